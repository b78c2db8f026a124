//! The page of a gallery: everything inside one file.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde_json::Value;

use super::Shown;
use crate::cli::args::Cli;
use crate::cli::check::size;
use crate::cli::progress::clock;
use crate::export::apng;
use crate::math::plain;
use crate::verify::{STYLE, escape};

/// Width of the moving pictures, at most \[pixels\].
const MOVING_WIDTH: u32 = 480;
/// Pictures in a moving one, at most.
const MOVING_FRAMES: usize = 32;
/// How long each of them stands \[ms\].
const DELAY: u16 = 120;

/// Looks beside those of the report of `verify`.
const OWN_STYLE: &str = "figure{margin:.6rem 0;display:flex;flex-wrap:wrap;gap:.6rem;align-items:flex-start}\
figure img{max-width:100%}img.last{flex:2 1 30rem;min-width:0}img.moving{flex:1 1 16rem;min-width:0}\
.sides{display:flex;flex-wrap:wrap;gap:2rem}.sides table{width:auto;flex:1 1 20rem}";

/// The page. A picture that cannot be read is left out, and said.
pub(super) fn html(out: &Path, shown: &[&Shown], elapsed: Duration, cli: &Cli) -> String {
    let failed = shown.iter().filter(|one| one.error.is_some()).count();
    let device = shown.iter().map(|one| &one.report["device"]).find(|device| device.is_object());
    let device = device.map_or_else(|| "no device".to_owned(), device_text);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let chosen = cli.device.as_ref().map(|name| format!(" --device {name}")).unwrap_or_default();
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Brisance: gallery</title>\n\
         <meta name=\"viewport\" content=\"width=device-width\"><style>{STYLE}{OWN_STYLE}</style></head><body>\n\
         <h1>Gallery of Brisance {}</h1>\n<p>{} scenes, {failed} failed, in {} on {}{}, {cores} processor cores.</p>\n",
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

fn device_text(device: &Value) -> String {
    let text = |key: &str| device[key].as_str().unwrap_or_default().to_owned();
    format!("{} ({}, {})", text("name"), text("backend"), text("driver"))
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

fn cells(report: &Value) -> String {
    let domain = &report["scene"]["domain"];
    let axes = domain["dimension"].as_u64().unwrap_or(0) as usize;
    let cells = domain["cells"].as_array().into_iter().flatten().take(axes);
    cells.map(ToString::to_string).collect::<Vec<_>>().join(" x ")
}

fn memory(report: &Value) -> String {
    let groups = report["memory"].as_object().into_iter().flatten();
    size(groups.filter_map(|(_, bytes)| bytes.as_u64()).sum())
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
    pictures(page, &out.join(&one.entry.id).join("frames"));
    let _ = writeln!(page, "<div class=\"sides\">");
    table(page, "parameter", &parameters(report));
    table(page, "number", &numbers(one));
    let _ = writeln!(page, "</div>");
    let checks = report["expect"].as_array().map(Vec::as_slice).unwrap_or_default();
    if !checks.is_empty() {
        let _ = writeln!(
            page,
            "<table><thead><tr><th>expected</th><th>allowed</th><th>measured</th><th>verdict</th>\
                                </tr></thead><tbody>"
        );
        for check in checks {
            let text = |key: &str| escape(check[key].as_str().unwrap_or_default());
            let verdict = if check["passed"].as_bool() == Some(true) { "pass" } else { "fail" };
            let _ = writeln!(
                page,
                "<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"{verdict}\">{verdict}</td></tr>",
                text("name"),
                text("allowed"),
                number(&check["measured"]),
            );
        }
        let _ = writeln!(page, "</tbody></table>");
    }
}

/// The last picture as it is, and all of them as a small moving one.
fn pictures(page: &mut String, frames: &Path) {
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(frames).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|end| end == "png"));
    files.sort();
    let Some(last) = files.last().and_then(|path| std::fs::read(path).ok()) else {
        let _ = writeln!(page, "<p>No picture.</p>");
        return;
    };
    let step = files.len().div_ceil(MOVING_FRAMES).max(1);
    let some: Vec<PathBuf> = files.iter().step_by(step).cloned().collect();
    let _ =
        write!(page, "<figure><img class=\"last\" alt=\"the end\" src=\"data:image/png;base64,{}\">", base64(&last));
    match apng::moving(&some, MOVING_WIDTH, DELAY) {
        Ok(moving) => {
            let _ = write!(
                page,
                "<img class=\"moving\" alt=\"the run\" src=\"data:image/png;base64,{}\">",
                base64(&moving)
            );
        }
        Err(error) => {
            let _ = write!(page, "<figcaption>{}</figcaption>", escape(&error.to_string()));
        }
    }
    let _ = writeln!(page, "</figure>");
}

fn table(page: &mut String, head: &str, rows: &[(String, String)]) {
    let _ = writeln!(page, "<table><thead><tr><th>{head}</th><th></th></tr></thead><tbody>");
    for (name, value) in rows {
        let _ = writeln!(page, "<tr><td>{}</td><td>{}</td></tr>", escape(name), escape(value));
    }
    let _ = writeln!(page, "</tbody></table>");
}

/// What the scene asks for.
fn parameters(report: &Value) -> Vec<(String, String)> {
    let scene = &report["scene"];
    let state = |state: &Value| format!("density {}, pressure {}", state["density"], state["pressure"]);
    let mut rows = vec![
        ("grid".to_owned(), cells(report)),
        ("until".to_owned(), scene["time"]["until"].to_string()),
        ("ambient gas".to_owned(), state(&scene["gas"]["ambient"])),
    ];
    let regions = scene["gas"]["regions"].as_array().into_iter().flatten();
    rows.extend(regions.enumerate().map(|(index, region)| (format!("gas region {}", index + 1), state(region))));
    for (name, law) in scene["materials"].as_object().into_iter().flatten() {
        for (kind, keys) in law.as_object().into_iter().flatten() {
            let keys = keys.as_object().into_iter().flatten();
            let keys: Vec<String> = keys.map(|(key, value)| format!("{key} {value}").replace('_', " ")).collect();
            rows.push((format!("material {name}"), format!("{}: {}", kind.replace('_', " "), keys.join(", "))));
        }
    }
    for body in scene["bodies"].as_array().into_iter().flatten() {
        let name = body["name"].as_str().unwrap_or_default();
        let material = body["material"].as_str().unwrap_or_default();
        rows.push((format!("body {name}"), format!("{material}, density {}", body["density"])));
    }
    rows
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

fn number(value: &Value) -> String {
    value.as_f64().map_or_else(|| "-".to_owned(), plain)
}

/// Bytes as text. [RFC 4648, section 4]
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let three = [group[0], group.get(1).copied().unwrap_or(0), group.get(2).copied().unwrap_or(0)];
        let bits = u32::from_be_bytes([0, three[0], three[1], three[2]]);
        for place in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * place)) as usize & 63];
            text.push(if place <= group.len() { digit.into() } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_as_text() {
        // RFC 4648, section 10
        for (bytes, text) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
        assert_eq!(base64(&[0xff, 0xfe, 0x00]), "//4A");
    }
}
