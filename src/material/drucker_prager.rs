//! Soil and sand: linear in the logarithmic strain, flows where shear exceeds friction and cohesion, and opens without tension.
//! The cone meets Mohr-Coulomb's in compression. [Drucker & Prager 1952; Klar et al. 2016]

use super::{Constants, GHOST_MODULUS, Hyperelastic, Kind, POISSON_RATIO, Parameter, YOUNG_MODULUS};

/// Slope of the cone.
const FRICTION_ANGLE: Parameter = Parameter::positive(
    "friction_angle",
    "deg",
    "Angle of internal friction, at which a dry heap stands; the cone meets Mohr-Coulomb's in triaxial compression",
)
.below(90.0)
.or(30.0);

/// Tip of the cone.
const COHESION: Parameter = Parameter::not_negative("cohesion", "Pa", "Shear stress that it bears without pressure");

/// The registry entry.
pub(super) const KIND: Kind = Kind {
    name: "drucker_prager",
    summary: "Soil and sand: yields by friction and cohesion, bears no tension beyond its cohesion.",
    parameters: &[YOUNG_MODULUS, POISSON_RATIO, FRICTION_ANGLE, COHESION, GHOST_MODULUS],
    keeps_volume: false,
    energy: Hyperelastic::Hencky,
    constants: |values| {
        // |dev tau| <= yield_stress - friction tr(tau)
        let friction = cone_slope(values[2]);
        Constants {
            yield_stress: 3.0 * friction * values[3] / values[2].to_radians().tan(),
            friction,
            ..Constants::elastic(values[0], values[1], values[4])
        }
    },
};

/// Slope of the cone of an angle of internal friction \[degrees\]: length of the deviator over minus the trace of the Kirchhoff stress.
pub(super) fn cone_slope(angle: f64) -> f64 {
    let sine = angle.to_radians().sin();
    2.0 * (2.0_f64 / 3.0).sqrt() * sine / (3.0 - sine)
}
