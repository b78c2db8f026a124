//! Ambient gas at rest under gravity.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{GasState, Scene};

/// How the ambient gas starts under gravity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Atmosphere {
    /// In balance, of one temperature; `ambient` lies at the lowest corner of the domain.
    #[default]
    Isothermal,
    /// In balance, of one entropy; likewise.
    Isentropic,
    /// `ambient` everywhere: under gravity it falls.
    Uniform,
}

impl Scene {
    /// Whether the ambient gas changes with height.
    #[must_use]
    pub fn is_stratified(&self) -> bool {
        self.gravity != [0.0; 3] && self.gas.atmosphere != Atmosphere::Uniform
    }

    /// Ambient gas at a point: weight and pressure gradient are in balance. [Holton 2004, section 1.6]
    #[must_use]
    pub fn ambient_at(&self, point: [f64; 3]) -> GasState {
        let mut state = self.gas.ambient;
        if !self.is_stratified() {
            return state;
        }
        let (ratio, entropy) = (self.pressure_ratio(point), self.gas.atmosphere == Atmosphere::Isentropic);
        state.pressure *= ratio;
        state.density *= if entropy { ratio.powf(1.0 / self.gas.gamma) } else { ratio };
        state
    }

    /// Pressure of the ambient gas at a point over that at the lowest corner; 0 where an isentropic atmosphere has ended.
    fn pressure_ratio(&self, point: [f64; 3]) -> f64 {
        let (domain, gamma) = (&self.domain, self.gas.gamma);
        let lowest = |d: usize| domain.origin[d] + if self.gravity[d] > 0.0 { domain.size[d] } else { 0.0 };
        let lift: f64 = (0..domain.axes()).map(|d| -self.gravity[d] * (point[d] - lowest(d))).sum();
        let heights = lift * self.gas.ambient.density / self.gas.ambient.pressure;
        match self.gas.atmosphere {
            Atmosphere::Isentropic => f64::max(1.0 - (gamma - 1.0) / gamma * heights, 0.0).powf(gamma / (gamma - 1.0)),
            _ => (-heights).exp(),
        }
    }

    /// The least pressure of the ambient gas in the domain over that at its lowest corner.
    pub(super) fn least_pressure_ratio(&self) -> f64 {
        let domain = &self.domain;
        self.pressure_ratio(std::array::from_fn(|d| {
            domain.origin[d] + if self.gravity[d] > 0.0 { 0.0 } else { domain.size[d] }
        }))
    }
}
