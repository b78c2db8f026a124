// The light that arrives in the gas: reads light_grid, the light that passes the gas up to each cell of a grid along the light,
// alone and with the shadows of solids, 16 bits each.

// A point in cells of the light grid: across, across, away from the light.
fn in_light(point: vec3f) -> vec3f {
    let q = point - view.light_origin;
    return vec3f(dot(q, view.light_right), dot(q, view.light_up), -dot(q, view.light)) / view.light_spacing;
}

// Light that arrives in the nearest cell: through the gas alone, and past solids too.
fn light_inside(place: vec3f) -> vec2f {
    let cell = vec3u(clamp(place, vec3f(0.0), vec3f(f32(LIGHT_CELLS) - 0.5)));
    return unpack2x16unorm(light_grid[cell.x + LIGHT_CELLS * (cell.y + LIGHT_CELLS * cell.z)]);
}

// The same past solids, between the middles of cells: in smoke a step from cell to cell would be seen.
fn light_between(place: vec3f) -> f32 {
    let low = floor(place - 0.5);
    let part = place - 0.5 - low;
    var sum = 0.0;
    for (var corner = 0u; corner < 8u; corner++) {
        let offset = vec3f(vec3u(corner & 1u, (corner >> 1u) & 1u, corner >> 2u));
        let share = abs(1.0 - offset - part);
        sum += share.x * share.y * share.z * light_inside(low + offset + 0.5).y;
    }
    return sum;
}

// Light that arrives at a place of the light grid: through the gas alone, and past solids too.
fn light_at(place: vec3f) -> vec2f {
    let cells = f32(LIGHT_CELLS);
    if view.shadows == 0u || any(place.xy < vec2f(0.0)) || any(place.xy >= vec2f(cells)) {
        return vec2f(1.0);
    }
    return light_inside(place);
}
