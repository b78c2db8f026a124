//! Behind a plane detonation that began at a wall.

use crate::explosive::Explosive;

/// The wave of G. I. Taylor \[Proc. R. Soc. A 200 (1950) 235\]: everything is a function of distance over time. Products leave the
/// Chapman-Jouguet state along their isentrope until they are at rest.
#[derive(Clone, Debug)]
pub(crate) struct TaylorWave {
    /// Speed of the detonation \[m s^-1\].
    pub(crate) speed: f64,
    /// Distance over time, velocity \[m s^-1\], pressure \[Pa\] and density \[kg m^-3\], from the front to where the products rest.
    rows: Vec<[f64; 4]>,
}

/// Steps of the expansion, in volumes of the explosive.
const STEP: f64 = 1e-5;

impl TaylorWave {
    /// Of an explosive.
    pub(crate) fn of(explosive: &Explosive) -> Self {
        let (own, density) = (&explosive.products, explosive.density);
        let front = own.chapman_jouguet(density);
        let sound = |volume: f64, energy: f64| (own.stiffness(volume, energy) / density).sqrt();
        let (mut volume, mut velocity) = (front.volume, (front.pressure / density * (1.0 - front.volume)).sqrt());
        let mut energy = own.energy + 0.5 * front.pressure * (1.0 - volume);
        let mut rows = Vec::new();
        while velocity > 0.0 {
            let pressure = own.pressure(volume, energy);
            rows.push([velocity + sound(volume, energy), velocity, pressure, density / volume]);
            let middle = [volume + 0.5 * STEP, energy - 0.5 * STEP * pressure];
            velocity -= sound(middle[0], middle[1]) * STEP / middle[0];
            energy -= STEP * own.pressure(middle[0], middle[1]);
            volume += STEP;
        }
        Self { speed: front.speed, rows }
    }

    /// Velocity \[m s^-1\], pressure \[Pa\] and density \[kg m^-3\] at a distance over time \[m s^-1\] behind the front.
    pub(crate) fn at(&self, ratio: f64) -> [f64; 3] {
        let after = self.rows.partition_point(|row| row[0] > ratio).min(self.rows.len() - 1);
        let (low, high) = (self.rows[after], self.rows[after.saturating_sub(1)]);
        let share = if high[0] > low[0] { ((ratio - low[0]) / (high[0] - low[0])).clamp(0.0, 1.0) } else { 0.0 };
        [1, 2, 3].map(|k| low[k] + share * (high[k] - low[k]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explosive::explosive;

    #[test]
    fn it_starts_at_the_detonation_and_ends_at_rest() {
        let tnt = explosive("tnt").unwrap();
        let wave = TaylorWave::of(tnt);
        assert!((wave.rows[0][0] / wave.speed - 1.0).abs() < 1e-4, "sonic behind the front: {:?}", wave.rows[0]);
        assert!((wave.at(wave.speed)[1] / tnt.detonation_pressure - 1.0).abs() < 2e-3, "{:?}", wave.at(wave.speed));
        let [velocity, pressure, _] = wave.at(0.1 * wave.speed);
        // products rest behind about half of the way, at some 0.27 of the pressure of the front
        assert!(velocity < 1.0 && (0.2..0.35).contains(&(pressure / tnt.detonation_pressure)), "{velocity} {pressure}");
    }
}
