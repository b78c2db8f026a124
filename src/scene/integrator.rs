//! How the gas is integrated in time, and what carries it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Scene;

/// Time integration of the gas.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// The paper's, which compresses twice.
    Paper,
    /// One solve per step, from the pressure that advection has not yet compressed: of first order in time.
    #[default]
    Predictor,
    /// Two solves per step, of second order: for gas alone, with `cfl` at most 0.5.
    // The implicit half of ARS(2,2,2) [Ascher, Ruuth & Spiteri 1997, section 2.6], and three stages of advection [Wicker & Skamarock 2002],
    // since the two of ARS let sound grow that runs with the stream.
    Ars222,
    /// `ars222` where bodies, `cfl` and `fixed_step` allow it, else `predictor`.
    // Only the advective part of the step counts: since the internal energy is carried implicitly, no acoustic Courant number limits `ars222`.
    Auto,
}

/// Velocity that carries the gas through its faces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FaceVelocity {
    /// That of the two cells, as in the paper: motion that the pressure solve cannot see compresses the gas.
    Cell,
    /// What the pressure solve sees of it: gas at rest stays quiet. Gas only.
    Consistent,
    /// `consistent` in scenes of gas alone, else `cell`.
    #[default]
    Auto,
}

impl Integrator {
    /// Largest fraction of the advective time step with two solves: above it strong shocks leave negative pressures.
    pub const ARS_CFL: f64 = 0.5;
}

/// Cells that sound may cross at most in a step that keeps it of fourth order in space.
const SHORT_STEP: f64 = 4.0;
/// Cells that sound crosses in a step that is filtered without being asked.
const LONG_STEP: f64 = 10.0;

/// A conservative filter after the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OddEvenFilter {
    /// Share of the alternating mode that a step removes.
    pub share: f64,
    /// Cells that sound crosses at least in a step that is filtered.
    pub least_courant: f64,
}

impl Scene {
    /// The integrator of this scene, never [`Integrator::Auto`]: the choice holds for the whole run, because a change from step
    /// to step is unstable.
    #[must_use]
    pub fn integrator(&self) -> Integrator {
        let time = &self.time;
        let slow = time.cfl <= Integrator::ARS_CFL && time.fixed_step.is_none() && self.bodies.is_empty();
        match self.numerics.integrator {
            Integrator::Auto if slow => Integrator::Ars222,
            Integrator::Auto => Integrator::Predictor,
            chosen => chosen,
        }
    }

    /// Whether the gas is carried by what the pressure solve sees of its velocity.
    #[must_use]
    pub fn consistent(&self) -> bool {
        match self.numerics.paper.face_velocity {
            FaceVelocity::Cell => false,
            FaceVelocity::Consistent => true,
            FaceVelocity::Auto => self.bodies.is_empty(),
        }
    }

    /// The filter of the mode that alternates from cell to cell, if some step may want it. Long steps do: their first carries gas with
    /// velocities that no solve has seen, and what alternates of the noise stays, for no pressure at a vertex sees it.
    #[must_use]
    pub fn filter(&self) -> Option<OddEvenFilter> {
        let long = self.time.fixed_step.is_some() || self.time.max_courant >= LONG_STEP;
        match self.numerics.filter {
            Some(share) => (share > 0.0).then_some(OddEvenFilter { share, least_courant: 0.0 }),
            None => (long && self.bodies.is_empty()).then_some(OddEvenFilter { share: 0.2, least_courant: LONG_STEP }),
        }
    }

    /// Whether sound is of fourth order in space (with b2b1 nearer to it than otherwise): with two solves, unless steps may be long, in
    /// which it feeds noise at rest.
    #[must_use]
    pub fn sound_of_fourth_order(&self) -> bool {
        self.solves() == 2 && self.time.fixed_step.is_none() && self.time.max_courant <= SHORT_STEP
    }

    /// Pressure solves per step.
    #[must_use]
    pub fn solves(&self) -> u32 {
        if self.integrator() == Integrator::Ars222 { 2 } else { 1 }
    }
}
