//! Kernels over slots in their forms: one source, told by the override `SWEEP` which slots it goes over (`shaders/shared/domain.wgsl`).

use crate::error::Result;
use crate::gpu::{Bound, Pass};
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

    /// Runs in a phase.
    pub(super) fn record(&self, pass: &mut Pass, state: &State, phase: Phase) {
        pass.dispatch(&self.kernel, &state.extent(phase, self.over));
    }
}

/// A kernel in two forms: plain, as a rule over the slots deep inside the gas, where every stencil is the same, and over the list of the
/// others.
#[derive(Clone, Debug)]
pub(super) struct Sweep {
    pub(super) plain: Form,
    pub(super) listed: Form,
}

impl Sweep {
    /// Binds both forms.
    pub(super) fn new(state: &State, shader: &str, entry: &str) -> Result<Self> {
        Self::over(state, Over::Interior, [shader, entry], &[])
    }

    /// The same with what the plain form goes over, and with other names of buffers.
    pub(super) fn over(
        state: &State,
        over: Over,
        source: [&str; 2],
        renamed: &[(&str, &wgpu::Buffer)],
    ) -> Result<Self> {
        let form = |over: Over| Form::new(state, over, source, renamed, &[]);
        Ok(Self { plain: form(over)?, listed: form(Over::Listed)? })
    }

    /// Runs both in a phase.
    pub(super) fn record(&self, pass: &mut Pass, state: &State, phase: Phase) {
        self.plain.record(pass, state, phase);
        self.listed.record(pass, state, phase);
    }
}
