// detonate: energy for the gas in a ball, evenly over its volume: pressure rises, density and velocity stay. Cells of a cut cluster
// share one state, so the centre of their first one decides for all. Reads cells, extra. Writes partials, energy.
#include "shared/domain.wgsl"
#include "shared/reduce.wgsl"

// Generated from src/stage/gas/detonate.rs by scripts/generate.
struct Blast {
    center: vec3f,              // Its middle, in cells from the low corner of the domain
    radius: f32,                // In cells
    rise: f32,                  // Energy per volume [J m^-3]
}
// End of what is generated.

@group(0) @binding(1) var<uniform> blast: Blast;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> extra: array<u32>;
@group(0) @binding(4) var<storage, read_write> partials: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> energy: array<f32>;

// Gas of a slot that belongs to the ball, in cells.
fn share_in_ball(slot: u32) -> f32 {
    if kind_of(cells[slot]) != GAS || !inside(cell_of(slot)) || is_alias(cell_of(slot)) { return 0.0; }
    var away = (vec3f(cell_of(cluster_first(slot))) + 0.5 - blast.center) * vec3f(reach());
    let size = vec3f(params.cells);
    away = select(away, away - size * round(away / size), periodic_axes());
    return select(0.0, gas_share(slot), length(away) < blast.radius);
}

@compute @workgroup_size(WORKGROUP)
fn detonate_volume(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var sum = 0.0;
    for (var slot = thread_index(group, lane); slot < params.slots; slot += striding_threads()) {
        sum += share_in_ball(slot);
    }
    sum = workgroup_sum(lane, sum);
    if lane == 0u { partials[group_index(group)] = vec4f(sum, 0.0, 0.0, 0.0); }
}

@compute @workgroup_size(WORKGROUP)
fn detonate_heat(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    if share_in_ball(slot) > 0.0 { energy[slot] += blast.rise; }
}
