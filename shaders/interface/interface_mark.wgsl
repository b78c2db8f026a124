// interface, second half: kinds, blocked fractions and flags of every slot from the solid volume of the cells, then the list
// of vertices that keep gas, interface and ghost pressure apart, then the list of slots that are not INTERIOR.
#include "shared/index.wgsl"
#include "interface/thin_walls.wgsl"

@group(0) @binding(1) var<storage, read_write> cells: array<u32>;
@group(0) @binding(2) var<storage, read> fill: array<vec2f>;
@group(0) @binding(3) var<storage, read> cell_start: array<u32>;
@group(0) @binding(4) var<storage, read_write> wanted: array<u32>;  // volume of a wall; 1 where a vertex wants P, h, Q apart; then where a slot is mixed
@group(0) @binding(5) var<storage, read> wanted_place: array<u32>;  // scan of wanted
@group(0) @binding(6) var<storage, read_write> extra: array<atomic<u32>>;   // place in the extra block, or NO_EXTRA; then the lists
@group(0) @binding(7) var<storage, read_write> control: Control;
@group(0) @binding(8) var<storage, read_write> edge: array<u32>;    // 1 where a slot is not INTERIOR
@group(0) @binding(9) var<storage, read> edge_place: array<u32>;    // scan of edge

fn full_volume() -> f32 { return params.solid_threshold * cell_volume(); }
fn is_full(slot: u32) -> bool { return fill[slot].x > full_volume(); }
fn fill_at(c: vec3i) -> f32 {
    if !inside(c) { return 0.0; }
    return fill[slot_of(c)].x;
}

// Volume of what closes the cell: its own where it is full, that of a thin wall; else 0.
@compute @workgroup_size(WORKGROUP)
fn interface_walls(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    var volume = 0.0;
    let own = fill[slot].x;
    if own > 0.0 && inside(cell_of(slot)) {
        if is_full(slot) { volume = own; } else { volume = thin_wall(cell_of(slot), slot); }
    }
    wanted[slot] = bitcast<u32>(volume);
}

// Share of a face that the solid of a cell blocks, its volume taken as a ball. [eqs. after section 2.3]
fn blocked_fraction(volume: f32) -> f32 {
    if DIM == 1u { return 1.0; }
    let pi = 3.14159265;
    if DIM == 2u { return min(2.0 * sqrt(volume / pi) / params.spacing, 1.0); }
    return min(pi * pow(3.0 * volume / (4.0 * pi), 2.0 / 3.0) / (params.spacing * params.spacing), 1.0);
}

// Of gas, in scenes whose obstacles cut cells: below what marks a cut cell.
const MOST_BLOCKED = 0.999;

// After `interface_walls`.
@compute @workgroup_size(WORKGROUP)
fn interface_kind(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let c = cell_of(slot);
    let before = kind_of(cells[slot]);
    if !inside(c) || before == WALL {
        cells[slot] = (cells[slot] & 0xffff0000u) | before | (before << 2u);
        return;
    }
    var wall = bitcast<f32>(wanted[slot]);
    if wall == 0.0 && fill[slot].x > WALL_CORNER * full_volume() { wall = corner_of_wall(c, slot); }
    var solid = wall > 0.0;
    if !solid && cell_start[slot + 1u] > cell_start[slot] {
        solid = true;
        for (var k = 0u; k < block_size(); k++) {
            let near = c + block_offset(k);
            if inside(near) && wanted[slot_of(near)] != 0u { solid = false; }
        }
    }
    let kind = select(GAS, SOLID, solid);
    var blocked = blocked_fraction(max(fill[slot].x, wall));
    // A cut cell is marked as what no particle makes of gas [whole_cells.wgsl].
    if CUT && kind == GAS { blocked = select(min(blocked, MOST_BLOCKED), 1.0, is_cut(slot)); }
    cells[slot] = word_with_blocked(kind | (before << 2u), blocked);
}

fn is_cut(slot: u32) -> bool { return CUT && (atomicLoad(&extra[cut_place(slot)]) & ~CUT_NEAR) != 0u; }

// No obstacle in the cell.
fn is_plain(slot: u32) -> bool { return kind_of(cells[slot]) != WALL && !is_cut(slot); }

// Whether no obstacle reaches the cells c + first .. c + last that lie inside.
fn clear_of_obstacles(c: vec3i, first: i32, last: i32) -> bool {
    if !CUT { return true; }
    for (var z = first * reach().z; z <= last * reach().z; z++) {
        for (var y = first * reach().y; y <= last * reach().y; y++) {
            for (var x = first; x <= last; x++) {
                let near = c + vec3i(x, y, z);
                if inside(near) && !is_plain(slot_of(near)) { return false; }
            }
        }
    }
    return true;
}

fn kind_near(c: vec3i) -> u32 { return kind_of(cells[slot_of(nearest_ring(c))]); }

// Flags follow from kinds alone. A flag set here is read by other slots only in later kernels.
@compute @workgroup_size(WORKGROUP)
fn interface_flags(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let c = cell_of(slot);
    if slot == 0u { atomicStore(&extra[part(LENGTHS, LENGTH_FRONTIER)], 0u); }
    if is_alias(c) { return; }
    var flags = 0u;
    var around = 0u;
    var gas = 0u;
    var solid = 0u;
    var closed = 0u;
    var even = true;
    for (var k = 0u; k < block_size(); k++) {
        let near = c + block_offset(k);
        let kind = kind_near(near);
        even = even && kind_near(mirrored(near)) == GAS;
        closed += u32(kind == WALL || kind == GHOST);
        if !inside(near) { continue; }
        around += 1u;
        gas += u32(kind == GAS);
        solid += u32(kind == SOLID);
    }
    if gas > 0u { flags |= NODE_GAS; }
    // A node beyond a side goes with the cell before it.
    let clear = clear_of_obstacles(nearest_inside(c), -1, 1);
    if gas > 0u && gas == around && clear && away_from_seam(c, -1, 2) { flags |= NODE_REGULAR; }
    if even && clear { flags |= NODE_INTERIOR; }
    if solid > 0u { flags |= NODE_SOLID; }
    if solid > 0u && solid == around { flags |= NODE_DEEP; }
    if solid > 0u && closed > 0u { flags |= NODE_FILM; }
    if is_vertex(c) { flags |= vertex_flags(c, slot); } else if SOLIDS { wanted[slot] = 0u; }
    cells[slot] = (cells[slot] & 0xffff000fu) | flags | select(0u, IMAGE, is_image(c));
}

fn vertex_flags(v: vec3i, slot: u32) -> u32 {
    var around = 0u;
    var gas = 0u;
    var solid = 0u;
    for (var k = 0u; k < corner_count(); k++) {
        let c = v - corner_offset(k);
        if !inside(c) { continue; }
        let kind = kind_near(c);
        around += 1u;
        gas += u32(kind == GAS);
        solid += u32(kind == SOLID);
    }
    var flags = 0u;
    if gas > 0u { flags |= VERTEX_GAS; }
    if gas > 0u && gas == around && clear_of_obstacles(v, -2, 1) && away_from_seam(v, -2, 1) { flags |= VERTEX_REGULAR; }
    if solid > 0u { flags |= VERTEX_SOLID; }
    if solid > 0u && solid == around { flags |= VERTEX_DEEP; }
    if SOLIDS { wanted[slot] = u32(gas > 0u && solid > 0u && !shares_pressure(v)); }
    return flags;
}

// One pressure for gas, interface and solid where the body is resolved: the 4^DIM cells around hold enough solid.
fn shares_pressure(v: vec3i) -> bool {
    if INTERFACE == INTERFACE_SINGLE { return true; }
    if INTERFACE == INTERFACE_H { return false; }
    var volume = 0.0;
    for (var z = -2 * reach().z; z <= reach().z; z++) {
        for (var y = -2 * reach().y; y <= reach().y; y++) {
            for (var x = -2; x <= 1; x++) {
                let c = v + vec3i(x, y, z);
                if inside(c) { volume += fill[slot_of(c)].x; }
            }
        }
    }
    // 2 of 16 cells in 2D: half of a sheet one cell thick that passes through the block, in any dimension.
    return volume >= select(select(0.5, 2.0, DIM == 2u), 8.0, DIM == 3u) * cell_volume();
}

// After the scan of `wanted`, of which each thread then makes the next one.
@compute @workgroup_size(WORKGROUP)
fn interface_extra(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    var at = NO_EXTRA;
    if wanted[slot] == 1u { at = wanted_place[slot]; }
    if at != NO_EXTRA && at >= params.extra_capacity {
        atomicMin(&control.fault, (STAGE_INTERFACE << 27u) | slot);
        at = NO_EXTRA;
    }
    atomicStore(&extra[slot], at);
    if slot == params.slots - 1u { control.extra = wanted_place[slot] + wanted[slot]; }
    find_edge(slot);
}

// INTERIOR: every stencil of cell, node and vertex stays deep inside the gas. The nodes of the vertex have only gas around them,
// so do the next ones up: gas in the 4^DIM cells around the vertex and two cells along each axis.
// `wanted` from here on: the slots whose stencils take by far the longest, those between gas and body or obstacle.
fn find_edge(slot: u32) {
    let c = cell_of(slot);
    // Of the six cells around a face only the outermost may be an image.
    var interior = inside(c) && (!MIRRORED || within(c, 2 * reach(), vec3i(params.cells) - 2 * reach())) && away_from_seam(c, -3, 3);
    if interior {
        for (var k = 0u; k < corner_count(); k++) {
            interior = interior && has(cells[slot_of(c - corner_offset(k))], NODE_INTERIOR);
        }
        for (var a = 0u; a < DIM; a++) { interior = interior && has(cells[slot_of(c + axis(a))], NODE_INTERIOR); }
    }
    edge[slot] = u32(!interior && !is_alias(c));
    wanted[slot] = u32(!is_alias(c) && is_mixed(cells[slot]));
}

// At the start, where `interface_extra` does not run.
@compute @workgroup_size(WORKGROUP)
fn interface_edge(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot < params.slots { find_edge(slot); }
}

// What an INTERIOR slot knows of the cells around its faces, see cell.wgsl.
fn reach_of(slot: u32) -> u32 {
    var found = 0u;
    for (var n = 0u; n < DIM; n++) {
        let s = step_of(n);
        let ends = vec2u(cells[slot - min(slot, 3u * s)], cells[min(slot + 3u * s, params.slots - 1u)]);
        for (var up = 0u; up < 2u; up++) {
            let is_end = holds_image(ends[up]);
            var wide = kind_of(ends[up]) == GAS || is_end;
            if CUT { wide = has(cells[slot - (2u - up) * s] & cells[slot + (1u + up) * s], NODE_INTERIOR); }
            found |= (u32(wide) << (WIDE_SHIFT + 2u * n + up)) | (u32(is_end) << (END_SHIFT + 2u * n + up));
        }
    }
    return found;
}

// INTERIOR slots whose node a listed vertex rests on, B1B0: the vertices of a node lie at its own slot and above.
fn on_frontier(slot: u32) -> bool {
    for (var k = 1u; k < corner_count(); k++) {
        let o = vec3u(corner_offset(k));
        if edge[slot + o.x + params.stride.x * (o.y + params.stride.y * o.z)] == 1u { return true; }
    }
    return false;
}

// After the scans of `edge` and `wanted`: the mark and the list of all slots that are not INTERIOR, mixed ones first so that threads that
// run in step have the same to do; the frontier in any order; and the lengths of both.
@compute @workgroup_size(WORKGROUP)
fn interface_list(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let interior = edge[slot] == 0u && !is_alias(cell_of(slot));
    let last = params.slots - 1u;
    if edge[slot] == 1u {
        let first = wanted_place[last] + wanted[last];
        let at = select(first + edge_place[slot] - wanted_place[slot], wanted_place[slot], wanted[slot] == 1u);
        atomicStore(&extra[part(LISTED_SLOTS, at)], slot);
    }
    if interior { cells[slot] = (cells[slot] & 0xffffu) | INTERIOR | reach_of(slot); }
    if interior && !QUADRATIC && on_frontier(slot) {
        let at = atomicAdd(&extra[part(LENGTHS, LENGTH_FRONTIER)], 1u);
        atomicStore(&extra[part(LENGTHS, 0u) - 1u - at], slot);
    }
    if slot == last { atomicStore(&extra[part(LENGTHS, LENGTH_LISTED)], edge_place[slot] + edge[slot]); }
}
