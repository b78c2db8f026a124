//! One scene takes the place of another. A wrong one takes no place: the scene before goes on.

use std::path::Path;
use std::sync::Arc;

use super::super::budget::{Budget, Rate};
use super::super::model::{Answer, Look, Opened, Phase, Request, Weight};
use super::super::pictures;
use super::super::session::Session;
use super::super::worker::lock;
use super::{Desk, OUT};
use crate::Result;
use crate::gpu::Gpu;
use crate::scene::{Scene, stem};
use crate::state::MemoryPlan;

impl Desk {
    /// Opens a scene, and tells the window what came of it.
    pub(super) fn open(&mut self, request: &Request, look: Option<Box<Look>>) {
        self.asked = true;
        let answer = match self.replace(request, look) {
            Ok(()) => Answer::Opened,
            Err(error) if self.session.is_some() => {
                self.note(Weight::Wrong, error.to_string());
                Answer::Refused
            }
            Err(error) => {
                self.report(error);
                Answer::Failed
            }
        };
        // whoever lost the device has answered
        if self.asked {
            self.answer(answer);
        }
    }

    pub(super) fn answer(&mut self, answer: Answer) {
        self.asked = false;
        lock(&self.outbox).answers.push(answer);
    }

    /// What is wrong about a scene is told before the one that is open goes: its file, its device, its size.
    fn replace(&mut self, request: &Request, look: Option<Box<Look>>) -> Result<()> {
        let scene = request.load()?;
        let gpu = match &self.gpu {
            Some(gpu) => gpu.clone(),
            None => self.gpu.insert(Gpu::new(&self.options)?).clone(),
        };
        MemoryPlan::fitting(&scene, &gpu)?;
        self.close();
        self.begin(request, &gpu, scene, look)
    }

    fn begin(&mut self, request: &Request, gpu: &Gpu, scene: Scene, look: Option<Box<Look>>) -> Result<()> {
        let session = match request.run() {
            Some(run) => Session::open_run(gpu, run, &request.changes)?,
            None => Session::open(gpu, scene)?,
        };
        let look = look.map_or_else(|| session.look(), |look| *look);
        self.folder = pictures::folder().join(stem(&request.name));
        // beside the file, whose meshes it may read
        let beside = Path::new(&request.name).parent().filter(|_| Path::new(&request.name).is_file());
        let shipped = Path::new(OUT).join(stem(&request.name));
        self.saved = (beside.unwrap_or(&shipped).to_owned(), stem(&request.name).to_owned());
        lock(&self.outbox).opened = Some(Opened {
            request: request.clone(),
            scene: Arc::clone(session.scene()),
            particles: session.particles(),
            fitted: session.fitted_camera(&look),
            look: look.clone(),
            device: gpu.info.name.clone(),
            software: gpu.is_software(),
        });
        (self.look, self.told) = (Some(look), Some(Arc::clone(session.scene())));
        self.session = Some(session);
        (self.phase, self.replay) = (Phase::Ready, request.run().is_some());
        (self.stale, self.budget, self.rate) = (true, Budget::default(), Rate::default());
        Ok(())
    }

    pub(super) fn close(&mut self) {
        self.finish_recording();
        // Buffers go before new ones come.
        (self.session, self.shown) = (None, None);
        (self.playing, self.steps_left, self.news, self.coarse) = (false, 0, false, false);
        self.records.clear();
        self.phase = Phase::Empty;
    }
}
