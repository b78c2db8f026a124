//! Scenes whose exact solution is that of a Riemann problem.

use super::Scene;
use crate::riemann::ExactRiemann;

impl Scene {
    /// The exact solution of a shock tube and the place of its jump: a scene of dimension 1 with no bodies, obstacles or gravity
    /// whose gas starts as one region in ambient gas, so that the two ends differ and one jump lies between them.
    #[must_use]
    pub fn riemann(&self) -> Option<(ExactRiemann, f64)> {
        let plain = self.domain.dimension == 1
            && self.bodies.is_empty()
            && self.obstacles.is_empty()
            && self.charges.is_empty()
            && self.gas.waves.is_empty()
            && self.gas.vortices.is_empty()
            && self.gas.radial_flows.is_empty()
            && self.gas.noise == 0.0
            && self.gravity == [0.0; 3];
        let [region] = &self.gas.regions[..] else { return None };
        let inside = |x: f64| region.shape.distance([x, 0.0, 0.0]) < 0.0;
        let (mut low, mut high) = (self.domain.origin[0], self.domain.origin[0] + self.domain.size[0]);
        let primitive = |x: f64| {
            let state = self.gas_at([x, 0.0, 0.0]);
            let gases = self.gas.equation_of_state();
            let gamma = gases.gamma_at(gases.volume_fraction(state.mass_fraction));
            (gamma, (state.density, state.velocity[0], state.pressure))
        };
        let nudge = 1e-9 * self.domain.size[0];
        let ((left_gamma, left), (right_gamma, right)) = (primitive(low + nudge), primitive(high - nudge));
        if !plain || inside(low + nudge) == inside(high - nudge) {
            return None;
        }
        let first = inside(low + nudge);
        while high - low > 1e-14 * self.domain.size[0] {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if inside(middle) == first { low = middle } else { high = middle }
        }
        Some((ExactRiemann::of_two_gases([left_gamma, right_gamma], left, right), 0.5 * (low + high)))
    }

    /// The exact solution and the place of its jump, while its waves are inside the domain: later the sides have their say.
    #[must_use]
    pub fn riemann_until_waves_leave(&self, time: f64) -> Option<(ExactRiemann, f64)> {
        let (exact, jump) = self.riemann()?;
        let ends = [self.domain.origin[0], self.domain.origin[0] + self.domain.size[0]];
        let speeds = exact.wave_speeds();
        let inside = jump + speeds[0] * time >= ends[0] && jump + speeds[4] * time <= ends[1];
        inside.then_some((exact, jump))
    }
}
