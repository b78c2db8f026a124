//! What the fault word of the device means.

use super::Simulation;
use crate::error::Error;
use crate::math::plain;
use crate::state::Control;
use crate::state::constants::STAGES;

impl Simulation {
    /// The fault of the run as an error.
    pub(super) fn fault(&self, control: &Control) -> Error {
        let (stage, at) = ((control.fault >> 27) as usize, control.fault & 0x07ff_ffff);
        let name = STAGES.get(stage).copied().unwrap_or("unknown");
        let (place, reason) = match name {
            "g2p" => {
                (format!("particle {at}"), "it is turned inside out or not finite; try a smaller numerics.elastic_cfl")
            }
            "coupled_solve" => (
                "all cells".to_owned(),
                "the pressure solve did not converge; try a larger numerics.tolerance or a smaller time.cfl",
            ),
            "interface" => {
                (self.cell(at), "more surface vertices of fragments than there is room for; try a finer resolution")
            }
            _ => (self.cell(at), "density or pressure is not positive and finite; try a smaller time.cfl"),
        };
        let step = u64::from(control.step) + 1;
        let reason = match (step, name) {
            (1, "g2p" | "coupled_solve" | "interface") | (2.., _) => reason.to_owned(),
            _ => format!(
                "density or pressure is not positive and finite; in the first step that is usually the start state: {}",
                self.start_text()
            ),
        };
        Error::Diverged { step, stage: name, place, reason }
    }

    /// Ranges of the state as it is now: a step that failed leaves that of its start in most cells.
    fn start_text(&self) -> String {
        let Ok(now) = self.snapshot() else { return "it cannot be read back".to_owned() };
        let range = |values: &mut dyn Iterator<Item = f64>| {
            let finite = values.filter(|value| value.is_finite());
            let [low, high] =
                finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
            format!("{} to {}", plain(low), plain(high))
        };
        let gas = || {
            now.density.iter().zip(&now.pressure).map(|(d, p)| (f64::from(*d), f64::from(*p))).filter(|(d, _)| *d > 0.0)
        };
        format!(
            "density {}, pressure {}, temperature p / rho {}",
            range(&mut gas().map(|(density, _)| density)),
            range(&mut gas().map(|(_, pressure)| pressure)),
            range(&mut gas().map(|(density, pressure)| pressure / density))
        )
    }

    fn cell(&self, slot: u32) -> String {
        format!("cell {:?}", self.state.grid.cell(slot))
    }
}
