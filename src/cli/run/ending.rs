//! The end of a run: what is left is written, the result judged, the report made.

use std::collections::BTreeMap;
use std::time::Duration;

use super::super::film;
use super::super::folder::Folder;
use super::super::outcome::{Verdict, changes, device, status, totals, verdict};
use super::super::page::moving::Small;
use super::super::page::{run as page, spans};
use super::super::progress::clock;
use super::super::writer::{Message, Written};
use super::{PICTURES, Run, formats};
use crate::expect::{Budget, Check, Ending, Gauge};
use crate::export::report::{self, Report, Status};
use crate::math::plain;
use crate::scene::Scene;
use crate::snapshot::Snapshot;
use crate::{Error, Result};

impl Run<'_> {
    /// Writes the rest, judges, reports.
    pub(super) fn finish(mut self, outcome: Result<()>, json: bool) -> Result<()> {
        self.progress.finish();
        if let Some(writer) = &self.writer {
            writer.send(Message { records: std::mem::take(&mut self.pending), ..Message::default() });
        }
        // The first error is the one to tell about.
        let mut outcome = match (outcome, self.close_writer()) {
            (Ok(()), Err(error)) => Err(error),
            (outcome, _) => outcome,
        };
        let mut written = std::mem::take(&mut self.written);
        let small = std::mem::take(&mut written.small);
        let filmed = film::tell(&written.films, self.options.quiet || json);
        let judged = match status(&outcome) {
            Status::Failed => Ok(Verdict::default()),
            status => self.judge(status),
        };
        // the report comes whatever the device says
        let (judged, asked) = judged.map_or_else(|error| (Verdict::default(), Err(error)), |judged| (judged, Ok(())));
        outcome = outcome.and(asked);
        let status = status(&outcome);
        judged.tell();
        if outcome.is_ok() {
            outcome = self.verdict(&judged.checks);
            if self.options.strict {
                outcome = outcome.and(judged.strict());
            }
        }
        outcome = outcome.and(filmed);
        let text = outcome.as_ref().map_or_else(ToString::to_string, |()| "finished".to_owned());
        let reported = self.write_report((status, &text), written, judged);
        // what failed first is told, not that the report could not be written either
        let report = match (outcome, reported) {
            (Err(error), Err(_)) => return Err(error),
            (Ok(()), Err(error)) => return Err(error),
            (told, Ok(report)) => {
                outcome = told;
                report
            }
        };
        outcome = outcome.and(self.write_page(&report, &small));
        if json && outcome.is_ok() {
            say!("{}", serde_json::to_string(&report).unwrap_or_default());
        } else if !json && !self.options.quiet {
            self.print(&report);
        }
        outcome
    }

    fn judge(&self, status: Status) -> Result<Verdict> {
        let snapshot: Snapshot = self.simulation.snapshot()?;
        let end = self.end_budget()?;
        let ending = Ending { start: &self.start_budget, end: &end, summary: &self.summary, snapshot: &snapshot };
        Ok(Verdict::of(&self.scene, &ending, status == Status::Finished && !self.options.no_expect))
    }

    /// The error of a run whose checks failed. What was changed by hand is another experiment, whose checks are told only.
    fn verdict(&self, checks: &[Check]) -> Result<()> {
        match (verdict(checks), &self.by_hand) {
            (Err(error), Some(change)) if !self.options.expect => {
                tell!("note: not enforced, since {change} was changed by hand (--expect enforces it): {error}");
                Ok(())
            }
            (verdict, _) => verdict,
        }
    }

    fn end_budget(&self) -> Result<Budget> {
        Budget::read(&self.simulation, &self.scene, self.summary.stored_energy())
    }

    pub(super) fn write_report(
        &self,
        (status, outcome): (Status, &str),
        written: Written,
        judged: Verdict,
    ) -> Result<Report<&Scene>> {
        // A device that is lost cannot be asked any more; the report must come all the same.
        let running = status == Status::Running;
        let end = if running { Budget::default() } else { self.end_budget().unwrap_or_default() };
        let seconds = |(name, time): (&str, Duration)| (name.to_owned(), time.as_secs_f64());
        let (clocks, folder) = (&self.clocks, &self.folder.path);
        let timings = [
            ("setup", clocks.setup),
            ("steps", clocks.steps),
            ("pictures", clocks.pictures),
            ("waiting_for_writer", clocks.waiting),
            ("writer", written.busy),
        ];
        let report = Report {
            form: report::FORM,
            version: env!("CARGO_PKG_VERSION"),
            status,
            outcome: outcome.to_owned(),
            time: self.simulation.time(),
            steps: self.simulation.step_count(),
            frames: written.frames,
            wall_seconds: self.wall_seconds(),
            device: device(&self.gpu),
            particles: self.plan.particles,
            memory: self.plan.groups().into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect(),
            timings: timings.map(seconds).into(),
            totals: totals(&self.summary, &end),
            drift: if running { BTreeMap::new() } else { end.drift_since(&self.start_budget) },
            expect: judged.checks,
            watched: judged.watched,
            warnings: judged.warnings,
            absent_warnings: judged.absent,
            scene_hash: self.scene.hash(),
            gauges: if running { BTreeMap::new() } else { page::gauges(folder).into_iter().collect() },
            bodies: if running { BTreeMap::new() } else { spans::bodies(folder) },
            extremes: if running { BTreeMap::new() } else { spans::extremes(folder) },
            changes: changes(self.options),
            scene_file: self.place.clone(),
            scene: &self.scene,
        };
        report::write(&folder.join("report.json"), &report)?;
        Ok(report)
    }

    /// The page of the run; its last files are written.
    fn write_page(&self, report: &Report<&Scene>, small: &Small) -> Result<()> {
        let path = &self.folder.path;
        let report = serde_json::to_value(report).map_err(|error| Error::io(path, error.into()))?;
        page::write(path, &report, &toml::to_string(&self.scene).unwrap_or_default(), small)?;
        Folder::note(path, &[path.join(page::NAME)])
    }

    /// Time on the clock, with that before the run went on \[s\].
    pub(super) fn wall_seconds(&self) -> f64 {
        self.before + self.start.elapsed().as_secs_f64()
    }

    fn print(&self, report: &Report<&Scene>) {
        let wall = clock(self.start.elapsed());
        let (time, steps) = (report.time, report.steps);
        let time = plain(time);
        let left = left(report.frames, &formats(self.options, &self.scene));
        say!("t = {time} s after {steps} steps in {wall}; {left} in {}", self.folder.path.display());
        say_gauges(&report.gauges, !self.scene.charges.is_empty());
        for check in &report.expect {
            say!("  {check}");
        }
    }
}

/// What so many frames are to be found as.
fn left(frames: u32, formats: &[String]) -> String {
    match formats {
        [] => "tables".to_owned(),
        some if some.iter().any(|name| PICTURES.contains(&name.as_str())) => format!("{frames} frames"),
        others => format!("{frames} frames as {}", others.join(", ")),
    }
}

/// What gauges and probes have seen; of charges in milliseconds and kilopascals.
fn say_gauges(gauges: &BTreeMap<String, Gauge>, charges: bool) {
    if gauges.is_empty() {
        return;
    }
    let (milli, [time, pressure]) = if charges { (1e3, ["ms", "kPa"]) } else { (1.0, ["s", "Pa"]) };
    let none = |value: Option<f64>| value.map_or("-".to_owned(), |value| plain(milli * value));
    let heads = [("arrival", time), ("overpressure", pressure), ("positive phase", time), ("impulse", "Pa s")];
    let heads = heads.map(|(name, unit)| format!("{name} [{unit}]"));
    let line = |name: &str, own: [String; 4]| {
        let [arrival, pressure, phase, impulse] = own;
        say!("  {name:16}  {arrival:>12}  {pressure:>18}  {phase:>19}  {impulse:>14}");
    };
    line("gauge", heads);
    for (name, gauge) in gauges {
        let pressure = plain(gauge.peak_overpressure / milli);
        line(name, [none(gauge.arrival), pressure, none(gauge.positive_phase), plain(gauge.impulse)]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_told_as_it_is() {
        let told = |formats: &[&str]| left(25, &formats.iter().map(|&name| name.to_owned()).collect::<Vec<_>>());
        assert_eq!(told(&[]), "tables");
        assert_eq!(told(&["png", "vtk"]), "25 frames");
        assert_eq!(told(&["fields", "vtk"]), "25 frames as fields, vtk");
    }
}
