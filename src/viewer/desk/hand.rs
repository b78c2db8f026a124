//! What the mouse does to the scene: blasts, and bodies that are held and let go.

use std::path::Path;

use super::super::adding::{Addition, MeshFile};
use super::super::model::{Strike, Weight};
use super::super::worker::lock;
use super::Desk;
use crate::Result;
use crate::math::plain;

impl Desk {
    pub(super) fn strike(&mut self, strike: &Strike) -> Result<()> {
        let (Some(session), Some(look)) = (&mut self.session, &self.look) else { return Ok(()) };
        let (place, energy) = session.strike(strike, look, &mut self.records)?;
        self.replay = false;
        (self.stale, self.news) = (true, true);
        let place = place.map(plain)[..session.scene().domain.axes()].join(", ");
        self.note(Weight::Fine, format!("{} J at ({place}) m", plain(energy)));
        Ok(())
    }

    /// Adds a body to the scene as it stands.
    pub(super) fn add(&mut self, at: [f64; 2], addition: &Addition) -> Result<()> {
        let (Some(session), Some(look)) = (&mut self.session, &self.look) else { return Ok(()) };
        let (name, place) = session.add(at, addition, look, &mut self.records)?;
        (self.replay, self.stale, self.news) = (false, true, true);
        let place = place.map(short)[..session.scene().domain.axes()].join(", ");
        self.note(Weight::Fine, format!("`{name}` of {} at ({place}) m; Left takes it back", addition.material));
        Ok(())
    }

    /// Reads a mesh for the next body. A wrong one leaves the form as it is.
    pub(super) fn read_mesh(&mut self, file: &Path, repair: bool) -> Result<()> {
        let Some(session) = &self.session else {
            let text = "open a scene first; a mesh becomes a body of the scene that is open";
            self.note(Weight::Wrong, format!("{}: {text}", file.display()));
            return Ok(());
        };
        match MeshFile::read(file, session.scene(), repair) {
            Ok(mesh) => {
                let (name, triangles) = (&mesh.name, mesh.triangles);
                self.note(Weight::Fine, format!("`{name}`, {triangles} triangles: a click in the picture adds it"));
                lock(&self.outbox).mesh = Some(mesh);
            }
            Err(error) => self.note(Weight::Wrong, error.to_string()),
        }
        Ok(())
    }

    /// Holds the body at a place of the picture, if there is one.
    pub(super) fn hold(&mut self, at: [f64; 2]) -> Result<()> {
        let (Some(session), Some(look)) = (&mut self.session, &self.look) else { return Ok(()) };
        let held = session.hold(at, look, &mut self.records);
        let found = held.as_ref().is_ok_and(Option::is_some);
        // a run that is looked at goes on from here
        self.replay &= !found;
        lock(&self.outbox).holds = Some(found);
        held.map(|_| ())
    }

    /// Leads it to another place.
    pub(super) fn lead(&mut self, at: [f64; 2]) {
        if let (Some(session), Some(look)) = (&mut self.session, &self.look) {
            session.lead(at, look);
        }
    }

    /// Lets go of it.
    pub(super) fn let_go(&mut self) -> Result<()> {
        let Some(session) = &mut self.session else { return Ok(()) };
        if let Some(thrown) = session.let_go(&mut self.records)? {
            let axes = session.scene().domain.axes();
            let thrown = thrown.map(short)[..axes].join(", ");
            (self.stale, self.news) = (true, true);
            self.note(Weight::Fine, format!("thrown with a momentum of ({thrown}) kg m/s"));
        }
        Ok(())
    }
}

/// A number with three digits.
fn short(value: f64) -> String {
    plain(format!("{value:.2e}").parse().unwrap_or(value))
}
