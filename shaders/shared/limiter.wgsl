// The flux limiter: how much of the high-order fluxes a cell allows, so that density and internal energy stay positive.

// A cell must keep this share of what the first-order update leaves of density and internal energy.
const KEPT = 0.1;

struct Change { high: Gas, low: Gas }

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
        if ARS && SECOND { return 0.0; }    // `before` is no state of the gas here, its own change is behind it
        return drained_share(before, change);
    }
    let density = before.flow.x + change.high.flow.x;
    var share = 1.0;
    if density < KEPT * low.flow.x { share = (1.0 - KEPT) * low.flow.x / max(low.flow.x - density, 1e-30); }
    let least = KEPT * internal_energy(low);
    for (var k = 0; k < 12; k++) {
        let flow = before.flow + change.low.flow + share * (change.high.flow - change.low.flow);
        let total = before.energy + change.low.energy + share * (change.high.energy - change.low.energy);
        if internal_energy(Gas(flow, total)) >= least { return share; }
        share *= 0.5;
    }
    return 0.0;
}
