// Positivity limiter: every cell names the largest share of the high-order part that its faces may carry, and a face carries the least of
// its two cells. So a cell must stand every mix of shares below its own. Density and internal energy are concave functions of the state,
// which makes the worst mix a sum over the faces. [Zhang & Shu 2010; Hu, Adams & Shu 2013; Kuzmin 2020]
// Needs ARS and STAGE.

// A cell must keep this share of what the first-order update leaves of density and internal energy.
const KEPT = 0.1;

// dt L(U) of both orders, and the worst that the high-order parts of the faces can do to a GAS cell: density and internal energy that
// they take, and momentum that they bring, relative to `velocity`. heat: see Fluxes.
struct Change { high: Gas, low: Gas, velocity: vec3f, lost_density: f32, lost_energy: f32, slip: vec3f, heat: f32 }

fn add_excess(change: ptr<function, Change>, flow: vec4f, energy: f32) {
    let velocity = (*change).velocity;
    let slip = flow.yzw - flow.x * velocity;
    (*change).lost_density += max(-flow.x, 0.0);
    (*change).lost_energy += max(0.5 * dot(velocity, flow.yzw + slip) - energy, 0.0);
    (*change).slip += abs(slip);
}

// Adds what passes along another axis.
fn plus(a: Change, b: Change) -> Change {
    let high = rounded4(b.high.flow);
    let rest = rounded4(vec4f(b.high.energy, b.heat, b.lost_density, b.lost_energy));
    let low = rounded4(b.low.flow);
    let slip = rounded4(vec4f(b.slip, b.low.energy));
    return Change(Gas(a.high.flow + high, a.high.energy + rest.x), Gas(a.low.flow + low, a.low.energy + slip.w), a.velocity,
        a.lost_density + rest.z, a.lost_energy + rest.w, a.slip + slip.xyz, a.heat + rest.y);
}

fn scaled(c: Change, share: f32) -> Change {
    return Change(Gas(share * c.high.flow, share * c.high.energy), Gas(share * c.low.flow, share * c.low.energy), c.velocity,
        share * c.lost_density, share * c.lost_energy, share * c.slip, share * c.heat);
}

fn drained_share(before: Gas, change: Change) -> f32 {
    let least = KEPT * internal_energy(before);
    var share = 0.5;
    for (var k = 0; k < 12; k++) {
        let flow = before.flow + share * change.low.flow;
        let total = before.energy + share * change.low.energy;
        if flow.x > KEPT * before.flow.x && internal_energy(Gas(flow, total)) > least { return share - 1.0; }
        share *= 0.5;
    }
    return -1.0;
}

// Largest share of the high-order change that keeps density and internal energy above KEPT of the first-order update.
// Where bodies recede on several sides even that would drain the cell: then -1 + the share of the first-order change that
// leaves KEPT of what is there.
fn allowed_share(before: Gas, change: Change) -> f32 {
    let low = Gas(before.flow + change.low.flow, before.energy + change.low.energy);
    if !(low.flow.x > KEPT * before.flow.x) || !(internal_energy(low) > 0.0) {
        if ARS && STAGE > 0u { return 0.0; }    // `before` is no state of the gas here, its own change is behind it
        return drained_share(before, change);
    }
    let slip = low.flow.yzw - low.flow.x * change.velocity;
    // rho e = E - v m + rho v^2 / 2 - |m - rho v|^2 / (2 rho) for every v; with v fixed only the last part is not linear.
    let least = KEPT * internal_energy(low);
    let heat = internal_energy(low) + 0.5 * dot(slip, slip) / low.flow.x;
    var share = min(1.0, (1.0 - KEPT) * low.flow.x / max(change.lost_density, 1e-30));
    for (var k = 0; k < 12; k++) {
        let slips = abs(slip) + share * change.slip;
        let density = low.flow.x - share * change.lost_density;
        if heat - share * change.lost_energy - 0.5 * dot(slips, slips) / density >= least { return share; }
        share *= 0.5;
    }
    return 0.0;
}
