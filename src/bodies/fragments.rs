//! The pieces that bodies have broken into, each as a rigid whole: mass, motion, spin, size along its axes, speeds inside it.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use crate::math::principal;
use crate::snapshot::{ParticleSample, Snapshot};

/// Shares of the mass by speed: below 1/8, 2/8, ... of the largest speed of the frame.
pub const SPEEDS: usize = 8;

/// A piece at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fragment {
    /// Number: the smallest [`ParticleSample::index`] in it, see [`Snapshot::piece_of_each`].
    pub piece: u32,
    /// Body.
    pub body: u32,
    /// Its particles: places in [`Snapshot::particles`].
    pub particles: Vec<usize>,
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass \[m\].
    pub centre: [f64; 3],
    /// Mean velocity \[m s^-1\].
    pub velocity: [f64; 3],
    /// Angular velocity of a rigid piece with the same angular momentum \[s^-1\].
    pub spin: [f64; 3],
    /// Edges of the box with the same moments along its axes, longest first \[m\].
    pub size: [f64; 3],
    /// Volume as it is deformed \[m^3\].
    pub volume: f64,
    /// Mass by speed \[kg\], in [`SPEEDS`] equal parts up to the largest speed of any particle.
    pub speeds: [f64; SPEEDS],
}

impl Snapshot {
    /// The pieces of all bodies by their numbers; `piece_of_each` is [`Snapshot::piece_of_each`]. Broken particles away from all pieces
    /// are none.
    pub fn fragments(&self, piece_of_each: &[u32]) -> Vec<Fragment> {
        let mut all: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (index, piece) in piece_of_each.iter().enumerate() {
            all.entry(*piece).or_default().push(index);
        }
        let fastest = self.fastest();
        all.retain(|_, own| own.iter().any(|index| self.particles[*index].damage < 1.0));
        all.into_par_iter().map(|(piece, own)| self.fragment(piece, own, fastest)).collect()
    }

    /// Largest speed of any particle \[m s^-1\].
    pub fn fastest(&self) -> f64 {
        let speed = |particle: &ParticleSample| f64::from(glam::Vec3::from(particle.velocity).length());
        self.particles.iter().map(speed).fold(0.0, f64::max)
    }

    fn fragment(&self, piece: u32, own: Vec<usize>, fastest: f64) -> Fragment {
        let vector = |parts: [f32; 3]| DVec3::from(parts.map(f64::from));
        let particles = || own.iter().map(|index| &self.particles[*index]);
        let mass: f64 = particles().map(|particle| f64::from(particle.mass)).sum();
        let mean = |value: &dyn Fn(&ParticleSample) -> DVec3| {
            particles().map(|particle| value(particle) * f64::from(particle.mass)).sum::<DVec3>() / mass
        };
        let (centre, velocity) = (mean(&|one| self.place_of(one).into()), mean(&|one| vector(one.velocity)));
        let (mut moments, mut turning) = (DMat3::ZERO, DVec3::ZERO);
        let mut speeds = [0.0; SPEEDS];
        for particle in particles() {
            let (arm, own) = (DVec3::from(self.place_of(particle)) - centre, f64::from(particle.mass));
            // a particle is a cube itself: its share of the box, and of what turns
            let side =
                f64::from(particle.volume0 * particle.volume_ratio()).abs().powf(1.0 / f64::from(self.grid.dimension));
            let cube = DMat3::from_diagonal(self.extended(side * side / 12.0));
            moments += (DMat3::from_cols(arm * arm.x, arm * arm.y, arm * arm.z) + cube) * own;
            let spin = vector(particle.vorticity) * 0.5;
            turning += (arm.cross(vector(particle.velocity) - velocity) + spin * side * side / 6.0) * own;
            let part = (vector(particle.velocity).length() / fastest * SPEEDS as f64) as usize;
            speeds[part.min(SPEEDS - 1)] += own;
        }
        let inertia =
            DMat3::from_diagonal(DVec3::splat(moments.x_axis.x + moments.y_axis.y + moments.z_axis.z)) - moments;
        let spin = if inertia.determinant() > 0.0 { inertia.inverse() * turning } else { DVec3::ZERO };
        let size = principal(moments).map(|moment| (12.0 * moment / mass).max(0.0).sqrt());
        let body = particles().next().map_or(0, |particle| particle.body);
        let volume = particles().map(|particle| f64::from(particle.volume0 * particle.volume_ratio()).abs()).sum();
        let (centre, velocity, spin) = (centre.into(), velocity.into(), spin.into());
        Fragment { piece, body, particles: own, mass, centre, velocity, spin, size, volume, speeds }
    }

    /// A value along each axis that the scene has.
    fn extended(&self, value: f64) -> DVec3 {
        let along = |axis: u32| if axis < self.grid.dimension { value } else { 0.0 };
        DVec3::new(along(0), along(1), along(2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Grid;

    /// Two bars of 6 x 2 x 1 particles, the second turned by 30 degrees about z and turning with 2 rad/s about it.
    #[test]
    fn a_turning_bar_is_measured() {
        let mut particles = Vec::new();
        for k in 0..24_u32 {
            let bar = k / 12;
            let at = DVec3::new(f64::from(k % 6) - 2.5, f64::from(k % 12 / 6) - 0.5, 0.0) * 0.5;
            let turned = glam::DQuat::from_rotation_z(if bar == 1 { 0.5 } else { 0.0 }) * at;
            let speed = if bar == 1 { DVec3::Z.cross(turned) * 2.0 } else { DVec3::X };
            let place = turned + DVec3::new(5.0, 5.0 + 10.0 * f64::from(bar), 5.0);
            particles.push(ParticleSample {
                index: 100 - k,
                position: place.as_vec3().into(),
                velocity: speed.as_vec3().into(),
                vorticity: [0.0, 0.0, if bar == 1 { 4.0 } else { 0.0 }],
                mass: 2.0,
                volume0: 0.125,
                damage: if k == 23 { 1.0 } else { 0.0 },
                body: bar,
                ..ParticleSample::default()
            });
        }
        let grid = Grid { dimension: 3, cells: [32; 3], frame: [0.0; 3], origin: [0.0; 3], spacing: 1.0 };
        let snapshot = Snapshot::of_particles((0.0, 0), grid, particles);
        let fragments = snapshot.fragments(&snapshot.piece_of_each());
        assert_eq!(fragments.iter().map(|one| (one.piece, one.body)).collect::<Vec<_>>(), [(77, 1), (89, 0)]);
        let [turning, flying] = &fragments[..] else { panic!("two pieces") };
        assert_eq!((flying.mass, flying.velocity, turning.body), (24.0, [1.0, 0.0, 0.0], 1));
        assert!((turning.spin[2] - 2.0).abs() < 1e-6 && turning.spin[0].abs() < 1e-6, "{:?}", turning.spin);
        for one in [turning, flying] {
            let wanted = [3.0, 1.0, 0.5];
            assert!(one.size.iter().zip(wanted).all(|(size, wanted)| (size - wanted).abs() < 1e-5), "{:?}", one.size);
            assert!((one.speeds.iter().sum::<f64>() - one.mass).abs() < 1e-12);
        }
    }
}
