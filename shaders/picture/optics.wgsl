// What light that crosses a 3D domain shows of its density: pictures along lines of sight [Settles 2001].
// integrate_lines: reads field (the density); writes columns, its integral along each ray of the whole picture.
// measure_lines: reads columns; writes ranges, the mean square of the picture that each workgroup saw, and its rays.
// draw_lines: reads columns, surface; writes light: grey, bodies and obstacles in front as shadows.

#include "shared/reduce.wgsl"
#include "picture/view.wgsl"
#include "picture/surface.wgsl"

@group(0) @binding(1) var<storage, read> field: array<f32>;
@group(0) @binding(2) var<storage, read_write> columns: array<f32>;
@group(0) @binding(3) var<storage, read_write> ranges: array<vec2f>;
@group(0) @binding(4) var<storage, read> surface: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> light: array<vec4f>;

// Steps of the integral per cell.
const STEPS: f32 = 1.5;

// Difference of the density from its ambient value, between the eight cell centres around a place; no gas counts as ambient.
fn excess_at(place: vec3f) -> f32 {
    let low = floor(place - 0.5);
    let w = place - 0.5 - low;
    var sum = 0.0;
    for (var corner = 0u; corner < 8u; corner++) {
        let offset = vec3f(f32(corner & 1u), f32((corner >> 1u) & 1u), f32(corner >> 2u));
        let cell = vec3u(clamp(low + offset, vec3f(0.0), vec3f(view.cells) - 1.0));
        let share = abs(1.0 - offset - w);
        let value = field[cell.x + view.cells.x * (cell.y + view.cells.y * cell.z)];
        sum += share.x * share.y * share.z * select(value - view.low, 0.0, value == NO_VALUE);
    }
    return sum;
}

@compute @workgroup_size(WORKGROUP)
fn integrate_lines(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= view.size.x * view.size.y { return; }
    let ray = ray_through(vec2f(vec2u(i % view.size.x, i / view.size.x)) + 0.5);
    let span = domain_span(ray);
    let length = max(span.y - span.x, 0.0);
    let count = ceil(STEPS * length / view.spacing);
    var sum = 0.0;
    for (var k = 0.0; k < count; k += 1.0) {
        let s = span.x + (k + 0.5) / count * length;
        sum += excess_at(in_cells(ray.start + s * ray.direction));
    }
    columns[i] = sum / max(count, 1.0) * length;
}

fn column(place: vec2i) -> f32 {
    let inside = vec2u(clamp(place, vec2i(0), vec2i(view.size) - 1));
    return columns[inside.x + view.size.x * inside.y];
}

// Rays across one cell in the middle of the domain: differences are those between cells.
fn reach() -> i32 {
    let middle = view.origin + 0.5 * vec3f(view.cells) * view.spacing;
    let distance = select(dot(middle - view.eye, view.forward), 1.0, view.parallel == 1u);
    return max(i32(view.spacing / (max(distance, 1e-6) * view.half_height) * 0.5 * f32(view.size.y)), 1);
}

// Bending of light across a slanted knife edge, or its focusing.
fn signal(place: vec2i) -> f32 {
    let h = reach();
    let right = column(place + vec2i(h, 0));
    let left = column(place - vec2i(h, 0));
    let above = column(place - vec2i(0, h));
    let below = column(place + vec2i(0, h));
    if view.optics == OPTICS_SHADOWGRAPH { return 4.0 * column(place) - right - left - above - below; }
    return 0.6 * (right - left) + 0.8 * (above - below);
}

@compute @workgroup_size(WORKGROUP)
fn measure_lines(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    var squares = 0.0;
    var count = 0.0;
    let total = view.size.x * view.size.y;
    for (var i = thread_index(workgroup, local); i < total; i += RANGE_GROUPS * WORKGROUP) {
        let value = signal(vec2i(vec2u(i % view.size.x, i / view.size.x)));
        if value != 0.0 {
            squares += value * value;
            count += 1.0;
        }
    }
    squares = workgroup_sum(local, squares);
    count = workgroup_sum(local, count);
    if local == 0u { ranges[workgroup.x] = vec2f(squares, count); }
}

@compute @workgroup_size(WORKGROUP)
fn draw_lines(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= band_rays() { return; }
    let bent = signal(vec2i(place_of(i))) / view.gain;
    // Like film, the grey approaches black and white slowly.
    var grey = 0.5 + 0.5 * bent / (1.0 + abs(bent));
    grey = grey * grey;
    let wall = unpack_surface(surface[solid_place(i)]);
    let body = unpack_surface(surface[i]);
    grey = mix(grey, 0.01, max(wall.coverage, body.coverage));
    light[i] = vec4f(vec3f(grey), 1.0);
}
