// Shadows: which solids the light meets first, and how much of it passes the gas.
// clear_shadow: writes shadow_bits: nothing in the way.
// splat_shadow: reads balls; lowers shadow_bits to the nearest sphere.
// trace_shadow: reads distance; lowers shadow_bits to the nearest obstacle.
// cast_light: reads corners, glow, colors, shadow_bits; writes light_grid, column by column away from the light.

#include "picture/view.wgsl"
#include "picture/gas_look.wgsl"
#include "picture/distance.wgsl"
#include "picture/growth.wgsl"

@group(0) @binding(1) var<storage, read> balls: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> shadow_bits: array<atomic<u32>>;
@group(0) @binding(3) var<storage, read> distance: array<f32>;
@group(0) @binding(4) var<storage, read> corners: array<vec2u>;
@group(0) @binding(5) var<storage, read> glow: array<vec2u>;
@group(0) @binding(6) var<storage, read> colors: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> light_grid: array<u32>;

// No solid in the way [m].
const FAR: f32 = 1e30;

fn texel_size() -> f32 { return view.light_spacing * f32(LIGHT_CELLS) / f32(SHADOW_TEXELS); }

// A point of the light grid in space; place in metres: across, across, away from the light.
fn from_light(place: vec3f) -> vec3f {
    return view.light_origin + place.x * view.light_right + place.y * view.light_up - place.z * view.light;
}

@compute @workgroup_size(WORKGROUP)
fn clear_shadow(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i < SHADOW_TEXELS * SHADOW_TEXELS { atomicStore(&shadow_bits[i], bitcast<u32>(FAR)); }
}

@compute @workgroup_size(WORKGROUP)
fn splat_shadow(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, local);
    if p >= view.particles || balls[2u * p].w == 0.0 { return; }
    // Stretched bodies let no light through.
    let radius = balls[2u * p].w * clamp(balls[2u * p + 1u].w / CLOSING, 1.0, 1.4);
    let q = balls[2u * p].xyz - view.light_origin;
    let centre = vec3f(dot(q, view.light_right), dot(q, view.light_up), -dot(q, view.light));
    let texel = texel_size();
    // A sphere smaller than a texel still covers the nearest one.
    let reach = max(radius, 0.75 * texel);
    let limit = vec2f(f32(SHADOW_TEXELS));
    let low = vec2u(clamp((centre.xy - reach) / texel, vec2f(0.0), limit));
    let high = vec2u(clamp((centre.xy + reach) / texel + 1.0, vec2f(0.0), limit));
    for (var y = low.y; y < high.y; y++) {
        for (var x = low.x; x < high.x; x++) {
            let offset = (vec2f(f32(x), f32(y)) + 0.5) * texel - centre.xy;
            let inside = reach * reach - dot(offset, offset);
            if inside >= 0.0 {
                let depth = max(centre.z - min(sqrt(inside), radius), 0.0);
                // Positive floats order like their bits.
                atomicMin(&shadow_bits[x + SHADOW_TEXELS * y], bitcast<u32>(depth));
            }
        }
    }
}

@compute @workgroup_size(WORKGROUP)
fn trace_shadow(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= SHADOW_TEXELS * SHADOW_TEXELS { return; }
    let place = (vec2f(f32(i % SHADOW_TEXELS), f32(i / SHADOW_TEXELS)) + 0.5) * texel_size();
    let ray = Ray(from_light(vec3f(place, 0.0)), -view.light);
    let hit = hit_obstacle(ray, domain_span(ray));
    if hit >= 0.0 { atomicMin(&shadow_bits[i], bitcast<u32>(hit)); }
}

@compute @workgroup_size(WORKGROUP)
fn cast_light(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= LIGHT_CELLS * LIGHT_CELLS { return; }
    let column = vec2u(i % LIGHT_CELLS, i / LIGHT_CELLS);
    let ray = Ray(from_light(vec3f((vec2f(column) + 0.5) * view.light_spacing, 0.0)), -view.light);
    let span = domain_span(ray);
    let texels = SHADOW_TEXELS / LIGHT_CELLS;
    var nearest = array<f32, 4>();
    for (var k = 0u; k < 4u; k++) {
        let texel = column * texels + texels / 4u + (texels / 2u) * vec2u(k & 1u, k >> 1u);
        nearest[k] = bitcast<f32>(atomicLoad(&shadow_bits[texel.x + SHADOW_TEXELS * texel.y]));
    }
    var depth = 0.0;
    for (var layer = 0u; layer < LIGHT_CELLS; layer++) {
        let s = (f32(layer) + 0.5) * view.light_spacing;
        var own = 0.0;
        if s > span.x && s < span.y && view.volume == 1u {
            let gas = optics_at(in_cells(ray.start + s * ray.direction));
            own = (gas.extinction + gas.shining) * view.light_spacing;
        }
        let passing = exp(-depth - 0.5 * own);
        depth += own;
        var seen = 0.0;
        for (var k = 0u; k < 4u; k++) {
            seen += 0.25 * f32(s < nearest[k]);
        }
        light_grid[i + LIGHT_CELLS * LIGHT_CELLS * layer] = pack2x16unorm(vec2f(passing, passing * seen));
    }
}
