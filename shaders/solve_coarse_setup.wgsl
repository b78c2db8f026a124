// coupled_solve, preparation of the preconditioner with two spaces: whether it pays in this step, how many levels it takes, and the
// diagonals of the levels. With A 1 = m (and its twin with alternating signs) the energy of a function f is
//   sum of m f^2 + sum over pairs of -A_vw (f_v - f_w)^2,
// so a wide hat function has sum of 4/9 of the hat's m, and of the stiffness that the diagonal tells.
#include "shared/index.wgsl"
#include "shared/cell.wgsl"
#include "shared/extents.wgsl"
#include "shared/control.wgsl"
#include "shared/reduce4.wgsl"
#include "shared/coarse.wgsl"
#include "shared/pcg_result.wgsl"

@group(0) @binding(1) var<uniform> level: Level;
@group(0) @binding(2) var<storage, read> extra: array<u32>;
@group(0) @binding(3) var<storage, read> inverse_diagonal: array<f32>;
@group(0) @binding(4) var<storage, read> cells: array<u32>;
@group(0) @binding(5) var<storage, read_write> levels: array<vec4f>;    // of both spaces: sums of m, of stiffness; then inverse diagonals
@group(0) @binding(6) var<storage, read_write> partials: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> direction: array<f32>;
@group(0) @binding(8) var<storage, read> stiffness: array<f32>;
@group(0) @binding(10) var<storage, read> solution: array<f32>;         // row sums at listed slots
@group(0) @binding(11) var<storage, read_write> pcg: PcgResult;
@group(0) @binding(12) var<storage, read_write> coarse_extents: array<vec4u>;
@group(0) @binding(13) var<storage, read_write> control: Control;

override SIGNED: bool;          // of the two spaces
override PHASE_AT: u32;         // extents of the phase
override FINEST: bool;
override LEVELS: u32;           // that there are
override LEAST_COURANT: f32;    // of the gas, below which the diagonal alone is the preconditioner

// Stiffness of a vertex, of a wide hat function and of a signed one, per unit of inverse mass around.
const NARROW = vec3f(2.0, 2.6666667, 2.6666667);
const WIDE = vec3f(0.4707, 2.6666667, 0.1317333);
// Levels follow until the Courant number of the next one is below this.
const SMOOTH_COURANT = 0.7;

fn stencil(word: u32) -> vec3f {
    let deep = SOLIDS && has(word, VERTEX_SOLID) && !has(word, VERTEX_GAS);
    return select(NARROW, WIDE, vec3<bool>(QUADRATIC || deep));
}

// Stiffness of a vertex' own unknown.
fn push_at(slot: u32) -> f32 { return max(1.0 / inverse_diagonal[slot] - stiffness[slot], 0.0); }

// Largest squares of the Courant number (dt / dx)^2 / (S^-1 M): deep in the gas; anywhere, bodies included.
@compute @workgroup_size(WORKGROUP)
fn coarse_measure(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                  @builtin(local_invocation_index) lane: u32) {
    var largest = vec4f(0.0);
    for (var slot = thread_index(group, groups, lane); slot < params.slots; slot += groups.x * groups.y * WORKGROUP) {
        if !(inverse_diagonal[slot] > 0.0 && stiffness[slot] > 0.0) { continue; }
        let word = cells[slot];
        let square = push_at(slot) / (stiffness[slot] * stencil(word).x);
        largest = max(largest, vec4f(select(0.0, square, has(word, INTERIOR)), square, 0.0, 0.0));
    }
    let part = workgroup_max4(lane, largest);
    if lane == 0u { partials[thread_index(group, groups, 0u) / WORKGROUP] = part; }
}

// One workgroup, dispatched always: opens the table of the preparation, or closes it outside of the phase.
@compute @workgroup_size(WORKGROUP)
fn coarse_choose(@builtin(local_invocation_index) lane: u32) {
    let on = extents[PHASE_AT + EXTENT_SINGLE].x > 0u;
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
    let nodes = select(vec4u(pcg.frontier_wide, pcg.frontier_high, 1u, 0u), vec4u(pcg.groups_wide, pcg.groups_high, 1u, 0u), QUADRATIC);
    coarse_extents[0] = nodes * keep;
    coarse_extents[1] = vec4u(pcg.listed_wide, pcg.listed_high, 1u, 0u) * keep;
    var vertices = params.cells.xy + vec2u(1u);
    for (var k = 0u; k < PCG_LEVELS; k++) {
        let wanted = (vertices.x * vertices.y + WORKGROUP - 1u) / WORKGROUP;
        let number = min(wanted, pcg.groups_partial) * u32(count > 0u && k <= count);
        coarse_extents[2u + k] = vec4u(number, 1u, 1u, 0u);
        if on { pcg.level_groups[k] = number; }
        vertices = vertices / 2u + vec2u(1u);
    }
}

// The function whose row sums are asked for: 1 or alternating, in what takes part.
@compute @workgroup_size(WORKGROUP)
fn coarse_ones(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
               @builtin(local_invocation_index) lane: u32) {
    let unknowns = params.slots + 2u * params.extra_capacity;
    for (var i = thread_index(group, groups, lane); i < unknowns; i += groups.x * groups.y * WORKGROUP) {
        var value = 0.0;
        if i < params.slots && takes_part(i) { value = select(1.0, alternating(vec2u(cell_of(i).xy)), SIGNED); }
        direction[i] = value;
    }
}

// Row sum and stiffness of a vertex of the grid.
fn finest_sums(v: vec2u) -> vec2f {
    let slot = slot_of_vertex(v);
    if !takes_part(slot) { return vec2f(0.0); }
    let word = cells[slot];
    let stencil = stencil(word);
    var own = stiffness[slot];
    if !has(word, INTERIOR) { own = solution[slot] * select(1.0, alternating(v), SIGNED); }
    return vec2f(own, push_at(slot) * select(stencil.y, stencil.z, SIGNED) / stencil.x);
}

fn sums_at(v: vec2u) -> vec4f {
    if FINEST { return vec4f(finest_sums(v), 0.0, 0.0); }
    return levels[level.fine_first + v.x + level.fine_count.x * v.y];
}

fn row_of_sums(near: Below, y: u32) -> vec4f {
    return near.weight_x.x * sums_at(vec2u(near.x.x, y)) + near.weight_x.y * sums_at(vec2u(near.x.y, y))
        + near.weight_x.z * sums_at(vec2u(near.x.z, y));
}

// P^T of row sums and stiffness; a hat function twice as wide has slopes half as steep.
@compute @workgroup_size(WORKGROUP)
fn coarse_sums(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
               @builtin(local_invocation_index) lane: u32) {
    for (var at = thread_index(group, groups, lane); at < level_length(); at += groups.x * groups.y * WORKGROUP) {
        let near = below(coarse_place(at));
        let sum = vec4f(1.0, 0.25, 1.0, 0.25) * (near.weight_y.x * row_of_sums(near, near.y.x)
            + near.weight_y.y * row_of_sums(near, near.y.y) + near.weight_y.z * row_of_sums(near, near.y.z));
        if FINEST && SIGNED { levels[level.first + at] = vec4f(levels[level.first + at].xy, sum.xy); }
        else { levels[level.first + at] = sum; }
    }
}

fn inverse_of(sums: vec2f) -> f32 {
    let diagonal = max(4.0 / 9.0 * sums.x + sums.y, 0.25 * sums.y);
    return select(0.0, 1.0 / diagonal, diagonal > 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn coarse_invert(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                 @builtin(local_invocation_index) lane: u32) {
    for (var at = thread_index(group, groups, lane); at < level_length(); at += groups.x * groups.y * WORKGROUP) {
        let sums = levels[level.first + at];
        levels[level.first + at] = vec4f(inverse_of(sums.xy), inverse_of(sums.zw), 0.0, 0.0);
    }
}
