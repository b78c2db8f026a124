// time_step, last part: states of inlets that follow a table of times, in the middle of the step that has just been chosen.
#include "shared/state.wgsl"

// Generated from src/state/openings.rs by scripts/generate.
struct Knot {
    velocity: vec3f,            // Velocity [m s^-1]
    time: f32,                  // When [s]
    density: f32,               // Density [kg m^-3]
    pressure: f32,              // Pressure [Pa]
}
// End of what is generated.

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> knots: array<Knot>;
@group(0) @binding(3) var<storage, read_write> openings: array<Opening, MAX_OPENINGS>;

@compute @workgroup_size(WORKGROUP)
fn openings_now(@builtin(local_invocation_index) lane: u32) {
    if lane >= MAX_OPENINGS || openings[lane].knots == 0u { return; }
    let time = control.time + 0.5 * control.duration;
    let first = openings[lane].first;
    let last = first + openings[lane].knots - 1u;
    var next = first;
    while next < last && knots[next].time <= time { next += 1u; }
    let before = knots[max(next, first + 1u) - 1u];
    let after = knots[next];
    let span = after.time - before.time;
    var share = 1.0;
    if span > 0.0 { share = clamp((time - before.time) / span, 0.0, 1.0); }
    let density = mix(before.density, after.density, share);
    let mass_fraction = openings[lane].species_density / openings[lane].flow.x;
    let species = vec2f(mass_fraction * density, openings[lane].species_volume);
    let gas = gas_from_primitive(density, mix(before.velocity, after.velocity, share),
        mix(before.pressure, after.pressure, share), species, 0.0);
    openings[lane].species_density = species.x;
    openings[lane].flow = gas.flow;
    openings[lane].energy = gas.energy;
    openings[lane].pressure = mix(before.pressure, after.pressure, share);
}
