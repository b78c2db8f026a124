// push: the same change of velocity for all that is free of a body, or another density for all of it. Reads deformation. Writes velocity or
// position, and partials: first mass and momentum of the body, then what it was given.
#include "shared/state.wgsl"
#include "solid/given.wgsl"

// Generated from src/stage/solid/push.rs by scripts/generate.
struct Push {
    change: vec3f,              // [m s^-1]
    body: u32,                  // Number of the body
}
// End of what is generated.

@group(0) @binding(1) var<uniform> push: Push;
@group(0) @binding(2) var<storage, read_write> position: array<vec4f>;
@group(0) @binding(3) var<storage, read> deformation: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> velocity: array<vec4f>;

// Whether a particle belongs to the body, is inside the domain, and moves by itself.
fn is_free(p: u32) -> bool {
    return bitcast<u32>(deformation[3u * p].w) == push.body && deformation[3u * p + 1u].w == 1.0;
}

@compute @workgroup_size(WORKGROUP)
fn push_sums(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var sum = vec4f(0.0);
    for (var p = thread_index(group, lane); p < params.particles; p += striding_threads()) {
        if is_free(p) { sum += position[p].w * vec4f(velocity[p].xyz, 1.0); }
    }
    sum = workgroup_sum4(lane, sum);
    if lane == 0u { partials[group_index(group)] = sum; }
}

@compute @workgroup_size(WORKGROUP)
fn push_change(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var given = vec4f(0.0);
    for (var p = thread_index(group, lane); p < params.particles; p += striding_threads()) {
        if !is_free(p) { continue; }
        let before = velocity[p].xyz;
        let after = before + push.change;
        velocity[p] = vec4f(after, velocity[p].w);
        given += given_to(position[p].w, after - before, before, after);
    }
    given = workgroup_sum4(lane, given);
    if lane == 0u { partials[group_index(group)] = given; }
}

// The density is the first component of the change.
@compute @workgroup_size(WORKGROUP)
fn push_weigh(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    for (var p = thread_index(group, lane); p < params.particles; p += striding_threads()) {
        if bitcast<u32>(deformation[3u * p].w) == push.body && deformation[3u * p + 1u].w > 0.0 { position[p].w = push.change.x * velocity[p].w; }
    }
}
