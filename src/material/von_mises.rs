//! Elastoplastic metal: neo-Hookean elasticity below a yield stress, plastic flow with linear hardening above it.
//! The return mapping works on the logarithmic strain and keeps the volume.

use super::{Constants, Hyperelastic, Kind, METAL};

/// The registry entry.
pub(super) const KIND: Kind = Kind {
    name: "von_mises",
    summary: "Elastoplastic metal: neo-Hookean until the yield stress, then plastic with linear hardening.",
    parameters: &METAL,
    keeps_volume: true,
    energy: Hyperelastic::NeoHookean,
    constants: Constants::metal,
};
