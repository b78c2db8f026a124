//! `verify`: the cases of [`crate::verify`], one table, one page, one verdict.

use std::io::IsTerminal;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;

use super::args::{Cli, VerifyOptions};
use super::interrupt;
use super::open_device;
use crate::export::atomic;
use crate::gpu::{Gpu, GpuOptions};
use crate::verify::{self, Case, Common, Findings, Head, Row, Suite, Verdict};
use crate::{Error, Result};

/// Cases that run at a time, at most, on a GPU and on a processor.
const AT_A_TIME: [usize; 2] = [4, 16];
/// How many threads Mesa's software driver has per device; with 0 it computes in the thread that asks.
#[cfg(unix)]
const DRIVER_THREADS: &str = "LP_NUM_THREADS";

/// Runs the suite and judges. What was found before an error, and by the cases before an interruption, is written all the same.
///
/// # Errors
/// [`Error::Expectation`] if a gate does not hold, after everything was written; those of runs.
pub(super) fn verify(options: &VerifyOptions, cli: &Cli) -> Result<()> {
    let suite = if options.full { Suite::Full } else { Suite::Quick };
    let cases = verify::select(suite, &options.filter);
    if cases.is_empty() {
        return Err(Error::Usage(format!(
            "no case matches `{}`; `brisance verify --full --list` prints all",
            options.filter
        )));
    }
    if options.list {
        list(&cases, cli.json);
        return Ok(());
    }
    share_cores_by_cases();
    interrupt::listen();
    let start = Instant::now();
    let gpu = open_device(cli)?;
    // a signal ends at once, wherever a case is: what the others found is written first
    let found = Arc::new(Mutex::new(Findings::default()));
    let words = last_words(head(options, &gpu, 0.0), &found, &options.out);
    interrupt::last_words(&options.out, Some(Box::new(words)));
    let bar = progress(cases.len());
    let notify = |text: &str| match &bar {
        Some(bar) => bar.set_message(text.to_owned()),
        None => tell!("{:6.1} s  {text}", start.elapsed().as_secs_f64()),
    };
    let done = |own: &Findings| {
        found.lock().unwrap_or_else(PoisonError::into_inner).add(own.clone());
        bar.iter().for_each(|bar| bar.inc(1));
    };
    let devices = [std::slice::from_ref(&gpu), &more_devices(cli, &gpu)?].concat();
    let (findings, outcome) = verify::perform(&devices, &Common::new(suite, &notify), &cases, &done);
    interrupt::last_words(&options.out, None);
    if let Some(bar) = &bar {
        bar.finish_and_clear();
    }
    let head = head(options, &gpu, start.elapsed().as_secs_f64());
    let object = write_all(&options.out, &head, &findings)?;
    let rows = findings.rows;
    if cli.json {
        say!("{object}");
    } else if options.markdown {
        say!("{}", verify::markdown(&head, &rows).trim_end());
    } else {
        say!("{}", verify::table(&rows));
    }
    outcome?;
    verdict(&rows, &options.out)
}

/// Starts the program again with a software driver that has no threads of its own, unless the caller has decided that: most cases are
/// small, and cases at a time fill the cores better than threads that wait for each other after every kernel. GPUs do not care.
fn share_cores_by_cases() {
    #[cfg(unix)]
    if std::env::var_os(DRIVER_THREADS).is_none()
        && let Ok(program) = std::env::current_exe()
    {
        use std::os::unix::process::CommandExt;
        // It returns only where that is not possible; then the driver keeps its threads.
        let _ = std::process::Command::new(program).args(std::env::args_os().skip(1)).env(DRIVER_THREADS, "0").exec();
    }
}

/// The same device opened again, for cases beside the first: one for each further processor core, up to [`AT_A_TIME`] in all.
fn more_devices(cli: &Cli, first: &Gpu) -> Result<Vec<Gpu>> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let all = cores.min(AT_A_TIME[usize::from(first.is_software())]);
    (1..all).map(|_| Gpu::new(&GpuOptions { device: cli.device.clone(), ..GpuOptions::default() })).collect()
}

fn list(cases: &[&Case], as_json: bool) {
    if as_json {
        let list: Vec<_> = cases
            .iter()
            .map(|case| {
                json!({ "id": case.id, "title": case.title, "group": case.group, "quick": case.quick,
                        "source": case.source })
            })
            .collect();
        say!("{}", json!({ "cases": list }));
        return;
    }
    let width = cases.iter().map(|case| case.id.len()).max().unwrap_or(0);
    for case in cases {
        say!("{:width$}  {:5}  {}", case.id, if case.quick { "quick" } else { "full" }, case.title);
    }
}

/// A bar on a terminal; plain lines elsewhere.
fn progress(cases: usize) -> Option<ProgressBar> {
    std::io::stderr().is_terminal().then(|| {
        let bar = ProgressBar::new(cases as u64);
        if let Ok(style) = ProgressStyle::with_template("{bar:32} {pos}/{len}  {elapsed}  {msg}") {
            bar.set_style(style);
        }
        bar
    })
}

fn head(options: &VerifyOptions, gpu: &Gpu, seconds: f64) -> Head {
    let suite = if options.full { "--full" } else { "--quick" };
    let filter = if options.filter.is_empty() { String::new() } else { format!(" --filter {}", options.filter) };
    let driver = format!("{} {}", gpu.info.driver, gpu.info.driver_info);
    Head {
        version: env!("CARGO_PKG_VERSION"),
        command: format!("brisance verify {suite}{filter}"),
        device: format!("{} ({}, {})", gpu.info.name, gpu.info.backend, driver.trim()),
        software: gpu.is_software(),
        cases: verify::cases().collect(),
        seconds,
    }
}

/// What is left to do when the process ends at once.
fn last_words(head: Head, found: &Arc<Mutex<Findings>>, out: &Path) -> impl FnMut() + Send + use<> {
    let (found, out, start) = (Arc::clone(found), out.to_owned(), Instant::now());
    move || {
        if let Some(findings) = found.try_lock().ok().filter(|findings| !findings.seconds.is_empty()) {
            let head = Head { seconds: start.elapsed().as_secs_f64(), ..head.clone() };
            let _ = write_all(&out, &head, &findings);
        }
    }
}

/// Writes the page and the table; returns the table.
fn write_all(out: &Path, head: &Head, Findings { rows, plots, seconds, .. }: &Findings) -> Result<serde_json::Value> {
    let object = verify::json(head, rows, seconds);
    write(&out.join("report.html"), &verify::html(head, rows, plots))?;
    write(&out.join("verify.json"), &format!("{object:#}\n"))?;
    Ok(object)
}

fn write(path: &Path, text: &str) -> Result<()> {
    atomic::write(path, |out| out.write_all(text.as_bytes()))
}

/// The error of a verification whose gates do not all hold.
fn verdict(rows: &[Row], folder: &Path) -> Result<()> {
    let failed: Vec<String> = rows
        .iter()
        .filter(|row| row.verdict() == Verdict::Fail)
        .map(|row| format!("{} {} {}", row.case, row.setting, row.quantity).replace("  ", " "))
        .collect();
    if failed.is_empty() {
        return Ok(());
    }
    let (count, page) = (failed.len(), folder.join("report.html"));
    Err(Error::Expectation(format!("{count} gates failed: {}; see {}", failed.join(", "), page.display())))
}
