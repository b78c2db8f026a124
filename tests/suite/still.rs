//! Still air: leaving out what nothing happens in changes no bit.

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

/// All that a run leaves, and most rows of blocks that the advection left out in one step. `skip`: leaves out what it may, or nothing.
fn run(gpu: &Gpu, text: &str, overrides: &[String], steps: u32, march: u32, skip: bool) -> (Vec<Vec<u32>>, u32) {
    let scene = Scene::parse(text, "still.toml", overrides).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(gpu, &scene).unwrap();
    if !skip {
        simulation.state.params.still = 0;
    }
    if march > 0 {
        simulation.state.params.march = march;
    }
    simulation.state.params_buffer.write(gpu, 0, &[simulation.state.params]);
    simulation.set_target(1.0).unwrap();
    let (mut records, mut left_out, mut blasted) = (Vec::new(), 0, false);
    while records.len() < steps as usize {
        simulation.advance_batch_of(&mut records, 1).unwrap();
        let params = &simulation.state.params;
        let words = readback::read(gpu, &simulation.state.interface.extra).unwrap();
        let lines = params.stride[scene.domain.axes() - 1];
        let blocks = (params.slots / lines).div_ceil(8) * lines.div_ceil(params.march);
        let rows = &words[params.still_at as usize..][..blocks as usize];
        let others = !((1 << params.march) - 1);
        assert!(rows.iter().all(|word| word & others == 0), "rows that a block of {} has not", params.march);
        left_out = left_out.max(rows.iter().map(|word| (!word & ((1 << params.march) - 1)).count_ones()).sum());
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

fn same_bits(name: &str, text: &str, overrides: &[&str], steps: u32) {
    same_bits_in_marches(name, text, overrides, steps, 0);
}

/// Columns of `march` slots, or with 0 as many as the device likes.
fn same_bits_in_marches(name: &str, text: &str, overrides: &[&str], steps: u32, march: u32) {
    let Some(gpu) = gpu_or_skip() else { return };
    let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
    let (full, none) = run(&gpu, text, &overrides, steps, march, false);
    let (less, some) = run(&gpu, text, &overrides, steps, march, true);
    eprintln!("{name} {overrides:?}: {some} rows");
    let moves = overrides.iter().any(|text| text.starts_with("gravity"));
    assert!(none == 0 && (some > 0 || moves), "{name} {overrides:?}: {none} and {some} rows left out");
    for (part, (a, b)) in full.iter().zip(&less).enumerate() {
        let first = a.iter().zip(b).position(|(a, b)| a != b);
        assert_eq!(first, None, "{name} {overrides:?}: first word of part {part} that differs");
    }
}

const OPEN: &str = "[boundary]\nx_max = \"outlet\"\n";

#[test]
fn a_line_and_a_plane() {
    same_bits("line", &blast(1, [4096, 1, 1], ""), &[], 40);
    for overrides in [&[][..], &["numerics.integrator=paper"], &["numerics.paper.face_velocity=cell"]] {
        same_bits("plane", &blast(2, [240, 160, 1], ""), overrides, 24);
    }
    for overrides in [
        &["numerics.pair=b2b1"][..],
        &["numerics.integrator=ars222", "time.cfl=0.4"],
        &["numerics.filter=0.1"],
        &["gravity=[0.0, -0.1]"],
    ] {
        same_bits("plane", &blast(2, [160, 96, 1], ""), overrides, 24);
    }
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
    same_bits("space", &blast(3, [40, 48, 120], ""), &[], 6);
    same_bits("space", &text, &[], 6);
    same_bits("space", &text, &["numerics.paper.face_velocity=cell"], 4);
}

/// As on a GPU.
#[test]
fn short_marches() {
    same_bits_in_marches("plane", &blast(2, [160, 96, 1], ""), &[], 24, 4);
    same_bits_in_marches("space", &blast(3, [40, 48, 80], OPEN), &[], 4, 4);
}

/// Slots that motion gets on in a step of so many iterations: residual of the solve, momentum, energy. Seven until the solve, as counted in
/// shaders/gas/still.wgsl; one each for the pressure of the predictor, that of the vertices and the right-hand side; one per iteration; and for
/// the energy one each for the carrier and what that brings through a face.
fn counted(iterations: u32) -> [u32; 3] {
    [7 + 3 + iterations, 7 + 3 + iterations, 7 + 3 + iterations + 2]
}

/// How far from a band of moving gas in y one step has changed the same, with nothing left out; and its iterations. The gas
/// has even pressure and another density in every cell, so that nothing hides what a face passes.
fn reached(gpu: &Gpu, overrides: &[String]) -> ([u32; 3], u32) {
    const BAND: [u32; 2] = [60, 68];
    let text = blast(2, [24, 128, 1], "fixed_step = 0.02\n").replace("pressure = 10.0", "pressure = 0.1");
    let scene = Scene::parse(&text, "band.toml", overrides).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(gpu, &scene).unwrap();
    simulation.state.params.still = 0;
    simulation.state.params_buffer.write(gpu, 0, &[simulation.state.params]);
    let [stride, rows, _] = simulation.state.params.stride;
    let mut random = 1_u32;
    let mut share = || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        random as f32 / u32::MAX as f32
    };
    let mut conserved = readback::read(gpu, &simulation.state.gas.conserved).unwrap();
    let mut energy = readback::read(gpu, &simulation.state.gas.energy).unwrap();
    for slot in 0..(stride * rows) as usize {
        if conserved[slot][0] == 0.0 {
            continue; // beyond the walls
        }
        conserved[slot] = [0.1 + share(), 0.0, 0.0, 0.0];
        energy[slot] = 0.25;
        if (BAND[0] + 1..=BAND[1]).contains(&(slot as u32 / stride)) {
            let velocity = [0.8 * share() - 0.4, 0.8 * share() - 0.4];
            let momentum = velocity.map(|v| v * conserved[slot][0]);
            energy[slot] += 0.5 * (momentum[0] * velocity[0] + momentum[1] * velocity[1]);
            conserved[slot] = [conserved[slot][0], momentum[0], momentum[1], 0.0];
        }
    }
    simulation.state.gas.conserved.write(gpu, 0, &conserved);
    simulation.state.gas.energy.write(gpu, 0, &energy);
    simulation.set_target(1.0).unwrap();
    let state = |simulation: &Simulation| {
        let gas = &simulation.state.gas;
        (readback::read(gpu, &gas.conserved).unwrap(), readback::read(gpu, &gas.energy).unwrap())
    };
    let before = state(&simulation);
    let mut records = Vec::new();
    simulation.advance_batch_of(&mut records, 1).unwrap();
    let after = state(&simulation);
    let residual = readback::read(gpu, &simulation.state.pcg.residual).unwrap();
    let mut far = [0; 3];
    for slot in 0..simulation.state.params.slots {
        let y = slot / stride;
        let distance = (BAND[0] + 1).saturating_sub(y).max((y + 1).saturating_sub(BAND[1] + 1));
        let at = slot as usize;
        let changed = [residual[at] != 0.0, before.0[at] != after.0[at], before.1[at] != after.1[at]];
        for (far, changed) in far.iter_mut().zip(changed) {
            *far = if changed { (*far).max(distance) } else { *far };
        }
    }
    (far, records[0].iterations)
}

/// The count by which gas is left out, and that it is not much too long.
#[test]
fn motion_gets_as_far_as_counted() {
    let Some(gpu) = gpu_or_skip() else { return };
    for overrides in [
        &[][..],
        &["numerics.integrator=paper"],
        &["numerics.paper.face_velocity=cell"],
        &["numerics.tolerance=1e-3"],
        &["numerics.tolerance=1e-7"],
    ] {
        let overrides: Vec<_> = overrides.iter().map(|&text| text.to_owned()).collect();
        let (far, iterations) = reached(&gpu, &overrides);
        let most = counted(iterations);
        eprintln!("{overrides:?}: {far:?} of {most:?} in {iterations} iterations");
        assert!(far.iter().zip(most).all(|(far, most)| *far <= most), "{overrides:?}: {far:?}, counted {most:?}");
        // By velocities, three or four slots nearer: small pressures are lost beside the large one, small velocities and residuals are not.
        assert!(far[0] + 4 >= most[0], "{overrides:?}: {far:?}, counted {most:?}");
    }
}

/// Gas that moves at once beside gas at rest: what goes wrong within the reach of one step shows in the first one. In y the halo
/// is as wide as written (see ADVECTION_SPAN in shaders/gas/still.wgsl).
#[test]
fn fronts() {
    let front = "[[gas.regions]]\nshape = { sphere = { center = [0.35, 0.4, 0.7], radius = 0.15 } }\ndensity = 0.5\n\
                 velocity = [2.0, -3.0, 2.5]\npressure = 0.1\n";
    for overrides in [&[][..], &["numerics.paper.face_velocity=cell"], &["numerics.integrator=ars222", "time.cfl=0.4"]]
    {
        same_bits("front", &blast(3, [56, 64, 128], front), overrides, 2);
    }
}
