// coupled_solve, first half of the operator: velocity change per unit time W = M^-1 C x at every node.
// Reads x, cells, masses. Writes work: gas nodes, then solid nodes; w keeps the inverse mass of the gas node.
#include "shared/index.wgsl"
#include "shared/listed.wgsl"
#include "shared/cell.wgsl"
#include "shared/element.wgsl"
#include "shared/system.wgsl"
#include "shared/interior.wgsl"

@group(0) @binding(1) var<storage, read> cells: array<u32>;
@group(0) @binding(2) var<storage, read> extra: array<u32>;
@group(0) @binding(3) var<storage, read> x: array<f32>;
@group(0) @binding(4) var<storage, read_write> work: array<vec4f>;
@group(0) @binding(5) var<storage, read> node: array<vec4f>;

// Only gas and the sides of the domain around the node: a product of one-dimensional stencils.
fn regular_force(slot: u32, c: vec3i) -> vec3f {
    let ex = axis_entries(0u, c.x, true);
    let ey = axis_entries(1u, c.y, true);
    let ez = axis_entries(2u, c.z, true);
    var force = vec3f(0.0);
    let wide = select(0, 1, QUADRATIC);
    let first = -wide * reach();
    let last = (1 + wide) * reach();
    for (var k = first.z; k <= last.z; k++) {
        if ez.mean[k + 1] == 0.0 { continue; }
        for (var j = first.y; j <= last.y; j++) {
            if ey.mean[j + 1] == 0.0 { continue; }
            for (var i = first.x; i <= last.x; i++) {
                if ex.mean[i + 1] == 0.0 { continue; }
                let value = x[u32(i32(slot) + i + i32(params.stride.x) * (j + i32(params.stride.y) * k))];
                force += value * vec3f(ex.slope[i + 1] * ey.mean[j + 1] * ez.mean[k + 1],
                    ex.mean[i + 1] * ey.slope[j + 1] * ez.mean[k + 1], ex.mean[i + 1] * ey.mean[j + 1] * ez.slope[k + 1]);
            }
        }
    }
    return force;
}

// (mean, difference) of the two vertices along x.
fn line(at: u32) -> vec2f { return vec2f(mean2(x[at], x[at + 1u]), x[at + 1u] - x[at]); }

// (mean, x-difference, y-difference) of a layer.
fn layer(at: u32) -> vec3f {
    let low = line(at);
    if DIM == 1u { return vec3f(low, 0.0); }
    let high = line(at + params.stride.x);
    return vec3f(mean2(low.x, high.x), mean2(low.y, high.y), high.x - low.x);
}

fn interior_force(slot: u32) -> vec3f {
    let low = layer(slot);
    if DIM < 3u { return vec3f(low.yz, 0.0); }
    let high = layer(slot + params.stride.x * params.stride.y);
    return vec3f(mean2(low.y, high.y), mean2(low.z, high.z), high.x - low.x);
}

// The same deep inside a body.
fn deep_force(slot: u32, count: u32) -> vec3f {
    var force = vec3f(0.0);
    for (var k = 0u; k < count; k++) {
        let offset = deep_offset(k);
        let v = u32(i32(slot) + offset.x + i32(params.stride.x) * (offset.y + i32(params.stride.y) * offset.z));
        force += x[ghost_index(v)] * deep_entry(offset);
    }
    return force;
}

// One element's force on one of its nodes: a product of one-dimensional entries. A closed face adds 1/2 to the slope of its
// vertices; where h is an unknown of its own, the face carries h instead of the element's pressure.
fn element_force(c: vec3i, kinds: vec2u, offset: vec3i, solid: bool) -> vec3f {
    let quadratic = solid || QUADRATIC;
    var slope = mat2x3f();      // [high corner][axis]
    var face = mat2x3f();       // of faces between gas and solid
    var mean = mat2x3f(vec3f(1.0), vec3f(1.0));
    for (var n = 0u; n < DIM; n++) {
        for (var side = 0u; side < 2u; side++) {
            let up = side == 1u;
            slope[side][n] = gradient_entry(quadratic, -offset[n], up);
            mean[side][n] = mean_entry(quadratic, -offset[n], up);
            if !face_holds(-offset, n, up) { continue; }
            let beyond = kind_in_block(kinds, select(offset - axis(n), offset + axis(n), up));
            let body = select(beyond == SOLID, beyond == GAS, solid);
            let bare = !solid && (beyond == WALL || beyond == GHOST);
            let share = select(0.0, select(-0.5, 0.5, up), body || bare);
            slope[side][n] += share;
            if body { face[side][n] = share; }
        }
    }
    var force = vec3f(0.0);
    for (var k = 0u; k < corner_count(); k++) {
        let corner = corner_offset(k);
        let v = slot_of(c + offset + corner);
        let h = interface_index(v);
        let apart = h != v;
        let value = x[select(v, h + params.extra_capacity, solid && apart)];
        let m = vec3f(mean[corner.x].x, mean[corner.y].y, mean[corner.z].z);
        let across = vec3f(m.y * m.z, m.x * m.z, m.x * m.y);
        force += value * across * vec3f(slope[corner.x].x, slope[corner.y].y, slope[corner.z].z);
        let jump = select(0.0, x[h] - value, apart);
        force += jump * across * vec3f(face[corner.x].x, face[corner.y].y, face[corner.z].z);
    }
    return force;
}

struct Forces { gas: vec3f, solid: vec3f }

// Sum over the elements around a node between gas and body; `count`: block_size(), or 0 elsewhere.
fn mixed_force(c: vec3i, count: u32) -> Forces {
    var forces: Forces;
    let kinds = kinds_around_node(c);
    for (var k = 0u; k < count; k++) {
        let offset = block_offset(k);
        let kind = kind_in_block(kinds, offset);
        if !inside(c + offset) || (kind != GAS && kind != SOLID) { continue; }
        let solid = kind == SOLID;
        let force = element_force(c, kinds, offset, solid);
        if solid { forces.solid += force; } else { forces.gas += force; }
    }
    return forces;
}

@compute @workgroup_size(WORKGROUP)
fn solve_forces(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                @builtin(local_invocation_index) lane: u32) {
    let slot = frontier_slot(thread_index(group, groups, lane));
    if slot >= params.slots { return; }
    let word = cells[slot];
    let inverse_mass = work[slot].w;
    if !LISTED {
        if !has(word, INTERIOR) { return; }
        var force: vec3f;
        if QUADRATIC { force = regular_force(slot, cell_of(slot)); } else { force = interior_force(slot); }
        work[slot] = vec4f(force * face_area() * inverse_mass, inverse_mass);
        return;
    }
    let c = cell_of(slot);
    let regular = has(word, NODE_REGULAR);
    let deep = SOLIDS && has(word, NODE_DEEP);
    let mixed = has(word, NODE_GAS | NODE_SOLID) && !regular && !deep;
    var forces = mixed_force(c, select(0u, block_size(), mixed));
    if regular { forces.gas = regular_force(slot, c); }
    work[slot] = vec4f(forces.gas * face_area() * inverse_mass, inverse_mass);
    if !SOLIDS || !has(word, NODE_SOLID) { return; }
    forces.solid += deep_force(slot, select(0u, deep_count(), deep));
    let mass = max(node[slot].w, params.mass_floor);
    work[params.slots + slot] = vec4f(forces.solid * face_area() / mass, 1.0 / mass);
}
