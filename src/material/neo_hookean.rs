//! Compressible neo-Hookean rubber: psi = mu/2 (tr(F F^T) - 3) - mu ln J + lambda/2 (ln J)^2.

use super::{Constants, GHOST_MODULUS, Hyperelastic, Kind, POISSON_RATIO, YOUNG_MODULUS};

/// The registry entry.
pub(super) const KIND: Kind = Kind {
    name: "neo_hookean",
    summary: "Compressible neo-Hookean rubber: elastic at any deformation.",
    parameters: &[YOUNG_MODULUS, POISSON_RATIO, GHOST_MODULUS],
    keeps_volume: true,
    energy: Hyperelastic::NeoHookean,
    constants: |values| Constants::elastic(values[0], values[1], values[2]),
};
