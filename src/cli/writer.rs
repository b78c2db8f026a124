//! The writer: a thread that encodes and writes while the device goes on. Its queue is short, so that a slow disk slows the
//! run down instead of filling the memory.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::folder::Folder;
use super::interrupt;
use super::tables::Tables;
use crate::Result;
use crate::diagnostics::StepRecord;
use crate::export::video::VideoExporter;
use crate::export::{self, Exporter, Moment, Needs, Origin, atomic};
use crate::render::{Picture, Stored};
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
    /// What pictures are drawn from, if something needs it.
    pub(super) stored: Option<Stored>,
}

/// What the thread writes of every frame, and where.
#[derive(Clone, Debug)]
pub(super) struct Files {
    /// Folder of the results.
    pub(super) folder: PathBuf,
    /// Names of the formats.
    pub(super) formats: Vec<String>,
    /// A film and its pictures per second.
    pub(super) video: Option<(PathBuf, u32)>,
    /// Whether there are tables.
    pub(super) tables: bool,
    /// Whether the folder keeps a list of what is written.
    pub(super) listed: bool,
}

impl Files {
    /// The exporters; the error is an unknown format.
    fn open(&self) -> Result<Vec<Box<dyn Exporter>>> {
        let mut exporters = export::open(&self.formats, &self.folder)?;
        if let Some((path, rate)) = &self.video {
            exporters.push(Box::new(VideoExporter::new(path, *rate)));
        }
        Ok(exporters)
    }

    /// What they want of every frame.
    ///
    /// # Errors
    /// [`crate::Error::Usage`] if a format is unknown.
    pub(super) fn needs(&self) -> Result<Needs> {
        Ok(Needs::of(&self.open()?))
    }
}

/// Handle of the thread.
#[derive(Debug)]
pub(super) struct Writer {
    queue: SyncSender<Message>,
    thread: JoinHandle<Result<Written>>,
}

/// What the thread has done.
#[derive(Clone, Debug, Default)]
pub(super) struct Written {
    /// Frames.
    pub(super) frames: u32,
    /// Time spent encoding and writing.
    pub(super) busy: Duration,
    /// What became of films.
    pub(super) films: Vec<std::result::Result<String, String>>,
}

impl Writer {
    /// Starts the thread for the files of a scene.
    pub(super) fn start(files: Files, scene: &Scene) -> Self {
        let (queue, messages) = sync_channel(QUEUE);
        let scene = scene.clone();
        let thread = std::thread::spawn(move || work(&messages, &files, &scene));
        Self { queue, thread }
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

fn work(messages: &Receiver<Message>, files: &Files, scene: &Scene) -> Result<Written> {
    atomic::remember();
    let mut exporters = files.open()?;
    let mut tables = files.tables.then(|| Tables::new(&files.folder, scene));
    let origin = Origin::of(scene);
    let mut written = Written::default();
    for Message { records, frame } in messages {
        let start = Instant::now();
        if let Some(tables) = &mut tables {
            tables.add_steps(&records);
        }
        if let Some(frame) = frame.filter(|_| !interrupt::urgent()) {
            let FrameToWrite { index, time, step, pictures, snapshot, stored } = &frame;
            if let (Some(tables), Some(snapshot)) = (&mut tables, snapshot) {
                tables.add_bodies(*index, *time, snapshot);
            }
            let (snapshot, stored) = (snapshot.as_ref(), stored.as_ref());
            let moment =
                Moment { index: *index, origin: &origin, time: *time, step: *step, pictures, snapshot, stored };
            for exporter in &mut exporters {
                exporter.write(&moment)?;
            }
            written.frames += 1;
        }
        if let Some(tables) = &mut tables {
            tables.save()?;
        }
        if files.listed {
            Folder::note(&files.folder, &atomic::newly_written())?;
        }
        written.busy += start.elapsed();
    }
    let start = Instant::now();
    for exporter in &mut exporters {
        written.films.extend(exporter.finish());
    }
    written.busy += start.elapsed();
    Ok(written)
}
