//! `report.html`: a run on one page.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;

use super::curves::Tables;
pub(in crate::cli) use super::curves::gauges;
use super::moving::Small;
use super::pieces;
use super::{cells, checks, device_text, memory, number, parameters, pictures, start, table};
use crate::Result;
use crate::export::atomic;
use crate::math::plain;
use crate::render::{Plot, escape};

/// Name of the file.
pub(in crate::cli) const NAME: &str = "report.html";

/// Writes the page of a run that has ended, from its report, its scene as text, its tables and its pictures, small ones of which are kept.
///
/// # Errors
/// [`crate::Error::Io`] if it cannot be written.
pub(in crate::cli) fn write(folder: &Path, report: &Value, scene: &str, small: &Small) -> Result<()> {
    let page = html(folder, report, scene, small);
    atomic::write(&folder.join(NAME), |out| out.write_all(page.as_bytes()))
}

fn html(folder: &Path, report: &Value, scene: &str, small: &Small) -> String {
    let (tables, title) = (Tables::read(folder), report["scene"]["title"].as_str().unwrap_or("a run"));
    let text = |key: &str| escape(report[key].as_str().unwrap_or_default());
    let mut page = start(&format!("Brisance: {title}"));
    let status = if report["status"] == "finished" && report["outcome"] == "finished" { "pass" } else { "fail" };
    let _ = writeln!(
        page,
        "<h1>{}</h1>\n<p>{}</p>\n<p><span class=\"{status}\">{}</span>: {}. t = {} s after {} steps.</p>",
        escape(title),
        escape(report["scene"]["description"].as_str().unwrap_or_default()),
        text("status"),
        text("outcome"),
        number(&report["time"]),
        report["steps"],
    );
    for wrong in &tables.wrong {
        let _ = writeln!(page, "<p class=\"fail\">{}</p>", escape(wrong));
    }
    pictures(&mut page, &folder.join("frames"), small);
    heading(&mut page, "Verdict");
    verdict(&mut page, report);
    let axes = report["scene"]["domain"]["dimension"].as_u64().unwrap_or(3).clamp(1, 3) as usize;
    let (gauges, more) = (tables.gauges(), tables.forces_and_points(axes));
    if !(gauges.is_empty() && more.is_empty()) {
        heading(&mut page, "Gauges");
        measured(&mut page, &gauges);
        plots(&mut page, gauges.into_iter().map(|(_, _, plot)| plot).chain(more));
    }
    let bodies = tables.bodies(axes);
    if !bodies.is_empty() {
        heading(&mut page, "Bodies and obstacles");
        plots(&mut page, bodies);
    }
    if let Some(sheet) = &tables.fragments {
        heading(&mut page, "Pieces");
        page += &pieces::table(sheet);
        plots(&mut page, [pieces::speeds(sheet)]);
    }
    heading(&mut page, "Budgets");
    let drift = report["drift"].as_object().into_iter().flatten();
    let drift: Vec<_> =
        drift.map(|(key, value)| (format!("change of {}", key.replace('_', " ")), number(value))).collect();
    table(&mut page, "relative change since the start, with what crossed the sides", &drift);
    plots(&mut page, tables.budgets(axes));
    heading(&mut page, "Largest values over time");
    plots(&mut page, tables.extremes());
    heading(&mut page, "Scene and changes");
    table(&mut page, "parameter", &parameters(report));
    changes(&mut page, report, scene);
    heading(&mut page, "What it took");
    took(&mut page, report);
    page + "</body></html>\n"
}

fn heading(page: &mut String, text: &str) {
    let _ = writeln!(page, "<h2>{text}</h2>");
}

fn plots(page: &mut String, plots: impl IntoIterator<Item = Plot>) {
    let all: String = plots.into_iter().map(|plot| plot.svg()).collect();
    let _ = writeln!(page, "<div class=\"plots\">{all}</div>");
}

/// `[expect]`, and what the program warns of.
fn verdict(page: &mut String, report: &Value) {
    if report["expect"].as_array().is_none_or(Vec::is_empty) {
        let _ = writeln!(page, "<p>Nothing was compared with [expect].</p>");
    }
    checks(page, report);
    let warnings = report["warnings"].as_array().map(Vec::as_slice).unwrap_or_default();
    let rows: Vec<_> = warnings
        .iter()
        .map(|warning| {
            let text = |key: &str| warning[key].as_str().unwrap_or_default().to_owned();
            let expected =
                warning["expected"].as_str().map(|reason| format!(" (expected: {reason})")).unwrap_or_default();
            let value = format!("{}, at most {}{expected}", number(&warning["measured"]), number(&warning["limit"]));
            (text("name").replace('_', " "), format!("{value}. {}", text("place")))
        })
        .collect();
    if rows.is_empty() {
        let _ = writeln!(page, "<p>No warnings.</p>");
    } else {
        table(page, "warning", &rows);
    }
}

fn measured(page: &mut String, gauges: &[(String, Option<crate::expect::Gauge>, Plot)]) {
    if gauges.is_empty() {
        return;
    }
    let _ = writeln!(
        page,
        "<table><thead><tr><th>gauge</th><th>first pressure [Pa]</th><th>arrival [s]</th><th>peak overpressure [Pa]</th>\
         <th>at [s]</th><th>positive phase [s]</th><th>impulse [Pa s]</th></tr></thead><tbody>"
    );
    for (name, gauge, _) in gauges {
        let entries = gauge.map_or_else(
            || "<td colspan=\"6\">never in gas</td>".to_owned(),
            |gauge| {
                let time = |time: Option<f64>, none: &str| time.map_or_else(|| none.to_owned(), plain);
                let phase = time(gauge.positive_phase, if gauge.arrival.is_some() { "not over" } else { "-" });
                let (first, peak) = (plain(gauge.first), plain(gauge.peak_overpressure));
                let all =
                    [first, time(gauge.arrival, "none"), peak, plain(gauge.peak_time), phase, plain(gauge.impulse)];
                all.map(|entry| format!("<td>{entry}</td>")).concat()
            },
        );
        let _ = writeln!(page, "<tr><td>{}</td>{entries}</tr>", escape(name));
    }
    let _ = writeln!(
        page,
        "</tbody></table>\n<p>Overpressure is that over the first pressure. Arrival: it passes a twentieth of the first pressure. \
         The positive phase ends where the first pressure comes back after the peak; the impulse is the integral over it.</p>"
    );
}

fn changes(page: &mut String, report: &Value, scene: &str) {
    let all = report["changes"].as_array().into_iter().flatten().filter_map(Value::as_str);
    let all: String = all.map(|change| format!("<li><code>{}</code></li>", escape(change))).collect();
    let file = escape(report["scene_file"].as_str().unwrap_or_default());
    let list =
        if all.is_empty() { "<p>No changes on the command line.</p>".to_owned() } else { format!("<ul>{all}</ul>") };
    let _ = writeln!(
        page,
        "<p>Scene <code>{file}</code>, hash <code>{}</code>.</p>{list}\n<details><summary>The scene with every default</summary>\
         <pre>{}</pre></details>",
        escape(report["scene_hash"].as_str().unwrap_or_default()),
        escape(scene)
    );
}

fn took(page: &mut String, report: &Value) {
    let seconds = |value: &Value| format!("{} s", number(value));
    let steps = report["steps"].as_f64().unwrap_or(0.0).max(1.0);
    let mut rows = vec![
        ("device".to_owned(), device_text(&report["device"])),
        ("brisance".to_owned(), report["version"].as_str().unwrap_or_default().to_owned()),
        ("grid".to_owned(), cells(report)),
        ("particles".to_owned(), report["particles"].to_string()),
        ("memory of the device".to_owned(), memory(report)),
        ("time on the clock".to_owned(), seconds(&report["wall_seconds"])),
        ("steps".to_owned(), report["steps"].to_string()),
        ("frames".to_owned(), report["frames"].to_string()),
    ];
    for (name, value) in report["timings"].as_object().into_iter().flatten() {
        rows.push((format!("time of {}", name.replace('_', " ")), seconds(value)));
    }
    for (name, label) in [("pcg_iterations", "PCG iterations per step"), ("substeps", "elastic sub-steps per step")] {
        rows.push((label.to_owned(), plain(report["totals"][name].as_f64().unwrap_or(f64::NAN) / steps)));
    }
    table(page, "what", &rows);
}
