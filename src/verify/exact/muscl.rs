//! An independent 1D solver for references: second-order MUSCL with the HLLC flux, explicit, in double precision, on the CPU.
//! It shares nothing with the method under test but the start of the scene. Waves around a line or a point are 1D too: their cells are
//! rings and shells, whose faces grow with the radius.
//! [van Leer 1979; Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics, 2009, sections 10.4 and 13.4]

use super::profile::Profile;
use crate::scene::{Boundary, Scene};

/// Fraction of the explicit time step.
pub(in crate::verify) const COURANT: f64 = 0.4;
/// Cells beyond each end.
pub(in crate::verify) const GHOSTS: usize = 2;

/// Density, momentum and energy per volume, or their fluxes.
type Flow = [f64; 3];
/// Density, velocity, pressure.
type Primitive = [f64; 3];

/// The gas at the end of a 1D scene. Walls reflect; every other end lets through what reaches it.
pub fn solve(scene: &Scene) -> Profile {
    let start = scene.initial_gas().into_iter().map(|cell| [cell[0], cell[1], cell[4]]);
    let walls = [&scene.boundary.x_min, &scene.boundary.x_max].map(|side| *side == Boundary::Wall);
    let (gas, spacing) = (IdealGas { gamma: scene.gas.gamma }, scene.domain.spacing());
    let mut tube = Tube { gas, spacing, symmetry: 0, walls, cells: start.collect() };
    tube.advance(scene.time.until);
    Profile { origin: scene.domain.origin[0], spacing, state: tube.columns() }
}

/// The gas at the end of a scene that starts round about the origin, over the radius: around a line in 2D, a point in 3D. It reaches to
/// the end of the domain in x, where everything is let through.
pub fn solve_radial(scene: &Scene, cells: u32) -> Profile {
    let domain = &scene.domain;
    let (gamma, spacing) = (scene.gas.gamma, (domain.origin[0] + domain.size[0]) / f64::from(cells));
    let start = (0..cells).map(|cell| {
        let state = scene.gas_at([(f64::from(cell) + 0.5) * spacing, 0.0, 0.0]).conserved(gamma);
        [state[0], state[1], state[4]]
    });
    let symmetry = domain.dimension.saturating_sub(1) as i32;
    let gas = IdealGas { gamma };
    let mut tube = Tube { gas, spacing, symmetry, walls: [true, false], cells: start.collect() };
    tube.advance(scene.time.until);
    Profile { origin: 0.0, spacing, state: tube.columns() }
}

/// What the flux knows of the gas.
#[derive(Clone, Copy, Debug)]
pub(in crate::verify) struct IdealGas {
    /// Ratio of specific heats.
    pub gamma: f64,
}

struct Tube {
    gas: IdealGas,
    spacing: f64,
    /// 0 between planes, 1 around a line, 2 around a point: faces grow with this power of the radius.
    symmetry: i32,
    walls: [bool; 2],
    cells: Vec<Flow>,
}

impl Tube {
    fn advance(&mut self, until: f64) {
        let mut time = 0.0;
        while time < until {
            let dt = self.time_step().min(until - time);
            self.step(dt);
            time = if dt == until - time { until } else { time + dt };
        }
    }

    /// Density, velocity and pressure of all cells.
    fn columns(&self) -> [Vec<f64>; 3] {
        let cells = self.cells.iter().map(|cell| self.gas.primitive(cell)).collect::<Vec<_>>();
        [0, 1, 2].map(|k| cells.iter().map(|cell| cell[k]).collect())
    }

    fn time_step(&self) -> f64 {
        let speed = |cell: &Flow| {
            let [density, velocity, pressure] = self.gas.primitive(cell);
            velocity.abs() + (self.gas.gamma * pressure / density).sqrt()
        };
        COURANT * self.spacing / self.cells.iter().map(speed).fold(0.0, f64::max)
    }

    /// Heun's method: the mean of the start and of two Euler steps.
    fn step(&mut self, dt: f64) {
        let start = self.cells.clone();
        self.euler_step(dt);
        self.euler_step(dt);
        for (cell, old) in self.cells.iter_mut().zip(&start) {
            *cell = std::array::from_fn(|k| 0.5 * (cell[k] + old[k]));
        }
    }

    fn euler_step(&mut self, dt: f64) {
        let states = self.padded();
        let slopes: Vec<Primitive> = states.windows(3).map(limited_slope).collect();
        let face = |k: usize| {
            let left = std::array::from_fn(|i| states[k][i] + 0.5 * slopes[k - 1][i]);
            let right = std::array::from_fn(|i| states[k + 1][i] - 0.5 * slopes[k][i]);
            self.gas.hllc(left, right)
        };
        let fluxes: Vec<Flow> = (1..states.len() - 2).map(face).collect();
        let pressures: Vec<f64> = states.iter().skip(GHOSTS).map(|state| state[2]).collect();
        let (spacing, power) = (self.spacing, self.symmetry);
        for (index, (cell, pair)) in self.cells.iter_mut().zip(fluxes.windows(2)).enumerate() {
            let faces = [index, index + 1].map(|face| face as f64 * spacing);
            let [low, high] = faces.map(|radius| radius.powi(power));
            let volume = (faces[1].powi(power + 1) - faces[0].powi(power + 1)) / f64::from(power + 1);
            let ratio = dt / volume;
            *cell = std::array::from_fn(|k| cell[k] - ratio * (high * pair[1][k] - low * pair[0][k]));
            // the flanks of a ring or shell push outward
            cell[1] += ratio * (high - low) * pressures[index];
        }
    }

    /// The cells with those beyond the ends.
    fn padded(&self) -> Vec<Primitive> {
        let inner = self.cells.iter().map(|cell| self.gas.primitive(cell)).collect::<Vec<_>>();
        let ghost = |wall: bool, depth: usize, from_low: bool| {
            let at = |k: usize| if from_low { inner[k] } else { inner[inner.len() - 1 - k] };
            if wall { [at(depth)[0], -at(depth)[1], at(depth)[2]] } else { at(0) }
        };
        let low = (0..GHOSTS).rev().map(|depth| ghost(self.walls[0], depth, true));
        let high = (0..GHOSTS).map(|depth| ghost(self.walls[1], depth, false));
        low.chain(inner.iter().copied()).chain(high).collect()
    }
}

impl IdealGas {
    fn primitive(&self, &[density, momentum, energy]: &Flow) -> Primitive {
        let velocity = momentum / density;
        [density, velocity, (self.gamma - 1.0) * (energy - 0.5 * momentum * velocity)]
    }

    /// Flux between two states. [Toro, section 10.4, with the wave speeds of 10.5.1 by Davis and Einfeldt]
    pub(in crate::verify) fn hllc(&self, left: Primitive, right: Primitive) -> Flow {
        let sound = |state: Primitive| (self.gamma * state[2] / state[0]).sqrt();
        let (roots, sounds) = ([left[0].sqrt(), right[0].sqrt()], [sound(left), sound(right)]);
        let mean = |a: f64, b: f64| (roots[0] * a + roots[1] * b) / (roots[0] + roots[1]);
        let speed = mean(left[1], right[1]);
        let jump = 0.5 * roots[0] * roots[1] / (roots[0] + roots[1]).powi(2) * (right[1] - left[1]).powi(2);
        let spread = (mean(sounds[0].powi(2), sounds[1].powi(2)) + jump).sqrt();
        let slow = (left[1] - sounds[0]).min(speed - spread);
        let fast = (right[1] + sounds[1]).max(speed + spread);
        if slow >= 0.0 {
            return self.flux(left);
        }
        if fast <= 0.0 {
            return self.flux(right);
        }
        let (push_left, push_right) = (left[0] * (slow - left[1]), right[0] * (fast - right[1]));
        let middle = (right[2] - left[2] + left[1] * push_left - right[1] * push_right) / (push_left - push_right);
        if middle >= 0.0 { self.beside(left, slow, middle) } else { self.beside(right, fast, middle) }
    }

    /// Flux of the state between the contact, which moves at `middle`, and the wave at `speed` into `outer`. [Toro, eqs. 10.38, 10.39]
    fn beside(&self, outer: Primitive, speed: f64, middle: f64) -> Flow {
        let [density, velocity, pressure] = outer;
        let flow = self.conserved(outer);
        let compressed = density * (speed - velocity) / (speed - middle);
        let work = middle + pressure / (density * (speed - velocity));
        let energy = compressed * (flow[2] / density + (middle - velocity) * work);
        let star = [compressed, compressed * middle, energy];
        let flux = self.flux(outer);
        std::array::from_fn(|k| flux[k] + speed * (star[k] - flow[k]))
    }

    fn conserved(&self, [density, velocity, pressure]: Primitive) -> Flow {
        [density, density * velocity, pressure / (self.gamma - 1.0) + 0.5 * density * velocity * velocity]
    }

    fn flux(&self, state: Primitive) -> Flow {
        let [mass, momentum, energy] = self.conserved(state);
        let [_, velocity, pressure] = state;
        [mass * velocity, momentum * velocity + pressure, (energy + pressure) * velocity]
    }
}

/// Monotonised central differences. [van Leer 1977]
pub(in crate::verify) fn limited_slope<const N: usize>(states: &[[f64; N]]) -> [f64; N] {
    std::array::from_fn(|k| {
        let (low, high) = (states[1][k] - states[0][k], states[2][k] - states[1][k]);
        if low * high <= 0.0 {
            return 0.0;
        }
        let size = (2.0 * low.abs()).min(2.0 * high.abs()).min(0.5 * (low + high).abs());
        size * low.signum()
    })
}
