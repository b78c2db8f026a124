//! What becomes of what has broken: rubble bears shear by friction alone, and debris is dropped with its mass, momentum and energy accounted for.

use brisance::diagnostics::StepRecord;
use brisance::expect::Budget;
use brisance::gpu::{Gpu, readback};
use brisance::scene::Scene;
use brisance::simulation::Simulation;
use brisance::snapshot::ParticleSample;

use crate::common::gpu_or_skip;

/// Young's modulus of the ball is 1, Poisson's ratio 0.25, so both Lame constants are this.
const LAME: f64 = 0.4;

/// A brittle ball, half of it broken from the start, that flies askew into the corner of a box.
fn struck(dimension: usize, until: f64, fracture: &str) -> Scene {
    let all = |values: [f64; 3]| values[..dimension].to_vec();
    let (cells, size) = ([24, 24, 12], [2.4, 2.4, 1.2]);
    let text = format!(
        "title = \"struck\"\n[domain]\ndimension = {dimension}\ncells = {:?}\nsize = {:?}\n\
         [gas]\nambient = {{ density = 0.01, pressure = 1e-3 }}\n[time]\nuntil = {until:?}\n\
         [materials.m]\nhencky = {{ young_modulus = 1.0, poisson_ratio = 0.25, yield_stress = 1e3 }}\n\
         fracture = {{ tensile_strength = 1.5e-2, fracture_energy = 6e-5, {fracture} }}\n\
         [[bodies]]\nname = \"ball\"\nmaterial = \"m\"\ndensity = 1.0\nvelocity = {:?}\n\
         shape = {{ sphere = {{ center = {:?}, radius = 0.4 }} }}\n\
         cracks = [{{ half_space = {{ point = {:?}, normal = {:?} }} }}]\n",
        &cells[..dimension],
        &size[..dimension],
        all([-0.05, -0.03, -0.02]),
        all([0.6, 0.7, 0.6]),
        all([0.6, 0.0, 0.0]),
        all([-1.0, 0.0, 0.0]),
    );
    Scene::parse(&text, "struck.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// The state at the end, the records of all steps, and what is missing of momentum and energy, over what the ball had.
fn run(gpu: &Gpu, scene: &Scene) -> (Simulation, Vec<StepRecord>, [f64; 2]) {
    let fail = |error: brisance::Error| -> ! { panic!("{error}") };
    let mut simulation = Simulation::new(gpu, scene).unwrap_or_else(|error| fail(error));
    let before = Budget::read(&simulation, scene, 0.0).unwrap_or_else(|error| fail(error));
    let records = simulation.advance_to(scene.time.until).unwrap_or_else(|error| fail(error));
    let last = &records[records.len() - 1];
    let stored = [last.elastic_energy, last.plastic_heat, last.fracture_energy, last.gone_energy].map(f64::from);
    let after = Budget::read(&simulation, scene, stored.iter().sum()).unwrap_or_else(|error| fail(error));
    let missing = after.over(&before);
    let (mass, speed) = (before.solid_mass, (0.05_f64.powi(2) + 0.03_f64.powi(2)).sqrt());
    let momentum = missing.momentum.iter().map(|part| part * part).sum::<f64>().sqrt() / (mass * speed);
    (simulation, records, [momentum, missing.energy / (0.5 * mass * speed * speed)])
}

/// That what is dropped is what no whole particle is near, and that the sums keep it.
fn check_dropped(gpu: &Gpu, dimension: usize, until: f64) {
    let kept = run(gpu, &struck(dimension, until, "debris = \"keep\""));
    let (simulation, records, missing) = run(gpu, &struck(dimension, until, "debris = \"drop\""));
    let last = &records[records.len() - 1];
    // of the other run, in which all stays
    let whole = f64::from(kept.1[0].solid.mass);
    let masses = [last.solid.mass, last.dropped_mass, last.broken_mass].map(|mass| f64::from(mass) / whole);
    println!(
        "{dimension}D: there, dropped, broken {masses:?}; momentum and energy missing {missing:?}, kept {:?}",
        kept.2
    );
    assert!(masses[1] > 0.1 && masses[0] > 0.3, "half was broken, and what lies at the other half stays: {masses:?}");
    assert!((masses[0] + masses[1] - 1.0).abs() < 1e-6, "{masses:?}");
    assert!(records.windows(2).all(|pair| pair[1].dropped_mass >= pair[0].dropped_mass), "what is dropped stays away");
    assert!(missing[0].abs() < 1e-3, "momentum {missing:?}");
    assert!(missing[1].abs() < kept.2[1].abs() + 0.02, "energy {missing:?}, kept {:?}", kept.2);
    assert_eq!(kept.1[kept.1.len() - 1].dropped_mass, 0.0);
    let snapshot = simulation.snapshot().expect("a device");
    let spacing = 0.1;
    let near = |a: [f32; 3], b: [f32; 3]| (0..dimension).all(|axis| (a[axis] - b[axis]).abs() < 2.1 * spacing);
    let (broken, sound): (Vec<&ParticleSample>, Vec<&ParticleSample>) =
        snapshot.particles.iter().partition(|own| own.damage >= 1.0);
    assert!(!broken.is_empty() && !sound.is_empty(), "{} broken, {} whole", broken.len(), sound.len());
    let alone = broken.iter().filter(|own| sound.iter().all(|other| !near(own.position, other.position))).count();
    assert_eq!(alone, 0, "of {} broken ones have no whole one within two cells", broken.len());
}

#[test]
fn dropped_debris_takes_its_mass_momentum_and_energy_along() {
    let Some(gpu) = gpu_or_skip() else { return };
    check_dropped(&gpu, 2, 5.0);
    check_dropped(&gpu, 3, 0.3);
}

/// Length of the deviator over minus the trace of the whole Kirchhoff stress, of particles that have crumbled and of other broken ones that
/// are pressed.
fn slopes(gpu: &Gpu, simulation: &Simulation, ambient: f64) -> [Vec<f64>; 2] {
    let all = &simulation.state.particles;
    let get = |buffer| readback::read(gpu, buffer).expect("a device");
    let (velocity, affine) = (get(&all.velocity), get(&all.affine));
    let (stress, deformation) = (get(&all.stress), get(&all.deformation));
    let mut found = [Vec::new(), Vec::new()];
    for p in (0..all.count as usize).filter(|&p| deformation[3 * p + 1][3] > 0.0 && deformation[3 * p + 2][3] >= 1.0) {
        let f = |k: usize| glam::Vec3::from_slice(&deformation[3 * p + k]) + glam::Vec3::AXES[k];
        let volume = f64::from(glam::Mat3::from_cols(f(0), f(1), f(2)).determinant());
        let own = |row: usize, k: usize| f64::from(stress[2 * p + row][k]) / f64::from(velocity[p][3]);
        let press = volume * (f64::from(affine[3 * p][3]) - ambient);
        let [xx, yy, zz] = [0, 1, 2].map(|k| own(0, k) - press);
        let (trace, off) = (xx + yy + zz, [0, 1, 2].map(|k| own(1, k)));
        let deviator = [xx, yy, zz].iter().map(|s| (s - trace / 3.0).powi(2)).sum::<f64>()
            + 2.0 * off.iter().map(|s| s * s).sum::<f64>();
        if trace < -1e-4 * LAME {
            let crumbled = affine[3 * p + 2][3].to_bits() >> 31 == 1;
            found[usize::from(!crumbled)].push(deviator.sqrt() / -trace);
        }
    }
    found
}

/// Mohr and Coulomb's cone of 35 degrees in triaxial compression.
fn cone() -> f64 {
    let sine = 35.0_f64.to_radians().sin();
    2.0 * (2.0_f64 / 3.0).sqrt() * sine / (3.0 - sine)
}

/// A broken ball swells, and what is left of it falls to the floor.
fn heap(rubble: bool) -> Scene {
    let text = format!(
        "title = \"heap\"\ngravity = [0.0, -0.02]\n[domain]\ndimension = 2\ncells = [24, 12]\nsize = [2.4, 1.2]\n\
         [gas]\nambient = {{ density = 0.01, pressure = 1e-3 }}\n[time]\nuntil = 12.0\n\
         [materials.m]\nhencky = {{ young_modulus = 1.0, poisson_ratio = 0.25, yield_stress = 1e3 }}\n\
         fracture = {{ tensile_strength = 2e-3, fracture_energy = 1e-6, rubble = {rubble} }}\n\
         [[bodies]]\nname = \"ball\"\nmaterial = \"m\"\ndensity = 1.0\nexpansion = 0.1\n\
         shape = {{ sphere = {{ center = [1.2, 0.45], radius = 0.35 }} }}\n\
         cracks = [{{ sphere = {{ center = [1.2, 0.45], radius = 0.5 }} }}]\n"
    );
    Scene::parse(&text, "heap.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// Largest of what particles bear in shear over the cone, of those that have crumbled and of others that have broken; and how many they are.
fn largest_shear(gpu: &Gpu, rubble: bool) -> ([f64; 2], [usize; 2]) {
    let scene = heap(rubble);
    let mut simulation = Simulation::new(gpu, &scene).unwrap_or_else(|error| panic!("{error}"));
    let (mut most, mut count) = ([0.0_f64; 2], [0; 2]);
    for part in 1..=6 {
        let time = scene.time.until * f64::from(part) / 6.0;
        simulation.advance_to(time).unwrap_or_else(|error| panic!("{error}"));
        for (kind, found) in slopes(gpu, &simulation, 1e-3).into_iter().enumerate() {
            count[kind] += found.len();
            most[kind] = found.into_iter().fold(most[kind], |most, slope| most.max(slope / cone()));
        }
    }
    println!("rubble {rubble}: shear over that of the cone {most:?}, of {count:?} pressed particles");
    (most, count)
}

#[test]
fn rubble_bears_shear_by_friction_alone() {
    let Some(gpu) = gpu_or_skip() else { return };
    let ([sand, _], [crumbled, _]) = largest_shear(&gpu, true);
    assert!(crumbled > 20, "{crumbled} have crumbled and are pressed");
    assert!(sand < 1.01, "{sand} of what the cone allows");
    let ([_, solid], [none, broken]) = largest_shear(&gpu, false);
    assert!(none == 0 && broken > 20, "nothing crumbles unasked: {none}, {broken}");
    assert!(solid > 1.2, "a closed crack bears more than friction gives: {solid}");
}
