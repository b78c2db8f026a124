// coupled_solve, preparation of the solid: mass that the solve gives to each node. One that sees next to nothing of a body would fly
// off under the pressure around it: it gets a share of what a cell full of the lightest particles near it weighs. A whole body that is
// much lighter than the others keeps its own mass that way. A fragment of one particle spreads it over 3^d nodes: their shares must stay
// small against its own mass, or the solve takes it for heavier than it is, its answer overshoots, and the fragment swings ever wider.
// Reads sorted particles, node. Writes inertia [kg].
#include "shared/index.wgsl"

@group(0) @binding(1) var<storage, read> position: array<vec4f>;
@group(0) @binding(2) var<storage, read> velocity: array<vec4f>;
@group(0) @binding(3) var<storage, read> order: array<u32>;
@group(0) @binding(4) var<storage, read> cell_start: array<u32>;
@group(0) @binding(5) var<storage, read> node: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> inertia: array<f32>;

// Least density of the particles in the cells around a node [kg m^-3].
fn least_density(c: vec3i) -> f32 {
    var least = 3e38;
    for (var k = 0u; k < block_size(); k++) {
        let near = c + block_offset(k);
        if !inside(near) { continue; }
        let slot = slot_of(near);
        let end = cell_start[slot + 1u];
        for (var i = cell_start[slot]; i < end; i++) { least = min(least, position[order[i]].w / velocity[order[i]].w); }
    }
    return least;
}

// Mass of the heaviest node around one [kg].
fn heaviest(c: vec3i) -> f32 {
    var most = 0.0;
    for (var k = 0u; k < block_size(); k++) {
        let near = c + block_offset(k);
        if in_ring(near) { most = max(most, node[slot_of(near)].w); }
    }
    return most;
}

@compute @workgroup_size(WORKGROUP)
fn solid_inertia(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let mass = node[slot].w;
    // No floor is above that of the heaviest body.
    var least = params.mass_floor;
    if mass < least {
        let c = cell_of(slot);
        let most = heaviest(c);
        if most > 0.0 { least = min(least, min(LIGHTEST_NODE * cell_volume() * least_density(c), LIGHTEST_BESIDE[DIM - 1u] * most)); }
    }
    inertia[slot] = max(mass, least);
}
