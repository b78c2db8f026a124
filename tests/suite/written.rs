//! What is written: how much, what a full disk costs, films that go on.
#![cfg(unix)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::cli::{brisance, err, report, succeeds};
use crate::common::{contents_below, files_below, folder_or_skip, is_kind};
use crate::folders::with_program;

/// Pictures, page, tables and report of a tube, of a plane and of space are told within 30 %.
#[test]
fn what_a_run_will_write_is_told() {
    let Some(folder) = folder_or_skip() else { return };
    for (scene, cells) in [
        ("sod", "400"),
        ("bursting_diaphragm_2d", "80"),
        ("fig03_elastic_shell_2d", "48"),
        ("kelvin_helmholtz", "48"),
        ("bursting_shell_3d", "16"),
        ("hot_bubble", "80"),
    ] {
        let given = [scene, "--resolution", cells, "--set", "time.frames=4"];
        let out = folder.path().join(scene);
        let told: serde_json::Value =
            serde_json::from_str(&succeeds(&[&["check", "--json"], &given[..]].concat())).unwrap();
        succeeds(&[&["run", "-q", "--no-expect", "--out", out.to_str().unwrap()], &given[..]].concat());
        let told = told["estimate"]["disk_bytes"].as_f64().unwrap();
        let real: usize = contents_below(&out).iter().map(|(_, bytes)| bytes.len()).sum();
        let ratio = told / real as f64;
        eprintln!("{scene}: {told:.0} bytes told, {real} written, {ratio:.2} times");
        assert!((1.0 / 1.3..1.3).contains(&ratio), "{scene}: {told} bytes told, {real} written");
    }
}

/// What pictures and converters need of a state has half the bytes of all that a run goes on from.
#[test]
fn a_light_state_has_half_the_bytes() {
    let Some(folder) = folder_or_skip() else { return };
    let out = folder.path().join("run");
    let written = ["--no-frames", "--export", "fields", "--checkpoint", "1000000steps", "--frames", "1"];
    let scene = ["run", "bursting_shell_3d", "--resolution", "24", "--no-expect", "-q", "--out", out.to_str().unwrap()];
    succeeds(&[&scene[..], &written[..]].concat());
    let last = |kind: &str| contents_below(&out.join(kind)).pop().unwrap().1.len();
    let (light, full) = (last("states"), last("checkpoints"));
    eprintln!("{light} bytes of {full}, {:.3}", light as f64 / full as f64);
    assert!(2 * light <= full, "{light} bytes of {full}");
}

/// A program that may write files of so many KiB: it meets the limit as it meets a full disk.
fn limited(kib: u32, arguments: &[&str]) -> Output {
    let script = format!("ulimit -f {kib}; exec \"$0\" \"$@\"");
    let mut command = Command::new("bash");
    command.args(["-c", &script, env!("CARGO_BIN_EXE_brisance")]).args(arguments);
    // texts of kernels may be larger than the limit
    command.env_remove("BRISANCE_KERNELS").output().unwrap()
}

#[test]
fn a_full_disk_costs_nothing_that_was_there() {
    let Some(folder) = folder_or_skip() else { return };
    let place = |name: &str| folder.path().join(name).display().to_string();
    let [run, out, again, sweep] = ["run", "out", "again", "sweep"].map(place);
    let short = ["--until", "0.01", "--frames", "1"];
    let states = ["--no-frames", "--no-expect", "-q", "--export", "states", "--out", &run];
    succeeds(&[&["run", "sod"], &short[..], &states].concat());
    let convert = ["convert", &run, "--to", "npz,vtk,usd", "-q", "--out", &out];
    let render = ["render", &run, "-q", "--out", &again];
    let over = ["--over", "gas.ambient.pressure=0.1,0.12", "--out", &sweep];
    let sweep = [&["sweep", "sod"], &short[..], &["--no-frames", "-q"], &over].concat();
    for (verb, kib, file) in [(&convert[..], 4, "arrays/0000.npz"), (&render, 8, "frames/0000.png"), (&sweep, 2, "")] {
        succeeds(verb);
        let before = contents_below(folder.path());
        if verb[0] == "sweep" {
            // what is finished is not run again
            std::fs::remove_file(folder.path().join("sweep/0001/point.txt")).unwrap();
        }
        let output = limited(kib, verb);
        let said = err(&output);
        assert_eq!(output.status.code(), Some(9), "{said}");
        assert!(said.contains(file) && said.contains("File too large") && said.contains("make room"), "{said}");
        let kept = |(path, bytes): &&(PathBuf, Vec<u8>)| {
            std::fs::read(folder.path().join(path)).is_ok_and(|now| now == *bytes)
        };
        // the table of a sweep has the runs that are there
        let own = |path: &Path| !path.starts_with("sweep") || path.starts_with("sweep/0000");
        let lost = before.iter().filter(|file| own(&file.0) && !kept(file)).map(|(path, _)| path).collect::<Vec<_>>();
        assert!(lost.is_empty(), "{lost:?}");
        assert!(!files_below(folder.path()).iter().any(|path| is_kind(path, "tmp")), "{}", verb[0]);
        succeeds(verb);
    }
}

/// An encoder that keeps the pictures as they come.
const RAW: &str = "#!/bin/bash\n[ \"$1\" = -version ] && exit 0\ncat >\"${@: -1}\"\n";

#[test]
fn a_film_goes_on_without_a_seam() {
    let Some(folder) = folder_or_skip() else { return };
    let path = with_program(folder.path(), "ffmpeg", RAW);
    let filmed = |arguments: &[&str]| {
        let output = brisance(arguments).env("PATH", &path).output().unwrap();
        assert!(output.status.success(), "{}", err(&output));
    };
    let run = folder.path().join("run");
    let (out, film) = (run.to_str().unwrap(), folder.path().join("film.mp4"));
    let given = ["run", "sod", "--resolution", "64", "--until", "0.05", "--frames", "6", "--no-expect", "-q"];
    let sizes = ["--set", "render.size=[64, 48]", "--checkpoint", "4steps", "--keep", "100"];
    filmed(&[&given[..], &sizes, &["--out", out, "--video", film.to_str().unwrap()]].concat());
    let whole = std::fs::read(&film).unwrap();
    assert_eq!(whole.len(), 7 * 3 * 64 * 48);
    std::fs::remove_file(&film).unwrap();
    // of an early stop, with pictures that the checkpoint does not know
    let mut kept: Vec<PathBuf> =
        std::fs::read_dir(run.join("checkpoints")).unwrap().map(|e| e.unwrap().path()).collect();
    kept.sort();
    assert!(kept.len() >= 3, "{kept:?}");
    kept.iter().skip(1).for_each(|path| std::fs::remove_file(path).unwrap());
    filmed(&["run", "--resume", out, "-q"]);
    assert!(std::fs::read(&film).unwrap() == whole, "the film of the resumed run is another one");
    assert_eq!(report(&run)["frames"], 7);
}
