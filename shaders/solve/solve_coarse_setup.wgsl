// coupled_solve, preparation of the preconditioner with coarse spaces: whether it pays in this step, how many levels it takes, and the
// diagonals of the levels. With A 1 = m (and its twins with alternating signs) the energy of a function f is
//   sum of m f^2 + sum over pairs of -A_vw (f_v - f_w)^2,
// so a wide hat function has the sum of 4/9 (two axes) or 8/27 (three) of the hat's m, and of the stiffness that the diagonal tells.
// In 3D a function that alternates along two axes lies in one layer of the third; the sum of squares of the means along that axis is
// the share of m - S^-1, and of the stiffness, that such a layer has of functions that do not change along it.
#include "shared/extents.wgsl"
#include "shared/reduce.wgsl"
#include "solve/coarse.wgsl"
#include "shared/pcg.wgsl"

@group(0) @binding(1) var<uniform> level: Level;
@group(0) @binding(2) var<storage, read> extra: array<u32>;
@group(0) @binding(3) var<storage, read> inverse_diagonal: array<f32>;
@group(0) @binding(4) var<storage, read> cells: array<u32>;
@group(0) @binding(5) var<storage, read_write> levels: array<vec2f>;    // sums of m, of stiffness; then inverse diagonals
@group(0) @binding(6) var<storage, read_write> partials: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> direction: array<f32>;
@group(0) @binding(8) var<storage, read> stiffness: array<f32>;
@group(0) @binding(10) var<storage, read> solution: array<f32>;         // row sums at listed slots
@group(0) @binding(12) var<storage, read_write> coarse_extents: array<vec4u>;
@group(0) @binding(13) var<storage, read_write> control: Control;

override SPACE: u32;            // whose sums are asked for
override PHASE_AT: u32;         // extents of the phase
override FINEST: bool;
override LEVELS: u32;           // that there are
override LEAST_COURANT: f32;    // of the gas, below which the diagonal alone is the preconditioner

// Sums of squares of an axis' coefficients, slopes and means, and the stiffness of a long wave with alternating sign in units of that
// of the wave itself.
const NARROW = vec3f(2.0, 0.5, 1.0);
const WIDE = vec3f(0.5555556, 0.4236111, 0.0493827);
// Levels follow until the Courant number of the next one is below this.
const SMOOTH_COURANT = 0.7;

fn stencil(word: u32) -> vec3f {
    let deep = SOLIDS && has(word, VERTEX_SOLID) && !has(word, VERTEX_GAS);
    return select(NARROW, WIDE, vec3<bool>(QUADRATIC || deep));
}

// Per unit of inverse mass around: stiffness of a vertex.
fn own_stiffness(stencil: vec3f) -> f32 { return f32(DIM) * stencil.x * select(stencil.y, stencil.y * stencil.y, DIM == 3u); }

// Share that one layer has of a function along a third axis.
fn layer_share(stencil: vec3f) -> f32 { return select(1.0, stencil.y, SPACE != 0u && DIM == 3u); }

// Per unit of inverse mass around: stiffness of a wide hat function, over its sum and the square of its slope.
fn hat_stiffness(stencil: vec3f) -> f32 { return 8.0 / 3.0 * select(1.0, stencil.z * layer_share(stencil), SPACE != 0u); }

// -1 where a function of the space turns its sign.
fn sign_at(v: vec3u) -> f32 {
    if SPACE == 0u { return 1.0; }
    let along = level.own[SPACE].halves * v;
    return select(1.0, -1.0, ((along.x + along.y + along.z) & 1u) == 1u);
}

// Stiffness of a vertex' own unknown.
fn push_at(slot: u32) -> f32 { return max(1.0 / inverse_diagonal[slot] - stiffness[slot], 0.0); }

// Largest squares of the Courant number (dt / dx)^2 / (S^-1 M): deep in the gas; anywhere, bodies included.
@compute @workgroup_size(WORKGROUP)
fn coarse_measure(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var largest = vec4f(0.0);
    for (var slot = thread_index(group, lane); slot < params.slots; slot += striding_threads()) {
        if !(inverse_diagonal[slot] > 0.0 && stiffness[slot] > 0.0) { continue; }
        let word = cells[slot];
        let square = push_at(slot) / (stiffness[slot] * own_stiffness(stencil(word)));
        largest = max(largest, vec4f(select(0.0, square, has(word, INTERIOR)), square, 0.0, 0.0));
    }
    let part = workgroup_max4(lane, largest);
    if lane == 0u { partials[group_index(group)] = part; }
}

// One workgroup, dispatched always: opens the table of the preparation, or closes it outside of the phase.
@compute @workgroup_size(WORKGROUP)
fn coarse_choose(@builtin(local_invocation_index) lane: u32) {
    let on = extents[PHASE_AT + OVER_SINGLE].x > 0u;
    var bound = vec4f(0.0);
    for (var k = lane; k < pcg.groups_partial; k += WORKGROUP) { bound = max(bound, partials[k]); }
    let courant = sqrt(workgroup_max4(lane, bound).xy);
    if lane != 0u { return; }
    var count = 0u;
    if on && courant.x >= LEAST_COURANT {
        for (var left = courant.y; count < LEVELS && left >= SMOOTH_COURANT; count++) { left *= 0.5; }
    }
    if on { pcg.levels = count; }
    let keep = u32(count > 0u);
    coarse_extents[0] = vec4u(pcg.groups_wide, pcg.groups_high, 1u, 0u) * keep;
    coarse_extents[1] = vec4u(pcg.near_wide, pcg.near_high, 1u, 0u) * keep;
    coarse_extents[2] = vec4u(pcg.groups_partial, 1u, 1u, 0u) * keep;
    let all = params.cells + vec3u(reach());
    var half = all;
    for (var k = 0u; k < PCG_LEVELS; k++) {
        let wanted = groups_of(entries(all, half));
        let number = min(wanted, pcg.groups_partial) * u32(count > 0u && k <= count);
        coarse_extents[3u + k] = vec4u(number, 1u, 1u, 0u);
        if on { pcg.level_groups[k] = number; }
        half = half / 2u + vec3u(1u);
    }
}

// Entries of a level about, from the number of vertices along the axes and that of the hat functions.
fn entries(all: vec3u, hats: vec3u) -> u32 {
    if DIM < 3u { return hats.x * hats.y; }
    return hats.x * hats.y * all.z + hats.y * hats.z * all.x + hats.x * hats.z * all.y;
}

// The function whose row sums are asked for: 1 or alternating, in what takes part.
@compute @workgroup_size(WORKGROUP)
fn coarse_ones(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    for (var i = thread_index(group, lane); i < unknowns(); i += striding_threads()) {
        var value = 0.0;
        if i < params.slots && takes_part(i) { value = sign_at(vec3u(cell_of(i))); }
        direction[i] = value;
    }
}

// Row sum and stiffness of a vertex of the grid.
fn finest_sums(v: vec3u) -> vec2f {
    let slot = slot_of_vertex(v);
    if !takes_part(slot) { return vec2f(0.0); }
    let word = cells[slot];
    let stencil = stencil(word);
    var own = stiffness[slot];
    if !has(word, INTERIOR) { own += layer_share(stencil) * (solution[slot] * sign_at(v) - own); }
    return vec2f(own, push_at(slot) * hat_stiffness(stencil) / own_stiffness(stencil));
}

fn value_below(fine: Grid, v: vec3u) -> vec2f {
    if FINEST { return finest_sums(v); }
    return levels[place_of(fine, v)];
}

// P^T of row sums and stiffness; a hat function twice as wide has slopes half as steep.
fn put_sums(space: u32, place: u32) {
    let own = level.own[space];
    levels[place] = vec2f(1.0, 0.25) * gathered(own, level.below[space], vertex_of(own, place - own.first));
}

// On the first level, of one space.
@compute @workgroup_size(WORKGROUP)
fn coarse_first_sums(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let own = level.own[SPACE];
    let end = own.count.x * own.count.y * own.count.z;
    for (var at = thread_index(group, lane); at < end; at += level_threads(1u)) { put_sums(SPACE, own.first + at); }
}

// On another one, of all spaces.
@compute @workgroup_size(WORKGROUP)
fn coarse_sums(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    for (var at = thread_index(group, lane); at < level.length; at += level_threads(level.number)) {
        let place = level.own[0].first + at;
        put_sums(space_of(place), place);
    }
}

// In 3D the three alternating spaces have much in common: a weight below 1 takes fewer iterations (measured: 22 instead of 24 in gas, 41
// instead of 55 with a stiff block; from 0.3 to 0.5 it hardly matters).
const COMMON_WEIGHT = 0.4;

fn inverse_of(sums: vec2f, space: u32) -> f32 {
    let lines = DIM == 3u && space != 0u;
    let square = select(4.0 / 9.0, 8.0 / 27.0, DIM == 3u && space == 0u);
    let diagonal = max(square * sums.x + sums.y, 0.25 * sums.y);
    return select(0.0, select(1.0, COMMON_WEIGHT, lines) / diagonal, diagonal > 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn coarse_invert(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    for (var at = thread_index(group, lane); at < level.length; at += level_threads(level.number)) {
        let place = level.own[0].first + at;
        levels[place] = vec2f(inverse_of(levels[place], space_of(place)), 0.0);
    }
}
