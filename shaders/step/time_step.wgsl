// time_step: how far may the next step go?
// Reads gas, particles. Writes control.dt and the partial maxima. On return dt satisfies every bound and stays on the device.
// rate = max over cells of sum over axes of (a + sqrt(a^2 + 4 b)) / 2, a = |u| / dx, b = |dp| / (dx^2 rho)
// [Kwatra et al. 2009, eq. 20]; also dt <= cfl dx / |v_particle|, dt <= max_courant dx / c and dt <= max_growth times the step before.
#include "shared/domain.wgsl"
#include "shared/gas_at.wgsl"
#include "shared/reduce.wgsl"
#include "shared/extents.wgsl"
#include "materials/stress.wgsl"

@group(0) @binding(1) var<storage, read_write> control: Control;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(4) var<storage, read> energy: array<f32>;
@group(0) @binding(5) var<storage, read> velocity: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> maxima: array<vec4f>; // rate, sound speed, particle speed, elastic wave speed
@group(0) @binding(7) var<storage, read> extra: array<u32>;
@group(0) @binding(8) var<storage, read> position: array<vec4f>;
@group(0) @binding(10) var<storage, read> affine: array<vec4f>;
@group(0) @binding(11) var<storage, read> deformation: array<vec4f>;

// Pressure differences below this share of p are noise of the solve, not a force.
const PRESSURE_NOISE = 1e-6;

// Pressure difference to a neighbour as an acceleration over the cell edge.
fn push_of(gas: Gas, p: f32, neighbour: Gas) -> f32 {
    let difference = abs(pressure_of(neighbour) - p);
    if difference <= PRESSURE_NOISE * p { return 0.0; }
    return difference / (params.spacing * params.spacing * min(gas.flow.x, neighbour.flow.x));
}

fn rate_along(speed: f32, push: f32) -> f32 { return 0.5 * (speed + sqrt(speed * speed + 4.0 * push)); }

fn interior_rate(slot: u32, gas: Gas, p: f32) -> f32 {
    var rate = 0.0;
    for (var a = 0u; a < DIM; a++) {
        let push = max(push_of(gas, p, gas_at(slot - step_of(a))), push_of(gas, p, gas_at(slot + step_of(a))));
        rate += rate_along(abs(gas.flow[a + 1u] / gas.flow.x) / params.spacing, push);
    }
    return rate;
}

fn listed_rate(c: vec3i, gas: Gas, p: f32) -> f32 {
    var rate = 0.0;
    for (var a = 0u; a < DIM; a++) {
        var speed = abs(gas.flow[a + 1u] / gas.flow.x) / params.spacing;
        var push = 0.0;
        for (var side = 0u; side < 2u; side++) {
            let other = slot_of(select(c - axis(a), c + axis(a), side == 1u));
            let kind = kind_of(cells[other]);
            if kind != GAS && kind != GHOST { continue; }
            var neighbour = gas_at(other);
            if kind == GHOST {
                // What flows in may be faster than all that is inside.
                neighbour = gas_beyond(opening_of(cells[other]), a, select(-1.0, 1.0, side == 1u), gas);
                speed = max(speed, abs(neighbour.flow[a + 1u] / neighbour.flow.x) / params.spacing);
            }
            push = max(push, push_of(gas, p, neighbour));
        }
        rate += rate_along(speed, push);
    }
    return rate;
}

// Share of an explosive that burns in a step, at most.
const MOST_BURNED = 0.16;

// A step ends where a cell begins to burn, or burns a part of it. As a rate, which the Courant number is over.
fn burn_rate_at(slot: u32) -> f32 {
    return params.cfl / max(energy[part(BURN_TIME, slot)] - control.time, MOST_BURNED / params.burn_rate);
}

// Rate and speed of sound.
fn bound_at(slot: u32) -> vec2f {
    let gas = gas_at(slot);
    let p = pressure_of(gas);
    var rate: f32;
    if is_listed() { rate = listed_rate(cell_of(slot), gas, p); } else { rate = interior_rate(slot, gas, p); }
    if PRODUCTS && gas.unburned > 1.0001 * params.fuel * max(gas.species.x, 0.0) { rate = max(rate, burn_rate_at(slot)); }
    return vec2f(rate, sound_speed(stiffness_ratio(gas, p), gas.flow.x, p));
}

@compute @workgroup_size(WORKGROUP)
fn time_step_gas(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    var bound = vec2f(0.0);
    let thread = thread_index(group, lane);
    for (var k = thread; k < params.slots; k += striding_threads()) {
        let slot = interior_slot(k);
        if slot < params.slots { bound = max(bound, bound_at(slot)); }
    }
    on_list = true;
    for (var k = thread; k < listed(); k += striding_threads()) {
        let slot = listed_slot(k);
        if kind_of(cells[slot]) == GAS && inside(cell_of(slot)) { bound = max(bound, bound_at(slot)); }
    }
    let largest = workgroup_max4(lane, vec4f(bound, 0.0, 0.0));
    if lane == 0u { maxima[group_index(group)] = largest; }
}

// What limits the elastic sub-steps at a particle, as a speed: the wave in the deformed body, and the velocity gradient, since a
// sub-step that strains by more than the share elastic_cfl may turn the particle inside out. An implicit step knows no wave but
// those that single precision cannot tell from rounding.
fn elastic_speed(p: u32) -> f32 {
    let material = materials[material_index(affine[3u * p + 2u].w)];
    let h = mat3x3f(deformation[3u * p].xyz, deformation[3u * p + 1u].xyz, deformation[3u * p + 2u].xyz);
    let wave = body_wave_speed(material, h, affine[3u * p].w, position[p].w / velocity[p].w);
    let c = mat3x3f(affine[3u * p].xyz, affine[3u * p + 1u].xyz, affine[3u * p + 2u].xyz);
    let gradient = sqrt(dot(c[0], c[0]) + dot(c[1], c[1]) + dot(c[2], c[2]));
    return max(select(wave, wave * params.elastic_cfl / IMPLICIT_COURANT, IMPLICIT), gradient * params.spacing);
}

@compute @workgroup_size(WORKGROUP)
fn time_step_particles(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let total = striding_threads();
    var speed = vec2f(0.0); // of particles; of elastic waves, or what strains as fast
    for (var p = thread_index(group, lane); p < params.particles; p += total) {
        let state = deformation[3u * p + 1u].w;
        if state == 0.0 { continue; }
        // A driven particle carries no wave.
        var fastest = 0.0;
        if state != 2.0 { fastest = elastic_speed(p); }
        speed = max(speed, vec2f(length(velocity[p].xyz), fastest));
    }
    let largest = workgroup_max4(lane, vec4f(0.0, 0.0, speed));
    if lane == 0u {
        let at = group_index(group);
        maxima[at] = max(maxima[at], largest);
    }
}

// One workgroup: the maxima of all groups, then dt.
@compute @workgroup_size(WORKGROUP)
fn time_step_choose(@builtin(local_invocation_index) lane: u32) {
    var bound = vec4f(0.0);
    for (var k = lane; k < params.groups; k += WORKGROUP) { bound = max(bound, maxima[k]); }
    let largest = workgroup_max4(lane, bound);
    if lane != 0u { return; }
    let sound = max(largest.y, control.sound); // with that of gas which a body has covered since
    let start = control.phase == PHASE_IDLE && control.remaining > 0.0 && atomicLoad(&control.fault) == NO_FAULT;
    open_with_scan(PHASE_BEGIN_EXTENTS, start);
    let moved = control.phase == PHASE_SUBSTEP && control.substep > 0u; // a long step goes on
    open_sort((start || moved) && atomicLoad(&control.fault) == NO_FAULT);
    if !start { return; }
    var dt = params.fixed_step;
    if dt == 0.0 {
        dt = params.max_courant * params.spacing / max(sound, 1e-30);
        dt = min(dt, params.cfl / max(largest.x, 1e-30));
        // growth counts from the step as taken: steps that alternate between short and long blow up
        if control.duration > 0.0 { dt = min(dt, params.max_growth * control.duration); }
    }
    let elastic_step = params.elastic_cfl * params.spacing / max(largest.w, 1e-30);
    if SOLIDS {
        dt = min(dt, params.cfl * params.spacing / max(largest.z, 1e-30));
        dt = min(dt, elastic_step * select(f32(params.max_substeps), 1.0, IMPLICIT));
    }
    // Reach the asked time exactly, without a tiny last step.
    if dt >= control.remaining * (1.0 - 1e-5) { dt = control.remaining; }
    else if dt > 0.5 * control.remaining { dt = 0.5 * control.remaining; }
    control.dt_previous = control.duration;
    control.duration = dt;
    control.dt = select(dt, ARS_SHARE * dt, ARS);
    control.stage = 0u;
    control.substeps = 0u;
    if SOLIDS { control.substeps = select(u32(ceil(max(1.0, dt / elastic_step - 1e-4))), 1u, IMPLICIT); }
    control.rounds = 0u;
    control.elastic_iterations = 0u;
    control.longest_round = 0u;
    control.substep = 0u;
    for (var k = 0u; k < 4u; k++) { atomicStore(&control.limited[k], 0u); }
    atomicStore(&control.cold, 0u);
    atomicStore(&control.surface_bound, 0u);
    control.limited_before = 0u;
    atomicStore(&control.floored, 0u);
    atomicStore(&control.raised, 0u);
    atomicStore(&control.dense, 0u);
    atomicStore(&control.clamped, 0u);
    control.extra = 0u;
    control.phase = PHASE_SOLVE;
}
