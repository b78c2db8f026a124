// State of the gas beyond an open side: one function per boundary rule. Walls have no state; their faces are closed.
// A slot outside of the domain belongs to the side that it lies behind; behind two sides, to the first open one.

fn side_kind(s: u32) -> u32 { return params.side[s >> 2u][s & 3u]; }

// Side that cell c lies behind (0..5), or 6 when it is inside.
fn side_of(c: vec3i) -> u32 {
    var found = 6u;
    for (var a = 0u; a < DIM; a++) {
        if c[a] < 0 && (found == 6u || side_kind(2u * a) != SIDE_WALL) { found = 2u * a; }
        if c[a] >= i32(params.cells[a]) && (found == 6u || side_kind(2u * a + 1u) != SIDE_WALL) { found = 2u * a + 1u; }
    }
    return found;
}

fn bc_inlet(side: u32) -> Gas { return Gas(params.inlet_flow[side], params.inlet_energy[side].x); }
