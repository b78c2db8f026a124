// elastic_solve, the last of it: what is missing from the momentum of a body, because conjugate gradients leave an imbalance r on its
// nodes, goes back to its particles as one velocity. A whole body is the softest mode of a stiff system, and the last to converge.
// Reads sorted particles, node, the imbalance of the last round. Writes particle velocity. On return every body has the momentum
// that the pressure, walls and other bodies have given to it; its spin is that of the solve.
#include "shared/index.wgsl"
#include "solid/place.wgsl"
#include "shared/driven.wgsl"
#include "solid/motion.wgsl"
#include "shared/reduce.wgsl"

@group(0) @binding(1) var<storage, read> position: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> velocity: array<vec4f>;
@group(0) @binding(3) var<storage, read> deformation: array<vec4f>;
@group(0) @binding(4) var<storage, read> node: array<vec4f>;
@group(0) @binding(5) var<storage, read> residual: array<vec4f>;
@group(0) @binding(6) var<storage, read> inverse_diagonal: array<vec4f>;
@group(0) @binding(7) var<storage, read> portions: array<vec2u>;            // first particle and end, as many portions for each body
@group(0) @binding(8) var<storage, read_write> missing: array<vec4f>;       // per portion: momentum, mass; behind them per body: velocity

// Velocity that a node is short of. Components that a wall stops have no diagonal, and what they are short of the wall bears.
fn grid_vector(slot: u32) -> vec3f {
    let mass = node[slot].w;
    if mass <= 0.0 { return vec3f(0.0); }
    return select(residual[slot].xyz / mass, vec3f(0.0), inverse_diagonal[slot].xyz == vec3f(0.0));
}

fn takes(p: u32) -> bool { return deformation[3u * p + 1u].w != 0.0 && !is_driven(p); }

// Of the particles of a portion of a body.
@compute @workgroup_size(WORKGROUP)
fn elastic_missing(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    for (var k = group.x; k < arrayLength(&portions); k += params.groups) {
        let portion = portions[k];
        var sum = vec4f(0.0);
        for (var p = portion.x + lane; p < portion.y; p += WORKGROUP) {
            if !takes(p) { continue; }
            let x = position[p];
            let cell = cell_at(x.xyz);
            read_rows(slot_of(cell));
            sum += x.w * vec4f(motion_at(place_at(x.xyz, vec3f(cell) + 0.5)).velocity, 1.0);
        }
        let part = workgroup_sum4(lane, sum);
        if lane == 0u { missing[k] = part; }
    }
}

@compute @workgroup_size(WORKGROUP)
fn elastic_missing_bodies(@builtin(local_invocation_index) lane: u32) {
    let count = arrayLength(&portions);
    let bodies = arrayLength(&missing) - count;
    let share = count / bodies;
    for (var body = lane; body < bodies; body += WORKGROUP) {
        var sum = vec4f(0.0);
        for (var k = body * share; k < (body + 1u) * share; k++) { sum += missing[k]; }
        missing[count + body] = vec4f(select(vec3f(0.0), sum.xyz / sum.w, sum.w > 0.0), 0.0);
    }
}

@compute @workgroup_size(WORKGROUP)
fn elastic_give(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let p = thread_index(group, lane);
    if p >= params.particles || !takes(p) { return; }
    let body = bitcast<u32>(deformation[3u * p].w);
    velocity[p] += vec4f(missing[arrayLength(&portions) + body].xyz, 0.0);
}
