//! What the worker writes to the disk when asked: screenshots and recordings.

use super::super::model::Weight;
use super::super::record::{self, Recording};
use super::Desk;
use crate::Result;
use crate::export::Origin;

impl Desk {
    /// Draws the picture as it stands in the window, in all its pixels, if that was not done.
    fn draw_whole(&mut self) -> Result<()> {
        if self.coarse || self.stale || self.shown.is_none() {
            (self.moving, self.stale) = (false, true);
            let playing = std::mem::replace(&mut self.playing, false);
            let drawn = self.draw();
            self.playing = playing;
            drawn?;
        }
        Ok(())
    }

    /// Saves the picture as it stands in the window.
    pub(super) fn screenshot(&mut self) -> Result<()> {
        self.draw_whole()?;
        let (Some(shown), Some(session)) = (&self.shown, &self.session) else { return Ok(()) };
        let path = record::save(&self.folder, shown, &Origin::of(session.scene()))?;
        self.note(Weight::Fine, format!("saved {}", path.display()));
        Ok(())
    }

    /// Starts a recording with the picture as it stands in the window, or ends one.
    pub(super) fn record(&mut self, on: bool) -> Result<()> {
        self.finish_recording();
        if !on {
            return Ok(());
        }
        self.draw_whole()?;
        let (Some(shown), Some(session)) = (&self.shown, &self.session) else { return Ok(()) };
        let mut recording = Recording::start(&self.folder, Origin::of(session.scene()))?;
        // A writer that fails at once says so when it is asked for the end.
        recording.add(shown);
        self.recording = Some(recording);
        Ok(())
    }

    pub(super) fn finish_recording(&mut self) {
        match self.recording.take().map(Recording::finish) {
            Some(Ok(text)) => self.note(Weight::Fine, text),
            Some(Err(error)) => self.note(Weight::Wrong, error.to_string()),
            None => {}
        }
    }
}
