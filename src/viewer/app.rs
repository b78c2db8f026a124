//! The event loop: makes the window, hands events to the user interface, paints when there is something new.

use std::sync::Arc;
use std::time::{Duration, Instant};

use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, OwnedDisplayHandle};
use winit::window::{Window, WindowId};

use super::theme;
use super::ui::Ui;
use super::window::{Painted, Painter};
use crate::{Error, Result};

/// Something new lies in the worker's outbox.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wake;

/// Frames that nobody asked for by mouse or key take at most one part in so many of the time: the processor belongs to the scene.
const IDLE_PARTS: u32 = 20;
/// Losses of the window's device before the program gives up.
const MOST_LOSSES: u32 = 3;
/// Pause before a frame that could not be drawn is tried again.
const RETRY: Duration = Duration::from_millis(100);

/// The program with a window.
pub(super) struct App {
    ui: Ui,
    display: OwnedDisplayHandle,
    open: Option<Open>,
    losses: u32,
    /// Earliest time of a frame that nobody asked for by mouse or key.
    rested: Instant,
    /// When the next frame is due; none if nothing changes.
    due: Option<Instant>,
    error: Option<Error>,
}

/// The window with what draws and feeds it.
struct Open {
    window: Arc<Window>,
    painter: Painter,
    state: egui_winit::State,
    hidden: bool,
}

impl App {
    pub(super) fn new(ui: Ui, display: OwnedDisplayHandle) -> Self {
        let now = Instant::now();
        Self { ui, display, open: None, losses: 0, rested: now, due: None, error: None }
    }

    /// How it ended: steps that the last scene ran, and the seconds that they took.
    ///
    /// # Errors
    /// What made the window impossible.
    pub(super) fn outcome(self) -> Result<(u64, f64)> {
        let ran = self.ui.ran();
        self.error.map_or(Ok(ran), Err)
    }

    fn make_window(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        let attributes = Window::default_attributes()
            .with_title("Brisance")
            .with_inner_size(LogicalSize::new(1280.0, 800.0))
            .with_min_inner_size(LogicalSize::new(480.0, 320.0));
        let window = event_loop.create_window(attributes);
        let window = Arc::new(window.map_err(|error| {
            Error::Usage(format!("no window can be opened: {error}; `brisance run SCENE` works without one"))
        })?);
        self.open = Some(self.equip(window)?);
        Ok(())
    }

    /// A window's device, surface and input; a new context, because a new device knows no textures.
    fn equip(&mut self, window: Arc<Window>) -> Result<Open> {
        let painter = Painter::new(Arc::clone(&window), self.display.clone())?;
        let context = egui::Context::default();
        theme::apply(&context);
        let scale = Some(window.scale_factor() as f32);
        let side = Some(painter.max_texture_side());
        let state = egui_winit::State::new(context, egui::ViewportId::ROOT, &window, scale, None, side);
        self.ui.forget_textures();
        window.request_redraw();
        Ok(Open { window, painter, state, hidden: false })
    }

    fn fail(&mut self, event_loop: &ActiveEventLoop, error: Error) {
        self.error = Some(error);
        event_loop.exit();
    }

    fn paint(&mut self, event_loop: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        if open.hidden {
            return;
        }
        let start = Instant::now();
        let input = open.state.take_egui_input(&open.window);
        let context = open.state.egui_ctx().clone();
        let ui = &mut self.ui;
        let mut output = context.run_ui(input, |root| ui.show(root));
        let platform = std::mem::take(&mut output.platform_output);
        open.state.handle_platform_output(&open.window, platform);
        let delay = output.viewport_output.get(&egui::ViewportId::ROOT).map_or(Duration::MAX, |own| own.repaint_delay);
        open.window.set_title(&self.ui.title());
        let painted = open.painter.paint(&context, output);
        self.rested = Instant::now() + start.elapsed() * (IDLE_PARTS - 1);
        self.due = Instant::now().checked_add(delay);
        match painted {
            Ok(Painted::Shown) => {}
            Ok(Painted::Skipped) => self.due = Some(Instant::now() + RETRY),
            Ok(Painted::DeviceLost) => self.recover(event_loop),
            Err(error) => self.fail(event_loop, error),
        }
        if self.ui.wants_to_quit() {
            event_loop.exit();
        }
    }

    /// A new device for the same window.
    fn recover(&mut self, event_loop: &ActiveEventLoop) {
        self.losses += 1;
        let Some(open) = self.open.take() else { return };
        if self.losses > MOST_LOSSES {
            let text = "the window's device was lost again and again; `brisance run SCENE` works without a window";
            self.fail(event_loop, Error::Gpu(text.to_owned()));
            return;
        }
        let window = Arc::clone(&open.window);
        // The surface goes before the next one comes.
        drop(open);
        match self.equip(window) {
            Ok(open) => {
                self.open = Some(open);
                self.ui.tell("the window's device was lost and opened again");
            }
            Err(error) => self.fail(event_loop, error),
        }
    }

    /// Asks for a frame as soon as the scene can spare the time, which one at rest can at once.
    fn repaint_when_rested(&mut self) {
        let now = Instant::now();
        let at = if self.ui.runs() { self.rested.max(now) } else { now };
        self.due = Some(self.due.map_or(at, |due| due.min(at)));
    }
}

impl ApplicationHandler<Wake> for App {
    fn new_events(&mut self, _: &ActiveEventLoop, cause: StartCause) {
        if let (StartCause::ResumeTimeReached { .. }, Some(open)) = (cause, &self.open) {
            self.due = None;
            open.window.request_redraw();
        }
    }

    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.open.is_none()
            && let Err(error) = self.make_window(event_loop)
        {
            self.fail(event_loop, error);
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, Wake: Wake) {
        self.ui.receive();
        self.repaint_when_rested();
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        let response = open.state.on_window_event(&open.window, &event);
        if response.repaint && !matches!(event, WindowEvent::RedrawRequested) {
            open.window.request_redraw();
        }
        match event {
            WindowEvent::CloseRequested | WindowEvent::Destroyed => event_loop.exit(),
            WindowEvent::Resized(size) => open.painter.resize(size.width, size.height),
            WindowEvent::Occluded(hidden) => {
                open.hidden = hidden;
                open.window.request_redraw();
            }
            WindowEvent::RedrawRequested => self.paint(event_loop),
            _ => {}
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        event_loop.set_control_flow(self.due.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }
}
