//! Gas beside bodies stays as warm as its entropy wants.

use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::common::gpu_or_skip;
use reference::interface::ledger::settled_part;

/// Internal energy over that of entropy 1 at a density.
fn entropy(u: [f64; 5]) -> f64 {
    0.4 * (u[4] - 0.5 * u[1] * u[1] / u[0]) / u[0].powf(1.4)
}

/// A floored cell owes the momentum that the floor took: it does not take it back, for that would undo the floor.
#[test]
fn a_floored_cell_does_not_take_its_momentum_back() {
    let (density, speed) = (0.1_f64, 2.0);
    let internal = 0.9 * density.powf(1.4) / 0.4;
    let floored = [density, density * speed, 0.0, 0.0, internal + 0.5 * density * speed * speed];
    assert!((entropy(floored) - 0.9).abs() < 1e-12);
    let owed = [0.0, 0.02, 0.0, 0.0, 0.0];
    let part = settled_part(floored, owed, 1.0, true, (1.4, 0.9));
    assert!(part * owed[1] < 1e-4 * floored[1], "part {part}");
    // without the rule it would
    assert!(settled_part(floored, owed, 1.0, true, (1.4, 0.0)) > 0.01);
}

/// The scene of `verify`'s case on the device, coarser: no frame has gas below the floor of entropy.
#[test]
fn no_gas_in_the_lee_of_a_disc_is_colder_than_entropy_allows() {
    let Some(gpu) = gpu_or_skip() else { return };
    let overrides = ["domain.cells=[48, 32]".to_owned()];
    let scene = Scene::shipped("validation/held_disc.toml", &overrides).unwrap();
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    for look in 1..=4 {
        simulation.advance_to(0.05 * f64::from(look)).unwrap();
        let snapshot = simulation.snapshot().unwrap();
        let gas = (0..snapshot.kind.len()).filter(|index| snapshot.kind[*index] == brisance::snapshot::kind::GAS);
        let least = gas
            .map(|index| f64::from(snapshot.pressure[index]) / f64::from(snapshot.density[index]).powf(1.4))
            .fold(f64::INFINITY, f64::min);
        assert!(least > 0.89, "look {look}: entropy {least}");
    }
}
