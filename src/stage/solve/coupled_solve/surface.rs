//! The preconditioner of the interface pressures: their own block of the system, inverted nearly by a Chebyshev polynomial.

use bytemuck::{Pod, Zeroable};

use crate::error::Result;
use crate::gpu::{Bound, Buffer, Pass};
use crate::numerics::Block;
use crate::stage::sweep::Form;
use crate::state::surface::{TERMS, dispatches, row_length};
use crate::state::{Over, Phase, State};
use crate::structure::structure;

structure! {
    /// One step of the polynomial.
    #[derive(Clone, Copy, Debug, Pod, Zeroable)]
    pub(crate) Turn as "Turn" {
        /// From 0.
        number: u32,
        /// Steps of all.
        count: u32,
    }
}

/// Kernels of the preconditioner.
#[derive(Debug)]
pub(super) struct Surface {
    rows: Form,
    /// One per term, or a single one.
    terms: Vec<Bound>,
    _buffers: Buffers,
}

/// What the kernels hold, for the plan of memory.
#[derive(Debug)]
struct Buffers {
    rows: Buffer<f32>,
    turns: Vec<Buffer<Turn>>,
}

impl Surface {
    /// Binds, in scenes with bodies.
    pub(super) fn new(state: &State) -> Result<Option<Self>> {
        let gpu = &state.gpu;
        let count = state.params.surface_rows as usize;
        if count == 0 {
            return Ok(None);
        }
        let length = count * row_length(state.grid.dimension as usize);
        let turns = dispatches(count);
        let entry = if turns > 1 { "surface_term" } else { "surface_terms" };
        let buffers = Buffers {
            rows: Buffer::new(gpu, "surface rows", length)?,
            turns: (0..turns).map(|_| Buffer::uniform(gpu, "turn", 1)).collect::<Result<_>>()?,
        };
        let shared = [("rows", buffers.rows.raw())];
        let bind = |entry: &str, more: &[(&str, &wgpu::Buffer)]| {
            let named = [&shared[..], more].concat();
            state.bind("solve/solve_surface.wgsl", entry, &named, &[])
        };
        let term = |(number, turn): (u32, &Buffer<Turn>)| {
            turn.write(gpu, 0, &[Turn { number, count: TERMS }]);
            bind(entry, &[("turn", turn.raw())])
        };
        Ok(Some(Self {
            rows: Form::new(state, Over::Listed, ["solve/solve_surface.wgsl", "surface_rows"], &shared, &[])?,
            terms: (0..).zip(&buffers.turns).map(term).collect::<Result<_>>()?,
            _buffers: buffers,
        }))
    }

    /// The rows of a solve, in a phase; masses of the nodes must be there.
    pub(super) fn record_rows(&self, pass: &mut Pass, state: &State, phase: Phase) {
        self.rows.record(pass, state, phase);
    }

    /// The block that it preconditions.
    pub(super) fn block(&self) -> Block<'_> {
        Block { terms: &self.terms, together: self.terms.len() == 1 }
    }
}
