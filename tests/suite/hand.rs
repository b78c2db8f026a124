//! What the mouse does to bodies: they are pushed, thrown, and go back to where they were.

use brisance::diagnostics::StepRecord;
use brisance::expect::Budget;
use brisance::scene::{Probe, Scene};
use brisance::simulation::{Blast, Simulation};
use brisance::viewer::session::Session;

use crate::common::gpu_or_skip;

/// Two bodies in still gas; a part of the second is clamped.
fn scene(dimension: usize) -> Scene {
    let (cells, edges) = (vec![16; dimension], vec![1.0; dimension]);
    let at = |x: f64, y: f64| format!("{:?}", &[x, y, 0.5][..dimension]);
    let text = format!(
        "title = \"Two bodies\"\n\
         domain = {{ dimension = {dimension}, cells = {cells:?}, size = {edges:?} }}\n\
         gas.ambient = {{ density = 1.2, pressure = 1.0e5 }}\n\
         time = {{ until = 0.01, frames = 1, fixed_step = 2.0e-5 }}\n\
         render.size = [200, 150]\n\
         [materials.rubber]\nneo_hookean = {{ young_modulus = 1.0e7, poisson_ratio = 0.3 }}\n\
         [[bodies]]\nname = \"lump\"\nshape.sphere = {{ center = {}, radius = 0.15 }}\nmaterial = \"rubber\"\n\
         density = 1000.0\n\
         [[bodies]]\nname = \"post\"\nshape.sphere = {{ center = {}, radius = 0.13 }}\nmaterial = \"rubber\"\n\
         density = 2000.0\nclamped.sphere = {{ center = {}, radius = 0.08 }}\n",
        at(0.35, 0.5),
        at(0.75, 0.7),
        at(0.75, 0.7),
    );
    Scene::parse(&text, "two.toml", &[]).expect("the scene of the test is valid")
}

/// Momentum of a body \[kg m s^-1\], and the kinetic energy of all \[J\].
fn momentum(simulation: &Simulation, body: u32) -> ([f64; 3], f64) {
    let particles = simulation.snapshot().unwrap().particles;
    let mut sum = [0.0; 3];
    for particle in particles.iter().filter(|particle| particle.body == body) {
        (0..3).for_each(|d| sum[d] += f64::from(particle.mass) * f64::from(particle.velocity[d]));
    }
    (sum, particles.iter().map(|particle| f64::from(particle.kinetic_energy)).sum())
}

fn advance(simulation: &mut Simulation, steps: usize) -> Vec<StepRecord> {
    let mut records = Vec::new();
    while records.len() < steps {
        let left = (steps - records.len()) as u32;
        simulation.advance_batch_of(&mut records, left).unwrap();
    }
    records
}

#[test]
fn a_push_gives_the_momentum_that_it_books_and_the_budgets_close() {
    let Some(gpu) = gpu_or_skip() else { return };
    for dimension in [2, 3] {
        let scene = scene(dimension);
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        simulation.set_target(scene.time.until).unwrap();
        advance(&mut simulation, 3);
        let before = (momentum(&simulation, 0), momentum(&simulation, 1).0);
        let budget = Budget::read(&simulation, &scene, 0.0).unwrap();
        let change = [3.0, -2.0, if dimension == 3 { 1.0 } else { 0.0 }];
        let given = simulation.push(0, change, &mut Vec::new()).unwrap();
        let (after, mass) = (momentum(&simulation, 0), simulation.moving(0, &mut Vec::new()).unwrap()[3]);
        let size = 3.0 * mass;
        for axis in 0..3 {
            let gained = after.0[axis] - before.0.0[axis];
            assert!((gained - given[axis]).abs() < 1e-4 * size, "{dimension}D: {gained} instead of {given:?}");
            assert!((given[axis] - mass * change[axis]).abs() < 1e-4 * size, "{dimension}D: {given:?}, {mass} kg");
        }
        assert!((after.1 - before.0.1 - given[3]).abs() < 1e-4 * given[3], "{dimension}D: energy {given:?}");
        assert_eq!(momentum(&simulation, 1).0, before.1, "the other body");
        let now = Budget::read(&simulation, &scene, 0.0).unwrap();
        assert!((now.energy - budget.energy).abs() < 1e-4 * given[3], "{dimension}D: {} J", now.energy - budget.energy);
        let lost: Vec<f64> = (0..3).map(|axis| now.momentum[axis] - budget.momentum[axis]).collect();
        assert!(lost.iter().all(|part| part.abs() < 1e-4 * size), "{dimension}D: {lost:?} kg m/s");
        let record = advance(&mut simulation, 1).pop().unwrap();
        let [x, y, _] = record.given.momentum.map(f64::from);
        assert!((x - given[0]).abs() < 0.02 * size && (y - given[1]).abs() < 0.02 * size, "{:?}", record.given);
    }
}

#[test]
fn what_is_clamped_is_not_pushed_and_nonsense_is_refused() {
    let Some(gpu) = gpu_or_skip() else { return };
    let mut simulation = Simulation::new(&gpu, &scene(2)).unwrap();
    let particles = simulation.snapshot().unwrap().particles;
    let whole: f64 = particles.iter().filter(|one| one.body == 1).map(|one| f64::from(one.mass)).sum();
    let free = simulation.moving(1, &mut Vec::new()).unwrap()[3];
    assert!(free > 0.3 * whole && free < 0.9 * whole, "{free} of {whole} kg are free");
    let given = simulation.push(1, [1.0, 0.0, 0.0], &mut Vec::new()).unwrap();
    assert!((given[0] - free).abs() < 1e-4 * free, "{given:?}");
    let mut refused = |body, change| simulation.push(body, change, &mut Vec::new()).unwrap_err().to_string();
    assert!(refused(2, [1.0, 0.0, 0.0]).contains("this scene has 2"));
    assert!(refused(0, [f64::NAN, 0.0, 0.0]).contains("finite"));
    assert!(refused(0, [0.0, 0.0, 1.0]).contains("across the domain"));
}

/// The place of a body's middle in the picture, as a share.
fn place(session: &Session, body: u32) -> [f64; 2] {
    let look = session.look();
    let particles = session.simulation().snapshot().unwrap().particles;
    let mut best = ([0.0; 2], f64::INFINITY);
    // the place from which the mouse finds the particle nearest to the middle
    let own: Vec<_> = particles.iter().filter(|one| one.body == body).collect();
    let middle: [f32; 3] =
        std::array::from_fn(|d| own.iter().map(|one| one.position[d]).sum::<f32>() / own.len() as f32);
    for x in 0..40 {
        for y in 0..40 {
            let at = [(f64::from(x) + 0.5) / 40.0, (f64::from(y) + 0.5) / 40.0];
            let spot = session.spot(at, &look).unwrap();
            let away: f64 = spot.point.iter().zip(middle).map(|(a, b)| (a - f64::from(b)).powi(2)).sum();
            if spot.body.is_some() && away < best.1 {
                best = (at, away);
            }
        }
    }
    best.0
}

#[test]
fn a_body_is_held_led_thrown_and_taken_back() {
    let Some(gpu) = gpu_or_skip() else { return };
    for dimension in [2, 3] {
        let scene = scene(dimension);
        let (mut session, mut alone) =
            (Session::open(&gpu, scene.clone()).unwrap(), Session::open(&gpu, scene).unwrap());
        let look = session.look();
        let mut records = (Vec::new(), Vec::new());
        while records.0.len() < 4 {
            session.advance(1, &mut records.0).unwrap();
        }
        while records.1.len() < 24 {
            alone.advance(1, &mut records.1).unwrap();
        }
        assert_eq!(session.hold([0.99, 0.99], &look, &mut records.0).unwrap(), None);
        let at = place(&session, 0);
        assert_eq!(session.hold(at, &look, &mut records.0).unwrap().as_deref(), Some("lump"));
        let held = (session.time(), session.step_count());
        let seen = session.held_at(&look).unwrap();
        assert!((seen[0] - at[0]).abs() < 0.06 && (seen[1] - at[1]).abs() < 0.06, "{dimension}D: {seen:?}, not {at:?}");
        let start = momentum(session.simulation(), 0).0;
        session.lead([at[0] + 0.2, at[1]], &look);
        while records.0.len() < 24 {
            session.advance(1, &mut records.0).unwrap();
        }
        let end = momentum(session.simulation(), 0).0;
        let size =
            |one: [f64; 3], other: [f64; 3]| one.iter().zip(other).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        let given = f64::from(records.0[23].given.momentum[0]) - f64::from(records.1[23].given.momentum[0]);
        assert!(size(end, start) > 1.0 && given.abs() > 0.5 * size(end, start), "{dimension}D: {start:?} {end:?}");
        assert_eq!(session.let_go(&mut records.0).unwrap(), None, "it goes on as it moves");
        assert!(session.held_at(&look).is_none());
        // back to where it was held: on from there as if it had never been pushed
        assert_eq!((session.rewind(held.0).unwrap(), session.step_count()), held);
        let mut again = Vec::new();
        while again.len() < 20 {
            session.advance(1, &mut again).unwrap();
        }
        assert!(again[..] == records.1[4..], "{dimension}D: the same steps as without a push");
        // a throw between two steps, taken back as well
        let before = momentum(session.simulation(), 0).0;
        let at = place(&session, 0);
        session.hold(at, &look, &mut again).unwrap();
        session.lead([at[0], at[1] - 0.2], &look);
        let thrown = session.let_go(&mut again).unwrap().expect("a throw");
        let gained = size(momentum(session.simulation(), 0).0, before);
        assert!((gained - size(thrown, [0.0; 3])).abs() < 1e-4 * gained && session.is_touched(), "{thrown:?} {gained}");
        session.rewind(session.time()).unwrap();
        assert_eq!((momentum(session.simulation(), 0).0, session.is_touched()), (before, false));
    }
}

#[test]
fn bodies_get_heavier_and_stiffer_between_steps_and_the_sums_book_it() {
    let Some(gpu) = gpu_or_skip() else { return };
    for dimension in [2, 3] {
        let scene = scene(dimension);
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        simulation.set_target(scene.time.until).unwrap();
        simulation.push(0, [3.0, 1.0, 0.0], &mut Vec::new()).unwrap();
        advance(&mut simulation, 6);
        let mass = |simulation: &Simulation, body| {
            let particles = simulation.snapshot().unwrap().particles;
            particles.iter().filter(|one| one.body == body).map(|one| f64::from(one.mass)).sum::<f64>()
        };
        let before = (mass(&simulation, 0), mass(&simulation, 1), momentum(&simulation, 0).0, simulation.given());
        let saved = simulation.save().unwrap();
        let mut heavy = scene.clone();
        heavy.bodies[0].density = Some(2500.0);
        let gained = simulation.alter(&scene, &heavy, &mut Vec::new()).unwrap();
        let after = (mass(&simulation, 0), mass(&simulation, 1), momentum(&simulation, 0).0, simulation.given());
        assert!((after.0 - 2.5 * before.0).abs() < 1e-5 * after.0 && after.1 == before.1, "{dimension}D: {after:?}");
        assert!((gained - 1.5 * before.0).abs() < 1e-5 * after.0, "{dimension}D: {gained} kg");
        let moved = after.2[0] - before.2[0];
        assert!((moved - 1.5 * before.2[0]).abs() < 1e-4 * moved, "{dimension}D: the velocity stays: {moved}");
        assert!((after.3[0] - before.3[0] - moved).abs() < 1e-4 * moved, "{dimension}D: {:?}", after.3);
        // a state of before has the density of now
        simulation.restore(&saved).unwrap();
        assert!((mass(&simulation, 0) - after.0).abs() < 1e-6 * after.0, "{dimension}D");
        let mut stiff = heavy.clone();
        let rubber = stiff.materials.get_mut("rubber").unwrap();
        *rubber = rubber.with("young_modulus", 4.0e7);
        let energy = simulation.given()[3];
        assert_eq!(simulation.alter(&heavy, &stiff, &mut Vec::new()).unwrap(), 0.0);
        assert!(simulation.given()[3] > energy, "{dimension}D: strain that gets stiffer takes energy");
        let laws = (scene.material_parameters()[0], stiff.material_parameters()[0]);
        assert!((laws.1.mu - 4.0 * laws.0.mu).abs() < 1e-3 * laws.1.mu);
        // light bodies of stiff material move otherwise from the next step on
        let records = advance(&mut simulation, 3);
        assert!(records.iter().all(|record| record.solid.energy.is_finite()), "{records:?}");
        let mut other = stiff.clone();
        other.bodies[0].velocity = [1.0, 0.0, 0.0];
        let refused = simulation.alter(&stiff, &other, &mut Vec::new()).unwrap_err().to_string();
        assert!(refused.contains("restart it for the rest"), "{refused}");
        other = stiff.clone();
        other.bodies[0].density = Some(-1.0);
        let refused = simulation.alter(&stiff, &other, &mut Vec::new()).unwrap_err();
        assert!(matches!(refused, brisance::Error::Usage(_)) && refused.to_string().contains("density"), "{refused}");
    }
}

#[test]
fn a_probe_that_comes_later_sees_what_one_of_the_start_sees() {
    let Some(gpu) = gpu_or_skip() else { return };
    for dimension in [2, 3] {
        let scene = scene(dimension);
        let mut with = scene.clone();
        let half = if dimension == 3 { 0.5 } else { 0.0 };
        let probe = |name: &str, x: f64| Probe { name: name.to_owned(), position: [x, 0.2, half] };
        with.probes = vec![probe("first", 0.2)];
        let blast = Blast { center: [0.2, 0.2, half], radius: 0.15, energy: 2e4 };
        let run = |from_start: bool| {
            let mut simulation = Simulation::new(&gpu, if from_start { &with } else { &scene }).unwrap();
            simulation.set_target(scene.time.until).unwrap();
            simulation.detonate(&blast, &mut Vec::new()).unwrap();
            let mut records = advance(&mut simulation, 3);
            if !from_start {
                simulation.alter(&scene, &with, &mut records).unwrap();
            }
            records.extend(advance(&mut simulation, 4));
            let mut two = with.clone();
            two.probes.insert(0, probe("second", 0.8));
            simulation.alter(&with, &two, &mut records).unwrap();
            records.extend(advance(&mut simulation, 2));
            records
        };
        let (late, early) = (run(false), run(true));
        assert!(late[..3].iter().all(|record| record.probes.is_empty()), "{:?}", late[0].probes);
        assert!(late[3..] == early[3..], "{dimension}D: a probe changes nothing");
        assert!(late[6].probes[0].pressure > 1.1e5 && late[8].probes[1].pressure > 1.1e5, "{:?}", late[8].probes);
        assert!((late[8].probes[0].pressure - 1.0e5).abs() < 1.0, "far away: {:?}", late[8].probes);
        let mut outside = with.clone();
        outside.probes[0].position[0] = 7.0;
        let refused = Simulation::new(&gpu, &with).unwrap().alter(&with, &outside, &mut Vec::new()).unwrap_err();
        assert!(matches!(refused, brisance::Error::Usage(_)), "{refused}");
    }
}

#[test]
fn a_hidden_body_is_not_drawn_and_not_hit_and_a_colour_is_another() {
    let Some(gpu) = gpu_or_skip() else { return };
    for dimension in [2, 3] {
        let mut session = Session::open(&gpu, scene(dimension)).unwrap();
        let mut look = session.look();
        look.settings.light.shadows = false;
        let at = place(&session, 0);
        let pixel = |session: &mut Session| {
            let frame = session.draw(&look).unwrap().frame;
            let [x, y] = [at[0] * f64::from(frame.width), at[1] * f64::from(frame.height)].map(|place| place as usize);
            let start = 4 * (y * frame.width as usize + x);
            [frame.rgba[start], frame.rgba[start + 1], frame.rgba[start + 2]]
        };
        let before = pixel(&mut session);
        let mut green = (**session.scene()).clone();
        green.bodies[0].color = Some(brisance::scene::Color([0, 255, 0]));
        session.change(green, &mut Vec::new()).unwrap();
        let [red, green, blue] = pixel(&mut session);
        assert!(green > 60 && green > 2 * red && green > 2 * blue, "{dimension}D: {:?}", [red, green, blue]);
        session.hide(vec![0]);
        let hidden = pixel(&mut session);
        assert!(hidden != before && hidden != [red, green, blue], "{dimension}D: {hidden:?}");
        assert!(session.spot(at, &look).unwrap().body.is_none(), "{dimension}D: it is looked through");
        session.hide(Vec::new());
        assert_eq!(pixel(&mut session), [red, green, blue]);
    }
}
