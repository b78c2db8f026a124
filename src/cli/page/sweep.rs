//! `sweep.html`: the table of a sweep as plots.

use std::fmt::Write as _;
use std::path::Path;

use super::{number, start};
use crate::Result;
use crate::export::atomic;
use crate::export::csv::Sheet;
use crate::render::{Plot, Style, escape};

/// Curves of one plot, at most; more points are marks of one kind.
const MOST_CURVES: usize = 8;
/// Columns that say nothing about what the runs found.
const ASIDE: [&str; 2] = ["run", "status"];

/// Writes the page of a sweep over keys from its `sweep.csv`.
///
/// # Errors
/// [`crate::Error::Io`] if the table cannot be read, or the page not be written.
pub(in crate::cli) fn write(out: &Path, title: &str, keys: &[String]) -> Result<()> {
    let texts: Vec<&str> = keys.iter().map(String::as_str).chain(["status"]).collect();
    let Some(sheet) = Sheet::read(&out.join("sweep.csv"), &texts)? else { return Ok(()) };
    let page = html(title, keys, &sheet);
    atomic::write(&out.join("sweep.html"), |file| file.write_all(page.as_bytes()))
}

fn html(title: &str, keys: &[String], sheet: &Sheet) -> String {
    let runs = sheet.numbers("run").unwrap_or_default();
    let mut page = start(&format!("Brisance: sweep of {title}"));
    let over: Vec<String> = keys.iter().map(|key| format!("<code>{}</code>", escape(key))).collect();
    let _ = writeln!(page, "<h1>Sweep of {}</h1>\n<p>{} runs over {}.</p>", escape(title), runs.len(), over.join(", "));
    let measured: Vec<&String> = sheet
        .names()
        .iter()
        .filter(|name| !ASIDE.contains(&name.as_str()) && !keys.contains(name))
        .filter(|name| changes(sheet.numbers(name).unwrap_or_default()))
        .collect();
    for (index, key) in keys.iter().enumerate() {
        let Some(x) = numbers(sheet, key) else { continue };
        let others: Vec<&String> = keys.iter().enumerate().filter(|(k, _)| *k != index).map(|(_, key)| key).collect();
        let plots = measured.iter().map(|name| plot(sheet, (key, &x), name, &others).svg());
        let _ =
            writeln!(page, "<h2>Over {}</h2>\n<div class=\"plots\">{}</div>", escape(key), plots.collect::<String>());
    }
    let _ = writeln!(page, "<h2>Table</h2>");
    table(&mut page, keys, &measured, sheet);
    page + "</body></html>\n"
}

fn changes(values: &[f64]) -> bool {
    let mut finite = values.iter().filter(|value| value.is_finite());
    let first = finite.next();
    finite.any(|value| Some(value) != first)
}

/// The values of a key, if all of them are numbers.
fn numbers(sheet: &Sheet, key: &str) -> Option<Vec<f64>> {
    sheet.texts(key)?.iter().map(|text| text.parse().ok()).collect()
}

/// A number over a key: a curve for each choice of the other keys, where these are few.
fn plot(sheet: &Sheet, (key, x): (&str, &[f64]), name: &str, others: &[&String]) -> Plot {
    let y = sheet.numbers(name).unwrap_or_default();
    let choice = |row: usize| {
        let value = |other: &&String| Some(format!("{} {}", other.rsplit('.').next()?, sheet.texts(other)?.get(row)?));
        others.iter().filter_map(value).collect::<Vec<_>>().join(", ")
    };
    let choices: Vec<String> = (0..x.len()).map(choice).collect();
    let mut curves: Vec<&String> = choices.iter().collect();
    curves.sort();
    curves.dedup();
    let empty = Plot::new(name.replace('_', " "), key, name.replace('_', " "));
    if curves.len() > MOST_CURVES {
        return empty.with("runs", Style::Marks, x.iter().zip(y).map(|(x, y)| [*x, *y]).collect());
    }
    curves.into_iter().fold(empty, |plot, curve| {
        let own = (0..x.len()).filter(|row| choices[*row] == *curve);
        let mut points: Vec<[f64; 2]> = own.map(|row| [x[row], y[row]]).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        plot.with(if curve.is_empty() { "runs" } else { curve }, Style::Both, points)
    })
}

fn table(page: &mut String, keys: &[String], measured: &[&String], sheet: &Sheet) {
    let names = ["run", "status"].into_iter().chain(keys.iter().chain(measured.iter().copied()).map(String::as_str));
    let heads: String = names.map(|name| format!("<th>{}</th>", escape(&name.replace('_', " ")))).collect();
    let _ = writeln!(page, "<div class=\"wide\"><table><thead><tr>{heads}</tr></thead><tbody>");
    for (row, run) in sheet.numbers("run").unwrap_or_default().iter().enumerate() {
        let text = |name: &str| escape(sheet.texts(name).map_or("", |all| &all[row]));
        let link = format!("<td><a href=\"{run:04}/report.html\">{run:04}</a></td><td>{}</td>", text("status"));
        let values: String = keys.iter().map(|key| format!("<td>{}</td>", text(key))).collect();
        let real = |name: &&String| sheet.numbers(name).map_or(f64::NAN, |all| all[row]);
        let rest: String = measured.iter().map(|name| format!("<td>{}</td>", number(&real(name).into()))).collect();
        let _ = writeln!(page, "<tr>{link}{values}{rest}</tr>");
    }
    let _ = writeln!(page, "</tbody></table></div>");
}
