// Faces of GAS cells towards open sides, as the last solve left them.
// Needs index, cell and cut, and the binding pressure.

// Mean of the pressure at the face of a cell.
fn last_face_pressure(near: vec3i, n: u32, up: bool) -> f32 {
    let low = select(near, near + axis(n), up);
    var sum = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let corner = corner_offset(k);
        if corner[n] == 1 { continue; }
        let own = corner + select(vec3i(0), axis(n), up);
        sum += face_shape(slot_of(near), n, up, own) * pressure[slot_of(low + corner)];
    }
    return sum;
}
