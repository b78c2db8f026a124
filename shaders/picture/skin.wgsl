// The surface that particles show: its depth, smoothed on request, and its light.
// draw_back: reads depth_in, balls, nearest; writes depth_out and kept, what is left of larger balls: their surface, drawn back.
// smooth_depth: reads depth_in, balls, nearest; writes depth_out, the mean over the samples around that lie on the same sheet.
// list_skin: reads nearest; writes covered, the number of rays that meet particles and their list, and skin_groups, the
// workgroups of shade_skin.
// shade_skin: reads covered, balls, nearest, depth_in, shadow_map, light_grid, glow_grid; writes surface for those rays.

#include "picture/view.wgsl"
#include "picture/samples.wgsl"
#include "picture/surface.wgsl"
#include "picture/lit.wgsl"
#include "picture/area.wgsl"

@group(0) @binding(1) var<storage, read> balls: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> covered: array<atomic<u32>>;
@group(0) @binding(10) var<storage, read_write> skin_groups: array<atomic<u32>>;
@group(0) @binding(3) var<storage, read> nearest: array<u32>;
@group(0) @binding(4) var<storage, read> depth_in: array<u32>;
@group(0) @binding(5) var<storage, read_write> depth_out: array<u32>;
@group(0) @binding(6) var<storage, read> shadow_map: array<u32>;
@group(0) @binding(7) var<storage, read> light_grid: array<u32>;
@group(0) @binding(8) var<storage, read_write> surface: array<vec4u>;
@group(0) @binding(9) var<storage, read> glow_grid: array<vec4f>;
@group(0) @binding(11) var<storage, read_write> kept: array<u32>;

// Whether the particles are smoothed into a surface.
override SMOOTH: bool = false;

// Radius of the smoothing over that of a ball, and the steepest slope that still belongs to the same sheet.
const SMOOTH_REACH: f32 = 2.4;
const STEEPEST: f32 = 3.0;
// Cosine between colours that differ in brightness alone.
const SAME_HUE: f32 = 0.995;

fn depth_of(place: vec2i) -> f32 {
    let grid = sample_grid();
    if any(place < vec2i(0)) || any(place >= vec2i(grid)) { return -1.0; }
    let bits = depth_in[u32(place.x) + grid.x * u32(place.y)];
    return select(bitcast<f32>(FARTHEST - bits), -1.0, bits == NOTHING);
}

// Depths that differ by more than so many radii belong to different sheets.
const SHEET: f32 = 6.0;
// Of sixteen places around, how many beyond a sheet tell its side from a small hole. The wider the ring, the fewer: what is left of a
// straight side is then as narrow.
fn places_of_side(growth: f32) -> u32 { return select(2u, 4u, growth < 1.8); }

@compute @workgroup_size(WORKGROUP)
fn draw_back(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    let grid = sample_grid();
    if i >= grid.x * grid.y { return; }
    kept[i] = nearest[i];
    depth_out[i] = depth_in[i];
    if nearest[i] == NOTHING { return; }
    let place = vec2i(vec2u(i % grid.x, i / grid.x));
    let depth = bitcast<f32>(FARTHEST - depth_in[i]);
    let ball = 2u * (FARTHEST - nearest[i]);
    let radius = balls[ball].w;
    let growth = balls[ball + 1u].w;
    let side = places_of_side(growth);
    let excess = (growth - 1.0) * radius;
    let reach = clamp(samples_across(excess, depth), 1.0, f32(SAMPLE_MARGIN) / 3.0);
    // On a ring around: what of the sheet is farthest, and what lies behind it where it ends.
    var farthest = depth;
    var behind = NOTHING;
    var beyond = 0u;
    for (var k = 0u; k < 16u; k++) {
        let angle = f32(k) * 0.39269908;
        let near = clamp(place + vec2i(round(reach * vec2f(cos(angle), sin(angle)))), vec2i(0), vec2i(grid) - 1);
        let j = u32(near.x) + grid.x * u32(near.y);
        let own = select(bitcast<f32>(FARTHEST - depth_in[j]), 1e30, nearest[j] == NOTHING);
        if own - depth <= SHEET * radius {
            farthest = max(farthest, own);
        } else {
            beyond += 1u;
            behind = select(behind, j + 1u, nearest[j] != NOTHING);
        }
    }
    if beyond >= side && behind != NOTHING {
        kept[i] = nearest[behind - 1u];
        farthest = bitcast<f32>(FARTHEST - depth_in[behind - 1u]);
    } else if beyond >= side {
        kept[i] = NOTHING;
    }
    depth_out[i] = select(FARTHEST - bitcast<u32>(farthest + excess), NOTHING, kept[i] == NOTHING);
}

@compute @workgroup_size(WORKGROUP)
fn smooth_depth(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    let grid = sample_grid();
    if i >= grid.x * grid.y { return; }
    depth_out[i] = depth_in[i];
    if depth_in[i] == NOTHING { return; }
    let place = vec2i(vec2u(i % grid.x, i / grid.x));
    let depth = bitcast<f32>(FARTHEST - depth_in[i]);
    let radius = balls[2u * (FARTHEST - nearest[i])].w;
    let reach = clamp(samples_across(SMOOTH_REACH * radius, depth), 1.0, f32(SAMPLE_MARGIN) / 3.0);
    // Eight places on each of three rings, weighted by a bell.
    var sum = depth;
    var weights = 1.0;
    for (var k = 0u; k < 24u; k++) {
        let ring = f32(k / 8u + 1u) / 3.0;
        let angle = (f32(k % 8u) + 0.5 * f32((k / 8u) & 1u)) * 0.78539816;
        let near = depth_of(place + vec2i(round(reach * ring * vec2f(cos(angle), sin(angle)))));
        if near > 0.0 && abs(near - depth) < radius * (1.0 + STEEPEST * SMOOTH_REACH * ring) {
            let weight = exp(-2.0 * ring * ring);
            sum += weight * near;
            weights += weight;
        }
    }
    depth_out[i] = FARTHEST - bitcast<u32>(sum / weights);
}

fn point_at(place: vec2i, depth: f32) -> vec3f {
    let ray = sample_ray(vec2u(place));
    return ray.start + depth * ray.direction;
}

// What a ring of samples on the same sheet tells: the normal of the plane that fits their depths best, zero where they are too few; and
// their colour, where only its brightness differs.
struct Sheet {
    normal: vec3f,
    color: vec3f,
}

fn fit_sheet(place: vec2i, here: vec3f, depth: f32, p: u32) -> Sheet {
    let radius = balls[2u * p].w;
    let color = balls[2u * p + 1u].rgb;
    let reach = clamp(samples_across(1.2 * radius, depth), 2.0, f32(SAMPLE_MARGIN) / 3.0);
    var rises = vec2f(0.0);
    var squares = vec2f(0.0);
    var colors = vec4f(color, 1.0);
    for (var k = 0u; k < 12u; k++) {
        let angle = f32(k) * 0.52359878;
        let offset = round(reach * vec2f(cos(angle), sin(angle)));
        let near = depth_of(place + vec2i(offset));
        if near > 0.0 && abs(near - depth) < radius * (1.0 + 1.2 * STEEPEST) {
            rises += offset * (near - depth);
            squares += offset * offset;
            let beside = balls[2u * (FARTHEST - particle_at(place + vec2i(offset))) + 1u].rgb;
            let same_hue = dot(beside, color) > SAME_HUE * length(beside) * length(color);
            colors += select(vec4f(0.0), vec4f(beside, 1.0), same_hue);
        }
    }
    var across = vec3f(0.0);
    if min(squares.x, squares.y) > 0.0 {
        let slope = rises / squares;
        let right = point_at(place + vec2i(1, 0), depth + slope.x) - here;
        let below = point_at(place + vec2i(0, 1), depth + slope.y) - here;
        across = cross(below, right);
    }
    return Sheet(across, colors.rgb / colors.w);
}

// Normal and colour of what a sample shows of a particle.
fn sheet_at(place: vec2i, ray: Ray, depth: f32, p: u32) -> Sheet {
    let here = ray.start + depth * ray.direction;
    var sheet = Sheet(vec3f(0.0), balls[2u * p + 1u].rgb);
    if SMOOTH { sheet = fit_sheet(place, here, depth, p); }
    let size = length(sheet.normal);
    if size > 0.0 {
        sheet.normal *= select(1.0, -1.0, dot(sheet.normal, ray.direction) > 0.0) / size;
    } else {
        sheet.normal = (here - balls[2u * p].xyz) / balls[2u * p].w;
    }
    return sheet;
}

// First sample of a ray of the band.
fn first_sample(i: u32) -> vec2u {
    return vec2u(i % view.size.x, i / view.size.x) * view.samples + vec2u(0u, SAMPLE_MARGIN);
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
            let area = area_at(vec2i(place), 1.0);
            sum.color += area.w * area.rgb;
            sum.coverage += area.w;
        } else if nearest[sample] != NOTHING {
            let p = FARTHEST - nearest[sample];
            let depth = bitcast<f32>(FARTHEST - depth_in[sample]);
            let ray = sample_ray(place);
            let point = ray.start + depth * ray.direction;
            let sheet = sheet_at(vec2i(place), ray, depth, p);
            if arriving < 0.0 { arriving = arriving_at(point, 1.5 * balls[2u * p].w); }
            sum.color += lit_surface(sheet.color, point, sheet.normal, -ray.direction, arriving);
            sum.depth += depth;
            sum.coverage += 1.0;
        }
    }
    let seen = max(sum.coverage, 1e-6);
    surface[i] = pack_surface(Surface(sum.depth / seen, sum.coverage / f32(count), sum.color / seen));
}
