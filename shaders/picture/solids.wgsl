// What stands still in a 3D scene: obstacles and the floor.
// trace_solids: reads distance, shadow_map, light_grid, glow_grid, bends; writes surface, the nearest of them along each ray of the band.

#include "picture/view.wgsl"
#include "picture/surface.wgsl"
#include "picture/distance.wgsl"
#include "picture/lit.wgsl"
#include "picture/color.wgsl"
#include "picture/backdrop.wgsl"
#include "picture/bent.wgsl"

@group(0) @binding(1) var<storage, read> distance: array<f32>;
@group(0) @binding(2) var<storage, read> shadow_map: array<u32>;
@group(0) @binding(3) var<storage, read> light_grid: array<u32>;
@group(0) @binding(4) var<storage, read_write> surface: array<vec4u>;
@group(0) @binding(5) var<storage, read> glow_grid: array<vec4f>;
@group(0) @binding(6) var<storage, read> bends: array<vec2f>;

// Whether there are obstacles.
override WALLS: bool = true;

const WALL_COLOR: vec3f = vec3f(0.30, 0.31, 0.33);

// Direction out of an obstacle; where the domain's side cuts it, that of the side.
fn wall_normal(ray: Ray, s: f32, span: vec2f) -> vec3f {
    let place = in_cells(ray.start + s * ray.direction);
    if s <= span.x {
        let half = 0.5 * vec3f(view.cells);
        let from_middle = (place - half) / half;
        let most = max(abs(from_middle.x), max(abs(from_middle.y), abs(from_middle.z)));
        return sign(from_middle) * vec3f(abs(from_middle) >= vec3f(most));
    }
    let h = 1.0 / f32(view.fineness);
    let gradient = vec3f(distance_at(place + vec3f(h, 0.0, 0.0)) - distance_at(place - vec3f(h, 0.0, 0.0)),
                         distance_at(place + vec3f(0.0, h, 0.0)) - distance_at(place - vec3f(0.0, h, 0.0)),
                         distance_at(place + vec3f(0.0, 0.0, h)) - distance_at(place - vec3f(0.0, 0.0, h)));
    return gradient / max(length(gradient), 1e-12);
}

// The obstacle or the floor that a stretch of a ray meets between two distances.
fn meet(ray: Ray, from_distance: f32, to_distance: f32) -> Surface {
    var found = Surface(0.0, 0.0, vec3f(0.0));
    if WALLS && view.fineness > 0u {
        let whole = domain_span(ray);
        let span = vec2f(max(whole.x, from_distance), min(whole.y, to_distance));
        let hit = hit_obstacle(ray, span);
        if hit >= 0.0 {
            let point = ray.start + hit * ray.direction;
            let normal = wall_normal(ray, hit, whole);
            let arriving = arriving_at(point, 0.5 * view.spacing);
            found = Surface(hit, 1.0, lit_surface(WALL_COLOR, point, normal, -ray.direction, arriving));
        }
    }
    let descent = dot(view.ground.xyz, ray.direction);
    if descent < -1e-6 {
        let s = (view.ground.w - dot(view.ground.xyz, ray.start)) / descent;
        if s > from_distance && s <= to_distance && (found.coverage == 0.0 || s < found.depth) {
            let point = ray.start + s * ray.direction;
            let arriving = arriving_at(point, 0.2 * view.spacing);
            let color = lit_surface(floor_color(point, ray, s), point, view.ground.xyz, -ray.direction, arriving);
            found = Surface(s, floor_coverage(point, s), color);
        }
    }
    return found;
}

@compute @workgroup_size(WORKGROUP)
fn trace_solids(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= band_rays() { return; }
    let pixel = vec2f(place_of(i)) + 0.5;
    let ray = ray_through(pixel);
    read_bend(pixel);
    var found = Surface(0.0, 0.0, vec3f(0.0));
    var s = 0.0;
    for (var k = 0u; k < STRETCHES && s < 1e29 && found.coverage == 0.0; k++) {
        let part = stretch(ray, k);
        found = meet(part.ray, s, part.end);
        s = part.end;
    }
    surface[solid_place(i)] = pack_surface(found);
}
