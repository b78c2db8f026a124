// particle_sort: which particles touch which cell?
// Reads positions. Writes cell_start (first entry of each slot in `order`) and order. On return `order` lists the active
// particles cell by cell, ascending by index inside a cell: the same on every run, whatever the order of the atomics.
#include "shared/index.wgsl"

@group(0) @binding(1) var<storage, read> position: array<vec4f>;
@group(0) @binding(2) var<storage, read> deformation: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> count: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> cell_start: array<u32>; // slots + 1 entries
@group(0) @binding(5) var<storage, read_write> order: array<u32>;

fn is_active(p: u32) -> bool { return deformation[3u * p + 1u].w > 0.0; }

fn slot_of_particle(p: u32) -> u32 { return slot_of(cell_at(position[p].xyz)); }

@compute @workgroup_size(WORKGROUP)
fn sort_clear(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot < params.slots { atomicStore(&count[slot], 0u); }
}

@compute @workgroup_size(WORKGROUP)
fn sort_count(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let p = thread_index(group, lane);
    if p < params.particles && is_active(p) { atomicAdd(&count[slot_of_particle(p)], 1u); }
}

// After the scan of `count` into `cell_start`: count runs down to zero while the particles take their places, from the first on:
// threads that run in order leave little to sort.
@compute @workgroup_size(WORKGROUP)
fn sort_place(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let p = thread_index(group, lane);
    if p >= params.particles || !is_active(p) { return; }
    let slot = slot_of_particle(p);
    order[cell_start[slot + 1u] - atomicSub(&count[slot], 1u)] = p;
}

// Insertion sort inside each cell: a handful of entries.
@compute @workgroup_size(WORKGROUP)
fn sort_within_cells(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let first = cell_start[slot];
    let end = cell_start[slot + 1u];
    if first == end { return; }
    var largest = order[first];
    for (var i = first + 1u; i < end; i++) {
        let moving = order[i];
        if moving > largest {
            largest = moving;
            continue;
        }
        var j = i;
        while j > first && order[j - 1u] > moving {
            order[j] = order[j - 1u];
            j--;
        }
        order[j] = moving;
    }
}
