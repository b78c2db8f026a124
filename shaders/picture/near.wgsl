// The particles around a point: lists of the particles in cubes of a grid that repeats in space, so that it needs no bounds.
// find_reach: reads balls; raises near_reach to the bits of the largest reach.
// tally_near: reads balls, near_reach; counts near_count. Its scan is near_start.
// place_near: reads balls, near_reach, near_start; counts near_count down; writes near_order, the particles cube by cube.
// mark_near: reads near_balls; near_marks is near_start, and behind it the largest reach around each cube, over the largest of all in
// 65535 parts.
// gather_near: reads balls, near_reach, near_start; sorts near_order inside each cube; writes near_balls in that order: the place, then the reach
// and half of the distance of neighbours over the largest reach.

#include "picture/view.wgsl"
#include "picture/near_cubes.wgsl"
#include "picture/growth.wgsl"

@group(0) @binding(1) var<storage, read> balls: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> near_reach: array<atomic<u32>>;
@group(0) @binding(3) var<storage, read_write> near_count: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read> near_start: array<u32>;
@group(0) @binding(7) var<storage, read_write> near_marks: array<atomic<u32>>;
@group(0) @binding(5) var<storage, read_write> near_order: array<u32>;
@group(0) @binding(6) var<storage, read_write> near_balls: array<vec4u>;

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
    let slot = thread_index(workgroup, local);
    if slot >= cube_count() { return; }
    let first = near_start[slot];
    let end = near_start[slot + 1u];
    for (var i = first; i < end; i++) {
        let moving = near_order[i];
        var j = i;
        while j > first && near_order[j - 1u] > moving {
            near_order[j] = near_order[j - 1u];
            j--;
        }
        near_order[j] = moving;
    }
    for (var i = first; i < end; i++) {
        let p = near_order[i];
        let half = 0.5 * balls[2u * p].w / BALL;
        let sizes = vec2f(reach_of(p), half) / bitcast<f32>(atomicLoad(&near_reach[0]));
        near_balls[i] = vec4u(bitcast<vec3u>(balls[2u * p].xyz), pack2x16unorm(sizes));
    }
}

@compute @workgroup_size(WORKGROUP)
fn mark_near(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let slot = thread_index(workgroup, local);
    if slot >= cube_count() { return; }
    let first = atomicLoad(&near_marks[slot]);
    let end = atomicLoad(&near_marks[slot + 1u]);
    var widest = 0u;
    for (var i = first; i < end; i++) { widest = max(widest, near_balls[i].w & 0xffffu); }
    if widest == 0u { return; }
    let cube = vec3i(vec3u(slot % CUBES_X, slot / CUBES_X % CUBES_Y, slot / (CUBES_X * CUBES_Y)));
    for (var k = 0; k < 125; k++) {
        let around = cube + vec3i(k % 5, k / 5 % 5, k / 25) - 2;
        atomicMax(&near_marks[cube_count() + 1u + cube_slot(around)], widest);
    }
}
