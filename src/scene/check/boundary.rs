//! Checks of the sides of the domain.

use crate::scene::boundary::{InletRule, Patched, TimedInlet};
use crate::scene::check::Check;
use crate::scene::check::shape;
use crate::scene::finding::Finding;
use crate::scene::{Boundaries, Boundary, MAX_REMEMBERED};

/// Cells that a periodic axis needs: the stencils must not meet themselves.
const FEWEST_PERIODIC_CELLS: u32 = 4;
/// Least share of the ambient pressure at the top of an atmosphere.
const THINNEST: f64 = 1e-4;
/// Rules of all sides together that let gas through.
pub const MAX_OPENINGS: usize = 64;

impl Check<'_> {
    /// Every side.
    pub(crate) fn boundary(&mut self) {
        let boundary = &self.scene.boundary;
        let axes = self.scene.domain.axes();
        let mut openings = 0;
        for (index, (side, name)) in boundary.sides().into_iter().zip(Boundaries::NAMES).enumerate() {
            let path = format!("boundary.{name}");
            if index / 2 >= axes && *side != Boundary::Wall {
                let help = format!("the scene has {} axes; remove the key", self.scene.domain.dimension);
                self.add(&path, "this side belongs to an inactive axis", help);
                continue;
            }
            openings += side.rules().iter().filter(|rule| !matches!(rule, Boundary::Wall | Boundary::Periodic)).count();
            if *side == Boundary::Periodic {
                self.periodic(&path, index);
            }
            if let Boundary::Patched(patched) = side {
                self.patched(&format!("{path}.patched"), patched, index);
            } else {
                self.rule(&path, side, index);
            }
        }
        if openings > MAX_OPENINGS {
            self.add("boundary", format!("{openings} open rules"), format!("give at most {MAX_OPENINGS}"));
        }
    }

    /// Ambient gas under gravity fills the domain.
    pub(crate) fn atmosphere(&mut self) {
        let scene = self.scene;
        let known = scene.gas.ambient.pressure > 0.0 && scene.gas.ambient.density > 0.0 && scene.gas.gamma > 1.0;
        if known && scene.is_stratified() && scene.least_pressure_ratio() < THINNEST {
            let ratio = scene.least_pressure_ratio();
            let message = format!("gravity leaves {ratio:.1e} of the pressure of `ambient` at the top of the domain");
            let help = format!(
                "it must be at least {THINNEST:e}: a weaker gravity, a lower domain, or gas.atmosphere = \"uniform\""
            );
            self.add("gravity", message, help);
        }
    }

    /// What outlets remember has room on the device.
    pub(crate) fn remembered(&mut self) {
        if self.scene.remembered().states.len() > MAX_REMEMBERED {
            let message = format!("more than {MAX_REMEMBERED} different states lie at the outlets at the start");
            self.add("boundary", message, "let fewer regions end there, or make the sides a \"far_field\"");
        }
    }

    fn periodic(&mut self, path: &str, index: usize) {
        let (scene, axis) = (self.scene, index / 2);
        if *scene.boundary.sides()[index ^ 1] != Boundary::Periodic {
            let other = Boundaries::NAMES[index ^ 1];
            let help = format!("write {other} = \"periodic\" too: what leaves here enters there");
            self.add(path, "only one side of the axis is periodic", help);
        }
        if scene.domain.cells[axis] < FEWEST_PERIODIC_CELLS {
            let message = format!("{} cells along a periodic axis", scene.domain.cells[axis]);
            self.add("domain.cells", message, format!("give at least {FEWEST_PERIODIC_CELLS}"));
        }
        if !scene.bodies.is_empty() {
            let help = "remove the bodies, or use walls or outlets: solids do not cross periodic sides";
            self.add(path, "a periodic side in a scene with bodies", help);
        }
    }

    fn patched(&mut self, path: &str, patched: &Patched, index: usize) {
        let side = self.scene.boundary.sides()[index];
        for (number, rule) in side.rules().into_iter().enumerate() {
            let key = match number {
                0 => format!("{path}.base"),
                _ => format!("{path}.patches[{}].rule", number - 1),
            };
            if matches!(rule, Boundary::Patched(_) | Boundary::Periodic) {
                self.add(
                    key,
                    "no rule for a part of a side",
                    "patches do not nest, and a whole side is periodic or none",
                );
            } else {
                self.rule(&key, rule, index);
            }
        }
        for (number, patch) in patched.patches.iter().enumerate() {
            let key = format!("{path}.patches[{number}].shape");
            shape::sizes(&key, &patch.shape, &mut self.findings);
        }
    }

    /// Patches that hold no face.
    pub(crate) fn patches_cover(&mut self) {
        let domain = &self.scene.domain;
        for (index, (side, name)) in self.scene.boundary.sides().into_iter().zip(Boundaries::NAMES).enumerate() {
            let Boundary::Patched(patched) = side else { continue };
            for (number, patch) in patched.patches.iter().enumerate() {
                if !domain.side_faces(index).any(|center| patch.shape.distance(center) < 0.0) {
                    let key = format!("boundary.{name}.patched.patches[{number}].shape");
                    let help = "the shape must hold the centre of at least one face of the side";
                    self.findings.push(Finding::new(key, "the patch covers no face of the side", help));
                }
            }
        }
    }

    fn rule(&mut self, path: &str, rule: &Boundary, index: usize) {
        match rule {
            Boundary::Inlet(state) => self.inward(format!("{path}.inlet.velocity"), state.velocity, index),
            Boundary::SubsonicInlet(inflow) => {
                self.inward(format!("{path}.subsonic_inlet.velocity"), inflow.velocity, index);
            }
            Boundary::TimedInlet(inlet) => self.timed(&format!("{path}.timed_inlet"), inlet, index),
            _ => {}
        }
    }

    fn timed(&mut self, path: &str, inlet: &TimedInlet, index: usize) {
        if inlet.table.is_empty() {
            self.add(format!("{path}.table"), "no entries", "give at least one state with its time");
        }
        let mut last = f64::NEG_INFINITY;
        for (number, state) in inlet.table.iter().enumerate() {
            let key = |name: &str| format!("{path}.table[{number}].{name}");
            if !(state.time > last && state.time.is_finite()) {
                let message = format!("{} does not come after {last}", state.time);
                self.add(key("time"), message, "give finite times in ascending order [s]");
            }
            last = state.time;
            self.inward(key("velocity"), state.velocity, index);
            if inlet.rule != InletRule::Subsonic {
                self.positive(key("pressure"), state.pressure, "[Pa]");
            }
        }
    }

    fn inward(&mut self, path: String, velocity: [f64; 3], index: usize) {
        let outward = if index.is_multiple_of(2) { -1.0 } else { 1.0 };
        if velocity[index / 2] * outward > 0.0 {
            let help = "turn the velocity round, or make the side an \"outlet\"";
            self.add(path, format!("{velocity:?} points out of the domain"), help);
        }
    }
}
