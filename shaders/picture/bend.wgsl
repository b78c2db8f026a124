// How gas bends the rays of a picture: the direction turns by the gradient of the index of refraction across it [Born and Wolf 1999].
// weigh_gas: reads conserved, cells; writes index, n - 1 of each cell, exaggerated [Gladstone and Dale 1863].
// bend_rays: reads index; writes bends, offsets of a grid of rays from their straight lines at a row of distances, in cells.
// shift_balls: reads bends; moves balls to where they are seen.

#include "picture/view.wgsl"
#include "picture/bent.wgsl"

@group(0) @binding(1) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read_write> index: array<f32>;
@group(0) @binding(4) var<storage, read_write> bends: array<vec2f>;
@group(0) @binding(5) var<storage, read_write> balls: array<vec4f>;

// Length of a step over the edge of a cell.
const BEND_STEP: f32 = 1.0;
// Cells before an open side over which bending fades: there the wave is cut off.
const FADING: f32 = 3.0;

// Denser than this over the ambient density, gas bends no more: no shock in air is, but products of an explosive, which hide what is behind.
const THICKEST: f32 = 8.0;

// Index of a slot with gas; -1 without.
fn index_of(slot: u32) -> f32 {
    if kind_of(cells[slot]) != KIND_GAS { return -1.0; }
    return view.refraction * min(conserved[slot].x, THICKEST * view.ambient_density);
}

@compute @workgroup_size(WORKGROUP)
fn weigh_gas(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= cell_count() { return; }
    let cell = cell_of(i);
    var own = index_of(slot_of(cell));
    if own < 0.0 {
        // Bodies and obstacles have the index of the gas around them, so that their edges bend nothing.
        var sum = 0.0;
        var count = 0.0;
        for (var k = 0u; k < 27u; k++) {
            let near = cell + vec3i(vec3u(k % 3u, (k / 3u) % 3u, k / 9u)) - 1;
            let beside = index_of(slot_of(clamp(near, vec3i(0), vec3i(view.cells) - 1)));
            sum += max(beside, 0.0);
            count += f32(beside >= 0.0);
        }
        own = select(view.refraction * view.ambient_density, sum / max(count, 1.0), count > 0.0);
    }
    index[i] = own;
}

// Gradient of the index at a place in cells [m^-1].
fn index_gradient(place: vec3f) -> vec3f {
    let at = clamp(place - 0.5, vec3f(0.0), vec3f(view.cells) - 1.001);
    let low = vec3u(at);
    let w = at - vec3f(low);
    let stride = vec3u(1u, view.cells.x, view.cells.x * view.cells.y);
    var gradient = vec3f(0.0);
    for (var corner = 0u; corner < 8u; corner++) {
        let offset = vec3u(corner & 1u, (corner >> 1u) & 1u, corner >> 2u);
        let share = abs(1.0 - vec3f(offset) - w);
        let value = index[dot(low + offset, stride)];
        gradient += value * (2.0 * vec3f(offset) - 1.0) * share.yzx * share.zxy;
    }
    let beyond = 1e6 * abs(view.ground.xyz) * vec3f(view.ground.xyz > vec3f(0.0));
    let above = 1e6 * abs(view.ground.xyz) * vec3f(view.ground.xyz < vec3f(0.0));
    let inside = min(place + beyond, vec3f(view.cells) - place + above);
    let fade = clamp(min(inside.x, min(inside.y, inside.z)) / FADING, 0.0, 1.0);
    return fade * gradient / view.spacing;
}

@compute @workgroup_size(WORKGROUP)
fn bend_rays(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    let grid = bend_grid();
    if i >= grid.x * grid.y { return; }
    let ray = ray_through(f32(view.bend_pitch) * vec2f(vec2u(i % grid.x, i / grid.x)));
    let along = bend_distance(1u) - bend_distance(0u);
    let count = ceil(along / (BEND_STEP * view.spacing));
    let step = along / count;
    var point = ray.start + view.bend_near * ray.direction;
    var direction = ray.direction;
    for (var knot = 1u; knot <= BEND_KNOTS; knot++) {
        for (var k = 0.0; k < count; k += 1.0) {
            let place = in_cells(point + 0.5 * step * direction);
            if all(place > vec3f(0.0)) && all(place < vec3f(view.cells)) {
                let gradient = index_gradient(place);
                direction = normalize(direction + step * (gradient - dot(gradient, direction) * direction));
            }
            point += step * direction;
        }
        // Along the ray, back to the plane of the straight line's point: what is left lies across the view axis.
        let away = point - ray.start - bend_distance(knot) * ray.direction;
        let across = away - ray.direction * dot(away, view.forward) / dot(ray.direction, view.forward);
        let offset = vec2f(dot(across, view.right), dot(across, view.up)) / view.spacing;
        bends[BEND_KNOTS * i + knot - 1u] = offset;
    }
}

@compute @workgroup_size(WORKGROUP)
fn shift_balls(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, local);
    if p >= view.particles { return; }
    let point = balls[2u * p].xyz;
    var seen = point;
    for (var k = 0u; k < 2u; k++) {
        let place = project(seen);
        if place.z <= 0.0 { return; }
        read_bend(place.xy);
        let from_eye = select(length(point - view.eye), place.z, view.parallel == 1u);
        seen = point - offset_at(from_eye);
    }
    balls[2u * p] = vec4f(seen, balls[2u * p].w);
}
