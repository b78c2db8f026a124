//! Totals after a step: not part of the method, but of every record of it.

use crate::error::Result;
use crate::gpu::{Bound, Extent, Pass, readback};
use crate::state::constants::PARTIALS;
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// Kernels of the totals.
#[derive(Debug)]
pub struct Totals {
    gas: Bound,
    particles: Option<Bound>,
    record: Bound,
    probes: Option<Bound>,
}

impl Totals {
    /// Binds.
    pub fn new(state: &State) -> Result<Self> {
        let bind = |entry: &str| state.bind("step/diagnostics.wgsl", entry, &[], &[]);
        Ok(Self {
            gas: bind("totals_gas")?,
            particles: if state.has_solids() { Some(bind("totals_particles")?) } else { None },
            record: bind("totals_record")?,
            probes: if state.params.probes > 0 { Some(bind("totals_probes")?) } else { None },
        })
    }

    /// One record of the history ring, if a step has just ended.
    pub fn record(&self, pass: &mut Pass, state: &State) {
        pass.stage(Stage::Totals.name());
        pass.dispatch(&self.gas, &state.extent(Phase::End, Over::Reduce));
        if let Some(particles) = &self.particles {
            pass.dispatch(particles, &state.extent(Phase::End, Over::Reduce));
        }
        pass.dispatch(&self.record, &state.extent(Phase::End, Over::Single));
        if let Some(probes) = &self.probes {
            pass.dispatch(probes, &state.extent(Phase::End, Over::Single));
        }
    }

    /// Momentum \[kg m s^-1\] of the bodies, their energy of motion and of strain \[J\], and their mass \[kg\], between two steps.
    ///
    /// # Errors
    /// Driver errors.
    pub fn of_bodies(&self, state: &State) -> Result<[f64; 5]> {
        let (gpu, groups) = (&state.gpu, state.params.groups as usize);
        let Some(particles) = &self.particles else { return Ok([0.0; 5]) };
        let mut pass = Pass::new(gpu, "bodies");
        pass.dispatch(particles, &Extent::Groups([state.params.groups, 1, 1]));
        pass.submit()?;
        let block = |number: usize| readback::read_range(gpu, &state.partials, number * PARTIALS as usize, groups);
        let (motion, energy) = (block(6)?, block(7)?);
        let sum = |parts: &[[f32; 4]], k: usize| parts.iter().map(|part| f64::from(part[k])).sum::<f64>();
        let stored = (0..3).map(|k| sum(&energy, k)).sum();
        Ok([sum(&motion, 1), sum(&motion, 2), sum(&motion, 3), stored, sum(&motion, 0)])
    }
}
