// A two-dimensional field through the colour table, with contour lines, obstacles and bodies over it.
// draw_slice: reads field, conserved, cells, colors, surface, distance; writes light. Row 0 is the top of the picture, y points up.

#include "picture/view.wgsl"
#include "picture/surface.wgsl"
#include "picture/distance.wgsl"
#include "picture/contour.wgsl"

@group(0) @binding(1) var<storage, read> field: array<f32>;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> colors: array<vec4f>;
@group(0) @binding(4) var<storage, read> surface: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> light: array<vec4f>;
@group(0) @binding(6) var<storage, read> distance: array<f32>;
@group(0) @binding(7) var<storage, read> conserved: array<vec4f>;

// Light of cells without gas: covered by a body, and walls.
const BODY_SHADE: vec3f = vec3f(0.045, 0.042, 0.040);
const WALL_SHADE: vec3f = vec3f(0.075, 0.080, 0.090);

const LINE_COLOR: vec3f = vec3f(0.02, 0.02, 0.025);

fn fraction_of(value: f32) -> f32 { return clamp((value - view.low) / (view.high - view.low), 0.0, 1.0); }

fn color_of(value: f32) -> vec3f { return colors[u32(fraction_of(value) * f32(COLOR_COUNT - 1u) + 0.5)].rgb; }

// What is sampled: the field itself, or what it is a derivative of.
const OF_FIELD: u32 = 0u;
const OF_DENSITY: u32 = 1u;
const OF_VELOCITY_X: u32 = 2u;
const OF_VELOCITY_Y: u32 = 3u;

fn value_at(cell: vec2i, quantity: u32) -> f32 {
    let inside = vec2u(clamp(cell, vec2i(0), vec2i(view.cells.xy) - 1));
    let seen = field[inside.x + view.cells.x * inside.y];
    if quantity == OF_FIELD || seen == NO_VALUE { return seen; }
    let state = conserved[slot_of(vec3i(vec2i(inside), 0))];
    let velocity = state.yz / state.x;
    return select(select(velocity.x, velocity.y, quantity == OF_VELOCITY_Y), state.x, quantity == OF_DENSITY);
}

// Weights of four neighbours at a place between the middle two: cubic, through the values. [Keys 1981]
fn cubic_weights(t: f32) -> vec4f {
    let s = 1.0 - t;
    return vec4f(-0.5 * t * s * s, 1.0 + t * t * (1.5 * t - 2.5), 1.0 + s * s * (1.5 * s - 2.5), -0.5 * s * t * t);
}

// The same of the cubic B-spline, whose slopes have no kinks, and of its derivative. [de Boor 1978]
fn spline_weights(t: f32) -> vec4f {
    let s = 1.0 - t;
    return vec4f(s * s * s, 4.0 - 3.0 * t * t * (2.0 - t), 4.0 - 3.0 * s * s * (2.0 - s), t * t * t) / 6.0;
}

fn spline_slopes(t: f32) -> vec4f {
    let s = 1.0 - t;
    return vec4f(-0.5 * s * s, t * (1.5 * t - 2.0), s * (2.0 - 1.5 * s), 0.5 * t * t);
}

// Mean of the nearest cells with gas, by their share in a place: what cells without gas count as. NO_VALUE where none is near.
fn mean_around(low: vec2f, t: vec2f, quantity: u32) -> f32 {
    var near = vec2f(0.0);
    var far = vec2f(0.0);
    for (var k = 0u; k < 16u; k++) {
        let offset = vec2f(f32(k & 3u), f32(k >> 2u)) - 1.0;
        let value = value_at(vec2i(low + offset), quantity);
        if value != NO_VALUE {
            let share = max(1.0 - abs(offset - t), vec2f(0.0));
            near += share.x * share.y * vec2f(value, 1.0);
            far += vec2f(value, 1.0);
        }
    }
    if near.y > 1e-3 { return near.x / near.y; }
    return select(NO_VALUE, far.x / far.y, far.y > 0.0);
}

// Sum over 4 x 4 cells with weights along x and y; cells without gas count as `rest`.
fn weighted(low: vec2f, along_x: vec4f, along_y: vec4f, rest: f32, quantity: u32) -> f32 {
    var sum = 0.0;
    for (var k = 0u; k < 16u; k++) {
        let offset = vec2f(f32(k & 3u), f32(k >> 2u)) - 1.0;
        let value = value_at(vec2i(low + offset), quantity);
        sum += along_x[k & 3u] * along_y[k >> 2u] * select(value, rest, value == NO_VALUE);
    }
    return sum;
}

// Gradient of a quantity at a place [1/m].
fn gradient(low: vec2f, t: vec2f, quantity: u32) -> vec2f {
    let rest = mean_around(low, t, quantity);
    let along_x = weighted(low, spline_slopes(t.x), spline_weights(t.y), rest, quantity);
    let along_y = weighted(low, spline_weights(t.x), spline_slopes(t.y), rest, quantity);
    return vec2f(along_x, along_y) / view.spacing;
}

// The field between the cells' middles, smooth, and nowhere beyond the four nearest values. NO_VALUE where no gas is near.
fn interpolated(place: vec2f) -> f32 {
    let low = floor(place - 0.5);
    let t = place - 0.5 - low;
    let rest = mean_around(low, t, OF_FIELD);
    if rest == NO_VALUE { return NO_VALUE; }
    if view.field == FIELD_SCHLIEREN { return length(gradient(low, t, OF_DENSITY)); }
    if view.field == FIELD_VORTICITY {
        return abs(gradient(low, t, OF_VELOCITY_Y).x - gradient(low, t, OF_VELOCITY_X).y);
    }
    var least = rest;
    var most = rest;
    for (var k = 0u; k < 4u; k++) {
        let value = value_at(vec2i(low + vec2f(f32(k & 1u), f32(k >> 1u))), OF_FIELD);
        if value != NO_VALUE {
            least = min(least, value);
            most = max(most, value);
        }
    }
    return clamp(weighted(low, cubic_weights(t.x), cubic_weights(t.y), rest, OF_FIELD), least, most);
}

// Share of a place covered by contour lines; rays are `reach` cells apart.
fn lines(place: vec2f, reach: f32) -> f32 {
    let here = fraction_of(interpolated(place));
    let right = fraction_of(interpolated(place + vec2f(reach, 0.0)));
    let above = fraction_of(interpolated(place + vec2f(0.0, reach)));
    return contour_coverage(here, length(vec2f(right - here, above - here)));
}

// Gas reaches a little into bodies and obstacles, which are drawn over it.
fn gas_color(place: vec2f, reach: f32) -> vec3f {
    let value = interpolated(place);
    if value == NO_VALUE {
        let inside = clamp(vec2i(floor(place)), vec2i(0), vec2i(view.cells.xy) - 1);
        let kind = kind_of(cells[slot_of(vec3i(inside, 0))]);
        return select(BODY_SHADE, WALL_SHADE, kind == KIND_WALL);
    }
    let color = color_of(value);
    if view.contour_count == 0u { return color; }
    return mix(color, LINE_COLOR, lines(place, reach));
}

@compute @workgroup_size(WORKGROUP)
fn draw_slice(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= band_rays() { return; }
    let pixel = vec2f(place_of(i)) + 0.5;
    let place = in_cells(ray_through(pixel).start).xy;
    let reach = abs(in_cells(ray_through(pixel + vec2f(1.0, 0.0)).start).x - place.x);
    var color = gas_color(place, reach);
    if view.fineness > 0u {
        let gap = distance_at(vec3f(place, 0.0)) / view.spacing;
        color = mix(WALL_SHADE, color, clamp(gap / reach + 0.5, 0.0, 1.0));
    }
    let body = unpack_surface(surface[i]);
    light[i] = vec4f(mix(color, body.color, body.coverage), 1.0);
}
