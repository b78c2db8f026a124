// p2g: what do the solids look like on the grid?
// Form by nodes, for hardware: each thread takes one node and sums what the particles of the cells around it give, row after row. Cells that
// follow each other along x have their sorted particles next to each other. Sums have one order: equal bits on every run.
// Same reads and writes as p2g.wgsl; velocity, mass and force come out in the same places. [Jiang et al. 2015; Cao et al. 2022, section 2.2]
#include "shared/index.wgsl"
#include "solid/transfer.wgsl"

override WITH_MASS: bool;       // mass and momentum

// What a node holds: momentum and mass, force and the mean driver times mass.
struct Sum { momentum: vec4f, force: vec4f }

// Weight of one axis, and its slope by the particle's place times the spacing; `d`: from the particle to the node, in cells.
// [Steffen et al. 2008; Jiang et al. 2016, section 5.5]
fn weight_at(d: f32) -> vec2f {
    let far = max(1.5 - abs(d), 0.0);
    return select(vec2f(0.5 * far * far, sign(d) * far), vec2f(0.75 - d * d, 2.0 * d), abs(d) <= 0.5);
}

// From a particle to a node, in cells, over the nearest seam of periodic axes; 0 on inactive axes.
fn distance_to(middle: vec3f, position: vec3f) -> vec3f {
    let d = (middle - (position - params.origin) / params.spacing) * vec3f(reach());
    if PERIODIC == 0u { return d; }
    let n = vec3f(params.cells);
    return select(d, d - n * round(d / n), periodic_axes());
}

fn with_particle(before: Sum, p: u32, middle: vec3f) -> Sum {
    var sum = before;
    let x = position[p];
    let d = distance_to(middle, x.xyz);
    let a = weight_at(d.x);
    var b = vec2f(1.0, 0.0);
    var c = vec2f(1.0, 0.0);
    if DIM > 1u { b = weight_at(d.y); }
    if DIM > 2u { c = weight_at(d.z); }
    let weight = a.x * b.x * c.x;
    if WITH_MASS {
        let gradient = mat3x3f(affine[3u * p].xyz, affine[3u * p + 1u].xyz, affine[3u * p + 2u].xyz);
        let mass = weight * x.w;
        sum.momentum += vec4f(mass * (velocity[p].xyz + params.spacing * (gradient * d)), mass);
    }
    if WITH_FORCE {
        let diagonal = stress[2u * p].xyz;  // xx, yy, zz of vol0 tau [J]
        let across = stress[2u * p + 1u];   // xy, yz, zx, driver
        let slope = vec3f(a.y * b.x * c.x, a.x * b.y * c.x, a.x * b.x * c.y) / params.spacing;
        sum.force -= vec4f(dot(vec3f(diagonal.x, across.x, across.z), slope), dot(vec3f(across.x, diagonal.y, across.y), slope),
                           dot(vec3f(across.z, across.y, diagonal.z), slope), 0.0);
        if WITH_DRIVER { sum.force.w += weight * x.w * across.w; }
    }
    return sum;
}

// Adds the particles of the cells from slot `first` to slot `last`.
fn with_cells(before: Sum, first: u32, last: u32, middle: vec3f) -> Sum {
    var sum = before;
    let end = cell_start[last + 1u];
    for (var i = cell_start[first]; i < end; i++) { sum = with_particle(sum, order[i], middle); }
    return sum;
}

// Adds the cells beside `c` along x, and itself. Cells of the ring hold no particles.
fn with_row(before: Sum, c: vec3i, middle: vec3f) -> Sum {
    if !in_ring(c) { return before; }
    let slot = slot_of(c);
    if (PERIODIC & 1u) == 0u || (c.x > 0 && c.x + 1 < i32(params.cells.x)) {
        return with_cells(before, max(slot, 1u) - 1u, min(slot + 1u, params.slots - 1u), middle);
    }
    var sum = before;
    for (var k = -1; k < 2; k++) {
        let beside = slot_of(c + k * axis(0u));
        sum = with_cells(sum, beside, beside, middle);
    }
    return sum;
}

@compute @workgroup_size(WORKGROUP)
fn p2g_nodes(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let c = cell_of(slot);
    var sum = Sum();
    if !is_alias(c) {
        let middle = vec3f(c) + 0.5;
        for (var row = 0u; row < block_size() / 3u; row++) {
            sum = with_row(sum, c + block_offset(3u * row + 1u), middle);
        }
    }
    if WITH_MASS {
        let mass = sum.momentum.w;
        node[slot] = vec4f(select(vec3f(0.0), sum.momentum.xyz / mass, mass > 0.0), mass);
    }
    if WITH_FORCE { work[part(ELASTIC_FORCE, slot)] = sum.force; }
}
