//! A second gas: where it is the same as the first it changes nothing, on every path of the gas.

use brisance::scene::Scene;
use brisance::simulation::Simulation;
use brisance::snapshot::{Snapshot, kind};

use crate::common::gpu_or_skip;

/// A blast beside an obstacle that cuts cells, and open sides.
fn scene(dimension: usize, set: &[&str]) -> Scene {
    let list = |value: f64| vec![format!("{value:?}"); dimension].join(", ");
    let text = format!(
        "title = \"species\"\n[domain]\ndimension = {dimension}\ncells = [{}]\nsize = [{}]\n\
         [gas]\nambient = {{ density = 1.0, pressure = 1.0 }}\n\
         [[gas.regions]]\nshape = {{ sphere = {{ center = [{}], radius = 0.2 }} }}\ndensity = 3.0\npressure = 5.0\n\
         [[obstacles]]\nname = \"ball\"\nshape = {{ sphere = {{ center = [{}], radius = 0.15 }} }}\n\
         [boundary]\nx_max = \"outlet\"\nx_min = {{ inlet = {{ density = 1.0, velocity = [0.2{}], pressure = 1.0 }} }}\n\
         [time]\nuntil = 0.12\n",
        vec!["24"; dimension].join(", "),
        list(1.0),
        list(0.4),
        list(0.75),
        ", 0.0".repeat(dimension - 1),
    );
    let set: Vec<String> = set.iter().map(|text| (*text).to_owned()).collect();
    Scene::parse(&text, "species.toml", &set[..]).unwrap_or_else(|error| panic!("{error}"))
}

fn end_of(gpu: &brisance::gpu::Gpu, scene: &Scene) -> Snapshot {
    let mut simulation = Simulation::new(gpu, scene).unwrap();
    simulation.advance_to(scene.time.until).unwrap();
    simulation.snapshot().unwrap()
}

/// Largest difference of density and pressure over the larger value.
fn difference(a: &Snapshot, b: &Snapshot) -> f32 {
    let gas = |cell: &usize| a.kind[*cell] == kind::GAS;
    let of = |a: &[f32], b: &[f32], cell: usize| (a[cell] - b[cell]).abs() / a[cell].max(b[cell]);
    let each = (0..a.kind.len()).filter(gas);
    each.map(|cell| of(&a.density, &b.density, cell).max(of(&a.pressure, &b.pressure, cell))).fold(0.0, f32::max)
}

/// Half of all gas, by mass and volume.
const HALF: [&str; 4] = [
    "gas.species.other.gamma=1.4",
    "gas.ambient.mass_fraction=0.5",
    "gas.regions[0].mass_fraction=0.5",
    "boundary.x_min.inlet.mass_fraction=0.5",
];

/// How far fractions are from a half in gas.
fn unevenness(snapshot: &Snapshot) -> f32 {
    let gas = snapshot.species.iter().zip(&snapshot.kind).filter(|(_, own)| **own == kind::GAS);
    gas.flat_map(|(fractions, _)| [fractions[0], fractions[1]]).map(|share| (share - 0.5).abs()).fold(0.0, f32::max)
}

#[test]
fn the_same_gas_twice_is_one_gas() {
    let Some(gpu) = gpu_or_skip() else { return };
    let methods: [(usize, &[&str]); 6] = [
        (1, &[]),
        (2, &[]),
        (2, &["numerics.pair=b2b1"]),
        (2, &["numerics.integrator=ars222"]),
        (2, &["numerics.filter=0.1"]),
        (3, &["domain.cells=[14, 14, 14]"]),
    ];
    for (dimension, method) in methods {
        let tight = ["numerics.tolerance=1e-7"];
        let one = end_of(&gpu, &scene(dimension, &[&tight[..], method].concat()));
        let two = end_of(&gpu, &scene(dimension, &[&tight[..], method, &HALF].concat()));
        assert!(!two.species.is_empty() && one.species.is_empty());
        let (most, uneven) = (difference(&one, &two), unevenness(&two));
        assert!(most < 1e-4 && uneven < 1e-5, "{dimension}D {method:?}: {most:e}, fractions {uneven:e}");
    }
}

#[test]
fn fractions_that_are_even_stay_even_where_bodies_cover_gas() {
    let Some(gpu) = gpu_or_skip() else { return };
    let mut set: Vec<String> = HALF[..3].iter().map(|text| (*text).to_owned()).collect();
    set.extend(["domain.cells=[48, 48]".to_owned(), "time.until=0.2".to_owned()]);
    let scene = Scene::shipped("validation/exploding_shell.toml", &set[..]).unwrap();
    let uneven = unevenness(&end_of(&gpu, &scene));
    assert!(uneven < 1e-4, "{uneven:e}");
}

#[test]
fn a_second_gas_that_is_told_wrong_is_refused() {
    for (set, told) in [
        (&["gas.regions[0].species=\"helium\""][..], "add a table such as [gas.species.helium]"),
        (&["gas.species.helium.gamma=1.667", "gas.regions[0].species=\"helum\""], "no gas `helum`"),
        (&["gas.species.helium.gamma=0.9"], "above 1"),
        (&["gas.species.helium.gas_constant=100.0"], "`gamma` is missing"),
        (&["gas.species.helium.gamma=1.6", "gas.species.neon.gamma=1.6"], "two gases at most"),
        (&["gas.regions[0].mass_fraction=0.5"], "there is no second gas"),
        (&["gas.species.helium.gamma=1.6", "gas.regions[0].mass_fraction=1.5"], "from 0 to 1"),
        (
            &["gas.species.helium.gamma=1.6", "gas.regions[0].species=\"helium\"", "gas.regions[0].mass_fraction=0.5"],
            "leave one of them out",
        ),
        (&["render.soot.extinction=10.0"], "there is no second gas"),
    ] {
        let text = toml::to_string(&scene(2, &[])).unwrap();
        let set: Vec<String> = set.iter().map(|text| (*text).to_owned()).collect();
        let error = Scene::parse(&text, "species.toml", &set[..]).unwrap_err().to_string();
        assert!(error.contains(told), "{set:?}: {error}");
    }
}
