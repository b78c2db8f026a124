//! Clicks: one on a body picks it, one on gas sets a probe, one on a probe takes it away.

use std::time::{Duration, Instant};

use egui::{Color32, FontId, Rect, Response, Stroke, Ui};

use super::model::{Command, Spot};
use super::panel::plots::COLORS;
use crate::scene::{Probe, Scene};

/// A second click within this time makes a double click, which means something else.
const WAITS: Duration = Duration::from_millis(320);
/// Distance from a probe up to which a click means it, in cells.
const NEAR: f64 = 1.5;

/// A click that may become a double click.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Click(Option<(Instant, [f64; 2])>);

impl Click {
    /// Hears the mouse over a picture; `may` where a click does not mean something else.
    pub(super) fn hear(&mut self, ui: &Ui, response: &Response, place: Rect, may: bool) -> Option<Command> {
        if response.double_clicked() || response.dragged() {
            self.0 = None;
        } else if let (true, true, Some(pointer)) = (response.clicked(), may, response.interact_pointer_pos()) {
            let share = (pointer - place.min) / place.size();
            self.0 = Some((Instant::now(), [f64::from(share.x), f64::from(share.y)]));
        }
        let (since, at) = self.0?;
        if since.elapsed() < WAITS {
            ui.ctx().request_repaint_after(WAITS);
            return None;
        }
        self.0 = None;
        Some(Command::Pick(at))
    }
}

/// What a click on the gas does to the probes.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Change {
    /// A new one, the last.
    Set(Probe),
    /// This one goes.
    Clear(usize),
}

/// What it is for a click that found no body.
pub(super) fn on_gas(scene: &Scene, spot: &Spot) -> Option<Change> {
    if spot.point.is_empty() {
        return None;
    }
    let position: [f64; 3] = std::array::from_fn(|axis| spot.point.get(axis).copied().unwrap_or(0.0));
    let near = |probe: &Probe| {
        let away = probe.position.iter().zip(position).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        away < NEAR * scene.domain.spacing()
    };
    if let Some(index) = scene.probes.iter().position(near) {
        return Some(Change::Clear(index));
    }
    let used = |name: &String| {
        scene.probes.iter().any(|probe| probe.name == *name) || scene.gauges.iter().any(|gauge| gauge.name == *name)
    };
    let name = (1..).map(|number| format!("probe_{number}")).find(|name| !used(name))?;
    Some(Change::Set(Probe { name, position }))
}

impl Change {
    /// The scene with it.
    pub(super) fn applied(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        match self {
            Self::Set(probe) => scene.probes.push(probe.clone()),
            Self::Clear(index) => drop(scene.probes.remove(*index)),
        }
        scene
    }
}

/// Draws the probes over a picture, in the colours of their curves.
pub(super) fn paint(ui: &Ui, place: Rect, scene: &Scene, probes: &[Option<[f64; 2]>]) {
    let painter = ui.painter().with_clip_rect(place);
    for ((probe, at), color) in scene.probes.iter().zip(probes).zip(COLORS.into_iter().cycle()) {
        let Some([x, y]) = at.map(|at| at.map(|share| share as f32)) else { continue };
        let middle = place.min + place.size() * egui::vec2(x, y);
        painter.circle_stroke(middle, 5.0, Stroke::new(5.0, Color32::from_black_alpha(170)));
        painter.circle_stroke(middle, 5.0, Stroke::new(2.0, color));
        let text = painter.layout_no_wrap(probe.name.clone(), FontId::proportional(13.0), color);
        let around = Rect::from_min_size(middle + egui::vec2(11.0, -0.5 * text.size().y), text.size());
        painter.rect_filled(around.expand2(egui::vec2(3.0, 1.0)), 3.0, Color32::from_black_alpha(225));
        painter.galley(around.min, text, color);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_click_takes_the_probe_away() {
        let scene = Scene::find("playground_2d", &[]).unwrap();
        let spot = |x: f64| Spot { at: [0.5; 2], point: vec![x, 0.5], value: None, body: None };
        let (one, other) = (spot(0.7), spot(0.9));
        let first = on_gas(&scene, &one).unwrap().applied(&scene);
        let both = on_gas(&first, &other).unwrap().applied(&first);
        let names: Vec<&str> = both.probes.iter().map(|probe| probe.name.as_str()).collect();
        assert_eq!((names, both.probes[1].position), (vec!["probe_1", "probe_2"], [0.9, 0.5, 0.0]));
        assert!(both.checked().is_ok());
        assert_eq!(on_gas(&both, &spot(0.7 + scene.domain.spacing())), Some(Change::Clear(0)));
        let left = on_gas(&both, &one).unwrap().applied(&both);
        assert_eq!(on_gas(&left, &one).unwrap().applied(&left).probes.len(), 2);
        assert_eq!(on_gas(&scene, &Spot { point: Vec::new(), ..one }), None);
    }
}
