// The pressure system at obstacles: the velocity is constant in the gas of a cell, so a cell feels the integral of the pressure
// gradient over its gas, and no pressure acts through the surface. A cluster moves as one.
// Needs the bindings cells and extra.
#include "shared/cut.wgsl"

// Whether a GAS cell has obstacles around it; the node at its centre then sees its own cell alone.
fn beside_obstacle(word: u32) -> bool { return CUT && !has(word, NODE_REGULAR); }

// Coefficient of a vertex on a node next to it, in units of face_area().
fn coefficient(j: vec3i, v: vec3i) -> vec3f {
    let slot = slot_of(j);
    let word = cells[slot];
    if has(word, NODE_REGULAR) {
        let ex = axis_entry(0u, j.x, v.x);
        let ey = axis_entry(1u, j.y, v.y);
        let ez = axis_entry(2u, j.z, v.z);
        return vec3f(ex.x * ey.y * ez.y, ex.y * ey.x * ez.y, ex.y * ey.y * ez.x);
    }
    if !inside(j) || kind_of(word) != GAS { return vec3f(0.0); }
    return cut_slope(slot, v - j);
}
