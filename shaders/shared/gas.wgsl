// Ideal gas: conserved variables U = (rho, rho u, E) and what follows from them.
// [Cao et al. 2022, eqs. 8-9]

struct Gas {
    flow: vec4f,    // density [kg m^-3], momentum [kg m^-2 s^-1]
    energy: f32,    // total energy per volume [J m^-3]
}

// The momentum along axes that the scene has not is zero. Said where a state is loaded, so that no kernel reads it or reckons with it.
fn in_space(flow: vec4f) -> vec4f {
    if DIM == 1u { return vec4f(flow.xy, 0.0, 0.0); }
    if DIM == 2u { return vec4f(flow.xyz, 0.0); }
    return flow;
}

fn velocity_of(flow: vec4f) -> vec3f { return flow.yzw / flow.x; }
fn kinetic_energy(flow: vec4f) -> f32 { return 0.5 * dot(flow.yzw, flow.yzw) / flow.x; }
fn internal_energy(gas: Gas) -> f32 { return gas.energy - kinetic_energy(gas.flow); }
fn pressure_of(gas: Gas) -> f32 { return (params.gamma - 1.0) * internal_energy(gas); }
fn sound_speed(density: f32, pressure: f32) -> f32 { return sqrt(params.gamma * max(pressure, 0.0) / density); }
fn gas_from_primitive(density: f32, velocity: vec3f, pressure: f32) -> Gas {
    return Gas(vec4f(density, density * velocity),
        pressure / (params.gamma - 1.0) + 0.5 * density * dot(velocity, velocity));
}
fn chosen(a: Gas, b: Gas, first: bool) -> Gas {
    return Gas(select(b.flow, a.flow, first), select(b.energy, a.energy, first));
}
