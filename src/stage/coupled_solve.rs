//! `coupled_solve`: which pressure and velocity satisfy both sides? One symmetric positive definite system for gas, interface
//! and ghost pressure, matrix-free, by conjugate gradients with a Jacobi preconditioner. [Cao et al. 2022, eqs. 34-37]

use super::time_step::slots;
use super::{Parts, extent, record_both};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::numerics::{Pcg, Width};
use crate::state::State;
use crate::state::constants::Entry;

/// Kernels of the stage.
#[derive(Debug)]
pub struct CoupledSolve {
    /// The iteration.
    pub pcg: Pcg,
    predictor: Option<Bound>,
    masses: [Bound; 2],
    open: Bound,
    forces_of_pressure: [Bound; 2],
    velocities: [Bound; 2],
    residual: [Bound; 2],
    diagonal: [Bound; 2],
    reference: Bound,
    forces: [Bound; 2],
    operator: [Bound; 2],
    add: Bound,
    kick: Option<[Bound; 2]>,
}

impl CoupledSolve {
    /// Binds.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>) -> Result<Self> {
        let Parts { gpu, state } = parts;
        let limits = (state.params.tolerance, state.params.max_iterations);
        let pcg = Pcg::new(gpu, &state.pcg, &state.partials, state.grid.slots(), state.params.groups, limits)?;
        let setup = |entry: &str| parts.both("solve_setup.wgsl", entry, &[], &[]);
        let forces = |x: &wgpu::Buffer| parts.both("solve_forces.wgsl", "solve_forces", &[("x", x)], &[]);
        let direction = [("x", state.pcg.direction.raw()), ("y", state.pcg.product.raw())];
        let optional = |shader: &str, entry: &str| -> Result<Option<Bound>> {
            if state.has_solids() { state.bind(gpu, shader, entry, &[], &[]).map(Some) } else { Ok(None) }
        };
        Ok(Self {
            pcg,
            predictor: optional("solid_predictor.wgsl", "solid_predictor")?,
            masses: setup("solve_masses")?,
            open: state.bind(gpu, "solve_open.wgsl", "solve_open", &[], &[("LISTED", 1.0)])?,
            forces_of_pressure: forces(state.pressure.raw())?,
            velocities: setup("solve_velocities")?,
            residual: setup("solve_residual")?,
            diagonal: parts.both("solve_diagonal.wgsl", "solve_diagonal", &[], &[])?,
            reference: state.bind(gpu, "solve_finish.wgsl", "solve_reference", &[], &[])?,
            forces: forces(state.pcg.direction.raw())?,
            operator: parts.both("solve_operator.wgsl", "solve_operator", &direction, &[])?,
            add: state.bind(gpu, "solve_finish.wgsl", "solve_add", &[], &[])?,
            kick: optional("solid_kick.wgsl", "solid_kick")?
                .zip(optional("solid_kick.wgsl", "solid_kick_spread")?)
                .map(Into::into),
        })
    }

    /// Masses, right-hand side and diagonal; opens the iteration.
    pub fn record_setup(&self, pass: &mut Pass, state: &State) {
        pass.stage("coupled_solve");
        if let Some(predictor) = &self.predictor {
            pass.dispatch(predictor, &slots(state, "BEGIN"));
        }
        pass.dispatch(&self.open, &extent(state, "BEGIN", Entry::Listed));
        for kernels in [&self.masses, &self.forces_of_pressure, &self.velocities, &self.residual, &self.diagonal] {
            record_both(pass, state, "BEGIN", kernels);
        }
        pass.dispatch(&self.reference, &extent(state, "BEGIN", Entry::Reduce));
        self.pcg.begin(pass, &extent(state, "BEGIN", Entry::Reduce), &extent(state, "BEGIN", Entry::Single));
    }

    /// Iterations; those after convergence do nothing.
    pub fn record_iterations(&self, pass: &mut Pass, count: u32) {
        pass.stage("coupled_solve");
        for _ in 0..count {
            let [forces, listed_forces] = &self.forces;
            let [operator, listed_operator] = &self.operator;
            let forces = [(forces, Width::Slots), (listed_forces, Width::Listed)];
            // The listed form leaves its partial sums first, the plain form adds to them.
            let operator = [(listed_operator, Width::Partial), (operator, Width::Partial)];
            self.pcg.iterate(pass, &[forces, operator].concat());
        }
    }

    /// X = X* + D and the forces that belong to it.
    pub fn record_solution(&self, pass: &mut Pass, state: &State) {
        pass.dispatch(&self.add, &extent(state, "UPDATE", Entry::Reduce));
        record_both(pass, state, "UPDATE", &self.forces_of_pressure);
    }

    /// Pressure kick of the solid nodes, change of the ghost pressure.
    pub fn record_solid(&self, pass: &mut Pass, state: &State) {
        pass.stage("coupled_solve");
        for kernel in self.kick.iter().flatten() {
            pass.dispatch(kernel, &slots(state, "UPDATE"));
        }
    }
}
