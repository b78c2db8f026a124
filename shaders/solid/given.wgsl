// What walls, gas films and gravity give to bodies: impulse [kg m s^-1] and work [J] of one step, a sum per group.
#include "shared/reduce.wgsl"

@group(0) @binding(8) var<storage, read_write> partials: array<vec4f>;

// A change of velocity of a mass that goes from `before` to `after`: other forces may have their share in that.
fn given_to(mass: f32, change: vec3f, before: vec3f, after: vec3f) -> vec4f {
    return mass * vec4f(change, 0.5 * dot(change, after + before));
}

// `first`: nothing has been given in this step before.
fn add_given(at: u32, lane: u32, given: vec4f, first: bool) {
    let sum = workgroup_sum4(lane, given);
    if lane != 0u { return; }
    let place = BLOCK_GIVEN * PARTIALS + at;
    partials[place] = select(partials[place], vec4f(0.0), first) + sum;
}
