//! Exact solution of the Riemann problem of one ideal gas, or two. [Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics, 2009, §4]

/// Density, velocity and pressure.
pub type Primitive = (f64, f64, f64);

/// Two uniform states that meet at x = 0 at time 0, of one gas or of two. The solution depends on xi = x / t alone.
///
/// ```
/// use brisance::riemann::ExactRiemann;
/// let sod = ExactRiemann::new(1.4, (1.0, 0.0, 1.0), (0.125, 0.0, 0.1));
/// let (_, velocity, pressure) = sod.sample(0.5);
/// assert!((pressure - 0.30313).abs() < 1e-5 && (velocity - 0.92745).abs() < 1e-5);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ExactRiemann {
    left: Side,
    right: Side,
    /// Pressure between the waves; 0 if a vacuum opens.
    pub star_pressure: f64,
    /// Velocity between the waves.
    pub star_velocity: f64,
}

/// The gas on one side, as a wave to the left sees it: the right one is mirrored.
#[derive(Clone, Copy, Debug)]
struct Side {
    gamma: f64,
    density: f64,
    velocity: f64,
    pressure: f64,
}

impl ExactRiemann {
    /// Solves for the state between the waves, of a gas with one ratio of specific heats.
    pub fn new(gamma: f64, left: Primitive, right: Primitive) -> Self {
        Self::of_two_gases([gamma; 2], left, right)
    }

    /// The same of two gases, with the ratios of specific heats on the left and on the right.
    pub fn of_two_gases([left_gamma, right_gamma]: [f64; 2], left: Primitive, right: Primitive) -> Self {
        let side = |gamma: f64, (density, velocity, pressure): Primitive| Side { gamma, density, velocity, pressure };
        let (left, right) = (side(left_gamma, left), side(right_gamma, mirrored(right)));
        let mut problem = ExactRiemann { left, right, star_pressure: 0.0, star_velocity: 0.0 };
        if !problem.vacuum() {
            let star = problem.solve_pressure();
            problem.star_pressure = star;
            problem.star_velocity =
                0.5 * (left.velocity - right.velocity) + 0.5 * (right.curve(star).0 - left.curve(star).0);
        }
        problem
    }

    /// The state along x = xi t.
    pub fn sample(&self, xi: f64) -> Primitive {
        if self.vacuum() {
            return self.sample_vacuum(xi);
        }
        if xi <= self.star_velocity {
            self.left.sample(xi, self.star_velocity, self.star_pressure)
        } else {
            mirrored(self.right.sample(-xi, -self.star_velocity, self.star_pressure))
        }
    }

    /// Speeds of the waves: low and high edge of the left one, contact, low and high edge of the right one. The edges of a shock
    /// coincide; without gas between the waves the inner three are those of the vacuum.
    pub fn wave_speeds(&self) -> [f64; 5] {
        let [left, right] = [self.left, self.right].map(|side| side.speeds(self.star_pressure));
        let contact = if self.vacuum() { 0.5 * (left[1] - right[1]) } else { self.star_velocity };
        [left[0], left[1], contact, -right[1], -right[0]]
    }

    /// Mean of the state over a cell at a time; the jump lies at `jump` at time 0.
    ///
    /// Density, velocity and pressure are averaged one by one over 64 points; the waves inside the cell are resolved to 1/64 of it.
    pub fn cell_average(&self, low: f64, high: f64, jump: f64, time: f64) -> Primitive {
        const POINTS: u32 = 64;
        let mut sum = (0.0, 0.0, 0.0);
        for index in 0..POINTS {
            let x = low + (high - low) * (f64::from(index) + 0.5) / f64::from(POINTS) - jump;
            let (rho, u, p) = if time > 0.0 {
                self.sample(x / time)
            } else if x < 0.0 {
                self.left.state()
            } else {
                mirrored(self.right.state())
            };
            sum = (sum.0 + rho, sum.1 + u, sum.2 + p);
        }
        let weight = 1.0 / f64::from(POINTS);
        (sum.0 * weight, sum.1 * weight, sum.2 * weight)
    }

    /// The states fly apart faster than their rarefactions can follow. [Toro, eq. 4.40]
    fn vacuum(&self) -> bool {
        self.left.escape() <= -self.right.escape()
    }

    /// Newton's method from the two-rarefaction guess, which lies below the root, where the function is concave: it converges. Of two gases the
    /// lower of both guesses. [Toro, eq. 4.46]
    fn solve_pressure(&self) -> f64 {
        let (left, right) = (&self.left, &self.right);
        let guess = |g: f64| {
            let z = (g - 1.0) / (2.0 * g);
            let (cl, cr) = (left.sound(), right.sound());
            let top = cl + cr + 0.5 * (g - 1.0) * (right.velocity + left.velocity);
            (top.max(1e-9 * (cl + cr)) / (cl / left.pressure.powf(z) + cr / right.pressure.powf(z))).powf(1.0 / z)
        };
        let mut p = f64::min(guess(left.gamma), guess(right.gamma));
        for _ in 0..100 {
            let [(fl, dl), (fr, dr)] = [left, right].map(|side| side.curve(p));
            let next = (p - (fl + fr - right.velocity - left.velocity) / (dl + dr)).max(0.01 * p);
            let change = (next - p).abs();
            p = next;
            if change <= 1e-15 * p {
                break;
            }
        }
        p
    }

    /// Two rarefactions with nothing between them. [Toro, §4.6]
    fn sample_vacuum(&self, xi: f64) -> Primitive {
        let fronts = [self.left.escape(), -self.right.escape()];
        if xi < fronts[0] {
            self.left.fan_or_rest(xi)
        } else if xi <= fronts[1] {
            (0.0, xi, 0.0)
        } else {
            mirrored(self.right.fan_or_rest(-xi))
        }
    }
}

fn mirrored((density, velocity, pressure): Primitive) -> Primitive {
    (density, -velocity, pressure)
}

impl Side {
    fn state(&self) -> Primitive {
        (self.density, self.velocity, self.pressure)
    }

    fn sound(&self) -> f64 {
        (self.gamma * self.pressure / self.density).sqrt()
    }

    /// Speed of its edge where it expands into nothing.
    fn escape(&self) -> f64 {
        self.velocity + 2.0 / (self.gamma - 1.0) * self.sound()
    }

    /// Edges of the wave that brings it to a pressure.
    fn speeds(&self, star_pressure: f64) -> [f64; 2] {
        let g = self.gamma;
        let (c, ratio) = (self.sound(), star_pressure / self.pressure);
        if ratio > 1.0 {
            return [self.shock_speed(star_pressure); 2];
        }
        // across a rarefaction u + 2 c / (gamma - 1) stays
        let c_star = c * ratio.powf((g - 1.0) / (2.0 * g));
        [self.velocity - c, self.velocity + 2.0 / (g - 1.0) * (c - c_star) - c_star]
    }

    /// Speed of the shock that brings it to a pressure. [Toro, eq. 4.52]
    fn shock_speed(&self, star_pressure: f64) -> f64 {
        let g = self.gamma;
        let ratio = star_pressure / self.pressure;
        self.velocity - self.sound() * ((g + 1.0) / (2.0 * g) * ratio + (g - 1.0) / (2.0 * g)).sqrt()
    }

    /// Change of velocity across the wave that brings it to pressure p, and its derivative. [Toro, eqs. 4.6, 4.7, 4.37]
    fn curve(&self, p: f64) -> (f64, f64) {
        let g = self.gamma;
        if p > self.pressure {
            let a = 2.0 / ((g + 1.0) * self.density);
            let b = (g - 1.0) / (g + 1.0) * self.pressure;
            let root = (a / (p + b)).sqrt();
            ((p - self.pressure) * root, root * (1.0 - 0.5 * (p - self.pressure) / (p + b)))
        } else {
            let c = self.sound();
            let ratio = p / self.pressure;
            let value = 2.0 * c / (g - 1.0) * (ratio.powf((g - 1.0) / (2.0 * g)) - 1.0);
            (value, ratio.powf(-(g + 1.0) / (2.0 * g)) / (self.density * c))
        }
    }

    /// The state on this side of the contact. [Toro, §4.5.1]
    fn sample(&self, xi: f64, star_velocity: f64, star_pressure: f64) -> Primitive {
        let g = self.gamma;
        let ratio = star_pressure / self.pressure;
        if ratio > 1.0 {
            let weight = (g - 1.0) / (g + 1.0);
            let star = self.density * (ratio + weight) / (weight * ratio + 1.0);
            let ahead = xi < self.shock_speed(star_pressure);
            return if ahead { self.state() } else { (star, star_velocity, star_pressure) };
        }
        if xi > star_velocity - self.sound() * ratio.powf((g - 1.0) / (2.0 * g)) {
            (self.density * ratio.powf(1.0 / g), star_velocity, star_pressure)
        } else {
            self.fan_or_rest(xi)
        }
    }

    /// Inside a left rarefaction, or before it. [Toro, eq. 4.56]
    fn fan_or_rest(&self, xi: f64) -> Primitive {
        let (g, c) = (self.gamma, self.sound());
        if xi < self.velocity - c {
            return self.state();
        }
        let factor = 2.0 / (g + 1.0) + (g - 1.0) / ((g + 1.0) * c) * (self.velocity - xi);
        let velocity = 2.0 / (g + 1.0) * (c + 0.5 * (g - 1.0) * self.velocity + xi);
        (self.density * factor.powf(2.0 / (g - 1.0)), velocity, self.pressure * factor.powf(2.0 * g / (g - 1.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Left, right, pressure, velocity, densities between the waves. [Toro 2009, tables 4.1 to 4.3]
    type Case = (Primitive, Primitive, [f64; 4]);

    const TORO: [Case; 5] = [
        ((1.0, 0.0, 1.0), (0.125, 0.0, 0.1), [0.30313, 0.92745, 0.42632, 0.26557]),
        ((1.0, -2.0, 0.4), (1.0, 2.0, 0.4), [0.00189, 0.0, 0.02185, 0.02185]),
        ((1.0, 0.0, 1000.0), (1.0, 0.0, 0.01), [460.894, 19.5975, 0.57506, 5.99924]),
        ((1.0, 0.0, 0.01), (1.0, 0.0, 100.0), [46.0950, -6.19633, 5.99242, 0.57511]),
        ((5.99924, 19.5975, 460.894), (5.99242, -6.19633, 46.0950), [1691.64, 8.68975, 14.2823, 31.0426]),
    ];

    #[test]
    fn star_states_of_toro() {
        for (left, right, [pressure, velocity, left_density, right_density]) in TORO {
            let exact = ExactRiemann::new(1.4, left, right);
            // half a unit of the last printed digit
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-5 * b.abs().max(1.0);
            assert!(close(exact.star_pressure, pressure), "{} {pressure}", exact.star_pressure);
            assert!(close(exact.star_velocity, velocity), "{} {velocity}", exact.star_velocity);
            let step = 1e-9 * (1.0 + velocity.abs());
            assert!(close(exact.sample(exact.star_velocity - step).0, left_density));
            assert!(close(exact.sample(exact.star_velocity + step).0, right_density));
        }
    }

    #[test]
    fn the_solution_conserves_mass() {
        for (left, right, _) in TORO {
            let exact = ExactRiemann::new(1.4, left, right);
            let cells = 4000;
            let edge = |index: i32| f64::from(index - cells / 2) * 0.05;
            let sum = (0..cells).map(|i| exact.cell_average(edge(i), edge(i + 1), 0.0, 1.0).0 * 0.05).sum::<f64>();
            let flow = 100.0 * (left.0 + right.0) + left.0 * left.1 - right.0 * right.1;
            assert!((sum / flow - 1.0).abs() < 1e-4, "{sum} {flow}");
        }
    }

    #[test]
    fn states_change_at_the_wave_speeds() {
        for (left, right, _) in TORO {
            let exact = ExactRiemann::new(1.4, left, right);
            let speeds = exact.wave_speeds();
            assert!(speeds.windows(2).all(|pair| pair[0] <= pair[1]), "{speeds:?}");
            let nudge = 1e-7 * (speeds[4] - speeds[0]);
            assert_eq!((exact.sample(speeds[0] - nudge), exact.sample(speeds[4] + nudge)), (left, right));
            for plateau in [[speeds[1] + nudge, speeds[2] - nudge], [speeds[2] + nudge, speeds[3] - nudge]] {
                assert!(plateau.iter().all(|xi| (exact.sample(*xi).2 / exact.star_pressure - 1.0).abs() < 1e-6));
            }
        }
    }

    #[test]
    fn vacuum_opens_and_mirrors() {
        let exact = ExactRiemann::new(1.4, (1.0, -8.0, 1.0), (1.0, 8.0, 1.0));
        assert_eq!(exact.sample(0.0), (0.0, 0.0, 0.0));
        for xi in [0.5, 2.5, 6.5, 7.5, 9.5] {
            let (a, b) = (exact.sample(xi), exact.sample(-xi));
            assert!((a.0 - b.0).abs() < 1e-12 && (a.1 + b.1).abs() < 1e-12 && (a.2 - b.2).abs() < 1e-12);
        }
    }

    #[test]
    fn two_gases_meet_as_in_the_shock_tube_with_helium() {
        // air of 1.4 behind a shock of Mach 1.22, helium of 1.648 with air in it, at the ambient pressure and 0.2239 of its density
        let exact = ExactRiemann::of_two_gases([1.4, 1.648], (1.3764, 0.394, 1.5698), (0.2239, 0.0, 1.0));
        let mirror = ExactRiemann::of_two_gases([1.648, 1.4], (0.2239, 0.0, 1.0), (1.3764, -0.394, 1.5698));
        for xi in [-1.2, -0.8, 0.0, 0.5, 3.0, 4.0] {
            let ((a, u, p), (b, v, q)) = (exact.sample(xi), mirror.sample(-xi));
            assert!((a - b).abs() < 1e-12 && (u + v).abs() < 1e-12 && (p - q).abs() < 1e-12);
        }
        // jump conditions across the transmitted shock: mass, momentum, energy
        let speed = exact.wave_speeds()[4];
        let (density, velocity, pressure) = exact.sample(speed - 1e-9);
        let flow = 0.2239 * speed;
        assert!((density * (speed - velocity) - flow).abs() < 1e-9);
        assert!((pressure - 1.0 - flow * velocity).abs() < 1e-9);
        let energy = |p: f64, rho: f64, u: f64| p / 0.648 + 0.5 * rho * u * u;
        let gained = (energy(pressure, density, velocity) - energy(1.0, 0.2239, 0.0)) * speed;
        assert!((gained - velocity * (energy(pressure, density, velocity) + pressure)).abs() < 1e-9);
    }
}
