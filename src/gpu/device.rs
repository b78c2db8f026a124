//! Opening the device, and keeping its first error.

use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::adapters::{choose, enough, new_instance, ranked_adapters};
use super::cache::Cache;
use super::kernel::Kernel;
use super::pipeline::{Pipeline, PipelineCache};
use super::reflect::Compiled;
use super::shader::Folder;
use crate::error::{Error, Result};

/// What the user may choose about the device.
#[derive(Clone, Debug, Default)]
pub struct GpuOptions {
    /// Index in the list of [`Gpu::adapters`], or a part of the adapter's description (any case). `None` asks the
    /// environment variable `BRISANCE_DEVICE`, then takes the first of the list.
    pub device: Option<String>,
    /// Folder to read shaders from instead of the embedded ones. `None` asks the environment variable `BRISANCE_SHADERS`.
    pub shaders: Option<PathBuf>,
    /// Whose settings to take. `None` asks the environment variable `BRISANCE_AS` (`gpu` or `software`), then the device.
    pub settings: Option<Settings>,
    /// Folder that gets the final text, entry point and overrides of every kernel that is compiled. `None` asks the environment
    /// variable `BRISANCE_KERNELS`.
    pub kernels: Option<PathBuf>,
    /// Asked before each kernel is compiled, which takes seconds for all of a scene: whether to stop.
    pub stop: Option<fn() -> bool>,
    /// Told how many of the kernels of a scene are compiled, and how many there are.
    pub compiling: Option<fn(usize, usize)>,
}

/// Choices that are about speed: which transfer to the grid, how many groups, how long a march, how long a submission. Results agree to
/// rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settings {
    /// For a processor that plays a GPU.
    Software,
    /// For hardware.
    Hardware,
}

impl Settings {
    /// What the environment asks for.
    fn from_environment() -> Result<Option<Settings>> {
        match environment("BRISANCE_AS").as_deref() {
            None => Ok(None),
            Some("gpu") => Ok(Some(Settings::Hardware)),
            Some("software") => Ok(Some(Settings::Software)),
            Some(other) => Err(Error::Usage(format!("BRISANCE_AS={other}: it may be gpu or software, or not be set"))),
        }
    }
}

/// Bytes in a gibibyte, for messages.
pub(super) const GIB: f64 = (1u64 << 30) as f64;

/// The open device. Clones share it; buffers and kernels keep what they need of it alive.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// Needed again only to make window surfaces.
    pub instance: wgpu::Instance,
    /// The physical device.
    pub adapter: wgpu::Adapter,
    /// The logical device.
    pub device: wgpu::Device,
    /// Where work is submitted.
    pub queue: wgpu::Queue,
    /// Name, type and driver of the adapter.
    pub info: wgpu::AdapterInfo,
    /// Limits of the device: those of the adapter, not the smaller defaults.
    pub limits: wgpu::Limits,
    /// Whether passes can be timed on the device itself, see [`super::Pass::timed`].
    pub timestamps: bool,
    /// Where shaders come from.
    pub folder: Folder,
    /// Whose settings the simulation takes.
    pub settings: Settings,
    /// Where every kernel that is compiled is written down.
    pub(super) written: Option<PathBuf>,
    /// Whether somebody wants to stop.
    stop: Option<fn() -> bool>,
    /// Told how many kernels are compiled, of how many.
    pub(super) compiling: Option<fn(usize, usize)>,
    /// Kernels that nobody has waited for.
    pub(super) queued: Queue,
    /// Longest wait for a submission.
    patience: Duration,
    /// What was submitted last, for whom it does not end.
    at_work: Arc<Mutex<String>>,
    /// Shaders compiled so far.
    pub(super) shaders: ShaderCache,
    /// Their entry points with the overrides they were specialised for.
    pub(super) kernels: KernelCache,
    /// The pipelines that they share.
    pub(super) pipelines: PipelineCache,
    faults: Arc<Mutex<Faults>>,
    allocated: Arc<AtomicU64>,
}

/// Shaders, and kernels, that a device knows at most. A scene has up to 150; a driver in software takes some megabytes for each.
const MOST_KNOWN: usize = 256;

/// Pipelines that a device keeps at most for kernels that share them.
const MOST_SHARED: usize = 512;

/// Compiled shaders by file name and constants text.
type ShaderCache = Arc<Mutex<Cache<(String, String), Arc<Compiled>>>>;

/// Pipelines asked for, in order.
type Queue = Arc<Mutex<Vec<Arc<Pipeline>>>>;

/// Kernels by shader, entry point, overrides and constants text.
type KernelCache = Arc<Mutex<Cache<String, Kernel>>>;

/// What the driver reported since the last [`Gpu::check`].
#[derive(Debug, Default)]
struct Faults {
    first: Option<Fault>,
    lost: Option<String>,
}

/// An error a driver reported outside of any error scope.
#[derive(Debug)]
enum Fault {
    OutOfMemory(String),
    /// Of the driver itself.
    Failed(String),
    /// What was asked for breaks a rule.
    Refused(String),
    /// A kernel that was not waited for does not compile.
    Shader(Error),
}

impl Gpu {
    /// Opens the best device, or the one that `BRISANCE_DEVICE` names.
    ///
    /// # Errors
    /// As [`Gpu::new`].
    pub fn best() -> Result<Gpu> {
        Gpu::new(&GpuOptions::default())
    }

    /// Opens the best device, or the one that `options` name.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] if there is no Vulkan, Metal or DirectX 12 device, none that matches, or its driver refuses to
    /// open it.
    pub fn new(options: &GpuOptions) -> Result<Gpu> {
        let instance = new_instance();
        let wanted = options.device.clone().or_else(|| environment("BRISANCE_DEVICE"));
        let adapter = choose(ranked_adapters(&instance), wanted.as_deref())?;
        let info = adapter.get_info();
        let limits = adapter.limits();
        enough(&info.name, &limits)?;
        let timestamps = adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("brisance"),
            required_features: if timestamps { wgpu::Features::TIMESTAMP_QUERY } else { wgpu::Features::empty() },
            required_limits: limits.clone(),
            ..Default::default()
        }))
        .map_err(|error| Error::NoAdapter(format!("{} cannot be opened: {error}", info.name)))?;
        let faults = Arc::new(Mutex::new(Faults::default()));
        watch(&device, &faults);
        let folder = match options.shaders.clone().or_else(|| environment("BRISANCE_SHADERS").map(PathBuf::from)) {
            Some(path) => Folder::Disk(path),
            None => Folder::Embedded,
        };
        let software = info.device_type == wgpu::DeviceType::Cpu;
        let of_device = if software { Settings::Software } else { Settings::Hardware };
        let settings = options.settings.or(Settings::from_environment()?).unwrap_or(of_device);
        let written = options.kernels.clone().or_else(|| environment("BRISANCE_KERNELS").map(PathBuf::from));
        let patience = patience(software)?;
        Ok(Gpu {
            instance,
            adapter,
            device,
            queue,
            info,
            limits,
            timestamps,
            folder,
            settings,
            written,
            stop: options.stop,
            compiling: options.compiling,
            queued: Arc::default(),
            patience,
            at_work: Arc::default(),
            shaders: Arc::new(Mutex::new(Cache::new(MOST_KNOWN))),
            kernels: Arc::new(Mutex::new(Cache::new(MOST_KNOWN))),
            pipelines: Arc::new(Mutex::new(Cache::new(MOST_SHARED))),
            faults,
            allocated: Arc::default(),
        })
    }

    /// Whether the device is a processor that plays a GPU: correct, slow.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Bytes of all living [`super::Buffer`]s.
    #[must_use]
    pub fn allocated_bytes(&self) -> u64 {
        self.allocated.load(Ordering::Relaxed)
    }

    /// Hands out the first error the driver reported since the last call, if any.
    ///
    /// # Errors
    /// [`Error::DoesNotFit`] if memory ran out, [`Error::Bug`] if a call was refused, [`Error::Gpu`] otherwise; a lost device stays an
    /// error for ever.
    pub fn check(&self) -> Result<()> {
        let first = lock(&self.faults).first.take();
        if matches!(first, Some(Fault::Refused(_))) {
            // a device that is gone refuses calls before it says that it is gone
            let _ = self.device.poll(wgpu::PollType::Poll);
        }
        if let Some(reason) = &lock(&self.faults).lost {
            return Err(Error::Gpu(format!(
                "{} was lost: {reason}; start again, or use another --device",
                self.info.name
            )));
        }
        match first {
            None => Ok(()),
            Some(Fault::OutOfMemory(text)) => Err(Error::DoesNotFit(format!(
                "{} is out of memory ({text}) with {:.2} GiB allocated; use a coarser resolution or another --device",
                self.info.name,
                self.allocated_bytes() as f64 / GIB
            ))),
            Some(Fault::Failed(text)) => Err(Error::Gpu(format!("{} failed: {text}", self.info.name))),
            Some(Fault::Shader(error)) => Err(error),
            Some(Fault::Refused(text)) => Err(Error::Bug(format!("the graphics library refused a call: {text}"))),
        }
    }

    /// Keeps a kernel's error for [`Gpu::check`].
    pub(super) fn note(&self, error: Error) {
        lock(&self.faults).first.get_or_insert(Fault::Shader(self.blamed(error)));
    }

    /// A shader that does not compile is a bug of ours, unless the user brought it.
    pub(super) fn blamed(&self, error: Error) -> Error {
        match error {
            Error::Shader(text) if self.folder == Folder::Embedded => {
                Error::Bug(text.split_whitespace().collect::<Vec<_>>().join(" "))
            }
            error => error,
        }
    }

    /// Before work that takes a while.
    ///
    /// # Errors
    /// [`Error::Interrupted`] if somebody wants to stop.
    pub(super) fn go_on(&self) -> Result<()> {
        if self.stop.is_some_and(|stop| stop()) { Err(Error::Interrupted) } else { Ok(()) }
    }

    /// Waits until a submission, or everything submitted, is done; then [`Gpu::check`]s.
    ///
    /// # Errors
    /// Those of [`Gpu::check`], and [`Error::Gpu`] with the stage if the device cannot be waited for, or takes longer than any
    /// submission may.
    pub fn wait(&self, submission: Option<wgpu::SubmissionIndex>) -> Result<()> {
        let timeout = Some(self.patience);
        let waited = self.device.poll(wgpu::PollType::Wait { submission_index: submission, timeout });
        self.check()?;
        waited.map(|_| ()).map_err(|error| {
            let (name, stage, seconds) = (&self.info.name, lock(&self.at_work), self.patience.as_secs());
            Error::Gpu(format!(
                "{name} has not finished {stage} after {seconds} s ({error}); try another --device, a newer driver or a coarser \
                 --resolution, or wait longer with BRISANCE_WAIT=SECONDS"
            ))
        })
    }

    /// Remembers what was submitted, for [`Gpu::wait`].
    pub(super) fn note_work(&self, what: String) {
        *lock(&self.at_work) = what;
    }

    /// The counter behind [`Gpu::allocated_bytes`].
    pub(super) fn ledger(&self) -> &Arc<AtomicU64> {
        &self.allocated
    }
}

/// Locks, also after another thread panicked: the guarded values are valid at every moment.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Longest wait for a submission: on hardware a hundred times what one may take; a software driver compiles while it runs.
fn patience(software: bool) -> Result<Duration> {
    let Some(text) = environment("BRISANCE_WAIT") else {
        return Ok(Duration::from_secs(if software { 1800 } else { 60 }));
    };
    let seconds = text.parse::<u64>().ok().filter(|seconds| *seconds > 0);
    let wrong = || Error::Usage(format!("BRISANCE_WAIT={text}: it must be a whole number of seconds above 0"));
    seconds.map(Duration::from_secs).ok_or_else(wrong)
}

/// A set, not empty environment variable.
pub(super) fn environment(name: &str) -> Option<String> {
    std::env::var(name).ok().filter(|value| !value.is_empty())
}

/// What wgpu says of a device that is gone.
const GONE: &str = "device is lost";

/// A message of several lines in one.
fn one_line(text: &str) -> String {
    text.lines().map(str::trim).filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" / ")
}

/// Keeps the device's first error and its loss instead of panicking.
fn watch(device: &wgpu::Device, faults: &Arc<Mutex<Faults>>) {
    let errors = Arc::clone(faults);
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        let text = one_line(&error.to_string());
        let fault = match &error {
            wgpu::Error::OutOfMemory { source } => Fault::OutOfMemory(source.to_string()),
            // calls to a device that is gone break a rule, too
            wgpu::Error::Validation { .. } if text.contains(GONE) => {
                lock(&errors).lost.get_or_insert(text);
                return;
            }
            wgpu::Error::Validation { .. } => Fault::Refused(text),
            wgpu::Error::Internal { .. } => Fault::Failed(text),
        };
        lock(&errors).first.get_or_insert(fault);
    }));
    let losses = Arc::clone(faults);
    // The last owner letting go of the device is a loss that nobody hears of.
    device.set_device_lost_callback(move |reason, text| {
        lock(&losses).lost.get_or_insert(format!("{reason:?} {text}").to_lowercase());
    });
}
