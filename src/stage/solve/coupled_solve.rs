//! `coupled_solve`: which pressure and velocity satisfy both sides? One symmetric positive definite system for gas, interface
//! and ghost pressure, matrix-free, by conjugate gradients with a Jacobi preconditioner, one of its own for the
//! interface pressures (`shaders/solve/solve_surface.wgsl`), and coarse levels in 2D and 3D (`shaders/solve/solve_coarse.wgsl`). [Cao et al. 2022, eqs. 34-37]

mod coarse;
mod surface;

pub(in crate::stage) use surface::Turn;

use crate::error::Result;
use crate::gpu::{Bound, Pass, WORKGROUP};
use crate::numerics::{Block, Dots, Groups, Layout, Levels, Pcg};
use crate::scene::{Coupling, Scene, SolidUpdate};
use crate::stage::gas::open_sides;
use crate::stage::sweep::{Form, Sweep};
use crate::state::constants::{BLOCK_DOTS, BLOCK_REFERENCE, PARTIALS};
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};
use coarse::Coarse;
use surface::Surface;

/// Kernels of the stage.
#[derive(Debug)]
pub struct CoupledSolve {
    /// The iteration.
    pub pcg: Pcg,
    film: Vec<Bound>,
    predictor: Vec<Bound>,
    masses: Sweep,
    open: Option<Form>,
    forces_of_pressure: Sweep,
    forces_on_bodies: Option<Form>,
    velocities: Sweep,
    vertices: Vertices,
    surface: Option<Surface>,
    coarse: Option<Coarse>,
    reference: Bound,
    forces: Sweep,
    add: Bound,
    /// The other update of the solid.
    gradient: Vec<Bound>,
    kick: Vec<Bound>,
}

/// Kernels over the vertices: right-hand side and diagonal, operator.
#[derive(Debug)]
struct Vertices {
    setup: Vec<Form>,
    /// One after the other: the first leaves its partial sums, the other adds to them.
    operator: Vec<Bound>,
    /// Nodes whose velocities are computed: all for B2B1; for B1B0, whose operator deep inside the gas stores none, listed ones and
    /// those that listed vertices rest on.
    nodes: Over,
}

impl Vertices {
    fn new(state: &State) -> Result<Self> {
        let direction = [("x", state.pcg.direction.raw()), ("y", state.pcg.product.raw())];
        let over = if state.quadratic { Over::Both } else { Over::Listed };
        let operator = ["solve/solve_operator.wgsl", "solve_operator"];
        let operator = Form::new(state, over, operator, &direction, &[])?.kernel;
        let [residual, diagonal] =
            [["solve/solve_setup.wgsl", "solve_residual"], ["solve/solve_diagonal.wgsl", "solve_diagonal"]];
        if state.quadratic {
            let setup = [residual, diagonal].map(|[shader, entry]| Sweep::new(state, shader, entry));
            let setup = setup.into_iter().collect::<Result<Vec<_>>>()?.into_iter().flat_map(|sweep| sweep.forms);
            return Ok(Self { setup: setup.collect(), operator: vec![operator], nodes: Over::Both });
        }
        let [residual, diagonal] = [residual, diagonal].map(|[shader, entry]| Form::listed(state, shader, entry));
        let interior = |entry: &str, vectors: &[(&str, &wgpu::Buffer)]| {
            Form::new(state, Over::Interior, ["solve/solve_interior.wgsl", entry], vectors, &[])
        };
        let right = [("x", state.pressure.raw()), ("y", state.pcg.residual.raw())];
        let setup = vec![interior("interior_setup", &right)?, residual?, diagonal?];
        let operator = vec![operator, interior("interior_operator", &direction)?.kernel];
        Ok(Self { setup, operator, nodes: Over::Near })
    }
}

impl CoupledSolve {
    /// Binds.
    pub fn new(state: &State, scene: &Scene) -> Result<Self> {
        let gpu = &state.gpu;
        let limits = (state.params.tolerance, state.params.max_iterations);
        // Interface pressures have a preconditioner of their own, and the B2B1 operator has no room for another buffer.
        let dots = if state.has_solids() || state.quadratic { Dots::Product } else { Dots::Both };
        let layout = Layout {
            threads: (state.params.groups_over_both() * WORKGROUP) as usize,
            groups: state.params.groups,
            dots,
            reference_at: PARTIALS * BLOCK_REFERENCE,
            dots_at: PARTIALS * BLOCK_DOTS,
            block_at: state.params.slots,
            row: (state.params.row < state.params.slots).then_some(state.params.row),
        };
        let pcg = Pcg::new(gpu, &state.pcg, &state.partials, limits, &layout)?;
        let vertices = Vertices::new(state)?;
        let coarse = Coarse::new(state, scene, pcg.control.raw())?;
        let over_nodes = |shader: &str, entry: &str, renamed: &[(&str, &wgpu::Buffer)]| {
            Sweep::over(state, vertices.nodes, [shader, entry], renamed)
        };
        let forces = |x: &wgpu::Buffer| over_nodes("solve/solve_forces.wgsl", "solve_forces", &[("x", x)]);
        let on_bodies = || {
            let (source, named) = (["solve/solve_forces.wgsl", "solve_forces"], [("x", state.pressure.raw())]);
            Form::new(state, Over::Listed, source, &named, &[("BODIES_ONLY", 1.0)])
        };
        let solid = |shader: &str, entries: &[&str]| -> Result<Vec<Bound>> {
            let entries = if state.has_solids() { entries } else { &[] };
            entries.iter().map(|entry| state.bind(shader, entry, &[], &[])).collect()
        };
        Ok(Self {
            film: [
                solid("solid/solid_inertia.wgsl", &["solid_inertia"])?,
                solid("solid/solid_predictor.wgsl", &["film_pressure", "film_left"])?,
            ]
            .concat(),
            predictor: solid("solid/solid_predictor.wgsl", &["solid_predictor"])?,
            masses: Sweep::new(state, "solve/solve_setup.wgsl", "solve_masses")?,
            open: open_sides(state, "solve_open")?,
            forces_of_pressure: forces(state.pressure.raw())?,
            forces_on_bodies: state.has_solids().then(on_bodies).transpose()?,
            velocities: over_nodes("solve/solve_setup.wgsl", "solve_velocities", &[])?,
            surface: Surface::new(state, &pcg, coarse.is_some())?,
            coarse,
            reference: state.bind("solve/solve_reference.wgsl", "solve_reference", &[], &[])?,
            forces: forces(state.pcg.direction.raw())?,
            add: state.bind("solve/solve_finish.wgsl", "solve_add", &[("pcg", pcg.control.raw())], &[])?,
            gradient: match scene.numerics.paper.solid_update {
                SolidUpdate::Forces => Vec::new(),
                SolidUpdate::Gradients => solid("solid/solid_gradient.wgsl", &["solid_gradient"])?,
            },
            kick: Self::kick(state, scene)?,
            vertices,
            pcg,
        })
    }

    fn kick(state: &State, scene: &Scene) -> Result<Vec<Bound>> {
        if !state.has_solids() {
            return Ok(Vec::new());
        }
        let aside = f64::from(u8::from(scene.late_flux()));
        let entries = ["solid_kick", "solid_kick_left", "solid_kick_share"];
        let own = if scene.numerics.paper.coupling == Coupling::Last { &entries[..] } else { &entries[..2] };
        own.iter().map(|entry| state.bind("solid/solid_kick.wgsl", entry, &[], &[("ASIDE", aside)])).collect()
    }

    /// What the nodes bear before the solve: films, gravity, forces of the pressure so far. In a phase.
    pub fn record_loads(&self, pass: &mut Pass, state: &State, phase: Phase) {
        pass.stage(Stage::SolidPredictor.name());
        for kernel in &self.film {
            pass.dispatch(kernel, &state.extent(phase, Over::Slots));
        }
        for kernel in &self.predictor {
            pass.dispatch(kernel, &state.extent(phase, Over::Reduce));
        }
        pass.stage(Stage::CoupledSolve.name());
        if let Some(open) = &self.open {
            open.record(pass, state, phase);
        }
        self.masses.record(pass, state, phase);
        self.forces_of_pressure.record(pass, state, phase);
    }

    /// Velocities, right-hand side and diagonal; opens the iteration. In a phase.
    pub fn record_setup(&self, pass: &mut Pass, state: &State, phase: Phase) {
        pass.stage(Stage::CoupledSolve.name());
        self.velocities.record(pass, state, phase);
        for form in &self.vertices.setup {
            form.record(pass, state, phase);
        }
        pass.dispatch(&self.reference, &state.extent(phase, Over::Reduce));
        if let Some(surface) = &self.surface {
            surface.record_rows(pass, state, phase);
        }
        if let Some(coarse) = &self.coarse {
            coarse.record_setup(pass, state, phase, &self.forces);
        }
        let extents = [Over::Reduce, Over::Single, Over::Surface].map(|entry| state.extent(phase, entry));
        self.pcg.begin(pass, &extents, &self.block(), &self.levels());
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
        let operator = self.vertices.operator.iter().map(|kernel| (kernel, Groups::Partial));
        let forces = self.forces.forms.iter().map(|form| (&form.kernel, form.groups()));
        let applied: Vec<_> = forces.chain(operator).collect();
        let (block, levels) = (self.block(), self.levels());
        for _ in 0..count {
            self.pcg.iterate(pass, &applied, &block, &levels);
        }
    }

    /// X = X* + D, and with bodies the forces that belong to it.
    pub fn record_solution(&self, pass: &mut Pass, state: &State) {
        pass.dispatch(&self.add, &state.extent(Phase::Update, Over::Reduce));
        if let Some(forces) = &self.forces_on_bodies {
            forces.record(pass, state, Phase::Update);
        }
        for kernel in &self.gradient {
            pass.dispatch(kernel, &state.extent(Phase::Update, Over::Slots));
        }
    }

    /// Pressure kick of the solid nodes, change of the ghost pressure.
    pub fn record_solid(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::SolidKick.name());
        for kernel in &self.kick {
            pass.dispatch(kernel, &state.extent(Phase::Update, Over::Slots));
        }
    }
}
