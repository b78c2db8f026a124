// coupled_solve, end: X = X* + D.
#include "shared/params.wgsl"
#include "shared/arrays.wgsl"
#include "shared/pcg.wgsl"
#include "shared/thread.wgsl"
#include "shared/runs.wgsl"

@group(0) @binding(1) var<storage, read_write> pressure: array<f32>;
@group(0) @binding(2) var<storage, read> extra: array<u32>;
@group(0) @binding(5) var<storage, read> solution: array<f32>;
@group(0) @binding(6) var<storage, read> direction: array<f32>;
@group(0) @binding(7) var<storage, read> pcg: Pcg;

fn add(i: u32) { pressure[i] += solution[i] + pcg.alpha * direction[i]; }

@compute @workgroup_size(WORKGROUP)
fn solve_add(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let runs = runs_of(thread);
    for (var run = runs.first; run < runs.end; run += runs.step) {
        let own = run_slot(run, thread);
        if own.any { add(own.slot); }
    }
    for (var k = thread; k < 2u * params.extra_capacity; k += striding_threads()) { add(apart_h(k)); }
}
