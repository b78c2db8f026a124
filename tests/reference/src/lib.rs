//! CPU twins: one step as plain loops over slices in f64. Same stages, same index space as the GPU code.

pub mod ablation;
pub mod ars222;
pub mod boundary;
pub mod gas;
pub mod grid;
pub mod interface;
pub mod numerics;
pub mod solid;
pub mod solve;
pub mod step;

use std::collections::HashMap;

use glam::{DMat3, DVec3};
use grid::Grid;
pub use numerics::{Numerics, Pair, Shared, Weno};

/// Cell holds gas.
pub const GAS: u32 = 0;
/// Cell belongs to a moving solid.
pub const SOLID: u32 = 1;
/// Static obstacle, or outside of a wall side.
pub const WALL: u32 = 2;
/// Outside of an inlet or outlet.
pub const GHOST: u32 = 3;

/// One side of the domain, by the quantities of the scene's keys of the same names.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug)]
pub enum Side {
    /// Slip wall.
    Wall,
    /// Prescribed state.
    Inlet { density: f64, velocity: [f64; 3], pressure: f64 },
    /// Density and velocity prescribed.
    Subsonic { density: f64, velocity: [f64; 3] },
    /// Total density and pressure.
    Total { density: f64, pressure: f64 },
    /// Sound leaves, and the pressure drifts to a far one.
    Pressure { pressure: f64, relaxation: f64 },
    /// A share of a far state beyond the side.
    Attenuated { density: f64, velocity: [f64; 3], pressure: f64, attenuation: f64 },
    /// Undisturbed gas beyond the side.
    Far { density: f64, velocity: [f64; 3], pressure: f64 },
    /// The other end of the axis.
    Periodic,
}

impl Side {
    /// Undisturbed gas of density, velocity and pressure.
    pub fn far((density, velocity, pressure): (f64, [f64; 3], f64)) -> Self {
        Self::Far { density, velocity, pressure }
    }
}

/// Everything that stays fixed during a run.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Cells of the domain.
    pub grid: Grid,
    /// Ratio of specific heats.
    pub gamma: f64,
    /// x_min, x_max, y_min, ...
    pub sides: [Side; 6],
    /// What lies beyond instead, by ring slot.
    pub beyond: HashMap<usize, Side>,
    /// Static obstacles, by slot.
    pub obstacles: Vec<bool>,
    /// Acceleration, m/s^2.
    pub gravity: [f64; 3],
    /// Density and pressure of the undisturbed gas.
    pub ambient: (f64, f64),
    /// p / rho^gamma that no gas falls below.
    pub least_entropy: f64,
    /// Laws that particles name by index.
    pub materials: Vec<solid::material::Material>,
    /// Choices of the method.
    pub numerics: Numerics,
}

impl Problem {
    /// Kirchhoff stress that the elastic force of a particle has at a deformation and a ghost pressure.
    fn stress(&self, particle: &Particle, f: DMat3, q: f64) -> DMat3 {
        let material = &self.materials[particle.material];
        if self.numerics.shared_volume { material.law_stress(f) } else { material.stress(f, q) }
    }

    /// What lies beyond a side, behind one of its faces.
    fn side_at(&self, side: usize, ring: usize) -> Side {
        self.beyond.get(&ring).copied().unwrap_or(self.sides[side])
    }

    /// Is a side a plane of symmetry?
    fn mirrors(&self, side: usize) -> bool {
        self.materials.is_empty() && matches!(self.sides[side], Side::Wall)
    }

    /// What stands for a place beyond such sides; `gap` is that between the image of the first place and the first.
    fn before_sides(&self, mut place: [i32; 3], gap: i32) -> [i32; 3] {
        for (axis, place) in place.iter_mut().enumerate().take(self.grid.dimension) {
            let last = self.grid.cells[axis] - gap;
            if *place < 0 && self.mirrors(2 * axis) {
                *place = -gap - *place;
            } else if *place > last && self.mirrors(2 * axis + 1) {
                *place = 2 * last + gap - *place;
            }
        }
        place
    }

    /// What a cell beyond such sides is the image of.
    pub fn mirrored(&self, cell: [i32; 3]) -> [i32; 3] {
        self.before_sides(cell, 1)
    }

    /// The cell whose velocity the node of a cell has, as it is or mirrored: beyond open sides where nothing prescribes it, the one before.
    pub fn node_of(&self, cell: [i32; 3]) -> [i32; 3] {
        let mut own = self.mirrored(cell);
        for (axis, own) in own.iter_mut().enumerate().take(self.grid.dimension) {
            let last = self.grid.cells[axis] - 1;
            let side = 2 * axis + usize::from(*own > last);
            let beyond = *own < 0 || *own > last;
            let free = matches!(self.sides[side], Side::Far { .. } | Side::Pressure { .. } | Side::Total { .. });
            if beyond && free && self.numerics.pair == Pair::B1b0 {
                *own = (*own).clamp(0, last);
            }
        }
        own
    }

    /// The same of a vertex.
    pub fn mirrored_vertex(&self, vertex: [i32; 3]) -> [i32; 3] {
        self.before_sides(vertex, 0)
    }

    /// A problem with the default method, no obstacles and no gravity.
    pub fn new(mut grid: Grid, sides: [Side; 6]) -> Self {
        grid.periodic = [0, 1, 2].map(|axis| matches!(sides[2 * axis], Side::Periodic));
        let obstacles = vec![false; grid.slots()];
        Self {
            grid,
            gamma: 1.4,
            sides,
            beyond: HashMap::new(),
            obstacles,
            gravity: [0.0; 3],
            ambient: (1.0, 1.0),
            least_entropy: 0.0,
            materials: Vec::new(),
            numerics: Numerics::default(),
        }
    }
}

/// Gas per cell: (rho, m) and total energy per volume.
#[derive(Clone, Debug)]
pub struct Gas {
    /// Density and momentum of each cell, kg/m^3 and kg/(m^2 s).
    pub conserved: Vec<[f64; 4]>,
    /// Total energy of each cell, J/m^3.
    pub energy: Vec<f64>,
    /// By how much what passed an open face in the last solve exceeds the carrier of the cell before it, by ring slot.
    pub surplus: boundary::Surplus,
}

impl Gas {
    /// (rho, m, E) of a slot.
    pub fn get(&self, slot: usize) -> [f64; 5] {
        let u = self.conserved[slot];
        [u[0], u[1], u[2], u[3], self.energy[slot]]
    }

    /// Stores (rho, m, E).
    pub fn set(&mut self, slot: usize, u: [f64; 5]) {
        self.conserved[slot] = [u[0], u[1], u[2], u[3]];
        self.energy[slot] = u[4];
    }

    /// Velocity of a slot.
    pub fn velocity(&self, slot: usize) -> [f64; 3] {
        let u = self.conserved[slot];
        [u[1] / u[0], u[2] / u[0], u[3] / u[0]]
    }

    /// Pressure of a slot.
    pub fn pressure(&self, slot: usize, gamma: f64) -> f64 {
        (gamma - 1.0) * internal_energy(self.get(slot))
    }

    /// (rho, m, E) from density, velocity, pressure.
    pub fn conserved_from_primitive(density: f64, v: [f64; 3], pressure: f64, gamma: f64) -> [f64; 5] {
        let kinetic = 0.5 * density * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        [density, density * v[0], density * v[1], density * v[2], pressure / (gamma - 1.0) + kinetic]
    }
}

/// Kinetic energy per volume.
pub fn kinetic_energy(u: [f64; 5]) -> f64 {
    0.5 * (u[1] * u[1] + u[2] * u[2] + u[3] * u[3]) / u[0]
}

/// Internal energy per volume.
pub fn internal_energy(u: [f64; 5]) -> f64 {
    u[4] - kinetic_energy(u)
}

/// One material point.
#[derive(Clone, Copy, Debug)]
pub struct Particle {
    /// Place, m.
    pub position: DVec3,
    /// Velocity, m/s.
    pub velocity: DVec3,
    /// Affine velocity (APIC), 1/s.
    pub affine: DMat3,
    /// Elastic deformation gradient.
    pub deformation: DMat3,
    /// Mass, kg.
    pub mass: f64,
    /// Volume at rest, m^3.
    pub volume0: f64,
    /// Pressure that the solve left in the particle, Pa.
    pub ghost_pressure: f64,
    /// Plastic strain so far.
    pub plastic_strain: f64,
    /// Index of its law.
    pub material: usize,
    /// Takes part in the step.
    pub active: bool,
}

/// Everything that a step changes.
#[derive(Clone, Debug)]
pub struct State {
    /// Gas of all cells.
    pub gas: Gas,
    /// What each cell holds.
    pub cells: Vec<u32>,
    /// Amounts of (mass, momentum, energy) of gas owed to or held by a cell.
    pub ledger: Vec<[f64; 5]>,
    /// Of a solid cell, what it holds for the gas on its upper side; the rest is in `ledger`.
    pub above: Vec<[f64; 5]>,
    /// All particles.
    pub particles: Vec<Particle>,
    /// Simulated time, s.
    pub time: f64,
    /// What outlets with a far pressure know of themselves.
    pub open: boundary::Memory,
    /// The step before, 0 before the first.
    pub previous_dt: f64,
    /// What the last whole step spanned.
    pub passed_dt: f64,
}

impl State {
    /// Gas from (density, velocity, pressure) per cell centre, and the cell kinds that the particles give.
    pub fn new(problem: &Problem, gas: impl Fn([f64; 3]) -> (f64, [f64; 3], f64), particles: Vec<Particle>) -> Self {
        let grid = &problem.grid;
        let mut cells_gas = Gas {
            conserved: vec![[1.0, 0.0, 0.0, 0.0]; grid.slots()],
            energy: vec![1.0; grid.slots()],
            surplus: boundary::Surplus::new(),
        };
        for c in grid.interior() {
            let (density, velocity, pressure) = gas(grid.centre(c));
            cells_gas.set(grid.slot(c), Gas::conserved_from_primitive(density, velocity, pressure, problem.gamma));
        }
        let mut bins = solid::particle_sort::bin(problem, &particles);
        let cells = interface::kinds(problem, &mut bins, &vec![GAS; grid.slots()]);
        gas::gas_advection::fill_ghosts(problem, &cells, &mut cells_gas);
        Self {
            gas: cells_gas,
            cells,
            ledger: vec![[0.0; 5]; grid.slots()],
            above: vec![[0.0; 5]; grid.slots()],
            particles,
            time: 0.0,
            open: boundary::Memory::new(),
            previous_dt: 0.0,
            passed_dt: 0.0,
        }
    }

    /// (mass, momentum, energy) of gas and ledger.
    pub fn gas_totals(&self, problem: &Problem) -> [f64; 5] {
        let mut total = [0.0; 5];
        for slot in problem.grid.interior().into_iter().map(|c| problem.grid.slot(c)) {
            let held = if self.cells[slot] == GAS { self.gas.get(slot) } else { [0.0; 5] };
            for k in 0..5 {
                total[k] += held[k] * problem.grid.volume() + self.ledger[slot][k] + self.above[slot][k];
            }
        }
        total
    }
}
