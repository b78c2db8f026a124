//! Pipelines that are compiled beside each other, on all cores, while the caller makes buffers and asks for further kernels.

use std::borrow::Cow;
use std::fmt::{self, Write};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Arc, Mutex, OnceLock};

use wgpu::naga::Module;

use super::cache::Cache;
use super::device::{Gpu, lock};
use super::reflect::Compiled;
use super::specialised::specialised;
use crate::error::{Error, Result};

/// Pipelines of a device by what they are made of. Kernels share one where their overrides differ in what is left out anyway.
pub(super) type PipelineCache = Arc<Mutex<Cache<[u64; 2], Made>>>;

/// A pipeline, compiled by whoever comes first, or why it cannot be.
type Made = Arc<OnceLock<std::result::Result<wgpu::ComputePipeline, String>>>;

/// The pipeline of a kernel, looked up or compiled by whoever comes first: a core without other work, or the one that needs it.
#[derive(Debug)]
pub(super) struct Pipeline {
    recipe: Recipe,
    known: PipelineCache,
    made: OnceLock<Made>,
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
        let pipeline = Arc::new(Pipeline { recipe, known: Arc::clone(&gpu.pipelines), made: OnceLock::new() });
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
        let made = self.made.get_or_init(|| self.recipe.known_or_compiled(device, &self.known)).get();
        made.expect("compiled before it is kept").as_ref().map_err(|text| Error::Shader(text.clone()))
    }
}

impl Recipe {
    fn known_or_compiled(&self, device: &wgpu::Device, known: &Mutex<Cache<[u64; 2], Made>>) -> Made {
        let module = match specialised(&self.compiled, &self.entry, &self.overrides) {
            Ok(module) => module,
            Err(reason) => return Arc::new(OnceLock::from(Err(format!("{}: {reason}", self.label)))),
        };
        let key = digest(&self.label, &self.compiled.shader.text, &module);
        let made = {
            let mut known = lock(known);
            known.get(&key).unwrap_or_else(|| {
                let made = Made::default();
                known.insert(key, Arc::clone(&made));
                made
            })
        };
        made.get_or_init(|| self.compile(device, module));
        made
    }

    fn compile(&self, device: &wgpu::Device, module: Module) -> std::result::Result<wgpu::ComputePipeline, String> {
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

/// 128 bits of what a pipeline is made of; label and text of the shader stand for its bindings, of which some may be left out.
fn digest(label: &str, text: &str, module: &Module) -> [u64; 2] {
    let mut digest = Digest([0_u8, 1].map(|seed| {
        let mut hasher = DefaultHasher::new();
        (seed, label, text).hash(&mut hasher);
        hasher
    }));
    write!(digest, "{module:?}").expect("nothing is stored");
    digest.0.map(|hasher| hasher.finish())
}

/// Takes text, and keeps hashes of it.
struct Digest([DefaultHasher; 2]);

impl Write for Digest {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.iter_mut().for_each(|hasher| hasher.write(text.as_bytes()));
        Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{Folder, Shader};

    const TEXT: &str = "
override CUT: bool;
override MIRRORED: u32;
@group(0) @binding(0) var<storage, read_write> values: array<f32>;
@compute @workgroup_size(1)
fn main() {
    if CUT { values[0] = f32(MIRRORED); }
}
";

    fn of_overrides(label: &str, cut: f64, mirrored: f64) -> [u64; 2] {
        let folder = Folder::Given(vec![("text.wgsl".to_owned(), TEXT.to_owned())]);
        let compiled = Shader::load("text.wgsl", "", &folder).unwrap().compile().unwrap();
        let overrides = [("CUT".to_owned(), cut), ("MIRRORED".to_owned(), mirrored)];
        digest(label, &compiled.shader.text, &specialised(&compiled, "main", &overrides).unwrap())
    }

    #[test]
    fn overrides_that_are_left_out_make_no_other_pipeline() {
        assert_eq!(of_overrides("a", 0.0, 3.0), of_overrides("a", 0.0, 5.0));
        assert_ne!(of_overrides("a", 1.0, 3.0), of_overrides("a", 1.0, 5.0));
        assert_ne!(of_overrides("a", 0.0, 3.0), of_overrides("b", 0.0, 3.0), "its bindings may differ");
    }
}
