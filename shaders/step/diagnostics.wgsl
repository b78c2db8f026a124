// diagnostics: totals of gas, ledger and solids after a step, extremes, and one record of them in the history ring.
// Sums are trees of fixed shape. Block k of `partials` holds one partial result per workgroup.
#include "shared/reduce.wgsl"
#include "materials/stress.wgsl"
#include "shared/domain.wgsl"
#include "shared/gas_at.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(4) var<storage, read> energy: array<f32>;
@group(0) @binding(5) var<storage, read> owed_flow: array<vec4f>;
@group(0) @binding(6) var<storage, read> owed_energy: array<f32>;
@group(0) @binding(7) var<storage, read_write> partials: array<vec4f>;
@group(0) @binding(8) var<storage, read> position: array<vec4f>;
@group(0) @binding(9) var<storage, read> velocity: array<vec4f>;
@group(0) @binding(10) var<storage, read> affine: array<vec4f>;
@group(0) @binding(11) var<storage, read> deformation: array<vec4f>;
@group(0) @binding(12) var<storage, read_write> history: array<vec4f>;
@group(0) @binding(13) var<storage, read> probe_cells: array<u32>;
@group(0) @binding(16) var<storage, read> extra: array<u32>;
@group(0) @binding(17) var<storage, read> stress: array<vec4f>;      // w of the first: heat of plastic flow and of cracks [J]
@group(0) @binding(14) var<storage, read_write> probe_history: array<vec4f>;

// The slot where p / rho^gamma is least, of a workgroup.
var<workgroup> coldest_slot: atomic<u32>;

fn put(block: u32, at: u32, lane: u32, value: vec4f) {
    if lane == 0u { partials[block * PARTIALS + at] = value; }
}

// Threads change places from turn to turn: where they are as many as a few rows of slots, one would get all that comes in through a side,
// another all that leaves, and the large sums would round off what their difference is made of.
const PLACES_PER_TURN = 5u;

@compute @workgroup_size(WORKGROUP)
fn totals_gas(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var gas = vec4f(0.0);
    var owed = vec4f(0.0);
    var crossed = vec4f(0.0);
    var heat = vec4f(0.0);
    var extremes = vec4f(-3e38);
    var speed = vec2f(0.0); // of the gas, of sound, squared
    var more = vec2f(0.0);  // kinetic energy; owed mass, whatever its sign
    var species = vec2f(0.0);   // mass of the second gas: held and owed, crossed
    var coldest = 3e38;     // p / rho^gamma
    var coldest_at = params.slots;
    if lane == 0u { atomicStore(&coldest_slot, params.slots); }
    let volume = cell_volume();
    let threads = striding_threads();
    var place = thread_index(group, lane);
    for (var first = 0u; first < params.slots; first += threads) {
        let slot = first + place;
        place = select(place + PLACES_PER_TURN, place + PLACES_PER_TURN - threads, place + PLACES_PER_TURN >= threads);
        if slot >= params.slots { continue; }
        let kind = kind_of(cells[slot]);
        let u = gas_at(slot);
        if !RING_LEDGER && (kind == GAS || kind == SOLID) {
            owed += owed_flow[slot];
            heat.y += owed_energy[slot];
            more.y += abs(owed_flow[slot].x + select(0.0, volume * u.flow.x, kind == SOLID));
            if SPECIES { species.x += owed_energy[ledger_part(OWED_SPECIES_MASS) + slot]; }
        }
        if kind == GAS {
            let share = volume * gas_share(slot);
            gas += share * u.flow;
            species.x += share * u.species.x;
            heat.x += share * u.energy;
            let p = pressure_of(u);
            extremes = max(extremes, vec4f(u.flow.x, -u.flow.x, p, -p));
            let v = velocity_of(u.flow);
            speed = max(speed, vec2f(dot(v, v), stiffness_ratio(u, p) * max(p, 0.0) / u.flow.x));
            more.x += share * kinetic_energy(u.flow);
            let entropy = p * pow(u.flow.x, -params.gamma);
            // of the first gas alone: at the same pressure and density the second has another
            if entropy < coldest && !(SPECIES && any(vec2f(u.species.x / u.flow.x, u.species.y) > vec2f(PURE))) { coldest = entropy; coldest_at = slot; }
        } else if SOLIDS && kind == SOLID {
            owed += volume * u.flow;
            heat.y += volume * u.energy;
            species.x += volume * u.species.x;
        } else if RING_LEDGER {
            crossed += volume * u.flow;
            species.y += volume * u.species.x;
            heat.z += volume * u.energy;
        } else {
            crossed += volume * (owed_flow[slot] + u.flow);
            heat.z += volume * (owed_energy[slot] + u.energy);
            species.y += volume * u.species.x;
            if SPECIES { species.y += volume * owed_energy[ledger_part(OWED_SPECIES_MASS) + slot]; }
        }
    }
    for (var k = thread_index(group, lane); RING_LEDGER && k < ring_count(); k += striding_threads()) {
        crossed += volume * owed_flow[k];
        heat.z += volume * owed_energy[k];
        if SPECIES { species.y += volume * owed_energy[ledger_part(OWED_SPECIES_MASS) + k]; }
    }
    speed = sqrt(speed);
    let at = group_index(group);
    put(0u, at, lane, workgroup_sum4(lane, gas));
    put(1u, at, lane, workgroup_sum4(lane, owed));
    put(2u, at, lane, workgroup_sum4(lane, crossed));
    let heat_sum = workgroup_sum4(lane, heat);
    put(4u, at, lane, workgroup_max4(lane, extremes));
    let largest = workgroup_max4(lane, vec4f(speed.x, speed.y * control.duration / params.spacing, speed.y, -coldest));
    put(5u, at, lane, largest);
    put(10u, at, lane, workgroup_sum4(lane, vec4f(more, 0.0, 0.0)));
    if SPECIES { put(11u, at, lane, workgroup_sum4(lane, vec4f(0.0, 0.0, species))); }
    put(3u, at, lane, vec4f(heat_sum.xyz, first_slot(-coldest == largest.w, coldest_at)));
}

// The lowest of the slots of those threads that have the least value, as bits.
fn first_slot(is_least: bool, slot: u32) -> f32 {
    if is_least { atomicMin(&coldest_slot, slot); }
    workgroupBarrier();
    return bitcast<f32>(atomicLoad(&coldest_slot));
}

@compute @workgroup_size(WORKGROUP)
fn totals_particles(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var body = vec4f(0.0);
    var heat = vec4f(0.0);
    var gone = vec2f(0.0);      // elastic energy and heat in what is no longer there [J]; mass of what was dropped
    var speed = 0.0;
    var cracks = vec4f(0.0);    // heat of what is damaged; mass of what has broken
    for (var p = thread_index(group, lane); p < params.particles; p += striding_threads()) {
        let v = velocity[p].xyz;
        let mass = position[p].w;
        let material = materials[material_index(affine[3u * p + 2u].w)];
        let h = mat3x3f(deformation[3u * p].xyz, deformation[3u * p + 1u].xyz, deformation[3u * p + 2u].xyz);
        let q = affine[3u * p].w;
        var stored = vec3f(velocity[p].w * elastic_energy(material.kind, h, elastic_part(material)),
            velocity[p].w * ghost_energy(material, swelling_of(material, h, q)), stress[2u * p].w);
        let damage = select(0.0, deformation[3u * p + 2u].w, FRACTURE);
        if damage > 0.0 { stored.x -= velocity[p].w * damage * tension_of(material, h, q, elastic_stress(material, h, q)).energy; }
        if deformation[3u * p + 1u].w == 0.0 {
            gone += vec2f(stored.x + stored.y + stored.z, max(-mass, 0.0));
            continue;
        }
        body += mass * vec4f(1.0, v);
        // The affine motion around a particle is motion, too: m dx^2 / 8 |C|^2. [Jiang et al. 2015]
        var turning = 0.0;
        for (var a = 0u; a < DIM; a++) { turning += dot(affine[3u * p + a].xyz, affine[3u * p + a].xyz); }
        let kinetic = 0.5 * mass * (dot(v, v) + 0.25 * params.spacing * params.spacing * turning);
        heat += vec4f(kinetic, stored.xy, select(stored.z, 0.0, damage > 0.0));
        if damage > 0.0 { cracks += vec4f(stored.z, select(0.0, mass, damage == 1.0), 0.0, 0.0); }
        speed = max(speed, length(v));
    }
    let at = group_index(group);
    put(6u, at, lane, workgroup_sum4(lane, body));
    put(7u, at, lane, workgroup_sum4(lane, heat));
    put(8u, at, lane, workgroup_max4(lane, vec4f(speed, 0.0, 0.0, 0.0)));
    let left = workgroup_sum4(lane, vec4f(0.0, 0.0, gone));
    if lane == 0u { partials[10u * PARTIALS + at] += left; }
    let broken = workgroup_sum4(lane, cracks);
    if lane == 0u {
        if SPECIES { partials[11u * PARTIALS + at] += broken; } else { partials[11u * PARTIALS + at] = broken; }
    }
}

fn block_total(block: u32, lane: u32, largest: bool) -> vec4f {
    var value = select(vec4f(0.0), vec4f(-3e38), largest);
    for (var k = lane; k < params.groups; k += WORKGROUP) {
        let part = partials[block * PARTIALS + k];
        value = select(value + part, max(value, part), largest);
    }
    if largest { return workgroup_max4(lane, value); }
    return workgroup_sum4(lane, value);
}

// One of the numbers in control.borrowed.
fn borrowed(number: u32) -> f32 {
    let high = bitcast<i32>(atomicLoad(&control.borrowed[2u * number + 1u]));
    return f32(high) + f32(atomicLoad(&control.borrowed[2u * number])) / 4294967296.0;
}

// One workgroup: the record of the step that has just ended.
@compute @workgroup_size(WORKGROUP)
fn totals_record(@builtin(local_invocation_index) lane: u32) {
    let base = ((control.step + params.history - 1u) % params.history) * HISTORY_WIDTH;
    if lane == 0u { atomicStore(&coldest_slot, params.slots); }
    var coldest = 0.0;
    for (var block = 0u; block < BLOCKS; block++) {
        let value = block_total(block, lane, block == 4u || block == 5u || block == 8u);
        if block == 5u { coldest = value.w; }
        if lane == 0u { history[base + 2u + block] = value; }
    }
    for (var k = lane; k < params.groups; k += WORKGROUP) {
        if partials[5u * PARTIALS + k].w == coldest { atomicMin(&coldest_slot, bitcast<u32>(partials[3u * PARTIALS + k].w)); }
    }
    workgroupBarrier();
    if lane != 0u { return; }
    history[base + 5u].w = bitcast<f32>(atomicLoad(&coldest_slot));
    control.sound = history[base + 7u].z;
    history[base + 7u].z = bitcast<f32>(atomicLoad(&control.raised));
    history[base + 15u] = vec4f(history[base + 12u].w, 0.0, 0.0, 0.0);
    history[base + 12u].w = bitcast<f32>(control.extra);
    history[base + 14u].x = bitcast<f32>(atomicLoad(&control.dense));
    let unit = borrowed_unit();
    history[base + 3u] += unit.x * vec4f(0.0, borrowed(0u), borrowed(1u), borrowed(2u));
    history[base + 5u].y += unit.y * borrowed(3u);
    history[base + 10u] = vec4f(history[base + 10u].x, bitcast<vec3f>(vec3u(control.rounds, control.elastic_iterations, control.longest_round)));
    history[base] = vec4f(control.duration, control.residual, bitcast<f32>(control.step), bitcast<f32>(control.iterations));
    var limited = 0u;
    for (var k = 0u; k < 4u; k++) { limited += atomicLoad(&control.limited[k]); }
    history[base + 1u] = vec4f(bitcast<f32>(control.substeps), bitcast<f32>(limited),
        bitcast<f32>(atomicLoad(&control.floored)), bitcast<f32>(atomicLoad(&control.clamped)));
}

@compute @workgroup_size(WORKGROUP)
fn totals_probes(@builtin(local_invocation_index) lane: u32) {
    let base = ((control.step + params.history - 1u) % params.history) * params.probes;
    for (var k = lane; k < params.probes; k += WORKGROUP) {
        let slot = probe_cells[k];
        let u = gas_at(slot);
        probe_history[2u * (base + k)] = vec4f(u.flow.x, velocity_of(u.flow));
        probe_history[2u * (base + k) + 1u] = vec4f(pressure_of(u), f32(kind_of(cells[slot])), 0.0, 0.0);
    }
}
