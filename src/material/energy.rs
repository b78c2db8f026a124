//! Elastic energy on the host, by the same laws as on the device.

use glam::{DMat3, DVec3};

use super::{GHOST_STIFFENING, KINDS, MaterialParams};
use crate::math::principal;

/// Below this the ghost pressure of a volume grows no further, as on the device.
const LEAST_SWELLING: f64 = -0.9;

/// Energy of a law without plastic flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hyperelastic {
    /// mu/2 (tr(F F^T) - 3) - mu ln J + lambda/2 (ln J)^2.
    NeoHookean,
    /// mu |F - R|^2 + lambda/2 (J - 1)^2, R the rotation of F. [Stomakhin et al. 2012]
    FixedCorotated,
    /// mu tr(e^2) + lambda/2 (tr e)^2, e = ln(F F^T) / 2.
    Hencky,
}

/// What an energy follows from.
#[derive(Clone, Copy, Debug)]
pub struct Strained {
    /// F F^T - 1.
    strain: DMat3,
    /// J - 1.
    swelling: f64,
}

impl Strained {
    /// By a displacement gradient F - 1, columns.
    #[must_use]
    pub fn of(columns: [[f64; 3]; 3]) -> Self {
        let h = DMat3::from_cols_array_2d(&columns);
        let minor = |a: usize, b: usize| columns[a][a] * columns[b][b] - columns[a][b] * columns[b][a];
        let trace = columns[0][0] + columns[1][1] + columns[2][2];
        let swelling = trace + minor(0, 1) + minor(0, 2) + minor(1, 2) + h.determinant();
        Self { strain: h + h.transpose() + h * h.transpose(), swelling }
    }

    /// Stretches along the principal axes less 1.
    fn stretch(&self) -> DVec3 {
        DVec3::from(
            principal(self.strain).map(|square| square.max(-1.0)).map(|square| square / (1.0 + (1.0 + square).sqrt())),
        )
    }

    /// Logarithms of the stretches.
    fn logarithm(&self) -> DVec3 {
        DVec3::from(principal(self.strain).map(|square| 0.5 * square.max(1e-12 - 1.0).ln_1p()))
    }
}

impl Hyperelastic {
    /// Energy per volume at rest \[J m^-3\], of Lame's constants `[mu, lambda]`; 0 of what is turned inside out.
    fn energy(self, [mu, lambda]: [f64; 2], strained: &Strained) -> f64 {
        let swelling = strained.swelling;
        match self {
            Self::FixedCorotated => mu * strained.stretch().length_squared() + 0.5 * lambda * swelling * swelling,
            _ if swelling <= -1.0 => 0.0,
            Self::NeoHookean => {
                let (logarithm, s) = (swelling.ln_1p(), strained.strain);
                mu * (0.5 * (s.x_axis.x + s.y_axis.y + s.z_axis.z) - logarithm) + 0.5 * lambda * logarithm * logarithm
            }
            Self::Hencky => {
                let strain = strained.logarithm();
                let volume = strain.element_sum();
                mu * strain.length_squared() + 0.5 * lambda * volume * volume
            }
        }
    }

    /// Principal stresses of Kirchhoff \[Pa\].
    fn stress(self, [mu, lambda]: [f64; 2], strained: &Strained) -> DVec3 {
        let swelling = strained.swelling;
        match self {
            Self::FixedCorotated => {
                let stretch = strained.stretch();
                2.0 * mu * stretch * (1.0 + stretch) + lambda * swelling * (1.0 + swelling)
            }
            _ if swelling <= -1.0 => DVec3::ZERO,
            Self::NeoHookean => mu * DVec3::from(principal(strained.strain)) + lambda * swelling.ln_1p(),
            Self::Hencky => {
                let strain = strained.logarithm();
                2.0 * mu * strain + lambda * strain.element_sum()
            }
        }
    }
}

/// The laws of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Laws {
    /// Its materials.
    pub materials: Vec<MaterialParams>,
    /// Pressure that bodies start with \[Pa\].
    pub start: f64,
    /// Whether body and gas share one pressure, so that the elastic force bears nothing of the ghost pressure.
    pub shared: bool,
}

impl Laws {
    /// Elastic energy per volume at rest without that of the ghost pressure, less what damage takes of it \[J m^-3\]; 0 of a material that
    /// is not known.
    #[must_use]
    pub fn elastic_energy(&self, material: u32, strained: &Strained, q: f64, damage: f64) -> f64 {
        let Some(own) = self.materials.get(material as usize) else { return 0.0 };
        let Some(kind) = KINDS.get(own.kind as usize) else { return 0.0 };
        let constants = [own.mu, own.elastic_lambda].map(f64::from);
        let whole = kind.energy.energy(constants, strained);
        if damage > 0.0 { whole - damage * self.tension(own, strained, q) } else { whole }
    }

    /// The energy that tension holds per volume at rest \[J m^-3\]: of what law and ghost pressure hold from the start pressure on, the share
    /// of the positive principal stresses by their strains.
    fn tension(&self, own: &MaterialParams, strained: &Strained, q: f64) -> f64 {
        let kind = KINDS[own.kind as usize];
        let [mu, part, ghost] = [own.mu, own.elastic_lambda, own.ghost_modulus].map(f64::from);
        let volume = if kind.keeps_volume {
            1.0 + strained.swelling.max(LEAST_SWELLING)
        } else {
            own.logarithm_by_ghost(q, self.start).exp()
        };
        let mut stress = kind.energy.stress([mu, part], strained) - volume * (q - self.start);
        if kind.keeps_volume && !self.shared {
            stress += volume * (q - own.ghost_pressure(volume, self.start));
        }
        let lambda = part + ghost;
        let strain = (stress - lambda * stress.element_sum() / (3.0 * lambda + 2.0 * mu)) / (2.0 * mu);
        // what breaks by voids gives up its deviator, too
        let mean = stress.element_sum() / 3.0;
        let pull = if own.void_softening > 0.0 { stress - mean.min(0.0) } else { stress.max(DVec3::ZERO) };
        let share = pull.dot(strain) / stress.dot(strain).max(1e-30);
        let ghost = own.ghost_energy(volume, q, self.start) + self.start * (volume - 1.0);
        share * (kind.energy.energy([mu, part], strained) + ghost)
    }
}

impl MaterialParams {
    /// The ghost pressure of a volume ratio \[Pa\], of a body that starts with the pressure `start`.
    fn ghost_pressure(&self, volume_ratio: f64, start: f64) -> f64 {
        let (n, modulus, logarithm) = (GHOST_STIFFENING, f64::from(self.ghost_modulus), volume_ratio.ln());
        start + modulus * if logarithm < 0.0 { (-n * logarithm).exp_m1() / n } else { -logarithm }
    }

    /// Logarithm of the volume ratio that a ghost pressure tells of.
    fn logarithm_by_ghost(&self, q: f64, start: f64) -> f64 {
        let over = (q - start) / f64::from(self.ghost_modulus);
        if over > 0.0 { -(GHOST_STIFFENING * over).ln_1p() / GHOST_STIFFENING } else { -over }
    }

    /// Energy of the ghost pressure per volume at rest, minus the integral of q dJ, of a body that starts with the pressure `start`
    /// \[J m^-3\]. By its volume ratio J q is start + K (J^-7 - 1) / 7 in compression and start - K ln J in tension, K = `ghost_modulus`.
    /// Where plastic flow changes the volume, so that the deformation gradient does not know it, q tells J.
    #[must_use]
    pub fn ghost_energy(&self, volume_ratio: f64, q: f64, start: f64) -> f64 {
        let keeps_volume = KINDS.get(self.kind as usize).is_some_and(|kind| kind.keeps_volume);
        let (n, modulus) = (GHOST_STIFFENING, f64::from(self.ghost_modulus));
        let logarithm = if keeps_volume { volume_ratio.ln() } else { self.logarithm_by_ghost(q, start) };
        let swelling = logarithm.exp_m1();
        let shape = match swelling < 0.0 {
            true => ((-(n - 1.0) * logarithm).exp_m1() / (n - 1.0) + swelling) / n,
            false => (1.0 + swelling) * logarithm - swelling,
        };
        modulus * shape - start * swelling
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Material, VolumeShare};

    /// Laws with mu = 100, lambda = 300 that the law alone bears, and next to no ghost pressure.
    fn laws() -> Laws {
        let own = |kind: &str| {
            let (young, poisson) = (100.0 * (900.0 + 200.0) / 400.0, 300.0 / 800.0);
            let mut given = vec![("young_modulus", young), ("poisson_ratio", poisson), ("ghost_modulus", 1e-9)];
            if ["von_mises", "hencky"].contains(&kind) {
                given.push(("yield_stress", 1e9));
            }
            let given: Vec<_> = given.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
            let material = Material::new(kind, &given).unwrap_or_else(|error| panic!("{error}"));
            material.params(VolumeShare::Split(1.0))
        };
        Laws { materials: KINDS.iter().map(|kind| own(kind.name)).collect(), start: 1.0, shared: false }
    }

    /// A block that is 1.3 times as long, 0.9 as wide and as high as before, and then turned.
    #[test]
    fn the_energy_of_a_stretched_block() {
        let stretched = DMat3::from_diagonal(DVec3::new(1.3, 0.9, 1.0));
        let turned = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, 0.7) * stretched;
        let volume: f64 = 1.3 * 0.9;
        let (a, b) = (1.3_f64.ln(), 0.9_f64.ln());
        let rubber = 50.0 * (1.69 + 0.81 - 2.0) - 100.0 * volume.ln() + 150.0 * volume.ln().powi(2);
        let corotated = 100.0 * (0.09 + 0.01) + 150.0 * (volume - 1.0).powi(2);
        let hencky = 100.0 * (a * a + b * b) + 150.0 * (a + b).powi(2);
        let right = [rubber, rubber, corotated, hencky, hencky];
        for ((number, kind), right) in (0..).zip(KINDS).zip(right) {
            for f in [stretched, turned] {
                let strained = Strained::of((f - DMat3::IDENTITY).to_cols_array_2d());
                let ours = laws().elastic_energy(number, &strained, 1.0, 0.0);
                assert!((ours / right - 1.0).abs() < 1e-6, "{}: {ours}, not {right}", kind.name);
            }
        }
    }

    /// What is broken keeps what compression holds, and half damaged holds half of tension, however large.
    #[test]
    fn damage_takes_the_energy_of_tension() {
        let along = |strain: f64| Strained::of([[strain, 0.0, 0.0], [0.0; 3], [0.0; 3]]);
        for (number, kind) in (0..).zip(KINDS) {
            let energy = |strain: f64, damage: f64| laws().elastic_energy(number, &along(strain), 1.0, damage);
            for strain in [1e-5, 0.3] {
                let right = energy(strain, 0.0);
                if strain < 1e-3 {
                    assert!(
                        (right / (0.5 * (300.0 + 2.0 * 100.0) * strain * strain) - 1.0).abs() < 1e-4,
                        "{}: {right}",
                        kind.name
                    );
                }
                for (sign, damage, share) in
                    [(1.0, 0.5, 0.5), (1.0, 1.0, 0.0), (-1.0, 1.0, energy(-strain, 0.0) / right)]
                {
                    let ours = energy(sign * strain, damage);
                    assert!((ours - share * right).abs() < 1e-4 * right, "{}: {strain} {damage}: {ours}", kind.name);
                }
            }
        }
    }
}
