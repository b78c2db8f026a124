// The quantity a picture shows, from the state of the gas.
// evaluate_field: reads conserved, energy, cells; writes field, NO_VALUE where there is no gas.
// find_range: reads field; writes the least and largest value that each workgroup saw.
// pack_corners: reads field; writes, per cube between eight cell centres, their fractions of the range in 8 bits each.
// mark_bricks: reads corners; writes 1 for every brick of cubes that the ray march must enter, 0 for transparent ones.

#include "shared/thread.wgsl"
#include "shared/reduce.wgsl"
#include "shared/view.wgsl"

@group(0) @binding(1) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(2) var<storage, read> energy: array<f32>;
@group(0) @binding(3) var<storage, read> cells: array<u32>;
@group(0) @binding(4) var<storage, read_write> field: array<f32>;
@group(0) @binding(5) var<storage, read_write> ranges: array<vec2f>;
@group(0) @binding(6) var<storage, read_write> corners: array<vec2u>;
@group(0) @binding(7) var<storage, read_write> bricks: array<u32>;

fn has_gas(slot: u32) -> bool {
    return kind_of(cells[slot]) == KIND_GAS;
}

// Density and velocity.
fn motion(slot: u32) -> vec4f {
    let state = conserved[slot];
    return vec4f(state.x, state.yzw / state.x);
}

fn pressure(slot: u32) -> f32 {
    let state = conserved[slot];
    let kinetic = 0.5 * dot(state.yzw, state.yzw) / state.x;
    return (view.gamma - 1.0) * (energy[slot] - kinetic);
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
    if (distance == 0.0) {
        return vec4f(0.0);
    }
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

fn value(cell: vec3i, slot: u32) -> f32 {
    let state = motion(slot);
    let speed = length(state.yzw);
    switch (view.field) {
        case FIELD_PRESSURE: { return pressure(slot); }
        case FIELD_VELOCITY: { return speed; }
        case FIELD_TEMPERATURE: { return pressure(slot) / state.x; }
        case FIELD_SCHLIEREN: { return density_gradient(cell); }
        case FIELD_MACH: { return speed / sqrt(view.gamma * max(pressure(slot), 1e-30) / state.x); }
        case FIELD_VORTICITY: { return vorticity(cell); }
        default: { return state.x; }
    }
}

@compute @workgroup_size(WORKGROUP)
fn evaluate_field(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
                  @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, groups, local);
    if (i >= cell_count()) {
        return;
    }
    let cell = cell_of(i);
    let slot = slot_of(cell);
    var result = NO_VALUE;
    if (has_gas(slot)) {
        let computed = value(cell, slot);
        // The comparison is false for NaN.
        if (abs(computed) < -NO_VALUE) {
            result = computed;
        }
    }
    field[i] = result;
}

@compute @workgroup_size(WORKGROUP)
fn find_range(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
              @builtin(local_invocation_index) local: u32) {
    var low = -NO_VALUE;
    var high = NO_VALUE;
    for (var i = thread_index(workgroup, groups, local); i < cell_count(); i += groups.x * WORKGROUP) {
        let seen = field[i];
        if (seen != NO_VALUE) {
            low = min(low, seen);
            high = max(high, seen);
        }
    }
    low = workgroup_min(local, low);
    high = workgroup_max(local, high);
    if (local == 0u) {
        ranges[workgroup.x] = vec2f(low, high);
    }
}

fn fraction_at(cell: vec3i) -> f32 {
    let inside = vec3u(clamp(cell, vec3i(0), vec3i(view.cells) - 1));
    let seen = field[inside.x + view.cells.x * (inside.y + view.cells.y * inside.z)];
    if (seen == NO_VALUE) {
        return -1.0;
    }
    return pow(clamp((seen - view.low) / (view.high - view.low), 0.0, 1.0), view.contrast);
}

// Cube (i, j, k) lies between the centres of cells i-1 and i, and so on: one more than cells per axis.
@compute @workgroup_size(WORKGROUP)
fn pack_corners(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
                @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, groups, local);
    let cubes = view.cells + 1u;
    if (i >= cubes.x * cubes.y * cubes.z) {
        return;
    }
    let cube = vec3i(vec3u(i % cubes.x, (i / cubes.x) % cubes.y, i / (cubes.x * cubes.y)));
    var fractions = array<f32, 8>();
    var sum = 0.0;
    var count = 0.0;
    for (var corner = 0u; corner < 8u; corner++) {
        let offset = vec3i(vec3u(corner & 1u, (corner >> 1u) & 1u, corner >> 2u));
        let fraction = fraction_at(cube - 1 + offset);
        fractions[corner] = fraction;
        if (fraction >= 0.0) {
            sum += fraction;
            count += 1.0;
        }
    }
    // Corners without gas take the mean of the others, so that bodies have no halo of false values.
    let filling = select(view.neutral, sum / max(count, 1.0), count > 0.0);
    for (var corner = 0u; corner < 8u; corner++) {
        if (fractions[corner] < 0.0) {
            fractions[corner] = filling;
        }
    }
    let near = vec4f(fractions[0], fractions[1], fractions[2], fractions[3]);
    let far = vec4f(fractions[4], fractions[5], fractions[6], fractions[7]);
    corners[i] = vec2u(pack4x8unorm(near), pack4x8unorm(far));
}

@compute @workgroup_size(WORKGROUP)
fn mark_bricks(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
               @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, groups, local);
    let grid = brick_grid();
    if (i >= grid.x * grid.y * grid.z) {
        return;
    }
    let cubes = view.cells + 1u;
    let first = BRICK * vec3u(i % grid.x, (i / grid.x) % grid.y, i / (grid.x * grid.y));
    let end = min(first + BRICK, cubes);
    var seen = false;
    for (var z = first.z; z < end.z; z++) {
        for (var y = first.y; y < end.y; y++) {
            for (var x = first.x; x < end.x; x++) {
                let packed = corners[x + cubes.x * (y + cubes.y * z)];
                let near = abs(unpack4x8unorm(packed.x) - view.neutral);
                let far = abs(unpack4x8unorm(packed.y) - view.neutral);
                let most = max(near, far);
                seen = seen || max(max(most.x, most.y), max(most.z, most.w)) > FAINTEST * contrast_scale();
            }
        }
    }
    bricks[i] = u32(seen);
}
