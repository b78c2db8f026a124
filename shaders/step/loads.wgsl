// loads: force, moment, power and pressure of the gas on bodies, static obstacles and walls of sides, one load each, in every step.
// load_owners: reads sorted particles; writes which body has each SOLID slot.
// load_faces: after the gas has its momentum and energy, before floors: reads pressure, cells, gas, nodes; adds up the loads.
// load_record: writes the loads of the step into their history ring and sets them to 0.
// What a body gets is what the gas beside it has lost at their faces; of an obstacle or wall what its slots have collected, and the surface in cut
// cells. Sums are integers, whose order does not matter: numbers of 64 bits, the low half first, in 2^-32 of a unit.
#include "shared/face_power.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> extra: array<u32>;
@group(0) @binding(4) var<storage, read> pressure: array<f32>;
@group(0) @binding(5) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(6) var<storage, read> node: array<vec4f>;
@group(0) @binding(7) var<storage, read> work: array<vec4f>;
// Numbers of all loads; then a word per slot: the load of the body that has it, one more, and above it that of the obstacle or side.
@group(0) @binding(8) var<storage, read_write> loads: array<atomic<u32>>;
@group(0) @binding(9) var<storage, read> order: array<u32>;
@group(0) @binding(10) var<storage, read> cell_start: array<u32>;
@group(0) @binding(11) var<storage, read> velocity: array<vec4f>;
@group(0) @binding(12) var<storage, read> deformation: array<vec4f>;
@group(0) @binding(13) var<storage, read_write> load_history: array<vec4f>;

override LOADS: u32;            // how many there are: bodies, if their loads are wanted, then obstacles, then sides
override LOAD_UNIT: f32;        // [Pa] a pressure of the start

// Share of a solve in the mean of a step: with two solves what the first collects counts less than it spans [shared/state.wgsl].
fn solve_share() -> f32 {
    if !ARS { return 1.0; }
    return select(ARS_SHARE, 1.0 - ARS_SHARE, control.stage == 0u);
}

fn face_size() -> f32 { return cell_volume() / params.spacing; }

// Force, power, moment, and force of the pressure alone that count as one.
fn units() -> vec4f {
    let force = LOAD_UNIT * face_size();
    let reach = params.spacing * f32(max(params.cells.x, max(params.cells.y, params.cells.z)));
    return vec4f(force, force * sqrt(LOAD_UNIT / params.ambient_density), force * reach, force);
}

fn place_of(load: u32, number: u32) -> u32 { return 2u * (LOAD_NUMBERS * load + number); }

fn add_number(load: u32, number: u32, value: f32) {
    let at = place_of(load, number);
    let size = abs(value);
    let whole = u32(floor(size));
    let part = u32(fract(size) * 4294967296.0);
    if value < 0.0 {
        let old = atomicSub(&loads[at], part);
        atomicSub(&loads[at + 1u], whole + u32(old < part));
    } else {
        let old = atomicAdd(&loads[at], part);
        atomicAdd(&loads[at + 1u], whole + u32(old > ~part));
    }
}

fn number_of(load: u32, number: u32) -> f32 {
    let at = place_of(load, number);
    let low = atomicExchange(&loads[at], 0u);
    return f32(bitcast<i32>(atomicExchange(&loads[at + 1u], 0u))) + f32(low) / 4294967296.0;
}

// Force, its arm from the low corner of the domain, power, force of the pressure alone, and area in faces of cells.
fn add_load(load: u32, force: vec3f, arm: vec3f, power: f32, pressed: f32, area: f32) {
    let unit = units();
    let moment = cross(arm, force);
    for (var a = 0u; a < 3u; a++) {
        if force[a] != 0.0 { add_number(load, a, force[a] / unit.x); }
        if moment[a] != 0.0 { add_number(load, 4u + a, moment[a] / unit.z); }
    }
    if power != 0.0 { add_number(load, 3u, power / unit.y); }
    add_number(load, 7u, pressed / unit.w);
    add_number(load, 8u, area);
}

fn owner_at(slot: u32) -> u32 { return place_of(LOADS, 0u) + slot; }

// The body with most volume in a cell, one more; 0 if it has no particles.
fn body_of(slot: u32) -> u32 {
    var best = 0u;
    var most = 0.0;
    let end = cell_start[slot + 1u];
    for (var i = cell_start[slot]; i < end; i++) {
        let body = bitcast<u32>(deformation[3u * order[i]].w);
        var volume = 0.0;
        for (var k = cell_start[slot]; k < end; k++) {
            volume += select(0.0, velocity[order[k]].w, bitcast<u32>(deformation[3u * order[k]].w) == body);
        }
        if volume > most { most = volume; best = body + 1u; }
    }
    return best;
}

// A covered cell without a particle is of a body around it.
fn body_near(c: vec3i) -> u32 {
    let own = body_of(slot_of(c));
    if own > 0u { return own; }
    for (var k = 0u; k < block_size(); k++) {
        let near = c + block_offset(k);
        if !inside(near) { continue; }
        let body = body_of(slot_of(near));
        if body > 0u { return body; }
    }
    return 0u;
}

@compute @workgroup_size(WORKGROUP)
fn load_owners(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots || kind_of(cells[slot]) != SOLID { return; }
    let at = owner_at(slot);
    atomicStore(&loads[at], (atomicLoad(&loads[at]) & 0xffff0000u) | body_near(cell_of(slot)));
}

// The middle of a face of a cell, from the low corner of the domain.
fn face_middle(c: vec3i, n: u32, up: bool) -> vec3f {
    var x = vec3f(c) + 0.5;
    x[n] += select(-0.5, 0.5, up);
    return x * params.spacing;
}

// A body's slot: what the gas behind each of its faces has lost there.
fn add_faces_of_body(load: u32, c: vec3i) {
    for (var face = 0u; face < 2u * DIM; face++) {
        let n = face / 2u;
        let up = (face & 1u) == 1u;     // the gas is above
        let near = select(c - axis(n), c + axis(n), up);
        if !inside(near) || kind_of(cells[slot_of(near)]) != GAS { continue; }
        let pressed = face_size() * aperture(slot_of(near), n, !up) * face_pressure(near, n, !up, SOLID);
        let sign = select(1.0, -1.0, up);
        var force = vec3f(0.0);
        force[n] = sign * pressed;
        let power = sign * face_size() * aperture(slot_of(near), n, !up) * interface_power(near, n, !up);
        add_load(load, force, face_middle(c, n, up), power, pressed, 1.0);
    }
}

// A slot of an obstacle, or beyond a side: what it has collected.
fn add_collected(load: u32, c: vec3i, slot: u32) {
    var pressed = 0.0;
    var area = 0.0;
    for (var face = 0u; face < 2u * DIM; face++) {
        let n = face / 2u;
        let up = (face & 1u) == 1u;
        let near = select(c - axis(n), c + axis(n), up);
        if !inside(near) || kind_of(cells[slot_of(near)]) != GAS { continue; }
        let open = aperture(slot_of(near), n, !up);
        pressed += face_size() * open * face_pressure(near, n, !up, WALL);
        area += open;
    }
    if area == 0.0 { return; }
    // Between two solves of a step the second still builds upon what the first collected.
    var force = conserved[slot].yzw * cell_volume() / control.duration;
    if ARS && control.stage == 0u { force = vec3f(0.0); }
    let share = solve_share();
    add_load(load, force, (vec3f(c) + 0.5) * params.spacing, 0.0, share * pressed, share * area);
}

// The surface of an obstacle in a cut cell: what the gas loses beyond what passes its faces.
fn add_cut_surface(load: u32, c: vec3i, slot: u32) {
    var force = vec3f(0.0);
    for (var k = 1u; k < corner_count(); k++) {
        force += (pressure[slot_of(c + corner_offset(k))] - pressure[slot]) * cut_slope(slot, corner_offset(k));
    }
    var missing = vec3f(0.0);   // of the faces, whose closed part is a surface
    for (var face = 0u; face < 2u * DIM; face++) {
        let n = face / 2u;
        let up = (face & 1u) == 1u;
        let open = aperture(slot, n, up);
        force[n] += select(1.0, -1.0, up) * open * face_pressure(c, n, up, neighbour_kind(c, n, up));
        missing[n] += select(-1.0, 1.0, up) * open;
    }
    let area = length(missing);
    if area == 0.0 && all(force == vec3f(0.0)) { return; }
    let share = solve_share();
    let pressed = share * area * face_size() * mean_pressure(c);
    add_load(load, share * face_size() * force, (vec3f(c) + 0.5) * params.spacing, 0.0, pressed, share * area);
}

fn mean_pressure(c: vec3i) -> f32 {
    var sum = 0.0;
    for (var k = 0u; k < corner_count(); k++) { sum += pressure[slot_of(c + corner_offset(k))]; }
    return sum / f32(corner_count());
}

@compute @workgroup_size(WORKGROUP)
fn load_faces(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = swept_slot(thread_index(group, lane));
    if slot >= params.slots { return; }
    let c = cell_of(slot);
    let owners = atomicLoad(&loads[owner_at(slot)]);
    if owners == 0u { return; }
    let kind = kind_of(cells[slot]);
    let body = owners & 0xffffu;
    let obstacle = owners >> 16u;
    if kind == SOLID && body > 0u { add_faces_of_body(body - 1u, c); }
    if obstacle == 0u { return; }
    if kind == WALL { add_collected(obstacle - 1u, c, slot); }
    if kind == GAS && beside_obstacle(slot, cells[slot]) { add_cut_surface(obstacle - 1u, c, slot); }
}

// One workgroup: force and power, moment about the low corner and force of the pressure alone, area.
@compute @workgroup_size(WORKGROUP)
fn load_record(@builtin(local_invocation_index) lane: u32) {
    let base = LOADS * ((control.step + params.history - 1u) % params.history);
    let unit = units();
    for (var load = lane; load < LOADS; load += WORKGROUP) {
        let at = 3u * (base + load);
        load_history[at] = vec4f(unit.xxx, unit.y) * vec4f(number_of(load, 0u), number_of(load, 1u), number_of(load, 2u), number_of(load, 3u));
        load_history[at + 1u] = vec4f(unit.zzz, unit.w) * vec4f(number_of(load, 4u), number_of(load, 5u), number_of(load, 6u), number_of(load, 7u));
        load_history[at + 2u] = vec4f(face_size() * number_of(load, 8u), 0.0, 0.0, 0.0);
    }
}
