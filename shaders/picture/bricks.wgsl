// mark_bricks: reads corners, glow, visible; writes 1 for every brick of cubes that the ray march must enter.

#include "picture/view.wgsl"

@group(0) @binding(1) var<storage, read> corners: array<vec2u>;
@group(0) @binding(2) var<storage, read> glow: array<vec2u>;
@group(0) @binding(3) var<storage, read_write> bricks: array<u32>;
// Per entry of the colour table, how many entries before it are not transparent; then the same of the black-body ramp.
@group(0) @binding(4) var<storage, read> visible: array<u32>;

// Places in a table that rounding in the march may be off by.
const SLACK: f32 = 0.01;

// Whether an entry of a table that the march may read between two fractions is not transparent.
fn sees(low: f32, high: f32, table: u32) -> bool {
    let first = u32(low * f32(COLOR_COUNT - 1u) + 0.5 - SLACK);
    let last = min(u32(high * f32(COLOR_COUNT - 1u) + 0.5 + SLACK), COLOR_COUNT - 1u);
    let start = table * (COLOR_COUNT + 1u);
    return visible[start + last + 1u] > visible[start + first];
}

// Least and largest of eight packed fractions and what was seen before.
fn widened(bounds: vec2f, packed: vec2u) -> vec2f {
    let near = unpack4x8unorm(packed.x);
    let far = unpack4x8unorm(packed.y);
    let low = min(near, far);
    let high = max(near, far);
    return vec2f(min(bounds.x, min(min(low.x, low.y), min(low.z, low.w))),
                 max(bounds.y, max(max(high.x, high.y), max(high.z, high.w))));
}

@compute @workgroup_size(WORKGROUP)
fn mark_bricks(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    let grid = (view.cells + BRICK) / BRICK;
    if i >= grid.x * grid.y * grid.z { return; }
    let cubes = view.cells + 1u;
    let first = BRICK * vec3u(i % grid.x, (i / grid.x) % grid.y, i / (grid.x * grid.y));
    let end = min(first + BRICK, cubes);
    var bounds = vec2f(1.0, 0.0);
    var hot = vec2f(1.0, 0.0);
    var soot = 0.0;
    for (var z = first.z; z < end.z; z++) {
        for (var y = first.y; y < end.y; y++) {
            for (var x = first.x; x < end.x; x++) {
                let cube = x + cubes.x * (y + cubes.y * z);
                bounds = widened(bounds, corners[cube]);
                if view.heat_opacity > 0.0 { hot = widened(hot, glow[glow_place(cube)]); }
                if view.soot > 0.0 { soot = max(soot, widened(vec2f(1.0, 0.0), glow[glow_place(cube) + 1u]).y); }
                if view.dust > 0.0 { soot = max(soot, widened(vec2f(1.0, 0.0), glow[dust_place(cube)]).y); }
            }
        }
    }
    let shines = view.heat_opacity > 0.0 && sees(hot.x, hot.y, 1u);
    bricks[i] = u32(sees(bounds.x, bounds.y, 0u)) | (u32(shines) << 1u) | (u32(soot > 0.0) << 2u);
}
