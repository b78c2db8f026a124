// The gas as the ray march and the light see it: reads corners, glow and colors.

// Whether hot gas shines.
override EMISSION: bool = true;

// The packed values of the cube of eight cell centres around a place, and the place inside of it.
struct Cube {
    index: u32,
    inside: vec3f,
}

// Place in cells from the low corner of the domain.
fn cube_at(place: vec3f) -> Cube {
    let from_cube = clamp(place + 0.5, vec3f(0.0), vec3f(view.cells) + 0.999);
    let cube = vec3u(from_cube);
    let index = cube.x + (view.cells.x + 1u) * (cube.y + (view.cells.y + 1u) * cube.z);
    return Cube(index, from_cube - vec3f(cube));
}

fn interpolated(packed: vec2u, w: vec3f) -> f32 {
    let slab = mix(unpack4x8unorm(packed.x), unpack4x8unorm(packed.y), w.z);
    let row = mix(slab.xy, slab.zw, w.y);
    return mix(row.x, row.y, w.x);
}

// Colour and opacity of a fraction of the range.
fn table_color(fraction: f32) -> vec4f { return colors[u32(fraction * f32(COLOR_COUNT - 1u) + 0.5)]; }

// Light and opacity of hot gas.
fn ramp_color(heat: f32) -> vec4f { return colors[COLOR_COUNT + u32(heat * f32(COLOR_COUNT - 1u) + 0.5)]; }

// What a piece of the gas adds to a ray.
struct Optics {
    // Colour that scatters light.
    color: vec3f,
    // Its extinction [m^-1].
    extinction: f32,
    // Light that comes from the gas itself.
    glow: vec3f,
    // Extinction of what shines [m^-1].
    shining: f32,
}

fn optics_at(place: vec3f) -> Optics {
    let cube = cube_at(place);
    let look = table_color(interpolated(corners[cube.index], cube.inside));
    var gas = Optics(look.rgb, view.opacity * look.a, vec3f(0.0), 0.0);
    if EMISSION {
        let hot = ramp_color(interpolated(glow[cube.index], cube.inside));
        gas.glow = hot.rgb;
        gas.shining = view.heat_opacity * hot.a;
    }
    return gas;
}
