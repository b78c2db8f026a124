//! The writer: a thread that encodes and writes while the device goes on. Its queue is short, so that a slow disk slows the
//! run down instead of filling the memory.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::folder::Folder;
use super::index::Index;
use super::interrupt;
use super::page::moving::Small;
use super::run::Checkpoint;
use super::tables::{Marks, Tables};
use crate::Result;
use crate::diagnostics::StepRecord;
use crate::export::video::VideoExporter;
use crate::export::{self, Exporter, Moment, Needs, Origin, atomic, checkpoint};
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
    /// The state that they lead to, to go on from.
    pub(super) checkpoint: Option<Box<Checkpoint>>,
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

/// What a run has written before it goes on.
#[derive(Clone, Debug, Default)]
pub(super) struct Before {
    /// Where its tables lie.
    pub(super) folder: PathBuf,
    /// How far they had come.
    pub(super) marks: Marks,
    /// Frames that lie in the folder of the run.
    pub(super) frames: u32,
}

/// What the thread writes of every frame, and where.
#[derive(Clone, Debug, Default)]
pub(super) struct Files {
    /// Folder of the results.
    pub(super) folder: PathBuf,
    /// Names of the formats.
    pub(super) formats: Vec<String>,
    /// A film and its pictures per second.
    pub(super) video: Option<(PathBuf, u32)>,
    /// Why there will be no film, though one is asked for.
    pub(super) lost_film: Option<String>,
    /// Whether there are tables.
    pub(super) tables: bool,
    /// Whether the folder keeps a list of what is written.
    pub(super) listed: bool,
    /// What was written before.
    pub(super) before: Before,
    /// File or name of the scene, and the device.
    pub(super) source: [String; 2],
}

impl Files {
    /// The exporters; the error is an unknown format.
    fn open(&self) -> Result<Vec<Box<dyn Exporter>>> {
        let mut exporters = export::open(&self.formats, &self.folder)?;
        if let Some((path, rate)) = &self.video {
            exporters.push(Box::new(VideoExporter::new(path, *rate, &self.folder.join("frames"))));
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
    thread: JoinHandle<(Written, Result<()>)>,
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
    /// What the page of the run shows of its pictures.
    pub(super) small: Small,
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

    /// Waits until everything is written: what was, and [`crate::Error::Io`] if something could not be.
    pub(super) fn finish(self) -> (Written, Result<()>) {
        drop(self.queue);
        match self.thread.join() {
            Ok(done) => done,
            Err(panic) => std::panic::resume_unwind(panic),
        }
    }
}

fn work(messages: &Receiver<Message>, files: &Files, scene: &Scene) -> (Written, Result<()>) {
    atomic::remember();
    let mut work = match Work::begin(files, scene) {
        Ok(work) => work,
        Err(error) => return (Written { frames: files.before.frames, ..Written::default() }, Err(error)),
    };
    let outcome = messages.iter().try_for_each(|message| work.take(message));
    if outcome.is_err() {
        // as many rows as still find room
        let _ = work.tables.as_mut().map(Tables::save);
        return (work.written, outcome);
    }
    let start = Instant::now();
    for exporter in &mut work.exporters {
        work.written.films.extend(exporter.finish());
    }
    work.written.busy += start.elapsed();
    (work.written, Ok(()))
}

/// The thread at work.
struct Work<'a> {
    files: &'a Files,
    exporters: Vec<Box<dyn Exporter>>,
    origin: Origin,
    tables: Option<Tables>,
    index: Option<Index>,
    written: Written,
    /// Whether a frame was given up.
    given_up: bool,
}

impl<'a> Work<'a> {
    fn begin(files: &'a Files, scene: &Scene) -> Result<Self> {
        let Before { folder, marks, frames } = &files.before;
        let mut exporters = files.open()?;
        for exporter in &mut exporters {
            exporter.go_on(*frames, &|index| scene.frame_time(index))?;
        }
        let tables = files.tables.then(|| Tables::continued(&files.folder, scene, (folder, marks)));
        let mut tables = tables.transpose()?;
        let origin = Origin::of(scene).at(&files.source[0], &files.source[1]);
        let index = tables.as_mut().map(|tables| {
            let names = tables.marks().files.into_keys().collect();
            Index::begin(&files.folder, &origin, (&files.formats, names), *frames)
        });
        let films = files.lost_film.iter().cloned().map(Err).collect();
        let paged = files.tables && files.formats.iter().any(|name| name == "png");
        let small = if paged { Small::of(scene.time.frames as usize + 1) } else { Small::default() };
        let written = Written { frames: *frames, films, small, ..Written::default() };
        Ok(Self { files, exporters, origin, tables, index, written, given_up: false })
    }

    /// Writes what a message holds, and lists it.
    fn take(&mut self, message: Message) -> Result<()> {
        let start = Instant::now();
        self.write(message)?;
        if self.files.listed {
            Folder::note(&self.files.folder, &atomic::newly_written())?;
        }
        self.written.busy += start.elapsed();
        Ok(())
    }

    fn write(&mut self, Message { records, frame, checkpoint }: Message) -> Result<()> {
        if let Some(tables) = &mut self.tables {
            tables.add_steps(&records);
        }
        // a state behind a frame that was given up would leave a hole
        self.given_up |= frame.is_some() && interrupt::urgent();
        if let Some(frame) = frame.filter(|_| !interrupt::urgent()) {
            self.write_frame(&frame)?;
        }
        let Some(tables) = &mut self.tables else { return Ok(()) };
        tables.save()?;
        let folder = &self.files.folder;
        if let Some(mut checkpoint) = checkpoint.filter(|_| !self.given_up) {
            let about = checkpoint.about(tables.marks());
            let saved = &checkpoint.saved;
            checkpoint::write(folder, &self.origin.source, saved, &about, checkpoint.keep)?;
            if let Some(index) = &mut self.index {
                index.add_checkpoint(folder, saved.time, saved.step);
            }
        }
        self.index.as_ref().map_or(Ok(()), |index| index.save(folder))
    }

    fn write_frame(&mut self, frame: &FrameToWrite) -> Result<()> {
        let FrameToWrite { index, time, step, pictures, snapshot, stored } = frame;
        if let (Some(tables), Some(snapshot)) = (&mut self.tables, snapshot) {
            tables.add_bodies(*index, *time, snapshot);
        }
        let (snapshot, stored) = (snapshot.as_ref(), stored.as_ref());
        let moment =
            Moment { index: *index, origin: &self.origin, time: *time, step: *step, pictures, snapshot, stored };
        for exporter in &mut self.exporters {
            exporter.write(&moment)?;
        }
        if let Some((place, picture)) = moment.places().next() {
            let path = self.files.folder.join("frames").join(place).with_extension("png");
            self.written.small.keep(*index, &path, &picture.frame);
        }
        self.written.frames += 1;
        if let Some(list) = &mut self.index {
            list.add_frame(*index, *time, *step);
        }
        Ok(())
    }
}
