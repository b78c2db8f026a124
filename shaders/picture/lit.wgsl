// Lit surfaces: reads light_grid; shadow_map, the distance from the light of the first solid; and glow_grid, see glow.wgsl.

#include "picture/in_light.wgsl"

// Light that arrives through the gas at a point of a surface, interpolated across the light.
fn light_through_gas(point: vec3f) -> f32 {
    let place = in_light(point);
    let low = floor(place.xy - 0.5);
    let w = place.xy - 0.5 - low;
    var sum = 0.0;
    for (var corner = 0u; corner < 4u; corner++) {
        let offset = vec2f(f32(corner & 1u), f32(corner >> 1u));
        let share = abs(1.0 - offset - w);
        sum += share.x * share.y * light_at(vec3f(low + offset + 0.5, place.z)).x;
    }
    return sum;
}

// Share of the light that passes solids and arrives at a point of a surface; nothing nearer than `bias` [m] counts.
fn light_past_solids(point: vec3f, bias: f32) -> f32 {
    let place = in_light(point);
    let texels = f32(SHADOW_TEXELS);
    let middle = place.xy / f32(LIGHT_CELLS) * texels;
    if view.shadows == 0u || any(middle < vec2f(4.0)) || any(middle >= vec2f(texels - 4.0)) { return 1.0; }
    let distance = place.z * view.light_spacing - bias;
    // A square window of four texels that slides smoothly: five by five, the outer ones weighted by their part inside.
    let corner = middle - 2.0;
    let first = vec2u(corner);
    let part = corner - floor(corner);
    var passing = 0.0;
    for (var y = 0u; y < 5u; y++) {
        let high = select(1.0, select(1.0 - part.y, part.y, y == 4u), y == 0u || y == 4u);
        for (var x = 0u; x < 5u; x++) {
            let wide = select(1.0, select(1.0 - part.x, part.x, x == 4u), x == 0u || x == 4u);
            let nearest = bitcast<f32>(shadow_map[first.x + x + SHADOW_TEXELS * (first.y + y)]);
            passing += 0.0625 * wide * high * f32(distance < nearest);
        }
    }
    return passing;
}

// Whether hot gas shines.
override EMISSION: bool = true;

// Light of hot gas that a surface sends on.
fn light_of_gas(point: vec3f, normal: vec3f) -> vec3f {
    if !EMISSION { return vec3f(0.0); }
    let cells = f32(GLOW_CELLS);
    let place = clamp(in_cells(point) / vec3f(view.cells) * cells - 0.5, vec3f(0.0), vec3f(cells - 1.001));
    let low = vec3u(place);
    let w = place - vec3f(low);
    var arriving = vec3f(0.0);
    var color = vec3f(0.0);
    for (var corner = 0u; corner < 8u; corner++) {
        let offset = vec3u(corner & 1u, (corner >> 1u) & 1u, corner >> 2u);
        let share = abs(1.0 - vec3f(offset) - w);
        let cell = low + offset;
        let index = 2u * (cell.x + GLOW_CELLS * (cell.y + GLOW_CELLS * cell.z));
        arriving += share.x * share.y * share.z * glow_grid[index].xyz;
        color += share.x * share.y * share.z * glow_grid[index + 1u].rgb;
    }
    // Beyond the domain it fades with the square of the distance from the middle.
    let away = in_cells(point) - 0.5 * vec3f(view.cells);
    let inside = clamp(away, -0.5 * vec3f(view.cells), 0.5 * vec3f(view.cells));
    let fading = (dot(inside, inside) + 1.0) / (dot(away, away) + 1.0);
    return fading * color * max(dot(arriving, normal), 0.0) / 3.1416;
}

// Share of the light that arrives at a point of a surface, past solids and through the gas.
fn arriving_at(point: vec3f, bias: f32) -> f32 {
    return light_through_gas(point + bias * view.light) * light_past_solids(point, bias);
}

// A lit surface [Lambert]: the light, of which a share arrives, the sky, hot gas, a little sheen.
fn lit_surface(base: vec3f, point: vec3f, normal: vec3f, towards_eye: vec3f, arriving: f32) -> vec3f {
    let lambert = max(dot(normal, view.light), 0.0);
    let sky = 0.35 + 0.65 * (0.5 + 0.5 * dot(normal, view.up));
    let sheen = pow(max(dot(normal, normalize(view.light + towards_eye)), 0.0), 30.0);
    let rim = pow(1.0 - max(dot(normal, towards_eye), 0.0), 3.0);
    let direct = view.light_strength * arriving;
    let outside = direct * lambert + view.sky_strength * (sky + 0.3 * rim);
    return base * (outside + light_of_gas(point, normal)) + 0.08 * direct * sheen;
}
