// Particles as lit spheres. Each pixel has SAMPLES x SAMPLES samples; the nearest sphere wins each sample.
// clear_samples: writes depth_bits, nearest: nothing seen.
// splat_depth: reads position, velocity, deformation; lowers depth_bits to the nearest sphere.
// splat_nearest: reads the same and depth_bits; writes nearest, the lowest particle index at that depth.
// shade_surface: reads all; writes surface: depth, coverage and colour of each pixel.

#include "shared/thread.wgsl"
#include "shared/view.wgsl"

@group(0) @binding(1) var<storage, read> position: array<vec4f>;
@group(0) @binding(2) var<storage, read> velocity: array<vec4f>;
@group(0) @binding(3) var<storage, read> affine: array<vec4f>;
@group(0) @binding(4) var<storage, read> deformation: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> depth_bits: array<atomic<u32>>;
@group(0) @binding(6) var<storage, read_write> nearest: array<atomic<u32>>;
@group(0) @binding(7) var<storage, read_write> surface: array<vec4u>;

const NOTHING: u32 = 0xffffffffu;

// Two kernels may round the same depth differently; this many units in the last place count as equal.
const DEPTH_SLACK: u32 = 64u;

// Pixels from the middle of a sphere that are looked at, at most: a sphere in front of the eye would fill the picture.
const MAX_REACH: f32 = 200.0;

fn sample_grid() -> vec2u {
    return view.size * SAMPLES;
}

fn sample_ray(place: vec2u) -> Ray {
    return ray_through((vec2f(place) + 0.5) / f32(SAMPLES));
}

fn radius_of(p: u32) -> f32 {
    return view.particle_scale * pow(velocity[p].w, 1.0 / f32(view.dimension));
}

// Distance along the ray to a sphere, negative if it is missed [m].
fn hit_sphere(ray: Ray, centre: vec3f, radius: f32) -> f32 {
    let relative = centre - ray.start;
    let along = dot(relative, ray.direction);
    let miss = relative - along * ray.direction;
    let inside = radius * radius - dot(miss, miss);
    return select(-1.0, along - sqrt(max(inside, 0.0)), inside >= 0.0);
}

struct Footprint {
    centre: vec3f,
    radius: f32,
    // Samples from low to below high, empty if the particle is not seen.
    low: vec2i,
    high: vec2i,
}

fn footprint(p: u32) -> Footprint {
    var mark = Footprint(position[p].xyz, radius_of(p), vec2i(0), vec2i(0));
    let place = project(mark.centre);
    let active_flag = deformation[3u * p + 1u].w;
    if (place.z <= mark.radius || active_flag == 0.0) {
        return mark;
    }
    let distance = select(place.z - mark.radius, 1.0, view.parallel == 1u);
    let reach = min(1.2 * mark.radius / (distance * view.half_height) * 0.5 * f32(view.size.y) + 1.0, MAX_REACH);
    let limit = vec2f(sample_grid());
    mark.low = vec2i(clamp((place.xy - reach) * f32(SAMPLES), vec2f(0.0), limit));
    mark.high = vec2i(clamp((place.xy + reach) * f32(SAMPLES) + 1.0, vec2f(0.0), limit));
    return mark;
}

@compute @workgroup_size(WORKGROUP)
fn clear_samples(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
                 @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, groups, local);
    let samples = sample_grid();
    if (i < samples.x * samples.y) {
        atomicStore(&depth_bits[i], NOTHING);
        atomicStore(&nearest[i], NOTHING);
    }
}

@compute @workgroup_size(WORKGROUP)
fn splat_depth(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
               @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, groups, local);
    if (p >= view.particles) {
        return;
    }
    let mark = footprint(p);
    for (var y = mark.low.y; y < mark.high.y; y++) {
        for (var x = mark.low.x; x < mark.high.x; x++) {
            let place = vec2u(vec2i(x, y));
            let depth = hit_sphere(sample_ray(place), mark.centre, mark.radius);
            if (depth > 0.0) {
                // Positive floats order like their bits.
                atomicMin(&depth_bits[place.x + sample_grid().x * place.y], bitcast<u32>(depth));
            }
        }
    }
}

@compute @workgroup_size(WORKGROUP)
fn splat_nearest(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
                 @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, groups, local);
    if (p >= view.particles) {
        return;
    }
    let mark = footprint(p);
    for (var y = mark.low.y; y < mark.high.y; y++) {
        for (var x = mark.low.x; x < mark.high.x; x++) {
            let place = vec2u(vec2i(x, y));
            let depth = hit_sphere(sample_ray(place), mark.centre, mark.radius);
            let i = place.x + sample_grid().x * place.y;
            if (depth > 0.0 && bitcast<u32>(depth) <= atomicLoad(&depth_bits[i]) + DEPTH_SLACK) {
                atomicMin(&nearest[i], p);
            }
        }
    }
}

// Light from one side, from the sky, and along the rim [Lambert].
fn lit(base: vec3f, normal: vec3f, towards_eye: vec3f) -> vec3f {
    let lambert = max(dot(normal, view.light), 0.0);
    let sky = 0.5 + 0.5 * dot(normal, view.up);
    let rim = pow(1.0 - max(dot(normal, towards_eye), 0.0), 3.0);
    let sheen = pow(max(dot(normal, normalize(view.light + towards_eye)), 0.0), 30.0);
    return base * (0.95 * lambert + 0.10 + 0.18 * sky) + 0.10 * rim * base + 0.06 * sheen;
}

fn particle_color(p: u32, ray: Ray, depth: f32) -> vec3f {
    let body = bitcast<u32>(deformation[3u * p].w);
    let plastic_strain = affine[3u * p + 1u].w;
    let base = BODY_COLORS[body % BODY_COLOR_COUNT] / (1.0 + max(plastic_strain, 0.0) / view.dark_strain);
    if (view.parallel == 1u) {
        // Discs of a few pixels would turn into a pattern under a light.
        return base;
    }
    let normal = (ray.start + depth * ray.direction - position[p].xyz) / radius_of(p);
    return lit(base, normal, -ray.direction);
}

@compute @workgroup_size(WORKGROUP)
fn shade_surface(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
                 @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, groups, local);
    if (i >= view.size.x * view.size.y) {
        return;
    }
    let first = vec2u(i % view.size.x, i / view.size.x) * SAMPLES;
    var color = vec3f(0.0);
    var depth = 0.0;
    var seen = 0.0;
    for (var s = 0u; s < SAMPLES * SAMPLES; s++) {
        let place = first + vec2u(s % SAMPLES, s / SAMPLES);
        let sample = place.x + sample_grid().x * place.y;
        let p = atomicLoad(&nearest[sample]);
        if (p != NOTHING) {
            let distance = bitcast<f32>(atomicLoad(&depth_bits[sample]));
            color += particle_color(p, sample_ray(place), distance);
            depth += distance;
            seen += 1.0;
        }
    }
    color /= max(seen, 1.0);
    depth /= max(seen, 1.0);
    let coverage = seen / f32(SAMPLES * SAMPLES);
    surface[i] = vec4u(bitcast<u32>(depth), bitcast<u32>(coverage), pack2x16unorm(color.rg), pack2x16unorm(vec2f(color.b, 0.0)));
}
