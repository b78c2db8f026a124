// The pressure system without a matrix: forces F = C X at the velocity nodes of gas and solid, and their transpose.
// Unknowns: one value per vertex (P, or Q inside solids, or the shared pressure); vertices in the extra list carry h and Q
// apart behind the grid. C = [K; B; H]: element gradients, faces to walls and open sides on P itself, faces between gas and
// solid on h. [Cao et al. 2022, eqs. 34-37]
// Needs the bindings cells and extra.
#include "shared/arrays.wgsl"

fn interface_index(slot: u32) -> u32 {
    if SOLIDS { let at = extra[slot]; if at != NO_EXTRA { return apart_h(at); } }
    return slot;
}
fn ghost_index(slot: u32) -> u32 {
    if SOLIDS { let at = extra[slot]; if at != NO_EXTRA { return apart_q(at); } }
    return slot;
}

fn neighbour_kind(c: vec3i, n: u32, up: bool) -> u32 {
    return kind_of(cells[slot_of(select(c - axis(n), c + axis(n), up))]);
}

// Kinds of the 2^DIM cells around a vertex, two bits each, in the order of corner_offset(): cell k lies at v - corner_offset(k).
fn kinds_around_vertex(v: vec3i) -> u32 {
    var kinds = 0u;
    for (var k = 0u; k < corner_count(); k++) { kinds |= kind_of(cells[slot_of(mirrored(v - corner_offset(k)))]) << (2u * k); }
    return kinds;
}

fn corner_index(corner: vec3i) -> u32 { return u32(corner.x + 2 * corner.y + 4 * corner.z); }

// Kind of the cell beyond the face, across axis n, that the element at `corner` has on the vertex' side.
fn kind_across(kinds: u32, corner: vec3i, n: u32) -> u32 {
    let other = select(corner, 1 - corner, along(n));
    return (kinds >> (2u * corner_index(other))) & 3u;
}

// Kinds of the 3^DIM cells around a node, two bits each, in the order of block_offset(). Beyond the ring: WALL.
fn kinds_around_node(c: vec3i) -> vec2u {
    var kinds = vec2u(0u);
    for (var k = 0u; k < block_size(); k++) {
        let near = c + block_offset(k);
        var kind = WALL;
        if in_ring(near) { kind = kind_of(cells[slot_of(near)]); }
        if k < 16u { kinds.x |= kind << (2u * k); } else { kinds.y |= kind << (2u * (k - 16u)); }
    }
    return kinds;
}

fn kind_in_block(kinds: vec2u, offset: vec3i) -> u32 {
    let place = offset + reach();
    let k = u32(place.x + 3 * place.y + 9 * place.z);
    return (select(kinds.y, kinds.x, k < 16u) >> (2u * (k & 15u))) & 3u;
}

// Vertices of a B2B1 node, 4 per axis, as offsets from its own.
fn wide_count() -> u32 { return 1u << (2u * DIM); }
fn wide_offset(k: u32) -> vec3i { return vec3i(vec3u(k & 3u, (k >> 2u) & 3u, k >> 4u)) - reach(); }
