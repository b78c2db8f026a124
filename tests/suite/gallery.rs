//! `brisance gallery`: scenes one after another, one page, and scenes that fail.

use std::path::Path;
use std::process::{Command, Output};

use crate::common::folder_or_skip;

/// A tube of eight cells with a variant that does not do what it promises, and two that differ in the density.
const SCENE: &str = r#"
title = "Tube & test"
description = "Eight cells."
[domain]
dimension = 1
cells = [8]
size = [1.0]
[gas]
ambient = { density = 1.0, pressure = 1.0 }
[time]
until = 0.1
frames = 2
[render]
size = [64, 48]
[expect]
min_pressure = 0.5
[variants.small]
domain.cells = [4]
[variants.gallery]
domain.cells = [6]
[variants.dense]
gas.ambient.density = 2.0
[variants.wrong]
expect.min_pressure = 2.0
[variants.long]
time.until = 400.0
"#;

fn gallery(folder: &Path, names: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_brisance"));
    command.arg("gallery").args(names).args(["--out", "shown"]).current_dir(folder).output().unwrap()
}

/// What `--json` prints.
fn printed(output: &Output) -> serde_json::Value {
    let first = String::from_utf8_lossy(&output.stdout).lines().next().unwrap_or_default().to_owned();
    serde_json::from_str(&first).unwrap_or_else(|error| panic!("{error}: {first}"))
}

#[test]
fn a_gallery_shows_every_variant_and_says_which_failed() {
    let Some(folder) = folder_or_skip() else { return };
    std::fs::write(folder.path().join("tube.toml"), SCENE).unwrap();
    // the one that fails comes first: the other runs all the same
    let output = gallery(folder.path(), &["tube.toml:wrong", "tube.toml:dense", "--json"]);
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(8), "{text}");
    assert!(text.contains("1 of 2 scenes failed: tube-wrong"), "{text}");
    let object = printed(&output);
    let passed: Vec<_> = object["scenes"].as_array().unwrap().iter().map(|scene| &scene["passed"]).collect();
    assert_eq!(passed, [false, true]);
    assert_eq!(object["scenes"][1]["variants"], serde_json::json!(["small", "dense"]));

    let page = std::fs::read_to_string(folder.path().join("shown/gallery.html")).unwrap();
    for part in ["Tube &amp; test", "tube-wrong", "tube-dense", "min_pressure", "above 2", "density 2", "<td>4</td>"] {
        assert!(page.contains(part), "no `{part}` in the page");
    }
    // nothing outside of the file: every picture is inside, and there is no other reference
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 4);
    assert_eq!(page.matches("src=").count(), 4);
    assert_eq!(page.matches("class=\"fail\"").count(), 3, "overview, error, check");
    assert!(!page.contains("http") && !page.contains("<script") && !page.contains("url("));
}

#[test]
fn a_gallery_takes_scenes_at_the_size_asked_for_and_knows_its_names() {
    let Some(folder) = folder_or_skip() else { return };
    std::fs::write(folder.path().join("tube.toml"), SCENE.split("[variants.wrong]").next().unwrap()).unwrap();
    for (scale, cells) in [("full", 8), ("gallery", 6), ("small", 4)] {
        let output = gallery(folder.path(), &["tube.toml", "--scale", scale, "-q", "--json"]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(printed(&output)["scenes"].as_array().unwrap().len(), 1, "a size is no entry of its own");
        let report = std::fs::read_to_string(folder.path().join("shown/tube-dense/report.json")).unwrap();
        let report: serde_json::Value = serde_json::from_str(&report).unwrap();
        assert_eq!(report["scene"]["domain"]["cells"][0], cells);
    }

    for (name, part) in [("tube.toml:thick", "there are: dense\n"), ("nowhere", "no shipped scene")] {
        let output = gallery(folder.path(), &[name]);
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(matches!(output.status.code(), Some(2 | 3)) && text.contains(part), "{text}");
    }
}

#[test]
fn a_gallery_runs_scenes_at_a_time_and_shows_them_in_order() {
    let Some(folder) = folder_or_skip() else { return };
    std::fs::write(folder.path().join("tube.toml"), SCENE).unwrap();
    let names = ["tube.toml:long", "tube.toml:dense", "--json", "--jobs"];
    let line = |text: &str, wanted: &str| {
        text.lines().position(|line| line == wanted).unwrap_or_else(|| panic!("no `{wanted}` in {text}"))
    };
    for (jobs, together) in [("1", false), ("2", true)] {
        let output = gallery(folder.path(), &[&names[..], &[jobs]].concat());
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{text}");
        // the second begins while the first, some thousand times as long, still runs; mostly it also ends before
        let (end, start) = (line(&text, "[1/2] tube-long: done"), line(&text, "[2/2] tube-dense"));
        assert_eq!(start < end, together, "{jobs} at a time: {text}");
        let page = std::fs::read_to_string(folder.path().join("shown/gallery.html")).unwrap();
        assert!(page.find("tube-long").unwrap() < page.find("tube-dense").unwrap());
        let object = printed(&output);
        let ids: Vec<_> = object["scenes"].as_array().unwrap().iter().map(|scene| &scene["id"]).collect();
        assert_eq!(ids, ["tube-long", "tube-dense"]);
    }
    let output = gallery(folder.path(), &["tube.toml", "--jobs", "0"]);
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && text.contains("--jobs"), "{text}");
}
