// coupled_solve, preparation of the solid: gravity, and the traction of the gas film between a body and a wall.
// A body that touches a wall keeps a film of gas there: without its pressure a body on the floor would not lift. The film
// carries the pressure of the nearest gas vertex along the wall; it acts before the solve and adds no unknown.
#include "shared/index.wgsl"
#include "shared/cell.wgsl"
#include "shared/control.wgsl"
#include "shared/element.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> energy: array<f32>;    // second third: predicted pressure of gas cells
@group(0) @binding(4) var<storage, read> ghost: array<f32>;
@group(0) @binding(5) var<storage, read_write> node: array<vec4f>;

// How far along the wall the film looks for gas, in cells.
const FILM_REACH = 16;

// Mean over the gas cells around a vertex: the vertex unknown may hold some of the body's own pressure.
fn gas_pressure(v: vec3i) -> f32 {
    var sum = 0.0;
    var count = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let c = v - corner_offset(k);
        if !inside(c) || kind_of(cells[slot_of(c)]) != GAS { continue; }
        sum += energy[params.slots + slot_of(c)];
        count += 1.0;
    }
    return sum / max(count, 1.0);
}

fn film_pressure(v: vec3i, n: u32) -> f32 {
    let slot = slot_of(v);
    if !FILM_NEAREST { return ghost[slot]; }
    if has(cells[slot], VERTEX_GAS) { return gas_pressure(v); }
    for (var far = 1; far <= FILM_REACH; far++) {
        var sum = 0.0;
        var count = 0.0;
        for (var a = 0u; a < DIM; a++) {
            if a == n { continue; }
            for (var side = -1; side <= 1; side += 2) {
                let near = v + side * far * axis(a);
                if !is_vertex(near) || !has(cells[slot_of(near)], VERTEX_GAS) { continue; }
                sum += gas_pressure(near);
                count += 1.0;
            }
        }
        if count > 0.0 { return sum / count; }
    }
    return ghost[slot];
}

// `count`: block_size(), or 0 away from walls.
fn film_force(c: vec3i, count: u32) -> vec3f {
    var force = vec3f(0.0);
    for (var k = 0u; k < count; k++) {
        let offset = block_offset(k);
        let e = c + offset;
        if !inside(e) || kind_of(cells[slot_of(e)]) != SOLID { continue; }
        for (var n = 0u; n < DIM; n++) {
            for (var side = 0u; side < 2u; side++) {
                let up = side == 1u;
                let beyond = kind_of(cells[slot_of(select(e - axis(n), e + axis(n), up))]);
                if (beyond != WALL && beyond != GHOST) || !face_holds(-offset, n, up) { continue; }
                for (var j = 0u; j < corner_count(); j++) {
                    let corner = corner_offset(j);
                    if (corner[n] == 1) != up { continue; }
                    force[n] += select(-1.0, 1.0, up) * film_pressure(e + corner, n) * face_entry(true, n, -offset, corner);
                }
            }
        }
    }
    return force * face_area();
}

@compute @workgroup_size(WORKGROUP)
fn solid_predictor(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                   @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, groups, lane);
    if slot >= params.slots || node[slot].w <= 0.0 { return; }
    var v = node[slot].xyz + control.dt * params.gravity;
    let count = select(0u, block_size(), has(cells[slot], NODE_FILM));
    v -= control.dt * film_force(cell_of(slot), count) / max(node[slot].w, params.mass_floor);
    node[slot] = vec4f(v, node[slot].w);
}
