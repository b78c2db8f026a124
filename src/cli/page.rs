//! Pages that runs leave: everything inside one file, without scripts.

mod curves;
mod gauges;
pub(super) mod moving;
mod pieces;
pub(super) mod run;
pub(super) mod spans;
pub(super) mod sweep;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::check::size;
use crate::math::plain;
use crate::render::{PAGE_STYLE, escape};
use moving::Small;

/// Looks beside those of the report of `verify`.
const OWN_PAGE_STYLE: &str = "figure{margin:.6rem 0;display:flex;flex-wrap:wrap;gap:.6rem;align-items:flex-start}\
figure img{max-width:100%}img.last{flex:2 1 30rem;min-width:0}img.moving{flex:1 1 16rem;min-width:0}\
.sides{display:flex;flex-wrap:wrap;gap:2rem}.sides table{width:auto;flex:1 1 20rem}.wide{overflow-x:auto}pre{overflow:auto;font-size:.75rem}";

/// The head of a page up to its first heading.
pub(super) fn start(title: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{}</title>\n\
         <meta name=\"viewport\" content=\"width=device-width\"><style>{PAGE_STYLE}{OWN_PAGE_STYLE}</style></head><body>\n",
        escape(title)
    )
}

/// The verdict on `[expect]`, if there is one.
pub(super) fn checks(page: &mut String, report: &Value) {
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

/// The device of a report.
pub(super) fn device_text(device: &Value) -> String {
    let text = |key: &str| device[key].as_str().unwrap_or_default().to_owned();
    format!("{} ({}, {})", text("name"), text("backend"), text("driver"))
}

/// Cells along each axis.
pub(super) fn cells(report: &Value) -> String {
    let domain = &report["scene"]["domain"];
    let axes = domain["dimension"].as_u64().unwrap_or(0) as usize;
    let cells = domain["cells"].as_array().into_iter().flatten().take(axes);
    cells.map(ToString::to_string).collect::<Vec<_>>().join(" x ")
}

/// Memory of the device.
pub(super) fn memory(report: &Value) -> String {
    let groups = report["memory"].as_object().into_iter().flatten();
    size(groups.filter_map(|(_, bytes)| bytes.as_u64()).sum())
}

/// The last picture as it is, and all of them as a small moving one.
pub(super) fn pictures(page: &mut String, frames: &Path, small: &Small) {
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(frames).into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|end| end == "png"));
    files.sort();
    let Some(last) = files.last().and_then(|path| std::fs::read(path).ok()) else {
        let _ = writeln!(page, "<p>No picture.</p>");
        return;
    };
    let _ =
        write!(page, "<figure><img class=\"last\" alt=\"the end\" src=\"data:image/png;base64,{}\">", base64(&last));
    match small.of_files(&files) {
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

/// A table of names and values.
pub(super) fn table(page: &mut String, head: &str, rows: &[(String, String)]) {
    let _ = writeln!(page, "<table><thead><tr><th>{head}</th><th></th></tr></thead><tbody>");
    for (name, value) in rows {
        let _ = writeln!(page, "<tr><td>{}</td><td>{}</td></tr>", escape(name), escape(value));
    }
    let _ = writeln!(page, "</tbody></table>");
}

/// What the scene asks for.
pub(super) fn parameters(report: &Value) -> Vec<(String, String)> {
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

/// A number, or a dash.
pub(super) fn number(value: &Value) -> String {
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
