//! `p2g`: what do the solids look like on the grid? Two forms with the same result in the same buffers, both over sorted particles in a
//! fixed order: column by column, and node by node. Both give equal bits on every run.

use crate::error::Result;
use crate::gpu::{Bound, Buffer, Pass, Settings};
use crate::scene;
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// How particles reach nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transfer {
    /// Columns of cells hand on what their particles give: each particle is read once, few threads; cheaper in software.
    Columns,
    /// Each node sums what the particles around it give: more reads, one thread per node; for hardware.
    Nodes,
}

impl Transfer {
    /// What a scene asks for, or what suits the device.
    pub fn of(asked: scene::Transfer, settings: Settings) -> Self {
        match (asked, settings) {
            (scene::Transfer::Columns, _) | (scene::Transfer::Auto, Settings::Software) => Self::Columns,
            (scene::Transfer::Nodes, _) | (scene::Transfer::Auto, Settings::Hardware) => Self::Nodes,
        }
    }
}

/// What one transfer by nodes gives: the elastic force, or mass and momentum with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Carry {
    Force,
    Both,
}

/// Kernels of one transfer.
#[derive(Clone, Debug)]
enum Kernels {
    /// `colors` run one after the other; only mass and momentum have something to finish.
    Columns {
        clear: Bound,
        colors: Vec<Bound>,
        finish: Option<Bound>,
    },
    Nodes(Bound),
}

/// Kernels of the stage: the elastic force, and mass and momentum with it: at the start of a step, and after the particles have moved.
#[derive(Debug)]
pub struct P2g {
    force: Force,
    all: Vec<Kernels>,
}

/// The transfer of a stress alone.
#[derive(Clone, Debug)]
pub(super) struct Force(Kernels);

impl Force {
    /// Binds: the force of `stress`, six components times the volume at rest in two vec4 per particle.
    pub(super) fn new(state: &State, transfer: Transfer, stress: &wgpu::Buffer) -> Result<Self> {
        Ok(Self(match transfer {
            Transfer::Columns => Kernels::columns(state, true, stress)?,
            Transfer::Nodes => Kernels::nodes(state, Carry::Force, stress)?,
        }))
    }

    /// The force, in a phase.
    pub(super) fn record(&self, pass: &mut Pass, state: &State, phase: Phase) {
        self.0.record(pass, state, phase);
    }
}

fn flag(on: bool) -> f64 {
    f64::from(u8::from(on))
}

/// Whether the driver of fracture goes with a stress: with that of the particles, where some material breaks.
fn driver(state: &State, stress: &wgpu::Buffer) -> bool {
    state.breaks && stress == state.particles.stress.raw()
}

impl Kernels {
    fn columns(state: &State, force: bool, stress: &wgpu::Buffer) -> Result<Self> {
        let gpu = &state.gpu;
        let switches = [("WITH_FORCE", flag(force)), ("WITH_DRIVER", flag(force && driver(state, stress)))];
        let bind = |entry: &str| state.bind("solid/p2g.wgsl", entry, &[], &switches);
        let kernel = state.kernel("solid/p2g.wgsl", "p2g_gather", &switches)?;
        let axes = state.grid.dimension;
        let wide = |axis: u32| if axes > axis { COLORS } else { 1 };
        let mut colors = Vec::new();
        for y in 0..wide(2) {
            for x in 0..wide(1) {
                let color = Buffer::uniform(gpu, "color", 4)?;
                color.write(gpu, 0, &[x, y, 0, 0]);
                colors.push(state.bind_kernel(&kernel, &[("color", color.raw()), ("stress", stress)])?);
            }
        }
        let finish = if force { None } else { Some(bind("p2g_finish")?) };
        Ok(Self::Columns { clear: bind("p2g_clear")?, colors, finish })
    }

    fn nodes(state: &State, carry: Carry, stress: &wgpu::Buffer) -> Result<Self> {
        let switches = [
            ("WITH_MASS", flag(carry == Carry::Both)),
            ("WITH_FORCE", 1.0),
            ("WITH_DRIVER", flag(driver(state, stress))),
        ];
        Ok(Self::Nodes(state.bind("solid/p2g_nodes.wgsl", "p2g_nodes", &[("stress", stress)], &switches)?))
    }

    fn record(&self, pass: &mut Pass, state: &State, phase: Phase) {
        match self {
            Self::Columns { clear, colors, finish } => {
                pass.dispatch(clear, &state.extent(phase, Over::Slots));
                for color in colors {
                    pass.dispatch(color, &state.extent(phase, Over::Color));
                }
                if let Some(finish) = finish {
                    pass.dispatch(finish, &state.extent(phase, Over::Slots));
                }
            }
            Self::Nodes(nodes) => pass.dispatch(nodes, &state.extent(phase, Over::Slots)),
        }
    }
}

/// Colors of columns along an axis: the splines of two columns meet unless two others lie between them.
const COLORS: u32 = 3;

impl P2g {
    /// Binds one form.
    pub fn new(state: &State, transfer: Transfer) -> Result<Self> {
        let stress = state.particles.stress.raw();
        let force = Force::new(state, transfer, stress)?;
        let all = match transfer {
            Transfer::Columns => vec![Kernels::columns(state, false, stress)?, force.0.clone()],
            Transfer::Nodes => vec![Kernels::nodes(state, Carry::Both, stress)?],
        };
        Ok(Self { force, all })
    }

    /// Mass, velocity and elastic force at the start of a step.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::P2g.name());
        for kernels in &self.all {
            kernels.record(pass, state, Phase::Begin);
        }
    }

    /// Elastic force for the next sub-step; mass and velocity again if the particles have moved since.
    pub fn record_substep(&self, pass: &mut Pass, state: &State, first: bool) {
        pass.stage(Stage::P2g.name());
        if first {
            self.force.record(pass, state, Phase::First);
        } else {
            for kernels in &self.all {
                kernels.record(pass, state, Phase::Again);
            }
        }
    }
}
