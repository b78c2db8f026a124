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
        let ex = narrow_pair(0u, v.x, v.x - j.x);
        let ey = narrow_pair(1u, v.y, v.y - j.y);
        let ez = narrow_pair(2u, v.z, v.z - j.z);
        return vec3f(ex.y * ey.x * ez.x, ex.x * ey.y * ez.x, ex.x * ey.x * ez.y);
    }
    if !inside(j) || kind_of(word) != GAS { return vec3f(0.0); }
    return cut_slope(slot, v - j);
}
