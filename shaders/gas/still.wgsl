// still: where does nothing move? Through the faces of even gas at rest passes zero times something. So the advection leaves out rows (see
// shared/domain.wgsl) that motion does not reach before the solve, with the same bits.
// Sides that let gas through, bodies and seams of periodic axes count as moving; walls and obstacles pass nothing on.
// Reads gas and cells. Writes the rows, in extra.
#include "shared/index.wgsl"
#include "shared/gas_at.wgsl"

@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(4) var<storage, read> energy: array<f32>;
// Rows in which something moves, as bits; then those near them along one line. In a vector of the solve: no word may be a NaN there.
@group(0) @binding(6) var<storage, read_write> busy: array<u32>;
@group(0) @binding(8) var<storage, read_write> extra: array<u32>;

// Slots that motion gets on until the solve: three per stage of the advection (a face has three cells on each side, its carrier reaches
// less far, and the limiter cuts fluxes there but makes none), and one in the carrier of the advected state.
// Test `motion_gets_as_far_as_counted`.
const ADVECTION_SPAN = 7;

fn blocks() -> u32 { return blocks_across() * layers(); }

// All rows of a block, as bits; no other is ever set.
fn all_rows() -> u32 { return (1u << params.march) - 1u; }

// Whether a slot stays as it is: gas at rest whose pressure is that of the slots beside it, on both sides, since one that is left out does
// not look.
fn rests(slot: u32) -> bool {
    let kind = kind_of(cells[slot]);
    if PERIODIC != 0u && is_alias(cell_of(slot)) { return false; }
    if kind != GAS { return kind == WALL; }
    if any(bitcast<vec3u>(conserved[slot].yzw) != vec3u(0u)) { return false; }
    let own = energy[slot];
    let phi = species_now(slot).y;
    for (var n = 0u; n < DIM; n++) {
        let below = slot - min(step_of(n), slot);
        let above = min(slot + step_of(n), params.slots - 1u);
        if energy[below] != own && kind_of(cells[below]) == GAS { return false; }
        if energy[above] != own && kind_of(cells[above]) == GAS { return false; }
        if SPECIES && species_now(below).y != phi && kind_of(cells[below]) == GAS { return false; }
        if SPECIES && species_now(above).y != phi && kind_of(cells[above]) == GAS { return false; }
    }
    return true;
}

@compute @workgroup_size(WORKGROUP)
fn still_find(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let total = striding_threads();
    for (var block = thread_index(group, lane); block < blocks(); block += total) {
        let corner = corner_of(block);
        let width = min(COLUMN_BLOCK, columns() - corner % columns());
        var rows = 0u;
        for (var k = 0u; k < params.march; k++) {
            let first = corner + k * columns();
            let end = min(first + width, params.slots);
            // A loop, which ends for good once something moves: in software both sides of a condition are run.
            for (var slot = first; slot < end; slot++) {
                if !rests(slot) { rows |= 1u << k; break; }
            }
        }
        busy[block] = rows;
    }
}

// Rows near rows in a block `layers` further along the last axis.
fn rows_near(rows: u32, layers: i32) -> u32 {
    var near = 0u;
    for (var k = -ADVECTION_SPAN; k <= ADVECTION_SPAN; k++) {
        let shift = layers * i32(params.march) + k;
        if abs(shift) < 32 { near |= select(rows >> u32(-shift), rows << u32(shift), shift >= 0); }
    }
    return near & all_rows();
}

// Rows of a block near those that move in its line of blocks, here and in other layers. A line runs along x, and on from one end of a row
// of the domain to the next row's beginning.
fn rows_along(block: u32) -> u32 {
    let far = (ADVECTION_SPAN + i32(params.march) - 1) / i32(params.march);
    let beside = select(ADVECTION_SPAN, 0, DIM == 1u);
    let across = i32(blocks_across());
    let layer = i32(block) / across;
    let first = i32(block) % across * i32(COLUMN_BLOCK);
    let low = max(first - beside, 0) / i32(COLUMN_BLOCK);
    let high = min(first + i32(COLUMN_BLOCK) - 1 + beside, i32(columns()) - 1) / i32(COLUMN_BLOCK);
    var rows = 0u;
    for (var k = max(-far, -layer); k <= min(far, i32(layers()) - 1 - layer); k++) {
        var found = 0u;
        for (var at = low; at <= high; at++) { found |= busy[(layer + k) * across + at]; }
        if found != 0u { rows |= rows_near(found, k); }
    }
    return rows;
}

// Rows to be computed, as far as one line tells; in space behind the first part of busy.
@compute @workgroup_size(WORKGROUP)
fn still_along(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let total = striding_threads();
    for (var block = thread_index(group, lane); block < blocks(); block += total) {
        var moving = all_rows();
        if params.still == 1u { moving = rows_along(block); }
        if DIM == 3u { busy[blocks() + block] = moving; } else { extra[params.still_at + block] = moving; }
    }
}

// The same over the lines across which motion reaches a block: in space a layer has many.
fn rows_across(block: u32) -> u32 {
    let across = i32(blocks_across());
    let layer = i32(blocks()) + i32(block) / across * across;
    var rows = 0u;
    for (var line = -ADVECTION_SPAN; line <= ADVECTION_SPAN; line++) {
        let first = i32(block) % across * i32(COLUMN_BLOCK) + line * i32(params.stride.x);
        let low = max(first, 0) / i32(COLUMN_BLOCK);
        let high = min(first + i32(COLUMN_BLOCK) - 1, i32(columns()) - 1);
        for (var at = low; at * i32(COLUMN_BLOCK) <= high; at++) { rows |= busy[layer + at]; }
    }
    return rows;
}

// In space.
@compute @workgroup_size(WORKGROUP)
fn still_spread(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let total = striding_threads();
    for (var block = thread_index(group, lane); block < blocks(); block += total) {
        extra[params.still_at + block] = rows_across(block);
    }
}
