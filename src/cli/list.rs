//! `devices` and `list`.

use serde_json::json;

use super::args::Cli;
use super::check::size;
use crate::gpu::{AdapterSummary, Gpu, GpuOptions, Settings};
use crate::scene::{self, Scene};
use crate::{Error, Result};

/// Prints the devices, best first.
///
/// # Errors
/// [`Error::NoAdapter`] if there is none.
pub(super) fn devices(cli: &Cli) -> Result<()> {
    let adapters = Gpu::adapters();
    // Opening says what to install where there is none, and which one it takes.
    let gpu = Gpu::new(&GpuOptions { device: cli.device.clone(), ..GpuOptions::default() })?;
    let chosen = AdapterSummary { index: 0, ..gpu.summary() };
    let taken = adapters.iter().position(|adapter| AdapterSummary { index: 0, ..adapter.clone() } == chosen);
    let why = reason(cli);
    let memory = crate::state::memory_together(&gpu);
    if cli.json {
        let list: Vec<_> = adapters
            .iter()
            .map(|a| {
                let limits: serde_json::Map<_, _> =
                    a.limits.iter().map(|(name, value)| ((*name).to_owned(), json!(value))).collect();
                let features: Vec<_> = a.features.iter().filter(|(_, has)| *has).map(|(name, _)| name).collect();
                json!({ "index": a.index, "name": a.name, "kind": a.kind, "backend": a.backend, "driver": a.driver,
                    "max_binding": a.max_binding, "max_buffer": a.max_buffer, "limits": limits, "features": features,
                    "known": a.known() })
            })
            .collect();
        say!(
            "{}",
            json!({ "devices": list, "chosen": { "index": taken, "why": why, "settings": settings(&gpu), "memory": memory } })
        );
        return Ok(());
    }
    for adapter in &adapters {
        say!("{adapter}");
        if Some(adapter.index) == taken {
            say!("   chosen    {why}; settings of {}", settings(&gpu));
            let told = memory.map_or("not told by the driver; buffers that do not fit are errors".to_owned(), size);
            say!("   memory    {told}");
        }
        let features: Vec<_> = adapter
            .features
            .iter()
            .map(|(name, has)| if *has { (*name).to_owned() } else { format!("no {name}") })
            .collect();
        say!("   features  {}", features.join(", "));
        let limits: Vec<_> = adapter.limits.iter().map(|(name, value)| format!("{name} {value}")).collect();
        say!("   limits    {}", limits.join(", "));
        say!("   known     {}", adapter.known());
    }
    Ok(())
}

/// Why the chosen device is chosen.
fn reason(cli: &Cli) -> String {
    let wish = std::env::var("BRISANCE_DEVICE").ok().filter(|value| !value.is_empty());
    match (&cli.device, wish) {
        (Some(wish), _) => format!("--device {wish}"),
        (None, Some(wish)) => format!("BRISANCE_DEVICE={wish}"),
        (None, None) => "the first of the list: discrete before integrated, virtual, other and software".to_owned(),
    }
}

/// Whose settings a device takes, for people.
pub(super) fn settings(gpu: &Gpu) -> &'static str {
    match gpu.settings {
        Settings::Software => "a software device: transfer by columns, long marches, few groups",
        Settings::Hardware => "hardware: transfer by nodes, short marches, many groups, submissions of 100 ms",
    }
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
