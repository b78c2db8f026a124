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

// The transpose of wide_force. `base`: where the nodes of gas or solid start.
fn wide_rows(slot: u32, v: vec3i, base: u32, solid: bool) -> f32 {
    let ex = wide_entries_of_vertex(0u, v.x, solid);
    let ey = wide_entries_of_vertex(1u, v.y, solid);
    let ez = wide_entries_of_vertex(2u, v.z, solid);
    var sum = 0.0;
    for (var k = -reach().z; k <= 2 * reach().z; k++) {
        for (var j = -reach().y; j <= 2 * reach().y; j++) {
            // The node (i, j, k) below the vertex sees it at the offset (i, j, k).
            let at = base + u32(i32(slot) - i32(params.stride.x) * (j + i32(params.stride.y) * k));
            let a = work[at + 1u].xyz;
            let b = work[at].xyz;
            let c = work[at - 1u].xyz;
            let d = work[at - 2u].xyz;
            let mean = ex.mean.x * a.yz + ex.mean.y * b.yz + ex.mean.z * c.yz + ex.mean.w * d.yz;
            sum += dot(ex.slope, vec4f(a.x, b.x, c.x, d.x)) * ey.mean[j + 1] * ez.mean[k + 1]
                + mean.x * ey.slope[j + 1] * ez.mean[k + 1] + mean.y * ey.mean[j + 1] * ez.slope[k + 1];
        }
    }
    return sum;
}

// (divergence's x part, means across x of the other two) of the nodes below and above the vertex along x: the transpose of
// narrow_line. `low` and `high` are the entries of these two nodes.
fn narrow_line(at: u32, low: vec3f, high: vec3f) -> vec3f {
    let a = work[at - 1u].xyz;
    let b = work[at].xyz;
    return vec3f(low.z * a.x - high.z * b.x, low.y * a.yz + high.x * b.yz);
}

// Sum over a layer of nodes, and its z velocity.
fn narrow_layer(at: u32, v: vec3i) -> vec2f {
    let low_x = narrow_entry(0u, v.x - 1);
    let high_x = narrow_entry(0u, v.x);
    let above = narrow_line(at, low_x, high_x);
    if DIM == 1u { return vec2f(above.x, 0.0); }
    let below = narrow_line(at - params.stride.x, low_x, high_x);
    let low = narrow_entry(1u, v.y - 1);
    let high = narrow_entry(1u, v.y);
    let sum = low.y * below + high.x * above;
    return vec2f(sum.x + low.z * below.y - high.z * above.y, sum.z);
}

fn regular_rows(slot: u32, v: vec3i) -> f32 {
    if QUADRATIC { return wide_rows(slot, v, 0u, false); }
    let above = narrow_layer(slot, v);
    if DIM < 3u { return above.x; }
    let below = narrow_layer(slot - params.stride.x * params.stride.y, v);
    let low = narrow_entry(2u, v.z - 1);
    let high = narrow_entry(2u, v.z);
    return low.y * below.x + high.x * above.x + low.z * below.y - high.z * above.y;
}

// One axis of an element as one of its vertices sees it, at the nodes -1, 0, 1: mean across, slope along, and the slope that acts on h.
struct Triple { mean: vec3f, slope: vec3f, face: vec3f }

fn triple_of(n: u32, quadratic: bool, up: bool, closed: f32, shared_face: f32) -> Triple {
    var triple: Triple;
    triple.mean = vec3f(0.0, 1.0, 0.0);
    if n >= DIM { return triple; }
    triple.mean = vec3f(mean_entry(quadratic, -1, up), mean_entry(quadratic, 0, up), mean_entry(quadratic, 1, up));
    let holds = select(vec3f(1.0, 1.0, 0.0), vec3f(0.0, 1.0, 1.0), up);
    triple.slope = vec3f(gradient_entry(quadratic, -1, up), gradient_entry(quadratic, 0, up), gradient_entry(quadratic, 1, up))
        + closed * holds;
    triple.face = shared_face * holds;
    return triple;
}

// Entry at the node k = -1, 0, 1.
fn pick(v: vec3f, k: i32) -> f32 { return select(select(v.y, v.x, k < 0), v.z, k > 0); }

// The transpose of element_force: one element's nodes as one of its vertices sees them, line by line along x.
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
    let tx = triple_of(0u, quadratic, corner.x == 1, closed.x, shared_face.x);
    let ty = triple_of(1u, quadratic, corner.y == 1, closed.y, shared_face.y);
    let tz = triple_of(2u, quadratic, corner.z == 1, closed.z, shared_face.z);
    var own = 0.0;
    var h = 0.0;
    // B1B0 couples a vertex to the nodes on its own side only.
    let first = select(corner - reach(), -reach(), quadratic);
    let last = select(corner, reach(), quadratic);
    for (var z = first.z; z <= last.z; z++) {
        let mz = pick(tz.mean, z);
        for (var y = first.y; y <= last.y; y++) {
            let my = pick(ty.mean, y);
            let along = my * mz;
            let slope_yz = vec2f(pick(ty.slope, y) * mz, my * pick(tz.slope, z));
            let face_yz = vec2f(pick(ty.face, y) * mz, my * pick(tz.face, z));
            for (var x = first.x; x <= last.x; x++) {
                let velocity = work[base + slot_of(v - corner + vec3i(x, y, z))].xyz;
                let mean = pick(tx.mean, x);
                own += dot(velocity, vec3f(pick(tx.slope, x) * along, mean * slope_yz));
                h += dot(velocity, vec3f(pick(tx.face, x) * along, mean * face_yz));
            }
        }
    }
    var r: Rows;
    r.h = h;
    if solid { r.q = own; } else { r.own = own; }
    return r;
}

// The vertex near an obstacle.
fn cut_rows(v: vec3i) -> f32 {
    var sum = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let j = v - corner_offset(k);
        sum += dot(work[slot_of(j)].xyz, coefficient(j, v));
    }
    return sum;
}

// C^T W at a vertex, in units of face_area().
fn gather_rows(slot: u32, word: u32) -> Rows {
    var rows: Rows;
    let v = cell_of(slot);
    let regular = !LISTED || has(word, VERTEX_REGULAR);
    for (var turn = 0u; turn < u32(regular); turn++) { rows.own = regular_rows(slot, v); }
    if !LISTED { return rows; }
    if CUT {
        if has(word, VERTEX_GAS) && !regular { rows.own = cut_rows(v); }
        return rows;
    }
    let deep = SOLIDS && has(word, VERTEX_DEEP);
    let mixed = has(word, VERTEX_GAS | VERTEX_SOLID) && !regular && !deep;
    for (var turn = 0u; turn < u32(deep); turn++) { rows.own = wide_rows(slot, v, params.slots, true); }
    let kinds = kinds_around_vertex(select(vec3i(0), v, mixed));
    for (var k = 0u; k < select(0u, corner_count(), mixed); k++) {
        let corner = corner_offset(k);
        let kind = (kinds >> (2u * k)) & 3u;
        if !inside(v - corner) || (kind != GAS && kind != SOLID) { continue; }
        add_rows(&rows, slot, element_rows(slot, v, kinds, corner, kind == SOLID));
    }
    return rows;
}
