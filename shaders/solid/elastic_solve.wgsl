// elastic_solve: which node velocities balance the elastic force at the end of the step? Backward Euler on the nodes,
//   r(V) = M (V^ - V) + dt f(V) = 0,  f(V) = -sum_p vol0 tau(F') grad w,  F' = F after plastic flow from (1 + dt grad V) F,
// by Newton's method: (M + dt^2 K) D = r, V += D, with the stiffness K of an isotropic law whose Lame constants each particle has now
// (elastic_operator.wgsl). tau is symmetric and grad w that of the start: angular momentum is kept. [Gast et al. 2015; Klar et al. 2016]
// Reads particles and nodes after the kick, V^. Writes node velocity. On return walls hold, and r is below the tolerance.
#include "solid/grid_wall.wgsl"
#include "solid/given.wgsl"
#include "materials/stress.wgsl"
#include "solid/ghost_between.wgsl"
#include "solid/motion.wgsl"
#include "shared/driven.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read_write> node: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> elastic: array<vec4f>;
@group(0) @binding(5) var<storage, read> work: array<vec4f>;                    // f(V)
@group(0) @binding(6) var<storage, read_write> residual: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> product: array<vec4f>;
@group(0) @binding(8) var<storage, read> ghost: array<f32>;                    // vertex change of the ghost pressure in this step
@group(0) @binding(9) var<storage, read_write> inverse_diagonal: array<vec4f>;
@group(0) @binding(10) var<storage, read> position: array<vec4f>;
@group(0) @binding(11) var<storage, read> velocity: array<vec4f>;
@group(0) @binding(13) var<storage, read_write> affine: array<vec4f>;
@group(0) @binding(14) var<storage, read> deformation: array<vec4f>;
@group(0) @binding(16) var<storage, read_write> stress: array<vec4f>;
@group(0) @binding(17) var<storage, read_write> change: array<vec4f>;           // w: vol0 lambda and vol0 mu of now [J]
@group(0) @binding(18) var<storage, read> order: array<u32>;
@group(0) @binding(19) var<storage, read> cell_start: array<u32>;

// Shear stiffness that plastic flow leaves at least, over that of the law: the system stays definite.
const SOFTEST = 0.01;
// From this round on what a wall has stopped stays stopped until the step ends: nodes that are stopped and let go in turn would go on so.
const STICKY_ROUND = 6u;
// Cells per step: a speed below this, times the tolerance, counts as rest.
const CREEP = 1e-3;

fn grid_vector(slot: u32) -> vec3f { return node[slot].xyz; }

fn is_free(slot: u32) -> bool { return node[slot].w > 0.0 && !(DRIVEN && has(cells[slot], NODE_DRIVEN)); }

// The first guess is what the nodes have, that of the particles, stopped at walls.
@compute @workgroup_size(WORKGROUP)
fn elastic_keep(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let here = node[slot];
    if is_free(slot) { node[slot] = vec4f(stopped_at_wall(cell_of(slot), here.xyz), here.w); }
}

// The ghost pressure of the end of the step, which the elastic stress depends on.
@compute @workgroup_size(WORKGROUP)
fn elastic_ghost(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let p = thread_index(group, lane);
    if p >= params.particles || deformation[3u * p + 1u].w == 0.0 { return; }
    affine[3u * p].w += ghost_between(position[p].xyz);
}

fn deviator_size(a: mat3x3f) -> f32 {
    let mean = trace(a) / 3.0;
    let d = vec3f(a[0].x, a[1].y, a[2].z) - vec3f(mean);
    let o = vec3f(a[0].y, a[1].z, a[2].x);
    return sqrt(dot(d, d) + 2.0 * dot(o, o));
}

// Largest sum of a row of F F^T: what a law in F F^T is stiffer by where it is stretched.
fn stretch_of(h: mat3x3f) -> f32 {
    let f = IDENTITY + h;
    let b = f * transpose(f);
    let rows = vec3f(dot(abs(b[0]), vec3f(1.0)), dot(abs(b[1]), vec3f(1.0)), dot(abs(b[2]), vec3f(1.0)));
    return max(1.0, max(rows.x, max(rows.y, rows.z)));
}

// Stress at the end of the step if the nodes move as they do now, and the Lame constants of a small change of it.
@compute @workgroup_size(WORKGROUP)
fn elastic_trial(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let p = thread_index(group, lane);
    if p >= params.particles { return; }
    if deformation[3u * p + 1u].w == 0.0 || !strains(p) {
        change[2u * p].w = 0.0;
        change[2u * p + 1u].w = 0.0;
        return;
    }
    let x = position[p].xyz;
    let cell = cell_at(x);
    read_rows(slot_of(cell));
    let trial = trial_deformation(p, motion_at(place_at(x, vec3f(cell) + 0.5)).gradient, control.dt);
    let material = materials[material_index(affine[3u * p + 2u].w)];
    let returned = return_map(material.kind, trial, affine[3u * p + 1u].w, material);
    let q = affine[3u * p].w;
    let tau = elastic_stress(material, returned.deformation, q);
    var stiffness = stretch_of(returned.deformation);
    if returned.plastic_strain > 0.0 {
        let before = deviator_size(kirchhoff_stress(material.kind, trial, material));
        stiffness *= clamp(deviator_size(tau) / max(before, 1e-30), SOFTEST, 1.0);
    }
    let volume = velocity[p].w;
    stress[2u * p] = vec4f(volume * vec3f(tau[0].x, tau[1].y, tau[2].z), stress[2u * p].w);
    stress[2u * p + 1u] = vec4f(volume * vec3f(tau[0].y, tau[1].z, tau[0].z), stress[2u * p + 1u].w);
    change[2u * p].w = volume * lambda_of(material, returned.deformation, q);
    change[2u * p + 1u].w = volume * material.mu * stiffness;
}

// Volumetric stiffness of the elastic stress.
fn lambda_of(m: MaterialParams, h: mat3x3f, q: f32) -> f32 {
    if !bears_volume(m) { return m.elastic_lambda; }
    return m.elastic_lambda + ghost_stiffness(m, ghost_pressure_of(m, swelling_of(m, h, q)));
}

// Share of a particle in the diagonal of K: vol0 ((lambda + mu) g_a^2 + mu |g|^2), g the slope of its weight at the node.
fn diagonal_share(p: u32, middle: vec3f, offset: vec3i) -> vec3f {
    let at = place_at(position[p].xyz, middle);
    let k = vec3u(offset + vec3i(1));
    let w = vec3f(at.weight[0][k.x], at.weight[1][k.y], at.weight[2][k.z]);
    let s = vec3f(at.slope[0][k.x], at.slope[1][k.y], at.slope[2][k.z]);
    let g = vec3f(s.x * w.y * w.z, w.x * s.y * w.z, w.x * w.y * s.z);
    let lambda = change[2u * p].w;
    let mu = change[2u * p + 1u].w;
    return (lambda + mu) * g * g + vec3f(mu * dot(g, g));
}

@compute @workgroup_size(WORKGROUP)
fn elastic_diagonal(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let c = cell_of(slot);
    var sum = vec3f(0.0);
    for (var k = 0u; k < select(0u, block_size(), node[slot].w > 0.0); k++) {
        let near = c + block_offset(k);
        if !inside(near) { continue; }
        let at = slot_of(near);
        let end = cell_start[at + 1u];
        for (var i = cell_start[at]; i < end; i++) { sum += diagonal_share(order[i], vec3f(near) + 0.5, -block_offset(k)); }
    }
    let entry = vec3f(node[slot].w) + control.dt * control.dt * sum;
    inverse_diagonal[slot] = vec4f(select(vec3f(0.0), 1.0 / entry, entry > vec3f(0.0)), 0.0);
}

// r of a node as it moves now.
fn imbalance(slot: u32) -> vec3f {
    return node[slot].w * (elastic[part(KICKED_VELOCITY, slot)].xyz - node[slot].xyz) + control.dt * work[part(ELASTIC_FORCE, slot)].xyz;
}

// Right-hand side. Components that a wall stops are no unknowns: they have no diagonal, and what the wall bears stays in `residual`.
// What the tolerance refers to is left in `product`.
@compute @workgroup_size(WORKGROUP)
fn elastic_residual(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    var r = vec3f(0.0);
    var scale = vec3f(0.0);
    var inverse_entry = vec3f(0.0);
    if is_free(slot) {
        let here = node[slot];
        r = imbalance(slot);
        inverse_entry = inverse_diagonal[slot].xyz;
        var held = held_at_wall(cell_of(slot), here.xyz + r * inverse_entry);
        let kept = (vec3u(u32(elastic[part(KICKED_VELOCITY, slot)].w)) & vec3u(1u, 2u, 4u)) != vec3u(0u);
        if control.rounds >= STICKY_ROUND { held = held | kept; }
        // Nothing follows the last round: what it stopped would leave an imbalance that belongs to other velocities.
        if control.rounds + 1u >= MAX_ROUNDS { held = held & (here.xyz == vec3f(0.0)); }
        elastic[part(KICKED_VELOCITY, slot)].w = f32(dot(select(vec3u(0u), vec3u(1u, 2u, 4u), held), vec3u(1u)));
        if any(held & (here.xyz != vec3f(0.0))) {
            node[slot] = vec4f(select(here.xyz, vec3f(0.0), held), here.w);
            atomicAdd(&control.newly_held, 1u);
        }
        inverse_entry = select(inverse_entry, vec3f(0.0), held);
        let creep = CREEP * params.spacing / control.dt;
        scale = here.w * (abs(elastic[part(KICKED_VELOCITY, slot)].xyz) + vec3f(creep)) + control.dt * abs(work[part(ELASTIC_FORCE, slot)].xyz);
    }
    residual[slot] = vec4f(r, 0.0);
    product[slot] = vec4f(scale, 0.0);
    inverse_diagonal[slot] = vec4f(inverse_entry, 0.0);
}

// Walls: what they stop, the rubbing that goes with it, and what they give.
@compute @workgroup_size(WORKGROUP)
fn elastic_finish(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var given = vec4f(0.0);
    for (var slot = thread_index(group, lane); slot < params.slots; slot += striding_threads()) {
        if !is_free(slot) { continue; }
        let here = node[slot];
        let c = cell_of(slot);
        let reaction = select(vec3f(0.0), residual[slot].xyz / here.w, inverse_diagonal[slot].xyz == vec3f(0.0));
        // Rubbing goes with what pushes against the wall; one that pulls lets go in the next step.
        let push = select(vec3f(0.0), reaction, held_at_wall(c, here.xyz + reaction));
        let v = velocity_at_wall(c, here.xyz + push);
        node[slot] = vec4f(v, here.w);
        given += given_to(here.w, v - here.xyz - reaction, elastic[part(KICKED_VELOCITY, slot)].xyz, v);
    }
    add_given(group_index(group), lane, given, false);
}
