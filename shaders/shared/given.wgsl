// The books of what walls, gas films and gravity give to bodies: impulse [kg m s^-1] and work [J] of one step, a sum per group.
#include "shared/reduce4.wgsl"

@group(0) @binding(8) var<storage, read_write> partials: array<vec4f>;

// What takes a mass from one velocity to another.
fn given_to(mass: f32, before: vec3f, after: vec3f) -> vec4f {
    return mass * vec4f(after - before, 0.5 * dot(after - before, after + before));
}

// `first`: nothing has been given in this step before.
fn add_given(at: u32, lane: u32, given: vec4f, first: bool) {
    let sum = workgroup_sum4(lane, given);
    if lane != 0u { return; }
    let place = BLOCK_GIVEN * PARTIALS + at;
    partials[place] = select(partials[place], vec4f(0.0), first) + sum;
}
