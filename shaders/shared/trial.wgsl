// The deformation that a velocity gradient leads to, before plastic flow. Needs the binding deformation.
// Kept and given is the displacement gradient h = F - I: near rest single precision has no room in F for the strain of a sub-step.
#include "shared/driven.wgsl"

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
