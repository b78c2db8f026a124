//! The result as files: a page that needs nothing else, an object for programs, a table for the documentation.

use std::fmt::Write as _;

use serde::Serialize;
use serde_json::json;

use super::Case;
use super::row::{Row, Verdict, short};
use super::table::{HEADS, entries, summary};
use crate::render::{PAGE_STYLE, Plot, escape};

/// What a document says about the verification as a whole.
#[derive(Clone, Debug, Serialize)]
pub struct Head {
    /// Version of the program.
    pub version: &'static str,
    /// The command line.
    pub command: String,
    /// Name and driver of the device.
    pub device: String,
    /// Whether the device is a processor in the role of a GPU.
    pub software: bool,
    /// Wall time \[s\].
    pub seconds: f64,
    /// The registry, in the order of the report.
    #[serde(skip)]
    pub cases: Vec<&'static Case>,
}

fn class(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Good => "good",
        Verdict::Pass => "pass",
        Verdict::Known => "known",
        Verdict::Fail => "fail",
        Verdict::Reported => "",
    }
}

/// Cases that have rows, with them.
fn by_case<'a>(head: &'a Head, rows: &'a [Row]) -> impl Iterator<Item = (&'static Case, Vec<&'a Row>)> {
    let own = move |case: &'static Case| (case, rows.iter().filter(|row| row.case == case.id).collect::<Vec<_>>());
    head.cases.iter().copied().map(own).filter(|(_, rows)| !rows.is_empty())
}

/// The result as one HTML page without anything outside of it.
pub fn html(head: &Head, rows: &[Row], plots: &[(&'static str, Plot)]) -> String {
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Brisance: verification</title>\n\
         <meta name=\"viewport\" content=\"width=device-width\"><style>{PAGE_STYLE}</style></head><body>\n\
         <h1>Verification of Brisance {}</h1>\n<p><code>{}</code> on {} in {:.0} s. {}.</p>\n",
        head.version,
        escape(&head.command),
        escape(&head.device),
        head.seconds,
        summary(rows)
    );
    page.push_str(
        "<p>PCG: iterations of the pressure solve per step, mean and most. Courant: largest acoustic Courant number of the run, and \
         the iterations that suffice there. A gate marked good is that of a sharp method.</p>\n",
    );
    let of = |id: &str| plots.iter().filter(|(own, _)| *own == id).map(|(_, plot)| plot.svg()).collect::<String>();
    let _ = writeln!(page, "<div class=\"plots\">{}</div>", of(""));
    let mut group = "";
    for (case, own) in by_case(head, rows) {
        // Writing to a String cannot fail.
        if case.group != group {
            group = case.group;
            let _ = writeln!(page, "<h2>{}</h2>", escape(group));
        }
        let (id, title, source) = (escape(case.id), escape(case.title), escape(case.source));
        let _ = writeln!(page, "<h3 id=\"{id}\">{title}</h3><p><code>{id}</code>. {source}</p>");
        let heads: String = HEADS[1..].iter().map(|text| format!("<th>{text}</th>")).collect();
        let _ = writeln!(page, "<table><thead><tr>{heads}</tr></thead><tbody>");
        for row in own {
            let cell = |(k, text): (usize, &String)| match k {
                6 => format!("<td class=\"{}\">{}</td>", class(row.verdict()), escape(text)),
                _ => format!("<td>{}</td>", escape(text)),
            };
            let cells: String = entries(row)[1..].iter().enumerate().map(cell).collect();
            let _ = writeln!(page, "<tr>{cells}</tr>");
        }
        let _ = writeln!(page, "</tbody></table>\n<div class=\"plots\">{}</div>", of(case.id));
    }
    page + "</body></html>\n"
}

/// The result as an object.
pub fn json(head: &Head, rows: &[Row], seconds: &[(&str, f64)]) -> serde_json::Value {
    let row = |row: &Row| {
        let mut object = json!(row);
        object["verdict"] = json!(row.verdict());
        object
    };
    let case = |(case, rows): (&Case, Vec<&Row>)| {
        let rows: Vec<_> = rows.into_iter().map(row).collect();
        let seconds = seconds.iter().find(|(id, _)| *id == case.id).map(|(_, seconds)| seconds);
        json!({ "id": case.id, "title": case.title, "group": case.group, "source": case.source, "seconds": seconds, "rows": rows })
    };
    let passed = rows.iter().all(|row| row.verdict() != Verdict::Fail);
    let cases: Vec<_> = by_case(head, rows).map(case).collect();
    json!({ "verification": head, "passed": passed, "summary": summary(rows), "cases": cases })
}

/// One line per case: what it is compared with, one measure, and how many of its gates hold. The measure is the first with a gate, on 400
/// cells where there is one.
fn overview(head: &Head, rows: &[Row]) -> String {
    let mut text = String::from(
        "\n| Case | Compared with | Measure | Found | Allowed | Gates held |\n|---|---|---|---|---|---|\n",
    );
    for (case, own) in by_case(head, rows) {
        let gated: Vec<_> = own.iter().filter(|row| row.pass.is_some()).collect();
        let Some(shown) = gated.iter().find(|row| row.setting.ends_with(" 400")).or(gated.first()) else { continue };
        let held = gated.iter().filter(|row| matches!(row.verdict(), Verdict::Good | Verdict::Pass)).count();
        let allowed = shown.pass.map(|limit| limit.to_string()).unwrap_or_default();
        let measure = [&shown.quantity, &shown.setting].map(|text| text.replace('|', "\\|")).join(", ");
        let measure = measure.trim_end_matches(", ");
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "| {} (`{}`) | {} | {measure} | {} | {allowed} | {held} of {} |",
            case.title,
            case.id,
            case.source,
            short(shown.ours),
            gated.len()
        );
    }
    text
}

/// The result as tables in Markdown: an overview with one line per case, then one table per case.
pub fn markdown(head: &Head, rows: &[Row]) -> String {
    let mut text = format!("`{}` on {}, {:.0} s: {}.\n", head.command, head.device, head.seconds, summary(rows));
    text += &overview(head, rows);
    let mut group = "";
    for (case, own) in by_case(head, rows) {
        if case.group != group {
            group = case.group;
            let _ = write!(text, "\n## {group}\n");
        }
        let _ = write!(text, "\n### {}\n\n`{}`. {}\n\n", case.title, case.id, case.source);
        let _ = writeln!(text, "| {} |\n|{}", HEADS[1..].join(" | "), "---|".repeat(HEADS.len() - 1));
        for row in own {
            let entries = entries(row)[1..].iter().map(|entry| entry.replace('|', "\\|")).collect::<Vec<_>>();
            let _ = writeln!(text, "| {} |", entries.join(" | "));
        }
    }
    text
}
