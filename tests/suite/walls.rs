//! Sides that are walls: planes of symmetry.

use brisance::gpu::Gpu;
use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::common::gpu_or_skip;

/// Gas at rest under gravity in a box stays at rest, whatever its walls and however the steps change.
#[test]
fn gas_under_gravity_rests_on_its_floor_at_every_step() {
    let Some(gpu) = gpu_or_skip() else { return };
    let text = "title = \"column\"\ngravity = [0.0, -0.01]\n[domain]\ndimension = 2\ncells = [6, 16]\nsize = [0.375, 1.0]\n\
                [gas]\natmosphere = \"uniform\"\nambient = { density = 1.4, pressure = 1.0 }\n\
                waves = [{ vector = [0.0, 0.02], phase = 1.570796327, pressure = 0.7 }]\n\
                [time]\nuntil = 30.0\nmax_courant = 5.0\n";
    let scene = Scene::parse(text, "column.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(&gpu, &scene).unwrap();
    let mut fastest = 0.0_f32;
    for time in [3.0, 7.1, 7.2, 15.0, 15.01, 30.0] {
        let records = simulation.advance_to(time).unwrap();
        fastest = records.iter().fold(fastest, |most, record| most.max(record.gas_speed));
    }
    eprintln!("largest speed {:.1e} of sqrt(g H)", fastest / 0.1);
    assert!(fastest < 5e-5, "{fastest:e}");
}

/// Density after `until` of a blast in a box, or with `part` of the piece of it where all coordinates are positive: its middle planes
/// are walls. A bar of dense gas makes it differ along the axes.
fn blast(gpu: &Gpu, dimension: usize, cells: usize, part: bool, (until, more): (f64, &str)) -> Vec<f32> {
    let list = |value: String| format!("[{}]", vec![value; dimension].join(", "));
    let (origin, size) = if part { ("0.0", "0.5") } else { ("-0.5", "1.0") };
    let bar = ["0.9", "0.25", "0.6"][..dimension].join(", ");
    let text = format!(
        "title = \"blast\"\n[domain]\ndimension = {dimension}\ncells = {}\norigin = {}\nsize = {}\n\
         [gas]\nambient = {{ density = 1.0, pressure = 1.0 }}\n\
         [[gas.regions]]\nshape = {{ box = {{ center = {}, size = [{bar}] }} }}\ndensity = 2.0\npressure = 1.0\n\
         [[gas.regions]]\nshape = {{ sphere = {{ center = {}, radius = 0.2 }} }}\ndensity = 1.0\npressure = 10.0\n\
         [time]\nuntil = {until}\n[numerics]\ntolerance = 1e-7\n{more}\n",
        list((if part { cells / 2 } else { cells }).to_string()),
        list(origin.to_owned()),
        list(size.to_owned()),
        list("0.0".to_owned()),
        list("0.0".to_owned()),
    );
    let scene = Scene::parse(&text, "blast.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(gpu, &scene).unwrap();
    simulation.advance_to(until).unwrap_or_else(|error| panic!("{more}: {error}"));
    simulation.snapshot().unwrap().density
}

/// Largest difference of the density between a part of a blast and the whole.
fn difference(gpu: &Gpu, dimension: usize, cells: usize, run: (f64, &str)) -> f32 {
    let whole = blast(gpu, dimension, cells, false, run);
    let part = blast(gpu, dimension, cells, true, run);
    let half = cells / 2;
    let place = |i: usize| {
        (0..dimension as u32)
            .map(|d| {
                let c = i / half.pow(d) % half;
                (half + c) * cells.pow(d)
            })
            .sum::<usize>()
    };
    let worst = (0..part.len()).fold(0.0, |most: f32, i| most.max((part[i] - whole[place(i)]).abs()));
    eprintln!("{dimension}D {run:?}: {worst:.1e}");
    worst
}

/// An obstacle in the middle of a plane, whose surface leaves gas in a part of cells that images stand next to.
const BALL: &str = "paper.obstacles = \"cut\"\n[[obstacles]]\nname = \"ball\"\nshape = { sphere = { center = [0.0, 0.0], radius = 0.12 } }";

/// The same of whole cells, as the pair B2B1 takes obstacles.
const BALL_OF_CELLS: &str =
    "pair = \"b2b1\"\n[[obstacles]]\nname = \"ball\"\nshape = { sphere = { center = [0.0, 0.0], radius = 0.12 } }";

/// Quarter and eighth of a blast with walls in its planes of symmetry are the whole one.
#[test]
fn a_part_of_a_blast_between_walls_is_the_whole_blast() {
    let Some(gpu) = gpu_or_skip() else { return };
    let settings =
        ["", "paper.face_velocity = \"cell\"", "integrator = \"ars222\"", "integrator = \"paper\"", "pair = \"b2b1\""];
    let blasts = [(1, 40, 0.2), (2, 32, 0.2), (3, 20, 0.05)];
    let free =
        settings.iter().flat_map(|more| blasts.map(|(dimension, cells, until)| (dimension, cells, (until, *more))));
    let mut failures = Vec::new();
    for (dimension, cells, run) in free.chain([(2, 32, (0.2, BALL)), (2, 32, (0.2, BALL_OF_CELLS))]) {
        let worst = difference(&gpu, dimension, cells, run);
        if worst >= 1e-5 {
            failures.push(format!("{dimension}D {run:?}: {worst:e}"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
