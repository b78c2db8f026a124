// coupled_solve, preparation: open faces. b of a vertex in units of face_area(), with X* in it: what flows out through the open
// faces that it belongs to; and their admittance, which resists the increment like a stiffness.
#include "shared/index.wgsl"
#include "shared/listed.wgsl"
#include "shared/cell.wgsl"
#include "shared/gas.wgsl"
#include "shared/boundary.wgsl"
#include "shared/control.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> extra: array<u32>;
@group(0) @binding(4) var<storage, read> energy: array<f32>;    // second third: predicted pressure, of GHOST slots p0; last third: u0
@group(0) @binding(8) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(5) var<storage, read> pressure: array<f32>;
@group(0) @binding(6) var<storage, read_write> stiffness: array<f32>;
@group(0) @binding(7) var<storage, read_write> residual: array<f32>;

@compute @workgroup_size(WORKGROUP)
fn solve_open(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
              @builtin(local_invocation_index) lane: u32) {
    let slot = listed_slot(thread_index(group, groups, lane));
    if slot >= params.slots { return; }
    let v = cell_of(slot);
    var flow = 0.0;
    var admittance = 0.0;
    for (var k = 0u; k < corner_count() && has(cells[slot], VERTEX_GAS); k++) {
        let corner = corner_offset(k);
        let e = v - corner;
        if !inside(e) { continue; }
        let here = slot_of(e);
        if kind_of(cells[here]) != GAS { continue; }
        for (var n = 0u; n < DIM; n++) {
            let up = corner[n] == 1;
            let beyond = slot_of(select(e - axis(n), e + axis(n), up));
            if kind_of(cells[beyond]) != GHOST { continue; }
            let face = OpenFace(energy[2u * params.slots + beyond], energy[params.slots + beyond]);
            let y = admittance_of(opening_of(cells[beyond]), face, conserved[here].x, energy[params.slots + here]);
            flow += select(-1.0, 1.0, up) * face.velocity + y * (pressure[slot] - face.reference);
            admittance += y;
        }
    }
    let share = 1.0 / f32(1u << (DIM - 1u));
    residual[slot] = share * flow;
    stiffness[slot] += share * control.dt * face_area() * admittance;
}
