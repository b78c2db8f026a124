// coupled_solve, preconditioner with two spaces: z = D^-1 r + sum over levels of P D_l^-1 P^T r, for hat functions and for hat
// functions with alternating sign. The residual goes down level by level, the sum of all levels comes up. [Bramble, Pasciak & Xu 1990]
#include "shared/params.wgsl"
#include "shared/thread.wgsl"
#include "shared/reduce4.wgsl"
#include "shared/coarse.wgsl"
#include "shared/pcg_result.wgsl"

@group(0) @binding(1) var<uniform> level: Level;
@group(0) @binding(2) var<storage, read> extra: array<u32>;
@group(0) @binding(3) var<storage, read> inverse_diagonal: array<f32>;
@group(0) @binding(4) var<storage, read> residual: array<f32>;
@group(0) @binding(5) var<storage, read_write> levels: array<vec4f>;    // inverse diagonals of both spaces; residuals, then sums
@group(0) @binding(6) var<storage, read_write> partials: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> direction: array<f32>;
@group(0) @binding(8) var<storage, read> pcg: PcgResult;

fn residual_at(slot: u32) -> f32 { return select(0.0, residual[slot], takes_part(slot)); }

// Three vertices next to each other along x: their sum, and with alternating signs, the middle one positive.
fn finest_row(near: Below, y: u32) -> vec2f {
    let first = slot_of_vertex(vec2u(0u, y));
    let r = near.weight_x * vec3f(residual_at(first + near.x.x), residual_at(first + near.x.y), residual_at(first + near.x.z));
    return vec2f(r.x + r.y + r.z, r.y - r.x - r.z);
}

fn coarse_row(near: Below, y: u32) -> vec2f {
    let first = level.fine_first + level.fine_count.x * y;
    return near.weight_x.x * levels[first + near.x.x].zw + near.weight_x.y * levels[first + near.x.y].zw
        + near.weight_x.z * levels[first + near.x.z].zw;
}

// A coarse vertex lies where i + j of the grid is even.
fn residual_below(near: Below) -> vec2f {
    if FINEST {
        return near.weight_y.y * finest_row(near, near.y.y)
            + vec2f(1.0, -1.0) * (near.weight_y.x * finest_row(near, near.y.x) + near.weight_y.z * finest_row(near, near.y.z));
    }
    return near.weight_y.x * coarse_row(near, near.y.x) + near.weight_y.y * coarse_row(near, near.y.y)
        + near.weight_y.z * coarse_row(near, near.y.z);
}

// P^T r of one level and its share of r . z. FINEST: from the vertices of the grid.
override FINEST: bool;

@compute @workgroup_size(WORKGROUP)
fn coarse_down(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
               @builtin(local_invocation_index) lane: u32) {
    var product = 0.0;
    for (var at = thread_index(group, groups, lane); at < level_length(); at += groups.x * groups.y * WORKGROUP) {
        let r = residual_below(below(coarse_place(at)));
        let inverse = levels[level.first + at].xy;
        levels[level.first + at] = vec4f(inverse, r);
        product += dot(inverse, r * r);
    }
    let sum = workgroup_sum4(lane, vec4f(0.0, 0.0, product, 0.0));
    if lane == 0u { partials[thread_index(group, groups, 0u) / WORKGROUP] += sum; }
}

// What a level gives to the four vertices of the level below at and beyond one of its own: at it, along x, along y, along both.
struct Given { at: vec2f, x: vec2f, y: vec2f, both: vec2f }

fn given_by(place: vec2u) -> Given {
    let near = square(place);
    let own = levels[near.x].zw;
    let x = own + levels[near.y].zw;
    let y = own + levels[near.z].zw;
    return Given(own, 0.5 * x, 0.5 * y, 0.25 * (x + y - own + levels[near.w].zw));
}

fn add_to_level(v: vec2u, more: vec2f) {
    if any(v >= level.fine_count) { return; }
    let at = level.fine_first + v.x + level.fine_count.x * v.y;
    let own = levels[at];
    levels[at] = vec4f(own.xy, own.xy * own.zw + more);
}

// Up: each level becomes D_l^-1 r and what the one above it has, unless that is not in use. `level` is the one above.
@compute @workgroup_size(WORKGROUP)
fn coarse_up(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
             @builtin(local_invocation_index) lane: u32) {
    let higher = level.number <= pcg.levels;
    for (var at = thread_index(group, groups, lane); at < level_length(); at += groups.x * groups.y * WORKGROUP) {
        let place = coarse_place(at);
        var given: Given;
        if higher { given = given_by(place); }
        let v = 2u * place;
        add_to_level(v, given.at);
        add_to_level(v + vec2u(1u, 0u), given.x);
        add_to_level(v + vec2u(0u, 1u), given.y);
        add_to_level(v + vec2u(1u, 1u), given.both);
    }
}

fn add_to_direction(v: vec2u, more: f32) {
    if any(v >= level.fine_count) { return; }
    let slot = slot_of_vertex(v);
    if takes_part(slot) { direction[slot] += more; }
}

// The new direction's share of all levels.
@compute @workgroup_size(WORKGROUP)
fn coarse_direction(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                    @builtin(local_invocation_index) lane: u32) {
    for (var at = thread_index(group, groups, lane); at < level_length(); at += groups.x * groups.y * WORKGROUP) {
        let place = coarse_place(at);
        let given = given_by(place);
        let v = 2u * place;
        add_to_direction(v, given.at.x + given.at.y);
        add_to_direction(v + vec2u(1u, 0u), given.x.x - given.x.y);
        add_to_direction(v + vec2u(0u, 1u), given.y.x - given.y.y);
        add_to_direction(v + vec2u(1u, 1u), given.both.x + given.both.y);
    }
}
