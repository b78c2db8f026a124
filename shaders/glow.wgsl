// Light of hot gas on surfaces: a coarse grid of the light that arrives from everywhere in the domain. Nothing stands in its way.
// gather_glow: reads corners, glow, colors; writes sources, the light that leaves each coarse cell, per solid angle.
// spread_glow: reads sources; writes glow_grid: direction and strength of what arrives in each coarse cell, then its colour.

#include "shared/thread.wgsl"
#include "shared/view.wgsl"
#include "shared/gas_look.wgsl"

@group(0) @binding(1) var<storage, read> corners: array<vec2u>;
@group(0) @binding(2) var<storage, read> glow: array<vec2u>;
@group(0) @binding(3) var<storage, read> colors: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> sources: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> glow_grid: array<vec4f>;

// Places of a coarse cell that are looked at, along each axis.
const PLACES: u32 = 4u;

// Edges of a coarse cell, in cells.
fn coarse() -> vec3f {
    return vec3f(view.cells) / f32(GLOW_CELLS);
}

fn coarse_cell(i: u32) -> vec3f {
    return vec3f(vec3u(i % GLOW_CELLS, (i / GLOW_CELLS) % GLOW_CELLS, i / (GLOW_CELLS * GLOW_CELLS)));
}

@compute @workgroup_size(WORKGROUP)
fn gather_glow(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
               @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, groups, local);
    if (i >= GLOW_CELLS * GLOW_CELLS * GLOW_CELLS) {
        return;
    }
    let edges = coarse() * view.spacing;
    let volume = edges.x * edges.y * edges.z;
    let across = pow(volume, 1.0 / 3.0);
    var sum = vec3f(0.0);
    for (var k = 0u; k < PLACES * PLACES * PLACES; k++) {
        let part = vec3f(vec3u(k % PLACES, (k / PLACES) % PLACES, k / (PLACES * PLACES)));
        let gas = optics_at((coarse_cell(i) + (part + 0.5) / f32(PLACES)) * coarse());
        // Thick gas shows its surface only.
        sum += gas.glow * (1.0 - exp(-gas.shining * across)) / across;
    }
    sources[i] = vec4f(sum * volume / f32(PLACES * PLACES * PLACES), 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn spread_glow(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
               @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, groups, local);
    let count = GLOW_CELLS * GLOW_CELLS * GLOW_CELLS;
    if (i >= count) {
        return;
    }
    let edges = coarse() * view.spacing;
    let soft = 0.25 * dot(edges, edges) / 3.0;
    let here = coarse_cell(i);
    var arriving = vec3f(0.0);
    var color = vec3f(0.0);
    for (var j = 0u; j < count; j++) {
        let source = sources[j].rgb;
        let brightness = dot(source, vec3f(0.2126, 0.7152, 0.0722));
        if (brightness > 0.0) {
            let away = (coarse_cell(j) - here) * edges;
            let square = dot(away, away);
            let share = 1.0 / (square + soft);
            arriving += brightness * share * away / sqrt(square + soft);
            color += share * source;
        }
    }
    let whole = dot(color, vec3f(0.2126, 0.7152, 0.0722));
    glow_grid[2u * i] = vec4f(arriving, 0.0);
    glow_grid[2u * i + 1u] = vec4f(color / max(whole, 1e-20), 0.0);
}
