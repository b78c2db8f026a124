// Faces of open sides, and the open parts of faces at obstacles, as the pressure system sees them.
// Needs the bindings cells, extra and pressure.
#include "shared/domain.wgsl"

// -- Open parts --

// What the open part of the face of a GAS cell has of the pressures at its vertices.

// Their mean, weighted by the shape functions over that part.
fn open_part_pressure(c: vec3i, n: u32, up: bool) -> f32 {
    let low = select(c, c + axis(n), up);
    var sum = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let corner = corner_offset(k);
        if corner[n] == 1 { continue; }
        let own = corner + select(vec3i(0), axis(n), up);
        sum += face_shape(slot_of(c), n, up, own) * pressure[slot_of(low + corner)];
    }
    return sum;
}

// -- Open sides --

// Least inflow speed over that of sound for which the impedance of a reservoir is taken: at rest it vanishes.
const LEAST_INFLOW = 0.1;

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
    let gamma = stiffness_ratio(here, pressure);
    let c = sound_speed(gamma, here.flow.x, pressure);
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
        return OpenFace(u, pressure_from_afar(o, gamma, sound_from_afar(o, n, outward, gamma, far_density(o, gamma, here.flow.x, pressure), u)));
    }
    if mach >= 1.0 { return OpenFace(velocity, -1.0); }
    let drift = min(1.0, o.share * max(1.0 - mach * mach, 0.0) * c * dt);
    return OpenFace(known.x + outward * drift * (known.y - o.pressure) / (here.flow.x * c), known.y);
}

// 1 / Z of an open face, from gamma, density and predicted pressure of its cell.
fn admittance_of(o: Opening, face: OpenFace, gamma: f32, density: f32, predicted: f32) -> f32 {
    if face.reference < 0.0 { return 0.0; }
    // That of the far gas behind the wave. Z of the cell would let out less where its pressure is too high.
    if follows(o, RULE_FAR) {
        let ratio = pow(face.reference / o.pressure, 0.5 + 0.5 / gamma);
        let far = far_density(o, gamma, density, predicted);
        return 1.0 / (far * sound_speed(gamma, far, o.pressure) * ratio);
    }
    let c = sound_speed(gamma, density, predicted);
    if follows(o, RULE_TOTAL) { return 1.0 / (density * max(abs(face.velocity), LEAST_INFLOW * c)); }
    return 1.0 / (density * c);
}
