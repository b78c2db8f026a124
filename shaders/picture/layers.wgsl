// What compositors take of a picture, pixel by pixel.
// finish_layers: reads light, surface, nearest, depth_in, deformation, velocity, bends; writes layers, three entries per pixel: light without the
// background, times alpha, and alpha; the depth of what is nearest, negative for nothing, and its number; its velocity.

#include "picture/view.wgsl"
#include "picture/samples.wgsl"
#include "picture/surface.wgsl"
#include "picture/color.wgsl"
#include "picture/backdrop.wgsl"
#include "picture/bent.wgsl"

@group(0) @binding(1) var<storage, read> light: array<vec4f>;
@group(0) @binding(2) var<storage, read> surface: array<vec4u>;
@group(0) @binding(3) var<storage, read> nearest: array<u32>;
@group(0) @binding(4) var<storage, read> depth_in: array<u32>;
@group(0) @binding(5) var<storage, read> deformation: array<vec4f>;
@group(0) @binding(6) var<storage, read> velocity: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> layers: array<vec4f>;
@group(0) @binding(8) var<storage, read> bends: array<vec2f>;

// Number of obstacles and the floor: one more than that of the last body, which has its place among the bodies and one more.
override OBSTACLES: u32 = 1u;

// What is nearest in a pixel: depth along the view axis, number, velocity.
struct Nearest {
    depth: f32,
    number: f32,
    velocity: vec3f,
}

// The nearest sample of a ray that shows a particle.
fn nearer_particle(ray: u32, before: Nearest) -> Nearest {
    var found = before;
    let first = vec2u(ray % view.size.x, ray / view.size.x) * view.samples + vec2u(0u, SAMPLE_MARGIN);
    for (var s = 0u; s < view.samples * view.samples; s++) {
        let place = first + vec2u(s % view.samples, s / view.samples);
        let sample = place.x + sample_grid().x * place.y;
        if nearest[sample] == NOTHING { continue; }
        let depth = bitcast<f32>(FARTHEST - depth_in[sample]) * dot(sample_ray(place).direction, view.forward);
        if found.depth < 0.0 || depth < found.depth {
            let p = FARTHEST - nearest[sample];
            found = Nearest(depth, f32(bitcast<u32>(deformation[3u * p].w) + 1u), velocity[p].xyz);
        }
    }
    return found;
}

// An obstacle or the floor in a ray.
fn nearer_solid(ray: u32, before: Nearest) -> Nearest {
    let wall = unpack_surface(surface[solid_place(ray)]);
    let along = dot(ray_through(vec2f(place_of(ray)) + 0.5).direction, view.forward);
    let depth = wall.depth * along;
    if wall.coverage < 0.5 || (before.depth >= 0.0 && before.depth <= depth) { return before; }
    return Nearest(depth, f32(OBSTACLES), vec3f(0.0));
}

@compute @workgroup_size(WORKGROUP)
fn finish_layers(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    let n = view.supersampling;
    let width = view.size.x / n;
    if i >= width * (view.rows / n) { return; }
    let place = vec2u(i % width, i / width) * n;
    var sum = vec4f(0.0);
    var found = Nearest(-1.0, 0.0, vec3f(0.0));
    for (var k = 0u; k < n * n; k++) {
        let at = place + vec2u(k % n, k / n);
        let ray = at.x + view.size.x * at.y;
        let own = light[ray];
        let pixel = vec2f(place_of(ray)) + 0.5;
        read_bend(pixel);
        let seen = beyond(pixel, ray_through(pixel));
        let background = view.exposure * (1.0 - own.a) * behind(seen.pixel, seen.direction);
        sum += vec4f(max(own.rgb - background, vec3f(0.0)), own.a);
        if view.particles > 0u { found = nearer_particle(ray, found); }
        found = nearer_solid(ray, found);
    }
    layers[3u * i] = sum / f32(n * n);
    layers[3u * i + 1u] = vec4f(found.depth, found.number, 0.0, 0.0);
    layers[3u * i + 2u] = vec4f(found.velocity, 0.0);
}
