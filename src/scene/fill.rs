//! From shapes to cells and particles.

use std::ops::{ControlFlow, Range};

use super::{Body, GasState, Scene, Shape};

/// Sub-samples per axis in cells that the surface of a region crosses.
const SAMPLES: u32 = 4;

/// A particle at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seed {
    /// Position `[m]`.
    pub position: [f64; 3],
    /// Velocity `[m s^-1]`.
    pub velocity: [f64; 3],
    /// Angular velocity `[rad s^-1]`.
    pub spin: [f64; 3],
    /// Volume `[m^3]`, with unit thickness along inactive axes.
    pub volume: f64,
    /// Density `[kg m^-3]`.
    pub density: f64,
    /// Whether it is clamped or moves as prescribed.
    pub driven: bool,
    /// Index of the body in the scene.
    pub body: u32,
    /// Index of the material among the sorted names.
    pub material: u32,
}

/// What is done at a point; a break ends the walk.
type Visit<'a> = dyn FnMut([f64; 3]) -> ControlFlow<()> + 'a;

impl Scene {
    /// Density, momentum and energy per volume of every cell, x fastest, without padding.
    ///
    /// A cell that the surface of a region crosses, and every cell under waves or vortices, holds the mean over 4^dimension
    /// points; every other cell is exact.
    #[must_use]
    pub fn initial_gas(&self) -> Vec<[f64; 5]> {
        let gamma = self.gas.gamma;
        if !self.gas.waves.is_empty() || !self.gas.vortices.is_empty() {
            return self.each_cell(|center| self.mean_over(center, |point| self.gas_at(point).conserved(gamma)));
        }
        let ambient = self.gas.ambient.conserved(gamma);
        let states = self.gas.regions.iter().map(|region| region.state.conserved(gamma)).collect::<Vec<_>>();
        let reach = self.cell_radius();
        self.each_cell(|center| {
            let mut state = ambient;
            let mut mixed = false;
            for (region, inside) in self.gas.regions.iter().zip(&states) {
                let distance = region.shape.distance(center);
                mixed = if distance < -reach { false } else { mixed || distance < reach };
                if distance < 0.0 {
                    state = *inside;
                }
            }
            if mixed { self.mean_state(center, &ambient, &states) } else { state }
        })
    }

    /// Mean over regular points of a cell, the last region at each point.
    fn mean_state(&self, center: [f64; 3], ambient: &[f64; 5], states: &[[f64; 5]]) -> [f64; 5] {
        self.mean_over(center, |point| {
            let last = self.gas.regions.iter().zip(states).rev().find(|(region, _)| region.shape.distance(point) < 0.0);
            *last.map_or(ambient, |(_, state)| state)
        })
    }

    /// Mean of a state over regular points of a cell.
    fn mean_over(&self, center: [f64; 3], state: impl Fn([f64; 3]) -> [f64; 5]) -> [f64; 5] {
        let mut sum = [0.0; 5];
        let points = lattice(self.domain.axes(), SAMPLES);
        for offset in &points {
            let point = std::array::from_fn(|d| center[d] + offset[d] * self.domain.spacing());
            for (total, entry) in sum.iter_mut().zip(state(point)) {
                *total += entry;
            }
        }
        sum.map(|total| total / points.len() as f64)
    }

    /// The mean over the part of a cell that lies outside of the obstacles.
    #[must_use]
    pub fn initial_gas_beside_obstacles(&self, cell: [u32; 3]) -> [f64; 5] {
        let center = self.domain.cell_center(cell);
        let place = |offset: [f64; 3]| std::array::from_fn(|d| center[d] + offset[d] * self.domain.spacing());
        let points: Vec<[f64; 3]> = lattice(self.domain.axes(), SAMPLES).into_iter().map(place).collect();
        let outside: Vec<[f64; 3]> = points.iter().copied().filter(|&point| !self.inside_obstacle(point)).collect();
        let seen = if outside.is_empty() { points } else { outside };
        let mut sum = [0.0; 5];
        for &point in &seen {
            let state = self.gas_at(point).conserved(self.gas.gamma);
            sum = std::array::from_fn(|k| sum[k] + state[k]);
        }
        sum.map(|total| total / seen.len() as f64)
    }

    /// Which cells are obstacle: those whose centre lies inside one. x fastest, without padding.
    #[must_use]
    pub fn obstacle_cells(&self) -> Vec<bool> {
        self.each_cell(|center| self.inside_obstacle(center))
    }

    /// The particles of all bodies on a regular lattice. A point in several bodies belongs to the first; obstacles come before bodies.
    #[must_use]
    pub fn seed_particles(&self) -> Vec<Seed> {
        (0..self.bodies.len()).flat_map(|index| self.seed_particles_of(index)).collect()
    }

    /// Those of one body.
    pub(super) fn seed_particles_of(&self, index: usize) -> impl Iterator<Item = Seed> + use<> {
        let body = &self.bodies[index];
        let per_cell = f64::from(body.particles_per_cell).powi(self.domain.dimension as i32);
        let mut seeds = Vec::new();
        let _ = self.each_particle(index, &mut |position| {
            seeds.push(Seed {
                position,
                velocity: body.velocity,
                spin: body.spin,
                volume: self.domain.cell_volume() / per_cell,
                density: body.density,
                driven: false,
                body: index as u32,
                material: self.material_index(&body.material).unwrap_or(0),
            });
            ControlFlow::Continue(())
        });
        turn(&mut seeds);
        drive(body, &mut seeds);
        seeds.into_iter()
    }

    /// How many particles [`Scene::seed_particles`] makes, without making them.
    #[must_use]
    pub fn particle_count(&self) -> usize {
        let mut count = 0;
        for index in 0..self.bodies.len() {
            let _ = self.each_particle(index, &mut |_| {
                count += 1;
                ControlFlow::Continue(())
            });
        }
        count
    }

    /// True if a body gets at least one particle.
    pub(super) fn has_particles(&self, index: usize) -> bool {
        self.each_particle(index, &mut |_| ControlFlow::Break(())).is_break()
    }

    /// Visits the lattice points that belong to a body, cell by cell.
    fn each_particle(&self, index: usize, visit: &mut Visit<'_>) -> ControlFlow<()> {
        let body = &self.bodies[index];
        let spacing = self.domain.spacing();
        let offsets = lattice(self.domain.axes(), body.particles_per_cell);
        self.each_cell_near(&body.shape, &mut |center| {
            let whole = self.owns_cell(index, center);
            for offset in &offsets {
                let point = std::array::from_fn(|d| center[d] + offset[d] * spacing);
                if whole || self.owner(point) == Some(index) {
                    visit(point)?;
                }
            }
            ControlFlow::Continue(())
        })
    }

    /// From the centre to the corners of a cell \[m\].
    fn cell_radius(&self) -> f64 {
        0.5 * self.domain.spacing() * f64::from(self.domain.dimension).sqrt()
    }

    /// Whether all of a cell belongs to a body. Distances are nowhere steeper than 1.
    fn owns_cell(&self, index: usize, center: [f64; 3]) -> bool {
        let radius = self.cell_radius();
        let far = |shape: &Shape| shape.distance(center) > radius;
        self.bodies[index].shape.distance(center) < -radius
            && self.bodies[..index].iter().all(|body| far(&body.shape))
            && self.obstacles.iter().all(|obstacle| far(&obstacle.shape))
    }

    /// The body that a point belongs to: the first that holds it; none inside obstacles.
    fn owner(&self, point: [f64; 3]) -> Option<usize> {
        let first = self.bodies.iter().position(|body| body.shape.distance(point) < 0.0);
        first.filter(|_| !self.inside_obstacle(point))
    }

    fn inside_obstacle(&self, point: [f64; 3]) -> bool {
        self.obstacles.iter().any(|obstacle| obstacle.shape.distance(point) < 0.0)
    }

    /// One value per cell from its centre, x fastest.
    fn each_cell<T>(&self, mut value: impl FnMut([f64; 3]) -> T) -> Vec<T> {
        let [nx, ny, nz] = self.domain.cells;
        let mut values = Vec::with_capacity(self.domain.cell_count());
        for z in 0..nz {
            for y in 0..ny {
                for x in 0..nx {
                    values.push(value(self.domain.cell_center([x, y, z])));
                }
            }
        }
        values
    }

    /// Visits the centres of all cells that a shape may touch, x fastest.
    fn each_cell_near(&self, shape: &Shape, visit: &mut Visit<'_>) -> ControlFlow<()> {
        let (low, high) = shape.bounds();
        let range = |d: usize| {
            if d >= self.domain.axes() {
                return 0..1;
            }
            let cell = |x: f64| {
                let at = ((x - self.domain.origin[d]) / self.domain.spacing()).floor();
                at.clamp(0.0, f64::from(self.domain.cells[d] - 1)) as u32
            };
            cell(low[d])..cell(high[d]) + 1
        };
        for z in range(2) {
            for y in range(1) {
                self.row_near(shape, range(0), [y, z], visit)?;
            }
        }
        ControlFlow::Continue(())
    }

    /// The same for a part of a row along x: halved until it is one cell, and dropped where the shape is too far away.
    fn row_near(&self, shape: &Shape, row: Range<u32>, [y, z]: [u32; 2], visit: &mut Visit<'_>) -> ControlFlow<()> {
        let first = self.domain.cell_center([row.start, y, z]);
        let half = 0.5 * f64::from(row.end - row.start - 1) * self.domain.spacing();
        if shape.distance([first[0] + half, first[1], first[2]]) > half + self.cell_radius() {
            return ControlFlow::Continue(());
        }
        if row.len() == 1 {
            return visit(first);
        }
        let middle = row.start.midpoint(row.end);
        self.row_near(shape, row.start..middle, [y, z], visit)?;
        self.row_near(shape, middle..row.end, [y, z], visit)
    }

    /// Initial state at a point.
    #[must_use]
    pub fn gas_at(&self, point: [f64; 3]) -> GasState {
        let last = self.gas.regions.iter().rev().find(|region| region.shape.distance(point) < 0.0);
        let mut state = last.map_or(self.gas.ambient, |region| region.state);
        for wave in &self.gas.waves {
            wave.add(&mut state, point);
        }
        for vortex in &self.gas.vortices {
            vortex.add(&mut state, self.gas.gamma, point);
        }
        state
    }
}

/// Adds what a body's spin gives to the velocities of its particles: spin x (position - centre).
fn turn(seeds: &mut [Seed]) {
    let count = seeds.len() as f64;
    let center: [f64; 3] = std::array::from_fn(|d| seeds.iter().map(|seed| seed.position[d]).sum::<f64>() / count);
    for seed in seeds {
        let arm: [f64; 3] = std::array::from_fn(|d| seed.position[d] - center[d]);
        for (d, (a, b)) in [(1, 2), (2, 0), (0, 1)].into_iter().enumerate() {
            seed.velocity[d] += seed.spin[a] * arm[b] - seed.spin[b] * arm[a];
        }
    }
}

/// Gives the driven part of a body its prescribed motion.
fn drive(body: &Body, seeds: &mut [Seed]) {
    let start = body.driven_motion()[0];
    let about = body.motion.as_ref().map_or([0.0; 3], |motion| motion.about);
    for seed in seeds.iter_mut().filter(|seed| body.drives(seed.position)) {
        let arm = glam::DVec3::from(seed.position) - glam::DVec3::from(about);
        seed.driven = true;
        seed.velocity = (glam::DVec3::from(start.velocity) + glam::DVec3::from(start.spin).cross(arm)).into();
        seed.spin = start.spin;
    }
}

/// `count` regular points per axis of the unit cell around 0; 0 along inactive axes. x fastest.
fn lattice(axes: usize, count: u32) -> Vec<[f64; 3]> {
    let total = count.pow(axes as u32);
    let offset = |index: u32, d: usize| {
        if d < axes { (f64::from(index / count.pow(d as u32) % count) + 0.5) / f64::from(count) - 0.5 } else { 0.0 }
    };
    (0..total).map(|index| std::array::from_fn(|d| offset(index, d))).collect()
}
