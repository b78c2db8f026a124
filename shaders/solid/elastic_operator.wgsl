// elastic_solve, the operator: y = M x + dt^2 K x, where K x is minus the force of the stress change
//   vol0 (lambda tr(G) + mu (G + G^T)), G = grad x,
// which elastic_strain leaves for p2g to carry to the nodes; elastic_operator puts the sum together. elastic_add takes the solution.
#include "shared/index.wgsl"
#include "shared/reduce.wgsl"
#include "solid/place.wgsl"
#include "materials/law.wgsl"
#include "solid/motion.wgsl"
#include "shared/pcg.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> position: array<vec4f>;
@group(0) @binding(3) var<storage, read> direction: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> change: array<vec4f>;
@group(0) @binding(5) var<storage, read> work: array<vec4f>;            // force of the stress change
@group(0) @binding(6) var<storage, read_write> node: array<vec4f>;
@group(0) @binding(7) var<storage, read> inverse_diagonal: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> product: array<vec4f>;
@group(0) @binding(9) var<storage, read_write> partials: array<vec4f>;
@group(0) @binding(10) var<storage, read> solution: array<vec4f>;

fn grid_vector(slot: u32) -> vec3f { return direction[slot].xyz; }

@compute @workgroup_size(WORKGROUP)
fn elastic_strain(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let p = thread_index(group, lane);
    if p >= params.particles { return; }
    let lambda = change[2u * p].w;
    let mu = change[2u * p + 1u].w;
    if mu == 0.0 { return; }
    let x = position[p].xyz;
    let cell = cell_at(x);
    read_rows(slot_of(cell));
    let g = motion_at(place_at(x, vec3f(cell) + 0.5)).gradient;
    let diagonal = vec3f(lambda * trace(g)) + 2.0 * mu * vec3f(g[0].x, g[1].y, g[2].z);
    let off = mu * vec3f(g[0].y + g[1].x, g[1].z + g[2].y, g[2].x + g[0].z);
    change[2u * p] = vec4f(diagonal, lambda);
    change[2u * p + 1u] = vec4f(off, mu);
}

@compute @workgroup_size(WORKGROUP)
fn elastic_operator(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var sum = 0.0;
    for (var slot = thread_index(group, lane); slot < params.slots; slot += striding_threads()) {
        let x = direction[slot].xyz;
        let y = node[slot].w * x - control.dt * control.dt * work[part(ELASTIC_FORCE, slot)].xyz;
        // Components that are no unknowns have no diagonal.
        let own = select(y, vec3f(0.0), inverse_diagonal[slot].xyz == vec3f(0.0));
        product[slot] = vec4f(own, 0.0);
        sum += dot(x, own);
    }
    let part = workgroup_sum4(lane, vec4f(sum, 0.0, 0.0, 0.0));
    if lane == 0u { partials[PARTIALS * BLOCK_DOTS + group_index(group)] = part; }
}

@compute @workgroup_size(WORKGROUP)
fn elastic_add(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    node[slot] = vec4f(node[slot].xyz + solution[slot].xyz + pcg.alpha * direction[slot].xyz, node[slot].w);
}
