//! What `report.json` says of bodies and of extremes over time: from the tables of a run.

use std::collections::BTreeMap;
use std::path::Path;

use crate::export::csv::Sheet;
use crate::export::report::Span;

/// Columns of `bodies.csv` that are no quantities of a body.
const ASIDE: [&str; 3] = ["frame", "time", "body"];
/// Beginnings of the columns of `diagnostics.csv` that are extremes.
const EXTREMES: [&str; 2] = ["min_", "max_"];

/// Each quantity of each body over the frames.
pub(in crate::cli) fn bodies(folder: &Path) -> BTreeMap<String, BTreeMap<String, Span>> {
    let Some(sheet) = Sheet::read(&folder.join("bodies.csv"), &["body"]).ok().flatten() else { return BTreeMap::new() };
    let names = sheet.texts("body").unwrap_or_default();
    let mut rows: BTreeMap<&String, Vec<usize>> = BTreeMap::new();
    names.iter().enumerate().for_each(|(row, name)| rows.entry(name).or_default().push(row));
    let columns = || sheet.names().iter().filter(|name| !ASIDE.contains(&name.as_str()));
    let of = |own: &[usize]| {
        columns().filter_map(|name| Some((name.clone(), span(&sheet, name, own.iter().copied())?))).collect()
    };
    rows.into_iter().map(|(name, own)| (name.clone(), of(&own))).collect()
}

/// Extremes over the steps.
pub(in crate::cli) fn extremes(folder: &Path) -> BTreeMap<String, Span> {
    let Some(sheet) = Sheet::read(&folder.join("diagnostics.csv"), &[]).ok().flatten() else { return BTreeMap::new() };
    let columns = sheet.names().iter().filter(|name| EXTREMES.iter().any(|begin| name.starts_with(begin)));
    let rows = || 0..sheet.numbers("time").map_or(0, <[f64]>::len);
    columns.filter_map(|name| Some((name.clone(), span(&sheet, name, rows())?))).collect()
}

/// A column over some rows; entries that are no numbers are left out.
fn span(sheet: &Sheet, name: &str, rows: impl Iterator<Item = usize>) -> Option<Span> {
    let (times, values) = (sheet.numbers("time")?, sheet.numbers(name)?);
    let mut span: Option<Span> = None;
    for (time, value) in rows.map(|row| (times[row], values[row])).filter(|(_, value)| value.is_finite()) {
        let own =
            span.get_or_insert(Span { first: value, least: value, largest: value, largest_time: time, last: value });
        own.last = value;
        own.least = own.least.min(value);
        if value > own.largest {
            (own.largest, own.largest_time) = (value, time);
        }
    }
    span
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_has_both_ends_and_the_largest() {
        let folder = tempfile::tempdir().unwrap();
        let rows = "frame,time,body,speed\n0,0,a,1\n0,0,b,7\n1,0.5,a,5\n1,0.5,b,NaN\n2,1,a,-2\n2,1,b,6\n";
        std::fs::write(folder.path().join("bodies.csv"), rows).unwrap();
        let all = bodies(folder.path());
        let span = Span { first: 1.0, last: -2.0, least: -2.0, largest: 5.0, largest_time: 0.5 };
        assert_eq!((all.len(), all["a"]["speed"], all["b"]["speed"].last), (2, span, 6.0));
        std::fs::write(folder.path().join("diagnostics.csv"), "time,dt,max_pressure\n1,1,2\n2,1,3\n").unwrap();
        let all = extremes(folder.path());
        assert_eq!((all.len(), all["max_pressure"].largest, all["max_pressure"].largest_time), (1, 3.0, 2.0));
        assert!(bodies(Path::new("nowhere")).is_empty() && extremes(Path::new("nowhere")).is_empty());
    }
}
