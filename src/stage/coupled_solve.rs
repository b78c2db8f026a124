//! `coupled_solve`: which pressure and velocity satisfy both sides? One symmetric positive definite system for gas, interface
//! and ghost pressure, matrix-free, by conjugate gradients with a Jacobi preconditioner, one of its own for the
//! interface pressures (`shaders/solve_surface.wgsl`), and coarse levels in 2D and 3D (`shaders/solve_coarse.wgsl`). [Cao et al. 2022, eqs. 34-37]

mod coarse;
mod surface;

use super::time_step::slots;
use super::{Parts, extent, record_both};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::numerics::{Block, Dots, Layout, Levels, Pcg, Width};
use crate::scene::{Scene, SolidUpdate};
use crate::state::State;
use crate::state::constants::{Entry, PARTIALS};
use crate::state::stages::Stage;
use coarse::Coarse;
use surface::Surface;

/// Kernels of the stage.
#[derive(Debug)]
pub struct CoupledSolve {
    /// The iteration.
    pub pcg: Pcg,
    film: Vec<Bound>,
    predictor: Vec<Bound>,
    masses: [Bound; 2],
    open: Bound,
    forces_of_pressure: [Bound; 2],
    forces_on_bodies: Option<Bound>,
    velocities: [Bound; 2],
    vertices: Vertices,
    surface: Option<Surface>,
    coarse: Option<Coarse>,
    reference: Bound,
    forces: [Bound; 2],
    add: Bound,
    /// The other update of the solid.
    gradient: Vec<Bound>,
    kick: Vec<Bound>,
}

/// Kernels over the vertices: right-hand side and diagonal, operator.
#[derive(Debug)]
struct Vertices {
    setup: Vec<(Bound, Entry)>,
    /// The plain and the listed form.
    operator: [Bound; 2],
    /// Nodes whose velocities the plain forms compute: all for B2B1; for B1B0, whose operator deep inside the gas stores none,
    /// those that listed vertices rest on.
    nodes: (Entry, Width),
}

impl Vertices {
    fn new(parts: Parts<'_>) -> Result<Self> {
        let state = parts.state;
        let direction = [("x", state.pcg.direction.raw()), ("y", state.pcg.product.raw())];
        let [residual, listed_residual] = parts.both("solve_setup.wgsl", "solve_residual", &[], &[])?;
        let [diagonal, listed_diagonal] = parts.both("solve_diagonal.wgsl", "solve_diagonal", &[], &[])?;
        let [operator, listed_operator] = parts.both("solve_operator.wgsl", "solve_operator", &direction, &[])?;
        let listed = [(listed_residual, Entry::Listed), (listed_diagonal, Entry::Listed)];
        if state.is_quadratic() {
            let setup = [(residual, Entry::Slots), (diagonal, Entry::Slots)].into_iter().chain(listed).collect();
            return Ok(Self { setup, operator: [operator, listed_operator], nodes: (Entry::Slots, Width::Slots) });
        }
        let interior = |entry: &str, vectors: &[(&str, &wgpu::Buffer)]| {
            state.bind(parts.gpu, "solve_interior.wgsl", entry, vectors, &[])
        };
        let right = [("x", state.pressure.raw()), ("y", state.pcg.residual.raw())];
        let setup = [(interior("interior_setup", &right)?, Entry::Slots)].into_iter().chain(listed).collect();
        let operator = [interior("interior_operator", &direction)?, listed_operator];
        Ok(Self { setup, operator, nodes: (Entry::Frontier, Width::Frontier) })
    }
}

impl CoupledSolve {
    /// Binds.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>, scene: &Scene) -> Result<Self> {
        let Parts { gpu, state } = parts;
        let limits = (state.params.tolerance, state.params.max_iterations);
        // Interface pressures have a preconditioner of their own, and the B2B1 operator has no room for another buffer.
        let dots = if state.has_solids() || state.is_quadratic() { Dots::Product } else { Dots::Both };
        let layout = Layout {
            threads: state.grid.slots(),
            groups: state.params.groups,
            dots,
            reference_at: PARTIALS,
            row: (state.params.row < state.params.slots).then_some(state.params.row),
        };
        let pcg = Pcg::new(gpu, &state.pcg, &state.partials, limits, &layout)?;
        let setup = |entry: &str| parts.both("solve_setup.wgsl", entry, &[], &[]);
        let forces = |x: &wgpu::Buffer| parts.both("solve_forces.wgsl", "solve_forces", &[("x", x)], &[]);
        let on_bodies = || {
            let named = [("x", state.pressure.raw())];
            state.bind(gpu, "solve_forces.wgsl", "solve_forces", &named, &[("LISTED", 1.0), ("BODIES_ONLY", 1.0)])
        };
        let solid = |shader: &str, entries: &[&str]| -> Result<Vec<Bound>> {
            let entries = if state.has_solids() { entries } else { &[] };
            entries.iter().map(|entry| state.bind(gpu, shader, entry, &[], &[])).collect()
        };
        Ok(Self {
            film: [
                solid("solid_inertia.wgsl", &["solid_inertia"])?,
                solid("solid_predictor.wgsl", &["film_pressure", "film_left"])?,
            ]
            .concat(),
            predictor: solid("solid_predictor.wgsl", &["solid_predictor"])?,
            masses: setup("solve_masses")?,
            open: state.bind(gpu, "solve_open.wgsl", "solve_open", &[], &[("LISTED", 1.0)])?,
            forces_of_pressure: forces(state.pressure.raw())?,
            forces_on_bodies: state.has_solids().then(on_bodies).transpose()?,
            velocities: setup("solve_velocities")?,
            vertices: Vertices::new(parts)?,
            surface: Surface::new(parts)?,
            coarse: Coarse::new(parts, scene, pcg.control.raw())?,
            reference: state.bind(gpu, "solve_reference.wgsl", "solve_reference", &[], &[])?,
            forces: forces(state.pcg.direction.raw())?,
            add: state.bind(gpu, "solve_finish.wgsl", "solve_add", &[("pcg", pcg.control.raw())], &[])?,
            gradient: match scene.numerics.solid_update {
                SolidUpdate::Forces => Vec::new(),
                SolidUpdate::Gradients => solid("solid_gradient.wgsl", &["solid_gradient"])?,
            },
            kick: Self::kick(parts, scene)?,
            pcg,
        })
    }

    fn kick(Parts { gpu, state }: Parts<'_>, scene: &Scene) -> Result<Vec<Bound>> {
        if !state.has_solids() {
            return Ok(Vec::new());
        }
        let aside = f64::from(u8::from(scene.late_flux()));
        let entries = ["solid_kick", "solid_kick_left", "solid_kick_share", "solid_kick_spread"];
        entries.iter().map(|entry| state.bind(gpu, "solid_kick.wgsl", entry, &[], &[("ASIDE", aside)])).collect()
    }

    /// What the nodes bear before the solve: films, gravity, forces of the pressure so far. In a phase.
    pub fn record_loads(&self, pass: &mut Pass, state: &State, phase: &str) {
        pass.stage(Stage::SolidPredictor.name());
        for kernel in &self.film {
            pass.dispatch(kernel, &slots(state, phase));
        }
        for kernel in &self.predictor {
            pass.dispatch(kernel, &extent(state, phase, Entry::Reduce));
        }
        pass.stage(Stage::CoupledSolve.name());
        pass.dispatch(&self.open, &extent(state, phase, Entry::Listed));
        record_both(pass, state, phase, &self.masses);
        self.record_nodes(pass, state, phase, &self.forces_of_pressure);
    }

    /// Velocities, right-hand side and diagonal; opens the iteration. In a phase.
    pub fn record_setup(&self, pass: &mut Pass, state: &State, phase: &str) {
        pass.stage(Stage::CoupledSolve.name());
        self.record_nodes(pass, state, phase, &self.velocities);
        for (kernel, entry) in &self.vertices.setup {
            pass.dispatch(kernel, &extent(state, phase, *entry));
        }
        pass.dispatch(&self.reference, &extent(state, phase, Entry::Reduce));
        if let Some(surface) = &self.surface {
            surface.record_rows(pass, state, phase);
        }
        if let Some(coarse) = &self.coarse {
            coarse.record_setup(pass, state, phase, &self.forces);
        }
        let extents = [Entry::Reduce, Entry::Single, Entry::Surface].map(|entry| extent(state, phase, entry));
        self.pcg.begin(pass, &extents, &self.block(), &self.levels());
    }

    fn record_nodes(&self, pass: &mut Pass, state: &State, phase: &str, [plain, listed]: &[Bound; 2]) {
        pass.dispatch(plain, &extent(state, phase, self.vertices.nodes.0));
        pass.dispatch(listed, &extent(state, phase, Entry::Listed));
    }

    fn block(&self) -> Block<'_> {
        self.surface.as_ref().map(Surface::block).unwrap_or_default()
    }

    fn levels(&self) -> Levels<'_> {
        self.coarse.as_ref().map(Coarse::levels).unwrap_or_default()
    }

    /// Iterations; those after convergence do nothing.
    pub fn record_iterations(&self, pass: &mut Pass, count: u32) {
        pass.stage(Stage::CoupledSolve.name());
        let [forces, listed_forces] = &self.forces;
        let [operator, listed_operator] = &self.vertices.operator;
        let (block, levels) = (self.block(), self.levels());
        for _ in 0..count {
            self.pcg.iterate(
                pass,
                &[
                    (forces, self.vertices.nodes.1),
                    (listed_forces, Width::Listed),
                    // The listed form leaves its partial sums first, the plain form adds to them.
                    (listed_operator, Width::Partial),
                    (operator, Width::Partial),
                ],
                &block,
                &levels,
            );
        }
    }

    /// X = X* + D, and with bodies the forces that belong to it.
    pub fn record_solution(&self, pass: &mut Pass, state: &State) {
        pass.dispatch(&self.add, &extent(state, "UPDATE", Entry::Reduce));
        if let Some(forces) = &self.forces_on_bodies {
            pass.dispatch(forces, &extent(state, "UPDATE", Entry::Listed));
        }
        for kernel in &self.gradient {
            pass.dispatch(kernel, &slots(state, "UPDATE"));
        }
    }

    /// Pressure kick of the solid nodes, change of the ghost pressure.
    pub fn record_solid(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::SolidKick.name());
        for kernel in &self.kick {
            pass.dispatch(kernel, &slots(state, "UPDATE"));
        }
    }
}
