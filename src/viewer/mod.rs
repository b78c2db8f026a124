//! The live window: a gallery of scenes, and any of them at work.
//!
//! A worker thread owns device, simulation and renderer ([`worker`]); the window has a small device of its own that draws the user
//! interface and nothing else. So the window answers however long a step takes, and outlives a lost device. It shows the bytes of
//! [`crate::render::Picture`]s: what is seen is what `run` writes.
//!
//! What can be tested without a window knows none: [`session`], [`adding`], [`camera`], [`pick`], [`budget`], [`charge`], [`hold`], [`keys`].

pub mod adding;
mod app;
mod bars;
mod browse;
pub mod budget;
pub mod camera;
pub mod charge;
mod click;
mod clipboard;
mod desk;
mod gallery;
mod grab;
mod help;
mod history;
pub mod hold;
pub mod keys;
pub mod model;
mod panel;
mod past;
pub mod pick;
mod pictures;
mod progress;
pub mod record;
pub mod session;
mod theme;
mod ui;
mod view;
mod watch;
mod window;
pub mod worker;

use winit::event_loop::EventLoop;

use crate::gpu::GpuOptions;
use crate::{Error, Result};
use app::{App, Wake};
use model::{Pace, Request};
use ui::Ui;
use worker::Worker;

/// Opens the window, on the gallery or on a scene, and returns when it is closed: steps that the last scene ran, and the seconds that
/// they took. Without a `pace` a scene takes its time.
///
/// # Errors
/// [`Error::Usage`] if there is no display; [`Error::NoAdapter`] if nothing can draw to the window; [`Error::Gpu`] if its device is lost again and
/// again.
pub fn run(options: GpuOptions, request: Option<Request>, pace: Option<Pace>) -> Result<(u64, f64)> {
    let event_loop = EventLoop::<Wake>::with_user_event().build().map_err(|error| no_window(&error.to_string()))?;
    let proxy = event_loop.create_proxy();
    let options = GpuOptions { compiling: Some(progress::tell), ..options };
    let worker = Worker::start(options, move || {
        // The loop has ended: nobody looks any more.
        let _ = proxy.send_event(Wake);
    });
    let display = event_loop.owned_display_handle();
    let mut app = App::new(Ui::new(worker, request, pace), display);
    let ended = event_loop.run_app(&mut app);
    let ran = app.outcome()?;
    ended.map_err(|error| no_window(&error.to_string()))?;
    Ok(ran)
}

/// Why there is no window, and what works without one. The window library's messages begin with places in its sources.
fn no_window(message: &str) -> Error {
    let set = |name: &&str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let places = ["DISPLAY", "WAYLAND_DISPLAY"];
    let reason = if cfg!(target_os = "linux") && !places.iter().any(set) {
        format!("there is no display: neither {} is set", places.join(" nor "))
    } else {
        message
            .rsplit_once(".rs:")
            .map_or(message, |(_, rest)| rest.trim_start_matches(|c: char| c.is_ascii_digit() || c == ':'))
            .trim()
            .to_owned()
    };
    Error::Usage(format!(
        "no window can be opened: {}; `brisance run SCENE` works without one",
        reason.trim_end_matches('.')
    ))
}
