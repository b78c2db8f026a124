//! The devices there are: their list, what they can, and the choice of one.

use std::path::PathBuf;

use super::device::{GIB, Gpu};
use super::kernel::MAX_GROUPS;
use super::reflect::MAX_STORAGE_BUFFERS;
use crate::error::{Error, Result};

/// One line of the list of devices, best first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterSummary {
    /// Position in the list; `--device` accepts it.
    pub index: usize,
    /// Name the driver gives.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    /// Programming interface, for example `vulkan`.
    pub backend: String,
    /// Programming interface and driver, for example `vulkan, llvmpipe, Mesa 22.3.6`.
    pub driver: String,
    /// Largest storage buffer a kernel may bind \[bytes\].
    pub max_binding: u64,
    /// Largest buffer \[bytes\].
    pub max_buffer: u64,
    /// Limits that kernels meet, by their names in WebGPU.
    pub limits: Vec<(&'static str, u64)>,
    /// Optional features in use where the device has them, and whether it has.
    pub features: Vec<(&'static str, bool)>,
}

impl std::fmt::Display for AdapterSummary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let gib = self.max_binding as f64 / GIB;
        write!(f, "{}: {} ({}; {}; {gib:.2} GiB per buffer)", self.index, self.name, self.kind, self.driver)
    }
}

impl AdapterSummary {
    /// What is known about devices of its kind.
    #[must_use]
    pub fn known(&self) -> &'static str {
        let text = format!("{} {}", self.name, self.driver).to_lowercase();
        let found = KNOWN.iter().find(|(part, _)| text.contains(part));
        found.map_or("never run; `brisance selftest` tells, and its file is welcome in an issue", |(_, known)| known)
    }
}

/// What has run on which driver, by a part of its description.
const KNOWN: [(&str, &str); 4] = [
    ("nvidia h100", "selftest, most of the suite and the scenes of the paper have run on it, under Vulkan"),
    ("nvidia h200", "selftest and most of the suite have run on it, under Vulkan"),
    ("mesa 22.3", "the whole suite runs on it, at every change"),
    ("llvmpipe", "the suite runs on Mesa 22.3 and 25.0; newer ones compile longer and compute faster"),
];

impl Gpu {
    /// All devices, best first: discrete, integrated, virtual, other, software.
    #[must_use]
    pub fn adapters() -> Vec<AdapterSummary> {
        ranked_adapters(&new_instance()).iter().enumerate().map(|(index, adapter)| summary(index, adapter)).collect()
    }

    /// The line of this device, wherever it stands in the list.
    #[must_use]
    pub fn summary(&self) -> AdapterSummary {
        summary(0, &self.adapter)
    }
}

/// An instance without the check that wgpu inserts before each indirect dispatch: it makes a dispatch of zero groups, our
/// way to skip work, cost as much as a real one. On DirectX 12 shaders go through Microsoft's newer compiler alone, from beside the
/// program: the one that comes with Windows refuses or miscompiles them.
pub(super) fn new_instance() -> wgpu::Instance {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle().with_env();
    descriptor.flags.remove(wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL);
    let compiler = shader_compiler().to_string_lossy().into_owned();
    descriptor.backend_options.dx12.shader_compiler = wgpu::Dx12Compiler::DynamicDxc { dxc_path: compiler };
    // An error here is better than memory that the system moves to and fro.
    descriptor.memory_budget_thresholds.for_resource_creation = Some(MOST_OF_MEMORY);
    wgpu::Instance::new(descriptor)
}

/// Share of the device's memory that buffers may take, in percent, where the driver tells how much there is.
const MOST_OF_MEMORY: u8 = 95;

/// Microsoft's shader compiler, beside the program.
fn shader_compiler() -> PathBuf {
    let program = std::env::current_exe().unwrap_or_default();
    program.with_file_name("dxcompiler.dll")
}

/// All adapters, best first; equal ones keep the driver's order.
pub(super) fn ranked_adapters(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
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
    let backend = info.backend.to_string();
    let driver = [backend.clone(), info.driver, info.driver_info]
        .into_iter()
        .filter(|part| !part.is_empty())
        .collect::<Vec<_>>()
        .join(", ");
    let limits = adapter.limits();
    AdapterSummary {
        index,
        name: info.name,
        kind,
        backend,
        driver,
        max_binding: limits.max_storage_buffer_binding_size,
        max_buffer: limits.max_buffer_size,
        limits: needed(&limits).iter().map(|(name, has, _)| (*name, *has)).collect(),
        features: vec![("timestamp-query", adapter.features().contains(wgpu::Features::TIMESTAMP_QUERY))],
    }
}

/// Limits that kernels meet: name in WebGPU, what there is, what it takes.
fn needed(limits: &wgpu::Limits) -> [(&'static str, u64, u64); 6] {
    [
        (
            "maxStorageBuffersPerShaderStage",
            limits.max_storage_buffers_per_shader_stage.into(),
            MAX_STORAGE_BUFFERS as u64,
        ),
        ("maxComputeWorkgroupsPerDimension", limits.max_compute_workgroups_per_dimension.into(), MAX_GROUPS.into()),
        ("maxComputeInvocationsPerWorkgroup", limits.max_compute_invocations_per_workgroup.into(), 64),
        ("maxComputeWorkgroupStorageSize", limits.max_compute_workgroup_storage_size.into(), 16 << 10),
        ("maxStorageBufferBindingSize", limits.max_storage_buffer_binding_size, 128 << 20),
        ("maxUniformBufferBindingSize", limits.max_uniform_buffer_binding_size, 16 << 10),
    ]
}

/// Refuses a device below what every WebGPU device has.
pub(super) fn enough(name: &str, limits: &wgpu::Limits) -> Result<()> {
    match needed(limits).iter().find(|(_, has, needs)| has < needs) {
        None => Ok(()),
        Some((limit, has, needs)) => Err(Error::NoAdapter(format!(
            "{name}: {limit} is {has}, and it takes {needs}; use another --device or a newer driver"
        ))),
    }
}

/// The adapter `wanted` names by index or by a part of its description; the first without a wish.
pub(super) fn choose(mut adapters: Vec<wgpu::Adapter>, wanted: Option<&str>) -> Result<wgpu::Adapter> {
    let list: Vec<String> =
        adapters.iter().enumerate().map(|(index, adapter)| summary(index, adapter).to_string()).collect();
    if adapters.is_empty() {
        let hint = if cfg!(windows) { NO_COMPILER } else { "" };
        return Err(Error::NoAdapter(format!("{NO_ADAPTER}{hint}")));
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

/// What else to do on Windows.
const NO_COMPILER: &str = "
  Windows:        for DirectX 12 put Microsoft's dxcompiler.dll (1.8.2502 or newer) beside brisance.exe, from
                  https://github.com/microsoft/DirectXShaderCompiler/releases; the compiler of Windows itself will not do";
