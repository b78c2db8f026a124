//! `shaders`: the kernels as other compilers get them.

use serde_json::json;

use super::args::{Cli, ShadersOptions};
use crate::gpu::{Gpu, GpuOptions, Settings};
use crate::render::Renderer;
use crate::scene::{self, Scene};
use crate::simulation::Simulation;
use crate::{Error, Result};

/// Cells along the longest axis: kernels do not depend on them.
const CELLS: u32 = 16;

/// Pixels of a picture: nor on these.
const SIZE: [u32; 2] = [32, 32];

/// Writes every kernel of the scenes, with the settings of software and of hardware.
///
/// # Errors
/// [`Error::Scene`], [`Error::Shader`], [`Error::Io`].
pub(super) fn shaders(options: &ShadersOptions, cli: &Cli) -> Result<()> {
    let open = |settings| {
        let kernels = Some(options.out.clone());
        Gpu::new(&GpuOptions { device: cli.device.clone(), settings: Some(settings), kernels, ..GpuOptions::default() })
    };
    let mut gpu = open(Settings::Software)?;
    let names = if options.scenes.is_empty() {
        scene::shipped().into_iter().map(|scene| scene.name).collect()
    } else {
        options.scenes.clone()
    };
    for name in &names {
        let scene = Scene::find(name, &[])?;
        // A scene whose shape asks for more cells is taken as it is.
        let mut scene = scene.with_resolution(CELLS).unwrap_or(scene);
        scene.render.size = SIZE;
        for settings in [Settings::Software, Settings::Hardware] {
            gpu.settings = settings;
            let simulation = Simulation::new(&gpu, &scene)?;
            // Those of pictures are compiled when one is drawn.
            Renderer::of(&simulation, &scene)?.render(0.0)?;
        }
    }
    let files = std::fs::read_dir(&options.out).map_err(|source| Error::io(&options.out, source))?;
    let kernels = files.flatten().filter(|file| file.path().extension().is_some_and(|end| end == "json")).count();
    if cli.json {
        say!("{}", json!({ "out": options.out, "scenes": names.len(), "kernels": kernels }));
    } else {
        say!("{kernels} kernels of {} scenes in {}", names.len(), options.out.display());
    }
    Ok(())
}
