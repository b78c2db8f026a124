// Where owed_flow and owed_energy have the books of a slot. With bodies or obstacles every slot has its own place. Else only slots of
// the ring have one, in their order, and what the energy floor takes from gas goes to control.borrowed.
override RING_BOOKS: bool;

// Slots of the ring.
fn ring_count() -> u32 { return params.slots - params.cells.x * params.cells.y * params.cells.z; }

// Place of a slot, with RING_BOOKS of one in the ring.
fn book_of(slot: u32) -> u32 {
    if !RING_BOOKS { return slot; }
    let c = cell_of(slot);
    let n = params.cells;
    let before = vec3u(clamp(c, vec3i(0), vec3i(n)));           // cells with a smaller index along each axis
    let level = (c >= vec3i(0)) & (c < vec3i(n));
    let in_row = select(0u, before.x, level.y);
    let in_layer = select(0u, before.y * n.x + in_row, level.z);
    return slot - before.z * n.y * n.x - in_layer;
}

// Mass and momentum, and energy, that count as one in control.borrowed: about those of ambient gas in a cell.
fn borrowed_unit() -> vec2f {
    return cell_volume() * vec2f(sqrt(params.ambient_pressure * params.ambient_density), params.ambient_pressure);
}
