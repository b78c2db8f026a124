// coupled_solve, preparation: the Jacobi diagonal D = S^-1 + dt^2 sum over nodes |coefficient|^2 / M. All coefficients of one
// vertex on one node are summed before they are squared. Unused unknowns get the inverse 0 and stay 0.
#include "shared/index.wgsl"
#include "shared/listed.wgsl"
#include "shared/cell.wgsl"
#include "shared/control.wgsl"
#include "shared/element.wgsl"
#include "shared/system.wgsl"
#include "shared/cut_system.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> extra: array<u32>;
@group(0) @binding(4) var<storage, read> work: array<vec4f>;        // w: inverse masses of gas and solid nodes
@group(0) @binding(5) var<storage, read> stiffness: array<f32>;
@group(0) @binding(6) var<storage, read_write> inverse_diagonal: array<f32>;

struct Entries { own: vec3f, h: vec3f, q: vec3f, h_solid: vec3f } // gas node: own, h; solid node: q, h_solid

fn add_entries(entries: ptr<function, Entries>, kinds: u32, node_offset: vec3i, corner: vec3i, solid: bool) {
    let quadratic = solid || QUADRATIC;
    let inner = element_entry(quadratic, node_offset, corner);
    if solid { (*entries).q += inner; } else { (*entries).own += inner; }
    for (var n = 0u; n < DIM; n++) {
        let up = corner[n] == 1;
        if !face_holds(node_offset, n, up) { continue; }
        let beyond = kind_across(kinds, corner, n);
        let across = select(-1.0, 1.0, up) * face_entry(quadratic, n, node_offset, corner);
        if solid {
            if beyond == GAS { (*entries).h_solid[n] += across; }
        } else if beyond == SOLID { (*entries).h[n] += across; }
        else if beyond == WALL || beyond == GHOST { (*entries).own[n] += across; }
    }
}

fn entries_at(v: vec3i, kinds: u32, j: vec3i) -> Entries {
    var entries: Entries;
    for (var k = 0u; k < corner_count(); k++) {
        let corner = corner_offset(k);
        let e = v - corner;
        let node_offset = j - e;
        if !inside(mirrored(e)) || any(abs(node_offset) > vec3i(1)) { continue; }
        let kind = (kinds >> (2u * k)) & 3u;
        if kind == GAS || kind == SOLID { add_entries(&entries, kinds, node_offset, corner, kind == SOLID); }
    }
    return entries;
}

fn inverse(d: f32) -> f32 { return select(0.0, 1.0 / d, d > 0.0); }

// The node that has this vertex at wide_offset(k), which covers both element pairs.
fn node_of(v: vec3i, k: u32) -> vec3i { return v - wide_offset(k); }

// Sum of |coefficient|^2 / M over the nodes, where only gas, or only solid, and the sides of the domain are around.
fn wide_square(v: vec3i, base: u32, solid: bool) -> f32 {
    let ex = wide_entries_of_vertex(0u, v.x, solid);
    let ey = wide_entries_of_vertex(1u, v.y, solid);
    let ez = wide_entries_of_vertex(2u, v.z, solid);
    var sum = 0.0;
    for (var k = 0u; k < wide_count(); k++) {
        let j = node_of(v, k);
        if !in_ring(j) { continue; }
        let at = wide_offset(k) + vec3i(1);
        let entry = vec3f(ex.slope[at.x] * ey.mean[at.y] * ez.mean[at.z], ex.mean[at.x] * ey.slope[at.y] * ez.mean[at.z],
            ex.mean[at.x] * ey.mean[at.y] * ez.slope[at.z]);
        sum += work[base + slot_of(j)].w * dot(entry, entry);
    }
    return sum;
}

fn regular_square(v: vec3i) -> f32 {
    if QUADRATIC { return wide_square(v, 0u, false); }
    var sum = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let corner = corner_offset(k);
        let ex = narrow_pair(0u, v.x, corner.x);
        let ey = narrow_pair(1u, v.y, corner.y);
        let ez = narrow_pair(2u, v.z, corner.z);
        let entry = vec3f(ex.y * ey.x * ez.x, ex.x * ey.y * ez.x, ex.x * ey.x * ez.y);
        sum += work[slot_of(v - corner)].w * dot(entry, entry);
    }
    return sum;
}

// The same near an obstacle; the coefficients on one cluster add up first.
fn cut_square(v: vec3i) -> f32 {
    var sum = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let j = v - corner_offset(k);
        let own = coefficient(j, v);
        for (var l = 0u; l < corner_count(); l++) {
            let other = v - corner_offset(l);
            if cluster_first(slot_of(other)) != cluster_first(slot_of(j)) { continue; }
            sum += work[slot_of(j)].w * dot(own, coefficient(other, v));
        }
    }
    return sum;
}

struct Squares { own: f32, h: f32, q: f32 }

// The same between gas and body.
fn mixed_squares(v: vec3i, apart: bool, count: u32) -> Squares {
    var squares: Squares;
    let kinds = kinds_around_vertex(select(vec3i(0), v, count > 0u));
    for (var k = 0u; k < count; k++) {
        let j = node_of(v, k);
        if !in_ring(j) { continue; }
        let gas = work[slot_of(j)].w;
        let solid = select(0.0, work[params.slots + slot_of(j)].w, SOLIDS && has(cells[slot_of(j)], NODE_SOLID));
        let at = entries_at(v, kinds, j);
        if apart {
            squares.own += gas * dot(at.own, at.own);
            squares.h += gas * dot(at.h, at.h) + solid * dot(at.h_solid, at.h_solid);
            squares.q += solid * dot(at.q, at.q);
        } else {
            squares.own += gas * dot(at.own + at.h, at.own + at.h) + solid * dot(at.q + at.h_solid, at.q + at.h_solid);
        }
    }
    return squares;
}

@compute @workgroup_size(WORKGROUP)
fn solve_diagonal(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                  @builtin(local_invocation_index) lane: u32) {
    let slot = busy_slot(thread_index(group, groups, lane));
    if slot >= params.slots { return; }
    let word = cells[slot];
    if !LISTED && !has(word, INTERIOR) { return; }
    if LISTED && !has(word, VERTEX_GAS | VERTEX_SOLID) {
        inverse_diagonal[slot] = 0.0;
        return;
    }
    let scale = control.dt * face_area() * control.dt * face_area();
    let v = cell_of(slot);
    let regular = !LISTED || has(word, VERTEX_REGULAR);
    if CUT && LISTED && !regular {
        inverse_diagonal[slot] = inverse(stiffness[slot] + scale * cut_square(v));
        return;
    }
    let deep = SOLIDS && LISTED && has(word, VERTEX_DEEP);
    let apart = interface_index(slot) != slot;
    var squares: Squares;
    if LISTED { squares = mixed_squares(v, apart, select(wide_count(), 0u, regular || deep)); }
    for (var turn = 0u; turn < u32(regular); turn++) { squares.own = regular_square(v); }
    for (var turn = 0u; turn < u32(deep); turn++) { squares.own = wide_square(v, params.slots, true); }
    inverse_diagonal[slot] = inverse(stiffness[slot] + scale * squares.own);
    if apart {
        // where h has a row, the preconditioner of the surface stands in for the diagonal
        let alone = extra[slot] >= params.surface_rows;
        inverse_diagonal[interface_index(slot)] = select(0.0, inverse(scale * squares.h), alone);
        inverse_diagonal[ghost_index(slot)] = inverse(stiffness[ghost_index(slot)] + scale * squares.q);
    }
}
