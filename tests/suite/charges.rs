//! Charges: what they give to the gas, when, and what is not taken for one.

use brisance::expect::Budget;
use brisance::scene::{Charge, Scene};
use brisance::simulation::{Saved, Simulation};
use brisance::snapshot::Snapshot;

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
        ("charges[0].time=-1.0", "give a number of at least 0"),
        ("charges[0].species=\"products\"", "add a table [gas.species.products]"),
        ("charges[0].center=[5.0, 1.0]", "lies outside the domain"),
        ("charges[0].center=[2.3, 1.2]", "nearer to an open or periodic side"),
        ("charges[0].center=[0.4, 0.4]", "lies inside obstacle `box`"),
        ("charges[0].center=[0.9, 0.4]", "lies inside body `block`"),
    ] {
        let scene = toml::to_string(&scene(
            2,
            "[[obstacles]]\nname = \"box\"\nshape = { box = { center = [0.4, 0.4], size = [0.3, 0.3] } }\n\
             [[bodies]]\nname = \"block\"\nmaterial = \"steel\"\nshape = { box = { center = [0.9, 0.4], size = [0.3, 0.3] } }\n[boundary]\nx_max = \"outlet\"\n",
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

/// A bent charge of TNT, and what else the scene has.
fn bent(more: &str) -> String {
    format!(
        "title = \"bent\"\n[domain]\ndimension = 2\ncells = [40, 40]\nsize = [0.4, 0.4]\n[gas]\n\
         ambient = {{ density = 1.2, pressure = 1e5 }}\n[gas.species.products]\nexplosive = \"tnt\"\n\
         [[charges]]\nname = \"c\"\nexplosive = \"tnt\"\nspecies = \"products\"\ntime = 1e-6\n\
         shape = {{ union = [{{ box = {{ center = [0.2, 0.1], size = [0.2, 0.06] }} }}, \
         {{ box = {{ center = [0.27, 0.2], size = [0.06, 0.26] }} }}] }}\ndetonate_at = [[0.11, 0.1]]\n\
         [time]\nuntil = 6e-5\n{more}"
    )
}

fn parsed(text: &str, set: &[&str]) -> Result<Scene, String> {
    let set: Vec<String> = set.iter().map(|own| (*own).to_owned()).collect();
    Scene::parse(text, "bent.toml", &set[..]).map_err(|error| error.to_string())
}

#[test]
fn a_detonation_goes_straight_and_around_corners() {
    let scene = parsed(&bent(""), &[]).unwrap();
    let (times, cell) = (scene.burn_times(), scene.domain.spacing());
    let at = |x: f64, y: f64| times[(x / cell) as usize + 40 * (y / cell) as usize].unwrap();
    let centre = |x: f64| ((x / cell).floor() + 0.5) * cell;
    let length = |a: [f64; 2], b: [f64; 2]| ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sqrt();
    let (from, corner, speed) = ([0.11, 0.1], [0.24, 0.13], 6930.0);
    for end in [[0.22, 0.11], [0.28, 0.09]] {
        let exact = 1e-6 + length(from, end.map(centre)) / speed;
        assert!((at(end[0], end[1]) / exact - 1.0).abs() < 1e-6, "{end:?}: {} {exact}", at(end[0], end[1]));
    }
    for end in [[0.25, 0.31], [0.29, 0.32], [0.26, 0.2]] {
        let exact = 1e-6 + (length(from, corner) + length(corner, end.map(centre))) / speed;
        // the corner of the cells is not that of the shape
        assert!((at(end[0], end[1]) / exact - 1.0).abs() < 0.03, "{end:?}: {} {exact}", at(end[0], end[1]));
    }
    assert!(times[20 + 40 * 38].is_none(), "far away nothing burns");
}

#[test]
fn a_charge_with_a_shape_burns_whole_and_keeps_its_energy() {
    let Some(gpu) = gpu_or_skip() else { return };
    let scene = parsed(&bent(""), &[]).unwrap();
    let on_grid = &scene.charges_on_grid()[0];
    let mass = on_grid.mass;
    assert!(on_grid.warning().is_some() == (on_grid.cells_across < 6.0) && on_grid.burned_after > 4e-5, "{on_grid:?}");
    let exact = 1630.0 * (0.2 * 0.06 + 0.06 * (0.26 - 0.06));
    assert!((mass / exact - 1.0).abs() < 1e-9, "{mass} {exact}");
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    let before = Budget::read(&simulation, &scene, 0.0).unwrap();
    assert!(((before.energy - 0.16 * 2.5e5) / (mass * TNT) - 1.0).abs() < 2e-3, "{before:?}");
    let start = simulation.snapshot().unwrap();
    assert!(start.pressure.iter().all(|p| (p / 1e5 - 1.0).abs() < 0.01), "nothing has burned");
    simulation.advance_to(2e-5).unwrap();
    let half = simulation.snapshot().unwrap();
    let burned = |snapshot: &Snapshot| 1.0 - held_energies(snapshot);
    assert!((0.3..0.7).contains(&burned(&half)), "{}", burned(&half));
    let saved = simulation.save().unwrap();
    simulation.advance_to(6e-5).unwrap();
    assert!(burned(&simulation.snapshot().unwrap()) > 1.0 - 1e-6);
    let drift = Budget::read(&simulation, &scene, 0.0).unwrap().drift_since(&before);
    assert!(drift["gas_mass"].abs() < 1e-6 && drift["energy"].abs() < 1e-6, "{drift:?}");
    // and the same bits from the middle on
    let mut second = Simulation::new(&gpu, &scene).unwrap();
    second.restore(&saved).unwrap();
    second.advance_to(6e-5).unwrap();
    assert_eq!(second.snapshot().unwrap().energy, simulation.snapshot().unwrap().energy);
}

/// Energies of detonation that the second gas holds, over its mass.
fn held_energies(snapshot: &Snapshot) -> f64 {
    let mass = |cell: usize| f64::from(snapshot.species[cell][0] * snapshot.density[cell]);
    let held = |cell: usize| mass(cell) * f64::from(snapshot.species[cell][2]);
    let cells = 0..snapshot.density.len();
    cells.clone().map(held).sum::<f64>() / cells.map(mass).sum::<f64>()
}

#[test]
fn a_shape_is_brought_to_its_mass() {
    let scene = parsed(&bent(""), &["charges[0].mass=10.0", "charges[0].detonate_at=[[0.18, 0.15]]"]).unwrap();
    let on_grid = scene.charges_on_grid()[0].mass;
    // bars are three cells thick, and cells hold what a few points of them see
    assert!((on_grid / 10.0 - 1.0).abs() < 0.03, "{on_grid}");
    // what has been scaled stays as it is
    let again = parsed(&toml::to_string(&scene).unwrap(), &[]).unwrap();
    assert_eq!(again.charges, scene.charges);
}

#[test]
fn products_burn_on_as_far_as_there_is_air() {
    let Some(gpu) = gpu_or_skip() else { return };
    let tnt = brisance::explosive::explosive("tnt").unwrap();
    let fuel = tnt.afterburn_energy() / tnt.specific_energy();
    let set = [
        "gas.species.products.afterburn=1e-4",
        "gas.ambient={ density = 24.0, pressure = 2e6 }",
        "charges[0].mass=2.0",
        "charges[0].detonate_at=[[0.19, 0.177]]",
    ];
    let scene = parsed(&bent(""), &set).unwrap();
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    let before = Budget::read(&simulation, &scene, 0.0).unwrap();
    let mass = scene.charges_on_grid()[0].mass;
    let energy = mass * tnt.combustion_energy;
    assert!(((before.energy - 0.16 * 5e6) / energy - 1.0).abs() < 2e-3, "{before:?} {energy}");
    let mut left = 1.0 + fuel;
    for time in [3e-5, 1e-4, 3e-4] {
        simulation.advance_to(time).unwrap();
        let now = simulation.snapshot().unwrap();
        let held = held_energies(&now);
        assert!(held < left * (1.0 + 1e-6), "{time}: {held} {left}");
        left = held;
        // no more has burned than the air of a cell can burn, and 3 %: each flux has a reconstruction of its own
        for (&[share, _, held], density) in now.species.iter().zip(&now.density) {
            let [own, air] = [f64::from(share * density), f64::from((1.0 - share) * density)];
            let least = fuel * (0.97 * own - air / tnt.air_needed()).max(0.0);
            assert!(f64::from(held) * own > least - 1e-5 * f64::from(*density), "{time}: {held} {share} {least}");
        }
        let drift = Budget::read(&simulation, &scene, 0.0).unwrap().drift_since(&before);
        assert!(drift["gas_mass"].abs() < 1e-6 && drift["energy"].abs() < 1e-6, "{time}: {drift:?}");
    }
    assert!((0.1 * fuel..0.95 * fuel).contains(&left), "some has burned: {left} of {fuel}");
}

#[test]
fn a_ball_brings_what_its_products_hold() {
    let Some(gpu) = gpu_or_skip() else { return };
    let tnt = brisance::explosive::explosive("tnt").unwrap();
    let text = toml::to_string(&scene(2, "")).unwrap();
    let set = [
        "gas.species.products.explosive=\"tnt\"",
        "gas.species.products.afterburn=1e-3",
        "charges[0].species=\"products\"",
        "charges[0].afterburn=true",
    ];
    let scene = parsed(&text, &set).unwrap();
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    let before = Budget::read(&simulation, &scene, 0.0).unwrap();
    simulation.advance_to(2e-3).unwrap();
    // all of the heat of combustion, whether it has burned near by or burns on the grid
    assert!((simulation.blasts() / (0.5 * tnt.combustion_energy) - 1.0).abs() < 1e-6, "{}", simulation.blasts());
    let drift = Budget::read(&simulation, &scene, 0.0).unwrap().drift_since(&before);
    assert!(drift["gas_mass"].abs() < 1e-6 && drift["energy"].abs() < 1e-5, "{drift:?}");
    let held = held_energies(&simulation.snapshot().unwrap());
    assert!(held > 0.1 && held < tnt.afterburn_energy() / tnt.specific_energy(), "{held}");
}

#[test]
fn cells_of_products_too_dense_for_their_law_are_counted() {
    let Some(gpu) = gpu_or_skip() else { return };
    let text = "title = \"dense\"\n[domain]\ndimension = 1\ncells = [40]\nsize = [0.4]\n[gas]\n\
        ambient = { density = 1630.0, pressure = 1e11, species = \"products\" }\n[gas.species.products]\nexplosive = \"tnt\"\n\
        [[gas.regions]]\nshape = { box = { center = [0.2], size = [0.08] } }\n\
        density = 4900.0\npressure = 1e11\nspecies = \"products\"\n[time]\nuntil = 1e-6\n";
    for (density, count) in [("4900.0", 8), ("4880.0", 0)] {
        let scene = parsed(&text.replace("4900.0", density), &[]).unwrap();
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        let record = simulation.advance_to(1e-8).unwrap().pop().unwrap();
        assert_eq!(record.dense, count, "{density}");
    }
}

#[test]
fn what_is_no_charge_on_the_grid_is_refused() {
    for (set, told) in [
        ("charges[0].mass=1000.0", "the shape cannot be brought to this mass within the gas"),
        ("charges[0].afterburn=true", "it is for the near field of a charge without a shape"),
        ("charges[0].roughness=0.1", "it is for a charge without a shape"),
        ("charges[0].explosive=\"c4\"", "the gas that its products are is not that of its explosive"),
        ("gas.species.products.explosive=\"tmt\"", "did you mean `tnt`"),
        ("gas.species.products.gamma=1.3", "`gamma` and `explosive` are both given"),
        ("charges[0].detonate_at=[[0.3, 0.35]]", "lies outside of the charge"),
        ("charges[0].detonate_at=[]", "its middle is no part of it"),
    ] {
        let error = parsed(&bent(""), &[set]).unwrap_err();
        assert!(error.contains(told), "{set}: {error}");
    }
    let apart =
        bent("").replace("center = [0.27, 0.2], size = [0.06, 0.26]", "center = [0.27, 0.3], size = [0.06, 0.06]");
    let error = parsed(&apart, &[]).unwrap_err();
    assert!(error.contains("the detonation does not come everywhere"), "{error}");
    let ball = scene(2, "");
    let text = toml::to_string(&ball).unwrap().replace("center = [1.2, 1.2, 0.0]\n", "");
    let error = parsed(&text, &[]).unwrap_err();
    assert!(error.contains("give mass [kg] and center [m], or shape"), "{error}");
}
