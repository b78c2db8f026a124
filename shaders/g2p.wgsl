// g2p: how do the particles move and deform?
// Reads nodes, ghost pressure changes. Writes particles and their stress. On return positions are inside the domain and det F > 0,
// or the step is flagged. [APIC: Jiang et al. 2015; F: Stomakhin et al. 2013; ghost pressure: Cao et al. 2022, eqs. 17-20]
#include "shared/index.wgsl"
#include "shared/control.wgsl"
#include "shared/bspline.wgsl"
#include "shared/matrix.wgsl"
#include "shared/material.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read_write> position: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> velocity: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> affine: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> deformation: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> stress: array<vec4f>;
@group(0) @binding(7) var<storage, read> node: array<vec4f>;
@group(0) @binding(8) var<storage, read> ghost: array<f32>;     // vertex change of the ghost pressure in this step

// Distance that a particle keeps from a wall side, in cells.
const WALL_GAP = 1e-3;

fn side_is_wall(s: u32) -> bool { return ((params.wall_sides >> s) & 1u) == 1u; }

fn ghost_change(x: vec3f) -> f32 {
    let place = (x - params.origin) / params.spacing;
    let base = nearest_inside(vec3i(floor(place)));
    let f = place - vec3f(base);
    var change = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let corner = corner_offset(k);
        var w = 1.0;
        for (var a = 0u; a < DIM; a++) { w *= select(1.0 - f[a], f[a], corner[a] == 1); }
        change += w * ghost[slot_of(base + corner)];
    }
    return change;
}

// Walls hold particles back, open sides let them go. Returns false for one that has left.
fn keep_inside(x: ptr<function, vec3f>) -> bool {
    let low = params.origin;
    let high = params.origin + vec3f(params.cells) * params.spacing;
    let gap = WALL_GAP * params.spacing;
    for (var a = 0u; a < DIM; a++) {
        if (*x)[a] < low[a] + gap {
            if side_is_wall(2u * a) { (*x)[a] = low[a] + gap; atomicAdd(&control.clamped, 1u); }
            else if (*x)[a] < low[a] { return false; }
        }
        if (*x)[a] > high[a] - gap {
            if side_is_wall(2u * a + 1u) { (*x)[a] = high[a] - gap; atomicAdd(&control.clamped, 1u); }
            else if (*x)[a] > high[a] { return false; }
        }
    }
    return true;
}

@compute @workgroup_size(WORKGROUP)
fn g2p(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
       @builtin(local_invocation_index) lane: u32) {
    let p = thread_index(group, groups, lane);
    if p >= params.particles || deformation[3u * p + 1u].w == 0.0 { return; }
    let time = control.dt / f32(control.substeps);
    var x = position[p].xyz;
    let s = spline_at(x);
    var v = vec3f(0.0);
    var c = mat3x3f();
    var gradient = mat3x3f();
    for (var k = 0u; k < block_size(); k++) {
        let offset = block_offset(k);
        let weight = spline_node(s, offset);
        let v_node = node[slot_of(s.base + offset)].xyz;
        let away = node_distance(s, offset, x);
        v += weight.w * v_node;
        c += outer_product(weight.w * v_node, away);
        gradient += outer_product(v_node, weight.xyz);
    }
    c = c * (4.0 / (params.spacing * params.spacing));
    let kind = bitcast<u32>(affine[3u * p + 2u].w);
    let material = materials[kind];
    var f = mat3x3f(deformation[3u * p].xyz, deformation[3u * p + 1u].xyz, deformation[3u * p + 2u].xyz);
    f = f + time * gradient * f;
    let returned = return_map(material.kind, f, material);
    f = returned.deformation;
    let volume = determinant(f);
    if !(volume > 0.0) || is_broken(volume) || is_broken(v.x + v.y + v.z) {
        atomicMin(&control.fault, (STAGE_G2P << 27u) | p);
        return;
    }
    let q = affine[3u * p].w + ghost_change(x) / f32(control.substeps);
    let plastic = affine[3u * p + 1u].w + returned.plastic_strain;
    x += time * v;
    let inside_domain = keep_inside(&x);
    if !inside_domain { atomicAdd(&control.escaped, 1u); }
    let tau = kirchhoff_stress(material.kind, f, material) * velocity[p].w;
    position[p] = vec4f(x, select(0.0, position[p].w, inside_domain));
    velocity[p] = vec4f(v, velocity[p].w);
    affine[3u * p] = vec4f(c[0], q);
    affine[3u * p + 1u] = vec4f(c[1], plastic);
    affine[3u * p + 2u] = vec4f(c[2], bitcast<f32>(kind));
    deformation[3u * p] = vec4f(f[0], deformation[3u * p].w);
    deformation[3u * p + 1u] = vec4f(f[1], f32(inside_domain));
    deformation[3u * p + 2u] = vec4f(f[2], 0.0);
    stress[2u * p] = vec4f(tau[0].x, tau[1].y, tau[2].z, 0.0);
    stress[2u * p + 1u] = vec4f(tau[0].y, tau[1].z, tau[0].z, 0.0);
}
