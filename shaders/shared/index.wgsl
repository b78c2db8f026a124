// One index space for cells, nodes and vertices: the grid with one ring of slots around it on every active axis.
// Cell c, the velocity node at its centre and the vertex at its low corner share slot_of(c).
#include "shared/params.wgsl"
#include "shared/thread.wgsl"

fn active_axis(a: u32) -> i32 { return i32(a < DIM); }
fn reach() -> vec3i { return vec3i(1, i32(DIM > 1u), i32(DIM > 2u)); }

fn slot_of(c: vec3i) -> u32 {
    let r = vec3u(c + reach());
    return r.x + params.stride.x * (r.y + params.stride.y * r.z);
}

fn cell_of(slot: u32) -> vec3i {
    let row = slot / params.stride.x;
    let layer = row / params.stride.y;
    return vec3i(vec3u(slot - row * params.stride.x, row - layer * params.stride.y, layer)) - reach();
}

fn axis(a: u32) -> vec3i { return vec3i(i32(a == 0u), i32(a == 1u), i32(a == 2u)); }

// Slot distance of neighbours along an axis.
fn step_of(a: u32) -> u32 {
    if a == 0u { return 1u; }
    if a == 1u { return params.stride.x; }
    return params.stride.x * params.stride.y;
}

fn inside(c: vec3i) -> bool { return all(c >= vec3i(0)) && all(c < vec3i(params.cells)); }
fn in_ring(c: vec3i) -> bool { return all(c >= -reach()) && all(c < vec3i(params.cells) + reach()); }
fn is_vertex(v: vec3i) -> bool { return all(v >= vec3i(0)) && all(v < vec3i(params.cells) + reach()); }
fn nearest_inside(c: vec3i) -> vec3i { return clamp(c, vec3i(0), vec3i(params.cells) - vec3i(1)); }
fn nearest_ring(c: vec3i) -> vec3i { return clamp(c, -reach(), vec3i(params.cells) + reach() - vec3i(1)); }

// Enumerations of the 3^DIM block (offsets -1..1) and of the 2^DIM corners (offsets 0..1), x fastest.
fn block_size() -> u32 { if DIM == 1u { return 3u; } if DIM == 2u { return 9u; } return 27u; }
fn block_offset(k: u32) -> vec3i {
    return vec3i(vec3u(k % 3u, (k / 3u) % 3u, k / 9u)) - reach();
}
fn corner_count() -> u32 { return 1u << DIM; }
fn corner_offset(k: u32) -> vec3i { return vec3i(vec3u(k & 1u, (k >> 1u) & 1u, k >> 2u)); }

fn cell_volume() -> f32 { return face_area() * params.spacing; }
fn face_area() -> f32 {
    if DIM == 1u { return 1.0; }
    if DIM == 2u { return params.spacing; }
    return params.spacing * params.spacing;
}
fn world_from_cell(c: vec3i) -> vec3f { return params.origin + (vec3f(c) + 0.5) * params.spacing; }
