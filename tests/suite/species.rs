//! A second gas: where it is the same as the first it changes nothing, on every path of the gas.

use brisance::quantity::Values;
use brisance::render::{Depth, Renderer, SceneBuffers};
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

/// Rays through a metre of hot soot at rest see what its quantities say: thick soot in the left half, thin soot in the right one.
#[test]
fn soot_and_flames_are_what_the_picture_shows() {
    let Some(gpu) = gpu_or_skip() else { return };
    let text = "title = \"soot\"\ndomain = { dimension = 3, cells = [16, 16, 16], size = [1.0, 1.0, 1.0] }\n\
        gas.species.smoke = { gamma = 1.4 }\ngas.ambient = { density = 1.0, pressure = 1.0, mass_fraction = 0.1 }\n\
        [[gas.regions]]\nshape = { box = { center = [0.25, 0.5, 0.5], size = [0.5, 1.0, 1.0] } }\ndensity = 1.0\npressure = 1.0\nmass_fraction = 0.4\n\
        [time]\nuntil = 0.1\n[render]\nsize = [96, 64]\nopacity = [[0, 0], [1, 0]]\nrange = [0, 2]\n\
        camera = { eye = [0.5, 0.5, 4], target = [0.5, 0.5, 0], up = [0, 1, 0], height = 1.2 }\n\
        light = { strength = 0, ambient = 0 }\nsoot = { extinction = 4 }\nemission = { ambient_kelvin = 2000, strength = 2 }\n\
        overlays = { title = false, time = false, color_bar = false, scale_bar = false, edges = false }\n";
    let scene = Scene::parse(text, "soot.toml", &[]).unwrap();
    let simulation = Simulation::new(&gpu, &scene).unwrap();
    let state = simulation.snapshot().unwrap();
    let real = |name: &str| match state.cell_field(name) {
        Some(Values::Real(values)) => values,
        other => panic!("{name}: {other:?}"),
    };
    let (soot, flames) = (real("soot"), real("flames"));
    let renderer = Renderer::new(&gpu, &scene, &SceneBuffers::of(&simulation.state)).unwrap();
    let pictures = renderer.with_depth(Depth { layers: true, fine: false }).render(0.0).unwrap();
    let layers = &pictures[0].layers;
    for (x, expected) in [(0.25, 1.6), (0.75, 0.4)] {
        let cell = state.cell_at([x, 0.5, 0.5]).unwrap();
        assert!(
            (soot[cell] - expected).abs() < 1e-5 && flames[cell] > 0.5 * expected,
            "{} {}",
            soot[cell],
            flames[cell]
        );
        let column = 0.5 * f64::from(layers.width) + (x - 0.5) / 1.2 * f64::from(layers.height);
        let pixel = layers.pixels[(layers.height / 2 * layers.width) as usize + column as usize];
        let [r, g, b, alpha] = pixel.light;
        let hidden = 1.0 - (-soot[cell]).exp();
        assert!((alpha / hidden - 1.0).abs() < 0.02, "at {x}: alpha {alpha}, not {hidden}");
        let (seen, told) = (0.2126 * r + 0.7152 * g + 0.0722 * b, flames[cell] / soot[cell] * hidden);
        assert!((seen / told - 1.0).abs() < 0.06, "at {x}: luminance {seen}, not {told}");
    }
}
