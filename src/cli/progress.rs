//! What a run shows while it works: a bar on a terminal, a plain line every few seconds elsewhere.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::diagnostics::StepRecord;
use crate::math::plain;

/// Resolution of the bar.
const TICKS: u64 = 10_000;
/// Time between plain lines.
const PAUSE: Duration = Duration::from_secs(5);
/// What is quicker is not shown.
const MOMENT: Duration = Duration::from_millis(300);

/// Whether nothing is to be shown.
static QUIET: AtomicBool = AtomicBool::new(false);

/// Progress of one run.
#[derive(Debug)]
pub(super) struct Progress {
    until: f64,
    start: Instant,
    spoken: Instant,
    form: Form,
}

#[derive(Debug)]
enum Form {
    Quiet,
    Bar(ProgressBar),
    Lines,
}

impl Progress {
    /// For a run that ends at `until` \[s\].
    pub(super) fn new(until: f64, quiet: bool) -> Self {
        let form = match (quiet, std::io::stderr().is_terminal()) {
            (true, _) => Form::Quiet,
            (false, false) => Form::Lines,
            (false, true) => Form::Bar(bar()),
        };
        Self { until, start: Instant::now(), spoken: Instant::now(), form }
    }

    /// Shows how far the run is.
    pub(super) fn show(&mut self, time: f64, last: Option<&StepRecord>) {
        let part = if self.until > 0.0 { (time / self.until).clamp(0.0, 1.0) } else { 1.0 };
        match &self.form {
            Form::Quiet => {}
            Form::Bar(bar) => {
                bar.set_position((part * TICKS as f64) as u64);
                bar.set_message(self.text(time, last, part));
            }
            Form::Lines if self.spoken.elapsed() >= PAUSE => {
                tell!("{:5.1} %  {}", 100.0 * part, self.text(time, last, part));
                self.spoken = Instant::now();
            }
            Form::Lines => {}
        }
    }

    fn text(&self, time: f64, last: Option<&StepRecord>, part: f64) -> String {
        let (step, iterations) = last.map_or((0, 0), |record| (record.step, record.iterations));
        let left = self.start.elapsed().mul_f64(if part > 0.0 { (1.0 - part) / part } else { 0.0 });
        let left = if part > 0.0 { clock(left) } else { "?".to_owned() };
        let time = plain(time);
        format!("t = {time} s  step {step}  PCG {iterations}  {} to go", left)
    }

    /// Takes the bar away.
    pub(super) fn finish(&self) {
        if let Form::Bar(bar) = &self.form {
            bar.finish_and_clear();
        }
    }
}

/// Shows on a terminal how many kernels are compiled, of how many; what is cached takes a moment and shows nothing.
pub(super) fn compiling(done: usize, all: usize) {
    static SHOWN: Mutex<Option<(Instant, Option<ProgressBar>)>> = Mutex::new(None);
    let mut shown = SHOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if done == all {
        if let Some((_, Some(bar))) = shown.take() {
            bar.finish_and_clear();
        }
        return;
    }
    let (start, bar) = shown.get_or_insert_with(|| (Instant::now(), None));
    if start.elapsed() >= MOMENT && std::io::stderr().is_terminal() && !QUIET.load(Ordering::Relaxed) {
        let bar = bar.get_or_insert_with(bar_of_kernels);
        bar.set_length(all as u64);
        bar.set_position(done as u64);
    }
}

/// Shows nothing of what happens before a run, either.
pub(super) fn hush() {
    QUIET.store(true, Ordering::Relaxed);
}

fn bar_of_kernels() -> ProgressBar {
    let bar = ProgressBar::new(0);
    if let Ok(style) = ProgressStyle::with_template("{bar:32} compiling kernel {pos} of {len}") {
        bar.set_style(style);
    }
    bar
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::new(TICKS);
    if let Ok(style) = ProgressStyle::with_template("{bar:32} {percent:>3} %  {msg}") {
        bar.set_style(style);
    }
    bar
}

/// Minutes and seconds, hours where there are some.
pub(super) fn clock(time: Duration) -> String {
    let seconds = time.as_secs();
    match seconds / 3600 {
        0 => format!("{}:{:02}", seconds / 60, seconds % 60),
        hours => format!("{hours}:{:02}:{:02}", seconds / 60 % 60, seconds % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks() {
        assert_eq!(clock(Duration::from_millis(61_900)), "1:01");
        assert_eq!(clock(Duration::from_secs(3_725)), "1:02:05");
    }
}
