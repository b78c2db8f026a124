//! The process that encodes a film. It may be slow, talk a lot, or do nothing at all: each costs the film, never the run.

use std::io::{Read, Write};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// The program that encodes.
pub(super) const ENCODER: &str = "ffmpeg";

/// Pictures that may wait.
const QUEUE: usize = 2;
/// An encoder that takes no picture for so long, or does not end within it, is given up.
const PATIENCE: Duration = Duration::from_secs(20);
/// The same once somebody waits for the end: the film can be made from the pictures.
const HASTE: Duration = Duration::from_secs(2);
/// An encoder that does not say its version within this time is none.
const ANSWER: Duration = Duration::from_secs(5);
/// Between two looks at a process.
const PAUSE: Duration = Duration::from_millis(20);
/// Bytes of what it says that are kept: the last ones.
const KEPT: usize = 2000;
/// Lines of these.
const LINES: usize = 3;

/// Whether the encoder is there and answers.
pub(super) fn answers() -> bool {
    let quiet = || Stdio::null();
    let mut command = Command::new(ENCODER);
    let asked = alone(&mut command).arg("-version").stdin(quiet()).stdout(quiet()).stderr(quiet()).spawn();
    asked.is_ok_and(|mut process| ended(&mut process, || ANSWER) == Some(true))
}

/// Waits for a process to end, and ends it after some time: whether it was content, if it ended by itself.
fn ended(process: &mut Child, patience: fn() -> Duration) -> Option<bool> {
    let start = Instant::now();
    while start.elapsed() < patience() {
        match process.try_wait() {
            Ok(Some(status)) => return Some(status.success()),
            Ok(None) => std::thread::sleep(PAUSE),
            Err(_) => break,
        }
    }
    end(process);
    None
}

/// Ends a process, with those that it started: it has a group of its own.
fn end(process: &mut Child) {
    end_group(process.id());
    let _ = process.kill();
    let _ = process.wait();
}

fn end_group(leader: u32) {
    #[cfg(unix)]
    if let Some(group) = i32::try_from(leader).ok().and_then(rustix::process::Pid::from_raw) {
        let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
    }
    #[cfg(not(unix))]
    let _ = leader;
}

/// Encoders at work.
static AT_WORK: Mutex<Vec<u32>> = Mutex::new(Vec::new());
/// Whether somebody waits for the end.
static HURRY: AtomicBool = AtomicBool::new(false);
/// Whether none may work any more.
static OVER: AtomicBool = AtomicBool::new(false);

fn at_work() -> std::sync::MutexGuard<'static, Vec<u32>> {
    AT_WORK.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From now on encoders have a moment to end.
pub(super) fn hurry() {
    HURRY.store(true, Ordering::SeqCst);
}

fn patience() -> Duration {
    if HURRY.load(Ordering::SeqCst) { HASTE } else { PATIENCE }
}

/// Ends every encoder, and those to come: their films are lost.
pub(super) fn end_all() {
    OVER.store(true, Ordering::SeqCst);
    at_work().iter().for_each(|leader| end_group(*leader));
}

/// Ctrl-C in the terminal is for us, not for those that we start.
fn alone(command: &mut Command) -> &mut Command {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    command
}

/// An encoder at work: one thread feeds it, another hears what it says.
#[derive(Debug)]
pub(super) struct Encoder {
    process: Child,
    pictures: Option<SyncSender<Vec<u8>>>,
    feeding: Option<JoinHandle<()>>,
    said: Option<JoinHandle<String>>,
}

impl Encoder {
    /// Starts one.
    pub(super) fn start(mut command: Command) -> std::io::Result<Self> {
        let mut process =
            alone(&mut command).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn()?;
        at_work().push(process.id());
        if OVER.load(Ordering::SeqCst) {
            end_group(process.id());
        }
        let (pictures, queue) = sync_channel(QUEUE);
        let feeding = process.stdin.take().map(|pipe| std::thread::spawn(move || feed(pipe, &queue)));
        let said = process.stderr.take().map(|errors| std::thread::spawn(move || hear(errors)));
        Ok(Self { process, pictures: Some(pictures), feeding, said })
    }

    /// Hands a picture over; the error is why there will be no film.
    pub(super) fn add(&mut self, mut picture: Vec<u8>) -> Result<(), String> {
        let start = Instant::now();
        let Some(pictures) = &self.pictures else { return Err("it was given up".to_owned()) };
        loop {
            picture = match pictures.try_send(picture) {
                Ok(()) => return Ok(()),
                Err(TrySendError::Disconnected(_)) => return Err("it takes no more pictures".to_owned()),
                Err(TrySendError::Full(picture)) => picture,
            };
            if start.elapsed() > patience() {
                end(&mut self.process);
                return Err(format!("it took no picture for {} s", patience().as_secs()));
            }
            std::thread::sleep(PAUSE);
        }
    }

    /// Waits for the end; the error is what the encoder said, or that it did not end.
    pub(super) fn finish(mut self) -> Result<(), String> {
        self.pictures = None;
        let end = ended(&mut self.process, patience);
        // both end with the process
        self.feeding.take().map(JoinHandle::join);
        let said = self.said.take().and_then(|thread| thread.join().ok()).unwrap_or_default();
        match end {
            Some(true) => Ok(()),
            Some(false) => Err(said.trim().to_owned()),
            None => Err(format!("it did not end within {} s {said}", patience().as_secs()).trim().to_owned()),
        }
    }
}

impl Drop for Encoder {
    fn drop(&mut self) {
        self.pictures = None;
        if matches!(self.process.try_wait(), Ok(None)) {
            end(&mut self.process);
        }
        at_work().retain(|leader| *leader != self.process.id());
    }
}

fn feed(mut pipe: impl Write, queue: &Receiver<Vec<u8>>) {
    for picture in queue {
        if pipe.write_all(&picture).is_err() {
            return;
        }
    }
}

/// Reads to the end; the last words.
fn hear(mut errors: impl Read) -> String {
    let (mut kept, mut some) = (Vec::new(), [0; 4096]);
    while let Ok(count @ 1..) = errors.read(&mut some) {
        kept.extend_from_slice(&some[..count]);
        let over = kept.len().saturating_sub(KEPT);
        kept.drain(..over);
    }
    let text = String::from_utf8_lossy(&kept);
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(LINES)..].join(" / ")
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    use super::*;

    fn shell(script: &str) -> Encoder {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        Encoder::start(command).unwrap()
    }

    #[test]
    fn what_it_says_is_drained_and_its_last_words_are_kept() {
        let mut encoder = shell("yes error | head -c 1000000 >&2; cat >/dev/null; echo last >&2; exit 1");
        for _ in 0..4 {
            encoder.add(vec![0; 1 << 20]).unwrap();
        }
        let said = encoder.finish().unwrap_err();
        assert!(said.ends_with("last") && said.len() <= KEPT, "{}", said.len());
    }

    #[test]
    fn one_that_takes_everything_and_is_content_makes_a_film() {
        let mut encoder = shell("cat >/dev/null");
        encoder.add(vec![0; 1 << 20]).unwrap();
        encoder.finish().unwrap();
    }

    #[test]
    fn one_that_ends_early_takes_no_more() {
        let mut encoder = shell("exit 0");
        let gone = (0..1000).any(|_| {
            std::thread::sleep(Duration::from_millis(1));
            encoder.add(vec![0; 1 << 20]).is_err()
        });
        assert!(gone);
    }

    #[test]
    fn one_that_does_not_end_is_ended() {
        let mut process = alone(Command::new("sh").args(["-c", "sleep 1000; true"])).spawn().unwrap();
        assert_eq!(ended(&mut process, || Duration::from_millis(100)), None);
        assert!(process.try_wait().unwrap().is_some());
    }
}
