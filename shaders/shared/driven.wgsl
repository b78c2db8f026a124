// The rigid motion of driven particles, and what a velocity gradient makes of any. Needs the binding deformation.
#include "shared/state.wgsl"
#include "materials/law.wgsl"

// Generated from src/state/supports.rs by scripts/generate.
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

@group(0) @binding(12) var<uniform> supports: array<Support, MAX_BODIES>;

// The word of a particle: 0 gone, 1 free, 2 driven.
fn is_driven(p: u32) -> bool { return DRIVEN && deformation[3u * p + 1u].w == 2.0; }

fn support_of(p: u32) -> Support { return supports[bitcast<u32>(deformation[3u * p].w)]; }

// Velocity at x of what moves like `s`; `part`: share of the step that has passed.
fn rigid_velocity(s: Support, x: vec3f, part: f32) -> vec3f {
    return s.velocity + cross(s.spin, x - s.pivot - part * s.advance);
}

// Columns of the matrix that turns: spin x.
fn turning(spin: vec3f) -> mat3x3f { return mat3x3f(0.0, spin.z, -spin.y, -spin.z, 0.0, spin.x, spin.y, -spin.x, 0.0); }

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

// -- Trial --

// The deformation that a velocity gradient leads to, before plastic flow.
// Kept and given is the displacement gradient h = F - I: near rest single precision has no room in F for the strain of a sub-step.

fn deformation_of(p: u32) -> mat3x3f {
    return mat3x3f(deformation[3u * p].xyz, deformation[3u * p + 1u].xyz, deformation[3u * p + 2u].xyz);
}

// Whether the law of a particle counts: a part that is held bears the stress of the rest at its edge.
fn strains(p: u32) -> bool { return !is_driven(p) || support_of(p).clamped == 1u; }

// Before plastic flow. What is driven turns with its motion, and strains where the nodes around it do not follow.
fn trial_deformation(p: u32, gradient: mat3x3f, time: f32) -> mat3x3f {
    let h = deformation_of(p);
    if !is_driven(p) { return h + time * (gradient + gradient * h); }
    let s = support_of(p);
    let change = gradient - turning(s.spin);
    let trial = IDENTITY + h + time * (change + change * h);
    return mat3x3f(turned(s, trial[0], time), turned(s, trial[1], time), turned(s, trial[2], time)) - IDENTITY;
}
