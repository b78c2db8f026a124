//! `probes.csv`: the gas at each probe of the scene, and what has come by so far, one row per step.

use std::path::Path;

use super::tables::Marks;
use crate::Result;
use crate::diagnostics::{ProbeRecord, StepRecord};
use crate::expect::Recording;
use crate::export::csv::{Sheet, Table, Value};
use crate::quantity::{self, PROBE, WAVE};
use crate::scene::Scene;
use crate::snapshot::kind;

/// Name of the table.
pub(super) const NAME: &str = "probes.csv";
/// The table.
#[derive(Debug)]
pub(super) struct Probes {
    names: Vec<String>,
    waves: Vec<Recording>,
    pub(super) table: Table,
}

impl Probes {
    /// That of a scene; none where it has no probes.
    pub(super) fn new(folder: &Path, scene: &Scene) -> Option<Self> {
        let names: Vec<String> = scene.probes.iter().map(|probe| probe.name.clone()).collect();
        let own = [quantity::names(PROBE), quantity::names(WAVE)].concat();
        let of_each = names.iter().flat_map(|name| own.iter().map(move |column| format!("{name}_{column}")));
        let columns = ["step", "time"].map(str::to_owned).into_iter().chain(of_each).collect();
        let table = Table::named(&folder.join(NAME), columns);
        (!names.is_empty()).then(|| Self { waves: vec![Recording::default(); names.len()], names, table })
    }

    /// Goes on after the rows of a run, as far as it had come.
    ///
    /// # Errors
    /// [`crate::Error::Io`] if the table is not what the run wrote.
    pub(super) fn go_on(&mut self, before: &Path, marks: &Marks) -> Result<()> {
        let Some(mark) = marks.files.get(NAME) else { return Ok(()) };
        let path = before.join(NAME);
        self.table.go_on_from((&path, mark))?;
        let sheet = Sheet::parse(&path, self.table.text(), &[])?;
        let column = |name: &str| sheet.numbers(name).unwrap_or_default();
        for (name, wave) in self.names.iter().zip(&mut self.waves) {
            let (pressures, kinds) = (column(&format!("{name}_pressure")), column(&format!("{name}_kind")));
            for ((time, pressure), own) in column("time").iter().zip(pressures).zip(kinds) {
                record(wave, (*time, *pressure), *own == f64::from(kind::GAS));
            }
        }
        Ok(())
    }

    /// Adds a step.
    pub(super) fn add(&mut self, step: &StepRecord) {
        let head: [Value; 2] = [step.step.into(), step.time.into()];
        let own = self.waves.iter_mut().zip(&step.probes).flat_map(|(wave, probe)| row(wave, probe, step.time));
        self.table.push(head.into_iter().chain(own));
    }
}

/// What a probe sees in gas counts.
fn record(wave: &mut Recording, (time, pressure): (f64, f64), gas: bool) {
    wave.add(time, if gas { pressure } else { f64::NAN });
}

fn row(wave: &mut Recording, probe: &ProbeRecord, time: f64) -> impl Iterator<Item = Value> {
    let gas = probe.kind == kind::GAS;
    record(wave, (time, probe.pressure.into()), gas);
    let none = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let so_far = wave.gauge().unwrap_or_default();
    let over = none(wave.overpressure().filter(|_| gas));
    let passed = [over, none(so_far.arrival), none(so_far.positive_phase), so_far.impulse];
    let own: Vec<_> = quantity::row(PROBE, probe).chain(quantity::row(WAVE, &passed)).collect();
    own.into_iter().map(Value::from)
}
