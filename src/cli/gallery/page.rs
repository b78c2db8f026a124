//! The page of a gallery: everything inside one file.

use std::fmt::Write as _;
use std::path::Path;
use std::time::Duration;

use super::Shown;
use crate::cli::args::Cli;
use crate::cli::page::moving::Small;
use crate::cli::page::{cells, checks, device_text, memory, number, parameters, pictures, start, table};
use crate::cli::progress::clock;
use crate::render::escape;

/// Width of the moving pictures, at most \[pixels\].
const MOVING_WIDTH: u32 = 480;

/// The page. A picture that cannot be read is left out, and said.
pub(super) fn html(out: &Path, shown: &[&Shown], elapsed: Duration, cli: &Cli) -> String {
    let failed = shown.iter().filter(|one| one.error.is_some()).count();
    let device = shown.iter().map(|one| &one.report["device"]).find(|device| device.is_object());
    let device = device.map_or_else(|| "no device".to_owned(), device_text);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let chosen = cli.device.as_ref().map(|name| format!(" --device {name}")).unwrap_or_default();
    let mut page = start("Brisance: gallery");
    let _ = writeln!(
        page,
        "<h1>Gallery of Brisance {}</h1>\n<p>{} scenes, {failed} failed, in {} on {}{}, {cores} processor cores.</p>\n",
        env!("CARGO_PKG_VERSION"),
        shown.len(),
        clock(elapsed),
        escape(&device),
        escape(&chosen),
    );
    overview(&mut page, shown);
    for one in shown {
        section(&mut page, out, one);
    }
    page + "</body></html>\n"
}

/// One line per scene.
fn overview(page: &mut String, shown: &[&Shown]) {
    let _ = writeln!(
        page,
        "<table><thead><tr><th>scene</th><th>cells</th><th>particles</th><th>memory</th>\
                            <th>steps</th><th>time</th><th>verdict</th></tr></thead><tbody>"
    );
    for one in shown {
        let (id, verdict) = (escape(&one.entry.id), if one.error.is_none() { "pass" } else { "fail" });
        let _ = writeln!(
            page,
            "<tr><td><a href=\"#{id}\">{id}</a></td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>\
             <td class=\"{verdict}\">{verdict}</td></tr>",
            cells(&one.report),
            one.report["particles"],
            memory(&one.report),
            one.report["steps"],
            clock(Duration::from_secs_f64(one.seconds)),
        );
    }
    let _ = writeln!(page, "</tbody></table>");
}

fn section(page: &mut String, out: &Path, one: &Shown) {
    let (report, scene) = (&one.report, &one.report["scene"]);
    let title = scene["title"].as_str().unwrap_or(&one.entry.id);
    let text = scene["description"].as_str().unwrap_or_default();
    let (id, command) = (escape(&one.entry.id), escape(&one.command()));
    let _ = writeln!(page, "<h2 id=\"{id}\">{}</h2>\n<p>{} <code>{command}</code></p>", escape(title), escape(text));
    if let Some(error) = &one.error {
        let _ = writeln!(page, "<p class=\"fail\">{}</p>", escape(error));
    }
    pictures(page, &out.join(&one.entry.id).join("frames"), &Small::none(MOVING_WIDTH));
    let _ = writeln!(page, "<div class=\"sides\">");
    table(page, "parameter", &parameters(report));
    table(page, "number", &numbers(one));
    let _ = writeln!(page, "</div>");
    checks(page, report);
}

/// What the run took and found.
fn numbers(one: &Shown) -> Vec<(String, String)> {
    let report = &one.report;
    let steps = report["steps"].as_f64().unwrap_or(0.0).max(1.0);
    let totals = |key: &str| report["totals"][key].as_f64().unwrap_or(f64::NAN);
    let mut rows = vec![
        ("particles".to_owned(), report["particles"].to_string()),
        ("memory of the device".to_owned(), memory(report)),
        ("time".to_owned(), clock(Duration::from_secs_f64(one.seconds))),
        ("steps".to_owned(), report["steps"].to_string()),
        (
            "PCG iterations per step".to_owned(),
            format!("{:.1}, at most {}", totals("pcg_iterations") / steps, totals("pcg_iterations_max")),
        ),
        ("elastic sub-steps per step".to_owned(), format!("{:.1}", totals("substeps") / steps)),
    ];
    for key in ["min_density", "min_pressure", "max_speed", "floored_cells"] {
        rows.push((key.replace('_', " "), number(&report["totals"][key])));
    }
    for (key, drift) in report["drift"].as_object().into_iter().flatten() {
        rows.push((format!("change of {}", key.replace('_', " ")), number(drift)));
    }
    rows
}
