// Ray march through a three-dimensional field, with bodies, obstacles and slices inside it and the edges of the domain around.
// Emission, absorption and single scattering [Max 1995]: dC/ds = sigma (c - C) along the ray, front to back.
// draw_volume: reads corners, glow, bricks, colors, light_grid, bends, surface; writes light, and as fourth number how much of it is no background.

#include "picture/view.wgsl"
#include "picture/color.wgsl"
#include "picture/surface.wgsl"
#include "picture/gas_look.wgsl"
#include "picture/in_light.wgsl"
#include "picture/contour.wgsl"
#include "picture/backdrop.wgsl"
#include "picture/bent.wgsl"

// One edge of the domain on the picture: end points in rays and their depth along the view axis [m].
struct Edge {
    from_point: vec2f,
    to_point: vec2f,
    depths: vec2f,
    unused: vec2f,
}

@group(0) @binding(1) var<storage, read> corners: array<vec2u>;
@group(0) @binding(2) var<storage, read> glow: array<vec2u>;
@group(0) @binding(3) var<storage, read> colors: array<vec4f>;
@group(0) @binding(4) var<storage, read> surface: array<vec4u>;
@group(0) @binding(5) var<uniform> edges: array<Edge, 12>;
@group(0) @binding(6) var<storage, read_write> light: array<vec4f>;
@group(0) @binding(7) var<storage, read> bricks: array<u32>;
@group(0) @binding(9) var<storage, read> light_grid: array<u32>;
@group(0) @binding(8) var<storage, read> bends: array<vec2f>;

const EDGE_COLOR: vec3f = vec3f(0.36, 0.42, 0.52);
const LINE_COLOR: vec3f = vec3f(0.02, 0.02, 0.025);

// Whether there are slices.
override SLICES: bool = true;

// Rays end when this little light passes.
const DARK: f32 = 0.004;

// Light gathered so far, and the share of what lies behind that still comes through.
struct Gathered {
    color: vec3f,
    passing: f32,
}

fn over(front: Gathered, color: vec3f, coverage: f32) -> Gathered {
    return Gathered(front.color + front.passing * coverage * color, front.passing * (1.0 - coverage));
}

// Coverage of this pixel by the edges of the domain: by those nearer than `front` along the view axis, and by those behind
// the middle of the domain.
fn edge_coverage(pixel: vec2f, front: f32, middle: f32) -> vec2f {
    var coverage = vec2f(0.0);
    let width = f32(view.supersampling);
    for (var e = 0u; e < 12u; e++) {
        let edge = edges[e];
        let along = edge.to_point - edge.from_point;
        let part = clamp(dot(pixel - edge.from_point, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
        let amount = clamp(0.5 + 0.7 * width - length(pixel - edge.from_point - part * along), 0.0, 1.0);
        // Perspective makes the inverse of the depth linear on the picture.
        let depth = select(1.0 / mix(1.0 / edge.depths.x, 1.0 / edge.depths.y, part),
                           mix(edge.depths.x, edge.depths.y, part), view.parallel == 1u);
        coverage = max(coverage, vec2f(0.60, 0.35) * amount * vec2f(f32(depth < front), f32(depth >= middle)));
    }
    return coverage;
}

// The brick that a ray is in: where it leaves it, and whether there is anything to see.
struct Brick {
    end: f32,
    // What it holds, as bits; 0 for nothing to see.
    holds: u32,
}

fn brick_at(ray: Ray, place: vec3f, s: f32) -> Brick {
    let from_cube = place + 0.5;
    let brick = vec3u(clamp(from_cube, vec3f(0.0), vec3f(view.cells) + 0.999)) / BRICK;
    let grid = (view.cells + BRICK) / BRICK;
    let ahead = vec3f(BRICK * (brick + vec3u(ray.direction > vec3f(0.0))));
    let speed = select(ray.direction, vec3f(1e-9), abs(ray.direction) < vec3f(1e-9)) / view.spacing;
    let exits = (ahead - from_cube) / speed;
    return Brick(s + min(exits.x, min(exits.y, exits.z)), bricks[brick.x + grid.x * (brick.y + grid.y * brick.z)]);
}

// Light from outside that arrives at a distance along a ray of the light grid.
fn arriving(lights: Ray, s: f32) -> f32 {
    if view.shadows == 0u { return 1.0; }
    let at = lights.start + s * lights.direction;
    if has_soot() || has_dust() { return light_between(at); }
    return light_inside(at).y;
}

// Light of the gas in one step, at a place that is a distance `s` along the ray, in a brick that holds `what`.
fn gas_light(before: Gathered, place: vec3f, what: u32, lights: Ray, s: f32) -> Gathered {
    let gas = optics_in(place, what);
    let extinction = gas.extinction + gas.shining;
    if extinction * view.spacing < 1e-5 { return before; }
    // A fully lit gas has the colours of the colour bar.
    let outside = view.sky_strength + (1.0 - view.sky_strength) * view.light_strength * arriving(lights, s);
    let source = (gas.extinction * outside * gas.color + gas.shining * gas.glow) / extinction;
    return over(before, source, 1.0 - exp(-extinction * view.step));
}

// Cells of gas before a body that show the gas in front of them: between the middles of cells the gas behind a thin wall would shine through.
const CLEARANCE: f32 = 1.2;

// A ray in cells of the light grid, which is read at its nearest cell, half a cell off at random: steps add up to the mean.
fn light_along(ray: Ray, jitter: f32) -> Ray {
    let start = in_light(ray.start);
    return Ray(start + select(0.8 * (jitter - 0.5), 0.0, has_soot() || has_dust()), in_light(ray.start + ray.direction) - start);
}

// Gathers light from the gas between two distances: leaps through empty bricks, then steps through one that is not. Both are loops of
// their own, because software computes both branches of a condition.
fn march(ray: Ray, from_distance: f32, to_distance: f32, jitter: f32, before: Gathered) -> Gathered {
    var gathered = before;
    if view.volume == 0u { return gathered; }
    let clear = max(to_distance - CLEARANCE * view.spacing, from_distance);
    var s = from_distance + jitter * view.step;
    var number = 0u;
    var part = stretch(ray, number);
    var lights = light_along(part.ray, jitter);
    while (s < to_distance && gathered.passing > DARK) {
        if REFRACTION && s >= part.end {
            while (s >= part.end) {
                number++;
                part = stretch(ray, number);
            }
            lights = light_along(part.ray, jitter);
        }
        let stop = min(part.end, to_distance);
        var brick = Brick(s, 0u);
        while (s < stop && brick.holds == 0u) {
            brick = brick_at(part.ray, in_cells(part.ray.start + min(s, clear) * part.ray.direction), s);
            // Steps are whole, so that leaping changes no sample.
            let steps = max(ceil((min(brick.end, part.end) - s) / view.step), 1.0);
            s += select(steps, 0.0, brick.holds != 0u) * view.step;
        }
        let end = select(s, min(brick.end, stop), brick.holds != 0u);
        // One step at least, where rounding puts the end of a brick before its beginning.
        var inside = brick.holds != 0u;
        while (inside && gathered.passing > DARK) {
            let place = in_cells(part.ray.start + min(s, clear) * part.ray.direction);
            gathered = gas_light(gathered, place, brick.holds, lights, s);
            s += view.step;
            inside = s < end;
        }
    }
    return gathered;
}

// Distance to the first slice behind `after`, and its index; index 4 if there is none.
fn next_slice(ray: Ray, after: f32, span: vec2f) -> vec2f {
    var found = vec2f(1e30, 4.0);
    for (var k = 0u; SLICES && k < view.slice_count; k++) {
        let plane = view.slices[k];
        let s = (plane.w - dot(plane.xyz, ray.start)) / dot(plane.xyz, ray.direction);
        if s > after && s >= span.x && s <= span.y && s < found.x { found = vec2f(s, f32(k)); }
    }
    return found;
}

// The field on a slice, with contour lines; a fraction per metre on the slice changes per ray.
fn slice_color(pixel: vec2f, ray: Ray, s: f32, plane: vec4f) -> vec3f {
    let place = in_cells(ray.start + s * ray.direction);
    let cube = cube_at(place);
    let fraction = interpolated(corners[cube.index], cube.inside);
    let color = colors[table_place(fraction)].rgb;
    if view.contour_count == 0u { return color; }
    var steepness = vec2f(0.0);
    for (var axis = 0u; axis < 2u; axis++) {
        var step = vec2f(0.0);
        step[axis] = 1.0;
        let near = ray_through(pixel + step);
        let t = (plane.w - dot(plane.xyz, near.start)) / dot(plane.xyz, near.direction);
        let other = cube_at(in_cells(near.start + t * near.direction));
        steepness[axis] = interpolated(corners[other.index], other.inside) - fraction;
    }
    return mix(color, LINE_COLOR, contour_coverage(fraction, length(steepness)));
}

@compute @workgroup_size(WORKGROUP)
fn draw_volume(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= band_rays() { return; }
    let corner = place_of(i);
    let pixel = vec2f(corner) + 0.5;
    let ray = ray_through(pixel);
    read_bend(pixel);
    let body = unpack_surface(surface[i]);
    let wall = unpack_surface(surface[solid_place(i)]);
    let span = domain_span(ray);
    let jitter = hash_unit(corner.x + view.size.x * corner.y);
    // Edges before the middle of the domain are drawn over the gas, the others behind it.
    let centre = view.origin + 0.5 * vec3f(view.cells) * view.spacing;
    let middle = dot(centre - view.eye, view.forward);
    let wall_depth = select(1e30, wall.depth, wall.coverage > 0.0);
    let body_depth = select(1e30, body.depth, body.coverage > 0.0 && body.depth < wall_depth);
    let along = dot(ray.direction, view.forward);

    let edge = edge_coverage(pixel, min(middle, min(body_depth, wall_depth) * along), middle);
    var gathered = over(Gathered(vec3f(0.0), 1.0), EDGE_COLOR, edge.x);
    var s = span.x;
    var body_ahead = body_depth < 1e29;
    for (var k = 0u; k < 6u && gathered.passing > DARK; k++) {
        let plane = next_slice(ray, s, vec2f(span.x, min(span.y, wall_depth)));
        let stop = min(plane.x, select(1e30, body_depth, body_ahead));
        let end = clamp(min(stop, wall_depth), span.x, max(span.x, span.y));
        gathered = march(ray, s, end, jitter, gathered);
        s = end;
        if stop > 1e29 { break; }
        if body_ahead && body_depth <= plane.x {
            gathered = over(gathered, body.color, body.coverage);
            body_ahead = false;
        } else if SLICES {
            gathered = over(gathered, slice_color(pixel, ray, plane.x, view.slices[u32(plane.y)]), 1.0);
            s = plane.x + 1e-5 * view.spacing;
        }
    }
    gathered = over(gathered, EDGE_COLOR, select(edge.y, 0.0, wall_depth * along < middle));
    gathered = over(gathered, wall.color, wall.coverage);
    let seen = beyond(pixel, ray);
    let background = behind(seen.pixel, seen.direction);
    let alpha = 1.0 - gathered.passing;
    gathered = over(gathered, background, 1.0);
    light[i] = vec4f(view.exposure * gathered.color, alpha);
}
