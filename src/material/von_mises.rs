//! Elastoplastic metal: neo-Hookean elasticity below a yield stress, perfectly plastic flow above it.
//! The return mapping works on the logarithmic strain and keeps the volume.

use super::{Constants, Kind, POISSON_RATIO, Parameter, YOUNG_MODULUS};

/// Stress at which a rod starts to flow.
const YIELD_STRESS: Parameter = Parameter {
    name: "yield_stress",
    unit: "Pa",
    default: None,
    above: 0.0,
    below: f64::INFINITY,
    summary: "Norm of the deviatoric Kirchhoff stress at which plastic flow starts.",
};

/// The registry entry.
pub(super) const KIND: Kind = Kind {
    name: "von_mises",
    summary: "Elastoplastic metal: neo-Hookean until the yield stress, then perfectly plastic.",
    parameters: &[YOUNG_MODULUS, POISSON_RATIO, YIELD_STRESS],
    constants: |values| Constants { yield_stress: values[2], ..Constants::elastic(values[0], values[1]) },
};
