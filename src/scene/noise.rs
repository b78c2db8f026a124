//! Noise on the gas at the start.

use super::geometry::sample::random;
use super::{Conserved, Gas, GasState};

impl Gas {
    /// Puts noise on density, momentum and energy per volume of a cell: shares of density and pressure and, along `axes` axes, of the
    /// speed of sound. The same cell always gets the same noise.
    pub(super) fn disturb(&self, cell: usize, axes: usize, state: &mut Conserved) {
        let share = |entry: usize| self.noise * random(5 * cell + entry);
        let gases = self.equation_of_state();
        let [density, _, _, _, _, part, phi] = *state;
        let mut velocity = [1, 2, 3].map(|k| state[k] / density);
        let gamma = gases.gamma_at(phi);
        let pressure = gases.pressure(*state, 0.0);
        let sound = (gamma * pressure / density).sqrt();
        for (entry, v) in (2..).zip(&mut velocity[..axes]) {
            *v += sound * share(entry);
        }
        let mass_fraction = part / density;
        let (density, pressure) = (density * (1.0 + share(0)), pressure * (1.0 + share(1)));
        let [density, x, y, z, energy] = GasState { density, velocity, pressure, mass_fraction }.conserved(gamma);
        *state = [density, x, y, z, energy, density * mass_fraction, phi];
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::Scene;

    #[test]
    fn noise_has_its_size_and_no_bias() {
        let size = 1e-3;
        let scene = Scene::shipped("validation/rest_noise.toml", &[format!("gas.noise={size}")]).unwrap();
        let cells = scene.initial_gas();
        assert_eq!(cells, scene.initial_gas());
        let speed = 1.4_f64.sqrt();
        let shares = |k: usize, scale: f64, rest: f64| cells.iter().map(move |cell| (cell[k] / scale - rest) / size);
        for (k, scale, rest) in [(0, 1.0, 1.0), (1, speed, 0.0), (2, speed, 0.0), (4, 2.5, 1.0)] {
            let most = shares(k, scale, rest).fold(0.0, |most: f64, share| most.max(share.abs()));
            let mean = shares(k, scale, rest).sum::<f64>() / cells.len() as f64;
            // the mean of n even numbers from -1 to 1 deviates by 0.58 / sqrt n
            assert!(most > 0.99 && most < 1.01 && mean.abs() < 3.0 / (cells.len() as f64).sqrt(), "{k}: {most} {mean}");
        }
        assert!(cells.iter().all(|cell| cell[3] == 0.0), "noise along an axis that is not there");
        assert!(Scene::shipped("validation/rest_noise.toml", &["gas.noise=0.6".to_owned()]).is_err());
    }
}
