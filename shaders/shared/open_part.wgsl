// What the open part of the face of a GAS cell has of the pressures at its vertices.
// Needs index, cell and cut, and the binding pressure.

// Their mean, weighted by the shape functions over that part.
fn open_part_pressure(c: vec3i, n: u32, up: bool) -> f32 {
    let low = select(c, c + axis(n), up);
    var sum = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let corner = corner_offset(k);
        if corner[n] == 1 { continue; }
        let own = corner + select(vec3i(0), axis(n), up);
        sum += face_shape(slot_of(c), n, up, own) * pressure[slot_of(low + corner)];
    }
    return sum;
}
