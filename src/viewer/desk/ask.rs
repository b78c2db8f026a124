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
}
