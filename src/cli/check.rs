//! `check`: what a scene is and needs, without running it.

use std::path::Path;

use serde_json::json;

use super::args::{CheckOptions, Cli};
use super::duration::{Duration, rough_time};
use super::init::not_an_input;
use super::{open_device, scenes};
use crate::export::png;
use crate::gpu::Gpu;
use crate::math::plain;
use crate::render::Renderer;
use crate::scene::{
    Breaking, ChargeEstimate, Estimate, GridCharge, Overlap, PlaceEstimate, Scene, Tearing, ThinBody, ThinObstacle,
};
use crate::simulation::Simulation;
use crate::state::MemoryPlan;
use crate::{Error, Result};

/// Checks a scene and prints it with every default. Needs no device; one that is named with `--device` is asked whether the
/// scene fits.
///
/// # Errors
/// [`Error::Scene`] with every mistake, [`Error::DoesNotFit`].
pub(super) fn check(options: &CheckOptions, cli: &Cli) -> Result<()> {
    let scene = scenes::load(&options.scene, &[])?;
    let plan = MemoryPlan::new(&scene, scene.particle_count());
    if let Some(path) = &options.picture {
        not_an_input(path, &options.scene.scene)?;
    }
    if cli.device.is_some() || options.picture.is_some() {
        let gpu = open_device(cli)?;
        plan.check_device(&scene, &gpu)?;
        if let Some(path) = &options.picture {
            draw_start(&gpu, &scene, path)?;
        }
    }
    let (overlaps, thin) = (scene.overlaps(), scene.thin_bodies());
    let (breaking, tearing) = (scene.breaking(), scene.tearing());
    let estimate = scene.estimate(usize::try_from(plan.particles).unwrap_or(usize::MAX));
    let (lost, charges, on_grid) = (scene.thin_obstacles(), scene.charge_estimates(), scene.charges_on_grid());
    let broken = breaking.iter().filter_map(Breaking::warning).chain(tearing.iter().filter_map(Tearing::warning));
    let grid = lost.iter().map(lost_text).chain(on_grid.iter().filter_map(GridCharge::warning));
    tell_warnings(estimate.warnings().into_iter().chain(broken).chain(grid).chain(stale_texts(&scene)));
    let duration = Duration::of(&scene, &plan, &estimate, cli);
    if let Some(reason) = duration.as_ref().and_then(|duration| duration.refused.as_ref()) {
        tell!("warning: a run on this device will be refused: {reason}");
    }
    if cli.json {
        let groups: serde_json::Map<_, _> =
            plan.groups().into_iter().map(|(name, bytes)| (name.to_owned(), bytes.into())).collect();
        let memory = json!({ "bytes": plan.bytes(None), "groups": groups, "bytes_per_cell": plan.per_cell(),
            "bytes_per_particle": plan.per_particle(), "largest_buffer": plan.largest() });
        let object = json!({ "title": scene.title, "cells": plan.cells, "particles": plan.particles,
            "memory": memory, "estimate": estimate, "duration": duration, "overlaps": overlaps, "thin": thin, "thin_obstacles": lost, "breaking": breaking, "tearing": tearing, "charges": charges, "charges_on_grid": on_grid,
            "scene": scene });
        say!("{object}");
        return Ok(());
    }
    let resolved =
        toml::to_string(&scene).map_err(|error| Error::Scene(format!("{}: {error}", options.scene.scene)))?;
    let domain = &scene.domain;
    let cells = domain.cells.map(|n| n.to_string())[..domain.axes()].join(" x ");
    say!("# {}\n#", scene.title);
    say!("# cells      {cells} = {} of edge {} m", plan.cells, plain(domain.spacing()));
    say!("# particles  {}", plan.particles);
    say_things(&overlaps, &thin, (&breaking, &tearing), &charges);
    on_grid.iter().for_each(say_charge_on_grid);
    if !scene.variants.is_empty() {
        say!("# variants   {}", scene.variants.keys().cloned().collect::<Vec<_>>().join(", "));
    }
    say!("# memory     {}", size(plan.bytes(None)));
    for (group, bytes) in plan.groups() {
        say!("#   {group:10} {}", size(bytes));
    }
    say!("#   {:.1} bytes per cell, {:.1} bytes per particle", plan.per_cell(), plan.per_particle());
    if let Some(largest) = plan.largest() {
        say!("#   largest buffer: {}, {}", largest.name, size(largest.bytes));
    }
    say_estimate(&estimate, duration.as_ref());
    say!("# checkpoint at most {} before compression", size(plan.bytes(None)));
    say!("#\n# The scene with every default, as TOML:\n\n{}", resolved.trim_end());
    Ok(())
}

/// What is to be known of bodies and charges, for people.
fn say_things(
    overlaps: &[Overlap],
    thin: &[ThinBody],
    (breaking, tearing): (&[Breaking], &[Tearing]),
    charges: &[ChargeEstimate],
) {
    for overlap in overlaps {
        say!("# overlap    {}", overlap_text(overlap));
    }
    for body in thin {
        say!("# thin       {}", thin_text(body));
    }
    for body in breaking {
        say!("# breaks     {}", breaking_text(body));
    }
    tearing.iter().for_each(say_tearing);
    charges.iter().for_each(say_charge);
}

/// How a body of metal breaks, for people.
fn say_tearing(tearing: &Tearing) {
    let Tearing { body, band, strain, opening, .. } = tearing;
    let [band, strain, opening] = [*band, *strain, *opening].map(plain);
    say!(
        "# tears      `{body}` by voids, in a pulled rod from a plastic strain of {strain} on, and parts {opening} m later; cracks are {band} m wide"
    );
}

/// A charge that stands on the grid, for people.
fn say_charge_on_grid(charge: &GridCharge) {
    let GridCharge { charge, explosive, mass, cells_across, burned_after } = charge;
    let (mass, end) = (plain(*mass), plain(1e3 * burned_after));
    say!(
        "# charge     `{charge}`: {mass} kg of {explosive} on the grid, {cells_across:.1} cells across, burned after {end} ms"
    );
}

/// A charge and what it does by the curves of Kingery and Bulmash, for people.
fn say_charge(charge: &ChargeEstimate) {
    let ground = if charge.on_ground { "on the ground" } else { "in free air" };
    let (tnt, radius) = (plain(charge.tnt), plain(charge.radius));
    say!(
        "# charge     `{}`: as {tnt} kg of TNT {ground}; radius {radius} m, {:.1} cells",
        charge.charge,
        charge.radius_cells
    );
    say!("#            its near field is computed apart, up to {:.1} cells around it", charge.reach_cells);
    for place in &charge.places {
        let PlaceEstimate { place, distance, scaled_distance, wave, fine_cell } = place;
        let wave = wave.map_or("no curve there".to_owned(), |[arrival, pressure, impulse]| {
            let [arrival, pressure] = [1e3 * arrival, 1e-3 * pressure].map(plain);
            format!("after {arrival} ms {pressure} kPa, {} Pa s", plain(impulse))
        });
        say!(
            "#   {place:10} {} m, Z = {scaled_distance:.2}: {wave}; cells of {} m show it",
            plain(*distance),
            plain(*fine_cell)
        );
    }
}

/// What a run will take, for people.
fn say_estimate(estimate: &Estimate, duration: Option<&Duration>) {
    let solid = match estimate.solid_sound_speed {
        0.0 => String::new(),
        speed => format!(", {} m/s in bodies", plain(speed)),
    };
    say!("# sound      {} m/s in gas{solid}", plain(estimate.gas_sound_speed));
    say!("# steps      about {} of {} s, as at the start", plain(estimate.steps.ceil()), plain(estimate.step));
    match duration {
        Some(Duration { device, seconds, .. }) => say!(
            "# time       very roughly {} on {device}, pictures apart: from how fast it copies memory; a third or thrice as long is possible",
            rough_time(*seconds)
        ),
        None => say!("# time       not estimated: no device"),
    }
    say!("# disk       about {}", size(estimate.disk_bytes as u64));
}

/// An overlap for people.
pub(super) fn overlap_text(overlap: &Overlap) -> String {
    let Overlap { body, by, share } = overlap;
    format!("`{body}` gives {:.2} % of its shape to `{by}`, which comes first", 100.0 * share)
}

/// A body that is too thin for people.
fn thin_text(thin: &ThinBody) -> String {
    let ThinBody { body, cells, share } = thin;
    let part = if *share > 0.95 { String::new() } else { format!(" in {:.0} % of it", 100.0 * share) };
    format!(
        "`{body}` is {cells:.1} cells thick{part}: its weight and the gas on either side are right from 1 cell on, but below 2 cells \
         how it bends and breaks is not to be trusted; more cells help (--resolution), or a thicker body"
    )
}

/// An obstacle that the grid does not hold as a whole for people.
pub(super) fn lost_text(lost: &ThinObstacle) -> String {
    let ThinObstacle { obstacle, cells, share } = lost;
    let thick = if *cells < 0.05 { "less than 0.1".to_owned() } else { format!("{cells:.1}") };
    format!(
        "{:.0} % of obstacle `{obstacle}` lie in no cell, where it is {thick} cells thick: gas passes there; an obstacle of 1.5 cells \
         has no holes; more cells help (--resolution), or a thicker obstacle",
        100.0 * share
    )
}

fn tell_warnings(texts: impl Iterator<Item = String>) {
    texts.for_each(|text| tell!("warning: {text}"));
}

/// Outlets that keep what the stream along them no longer is, for people.
pub(super) fn stale_texts(scene: &Scene) -> impl Iterator<Item = String> {
    let pairs = scene.boundary.outlets_along_changing_streams(scene.domain.dimension);
    pairs.into_iter().map(|[outlet, inlet]| {
        format!(
            "boundary.{outlet} = \"outlet\" keeps the gas of the start beyond it, and the stream of boundary.{inlet} along it changes: \
             gas leaves or enters all along the side; use a far_field of the later stream, or an attenuated_outlet with attenuation 0"
        )
    })
}

/// How a body breaks, for people.
fn breaking_text(b: &Breaking) -> String {
    let [strength, asked, energy, asked_energy] =
        [b.tensile_strength, b.asked_strength, b.fracture_energy, b.asked_energy].map(plain);
    let kept = if b.tensile_strength < b.asked_strength {
        format!(
            "cells are too coarse for both: the energy {energy} J/m^2 is kept, the strength is {strength} instead of {asked} Pa"
        )
    } else if b.fracture_energy > b.asked_energy {
        format!(
            "cells are too coarse for both: the strength {strength} Pa is kept, a crack takes {energy} instead of {asked_energy} J/m^2"
        )
    } else {
        format!("at {strength} Pa with {energy} J/m^2")
    };
    format!(
        "`{}` {kept}; both hold up to cells of {} m; cracks are {} m wide, pieces at least {} m, larger below {} of strain per second",
        b.body,
        plain(b.coarsest_cell),
        plain(b.band),
        plain(b.smallest_piece),
        plain(b.fastest_rate)
    )
}

/// Writes the picture that a run would begin with.
fn draw_start(gpu: &Gpu, scene: &Scene, path: &Path) -> Result<()> {
    let simulation = Simulation::new(gpu, scene)?;
    let mut renderer = Renderer::of(&simulation, scene)?;
    match renderer.render(0.0)?.first() {
        Some(picture) => png::write(path, &picture.frame, &[("Title", scene.title.clone())]),
        None => Ok(()),
    }
}

/// Bytes for people.
pub(super) fn size(bytes: u64) -> String {
    let bytes = bytes as f64;
    match bytes {
        b if b >= 1024.0 * 1024.0 * 1024.0 => format!("{:.2} GiB", b / (1024.0 * 1024.0 * 1024.0)),
        b if b >= 1024.0 * 1024.0 => format!("{:.1} MiB", b / (1024.0 * 1024.0)),
        b => format!("{:.1} KiB", b / 1024.0),
    }
}
