//! The bodies of a scene as wholes: where they are, how they move, how many pieces they have broken into.

mod fragments;

use rayon::prelude::*;
use serde::Serialize;

use crate::material::Strained;
use crate::snapshot::{ParticleSample, Snapshot};
pub use fragments::{Fragment, SPEEDS};

/// One body at one time. Values are those of the particles that are still inside the domain.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct BodyState {
    /// Particles.
    pub particles: u64,
    /// Mass \[kg\].
    pub mass: f64,
    /// Volume of the particles at rest \[m^3\].
    pub volume0: f64,
    /// Centre of mass \[m\].
    pub centroid: [f64; 3],
    /// Mean velocity, weighted by mass \[m s^-1\].
    pub velocity: [f64; 3],
    /// Angular momentum about the centre of mass \[kg m^2 s^-1\], with that of the affine motion around each particle, as
    /// transfers between particles and grid keep it. [Jiang et al. 2015]
    pub angular_momentum: [f64; 3],
    /// Largest equivalent plastic strain.
    pub plastic_strain: f64,
    /// Its mean, weighted by mass.
    pub mean_plastic_strain: f64,
    /// Largest norm of the elastic strain of Green and Lagrange, (F^T F - 1) / 2, of what has not broken.
    pub elastic_strain: f64,
    /// Largest deviatoric stress of what has not broken, sqrt(3/2 s:s) \[Pa\].
    pub deviatoric_stress: f64,
    /// Kinetic energy of the particles, that of the affine motion around them included \[J\].
    pub kinetic_energy: f64,
    /// Elastic energy of the particles, less what damage takes of it, without that of the ghost pressure \[J\]; 0 if the snapshot knows
    /// no laws.
    pub elastic_energy: f64,
    /// Mass of the particles that have broken \[kg\].
    pub broken_mass: f64,
    /// Low and high corner of the box around the particles \[m\].
    pub extent: [[f64; 3]; 2],
    /// Room over volume at rest: the mean of the volume ratio, or the cells that hold particles where they are less.
    pub room: f64,
    /// Pieces: groups of particles that are not broken, in cells that touch, corners included.
    pub pieces: u32,
}

impl Snapshot {
    /// The first `count` bodies of the scene.
    pub fn bodies(&self, count: usize) -> Vec<BodyState> {
        let empty = BodyState { extent: [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]], ..BodyState::default() };
        let mut bodies = vec![empty; count];
        for particle in &self.particles {
            if let Some(body) = bodies.get_mut(particle.body as usize) {
                body.add(particle, self.grid.spacing.into());
            }
        }
        for (particle, energy) in self.particles.iter().zip(self.elastic_energies()) {
            if let Some(body) = bodies.get_mut(particle.body as usize) {
                body.elastic_energy += energy;
            }
        }
        let cell = f64::from(self.grid.spacing).powi(self.grid.dimension as i32);
        for (body, (pieces, cells)) in bodies.iter_mut().zip(self.pieces(count)) {
            body.pieces = pieces;
            body.finish(cell * f64::from(cells), self.grid.frame);
        }
        bodies
    }

    /// Elastic energy of each particle \[J\].
    fn elastic_energies(&self) -> Vec<f64> {
        let energy = |own: &ParticleSample| {
            let strained = Strained::of(own.displacement_gradient.map(|column| column.map(f64::from)));
            let density =
                self.laws.elastic_energy(own.material, &strained, own.ghost_pressure.into(), own.damage.into());
            f64::from(own.volume0) * density
        };
        self.particles.par_iter().map(energy).collect()
    }

    /// Pieces of each body: connected groups of cells that hold particles of it that are not broken; and the number of cells with any.
    fn pieces(&self, count: usize) -> Vec<(u32, u32)> {
        let (places, roots) = self.groups();
        let mut pieces = vec![(0, 0); count];
        for (index, (body, _)) in places.iter().enumerate() {
            if let Some((pieces, _)) = pieces.get_mut(*body as usize) {
                *pieces += u32::from(roots[index] == index);
            }
        }
        let mut held: Vec<_> = self.particles.iter().map(|particle| self.place(particle)).collect();
        held.sort_unstable();
        held.dedup();
        for (body, _) in held {
            if let Some((_, cells)) = pieces.get_mut(body as usize) {
                *cells += 1;
            }
        }
        pieces
    }

    /// The piece that each particle belongs to, by the smallest [`ParticleSample::index`] in it: a piece keeps its number while it is
    /// one, and of those that it splits into one keeps it. Broken particles away from all pieces have their own.
    pub fn piece_of_each(&self) -> Vec<u32> {
        let (places, roots) = self.groups();
        let root = |particle: &ParticleSample| places.binary_search(&self.place(particle)).ok().map(|at| roots[at]);
        let own: Vec<Option<usize>> = self.particles.par_iter().map(root).collect();
        let mut smallest = vec![u32::MAX; places.len()];
        for (particle, root) in self.particles.iter().zip(&own) {
            if let Some(root) = *root {
                smallest[root] = particle.index.min(smallest[root]);
            }
        }
        let particles = self.particles.iter().zip(own);
        particles.map(|(particle, root)| root.map_or(particle.index, |root| smallest[root])).collect()
    }

    /// Body and cell of a particle.
    fn place(&self, particle: &ParticleSample) -> (u32, [i32; 3]) {
        let grid = &self.grid;
        let at = |axis: usize| ((particle.position[axis] - grid.origin[axis]) / grid.spacing).floor() as i32;
        let axis = |axis: usize| at(axis).clamp(0, grid.cells[axis] as i32 - 1);
        (particle.body, [axis(2), axis(1), axis(0)])
    }

    /// Cells that hold particles that are not broken, body by body, and the first of those that each hangs together with.
    fn groups(&self) -> (Vec<(u32, [i32; 3])>, Vec<usize>) {
        let mut places: Vec<_> =
            self.particles.par_iter().filter(|one| one.damage < 1.0).map(|one| self.place(one)).collect();
        places.par_sort_unstable();
        places.dedup();
        let mut groups = Groups::of(places.len());
        // The 13 neighbours that come before a cell in the order of `places`; each goes through that order as the cell does.
        let mut others = [0; 13];
        for (index, &(body, [z, y, x])) in places.iter().enumerate() {
            for (offset, other) in (0..).zip(&mut others) {
                let near = (body, [z + offset / 9 - 1, y + offset / 3 % 3 - 1, x + offset % 3 - 1]);
                while places[*other] < near {
                    *other += 1;
                }
                if places[*other] == near {
                    groups.join(index, *other);
                }
            }
        }
        let roots = (0..places.len()).map(|index| groups.root(index)).collect();
        (places, roots)
    }
}

impl BodyState {
    fn add(&mut self, particle: &ParticleSample, spacing: f64) {
        let mass = f64::from(particle.mass);
        let (arm, speed) = (particle.position.map(f64::from), particle.velocity.map(f64::from));
        self.plastic_strain = self.plastic_strain.max(particle.plastic_strain.into());
        self.mean_plastic_strain += mass * f64::from(particle.plastic_strain);
        self.kinetic_energy += f64::from(particle.kinetic_energy);
        if particle.damage < 1.0 {
            self.elastic_strain = self.elastic_strain.max(particle.elastic_strain().into());
            self.deviatoric_stress = self.deviatoric_stress.max(particle.deviatoric_stress().into());
        } else {
            self.broken_mass += mass;
        }
        self.particles += 1;
        self.mass += mass;
        self.volume0 += f64::from(particle.volume0);
        self.room += f64::from(particle.volume0 * particle.volume_ratio());
        for axis in 0..3 {
            let position = arm[axis];
            self.centroid[axis] += mass * position;
            self.velocity[axis] += mass * speed[axis];
            let own = 0.25 * spacing * spacing * f64::from(particle.vorticity[axis]);
            self.angular_momentum[axis] += mass * (cross(arm, speed)[axis] + own);
            self.extent[0][axis] = self.extent[0][axis].min(position);
            self.extent[1][axis] = self.extent[1][axis].max(position);
        }
    }

    /// Sums to means, in the coordinates of the scene, in which those of the device have their zero at `frame`; a body that has left the
    /// domain is nowhere. `cells` is the volume of the cells that hold particles \[m^3\].
    fn finish(&mut self, cells: f64, frame: [f64; 3]) {
        self.room = self.room.min(cells) / self.volume0;
        self.centroid = self.centroid.map(|sum| sum / self.mass);
        self.velocity = self.velocity.map(|sum| sum / self.mass);
        self.mean_plastic_strain /= self.mass;
        let whole = cross(self.centroid, self.velocity);
        for (sum, orbit) in self.angular_momentum.iter_mut().zip(whole) {
            *sum -= self.mass * orbit;
        }
        for axis in 0..3 {
            self.centroid[axis] += frame[axis];
            self.extent.iter_mut().for_each(|corner| corner[axis] += frame[axis]);
        }
        if self.particles == 0 {
            self.extent = [[f64::NAN; 3]; 2];
        }
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    glam::DVec3::from(a).cross(glam::DVec3::from(b)).into()
}

/// Disjoint groups of indices: each entry names another member of its group, the root itself. [Tarjan 1975]
#[derive(Debug)]
pub(crate) struct Groups(Vec<usize>);

impl Groups {
    /// So many groups of one.
    pub(crate) fn of(count: usize) -> Self {
        Self((0..count).collect())
    }

    /// The root of a member's group.
    pub(crate) fn root(&mut self, mut index: usize) -> usize {
        while self.0[index] != index {
            self.0[index] = self.0[self.0[index]];
            index = self.0[index];
        }
        index
    }

    /// Makes one group of two.
    pub(crate) fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Grid;

    fn snapshot(particles: &[(u32, [f32; 3])]) -> Snapshot {
        let sample = |&(body, position): &(u32, [f32; 3])| ParticleSample {
            position,
            velocity: [1.0, 0.0, 0.0],
            vorticity: [0.0, 0.0, 4.0],
            mass: 2.0,
            body,
            ..ParticleSample::default()
        };
        let grid = Grid { dimension: 3, cells: [8; 3], frame: [0.0; 3], origin: [0.0; 3], spacing: 1.0 };
        Snapshot::of_particles((0.0, 0), grid, particles.iter().map(sample).collect())
    }

    /// What has broken bears nothing.
    #[test]
    fn strain_stress_and_energy_of_a_body() {
        let particle = |k: usize| ParticleSample {
            mass: [1.0, 3.0, 4.0][k],
            kinetic_energy: 0.5,
            plastic_strain: [0.4, 0.0, 0.0][k],
            damage: [0.0, 0.0, 1.0][k],
            deformation: [[1.0, 0.0, 0.0], [0.0, 1.2, 0.0], [0.0, 0.0, 1.0 + k as f32]],
            stress: [5.0 * k as f32, 0.0, 0.0, 0.0, 0.0, 0.0],
            ..ParticleSample::default()
        };
        let grid = Grid { dimension: 3, cells: [8; 3], frame: [0.0; 3], origin: [0.0; 3], spacing: 1.0 };
        let state = Snapshot::of_particles((0.0, 0), grid, (0..3).map(particle).collect());
        let [body] = &state.bodies(1)[..] else { panic!("one body") };
        let near = |ours: f64, right: f64| assert!((ours - right).abs() < 1e-6, "{ours}, not {right}");
        // E has 0.22 along y, and 1.5 along z in the second particle
        near(body.elastic_strain, 0.22f64.hypot(1.5));
        near(body.deviatoric_stress, 5.0);
        near(body.plastic_strain, 0.4);
        near(body.mean_plastic_strain, 0.05);
        assert_eq!((body.kinetic_energy, body.broken_mass), (1.5, 4.0));
    }

    #[test]
    fn pieces_touch_at_corners_and_bodies_stay_apart() {
        let state = snapshot(&[
            (0, [0.5, 0.5, 0.5]),
            (0, [1.5, 1.5, 1.5]),
            (0, [2.5, 0.5, 2.5]),
            (0, [5.5, 5.5, 5.5]),
            (1, [0.5, 0.5, 1.5]),
        ]);
        let bodies = state.bodies(3);
        assert_eq!(bodies.iter().map(|body| body.pieces).collect::<Vec<_>>(), [2, 1, 0]);
        assert_eq!(bodies[0].centroid, [2.5, 2.0, 2.5]);
        assert_eq!(bodies[0].extent, [[0.5; 3], [5.5; 3]]);
        assert_eq!((bodies[0].mass, bodies[0].velocity), (8.0, [1.0, 0.0, 0.0]));
        // velocities are equal: what is left is each particle's own m dx^2 / 4 times its vorticity
        assert!((glam::DVec3::from(bodies[0].angular_momentum) - glam::DVec3::new(0.0, 0.0, 8.0)).length() < 1e-12);
        assert!(bodies[2].particles == 0 && bodies[2].centroid[0].is_nan());
    }
}
