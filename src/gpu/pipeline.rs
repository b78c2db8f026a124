//! Pipelines that are compiled beside each other, on all cores, while the caller makes buffers and asks for further kernels.

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use super::device::{Gpu, lock};
use super::reflect::Compiled;
use super::specialised::specialised;
use crate::error::{Error, Result};

/// A pipeline, compiled by whoever comes first: a core without other work, or the one that needs it.
#[derive(Debug)]
pub(super) struct Pipeline {
    recipe: Recipe,
    made: OnceLock<std::result::Result<wgpu::ComputePipeline, String>>,
}

/// What a pipeline is made of.
#[derive(Debug)]
pub(super) struct Recipe {
    pub label: String,
    pub layout: wgpu::PipelineLayout,
    pub compiled: Arc<Compiled>,
    pub entry: String,
    pub overrides: Vec<(String, f64)>,
}

impl Pipeline {
    /// Asks for a pipeline; [`Gpu::finish_kernels`] waits for it.
    pub(super) fn queue(gpu: &Gpu, recipe: Recipe) -> Arc<Pipeline> {
        let pipeline = Arc::new(Pipeline { recipe, made: OnceLock::new() });
        lock(&gpu.queued).push(Arc::clone(&pipeline));
        let (device, wish, queued) = (gpu.device.clone(), gpu.clone(), Arc::clone(&pipeline));
        rayon::spawn(move || {
            if wish.go_on().is_ok() {
                let _ = queued.get(&device);
            }
        });
        pipeline
    }

    /// The pipeline, compiled now if nobody has begun.
    ///
    /// # Errors
    /// [`Error::Shader`] if the compiler refuses it.
    pub(super) fn get(&self, device: &wgpu::Device) -> Result<&wgpu::ComputePipeline> {
        let made = self.made.get_or_init(|| self.recipe.compile(device));
        made.as_ref().map_err(|text| Error::Shader(text.clone()))
    }
}

impl Recipe {
    fn compile(&self, device: &wgpu::Device) -> std::result::Result<wgpu::ComputePipeline, String> {
        let module = specialised(&self.compiled, &self.entry, &self.overrides)
            .map_err(|reason| format!("{}: {reason}", self.label))?;
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(&self.label),
            source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&self.label),
            layout: Some(&self.layout),
            module: &module,
            entry_point: Some(&self.entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        match pollster::block_on(scope.pop()) {
            Some(error) => Err(format!("{}: {error}", self.label)),
            None => Ok(pipeline),
        }
    }
}

impl Gpu {
    /// Waits until all kernels asked for so far are compiled, and tells [`super::GpuOptions::compiling`] how far it is.
    ///
    /// # Errors
    /// [`Error::Shader`] for the first one that is refused, [`Error::Bug`] if it is one of ours; [`Error::Interrupted`].
    pub fn finish_kernels(&self) -> Result<()> {
        let queued = std::mem::take(&mut *lock(&self.queued));
        for (index, pipeline) in queued.iter().enumerate() {
            self.go_on()?;
            if let Some(tell) = self.compiling {
                tell(index, queued.len());
            }
            pipeline.get(&self.device).map_err(|error| self.blamed(error))?;
        }
        if let (Some(tell), false) = (self.compiling, queued.is_empty()) {
            tell(queued.len(), queued.len());
        }
        Ok(())
    }
}
