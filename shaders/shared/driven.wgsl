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

// Columns of the matrix that turns: spin x.
fn turning(spin: vec3f) -> mat3x3f {
    return mat3x3f(0.0, spin.z, -spin.y, -spin.z, 0.0, spin.x, spin.y, -spin.x, 0.0);
}

// A vector that turns with `s` for a while. [Rodrigues 1840]
fn turned(s: Support, arm: vec3f, time: f32) -> vec3f {
    let rate = length(s.spin);
    let about = s.spin / max(rate, 1e-30);
    let angle = rate * time;
    return arm * cos(angle) + cross(about, arm) * sin(angle) + about * dot(about, arm) * (1.0 - cos(angle));
}

// Where a point goes between two shares of the step.
fn rigid_place(s: Support, x: vec3f, from_part: f32, to_part: f32, time: f32) -> vec3f {
    return s.pivot + to_part * s.advance + turned(s, x - s.pivot - from_part * s.advance, time);
}
