// dust: where does the gas carry dust? It has the velocity of the gas and does nothing to it: docs/method/dust.md.
// Reads the gas at the start of the step. Writes dust; slots of the ring collect what passes their face. The sum over all slots and the ground
// is conserved: each face gives one slot what it takes from the other.
// dust_lift: how much of its dust each slot can give, who takes that of bodies, and what the gas takes along from the ground.
// dust_carry, dust_keep: the dust at the end of the step.
// dust_sum, dust_record: how much there is, for the record of the step.
#include "shared/domain.wgsl"
#include "shared/reduce.wgsl"

override DUST_THRESHOLD: f32;   // speed of the gas from which it takes dust along [m s^-1]
override DUST_RATE: f32;        // share of what lies there that goes, per density and way beyond that speed [m^2 kg^-1]

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(4) var<storage, read> extra: array<u32>;
@group(0) @binding(5) var<storage, read_write> dust: array<f32>;
@group(0) @binding(6) var<storage, read_write> passing: array<f32>;
@group(0) @binding(7) var<storage, read_write> taken: array<f32>;
@group(0) @binding(8) var<storage, read> node: array<vec4f>;
@group(0) @binding(9) var<storage, read_write> settled: array<f32>;
@group(0) @binding(10) var<storage, read_write> partials: array<vec4f>;
@group(0) @binding(11) var<storage, read_write> history: array<vec4f>;

// A slot is asked for this much of its dust at most, a hair less than all.
const ALL_BUT_ROUNDING = 0.999999;

// The slot across a face, the image of this one beyond a plane of symmetry.
fn beside(slot: u32, c: vec3i, n: u32, up: bool) -> u32 {
    return u32(i32(slot) + (place_along(n, c[n] + select(-1, 1, up)) - c[n]) * i32(step_of(n)));
}

// Gas that passes a face of a GAS slot along +axis in the step, over the volume of a cell; 0 if it is closed.
fn passed(slot: u32, c: vec3i, n: u32, up: bool) -> f32 {
    if is_reflected(n, c[n] + select(-1, 1, up)) { return 0.0; }
    let other = beside(slot, c, n, up);
    let kind = kind_of(cells[other]);
    if kind == WALL || kind == SOLID { return 0.0; }
    var flow = conserved[slot];
    if kind == GAS { flow += conserved[other]; }
    return flow[n + 1u] / flow.x * control.duration / params.spacing * aperture(slot, n, up);
}

// Dust of a slot at its face, as the share of the cell that passes it holds on average. [van Leer 1977]
fn at_face(slot: u32, c: vec3i, n: u32, up: bool, share: f32) -> f32 {
    let ahead = beside(slot, c, n, up);
    let behind = beside(slot, c, n, !up);
    let here = dust[slot];
    if kind_of(cells[ahead]) != GAS || kind_of(cells[behind]) != GAS { return here; }
    let rise = vec2f(here - dust[behind], dust[ahead] - here);
    if rise.x * rise.y <= 0.0 { return here; }
    // It lies between both cells, to the last bit: nobody gives less than nothing.
    let value = here + (1.0 - min(abs(share), 1.0)) * rise.x * rise.y / (rise.x + rise.y);
    return clamp(value, min(here, dust[ahead]), max(here, dust[ahead]));
}

// Dust that a GAS slot would give through a face.
fn offered(slot: u32, c: vec3i, n: u32, up: bool) -> f32 {
    let share = passed(slot, c, n, up);
    if (share > 0.0) != up || share == 0.0 { return 0.0; }
    return abs(share) * at_face(slot, c, n, up, share);
}

fn given(slot: u32, c: vec3i, n: u32, up: bool) -> f32 { return passing[slot] * offered(slot, c, n, up); }

// What the gas of a slot takes along from the ground beside it.
fn lifted(slot: u32) -> f32 {
    let left = dust[part(LOOSE_DUST, slot)];
    let flow = conserved[slot];
    let way = max(length(flow.yzw) / flow.x - DUST_THRESHOLD, 0.0) * control.duration;
    return left - left / (1.0 + DUST_RATE * flow.x * way);
}

fn is_gas(slot: u32) -> bool { return kind_of(cells[slot]) == GAS; }

// Velocity of the body in a cell.
fn body_velocity(c: vec3i) -> vec3f {
    var sum = vec4f(0.0);
    for (var k = 0u; k < corner_count(); k++) {
        let at = node[slot_of(c + corner_offset(k))];
        sum += at.w * vec4f(at.xyz, 1.0);
    }
    return sum.xyz / max(sum.w, 1e-30);
}

// GAS slots around a body's slot that take its dust, as bits: those ahead of it, or else all.
fn takers(slot: u32, c: vec3i) -> u32 {
    let velocity = body_velocity(c);
    var all = 0u;
    var ahead = 0u;
    for (var face = 0u; face < 2u * DIM; face++) {
        let n = face / 2u;
        let up = (face & 1u) == 1u;
        let other = select(c - axis(n), c + axis(n), up);
        if !inside(other) || !is_gas(slot_of(other)) { continue; }
        all |= 1u << face;
        if (velocity[n] > 0.0) == up && velocity[n] != 0.0 { ahead |= 1u << face; }
    }
    return select(all, ahead, ahead != 0u);
}

@compute @workgroup_size(WORKGROUP)
fn dust_lift(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let c = cell_of(slot);
    passing[slot] = 0.0;
    taken[slot] = 0.0;
    if !inside(c) { return; }
    for (var turn = 0u; turn < when(SOLIDS && kind_of(cells[slot]) == SOLID && dust[slot] > 0.0); turn++) {
        passing[slot] = f32(takers(slot, c));
    }
    if !is_gas(slot) { return; }
    if dust[part(LOOSE_DUST, slot)] > 0.0 {
        taken[slot] = lifted(slot);
        dust[part(LOOSE_DUST, slot)] -= taken[slot];
    }
    let held = dust[slot] * cluster_share(slot);
    var wanted = 0.0;
    for (var turn = 0u; turn < when(held > 0.0); turn++) {
        for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) {
            let member = cell_of(at);
            for (var face = 0u; face < 2u * DIM; face++) { wanted += offered(at, member, face / 2u, (face & 1u) == 1u); }
        }
    }
    if wanted > 0.0 { passing[slot] = min(1.0, ALL_BUT_ROUNDING * held / wanted); }
}

// What passes the faces of a GAS slot, and what bodies beside it hand over.
fn gained(slot: u32) -> f32 {
    let c = cell_of(slot);
    var sum = taken[slot];
    for (var face = 0u; face < 2u * DIM; face++) {
        let n = face / 2u;
        let up = (face & 1u) == 1u;
        sum -= given(slot, c, n, up);
        let far = select(c - axis(n), c + axis(n), up);
        if is_reflected(n, far[n]) { continue; }
        let other = beside(slot, c, n, up);
        if is_gas(other) { sum += given(other, cell_of(other), n, !up); }
        if !SOLIDS || kind_of(cells[other]) != SOLID { continue; }
        let bits = u32(passing[other]);
        let own = 1u << (2u * n + u32(!up));
        if (bits & own) != 0u { sum += dust[other] / f32(countOneBits(bits)); }
    }
    return sum;
}

// What leaves through the face of a slot of the ring.
fn left_through(c: vec3i) -> f32 {
    let near = nearest_inside(c);
    let away = c - near;
    if dot(away, away) != 1 || !is_gas(slot_of(near)) { return 0.0; }
    let n = u32(away.y != 0) + 2u * u32(away.z != 0);
    return given(slot_of(near), near, n, away[n] > 0);
}

@compute @workgroup_size(WORKGROUP)
fn dust_carry(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let c = cell_of(slot);
    let kind = kind_of(cells[slot]);
    var sum = dust[slot];
    for (var turn = 0u; turn < when(kind == GHOST && !is_alias(c)); turn++) { sum += left_through(c); }
    if kind == SOLID && passing[slot] > 0.0 { sum = 0.0; }
    var gain = 0.0;
    for (var turn = 0u; turn < when(kind == GAS && inside(c)); turn++) {
        for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) { gain += gained(at); }
    }
    if gain != 0.0 { sum += gain / cluster_share(slot); }
    settled[slot] = sum;
}

@compute @workgroup_size(WORKGROUP)
fn dust_keep(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot < params.slots { dust[slot] = settled[slot]; }
}

@compute @workgroup_size(WORKGROUP)
fn dust_sum(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var sum = vec4f(0.0);   // in the gas and in bodies, on the ground, left through sides
    for (var slot = thread_index(group, lane); slot < params.slots; slot += striding_threads()) {
        let kind = kind_of(cells[slot]);
        let held = dust[slot] * gas_share(slot);
        sum += vec4f(select(held, 0.0, kind == GHOST), dust[part(LOOSE_DUST, slot)], select(0.0, held, kind == GHOST), 0.0);
    }
    sum = workgroup_sum4(lane, cell_volume() * sum);
    if lane == 0u { partials[group_index(group)] = sum; }
}

// One workgroup, after the record of the step that has just ended.
@compute @workgroup_size(WORKGROUP)
fn dust_record(@builtin(local_invocation_index) lane: u32) {
    var sum = vec4f(0.0);
    for (var k = lane; k < params.groups; k += WORKGROUP) { sum += partials[k]; }
    sum = workgroup_sum4(lane, sum);
    let base = ((control.step + params.history - 1u) % params.history) * HISTORY_WIDTH;
    if lane == 0u { history[base + 14u] = vec4f(history[base + 14u].x, sum.xyz); }
}
