//! Isentropic vortices on top of the gas at the start.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finding::Finding;
use super::{Gas, GasState, vector};

/// A vortex around z that is added to the gas at the start. The gas turns around its centre at speed
/// `strength / (2 pi) * (r / radius) * exp((1 - (r / radius)^2) / 2)`; pressure and density hold it in place at constant entropy.
/// [Shu 1998]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Vortex {
    /// Middle `[m]`.
    #[serde(with = "vector::Point")]
    pub center: [f64; 3],
    /// Where the gas is fastest `[m]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: f64,
    /// 2 pi times the largest speed `[m s^-1]`; positive turns from x to y. Some pressure must be left in the middle.
    pub strength: f64,
}

impl Vortex {
    /// Adds the vortex to a state at a point.
    pub(super) fn add(&self, state: &mut GasState, gamma: f64, point: [f64; 3]) {
        let [x, y] = [0, 1].map(|d| (point[d] - self.center[d]) / self.radius);
        let fall = (1.0 - x * x - y * y).exp();
        let turn = self.strength / std::f64::consts::TAU * fall.sqrt();
        let cooler = 1.0 - self.cooling(gamma) * fall * state.density / state.pressure;
        state.velocity[0] -= turn * y;
        state.velocity[1] += turn * x;
        state.density *= cooler.powf(1.0 / (gamma - 1.0));
        state.pressure *= cooler.powf(gamma / (gamma - 1.0));
    }

    /// Fall of pressure over density at the radius of the fastest gas \[m^2 s^-2\].
    fn cooling(&self, gamma: f64) -> f64 {
        (gamma - 1.0) * self.strength.powi(2) / (8.0 * gamma * std::f64::consts::PI.powi(2))
    }
}

/// A vortex must leave some pressure in its middle.
pub(super) fn findings(gas: &Gas) -> Vec<Finding> {
    let states = || gas.regions.iter().map(|region| region.state).chain([gas.ambient]);
    let least = states().map(|state| state.pressure / state.density).fold(f64::INFINITY, f64::min);
    let mut findings = Vec::new();
    for (index, vortex) in gas.vortices.iter().enumerate() {
        let path = format!("gas.vortices[{index}]");
        let fall = std::f64::consts::E * vortex.cooling(gas.gamma);
        if fall >= least {
            let message =
                format!("pressure over density falls by {fall:.3} in the middle, and a state has only {least:.3}");
            findings.push(Finding::new(format!("{path}.strength"), message, "make the vortex weaker"));
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use crate::scene::Scene;

    #[test]
    fn a_vortex_is_in_balance() {
        let scene = Scene::shipped("validation/isentropic_vortex.toml", &[]).unwrap();
        let gas = |x: f64, y: f64| scene.gas_at([x, y, 0.0]);
        // lowest density and pressure of the vortex of strength 5 [Shu 1997]
        assert!((gas(0.0, 0.0).density - 0.493_807).abs() < 1e-6 && (gas(0.0, 0.0).pressure - 0.372_375).abs() < 1e-6);
        for radius in [0.3, 1.0, 2.0] {
            // the fall of pressure turns the gas: dp/dr = rho u^2 / r
            let slope = (gas(radius + 1e-5, 0.0).pressure - gas(radius - 1e-5, 0.0).pressure) / 2e-5;
            let state = gas(radius, 0.0);
            let turn = state.velocity[1] - 1.0;
            assert!(turn > 0.0 && (state.velocity[0] - 1.0).abs() < 1e-12);
            assert!((slope - state.density * turn * turn / radius).abs() < 1e-6, "{radius}: {slope}");
            assert!((state.pressure - state.density.powf(scene.gas.gamma)).abs() < 1e-12, "constant entropy");
        }
    }

    #[test]
    fn impossible_vortices_are_refused() {
        for (key, place) in [("strength=11", "gas.vortices[0].strength"), ("radius=0", "gas.vortices[0].radius")] {
            let text = Scene::shipped("validation/isentropic_vortex.toml", &[format!("gas.vortices[0].{key}")]);
            let message = text.unwrap_err().to_string();
            assert!(message.contains(place), "{message}");
        }
    }
}
