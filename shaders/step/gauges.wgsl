// gauges: what points of bodies do, after every step.
// gauge_record: reads particles; writes the state of each particle that has a gauge into their history ring.
#include "shared/state.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> position: array<vec4f>;
@group(0) @binding(3) var<storage, read> velocity: array<vec4f>;
@group(0) @binding(4) var<storage, read> affine: array<vec4f>;
@group(0) @binding(5) var<storage, read> deformation: array<vec4f>;
@group(0) @binding(6) var<storage, read> stress: array<vec4f>;
@group(0) @binding(7) var<storage, read> gauge_particles: array<u32>;
@group(0) @binding(8) var<storage, read_write> gauge_history: array<vec4f>;

override GAUGES: u32;           // points that have gauges

// One workgroup.
@compute @workgroup_size(WORKGROUP)
fn gauge_record(@builtin(local_invocation_index) lane: u32) {
    let base = ((control.step + params.history - 1u) % params.history) * GAUGES;
    for (var k = lane; k < GAUGES; k += WORKGROUP) {
        let p = gauge_particles[k];
        let at = GAUGE_WIDTH * (base + k);
        if p >= params.particles { continue; }
        gauge_history[at] = position[p];
        gauge_history[at + 1u] = velocity[p];
        for (var column = 0u; column < 3u; column++) {
            gauge_history[at + 2u + column] = affine[3u * p + column];
            gauge_history[at + 5u + column] = deformation[3u * p + column];
        }
        gauge_history[at + 8u] = stress[2u * p];
        gauge_history[at + 9u] = stress[2u * p + 1u];
    }
}
