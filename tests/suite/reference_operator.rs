//! The CPU reference piece by piece: pressure operator, element stencils, stress, plasticity, elastic waves.

use crate::common::Random;
use crate::reference_solids::lattice;
use crate::reference_tables::Noise;
use glam::DMat3;
use reference::gas::gas_advection;
use reference::gas::intermediate_pressure;
use reference::grid::Grid;
use reference::interface;
use reference::solid::g2p;
use reference::solid::material::Material;
use reference::solid::mpm_grid_update;
use reference::solid::p2g;
use reference::solid::particle_sort;
use reference::solve::coupled_solve::{Inputs, System, assemble, dot};
use reference::{Gas, Pair, Particle, Problem, SOLID, Shared, Side, State, internal_energy};

/// A random admissible scene in `dimension` axes: gas everywhere, a few bodies and fragments, an obstacle, open sides.
fn random_system(dimension: usize, pair: Pair, shared: Shared, seed: u64) -> System {
    let mut noise = Noise(seed);
    let cells = [12, 7, 5];
    let still = Side::far((1.0, [0.0; 3], 1.0));
    let inlet = Side::Inlet { density: 1.0, velocity: [0.3, 0.0, 0.0], pressure: 1.0 };
    let mut problem = Problem::new(
        Grid::new(&cells[..dimension], [0.0; 3], 0.1),
        [inlet, still, Side::Wall, Side::Wall, Side::Wall, still],
    );
    (problem.numerics.pair, problem.numerics.shared) = (pair, shared);
    problem.materials = vec![Material::new(50.0, 0.3, f64::INFINITY)];
    let obstacle = problem.grid.slot([9, i32::from(dimension > 1), 0]);
    problem.obstacles[obstacle] = true;
    let mut particles = lattice(&problem, 2, 5.0, |x| (x[0] > 0.2 && x[0] < 0.5) || (x[0] > 0.7 && x[0] < 0.8));
    particles.retain(|p| p.position.x < 0.6 && (dimension == 1 || p.position.y < 0.45) || noise.next() > 0.6);
    let mut state = State::new(&problem, |_| (1.0, [0.0; 3], 1.0), particles);
    for slot in 0..problem.grid.slots() {
        let v = [0, 1, 2].map(|d| if d < dimension { noise.next() } else { 0.0 });
        state.gas.set(slot, Gas::conserved_from_primitive(1.0 + 0.5 * noise.next(), v, 1.0 + 0.5 * noise.next(), 1.4));
    }
    for particle in &mut state.particles {
        particle.velocity.x = noise.next();
    }
    gas_advection::fill_ghosts(&problem, &state.cells, &mut state.gas);
    let (bins, nodes) = (particle_sort::bin(&problem, &state.particles), p2g::p2g(&problem, &state.particles));
    assert!(state.cells.contains(&SOLID));
    let faces = interface::interface(&problem, state.cells.clone(), &bins, &nodes);
    let intermediate =
        intermediate_pressure::intermediate(&problem, &faces, (&state.gas, &state.gas), None, &state.open, 0.05);
    let intermediate = &intermediate;
    assemble(&Inputs { problem: &problem, interface: &faces, bins: &bins, intermediate, nodes: &nodes, dt: 0.05 })
}

#[test]
fn operator_is_symmetric_and_positive() {
    for dimension in 1..=3 {
        for (pair, shared, seed) in
            [(Pair::B1b0, Shared::Resolved, 1), (Pair::B2b1, Shared::H, 2), (Pair::B1b0, Shared::Single, 3)]
        {
            let system = random_system(dimension, pair, shared, seed);
            let mut noise = Noise(seed + 10);
            let mut random = || -> Vec<f64> {
                system.diagonal.iter().map(|d| if *d > 0.0 { noise.next() / d.sqrt() } else { 0.0 }).collect()
            };
            let (x, y) = (random(), random());
            let (ax, ay) = (system.apply(&x), system.apply(&y));
            let (left, right) = (dot(&y, &ax), dot(&x, &ay));
            assert!((left - right).abs() < 1e-12 * dot(&x, &ax), "{left} {right}");
            assert!(dot(&x, &ax) > 0.0);
            for index in (0..system.diagonal.len()).filter(|i| system.diagonal[*i] > 0.0).step_by(7) {
                let mut unit = vec![0.0; system.diagonal.len()];
                unit[index] = 1.0;
                let entry = system.apply(&unit)[index];
                assert!((entry / system.diagonal[index] - 1.0).abs() < 1e-12);
            }
            let (_, iterations, converged) = system.solve(1e-8, 2000);
            println!("{dimension}D {pair:?} {shared:?}: {iterations} iterations to 1e-8");
            assert!(converged);
        }
    }
}

#[test]
fn interior_stencils() {
    for (pair, along, across) in [
        (Pair::B1b0, [0.0, -1.0, 1.0, 0.0], [0.0, 0.5, 0.5, 0.0]),
        (Pair::B2b1, [-1.0 / 6.0, -0.5, 0.5, 1.0 / 6.0], [1.0 / 24.0, 11.0 / 24.0, 11.0 / 24.0, 1.0 / 24.0]),
    ] {
        let mut problem = Problem::new(Grid::new(&[8, 8], [0.0; 3], 1.0), [Side::Wall; 6]);
        problem.numerics.pair = pair;
        let state = State::new(&problem, |_| (1.0, [0.0; 3], 1.0), Vec::new());
        let (bins, nodes) = (particle_sort::bin(&problem, &[]), p2g::p2g(&problem, &[]));
        let faces = interface::interface(&problem, state.cells.clone(), &bins, &nodes);
        let intermediate =
            &intermediate_pressure::intermediate(&problem, &faces, (&state.gas, &state.gas), None, &state.open, 0.1);
        let system = assemble(&Inputs {
            problem: &problem,
            interface: &faces,
            bins: &bins,
            intermediate,
            nodes: &nodes,
            dt: 0.1,
        });
        let row = system.rows.iter().find(|row| row.node == problem.grid.slot([4, 4, 0]) && row.axis == 0);
        let row = row.expect("an inner node has a row");
        for y in 0..4 {
            for x in 0..4 {
                let vertex = problem.grid.slot([3 + x, 3 + y, 0]);
                let value: f64 = row.entries.iter().filter(|e| e.0 == vertex).map(|e| e.1).sum();
                let expected = along[x as usize] * across[y as usize];
                assert!((value - expected).abs() < 1e-14, "{pair:?} {x} {y}: {value} {expected}");
            }
        }
    }
}

#[test]
fn stress_is_the_derivative_of_the_energy() {
    let material = Material::new(3.0, 0.3, f64::INFINITY);
    let energy = |f: DMat3| {
        let j = f.determinant();
        let square: f64 = f.to_cols_array().iter().map(|x| x * x).sum();
        let law = 0.5 * material.mu * (square - 3.0 - 2.0 * j.ln()) + 0.5 * material.elastic_lambda * j.ln().powi(2);
        law + material.ghost_energy(j)
    };
    let mut noise = Noise(3);
    for _ in 0..20 {
        let mut f = DMat3::IDENTITY;
        (0..3).for_each(|c| f.col_mut(c).as_mut().iter_mut().for_each(|x| *x += 0.3 * noise.next()));
        // whatever the ghost pressure is, the elastic force and it make up the whole stress
        let q = 2.0 * noise.next();
        let stress = material.stress(f, q) - DMat3::IDENTITY * (q * f.determinant());
        for (row, column) in [(0, 0), (1, 0), (2, 1)] {
            let mut turn = DMat3::ZERO;
            turn.col_mut(column)[row] = 1e-5;
            let slope = (energy(f + turn * f) - energy(f - turn * f)) / 2e-5;
            assert!((slope - stress.col(column)[row]).abs() < 1e-7, "{slope}");
        }
    }
    assert!(material.stress(DMat3::IDENTITY, material.start).abs_diff_eq(DMat3::ZERO, 1e-15));
}

#[test]
fn plastic_return_meets_the_yield_surface() {
    let material = Material::new(3.0, 0.3, 0.2);
    let mut noise = Noise(4);
    for _ in 0..20 {
        let mut f = DMat3::IDENTITY;
        (0..3).for_each(|c| f.col_mut(c).as_mut().iter_mut().for_each(|x| *x += 0.4 * noise.next()));
        let (returned, strain) = material.plastic_return(f);
        assert!((returned.determinant() / f.determinant() - 1.0).abs() < 1e-12, "volume is kept");
        assert!(strain > 0.0);
        let (again, more) = material.plastic_return(returned * (1.0 + 1e-12));
        assert!(more < 1e-10 && again.abs_diff_eq(returned, 1e-9), "{more}");
    }
}

/// A free elastic bar of 40 cells without gas: quarter period of its lowest mode.
#[test]
fn elastic_bar_vibrates_at_its_frequency() {
    let mut problem = Problem::new(Grid::new(&[60], [0.0; 3], 1.0), [Side::Wall; 6]);
    problem.materials = vec![Material::new(100.0, 0.0, f64::INFINITY)];
    let mut particles = lattice(&problem, 4, 1.0, |x| x[0] > 10.0 && x[0] < 50.0);
    let shape = |x: f64| (std::f64::consts::PI * (x - 10.0) / 40.0).cos();
    let start: Vec<f64> = particles.iter().map(|p| shape(p.position.x)).collect();
    for (particle, shape) in particles.iter_mut().zip(&start) {
        particle.velocity.x = 1e-3 * shape;
    }
    let still = vec![0.0; problem.grid.slots()];
    let (mut time, dt) = (0.0, 0.01);
    let amplitude = |p: &[Particle]| p.iter().zip(&start).map(|(p, s)| p.velocity.x * s).sum::<f64>();
    let mut before = amplitude(&particles);
    while amplitude(&particles) > 0.0 {
        before = amplitude(&particles);
        let mut nodes = p2g::p2g(&problem, &particles);
        mpm_grid_update::add_forces(&mut nodes.velocity, &nodes.mass, &nodes.force, dt);
        g2p::g2p(&problem, &nodes.velocity, &still, 0.0, dt, &mut particles);
        time += dt;
    }
    let after = amplitude(&particles);
    let quarter = time - dt * after / (after - before);
    println!("quarter period {quarter:.4}, exact {:.4}", 40.0 / 10.0 / 2.0);
    assert!((quarter / 2.0 - 1.0).abs() < 0.02);
}

/// The shares of the faces of a cell differ: each comes with the least of both sides. No mix may empty the cell.
#[test]
fn the_limiter_holds_for_every_mix_of_shares() {
    let mut random = Random(11);
    let (mut limited, mut worst_of_sum) = (0, f64::INFINITY);
    for _ in 0..20_000 {
        let mut next = |low: f32, high: f32| f64::from(random.between(low, high));
        let velocity = [next(-1.0, 1.0), next(-1.0, 1.0), 0.0];
        let (density, heat) = (next(0.1, 1.0), 10.0_f64.powf(next(-6.0, 0.0)));
        let m = velocity.map(|v| density * (v + 0.1 * next(-1.0, 1.0)));
        let first = [density, m[0], m[1], m[2], heat + 0.5 * m.iter().map(|m| m * m).sum::<f64>() / density];
        let size = 10.0_f64.powf(next(-3.0, 0.0));
        let part = |next: &mut dyn FnMut(f32, f32) -> f64| {
            let mass = size * next(-1.0, 1.0);
            let v = velocity.map(|v| v + size * next(-1.0, 1.0));
            [mass, mass * v[0], mass * v[1], mass * v[2], 0.5 * mass * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])]
        };
        let excess = [0; 4].map(|_| part(&mut next));
        let internal = |shares: [f64; 4]| {
            let u = [0, 1, 2, 3, 4].map(|k| first[k] + (0..4).map(|f| shares[f] * excess[f][k]).sum::<f64>());
            if u[0] > 0.0 { internal_energy(u) } else { -1.0 }
        };
        let share = gas_advection::allowed_share(first, &excess, velocity);
        limited += usize::from(share < 1.0);
        if internal([1.0; 4]) >= 0.1 * internal([0.0; 4]) {
            worst_of_sum = worst_of_sum.min(internal([1.0, 0.0, 1.0, 0.0]));
        }
        for mix in 0..16 {
            let shares = [0, 1, 2, 3].map(|face| if mix >> face & 1 == 1 { share } else { 0.0 });
            assert!(internal(shares) >= 0.0999 * internal([0.0; 4]), "{first:?} {excess:?} {share} {shares:?}");
        }
    }
    eprintln!("{limited} limited; where the sum of all faces is good, a mix has {worst_of_sum:.1e}");
    assert!(limited > 1000 && worst_of_sum < 0.0, "{limited}, {worst_of_sum}");
}
