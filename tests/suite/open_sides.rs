//! What outlets remember: the gas that lay at the side at the start comes back when the waves have gone.

use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::common::gpu_or_skip;

/// Gas of density 1 and pressure 1 with a ball of radius 0.2 at a pressure, in the middle of open sides or in a corner of two walls.
fn blast(cells: &[u32], pressure: f64, corner: bool, ambient: &str) -> Scene {
    let names = ["x_min", "x_max", "y_min", "y_max"];
    let rule = |name: &&str| if corner && name.ends_with("min") { "\"wall\"" } else { "\"outlet\"" };
    let sides: Vec<String> = names[..2 * cells.len()].iter().map(|name| format!("{name} = {}", rule(name))).collect();
    let (size, center) = (vec![1.0; cells.len()], vec![if corner { 0.0 } else { 0.5 }; cells.len()]);
    let text = format!(
        "title = \"blast\"\n[domain]\ndimension = {}\ncells = {cells:?}\nsize = {size:?}\n[gas]\nambient = {{ {ambient} }}\n\
         [[gas.regions]]\nshape = {{ sphere = {{ center = {center:?}, radius = 0.2 }} }}\ndensity = 1.0\npressure = {pressure:?}\n\
         [boundary]\n{}\n[time]\nuntil = 4.23\n",
        cells.len(),
        sides.join("\n"),
    );
    Scene::parse(&text, "open_sides.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// Least and largest pressure after five sound crossings of the domain.
fn range_at_the_end(scene: &Scene) -> Option<(f32, f32)> {
    let gpu = gpu_or_skip()?;
    let mut simulation = Simulation::new(&gpu, scene).unwrap();
    simulation.advance_to(scene.time.until).unwrap_or_else(|error| panic!("{error}"));
    let after = simulation.snapshot().unwrap();
    let range = |(low, high): (f32, f32), p: &f32| (low.min(*p), high.max(*p));
    Some(after.pressure.iter().fold((f32::MAX, f32::MIN), range))
}

#[test]
fn a_blast_leaves_the_pressure_of_the_start() {
    for (pressure, corner) in [(2.0, false), (10.0, false), (10.0, true), (100.0, false), (100.0, true)] {
        let Some((low, high)) = range_at_the_end(&blast(&[100], pressure, corner, "density = 1.0, pressure = 1.0"))
        else {
            return;
        };
        eprintln!("blast of {pressure}, corner {corner}: {low} to {high}");
        assert!(low > 0.99 && high < 1.01, "blast of {pressure}, corner {corner}: {low} to {high}");
    }
}

#[test]
fn a_blast_in_the_plane_leaves_the_pressure_of_the_start() {
    for (pressure, corner) in [(2.0, true), (100.0, false)] {
        let ambient = "density = 1.0, pressure = 1.0";
        let Some((low, high)) = range_at_the_end(&blast(&[32, 32], pressure, corner, ambient)) else { return };
        eprintln!("blast of {pressure}, corner {corner}: {low} to {high}");
        assert!(low > 0.99 && high < 1.01, "blast of {pressure}, corner {corner}: {low} to {high}");
    }
}

/// Each side remembers what lies at it: two states in equilibrium, and each row its own height.
#[test]
fn outlets_remember_their_own_states() {
    let text = "title = \"sides\"\ngravity = [0.0, -1.0]\n[domain]\ndimension = 2\ncells = [8, 4]\nsize = [2.0, 1.0]\n\
                [gas]\nambient = { density = 1.0, pressure = 10.0 }\n\
                [[gas.regions]]\nshape = { half_space = { point = [1.0, 0.0], normal = [1.0, 0.0] } }\n\
                density = 2.0\npressure = 10.0\n[boundary]\nx_min = \"outlet\"\nx_max = \"outlet\"\n[time]\nuntil = 0.1\n";
    let scene = Scene::parse(text, "sides.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let states = scene.remembered().states;
    assert_eq!(states.len(), 5, "the region on one side, four heights on the other: {states:?}");
    assert_eq!(scene.gas_beyond(0, [0, 2, 0]).density, 2.0);
    let there = scene.gas_beyond(1, [7, 2, 0]);
    assert!((there.pressure / (10.0 * (-0.625f64 / 10.0).exp()) - 1.0).abs() < 1e-12, "{there:?}");
    assert!((there.density / there.pressure - 0.1).abs() < 1e-12, "isothermal: {there:?}");
}

/// An atmosphere of one entropy stays one under the law p = K rho^gamma, and weight balances the pressure.
#[test]
fn atmospheres_are_in_balance() {
    for law in ["isothermal", "isentropic"] {
        let text = format!(
            "title = \"air\"\ngravity = [0.0, -9.81]\n[domain]\ndimension = 2\ncells = [4, 1000]\nsize = [4.0, 1000.0]\n\
             [gas]\natmosphere = \"{law}\"\nambient = {{ density = 1.225, pressure = 101325.0 }}\n[time]\nuntil = 0.1\n"
        );
        let scene = Scene::parse(&text, "air.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
        let (low, middle, high) = (
            scene.ambient_at([0.5, 499.0, 0.0]),
            scene.ambient_at([0.5, 500.0, 0.0]),
            scene.ambient_at([0.5, 501.0, 0.0]),
        );
        let slope = (high.pressure - low.pressure) / 2.0;
        assert!((slope / (-9.81 * middle.density) - 1.0).abs() < 1e-7, "{law}: {slope}");
        let kept = if law == "isothermal" { 1.0 } else { 1.4 };
        let entropy = middle.pressure / middle.density.powf(kept) * 1.225f64.powf(kept) / 101_325.0;
        assert!((entropy - 1.0).abs() < 1e-12, "{law}: {entropy}");
        assert_eq!(scene.ambient_at([0.0; 3]), scene.gas.ambient);
    }
}

/// Whatever sides are open, air in balance keeps still: what the solve moves beside them is what it weighs there.
#[test]
fn still_air_stays_still() {
    let Some(gpu) = gpu_or_skip() else { return };
    let air = |dimension: usize, open: &[&str], until: f64| {
        let (cells, size) = (vec![if dimension == 2 { 16 } else { 8 }; dimension], vec![100.0; dimension]);
        let mut gravity = vec![0.0; dimension];
        gravity[1] = -9.81;
        let sides: Vec<String> = open.iter().map(|side| format!("{side} = \"outlet\"")).collect();
        let text = format!(
            "title = \"air\"\ngravity = {gravity:?}\n[domain]\ndimension = {dimension}\ncells = {cells:?}\nsize = {size:?}\n\
             [gas]\nambient = {{ density = 1.225, pressure = 101325.0 }}\n[boundary]\n{}\n[time]\nuntil = {until:?}\nmax_courant = 4.0\n[numerics]\ntolerance = 1e-7\n",
            sides.join("\n")
        );
        Scene::parse(&text, "air.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
    };
    for (dimension, open, until) in [
        (2, &["x_min", "x_max", "y_max"][..], 20.0),
        (2, &["x_max", "y_min", "y_max"], 5.0),
        (2, &["x_min", "x_max"], 20.0),
        (3, &["x_min", "x_max", "y_max", "z_max"], 2.0),
    ] {
        let mut simulation = Simulation::new(&gpu, &air(dimension, open, until)).unwrap();
        let records = simulation.advance_to(until).unwrap_or_else(|error| panic!("{error}"));
        let most = records.iter().map(|record| record.gas_speed).fold(0.0, f32::max);
        eprintln!("{dimension}D, {open:?}: {most} m/s");
        assert!(most < 0.01, "{dimension}D, {open:?}: {most} m/s");
    }
}
