//! Dust on the ground: taken along by the gas and carried with it, to the last milligram, on every path of the gas.

use brisance::gpu::{Gpu, readback};
use brisance::quantity::Values;
use brisance::render::{Depth, Renderer, SceneBuffers};
use brisance::scene::Scene;
use brisance::simulation::Simulation;
use brisance::snapshot::kind;

use crate::common::gpu_or_skip;

fn with(text: &str, set: &[&str]) -> Scene {
    let set: Vec<String> = set.iter().map(|text| (*text).to_owned()).collect();
    Scene::parse(text, "dust.toml", &set[..]).unwrap_or_else(|error| panic!("{error}"))
}

/// A blast over dusty ground, beside a dusty ball, with one open side.
fn blast(dimension: usize, set: &[&str]) -> Scene {
    let list = |value: f64| vec![format!("{value:?}"); dimension].join(", ");
    let ground = ["x_min", "y_min", "z_min"][dimension - 1];
    let text = format!(
        "title = \"dust\"\n[domain]\ndimension = {dimension}\ncells = [{}]\nsize = [{}]\n\
         [gas]\nambient = {{ density = 1.0, pressure = 1.0 }}\n\
         dust = {{ sides = [\"{ground}\"], amount = 0.2, threshold = 0.01, rate = 0.5 }}\n\
         [[gas.regions]]\nshape = {{ sphere = {{ center = [{}], radius = 0.2 }} }}\ndensity = 3.0\npressure = 8.0\n\
         [boundary]\nx_max = \"outlet\"\n[time]\nuntil = 0.4\n",
        vec!["16"; dimension].join(", "),
        list(1.0),
        list(0.3),
    );
    with(&text, set)
}

/// All dust of a state: in the gas and in bodies, on the ground, and what has left \[kg\].
fn masses(gpu: &Gpu, scene: &Scene, simulation: &Simulation) -> [f64; 3] {
    let grid = &simulation.state.grid;
    let dust: Vec<f32> = readback::read(gpu, &simulation.state.dust).unwrap();
    let words: Vec<u32> = readback::read(gpu, &simulation.state.interface.cells).unwrap();
    let shares = brisance::state::cut::gas_shares(grid, &scene.cut_geometry());
    let volume = scene.domain.cell_volume();
    let mut sum = [0.0; 3];
    for slot in 0..grid.slots() {
        let beyond = (words[slot] as u8 & kind::MASK) == kind::GHOST;
        sum[if beyond { 2 } else { 0 }] += volume * shares[slot] * f64::from(dust[slot]);
        sum[1] += volume * f64::from(dust[grid.slots() + slot]);
    }
    sum
}

/// Obstacles that cut cells, and one that fills them.
const BALL: &str = "obstacles=[{ name = \"ball\", shape = { sphere = { center = CENTER, radius = 0.17 } } }]";
/// A heavy body that flies along the ground.
const FLYER: &str = "bodies=[{ name = \"flyer\", material = \"soft\", density = 40.0, velocity = VELOCITY, \
                     shape = { sphere = { center = CENTER, radius = 0.12 } } }]";
const SOFT: &str = "materials.soft.neo_hookean={ young_modulus = 400.0, poisson_ratio = 0.3 }";

#[test]
fn what_leaves_the_ground_is_in_the_gas_or_has_left() {
    let Some(gpu) = gpu_or_skip() else { return };
    let [ball, ball_3d] = ["[0.6, 0.2]", "[0.6, 0.6, 0.2]"].map(|center| BALL.replace("CENTER", center));
    let flyer = FLYER.replace("CENTER", "[0.3, 0.15]").replace("VELOCITY", "[1.5, 0.0]");
    let cases: [(usize, &[&str]); 8] = [
        (1, &[]),
        (2, &[]),
        (2, &["numerics.integrator=ars222"]),
        (2, &["numerics.pair=b2b1"]),
        (2, &[&ball, "gas.dust.obstacles=true"]),
        (2, &[&flyer, SOFT]),
        (2, &["gas.species.other.gamma=1.3", "gas.regions[0].species=\"other\""]),
        (3, &["domain.cells=[12, 12, 12]", "time.until=0.2", &ball_3d, "gas.dust.obstacles=true"]),
    ];
    for (dimension, set) in cases {
        let scene = blast(dimension, set);
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        let [_, before, _] = masses(&gpu, &scene, &simulation);
        let records = simulation.advance_to(scene.time.until).unwrap();
        let [held, loose, left] = masses(&gpu, &scene, &simulation);
        let drift = (held + loose + left) / before - 1.0;
        println!("{dimension}D {set:?}: {held:.4} {loose:.4} {left:.4} of {before:.4}, drift {drift:.1e}");
        assert!(drift.abs() < 1e-6, "{dimension}D {set:?}: {drift:e}");
        assert!(held > 0.02 * before && loose < 0.98 * before, "{dimension}D {set:?}: {held} of {before}");
        let told = records.last().unwrap().dust_mass.map(f64::from);
        let off =
            told.iter().zip([held, loose, left]).map(|(told, own)| (told - own).abs()).fold(0.0, f64::max) / before;
        println!("    record off by {off:.1e}");
        assert!(off < 1e-6, "{dimension}D {set:?}: {told:?} {held} {loose} {left}");
        let least: f32 = readback::read(&gpu, &simulation.state.dust).unwrap().into_iter().fold(0.0, f32::min);
        assert!(least >= 0.0, "{dimension}D {set:?}: {least}");
    }
}

#[test]
fn the_gas_does_not_feel_it() {
    let Some(gpu) = gpu_or_skip() else { return };
    let flyer = FLYER.replace("CENTER", "[0.3, 0.15]").replace("VELOCITY", "[1.5, 0.0]");
    for set in [&[][..], &["numerics.integrator=ars222"], &[&flyer, SOFT]] {
        let scene = blast(2, &[set, &["time.until=0.2"]].concat());
        let mut without = scene.clone();
        without.gas.dust = None;
        let [with, without] = [scene, without].map(|scene| {
            let mut simulation = Simulation::new(&gpu, &scene).unwrap();
            simulation.advance_to(scene.time.until).unwrap();
            let snapshot = simulation.snapshot().unwrap();
            // as text, for a body's cells hold no number
            format!("{:?}", (snapshot.density, snapshot.velocity, snapshot.energy, snapshot.particles))
        });
        assert!(with == without, "{set:?}");
    }
}

/// A wind over dusty ground, around and around.
fn wind(set: &[&str]) -> Scene {
    let text = "title = \"wind\"\ndomain = { dimension = 2, cells = [64, 8], size = [1.0, 0.125] }\n\
        [gas]\nambient = { density = 2.0, velocity = [1.5, 0.0], pressure = 1.0 }\n\
        dust = { sides = [\"y_min\"], amount = 0.2, threshold = 0.5, rate = 0.05 }\n\
        [boundary]\nx_min = \"periodic\"\nx_max = \"periodic\"\n[time]\nuntil = 0.5\n";
    with(text, set)
}

#[test]
fn the_ground_gives_what_the_law_says() {
    let Some(gpu) = gpu_or_skip() else { return };
    for (threshold, rate) in [("0.5", 0.05 / 0.2 * 2.0 * 1.0), ("1.6", 0.0)] {
        let scene = wind(&[&format!("gas.dust.threshold={threshold}")]);
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        let [_, before, _] = masses(&gpu, &scene, &simulation);
        assert!((before / 0.2 - 1.0).abs() < 1e-6, "{before}");
        simulation.advance_to(scene.time.until).unwrap();
        let [held, loose, _] = masses(&gpu, &scene, &simulation);
        let exact = before * f64::exp(-rate * scene.time.until);
        println!("on the ground beside the law: {:.1e}", loose / exact - 1.0);
        assert!((loose / exact - 1.0).abs() < 2e-3 && (held - (before - loose)).abs() < 1e-6, "{loose} {exact}");
    }
}

#[test]
fn it_goes_where_the_gas_goes() {
    let Some(gpu) = gpu_or_skip() else { return };
    let until = ["gas.dust.threshold=9.0", "time.until=0.6666666666666666"];
    let errors = [64, 128].map(|cells: u32| {
        let scene = wind(&[until[0], until[1], &format!("domain.cells=[{cells}, {}]", cells / 8)]);
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        let grid = simulation.state.grid;
        let hill = |x: f32| f32::exp(-((x - 0.5) / 0.1).powi(2));
        let mut dust = vec![0.0; grid.slots()];
        for cell in (0..cells as i32 / 8).flat_map(|y| (0..cells as i32).map(move |x| [x, y, 0])) {
            dust[grid.slot(cell)] = hill(grid.centre(cell)[0]);
        }
        simulation.state.dust.write(&gpu, 0, &dust);
        simulation.advance_to(scene.time.until).unwrap();
        let snapshot = simulation.snapshot().unwrap();
        let now = snapshot.dust.iter().enumerate();
        let error = now.map(|(cell, own)| (own - hill(grid.centre([(cell as u32 % cells) as i32, 0, 0])[0])).abs());
        error.sum::<f32>() / snapshot.dust.iter().sum::<f32>()
    });
    println!("after one turn, over its mass: {errors:?}");
    assert!(errors[0] < 0.06 && errors[1] < 0.3 * errors[0], "{errors:?}");
}

#[test]
fn a_run_goes_on_with_its_dust() {
    let Some(gpu) = gpu_or_skip() else { return };
    let scene = blast(2, &["gas.dust.obstacles=false"]);
    let mut whole = Simulation::new(&gpu, &scene).unwrap();
    whole.advance_to(0.2).unwrap();
    let saved = whole.save().unwrap();
    let mut again = Simulation::new(&gpu, &scene).unwrap();
    again.restore(&saved).unwrap();
    let ends = [&mut whole, &mut again].map(|simulation| {
        simulation.advance_to(0.4).unwrap();
        readback::read(&gpu, &simulation.state.dust).unwrap()
    });
    assert!(ends[0] == ends[1] && ends[0].iter().any(|own| *own > 0.0));
}

#[test]
fn dust_that_is_told_wrong_is_refused() {
    for (set, told) in [
        (&["gas.dust.sides=[\"z_min\"]"][..], "`z_min` is no side of the domain"),
        (&["gas.dust.sides=[\"x_max\"]"], "`x_max` is no wall: dust lies on walls"),
        (&["gas.dust.sides=[\"y_min\", \"y_min\"]"], "named twice"),
        (&["gas.dust.sides=[]"], "it lies nowhere"),
        (&["gas.dust.obstacles=true"], "there are no obstacles"),
        (&["gas.dust.amount=0.0"], "above 0"),
        (&["gas.dust.rate=-1.0"], "above 0"),
        (&["gas.dust.threshold=-1.0"], "at least 0"),
        (&["gas.dust.height=1.0"], "height"),
    ] {
        let text = toml::to_string(&blast(2, &[])).unwrap();
        let set: Vec<String> = set.iter().map(|text| (*text).to_owned()).collect();
        let error = Scene::parse(&text, "dust.toml", &set[..]).unwrap_err().to_string();
        assert!(error.contains(told), "{set:?}: {error}");
    }
    let text = toml::to_string(&blast(2, &[])).unwrap().replace("rate = 0.5\n", "");
    assert!(Scene::parse(&text, "dust.toml", &[]).unwrap_err().to_string().contains("rate"));
    let clean = "title = \"c\"\ndomain = { dimension = 2, cells = [4, 4], size = [1.0, 1.0] }\n\
                 gas.ambient = { density = 1.0, pressure = 1.0 }\ntime.until = 1.0\nrender.dust = {}\n";
    assert!(Scene::parse(clean, "c.toml", &[]).unwrap_err().to_string().contains("there is no dust"));
}

/// Rays through a metre of dust, thick in the left half and thin in the right one, as the extinction says.
#[test]
fn a_picture_shows_how_much_there_is() {
    let Some(gpu) = gpu_or_skip() else { return };
    let text = "title = \"dust\"\ndomain = { dimension = 3, cells = [16, 16, 16], size = [1.0, 1.0, 1.0] }\n\
        gas.ambient = { density = 1.0, pressure = 1.0 }\n\
        gas.dust = { sides = [\"z_min\"], amount = 1.0, threshold = 1.0, rate = 0.1 }\n\
        [time]\nuntil = 0.1\n[render]\nsize = [96, 64]\nopacity = [[0, 0], [1, 0]]\nrange = [0, 2]\n\
        camera = { eye = [0.5, 0.5, 4], target = [0.5, 0.5, 0], up = [0, 1, 0], height = 1.2 }\n\
        light = { strength = 0, ambient = 1 }\ndust = { extinction = 4, color = \"#ff8000\" }\n\
        overlays = { title = false, time = false, color_bar = false, scale_bar = false, edges = false }\n";
    let scene = Scene::parse(text, "dust.toml", &[]).unwrap();
    let simulation = Simulation::new(&gpu, &scene).unwrap();
    let grid = simulation.state.grid;
    let mut dust = vec![0.0; grid.slots()];
    for place in 0..16 * 16 * 16 {
        dust[grid.slot([place % 16, place / 16 % 16, place / 256])] = if place % 16 < 8 { 0.4 } else { 0.1 };
    }
    simulation.state.dust.write(&gpu, 0, &dust);
    let state = simulation.snapshot().unwrap();
    let Some(Values::Real(told)) = state.cell_field("dust") else { panic!("no dust") };
    let renderer = Renderer::new(&gpu, &scene, &SceneBuffers::of(&simulation.state)).unwrap();
    let pictures = renderer.with_depth(Depth { layers: true, fine: false }).render(0.0).unwrap();
    let layers = &pictures[0].layers;
    for (x, expected) in [(0.25, 0.4), (0.75, 0.1)] {
        assert_eq!(told[state.cell_at([x, 0.5, 0.5]).unwrap()], expected);
        let column = 0.5 * f64::from(layers.width) + (x - 0.5) / 1.2 * f64::from(layers.height);
        let pixel = layers.pixels[(layers.height / 2 * layers.width) as usize + column as usize];
        let [red, green, blue, alpha] = pixel.light;
        let hidden = 1.0 - (-4.0 * expected).exp();
        assert!((alpha / hidden - 1.0).abs() < 0.02, "at {x}: alpha {alpha}, not {hidden}");
        assert!((red / hidden - 1.0).abs() < 0.03 && (green / red - 0.2158).abs() < 0.01 && blue < 1e-3, "{pixel:?}");
    }
}
