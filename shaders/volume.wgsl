// Ray march through a three-dimensional field, with bodies and walls inside it and the edges of the domain around it.
// Emission and absorption [Max 1995]: dC/ds = sigma (c - C) along the ray, front to back.
// draw_volume: reads corners, bricks, cells, colors, surface, edges; writes pixels.

#include "shared/thread.wgsl"
#include "shared/view.wgsl"
#include "shared/color.wgsl"
#include "shared/surface.wgsl"

// One edge of the domain on the picture: end points in pixels and their depth along the view axis [m].
struct Edge {
    from_point: vec2f,
    to_point: vec2f,
    depths: vec2f,
    unused: vec2f,
}

@group(0) @binding(1) var<storage, read> corners: array<vec2u>;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> colors: array<vec4f>;
@group(0) @binding(4) var<storage, read> surface: array<vec4u>;
@group(0) @binding(5) var<storage, read> edges: array<Edge, 12>;
@group(0) @binding(6) var<storage, read_write> pixels: array<u32>;
@group(0) @binding(7) var<storage, read> bricks: array<u32>;

const BACKGROUND_TOP: vec3f = vec3f(0.0045, 0.0060, 0.0100);
const BACKGROUND_BOTTOM: vec3f = vec3f(0.0200, 0.0240, 0.0330);
const EDGE_COLOR: vec3f = vec3f(0.36, 0.42, 0.52);
const WALL_COLOR: vec3f = vec3f(0.20, 0.21, 0.23);

// Rays end when this little light passes.
const DARK: f32 = 0.004;

// Light gathered so far, and the share of what lies behind that still comes through.
struct Light {
    color: vec3f,
    passing: f32,
}

fn over(front: Light, color: vec3f, coverage: f32) -> Light {
    return Light(front.color + front.passing * coverage * color, front.passing * (1.0 - coverage));
}

// Fraction of the range at a point, in cells from the low corner of the domain.
fn fraction_at(place: vec3f) -> f32 {
    let from_cube = clamp(place + 0.5, vec3f(0.0), vec3f(view.cells) + 0.999);
    let cube = vec3u(from_cube);
    let w = from_cube - vec3f(cube);
    let packed = corners[cube.x + (view.cells.x + 1u) * (cube.y + (view.cells.y + 1u) * cube.z)];
    let slab = mix(unpack4x8unorm(packed.x), unpack4x8unorm(packed.y), w.z);
    let row = mix(slab.xy, slab.zw, w.y);
    return mix(row.x, row.y, w.x);
}

fn table_color(fraction: f32) -> vec3f {
    let place = fraction * f32(COLOR_COUNT - 1u);
    let low = min(u32(place), COLOR_COUNT - 2u);
    return mix(colors[low].rgb, colors[low + 1u].rgb, place - f32(low));
}

fn is_wall(cell: vec3i) -> bool {
    return all(cell >= vec3i(0)) && all(cell < vec3i(view.cells)) && kind_of(cells[slot_of(cell)]) == KIND_WALL;
}

fn cell_at(ray: Ray, distance: f32) -> vec3i {
    return vec3i(floor((ray.start + distance * ray.direction - view.origin) / view.spacing));
}

// Walls are lit by the direction in which they end.
fn wall_color(cell: vec3i) -> vec3f {
    var normal = vec3f(0.0);
    for (var i = 0u; i < 27u; i++) {
        let offset = vec3i(vec3u(i % 3u, (i / 3u) % 3u, i / 9u)) - 1;
        if (!is_wall(cell + offset)) {
            normal += vec3f(offset);
        }
    }
    normal = normal / max(length(normal), 1e-6);
    return WALL_COLOR * (0.25 + 0.75 * max(dot(normal, view.light), 0.0));
}

// The cell by which a ray enters a wall, between a point before it and a point inside it.
fn wall_entry(ray: Ray, before: f32, inside: f32) -> vec3i {
    var outer = before;
    var inner = inside;
    for (var i = 0u; i < 8u; i++) {
        let middle = 0.5 * (outer + inner);
        if (is_wall(cell_at(ray, middle))) {
            inner = middle;
        } else {
            outer = middle;
        }
    }
    return cell_at(ray, inner);
}

// Entry and exit of the domain along a ray, in metres; empty if the exit is not behind the entry.
fn domain_span(ray: Ray) -> vec2f {
    let extent = vec3f(view.cells) * view.spacing;
    let safe = select(ray.direction, vec3f(1e-9), abs(ray.direction) < vec3f(1e-9));
    let a = (view.origin - ray.start) / safe;
    let b = (view.origin + extent - ray.start) / safe;
    let low = min(a, b);
    let high = max(a, b);
    return vec2f(max(max(low.x, max(low.y, low.z)), 0.0), min(high.x, min(high.y, high.z)));
}

// Coverage of this pixel by the edges of the domain: by those nearer than `front` along the view axis, and by those behind
// the middle of the domain.
fn edge_coverage(pixel: vec2f, front: f32, middle: f32) -> vec2f {
    var coverage = vec2f(0.0);
    for (var e = 0u; e < 12u; e++) {
        let edge = edges[e];
        let along = edge.to_point - edge.from_point;
        let part = clamp(dot(pixel - edge.from_point, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
        let amount = clamp(1.2 - length(pixel - edge.from_point - part * along), 0.0, 1.0);
        // Perspective makes the inverse of the depth linear on the picture.
        let depth = 1.0 / mix(1.0 / edge.depths.x, 1.0 / edge.depths.y, part);
        coverage = max(coverage, vec2f(0.60, 0.35) * amount * vec2f(f32(depth < front), f32(depth >= middle)));
    }
    return coverage;
}

// Steps to the end of a transparent brick, 0 in others. Steps are whole, so that leaping changes no sample.
fn steps_to_leap(ray: Ray, place: vec3f) -> f32 {
    let from_cube = place + 0.5;
    let brick = vec3u(clamp(from_cube, vec3f(0.0), vec3f(view.cells) + 0.999)) / BRICK;
    let grid = brick_grid();
    if (bricks[brick.x + grid.x * (brick.y + grid.y * brick.z)] == 1u) {
        return 0.0;
    }
    let ahead = vec3f(BRICK * (brick + vec3u(ray.direction > vec3f(0.0))));
    let speed = select(ray.direction, vec3f(1e-9), abs(ray.direction) < vec3f(1e-9)) / view.spacing;
    let exits = (ahead - from_cube) / speed;
    return max(ceil(min(exits.x, min(exits.y, exits.z)) / view.step), 1.0);
}

// Light of the gas in one step.
fn gas_light(light: Light, place: vec3f) -> Light {
    let fraction = fraction_at(place);
    let contrast = abs(fraction - view.neutral) / contrast_scale();
    if (contrast < FAINTEST) {
        return light;
    }
    let absorbed = 1.0 - exp(-view.opacity * contrast * contrast * view.step);
    return over(light, table_color(fraction), absorbed);
}

// Gathers light from the gas between two distances.
fn march(ray: Ray, from_distance: f32, to_distance: f32, jitter: f32, before: Light) -> Light {
    var light = before;
    var s = from_distance + jitter * view.step;
    while (s < to_distance && light.passing > DARK) {
        let place = (ray.start + s * ray.direction - view.origin) / view.spacing;
        if (view.obstacles == 1u) {
            if (is_wall(vec3i(floor(place)))) {
                return over(light, wall_color(wall_entry(ray, max(s - view.step, from_distance), s)), 1.0);
            }
            light = gas_light(light, place);
            s += view.step;
        } else {
            let leap = steps_to_leap(ray, place);
            if (leap == 0.0) {
                light = gas_light(light, place);
            }
            s += max(leap, 1.0) * view.step;
        }
    }
    return light;
}

@compute @workgroup_size(WORKGROUP)
fn draw_volume(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
               @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, groups, local);
    if (i >= view.size.x * view.size.y) {
        return;
    }
    let pixel = vec2f(vec2u(i % view.size.x, i / view.size.x)) + 0.5;
    let ray = ray_through(pixel);
    let body = unpack_surface(surface[i]);
    let span = domain_span(ray);
    let jitter = hash_unit(i);
    // Edges before the middle of the domain are drawn over the gas, the others behind it.
    let centre = view.origin + 0.5 * vec3f(view.cells) * view.spacing;
    let middle = dot(centre - view.eye, view.forward);
    let body_depth = select(1e30, body.depth * dot(ray.direction, view.forward), body.coverage > 0.0);

    let edge = edge_coverage(pixel, min(middle, body_depth), middle);
    var light = over(Light(vec3f(0.0), 1.0), EDGE_COLOR, edge.x);
    let meeting = select(span.y, clamp(body.depth, span.x, max(span.x, span.y)), body.coverage > 0.0);
    light = march(ray, span.x, meeting, jitter, light);
    light = over(light, body.color, body.coverage);
    if (light.passing > DARK && meeting < span.y) {
        light = march(ray, meeting, span.y, jitter, light);
    }
    light = over(light, EDGE_COLOR, edge.y);
    let background = mix(BACKGROUND_TOP, BACKGROUND_BOTTOM, pixel.y / f32(view.size.y));
    light = over(light, background, 1.0);
    pixels[i] = packed_pixel(light.color, hash_unit(i ^ 0x9e3779b9u));
}
