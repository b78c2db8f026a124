// Sum, minimum or maximum of an array.
// Equation: result[g] = op over i of values[i], i = thread, thread + threads, ... of workgroup g.
// Reads: values. Writes: result, one number per workgroup; a second dispatch of one workgroup makes it one number.

#include "shared/reduce.wgsl"

struct ReduceParams {
    // Number of values.
    count: u32,
    // Threads of the dispatch.
    threads: u32,
}

@group(0) @binding(0) var<uniform> params: ReduceParams;
@group(0) @binding(1) var<storage, read> values: array<f32>;
@group(0) @binding(2) var<storage, read_write> result: array<f32>;

// Neutral elements of minimum and maximum: the largest finite f32, with both signs.
const LARGEST: f32 = 3.4028234e38;

@compute @workgroup_size(WORKGROUP)
fn reduce_sum(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    var sum = 0.0;
    for (var i = workgroup.x * WORKGROUP + local; i < params.count; i += params.threads) {
        sum += values[i];
    }
    sum = workgroup_sum(local, sum);
    if local == 0u { result[workgroup.x] = sum; }
}

@compute @workgroup_size(WORKGROUP)
fn reduce_min(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    var smallest = LARGEST;
    for (var i = workgroup.x * WORKGROUP + local; i < params.count; i += params.threads) {
        smallest = min(smallest, values[i]);
    }
    smallest = workgroup_min(local, smallest);
    if local == 0u { result[workgroup.x] = smallest; }
}

@compute @workgroup_size(WORKGROUP)
fn reduce_max(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    var largest = -LARGEST;
    for (var i = workgroup.x * WORKGROUP + local; i < params.count; i += params.threads) {
        largest = max(largest, values[i]);
    }
    largest = workgroup_max(local, largest);
    if local == 0u { result[workgroup.x] = largest; }
}
