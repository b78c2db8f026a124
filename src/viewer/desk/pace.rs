//! When the scene is to go on, and when the next state of a run is to be shown.

use super::super::budget::{Rate, paced_steps};
use super::super::model::Pace;
use super::super::session::Session;
use super::Desk;
use crate::Result;
use crate::export::video::FRAME_RATE;

/// What of a lag behind the pace is caught up \[s\].
pub(super) const LONGEST_LAG: f64 = 0.1;

impl Desk {
    pub(super) fn play(&mut self, playing: bool) -> Result<()> {
        self.playing = playing && self.ready();
        self.rate = Rate::since(self.now());
        self.start_pace();
        match (self.playing, self.replay) {
            (true, true) => self.play_again(),
            (true, false) => self.pass_the_end(),
            (false, _) => Ok(()),
        }
    }

    /// Whoever goes on at the end wants to see more.
    pub(super) fn pass_the_end(&mut self) -> Result<()> {
        match &mut self.session {
            Some(session) if session.finished() => session.go_on(),
            _ => Ok(()),
        }
    }

    pub(super) fn start_pace(&mut self) {
        self.paced_from = (self.now(), self.session.as_ref().map_or(0.0, Session::time));
    }

    /// Steps that budget and pace allow now.
    pub(super) fn due_steps(&self) -> u32 {
        let (Some(session), most) = (&self.session, self.budget.steps()) else { return 0 };
        match self.pace {
            Pace::Fastest => most,
            Pace::Lasting(seconds) => {
                let speed = session.scene().time.until / seconds;
                paced_steps(-speed * self.lag(session, speed), session.dt(), most)
            }
        }
    }

    /// Whether the scene, or the run, is to go on now.
    pub(super) fn is_due(&self) -> bool {
        if self.replay { self.next_is_due() } else { self.due_steps() > 0 }
    }

    /// How far simulated time is behind its pace \[s of the clock\]; negative if it is ahead.
    fn lag(&self, session: &Session, speed: f64) -> f64 {
        self.now() - self.paced_from.0 - (session.time() - self.paced_from.1) / speed
    }

    /// A long lag is forgotten: after a hitch the scene does not race.
    pub(super) fn forget_lag(&mut self) {
        let Some(session) = &self.session else { return };
        let speed = match self.pace {
            _ if self.replay => replay_speed(session),
            Pace::Lasting(seconds) => session.scene().time.until / seconds,
            Pace::Fastest => return,
        };
        let lag = self.lag(session, speed);
        self.paced_from.0 += (lag - LONGEST_LAG).max(0.0);
    }

    /// Whether the next state of a run is due.
    fn next_is_due(&self) -> bool {
        let Some(session) = &self.session else { return false };
        let speed = replay_speed(session);
        // at the last one it is time to stop
        session.next().is_none_or(|next| self.lag(session, speed) >= (next - session.time()) / speed)
    }

    /// Shows the next state of a run where it is due; behind the last one it is over.
    pub(super) fn show_next(&mut self) -> Result<()> {
        if !self.next_is_due() {
            return Ok(());
        }
        let Some(session) = &mut self.session else { return Ok(()) };
        if session.show_next()? {
            (self.stale, self.news) = (true, true);
            self.forget_lag();
        } else {
            self.playing = false;
        }
        Ok(())
    }

    /// Plays a run that is over from its first state on.
    fn play_again(&mut self) -> Result<()> {
        if self.session.as_ref().is_some_and(|session| session.next().is_none()) {
            self.rewind(0.0)?;
            self.playing = true;
            self.start_pace();
        }
        Ok(())
    }
}

/// Simulated time that passes in a second of a run that is shown: its frames follow each other as in a film.
fn replay_speed(session: &Session) -> f64 {
    session.scene().frame_interval() * f64::from(FRAME_RATE)
}
