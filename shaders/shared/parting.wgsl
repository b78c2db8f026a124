// Where the velocities of two cells part, the pressure of their face works on both, and each pays for it in proportion to its own
// pressure. The mean by mass, with which a face moves, would let a thin cell pay nearly all of a work whose pressure is the dense one's:
// its entropy would fall. No cell pays more than its own pressure can; what a vertex asks beyond that is paid by all cells around it,
// as far as they have it.
// In gas alone shares are those by mass: by pressure, tubes would have errors 2 to 10 % larger.
// Needs the bindings cells, extra, pressure, control, node, work, conserved and energy.
#include "shared/face_power.wgsl"

// Pressure of a gas cell before the solve.
fn own_pressure(slot: u32) -> f32 { return max(energy[part(PREDICTED_PRESSURE, slot)], 0.0); }

// Velocity of a gas cell that its faces see.
fn parting_speed(slot: u32, n: u32) -> f32 { return conserved[slot][n + 1u] / conserved[slot].x; }

// Power from the low to the high of two gas cells, beside that of the face's velocity: from shares by mass to shares by pressure.
fn shift_between(p: f32, low: u32, high: u32, n: u32) -> f32 {
    if !SOLIDS { return 0.0; }
    let jump = parting_speed(high, n) - parting_speed(low, n);
    if jump <= 0.0 { return 0.0; }
    let a = vec2f(conserved[low].x, own_pressure(low));
    let b = vec2f(conserved[high].x, own_pressure(high));
    return p * jump * (rounded(a.x * a.y) - rounded(b.x * b.y)) / max((a.x + b.x) * (a.y + b.y), 1e-37);
}

// Place of what a vertex asks of the gas around it, over the sum of the pressures of those who pay.
fn surplus_index(vertex: u32) -> u32 { return unknowns() + vertex; }

// Velocity across axis n, at a vertex, of the body beyond a face of gas cell c.
fn body_speed(v: vec3i, c: vec3i, beyond: vec3i, n: u32) -> f32 {
    let a = (n + 1u) % 3u;
    let b = (n + 2u) % 3u;
    var sum = vec2f(0.0);
    for (var k = -reach()[b]; k <= reach()[b]; k++) {
        let pair_b = means_of(b, k);
        let mean_b = select(pair_b.x, pair_b.y, v[b] > c[b]);
        for (var j = -reach()[a]; j <= reach()[a]; j++) {
            let pair_a = means_of(a, j);
            let mean = mean_b * select(pair_a.x, pair_a.y, v[a] > c[a]);
            let away = j * axis(a) + k * axis(b);
            let velocity = 0.5 * (body_velocity(slot_of(c + away), n) + body_velocity(slot_of(beyond + away), n));
            sum += mean * vec2f(velocity, 1.0);
        }
    }
    return sum.x / sum.y;
}

// What a gas cell would pay beyond its own pressure, per jump of velocity, at a vertex between gas cells.
fn beyond_own(p: f32, slot: u32, far: u32) -> f32 {
    let own = own_pressure(slot);
    let both = own + own_pressure(far);
    return max(p - both, 0.0) * own / max(both, 1e-37);
}

// Power of what a gas cell would pay beyond its own pressure at a vertex, for its face across axis n.
fn beyond_cap(v: vec3i, c: vec3i, slot: u32, n: u32) -> f32 {
    let up = v[n] > c[n];
    let other = select(c - axis(n), c + axis(n), up);
    let far = slot_of(other);
    let at = slot_of(v);
    var kind = GAS;
    if is_listed() { kind = kind_of(cells[far]); }
    if kind == GHOST { return 0.0; }
    var there = 0.0;
    var excess: f32;
    if kind == GAS {
        excess = beyond_own(pressure[at], slot, far);
        there = parting_speed(far, n);
    } else {
        excess = max(pressure[interface_index(at)] - 2.0 * own_pressure(slot), 0.0);
    }
    if excess == 0.0 { return 0.0; }
    if SOLIDS && kind == SOLID { there = body_speed(v, c, other, n); }
    return excess * max(select(-1.0, 1.0, up) * (there - parting_speed(slot, n)), 0.0);
}

// The same for all of its faces there, each of which is a mean of its vertices.
fn beyond_caps(v: vec3i, c: vec3i, slot: u32) -> f32 {
    var sum = 0.0;
    for (var n = 0u; n < DIM; n++) { sum += rounded(beyond_cap(v, c, slot, n)); }
    return 2.0 * sum / f32(corner_count());
}

// Whether a cell takes part in what a vertex shares out: gas with gas beside it there. One that is alone pays for its faces itself.
fn shares_at(v: vec3i, c: vec3i) -> bool {
    if !is_listed() { return true; }
    if kind_of(cells[slot_of(c)]) != GAS { return false; }
    for (var n = 0u; n < DIM; n++) {
        let other = select(c - axis(n), c + axis(n), v[n] > c[n]);
        if kind_of(cells[slot_of(other)]) == GAS { return true; }
    }
    return false;
}

// Share of its internal energy that a gas cell gives at all of its vertices together, at most.
const MOST_GIVEN = 0.5;

// What a vertex gets of the gas around it at most, over the sum of the pressures of those who pay: were all vertices of a cell to ask as much,
// it would give MOST_GIVEN. Without that bound cells would pay what they have not, and the energy floor would lend it.
fn most_asked() -> f32 {
    let stiffest = max(grueneisen_of(0.0), grueneisen_of(1.0));
    return MOST_GIVEN * params.spacing / (f32(corner_count()) * stiffest * control.dt);
}

// What a gas cell gets back for its own faces at a vertex, and what it pays there of the sum.
fn heat_at_vertex(v: vec3i, c: vec3i, slot: u32) -> f32 {
    let asked = pressure[surplus_index(slot_of(v))];
    if asked == 0.0 || !shares_at(v, c) { return 0.0; }
    return min(most_asked() / asked, 1.0) * (beyond_caps(v, c, slot) - asked * own_pressure(slot));
}

// Opposite corners in pairs, so that mirror images keep their bits.
fn heat_at_vertices(c: vec3i, slot: u32) -> f32 {
    if !SOLIDS { return 0.0; }
    var heat = 0.0;
    for (var k = 0u; k < corner_count() / 2u; k++) {
        let low = heat_at_vertex(c + corner_offset(k), c, slot);
        let high = heat_at_vertex(c + corner_offset(corner_count() - 1u - k), c, slot);
        heat += rounded(low + high);
    }
    return heat;
}
