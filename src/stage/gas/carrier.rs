//! `carrier`: which velocity carries the gas through its faces? One that compresses only what the pressure solve can see.

use crate::error::Result;
use crate::gpu::{Pass, Settings};
use crate::stage::sweep::Form;
use crate::state::stages::Stage;
use crate::state::{Over, Phase, State};

/// The state whose velocity carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carried {
    /// That of the start of the step.
    Start = 0,
    /// Halfway through the advection.
    Halfway = 1,
    /// After the advection.
    Advected = 2,
    /// After the solve, which also moves gas that was at rest.
    Solved = 3,
    /// Before the second of two solves: as [`Carried::Halfway`], in gas that the first has moved.
    SecondHalfway = 4,
}

/// Kernels of the stage in order, for each state that carries; none where the cells' own velocities do.
#[derive(Debug)]
pub struct CarrierVelocity {
    kernels: Vec<(Carried, Vec<Form>)>,
}

impl CarrierVelocity {
    /// Binds for the states that carry in a step of so many solves; if it is not `wanted`, its recordings are empty.
    pub fn new(state: &State, wanted: bool, solves: u32) -> Result<Self> {
        let of = |carried: &Carried| {
            let (source, solved) = match *carried {
                Carried::Solved => (Carried::Start, 1.0),
                Carried::SecondHalfway => (Carried::Halfway, 1.0),
                unsolved => (unsolved, 0.0),
            };
            let form = |over: Over, entry: &str| {
                Form::new(
                    state,
                    over,
                    ["gas/carrier.wgsl", entry],
                    &[],
                    &[("SOURCE", f64::from(source as u32)), ("SOLVED", solved)],
                )
            };
            let [average, divergence] = ["carrier_average", "carrier_divergence"];
            let kernels: &[(Over, &str)] = match (state.gpu.settings, state.grid.dimension) {
                (Settings::Hardware, 2) => &[(Over::Whole, "carrier_march"), (Over::Listed, divergence)],
                (Settings::Hardware, _) => &[(Over::Both, average), (Over::Both, divergence)],
                (_, 2) => &[(Over::Marches, "carrier_march"), (Over::Listed, average), (Over::Listed, divergence)],
                _ => &[
                    (Over::Interior, average),
                    (Over::Listed, average),
                    (Over::Interior, divergence),
                    (Over::Listed, divergence),
                ],
            };
            Ok((*carried, kernels.iter().map(|(over, entry)| form(*over, entry)).collect::<Result<_>>()?))
        };
        let carrying: &[Carried] = match (wanted, solves) {
            (false, _) => &[],
            (true, 1) => &[Carried::Start, Carried::Halfway, Carried::Advected, Carried::Solved],
            (true, _) => &[Carried::Start, Carried::Solved, Carried::SecondHalfway],
        };
        Ok(Self { kernels: carrying.iter().map(of).collect::<Result<_>>()? })
    }

    /// Carrier of a state, in a phase.
    pub fn record(&self, pass: &mut Pass, state: &State, source: Carried, phase: Phase) {
        pass.stage(Stage::Carrier.name());
        for form in self.kernels.iter().filter(|(carried, _)| *carried == source).flat_map(|(_, all)| all) {
            form.record(pass, state, phase);
        }
    }
}
