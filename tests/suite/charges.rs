//! Charges: what they give to the gas, when, and what is not taken for one.

use brisance::expect::Budget;
use brisance::scene::{Charge, Scene};
use brisance::simulation::{Saved, Simulation};

use crate::common::gpu_or_skip;

/// Arrays that are the gas.
const GAS: [&str; 2] = ["conserved", "energy"];
/// Energy of detonation of TNT [J kg^-1].
const TNT: f64 = 7.0e9 / 1630.0;

fn scene(dimension: usize, more: &str) -> Scene {
    let list = |value: f64| vec![format!("{value:?}"); dimension].join(", ");
    let text = format!(
        "title = \"charge\"\n[domain]\ndimension = {dimension}\ncells = [{}]\nsize = [{}]\n[gas]\nambient = {{ air = {{}} }}\n\
         [[charges]]\nname = \"c\"\nexplosive = \"tnt\"\nmass = 0.5\ncenter = [{}]\ntime = 1e-4\n[time]\nuntil = 0.004\n{more}",
        vec!["24"; dimension].join(", "),
        list(2.4),
        list(1.2)
    );
    Scene::parse(&text, "charge.toml", &[] as &[String]).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn mass_and_energy_grow_by_those_of_the_charge() {
    let Some(gpu) = gpu_or_skip() else { return };
    // a pole of an obstacle beside the charge, which cuts cells
    let pole = "[[obstacles]]\nname = \"pole\"\nshape = { sphere = { center = [1.6, 1.25], radius = 0.21 } }\n";
    for (dimension, more) in [(1, ""), (2, ""), (2, pole), (3, "")] {
        let scene = scene(dimension, more);
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        let before = Budget::read(&simulation, &scene, 0.0).unwrap();
        simulation.advance_to(0.9e-4).unwrap();
        assert_eq!(simulation.released().count, 0, "{dimension}: its time has not come");
        simulation.advance_to(2e-3).unwrap();
        let released = simulation.released();
        assert_eq!(released.count, 1, "{dimension}");
        assert!((released.mass / 0.5 - 1.0).abs() < 1e-6, "{dimension}: {released:?}");
        // of the gas with the speed of sound, about
        let scale = 340.0 * (released.mass + before.gas_mass);
        let tilt = released.momentum.iter().map(|p| p.abs()).fold(0.0, f64::max) / scale;
        assert!(!more.is_empty() || tilt < 1e-6, "{dimension}: {released:?}");
        assert!((simulation.blasts() / (0.5 * TNT) - 1.0).abs() < 1e-6, "{dimension}: {}", simulation.blasts());
        let after = Budget::read(&simulation, &scene, 0.0).unwrap();
        assert!(((after.gas_mass - before.gas_mass) / 0.5 - 1.0).abs() < 1e-5, "{dimension}: {after:?}");
        let drift = after.drift_since(&before);
        assert!(drift["gas_mass"].abs() < 1e-6 && drift["energy"].abs() < 1e-5, "{dimension}: {drift:?}");
    }
}

#[test]
fn products_are_a_second_gas_where_the_charge_says_so() {
    let Some(gpu) = gpu_or_skip() else { return };
    for dimension in 1..=3 {
        let text = toml::to_string(&scene(dimension, "")).unwrap();
        let set = ["gas.species.products.gamma=1.3".to_owned(), "charges[0].species=\"products\"".to_owned()];
        let scene = Scene::parse(&text, "charge.toml", &set[..]).unwrap_or_else(|error| panic!("{error}"));
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        let records = simulation.advance_to(2e-3).unwrap();
        let held = records.last().unwrap().species_mass;
        // 1e-5: the sum of single precision
        assert!((f64::from(held[0] + held[1]) / 0.5 - 1.0).abs() < 1e-5, "{dimension}: {held:?}");
        let snapshot = simulation.snapshot().unwrap();
        let middle = snapshot.cell_at([1.2; 3]).unwrap();
        assert!(snapshot.mass_fraction_at(middle) > 0.9, "{dimension}: {:?}", snapshot.species[middle]);
        let far = snapshot.cell_at([0.05; 3]).unwrap();
        assert!(snapshot.mass_fraction_at(far).abs() < 1e-4, "{dimension}: {:?}", snapshot.species[far]);
        assert!((simulation.blasts() / (0.5 * TNT) - 1.0).abs() < 1e-6, "{dimension}: {}", simulation.blasts());
    }
}

#[test]
fn a_saved_state_knows_which_charges_have_gone_off() {
    let Some(gpu) = gpu_or_skip() else { return };
    let second = "[[charges]]\nname = \"d\"\nexplosive = \"c4\"\nmass = 0.1\ncenter = [0.6, 0.6]\ntime = 1e-3\n";
    let scene = scene(2, second);
    let mut first = Simulation::new(&gpu, &scene).unwrap();
    first.advance_to(7e-4).unwrap();
    let saved = first.save().unwrap();
    assert_eq!(first.released().count, 1);
    let mut second = Simulation::new(&gpu, &scene).unwrap();
    second.restore(&saved).unwrap();
    for simulation in [&mut first, &mut second] {
        simulation.advance_to(2e-3).unwrap();
        assert_eq!(simulation.released().count, 2);
    }
    // scratch of the last submission may differ where its length follows the clock
    let [first, second] = [first.save().unwrap(), second.save().unwrap()];
    let gas =
        |saved: &Saved| saved.arrays.iter().filter(|array| GAS.contains(&&*array.name)).cloned().collect::<Vec<_>>();
    assert_eq!(
        (first.time, first.step, &first.host, gas(&first)),
        (second.time, second.step, &second.host, gas(&second))
    );
    assert_eq!(gas(&first).len(), GAS.len());
}

#[test]
fn what_is_no_charge_is_refused() {
    for (set, told) in [
        ("charges[0].explosive=\"tmt\"", "did you mean `tnt`"),
        ("charges[0].mass=-1.0", "out of range"),
        ("charges[0].mass=1e6", "all of the domain would be products"),
        ("charges[0].time=-1.0", "give a time from 0 on"),
        ("charges[0].species=\"products\"", "add a table [gas.species.products]"),
        ("charges[0].center=[5.0, 1.0]", "lies outside the domain"),
        ("charges[0].center=[2.3, 1.2]", "nearer to an open or periodic side"),
        ("charges[0].center=[0.4, 0.4]", "lies inside obstacle `box`"),
    ] {
        let scene = toml::to_string(&scene(
            2,
            "[[obstacles]]\nname = \"box\"\nshape = { box = { center = [0.4, 0.4], size = [0.3, 0.3] } }\n[boundary]\nx_max = \"outlet\"\n",
        ));
        let error = Scene::parse(&scene.unwrap(), "charge.toml", &[set.to_owned()][..]).unwrap_err().to_string();
        assert!(error.contains(told) && error.contains("charges[0]"), "{set}: {error}");
    }
}

#[test]
fn a_charge_goes_off_when_it_is_asked_for() {
    let Some(gpu) = gpu_or_skip() else { return };
    let scene = scene(2, "");
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    simulation.advance_to(1e-3).unwrap();
    let before = Budget::read(&simulation, &scene, 0.0).unwrap();
    let energy = simulation.set_off(&Charge::tnt("click", 0.2, [0.5, 0.6, 0.0]), &mut Vec::new()).unwrap();
    assert!((energy / (0.2 * TNT) - 1.0).abs() < 1e-6, "{energy}");
    simulation.advance_to(2e-3).unwrap();
    let after = Budget::read(&simulation, &scene, 0.0).unwrap();
    assert!(((after.gas_mass - before.gas_mass) / 0.2 - 1.0).abs() < 1e-5, "{after:?}");
    let drift = after.drift_since(&before);
    assert!(drift["gas_mass"].abs() < 1e-6 && drift["energy"].abs() < 1e-5, "{drift:?}");
    let error = simulation.set_off(&Charge::tnt("click", 1e8, [0.5, 0.6, 0.0]), &mut Vec::new()).unwrap_err();
    assert!(error.to_string().contains("do not fit"), "{error}");
}
