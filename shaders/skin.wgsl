// The surface that particles show: its depth, smoothed on request, and its light.
// smooth_depth: reads depth_in; writes depth_out, the mean over the samples around that lie on the same sheet.
// shade_skin: reads position, paint, nearest, depth_in, shadow_map, light_grid, glow_grid; writes surface.

#include "shared/thread.wgsl"
#include "shared/view.wgsl"
#include "shared/samples.wgsl"
#include "shared/surface.wgsl"
#include "shared/light.wgsl"

@group(0) @binding(1) var<storage, read> position: array<vec4f>;
@group(0) @binding(2) var<storage, read> paint: array<vec4f>;
@group(0) @binding(3) var<storage, read> nearest: array<u32>;
@group(0) @binding(4) var<storage, read> depth_in: array<u32>;
@group(0) @binding(5) var<storage, read_write> depth_out: array<u32>;
@group(0) @binding(6) var<storage, read> shadow_map: array<u32>;
@group(0) @binding(7) var<storage, read> light_grid: array<u32>;
@group(0) @binding(8) var<storage, read_write> surface: array<vec4u>;
@group(0) @binding(9) var<storage, read> glow_grid: array<vec4f>;

// Radius of the smoothing over that of a ball, and the difference in depth that makes another sheet.
const SMOOTH_REACH: f32 = 1.6;
const SHEET: f32 = 2.0;

fn depth_of(place: vec2i) -> f32 {
    let grid = sample_grid();
    if (any(place < vec2i(0)) || any(place >= vec2i(grid))) {
        return -1.0;
    }
    let bits = depth_in[u32(place.x) + grid.x * u32(place.y)];
    return select(bitcast<f32>(bits), -1.0, bits == NOTHING);
}

// Samples across a length seen at a depth.
fn samples_across(length: f32, depth: f32) -> f32 {
    let distance = select(depth, 1.0, view.parallel == 1u);
    return length / (distance * view.half_height) * 0.5 * f32(view.size.y) * f32(view.samples);
}

@compute @workgroup_size(WORKGROUP)
fn smooth_depth(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
                @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, groups, local);
    let grid = sample_grid();
    if (i >= grid.x * grid.y) {
        return;
    }
    depth_out[i] = depth_in[i];
    if (depth_in[i] == NOTHING) {
        return;
    }
    let place = vec2i(vec2u(i % grid.x, i / grid.x));
    let depth = bitcast<f32>(depth_in[i]);
    let radius = paint[nearest[i]].w;
    let reach = clamp(samples_across(SMOOTH_REACH * radius, depth), 1.0, f32(SAMPLE_MARGIN) / 3.0);
    // Eight places on each of three rings, weighted by a bell.
    var sum = depth;
    var weights = 1.0;
    for (var k = 0u; k < 24u; k++) {
        let ring = f32(k / 8u + 1u) / 3.0;
        let angle = (f32(k % 8u) + 0.5 * f32((k / 8u) & 1u)) * 0.78539816;
        let near = depth_of(place + vec2i(round(reach * ring * vec2f(cos(angle), sin(angle)))));
        if (near > 0.0 && abs(near - depth) < SHEET * radius) {
            let weight = exp(-2.0 * ring * ring);
            sum += weight * near;
            weights += weight;
        }
    }
    depth_out[i] = bitcast<u32>(sum / weights);
}

fn point_at(place: vec2i, depth: f32) -> vec3f {
    let ray = sample_ray(vec2u(place));
    return ray.start + depth * ray.direction;
}

// Difference of points along one axis of the samples, to the side where the depth changes less.
fn tangent(place: vec2i, here: vec3f, depth: f32, step: vec2i) -> vec3f {
    let ahead = depth_of(place + step);
    let behind = depth_of(place - step);
    let rise = select(abs(ahead - depth), 1e30, ahead < 0.0);
    let fall = select(abs(behind - depth), 1e30, behind < 0.0);
    if (min(rise, fall) > 1e29) {
        return vec3f(0.0);
    }
    if (rise < fall) {
        return point_at(place + step, ahead) - here;
    }
    return here - point_at(place - step, behind);
}

fn normal_at(place: vec2i, ray: Ray, depth: f32, p: u32) -> vec3f {
    let here = ray.start + depth * ray.direction;
    if (view.smooth_skin == 1u) {
        let across = cross(tangent(place, here, depth, vec2i(0, 1)), tangent(place, here, depth, vec2i(1, 0)));
        let size = length(across);
        if (size > 0.0) {
            return across / size * select(1.0, -1.0, dot(across, ray.direction) > 0.0);
        }
    }
    return (here - position[p].xyz) / paint[p].w;
}

@compute @workgroup_size(WORKGROUP)
fn shade_skin(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
              @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, groups, local);
    if (i >= band_rays()) {
        return;
    }
    let first = vec2u(i % view.size.x, i / view.size.x) * view.samples + vec2u(0u, SAMPLE_MARGIN);
    var sum = Surface(0.0, 0.0, vec3f(0.0));
    let count = view.samples * view.samples;
    for (var s = 0u; s < count; s++) {
        let place = first + vec2u(s % view.samples, s / view.samples);
        let sample = place.x + sample_grid().x * place.y;
        let p = nearest[sample];
        if (p != NOTHING) {
            let depth = bitcast<f32>(depth_in[sample]);
            let ray = sample_ray(place);
            var color = paint[p].rgb;
            // Discs of a few pixels would turn into a pattern under a light.
            if (view.dimension == 3u) {
                let point = ray.start + depth * ray.direction;
                let normal = normal_at(vec2i(place), ray, depth, p);
                color = lit_surface(color, point, normal, -ray.direction, 1.5 * paint[p].w);
            }
            sum.color += color;
            sum.depth += depth;
            sum.coverage += 1.0;
        }
    }
    let seen = max(sum.coverage, 1.0);
    surface[i] = pack_surface(Surface(sum.depth / seen, sum.coverage / f32(count), sum.color / seen));
}
