// coupled_solve, preconditioner with coarse spaces: z = D^-1 r + sum over spaces and levels of P D_l^-1 P^T r, for hat functions and
// for hat functions with alternating sign, see coarse.wgsl. The residual goes down level by level, the sum of all levels comes
// up. [Bramble, Pasciak & Xu 1990] Between the grid and its first coarse level one thread takes a block of 2^DIM vertices, with all
// spaces at once: they need the same neighbours.
#include "shared/state.wgsl"
#include "shared/reduce.wgsl"
#include "solve/coarse.wgsl"
#include "shared/pcg.wgsl"

@group(0) @binding(1) var<uniform> level: Level;
@group(0) @binding(2) var<storage, read> extra: array<u32>;
@group(0) @binding(3) var<storage, read> inverse_diagonal: array<f32>;
@group(0) @binding(4) var<storage, read> residual: array<f32>;
@group(0) @binding(5) var<storage, read_write> levels: array<vec2f>;    // inverse diagonal; residual, then sum
@group(0) @binding(6) var<storage, read_write> partials: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> direction: array<f32>;

// Unknowns that are not used have no residual.
fn residual_at(slot: u32) -> f32 {
    if SOLIDS { if extra[slot] != NO_EXTRA { return 0.0; } }
    return residual[slot];
}

// P^T r of a block: hat functions; those that alternate, at the lower and the upper of the block's two layers.
struct Block { plain: f32, xy: vec2f, yz: vec2f, xz: vec2f }

// A coarse vertex lies where i, j and k of the grid are even.
fn block_residual(v: vec3u) -> Block {
    let grid = level.own[0];
    let fine = level.below[0];
    let x = below(grid, fine, v, 0u);
    let y = below(grid, fine, v, 1u);
    let z = below(grid, fine, v, 2u);
    let turns = vec3f(-1.0, 1.0, -1.0);
    var block: Block;
    for (var k = select(1u, 0u, DIM > 2u); k <= select(1u, 2u, DIM > 2u); k++) {
        for (var j = 0u; j < 3u; j++) {
            let first = slot_of_vertex(vec3u(0u, y.at[j], z.at[k]));
            let r = vec3f(residual_at(first + x.at.x), residual_at(first + x.at.y), residual_at(first + x.at.z));
            let weighed = x.weight * r;
            let both = y.weight[j] * z.weight[k];
            let turned = weighed.y - weighed.x - weighed.z;
            block.plain += both * (weighed.x + weighed.y + weighed.z);
            block.xy += vec2f(vec2u(k) == vec2u(1u, 2u)) * (y.weight[j] * turns[j] * turned);
            block.yz += (both * turns[j] * turns[k]) * r.yz;
            block.xz += vec2f(vec2u(j) == vec2u(1u, 2u)) * (z.weight[k] * turns[k] * turned);
        }
    }
    return block;
}

// Leaves the residual of an entry; its share of r . z.
fn put_residual(place: u32, r: f32) -> f32 {
    let inverse = levels[place].x;
    levels[place] = vec2f(inverse, r);
    return inverse * r * r;
}

// The same for a space's two layers of a block, as far as they lie inside.
fn put_layers(grid: Grid, v: vec3u, a: u32, r: vec2f) -> f32 {
    var at = v;
    at[a] = 2u * v[a];
    var product = put_residual(place_of(grid, at), r.x);
    at[a] += 1u;
    if at[a] < grid.count[a] { product += put_residual(place_of(grid, at), r.y); }
    return product;
}

fn block_count() -> u32 {
    let count = level.own[0].count;
    return count.x * count.y * count.z;
}

// P^T r of the first level.
@compute @workgroup_size(WORKGROUP)
fn coarse_residual(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var product = 0.0;
    for (var at = thread_index(group, lane); at < block_count(); at += level_threads(level.number)) {
        let v = vertex_of(level.own[0], at);
        let block = block_residual(v);
        product += put_residual(level.own[0].first + at, block.plain) + put_layers(level.own[1], v, 2u, block.xy);
        if DIM > 2u { product += put_layers(level.own[2], v, 0u, block.yz) + put_layers(level.own[3], v, 1u, block.xz); }
    }
    let sum = workgroup_sum4(lane, vec4f(0.0, 0.0, product, 0.0));
    if lane == 0u { partials[group_index(group)] += sum; }
}

fn value_below(fine: Grid, v: vec3u) -> vec2f { return levels[place_of(fine, v)]; }

// P^T r of another level.
@compute @workgroup_size(WORKGROUP)
fn coarse_down(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var product = 0.0;
    for (var at = thread_index(group, lane); at < level.length; at += level_threads(level.number)) {
        let place = level.own[0].first + at;
        let space = space_of(place);
        let own = level.own[space];
        product += put_residual(place, gathered(own, level.below[space], vertex_of(own, place - own.first)).y);
    }
    let sum = workgroup_sum4(lane, vec4f(0.0, 0.0, product, 0.0));
    if lane == 0u { partials[group_index(group)] += sum; }
}

// The coarse vertex beyond a place along every axis.
fn beyond(grid: Grid, v: vec3u) -> vec3u { return select(v + vec3u(1u), vec3u(0u), v + vec3u(1u) >= grid.count); }

const X = vec3u(1u, 0u, 0u);
const Y = vec3u(0u, 1u, 0u);
const Z = vec3u(0u, 0u, 1u);

fn moved(v: vec3u, far: vec3u, along: vec3u) -> vec3u { return select(v, far, along == vec3u(1u)); }

// What a space gives to the four vertices of the level below at and beyond one of its own: at it, along a, along b, along both.
fn square(grid: Grid, v: vec3u, a: vec3u, b: vec3u, sign: f32) -> vec4f {
    let far = beyond(grid, v);
    let own = levels[place_of(grid, v)].y;
    let x = own + levels[place_of(grid, moved(v, far, a))].y;
    let y = own + levels[place_of(grid, moved(v, far, b))].y;
    return vec4f(own, 0.5 * sign * x, 0.5 * sign * y, 0.25 * (x + y - own + levels[place_of(grid, moved(v, far, a + b))].y));
}

fn add_to_level(grid: Grid, v: vec3u, more: f32) {
    if any(v >= grid.count) { return; }
    let at = place_of(grid, v);
    let own = levels[at];
    levels[at] = vec2f(own.x, own.x * own.y + more);
}

fn add_square(grid: Grid, v: vec3u, a: vec3u, b: vec3u, more: vec4f) {
    add_to_level(grid, v, more.x);
    add_to_level(grid, v + a, more.y);
    add_to_level(grid, v + b, more.z);
    add_to_level(grid, v + a + b, more.w);
}

// Up: each level becomes D_l^-1 r and what the one above it has, unless that is not in use. `level` is the one above.
@compute @workgroup_size(WORKGROUP)
fn coarse_up(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let keep = f32(level.number <= pcg.levels);
    for (var at = thread_index(group, lane); at < level.length; at += level_threads(level.number - 1u)) {
        let place = level.own[0].first + at;
        let space = space_of(place);
        let grid = level.own[space];
        let fine = level.below[space];
        let v = vertex_of(grid, place - grid.first);
        let first = v * (vec3u(1u) + grid.halves);
        let a = select(Y, X, grid.halves.x == 1u);
        let b = select(Z, Y, grid.halves.x * grid.halves.y == 1u);
        let lower = keep * square(grid, v, a, b, 1.0);
        add_square(fine, first, a, b, lower);
        for (var turn = 0u; turn < when(DIM > 2u && space == 0u); turn++) {
            let upper = keep * square(grid, moved(v, beyond(grid, v), Z), a, b, 1.0);
            add_square(fine, first + Z, a, b, 0.5 * (lower + upper));
        }
    }
}

// What a space that alternates along a and b gives to the vertices of a block, in the upper or the lower of its layers along the third axis.
fn layer(space: u32, v: vec3u, a: vec3u, b: vec3u, upper: u32) -> vec4f {
    let grid = level.own[space];
    return square(grid, moved(v, min(2u * v + upper, grid.count - 1u), vec3u(1u) - a - b), a, b, -1.0);
}

fn add_to_direction(v: vec3u, more: f32) {
    if any(v >= level.below[0].count) { return; }
    let slot = slot_of_vertex(v);
    if takes_part(slot) { direction[slot] += more; }
}

fn add_layer(v: vec3u, more: vec4f) {
    add_to_direction(v, more.x);
    add_to_direction(v + X, more.y);
    add_to_direction(v + Y, more.z);
    add_to_direction(v + X + Y, more.w);
}

// The new direction's share of all levels.
@compute @workgroup_size(WORKGROUP)
fn coarse_direction(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    for (var at = thread_index(group, lane); at < block_count(); at += level_threads(level.number - 1u)) {
        let v = vertex_of(level.own[0], at);
        var lower = square(level.own[0], v, X, Y, 1.0);
        var upper = lower;
        if DIM > 2u {
            upper = 0.5 * (lower + square(level.own[0], moved(v, beyond(level.own[0], v), Z), X, Y, 1.0));
            upper += layer(1u, v, X, Y, 1u);
            let yz = array(layer(2u, v, Y, Z, 0u), layer(2u, v, Y, Z, 1u));
            let xz = array(layer(3u, v, X, Z, 0u), layer(3u, v, X, Z, 1u));
            lower += vec4f(yz[0].x, yz[1].x, yz[0].y, yz[1].y) + vec4f(xz[0].xy, xz[1].xy);
            upper += vec4f(yz[0].z, yz[1].z, yz[0].w, yz[1].w) + vec4f(xz[0].zw, xz[1].zw);
        }
        lower += layer(1u, v, X, Y, 0u);
        add_layer(2u * v, lower);
        if DIM > 2u { add_layer(2u * v + Z, upper); }
    }
}
