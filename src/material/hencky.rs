//! Elastoplastic metal in logarithmic strain: psi = mu tr(e^2) + lambda/2 (tr e)^2, e = ln(F F^T) / 2. [Hencky 1928]

use super::{Constants, HARDENING, Kind, POISSON_RATIO, YIELD_STRESS, YOUNG_MODULUS};

/// The registry entry.
pub(super) const KIND: Kind = Kind {
    name: "hencky",
    summary: "Elastoplastic metal, linear in the logarithmic strain until the yield stress, then plastic with linear hardening.",
    parameters: &[YOUNG_MODULUS, POISSON_RATIO, YIELD_STRESS, HARDENING],
    constants: |values| Constants {
        yield_stress: values[2],
        hardening: values[3],
        ..Constants::elastic(values[0], values[1])
    },
};
