// coupled_solve, preconditioner of the interface pressures h: they have no compliance, and patterns that change sign from vertex to
// vertex hardly move the nodes, so that a diagonal alone leaves fragments ill-conditioned. Here their own block of the system stands
// row by row, and a Chebyshev polynomial of it comes close to its inverse. [Saad 2003, algorithm 12.1]
// A row: what the polynomial works with (result, residual, two directions in turn), the vertex, the inverse of its diagonal, and the
// coefficients of the neighbours before it, one vertex away at most; those behind it have theirs in their own rows. What is left out
// between bodies is small; the polynomial is positive below its upper bound, so the preconditioner is positive definite all the same.
#include "shared/system.wgsl"
#include "shared/reduce.wgsl"
#include "shared/pcg.wgsl"

// Generated from src/stage/solve/coupled_solve/surface.rs by scripts/generate.
struct Turn {
    number: u32,                // From 0
    count: u32,                 // Steps of all
    first: u32,                 // 1 before the first iteration
    ends: u32,                  // 1 if all steps at once also open or end an iteration
}
// End of what is generated.

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> extra: array<u32>;
@group(0) @binding(4) var<storage, read> work: array<vec4f>;            // w: inverse masses of gas and solid nodes
@group(0) @binding(5) var<storage, read_write> rows: array<f32>;
@group(0) @binding(7) var<storage, read> residual: array<f32>;
@group(0) @binding(8) var<storage, read_write> partials: array<vec4f>;
@group(0) @binding(9) var<storage, read_write> product: array<f32>;    // before the first iteration the direction itself
@group(0) @binding(10) var<uniform> turn: Turn;

// Between the largest eigenvalue and the least one that the polynomial takes care of.
const SPREAD = 300.0;

// Places in a row.
const RESULT = 0u;
const RESIDUAL = 1u;
const DIRECTION = 2u;       // and the next one
const VERTEX = 4u;
const INVERSE = 5u;

fn before() -> u32 { return block_size() / 2u; }
fn row_length() -> u32 { return COUPLINGS + before(); }
fn row_count() -> u32 { return min(control.extra, params.surface_rows); }

// How gas pushes on the four faces across axis a at a vertex, half of each: from below +, from above -. Solids feel the opposite.
fn faces_at(kinds: u32, a: u32) -> vec4f {
    let b = (a + 1u) % 3u;
    let c = (a + 2u) % 3u;
    var push = vec4f(0.0);
    for (var t = 0u; t < 4u; t++) {
        if (b >= DIM && (t & 1u) == 1u) || (c >= DIM && (t >> 1u) == 1u) { continue; }
        var corner = vec3i(0);
        corner[b] = i32(t & 1u);
        corner[c] = i32(t >> 1u);
        let above = (kinds >> (2u * corner_index(corner))) & 3u;
        corner[a] = 1;
        let below = (kinds >> (2u * corner_index(corner))) & 3u;
        push[t] = select(0.0, 0.5, below == GAS && above == SOLID) - select(0.0, 0.5, below == SOLID && above == GAS);
    }
    return push;
}

// Means along one tangential axis of a node d from the vertex, in the cells at and below the vertex.
fn means(quadratic: bool, n: u32, d: i32) -> vec2f {
    if n >= DIM { return vec2f(1.0, 0.0); }
    let at = select(0.0, mean_entry(quadratic, d, false), abs(d) <= 1);
    let below = select(0.0, mean_entry(quadratic, d + 1, true), abs(d + 1) <= 1);
    return vec2f(at, below);
}

fn coefficient_at(push: vec4f, b: vec2f, c: vec2f) -> f32 {
    return dot(push, vec4f(b.x * c.x, b.y * c.x, b.x * c.y, b.y * c.y));
}

// Sum over the nodes of one phase of the product of the coefficients of the vertices v and v + w across axis a, over the masses.
fn coupled(v: vec3i, w: vec3i, a: u32, push: vec4f, other: vec4f, solid: bool) -> f32 {
    let quadratic = solid || QUADRATIC;
    let b = (a + 1u) % 3u;
    let c = (a + 2u) % 3u;
    let low = select(-1, -2, quadratic);
    let high = select(0, 1, quadratic);
    let nodes = select(GAS_NODE, SOLID_NODE, solid);
    var sum = 0.0;
    for (var db = select(0, low, b < DIM); db <= select(0, high, b < DIM); db++) {
        let own_b = means(quadratic, b, db);
        let other_b = means(quadratic, b, db - w[b]);
        for (var dc = select(0, low, c < DIM); dc <= select(0, high, c < DIM); dc++) {
            let product = coefficient_at(push, own_b, means(quadratic, c, dc))
                * coefficient_at(other, other_b, means(quadratic, c, dc - w[c]));
            for (var da = max(-1, w[a] - 1); da <= min(0, w[a]); da++) {
                var d = vec3i(0);
                d[a] = da;
                d[b] = db;
                d[c] = dc;
                if !in_ring(v + d) { continue; }
                let at = slot_of(v + d);
                let counts = !solid || has(cells[at], NODE_SOLID);
                sum += select(0.0, work[part(nodes, at)].w, counts) * product;
            }
        }
    }
    return sum;
}

fn coupling(v: vec3i, w: vec3i, kinds: u32) -> f32 {
    let others = kinds_around_vertex(v + w);
    var sum = 0.0;
    for (var a = 0u; a < DIM; a++) {
        let push = faces_at(kinds, a);
        let other = faces_at(others, a);
        let meet = abs(w[a]) <= 1 && any(push != vec4f(0.0)) && any(other != vec4f(0.0));
        for (var k = 0u; k < when(meet); k++) {
            sum += coupled(v, w, a, push, other, false) + coupled(v, w, a, push, other, true);
        }
    }
    let scale = control.dt * face_area();
    return scale * scale * sum;
}

@compute @workgroup_size(WORKGROUP)
fn surface_rows(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = swept_slot(thread_index(group, lane));
    if slot >= params.slots { return; }
    let row = extra[slot];
    let v = cell_of(slot);
    let first = row * row_length();
    let count = select(0u, block_size(), row < params.surface_rows);
    let kinds = kinds_around_vertex(select(vec3i(0), v, count > 0u));
    var diagonal = 0.0;
    var beside = 0.0;
    for (var k = 0u; k < count; k++) {
        let near = v + block_offset(k);
        let meets = in_ring(near) && extra[slot_of(near)] < params.surface_rows;
        var value = 0.0;
        for (var once = 0u; once < when(meets); once++) { value = coupling(v, near - v, kinds); }
        if k == before() { diagonal = value; } else { beside += abs(value); }
        if k < before() { rows[first + COUPLINGS + k] = value; }
    }
    if count == 0u { return; }
    let inverse = select(0.0, 1.0 / diagonal, diagonal > 0.0);
    rows[first + VERTEX] = bitcast<f32>(slot);
    rows[first + INVERSE] = inverse;
    atomicMax(&control.surface_bound, bitcast<u32>(1.0 + beside * inverse));
}

// The block times one of the directions, at a row.
fn image_at(first: u32, direction_place: u32) -> f32 {
    let v = cell_of(bitcast<u32>(rows[first + VERTEX]));
    let inverse = rows[first + INVERSE];
    var image = select(0.0, rows[first + direction_place] / inverse, inverse > 0.0);
    for (var k = 0u; k < block_size(); k++) {
        let near = v + block_offset(k);
        if k == before() || !in_ring(near) { continue; }
        let row = extra[slot_of(near)];
        if row >= params.surface_rows { continue; }
        let other = row * row_length();
        // the matrix is symmetric: a neighbour behind has the coefficient at the mirrored place
        let value = select(rows[other + COUPLINGS + block_size() - 1u - k], rows[first + COUPLINGS + k], k < before());
        image += value * rows[other + direction_place];
    }
    return image;
}

// One term of the polynomial.
struct Term { number: u32, last: bool, middle: f32, width: f32, last_weight: f32, weight: f32 }

fn term(number: u32) -> Term {
    let high = 1.01 * bitcast<f32>(atomicLoad(&control.surface_bound));
    let low = high / SPREAD;
    let middle = 0.5 * (high + low);
    let width = 0.5 * (high - low);
    var last_weight = 0.0;
    var weight = width / middle;
    for (var k = 0u; k < number; k++) {
        last_weight = weight;
        weight = 1.0 / (2.0 * middle / width - weight);
    }
    return Term(number, number + 1u == turn.count, middle, width, last_weight, weight);
}

// The term at a row; the last one leaves z where the image of the direction was. Returns its share of z . r.
fn add_term(at: u32, t: Term) -> f32 {
    let now = DIRECTION + (t.number & 1u);
    let then = DIRECTION + 1u - (t.number & 1u);
    let first = at * row_length();
    let inverse = rows[first + INVERSE];
    let given = residual[apart_h(at)];
    var step = given * inverse / t.middle;
    var result = 0.0;
    var left = given;
    for (var once = 0u; once < when(t.number > 0u); once++) {
        let old = rows[first + then];
        result = rows[first + RESULT] + old;
        left = rows[first + RESIDUAL] - image_at(first, then);
        step = t.weight * t.last_weight * old + 2.0 * t.weight / t.width * inverse * left;
    }
    rows[first + RESIDUAL] = left;
    rows[first + now] = step;
    rows[first + RESULT] = result;
    if !t.last { return 0.0; }
    product[apart_h(at)] = result + step;
    return (result + step) * given;
}

// One dispatch per term, where there are many rows; the last one adds z . r to the partial sums.
@compute @workgroup_size(WORKGROUP)
fn surface_term(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let now = term(turn.number);
    var share = 0.0;
    for (var at = thread_index(group, lane); at < row_count(); at += striding_threads()) { share += add_term(at, now); }
    if turn.number + 1u < turn.count { return; }
    let sum = workgroup_sum4(lane, vec4f(share, 0.0, 0.0, 0.0));
    if lane == 0u { partials[group_index(group)] += sum; }
}

var<workgroup> shares: array<vec2f, SURFACE_THREADS>;

// Of a lane: r . z of the unknowns outside of the block; and of the reference, or of direction . product.
fn sums_of_others(lane: u32) -> vec2f {
    var sums = vec2f(0.0);
    for (var k = lane; k < pcg.groups_partial; k += SURFACE_THREADS) {
        sums.x += partials[k].x;
        if turn.first == 1u { sums.y += partials[pcg.reference_at + k].y; } else { sums.y += partials[pcg.dots_at + k].x; }
    }
    return sums;
}

// All terms at once, where there are few rows: one workgroup, whose threads see after each barrier what the others have written. Adds
// z . r to the first of the partial sums, or without coarse levels opens or ends the iteration with it. In an iteration it is dispatched
// always, as it holds the table that gates the others.
@compute @workgroup_size(SURFACE_THREADS)
fn surface_terms(@builtin(local_invocation_index) lane: u32) {
    let runs = turn.first == 1u || pcg.outcome == PCG_RUNNING;
    let count = select(0u, row_count(), runs);
    var sums = vec2f(0.0);
    for (var number = 0u; number < turn.count; number++) {
        let now = term(number);
        for (var at = lane; at < count; at += SURFACE_THREADS) { sums.x += add_term(at, now); }
        storageBarrier();
    }
    if turn.ends == 1u { sums += sums_of_others(lane); }
    shares[lane] = sums;
    for (var stride = 1u; stride < SURFACE_THREADS; stride *= 16u) {
        workgroupBarrier();
        let turns = select(0u, 16u, lane % (16u * stride) == 0u);
        for (var k = 1u; k < turns; k++) { shares[lane] += shares[lane + k * stride]; }
    }
    if lane != 0u || !runs { return; }
    let all = shares[0];
    if turn.ends == 0u {
        partials[0].x += all.x;
        return;
    }
    if turn.first == 1u { begin_iteration(all.x, all.x, all.y); } else { end_iteration(all.x, all.x, all.y); }
    decide();
}
