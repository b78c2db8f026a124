// The energy floor: how much internal energy a gas cell must keep.

const FLOOR_SHARE = 0.1;
// Internal energy is a difference of two float32 numbers: below some hundred units in the last place it means nothing.
const RESOLVED_SHARE = 2e-5;

// A share of the internal energy `before` the pressure step, the entropy of no gas that was there, and what the total energy resolves.
fn least_energy(density: f32, total: f32, before: f32) -> f32 {
    let coldest = params.least_entropy * pow(density, params.gamma) / (params.gamma - 1.0);
    return max(max(FLOOR_SHARE * before, coldest), RESOLVED_SHARE * total);
}

fn is_unsound(density: f32, total: f32) -> bool { return is_broken(total) || is_broken(density) || density <= 0.0; }
