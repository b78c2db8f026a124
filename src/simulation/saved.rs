//! Everything that a run needs to go on bit by bit, on the host: copied between two steps, and brought back.

use serde::{Deserialize, Serialize};

use super::recorded::Recorded;
use super::{Released, Simulation};
use crate::error::{Error, Result};
use crate::gpu::{Allocation, readback};
use crate::snapshot::kind;

/// Buffers that follow from the scene alone; the device only reads them.
const FROM_SCENE: [&str; 8] =
    ["params", "materials", "knots", "motions", "probe_cells", "probe_history", "gauge_particles", "gauge_history"];

/// Buffers that no step reads before it has written them.
const SCRATCH: [&str; 9] =
    ["work", "stiffness", "solution", "residual", "direction", "inverse_diagonal", "surface rows", "elastic", "node"];

/// Buffers that hold numbers alone.
const NUMBERS: [&str; 3] = ["conserved", "position", "velocity"];
/// Buffers of particles with as many rows each, whose fourth words are bits of indices, too.
const ROWS: [(&str, usize); 3] = [("affine", 3), ("deformation", 3), ("stress", 2)];

/// The state of a simulation between two steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Saved {
    /// Simulated time \[s\].
    pub time: f64,
    /// Steps done.
    pub step: u64,
    /// What the host keeps.
    pub host: Host,
    /// The buffers.
    pub arrays: Vec<SavedArray>,
}

/// What the host keeps of a simulation beside its buffers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Host {
    /// What [`Simulation::given`] says.
    given: [f64; 4],
    /// What [`Simulation::pulled`] says, and the momentum of the gas before the next step.
    pulled: [f64; 4],
    gas_before: [f64; 3],
    /// What [`Simulation::borne`] says, of bodies and then of obstacles.
    borne: Vec<[f64; 4]>,
    /// What [`Simulation::blasts`] says.
    blasts: f64,
    /// What [`Simulation::released`] says.
    #[serde(default)]
    released: Released,
    /// The time that the run was asked for \[s\].
    #[serde(default)]
    target: f64,
    /// How much of each loop was recorded last.
    recorded: [u32; 4],
}

/// One buffer.
#[derive(Clone, Debug, PartialEq)]
pub struct SavedArray {
    /// Name, unique within a state.
    pub name: String,
    /// Whether its words are floating point numbers.
    pub real: bool,
    /// Words of an element.
    pub columns: usize,
    /// Its words, in the order of bytes of this machine.
    pub words: Vec<u32>,
}

impl Saved {
    /// The first array, and where in it, that holds something else than a number where a step reads one: everywhere, in cells of gas, or of
    /// particles inside the domain.
    fn not_finite(&self) -> Option<(&str, usize)> {
        let words = |name: &str| {
            let array = self.arrays.iter().find(|array| array.name == name);
            array.map_or(&[][..], |array| &array.words)
        };
        let bad = |word: &u32| !f32::from_bits(*word).is_finite();
        let gas = words("cells")
            .iter()
            .zip(words("energy"))
            .position(|(cell, word)| *cell as u8 & kind::MASK == kind::GAS && bad(word));
        let inside: Vec<bool> =
            words("deformation").chunks(12).map(|own| own.get(7).is_some_and(|w| f32::from_bits(*w) > 0.0)).collect();
        let of_particles = |(name, rows): (&'static str, usize)| {
            let each = words(name).chunks(4 * rows).zip(&inside);
            let mut found = each.enumerate().filter(|(_, (_, inside))| **inside);
            found.find_map(|(number, (own, _))| {
                let at = own.iter().enumerate().position(|(place, word)| place % 4 < 3 && bad(word))?;
                Some((name, 4 * rows * number + at))
            })
        };
        let numbers = NUMBERS.iter().find_map(|name| Some((*name, words(name).iter().position(bad)?)));
        numbers.or(gas.map(|at| ("energy", at))).or_else(|| ROWS.into_iter().find_map(of_particles))
    }
}

impl Simulation {
    /// Copies what carries the state from step to step. Between two steps only, see [`Simulation::settle`].
    ///
    /// # Errors
    /// Driver errors.
    pub fn save(&self) -> Result<Saved> {
        let mut arrays = Vec::new();
        for (name, buffer) in self.carried() {
            let bytes = if buffer.bytes == 0 {
                Vec::new()
            } else {
                readback::read_bytes(&self.gpu, &buffer.raw, 0, buffer.bytes)?
            };
            let words = bytemuck::pod_collect_to_vec(&bytes);
            arrays.push(SavedArray { name, real: buffer.real, columns: buffer.columns, words });
        }
        let host = Host {
            given: self.given,
            pulled: self.pulled,
            gas_before: self.gas_before,
            borne: self.borne.clone(),
            blasts: self.blasts,
            released: self.released,
            target: self.target,
            recorded: self.recorded.numbers(),
        };
        Ok(Saved { time: self.time, step: self.step, host, arrays })
    }

    /// Goes on from a state that was saved of the same scene.
    ///
    /// # Errors
    /// [`Error::Spoilt`] if an array is missing, foreign, of another length, or holds what is no number; [`Error::Usage`] if it has other
    /// loads; driver errors.
    pub fn restore(&mut self, saved: &Saved) -> Result<()> {
        let wanted = self.carried();
        if saved.host.borne.len() != self.borne.len() {
            let text = "its loads are those of other bodies, obstacles and gauges: new gauges may sit on points of bodies, and on what had \
                        loads before";
            return Err(Error::Usage(text.to_owned()));
        }
        for array in &saved.arrays {
            if !wanted.iter().any(|(name, _)| *name == array.name) {
                return Err(Error::Spoilt(format!("array `{}` is none of this scene's and program's", array.name)));
            }
        }
        for (name, buffer) in &wanted {
            let Some(array) = saved.arrays.iter().find(|array| array.name == *name) else {
                if buffer.bytes == 0 {
                    continue;
                }
                return Err(Error::Spoilt(format!("array `{name}` is missing")));
            };
            let (words, expected) = (array.words.len(), buffer.bytes as usize / 4);
            if words != expected {
                return Err(Error::Spoilt(format!(
                    "array `{name}` has {words} words; this scene and program have {expected}"
                )));
            }
        }
        if let Some((name, at)) = saved.not_finite() {
            return Err(Error::Spoilt(format!("array `{name}`, word {at}: not a finite number")));
        }
        for (name, buffer) in &wanted {
            let array = saved.arrays.iter().find(|array| array.name == *name);
            if let Some(array) = array.filter(|array| !array.words.is_empty()) {
                self.gpu.queue.write_buffer(&buffer.raw, 0, bytemuck::cast_slice(&array.words));
            }
        }
        let host = &saved.host;
        (self.time, self.step, self.given, self.blasts) = (saved.time, saved.step, host.given, host.blasts);
        (self.released, self.target) = (host.released, host.target);
        (self.pulled, self.gas_before, self.borne) = (host.pulled, host.gas_before, host.borne.clone());
        self.recorded = Recorded::of(host.recorded);
        self.weigh_again()?;
        self.gpu.check()
    }

    /// Bytes of a saved state.
    #[must_use]
    pub fn saved_bytes(&self) -> u64 {
        self.carried().iter().map(|(_, buffer)| buffer.bytes).sum()
    }

    /// The buffers that carry the state, by names that are unique.
    pub(super) fn carried(&self) -> Vec<(String, &Allocation)> {
        let mut named: Vec<(String, &Allocation)> = Vec::new();
        for buffer in self.buffers.iter().filter(|buffer| carries(&buffer.label)) {
            let label = buffer.label.replace(' ', "_");
            let before = named.iter().filter(|(_, other)| other.label == buffer.label).count();
            named.push((if before == 0 { label } else { format!("{label}_{}", before + 1) }, buffer));
        }
        named
    }
}

/// Whether a buffer carries the state.
fn carries(label: &str) -> bool {
    !FROM_SCENE.contains(&label) && !SCRATCH.contains(&label)
}
