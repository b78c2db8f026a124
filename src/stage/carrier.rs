//! `carrier`: which velocity carries the gas through its faces? One that compresses only what the pressure solve can see.

use super::{Parts, extent};
use crate::error::{Error, Result};
use crate::gpu::{Bound, Pass};
use crate::state::State;
use crate::state::constants::Entry;
use crate::state::stages::Stage;

/// The state whose velocity carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carried {
    /// The state now.
    Now = 0,
    /// After the first Runge-Kutta stage of the advection.
    First = 1,
    /// After the advection.
    Star = 2,
    /// The state now, after the solve, which also moves still air.
    Solved = 3,
    /// Before the second of two solves: as [`Carried::First`], in air that the first has moved.
    Middle = 4,
}

/// Kernels of the stage in order, for each state that carries; none where the cells' own velocities do.
#[derive(Debug)]
pub struct CarrierVelocity {
    kernels: Vec<(Carried, Vec<(Bound, Entry)>)>,
}

impl CarrierVelocity {
    /// Binds for the states that carry in a step of so many solves; if it is not `wanted`, its recordings are empty.
    ///
    /// # Errors
    /// If a shader or buffer is wrong.
    pub fn new(parts: Parts<'_>, wanted: bool, solves: u32) -> Result<Self> {
        let of = |source: &Carried| {
            let bind = |entry: &str, listed: f64| {
                let (state, solved) = match *source {
                    Carried::Solved => (Carried::Now, 1.0),
                    Carried::Middle => (Carried::First, 1.0),
                    unsolved => (unsolved, 0.0),
                };
                let switches = [("SOURCE", f64::from(state as u32)), ("LISTED", listed), ("SOLVED", solved)];
                parts.state.bind(parts.gpu, "carrier.wgsl", entry, &[], &switches)
            };
            let plain = if parts.state.grid.dimension == 2 {
                [Some((bind("carrier_march", 0.0)?, Entry::Marched)), None]
            } else {
                let slots = |entry: &str| Ok::<_, Error>((bind(entry, 0.0)?, Entry::Slots));
                [Some(slots("carrier_average")?), Some(slots("carrier_divergence")?)]
            };
            let [first, second] = plain;
            let listed = |entry: &str| Ok::<_, Error>((bind(entry, 1.0)?, Entry::Listed));
            let kernels = [first, Some(listed("carrier_average")?), second, Some(listed("carrier_divergence")?)];
            Ok((*source, kernels.into_iter().flatten().collect()))
        };
        let carrying: &[Carried] = match (wanted, solves) {
            (false, _) => &[],
            (true, 1) => &[Carried::Now, Carried::First, Carried::Star, Carried::Solved],
            (true, _) => &[Carried::Now, Carried::Solved, Carried::Middle],
        };
        Ok(Self { kernels: carrying.iter().map(of).collect::<Result<_>>()? })
    }

    /// Carrier of a state, in a phase.
    pub fn record(&self, pass: &mut Pass, state: &State, source: Carried, phase: &str) {
        pass.stage(Stage::Carrier.name());
        for (kernel, entry) in self.kernels.iter().filter(|(carried, _)| *carried == source).flat_map(|(_, all)| all) {
            pass.dispatch(kernel, &extent(state, phase, *entry));
        }
    }
}
