//! What the mouse does to bodies: they are pushed, thrown, and go back to where they were.

use brisance::diagnostics::StepRecord;
use brisance::expect::Budget;
use brisance::scene::Scene;
use brisance::simulation::Simulation;
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
