//! `view`: the live window.

use super::args::{Cli, ViewOptions};
use crate::Result;

/// Opens the window, on the gallery or on a scene.
///
/// # Errors
/// [`crate::Error::Scene`] if the scene is wrong; [`crate::Error::Usage`] if there is no window.
#[cfg(feature = "viewer")]
pub(super) fn view(options: Option<&ViewOptions>, cli: &Cli) -> Result<()> {
    use crate::gpu::GpuOptions;
    use crate::viewer::model::{Pace, Request};

    let request = options.map(|ViewOptions { scene, .. }| Request {
        name: scene.scene.clone(),
        changes: super::scenes::changes(scene, &[]),
        resolution: scene.resolution,
        ..Request::default()
    });
    if let Some(request) = &request {
        // Mistakes are told here, where they were made.
        request.load()?;
    }
    let pace = options.filter(|options| options.full_speed).map(|_| Pace::Fastest);
    let options = GpuOptions { device: cli.device.clone(), ..GpuOptions::default() };
    let (steps, seconds) = crate::viewer::run(options, request, pace)?;
    if steps > 0 {
        tell!(
            "{steps} steps in {seconds:.1} s: {:.2} steps/s with everything that the window needs",
            steps as f64 / seconds
        );
    }
    Ok(())
}

/// Says that this program has no window.
///
/// # Errors
/// Always [`crate::Error::Usage`].
#[cfg(not(feature = "viewer"))]
pub(super) fn view(_: Option<&ViewOptions>, _: &Cli) -> Result<()> {
    Err(crate::Error::Usage(
        "this program was built without the live window (--no-default-features); `brisance run SCENE` writes pictures, \
         `brisance list` names the scenes"
            .to_owned(),
    ))
}
