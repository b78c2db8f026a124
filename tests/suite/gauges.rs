//! Gauges on walls, obstacles, bodies and points of bodies: against the budgets of the gas, of the bodies, and the state itself.

use brisance::diagnostics::StepRecord;
use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::cli::{SmallRun, fails, report, small_run, succeeds, table};
use crate::common::gpu_or_skip;

const TUBE: &str = "title = \"gauges\"\n[domain]\ndimension = 1\ncells = [50]\nsize = [1.0]\n\
    [[gas.regions]]\nshape = { half_space = { point = [0.5], normal = [1.0] } }\ndensity = 1.0\npressure = 1.0\n\
    [gas]\nambient = { density = 0.125, pressure = 0.1 }\n\
    [[gauges]]\nname = \"low\"\nside = \"x_min\"\n[[gauges]]\nname = \"high\"\nside = \"x_max\"\n";

fn scene(text: &str) -> Scene {
    Scene::parse(text, "gauges.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn advance(text: &str, until: f64) -> Option<(Simulation, Vec<StepRecord>)> {
    let gpu = gpu_or_skip()?;
    let mut simulation = Simulation::new(&gpu, &scene(text)).unwrap_or_else(|error| panic!("{error}"));
    let records = simulation.advance_to(until).unwrap_or_else(|error| panic!("{error}"));
    Some((simulation, records))
}

/// A shock meets the far wall of a closed tube: what both walls bear changes the momentum of the gas, in every step, with one solve a step
/// and with two; walls of gas at rest bear its pressure.
#[test]
fn the_walls_of_a_tube_bear_what_the_gas_loses() {
    for numerics in ["", "integrator = \"ars222\"\n", "pair = \"b2b1\"\n"] {
        let text = format!("{TUBE}[numerics]\ntolerance = 1e-7\n{numerics}[time]\nuntil = 0.4\n");
        let Some((_, records)) = advance(&text, 0.4) else { return };
        let mut impulse = 0.0;
        for record in &records {
            let [low, high] = record.loads[..] else { panic!("two walls") };
            impulse += f64::from(record.dt) * f64::from(low.force[0] + high.force[0]);
            let momentum = f64::from(record.gas.momentum[0]);
            assert!((momentum + impulse).abs() < 2e-5, "{numerics}: {momentum} and {impulse}");
        }
        let (first, last) = (&records[0].loads, &records[records.len() - 1].loads);
        assert!((first[0].force[0] + 1.0).abs() < 1e-4 && (first[1].force[0] - 0.1).abs() < 1e-5, "{first:?}");
        assert!((first[1].pressure - 0.1).abs() < 1e-5 && first[1].area == 1.0, "{first:?}");
        assert!(last[1].pressure > 0.5, "the shock is reflected: {last:?}");
    }
}

/// In a box at rest each wall bears its length times the pressure, in its middle.
#[test]
fn walls_of_a_box_at_rest_bear_its_pressure() {
    let mut text = "title = \"box\"\n[domain]\ndimension = 2\ncells = [12, 8]\nsize = [1.2, 0.8]\n[gas]\n\
        ambient = { density = 1.0, pressure = 2.0 }\n[time]\nuntil = 0.1\n"
        .to_owned();
    for side in ["x_min", "x_max", "y_min", "y_max"] {
        text += &format!("[[gauges]]\nname = \"{side}\"\nside = \"{side}\"\n");
    }
    let Some((_, records)) = advance(&text, 0.1) else { return };
    for record in &records {
        let forces: Vec<[f32; 2]> = record.loads.iter().map(|load| [load.force[0], load.force[1]]).collect();
        let right = [[-1.6f32, 0.0], [1.6, 0.0], [0.0, -2.4], [0.0, 2.4]];
        let near = |a: f32, b: f32| (a - b).abs() < 1e-4;
        for ((force, right), load) in forces.iter().zip(right).zip(&record.loads) {
            assert!(near(force[0], right[0]) && near(force[1], right[1]), "{force:?}, not {right:?}");
            assert!(near(load.pressure, 2.0), "{load:?}");
        }
        // x F_y - y F_x
        assert!(near(record.loads[1].moment[2], -0.64) && near(record.loads[3].moment[2], 1.44), "{:?}", record.loads);
    }
}

/// A block of rubber that nothing holds, hit by a shock.
const BLOCK: &str = "title = \"block\"\n[domain]\ndimension = 2\ncells = [32, 16]\nsize = [2.0, 1.0]\n\
    [[gas.regions]]\nshape = { half_space = { point = [0.6, 0.0], normal = [1.0, 0.0] } }\ndensity = 3.0\npressure = 4.0\n\
    [gas]\nambient = { density = 1.0, pressure = 1.0 }\n[time]\nuntil = 0.3\n\
    [materials.rubber.neo_hookean]\nyoung_modulus = 100.0\npoisson_ratio = 0.3\n\
    [[bodies]]\nname = \"block\"\nmaterial = \"rubber\"\ndensity = 5.0\n\
    shape = { box = { center = [1.0, 0.45], size = [0.4, 0.3] } }\n\
    [[gauges]]\nname = \"all\"\nbody = \"block\"\n\
    [[gauges]]\nname = \"corner\"\nbody = \"block\"\npoint = [1.2, 0.6]\n";

/// The impulse of the gas is the momentum of a body that nothing else pushes; a point of it is the particle that is there.
#[test]
fn a_free_body_gets_the_impulse_that_its_gauge_shows() {
    let Some((simulation, records)) = advance(BLOCK, 0.3) else { return };
    let mut impulse = [0.0; 2];
    for record in &records {
        let load = record.loads[0];
        (0..2).for_each(|axis| impulse[axis] += f64::from(record.dt) * f64::from(load.force[axis]));
    }
    let solid = records[records.len() - 1].solid.momentum.map(f64::from);
    assert!(solid[0] > 0.05, "{solid:?}");
    assert!((impulse[0] - solid[0]).abs() < 0.02 * solid[0], "{impulse:?} and {solid:?}");

    let scene = scene(BLOCK);
    let distance = |place: [f64; 3]| (place[0] - 1.2).powi(2) + (place[1] - 0.6).powi(2);
    let seeds = scene.seed_particles();
    let nearest = (0..seeds.len()).min_by(|a, b| distance(seeds[*a].position).total_cmp(&distance(seeds[*b].position)));
    let (start, snapshot) = (seeds[nearest.unwrap()].position, simulation.snapshot().unwrap());
    let particle = snapshot.particles.iter().find(|particle| particle.index as usize == nearest.unwrap()).unwrap();
    let point = records[records.len() - 1].points[0];
    assert_eq!((point.velocity, point.stress, point.damage), (particle.velocity, particle.stress, 0.0));
    for ((place, start), own) in particle.position.iter().zip(start).zip(point.displacement) {
        assert!((f64::from(own) - (f64::from(*place) - start)).abs() < 1e-6, "{point:?}");
    }
    assert!(
        point.displacement[0] > 1e-3 && point.elastic_strain[0] != 0.0 && records.iter().all(|r| r.points.len() == 1)
    );
}

/// Gauges change nothing of the gas and the bodies.
#[test]
fn gauges_move_no_bit() {
    let without = &BLOCK[..BLOCK.find("[[gauges]]").unwrap()];
    let Some((one, _)) = advance(BLOCK, 0.1) else { return };
    let Some((two, _)) = advance(without, 0.1) else { return };
    // as text, where a velocity in covered cells that is no number equals itself
    assert!(format!("{:?}", one.snapshot().unwrap()) == format!("{:?}", two.snapshot().unwrap()));
}

const GAUGES: &str = "\n[[gauges]]\nname = \"wall\"\nside = \"x_min\"\nabout = [0.0, 1.0]\n[[gauges]]\nname = \"block\"\nbody = \"block\"\n\
    [[gauges]]\nname = \"tip\"\nbody = \"block\"\npoint = [1.5, 0.5]\n";

#[test]
fn gauges_have_a_table_and_plots_and_go_on() {
    let Some(SmallRun { scene, out, folder }) = small_run() else { return };
    // the shock does not get as far: the block moves, or nothing would strain it
    let text =
        std::fs::read_to_string(&scene).unwrap().replace("density = 5.0\n", "density = 5.0\nvelocity = [0.1, 0.0]\n");
    std::fs::write(&scene, text + GAUGES).unwrap();
    let target = out.to_str().unwrap();
    succeeds(&["run", &scene, "--out", target, "--no-expect"]);
    let (header, rows) = table(&out.join("gauges.csv"));
    let column = |name: &str| header.iter().position(|own| own == name).unwrap_or_else(|| panic!("{name}"));
    let last = rows.last().unwrap();
    // gas of pressure 2 on one metre for 0.02 s, in the middle half a metre below
    assert!((last[column("wall_force_x")] + 2.0).abs() < 1e-3 && (last[column("wall_impulse_x")] + 0.04).abs() < 1e-4);
    assert!((last[column("wall_moment_z")] + 1.0).abs() < 1e-3, "{}", last[column("wall_moment_z")]);
    assert!(last[column("tip_stress_xx")] != 0.0 && last[column("block_pressure")] > 0.9);
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    for part in ["Gauge wall", "Force on block", "Displacement of tip", "Elastic strain of tip", "Stress of tip"] {
        assert!(page.contains(part), "{part}");
    }
    assert!((report(&out)["gauges"]["wall"]["peak"].as_f64().unwrap() - 2.0).abs() < 1e-2);
    // in two parts: the same table
    let halves = folder.path().join("halves");
    let half = halves.to_str().unwrap();
    let set = ["--set", "time.frames=1", "--until", "0.01", "--no-expect", "--checkpoint", "5steps"];
    succeeds(&[&["run", &scene, "--out", half][..], &set].concat());
    succeeds(&["run", "--resume", half, "--until", "0.02"]);
    let (_, again) = table(&halves.join("gauges.csv"));
    let (time, impulse) = (column("time"), column("wall_impulse_x"));
    let end = again.last().unwrap();
    assert!((end[time] - 0.02).abs() < 1e-9 && (end[impulse] + 0.04).abs() < 1e-4, "{end:?}");
    assert!(again.windows(2).all(|pair| pair[1][0] == pair[0][0] + 1.0));
}

#[test]
fn gauges_on_nothing_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let outlet = "[boundary]\nx_max = \"outlet\"\n";
    for (gauge, told) in [
        ("name = \"a\"", "it is not said what the gauge sits on"),
        ("name = \"a\"\nside = \"x_min\"\nbody = \"block\"", "or more than one thing"),
        ("name = \"a\"\nside = \"z_min\"", "the domain has no such axis"),
        ("name = \"a\"\nside = \"x_max\"", "no part of this side is a wall"),
        ("name = \"a\"\nobstacle = \"block\"", "unknown obstacle `block`"),
        ("name = \"a\"\nbody = \"blok\"", "unknown body `blok`"),
        ("name = \"a\"\nbody = \"block\"\npoint = [0.2, 0.5]", "lies outside of `block`"),
        ("name = \"a\"\nside = \"x_min\"\npoint = [0.2, 0.5]", "walls and obstacles do not move"),
        ("name = \"all\"\nside = \"x_min\"", "`all` is taken"),
        ("name = \"a\"\nside = \"left\"", "unknown variant `left`"),
    ] {
        std::fs::write(&path, format!("{BLOCK}[[gauges]]\n{gauge}\n{outlet}")).unwrap();
        let said = fails(3, &["check", path.to_str().unwrap()]);
        assert!(said.contains(told), "{gauge}: {said}");
    }
}
