//! Fixed-corotated solid: psi = mu |F - R|^2 + lambda/2 (J - 1)^2, R the rotation of F. [Stomakhin et al. 2012]

use super::{Constants, GHOST_MODULUS, Hyperelastic, Kind, POISSON_RATIO, YOUNG_MODULUS};

/// The registry entry.
pub(super) const KIND: Kind = Kind {
    name: "fixed_corotated",
    summary: "Fixed-corotated solid: elastic, linear in the stretch.",
    parameters: &[YOUNG_MODULUS, POISSON_RATIO, GHOST_MODULUS],
    keeps_volume: true,
    energy: Hyperelastic::FixedCorotated,
    constants: |values| Constants::elastic(values[0], values[1], values[2]),
};
