//! `sweep.csv`: values, how the runs ended, expectations, totals, and what gauges measured.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::Value as Json;

use crate::export::csv::{Table, Value};
use crate::export::forms;
use crate::export::report::REPORT;
use crate::{Result, input};

/// Columns before the values.
const HEAD: [&str; 4] = ["run", "status", "wall_seconds", "steps"];

/// What is known of the runs of a sweep; those that have ended are read once.
#[derive(Debug)]
pub(super) struct Rows {
    keys: Vec<String>,
    /// Of each point: the entries of [`HEAD`], its values, and its numbers by name.
    rows: Vec<Option<Row>>,
}

#[derive(Debug)]
struct Row {
    status: String,
    wall_seconds: f64,
    steps: f64,
    numbers: BTreeMap<String, f64>,
}

impl Rows {
    /// Of a sweep over keys with so many points.
    pub(super) fn new(keys: Vec<String>, points: usize) -> Self {
        Self { keys, rows: (0..points).map(|_| None).collect() }
    }

    /// Reads the run of a point again.
    pub(super) fn forget(&mut self, point: usize) {
        self.rows[point] = None;
    }

    /// Writes the table of all runs that are there and are runs of this sweep, as `own` says.
    ///
    /// # Errors
    /// [`crate::Error::Io`]; [`crate::Error::Usage`] if a later program wrote a run.
    pub(super) fn save(
        &mut self,
        out: &Path,
        points: &[Vec<String>],
        own: impl Fn(usize, &Path) -> bool,
    ) -> Result<()> {
        for (number, row) in self.rows.iter_mut().enumerate().filter(|(_, row)| row.is_none()) {
            let folder = out.join(format!("{number:04}"));
            if own(number, &folder) {
                *row = Row::of(&report(&folder)?);
            }
        }
        let mut columns: Vec<&String> = Vec::new();
        for row in self.rows.iter().flatten() {
            row.numbers.keys().for_each(|key| {
                if !columns.contains(&key) {
                    columns.push(key)
                }
            });
        }
        let names = HEAD.into_iter().chain(self.keys.iter().map(String::as_str));
        let names: Vec<&str> = names.chain(columns.iter().map(|column| column.as_str())).collect();
        let mut table = Table::new(&out.join("sweep.csv"), &names);
        for (number, (row, point)) in self.rows.iter().zip(points).enumerate() {
            let Some(row) = row else { continue };
            let head: [Value; 4] =
                [(number as u64).into(), row.status.as_str().into(), row.wall_seconds.into(), row.steps.into()];
            let values = point.iter().map(|value| Value::from(value.as_str()));
            let rest = columns.iter().map(|column| row.numbers.get(*column).copied().unwrap_or(f64::NAN).into());
            table.push(head.into_iter().chain(values).chain(rest));
        }
        table.save()
    }
}

impl Row {
    /// That of a run that has ended.
    fn of(report: &Json) -> Option<Self> {
        let status = report["status"].as_str().filter(|status| *status != "running")?;
        let real = |value: &Json| value.as_f64().unwrap_or(f64::NAN);
        Some(Self {
            status: status.to_owned(),
            wall_seconds: real(&report["wall_seconds"]),
            steps: real(&report["steps"]),
            numbers: numbers(report),
        })
    }
}

/// The report of a run; null where there is none.
///
/// # Errors
/// [`crate::Error::Usage`] if a later program wrote it.
pub(super) fn report(folder: &Path) -> Result<Json> {
    forms::known(folder, true)?;
    let text = input::text(&folder.join(REPORT), input::MOST_REPORT).ok();
    Ok(text.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default())
}

/// Numbers of a run by name.
fn numbers(report: &Json) -> BTreeMap<String, f64> {
    let mut found = BTreeMap::new();
    for check in report["expect"].as_array().into_iter().flatten() {
        if let (Some(name), Some(value)) = (check["name"].as_str(), check["measured"].as_f64()) {
            found.insert(format!("expect_{name}"), value);
        }
    }
    let real = |(name, value): (&String, &Json)| Some((name.clone(), value.as_f64()?));
    found.extend(report["totals"].as_object().into_iter().flatten().filter_map(real));
    for (gauge, measured) in report["gauges"].as_object().into_iter().flatten() {
        let measured = measured.as_object().into_iter().flatten().filter_map(real);
        found.extend(measured.map(|(name, value)| (format!("{gauge}_{name}"), value)));
    }
    found
}
