// The energy floor: how much internal energy a gas cell must keep.

const FLOOR_SHARE = 0.1;
// Internal energy is a difference of two float32 numbers: below some hundred units in the last place it means nothing.
const RESOLVED_SHARE = 2e-5;

// Internal energy of the entropy that no gas had. Of two gases each has its own; where both are, mixing changes it.
fn coldest_energy(density: f32, species: vec2f) -> f32 {
    let shares = vec2f(species.x / density, species.y);
    if SPECIES && all(shares > vec2f(1.0 - PURE)) { return params.species_least_entropy * pow(density, params.species_gamma) / (params.species_gamma - 1.0); }
    if SPECIES && any(shares >= vec2f(PURE)) { return 0.0; }
    return params.least_entropy * pow(density, params.gamma) / (params.gamma - 1.0);
}

// A share of the internal energy `before` the pressure step, the entropy of no gas that was there, and what the total energy resolves.
fn least_energy(density: f32, species: vec2f, total: f32, before: f32) -> f32 {
    return max(max(FLOOR_SHARE * before, coldest_energy(density, species)), RESOLVED_SHARE * total);
}

fn is_unsound(density: f32, total: f32) -> bool { return is_broken(total) || is_broken(density) || density <= 0.0; }
