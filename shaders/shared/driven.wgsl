// The rigid motion of driven particles. Needs the bindings control and deformation.
#include "shared/support.wgsl"

@group(0) @binding(12) var<uniform> supports: array<Support, MAX_BODIES>;

// The word of a particle: 0 gone, 1 free, 2 driven.
fn is_driven(p: u32) -> bool { return DRIVEN && deformation[3u * p + 1u].w == 2.0; }

fn support_of(p: u32) -> Support { return supports[bitcast<u32>(deformation[3u * p].w)]; }

// Velocity at x of what moves like `s`; `part`: share of the step that has passed.
fn rigid_velocity(s: Support, x: vec3f, part: f32) -> vec3f {
    return s.velocity + cross(s.spin, x - s.pivot - part * s.advance);
}

// Where a point goes between two shares of the step. [Rodrigues 1840]
fn rigid_place(s: Support, x: vec3f, from_part: f32, to_part: f32, time: f32) -> vec3f {
    let arm = x - s.pivot - from_part * s.advance;
    let rate = length(s.spin);
    let about = s.spin / max(rate, 1e-30);
    let angle = rate * time;
    let turned = arm * cos(angle) + cross(about, arm) * sin(angle) + about * dot(about, arm) * (1.0 - cos(angle));
    return s.pivot + to_part * s.advance + turned;
}
