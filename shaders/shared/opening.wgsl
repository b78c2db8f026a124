// What lies beyond a part of a side.

// Generated from src/state/openings.rs by scripts/generate.
struct Opening {
    flow: vec4f,                // Density [kg m^-3] and momentum [kg m^-2 s^-1] of the state beyond; total density of a reservoir
    energy: f32,                // Total energy per volume of that state [J m^-3]
    pressure: f32,              // Pressure of that state, far or total pressure [Pa]
    rule: u32,                  // What is prescribed, RULE_* of constants::RULES
    share: f32,                 // Attenuation [1], or relaxation over the length of the domain [m^-1]
    first: u32,                 // First knot of the table of times
    knots: u32,                 // Knots of the table of times, 0 for a constant state
}
// End of what is generated.
