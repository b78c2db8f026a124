// The light of what samples show of particles.
// list_skin: reads nearest; writes covered, the number of rays that meet particles and their list, and skin_groups, the
// workgroups of shade_skin.
// shade_skin: reads covered, balls, nearest, depth_in, shadow_map, light_grid, glow_grid; writes surface for those rays.
// shade_sheets: the same where particles make up a surface: reads sheets and near_reach instead of balls and nearest.

#include "picture/view.wgsl"
#include "picture/samples.wgsl"
#include "picture/surface.wgsl"
#include "picture/lit.wgsl"
#include "picture/area.wgsl"
#include "picture/sheets.wgsl"

@group(0) @binding(1) var<storage, read> balls: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> covered: array<atomic<u32>>;
@group(0) @binding(10) var<storage, read_write> skin_groups: array<atomic<u32>>;
@group(0) @binding(3) var<storage, read> nearest: array<u32>;
@group(0) @binding(4) var<storage, read> depth_in: array<u32>;
@group(0) @binding(5) var<storage, read> sheets: array<vec2u>;
@group(0) @binding(6) var<storage, read> shadow_map: array<u32>;
@group(0) @binding(7) var<storage, read> light_grid: array<u32>;
@group(0) @binding(8) var<storage, read_write> surface: array<vec4u>;
@group(0) @binding(9) var<storage, read> glow_grid: array<vec4f>;
@group(0) @binding(11) var<storage, read> near_reach: array<u32>;

// First sample of a ray of the band.
fn first_sample(i: u32) -> vec2u {
    return vec2u(i % view.size.x, i / view.size.x) * view.samples + vec2u(0u, SAMPLE_MARGIN);
}

// Samples between particles in the plane that still belong to the area around them, from either side.
const GAP: i32 = 3;

// In the plane, a particle seen beside the samples of a ray: between the particles of a body there may be gaps as wide as a ray.
fn particle_beside(first: vec2i) -> u32 {
    if view.dimension == 3u { return NOTHING; }
    let far = i32(view.samples) - 1 + GAP;
    let middle = i32(view.samples) / 2;
    var seen = NOTHING;
    for (var k = 0; k < 9; k++) {
        let step = vec2i(k % 3, k / 3);
        seen |= particle_at(first + select(select(vec2i(middle), vec2i(far), step == vec2i(2)), vec2i(-GAP), step == vec2i(0)));
    }
    return seen;
}

@compute @workgroup_size(WORKGROUP)
fn list_skin(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= band_rays() { return; }
    let first = first_sample(i);
    var seen = 0u;
    for (var s = 0u; s < view.samples * view.samples; s++) {
        let place = first + vec2u(s % view.samples, s / view.samples);
        seen |= nearest[place.x + sample_grid().x * place.y];
    }
    seen |= particle_beside(vec2i(first));
    if seen != NOTHING {
        let slot = atomicAdd(&covered[0], 1u);
        atomicMax(&skin_groups[0], slot / WORKGROUP + 1u);
        atomicStore(&covered[1u + slot], i);
    }
}

@compute @workgroup_size(WORKGROUP)
fn shade_skin(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let entry = thread_index(workgroup, local);
    if entry >= atomicLoad(&covered[0]) { return; }
    let i = atomicLoad(&covered[1u + entry]);
    let first = first_sample(i);
    var sum = Surface(0.0, 0.0, vec3f(0.0));
    let count = view.samples * view.samples;
    // Shadows hardly change within the place of a ray: the first sample speaks for all.
    var arriving = -1.0;
    for (var s = 0u; s < count; s++) {
        let place = first + vec2u(s % view.samples, s / view.samples);
        let sample = place.x + sample_grid().x * place.y;
        if view.dimension < 3u {
            let area = area_at(vec2i(place), f32(GAP));
            sum.color += area.w * area.rgb;
            sum.coverage += area.w;
        } else if nearest[sample] != NOTHING {
            let p = FARTHEST - nearest[sample];
            let depth = bitcast<f32>(FARTHEST - depth_in[sample]);
            let ray = sample_ray(place);
            let point = ray.start + depth * ray.direction;
            let ball = balls[2u * p];
            if arriving < 0.0 { arriving = arriving_at(point, 1.5 * ball.w); }
            let normal = (point - ball.xyz) / ball.w;
            sum.color += lit_surface(balls[2u * p + 1u].rgb, point, normal, -ray.direction, arriving);
            sum.depth += depth;
            sum.coverage += 1.0;
        }
    }
    let seen = max(sum.coverage, 1e-6);
    surface[i] = pack_surface(Surface(sum.depth / seen, sum.coverage / f32(count), sum.color / seen));
}

// Over the largest reach of a particle: how far above a surface shadows are looked for, and what is too near to cast one. The balls that
// cast them are not smooth.
const ABOVE_SURFACE: f32 = 0.3;
const CLEAR_OF_SURFACE: f32 = 0.5;

@compute @workgroup_size(WORKGROUP)
fn shade_sheets(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let entry = thread_index(workgroup, local);
    if entry >= atomicLoad(&covered[0]) { return; }
    let i = atomicLoad(&covered[1u + entry]);
    let first = first_sample(i);
    var sum = Surface(0.0, 0.0, vec3f(0.0));
    let count = view.samples * view.samples;
    var arriving = -1.0;
    for (var s = 0u; s < count; s++) {
        let place = first + vec2u(s % view.samples, s / view.samples);
        let sample = place.x + sample_grid().x * place.y;
        if depth_in[sample] == NOTHING { continue; }
        let depth = bitcast<f32>(FARTHEST - depth_in[sample]);
        let ray = sample_ray(place);
        let point = ray.start + depth * ray.direction;
        let sheet = unpack_sheet(sheets[sample]);
        let reach = bitcast<f32>(near_reach[0]);
        if arriving < 0.0 { arriving = arriving_at(point + ABOVE_SURFACE * reach * sheet.normal, CLEAR_OF_SURFACE * reach); }
        sum.color += lit_surface(sheet.color, point, sheet.normal, -ray.direction, arriving);
        sum.depth += depth;
        sum.coverage += 1.0;
    }
    let seen = max(sum.coverage, 1e-6);
    surface[i] = pack_surface(Surface(sum.depth / seen, sum.coverage / f32(count), sum.color / seen));
}
