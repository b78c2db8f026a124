//! Neo-Hookean elasticity with a ghost pressure, von Mises return in log strain.

use glam::{DMat3, DVec3};

/// A solid material.
#[derive(Clone, Copy, Debug)]
pub struct Material {
    /// Shear modulus.
    pub mu: f64,
    /// First Lame parameter of the body.
    pub lambda: f64,
    /// Modulus of the ghost pressure.
    pub ghost: f64,
    /// What that leaves of lambda to the stress.
    pub elastic_lambda: f64,
    /// Ghost pressure that bodies start with.
    pub start: f64,
    /// Infinite for a purely elastic one.
    pub yield_stress: f64,
}

impl Material {
    /// From Young's modulus and Poisson's ratio.
    pub fn new(young: f64, poisson: f64, yield_stress: f64) -> Self {
        let mu = young / (2.0 * (1.0 + poisson));
        let lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
        Self { mu, lambda, ghost: 0.02 * lambda, elastic_lambda: 0.98 * lambda, start: 1.0, yield_stress }
    }

    /// The same in gas whose largest pressure is `most`.
    pub fn in_gas(self, most: f64) -> Self {
        let ghost = self.ghost.max(most);
        Self { ghost, elastic_lambda: (self.lambda - ghost).max(0.0), ..self }
    }

    /// Compliance of the ghost volume at a ghost pressure.
    pub fn compliance(&self, ghost_pressure: f64) -> f64 {
        1.0 / (self.ghost + 7.0 * (ghost_pressure - self.start).max(0.0))
    }

    /// Ghost pressure of a body that the solve alone has moved, by its volume ratio.
    pub fn ghost_pressure(&self, j: f64) -> f64 {
        if j > 1.0 { self.start - self.ghost * j.ln() } else { self.start + self.ghost / 7.0 * (j.powi(-7) - 1.0) }
    }

    /// Energy of the ghost pressure per volume at rest.
    pub fn ghost_energy(&self, j: f64) -> f64 {
        let shape = if j > 1.0 { j * j.ln() - j + 1.0 } else { ((j.powi(-6) - 1.0) / 6.0 - 1.0 + j) / 7.0 };
        self.ghost * shape + self.start * (1.0 - j)
    }

    /// Kirchhoff stress of the law.
    pub fn law_stress(&self, f: DMat3) -> DMat3 {
        (f * f.transpose() - DMat3::IDENTITY) * self.mu + DMat3::IDENTITY * (self.elastic_lambda * f.determinant().ln())
    }

    /// Kirchhoff stress of the elastic force: with the ghost pressure q it is the whole stress.
    pub fn stress(&self, f: DMat3, q: f64) -> DMat3 {
        let j = f.determinant();
        self.law_stress(f) + DMat3::IDENTITY * (j * (q - self.ghost_pressure(j)))
    }

    /// Longitudinal wave speed in a deformed body, `density` that at rest.
    pub fn wave_speed(&self, f: DMat3, density: f64) -> f64 {
        let squares = f * f.transpose();
        let rows = [squares.x_axis, squares.y_axis, squares.z_axis].map(|row| row.abs().element_sum());
        let bulk = self.lambda * (1.0 - f.determinant().ln()).max(0.0);
        ((bulk + self.mu * (1.0 + rows[0].max(rows[1]).max(rows[2]))) / density).sqrt()
    }

    /// The same with what the ghost pressure is stiffer than the part of the law that it bears.
    pub fn body_wave_speed(&self, f: DMat3, density: f64) -> f64 {
        let ghost = 1.0 / self.compliance(self.ghost_pressure(f.determinant()));
        self.wave_speed(f, density).hypot(((ghost + self.elastic_lambda - self.lambda).max(0.0) / density).sqrt())
    }

    /// Deformation after the plastic return, and the equivalent plastic strain of it.
    pub fn plastic_return(&self, f: DMat3) -> (DMat3, f64) {
        if self.yield_stress.is_infinite() {
            return (f, 0.0);
        }
        let (squared, v) = eigen(f.transpose() * f);
        let strain = DVec3::new(squared.x.ln(), squared.y.ln(), squared.z.ln()) * 0.5;
        let mean = DVec3::splat(strain.element_sum() / 3.0);
        let deviator = strain - mean;
        let (norm, limit) = (deviator.length(), self.yield_stress / (2.0 * self.mu));
        if norm <= limit {
            return (f, 0.0);
        }
        let ratio = mean + deviator * (limit / norm) - strain;
        let stretch = DMat3::from_diagonal(DVec3::new(ratio.x.exp(), ratio.y.exp(), ratio.z.exp()));
        (f * v * stretch * v.transpose(), (2.0_f64 / 3.0).sqrt() * (norm - limit))
    }
}

/// Eigenvalues and eigenvectors (columns) of a symmetric matrix, by Jacobi rotations.
pub fn eigen(mut a: DMat3) -> (DVec3, DMat3) {
    let mut v = DMat3::IDENTITY;
    for _ in 0..24 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = a.col(q)[p];
            if off.abs() < 1e-300 {
                continue;
            }
            let theta = 0.5 * (2.0 * off).atan2(a.col(q)[q] - a.col(p)[p]);
            let (sine, cosine) = theta.sin_cos();
            let mut rotation = DMat3::IDENTITY;
            rotation.col_mut(p)[p] = cosine;
            rotation.col_mut(q)[q] = cosine;
            rotation.col_mut(q)[p] = sine;
            rotation.col_mut(p)[q] = -sine;
            a = rotation.transpose() * a * rotation;
            v *= rotation;
        }
    }
    (DVec3::new(a.x_axis.x, a.y_axis.y, a.z_axis.z), v)
}
