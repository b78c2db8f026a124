//! The worker: a thread that owns the device, the simulation and the renderer. It hears commands between submissions and leaves what
//! came of them in an outbox, so that the window answers however long a step takes.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use super::desk::Desk;
use super::model::{Command, Outbox};
use crate::gpu::GpuOptions;

/// Handle of the thread.
#[derive(Debug)]
pub struct Worker {
    commands: Option<Sender<Command>>,
    outbox: Arc<Mutex<Outbox>>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    /// Starts the thread; it calls `wake` whenever there is something new in the outbox.
    pub fn start(options: GpuOptions, wake: impl Fn() + Send + 'static) -> Self {
        let (commands, received) = channel();
        let outbox = Arc::new(Mutex::new(Outbox::default()));
        let shared = Arc::clone(&outbox);
        let thread = std::thread::spawn(move || work(Desk::new(options, shared), &received, &wake));
        Self { commands: Some(commands), outbox, thread: Some(thread) }
    }

    /// Asks for something.
    pub fn send(&self, command: Command) {
        if let Some(commands) = &self.commands {
            // The thread ends only when this handle does.
            let _ = commands.send(command);
        }
    }

    /// What has come since the last call.
    pub fn take(&self) -> Outbox {
        let mut outbox = lock(&self.outbox);
        let status = outbox.status.clone();
        std::mem::replace(&mut *outbox, Outbox { status, ..Outbox::default() })
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.commands = None;
        if let Some(thread) = self.thread.take() {
            // A panic was reported where it happened.
            let _ = thread.join();
        }
    }
}

/// Locks, also after a panic: the outbox is valid at every moment.
pub(super) fn lock(outbox: &Mutex<Outbox>) -> MutexGuard<'_, Outbox> {
    outbox.lock().unwrap_or_else(PoisonError::into_inner)
}

fn work(mut desk: Desk, commands: &Receiver<Command>, wake: &dyn Fn()) {
    while let Some(batch) = listen(commands, desk.patience()) {
        let heard = !batch.is_empty();
        // what follows a command that failed is heard, too
        batch.into_iter().for_each(|command| guarded(&mut desk, |desk| desk.obey(command)));
        if heard {
            // What follows may take long: the first step of a scene compiles kernels on some drivers.
            desk.publish();
            wake();
        }
        guarded(&mut desk, Desk::work);
        desk.publish();
        wake();
    }
}

/// A panic ends the scene, and neither the worker nor the window.
fn guarded(desk: &mut Desk, what: impl FnOnce(&mut Desk)) {
    if catch_unwind(AssertUnwindSafe(|| what(desk))).is_err() {
        desk.give_up("a bug stopped the simulation; the terminal says where");
    }
}

/// Everything that has been asked for, after waiting for it as long as there is nothing else to do; none when the window has gone.
fn listen(commands: &Receiver<Command>, patience: Option<Duration>) -> Option<Vec<Command>> {
    let first = match patience {
        None => Some(commands.recv().ok()?),
        Some(patience) => match commands.recv_timeout(patience) {
            Ok(command) => Some(command),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => return None,
        },
    };
    Some(first.into_iter().chain(commands.try_iter()).collect())
}
