//! The cases, a file for each family. They do not know each other: what several measure stands in [`super::measure`].

mod ablations;
mod athena;
mod blast_2d;
mod blasted_plates;
mod blasts;
mod bow_shocks;
mod buoyancy;
mod charges;
mod clamped;
mod cold;
mod contacts;
mod cracks;
mod cylinders;
mod detonation;
mod drifting;
mod driven;
mod duct;
mod explosions;
mod forward_step;
mod fragments;
mod jet;
mod line_explosion;
mod loaded_walls;
mod open_sides;
mod panel;
mod pistons;
mod plane_flows;
mod plates;
mod pressure_impulse;
mod quiet;
mod riemann_2d;
mod shells;
mod soft_bodies;
mod solids;
mod steady;
mod thin_walls;
mod tubes;
mod two_gases;
mod waves;

use super::harness::{Case, Suite};

/// All cases in the order of the report, those of a group together.
pub fn cases() -> impl Iterator<Item = &'static Case> {
    let lines = [tubes::CASES, athena::CASES, blasts::CASES, waves::CASES];
    let blasts = [blast_2d::CASES, line_explosion::CASES, explosions::CASES, charges::CASES, detonation::CASES];
    let streams = [forward_step::CASES, steady::CASES, bow_shocks::CASES, jet::CASES];
    let coupled = [
        plates::CASES,
        pistons::CASES,
        drifting::CASES,
        driven::CASES,
        panel::CASES,
        shells::CASES,
        cylinders::CASES,
        cold::CASES,
        fragments::CASES,
        thin_walls::CASES,
        soft_bodies::CASES,
        loaded_walls::CASES,
    ];
    let gas = lines.into_iter().chain(blasts).chain(streams).chain([
        duct::CASES,
        riemann_2d::CASES,
        plane_flows::CASES,
        buoyancy::CASES,
        quiet::CASES,
        open_sides::CASES,
        contacts::CASES,
        two_gases::CASES,
    ]);
    let held = [clamped::CASES, blasted_plates::CASES, pressure_impulse::CASES, cracks::CASES];
    let by_file = gas.chain(coupled).chain([solids::CASES]).chain(held).chain([ablations::CASES]).flatten();
    let mut cases: Vec<&Case> = by_file.collect();
    let by_file = cases.clone();
    cases.sort_by_key(|case| by_file.iter().position(|first| first.group == case.group));
    cases.into_iter()
}

/// Cases of a suite whose identifier, title or group contains `filter`, capitals or not.
pub fn select(suite: Suite, filter: &str) -> Vec<&'static Case> {
    let filter = filter.to_lowercase();
    let named =
        |case: &Case| [case.id, case.title, case.group].iter().any(|text| text.to_lowercase().contains(&filter));
    cases().filter(|case| (case.quick || suite == Suite::Full) && named(case)).collect()
}
