// carrier: which velocity carries the gas through its faces, so that what the solve calls free of divergence compresses nothing?
// The solve sees a velocity averaged over the other axes; with the unaveraged one, motion that it cannot see would compress the
// cells step after step. Reads gas, cells. Writes the carrier (node, in scenes without bodies) of GAS cells: per component the
// velocity averaged with (1, 2, 1) / 4 along every other axis, and in w the sum of its differences across the faces. GHOST slots: by how
// much the velocity of the face, as the last solve saw it, exceeds that of the cell before it.
#include "gas/cut_carrier.wgsl"
#include "shared/open_side.wgsl"
#include "shared/gas_at.wgsl"

override SOURCE: u32;   // 0: the state now, 1: U1, 2: U*
override SOLVED: bool;  // the solve has moved air that was still

@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(4) var<storage, read> work: array<vec4f>;
@group(0) @binding(5) var<storage, read> extra: array<u32>;
@group(0) @binding(6) var<storage, read_write> node: array<vec4f>;
@group(0) @binding(7) var<storage, read> pressure: array<f32>;
@group(0) @binding(8) var<storage, read> energy: array<f32>;

fn source(slot: u32) -> vec4f {
    if SOURCE == 1u { return in_space(work[part(HALFWAY_FLOW, slot)]); }
    if SOURCE == 2u { return in_space(work[part(ADVECTED_FLOW, slot)]); }
    return in_space(conserved[slot]);
}

fn flow_at(slot: u32) -> vec4f { return source(slot); }

// Velocity at an offset from GAS cell c: of the gas there, or of what an inlet prescribes, or of the nearest gas in the block.
fn velocity_at(c: vec3i, offset: vec3i, own: vec3f) -> vec3f {
    let at = c + offset;
    let kind = kind_of(cells[slot_of(at)]);
    if kind == GAS { return velocity_of(source(slot_of(at))); }
    if kind == GHOST {
        let opening = opening_of(cells[slot_of(at)]);
        if prescribes(opening) { return velocity_of(opening.flow); }
    }
    var sum = vec3f(0.0);
    var count = 0.0;
    for (var a = 0u; a < DIM; a++) {
        let nearer = offset - offset[a] * axis(a);
        if all(nearer == offset) || all(nearer == vec3i(0)) { continue; }
        if kind_of(cells[slot_of(c + nearer)]) == GAS {
            sum += velocity_of(source(slot_of(c + nearer)));
            count += 1.0;
        }
    }
    return select(own, sum / max(count, 1.0), count > 0.0);
}

// Share of a neighbour in the average across axis n.
fn across_share(offset: vec3i, n: u32) -> f32 {
    var share = 1.0;
    for (var a = 0u; a < DIM; a++) {
        if a == n { share *= f32(offset[a] == 0); } else { share *= select(0.25, 0.5, offset[a] == 0); }
    }
    return share;
}

fn component(at: u32, n: u32) -> f32 {
    let gas = source(at);
    return gas[n + 1u] / gas.x;
}

fn smooth_along(at: u32, n: u32, step: u32) -> f32 {
    return 0.5 * component(at, n) + 0.25 * (component(at - step, n) + component(at + step, n));
}

// Velocity component n averaged across its axis, deep inside the gas.
fn interior_average(at: u32, n: u32) -> f32 {
    let t = across(n);
    if DIM == 1u { return component(at, n); }
    if DIM == 2u { return smooth_along(at, n, t.x + t.y); }
    return 0.5 * smooth_along(at, n, t.x) + 0.25 * (smooth_along(at - t.y, n, t.x) + smooth_along(at + t.y, n, t.x));
}

// Whether nothing moves near a slot. Clusters of cut cells reach further.
fn stays(slot: u32) -> bool { return !CUT && !SOLVED && is_still(slot); }

// The same of any GAS cell.
fn average(c: vec3i, slot: u32) -> vec3f {
    let own = velocity_of(source(slot));
    var sum = vec3f(0.0);
    for (var k = 0u; k < block_size() / 2u; k++) {
        let offset = block_offset(k);
        let share = vec3f(across_share(offset, 0u), across_share(offset, 1u), across_share(offset, 2u)) * vec3f(reach());
        if all(share == vec3f(0.0)) { continue; }
        sum += share * (velocity_at(c, offset, own) + velocity_at(c, -offset, own));
    }
    return own * vec3f(reach()) / f32(1u << (DIM - 1u)) + sum;
}

// By how much what passed an open face in the last solve is faster than the carrier of the cell before it. The face lies half a cell
// further: without this, gas there would be compressed by half of what the solve sees. 0 before the first solve, and where the
// velocity is prescribed, as faster than sound.
fn surplus_beyond(c: vec3i, slot: u32) -> vec4f {
    let near = nearest_inside(c);
    let away = c - near;
    let face = OpenFace(energy[part(OPEN_VELOCITY, slot)], energy[part(OPEN_PRESSURE, slot)]);
    if dot(away, away) != 1 || kind_of(cells[slot_of(near)]) != GAS || face.reference <= 0.0 { return vec4f(0.0); }
    let n = u32(away.y != 0) + 2u * u32(away.z != 0);
    let predicted = energy[part(PREDICTED_PRESSURE, slot_of(near))];
    let y = admittance_of(opening_of(cells[slot]), face, gamma_at(slot_of(near), predicted), conserved[slot_of(near)].x, predicted);
    let solved = face.velocity + f32(away[n]) * y * (open_part_pressure(near, n, away[n] > 0) - face.reference);
    return select(vec4f(0.0), vec4f(solved - average(near, slot_of(near))[n]), vec4<bool>(along(n), false));
}

fn find_average(slot: u32) {
    let word = cells[slot];
    if is_listed() && SOURCE == 0u && kind_of(word) == GHOST { node[slot] = surplus_beyond(cell_of(slot), slot); }
    if kind_of(word) != GAS { return; }
    if stays(slot) {
        node[slot] = vec4f(0.0);
        return;
    }
    if is_listed() {
        node[slot] = vec4f(average(cell_of(slot), slot), 0.0);
        return;
    }
    var sum = vec3f(0.0);
    for (var n = 0u; n < DIM; n++) { sum[n] = interior_average(slot, n); }
    node[slot] = vec4f(sum, 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn carrier_average(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let own = interior_slot(thread);
    if own < params.slots { find_average(own); }
    on_list = true;
    let next = one_listed(thread);
    if next < params.slots { find_average(next); }
    for (var k = first_listed(thread); k < among(); k = next_listed(k)) { find_average(listed_slot(k)); }
}

// Mass-weighted carrier at the face between GAS cell c and its neighbour.
fn face_mean(c: vec3i, slot: u32, n: u32, up: bool) -> f32 {
    let far = select(c - axis(n), c + axis(n), up);
    let other = slot_of(far);
    let kind = kind_of(cells[other]);
    if kind == WALL { return 0.0; }
    if kind != GAS {
        let opening = opening_of(cells[other]);
        if prescribes(opening) { return velocity_of(opening.flow)[n]; }
        return node[slot][n] + node[other][n];
    }
    if near_obstacle(cells[slot], cells[other]) { return cut_velocity(select(far, c, up), n); }
    let a = source(slot).x;
    let b = source(other).x;
    return (a * node[slot][n] + b * node[other][n]) / (a + b);
}

// The same sum for a cluster, through its open faces, over the gas in it.
fn cut_divergence(slot: u32) -> f32 {
    var sum = 0.0;
    for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) {
        let c = cell_of(at);
        for (var n = 0u; n < DIM; n++) {
            sum += aperture(at, n, true) * face_mean(c, at, n, true) - aperture(at, n, false) * face_mean(c, at, n, false);
        }
    }
    return sum / cluster_share(slot);
}

fn find_divergence(slot: u32) {
    let word = cells[slot];
    if kind_of(word) != GAS || stays(slot) { return; }
    var sum = 0.0;
    if is_listed() {
        let c = cell_of(slot);
        if CUT { sum = cut_divergence(slot); }
        else { for (var n = 0u; n < DIM; n++) { sum += rounded(face_mean(c, slot, n, true) - face_mean(c, slot, n, false)); } }
    } else {
        let density = source(slot).x;
        let own = node[slot];
        for (var n = 0u; n < DIM; n++) {
            let low = source(slot - step_of(n)).x;
            let high = source(slot + step_of(n)).x;
            sum += rounded((density * own[n] + high * node[slot + step_of(n)][n]) / (density + high)
                - (low * node[slot - step_of(n)][n] + density * own[n]) / (low + density));
        }
    }
    node[slot].w = sum;
}

@compute @workgroup_size(WORKGROUP)
fn carrier_divergence(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let own = interior_slot(thread);
    if own < params.slots { find_divergence(own); }
    on_list = true;
    let next = one_listed(thread);
    if next < params.slots { find_divergence(next); }
    for (var k = first_listed(thread); k < among(); k = next_listed(k)) { find_divergence(listed_slot(k)); }
}

// Three cells next to each other along x: density and velocity.
struct Row { density: vec3f, x: vec3f, y: vec3f }

fn row_at(at: u32) -> Row {
    let middle = clamp(at, 1u, params.slots - 2u);
    let a = source(middle - 1u);
    let b = source(middle);
    let c = source(middle + 1u);
    let density = vec3f(a.x, b.x, c.x);
    return Row(density, vec3f(a.y, b.y, c.y) / density, vec3f(a.z, b.z, c.z) / density);
}

fn row_average(r: Row) -> f32 { return 0.5 * r.y.y + 0.25 * (r.y.x + r.y.z); }

fn mean_of(a: f32, u: f32, b: f32, v: f32) -> f32 { return (a * u + b * v) / (a + b); }

// Whether a march writes what stays at a slot: in a kernel that has the list, too, only deep inside the gas.
fn leaves_out(slot: u32) -> bool { return SWEEP != OVER_WHOLE || has(cells[slot], INTERIOR); }

// Average and divergence at once, deep inside the gas in 2D: a column of params.march slots, each row of three read once.
fn march(thread: u32) {
    let s = params.stride.x;
    let first = swept_slot(thread);
    if first >= params.slots { return; }
    let moving = moving_rows(thread, CUT || SOLVED);
    for (var k = 0u; k < params.march; k++) {
        let slot = first + k * s;
        if slot < params.slots && (k < moving.x || k >= moving.y) && leaves_out(slot) { node[slot] = vec4f(0.0); }
    }
    if moving.x == moving.y { return; }
    let begin = first + moving.x * s;
    var low = row_at(max(begin, s) - s);
    var here = row_at(begin);
    for (var slot = begin; slot < min(first + moving.y * s, params.slots); slot += s) {
        let high = row_at(slot + s);
        if has(cells[slot], INTERIOR) {
            let x = 0.5 * here.x + 0.25 * (low.x + high.x);
            let y = row_average(here);
            let d = here.density;
            let along_x = mean_of(d.y, x.y, d.z, x.z) - mean_of(d.x, x.x, d.y, x.y);
            let along_y = mean_of(d.y, y, high.density.y, row_average(high)) - mean_of(low.density.y, row_average(low), d.y, y);
            node[slot] = vec4f(x.y, y, 0.0, rounded(along_x) + rounded(along_y));
        }
        low = here;
        here = high;
    }
}

// The same, on a GPU with the averages of the list.
@compute @workgroup_size(WORKGROUP)
fn carrier_march(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    march(thread);
    on_list = true;
    let next = one_listed(thread);
    if next < params.slots { find_average(next); }
    for (var k = first_listed(thread); k < among(); k = next_listed(k)) { find_average(listed_slot(k)); }
}
