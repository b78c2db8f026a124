// g2p: how do the particles move and deform?
// Reads nodes, ghost pressure changes. Writes particles and their stress. On return positions are inside the domain and det F > 0,
// or the step is flagged. [APIC: Jiang et al. 2015; F: Stomakhin et al. 2013; ghost pressure: Cao et al. 2022, eqs. 17-20]
// Two forms: g2p, one thread per particle; and g2p_cells, one thread per cell that reads its nodes once for all its particles,
// followed by g2p_particles.
#include "materials/stress.wgsl"
#include "solid/ghost_between.wgsl"
#include "shared/driven.wgsl"
#include "solid/motion.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read_write> position: array<vec4f>;
@group(0) @binding(3) var<storage, read_write> velocity: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> affine: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> deformation: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> stress: array<vec4f>;
@group(0) @binding(7) var<storage, read> node: array<vec4f>;      // velocity; w: mean driver of fracture
@group(0) @binding(8) var<storage, read> ghost: array<f32>;     // vertex change of the ghost pressure in this step
@group(0) @binding(9) var<storage, read> order: array<u32>;
@group(0) @binding(10) var<storage, read> cell_start: array<u32>;

fn grid_vector(slot: u32) -> vec3f { return node[slot].xyz; }

// Distance that a particle keeps from a wall side, in cells.
const WALL_GAP = 1e-3;

fn side_is_wall(s: u32) -> bool { return ((params.wall_sides >> s) & 1u) == 1u; }

// Walls hold particles back, open sides let them go. Returns false for one that has left.
fn keep_inside(x: ptr<function, vec3f>) -> bool {
    let low = params.origin;
    let high = params.origin + vec3f(params.cells) * params.spacing;
    let gap = WALL_GAP * params.spacing;
    for (var a = 0u; a < DIM; a++) {
        if (*x)[a] < low[a] + gap {
            if side_is_wall(2u * a) { *x = select(*x, low + gap, along(a)); atomicAdd(&control.clamped, 1u); }
            else if (*x)[a] < low[a] { return false; }
        }
        if (*x)[a] > high[a] - gap {
            if side_is_wall(2u * a + 1u) { *x = select(*x, high - gap, along(a)); atomicAdd(&control.clamped, 1u); }
            else if (*x)[a] > high[a] { return false; }
        }
    }
    return true;
}

// C = 4 / h^2 sum w v (x_node - x_p)^T. [Jiang et al. 2015]
fn affine_of(motion: Motion, at: Place) -> mat3x3f {
    return (4.0 / params.spacing) * (motion.moment - outer_product(motion.velocity, at.center));
}

fn store_deformation(p: u32, h: mat3x3f) {
    deformation[3u * p] = vec4f(h[0], deformation[3u * p].w);
    deformation[3u * p + 1u] = vec4f(h[1], deformation[3u * p + 1u].w);
    deformation[3u * p + 2u] = vec4f(h[2], deformation[3u * p + 2u].w);
}

fn put_at(p: u32, place: vec3f) {
    var x = place;
    let inside_domain = keep_inside(&x);
    if !inside_domain || any(cell_at(x) != cell_at(position[p].xyz)) { atomicStore(&control.unsorted, 1u); }
    if !inside_domain {
        atomicAdd(&control.escaped, 1u);
        deformation[3u * p + 1u].w = 0.0;
    }
    position[p] = vec4f(x, select(0.0, position[p].w, inside_domain));
}

// The ghost pressure that the solve gave. The force of the solve has all of it in each sub-step: where the elastic force bears the
// difference, so must q. Elsewhere q is picked up on the way of the particle. An implicit step has it already [elastic_ghost].
fn follow_ghost(p: u32) {
    if IMPLICIT { return; }
    let whole = bears_volume(materials[material_index(affine[3u * p + 2u].w)]);
    let share = select(1.0 / f32(control.substeps), select(0.0, 1.0, control.substep <= 1u), whole);
    affine[3u * p].w += share * ghost_between(position[p].xyz);
}

// Moves a driven particle.
fn carry(p: u32, time: f32) {
    let s = support_of(p);
    // Shares of the step at the ends of this sub-step.
    let parts = (vec2f(f32(control.substep)) - vec2f(1.0, 0.0)) / f32(control.substeps);
    let place = rigid_place(s, position[p].xyz, parts.x, parts.y, time);
    velocity[p] = vec4f(rigid_velocity(s, place, parts.y), velocity[p].w);
    put_at(p, place);
}

// Shared volume: the ghost pressure goes to what the volumetric part of the law says, as fast as an elastic wave passes this many cells.
const RELAXED_CELLS = 10.0;

fn relaxation(p: u32, q: f32, h: mat3x3f, material: MaterialParams, time: f32) -> f32 {
    var volumetric = material;
    volumetric.mu = 0.0;
    let tau = kirchhoff_stress(material.kind, h, volumetric);
    let swollen = params.ambient_pressure - (tau[0].x + tau[1].y + tau[2].z) / (3.0 * (1.0 + swelling(h)));
    let speed = wave_speed(material.kind, h, material, position[p].w / velocity[p].w);
    return (1.0 - exp(-time * speed / (RELAXED_CELLS * params.spacing))) * (swollen - q);
}

// Mean over the nodes of the driver of fracture.
fn mean_driver(x: vec3f) -> f32 {
    let cell = cell_at(x);
    let at = place_at(x, vec3f(cell) + 0.5);
    var sum = 0.0;
    for (var k = 0u; k < block_size(); k++) {
        let offset = block_offset(k);
        let n = vec3u(offset + 1);
        sum += at.weight[0][n.x] * at.weight[1][n.y] * at.weight[2][n.z] * node[slot_of(cell + offset)].w;
    }
    return sum;
}

// What has broken gives way instead of bearing tension. Returns the deformation that is left, and what friction has taken [J m^-3].
fn give_way(p: u32, h: mat3x3f, m: MaterialParams, friction: ptr<function, f32>) -> mat3x3f {
    let opened = without_tension(m, h, affine[3u * p + 1u].w, affine[3u * p].w);
    affine[3u * p].w = opened.ghost;
    affine[3u * p + 1u].w = opened.open;
    let word = bitcast<u32>(affine[3u * p + 2u].w) | select(0u, CRUMBLED, m.rubble > 0.0 && opened.open > CRUMBLES);
    affine[3u * p + 2u].w = bitcast<f32>(word);
    var left = opened.deformation;
    for (var turn = 0u; turn < when((word & CRUMBLED) != 0u); turn++) {
        let part = elastic_part(m);
        let before = elastic_energy(m.kind, left, part);
        left = slid(m, left).deformation;
        *friction += before - elastic_energy(m.kind, left, part);
    }
    return left;
}

// Stress that is left of `tau`, driver for the nodes, and energy per volume at rest that damage has taken in a sub-step.
struct Fractured { stress: mat3x3f, driver: f32, lost: f32 }

// Share of the way to melting that plastic flow has heated a particle.
fn heated_by_flow(p: u32, m: MaterialParams) -> f32 {
    if !follows_rate(m) { return 0.0; }
    return clamp(m.heating * stress[2u * p].w / position[p].w, 0.0, 1.0);
}

// `flow`: the plastic strain of this sub-step.
fn fracture(p: u32, m: MaterialParams, h: mat3x3f, tau: mat3x3f, flow: f32, time: f32) -> Fractured {
    let tension = tension_of(m, h, affine[3u * p].w, tau);
    let strength = strength_of(m, affine[3u * p + 2u].w);
    let ratio = ratio_of(m, strength);
    let voids = breaks_by_voids(m);
    let before = deformation[3u * p + 2u].w;
    var damage = before;
    if before < 1.0 {
        // A crack grows through a band no faster than Rayleigh's waves run.
        let fastest = time * sqrt(m.crack_modulus * velocity[p].w / position[p].w);
        let driven = mean_driver(position[p].xyz) / strength;
        let reached = select(damage_at(m, driven, ratio), damage_of_voids(m, driven), voids);
        damage = max(before, min(reached, before + fastest));
        deformation[3u * p + 2u].w = damage;
    }
    // From here on what counts the plastic strain counts the opening.
    if damage == 1.0 && before < 1.0 { affine[3u * p + 1u].w = 0.0; }
    let lost = (damage - before) * tension.energy;
    if voids {
        let grown = stress[2u * p + 1u].w + m.tensile_strength * flow / strain_of_voids(m, tension.stress, flow / time, heated_by_flow(p, m));
        let most = most_voids(m) * m.tensile_strength;
        return Fractured(damaged_stress(tau, tension, damage), select(min(grown, most), most, damage == 1.0), lost);
    }
    var driver = max(tension.pull.x, max(tension.pull.y, tension.pull.z)) / (1.0 + swelling(h));
    if damage == 1.0 {
        let opening = (whole_lambda(m) + 2.0 * m.mu) * affine[3u * p + 1u].w;
        driver = min(driver + opening, MOST_DRIVE * ratio * strength);
    }
    return Fractured(damaged_stress(tau, tension, damage), driver, lost);
}

// Stress of a particle from `h`, its displacement gradient before plastic flow and then after it; `stored` where it is in memory already.
// Returns false after a fault.
fn strain(p: u32, h: ptr<function, mat3x3f>, v: vec3f, stored: bool, time: f32) -> bool {
    let material = materials[material_index(affine[3u * p + 2u].w)];
    let trial = *h;
    let breaks = can_break(material) && !is_driven(p);
    let broken = breaks && deformation[3u * p + 2u].w == 1.0;
    var flowing = material;
    if follows_rate(material) { flowing = heated_metal(material, heated_by_flow(p, material), time); }
    let returned = return_map(material.kind, trial, select(affine[3u * p + 1u].w, 0.0, broken), flowing);
    *h = returned.deformation;
    // a loop: a software device would run a branch for all lanes
    var friction = 0.0;
    for (var turn = 0u; turn < when(broken); turn++) { *h = give_way(p, *h, material, &friction); }
    let volume = 1.0 + swelling(*h);
    if !(volume > 0.0) || is_broken(volume) || is_broken(v.x + v.y + v.z) {
        atomicMin(&control.fault, (STAGE_G2P << 27u) | p);
        return false;
    }
    var tau = elastic_stress(material, *h, affine[3u * p].w);
    var driver = 0.0;
    var heat = stress[2u * p].w + velocity[p].w * friction;
    if breaks {
        let fractured = fracture(p, material, *h, tau, returned.plastic_strain, time);
        tau = fractured.stress;
        driver = fractured.driver;
        heat += velocity[p].w * fractured.lost;
    }
    tau *= velocity[p].w;
    if returned.plastic_strain > 0.0 {
        if !breaks || deformation[3u * p + 2u].w < 1.0 { affine[3u * p + 1u].w += returned.plastic_strain; }
        let part = elastic_part(material);
        let lost = elastic_energy(material.kind, trial, part) - elastic_energy(material.kind, *h, part);
        // what is damaged flows under what is left of its stress
        heat += velocity[p].w * lost * select(1.0, 1.0 - deformation[3u * p + 2u].w, breaks);
    }
    if !stored || broken || returned.plastic_strain > 0.0 { store_deformation(p, *h); }
    stress[2u * p] = vec4f(tau[0].x, tau[1].y, tau[2].z, heat);
    stress[2u * p + 1u] = vec4f(tau[0].y, tau[1].z, tau[0].z, driver);
    return true;
}

// Strains and moves a particle with velocity v; `trial` and `stored` as above. Returns false after a fault.
fn advance(p: u32, v: vec3f, trial: mat3x3f, stored: bool, time: f32) -> bool {
    var h = trial;
    let x = position[p].xyz;
    follow_ghost(p);
    if strains(p) && !strain(p, &h, v, stored, time) { return false; }
    if is_driven(p) {
        carry(p, time);
        return true;
    }
    if SHARED_VOLUME {
        let material = materials[material_index(affine[3u * p + 2u].w)];
        affine[3u * p].w += relaxation(p, affine[3u * p].w, h, material, time);
    }
    put_at(p, x + time * v);
    return true;
}

fn store_motion(p: u32, motion: Motion, at: Place) {
    let c = affine_of(motion, at);
    velocity[p] = vec4f(motion.velocity, velocity[p].w);
    affine[3u * p] = vec4f(c[0], affine[3u * p].w);
    affine[3u * p + 1u] = vec4f(c[1], affine[3u * p + 1u].w);
    affine[3u * p + 2u] = vec4f(c[2], affine[3u * p + 2u].w);
}

@compute @workgroup_size(WORKGROUP)
fn g2p(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let p = thread_index(group, lane);
    if p >= params.particles || deformation[3u * p + 1u].w == 0.0 { return; }
    let time = control.dt / f32(control.substeps);
    if !strains(p) {
        follow_ghost(p);
        carry(p, time);
        return;
    }
    let x = position[p].xyz;
    let cell = cell_at(x);
    let at = place_at(x, vec3f(cell) + 0.5);
    read_rows(slot_of(cell));
    let motion = motion_at(at);
    let moved = advance(p, motion.velocity, trial_deformation(p, motion.gradient, time), false, time);
    if moved && !is_driven(p) { store_motion(p, motion, at); }
}

// Velocity, affine velocity and trial deformation of the particles of a cell.
@compute @workgroup_size(WORKGROUP)
fn g2p_cells(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let first = cell_start[slot];
    let end = cell_start[slot + 1u];
    if first == end { return; }
    let time = control.dt / f32(control.substeps);
    let middle = vec3f(cell_of(slot)) + 0.5;
    read_rows(slot);
    for (var i = first; i < end; i++) {
        let p = order[i];
        if !strains(p) { continue; }
        let at = place_at(position[p].xyz, middle);
        let motion = motion_at(at);
        if !is_driven(p) { store_motion(p, motion, at); }
        store_deformation(p, trial_deformation(p, motion.gradient, time));
    }
}

// What follows from them, particle by particle.
@compute @workgroup_size(WORKGROUP)
fn g2p_particles(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let p = thread_index(group, lane);
    if p >= params.particles || deformation[3u * p + 1u].w == 0.0 { return; }
    let time = control.dt / f32(control.substeps);
    _ = advance(p, velocity[p].xyz, deformation_of(p), true, time);
}
