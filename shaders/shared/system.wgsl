// The pressure system without a matrix: forces F = C X at the velocity nodes of gas and solid, and their transpose.
// Unknowns: one value per vertex (P, or Q inside solids, or the shared pressure); vertices in the extra list carry h and Q
// apart behind the grid. C = [K; B; H]: element gradients, faces to walls and open sides on P itself, faces between gas and
// solid on h. [Cao et al. 2022, eqs. 34-37]
// Needs the bindings cells and extra.

fn interface_index(slot: u32) -> u32 {
    if SOLIDS { let at = extra[slot]; if at != NO_EXTRA { return params.slots + at; } }
    return slot;
}
fn ghost_index(slot: u32) -> u32 {
    if SOLIDS { let at = extra[slot]; if at != NO_EXTRA { return params.slots + params.extra_capacity + at; } }
    return slot;
}

fn neighbour_kind(c: vec3i, n: u32, up: bool) -> u32 {
    return kind_of(cells[slot_of(select(c - axis(n), c + axis(n), up))]);
}
