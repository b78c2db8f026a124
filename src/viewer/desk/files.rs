//! What the worker writes to the disk when asked: screenshots and recordings.

use super::super::adding::mesh;
use super::super::model::Weight;
use super::super::record::{self, Recording};
use super::Desk;
use crate::export::Origin;
use crate::scene::RenderSettings;
use crate::{Error, Result};

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

    /// Writes a scene file of the scene as it is now, with what pictures show.
    pub(super) fn save_scene(&mut self) -> Result<()> {
        let (Some(session), Some(look)) = (&self.session, &self.look) else { return Ok(()) };
        let mut scene = (**session.scene()).clone();
        let settings = look.settings.clone();
        scene.render = RenderSettings { size: scene.render.size, views: scene.render.views, ..settings };
        scene.output.fields.retain(|field| *field != look.field);
        scene.output.fields.insert(0, look.field);
        let (folder, name) = &self.saved;
        std::fs::create_dir_all(folder).map_err(|source| Error::io(folder, source))?;
        let copied = mesh::bring_along(&mut scene.bodies, folder)?;
        let text = toml::to_string(&scene).map_err(|error| Error::Scene(error.to_string()))?;
        let path = (1..).map(|k| folder.join(format!("{name}_saved_{k:03}.toml"))).find(|path| !path.exists());
        let path = path.unwrap_or_else(|| folder.join(name));
        std::fs::write(&path, text).map_err(|source| Error::io(&path, source))?;
        let beside: String = copied.iter().map(|file| format!(", with {}", file.display())).collect();
        self.note(Weight::Fine, format!("saved {}{beside}", path.display()));
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
