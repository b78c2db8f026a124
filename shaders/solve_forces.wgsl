// coupled_solve, first half of the operator: velocity change per unit time W = M^-1 C x at every node.
// Reads x, cells, masses. Writes work: gas nodes, then solid nodes; w keeps the inverse mass of the gas node.
#include "shared/index.wgsl"
#include "shared/listed.wgsl"
#include "shared/cell.wgsl"
#include "shared/element.wgsl"
#include "shared/system.wgsl"
#include "shared/cut.wgsl"

@group(0) @binding(1) var<storage, read> cells: array<u32>;
@group(0) @binding(2) var<storage, read> extra: array<u32>;
@group(0) @binding(3) var<storage, read> x: array<f32>;
@group(0) @binding(4) var<storage, read_write> work: array<vec4f>;
@group(0) @binding(5) var<storage, read> inertia: array<f32>;

// B2B1 where only gas, or only solid, and the sides of the domain are around: a product of one-dimensional stencils, line by line.
fn wide_force(slot: u32, c: vec3i, solid: bool) -> vec3f {
    let ex = wide_entries_of_node(0u, c.x, solid);
    let ey = wide_entries_of_node(1u, c.y, solid);
    let ez = wide_entries_of_node(2u, c.z, solid);
    var force = vec3f(0.0);
    for (var k = -reach().z; k <= 2 * reach().z; k++) {
        for (var j = -reach().y; j <= 2 * reach().y; j++) {
            let at = u32(i32(slot) + i32(params.stride.x) * (j + i32(params.stride.y) * k));
            let line = vec4f(value_at(at - 1u, solid), value_at(at, solid), value_at(at + 1u, solid), value_at(at + 2u, solid));
            let mean = dot(ex.mean, line);
            force += vec3f(dot(ex.slope, line) * ey.mean[j + 1] * ez.mean[k + 1],
                mean * vec2f(ey.slope[j + 1] * ez.mean[k + 1], ey.mean[j + 1] * ez.slope[k + 1]));
        }
    }
    return force;
}

fn value_at(slot: u32, solid: bool) -> f32 {
    if solid { return x[ghost_index(slot)]; }
    return x[slot];
}

// (mean, slope) of the two vertices along x.
fn narrow_line(at: u32, ex: vec3f) -> vec2f { return vec2f(ex.x * x[at] + ex.y * x[at + 1u], ex.z * (x[at + 1u] - x[at])); }

// (mean, slope along x, slope along y) of a layer.
fn narrow_layer(at: u32, ex: vec3f, ey: vec3f) -> vec3f {
    let low = narrow_line(at, ex);
    if DIM == 1u { return vec3f(low, 0.0); }
    let high = narrow_line(at + params.stride.x, ex);
    return vec3f(ey.x * low + ey.y * high, ey.z * (high.x - low.x));
}

// Only gas and the sides of the domain around the node.
fn regular_force(slot: u32, c: vec3i) -> vec3f {
    if QUADRATIC { return wide_force(slot, c, false); }
    let ex = narrow_entry(0u, c.x);
    let ey = narrow_entry(1u, c.y);
    let low = narrow_layer(slot, ex, ey);
    if DIM < 3u { return vec3f(low.yz, 0.0); }
    let ez = narrow_entry(2u, c.z);
    let high = narrow_layer(slot + params.stride.x * params.stride.y, ex, ey);
    return vec3f(ez.x * low.yz + ez.y * high.yz, ez.z * (high.x - low.x));
}

// One axis of an element as one of its nodes sees it, at the low and the high vertex: mean across, slope along, and the slope that
// acts on h instead of the element's pressure. A closed face adds 1/2 to the slope of its vertices.
struct Pair { mean: vec2f, slope: vec2f, face: vec2f }

fn pair_of(n: u32, kinds: vec2u, offset: vec3i, solid: bool) -> Pair {
    var pair: Pair;
    pair.mean = vec2f(1.0, 0.0);
    if n >= DIM { return pair; }
    let quadratic = solid || QUADRATIC;
    let node = -offset[n];
    let low = closed_share(n, kinds, offset, solid, false);
    let high = closed_share(n, kinds, offset, solid, true);
    pair.mean = vec2f(mean_entry(quadratic, node, false), mean_entry(quadratic, node, true));
    pair.slope = vec2f(gradient_entry(quadratic, node, false), gradient_entry(quadratic, node, true)) + vec2f(low.x, high.x);
    pair.face = vec2f(low.y, high.y);
    return pair;
}

// What a face of the element adds to the slope of its vertices, and the part of that which is h's.
fn closed_share(n: u32, kinds: vec2u, offset: vec3i, solid: bool, up: bool) -> vec2f {
    let beyond = kind_in_block(kinds, select(offset - axis(n), offset + axis(n), up));
    let body = select(beyond == SOLID, beyond == GAS, solid);
    let bare = !solid && (beyond == WALL || beyond == GHOST);
    let share = select(-0.5, 0.5, up) * f32(face_holds(-offset, n, up));
    return select(vec2f(0.0), vec2f(share, select(0.0, share, body)), body || bare);
}

// Unknown of an element at a vertex, and how far h lies above it.
fn unknown_at(v: vec3i, solid: bool) -> vec2f {
    let slot = slot_of(v);
    let h = interface_index(slot);
    let value = x[select(slot, h + params.extra_capacity, solid && h != slot)];
    return vec2f(value, select(0.0, x[h] - value, h != slot));
}

fn mean_of(pair: Pair, low: vec2f, high: vec2f) -> vec2f { return pair.mean.x * low + pair.mean.y * high; }
fn slope_of(pair: Pair, low: vec2f, high: vec2f) -> f32 {
    return dot(pair.slope, vec2f(low.x, high.x)) + dot(pair.face, vec2f(low.y, high.y));
}

// Mean of the unknowns along the axes taken so far, and the slopes of those axes.
struct Part { mean: vec2f, slope: vec2f }

fn line_part(v: vec3i, solid: bool, along_x: Pair) -> Part {
    let low = unknown_at(v, solid);
    let high = unknown_at(v + axis(0u), solid);
    return Part(mean_of(along_x, low, high), vec2f(slope_of(along_x, low, high), 0.0));
}

fn layer_part(v: vec3i, solid: bool, along_x: Pair, along_y: Pair) -> Part {
    let low = line_part(v, solid, along_x);
    if DIM == 1u { return low; }
    let high = line_part(v + axis(1u), solid, along_x);
    return Part(mean_of(along_y, low.mean, high.mean),
        vec2f(dot(along_y.mean, vec2f(low.slope.x, high.slope.x)), slope_of(along_y, low.mean, high.mean)));
}

// One element's force on one of its nodes: a product of the three axes, taken one after the other.
fn element_force(c: vec3i, kinds: vec2u, offset: vec3i, solid: bool) -> vec3f {
    let along_x = pair_of(0u, kinds, offset, solid);
    let along_y = pair_of(1u, kinds, offset, solid);
    let low = layer_part(c + offset, solid, along_x, along_y);
    if DIM < 3u { return vec3f(low.slope, 0.0); }
    let along_z = pair_of(2u, kinds, offset, solid);
    let high = layer_part(c + offset + axis(2u), solid, along_x, along_y);
    return vec3f(along_z.mean.x * low.slope + along_z.mean.y * high.slope, slope_of(along_z, low.mean, high.mean));
}

// Force on the gas of a cluster next to an obstacle. Differences, so that a constant pressure moves nothing.
fn cut_force(slot: u32) -> vec3f {
    var force = vec3f(0.0);
    for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) {
        let c = cell_of(at);
        let own = x[at];
        for (var k = 1u; k < corner_count(); k++) {
            force += (x[slot_of(c + corner_offset(k))] - own) * cut_slope(at, corner_offset(k));
        }
    }
    return force;
}

struct Forces { gas: vec3f, solid: vec3f }

// Sum over the elements around a node between gas and body; `count`: block_size(), or 0 elsewhere.
fn mixed_force(c: vec3i, count: u32) -> Forces {
    var forces: Forces;
    let kinds = kinds_around_node(c);
    for (var k = 0u; k < count; k++) {
        let offset = block_offset(k);
        let kind = kind_in_block(kinds, offset);
        if !inside(c + offset) || (kind != GAS && kind != SOLID) { continue; }
        let solid = kind == SOLID;
        let force = element_force(c, kinds, offset, solid);
        if solid { forces.solid += force; } else { forces.gas += force; }
    }
    return forces;
}

@compute @workgroup_size(WORKGROUP)
fn solve_forces(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                @builtin(local_invocation_index) lane: u32) {
    let slot = frontier_slot(thread_index(group, groups, lane));
    if slot >= params.slots { return; }
    let word = cells[slot];
    let inverse_mass = work[slot].w;
    let c = cell_of(slot);
    if !LISTED {
        if has(word, INTERIOR) { work[slot] = vec4f(regular_force(slot, c) * face_area() * inverse_mass, inverse_mass); }
        return;
    }
    let regular = has(word, NODE_REGULAR);
    if CUT && !regular {
        var force = vec3f(0.0);
        if kind_of(word) == GAS && inside(c) { force = cut_force(slot); }
        work[slot] = vec4f(force * face_area() * inverse_mass, inverse_mass);
        return;
    }
    let deep = SOLIDS && has(word, NODE_DEEP);
    let mixed = has(word, NODE_GAS | NODE_SOLID) && !regular && !deep;
    var forces = mixed_force(c, select(0u, block_size(), mixed));
    for (var turn = 0u; turn < u32(regular); turn++) { forces.gas = regular_force(slot, c); }
    work[slot] = vec4f(forces.gas * face_area() * inverse_mass, inverse_mass);
    if !SOLIDS || !has(word, NODE_SOLID) { return; }
    for (var turn = 0u; turn < u32(deep); turn++) { forces.solid = wide_force(slot, c, true); }
    let inverse = select(1.0 / inertia[slot], 0.0, DRIVEN && has(word, NODE_DRIVEN));
    work[params.slots + slot] = vec4f(forces.solid * face_area() * inverse, inverse);
}
