//! Sine waves on top of the gas at the start.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finding::Finding;
use super::{Gas, GasState, Shape, vector};

/// A wave that is added to the gas at the start: amplitude times cos(vector . x + phase).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// Where it is added; everywhere when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// Wave vector: 2 pi over the wave length, along the direction `[m^-1]`.
    #[serde(with = "vector::Point")]
    pub vector: [f64; 3],
    /// Phase at the origin `[rad]`.
    #[serde(default)]
    pub phase: f64,
    /// Amplitude of the density `[kg m^-3]`.
    #[serde(default)]
    pub density: f64,
    /// Amplitude of the velocity `[m s^-1]`.
    #[serde(default, with = "vector::Point")]
    pub velocity: [f64; 3],
    /// Amplitude of the pressure `[Pa]`.
    #[serde(default)]
    pub pressure: f64,
}

impl Wave {
    /// Adds the wave to a state at a point.
    pub(super) fn add(&self, state: &mut GasState, point: [f64; 3]) {
        if self.shape.as_ref().is_some_and(|shape| shape.distance(point) >= 0.0) {
            return;
        }
        let angle: f64 = self.vector.iter().zip(point).map(|(k, x)| k * x).sum();
        let factor = (angle + self.phase).cos();
        state.density += factor * self.density;
        state.pressure += factor * self.pressure;
        for (sum, amplitude) in state.velocity.iter_mut().zip(self.velocity) {
            *sum += factor * amplitude;
        }
    }
}

/// All waves together must leave something of every state.
pub(super) fn finding(gas: &Gas) -> Option<Finding> {
    let states = || gas.regions.iter().map(|region| region.state).chain([gas.ambient]);
    let least = |of: fn(&GasState) -> f64| states().map(|state| of(&state)).fold(f64::INFINITY, f64::min);
    let sum = |of: fn(&Wave) -> f64| gas.waves.iter().map(|wave| of(wave).abs()).sum::<f64>();
    let density = ("density", least(|state| state.density), sum(|wave| wave.density));
    let pressure = ("pressure", least(|state| state.pressure), sum(|wave| wave.pressure));
    let (name, least, sum) = [density, pressure].into_iter().find(|(_, least, sum)| *sum > 0.0 && sum >= least)?;
    let message = format!("amplitudes of the {name} add up to {sum}, and a state has only {least}");
    Some(Finding::new("gas.waves", message, "make the waves smaller: density and pressure must stay positive"))
}
