// Light of hot gas on surfaces: a coarse grid of the light that arrives from everywhere in the domain, past the bodies between.
// gather_glow: reads corners, glow, colors; writes sources, the light that leaves each coarse cell, per solid angle.
// block_bodies: reads balls; adds to blocks, the share of each cell of a finer grid that particles fill.
// block_walls: reads distance; fills blocks where obstacles are.
// spread_glow: reads sources, blocks; writes glow_grid: direction and strength of what arrives in each coarse cell, then its colour.

#include "picture/view.wgsl"
#include "picture/gas_look.wgsl"
#include "picture/distance.wgsl"

@group(0) @binding(1) var<storage, read> corners: array<vec2u>;
@group(0) @binding(2) var<storage, read> glow: array<vec2u>;
@group(0) @binding(3) var<storage, read> colors: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> sources: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> glow_grid: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> blocks: array<atomic<u32>>;
@group(0) @binding(7) var<storage, read> balls: array<vec4f>;
@group(0) @binding(8) var<storage, read> distance: array<f32>;

// A full cell of the blocks. Shares are whole numbers, so that their sum does not depend on its order.
const FULL: f32 = 1048576.0;
// Optical depth of a full cell: a sheet that fills a part of it hides what is behind, too.
const BLOCK_DEPTH: f32 = 6.0;
// What is so near to the place where light arrives, in cells of the blocks, is the body itself: its surfaces turn away from the light.
const OWN_BODY: f32 = 1.5;

// Places of a coarse cell that are looked at, along each axis.
const PLACES: u32 = 4u;

// Edges of a coarse cell, in cells.
fn coarse() -> vec3f { return vec3f(view.cells) / f32(GLOW_CELLS); }

fn coarse_cell(i: u32) -> vec3f {
    return vec3f(vec3u(i % GLOW_CELLS, (i / GLOW_CELLS) % GLOW_CELLS, i / (GLOW_CELLS * GLOW_CELLS)));
}

@compute @workgroup_size(WORKGROUP)
fn gather_glow(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= GLOW_CELLS * GLOW_CELLS * GLOW_CELLS { return; }
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

fn block_index(place: vec3f) -> u32 {
    let cell = vec3u(clamp(place, vec3f(0.0), vec3f(f32(BLOCK_CELLS) - 0.5)));
    return cell.x + BLOCK_CELLS * (cell.y + BLOCK_CELLS * cell.z);
}

// Edges of a cell of the blocks, in cells.
fn block_edges() -> vec3f { return vec3f(view.cells) / f32(BLOCK_CELLS); }

@compute @workgroup_size(WORKGROUP)
fn block_bodies(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, local);
    if p >= view.particles || balls[2u * p].w == 0.0 { return; }
    let edge = balls[2u * p].w / view.particle_scale / view.spacing;
    let whole = block_edges();
    let share = min(edge * edge * edge / (whole.x * whole.y * whole.z), 1.0);
    let place = in_cells(balls[2u * p].xyz) / whole;
    if all(place >= vec3f(0.0)) && all(place < vec3f(f32(BLOCK_CELLS))) {
        atomicAdd(&blocks[block_index(place)], u32(share * FULL + 0.5));
    }
}

@compute @workgroup_size(WORKGROUP)
fn block_walls(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= BLOCK_CELLS * BLOCK_CELLS * BLOCK_CELLS { return; }
    let cell = vec3u(i % BLOCK_CELLS, (i / BLOCK_CELLS) % BLOCK_CELLS, i / (BLOCK_CELLS * BLOCK_CELLS));
    if distance_at((vec3f(cell) + 0.5) * block_edges()) < 0.0 { atomicMax(&blocks[i], u32(FULL)); }
}

// Share of the light that passes the bodies from one place to another, both in cells of the blocks.
fn passing(here: vec3f, there: vec3f) -> f32 {
    let along = there - here;
    let reach = length(along);
    let count = ceil(reach);
    var depth = 0.0;
    for (var k = 0.0; k < count; k += 1.0) {
        let part = (k + 0.5) / count;
        if part * reach > OWN_BODY {
            let filled = f32(atomicLoad(&blocks[block_index(here + part * along)])) / FULL;
            depth += reach / count * min(filled, 1.0);
        }
    }
    return exp(-BLOCK_DEPTH * depth);
}

@compute @workgroup_size(WORKGROUP)
fn spread_glow(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    let count = GLOW_CELLS * GLOW_CELLS * GLOW_CELLS;
    if i >= count { return; }
    let edges = coarse() * view.spacing;
    let soft = 0.25 * dot(edges, edges) / 3.0;
    let here = coarse_cell(i);
    var arriving = vec3f(0.0);
    var color = vec3f(0.0);
    for (var j = 0u; j < count; j++) {
        let source = sources[j].rgb;
        let brightness = dot(source, vec3f(0.2126, 0.7152, 0.0722));
        if brightness > 0.0 {
            let away = (coarse_cell(j) - here) * edges;
            let square = dot(away, away);
            var share = 1.0 / (square + soft);
            if view.shadows == 1u {
                let finer = f32(BLOCK_CELLS) / f32(GLOW_CELLS);
                share *= passing((here + 0.5) * finer, (coarse_cell(j) + 0.5) * finer);
            }
            arriving += brightness * share * away / sqrt(square + soft);
            color += share * source;
        }
    }
    let whole = dot(color, vec3f(0.2126, 0.7152, 0.0722));
    glow_grid[2u * i] = vec4f(arriving, 0.0);
    glow_grid[2u * i + 1u] = vec4f(color / max(whole, 1e-20), 0.0);
}
