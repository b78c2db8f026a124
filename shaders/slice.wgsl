// A two-dimensional field through the colour table, bodies drawn over it.
// draw_slice: reads field, cells, colors, surface; writes pixels. Row 0 is the top of the picture, y points up.

#include "shared/thread.wgsl"
#include "shared/view.wgsl"
#include "shared/color.wgsl"
#include "shared/surface.wgsl"

@group(0) @binding(1) var<storage, read> field: array<f32>;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> colors: array<vec4f>;
@group(0) @binding(4) var<storage, read> surface: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> pixels: array<u32>;

// Light of cells without gas: covered by a body, and walls.
const BODY_SHADE: vec3f = vec3f(0.045, 0.042, 0.040);
const WALL_SHADE: vec3f = vec3f(0.075, 0.080, 0.090);

fn color_of(value: f32) -> vec3f {
    let place = clamp((value - view.low) / (view.high - view.low), 0.0, 1.0) * f32(COLOR_COUNT - 1u);
    let low = min(u32(place), COLOR_COUNT - 2u);
    return mix(colors[low].rgb, colors[low + 1u].rgb, place - f32(low));
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

fn gas_color(place: vec2f) -> vec3f {
    let cell = vec2i(floor(place));
    let own = value_at(cell);
    if (own == NO_VALUE) {
        let inside = clamp(cell, vec2i(0), vec2i(view.cells.xy) - 1);
        let kind = kind_of(cells[slot_of(vec3i(inside, 0))]);
        return select(BODY_SHADE, WALL_SHADE, kind == KIND_WALL);
    }
    if (view.squares == 1u) {
        return color_of(own);
    }
    return color_of(interpolated(place));
}

@compute @workgroup_size(WORKGROUP)
fn draw_slice(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
              @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, groups, local);
    if (i >= view.size.x * view.size.y) {
        return;
    }
    let pixel = vec2f(vec2u(i % view.size.x, i / view.size.x)) + 0.5;
    let point = ray_through(pixel).start;
    let place = (point.xy - view.origin.xy) / view.spacing;
    let body = unpack_surface(surface[i]);
    let color = mix(gas_color(place), body.color, body.coverage);
    pixels[i] = packed_pixel(color, 0.5);
}
