//! `p2g`: what do the solids look like on the grid? Two forms with the same result in the same buffers: gather over sorted
//! particles, and scatter by fixed-point integer atomics. Both give equal bits on every run.

use super::{Parts, extent};
use crate::error::Result;
use crate::gpu::{Bound, Pass};
use crate::state::State;
use crate::state::constants::Entry;

/// How particles reach nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transfer {
    /// Nodes collect from sorted particles: cheaper in software.
    Gather,
    /// Particles add to nodes.
    Scatter,
}

/// What one transfer carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Carry {
    Mass,
    Force,
    Both,
}

/// Kernels of one transfer.
#[derive(Debug)]
struct Kernels {
    gather: Option<Bound>,
    scatter: Option<[Bound; 5]>,
}

/// Kernels of the stage.
#[derive(Debug)]
pub struct P2g {
    mass: Kernels,
    force: Kernels,
    both: Kernels,
}

impl Kernels {
    fn new(parts: Parts<'_>, transfer: Transfer, carry: Carry) -> Result<Self> {
        let Parts { gpu, state } = parts;
        let flag = |on: bool| f64::from(u8::from(on));
        let switches = [("WITH_MASS", flag(carry != Carry::Force)), ("WITH_FORCE", flag(carry != Carry::Mass))];
        let renamed = [("sums", state.gas.work.raw()), ("bounds", state.partials.raw())];
        let scatter = |entry: &str| state.bind(gpu, "p2g_scatter.wgsl", entry, &renamed, &switches);
        Ok(match transfer {
            Transfer::Gather => {
                Self { gather: Some(state.bind(gpu, "p2g.wgsl", "p2g_gather", &[], &switches)?), scatter: None }
            }
            Transfer::Scatter => {
                let kernels = [
                    scatter("scatter_bounds")?,
                    scatter("scatter_units")?,
                    scatter("scatter_clear")?,
                    scatter("scatter_add")?,
                    scatter("scatter_resolve")?,
                ];
                Self { gather: None, scatter: Some(kernels) }
            }
        })
    }

    fn record(&self, pass: &mut Pass, state: &State, phase: &str) {
        if let Some(gather) = &self.gather {
            pass.dispatch(gather, &extent(state, phase, Entry::Slots));
        }
        if let Some([bounds, units, clear, add, resolve]) = &self.scatter {
            pass.dispatch(bounds, &extent(state, phase, Entry::Reduce));
            pass.dispatch(units, &extent(state, phase, Entry::Single));
            pass.dispatch(clear, &extent(state, phase, Entry::Slots));
            pass.dispatch(add, &extent(state, phase, Entry::Particles));
            pass.dispatch(resolve, &extent(state, phase, Entry::Slots));
        }
    }
}

impl P2g {
    /// Binds one form.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>, transfer: Transfer) -> Result<Self> {
        Ok(Self {
            mass: Kernels::new(parts, transfer, Carry::Mass)?,
            force: Kernels::new(parts, transfer, Carry::Force)?,
            both: Kernels::new(parts, transfer, Carry::Both)?,
        })
    }

    /// Mass and velocity at the start of a step.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage("p2g");
        self.mass.record(pass, state, "BEGIN");
    }

    /// Elastic force for the next sub-step; mass and velocity again if the particles have moved since.
    pub fn record_substep(&self, pass: &mut Pass, state: &State, first: bool) {
        pass.stage("p2g");
        if first {
            self.force.record(pass, state, "FIRST");
        } else {
            self.both.record(pass, state, "AGAIN");
        }
    }
}
