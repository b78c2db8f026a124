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

fn regular_rows(slot: u32, v: vec3i) -> f32 {
    let ex = axis_entries(0u, v.x, false);
    let ey = axis_entries(1u, v.y, false);
    let ez = axis_entries(2u, v.z, false);
    var sum = 0.0;
    let wide = select(0, 1, QUADRATIC);
    let first = -wide * reach();
    let last = (1 + wide) * reach();
    for (var k = first.z; k <= last.z; k++) {
        if ez.mean[k + 1] == 0.0 { continue; }
        for (var j = first.y; j <= last.y; j++) {
            if ey.mean[j + 1] == 0.0 { continue; }
            for (var i = first.x; i <= last.x; i++) {
                if ex.mean[i + 1] == 0.0 { continue; }
                // The node (i, j, k) below the vertex sees it at the offset (i, j, k).
                let w = work[u32(i32(slot) - i - i32(params.stride.x) * (j + i32(params.stride.y) * k))].xyz;
                sum += w.x * ex.slope[i + 1] * ey.mean[j + 1] * ez.mean[k + 1]
                    + w.y * ex.mean[i + 1] * ey.slope[j + 1] * ez.mean[k + 1]
                    + w.z * ex.mean[i + 1] * ey.mean[j + 1] * ez.slope[k + 1];
            }
        }
    }
    return sum;
}

// The transpose of element_force: one element's nodes as one of its vertices sees them.
fn element_rows(slot: u32, v: vec3i, kinds: u32, corner: vec3i, solid: bool) -> Rows {
    let quadratic = solid || QUADRATIC;
    let base = select(0u, params.slots, solid);
    let apart = interface_index(slot) != slot;
    var closed = vec3f(0.0);    // +-1/2 where the face on this corner's side acts on the element's own pressure
    var shared_face = vec3f(0.0);   // the same where it acts on h
    for (var n = 0u; n < DIM; n++) {
        let beyond = kind_across(kinds, corner, n);
        let share = select(-0.5, 0.5, corner[n] == 1);
        let body = select(beyond == SOLID, beyond == GAS, solid);
        if body && apart { shared_face[n] = share; }
        else if body || (!solid && (beyond == WALL || beyond == GHOST)) { closed[n] = share; }
    }
    var own = 0.0;
    var h = 0.0;
    let count = select(corner_count(), block_size(), quadratic);
    for (var k = 0u; k < count; k++) {
        let node_offset = select(corner + corner_offset(k) - reach(), block_offset(k), quadratic);
        let velocity = work[base + slot_of(v - corner + node_offset)].xyz;
        var mean = vec3f(1.0);
        var slope = vec3f(0.0);
        var holds = vec3f(0.0);
        for (var n = 0u; n < DIM; n++) {
            let up = corner[n] == 1;
            mean[n] = mean_entry(quadratic, node_offset[n], up);
            slope[n] = gradient_entry(quadratic, node_offset[n], up);
            holds[n] = f32(face_holds(node_offset, n, up));
        }
        let across = velocity * vec3f(mean.y * mean.z, mean.x * mean.z, mean.x * mean.y);
        own += dot(across, slope + closed * holds);
        h += dot(across, shared_face * holds);
    }
    var r: Rows;
    r.h = h;
    if solid { r.q = own; } else { r.own = own; }
    return r;
}

// Only solid around the vertex.
fn deep_rows(slot: u32, count: u32) -> f32 {
    var sum = 0.0;
    for (var k = 0u; k < count; k++) {
        let offset = deep_offset(k);
        let at = u32(i32(slot) - offset.x - i32(params.stride.x) * (offset.y + i32(params.stride.y) * offset.z));
        sum += dot(work[params.slots + at].xyz, deep_entry(offset));
    }
    return sum;
}

// C^T W at a vertex, in units of face_area().
fn gather_rows(slot: u32, word: u32) -> Rows {
    var rows: Rows;
    let v = cell_of(slot);
    let regular = !LISTED || has(word, VERTEX_REGULAR);
    if regular { rows.own = regular_rows(slot, v); }
    if !LISTED { return rows; }
    let deep = SOLIDS && has(word, VERTEX_DEEP);
    let mixed = has(word, VERTEX_GAS | VERTEX_SOLID) && !regular && !deep;
    if SOLIDS { rows.own += deep_rows(slot, select(0u, deep_count(), deep)); }
    let kinds = kinds_around_vertex(select(vec3i(0), v, mixed));
    for (var k = 0u; k < select(0u, corner_count(), mixed); k++) {
        let corner = corner_offset(k);
        let kind = (kinds >> (2u * k)) & 3u;
        if !inside(v - corner) || (kind != GAS && kind != SOLID) { continue; }
        add_rows(&rows, slot, element_rows(slot, v, kinds, corner, kind == SOLID));
    }
    return rows;
}
