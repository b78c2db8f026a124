//! Gas that moves towards or away from a point at the start.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{GasState, vector};

/// A flow of constant speed away from a point that is added to the velocity at the start. In 2D the point is a line along z.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadialFlow {
    /// Where it comes from `[m]`.
    #[serde(with = "vector::Point")]
    pub center: [f64; 3],
    /// Speed away from there `[m s^-1]`; negative towards it.
    pub speed: f64,
}

impl RadialFlow {
    /// Adds the flow to a state at a point. The centre itself has no direction and keeps its velocity.
    pub(super) fn add(&self, state: &mut GasState, point: [f64; 3]) {
        let arm: [f64; 3] = std::array::from_fn(|d| point[d] - self.center[d]);
        let radius = arm.iter().map(|x| x * x).sum::<f64>().sqrt();
        if radius > 0.0 {
            for (sum, x) in state.velocity.iter_mut().zip(arm) {
                *sum += self.speed * x / radius;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::Scene;

    #[test]
    fn gas_moves_towards_the_center() {
        let scene = Scene::shipped("validation/noh_cylindrical.toml", &[]).unwrap();
        let velocity = |x: f64, y: f64| scene.gas_at([x, y, 0.0]).velocity;
        assert_eq!(velocity(0.0, 0.0), [0.0; 3]);
        let [u, v, w] = velocity(0.3, 0.4);
        assert!((u + 0.6).abs() < 1e-15 && (v + 0.8).abs() < 1e-15 && w == 0.0);
    }
}
