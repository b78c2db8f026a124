// What lies beyond a part of a side. Mirror of src/state/openings.rs (Opening).

struct Opening {
    flow: vec4f,        // density, momentum of the state beyond; total density of a reservoir
    energy: f32,        // total energy per volume of that state
    pressure: f32,      // [Pa] of that state, far or total
    rule: u32,          // RULE_FIXED ...
    share: f32,         // attenuation [1], or relaxation over the length of the domain [m^-1]
    first: u32,         // first knot of the table of times
    knots: u32,         // knots of the table, 0 for a constant state
}
