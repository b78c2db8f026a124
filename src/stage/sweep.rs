//! Kernels over slots in their forms: one source, told by the override `SWEEP` which slots it goes over (`shaders/shared/domain.wgsl`).

use crate::error::Result;
use crate::gpu::{Bound, Pass, Settings};
use crate::numerics::Groups;
use crate::state::{Over, Phase, State};

/// A kernel in one form.
#[derive(Clone, Debug)]
pub(super) struct Form {
    /// The kernel, for those who dispatch it by a table of their own.
    pub(super) kernel: Bound,
    /// What it goes over.
    pub(super) over: Over,
}

impl Form {
    /// Binds; `renamed` and `switches` as [`State::bind`] takes them.
    pub(super) fn new(
        state: &State,
        over: Over,
        [shader, entry]: [&str; 2],
        renamed: &[(&str, &wgpu::Buffer)],
        switches: &[(&str, f64)],
    ) -> Result<Self> {
        let switches = [switches, &[("SWEEP", f64::from(over as u32))]].concat();
        let kernel = state.bind(shader, entry, renamed, &switches)?;
        Ok(Self { kernel: if over == Over::Listed { kernel.in_form("listed") } else { kernel }, over })
    }

    /// The form over the list.
    pub(super) fn listed(state: &State, shader: &str, entry: &str) -> Result<Self> {
        Self::new(state, Over::Listed, [shader, entry], &[], &[])
    }

    /// Its groups in an iteration of a solve.
    pub(super) fn groups(&self) -> Groups {
        if matches!(self.over, Over::Listed | Over::Frontier | Over::Near) { Groups::Near } else { Groups::Slots }
    }

    /// Runs in a phase.
    pub(super) fn record(&self, pass: &mut Pass, state: &State, phase: Phase) {
        pass.dispatch(&self.kernel, &state.extent(phase, self.over));
    }
}

/// A kernel over both kinds of slots: those deep inside the gas, where every stencil is the same, and the list of the others.
#[derive(Clone, Debug)]
pub(super) struct Sweep {
    /// In order.
    pub(super) forms: Vec<Form>,
}

impl Sweep {
    /// Binds.
    pub(super) fn new(state: &State, shader: &str, entry: &str) -> Result<Self> {
        Self::over(state, Over::Both, [shader, entry], &[])
    }

    /// The same over both, or over frontier and list, with other names of buffers. One form for a GPU, which a launch costs
    /// as much as a small kernel; two on a CPU, where a thread would prepare for both kinds.
    pub(super) fn over(
        state: &State,
        over: Over,
        source: [&str; 2],
        renamed: &[(&str, &wgpu::Buffer)],
    ) -> Result<Self> {
        let overs: &[Over] = match (state.gpu.settings, over) {
            (Settings::Hardware, _) => &[over],
            (Settings::Software, Over::Both) => &[Over::Interior, Over::Listed],
            (Settings::Software, _) => &[Over::Frontier, Over::Listed],
        };
        let form = |over: &Over| Form::new(state, *over, source, renamed, &[]);
        Ok(Self { forms: overs.iter().map(form).collect::<Result<_>>()? })
    }

    /// Runs in a phase.
    pub(super) fn record(&self, pass: &mut Pass, state: &State, phase: Phase) {
        self.forms.iter().for_each(|form| form.record(pass, state, phase));
    }
}
