//! Contacts that drift keep the pressure even, however much denser one side is.

use brisance::gpu::Gpu;
use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::common::gpu_or_skip;

/// Largest |p - 1| over all steps in which a slab of a density drifts at a speed.
fn largest(gpu: &Gpu, density: f64, speed: f64, more: &[&str]) -> f64 {
    let mut overrides = vec![
        format!("gas.regions[0].density={density:?}"),
        format!("gas.regions[0].velocity=[{speed:?}]"),
        format!("gas.ambient.velocity=[{speed:?}]"),
    ];
    overrides.extend(more.iter().map(|text| (*text).to_owned()));
    let scene = Scene::shipped("validation/drifting_contact.toml", &overrides).unwrap();
    let mut simulation = Simulation::new(gpu, &scene).unwrap();
    let records = simulation.advance_to(0.4 / speed.max(0.4)).unwrap();
    records.iter().map(|r| f64::from((r.pressure[1] - 1.0).max(1.0 - r.pressure[0]))).fold(0.0, f64::max)
}

#[test]
fn a_drifting_contact_keeps_its_pressure() {
    let Some(gpu) = gpu_or_skip() else { return };
    let cases: [(f64, f64, &[&str], f64); 6] = [
        (1000.0, 1.0, &["numerics.integrator=predictor"], 5e-4),
        (1000.0, 1.0, &["numerics.integrator=ars222"], 5e-4),
        (1000.0, 0.1, &["numerics.integrator=predictor"], 5e-5),
        (1000.0, 0.1, &["numerics.integrator=predictor", "time.max_courant=3.0"], 5e-5),
        (10.0, 1.0, &["numerics.integrator=predictor"], 1e-5),
        (10.0, 1.0, &["numerics.integrator=ars222"], 1e-5),
    ];
    let mut failures = Vec::new();
    for (density, speed, more, bound) in cases {
        let off = largest(&gpu, density, speed, more);
        eprintln!("{density} : 1, speed {speed}, {more:?}: {off:.2e}");
        if off > bound || off.is_nan() {
            failures.push(format!("{density} : 1, speed {speed}, {more:?}: {off:.2e} above {bound}"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
