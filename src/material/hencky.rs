//! Elastoplastic metal in logarithmic strain: psi = mu tr(e^2) + lambda/2 (tr e)^2, e = ln(F F^T) / 2. [Hencky 1928]

use super::{Constants, Hyperelastic, Kind, METAL};

/// The registry entry.
pub(super) const KIND: Kind = Kind {
    name: "hencky",
    summary: "Elastoplastic metal, linear in the logarithmic strain until the yield stress, then plastic with linear hardening.",
    parameters: &METAL,
    keeps_volume: true,
    energy: Hyperelastic::Hencky,
    constants: Constants::metal,
};
