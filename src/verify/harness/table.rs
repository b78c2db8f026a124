//! The table for people: aligned columns, one line per row.

use super::row::{Row, Solver, Verdict, short};

/// Heads of the columns.
pub(in crate::verify) const HEADS: [&str; 10] = [
    "case", "setting", "quantity", "reference", "source", "ours", "allowed", "verdict", "PCG mean/max",
    "Courant (bound)",
];

/// Entries of a row, in the order of [`HEADS`].
pub(in crate::verify) fn entries(row: &Row) -> [String; 10] {
    let iterations = |solver: &Solver| format!("{:.1}/{}", solver.mean_iterations, solver.max_iterations);
    let courant = |solver: &Solver| format!("{:.2} ({:.0})", solver.courant, solver.bound);
    let of = |text: &dyn Fn(&Solver) -> String| row.solver.as_ref().map(text).unwrap_or_default();
    [
        row.case.to_owned(),
        row.setting.clone(),
        row.quantity.clone(),
        row.reference.map(short).unwrap_or_default(),
        row.source.clone(),
        short(row.ours),
        row.allowed(),
        row.verdict().to_string(),
        of(&iterations),
        of(&courant),
    ]
}

/// All rows as text, with a last line that counts the verdicts.
pub fn table(rows: &[Row]) -> String {
    let lines: Vec<[String; 10]> = std::iter::once(HEADS.map(str::to_owned)).chain(rows.iter().map(entries)).collect();
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; 10] = std::array::from_fn(width);
    let mut text = String::new();
    for line in &lines {
        let padded = line.iter().zip(widths).map(|(entry, width)| format!("{entry:width$}"));
        text.push_str(padded.collect::<Vec<_>>().join("  ").trim_end());
        text.push('\n');
    }
    text + "\n" + &summary(rows)
}

/// How many rows stand how.
pub(in crate::verify) fn summary(rows: &[Row]) -> String {
    let count = |verdict: Verdict| rows.iter().filter(|row| row.verdict() == verdict).count();
    let [good, pass, known, fail, reported] =
        [Verdict::Good, Verdict::Pass, Verdict::Known, Verdict::Fail, Verdict::Reported].map(count);
    let gates = good + pass + known + fail;
    format!("{gates} gates: {good} good, {pass} pass, {known} known misses, {fail} fail; {reported} values reported")
}
