// supports, first part: velocities of driven parts in the middle of the step that has just been chosen, and their pivots.
#include "shared/state.wgsl"

// Generated from src/state/supports.rs by scripts/generate.
struct MotionAt {
    velocity: vec3f,            // Velocity [m s^-1]
    time: f32,                  // When [s]
    spin: vec3f,                // Angular velocity [rad s^-1]
}

struct Support {
    velocity: vec3f,            // Velocity of the driven part now [m s^-1]
    friction: f32,              // Coefficient of friction at walls and obstacles [1]; STICK for a body that sticks
    spin: vec3f,                // Angular velocity of the driven part now [rad s^-1]
    first: u32,                 // First entry of the motion over time
    pivot: vec3f,               // The point that the driven part turns about, at the start of the step, in the device's coordinates [m]
    entries: u32,               // Entries of the motion over time
    advance: vec3f,             // How far that point moves in this step [m]
    clamped: u32,               // 1 where only a part of the body is driven: that part strains next to the rest
}
// End of what is generated.

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> motions: array<MotionAt>;
@group(0) @binding(3) var<storage, read_write> supports: array<Support, MAX_BODIES>;

@compute @workgroup_size(WORKGROUP)
fn motions_now(@builtin(local_invocation_index) lane: u32) {
    for (var k = lane; k < params.bodies; k += WORKGROUP) {
        let time = control.time + 0.5 * control.duration;
        let first = supports[k].first;
        let last = first + supports[k].entries - 1u;
        var next = first;
        while next < last && motions[next].time <= time { next += 1u; }
        let before = motions[max(next, first + 1u) - 1u];
        let after = motions[next];
        let span = after.time - before.time;
        var share = 1.0;
        if span > 0.0 { share = clamp((time - before.time) / span, 0.0, 1.0); }
        supports[k].velocity = mix(before.velocity, after.velocity, share);
        supports[k].spin = mix(before.spin, after.spin, share);
        supports[k].pivot += supports[k].advance;
        supports[k].advance = control.duration * supports[k].velocity;
    }
}
