//! Exact solution of the Riemann problem of an ideal gas. [Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics, 2009, §4]

/// Density, velocity and pressure.
pub type Primitive = (f64, f64, f64);

/// Two uniform states of one gas that meet at x = 0 at time 0. The solution depends on xi = x / t alone.
///
/// ```
/// use brisance::riemann::ExactRiemann;
/// let sod = ExactRiemann::new(1.4, (1.0, 0.0, 1.0), (0.125, 0.0, 0.1));
/// let (_, velocity, pressure) = sod.sample(0.5);
/// assert!((pressure - 0.30313).abs() < 1e-5 && (velocity - 0.92745).abs() < 1e-5);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ExactRiemann {
    gamma: f64,
    left: Primitive,
    right: Primitive,
    /// Pressure between the waves; 0 if a vacuum opens.
    pub star_pressure: f64,
    /// Velocity between the waves.
    pub star_velocity: f64,
}

impl ExactRiemann {
    /// Solves for the state between the waves.
    pub fn new(gamma: f64, left: Primitive, right: Primitive) -> Self {
        let mut problem = ExactRiemann { gamma, left, right, star_pressure: 0.0, star_velocity: 0.0 };
        if !problem.vacuum() {
            problem.star_pressure = problem.solve_pressure();
            let (towards_left, towards_right) =
                (problem.curve(left, problem.star_pressure), problem.curve(right, problem.star_pressure));
            problem.star_velocity = 0.5 * (left.1 + right.1) + 0.5 * (towards_right.0 - towards_left.0);
        }
        problem
    }

    /// The state along x = xi t.
    pub fn sample(&self, xi: f64) -> Primitive {
        if self.vacuum() {
            return self.sample_vacuum(xi);
        }
        if xi <= self.star_velocity {
            self.sample_side(xi, self.left)
        } else {
            // the right side is the left side of the mirrored problem
            let (rho, u, p) = self.sample_side_mirrored(xi);
            (rho, u, p)
        }
    }

    /// Speeds of the waves: low and high edge of the left one, contact, low and high edge of the right one. The edges of a shock
    /// coincide; without gas between the waves the inner three are those of the vacuum.
    pub fn wave_speeds(&self) -> [f64; 5] {
        let flip = |(rho, u, p): Primitive| (rho, -u, p);
        let (left, right) = (self.side_speeds(self.left), self.side_speeds(flip(self.right)));
        let contact = if self.vacuum() { 0.5 * (left[1] - right[1]) } else { self.star_velocity };
        [left[0], left[1], contact, -right[1], -right[0]]
    }

    /// Edges of the wave on the left of a gas.
    fn side_speeds(&self, side: Primitive) -> [f64; 2] {
        let g = self.gamma;
        let (c, ratio) = (self.sound(side), self.star_pressure / side.2);
        if ratio > 1.0 {
            return [self.shock_speed(side); 2];
        }
        // across a rarefaction u + 2 c / (gamma - 1) stays
        let c_star = c * ratio.powf((g - 1.0) / (2.0 * g));
        [side.1 - c, side.1 + 2.0 / (g - 1.0) * (c - c_star) - c_star]
    }

    /// Speed of a left shock into a gas. [Toro, eq. 4.52]
    fn shock_speed(&self, side: Primitive) -> f64 {
        let g = self.gamma;
        let ratio = self.star_pressure / side.2;
        side.1 - self.sound(side) * ((g + 1.0) / (2.0 * g) * ratio + (g - 1.0) / (2.0 * g)).sqrt()
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
                self.left
            } else {
                self.right
            };
            sum = (sum.0 + rho, sum.1 + u, sum.2 + p);
        }
        let weight = 1.0 / f64::from(POINTS);
        (sum.0 * weight, sum.1 * weight, sum.2 * weight)
    }

    fn sound(&self, state: Primitive) -> f64 {
        (self.gamma * state.2 / state.0).sqrt()
    }

    /// The states fly apart faster than their rarefactions can follow. [Toro, eq. 4.40]
    fn vacuum(&self) -> bool {
        2.0 / (self.gamma - 1.0) * (self.sound(self.left) + self.sound(self.right)) <= self.right.1 - self.left.1
    }

    /// Change of velocity across the wave that brings a state to pressure p, and its derivative. [Toro, eqs. 4.6, 4.7, 4.37]
    fn curve(&self, state: Primitive, p: f64) -> (f64, f64) {
        let g = self.gamma;
        let (rho, _, pressure) = state;
        if p > pressure {
            let a = 2.0 / ((g + 1.0) * rho);
            let b = (g - 1.0) / (g + 1.0) * pressure;
            let root = (a / (p + b)).sqrt();
            ((p - pressure) * root, root * (1.0 - 0.5 * (p - pressure) / (p + b)))
        } else {
            let c = self.sound(state);
            let ratio = p / pressure;
            let value = 2.0 * c / (g - 1.0) * (ratio.powf((g - 1.0) / (2.0 * g)) - 1.0);
            (value, ratio.powf(-(g + 1.0) / (2.0 * g)) / (rho * c))
        }
    }

    /// Newton's method from the two-rarefaction guess, which lies below the root, where the function is concave: it converges. [Toro, eq. 4.46]
    fn solve_pressure(&self) -> f64 {
        let g = self.gamma;
        let z = (g - 1.0) / (2.0 * g);
        let (cl, cr) = (self.sound(self.left), self.sound(self.right));
        let top = cl + cr - 0.5 * (g - 1.0) * (self.right.1 - self.left.1);
        let mut p = (top / (cl / self.left.2.powf(z) + cr / self.right.2.powf(z))).powf(1.0 / z);
        for _ in 0..100 {
            let (fl, dl) = self.curve(self.left, p);
            let (fr, dr) = self.curve(self.right, p);
            let next = (p - (fl + fr + self.right.1 - self.left.1) / (dl + dr)).max(0.01 * p);
            let change = (next - p).abs();
            p = next;
            if change <= 1e-15 * p {
                break;
            }
        }
        p
    }

    fn sample_side_mirrored(&self, xi: f64) -> Primitive {
        let flip = |(rho, u, p): Primitive| (rho, -u, p);
        let mirrored = ExactRiemann {
            left: flip(self.right),
            right: flip(self.left),
            star_velocity: -self.star_velocity,
            ..*self
        };
        flip(mirrored.sample_side(-xi, mirrored.left))
    }

    /// The state on the left of the contact. [Toro, §4.5.1]
    fn sample_side(&self, xi: f64, side: Primitive) -> Primitive {
        let g = self.gamma;
        let (rho, u, p) = side;
        let c = self.sound(side);
        let ratio = self.star_pressure / p;
        if ratio > 1.0 {
            let speed = self.shock_speed(side);
            let weight = (g - 1.0) / (g + 1.0);
            let star = rho * (ratio + weight) / (weight * ratio + 1.0);
            return if xi < speed { side } else { (star, self.star_velocity, self.star_pressure) };
        }
        let tail = self.star_velocity - c * ratio.powf((g - 1.0) / (2.0 * g));
        if xi < u - c {
            side
        } else if xi > tail {
            (rho * ratio.powf(1.0 / g), self.star_velocity, self.star_pressure)
        } else {
            self.fan(xi, side)
        }
    }

    /// Inside a left rarefaction. [Toro, eq. 4.56]
    fn fan(&self, xi: f64, (rho, u, p): Primitive) -> Primitive {
        let g = self.gamma;
        let c = self.sound((rho, u, p));
        let factor = 2.0 / (g + 1.0) + (g - 1.0) / ((g + 1.0) * c) * (u - xi);
        let velocity = 2.0 / (g + 1.0) * (c + 0.5 * (g - 1.0) * u + xi);
        (rho * factor.powf(2.0 / (g - 1.0)), velocity, p * factor.powf(2.0 * g / (g - 1.0)))
    }

    /// Two rarefactions with nothing between them. [Toro, §4.6]
    fn sample_vacuum(&self, xi: f64) -> Primitive {
        let g = self.gamma;
        let flip = |(rho, u, p): Primitive| (rho, -u, p);
        let (cl, cr) = (self.sound(self.left), self.sound(self.right));
        let fronts = (self.left.1 + 2.0 * cl / (g - 1.0), self.right.1 - 2.0 * cr / (g - 1.0));
        if xi <= self.left.1 - cl {
            self.left
        } else if xi < fronts.0 {
            self.fan(xi, self.left)
        } else if xi <= fronts.1 {
            (0.0, xi, 0.0)
        } else if xi < self.right.1 + cr {
            flip(self.fan(-xi, flip(self.right)))
        } else {
            self.right
        }
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
}
