// The quantity a picture shows, from the state of the gas.
// evaluate_field: reads conserved, energy, species, owed_flow, cells, maps; writes field and heat (p / rho), NO_VALUE where there is no gas.
// find_range: reads field; writes the least and largest value that each workgroup saw.
// pack_corners: reads field; writes, per cube between eight cell centres, their fractions of the range in 8 bits each.
// pack_glow: reads heat; writes the same cubes' places in the black-body ramp.
// pack_soot: reads species, cells; writes how much of the second gas is there, beside them.

#include "shared/reduce.wgsl"
#include "picture/view.wgsl"
#include "picture/packing.wgsl"

@group(0) @binding(1) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(2) var<storage, read> energy: array<f32>;
@group(0) @binding(3) var<storage, read> cells: array<u32>;
@group(0) @binding(4) var<storage, read_write> field: array<f32>;
@group(0) @binding(5) var<storage, read_write> ranges: array<vec2f>;
@group(0) @binding(6) var<storage, read_write> corners: array<vec2u>;
@group(0) @binding(8) var<storage, read_write> heat: array<f32>;
@group(0) @binding(9) var<storage, read_write> glow: array<vec2u>;
// Mass and momentum that a slot owes; one entry alone where no slot inside the domain has a ledger.
@group(0) @binding(11) var<storage, read> owed_flow: array<vec4f>;

// The second gas, see species_of(); the energy where there is none.
@group(0) @binding(13) var<storage, read> species: array<f32>;

// Largest pressure, impulse, what rounding took, largest plastic strain so far; one entry alone where no maps are kept.
@group(0) @binding(12) var<storage, read> maps: array<vec4f>;

// What a kernel is made for, because software computes all branches: two quantities that read around a cell, else all others; whether there
// is a second gas, and an explosive.
override SCHLIEREN: bool = false;
override VORTICITY: bool = false;
override MIXED: bool = true;
override EXPLOSIVE: bool = true;

fn has_gas(slot: u32) -> bool { return kind_of(cells[slot]) == KIND_GAS; }

// Density and velocity.
fn motion(slot: u32) -> vec4f {
    let state = conserved[slot];
    return vec4f(state.x, state.yzw / state.x);
}

// Density of the second gas, and its volume fraction.
fn species_of(slot: u32) -> vec2f {
    if !MIXED || view.species_gamma == 0.0 {
        return vec2f(0.0);
    }
    let slots = arrayLength(&conserved);
    return vec2f(species[view.species_start + slot], species[view.species_start + slots + slot]);
}

// gamma - 1 of the mixture.
fn grueneisen(slot: u32) -> f32 {
    if !MIXED || view.species_gamma == 0.0 {
        return view.gamma - 1.0;
    }
    return 1.0 / mix(1.0 / (view.gamma - 1.0), 1.0 / (view.species_gamma - 1.0), species_of(slot).y);
}

fn gamma(slot: u32) -> f32 {
    if !MIXED || view.species_gamma == 0.0 { return view.gamma; }
    return 1.0 + grueneisen(slot);
}

// x of both terms of the products of an explosive [shared/state.wgsl].
fn expansions(slot: u32) -> vec2f {
    let own = species_of(slot);
    let trace = 1e-6 * conserved[slot].x;
    return min(view.products.zw / clamp((own.x + trace) / (own.y + 1e-6), trace, view.densest), vec2f(80.0));
}

// Of an explosive: density of what has not burned, and volume fraction of what has.
fn unburned(slot: u32) -> f32 { return species[view.species_start + 2u * arrayLength(&conserved) + slot]; }
fn products_volume(slot: u32) -> f32 {
    let own = species_of(slot);
    return own.y * (1.0 - clamp(unburned(slot) / max(own.x, 1e-30) - view.fuel, 0.0, 1.0));
}

fn reference_energy(slot: u32) -> f32 {
    if !EXPLOSIVE || view.products.x == 0.0 {
        return 0.0;
    }
    let x = expansions(slot);
    let w = view.species_gamma - 1.0;
    let cold = dot(view.products.xy, (1.0 - w / x) * exp(-x));
    return view.chemical_energy * unburned(slot) - products_volume(slot) / w * cold;
}

// Pressure of products at no temperature.
fn cold_pressure(slot: u32) -> f32 {
    if !EXPLOSIVE || view.products.x == 0.0 {
        return 0.0;
    }
    return products_volume(slot) * dot(view.products.xy, exp(-expansions(slot)));
}

fn pressure(slot: u32) -> f32 {
    let state = conserved[slot];
    let kinetic = 0.5 * dot(state.yzw, state.yzw) / state.x;
    return grueneisen(slot) * (energy[slot] - kinetic - reference_energy(slot));
}

fn mass_fraction(slot: u32) -> f32 {
    return species_of(slot).x / conserved[slot].x;
}

// p / rho, over the gas constant of a mixture times that of the first gas.
fn temperature(slot: u32) -> f32 {
    let warm = (pressure(slot) - cold_pressure(slot)) / conserved[slot].x;
    if !MIXED || view.species_gamma == 0.0 { return warm; }
    return warm / mix(1.0, view.species_constant, mass_fraction(slot));
}

// Difference quotient of density and velocity along an active axis; one-sided next to cells without gas.
fn slope(cell: vec3i, axis: u32) -> vec4f {
    var step = vec3i(0);
    step[axis] = 1;
    let here = slot_of(cell);
    let below = slot_of(cell - step);
    let above = slot_of(cell + step);
    let low = select(here, below, has_gas(below));
    let high = select(here, above, has_gas(above));
    let distance = view.spacing * f32(u32(low != here) + u32(high != here));
    if distance == 0.0 { return vec4f(0.0); }
    return (motion(high) - motion(low)) / distance;
}

fn density_gradient(cell: vec3i) -> f32 {
    var squared = 0.0;
    for (var axis = 0u; axis < view.dimension; axis++) {
        let along = slope(cell, axis).x;
        squared += along * along;
    }
    return sqrt(squared);
}

fn vorticity(cell: vec3i) -> f32 {
    var gradient = array<vec3f, 3>(vec3f(0.0), vec3f(0.0), vec3f(0.0));
    for (var axis = 0u; axis < view.dimension; axis++) {
        gradient[axis] = slope(cell, axis).yzw;
    }
    let curl = vec3f(gradient[1].z - gradient[2].y, gradient[2].x - gradient[0].z, gradient[0].y - gradient[1].x);
    return length(curl);
}

// Gas that a cell owes per volume, and of a covered cell all that it holds.
fn owed_gas(slot: u32) -> f32 {
    var owed = 0.0;
    if slot < arrayLength(&owed_flow) { owed = owed_flow[slot].x / pow(view.spacing, f32(view.dimension)); }
    return owed + select(0.0, conserved[slot].x, is_covered(slot));
}

fn is_covered(slot: u32) -> bool { return kind_of(cells[slot]) == KIND_SOLID; }

fn is_map() -> bool {
    return view.field == FIELD_PEAK_PRESSURE || view.field == FIELD_IMPULSE || view.field == FIELD_PEAK_PLASTIC_STRAIN;
}

// What a place has seen so far, also where a body is now.
fn mapped(slot: u32) -> f32 {
    if slot >= arrayLength(&maps) || kind_of(cells[slot]) == KIND_WALL { return NO_VALUE; }
    let seen = maps[slot];
    if view.field == FIELD_IMPULSE { return seen.y; }
    return select(seen.x, seen.w, view.field == FIELD_PEAK_PLASTIC_STRAIN);
}

fn value(cell: vec3i, slot: u32) -> f32 {
    if SCHLIEREN { return density_gradient(cell); }
    if VORTICITY { return vorticity(cell); }
    let state = motion(slot);
    let speed = length(state.yzw);
    switch (view.field) {
        case FIELD_PRESSURE: { return pressure(slot); }
        case FIELD_VELOCITY: { return speed; }
        case FIELD_TEMPERATURE: { return temperature(slot); }
        case FIELD_MACH: { return speed / sqrt(gamma(slot) * max(pressure(slot), 1e-30) / state.x); }
        case FIELD_ENTROPY: { return pressure(slot) * pow(state.x, -gamma(slot)); }
        case FIELD_MASS_FRACTION: { return mass_fraction(slot); }
        case FIELD_OWED: { return owed_gas(slot); }
        case FIELD_DUST: { return 0.0; }
        default: { return state.x; }
    }
}

@compute @workgroup_size(WORKGROUP)
fn evaluate_field(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= cell_count() { return; }
    let cell = cell_of(i);
    let slot = slot_of(cell);
    var result = NO_VALUE;
    var hot = NO_VALUE;
    if has_gas(slot) {
        let computed = value(cell, slot);
        // By its bits: fast arithmetic may take every comparison with NaN for true.
        if (bitcast<u32>(computed) & 0x7f800000u) != 0x7f800000u && abs(computed) < -NO_VALUE {
            result = computed;
        }
        hot = max(temperature(slot), 0.0);
    }
    if view.field == FIELD_OWED && is_covered(slot) { result = owed_gas(slot); }
    if is_map() { result = mapped(slot); }
    field[i] = result;
    heat[i] = hot;
}

@compute @workgroup_size(WORKGROUP)
fn find_range(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    var low = -NO_VALUE;
    var high = NO_VALUE;
    for (var i = thread_index(workgroup, local); i < cell_count(); i += RANGE_GROUPS * WORKGROUP) {
        let seen = field[i];
        if seen != NO_VALUE {
            low = min(low, seen);
            high = max(high, seen);
        }
    }
    low = workgroup_min(local, low);
    high = workgroup_max(local, high);
    if local == 0u { ranges[workgroup.x] = vec2f(low, high); }
}

// Place of a cell in the arrays without ring; cells beyond the sides are those at the sides.
fn nearest_cell(cell: vec3i) -> u32 {
    let inside = vec3u(clamp(cell, vec3i(0), vec3i(view.cells) - 1));
    return inside.x + view.cells.x * (inside.y + view.cells.y * inside.z);
}

// The fraction of a corner of a cube, negative without gas.
fn field_fraction(cube: vec3i, corner: u32) -> f32 {
    let seen = field[nearest_cell(corner_cell(cube, corner))];
    let fraction = pow(clamp((seen - view.low) / (view.high - view.low), 0.0, 1.0), view.contrast);
    return select(fraction, -1.0, seen == NO_VALUE);
}

fn heat_fraction(cube: vec3i, corner: u32) -> f32 {
    let seen = heat[nearest_cell(corner_cell(cube, corner))];
    return select(clamp(seen * view.heat_scale - view.heat_offset, 0.0, 1.0), -1.0, seen == NO_VALUE);
}

@compute @workgroup_size(WORKGROUP)
fn pack_corners(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let run = run_of(thread_index(workgroup, local));
    var cube = run.first;
    var fractions = array<f32, 8>();
    for (var k = 0u; k < 4u; k++) { fractions[k + 4u] = field_fraction(cube, k); }
    for (; cube.z < run.end; cube.z++) {
        for (var k = 0u; k < 4u; k++) { fractions[k] = fractions[k + 4u]; }
        for (var k = 4u; k < 8u; k++) { fractions[k] = field_fraction(cube, k); }
        corners[cube_index(cube)] = packed_corners(fractions);
    }
}

@compute @workgroup_size(WORKGROUP)
fn pack_glow(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let run = run_of(thread_index(workgroup, local));
    var cube = run.first;
    var fractions = array<f32, 8>();
    for (var k = 0u; k < 4u; k++) { fractions[k + 4u] = heat_fraction(cube, k); }
    for (; cube.z < run.end; cube.z++) {
        for (var k = 0u; k < 4u; k++) { fractions[k] = fractions[k + 4u]; }
        for (var k = 4u; k < 8u; k++) { fractions[k] = heat_fraction(cube, k); }
        glow[glow_place(cube_index(cube))] = packed_corners(fractions);
    }
}

@compute @workgroup_size(WORKGROUP)
fn pack_soot(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= cube_count() { return; }
    let cube = cube_of(i);
    var fractions = array<f32, 8>();
    for (var corner = 0u; corner < 8u; corner++) {
        let slot = slot_of(clamp(corner_cell(cube, corner), vec3i(0), vec3i(view.cells) - 1));
        let depth = view.soot * max(species[view.species_start + slot], 0.0) * view.spacing;
        fractions[corner] = select(-1.0, depth_fraction(depth), has_gas(slot));
    }
    glow[glow_place(i) + 1u] = packed_corners(fractions);
}
