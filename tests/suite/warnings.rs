//! The program's own verdict: what it warns of, and that the budgets behind it close.

use brisance::expect::{self, Budget, Summary};
use brisance::render::{Renderer, SceneBuffers};
use brisance::scene::{Field, Scene};
use brisance::simulation::Simulation;
use brisance::snapshot::kind;

use crate::cli::{err, report, run};
use crate::common::{folder_or_skip, gpu_or_skip};

#[test]
fn the_table_of_the_docs_is_that_of_the_program() {
    let docs = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/inside/warnings.md")).unwrap();
    assert!(docs.contains(&expect::table()), "docs/inside/warnings.md must hold this table:\n{}", expect::table());
}

/// A block that flies out on the right through thin gas.
const LEAVING: &str = "title = \"leaving\"\n[domain]\ndimension = 2\ncells = [16, 8]\nsize = [1.6, 0.8]\n\
    [boundary]\nx_max = { pressure_outlet = { pressure = 0.01 } }\n[gas]\nambient = { density = 0.01, pressure = 0.01 }\n\
    [materials.jelly]\nneo_hookean = { young_modulus = 10.0, poisson_ratio = 0.3 }\n\
    [[bodies]]\nname = \"block\"\nmaterial = \"jelly\"\ndensity = 1.0\nvelocity = [2.0, 0.0]\n\
    shape = { box = { center = [1.2, 0.4], size = [0.3, 0.3] } }\n[time]\nuntil = 0.6\nframes = 1\n";

#[test]
fn a_body_that_leaves_is_told_and_the_budgets_keep_what_it_took() {
    let Some(folder) = folder_or_skip() else { return };
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let go = |name: &str, text: &str, more: &[&str]| {
        std::fs::write(path(&format!("{name}.toml")), text).unwrap();
        let (scene, out) = (path(&format!("{name}.toml")), path(name));
        let output = run(&[&["run", &scene, "--out", &out, "--no-frames", "--quiet"], more].concat());
        (output.status.code(), err(&output), report(&folder.path().join(name)))
    };
    let (code, text, told) = go("plain", LEAVING, &[]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("warning: lost_bodies = 1") && text.contains("`block`"), "{text}");
    assert_eq!(told["warnings"].as_array().unwrap().len(), 1, "{}", told["warnings"]);
    assert_eq!(told["warnings"][0]["name"], "lost_bodies");
    for (name, most) in [("momentum", 1e-3), ("energy", 0.02), ("gas_mass", 1e-5)] {
        let measured = told["watched"][name].as_f64().unwrap();
        assert!(measured < most, "{name}: {measured}");
    }
    let (code, text, _) = go("strict", LEAVING, &["--strict"]);
    assert_eq!(code, Some(8), "{text}");
    assert!(text.contains("lost_bodies") && text.contains("--strict"), "{text}");
    let expects = format!("{LEAVING}[expect]\nwarnings = {{ lost_bodies = \"it flies out\", owed_gas = \"never\" }}\n");
    let (code, text, told) = go("expected", &expects, &["--strict"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(text.contains("note: lost_bodies = 1") && text.contains("it flies out"), "{text}");
    assert!(text.contains("note: the scene expects a warning of owed_gas"), "{text}");
    assert_eq!(told["absent_warnings"][0], "owed_gas");
}

/// Gas that gravity sets going in a closed box: the budgets know what gravity gave.
#[test]
fn what_gravity_gives_to_the_gas_is_in_the_budget() {
    let Some(gpu) = gpu_or_skip() else { return };
    let text = "title = \"sloshing\"\ngravity = [0.3, -0.5]\n[domain]\ndimension = 2\ncells = [16, 16]\nsize = [1.0, 1.0]\n\
        [gas]\natmosphere = \"uniform\"\nambient = { density = 1.0, pressure = 1.0 }\n[time]\nuntil = 0.5\n";
    let scene = Scene::parse(text, "sloshing.toml", &[]).unwrap();
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    let start = Budget::read(&simulation, &scene, 0.0).unwrap();
    let mut summary = Summary::default();
    summary.add(&simulation.advance_to(0.5).unwrap());
    let end = Budget::read(&simulation, &scene, summary.stored_energy()).unwrap();
    let [x, y, _, work] = simulation.pulled();
    eprintln!("given {x} {y}, work {work}, left {:?} {:e}", end.momentum, end.energy - start.energy);
    assert!((x - 0.15).abs() < 1e-5 && (y + 0.25).abs() < 1e-5 && work > 0.01, "{x} {y} {work}");
    assert!((end.energy - start.energy).abs() < 1e-3 * work, "{:e} of {work:e}", end.energy - start.energy);
    for axis in 0..2 {
        assert!((end.momentum[axis] - start.momentum[axis]).abs() < 1e-5, "{:?}", end.momentum);
    }
}

/// Pictures of owed gas and entropy show the numbers of the snapshot, and these are those of the budgets.
#[test]
fn owed_gas_and_entropy_are_fields() {
    let Some(gpu) = gpu_or_skip() else { return };
    let scene = Scene::parse(LEAVING, "leaving.toml", &["render.size=[64,48]".to_owned()]).unwrap();
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    let records = simulation.advance_to(0.1).unwrap();
    let last = records.last().unwrap();
    let now = simulation.snapshot().unwrap();
    let volume = now.grid.spacing.powi(2);
    let sum: f32 = now.owed.iter().map(|owed| owed * volume).sum();
    let either: f32 = now.owed.iter().map(|owed| owed.abs() * volume).sum();
    assert!(either > 1e-5 && (sum - last.owed.mass).abs() < 1e-3 * either, "{sum} {:?} {either}", last.owed);
    assert!((either / last.owed_either - 1.0).abs() < 1e-3, "{either} {}", last.owed_either);
    let gas = |cell: &usize| now.kind[*cell] == kind::GAS;
    let entropy = |cell: usize| now.pressure[cell] * now.density[cell].powf(-1.4);
    let entropies: Vec<f32> = (0..now.kind.len()).filter(gas).map(entropy).collect();
    let least = entropies.iter().copied().fold(f32::INFINITY, f32::min);
    assert!((least / last.min_entropy - 1.0).abs() < 1e-4, "{least} {}", last.min_entropy);
    let place = now.grid.cell(last.coldest_slot);
    assert!((entropy((place[0] + 16 * place[1]) as usize) / least - 1.0).abs() < 1e-4, "{place:?}");
    let mut renderer = Renderer::new(&gpu, &scene, &SceneBuffers::of(&simulation.state)).unwrap();
    for (field, values) in [(Field::Owed, &now.owed), (Field::Entropy, &entropies)] {
        let [low, high] = values.iter().fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], x| [a.min(*x), b.max(*x)]);
        let range = renderer.draw(&scene.own_look(), field, 0.1).unwrap().range;
        let width = f64::from(high - low);
        let off = (range[0] - f64::from(low)).abs().max((range[1] - f64::from(high)).abs());
        assert!(off < 1e-3 * width, "{}: {range:?}, not {low} to {high}", field.keyword());
    }
}

/// The window's mark: nothing while all is well, the lost body at the end.
#[cfg(feature = "viewer")]
#[test]
fn the_window_knows_what_a_run_is_warned_of() {
    let Some(gpu) = gpu_or_skip() else { return };
    let scene = Scene::parse(LEAVING, "leaving.toml", &[]).unwrap();
    let mut session = brisance::viewer::session::Session::open(&gpu, scene).unwrap();
    let mut records = Vec::new();
    session.advance(1, &mut records).unwrap();
    assert!(session.unexpected().is_empty(), "{:?}", session.unexpected());
    while !session.finished() {
        session.advance(16, &mut records).unwrap();
    }
    let told = session.unexpected();
    assert!(told.len() == 1 && told[0].starts_with("lost_bodies"), "{told:?}");
}
