// The particles around a point: lists of the particles in cubes of a grid that repeats in space, so that it needs no bounds.
// find_reach: reads balls; raises near_reach to the bits of the largest reach.
// tally_near: reads balls, near_reach; counts near_count. Its scan is near_start.
// place_near: reads balls, near_reach, near_start; counts near_count down; writes near_order, the particles cube by cube.
// gather_near: reads balls, near_reach, near_start, near_order; writes, cube by cube in the order of the particles, near_balls: the place, then
// the reach and half of the distance of neighbours over the largest reach; and near_names: the colour and the particle.
// mark_near: reads near_balls; near_marks is near_start, and behind it the largest reach in and around each cube, over the largest of all in
// 65535 parts.

#include "picture/view.wgsl"
#include "picture/near_cubes.wgsl"
#include "picture/growth.wgsl"
#include "picture/sheets.wgsl"

@group(0) @binding(1) var<storage, read> balls: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> near_reach: array<atomic<u32>>;
@group(0) @binding(3) var<storage, read_write> near_count: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read> near_start: array<u32>;
@group(0) @binding(7) var<storage, read_write> near_marks: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read_write> near_order: array<u32>;
@group(0) @binding(6) var<storage, read_write> near_balls: array<vec4u>;
@group(0) @binding(8) var<storage, read_write> near_names: array<vec2u>;

// Reach of a particle over the distance of its neighbours, and how far stretching widens it at most.
const REACH: f32 = 1.75;
const WIDEST: f32 = 1.5;
// Radius of a ball over that distance.
const BALL: f32 = 0.625;

fn reach_of(p: u32) -> f32 { return REACH * balls[2u * p].w / BALL * min(balls[2u * p + 1u].w / CLOSING, WIDEST); }

fn cube_of(p: u32) -> u32 { return cube_slot(cube_at_point(balls[2u * p].xyz, bitcast<f32>(atomicLoad(&near_reach[0])))); }

fn is_shown(p: u32) -> bool { return p < view.particles && balls[2u * p].w > 0.0; }

@compute @workgroup_size(WORKGROUP)
fn find_reach(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, local);
    // Positive floats order like their bits.
    if is_shown(p) { atomicMax(&near_reach[0], bitcast<u32>(reach_of(p))); }
}

@compute @workgroup_size(WORKGROUP)
fn tally_near(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, local);
    if is_shown(p) { atomicAdd(&near_count[cube_of(p)], 1u); }
}

@compute @workgroup_size(WORKGROUP)
fn place_near(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, local);
    if !is_shown(p) { return; }
    let slot = cube_of(p);
    near_order[near_start[slot + 1u] - atomicSub(&near_count[slot], 1u)] = p;
}

// The order inside a cube is that of the particles, so that sums are the same in every picture.
@compute @workgroup_size(WORKGROUP)
fn gather_near(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, local);
    if !is_shown(p) { return; }
    let slot = cube_of(p);
    let first = near_start[slot];
    let end = near_start[slot + 1u];
    var place = first;
    for (var i = first; i < end; i++) { place += u32(near_order[i] < p); }
    let half = 0.5 * balls[2u * p].w / BALL;
    let sizes = vec2f(reach_of(p), half) / bitcast<f32>(atomicLoad(&near_reach[0]));
    near_balls[place] = vec4u(bitcast<vec3u>(balls[2u * p].xyz), pack2x16unorm(sizes));
    near_names[place] = vec2u(pack_color(balls[2u * p + 1u].rgb), p);
}

@compute @workgroup_size(WORKGROUP)
fn mark_near(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let slot = thread_index(workgroup, local);
    if slot >= cube_count() { return; }
    let end = atomicLoad(&near_marks[slot + 1u]);
    var widest = 0u;
    for (var k = atomicLoad(&near_marks[slot]); k < end; k++) { widest = max(widest, near_balls[k].w & 0xffffu); }
    if widest == 0u { return; }
    let cube = vec3i(vec3u(slot % CUBES_X, slot / CUBES_X % CUBES_Y, slot / (CUBES_X * CUBES_Y)));
    for (var k = 0; k < 27; k++) {
        let around = cube + vec3i(k % 3, k / 3 % 3, k / 9) - 1;
        atomicMax(&near_marks[cube_count() + 1u + cube_slot(around)], widest);
    }
}
