//! Soil and sand: linear in the logarithmic strain, flows where shear exceeds friction and cohesion, and opens without tension.
//! The cone meets Mohr-Coulomb's in compression. [Drucker & Prager 1952; Klar et al. 2016]

use std::ops::Bound;

use super::{Constants, GHOST_MODULUS, Kind, POISSON_RATIO, Parameter, YOUNG_MODULUS};

/// Slope of the cone.
const FRICTION_ANGLE: Parameter = Parameter {
    name: "friction_angle",
    unit: "deg",
    default: Some(30.0),
    low: Bound::Excluded(0.0),
    high: Bound::Excluded(90.0),
    summary: "Angle of internal friction, at which a dry heap stands; the cone meets Mohr-Coulomb's in triaxial compression",
};

/// Tip of the cone.
const COHESION: Parameter = Parameter {
    name: "cohesion",
    unit: "Pa",
    default: Some(0.0),
    low: Bound::Included(0.0),
    high: Bound::Unbounded,
    summary: "Shear stress that it bears without pressure",
};

/// The registry entry.
pub(super) const KIND: Kind = Kind {
    name: "drucker_prager",
    summary: "Soil and sand: yields by friction and cohesion, bears no tension beyond its cohesion.",
    parameters: &[YOUNG_MODULUS, POISSON_RATIO, FRICTION_ANGLE, COHESION, GHOST_MODULUS],
    keeps_volume: false,
    constants: |values| {
        let (sine, cosine) = values[2].to_radians().sin_cos();
        // |dev tau| <= yield_stress - friction tr(tau)
        let scale = 2.0 * (2.0_f64 / 3.0).sqrt() / (3.0 - sine);
        Constants {
            yield_stress: 3.0 * scale * values[3] * cosine,
            friction: scale * sine,
            ..Constants::elastic(values[0], values[1], values[4])
        }
    },
};
