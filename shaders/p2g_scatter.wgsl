// p2g, scatter form: each particle adds to the 3^DIM nodes around it by fixed-point integer atomics, first in the memory of its
// workgroup, which takes a tile of cells and their sorted particles, then once per node of the tile in global memory. [Gao et al. 2018]
// Integer sums do not depend on their order, so the bits are the same on every run. The unit of a sum follows from the largest
// share in this very state and from the crowd a node may see; a node that could hold more raises a fault instead of wrapping.
// Same reads and writes as p2g.wgsl; velocity, mass and force come out in the same places.
#include "shared/index.wgsl"
#include "shared/reduce4.wgsl"
#include "shared/bspline.wgsl"
#include "shared/particle.wgsl"

@group(0) @binding(1) var<storage, read> position: array<vec4f>;
@group(0) @binding(2) var<storage, read> velocity: array<vec4f>;
@group(0) @binding(3) var<storage, read> affine: array<vec4f>;
@group(0) @binding(4) var<storage, read> stress: array<vec4f>;
@group(0) @binding(5) var<storage, read> cell_start: array<u32>;
@group(0) @binding(6) var<storage, read_write> sums: array<atomic<i32>>; // per slot: momentum and mass; then per slot: force
@group(0) @binding(7) var<storage, read_write> node: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> bounds: array<vec4f>; // partial maxima, then the units at PARTIALS: mass, momentum, force, mass times driver
@group(0) @binding(9) var<storage, read> order: array<u32>;

const FULL = 1073741824.0;  // 2^30: half of what an i32 holds

@compute @workgroup_size(WORKGROUP)
fn scatter_bounds(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var bound = vec4f(0.0);
    for (var p = thread_index(group, lane); p < params.particles; p += striding_threads()) {
        let gradient = dot(affine[3u * p].xyz, affine[3u * p].xyz) + dot(affine[3u * p + 1u].xyz, affine[3u * p + 1u].xyz)
            + dot(affine[3u * p + 2u].xyz, affine[3u * p + 2u].xyz);
        let speed = length(velocity[p].xyz) + 2.6 * params.spacing * sqrt(gradient); // a node is at most sqrt(3) 1.5 dx away
        let size = dot(stress[2u * p].xyz, stress[2u * p].xyz) + 2.0 * dot(stress[2u * p + 1u].xyz, stress[2u * p + 1u].xyz);
        let driver = select(0.0, stress[2u * p + 1u].w, WITH_DRIVER);
        bound = max(bound, vec4f(position[p].w * vec2f(1.0, speed), 2.0 * sqrt(size) / params.spacing, position[p].w * driver));
    }
    let largest = workgroup_max4(lane, bound);
    if lane == 0u { bounds[group_index(group)] = largest; }
}

@compute @workgroup_size(WORKGROUP)
fn scatter_units(@builtin(local_invocation_index) lane: u32) {
    var bound = vec4f(0.0);
    for (var k = lane; k < params.groups; k += WORKGROUP) { bound = max(bound, bounds[k]); }
    let largest = workgroup_max4(lane, bound);
    if lane == 0u { bounds[PARTIALS] = max(largest, vec4f(1e-30)) * params.crowd / FULL; }
}

@compute @workgroup_size(WORKGROUP)
fn scatter_clear(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    for (var k = 0u; k < 4u; k++) {
        if WITH_MASS { atomicStore(&sums[4u * slot + k], 0); }
        if WITH_FORCE { atomicStore(&sums[4u * (params.slots + slot) + k], 0); }
    }
}

// Cells of a tile: one per thread of a workgroup.
fn tile_cells() -> vec3u {
    if DIM == 1u { return vec3u(WORKGROUP, 1u, 1u); }
    if DIM == 2u { return vec3u(8u, WORKGROUP / 8u, 1u); }
    return vec3u(4u, 4u, WORKGROUP / 16u);
}

const TILE_NODES = 216u;    // those of a tile and around it, at most
const PARTS = 8u;           // momentum, mass, force, mass times driver
// Those that this form carries.
fn parts() -> u32 { return select(7u, 8u, WITH_DRIVER); }
var<workgroup> tile: array<atomic<i32>, TILE_NODES * PARTS>;

fn place_in(size: vec3u, index: u32) -> vec3u {
    return vec3u(index % size.x, (index / size.x) % size.y, index / (size.x * size.y));
}

fn index_in(size: vec3u, place: vec3u) -> u32 { return place.x + size.x * (place.y + size.y * place.z); }

// Adds the particles of cell c to the tile; `corner`: the first node of the tile.
fn add_cell(c: vec3i, corner: vec3i, nodes: vec3u) {
    let unit = bounds[PARTIALS];
    let slot = slot_of(c);
    for (var i = cell_start[slot]; i < cell_start[slot + 1u]; i++) {
        let p = order[i];
        let s = spline_at(position[p].xyz);
        for (var k = 0u; k < block_size(); k++) {
            let offset = block_offset(k);
            let share = share_of(p, s, offset);
            let at = PARTS * index_in(nodes, vec3u(c + offset - corner));
            if WITH_MASS {
                let whole = vec4i(round(share.momentum / vec4f(unit.yyy, unit.x)));
                for (var a = 0u; a < 4u; a++) { atomicAdd(&tile[at + a], whole[a]); }
            }
            if WITH_FORCE {
                let whole = vec4i(round(share.force / vec4f(unit.zzz, unit.w)));
                for (var a = 4u; a < parts(); a++) { atomicAdd(&tile[at + a], whole[a - 4u]); }
            }
        }
    }
}

// Gives what node n of the tile holds to the sums, and leaves it empty for the next tile.
fn hand_over(n: u32, node: vec3i) {
    for (var a = 0u; a < parts(); a++) {
        let whole = atomicExchange(&tile[PARTS * n + a], 0);
        if whole == 0 { continue; }
        let slot = slot_of(node);
        if a < 4u { atomicAdd(&sums[4u * slot + a], whole); } else { atomicAdd(&sums[4u * (params.slots + slot) + a - 4u], whole); }
    }
}

@compute @workgroup_size(WORKGROUP)
fn scatter_add(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let size = tile_cells();
    let nodes = size + 2u * vec3u(reach());
    let tiles = (params.cells + size - 1u) / size;
    for (var t = group_index(group); t < tiles.x * tiles.y * tiles.z; t += params.groups) {
        let first = vec3i(place_in(tiles, t) * size);
        let c = first + vec3i(place_in(size, lane));
        if inside(c) { add_cell(c, first - reach(), nodes); }
        workgroupBarrier();
        for (var n = lane; n < nodes.x * nodes.y * nodes.z; n += WORKGROUP) {
            hand_over(n, first - reach() + vec3i(place_in(nodes, n)));
        }
        workgroupBarrier();
    }
}

// Largest sum of weights that the particles around a node can reach.
fn crowd_at(c: vec3i) -> f32 {
    var crowd = 0.0;
    for (var k = 0u; k < block_size(); k++) {
        let offset = block_offset(k);
        if !inside(c + offset) { continue; }
        var most = 1.0;
        for (var a = 0u; a < DIM; a++) { most *= select(0.5, 0.75, offset[a] == 0); }
        let source = slot_of(c + offset);
        crowd += most * f32(cell_start[source + 1u] - cell_start[source]);
    }
    return crowd;
}

@compute @workgroup_size(WORKGROUP)
fn scatter_resolve(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let unit = bounds[PARTIALS];
    // A wrapped sum must not pass for a result: a broken node value raises the fault of the next stage.
    let crowded = crowd_at(cell_of(slot)) > 1.9 * params.crowd;
    let broken = bitcast<f32>(0x7fc00000u + u32(params.slots == 0u));
    if WITH_MASS {
        var sum: vec4f;
        for (var a = 0u; a < 4u; a++) { sum[a] = f32(atomicLoad(&sums[4u * slot + a])); }
        let momentum = sum * vec4f(unit.yyy, unit.x);
        let v = select(vec3f(0.0), momentum.xyz / momentum.w, momentum.w > 0.0);
        node[slot] = select(vec4f(v, momentum.w), vec4f(broken), crowded);
    }
    if WITH_FORCE {
        for (var a = 4u; a < parts(); a++) {
            let force = f32(atomicLoad(&sums[4u * (params.slots + slot) + a - 4u])) * select(unit.z, unit.w, a == 7u);
            atomicStore(&sums[4u * (params.slots + slot) + a - 4u], bitcast<i32>(select(force, broken, crowded)));
        }
    }
}
