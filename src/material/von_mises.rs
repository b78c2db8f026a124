//! Elastoplastic metal: neo-Hookean elasticity below a yield stress, plastic flow with linear hardening above it.
//! The return mapping works on the logarithmic strain and keeps the volume.

use super::{Constants, HARDENING, Kind, POISSON_RATIO, YIELD_STRESS, YOUNG_MODULUS};

/// The registry entry.
pub(super) const KIND: Kind = Kind {
    name: "von_mises",
    summary: "Elastoplastic metal: neo-Hookean until the yield stress, then plastic with linear hardening.",
    parameters: &[YOUNG_MODULUS, POISSON_RATIO, YIELD_STRESS, HARDENING],
    constants: |values| Constants {
        yield_stress: values[2],
        hardening: values[3],
        ..Constants::elastic(values[0], values[1])
    },
};
