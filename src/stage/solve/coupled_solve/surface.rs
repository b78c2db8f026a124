//! The preconditioner of the interface pressures: their own block of the system, inverted nearly by a Chebyshev polynomial.

use bytemuck::{Pod, Zeroable};

use crate::error::Result;
use crate::gpu::{Bound, Buffer, Pass};
use crate::numerics::{Block, Pcg};
use crate::stage::sweep::Form;
use crate::state::surface::{TERMS, are_few, row_length, turns};
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
        /// 1 before the first iteration.
        first: u32,
        /// 1 if all steps at once also open or end an iteration.
        ends: u32,
    }
}

/// Kernels of the preconditioner.
#[derive(Debug)]
pub(super) struct Surface {
    rows: Form,
    /// One per term, or a single one: before the first iteration, and in one.
    begin: Vec<Bound>,
    terms: Vec<Bound>,
    ends: bool,
    _buffers: Buffers,
}

/// What the kernels hold, for the plan of memory.
#[derive(Debug)]
struct Buffers {
    rows: Buffer<f32>,
    turns: Vec<Buffer<Turn>>,
}

impl Surface {
    /// Binds, in scenes with bodies. `levels`: whether the solve may have coarse levels, too.
    pub(super) fn new(state: &State, pcg: &Pcg, levels: bool) -> Result<Option<Self>> {
        let gpu = &state.gpu;
        let count = state.params.surface_rows as usize;
        if count == 0 {
            return Ok(None);
        }
        let length = count * row_length(state.grid.dimension as usize);
        let together = are_few(count);
        let ends = together && !levels;
        let buffers = Buffers {
            rows: Buffer::new(gpu, "surface rows", length)?,
            turns: (0..turns(count)).map(|_| Buffer::uniform(gpu, "turn", 1)).collect::<Result<_>>()?,
        };
        for (number, turn) in (0..).zip(&buffers.turns) {
            let first = u32::from(together && number == 0);
            let number = if together { 0 } else { number };
            turn.write(gpu, 0, &[Turn { number, count: TERMS, first, ends: u32::from(ends) }]);
        }
        let shared = [("rows", buffers.rows.raw())];
        let entry = if together { "surface_terms" } else { "surface_term" };
        let term = |turn: &Buffer<Turn>, z: &wgpu::Buffer| {
            let own = [("turn", turn.raw()), ("product", z), ("pcg", pcg.control.raw())];
            let named = [&shared[..], &own, &[("pcg_extents", pcg.extents.raw())]].concat();
            state.bind("solve/solve_surface.wgsl", entry, &named, &[])
        };
        let all = |turns: &[Buffer<Turn>], z: &Buffer<f32>| turns.iter().map(|turn| term(turn, z.raw())).collect();
        // Where all terms are one dispatch the first turn is that before the iterations.
        let (first, others) =
            if together { buffers.turns.split_at(1) } else { (&buffers.turns[..], &buffers.turns[..]) };
        let (begin, terms): (Result<_>, Result<_>) =
            (all(first, &state.pcg.direction), all(others, &state.pcg.product));
        Ok(Some(Self {
            rows: Form::new(state, Over::Listed, ["solve/solve_surface.wgsl", "surface_rows"], &shared, &[])?,
            begin: begin?,
            terms: terms?,
            ends,
            _buffers: buffers,
        }))
    }

    /// The rows of a solve, in a phase; masses of the nodes must be there.
    pub(super) fn record_rows(&self, pass: &mut Pass, state: &State, phase: Phase) {
        self.rows.record(pass, state, phase);
    }

    /// The block that it preconditions.
    pub(super) fn block(&self) -> Block<'_> {
        Block { terms: &self.terms, begin: &self.begin, together: self.terms.len() == 1, ends: self.ends }
    }
}
