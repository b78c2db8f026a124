//! A run and its folder, its signals and its children.
#![cfg(unix)]

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::cli::{SmallRun, brisance, err, fails, report, run, small_run, succeeds, table, write_small_scene};
use crate::common::folder_or_skip;

const SHORT: [&str; 7] = ["run", "sod", "--until", "0.01", "--frames", "1", "--out"];

#[test]
fn a_run_is_replaced_by_force_only_and_nothing_else_with_it() {
    let Some(folder) = folder_or_skip() else { return };
    let target = folder.path().join("run");
    let out = target.to_str().unwrap();
    let arguments = [&SHORT[..], &[out]].concat();
    succeeds(&arguments);
    assert_eq!(report(&target)["status"], "finished");
    std::fs::write(target.join("frames/mine.txt"), "x").unwrap();
    assert!(fails(2, &arguments).contains("--force"));
    let again = [&SHORT[..], &[out, "--force", "--set", "render.size=[64, 64]", "--no-frames"]].concat();
    succeeds(&again);
    assert!(target.join("frames/mine.txt").exists() && !target.join("frames/0000.png").exists());
    std::fs::write(target.join(".brisance.lock"), "1\n0\nelsewhere\n").unwrap();
    assert!(fails(2, &again).contains("belongs to another run"));
}

#[test]
fn a_report_tells_of_what_was_killed_and_a_stale_lock_is_none() {
    let Some(folder) = folder_or_skip() else { return };
    let target = folder.path().join("run");
    let out = target.to_str().unwrap();
    let long = ["run", "sod", "--until", "1000", "--frames", "100000", "--no-expect", "--out", out];
    let mut child = brisance(&long).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    wait_for("a frame", || target.join("frames/0003.png").exists());
    assert!(fails(2, &long).contains("belongs to another run"));
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(report(&target)["status"], "running");
    assert!(report(&target)["steps"].as_u64().unwrap() > 0);
    succeeds(&[&SHORT[..], &[out, "--force"]].concat());
}

#[test]
fn output_that_goes_away_ends_no_run() {
    let Some(folder) = folder_or_skip() else { return };
    let target = folder.path().join("run");
    let arguments = [&SHORT[..], &[target.to_str().unwrap()]].concat();
    let mut child = brisance(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop((child.stdout.take(), child.stderr.take()));
    assert!(child.wait().unwrap().success());
    assert_eq!(report(&target)["status"], "finished");
    let script = format!("{} list | head -n 1", env!("CARGO_BIN_EXE_brisance"));
    let list = Command::new("sh").args(["-c", &script]).output().unwrap();
    assert!(list.status.success() && list.stderr.is_empty(), "{}", err(&list));
}

/// Puts a program of that name and text in front of all others.
pub(crate) fn with_program(folder: &Path, name: &str, text: &str) -> String {
    let bin = folder.join("bin");
    std::fs::create_dir_all(&bin).unwrap();
    std::fs::write(bin.join(name), text).unwrap();
    std::fs::set_permissions(bin.join(name), std::fs::Permissions::from_mode(0o755)).unwrap();
    format!("{}:{}", bin.display(), std::env::var("PATH").unwrap_or_default())
}

#[test]
fn an_encoder_that_fails_costs_the_film_alone() {
    let Some(folder) = folder_or_skip() else { return };
    let target = folder.path().join("run");
    let film = folder.path().join("film.mp4");
    let talks = "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\nyes error | head -c 1000000 >&2\ncat >/dev/null\nexit 1\n";
    let path = with_program(folder.path(), "ffmpeg", talks);
    let arguments = [&SHORT[..], &[target.to_str().unwrap(), "--video", film.to_str().unwrap()]].concat();
    let output = brisance(&arguments).env("PATH", path).output().unwrap();
    assert_eq!(output.status.code(), Some(9), "{}", err(&output));
    assert!(err(&output).contains("warning: no film"), "{}", err(&output));
    assert!(target.join("frames/0001.png").exists() && !film.exists());
    let report = report(&target);
    assert_eq!(report["status"], "finished");
    assert!(report["outcome"].as_str().unwrap().starts_with("no film"), "{}", report["outcome"]);
}

#[test]
fn scenes_come_by_name_by_pipe_and_from_nothing() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("scenes")).unwrap();
    std::fs::write(folder.path().join("scenes/broken.toml"), "title = ").unwrap();
    let at = |arguments: &[&str]| brisance(arguments).current_dir(folder.path()).output().unwrap();
    assert!(at(&["list"]).status.success() && at(&["check", "sod"]).status.success());
    let told = err(&at(&["check", "sodd"]));
    assert!(told.contains("did you mean `sod`") && told.len() < 300, "{told}");
    assert!(at(&["show", "sod"]).stdout.starts_with(b"#:schema"));
    for (name, options) in [("a", &[][..]), ("b.toml", &["--3d"]), ("c", &["--shock-tube"]), ("d", &["--from", "lax"])]
    {
        let made = at(&[&["init", name], options].concat());
        assert!(made.status.success(), "{}", err(&made));
        let file = format!("{}.toml", name.trim_end_matches(".toml"));
        let checked = at(&["check", &file]);
        assert!(checked.status.success(), "{}", err(&checked));
        assert_eq!(at(&["init", name]).status.code(), Some(2), "it stays");
    }
    let from = std::fs::read_to_string(folder.path().join("d.toml")).unwrap();
    assert!(from.starts_with("#:schema scene.schema.json\n") && from.matches("#:schema").count() == 1, "{from}");
    assert!(at(&["init", "e", "--from", "a.toml"]).status.success(), "a file of one's own");
    // folders and files of those names hide no shipped scene
    std::fs::create_dir(folder.path().join("sod")).unwrap();
    std::fs::write(folder.path().join("sod/report.json"), "{}").unwrap();
    std::fs::write(folder.path().join("lax"), "title = ").unwrap();
    assert!(at(&["check", "sod"]).status.success() && at(&["check", "lax"]).status.success());
    let report = at(&["selftest", "--out", "a.toml"]);
    assert!(err(&report).contains("is an input"), "{}", err(&report));
    let picture = at(&["check", "a.toml", "--picture", "a.toml"]);
    assert!(err(&picture).contains("is an input"), "{}", err(&picture));
    let script = format!("{} check - < a.toml", env!("CARGO_BIN_EXE_brisance"));
    assert!(Command::new("sh").args(["-c", &script]).current_dir(folder.path()).status().unwrap().success());
    Command::new("mkfifo").arg(folder.path().join("fifo.toml")).status().unwrap();
    assert!(err(&at(&["check", "fifo.toml"])).contains("no regular file"));
    assert!(err(&run(&["check", folder.path().to_str().unwrap()])).contains("is a folder"));
}

#[test]
fn interruption_leaves_complete_files() {
    let Some(SmallRun { scene, out: target, folder: _folder }) = small_run() else { return };
    let long = ["--until", "1000", "--frames", "100000", "--out", target.to_str().unwrap()];
    let arguments = [&["run", &scene], &long[..]].concat();
    let mut child = brisance(&arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    wait_for("a frame", || {
        assert!(child.try_wait().unwrap().is_none(), "ended early");
        target.join("frames/0003.png").exists()
    });
    assert!(kill("-INT", &child.id().to_string()));
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let report = report(&target);
    assert!(report["outcome"].as_str().unwrap().starts_with("interrupted"), "{}", report["outcome"]);
    assert_eq!(report["status"], "stopped");
    assert!(!target.join(".brisance.lock").exists());
    let frames = report["frames"].as_u64().unwrap();
    for index in 0..frames {
        let picture = std::fs::read(target.join(format!("frames/{index:04}.png"))).unwrap();
        assert!(picture.ends_with(b"IEND\xaeB`\x82"), "frame {index} is cut");
    }
    assert!(!target.join(format!("frames/{frames:04}.png")).exists());
    let (_, steps) = table(&target.join("diagnostics.csv"));
    assert_eq!(steps.len() as u64, report["steps"].as_u64().unwrap());
}

/// A run whose film waits for an encoder that never reads, once four frames are written, and the encoder's process.
fn run_with_a_deaf_encoder(folder: &Path) -> (std::process::Child, String) {
    let scene = folder.join("small.toml");
    write_small_scene(&scene);
    let deaf = "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\necho $$ >\"$DEAF\"\nsleep 1000\n";
    let path = with_program(folder, "ffmpeg", deaf);
    let (target, film, pid) = (folder.join("run"), folder.join("film.mp4"), folder.join("pid"));
    let names = [&scene, &target, &film].map(|path| path.to_str().unwrap().to_owned());
    let long = ["run", &names[0], "--until", "1000", "--frames", "100000", "--out", &names[1], "--video", &names[2]];
    let mut command = brisance(&[&long[..], &["--set", "render.size=[64, 64]"]].concat());
    let child = command.env("PATH", path).env("DEAF", &pid).stdout(Stdio::null()).stderr(Stdio::null());
    let child = child.spawn().unwrap();
    wait_for("a frame", || target.join("frames/0003.png").exists() && pid.exists());
    (child, std::fs::read_to_string(pid).unwrap().trim().to_owned())
}

fn kill(signal: &str, process: &str) -> bool {
    Command::new("kill").args([signal, process]).stderr(Stdio::null()).status().unwrap().success()
}

/// Sends a signal, upon which a run has to end as interrupted within so many seconds.
fn ends_within(seconds: u64, child: &mut std::process::Child, signal: &str) {
    let start = Instant::now();
    assert!(kill(signal, &child.id().to_string()));
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(start.elapsed() < Duration::from_secs(seconds), "{:?}", start.elapsed());
}

/// Whether a process works; one that has ended may wait for somebody to ask how.
fn lives(process: &str) -> bool {
    let state = Command::new("ps").args(["-o", "stat=", "-p", process]).output().unwrap().stdout;
    !state.is_empty() && !state.starts_with(b"Z")
}

#[test]
fn sigterm_means_now_and_takes_the_encoder_along() {
    let Some(folder) = folder_or_skip() else { return };
    let (mut child, encoder) = run_with_a_deaf_encoder(folder.path());
    // a step takes milliseconds here; the encoder would be waited for 20 s
    ends_within(10, &mut child, "-TERM");
    let (target, film) = (folder.path().join("run"), folder.path().join("film.mp4"));
    let report = report(&target);
    assert_eq!(report["status"], "stopped");
    let (_, steps) = table(&target.join("diagnostics.csv"));
    assert_eq!(steps.len() as u64, report["steps"].as_u64().unwrap());
    assert!(!film.exists() && !target.join(".brisance.lock").exists() && !lives(&encoder));
}

#[test]
fn a_second_signal_ends_at_once_with_the_encoder() {
    let Some(folder) = folder_or_skip() else { return };
    let (mut child, encoder) = run_with_a_deaf_encoder(folder.path());
    assert!(kill("-INT", &child.id().to_string()));
    std::thread::sleep(Duration::from_millis(300));
    assert!(child.try_wait().unwrap().is_none(), "the first one waits for the film");
    ends_within(10, &mut child, "-INT");
    assert!(!lives(&encoder));
    assert_eq!(report(&folder.path().join("run"))["status"], "stopped");
}

#[test]
fn an_interruption_gives_the_encoder_a_moment() {
    let Some(folder) = folder_or_skip() else { return };
    let (mut child, encoder) = run_with_a_deaf_encoder(folder.path());
    // an encoder is waited for 20 s where nobody waits for the end
    ends_within(15, &mut child, "-INT");
    assert!(!lives(&encoder));
    assert_eq!(report(&folder.path().join("run"))["status"], "stopped");
}

#[cfg(feature = "verify")]
#[test]
fn a_verification_is_stopped_within_a_case_with_what_the_others_found() {
    let Some(folder) = folder_or_skip() else { return };
    let out = folder.path().to_str().unwrap();
    let arguments = ["verify", "--full", "--filter", "sod", "--out", out];
    let mut child = brisance(&arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let said = std::io::BufReader::new(child.stderr.take().unwrap());
    // the name of a run is told before its kernels are compiled
    let first = std::io::BufRead::lines(said).map_while(Result::ok).find(|line| line.contains("s  sod"));
    assert!(first.is_some());
    ends_within(2, &mut child, "-INT");
}

/// Waits for a condition, at most two minutes.
fn wait_for(what: &str, mut condition: impl FnMut() -> bool) {
    let start = Instant::now();
    while !condition() {
        assert!(start.elapsed() < Duration::from_secs(120), "{what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_run_that_is_stopped_in_set_up_says_so_and_takes_no_name() {
    let Some(folder) = folder_or_skip() else { return };
    let target = folder.path().join("run");
    let long = ["run", "bursting_shell_3d", "--no-expect", "--quiet", "--out", target.to_str().unwrap()];
    // kernels that no earlier run has left compiled
    let mut command = brisance(&long);
    command.env("MESA_SHADER_CACHE_DISABLE", "true").stdout(Stdio::null()).stderr(Stdio::null());
    let mut child = command.spawn().unwrap();
    wait_for("a report before the first kernel", || target.join("report.json").exists());
    assert_eq!(report(&target)["status"], "running");
    ends_within(2, &mut child, "-INT");
    let report = report(&target);
    assert_eq!((&report["status"], &report["steps"]), (&"stopped".into(), &0.into()));
    // nothing was lost with it, so nothing asks for --force
    succeeds(&[&SHORT[..], &[target.to_str().unwrap(), "--no-frames"]].concat());
}

#[test]
fn a_disk_that_is_full_is_told_with_what_was_written() {
    let Some(folder) = folder_or_skip() else { return };
    let target = folder.path().join("run");
    // a limit on the size of files is met as a full disk is: pictures grow with what there is to see
    let run = "run sod --no-expect --quiet --set render.size=[1280,720] --out";
    let script = format!("ulimit -f 57; exec {} {run} {}", env!("CARGO_BIN_EXE_brisance"), target.display());
    // texts of kernels may be larger than the limit
    let output = Command::new("bash").args(["-c", &script]).env_remove("BRISANCE_KERNELS").output().unwrap();
    assert_eq!(output.status.code(), Some(9), "{}", err(&output));
    assert!(err(&output).contains(".png: File too large"), "what failed first is told: {}", err(&output));
    let report = report(&target);
    let pictures = std::fs::read_dir(target.join("frames")).unwrap().count();
    assert_eq!((&report["status"], &report["frames"]), (&"failed".into(), &pictures.into()));
    assert!(report["outcome"].as_str().unwrap().contains("File too large"), "{}", report["outcome"]);
    let (_, steps) = table(&target.join("diagnostics.csv"));
    let made = report["steps"].as_u64().unwrap();
    assert!((1..=made).contains(&(steps.len() as u64)), "{} rows of {made} steps", steps.len());
}

#[test]
fn a_film_that_nobody_encodes_is_told_by_the_exit_code() {
    let Some(folder) = folder_or_skip() else { return };
    let target = folder.path().join("run");
    let arguments = [&SHORT[..], &[target.to_str().unwrap(), "--video", "film.mp4"]].concat();
    let output = brisance(&arguments).env("PATH", folder.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(9), "{}", err(&output));
    let report = report(&target);
    assert_eq!((&report["status"], &report["frames"]), (&"finished".into(), &2.into()));
    assert!(report["outcome"].as_str().unwrap().starts_with("no film film.mp4: ffmpeg"), "{}", report["outcome"]);
}

/// Whoever sent the folder of a run may have put links into it.
#[test]
fn no_link_leads_out_of_a_foreign_run() {
    let Some(folder) = folder_or_skip() else { return };
    let target = folder.path().join("run");
    let out = target.to_str().unwrap();
    succeeds(&[&SHORT[..], &[out, "--export", "states", "--set", "render.size=[64, 64]"]].concat());
    let again = [vec!["render", out], vec!["convert", out, "--to", "npz"]];
    for name in ["states/0001.npz", "states", "report.json"] {
        let (inside, outside) = (target.join(name), folder.path().join("elsewhere"));
        std::fs::rename(&inside, &outside).unwrap();
        std::os::unix::fs::symlink(&outside, &inside).unwrap();
        for arguments in &again {
            let told = fails(2, arguments);
            assert!(told.contains("leads out of the folder of the run") && told.contains("--allow-outside"), "{told}");
            succeeds(&[&arguments[..], &["--allow-outside"]].concat());
        }
        std::fs::remove_file(&inside).unwrap();
        std::fs::rename(&outside, &inside).unwrap();
        again.iter().for_each(|arguments| drop(succeeds(arguments)));
    }
}

#[test]
#[cfg(target_os = "linux")]
fn nohup_is_heeded() {
    let Some(folder) = folder_or_skip() else { return };
    let target = folder.path().join("run");
    let long = "run sod --until 1000 --frames 100000 --no-expect --quiet --out";
    let script = format!("trap '' HUP; exec {} {long} {}", env!("CARGO_BIN_EXE_brisance"), target.display());
    let mut child = Command::new("bash").args(["-c", &script]).stderr(Stdio::null()).spawn().unwrap();
    wait_for("no frame", || target.join("frames/0001.png").exists());
    assert!(kill("-HUP", &child.id().to_string()));
    let seen = report(&target)["frames"].as_u64().unwrap();
    wait_for("it goes on", || report(&target)["frames"].as_u64().unwrap() > seen + 2);
    assert!(child.try_wait().unwrap().is_none(), "a terminal that is gone ends nothing under nohup");
    assert!(kill("-TERM", &child.id().to_string()));
    assert_eq!(child.wait().unwrap().code(), Some(130));
}
