// Inverse masses of the B1B0 nodes deep inside the gas: the binding energy holds them.
#include "shared/state.wgsl"

fn inverse_mass(at: u32) -> f32 { return energy[part(INVERSE_MASS, at)]; }

// Inverse masses of the four nodes around a vertex in the layer of node `at`, in the same order.
fn masses(at: u32) -> vec4f {
    let y = params.stride.x;
    return vec4f(inverse_mass(at - 1u - y), inverse_mass(at - y), inverse_mass(at - 1u), inverse_mass(at));
}

// Sum over the nodes around a vertex.
fn mass_sum(at: u32) -> f32 {
    if DIM == 1u { return inverse_mass(at - 1u) + inverse_mass(at); }
    var all = masses(at);
    if DIM == 3u { all += masses(at - params.stride.x * params.stride.y); }
    return (all.x + all.w) + (all.y + all.z);
}
