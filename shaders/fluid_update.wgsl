// fluid_update: momentum and energy of the gas from the solved pressure, by local gradients. [Kwatra et al. 2009; eqs. 14, 3]
// Reads pressure, cells, nodes. Writes gas. On return momentum and energy are final; each face gives one cell what it takes
// from the other, so their sums are conserved. WALL and GHOST slots collect the impulse and work that leaves through them.
#include "shared/index.wgsl"
#include "shared/listed.wgsl"
#include "shared/cell.wgsl"
#include "shared/gas.wgsl"
#include "shared/boundary.wgsl"
#include "shared/control.wgsl"
#include "shared/ars.wgsl"
#include "shared/element.wgsl"
#include "shared/system.wgsl"
#include "shared/interior.wgsl"
#include "shared/carrier.wgsl"
#include "shared/cut_system.wgsl"
#include "shared/cut_carrier.wgsl"
#include "shared/body_power.wgsl"
#include "shared/late_flux.wgsl"
#include "shared/floor.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> extra: array<u32>;
@group(0) @binding(4) var<storage, read> pressure: array<f32>;
@group(0) @binding(5) var<storage, read_write> conserved: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> energy: array<f32>;
@group(0) @binding(7) var<storage, read> node: array<vec4f>;
@group(0) @binding(8) var<storage, read> work: array<vec4f>;    // second half: M^-1 (G Q + H h) of solid nodes

// Slots of the vertices of a face across axis n whose low corner is `low`; along an inactive axis each is met twice.
fn face_vertices(low: vec3i, n: u32) -> vec4u {
    let a = axis((n + 1u) % 3u) * reach();
    let b = axis((n + 2u) % 3u) * reach();
    return vec4u(slot_of(low), slot_of(low + a), slot_of(low + b), slot_of(low + a + b));
}

// Where these vertices keep the pressure between gas and body.
fn interface_indices(at: vec4u) -> vec4u {
    return vec4u(interface_index(at.x), interface_index(at.y), interface_index(at.z), interface_index(at.w));
}

// Mean pressure of the open part of a face of cell c next to an obstacle.
fn cut_face_pressure(c: vec3i, low: vec3i, n: u32, up: bool) -> f32 {
    var sum = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let corner = corner_offset(k);
        if corner[n] == 1 { continue; }
        let own = corner + select(vec3i(0), axis(n), up);
        sum += face_shape(slot_of(c), n, up, own) * pressure[slot_of(low + corner)];
    }
    return sum;
}

// Pressure of the face of GAS cell c across axis n: mean of its vertices; for B2B1 inside the gas the finite-element mean,
// p * (1,4,1)/6 along the axis and (1,11,11,1)/24 across, without which short waves grow for c dt > 2 dx.
fn face_pressure(c: vec3i, n: u32, up: bool, beyond: u32) -> f32 {
    let low = select(c, c + axis(n), up);
    let between_gas = beyond == GAS || is_image(select(c - axis(n), c + axis(n), up));
    if QUADRATIC && between_gas && wide_face_is_gas(low, n) { return wide_face_pressure(low, n); }
    if CUT { return cut_face_pressure(c, low, n, up); }
    var at = face_vertices(low, n);
    for (var turn = 0u; turn < u32(SOLIDS && beyond == SOLID); turn++) { at = interface_indices(at); }
    return mean2(mean2(pressure[at.x], pressure[at.y]), mean2(pressure[at.z], pressure[at.w]));
}

// Loss of momentum of a cluster next to an obstacle: the pressure gradient over its gas.
fn cut_impulse(slot: u32) -> vec3f {
    var force = vec3f(0.0);
    for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) {
        let c = cell_of(at);
        for (var k = 1u; k < corner_count(); k++) {
            force += (pressure[slot_of(c + corner_offset(k))] - pressure[at]) * cut_slope(at, corner_offset(k));
        }
    }
    return -force / cluster_share(slot);
}

fn wide_range(n: u32) -> array<vec3i, 2> {
    var first = -reach();
    var last = 2 * reach();
    first[n] = -1;
    last[n] = 1;
    return array<vec3i, 2>(first, last);
}

fn wide_face_is_gas(low: vec3i, n: u32) -> bool {
    let range = wide_range(n);
    for (var z = range[0].z; z <= range[1].z; z++) {
        for (var y = range[0].y; y <= range[1].y; y++) {
            for (var x = range[0].x; x <= range[1].x; x++) {
                let v = mirrored_vertex(low + vec3i(x, y, z));
                if !is_vertex(v) || !has(cells[slot_of(v)], VERTEX_GAS) { return false; }
            }
        }
    }
    return true;
}

// (1, 4, 1) / 6 of the vertices along axis n, by differences from `reference`.
fn face_line(middle: vec3i, n: u32, reference: f32) -> f32 {
    let below = pressure[slot_of(mirrored_vertex(middle - axis(n)))] - reference;
    let above = pressure[slot_of(mirrored_vertex(middle + axis(n)))] - reference;
    return rounded((below + above) / 6.0) + rounded(2.0 / 3.0 * (pressure[slot_of(mirrored_vertex(middle))] - reference));
}

// (1, 11, 11, 1) / 24 across; an inactive axis has one layer.
fn across_weights(a: u32) -> vec4f { return select(vec4f(0.0, 1.0, 0.0, 0.0), vec4f(1.0, 11.0, 11.0, 1.0) / 24.0, a < DIM); }

// By differences, so that a constant pressure stays constant, from the highest in the middle, and from both ends alike.
fn wide_face_pressure(low: vec3i, n: u32) -> f32 {
    let a = (n + 1u) % 3u;
    let b = (n + 2u) % 3u;
    let at = face_vertices(low, n);
    let reference = max(max(pressure[at.x], pressure[at.y]), max(pressure[at.z], pressure[at.w]));
    var rows: vec4f;
    for (var k = -reach()[b]; k <= 2 * reach()[b]; k++) {
        var lines: vec4f;
        for (var j = -reach()[a]; j <= 2 * reach()[a]; j++) { lines[j + 1] = face_line(low + j * axis(a) + k * axis(b), n, reference); }
        rows[k + 1] = paired(lines * across_weights(a));
    }
    return reference + paired(rows * across_weights(b));
}

// Mean pressure of the low face of a cell deep inside the gas.
fn interior_face(at: u32, n: u32) -> f32 {
    if QUADRATIC { return wide_face_pressure(cell_of(at), n); }
    let t = across(n);
    if DIM == 1u { return pressure[at]; }
    if DIM == 2u { return mean2(pressure[at], pressure[at + t.x + t.y]); }
    return 0.25 * (pressure[at] + pressure[at + t.x] + pressure[at + t.y] + pressure[at + t.x + t.y]);
}

fn interior_impulse(slot: u32) -> vec3f {
    var impulse = vec3f(0.0);
    for (var n = 0u; n < DIM; n++) { impulse[n] = interior_face(slot, n) - interior_face(slot + step_of(n), n); }
    return impulse;
}

fn flow_at(slot: u32) -> vec4f { return conserved[slot]; }

// Velocity of the face between two GAS cells.
fn face_velocity(n: u32, low: u32, high: u32, a: vec4f, b: vec4f) -> f32 {
    if CONSISTENT {
        if near_obstacle(cells[low], cells[high]) { return cut_velocity(cell_of(low), n) - given_back() * (node[high].w - node[low].w); }
        return carried_velocity(n, node[low], a.x, node[high], b.x);
    }
    return (a[n + 1u] + b[n + 1u]) / (a.x + b.x);
}

// With two solves the new face velocity also carries the internal energy that was there at the start of the step [shared/ars.wgsl].
fn carried_along(low: u32, high: u32) -> f32 {
    if !ARS { return 0.0; }
    return 0.5 * (energy[ARS_HEAT * params.slots + low] + energy[ARS_HEAT * params.slots + high]);
}

fn interior_heat(slot: u32, here: vec4f) -> f32 {
    var heat = 0.0;
    var own = vec4f(0.0);
    if CONSISTENT { own = node[slot]; }
    for (var n = 0u; n < DIM; n++) {
        let low = slot - step_of(n);
        let high = slot + step_of(n);
        var below: f32;
        var above: f32;
        if CONSISTENT {
            below = carried_velocity(n, node[low], conserved[low].x, own, here.x);
            above = carried_velocity(n, own, here.x, node[high], conserved[high].x);
        } else {
            below = (conserved[low][n + 1u] + here[n + 1u]) / (conserved[low].x + here.x);
            above = (here[n + 1u] + conserved[high][n + 1u]) / (here.x + conserved[high].x);
        }
        heat += rounded((interior_face(slot, n) + carried_along(low, slot)) * below
            - (interior_face(high, n) + carried_along(slot, high)) * above);
    }
    return heat;
}

// Calls with c in GAS; slots of other kinds see the same face from the other side.
@compute @workgroup_size(WORKGROUP)
fn fluid_momentum(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                  @builtin(local_invocation_index) lane: u32) {
    let slot = busy_slot(thread_index(group, groups, lane));
    if slot >= params.slots { return; }
    if !LISTED {
        if has(cells[slot], INTERIOR) {
            conserved[slot] += vec4f(0.0, interior_impulse(slot) * control.dt / params.spacing);
        }
        return;
    }
    let kind = kind_of(cells[slot]);
    if kind == SOLID { return; }
    let c = cell_of(slot);
    if kind == GAS && beside_obstacle(cells[slot]) {
        conserved[slot] += vec4f(0.0, cut_impulse(slot) * control.dt / params.spacing);
        return;
    }
    var impulse = vec3f(0.0);
    for (var n = 0u; n < DIM; n++) {
        for (var side = 0u; side < 2u; side++) {
            let up = side == 1u;
            let other = select(c - axis(n), c + axis(n), up);
            let own = kind == GAS;
            if !own && (!inside(other) || kind_of(cells[slot_of(other)]) != GAS) { continue; }
            let near = select(other, c, own);
            impulse[n] += select(1.0, -1.0, up) * aperture(slot_of(near), n, up == own)
                * face_pressure(near, n, up == own, neighbour_kind(near, n, up == own));
        }
    }
    if LATE_FLUX && kind == GAS && has(cells[slot], NODE_SOLID) {
        let left = 1.0 - late_share_of(c);
        conserved[slot] *= left;
        energy[slot] *= left;
    }
    if any(impulse != vec3f(0.0)) {
        conserved[slot] += vec4f(0.0, impulse * control.dt / params.spacing);
    }
}

// What passes a face of GAS cell c: p u.
fn face_power(c: vec3i, slot: u32, here: vec4f, n: u32, up: bool) -> f32 {
    let beyond = neighbour_kind(c, n, up);
    if beyond == WALL { return 0.0; }
    if SOLIDS {
        var power = 0.0;
        for (var turn = 0u; turn < u32(beyond == SOLID); turn++) { power = interface_power(c, n, up); }
        if beyond == SOLID { return power; }
    }
    let p = face_pressure(c, n, up, beyond);
    let far = slot_of(select(c - axis(n), c + axis(n), up));
    if beyond == GAS {
        let there = in_space(conserved[far]);
        let velocity = face_velocity(n, select(far, slot, up), select(slot, far, up), select(there, here, up), select(here, there, up));
        return (p + carried_along(slot, far)) * velocity;
    }
    // Open: the velocity that the solve saw there.
    let face = OpenFace(energy[2u * params.slots + far], energy[params.slots + far]);
    let y = admittance_of(opening_of(cells[far]), face, here.x, energy[params.slots + slot]);
    return p * (face.velocity + select(-1.0, 1.0, up) * y * (p - face.reference));
}

// Power through the faces of a slot; of one that is not its `own`, through those it shares with GAS cells. `gives`: to slots of the ring
// what passes towards them.
fn heat_of(slot: u32, own: bool, gives: bool) -> f32 {
    let c = cell_of(slot);
    let here = in_space(conserved[slot]);
    var heat = 0.0;
    for (var n = 0u; n < DIM; n++) {
        var along = 0.0;
        for (var side = 0u; side < 2u; side++) {
            let up = side == 1u;
            let sign = select(1.0, -1.0, up);
            let other = select(c - axis(n), c + axis(n), up);
            if !own && (!inside(other) || kind_of(cells[slot_of(other)]) != GAS) { continue; }
            let near = select(other, c, own);
            var state = here;
            if !own { state = conserved[slot_of(near)]; }
            let power = sign * aperture(slot_of(near), n, up == own) * face_power(near, slot_of(near), state, n, up == own);
            along += power;
            if own && gives && !inside(other) { energy[slot_of(other)] -= power * control.dt / params.spacing; }
        }
        heat += rounded(along);
    }
    return heat;
}

// Least ratio of the pressure of the predictor to that of the advected state, and a hair less [intermediate_pressure.wgsl]; with two solves
// less by what the solve does not see.
fn least_predicted() -> f32 { return select(0.98, 0.5, ARS); }

// Whether the floor may have to act on a cell deep inside the gas: never false where it would, for the pressure of the predictor tells
// nearly what internal energy there was before.
fn may_be_cold(slot: u32, flow: vec4f, total: f32) -> bool {
    let before = energy[params.slots + slot] / (least_predicted() * (params.gamma - 1.0));
    return is_unsound(flow.x, total) || total - kinetic_energy(flow) < least_energy(flow.x, total, before);
}

@compute @workgroup_size(WORKGROUP)
fn fluid_energy(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                @builtin(local_invocation_index) lane: u32) {
    let slot = listed_slot(thread_index(group, groups, lane));
    if slot >= params.slots { return; }
    if !LISTED {
        if has(cells[slot], INTERIOR) {
            let flow = in_space(conserved[slot]);
            let total = energy[slot] + interior_heat(slot, flow) * control.dt / params.spacing;
            if may_be_cold(slot, flow, total) { atomicStore(&control.cold, 1u); }
            energy[slot] = total;
        }
        return;
    }
    let kind = kind_of(cells[slot]);
    if kind == WALL || kind == SOLID { return; }
    var heat = 0.0;
    // A slot of the ring has its part from the cell before it.
    for (var turn = u32(!inside(cell_of(slot))); turn < 1u; turn++) {
        for (var at = cluster_first(slot); at != NO_EXTRA; at = cluster_next(at)) { heat += heat_of(at, kind == GAS, at == slot); }
    }
    heat /= cluster_share(slot);
    if heat != 0.0 { energy[slot] += heat * control.dt / params.spacing; }
}
