// The gas as the ray march and the light see it: reads corners, glow and colors.

// Whether hot gas shines, whether the second gas absorbs light, and whether dust does.
override EMISSION: bool = true;
override SOOT: bool = true;
override DUST: bool = true;

// Share of the light that soot scatters, by colour.
const SOOT_COLOR: vec3f = vec3f(0.11, 0.10, 0.09);

fn has_soot() -> bool { return SOOT && view.soot > 0.0; }
fn has_dust() -> bool { return DUST && view.dust > 0.0; }

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

// Entry of `colors` with colour and opacity of a fraction of the range.
fn table_place(fraction: f32) -> u32 { return u32(fraction * f32(COLOR_COUNT - 1u) + 0.5); }

// The same with light and opacity of hot gas.
fn ramp_place(heat: f32) -> u32 { return COLOR_COUNT + u32(heat * f32(COLOR_COUNT - 1u) + 0.5); }

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

// Soot absorbs, scatters a little, and shines as far as it is hot: clear gas then does not shine.
fn with_soot(clear: Optics, cube: Cube) -> Optics {
    let packed = interpolated(glow[glow_place(cube.index) + 1u], cube.inside);
    let soot = SOOT_DEPTH * packed * packed / view.spacing;
    var gas = clear;
    gas.shining = soot * clear.shining / max(view.heat_opacity, 1e-20);
    let dark = soot - gas.shining;
    gas.extinction = clear.extinction + dark;
    gas.color = (clear.extinction * clear.color + dark * SOOT_COLOR) / max(gas.extinction, 1e-20);
    return gas;
}

// Dust scatters light in its colour; it does not shine.
fn with_dust(clear: Optics, cube: Cube) -> Optics {
    let packed = interpolated(glow[dust_place(cube.index)], cube.inside);
    let dust = SOOT_DEPTH * packed * packed / view.spacing;
    var gas = clear;
    gas.extinction = clear.extinction + dust;
    gas.color = (clear.extinction * clear.color + dust * view.dust_color.rgb) / max(gas.extinction, 1e-20);
    return gas;
}

// What a brick of cubes may hold, as bits: gas with colours that are not transparent, hot gas, soot or dust.
const COLORED: u32 = 1u;
const SHINING: u32 = 2u;
const SMOKY: u32 = 4u;
const ANYTHING: u32 = 7u;

// Cells before an open side over which gas fades: what reaches farther is cut off there.
const FADING: f32 = 3.0;

// What is seen of gas at a place.
fn fading(place: vec3f) -> f32 {
    let inside = min(place + view.far_from_low.xyz, vec3f(view.cells) - place + view.far_from_high.xyz);
    return clamp(min(inside.x, min(inside.y, inside.z)) / FADING, 0.0, 1.0);
}

// The gas at a place, of a brick that holds `what`. Colours are read where they count alone: in software a read costs as much as dozens of
// products.
fn optics_in(place: vec3f, what: u32) -> Optics {
    let cube = cube_at(place);
    var gas = Optics(vec3f(0.0), 0.0, vec3f(0.0), 0.0);
    if (what & COLORED) != 0u {
        let entry = table_place(interpolated(corners[cube.index], cube.inside));
        gas.extinction = view.opacity * colors[entry].a;
        if gas.extinction > 0.0 { gas.color = colors[entry].rgb; }
    }
    if EMISSION && (what & SHINING) != 0u {
        let entry = ramp_place(interpolated(glow[glow_place(cube.index)], cube.inside));
        gas.shining = view.heat_opacity * colors[entry].a;
        if gas.shining > 0.0 { gas.glow = colors[entry].rgb; }
    }
    if has_soot() { gas = with_soot(gas, cube); }
    if has_dust() { gas = with_dust(gas, cube); }
    let seen = fading(place);
    gas.extinction *= seen;
    gas.shining *= seen;
    return gas;
}

fn optics_at(place: vec3f) -> Optics { return optics_in(place, ANYTHING); }
