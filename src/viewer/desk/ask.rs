//! What lies under the pointer.

use super::super::worker::lock;
use super::Desk;
use crate::Result;

impl Desk {
    /// Leaves in the outbox what lies at a place of the picture, in shares of its width and height.
    pub(super) fn ask(&mut self, at: [f64; 2]) -> Result<()> {
        let (Some(session), Some(look), Some(_)) = (&self.session, &self.look, &self.shown) else { return Ok(()) };
        let spot = session.spot(at, look)?;
        lock(&self.outbox).spot = Some(spot);
        Ok(())
    }

    /// The same for a click.
    pub(super) fn pick(&mut self, at: [f64; 2]) -> Result<()> {
        let (Some(session), Some(look), Some(_)) = (&self.session, &self.look, &self.shown) else { return Ok(()) };
        let spot = session.spot(at, look)?;
        lock(&self.outbox).picked = Some(spot);
        Ok(())
    }

    /// Leaves bodies out of pictures.
    pub(super) fn hide(&mut self, hidden: Vec<usize>) {
        if let Some(session) = &mut self.session {
            session.hide(hidden);
            self.stale = true;
        }
    }
}
