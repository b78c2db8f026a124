// supports: what is held?
// Reads sorted particles. Writes the velocity of driven nodes, takes the driven mass from the others, and marks both in `cells`:
// NODE_DRIVEN, and in the word of a WALL slot the friction of what touches it. Driven nodes keep their velocity through the step:
// the pressure solve sees them without bound of mass.
#include "shared/index.wgsl"
#include "solid/place.wgsl"
#include "shared/driven.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read_write> cells: array<u32>;
@group(0) @binding(3) var<storage, read> position: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> velocity: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> affine: array<vec4f>;
@group(0) @binding(6) var<storage, read> deformation: array<vec4f>;
@group(0) @binding(7) var<storage, read> order: array<u32>;
@group(0) @binding(8) var<storage, read> cell_start: array<u32>;
@group(0) @binding(9) var<storage, read_write> node: array<vec4f>;

@compute @workgroup_size(WORKGROUP)
fn supports_particles(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let p = thread_index(group, lane);
    if p >= params.particles || !is_driven(p) { return; }
    let s = support_of(p);
    let c = turning(s.spin);
    velocity[p] = vec4f(rigid_velocity(s, position[p].xyz, 0.0), velocity[p].w);
    for (var a = 0u; a < 3u; a++) { affine[3u * p + a] = vec4f(c[a], affine[3u * p + a].w); }
}

// What the particles around a node give to it, by volume: all of them, the driven ones, friction. And the driven momentum and mass.
struct Held { volume: f32, driven: f32, friction: f32, momentum: vec4f }

fn add_particle(held: ptr<function, Held>, p: u32, middle: vec3f, offset: vec3i) {
    let x = position[p];
    let at = place_at(x.xyz, middle);
    var w = 1.0;
    for (var a = 0u; a < DIM; a++) { w *= at.weight[a][offset[a] + 1]; }
    let volume = w * velocity[p].w;
    (*held).volume += volume;
    (*held).friction += volume * support_of(p).friction;
    if !is_driven(p) { return; }
    (*held).driven += volume;
    let arm = (middle + vec3f(offset)) * params.spacing + params.origin - x.xyz;
    let c = mat3x3f(affine[3u * p].xyz, affine[3u * p + 1u].xyz, affine[3u * p + 2u].xyz);
    (*held).momentum += w * x.w * vec4f(velocity[p].xyz + c * (arm * vec3f(reach())), 1.0);
}

fn held_at(c: vec3i) -> Held {
    var held: Held;
    for (var k = 0u; k < block_size(); k++) {
        let near = c + block_offset(k);
        if !inside(near) { continue; }
        let slot = slot_of(near);
        let end = cell_start[slot + 1u];
        for (var i = cell_start[slot]; i < end; i++) { add_particle(&held, order[i], vec3f(near) + 0.5, -block_offset(k)); }
    }
    return held;
}

@compute @workgroup_size(WORKGROUP)
fn supports_nodes(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    var word = cells[slot] & ~NODE_DRIVEN;
    let here = node[slot];
    if here.w > 0.0 {
        let held = held_at(cell_of(slot));
        if FRICTION && kind_of(word) == WALL { word = word_with_friction(word, held.friction / held.volume); }
        if DRIVEN && held.driven > 0.0 {
            // The driven part is where it fills half of what the node sees.
            if held.driven >= 0.5 * held.volume {
                word |= NODE_DRIVEN;
                node[slot] = vec4f(held.momentum.xyz / held.momentum.w, here.w);
            } else {
                let mass = here.w - held.momentum.w;
                node[slot] = vec4f((here.w * here.xyz - held.momentum.xyz) / mass, mass);
            }
        }
    }
    cells[slot] = word;
}
