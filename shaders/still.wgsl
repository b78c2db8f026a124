// still: where does nothing move? Through the faces of even gas at rest passes zero times something, and the solve finds nothing to do
// there until its iterations have carried it there from elsewhere. So two kinds of rows (see shared/still.wgsl) are left out, with the
// same bits: those that motion does not reach before the solve, by the advection; and by all, asleep, those that it does not reach in the
// whole step, nor did in the step before, so that every array still holds there what it would get again. The rest is awake. A solve that
// goes on for longer than control.reach iterations wakes everything, in the next step, too.
// Sides that let gas through, bodies and seams of periodic axes count as moving; walls and obstacles pass nothing on.
// Reads gas and cells. Writes busy and, in extra, rows and runs.
#include "shared/index.wgsl"
#include "shared/arrays.wgsl"
#include "shared/cell.wgsl"
#include "shared/control.wgsl"
#include "shared/runs.wgsl"
#include "shared/still.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(4) var<storage, read> energy: array<f32>;
// Rows in which something moves, as bits: now, and from bit 16 on in the step before. Without SLEEPS, that is without the latter, in a
// vector of the solve: no word may be a NaN there.
@group(0) @binding(6) var<storage, read_write> busy: array<u32>;
@group(0) @binding(8) var<storage, read_write> extra: array<u32>;

// Slots that motion gets on until the solve: three per stage of the advection (a face has three cells on each side, its carrier reaches
// less far, and the limiter cuts fluxes there but makes none), and one in the carrier of the advected state.
const ADVECTION_SPAN = 7;
// And in a step: one each for the pressure of the predictor, that of the vertices and the right-hand side; one per iteration but the first;
// one each for the velocity, its carrier and what that brings through a face. Test `motion_gets_as_far_as_counted`.
fn step_span() -> i32 { return ADVECTION_SPAN + 3 + i32(control.reach) - 1 + 3; }

fn blocks() -> u32 { return blocks_across() * layers(); }

// All rows of a block, as bits; no other is ever set.
fn all_rows() -> u32 { return (1u << params.march) - 1u; }

// Whether a slot stays as it is: gas at rest whose pressure is that of the slots beside it, on both sides, since one that sleeps does not look.
fn rests(slot: u32) -> bool {
    let kind = kind_of(cells[slot]);
    if PERIODIC != 0u && is_alias(cell_of(slot)) { return false; }
    if kind != GAS { return kind == WALL; }
    if any(bitcast<vec3u>(conserved[slot].yzw) != vec3u(0u)) { return false; }
    let own = energy[slot];
    for (var n = 0u; n < DIM; n++) {
        let below = slot - min(step_of(n), slot);
        let above = min(slot + step_of(n), params.slots - 1u);
        if energy[below] != own && kind_of(cells[below]) == GAS { return false; }
        if energy[above] != own && kind_of(cells[above]) == GAS { return false; }
    }
    return true;
}

@compute @workgroup_size(WORKGROUP)
fn still_find(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let total = striding_threads();
    for (var block = thread_index(group, lane); block < blocks(); block += total) {
        // What slept stays as it was.
        let awake = row_span(select(block_rows(block) >> 16u, all_rows(), control.woken_before == 1u));
        let corner = march_start(STILL_BLOCK * block);
        let width = min(STILL_BLOCK, columns() - corner % columns());
        var rows = 0u;
        for (var k = awake.x; k < awake.y; k++) {
            let first = corner + k * columns();
            let end = min(first + width, params.slots);
            // A loop, which ends for good once something moves: in software both sides of a condition are run.
            for (var slot = first; slot < end; slot++) {
                if !rests(slot) { rows |= 1u << k; break; }
            }
        }
        busy[block] = select(0u, busy[block] << 16u, SLEEPS) | rows;
    }
}

// Rows that lie within `span` of rows in a block `layers` further along the last axis.
fn rows_near(rows: u32, layers: i32, span: i32) -> u32 {
    var near = 0u;
    for (var k = -span; k <= span; k++) {
        let shift = layers * i32(params.march) + k;
        if abs(shift) < 32 { near |= select(rows >> u32(-shift), rows << u32(shift), shift >= 0); }
    }
    return near & all_rows();
}

// Rows of a block within `span` of those that move in its line of blocks, here and in other layers; with `before` also of those that
// moved in the step before. A line runs along x, and on from one end of a row of the domain to the next row's beginning.
fn rows_along(block: u32, span: i32, before: bool) -> u32 {
    let far = (span + i32(params.march) - 1) / i32(params.march);
    let beside = select(span, 0, DIM == 1u);
    let across = i32(blocks_across());
    let layer = i32(block) / across;
    let first = i32(block) % across * i32(STILL_BLOCK);
    let low = max(first - beside, 0) / i32(STILL_BLOCK);
    let high = min(first + i32(STILL_BLOCK) - 1 + beside, i32(columns()) - 1) / i32(STILL_BLOCK);
    var rows = 0u;
    for (var k = max(-far, -layer); k <= min(far, i32(layers()) - 1 - layer); k++) {
        var found = 0u;
        for (var at = low; at <= high; at++) { found |= busy[(layer + k) * across + at]; }
        found = (found & 0xffffu) | select(0u, found >> 16u, before);
        if found != 0u { rows |= rows_near(found, k, span); }
    }
    return rows;
}

// Behind the first part of busy: rows to be computed by the advection, and from bit 16 on those that are awake, as far as one line tells.
@compute @workgroup_size(WORKGROUP)
fn still_along(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let total = striding_threads();
    for (var block = thread_index(group, lane); block < blocks(); block += total) {
        var moving = all_rows();
        var awake = moving;
        if params.still != STILL_NONE { moving = rows_along(block, ADVECTION_SPAN, false); }
        if params.still == STILL_ASLEEP && control.woken_before == 0u { awake = rows_along(block, step_span(), true); }
        busy[blocks() + block] = moving | select(0u, awake << 16u, SLEEPS);
    }
}

// The same over the lines across which motion reaches a block: in space a layer has many.
fn rows_across(block: u32, span: i32) -> u32 {
    let across = i32(blocks_across());
    let layer = i32(blocks()) + i32(block) / across * across;
    var rows = 0u;
    for (var line = -span; line <= span; line++) {
        let first = i32(block) % across * i32(STILL_BLOCK) + line * i32(params.stride.x);
        let low = max(first, 0) / i32(STILL_BLOCK);
        let high = min(first + i32(STILL_BLOCK) - 1, i32(columns()) - 1);
        for (var at = low; at * i32(STILL_BLOCK) <= high; at++) { rows |= busy[layer + at]; }
    }
    return rows;
}

@compute @workgroup_size(WORKGROUP)
fn still_spread(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let total = striding_threads();
    for (var block = thread_index(group, lane); block < blocks(); block += total) {
        var rows = busy[blocks() + block];
        if DIM == 3u { rows = (rows_across(block, ADVECTION_SPAN) & 0xffffu) | (rows_across(block, step_span()) & 0xffff0000u); }
        extra[params.still_at + block] = select(rows | (all_rows() << 16u), rows, SLEEPS);
    }
}

// The solve goes on for longer than it may while some sleep.
@compute @workgroup_size(WORKGROUP)
fn still_wake(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let total = striding_threads();
    for (var block = thread_index(group, lane); block < blocks(); block += total) { extra[params.still_at + block] |= all_rows() << 16u; }
}

// Runs of the whole grid.
fn runs_in_all() -> u32 {
    if DIM == 1u { return runs_over(params.slots); }
    return params.slots / columns() * blocks_across();
}

// Where the runs that an octet takes in turn lie: block of columns, row in its layer, and layer; and from one to the next. In software a
// division costs more than all else that is done for a run that sleeps.
struct Walk { at: vec3u, step: vec3u, across: u32, columns: u32 }

fn block_row_layer(run: u32, across: u32) -> vec3u {
    let row = run / across;
    return vec3u(run % across, row % params.march, row / params.march);
}

fn walk_from(run: u32, step: u32) -> Walk {
    let across = blocks_across();
    return Walk(block_row_layer(run, across), block_row_layer(step, across), across, columns());
}

fn walk_on(walk: ptr<function, Walk>) {
    var at = (*walk).at + (*walk).step;
    if at.x >= (*walk).across { at = vec3u(at.x - (*walk).across, at.y + 1u, at.z); }
    if at.y >= params.march { at = vec3u(at.x, at.y - params.march, at.z + 1u); }
    (*walk).at = at;
}

// First slot of a run.
fn run_start(run: u32, walk: Walk) -> u32 {
    if DIM == 1u { return OCTET * run; }
    return (walk.at.z * params.march + walk.at.y) * walk.columns + walk.at.x * OCTET;
}

// Slots of a run that are awake, as bits: in 1D some, else all or none.
fn awake_slots(run: u32, walk: Walk) -> u32 {
    if DIM > 1u {
        let awake = (block_rows(walk.at.z * walk.across + walk.at.x) >> (16u + walk.at.y)) & 1u;
        return awake * ((1u << min(OCTET, walk.columns - walk.at.x * OCTET)) - 1u);
    }
    var bits = 0u;
    for (var k = 0u; k < min(OCTET, params.slots - OCTET * run); k++) { bits |= u32(is_awake(OCTET * run + k)) << k; }
    return bits;
}

// The same of a run of the list.
fn awake_listed(run: u32) -> u32 {
    let first = OCTET * run;
    var bits = 0u;
    for (var k = 0u; k < min(OCTET, list_length() - first); k++) { bits |= u32(is_awake(extra[part(LISTED_SLOTS, first + k)])) << k; }
    return bits;
}

fn runs_in_list() -> u32 { return runs_over(list_length()); }

// Every octet counts its runs.
@compute @workgroup_size(WORKGROUP)
fn still_count(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let octet = thread_index(group, lane);
    if octet >= octets() { return; }
    var count = vec2u(0u);
    let all = runs_in_all();
    var walk = walk_from(octet, octets());
    for (var run = octet; run < all; run += octets()) {
        count.x += u32(awake_slots(run, walk) != 0u);
        walk_on(&walk);
    }
    for (var run = octet; run < runs_in_list(); run += octets()) { count.y += u32(awake_listed(run) != 0u); }
    extra[params.runs_at + octet] = count.x;
    extra[params.list_runs_at + octet] = count.y;
}

var<workgroup> shares: array<vec2u, WORKGROUP>;

// One group: where the runs of every octet begin.
@compute @workgroup_size(WORKGROUP)
fn still_places(@builtin(local_invocation_index) lane: u32) {
    let share = (octets() + WORKGROUP - 1u) / WORKGROUP;
    let first = min(lane * share, octets());
    let end = min(first + share, octets());
    var sum = vec2u(0u);
    for (var octet = first; octet < end; octet++) {
        sum += vec2u(extra[params.runs_at + octet], extra[params.list_runs_at + octet]);
    }
    shares[lane] = sum;
    workgroupBarrier();
    var at = vec2u(0u);
    for (var k = 0u; k < lane; k++) { at += shares[k]; }
    for (var octet = first; octet < end; octet++) {
        let count = vec2u(extra[params.runs_at + octet], extra[params.list_runs_at + octet]);
        extra[params.runs_at + octet] = at.x;
        extra[params.list_runs_at + octet] = at.y;
        at += count;
    }
    if lane != WORKGROUP - 1u { return; }
    extra[params.runs_at + octets()] = at.x;
    extra[params.list_runs_at + octets()] = at.y;
    control.runs = at.x;
    control.list_runs = at.y;
}

// Every octet writes its runs.
@compute @workgroup_size(WORKGROUP)
fn still_list(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let octet = thread_index(group, lane);
    if octet >= octets() { return; }
    var at = params.runs_at + octets() + 1u + 2u * extra[params.runs_at + octet];
    let all = runs_in_all();
    var walk = walk_from(octet, octets());
    for (var run = octet; run < all; run += octets()) {
        let awake = awake_slots(run, walk);
        let first = run_start(run, walk);
        walk_on(&walk);
        if awake == 0u { continue; }
        var deep = 0u;
        for (var k = 0u; k < OCTET; k++) { deep |= u32(has(cells[min(first + k, params.slots - 1u)], INTERIOR)) << k; }
        extra[at] = first;
        extra[at + 1u] = (deep & awake) | (awake << 8u);
        at += 2u;
    }
    at = params.list_runs_at + octets() + 1u + extra[params.list_runs_at + octet];
    for (var run = octet; run < runs_in_list(); run += octets()) {
        let awake = awake_listed(run);
        if awake == 0u { continue; }
        extra[at] = awake | (run << 8u);
        at++;
    }
}
