// coupled_solve, preparation of the solid: gravity, and the traction of the gas film between a body and a wall.
// A body that touches a wall keeps a film of gas there: without its pressure a body on the floor would not lift. The film
// carries the pressure of the nearest gas vertex along the wall; it acts before the solve and adds no unknown.
#include "shared/system.wgsl"
#include "solid/given.wgsl"
#include "solid/light_node.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> energy: array<f32>;    // second third: predicted pressure of gas cells
@group(0) @binding(4) var<storage, read> ghost: array<f32>;
@group(0) @binding(5) var<storage, read_write> node: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> work: array<vec4f>;  // first part: film pressure at vertices of walls, per axis across; second: what light nodes leave
@group(0) @binding(7) var<storage, read> extra: array<u32>;
@group(0) @binding(9) var<storage, read> inertia: array<f32>;

// How far along the wall the film looks for gas, in cells.
const FILM_REACH = 16;

// Mean over the gas cells around a vertex: the vertex unknown may hold some of the body's own pressure.
fn gas_pressure(v: vec3i) -> f32 {
    var sum = 0.0;
    var count = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let c = v - corner_offset(k);
        if !inside(c) || kind_of(cells[slot_of(c)]) != GAS { continue; }
        sum += energy[part(PREDICTED_PRESSURE, slot_of(c))];
        count += 1.0;
    }
    return sum / max(count, 1.0);
}

// Steps of unit length along the wall across axis n; at most four, in 2D two, in 1D none.
fn along_wall(n: u32, k: u32) -> vec3i {
    let a = axis((n + 1u + k / 2u) % 3u);
    return select(-a, a, (k & 1u) == 1u);
}

// Directions in which there is gas at a distance, as bits.
fn gas_at(v: vec3i, n: u32, far: i32) -> u32 {
    var found = 0u;
    for (var k = 0u; k < 4u; k++) {
        let step = along_wall(n, k);
        let near = v + far * step;
        // An inactive axis leads out of the grid.
        if is_vertex(near) && has(cells[slot_of(near)], VERTEX_GAS) { found |= 1u << k; }
    }
    return found;
}

fn nearest_gas(v: vec3i, n: u32) -> f32 {
    let slot = slot_of(v);
    var far = 0;
    var found = u32(has(cells[slot], VERTEX_GAS));
    while found == 0u && far < FILM_REACH {
        far++;
        found = gas_at(v, n, far);
    }
    if found == 0u { return ghost[slot]; }
    var sum = 0.0;
    for (var k = 0u; k < 4u; k++) {
        if ((found >> k) & 1u) == 1u { sum += gas_pressure(v + far * along_wall(n, k)); }
    }
    return sum / f32(countOneBits(found));
}

// Axes across which a vertex has a wall and a body, as bits.
fn walls_of(v: vec3i) -> u32 {
    let kinds = kinds_around_vertex(v);
    var walls = 0u;
    for (var k = 0u; k < corner_count(); k++) {
        let corner = corner_offset(k);
        if ((kinds >> (2u * k)) & 3u) != SOLID { continue; }
        for (var n = 0u; n < DIM; n++) {
            let beyond = kind_across(kinds, corner, n);
            if beyond == WALL || beyond == GHOST { walls |= 1u << n; }
        }
    }
    return walls;
}

@compute @workgroup_size(WORKGROUP)
fn film_pressure(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots || !has(cells[slot], VERTEX_SOLID) { return; }
    let v = cell_of(slot);
    let walls = walls_of(v);
    for (var n = 0u; n < select(0u, DIM, walls != 0u); n++) {
        if ((walls >> n) & 1u) == 1u { work[part(FILM_PRESSURE, slot)][n] = nearest_gas(v, n); }
    }
}

// Mean film pressure of a face across axis n, whose low corner is `low`, as a node at `offset` from the element sees it.
fn face_mean(low: vec3i, n: u32, offset: vec3i) -> f32 {
    var sum = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let corner = corner_offset(k);
        if corner[n] == 1 { continue; }
        sum += work[part(FILM_PRESSURE, slot_of(low + corner))][n] * face_entry(true, n, offset, corner);
    }
    return sum;
}

// `count`: block_size(), or 0 away from walls.
fn film_force(c: vec3i, count: u32) -> vec3f {
    var force = vec3f(0.0);
    let kinds = kinds_around_node(select(vec3i(0), c, count > 0u));
    for (var k = 0u; k < count; k++) {
        let offset = block_offset(k);
        for (var f = 0u; f < select(0u, 2u * DIM, kind_in_block(kinds, offset) == SOLID); f++) {
            let n = f / 2u;
            let up = (f & 1u) == 1u;
            let step = select(-axis(n), axis(n), up);
            if !face_holds(-offset, n, up) { continue; }
            let beyond = kind_in_block(kinds, offset + step);
            if beyond != WALL && beyond != GHOST { continue; }
            let push = select(-1.0, 1.0, up) * face_mean(c + offset + select(vec3i(0), step, up), n, -offset);
            force = select(force, force + push, along(n));
        }
    }
    return force * face_area();
}

// Velocity that the film gives to a node.
fn film_kick(slot: u32) -> vec3f {
    let count = select(0u, block_size(), has(cells[slot], NODE_FILM));
    return -control.dt * film_force(cell_of(slot), count) / inertia[slot];
}

@compute @workgroup_size(WORKGROUP)
fn film_left(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    var left = vec3f(0.0);
    if has(cells[slot], NODE_FILM) && !(DRIVEN && has(cells[slot], NODE_DRIVEN)) { left = share_left(slot) * film_kick(slot); }
    work[part(LEFT_KICK, slot)] = vec4f(left, 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn solid_predictor(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var given = vec4f(0.0);
    for (var slot = thread_index(group, lane); slot < params.slots; slot += striding_threads()) {
        let here = node[slot];
        if here.w <= 0.0 || (DRIVEN && has(cells[slot], NODE_DRIVEN)) { continue; }
        let change = control.dt * params.gravity + film_kick(slot) + gain_around(slot, block_size());
        node[slot] = vec4f(here.xyz + change, here.w);
        given += given_to(here.w, change, here.xyz, here.xyz + change);
    }
    add_given(group_index(group), lane, given, true);
}
