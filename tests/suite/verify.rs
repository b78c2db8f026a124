//! The verification: its verdicts, its documents, its registry, its independent solver, and the exit code of a failed gate.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use brisance::render::{Plot, Style};
use brisance::scene::Scene;
use brisance::verify::{self, Head, Limit, Profile, Row, Suite, Verdict, muscl, muscl_plane};

use crate::common::{files_below, folder_or_skip};

fn row(case: &'static str, ours: f64) -> Row {
    Row {
        case,
        setting: "b1b0 predictor 100".to_owned(),
        quantity: "error <of> \"it\" | all".to_owned(),
        reference: None,
        source: String::new(),
        ours,
        pass: None,
        good: None,
        known: None,
        solver: None,
    }
}

#[test]
fn verdicts_follow_the_limits() {
    let mut row = row("sod", 0.02);
    assert_eq!(row.verdict(), Verdict::Reported);
    row.pass(Limit::AtMost(0.03)).good(Limit::AtMost(0.01));
    assert_eq!(row.verdict(), Verdict::Pass);
    row.ours = 0.01;
    assert_eq!(row.verdict(), Verdict::Good);
    row.ours = 0.04;
    assert_eq!(row.verdict(), Verdict::Fail);
    row.known(Limit::AtMost(0.05), "the reason");
    assert_eq!(row.verdict(), Verdict::Known);
    assert!(row.allowed().contains("<= 0.03") && row.allowed().contains("the reason"), "{}", row.allowed());
    row.ours = 0.06;
    assert_eq!(row.verdict(), Verdict::Fail);
    row.ours = 0.01;
    assert!(!row.allowed().contains("the reason"), "what is met needs no excuse: {}", row.allowed());
    row.ours = f64::NAN;
    assert_eq!(row.verdict(), Verdict::Fail);
    row.reference(2.0, "somebody").within(0.01);
    for (value, holds) in [(1.979, false), (1.981, true), (2.019, true), (2.021, false)] {
        assert_eq!(row.pass.unwrap().holds(value), holds, "{value}");
    }
    assert!(!Limit::Above(0.0).holds(0.0) && Limit::AtLeast(0.0).holds(0.0));
}

#[test]
fn the_registry_is_sound() {
    let ids: Vec<&str> = verify::cases().map(|case| case.id).collect();
    assert_eq!(ids.iter().collect::<BTreeSet<_>>().len(), ids.len(), "{ids:?}");
    for case in verify::cases() {
        assert!(!case.title.is_empty() && !case.group.is_empty() && case.source.len() > 5, "{}", case.id);
        assert!(case.id.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_'), "{}", case.id);
    }
    let mut groups: Vec<&str> = verify::cases().map(|case| case.group).collect();
    groups.dedup();
    assert_eq!(groups.iter().collect::<BTreeSet<_>>().len(), groups.len(), "a group in two places: {groups:?}");
    assert_eq!(verify::select(Suite::Full, "").len(), ids.len());
    let quick = verify::select(Suite::Quick, "SOD");
    assert!(quick.iter().any(|case| case.id == "sod") && quick.iter().all(|case| case.quick));
    assert!(verify::select(Suite::Full, "no such case").is_empty());
}

/// Scene paths that a source of the verification names.
fn named_scenes(text: &str) -> impl Iterator<Item = &str> {
    text.split('"').skip(1).step_by(2).filter(|quoted| quoted.ends_with(".toml"))
}

#[test]
fn every_scene_of_a_case_is_shipped() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/verify/cases");
    let mut found = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        for name in named_scenes(&std::fs::read_to_string(&path).unwrap()).filter(|_| !path.ends_with("mod.rs")) {
            Scene::shipped(name, &[]).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            found += 1;
        }
    }
    assert!(found >= 10, "{found}");
}

fn head() -> Head {
    Head {
        version: "0",
        command: "brisance verify".to_owned(),
        device: "a <device>".to_owned(),
        software: true,
        seconds: 1.0,
        cases: verify::cases().collect(),
    }
}

/// Checks that every element that opens closes, in order.
fn assert_balanced(html: &str) {
    let mut open: Vec<&str> = Vec::new();
    for tag in html.split('<').skip(1).map(|rest| rest.split('>').next().unwrap()) {
        let name = tag.trim_start_matches('/').split([' ', '/']).next().unwrap();
        if name.starts_with('!') || name == "meta" || tag.ends_with('/') {
            continue;
        }
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "{tag}");
        } else {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn the_book_names_every_case() {
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/results/validation.md")).unwrap();
    let missing: Vec<_> = verify::cases().map(|case| case.id).filter(|id| !page.contains(&format!("`{id}`"))).collect();
    assert!(
        missing.is_empty(),
        "docs/results/validation.md: brisance verify --full --markdown has lines for {missing:?}"
    );
}

#[test]
fn documents_are_well_formed() {
    let mut rows = vec![row("sod", 1.0), row("lax", f64::NAN)];
    rows[1].pass(Limit::AtMost(1.0));
    let plot = Plot::new("a < b", "cells", "error")
        .logarithmic()
        .with("errors & more", Style::Both, vec![[100.0, 0.1], [200.0, 0.05], [400.0, 0.0]])
        .with("order 1", Style::Guide, vec![[100.0, 0.2], [400.0, 0.05]]);
    let html = verify::html(&head(), &rows, &[("", plot.clone()), ("sod", plot)]);
    assert_balanced(&html);
    assert!(html.contains("@media print") && html.contains("<svg") && html.contains("a &lt;device&gt;"));
    assert!(!html.contains("NaN,") && !html.contains(",inf") && !html.contains("src=") && !html.contains("href="));
    assert!(html.contains("class=\"fail\""));

    let object = verify::json(&head(), &rows, &[]);
    let object: serde_json::Value = serde_json::from_str(&object.to_string()).unwrap();
    assert_eq!((&object["passed"], &object["cases"][1]["rows"][0]["verdict"]), (&false.into(), &"fail".into()));
    assert_eq!(object["cases"][0]["id"], "sod");

    let markdown = verify::markdown(&head(), &rows);
    let columns = |line: &str| line.replace("\\|", "").matches('|').count();
    let lines: Vec<usize> = markdown.lines().filter(|line| line.starts_with('|')).map(columns).collect();
    // one line of the overview, for the case that has a gate, then one table per case
    assert!(
        lines.len() == 9 && lines[..3] == [7; 3] && lines[3..].iter().all(|count| *count == lines[3]),
        "{markdown}"
    );
    assert!(markdown.contains("| NaN | <= 1 | 0 of 1 |"), "{markdown}");
    assert!(verify::table(&rows).contains("1 gates: 0 good, 0 pass, 0 known misses, 1 fail; 1 values reported"));
}

#[test]
fn the_independent_solver_converges_to_the_exact_solution() {
    // Sod's tube by MUSCL-HLLC on 400 cells: published codes of the kind reach 1.0e-3 to 1.4e-3.
    for (path, cells, most) in [
        ("gas/sod.toml", 100, 5.2e-3),
        ("gas/sod.toml", 400, 1.4e-3),
        ("gas/lax.toml", 400, 6.2e-3),
        ("gas/mach3.toml", 400, 3.8e-3),
    ] {
        let scene = Scene::shipped(path, &[]).unwrap().with_resolution(cells).unwrap();
        let (exact, jump) = scene.riemann().unwrap();
        let error = muscl::solve(&scene).l1(&Profile::exact(&scene, &exact, jump, scene.time.until), 0);
        eprintln!("{path} {cells}: {error:.5}");
        assert!(error <= most, "{path}: {error}");
    }
}

#[test]
fn the_independent_solver_keeps_mass_between_walls() {
    let scene = Scene::shipped("gas/blast.toml", &[]).unwrap();
    let profile = muscl::solve(&scene);
    let mass: f64 = profile.state[0].iter().sum::<f64>() * profile.spacing;
    assert!((mass - 1.0).abs() < 1e-12, "{mass}");
    let (peak, place) = profile.peak(0, [0.0, 1.0]);
    assert!((5.0..6.6).contains(&peak) && (0.75..0.79).contains(&place), "{peak} at {place}");
}

#[test]
fn the_solver_in_the_plane_is_the_one_along_each_axis() {
    let [_, y] = [0, 1].map(|axis| {
        let (cells, normal) = [([100, 4], [1.0, 0.0]), ([4, 100], [0.0, 1.0])][axis];
        let size = cells.map(|n| f64::from(n) / 100.0);
        let text = format!(
            "title = \"tube\"\n[domain]\ndimension = 2\ncells = {cells:?}\nsize = {size:?}\n\
             [gas]\nambient = {{ density = 0.125, pressure = 0.1, velocity = {:?} }}\n\
             [[gas.regions]]\nshape = {{ half_space = {{ point = [0.5, 0.5], normal = {normal:?} }} }}\n\
             density = 1.0\npressure = 1.0\n[time]\nuntil = 0.15\n",
            [0.0, 0.0],
        );
        let density = muscl_plane::solve(&Scene::parse(&text, "tube.toml", &[]).unwrap());
        let tube = muscl::solve(&Scene::shipped("gas/sod.toml", &[]).unwrap().with_resolution(100).unwrap());
        let error = (0..100).map(|k| (density[if axis == 0 { k } else { 4 * k }] - tube.state[0][k]).abs());
        let error = error.fold(0.0, f64::max);
        // steps are the same, so that only rounding differs
        assert!(error < 1e-12, "axis {axis}: {error:e}");
        density
    });
    assert!(y.chunks(4).all(|row| row.iter().all(|value| (value - row[0]).abs() < 1e-12)));
}

#[test]
fn the_radial_solver_finds_round_shocks() {
    // shocks on 4000 cells; what is inside has not been reached, or only just
    for (path, place) in [("paper/fig16_convergence.toml", 0.8134), ("validation/spherical_explosion.toml", 0.7933)] {
        let scene = Scene::shipped(path, &[]).unwrap();
        let profile = muscl::solve_radial(&scene, 400);
        let found = profile.crossings(2, 0.1515).next_back().unwrap();
        assert!((found - place).abs() < 0.003, "{path}: {found}");
        // the power of the radius that a wave spreads over, and unit density inside 0.4
        let power = scene.domain.dimension as i32;
        let shell =
            |k: usize| (profile.spacing * (k + 1) as f64).powi(power) - (profile.spacing * k as f64).powi(power);
        let mass: f64 = (0..profile.cells()).map(|k| shell(k) * profile.state[0][k]).sum();
        let expected = 0.125 + 0.875 * 0.4_f64.powi(power);
        assert!((mass - expected).abs() < 1e-6, "{path}: {mass} {expected}");
    }
}

#[test]
fn the_iteration_bound_is_that_of_conjugate_gradients() {
    assert!((verify::iteration_bound(1, 0.0, 1e-7) - 8.4).abs() < 0.01);
    assert!((verify::iteration_bound(2, 1.0, 1e-7) - 3.0 * 8.405).abs() < 0.01);
}

#[test]
fn a_verification_leaves_its_files() {
    let Some(folder) = folder_or_skip() else { return };
    let target = folder.path().join("deep");
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_brisance"));
        command.arg("verify").args(arguments).arg("--out").arg(&target).current_dir(folder.path());
        command.output().unwrap()
    };
    let output = run(&["--quick", "--filter", "stationary_contact"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{text}{}", String::from_utf8_lossy(&output.stderr));
    assert!(text.starts_with("case ") && text.contains("PCG mean/max") && text.contains(" 0 fail"), "{text}");
    assert_balanced(&std::fs::read_to_string(target.join("report.html")).unwrap());
    let object = std::fs::read_to_string(target.join("verify.json")).unwrap();
    let object: serde_json::Value = serde_json::from_str(&object).unwrap();
    assert_eq!((&object["passed"], &object["cases"][0]["id"]), (&true.into(), &"stationary_contact".into()));
    let solver = &object["cases"][0]["rows"][0]["solver"];
    assert!(solver["courant"].as_f64().unwrap() > 0.5 && solver["bound"].as_f64().unwrap() > 6.0, "{solver}");

    assert_eq!(run(&["--filter", "no such case"]).status.code(), Some(2));
    let list = String::from_utf8(run(&["--full", "--list"]).stdout).unwrap();
    assert!(verify::cases().all(|case| list.lines().any(|line| line.starts_with(case.id))), "{list}");
}

#[test]
fn a_failed_gate_has_an_exit_code() {
    let Some(folder) = folder_or_skip() else { return };
    copy_shaders(&Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders"), folder.path());
    // A table that mistakes the sign of the lowest pressure is what the gate on it must not let pass.
    let path = folder.path().join("step/diagnostics.wgsl");
    let text = std::fs::read_to_string(&path).unwrap();
    let wrong = text.replace("-u.flow.x, p, -p)", "-u.flow.x, p, p)");
    assert_ne!(text, wrong, "the test breaks a line that is no more");
    std::fs::write(&path, wrong).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_brisance"))
        .args(["verify", "--filter", "stationary_contact", "--json", "--out", "result"])
        .env("BRISANCE_SHADERS", folder.path())
        .current_dir(folder.path())
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(8), "{text}");
    assert!(text.contains("1 gates failed: stationary_contact lowest pressure"), "{text}");
    let object = std::fs::read_to_string(folder.path().join("result/verify.json")).unwrap();
    assert!(object.contains("\"passed\": false"), "the files are there all the same");
}

fn copy_shaders(from: &Path, to: &Path) {
    for path in files_below(from) {
        std::fs::create_dir_all(to.join(&path).parent().unwrap()).unwrap();
        std::fs::copy(from.join(&path), to.join(&path)).unwrap();
    }
}
