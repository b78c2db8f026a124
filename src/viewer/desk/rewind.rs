//! Going back: to a state that is kept, with the parameters of now.

use super::{Desk, lock};
use crate::Result;

impl Desk {
    /// Goes to the last state that is kept up to a time \[s\], and waits there.
    pub(super) fn rewind(&mut self, time: f64) -> Result<()> {
        let Some(session) = &mut self.session else { return Ok(()) };
        self.replay = session.is_of_a_run();
        let before = (session.step_count(), session.is_touched());
        let time = session.rewind(time)?;
        (self.playing, self.steps_left) = (false, 0);
        if (session.step_count(), false) == before {
            return Ok(());
        }
        (self.stale, self.news) = (true, true);
        self.records.retain(|record| record.time <= time);
        let mut outbox = lock(&self.outbox);
        outbox.records.retain(|record| record.time <= time);
        outbox.rewound = Some(outbox.rewound.map_or(time, |earlier| earlier.min(time)));
        Ok(())
    }
}
