//! The pages that runs and sweeps leave.

use std::path::Path;
use std::process::Stdio;

use crate::cli::{SmallRun, brisance, err, fails, report, run, small_run, succeeds};

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn a_run_leaves_one_page_with_everything_in_it() {
    let Some(SmallRun { scene, out: target, folder: _folder }) = small_run() else { return };
    let out = target.to_str().unwrap();
    let sets = ["--set", "gas.regions[0].pressure=3.0", "--set", "time.until=0.2"];
    succeeds(&[&["run", &scene, "--out", out][..], &sets].concat());
    let page = text(&target.join("report.html"));
    for part in [
        "<h1>Small</h1>",
        "<td>pieces</td>",
        "Gauge left",
        "Paths of bodies",
        "largest equivalent plastic strain",
        "kinetic energy of the particles E_kin [J]",
        "mean equivalent plastic strain &lt;\u{3b5}_p&gt;",
        "Deviatoric stress",
        "Momentum along y",
        "<code>--set gas.regions[0].pressure=3.0</code>",
        "elastic sub-steps per step",
        "src=\"data:image/png;base64,",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("Momentum along z") && !page.contains("src=\"http") && !page.contains("<script"));
    assert!(page.matches("<svg").count() >= 15 && page.matches("</svg>").count() == page.matches("<svg").count());
    let gauge = &report(&target)["gauges"]["left"];
    let (first, peak) = (gauge["first"].as_f64().unwrap(), gauge["peak"].as_f64().unwrap());
    assert!(first > 2.5 && peak >= first && gauge["arrival"].is_null(), "{gauge}");
    let report = report(&target);
    let block = &report["bodies"]["block"];
    // 0.25 m^2 of 5 kg/m^3, pushed along x; its energy is at least that of the centre
    let of = |column: &str, what: &str| block[column][what].as_f64().unwrap();
    assert!((of("mass", "last") - 1.25).abs() < 1e-5 && of("x", "last") > of("x", "first"), "{block}");
    assert!(of("kinetic_energy", "largest") >= 0.999 * 0.5 * 1.25 * of("velocity_x", "largest").powi(2), "{block}");
    assert!(of("elastic_strain", "largest") > 0.0 && of("deviatoric_stress", "largest") > 0.0, "{block}");
    let most = &report["extremes"]["max_pressure"];
    assert!(most["largest"].as_f64().unwrap() >= peak && most["largest_time"].as_f64().unwrap() > 0.0, "{most}");
    assert!(text(&target.join("written.txt")).lines().any(|line| line == "report.html"));
}

#[test]
fn a_sweep_leaves_a_table_and_a_page_and_goes_on() {
    let Some(SmallRun { scene, out, folder: _folder }) = small_run() else { return };
    let base = ["sweep", &scene, "--no-frames", "--out", out.to_str().unwrap()];
    let over = ["--over", "gas.regions[0].pressure=2:4:3", "--over", "bodies[0].density=5,6"];
    succeeds(&[&base[..], &over, &["--shard", "1/2"]].concat());
    assert_eq!(text(&out.join("sweep.csv")).lines().count(), 1 + 3);
    let first = text(&out.join("0000/report.json"));
    succeeds(&[&base[..], &over].concat());
    assert_eq!(text(&out.join("0000/report.json")), first, "what is finished is not run again");
    let table = text(&out.join("sweep.csv"));
    assert!(
        table.lines().count() == 1 + 6 && table.lines().next().unwrap().contains(",left_peak_overpressure,"),
        "{table}"
    );
    let page = text(&out.join("sweep.html"));
    assert!(
        page.contains("density 6") && page.contains("href=\"0005/report.html\"") && page.matches("<svg").count() > 10
    );
    let later = |name: &str, one: &str, other: &str| {
        let path = out.join("0000").join(name);
        std::fs::write(&path, text(&path).replacen(one, other, 1)).unwrap();
    };
    for (name, form, own) in [("report.json", "\"form\": ", 2), ("run.json", "\"version\": ", 1)] {
        let next = own + 1;
        later(name, &format!("{form}{own},"), &format!("{form}{next},"));
        let told = fails(6, &[&base[..], &over].concat());
        let form_told = told.contains(&format!("in form {next}"));
        assert!(told.contains(name) && form_told && told.contains("newer program"), "{told}");
        later(name, &format!("{form}{next},"), &format!("{form}{own},"));
    }
    // another scene is another sweep
    succeeds(&[&base[..], &over, &["--shard", "1/6", "--set", "gas.ambient.density=2.0"]].concat());
    assert_ne!(text(&out.join("0000/report.json")), first);
    assert_eq!(text(&out.join("sweep.csv")).lines().count(), 1 + 1);
}

#[test]
fn runs_of_a_sweep_may_share_their_start() {
    let Some(SmallRun { scene, out, folder: _folder }) = small_run() else { return };
    let base = ["sweep", &scene, "--no-frames", "--out", out.to_str().unwrap()];
    let late = [&base[..], &["--branch-at", "0.02", "--over", "gravity=[0.0, -1.0],[0.0, -2.0]"]].concat();
    let said = fails(2, &late);
    assert!(said.contains("--branch-at 0.02: a time between 0 and the end, 0.02 s"), "{said}");
    let shared = ["--set", "time.until=0.04", "--branch-at", "0.02"];
    let said = fails(2, &[&base[..], &shared, &["--over", "bodies[0].density=5,6"]].concat());
    assert!(said.contains("--over bodies[0].density with --branch-at: a state goes on only"), "{said}");
    let said = fails(3, &[&base[..], &shared, &["--over", "gravity=[0.0, -1.0],[0.0]"]].concat());
    assert!(said.contains("gravity") && said.contains("--> --over:1:"), "{said}");
    assert!(!out.exists(), "a sweep that is refused leaves nothing");
    let done = run(&[&base[..], &shared, &["--over", "gravity=[0.0, -1.0],[0.0, -2.0]"]].concat());
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let rows =
        |name: &str| text(&out.join(name).join("diagnostics.csv")).lines().map(str::to_owned).collect::<Vec<_>>();
    let (start, one, two) = (rows("start"), rows("0000"), rows("0001"));
    assert!(start.len() > 1 && one.len() > start.len() && one[..start.len()] == start && two[..start.len()] == start);
    assert_ne!(one.last(), two.last());
    let last: f64 = one.last().unwrap().split(',').nth(1).unwrap().parse().unwrap();
    assert!((last - 0.04).abs() < 1e-9, "{last}");
}

/// Parts at the same time share a start; a part that was stopped goes on where it was.
#[test]
fn parts_of_a_sweep_share_a_start_and_go_on() {
    let Some(SmallRun { scene, out, folder: _folder }) = small_run() else { return };
    let base = ["sweep", &scene, "--no-frames", "-q", "--out", out.to_str().unwrap(), "--set", "time.until=0.04"];
    let over = ["--branch-at", "0.02", "--over", "gravity=[0.0, -1.0],[0.0, -2.0],[0.0, -3.0]"];
    let part = |shard: &'static str| [&base[..], &over, &["--shard", shard]].concat();
    let both = ["1/2", "2/2"].map(|shard| brisance(&part(shard)).stderr(Stdio::piped()).spawn().unwrap());
    let said = both.map(|part| {
        let output = part.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", err(&output));
        err(&output)
    });
    assert!(said.iter().filter(|said| said.contains("waiting for the start")).count() <= 1, "{said:?}");
    let of = |name: &str| text(&out.join(name).join("report.json"));
    let (start, first, last) = (of("start"), of("0000"), of("0002"));
    std::fs::write(out.join("0002/report.json"), last.replace("\"finished\"", "\"stopped\"")).unwrap();
    succeeds(&part("2/2"));
    assert!(of("0002").contains("\"status\": \"stopped\""), "it is of the other part");
    succeeds(&part("1/2"));
    assert_eq!(report(&out.join("0002"))["status"], "finished");
    assert!(of("start") == start && of("0000") == first, "what is finished stays");
    assert_eq!(text(&out.join("sweep.csv")).lines().count(), 1 + 3);
    // somebody else has the turn, and gives it up
    std::fs::remove_file(out.join("start/point.txt")).unwrap();
    std::fs::remove_file(out.join("0001/point.txt")).unwrap();
    std::fs::write(out.join(".brisance.lock"), "1\n0\nelsewhere\n").unwrap();
    let mut waiting = brisance(&part("2/2")).stderr(Stdio::piped()).spawn().unwrap();
    let told = std::io::BufReader::new(waiting.stderr.take().unwrap());
    let mut told = std::io::BufRead::lines(told).map_while(Result::ok);
    assert!(told.any(|line| line.contains("waiting for the start") && line.contains("elsewhere")));
    assert!(waiting.try_wait().unwrap().is_none() && of("start") == start);
    std::fs::remove_file(out.join(".brisance.lock")).unwrap();
    assert!(waiting.wait().unwrap().success() && of("start") != start);
}
