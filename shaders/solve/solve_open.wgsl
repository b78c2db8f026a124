// coupled_solve, preparation: open faces. b of a vertex in units of face_area(), with X* in it: what flows out through the open
// faces that it belongs to; and their admittance, which resists the increment like a stiffness.
#include "shared/open_side.wgsl"
#include "shared/gas_at.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> extra: array<u32>;
@group(0) @binding(4) var<storage, read_write> energy: array<f32>;
@group(0) @binding(8) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(5) var<storage, read> pressure: array<f32>;
@group(0) @binding(9) var<storage, read_write> fill: array<vec2f>;
@group(0) @binding(6) var<storage, read_write> stiffness: array<f32>;
@group(0) @binding(7) var<storage, read_write> residual: array<f32>;

// GHOST slots next to a gas cell keep what the pressure system is told about the face: p0 and u0; and in `fill` what an outlet with a far pressure knows of itself.
fn note_open_face(c: vec3i, slot: u32) {
    let near = nearest_inside(c);
    let away = c - near;
    if dot(away, away) != 1 { return; }
    if kind_of(cells[slot_of(near)]) != GAS {
        fill[slot] = vec2f(0.0);
        return;
    }
    let n = u32(away.y != 0) + 2u * u32(away.z != 0);
    let outward = f32(away[n]);
    let opening = opening_of(cells[slot]);
    let flow = conserved[slot_of(near)];
    let species = species_now(slot_of(near));
    var p = 1.0 / (gamma_of(species.y) * fill[slot_of(near)].y);   // its energy waits for what the solve carries [shared/state.wgsl]
    if PRODUCTS { p = energy[part(PREDICTED_PRESSURE, slot_of(near))]; }
    var here = Gas(flow, p / grueneisen_of(species.y) + kinetic_energy(flow), species, unburned_at(slot_of(near)));
    here.energy += reference_energy(here);
    let gamma = stiffness_ratio(here, p);
    let last = fill[slot];
    var known = vec2f(here.flow[n + 1u] / here.flow.x, p);
    if last.y > 0.0 {
        known.y = open_part_pressure(near, n, away[n] > 0);
        known.x = last.x + outward * (known.y - last.y) / (here.flow.x * sound_speed(gamma, here.flow.x, p));
    }
    let face = open_face(opening, n, outward, here, known, control.dt);
    fill[slot] = vec2f(face.velocity, select(face.reference, p, face.reference < 0.0));
    energy[part(OPEN_PRESSURE, slot)] = face.reference;
    energy[part(OPEN_VELOCITY, slot)] = face.velocity;
}

// While `pressure` still holds what the last solve left.
@compute @workgroup_size(WORKGROUP)
fn open_faces(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = swept_slot(thread_index(group, lane));
    if slot < params.slots && kind_of(cells[slot]) == GHOST { note_open_face(cell_of(slot), slot); }
}

// Whether a vertex lies on a side of the domain.
fn on_side(v: vec3i) -> bool { return any(((v == vec3i(0)) | (v == vec3i(params.cells))) & (reach() == vec3i(1))); }

// From the middle of a face with normal n to one of its vertices, in cells.
fn along_face(corner: vec3i, n: u32) -> vec3f {
    return (vec3f(corner) - 0.5) * vec3f((reach() == vec3i(1)) & (axis(n) == vec3i(0)));
}

@compute @workgroup_size(WORKGROUP)
fn solve_open(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = swept_slot(thread_index(group, lane));
    if slot >= params.slots { return; }
    let v = cell_of(slot);
    var flow = 0.0;
    var admittance = 0.0;
    let count = select(0u, corner_count(), has(cells[slot], VERTEX_GAS) && on_side(v));
    for (var k = 0u; k < count; k++) {
        let corner = corner_offset(k);
        let e = v - corner;
        if !inside(e) { continue; }
        let here = slot_of(e);
        if kind_of(cells[here]) != GAS { continue; }
        for (var n = 0u; n < DIM; n++) {
            let up = corner[n] == 1;
            let beyond = slot_of(select(e - axis(n), e + axis(n), up));
            if kind_of(cells[beyond]) != GHOST { continue; }
            let face = OpenFace(energy[part(OPEN_VELOCITY, beyond)], energy[part(OPEN_PRESSURE, beyond)]);
            let predicted = energy[part(PREDICTED_PRESSURE, here)];
            let y = admittance_of(opening_of(cells[beyond]), face, gamma_at(here, predicted), conserved[here].x, predicted);
            let share = aperture(here, n, up) * face_shape(here, n, up, corner);
            // the reference is that of the middle of the face
            let weight = conserved[here].x * params.spacing * dot(params.gravity, along_face(corner, n));
            flow += rounded(share * (select(-1.0, 1.0, up) * face.velocity + y * (pressure[slot] - (face.reference + weight))));
            admittance += share * y;
        }
    }
    residual[slot] = flow;
    stiffness[slot] += control.dt * face_area() * admittance;
}
