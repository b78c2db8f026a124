//! Compute kernels whose bindings are read from the WGSL: Rust names buffers, never binding numbers.

use std::fmt::Write as _;
use std::num::NonZeroU64;
use std::sync::Arc;

use super::buffer::Buffer;
use super::device::{Gpu, lock};
use super::pipeline::{Pipeline, Recipe};
use super::reflect::{Access, Binding, Compiled};
use super::shader::Shader;
use crate::error::{Error, Result};

/// Threads of a workgroup, flat along x; every shader sees it as `const WORKGROUP`.
pub const WORKGROUP: u32 = 64;

/// Neighbouring threads that take slots next to each other: on a CPU as many as one instruction; every shader sees it as `const OCTET`.
pub const OCTET: u32 = 8;

/// Workgroups along one axis at most, on every device; every shader sees it as `const MAX_GROUPS`.
pub const MAX_GROUPS: u32 = 65_535;

/// What is fixed when a shader is compiled.
#[derive(Clone, Copy, Debug, Default)]
pub struct Constants<'a> {
    /// Values of `override` declarations. Those the shader does not declare are left out, so that one list serves all.
    pub overrides: &'a [(&'a str, f64)],
    /// WGSL declarations put before the source.
    pub source: &'a str,
}

/// One compiled entry point.
#[derive(Clone, Debug)]
pub struct Kernel {
    label: String,
    name: Arc<str>,
    pipeline: Arc<Pipeline>,
    layout: wgpu::BindGroupLayout,
    bindings: Vec<Binding>,
    threads_per_group: u32,
}

/// A kernel with its buffers: what a [`super::Pass`] dispatches.
#[derive(Clone, Debug)]
pub struct Bound {
    pub(super) pipeline: Arc<Pipeline>,
    pub(super) group: wgpu::BindGroup,
    pub(super) threads_per_group: u32,
    /// Entry point, with its form where there are several.
    pub(super) name: Arc<str>,
}

impl Bound {
    /// With the form in its name.
    #[must_use]
    pub fn in_form(self, form: &str) -> Self {
        Bound { name: format!("{} ({form})", self.name).into(), ..self }
    }
}

/// How many threads a dispatch runs.
#[derive(Clone, Copy, Debug)]
pub enum Extent<'a> {
    /// At least this many threads, in whole workgroups; the shader checks its index.
    Threads(u64),
    /// Exactly these workgroups.
    Groups([u32; 3]),
    /// The three group counts at this byte offset of a [`Buffer::indirect`]; zeros skip the dispatch.
    Indirect(&'a Buffer<u32>, u64),
}

/// Workgroups for `groups`: rows of [`MAX_GROUPS`] along x, as many as needed along y. The product is at least `groups`, and
/// `thread_index` in `head.wgsl`, which every shader sees, counts the same way.
#[must_use]
pub fn group_counts(groups: u64) -> [u32; 3] {
    let limit = u64::from(MAX_GROUPS);
    [groups.min(limit) as u32, groups.div_ceil(limit) as u32, 1]
}

impl Kernel {
    /// One entry point of a shader, once per device, constants text, and values of the overrides that it reads. It is compiled on
    /// another core; [`Gpu::finish_kernels`] waits for it, and so does the first dispatch.
    ///
    /// # Errors
    /// [`Error::Shader`] for everything that is wrong with the source, the entry point or its bindings, [`Error::Bug`] if the source is
    /// ours; [`Error::Interrupted`].
    pub fn new(gpu: &Gpu, shader: &str, entry: &str, constants: &Constants<'_>) -> Result<Kernel> {
        Kernel::known_or_new(gpu, shader, entry, constants).map_err(|error| gpu.blamed(error))
    }

    fn known_or_new(gpu: &Gpu, shader: &str, entry: &str, constants: &Constants<'_>) -> Result<Kernel> {
        let compiled = compiled(gpu, shader, constants.source)?;
        let mut read = String::new();
        for (name, value) in constants.overrides {
            if compiled.reads_override(entry, name)? {
                let _ = write!(read, " {name} {value}");
            }
        }
        let key = format!("{shader}: {entry}{read}\n{}", constants.source);
        if let Some(known) = lock(&gpu.kernels).get(&key) {
            return Ok(known);
        }
        gpu.go_on()?;
        let kernel = Kernel::compile(gpu, &compiled, entry, constants)?;
        lock(&gpu.kernels).insert(key, kernel.clone());
        Ok(kernel)
    }

    /// Has one entry point compiled.
    fn compile(gpu: &Gpu, compiled: &Arc<Compiled>, entry: &str, constants: &Constants<'_>) -> Result<Kernel> {
        let label = format!("shaders/{}: {entry}", compiled.shader.name);
        let bindings = compiled.bindings(entry)?;
        let threads_per_group = compiled.threads_per_group(entry)?;
        let entries: Vec<_> = bindings.iter().map(layout_entry).collect();
        let layout = gpu
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(&label), entries: &entries });
        let pipeline_layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(&label),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let overrides: Vec<_> =
            constants.overrides.iter().copied().filter(|(name, _)| compiled.has_override(name)).collect();
        gpu.check()?;
        let missing = compiled.missing_overrides(entry, &overrides)?;
        if !missing.is_empty() {
            return Err(Error::Shader(format!("{label}: no value for override {}", missing.join(", "))));
        }
        if let Some(folder) = &gpu.written {
            super::written::write(folder, compiled, entry, &overrides)?;
        }
        let overrides = overrides.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
        let (compiled, name) = (Arc::clone(compiled), entry.into());
        let recipe =
            Recipe { label: label.clone(), layout: pipeline_layout, compiled, entry: entry.to_owned(), overrides };
        let pipeline = Pipeline::queue(gpu, recipe);
        Ok(Kernel { label, pipeline, layout, bindings, threads_per_group, name })
    }

    /// The variables of group 0 this entry point uses, by binding number.
    #[must_use]
    pub fn bindings(&self) -> &[Binding] {
        &self.bindings
    }

    /// Connects buffers by the names of the shader's variables. All that the entry point uses must be given, and nothing else.
    ///
    /// # Errors
    /// [`Error::Shader`] for unknown, missing, doubled and too small buffers, and for one buffer under two names of which one
    /// is written.
    pub fn bind(&self, gpu: &Gpu, buffers: &[(&str, &wgpu::Buffer)]) -> Result<Bound> {
        self.check(buffers).map_err(|reason| Error::Shader(format!("{}: {reason}", self.label)))?;
        let entries: Vec<_> = buffers
            .iter()
            .filter_map(|(name, buffer)| {
                let binding = self.bindings.iter().find(|binding| binding.name == *name)?;
                Some(wgpu::BindGroupEntry { binding: binding.index, resource: buffer.as_entire_binding() })
            })
            .collect();
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(&self.label),
            layout: &self.layout,
            entries: &entries,
        });
        gpu.check()?;
        let (pipeline, name) = (Arc::clone(&self.pipeline), self.name.clone());
        Ok(Bound { pipeline, group, threads_per_group: self.threads_per_group, name })
    }

    /// Compares the given names with the declared ones, both ways.
    fn check(&self, buffers: &[(&str, &wgpu::Buffer)]) -> std::result::Result<(), String> {
        let declared = || self.bindings.iter().map(|binding| binding.name.as_str()).collect::<Vec<_>>().join(", ");
        for (index, (name, buffer)) in buffers.iter().enumerate() {
            let Some(binding) = self.bindings.iter().find(|binding| binding.name == *name) else {
                return Err(format!("uses no variable `{name}`; it uses {}", declared()));
            };
            if buffer.size() < binding.min_bytes {
                return Err(format!("`{name}` needs {} bytes, the buffer has {}", binding.min_bytes, buffer.size()));
            }
            for (other_name, other) in &buffers[..index] {
                if other_name == name {
                    return Err(format!("`{name}` is given twice"));
                }
                let written = |wanted: &str| {
                    self.bindings.iter().any(|item| item.name == wanted && item.access == Access::ReadWrite)
                };
                if other == buffer && (written(name) || written(other_name)) {
                    return Err(format!("`{other_name}` and `{name}` are one buffer, and one of them is written"));
                }
            }
        }
        let given = |binding: &&Binding| buffers.iter().any(|(name, _)| *name == binding.name);
        match self.bindings.iter().find(|binding| !given(binding)) {
            Some(binding) => Err(format!("no buffer for `{}`; it uses {}", binding.name, declared())),
            None => Ok(()),
        }
    }
}

/// The shader from the device's cache, or compiled now.
fn compiled(gpu: &Gpu, name: &str, constants: &str) -> Result<Arc<Compiled>> {
    let key = (name.to_owned(), constants.to_owned());
    if let Some(known) = lock(&gpu.shaders).get(&key) {
        return Ok(known);
    }
    let compiled = Arc::new(Shader::load(name, constants, &gpu.folder)?.compile()?);
    lock(&gpu.shaders).insert(key, Arc::clone(&compiled));
    Ok(compiled)
}

/// One line of the explicit layout.
fn layout_entry(binding: &Binding) -> wgpu::BindGroupLayoutEntry {
    let ty = match binding.access {
        Access::Uniform => wgpu::BufferBindingType::Uniform,
        Access::Read => wgpu::BufferBindingType::Storage { read_only: true },
        Access::ReadWrite => wgpu::BufferBindingType::Storage { read_only: false },
    };
    wgpu::BindGroupLayoutEntry {
        binding: binding.index,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            min_binding_size: NonZeroU64::new(binding.min_bytes),
        },
        count: None,
    }
}
