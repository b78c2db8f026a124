// Transpose of the forces: C^T of a node field, at one vertex. Needs the bindings cells, extra and work (gas nodes, solid nodes).

// Rows of one vertex: its own unknown, and h and Q where they are apart.
struct Rows { own: f32, h: f32, q: f32 }

fn add_rows(rows: ptr<function, Rows>, slot: u32, r: Rows) {
    if interface_index(slot) == slot {
        (*rows).own += r.own + r.h + r.q;
    } else {
        (*rows).own += r.own;
        (*rows).h += r.h;
        (*rows).q += r.q;
    }
}

fn regular_rows(slot: u32) -> f32 {
    var sum = 0.0;
    let wide = select(0, 1, QUADRATIC);
    let first = -vec3i(wide) * reach();
    let last = (vec3i(1) + vec3i(wide)) * reach();
    for (var k = first.z; k <= last.z; k++) {
        for (var j = first.y; j <= last.y; j++) {
            for (var i = first.x; i <= last.x; i++) {
                // The node (i, j, k) below the vertex sees it at the offset (i, j, k).
                let at = u32(i32(slot) - i - i32(params.stride.x) * (j + i32(params.stride.y) * k));
                sum += dot(work[at].xyz, regular_entry(vec3i(i, j, k)));
            }
        }
    }
    return sum;
}

fn add_element_rows(rows: ptr<function, Rows>, slot: u32, e: vec3i, corner: vec3i, solid: bool) {
    let quadratic = solid || QUADRATIC;
    let base = select(0u, params.slots, solid);
    var r: Rows;
    var body = 0.0;
    for (var k = 0u; k < block_size(); k++) {
        let node_offset = block_offset(k);
        let velocity = work[base + slot_of(e + node_offset)].xyz;
        body += dot(velocity, element_entry(quadratic, node_offset, corner));
        for (var n = 0u; n < DIM; n++) {
            let up = corner[n] == 1;
            if !face_holds(node_offset, n, up) { continue; }
            let beyond = neighbour_kind(e, n, up);
            let flow = select(-1.0, 1.0, up) * velocity[n] * face_entry(quadratic, n, node_offset, corner);
            if select(beyond == SOLID, beyond == GAS, solid) { r.h += flow; }
            else if !solid && (beyond == WALL || beyond == GHOST) { body += flow; }
        }
    }
    if solid { r.q = body; } else { r.own = body; }
    add_rows(rows, slot, r);
}

// C^T W at a vertex, in units of face_area().
fn gather_rows(slot: u32, word: u32) -> Rows {
    var rows: Rows;
    if has(word, VERTEX_REGULAR) {
        rows.own = regular_rows(slot);
        return rows;
    }
    if !has(word, VERTEX_GAS | VERTEX_SOLID) { return rows; }
    let v = cell_of(slot);
    for (var k = 0u; k < corner_count(); k++) {
        let corner = corner_offset(k);
        let e = v - corner;
        if !inside(e) { continue; }
        let kind = kind_of(cells[slot_of(e)]);
        if kind == GAS { add_element_rows(&rows, slot, e, corner, false); }
        if SOLIDS && kind == SOLID { add_element_rows(&rows, slot, e, corner, true); }
    }
    return rows;
}
