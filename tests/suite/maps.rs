//! Maps of the largest pressure, the impulse and the largest plastic strain so far: against a book of all steps, and in pictures and files.

use brisance::scene::Scene;
use brisance::simulation::Simulation;
use brisance::snapshot::kind;

use crate::cli::{SmallRun, fails, small_run, succeeds};
use crate::common::gpu_or_skip;

/// A shock beats a block of soft metal, which yields.
const TEXT: &str = "title = \"maps\"\n[domain]\ndimension = 2\ncells = [32, 16]\nsize = [2.0, 1.0]\n\
    [[gas.regions]]\nshape = { half_space = { point = [0.6, 0.0], normal = [1.0, 0.0] } }\ndensity = 3.0\npressure = 4.0\n\
    [gas]\nambient = { density = 1.0, pressure = 1.0 }\n[time]\nuntil = 0.4\n\
    [materials.lead.von_mises]\nyoung_modulus = 100.0\npoisson_ratio = 0.3\nyield_stress = 0.05\n\
    [[bodies]]\nname = \"block\"\nmaterial = \"lead\"\ndensity = 2.0\nshape = { box = { center = [1.0, 0.45], size = [0.4, 0.3] } }\n";

fn simulation(maps: bool) -> Option<Simulation> {
    let gpu = gpu_or_skip()?;
    let scene =
        Scene::parse(TEXT, "maps.toml", &[format!("output.maps={maps}")]).unwrap_or_else(|error| panic!("{error}"));
    Some(Simulation::new(&gpu, &scene).unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn maps_hold_the_largest_of_all_steps() {
    let Some(mut simulation) = simulation(true) else { return };
    let first = simulation.snapshot().unwrap();
    let cells = first.kind.len();
    let gas = |kinds: &[u8], i: usize| kinds[i] == kind::GAS;
    let mut peak: Vec<f32> = (0..cells).map(|i| if gas(&first.kind, i) { first.pressure[i] } else { 0.0 }).collect();
    let (mut impulse, mut strain) = (vec![0.0f64; cells], vec![0.0f32; cells]);
    simulation.set_target(0.4).unwrap();
    let (mut records, mut seen) = (Vec::new(), 0);
    while !simulation.advance_batch_of(&mut records, 1).unwrap() {
        let state = simulation.snapshot().unwrap();
        if state.step == seen {
            continue; // a step that goes on in the next recording
        }
        seen = state.step;
        let dt = f64::from(records.last().unwrap().dt);
        for i in (0..cells).filter(|i| gas(&state.kind, *i)) {
            peak[i] = peak[i].max(state.pressure[i]);
            impulse[i] += dt * f64::from((state.pressure[i] - 1.0).max(0.0));
        }
        for particle in &state.particles {
            let cell = state.cell_at(particle.position.map(f64::from)).unwrap();
            strain[cell] = strain[cell].max(particle.plastic_strain);
        }
        if state.step == 15 {
            break;
        }
    }
    let end = simulation.snapshot().unwrap();
    assert_eq!((end.step, end.maps.len()), (15, cells));
    for i in (0..cells).filter(|i| end.kind[*i] != kind::SOLID || peak[*i] > 0.0) {
        let [own_peak, own_impulse, _] = end.maps[i];
        assert!((own_peak - peak[i]).abs() <= 2e-6 * peak[i], "cell {i}: {own_peak}, not {}", peak[i]);
        let gap = (f64::from(own_impulse) - impulse[i]).abs();
        assert!(gap <= 1e-5 * impulse[i] + 1e-7, "cell {i}: {own_impulse}, not {}", impulse[i]);
    }
    let own: Vec<f32> = end.maps.iter().map(|map| map[2]).collect();
    assert_eq!(own, strain);
    let most = |values: &[f32]| values.iter().copied().fold(0.0, f32::max);
    let past = (0..cells).filter(|i| gas(&end.kind, *i) && peak[*i] > 1.1 * end.pressure[*i]).count();
    let seen = (most(&strain), past, impulse.iter().copied().fold(0.0, f64::max));
    assert!(seen.0 > 1e-3 && seen.1 > 10 && seen.2 > 0.1, "nothing happened: {seen:?}");
    assert!(end.cell_field("impulse").is_some());
}

#[test]
fn maps_move_no_bit() {
    let (Some(mut with), Some(mut without)) = (simulation(true), simulation(false)) else { return };
    for simulation in [&mut with, &mut without] {
        simulation.advance_to(0.1).unwrap();
    }
    let (mut one, two) = (with.snapshot().unwrap(), without.snapshot().unwrap());
    assert!(two.maps.is_empty() && two.cell_field("impulse").is_none());
    one.maps.clear();
    assert!(format!("{one:?}") == format!("{two:?}"));
}

/// Pictures of maps are drawn again from states to the byte, and other programs get them.
#[test]
fn maps_are_in_pictures_and_files() {
    let Some(SmallRun { scene, out, folder }) = small_run() else { return };
    let target = out.to_str().unwrap();
    let fields = ["--set", "output.fields=[\"peak_pressure\", \"impulse\", \"peak_plastic_strain\"]"];
    let base = [&["run", &scene, "--no-expect", "--export", "states,npz,vtk"][..], &fields].concat();
    succeeds(&[&base[..], &["--checkpoint", "4steps", "--out", target]].concat());
    succeeds(&["render", target]);
    for name in ["0002.png", "impulse/0002.png", "peak_plastic_strain/0001.png"] {
        let read = |place: &str| std::fs::read(out.join(place).join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(read("frames") == read("again/frames"), "{name}");
    }
    let bytes = std::fs::read(out.join("arrays/0002.npz")).unwrap();
    assert!(bytes.windows(17).any(|part| part == b"peak_pressure.npy"));
    let text = String::from_utf8_lossy(&std::fs::read(out.join("fields/0002.vti")).unwrap()).into_owned();
    assert!(text.contains("Name=\"impulse\""));
    // a run that keeps none
    let plain = folder.path().join("plain");
    let plain = plain.to_str().unwrap();
    succeeds(&["run", &scene, "--no-expect", "--export", "states", "--checkpoint", "4steps", "--out", plain]);
    let said = fails(2, &["render", plain, "--field", "impulse"]);
    assert!(said.contains("has no map of impulse"), "{said}");
    let branch = format!("{plain}@0.02");
    let said = fails(2, &["run", "--branch", &branch, "--set", "output.maps=true", "--until", "0.03", "--frames", "3"]);
    assert!(said.contains("maps of the largest values begin with the run"), "{said}");
}
