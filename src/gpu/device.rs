//! Choosing an adapter, opening the device, and keeping its first error.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::kernel::Kernel;
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
}

/// One line of the list of devices, best first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterSummary {
    /// Position in the list; `--device` accepts it.
    pub index: usize,
    /// Name the driver gives.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    /// Programming interface and driver, for example `vulkan, llvmpipe, Mesa 22.3.6`.
    pub driver: String,
    /// Largest storage buffer a kernel may bind \[bytes\].
    pub max_binding: u64,
}

impl std::fmt::Display for AdapterSummary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let gib = self.max_binding as f64 / GIB;
        write!(f, "{}: {} ({}; {}; {gib:.2} GiB per buffer)", self.index, self.name, self.kind, self.driver)
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
    /// Shaders compiled so far.
    pub(super) shaders: ShaderCache,
    /// Their entry points with the overrides they were specialised for.
    pub(super) kernels: KernelCache,
    faults: Arc<Mutex<Faults>>,
    allocated: Arc<AtomicU64>,
}

/// Compiled shaders by file name and constants text.
type ShaderCache = Arc<Mutex<HashMap<(String, String), (Arc<Compiled>, wgpu::ShaderModule)>>>;

/// Kernels by shader, entry point, overrides and constants text.
type KernelCache = Arc<Mutex<HashMap<String, Kernel>>>;

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
}

impl Gpu {
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
        let (shaders, kernels, allocated) = (Arc::default(), Arc::default(), Arc::default());
        Ok(Gpu {
            instance,
            adapter,
            device,
            queue,
            info,
            limits,
            timestamps,
            folder,
            shaders,
            kernels,
            faults,
            allocated,
        })
    }

    /// All devices, best first: discrete, integrated, virtual, other, software.
    #[must_use]
    pub fn adapters() -> Vec<AdapterSummary> {
        ranked_adapters(&new_instance()).iter().enumerate().map(|(index, adapter)| summary(index, adapter)).collect()
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
            Some(Fault::Refused(text)) => Err(Error::Bug(format!("the graphics library refused a call: {text}"))),
        }
    }

    /// Waits until a submission, or everything submitted, is done; then [`Gpu::check`]s.
    ///
    /// # Errors
    /// Those of [`Gpu::check`], and [`Error::Gpu`] if the device cannot be waited for.
    pub fn wait(&self, submission: Option<wgpu::SubmissionIndex>) -> Result<()> {
        let waited = self.device.poll(wgpu::PollType::Wait { submission_index: submission, timeout: None });
        self.check()?;
        waited.map(|_| ()).map_err(|error| Error::Gpu(format!("waiting for {}: {error}", self.info.name)))
    }

    /// Forgets compiled shaders, so that the next [`super::Kernel`] reads the sources again (live editing).
    pub fn forget_shaders(&self) {
        lock(&self.shaders).clear();
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

/// A set, not empty environment variable.
fn environment(name: &str) -> Option<String> {
    std::env::var(name).ok().filter(|value| !value.is_empty())
}

/// An instance without the check that wgpu inserts before each indirect dispatch: it makes a dispatch of zero groups, our
/// way to skip work, cost as much as a real one.
fn new_instance() -> wgpu::Instance {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle().with_env();
    descriptor.flags.remove(wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL);
    wgpu::Instance::new(descriptor)
}

/// All adapters, best first; equal ones keep the driver's order.
fn ranked_adapters(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    adapters.sort_by_key(|adapter| match adapter.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    });
    adapters
}

/// Describes one adapter of the ranked list.
fn summary(index: usize, adapter: &wgpu::Adapter) -> AdapterSummary {
    let info = adapter.get_info();
    let kind = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => "discrete",
        wgpu::DeviceType::IntegratedGpu => "integrated",
        wgpu::DeviceType::VirtualGpu => "virtual",
        wgpu::DeviceType::Cpu => "software",
        wgpu::DeviceType::Other => "other",
    };
    let driver = [info.backend.to_string(), info.driver, info.driver_info]
        .into_iter()
        .filter(|part| !part.is_empty())
        .collect::<Vec<_>>()
        .join(", ");
    let max_binding = adapter.limits().max_storage_buffer_binding_size;
    AdapterSummary { index, name: info.name, kind, driver, max_binding }
}

/// The adapter `wanted` names by index or by a part of its description; the first without a wish.
fn choose(mut adapters: Vec<wgpu::Adapter>, wanted: Option<&str>) -> Result<wgpu::Adapter> {
    let list: Vec<String> =
        adapters.iter().enumerate().map(|(index, adapter)| summary(index, adapter).to_string()).collect();
    if adapters.is_empty() {
        return Err(Error::NoAdapter(NO_ADAPTER.to_owned()));
    }
    let found = match wanted {
        None => Some(0),
        Some(text) => match text.parse::<usize>() {
            Ok(index) => (index < list.len()).then_some(index),
            Err(_) => list.iter().position(|line| line.to_lowercase().contains(&text.to_lowercase())),
        },
    };
    match found {
        Some(index) => Ok(adapters.swap_remove(index)),
        None => Err(Error::NoAdapter(format!(
            "no device matches `{}`; there are\n  {}",
            wanted.unwrap_or_default(),
            list.join("\n  ")
        ))),
    }
}

/// What to install where nothing was found.
const NO_ADAPTER: &str =
    "no Vulkan, Metal or DirectX 12 device was found. Install your GPU's driver, or a software one:
  Debian, Ubuntu: apt install mesa-vulkan-drivers
  Fedora:         dnf install mesa-vulkan-drivers vulkan-loader
  Arch:           pacman -S vulkan-swrast vulkan-icd-loader
  Alpine:         apk add mesa-vulkan-swrast vulkan-loader";

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
