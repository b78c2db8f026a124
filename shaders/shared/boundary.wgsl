// The gas beyond open sides. Each GHOST slot of the ring names its rule in the word of the slot; walls have no rule.
// Two things follow from a rule: the state beyond, which advection reads, and the velocity of the face as the pressure system
// sees it, u = u0 + (p - p0) / Z along the outward normal. Z = rho c lets sound pass: what a wave would do beyond the side,
// the face does [Poinsot and Lele 1992]. Where Z is infinite, the velocity is prescribed. 1 / Z adds to the diagonal, so
// that the system stays symmetric positive definite.
// RULES_USED names the rules of the scene, so that the others cost nothing.
#include "shared/opening.wgsl"

@group(0) @binding(14) var<uniform> openings: array<Opening, MAX_OPENINGS>;

// Least inflow speed over that of sound for which the impedance of a reservoir is taken: at rest it vanishes.
const LEAST_INFLOW = 0.1;

fn opening_of(word: u32) -> Opening { return openings[word >> RULE_SHIFT]; }

fn any_used(first: u32, last: u32) -> bool { return (RULES_USED & ((2u << last) - (1u << first))) != 0u; }
fn follows(o: Opening, rule: u32) -> bool { return any_used(rule, rule) && o.rule == rule; }
// Whether the velocity beyond is that of the opening.
fn prescribes(o: Opening) -> bool { return any_used(RULE_FIXED, RULE_SUBSONIC) && o.rule <= RULE_SUBSONIC; }

// Pressure of gas that has left a reservoir without losses, at a speed. [Liepmann and Roshko 1957, section 2.10]
fn reservoir_pressure(o: Opening, speed: f32) -> f32 {
    let square = params.gamma * o.pressure / o.flow.x;
    let ratio = 1.0 - 0.5 * (params.gamma - 1.0) * speed * speed / square;
    return o.pressure * pow(max(ratio, 0.0), params.gamma / (params.gamma - 1.0));
}

// Speed into the domain; that of sound at most, which no reservoir exceeds.
fn inflow_speed(o: Opening, outward_velocity: f32) -> f32 {
    let critical = sqrt(2.0 / (params.gamma + 1.0) * params.gamma * o.pressure / o.flow.x);
    return clamp(-outward_velocity, 0.0, critical);
}

// Least speed of sound behind a wave into the far gas, over that of the far gas.
const LEAST_SOUND = 0.1;

// The far gas as it is where gas of this entropy has its pressure: what leaves pushes gas of its own entropy before it.
fn far_density(o: Opening, density: f32, pressure: f32) -> f32 {
    return density * pow(o.pressure / pressure, 1.0 / params.gamma);
}

// Speed of sound over that at the far pressure where a simple wave that runs outward has brought gas of a density there to velocity u:
// u_in + 2 c / (gamma - 1) stays. [Liepmann and Roshko 1957, section 3.9]
fn sound_from_afar(o: Opening, n: u32, outward: f32, density: f32, u: f32) -> f32 {
    let gain = outward * (u - o.flow[n + 1u] / o.flow.x) / sound_speed(density, o.pressure);
    return max(1.0 + 0.5 * (params.gamma - 1.0) * gain, LEAST_SOUND);
}

fn pressure_from_afar(o: Opening, sound: f32) -> f32 { return o.pressure * pow(sound, 2.0 * params.gamma / (params.gamma - 1.0)); }

// What comes in from afar below the speed of sound brings its entropy and its velocity along the face, passes the face as fast as the
// gas there, and has the pressure that this takes. With the far velocity, advection would not let in what the pressure system
// moves; with the pressure of the cell, cells along the side would take turns in pressure, which no vertex sees.
fn gas_from_afar(o: Opening, n: u32, outward: f32, here: Gas) -> Gas {
    let u = here.flow[n + 1u] / here.flow.x;
    if outward * u >= 0.0 { return here; }
    if outward * u <= -sound_speed(here.flow.x, pressure_of(here)) { return Gas(o.flow, o.energy); }
    let p = pressure_of(here);
    let sound = sound_from_afar(o, n, outward, far_density(o, here.flow.x, p), u);
    let velocity = select(velocity_of(o.flow), vec3f(u), along(n));
    let p_beyond = pressure_from_afar(o, sound);
    return gas_from_primitive(o.flow.x * pow(p_beyond / o.pressure, 1.0 / params.gamma), velocity, p_beyond);
}

// State beyond a face next to `here`, across axis n, outward = -1 or 1.
fn gas_beyond(o: Opening, n: u32, outward: f32, here: Gas) -> Gas {
    if follows(o, RULE_FIXED) { return Gas(o.flow, o.energy); }
    if follows(o, RULE_SUBSONIC) { return Gas(o.flow, internal_energy(here) + kinetic_energy(o.flow)); }
    if follows(o, RULE_TOTAL) {
        let speed = inflow_speed(o, outward * here.flow[n + 1u] / here.flow.x);
        let pressure = reservoir_pressure(o, speed);
        let u = select(vec3f(0.0), vec3f(-outward * speed), along(n));
        return gas_from_primitive(o.flow.x * pow(pressure / o.pressure, 1.0 / params.gamma), u, pressure);
    }
    if follows(o, RULE_ATTENUATED) { return Gas(mix(here.flow, o.flow, o.share), mix(here.energy, o.energy, o.share)); }
    if follows(o, RULE_FAR) { return gas_from_afar(o, n, outward, here); }
    return here;
}

// Velocity that the node beyond an open face has.
fn velocity_beyond(o: Opening, here: vec4f) -> vec3f {
    if prescribes(o) { return velocity_of(o.flow); }
    if follows(o, RULE_ATTENUATED) { return velocity_of(mix(here, o.flow, o.share)); }
    return velocity_of(here);
}

// A face as the pressure system sees it.
struct OpenFace {
    velocity: f32,      // u0 along +axis
    reference: f32,     // p0; below 0 where the velocity is prescribed
}

// What the pressure system is told about an open face of a cell with the advected state `here`. `known` is what an outlet with a far
// pressure knows of itself: velocity and pressure of the last step. Kept, they keep what would come in from far away as it was; the
// pressure drifts slowly towards the far one. [Thompson 1987; Poinsot and Lele 1992]
fn open_face(o: Opening, n: u32, outward: f32, here: Gas, known: vec2f, dt: f32) -> OpenFace {
    let velocity = here.flow[n + 1u] / here.flow.x;
    let pressure = pressure_of(here);
    let c = sound_speed(here.flow.x, pressure);
    let mach = outward * velocity / c;
    if prescribes(o) { return OpenFace(o.flow[n + 1u] / o.flow.x, -1.0); }
    if follows(o, RULE_TOTAL) {
        let speed = inflow_speed(o, outward * velocity);
        return OpenFace(-outward * speed, reservoir_pressure(o, speed));
    }
    if follows(o, RULE_ATTENUATED) {
        let beyond = mix(here.flow, o.flow, o.share);
        return OpenFace((here.flow[n + 1u] + beyond[n + 1u]) / (here.flow.x + beyond.x), -1.0);
    }
    if follows(o, RULE_FAR) {
        if mach >= 1.0 { return OpenFace(velocity, -1.0); }
        if mach <= -1.0 { return OpenFace(o.flow[n + 1u] / o.flow.x, -1.0); }
        // without the kick of gravity, which the pressure that it is solved for balances
        let u = velocity - dt * params.gravity[n];
        return OpenFace(u, pressure_from_afar(o, sound_from_afar(o, n, outward, far_density(o, here.flow.x, pressure), u)));
    }
    if mach >= 1.0 { return OpenFace(velocity, -1.0); }
    let drift = min(1.0, o.share * max(1.0 - mach * mach, 0.0) * c * dt);
    return OpenFace(known.x + outward * drift * (known.y - o.pressure) / (here.flow.x * c), known.y);
}

// 1 / Z of an open face, from density and predicted pressure of its cell.
fn admittance_of(o: Opening, face: OpenFace, density: f32, predicted: f32) -> f32 {
    if face.reference < 0.0 { return 0.0; }
    // That of the far gas behind the wave. Z of the cell would let out less where its pressure is too high.
    if follows(o, RULE_FAR) {
        let ratio = pow(face.reference / o.pressure, 0.5 + 0.5 / params.gamma);
        let far = far_density(o, density, predicted);
        return 1.0 / (far * sound_speed(far, o.pressure) * ratio);
    }
    let c = sound_speed(density, predicted);
    if follows(o, RULE_TOTAL) { return 1.0 / (density * max(abs(face.velocity), LEAST_INFLOW * c)); }
    return 1.0 / (density * c);
}
