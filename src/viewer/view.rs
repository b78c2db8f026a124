//! The page of an open scene: the picture, what the mouse does to it, and what is asked of the worker.

mod mouse;

use std::cmp::Ordering;
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::{ColorImage, Pos2, Rect, Response, Sense, TextureHandle, TextureOptions, Ui, Vec2};

use super::camera;
use super::charge::Charge;
use super::click::{self, Change, Click};
use super::grab::Grab;
use super::history::History;
use super::keys::Action;
use super::model::{Command, Look, Opened, Outbox, Pace, Phase, Shown, Spot, Status, Strike};
use super::panel::{Panel, Picked, amount};
use super::theme;
use crate::math::plain;
use crate::render::caption;
use crate::scene::{Camera, RenderSettings, Scene};

/// The camera counts as moving for so long after the last turn of the wheel.
const SETTLES: Duration = Duration::from_millis(250);
/// The pointer rests where it has not moved for so long \[s\].
const RESTS: f32 = 0.25;
/// Least and largest side of a picture.
const SIDES: [f32; 2] = [16.0, 8192.0];
/// Points of a scroll that make one notch.
const POINTS_PER_NOTCH: f32 = 50.0;
/// Slowest and fastest pace that keys reach \[s\].
const PACES: [f64; 2] = [0.5, 3600.0];

/// An open scene as the window sees it.
pub(super) struct View {
    pub(super) opened: Opened,
    /// The scene with the parameters that it has now.
    pub(super) scene: Arc<Scene>,
    /// What pictures should show.
    pub(super) look: Look,
    pub(super) pace: Pace,
    pub(super) shown: Option<Shown>,
    pub(super) history: History,
    pub(super) stages: Vec<(String, f64)>,
    pub(super) panel: Panel,
    /// What the user asked for in this frame.
    pub(super) commands: Vec<Command>,
    texture: Option<TextureHandle>,
    sent: Option<(Look, bool)>,
    moves_until: Instant,
    dragging: bool,
    charge: Charge,
    grab: Grab,
    held: Option<[f64; 2]>,
    click: Click,
    /// Where the probes are in the picture.
    probes: Vec<Option<[f64; 2]>>,
    /// Bodies that pictures leave out.
    pub(super) hidden: Vec<usize>,
    /// What lies under the pointer, and for which place and time that was asked.
    spot: Option<Spot>,
    asked: Option<([f64; 2], f64)>,
    /// Where the time line was dragged to last [s].
    again: f64,
}

impl View {
    pub(super) fn new(opened: Opened, pace: Pace) -> Self {
        let (look, scene) = (opened.look.clone(), Arc::clone(&opened.scene));
        Self {
            panel: Panel::new(&scene),
            opened,
            scene,
            look,
            pace,
            shown: None,
            history: History::default(),
            stages: Vec::new(),
            commands: Vec::new(),
            texture: None,
            sent: None,
            moves_until: Instant::now(),
            dragging: false,
            charge: Charge::default(),
            grab: Grab::default(),
            held: None,
            click: Click::default(),
            probes: Vec::new(),
            hidden: Vec::new(),
            spot: None,
            asked: None,
            again: 0.0,
        }
    }

    /// Dimension of the scene.
    pub(super) fn dimension(&self) -> u32 {
        self.scene.domain.dimension
    }

    /// Takes what the worker has left.
    pub(super) fn receive(&mut self, outbox: Outbox) {
        if let Some(time) = outbox.rewound {
            self.history.forget_after(time);
        }
        if outbox.rewound.is_some() || outbox.changed.is_some() {
            // at the same time something else may lie under the pointer
            (self.spot, self.asked) = (None, None);
        }
        self.history.add(&outbox.records);
        self.spot = outbox.spot.or(self.spot.take());
        self.grab.answer(outbox.holds);
        (self.held, self.probes) = (outbox.status.held, outbox.status.probes);
        if let Some(spot) = outbox.picked {
            self.pick(&spot);
        }
        if let Some(mesh) = outbox.mesh {
            self.panel.adding.take(mesh, &self.scene);
            self.panel.open = true;
        }
        if let Some(stages) = outbox.stages {
            self.stages = stages;
        }
        if let Some(scene) = outbox.changed {
            self.change_to(scene);
        }
        if outbox.status.phase == Phase::Ready {
            self.opened.particles = outbox.status.particles;
        }
        if let Some(shown) = outbox.shown {
            self.shown = Some(shown);
            self.texture = None;
        }
    }

    /// The scene is another one: of bodies that have joined it the numbers of the file are those that they joined with.
    fn change_to(&mut self, scene: Arc<Scene>) {
        let (count, known) = (scene.bodies.len(), self.opened.scene.bodies.len());
        if count != known {
            let file = Arc::make_mut(&mut self.opened.scene);
            file.bodies.truncate(count);
            file.bodies.extend(scene.bodies.iter().skip(known).cloned());
            for (name, material) in &scene.materials {
                file.materials.entry(name.clone()).or_insert_with(|| material.clone());
            }
        }
        if self.panel.body.body.is_some_and(|body| body >= count) {
            self.panel.body = Picked::of(None);
        }
        self.hidden.retain(|body| *body < count);
        self.panel.body.settle();
        self.scene = scene;
    }

    /// A body that was clicked on is picked; a click on gas sets a probe, one on a probe takes it away.
    fn pick(&mut self, spot: &Spot) {
        let body = spot.body.as_ref().and_then(|name| self.scene.bodies.iter().position(|body| body.name == *name));
        if body.is_some() {
            self.panel.body = Picked::of(body);
        } else if let Some(change) = click::on_gas(&self.scene, spot) {
            match change {
                Change::Set(_) => self.panel.probe_is_new = true,
                Change::Clear(index) => self.history.forget_probe(index),
            }
            self.commands.push(Command::Change(Box::new(change.applied(&self.scene))));
        }
    }

    /// Textures belong to a device that is gone.
    pub(super) fn forget_texture(&mut self) {
        self.texture = None;
    }

    /// The camera of the picture as it stands.
    pub(super) fn camera(&self) -> Option<Camera> {
        let (domain, settings) = (&self.scene.domain, &self.look.settings);
        let still = match domain.dimension {
            3 => settings.camera.or(self.opened.fitted)?,
            2 => settings.camera.unwrap_or_else(|| camera::above(domain.origin, domain.size)),
            _ => return None,
        };
        let time = self.shown.as_ref().map_or(0.0, |shown| shown.time);
        Some(settings.path.as_ref().map_or(still, |path| path.at(time, &still)))
    }

    /// Whoever moves the camera takes it off its path.
    pub(super) fn set_camera(&mut self, moved: Camera) {
        let domain = &self.scene.domain;
        self.look.settings.path = None;
        self.look.settings.camera =
            Some(if domain.dimension == 2 { camera::kept_inside(&moved, domain.origin, domain.size) } else { moved });
    }

    fn move_camera(&mut self, how: impl Fn(&Camera) -> Camera) {
        if let Some(camera) = self.camera() {
            self.set_camera(how(&camera));
            self.moves_until = Instant::now() + SETTLES;
        }
    }

    pub(super) fn fit(&mut self) {
        self.look.settings.path = None;
        self.look.settings.camera = if self.dimension() == 3 { self.opened.fitted } else { None };
    }

    pub(super) fn is_parallel(&self) -> bool {
        self.dimension() == 3 && self.camera().is_some_and(|camera| camera.height.is_some())
    }

    pub(super) fn set_parallel(&mut self, parallel: bool) {
        if self.dimension() == 3 {
            self.move_camera(|camera| camera::with_parallel_rays(camera, parallel));
        }
    }

    /// Does what a key asks for; keys that are not about the picture are left to others.
    pub(super) fn act(&mut self, action: Action, status: &Status) {
        match action {
            Action::Play => self.commands.push(Command::Play(!status.playing)),
            Action::GoOn => self.commands.push(Command::GoOn),
            Action::Step(steps) => self.commands.push(Command::Steps(steps)),
            Action::Rewind(time) => self.rewind(time),
            Action::Undo => {
                let earlier =
                    |kept: &&f64| **kept < status.time * (1.0 - 1e-9) || status.touched && **kept <= status.time;
                let before = status.kept.iter().rev().find(earlier);
                before.into_iter().for_each(|kept| self.rewind(*kept));
            }
            Action::Again => {
                self.commands.push(Command::Rewind(self.again));
                self.commands.push(Command::Play(true));
            }
            Action::Screenshot => self.commands.push(Command::Screenshot),
            Action::Record => self.commands.push(Command::Record(status.recorded.is_none())),
            Action::Fit => self.fit(),
            Action::Field(field) => self.look.field = field,
            Action::Orthographic => self.set_parallel(!self.is_parallel()),
            Action::Panel => self.panel.open = !self.panel.open,
            Action::Zoom(notches) => self.move_camera(|camera| camera::zoom(camera, notches, [0.0; 2])),
            Action::Turn(drag) if self.dimension() == 3 => self.move_camera(|camera| camera::orbit(camera, drag)),
            Action::Turn(drag) => self.move_camera(|camera| camera::pan(camera, drag)),
            Action::Pace(factor) => {
                let seconds = match self.pace {
                    Pace::Lasting(seconds) => (seconds / factor).clamp(PACES[0], PACES[1]),
                    Pace::Fastest => 2.0 * PACES[0],
                };
                self.set_pace(Pace::Lasting(seconds));
            }
            Action::Restart | Action::Help | Action::Back | Action::Open | Action::Quit => {}
        }
    }

    fn rewind(&mut self, time: f64) {
        self.again = time;
        self.commands.push(Command::Rewind(time));
    }

    pub(super) fn set_pace(&mut self, pace: Pace) {
        self.pace = pace;
        self.commands.push(Command::Pace(pace));
    }

    /// Shows the picture in the room that is left, and hears the mouse.
    pub(super) fn show(&mut self, ui: &mut Ui) {
        let scale = ui.ctx().pixels_per_point();
        let round = |place: Pos2| (place.to_vec2() * scale).round() / scale;
        let room = ui.available_rect_before_wrap();
        let place = Rect::from_min_max(round(room.min).to_pos2(), round(room.max).to_pos2());
        let response = ui.interact(place, ui.scope_id().with("picture"), Sense::click_and_drag());
        ui.painter().rect_filled(place, 0.0, theme::BACKGROUND);
        let pixels = (place.size() * scale).round().clamp(Vec2::splat(SIDES[0]), Vec2::splat(SIDES[1]));
        self.look.settings.size = [pixels.x as u32, pixels.y as u32];
        self.paint(ui, place);
        click::paint(ui, place, &self.scene, &self.probes);
        self.mouse(ui, &response, place);
        self.under_pointer(ui, &response, place);
        self.send_look(ui, response.dragged());
    }

    /// The newest picture, pixel by pixel where it has the room's size.
    fn paint(&mut self, ui: &Ui, place: Rect) {
        let Some(shown) = &self.shown else { return };
        let frame = &shown.picture.frame;
        let size = [frame.width as usize, frame.height as usize];
        let texture = self.texture.get_or_insert_with(|| {
            // Every pixel is opaque.
            let image = ColorImage::from_rgba_premultiplied(size, &frame.rgba);
            let options = if shown.look.settings.size == self.look.settings.size {
                TextureOptions::NEAREST
            } else {
                TextureOptions::LINEAR
            };
            ui.ctx().load_texture("picture", image, options)
        });
        let own = Vec2::new(size[0] as f32, size[1] as f32);
        let fitted = own * (place.size() / own).min_elem();
        let target = if shown.look.settings.size == self.look.settings.size {
            place
        } else {
            Rect::from_center_size(place.center(), fitted)
        };
        let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
        ui.painter().image(texture.id(), target, whole, egui::Color32::WHITE);
    }

    /// Where the pointer rests, asks what lies there, and shows it beside the pointer.
    fn under_pointer(&mut self, ui: &Ui, response: &Response, place: Rect) {
        let (Some(pointer), Some(shown)) = (response.hover_pos().filter(|_| !response.dragged()), &self.shown) else {
            return;
        };
        let share = (pointer - place.min) / place.size();
        let at = [f64::from(share.x), f64::from(share.y)];
        let rested = ui.input(|input| input.pointer.time_since_last_movement()) > RESTS;
        let wanted = (at, shown.time);
        if !rested {
            ui.ctx().request_repaint_after(Duration::from_secs_f32(RESTS));
        } else if self.asked != Some(wanted) && self.dimension() > 1 {
            self.commands.push(Command::Ask(at));
            self.asked = Some(wanted);
        }
        let Some(spot) = self.spot.as_ref().filter(|spot| spot.at == at && !spot.point.is_empty()) else { return };
        let mut lines =
            vec![format!("({}) m", spot.point.iter().map(|own| plain(*own)).collect::<Vec<_>>().join(", "))];
        lines.extend(spot.value.map(|value| format!("{}: {}", caption(shown.look.field), plain(value))));
        lines.extend(spot.body.clone());
        theme::tag(ui, pointer, &lines.join("\n"));
    }

    /// Tells the worker what pictures should show, when that changes.
    fn send_look(&mut self, ui: &Ui, dragged: bool) {
        self.dragging = dragged;
        let now = Instant::now();
        let moving = dragged || now < self.moves_until;
        if moving {
            ui.ctx().request_repaint_after(SETTLES);
        }
        // A range that is being typed may be empty for a moment.
        if self.look.settings.range.is_some_and(|[low, high]| low.partial_cmp(&high) != Some(Ordering::Less)) {
            return;
        }
        let wanted = (self.look.clone(), moving);
        if self.sent.as_ref() != Some(&wanted) {
            self.commands.push(Command::Look { look: Box::new(self.look.clone()), moving });
            self.sent = Some(wanted);
        }
    }

    /// The look that the scene file asks for, at the size of the window.
    pub(super) fn reset_look(&mut self) {
        let settings = RenderSettings { size: self.look.settings.size, ..self.opened.scene.own_look() };
        self.look = Look { field: self.opened.look.field, settings };
    }
}
