// The carrier at faces near obstacles in 2D. In a cell of velocity u the solve sees transfers between its vertices, along each edge the
// integral of the velocity there over the gas; what comes in at a vertex is its divergence. Give each vertex to the cells
// around it by the gas that they hold there: then every transfer becomes fluxes through the faces between these cells, and a cell is
// compressed by its share of what the solve sees at its vertices, by nothing else. Where the nearest face is closed, the flux goes
// through the next one. Where no obstacle is near, this is the mean with (1, 2, 1) / 4; along a flat wall, with the nearest gas beyond.
// Needs the bindings cells, extra, node and openings, and a function flow_at(slot): density and momentum of the state that carries.

// The six cells beside a face and its neighbours, by [row + 1][column]: columns along the normal, rows along the face.
struct Beside {
    gas: array<vec2f, 3>,       // share
    across: array<vec2f, 3>,    // velocity along the normal
    along: array<vec2f, 3>,     // velocity along the face
    normal_place: array<vec2f, 3>,  // centre of the gas in its cell, along the normal
    place: array<vec2f, 3>,         // and along the face
    closed: array<f32, 3>,      // 1 where the face between the columns is closed
    shut: array<vec2f, 2>,      // 1 where the face between two rows is closed
    density: vec2f,             // of the middle row
}

fn holds_gas(c: vec3i) -> bool { return inside(c) && kind_of(cells[slot_of(c)]) == GAS; }

fn is_closed(c: vec3i, n: u32) -> f32 {
    if !holds_gas(c) || !holds_gas(c + axis(n)) { return 1.0; }
    return select(0.0, 1.0, aperture(slot_of(c), n, true) == 0.0);
}

fn beside(low: vec3i, n: u32) -> Beside {
    let t = 1u - n;
    var b: Beside;
    for (var row = 0u; row < 3u; row++) {
        for (var column = 0u; column < 2u; column++) {
            let c = low + i32(column) * axis(n) + (i32(row) - 1) * axis(t);
            if row < 2u { b.shut[row][column] = is_closed(c, t); }
            if !holds_gas(c) { continue; }
            let slot = slot_of(c);
            let flow = flow_at(slot);
            b.gas[row][column] = gas_share(slot);
            b.across[row][column] = flow[n + 1u] / flow.x;
            b.along[row][column] = flow[t + 1u] / flow.x;
            let entry = cut_entry(slot);
            if entry != 0u {
                b.normal_place[row][column] = cut_value(entry, CUT_CENTER + n);
                b.place[row][column] = cut_value(entry, CUT_CENTER + t);
            }
            if row == 1u { b.density[column] = flow.x; }
        }
        b.closed[row] = is_closed(low + (i32(row) - 1) * axis(t), n);
    }
    return b;
}

const LOW_HIGH = vec2f(1.0, -1.0);  // a vertex between two columns is at the high end of the first

// Shares of a vertex in the cells below and above it along the face; level 0 or 1 is the lower or upper end of the face.
struct Shares { below: vec2f, above: vec2f }

fn shares_of(b: Beside, level: u32) -> Shares {
    let below = b.gas[level] * (0.5 + LOW_HIGH * b.normal_place[level]) * (0.5 + b.place[level]);
    let above = b.gas[level + 1u] * (0.5 + LOW_HIGH * b.normal_place[level + 1u]) * (0.5 - b.place[level + 1u]);
    let sum = max(below.x + below.y + above.x + above.y, 1e-30);
    return Shares(below / sum, above / sum);
}

// Transfers along the normal, at the two edges of a level; and along the face, at the edge of a row.
fn across_transfer(b: Beside, level: u32) -> vec2f {
    return b.across[level] * b.gas[level] * (0.5 + b.place[level])
        + b.across[level + 1u] * b.gas[level + 1u] * (0.5 - b.place[level + 1u]);
}

fn along_transfer(b: Beside, row: u32) -> f32 {
    return dot(b.along[row] * b.gas[row], 0.5 + LOW_HIGH * b.normal_place[row]);
}

// What enters through open sides at an end of the face, at the cells of the middle row, and does not stay there.
fn side_transfer(low: vec3i, n: u32, level: u32, shares: vec2f) -> f32 {
    let t = 1u - n;
    let up = level == 1u;
    var inflow = vec2f(0.0);
    for (var column = 0u; column < 2u; column++) {
        let c = low + i32(column) * axis(n);
        let beyond = c + select(-axis(t), axis(t), up);
        if inside(beyond) || !holds_gas(c) || kind_of(cells[slot_of(beyond)]) != GHOST { continue; }
        let opening = opening_of(cells[slot_of(beyond)]);
        let flow = flow_at(slot_of(c));
        var velocity = flow[t + 1u] / flow.x + node[slot_of(beyond)][t];
        if prescribes(opening) { velocity = opening.flow[t + 1u] / opening.flow.x; }
        let corner = i32(1u - column) * axis(n) + i32(level) * axis(t);
        inflow[column] = select(1.0, -1.0, up) * velocity
            * aperture(slot_of(c), t, up) * face_shape(slot_of(c), t, up, corner);
    }
    return inflow.x - shares.x * (inflow.x + inflow.y);
}

// Volume that passes the face above cell `low` per area of a whole face, mass-weighted as the mean of two cells.
fn face_volume(low: vec3i, n: u32) -> f32 {
    let b = beside(low, n);
    let s = shares_of(b, 0u);
    let t = shares_of(b, 1u);
    let weight = 2.0 * b.density / (b.density.x + b.density.y);
    let lower = weight * across_transfer(b, 0u);
    let upper = weight * across_transfer(b, 1u);
    var sum = dot(lower, s.above.yx + b.closed[0] * s.below.yx) + dot(upper, t.below.yx + b.closed[2] * t.above.yx);
    let enters = s.above.x + (1.0 - b.shut[0].x) * s.below.x + b.shut[0].y * s.below.y;
    let leaves = t.below.x + (1.0 - b.shut[1].x) * t.above.x + b.shut[1].y * t.above.y;
    sum += along_transfer(b, 1u) * (enters - leaves);
    sum += along_transfer(b, 2u) * dot(LOW_HIGH * b.shut[1], t.below);
    sum -= along_transfer(b, 0u) * dot(LOW_HIGH * b.shut[0], s.above);
    return sum + side_transfer(low, n, 0u, s.above) + side_transfer(low, n, 1u, t.below);
}

// Whether the face between two GAS cells is one of these, by their words.
fn near_obstacle(low: u32, high: u32) -> bool { return CUT && DIM == 2u && !has(low & high, NODE_REGULAR); }

// Velocity of the face in its open part, without the correction by the divergence.
fn cut_velocity(low: vec3i, n: u32) -> f32 {
    let open = aperture(slot_of(low), n, true);
    return select(face_volume(low, n) / open, 0.0, open == 0.0);
}
