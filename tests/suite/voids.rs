//! Metals that break by voids: a bar with a waist that is pulled until it parts, and one that is pressed.

use std::f64::consts::PI;

use brisance::scene::Scene;
use brisance::simulation::Simulation;
use brisance::snapshot::{ParticleSample, Snapshot};

use crate::common::gpu_or_skip;

/// Yield stress of a rod over Young's modulus.
const YIELD: f64 = 1e-3;
/// Width of the bar over its length, which is 1, and of its waist.
const WIDTH: f64 = 0.2;
const WAIST: f64 = 0.14;
/// By how much the grips part or come closer, and in which time.
const WAY: f64 = 0.012;
const TIME: f64 = 80.0;
/// Plastic strain at which voids join, whatever the tension.
const STRAIN: f64 = 0.02;

/// A bar between grips that part; with a minus that come closer.
fn scene(sign: f64) -> Scene {
    let material = |name: &str, law: &str, rest: &str| {
        format!("[materials.{name}]\n{law} = {{ young_modulus = 1.0, poisson_ratio = 0.3{rest}\n")
    };
    // the deviator of a rod has the length sqrt(2/3) of its stress
    let flow = YIELD * (2.0_f64 / 3.0).sqrt();
    let grip = |name: &str, x: f64, sign: f64| {
        format!(
            "[[bodies]]\nname = \"{name}\"\nmaterial = \"grip\"\ndensity = 1.0\n\
             shape = {{ box = {{ center = [{x:?}, 0.25], size = [0.1, {WIDTH:?}] }} }}\nmotion = {{ velocity = [{:?}, 0.0] }}\n",
            sign * 0.5 * WAY / TIME
        )
    };
    let text = format!(
        "title = \"waist\"\n[domain]\ndimension = 2\ncells = [32, 10]\nsize = [1.6, 0.5]\n\
         [gas]\nambient = {{ density = 1e-6, pressure = 1e-10 }}\n[time]\nuntil = {TIME:?}\n{}\
         fracture = {{ fracture_energy = {:?}, johnson_cook = {{ d1 = {STRAIN:?}, d2 = 0.0, d3 = 0.0 }} }}\n{}{}{}\
         [[bodies]]\nname = \"bar\"\nmaterial = \"metal\"\ndensity = 1.0\nshape = {{ difference = [\n\
         {{ box = {{ center = [0.8, 0.25], size = [1.0, {WIDTH:?}] }} }},\n\
         {{ sphere = {{ center = [0.8, 0.395], radius = 0.075 }} }}, {{ sphere = {{ center = [0.8, 0.105], radius = 0.075 }} }}] }}\n",
        material("metal", "von_mises", &format!(", yield_stress = {flow:?}, hardening = {flow:?} }}")),
        0.5 * 0.004 * YIELD,
        material("grip", "neo_hookean", " }"),
        grip("left", 0.25, -sign),
        grip("right", 1.35, sign),
    );
    Scene::parse(&text, "waist.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn bar(snapshot: &Snapshot) -> impl Iterator<Item = &ParticleSample> {
    snapshot.particles.iter().filter(|particle| particle.body == 2)
}

fn largest(snapshot: &Snapshot, of: fn(&ParticleSample) -> f32) -> f64 {
    bar(snapshot).map(of).fold(0.0, f32::max).into()
}

/// Force through the bar over the yield stress and the section of the waist.
fn force(snapshot: &Snapshot) -> f64 {
    let aside = bar(snapshot).filter(|own| (0.22..0.38).contains(&(f64::from(own.position[0]) - 0.8).abs()));
    let (sum, volume) = aside.fold((0.0, 0.0), |(sum, volume), own| {
        let size = f64::from(own.volume0 * own.volume_ratio());
        (sum + size * f64::from(own.stress[0]), volume + size)
    });
    sum / volume * WIDTH / (WAIST * YIELD)
}

/// The bar bears what plasticity lets a notched bar bear, opens voids from the strain of the law on, parts, and loses as much energy as its
/// grips give to it.
#[test]
fn a_bar_tears_at_its_waist() {
    const PARTS: u32 = 50;
    let Some(gpu) = gpu_or_skip() else { return };
    let mut simulation = Simulation::new(&gpu, &scene(1.0)).unwrap_or_else(|error| panic!("{error}"));
    let (mut peak, mut before, mut work, mut onset, mut books) = (0.0_f64, 0.0, 0.0, f64::NAN, 0.0);
    for part in 1..=PARTS {
        let records =
            simulation.advance_to(TIME * f64::from(part) / f64::from(PARTS)).unwrap_or_else(|error| panic!("{error}"));
        let snapshot = simulation.snapshot().expect("a device");
        let pull = force(&snapshot);
        work += 0.5 * (before + pull) * WAY / f64::from(PARTS);
        (before, peak) = (pull, peak.max(pull));
        if onset.is_nan() && largest(&snapshot, |own| own.damage) > 0.0 {
            onset = largest(&snapshot, |own| own.plastic_strain);
        }
        if let Some(last) = records.last() {
            let [kinetic, rest] = [last.solid.energy, last.elastic_energy + last.ghost_energy].map(f64::from);
            books = (kinetic + rest + f64::from(last.plastic_heat) + f64::from(last.fracture_energy)) / (WAIST * YIELD);
        }
    }
    let snapshot = simulation.snapshot().expect("a device");
    eprintln!("largest force {peak}, at the end {before}, work {work}, books {books}, onset at {onset}");
    // Prandtl's plane strain and the constraint of a shallow notch
    let smooth = 2.0 / 3.0_f64.sqrt();
    assert!((smooth..smooth * (1.0 + 0.25 * PI)).contains(&peak), "largest force {peak}");
    assert!((STRAIN..2.0 * STRAIN).contains(&onset), "plastic strain at the first damage {onset}");
    assert!(before < 0.15, "force at the end {before}");
    assert!((0.93..1.02).contains(&(books / work)), "energy of the books over the work of the grips: {}", books / work);
    let far =
        bar(&snapshot).filter(|own| own.damage >= 1.0).map(|own| (own.position[0] - 0.8).abs()).fold(0.0, f32::max);
    assert!(far > 0.0 && far < 0.1, "broken up to {far} from the waist");
}

/// Pressed it flows as far, and no void grows.
#[test]
fn no_void_grows_under_pressure() {
    let Some(gpu) = gpu_or_skip() else { return };
    let mut simulation = Simulation::new(&gpu, &scene(-1.0)).unwrap_or_else(|error| panic!("{error}"));
    simulation.advance_to(TIME).unwrap_or_else(|error| panic!("{error}"));
    let snapshot = simulation.snapshot().expect("a device");
    let flow = largest(&snapshot, |own| own.plastic_strain);
    assert!(flow > STRAIN, "plastic strain {flow}");
    assert_eq!(largest(&snapshot, |own| own.damage), 0.0);
}
