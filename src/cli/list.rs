//! `devices` and `list`.

use serde_json::json;

use crate::gpu::Gpu;
use crate::scene::{self, Scene};
use crate::{Error, Result};

/// Prints the devices, best first.
///
/// # Errors
/// [`Error::NoAdapter`] if there is none.
pub(super) fn devices(as_json: bool) -> Result<()> {
    let adapters = Gpu::adapters();
    if adapters.is_empty() {
        // Opening says what to install.
        return Gpu::new(&crate::gpu::GpuOptions::default()).map(|_| ());
    }
    if as_json {
        let list: Vec<_> = adapters
            .iter()
            .map(|a| json!({ "index": a.index, "name": a.name, "kind": a.kind, "driver": a.driver, "max_binding": a.max_binding }))
            .collect();
        say!("{}", json!({ "devices": list }));
        return Ok(());
    }
    for adapter in &adapters {
        say!("{adapter}");
    }
    Ok(())
}

/// Prints the shipped scenes with their titles.
///
/// # Errors
/// [`Error::Scene`] if one of them is wrong.
pub(super) fn scenes(as_json: bool) -> Result<()> {
    let shipped = scene::shipped();
    let mut list = Vec::new();
    for scene in &shipped {
        let read = Scene::parse(&scene.text, &scene.path, &[]).map_err(|error| Error::Scene(error.to_string()))?;
        list.push((scene, read));
    }
    if as_json {
        let list: Vec<_> = list
            .iter()
            .map(|(shipped, scene)| {
                json!({ "name": shipped.name, "path": shipped.path, "title": scene.title,
                        "dimension": scene.domain.dimension, "cells": scene.domain.cells,
                        "variants": scene.variants.keys().collect::<Vec<_>>() })
            })
            .collect();
        say!("{}", json!({ "scenes": list }));
        return Ok(());
    }
    let width = shipped.iter().map(|scene| scene.name.len()).max().unwrap_or(0);
    for (shipped, scene) in &list {
        let variants: Vec<&str> = scene.variants.keys().map(String::as_str).collect();
        let variants = if variants.is_empty() { String::new() } else { format!(" [{}]", variants.join(", ")) };
        say!("{:width$}  {}D  {}{variants}", shipped.name, scene.domain.dimension, scene.title);
    }
    say!("\nbrisance run NAME runs one of them, --variant one of the variants in brackets.");
    Ok(())
}
