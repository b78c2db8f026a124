// A two-dimensional field through the colour table, with contour lines, obstacles and bodies over it.
// draw_slice: reads field, cells, colors, surface, distance; writes light. Row 0 is the top of the picture, y points up.

#include "shared/thread.wgsl"
#include "shared/view.wgsl"
#include "shared/surface.wgsl"
#include "shared/distance.wgsl"
#include "shared/contour.wgsl"

@group(0) @binding(1) var<storage, read> field: array<f32>;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> colors: array<vec4f>;
@group(0) @binding(4) var<storage, read> surface: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> light: array<vec4f>;
@group(0) @binding(6) var<storage, read> distance: array<f32>;

// Light of cells without gas: covered by a body, and walls.
const BODY_SHADE: vec3f = vec3f(0.045, 0.042, 0.040);
const WALL_SHADE: vec3f = vec3f(0.075, 0.080, 0.090);

const LINE_COLOR: vec3f = vec3f(0.02, 0.02, 0.025);

fn fraction_of(value: f32) -> f32 {
    return clamp((value - view.low) / (view.high - view.low), 0.0, 1.0);
}

fn color_of(value: f32) -> vec3f {
    return colors[u32(fraction_of(value) * f32(COLOR_COUNT - 1u) + 0.5)].rgb;
}

fn value_at(cell: vec2i) -> f32 {
    let inside = vec2u(clamp(cell, vec2i(0), vec2i(view.cells.xy) - 1));
    return field[inside.x + view.cells.x * inside.y];
}

// Interpolation between the four nearest cell centres; those without gas have no say.
fn interpolated(place: vec2f) -> f32 {
    let low = floor(place - 0.5);
    let weight = place - 0.5 - low;
    var sum = 0.0;
    var weights = 0.0;
    for (var corner = 0u; corner < 4u; corner++) {
        let offset = vec2f(f32(corner & 1u), f32(corner >> 1u));
        let value = value_at(vec2i(low + offset));
        let share = abs(1.0 - offset.x - weight.x) * abs(1.0 - offset.y - weight.y);
        if (value != NO_VALUE) {
            sum += share * value;
            weights += share;
        }
    }
    return sum / max(weights, 1e-20);
}

// Share of a place covered by contour lines; rays are `reach` cells apart.
fn lines(place: vec2f, reach: f32) -> f32 {
    let here = fraction_of(interpolated(place));
    let right = fraction_of(interpolated(place + vec2f(reach, 0.0)));
    let above = fraction_of(interpolated(place + vec2f(0.0, reach)));
    return contour_coverage(here, length(vec2f(right - here, above - here)));
}

fn gas_color(place: vec2f, reach: f32) -> vec3f {
    let cell = vec2i(floor(place));
    let own = value_at(cell);
    if (own == NO_VALUE) {
        let inside = clamp(cell, vec2i(0), vec2i(view.cells.xy) - 1);
        let kind = kind_of(cells[slot_of(vec3i(inside, 0))]);
        return select(BODY_SHADE, WALL_SHADE, kind == KIND_WALL);
    }
    var color = vec3f(0.0);
    if (view.squares == 1u) {
        color = color_of(own);
    } else {
        color = color_of(interpolated(place));
    }
    if (view.contour_count > 0u) {
        color = mix(color, LINE_COLOR, lines(place, reach));
    }
    return color;
}

@compute @workgroup_size(WORKGROUP)
fn draw_slice(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if (i >= band_rays()) {
        return;
    }
    let pixel = vec2f(place_of(i)) + 0.5;
    let place = in_cells(ray_through(pixel).start).xy;
    let reach = abs(in_cells(ray_through(pixel + vec2f(1.0, 0.0)).start).x - place.x);
    var color = gas_color(place, reach);
    if (view.fineness > 0u) {
        let gap = distance_at(vec3f(place, 0.0)) / view.spacing;
        color = mix(WALL_SHADE, color, clamp(gap / reach + 0.5, 0.0, 1.0));
    }
    let body = unpack_surface(surface[i]);
    light[i] = vec4f(mix(color, body.color, body.coverage), 1.0);
}
