//! The writer: a thread that encodes and writes while the device goes on. Its queue is short, so that a slow disk slows the
//! run down instead of filling the memory.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::tables::Tables;
use crate::Result;
use crate::diagnostics::StepRecord;
use crate::export::{self, Moment};
use crate::render::Picture;
use crate::scene::Scene;
use crate::snapshot::Snapshot;

/// Frames that may wait.
const QUEUE: usize = 2;

/// What happened since the last message.
#[derive(Debug, Default)]
pub(super) struct Message {
    /// Steps.
    pub(super) records: Vec<StepRecord>,
    /// The frame that they lead to; none at the end of a run that broke off.
    pub(super) frame: Option<FrameToWrite>,
}

/// A frame on its way to the disk.
#[derive(Debug)]
pub(super) struct FrameToWrite {
    /// Number, from 0.
    pub(super) index: u32,
    /// Time of the frame \[s\].
    pub(super) time: f64,
    /// Steps done.
    pub(super) step: u64,
    /// Pictures.
    pub(super) pictures: Vec<Picture>,
    /// The state, if something needs it.
    pub(super) snapshot: Option<Snapshot>,
}

/// Handle of the thread.
#[derive(Debug)]
pub(super) struct Writer {
    queue: SyncSender<Message>,
    thread: JoinHandle<Result<Written>>,
}

/// What the thread has done.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Written {
    /// Frames.
    pub(super) frames: u32,
    /// Time spent encoding and writing.
    pub(super) busy: Duration,
}

impl Writer {
    /// Starts the thread for one folder and these export formats.
    ///
    /// # Errors
    /// [`crate::Error::Usage`] if a format is unknown.
    pub(super) fn start(folder: &Path, scene: &Scene, formats: Vec<String>) -> Result<Self> {
        // Unknown names are the user's business, here and now.
        export::open(&formats, folder)?;
        let (queue, messages) = sync_channel(QUEUE);
        let (folder, scene): (PathBuf, Scene) = (folder.to_owned(), scene.clone());
        let thread = std::thread::spawn(move || work(&messages, &folder, &scene, &formats));
        Ok(Self { queue, thread })
    }

    /// Hands a message over; waits while the queue is full. Returns false if the thread has stopped: [`Writer::finish`] says why.
    pub(super) fn send(&self, message: Message) -> bool {
        self.queue.send(message).is_ok()
    }

    /// Waits until everything is written.
    ///
    /// # Errors
    /// [`crate::Error::Io`] if something could not be.
    pub(super) fn finish(self) -> Result<Written> {
        drop(self.queue);
        match self.thread.join() {
            Ok(result) => result,
            Err(panic) => std::panic::resume_unwind(panic),
        }
    }
}

fn work(messages: &Receiver<Message>, folder: &Path, scene: &Scene, formats: &[String]) -> Result<Written> {
    let mut exporters = export::open(formats, folder)?;
    let mut tables = Tables::new(folder, scene);
    let mut written = Written::default();
    for Message { records, frame } in messages {
        let start = Instant::now();
        tables.add_steps(&records);
        if let Some(frame) = frame {
            let FrameToWrite { index, time, step, pictures, snapshot } = &frame;
            if let Some(snapshot) = snapshot {
                tables.add_bodies(*index, *time, snapshot);
            }
            let moment = Moment {
                index: *index,
                title: &scene.title,
                time: *time,
                step: *step,
                pictures,
                snapshot: snapshot.as_ref(),
            };
            for exporter in &mut exporters {
                exporter.write(&moment)?;
            }
            written.frames += 1;
        }
        tables.save()?;
        written.busy += start.elapsed();
    }
    Ok(written)
}
