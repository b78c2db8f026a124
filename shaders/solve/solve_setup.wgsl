// coupled_solve, preparation: node masses, intermediate node velocities, right-hand side of the increment form
//   A D = dt C^T (V* - dt M^-1 C X*) - dt b,  X = X* + D,
// which keeps float32 from losing a small increment in a large pressure. X: pressures of the vertices, X* before the solve, D their
// increment; V: velocities of the nodes, M their masses; C: the gradient; A = S^-1 + dt^2 C^T M^-1 C, S^-1 the compliance; b: what inlets and
// outlets let through, which solve_open has left in residual at the sides. [docs/method/coupled_solve.md]
#include "shared/system.wgsl"
#include "solve/gather.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> extra: array<u32>;
@group(0) @binding(4) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> work: array<vec4f>;
@group(0) @binding(6) var<storage, read> node: array<vec4f>;
@group(0) @binding(7) var<storage, read_write> residual: array<f32>;
@group(0) @binding(8) var<storage, read_write> energy: array<f32>;

// Densities of the cells of a plane around a cell, summed by how many axes they lie off it: the cell itself, beside it, across its corners.
fn layer_densities(at: u32) -> vec3f {
    let x = conserved[at - 1u].x + conserved[at + 1u].x;
    if DIM == 1u { return vec3f(conserved[at].x, x, 0.0); }
    let s = params.stride.x;
    let y = conserved[at - s].x + conserved[at + s].x;
    let corners = (conserved[at - s - 1u].x + conserved[at + s + 1u].x) + (conserved[at - s + 1u].x + conserved[at + s - 1u].x);
    return vec3f(conserved[at].x, x + y, corners);
}

fn mean_mass(at: u32) -> f32 {
    let middle = vec4f(layer_densities(at), 0.0);
    if DIM < 3u { return weighed(middle); }
    let z = params.stride.x * params.stride.y;
    let outer = layer_densities(at - z) + layer_densities(at + z);
    return weighed(vec4f(middle.x, middle.y + outer.x, middle.z + outer.y, outer.z));
}

// Mass that a node sees, over the volume of a cell, from such sums.
fn weighed(densities: vec4f) -> f32 {
    var sum = 0.0;
    for (var off = 0u; off <= DIM; off++) {
        var share = densities[off];
        for (var a = 0u; a < DIM; a++) { share *= mass_share(i32(a < off)); }
        sum += share;
    }
    return sum;
}

fn mass_share(node: i32) -> f32 { return mean_entry(QUADRATIC, node, false) + mean_entry(QUADRATIC, node, true); }

// Density that a node sees in a GAS cell, or in what stands for it: `own`, that of its own cell, where the velocity is constant per cell.
// With a mean, a thin cell beside a dense one would move like the dense one in the solve, and as itself after it. In scenes with bodies the
// mean stays: beside a body a cell may be so thin that its own mass would let the body's pressure throw it. 0 elsewhere.
fn gas_density(c: vec3i, own: f32) -> f32 {
    let near = joined(mirrored(c));
    if !inside(near) || kind_of(cells[slot_of(near)]) != GAS { return 0.0; }
    return select(conserved[slot_of(near)].x, own, own > 0.0);
}

fn own_mass() -> bool { return !QUADRATIC && !SOLIDS; }

fn interior_mass(at: u32) -> f32 {
    if own_mass() { return conserved[at].x; }
    return mean_mass(at);
}

// Lumped mass of a gas node from the gas cells around it.
fn find_mass(slot: u32) {
    var mass = 0.0;
    let c = cell_of(slot);
    if !is_listed() { mass = interior_mass(slot); }
    else if beside_obstacle(slot, cells[slot]) {
        if kind_of(cells[slot]) == GAS { mass = conserved[slot].x * cluster_share(slot); }
    } else if has(cells[slot], NODE_GAS) && !is_image(c) && !is_joined(c) {
        var around = vec4f(0.0);    // pairs across the node by how many axes they lie off
        let own = select(0.0, conserved[slot].x, own_mass() && kind_of(cells[slot]) == GAS);
        for (var k = 0u; k < block_size() / 2u; k++) {
            let offset = block_offset(k);
            around[dot(offset, offset)] += gas_density(c + offset, own) + gas_density(c - offset, own);
        }
        around.x = gas_density(c, own);
        mass = weighed(around);
    }
    let inverse = select(0.0, 1.0 / (mass * cell_volume()), mass > 0.0);
    if is_listed() || QUADRATIC { work[part(GAS_NODE, slot)] = vec4f(0.0, 0.0, 0.0, inverse); }
    if kind_of(cells[slot]) != GHOST { energy[part(INVERSE_MASS, slot)] = inverse; }
}

@compute @workgroup_size(WORKGROUP)
fn solve_masses(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let own = interior_slot(thread);
    if own < params.slots { find_mass(own); }
    on_list = true;
    let next = one_listed(thread);
    if next < params.slots { find_mass(next); }
    for (var k = first_listed(thread); k < among(); k = next_listed(k)) { find_mass(listed_slot(k)); }
}

// A node that is not in the gas moves like the nearest gas cells: face neighbours, else edges, else corners.
fn nearest_gas_velocity(c: vec3i) -> vec3f {
    for (var distance = 1; distance <= i32(DIM); distance++) {
        var sum = vec3f(0.0);
        var count = 0.0;
        for (var k = 0u; k < block_size(); k++) {
            let offset = block_offset(k);
            if dot(offset, offset) != distance || !inside(c + offset) { continue; }
            let at = slot_of(c + offset);
            if kind_of(cells[at]) == GAS {
                sum += velocity_of(in_space(conserved[at]));
                count += 1.0;
            }
        }
        if count > 0.0 { return sum / count; }
    }
    return vec3f(0.0);
}

fn gas_node_velocity(c: vec3i, slot: u32) -> vec3f {
    if is_image(c) { return vec3f(0.0); }
    let kind = kind_of(cells[slot]);
    if kind == GAS { return velocity_of(in_space(conserved[slot])); }
    if kind != GHOST { return nearest_gas_velocity(c); }
    let opening = opening_of(cells[slot]);
    let near = slot_of(nearest_inside(c));
    if kind_of(cells[near]) == GAS { return velocity_beyond(opening, conserved[near]); }
    if prescribes(opening) { return velocity_of(opening.flow); }
    return nearest_gas_velocity(c);
}

// work: M^-1 C X* becomes V* - dt M^-1 C X*.
fn interior_velocity(slot: u32) {
    let gas = work[part(GAS_NODE, slot)];
    work[part(GAS_NODE, slot)] = vec4f(velocity_of(in_space(conserved[slot])) - control.dt * gas.xyz, gas.w);
}

fn listed_velocities(slot: u32) {
    let word = cells[slot];
    if has(word, NODE_GAS) {
        let gas = work[part(GAS_NODE, slot)];
        work[part(GAS_NODE, slot)] = vec4f(gas_node_velocity(cell_of(slot), slot) - control.dt * gas.xyz, gas.w);
    }
    if SOLIDS && has(word, NODE_SOLID) {
        let solid = work[part(SOLID_NODE, slot)];
        work[part(SOLID_NODE, slot)] = vec4f(node[slot].xyz - control.dt * solid.xyz, solid.w);
    }
}

@compute @workgroup_size(WORKGROUP)
fn solve_velocities(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let own = interior_slot(thread);
    if own < params.slots { interior_velocity(own); }
    on_list = true;
    let next = one_listed(thread);
    if next < params.slots { listed_velocities(next); }
    for (var k = first_listed(thread); k < among(); k = next_listed(k)) { listed_velocities(listed_slot(k)); }
}

fn find_residual(slot: u32) {
    let word = cells[slot];
    let rows = gather_rows(slot, word);
    let scale = control.dt * face_area();
    var own = rows.own;
    if !is_listed() { residual[slot] = scale * own; return; }
    let v = cell_of(slot);
    let at_side = any(((v == vec3i(0)) | (v == vec3i(params.cells))) & (reach() == vec3i(1)));
    if RULES_USED != 0u && at_side && has(word, VERTEX_GAS) { own -= residual[slot]; } // b, from solve_open
    residual[slot] = scale * own;
    if SOLIDS && extra[slot] != NO_EXTRA {
        residual[apart_h(extra[slot])] = scale * rows.h;
        residual[apart_q(extra[slot])] = scale * rows.q;
    }
}

@compute @workgroup_size(WORKGROUP)
fn solve_residual(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let own = interior_slot(thread);
    if own < params.slots { find_residual(own); }
    on_list = true;
    let next = one_listed(thread);
    if next < params.slots { find_residual(next); }
    for (var k = first_listed(thread); k < among(); k = next_listed(k)) { find_residual(listed_slot(k)); }
}
