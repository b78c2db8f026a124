// intermediate_pressure, second half: cell values to vertices. X*_v = mean of the adjacent gas cells' predicted pressure, without
// bodies at walls with the weight of the gas in between; with products of an explosive weighted by compliance, so that what is soft says
// what the pressure between solid explosive and air is,
// S^-1_v = sum of (cell volume / 2^DIM) / (stiffness of the cell). Where gas and solid share a pressure both add.
#include "shared/system.wgsl"

@group(0) @binding(1) var<storage, read> cells: array<u32>;
@group(0) @binding(2) var<storage, read> energy: array<f32>;        // second third: predicted pressure
@group(0) @binding(3) var<storage, read> fill: array<vec2f>;
@group(0) @binding(4) var<storage, read> ghost: array<f32>;
@group(0) @binding(5) var<storage, read> extra: array<u32>;
@group(0) @binding(6) var<storage, read_write> pressure: array<f32>;
@group(0) @binding(7) var<storage, read_write> stiffness: array<f32>;

@group(0) @binding(10) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> residual: array<f32>;
@group(0) @binding(9) var<storage, read_write> inverse_diagonal: array<f32>;

// Unknowns behind the grid that no vertex uses in this step must be zero everywhere.
@compute @workgroup_size(WORKGROUP)
fn vertex_clear(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    for (var i = thread_index(group, lane); i < 2u * params.extra_capacity; i += striding_threads()) {
        pressure[apart_h(i)] = 0.0;
        stiffness[apart_h(i)] = 0.0;
        residual[apart_h(i)] = 0.0;
        inverse_diagonal[apart_h(i)] = 0.0;
    }
}

// Pressure and compliance of the cell at a corner of a vertex.
fn interior_corner(slot: u32, corner: vec3i) -> vec2f {
    let o = vec3u(corner);
    let at = slot - o.x - params.stride.x * (o.y + params.stride.y * o.z);
    return vec2f(energy[part(PREDICTED_PRESSURE, at)], fill[at].y);
}

// A vertex with only gas around it. Differences from the highest pressure, so that a constant one stays constant, up to the sides, and pairs
// across the vertex, so that no order shows.
fn interior_vertex(slot: u32) {
    var reference = vec2f(0.0);
    for (var k = 0u; k < corner_count(); k++) { reference.x = max(reference.x, interior_corner(slot, corner_offset(k)).x); }
    var sum = vec2f(0.0);
    var weighted = 0.0;
    for (var k = 0u; k < corner_count() / 2u; k++) {
        let low = interior_corner(slot, corner_offset(k)) - reference;
        let high = interior_corner(slot, reach() - corner_offset(k)) - reference;
        sum += low + high;
        if PRODUCTS { weighted += rounded(low.x * low.y) + rounded(high.x * high.y); }
    }
    let mean = sum / f32(corner_count());
    pressure[slot] = reference.x + select(mean.x, weighted / max(sum.y, 1e-37), PRODUCTS);
    stiffness[slot] = mean.y * cell_volume();
}

// Count, pressure over the reference, compliance of a corner; and the mean pressure of a sum of them.
fn of_corner(over: f32, compliance: f32) -> vec3f { return vec3f(1.0, select(over, over * compliance, PRODUCTS), compliance); }
fn mean_of(sum: vec3f) -> f32 { return sum.y / max(select(sum.x, sum.z, PRODUCTS), select(1e-30, 1e-37, PRODUCTS)); }

// A vertex near an obstacle: weights are the gas that it stands for.
fn cut_vertex(slot: u32) {
    let v = cell_of(slot);
    var reference = 0.0;
    var sum = vec3f(0.0);   // weights, weighted pressure, compliance
    for (var k = 0u; k < corner_count(); k++) {
        let c = v - corner_offset(k);
        let at = slot_of(c);
        if !inside(c) || kind_of(cells[at]) != GAS { continue; }
        let p = energy[part(PREDICTED_PRESSURE, at)];
        let weight = gas_at_corner(at, corner_offset(k));
        if sum.x == 0.0 { reference = p; }
        sum += weight * of_corner(p - reference, fill[at].y);
    }
    pressure[slot] = reference + mean_of(sum);
    stiffness[slot] = sum.z * cell_volume();
}

// Sums over cells around a vertex. gas: count, pressure over the reference, compliance; weight: density times gravity times the way from
// the cell to the vertex, in cells; solid, rigid: compliance of bodies, and of those with a given motion.
struct Around { gas: vec3f, reference: f32, weight: f32, solid: f32, rigid: f32 }

fn both(a: Around, b: Around) -> Around {
    return Around(a.gas + b.gas, 0.0, a.weight + b.weight, a.solid + b.solid, a.rigid + b.rigid);
}

fn beside(v: vec3i, corner: vec3i, reference: f32) -> Around {
    var one: Around;
    let c = v - corner;
    if !inside(c) { return one; }
    let at = slot_of(c);
    let kind = kind_of(cells[at]);
    if kind == GAS {
        one.gas = of_corner(energy[part(PREDICTED_PRESSURE, at)] - reference, fill[at].y);
        if !SOLIDS { one.weight = rounded(conserved[at].x * dot(params.gravity, vec3f(corner) - 0.5)); }
    }
    if kind == SOLID {
        one.solid = max(fill[at].y, 0.0);
        one.rigid = max(-fill[at].y, 0.0);
    }
    return one;
}

// Highest pressure of the gas cells around a vertex.
fn highest_around(v: vec3i) -> f32 {
    var highest = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let c = v - corner_offset(k);
        if inside(c) && kind_of(cells[slot_of(c)]) == GAS { highest = max(highest, energy[part(PREDICTED_PRESSURE, slot_of(c))]); }
    }
    return highest;
}

// Whether a node that is not driven looks at a vertex, from its 4^DIM block.
fn meets_free_node(v: vec3i) -> bool {
    let low = -2 * reach();
    for (var z = low.z; z <= reach().z; z++) {
        for (var y = low.y; y <= reach().y; y++) {
            for (var x = low.x; x <= reach().x; x++) {
                let c = v + vec3i(x, y, z);
                if !in_ring(c) { continue; }
                let word = cells[slot_of(c)];
                if has(word, NODE_SOLID) && !has(word, NODE_DRIVEN) { return true; }
            }
        }
    }
    return false;
}

// Whether one of the cells at a vertex is cut: then no body is near.
fn meets_cut_cell(v: vec3i) -> bool {
    for (var k = 0u; k < corner_count(); k++) {
        if cut_entry(slot_of(v - corner_offset(k))) != 0u { return true; }
    }
    return false;
}

fn listed_vertex(slot: u32) {
    let word = cells[slot];
    if CUT && !has(word, VERTEX_REGULAR) && (!SOLIDS || meets_cut_cell(cell_of(slot))) {
        cut_vertex(slot);
        return;
    }
    var sum: Around;
    if has(word, VERTEX_GAS | VERTEX_SOLID) {
        let v = cell_of(slot);
        let reference = highest_around(v);
        for (var k = 0u; k < corner_count() / 2u; k++) {
            sum = both(sum, both(beside(v, corner_offset(k), reference), beside(v, reach() - corner_offset(k), reference)));
        }
        sum.reference = reference;
    }
    let gas = sum.gas;
    let part = cell_volume() / f32(corner_count());
    // Where cells are all around, what they weigh cancels.
    let below = select(0.0, sum.weight * params.spacing, gas.x < f32(corner_count()));
    let gas_pressure = sum.reference + select((gas.y + below) / max(gas.x, 1.0), mean_of(gas) + below / max(gas.x, 1.0), PRODUCTS);
    let s_gas = gas.z * part;
    var s_solid = 0.0;
    var q = 0.0;
    if SOLIDS { s_solid = sum.solid * part; q = ghost[slot]; }
    var at = NO_EXTRA;
    if SOLIDS { at = extra[slot]; }
    if at != NO_EXTRA {
        pressure[slot] = gas_pressure;
        stiffness[slot] = s_gas;
        pressure[apart_h(at)] = gas_pressure; // h starts from the gas
        stiffness[apart_h(at)] = 0.0;
        pressure[apart_q(at)] = q;
        stiffness[apart_q(at)] = s_solid;
        return;
    }
    // Inside a body with a given motion nothing gives way; a free node of a body that it touches would meet a pressure without bound.
    if DRIVEN && s_gas + s_solid == 0.0 && sum.rigid > 0.0 && meets_free_node(cell_of(slot)) { s_solid = sum.rigid * part; }
    let s = s_gas + s_solid;
    pressure[slot] = select(q, gas_pressure + s_solid / s * (q - gas_pressure), s > 0.0);
    stiffness[slot] = s;
}

@compute @workgroup_size(WORKGROUP)
fn vertex_pressure(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let own = interior_slot(thread);
    if own < params.slots { interior_vertex(own); }
    on_list = true;
    let next = one_listed(thread);
    if next < params.slots { listed_vertex(next); }
    for (var k = first_listed(thread); k < among(); k = next_listed(k)) { listed_vertex(listed_slot(k)); }
}
