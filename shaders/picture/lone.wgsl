// Which particles touch no other one, and which are broken.
// mark_lone: reads balls, deformation and what near.wgsl writes; sets LONE and BROKEN in near_order.

#include "picture/view.wgsl"

@group(0) @binding(1) var<storage, read> balls: array<vec4f>;
@group(0) @binding(2) var<storage, read> near_reach: array<u32>;
@group(0) @binding(3) var<storage, read> near_start: array<u32>;
@group(0) @binding(4) var<storage, read_write> near_order: array<u32>;
@group(0) @binding(5) var<storage, read> near_balls: array<vec4u>;
@group(0) @binding(6) var<storage, read> deformation: array<vec4f>;

#include "picture/sheet.wgsl"

// Weight of the others around a particle below which it is alone: one of them 1.15 distances away has this, and two that are 0.97 away
// have that of broken ones.
const COMPANY: f32 = 0.18;
const COMPANY_OF_BROKEN: f32 = 0.66;

// Particles in a cube and the 26 around it with which none there is alone: of a whole body they are 18.
const MANY: u32 = 14u;

fn are_many_around(point: vec3f) -> bool {
    let cube = cube_at_point(point, largest_reach());
    let first = cube_slot(vec3i(cube.x - 1, 0, 0));
    var count = 0u;
    for (var i = 0; i < 9; i++) {
        let row = cube_slot(vec3i(0, cube.y + i % 3 - 1, cube.z + i / 3 - 1));
        for (var k = 0u; k < 2u; k++) {
            let part = row_part(row, first, 3u, k);
            count += near_start[part.y] - near_start[part.x];
        }
    }
    return count >= MANY;
}

@compute @workgroup_size(WORKGROUP)
fn mark_lone(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let k = thread_index(workgroup, local);
    if k >= near_start[cube_count()] { return; }
    let p = near_order[k];
    let point = bitcast<vec3f>(near_balls[k].xyz);
    let broken = deformation[3u * p + 2u].w > 0.5;
    var lone = false;
    if !are_many_around(point) {
        lone = look_around(point, 1.0, vec3f(-1.0)).weight - 1.0 < select(COMPANY, COMPANY_OF_BROKEN, broken);
    }
    near_order[k] = p | select(0u, LONE, lone) | select(0u, BROKEN, broken);
}
