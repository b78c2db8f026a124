//! Still air: leaving out what nothing happens in changes no bit, and is woken by all that may happen to it.

use brisance::gpu::{Gpu, readback};
use brisance::scene::Scene;
use brisance::simulation::{Blast, Simulation};

use crate::common::gpu_or_skip;

/// A blast with a box of gas of its own state around it, away from the middle, so that its waves reach columns at different times.
fn blast(dimension: usize, cells: [u32; 3], more: &str) -> String {
    let size = cells.map(|n| f64::from(n) / 64.0);
    format!(
        "title = \"Blast\"\n[domain]\ndimension = {dimension}\ncells = {:?}\nsize = {:?}\n[gas]\ngamma = 1.4\n\
         ambient = {{ density = 0.125, pressure = 0.1 }}\n[[gas.regions]]\n\
         shape = {{ sphere = {{ center = {:?}, radius = 0.08 }} }}\ndensity = 1.0\npressure = 10.0\n\
         [time]\nuntil = 1.0\n{more}",
        &cells[..dimension],
        &size[..dimension],
        &[0.25, 0.3, 0.2][..dimension],
    )
}

/// In place of an override: a tolerance of 1e-6 and longer steps from the fourth on.
const LATER: &str = "strict later";

/// How much was left out in a run.
#[derive(Debug, Default)]
struct LeftOut {
    /// Most rows of blocks that the advection left out in one step.
    still: u32,
    /// Most runs of slots that slept in one.
    asleep: u32,
    /// Whether a solve woke them.
    woken: bool,
}

/// All that a run leaves. `skip`: leaves out what it may, or nothing.
fn run(gpu: &Gpu, text: &str, overrides: &[String], steps: u32, march: u32, skip: bool) -> (Vec<Vec<u32>>, LeftOut) {
    let later = overrides.iter().any(|text| text == LATER);
    let overrides: Vec<_> = overrides.iter().filter(|text| *text != LATER).cloned().collect();
    let scene = Scene::parse(text, "still.toml", &overrides).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(gpu, &scene).unwrap();
    if !skip {
        simulation.state.params.still = 0;
    }
    if march > 0 {
        simulation.state.params.march = march;
    }
    simulation.state.params_buffer.write(gpu, 0, &[simulation.state.params]);
    simulation.set_target(1.0).unwrap();
    let (mut records, mut left_out, mut blasted) = (Vec::new(), LeftOut::default(), false);
    let mut slept = 0;
    while records.len() < steps as usize {
        if later && records.len() == 4 {
            let mut strict = scene.clone();
            strict.numerics.tolerance = 1e-6;
            (strict.time.cfl, strict.time.max_courant, strict.time.max_growth) = (1.5, 12.0, 20.0);
            simulation.change(&scene, &strict, &mut records).unwrap();
        }
        simulation.advance_batch_of(&mut records, 1).unwrap();
        let params = &simulation.state.params;
        let words = readback::read(gpu, &simulation.state.interface.extra).unwrap();
        let lines = params.stride[scene.domain.axes() - 1];
        let blocks = (params.slots / lines).div_ceil(8) * lines.div_ceil(params.march);
        let rows = &words[params.still_at as usize..][..blocks as usize];
        let control = simulation.control().unwrap();
        let runs = simulation.state.interface.runs as u32;
        let asleep = if simulation.state.sleeps() { runs - control.runs } else { 0 };
        left_out.still =
            left_out.still.max(rows.iter().map(|word| (!word & ((1 << params.march) - 1)).count_ones()).sum());
        left_out.asleep = left_out.asleep.max(asleep);
        // what slept in the last step sleeps on, unless the solve or a blast wakes it
        left_out.woken |= slept > 0 && control.woken == 1 && !blasted;
        slept = asleep;
        if !blasted && records.len() >= steps as usize / 2 {
            blasted = true;
            let middle =
                std::array::from_fn(
                    |axis| if axis < scene.domain.axes() { 0.75 * scene.domain.size[axis] } else { 0.0 },
                );
            simulation.detonate(&Blast { center: middle, radius: 0.06, energy: 0.01 }, &mut records).unwrap();
        }
    }
    assert!(blasted);
    let state = &simulation.state;
    let words = |buffer| bytemuck::cast_vec(readback::read(gpu, buffer).unwrap());
    let energy: Vec<u32> = bytemuck::cast_vec(readback::read(gpu, &state.gas.energy).unwrap());
    let now = energy[..state.params.slots as usize].to_vec();
    let particles = [words(&state.particles.position), words(&state.particles.velocity)];
    let owed: Vec<u32> = bytemuck::cast_vec(readback::read(gpu, &state.gas.owed_energy).unwrap());
    let kept = [words(&state.gas.conserved), now, words(&state.gas.owed_flow), owed, words(&state.history)];
    (kept.into_iter().chain(particles).collect(), left_out)
}

fn same_bits(name: &str, text: &str, overrides: &[&str], steps: u32) -> Option<LeftOut> {
    same_bits_in_marches(name, text, overrides, steps, 0)
}

/// Columns of `march` slots, or with 0 as many as the device likes.
fn same_bits_in_marches(name: &str, text: &str, overrides: &[&str], steps: u32, march: u32) -> Option<LeftOut> {
    let gpu = gpu_or_skip()?;
    let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
    let (full, none) = run(&gpu, text, &overrides, steps, march, false);
    let (less, some) = run(&gpu, text, &overrides, steps, march, true);
    eprintln!("{name} {overrides:?}: {some:?}");
    let moves = overrides.iter().any(|text| text.starts_with("gravity"));
    assert!(none.still == 0 && none.asleep == 0, "{name} {overrides:?}: {none:?}");
    assert!(some.still > 0 || moves, "{name} {overrides:?}: {some:?}");
    for (part, (a, b)) in full.iter().zip(&less).enumerate() {
        let first = a.iter().zip(b).position(|(a, b)| a != b);
        assert_eq!(first, None, "{name} {overrides:?}: first word of part {part} that differs");
    }
    Some(some)
}

fn sleeps(left_out: Option<LeftOut>) {
    assert!(left_out.is_none_or(|some| some.asleep > 0), "nothing slept");
}

const OPEN: &str = "[boundary]\nx_max = \"outlet\"\n";

#[test]
fn a_line_and_a_plane() {
    sleeps(same_bits("line", &blast(1, [4096, 1, 1], ""), &[], 40));
    for overrides in
        [&[][..], &["numerics.integrator=paper"], &["numerics.face_velocity=cell"], &["numerics.limiter=false"]]
    {
        sleeps(same_bits("plane", &blast(2, [240, 160, 1], ""), overrides, 24));
    }
    for overrides in [
        &["numerics.pair=b2b1"][..],
        &["numerics.integrator=ars222", "time.cfl=0.4"],
        &["numerics.filter=0.1", "numerics.limiter=false"],
        &["gravity=[0.0, -0.1]"],
    ] {
        same_bits("plane", &blast(2, [160, 96, 1], ""), overrides, 24);
    }
}

/// Steps that from some on take more iterations than sleepers may sleep through, and than would not reach them.
#[test]
fn a_long_solve_wakes_all() {
    let weak = blast(2, [320, 160, 1], "").replace("pressure = 10.0", "pressure = 0.11");
    let some = same_bits("plane", &weak, &[LATER], 12);
    assert!(some.is_none_or(|some| some.asleep > 0 && some.woken), "nothing slept, or nothing was woken");
}

#[test]
fn open_and_periodic_sides_obstacles_and_bodies() {
    let inlet = "[boundary]\nx_max = { inlet = { density = 0.2, velocity = [-0.5, 0.0], pressure = 0.2 } }\n";
    let around = "[boundary]\ny_min = \"periodic\"\ny_max = \"periodic\"\n";
    let obstacle = "[[obstacles]]\nname = \"post\"\nshape = { sphere = { center = [1.0, 1.0], radius = 0.2 } }\n";
    let body = "[materials.stuff]\nneo_hookean = { young_modulus = 50.0, poisson_ratio = 0.3 }\n[[bodies]]\nname = \"ball\"\n\
                material = \"stuff\"\ndensity = 2.0\nparticles_per_cell = 2\n\
                shape = { sphere = { center = [0.5, 0.5], radius = 0.1 } }\n";
    for (name, more) in [("open", OPEN), ("inlet", inlet), ("periodic", around), ("obstacle", obstacle), ("body", body)]
    {
        same_bits(name, &blast(2, [160, 128, 1], more), &[], 24);
    }
}

#[test]
fn space() {
    let text = blast(3, [40, 48, 80], OPEN);
    sleeps(same_bits("space", &blast(3, [40, 48, 120], ""), &[], 6));
    same_bits("space", &text, &[], 6);
    same_bits("space", &text, &["numerics.face_velocity=cell"], 4);
}

/// As on a GPU.
#[test]
fn short_marches() {
    same_bits_in_marches("plane", &blast(2, [160, 96, 1], ""), &[], 24, 4);
    same_bits_in_marches("space", &blast(3, [40, 48, 80], OPEN), &[], 4, 4);
}

/// Gas that moves at once beside gas at rest: what goes wrong within the reach of one step shows in the first one. In y the halo
/// is as wide as written (see SPAN in shaders/still.wgsl).
#[test]
fn fronts() {
    let front = "[[gas.regions]]\nshape = { sphere = { center = [0.35, 0.4, 0.7], radius = 0.15 } }\ndensity = 0.5\n\
                 velocity = [2.0, -3.0, 2.5]\npressure = 0.1\n";
    for overrides in [&[][..], &["numerics.face_velocity=cell"], &["numerics.integrator=ars222", "time.cfl=0.4"]] {
        same_bits("front", &blast(3, [56, 64, 128], front), overrides, 2);
    }
}
