// Which particles touch no other one, and which are broken.
// mark_lone: reads deformation and what near.wgsl writes; sets LONE and BROKEN in near_names.

#include "picture/view.wgsl"

@group(0) @binding(2) var<storage, read> near_reach: array<u32>;
@group(0) @binding(3) var<storage, read> near_start: array<u32>;
@group(0) @binding(4) var<storage, read_write> near_names: array<vec2u>;
@group(0) @binding(5) var<storage, read> near_balls: array<vec4u>;
@group(0) @binding(6) var<storage, read> deformation: array<vec4f>;

#include "picture/sheet.wgsl"
#include "picture/sheets.wgsl"

// Weight of the others around a particle below which it is alone: one of them 1.15 distances away has this, and two that are 0.97 away
// have that of broken ones.
const COMPANY: f32 = 0.18;
const COMPANY_OF_BROKEN: f32 = 0.66;

// Whether the weight of the others around a particle comes to a limit: first those in its own cube, where most find enough.
fn has_company(own: u32, limit: f32) -> bool {
    let point = bitcast<vec3f>(near_balls[own].xyz);
    let cube = cube_at_point(point, largest_reach());
    let widening = 1.0 / (largest_reach() * largest_reach());
    var weight = 0.0;
    for (var i = 0u; i < 27u && weight < limit; i++) {
        let j = vec3i(vec3u((i + 13u) % 27u) / vec3u(1u, 3u, 9u) % 3u);
        let slot = cube_slot(cube + j - 1);
        let end = near_start[slot + 1u];
        for (var k = near_start[slot]; k < end && weight < limit; k++) {
            let sum = with_particle(nothing_around(), k, point, widening, vec3f(-1.0));
            weight += select(sum.weight, 0.0, k == own);
        }
    }
    return weight >= limit;
}

@compute @workgroup_size(WORKGROUP)
fn mark_lone(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let k = thread_index(workgroup, local);
    if k >= near_start[cube_count()] { return; }
    let broken = deformation[3u * particle_of(k) + 2u].w > 0.5;
    let lone = !has_company(k, select(COMPANY, COMPANY_OF_BROKEN, broken));
    near_names[k].x |= select(0u, LONE, lone) | select(0u, BROKEN, broken);
}
