//! Which formats a run writes.

use super::RunOptions;
use crate::export::keyword;
use crate::scene::Scene;

/// Formats of a run: pictures unless unwanted, others if the scene or the command line asks.
pub(super) fn formats(options: &RunOptions, scene: &Scene) -> Vec<String> {
    let mut formats: Vec<String> = if options.no_frames { Vec::new() } else { vec!["png".to_owned()] };
    let asked = options.export.iter().map(|name| keyword(name).to_owned());
    let asked = asked.chain(scene.output.formats().map(str::to_owned));
    for name in asked {
        if !formats.contains(&name) {
            formats.push(name);
        }
    }
    if options.no_frames {
        formats.retain(|name| !PICTURES.contains(&name.as_str()));
    }
    without_coarse(&mut formats);
    formats
}

/// Formats that hold pictures.
pub(in crate::cli) const PICTURES: [&str; 3] = ["png", "png16", "exr"];

/// Pictures of 16 bits per channel take the place of those of 8.
pub(in crate::cli) fn without_coarse(formats: &mut Vec<String>) {
    if formats.iter().any(|name| name == "png16") {
        formats.retain(|name| name != "png");
    }
}
