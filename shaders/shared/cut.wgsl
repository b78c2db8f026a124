// Cut cells: the surface of an obstacle leaves gas in a part of them. Small parts share one state with a neighbour, their cluster:
// what changes one of them changes all by the same amount. Mirror of src/state/cut.rs.
// Needs the binding extra: without bodies its first block holds the number of a slot's entry, counted from 1, and the table
// stands behind the lists.

fn cut_entry(slot: u32) -> u32 {
    if CUT { return extra[slot]; }
    return 0u;
}

fn cut_word(entry: u32, field: u32) -> u32 { return extra[params.table_at + (entry - 1u) * CUT_WIDTH + field]; }
fn cut_value(entry: u32, field: u32) -> f32 { return bitcast<f32>(cut_word(entry, field)); }
fn cut_vector(entry: u32, field: u32) -> vec3f {
    return vec3f(cut_value(entry, field), cut_value(entry, field + 1u), cut_value(entry, field + 2u));
}

// Gas in a GAS cell, and in all cells that share its state, in cells.
fn gas_share(slot: u32) -> f32 {
    let entry = cut_entry(slot);
    if entry == 0u { return 1.0; }
    return cut_value(entry, CUT_SHARE);
}

fn cluster_share(slot: u32) -> f32 {
    let entry = cut_entry(slot);
    if entry == 0u { return 1.0; }
    return cut_value(entry, CUT_CLUSTER_SHARE);
}

// The slots of a cluster in order, the same for each of them; NO_EXTRA after the last.
fn cluster_first(slot: u32) -> u32 {
    let entry = cut_entry(slot);
    if entry == 0u { return slot; }
    return cut_word(entry, CUT_FIRST);
}

fn cluster_next(slot: u32) -> u32 {
    let entry = cut_entry(slot);
    if entry == 0u { return NO_EXTRA; }
    return cut_word(entry, CUT_NEXT);
}

// Open share of a face of a GAS cell.
fn aperture(slot: u32, n: u32, up: bool) -> f32 {
    let entry = cut_entry(slot);
    if entry == 0u { return 1.0; }
    return cut_value(entry, CUT_APERTURE + 2u * n + u32(up));
}

// What a corner of a cell has to say at a place, in cells from the centre.
fn shape_at(place: vec3f, corner: vec3i) -> f32 {
    var value = 1.0;
    for (var a = 0u; a < DIM; a++) { value *= 0.5 + select(-place[a], place[a], corner[a] == 1); }
    return value;
}

// The same in the mean over the open part of a face, for corners of this face.
fn face_shape(slot: u32, n: u32, up: bool, corner: vec3i) -> f32 {
    let entry = cut_entry(slot);
    if entry == 0u { return 1.0 / f32(1u << (DIM - 1u)); }
    let a = (n + 1u) % 3u;
    let b = (n + 2u) % 3u;
    let middle = cut_vector(entry, CUT_MIDDLE + 3u * (2u * n + u32(up)));
    let side = 2.0 * vec3f(corner) - 1.0;
    if DIM == 1u { return 1.0; }
    if DIM == 2u { return 0.5 + side[1u - n] * middle[1u - n]; }
    return 0.25 + 0.5 * (side[a] * middle[a] + side[b] * middle[b]) + side[a] * side[b] * middle[n];
}

// Share of a corner in the gas of its cell, and the integral of the gradient of its shape function over that gas, in units
// of face_area().
fn gas_at_corner(slot: u32, corner: vec3i) -> f32 {
    let entry = cut_entry(slot);
    if entry == 0u { return 1.0 / f32(corner_count()); }
    return cut_value(entry, CUT_SHARE) * shape_at(cut_vector(entry, CUT_CENTER), corner);
}

fn cut_slope(slot: u32, corner: vec3i) -> vec3f {
    let side = 2.0 * vec3f(corner) - 1.0;
    let entry = cut_entry(slot);
    var share = 1.0;
    var center = vec3f(0.0);
    var mixed = vec3f(0.0);
    if entry != 0u {
        share = cut_value(entry, CUT_SHARE);
        center = cut_vector(entry, CUT_CENTER);
        mixed = cut_vector(entry, CUT_MIXED);
    }
    let half = 0.5 + side * center;
    if DIM == 1u { return vec3f(share * side.x, 0.0, 0.0); }
    if DIM == 2u { return share * vec3f(side.xy * half.yx, 0.0); }
    // mean of (1/2 + s y)(1/2 + t z)
    let t = side.yzx;
    let u = side.zxy;
    return share * side * (0.25 + 0.5 * (t * center.yzx + u * center.zxy) + t * u * mixed);
}
