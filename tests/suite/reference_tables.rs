//! The CPU reference against exact solutions and known error tables.

use crate::analytic::TUBES;
use crate::reference_exact::{self as exact, Primitive};
use brisance::scene::Scene;
use reference::gas::gas_advection::fill_ghosts;
use reference::grid::Grid;
use reference::step::{Report, advance_to, step};
use reference::{Numerics, Pair, Problem, Side, State, Weno};
use std::sync::OnceLock;

/// A shock-tube case: name, left, right, time.
type Case = (&'static str, Primitive, Primitive, f64);

const CASES: [Case; 6] = [
    ("sod", [1.0, 0.0, 1.0], [0.125, 0.0, 0.1], 0.15),
    ("lax", [0.445, 0.698, 3.528], [0.5, 0.0, 0.571], 0.12),
    ("strong", [1.0, 0.0, 1e10], [0.125, 0.0, 0.1], 2.5e-6),
    ("mach3", [3.857, 0.92, 10.333], [1.0, 3.55, 1.0], 0.09),
    ("highmach", [10.0, 2000.0, 500.0], [20.0, 0.0, 500.0], 1.75e-4),
    ("raref", [1.0, -2.0, 0.4], [1.0, 2.0, 0.4], 0.15),
];

/// A problem with the reconstruction of the tables: one form everywhere, which takes differences of up to 0.1 % as smooth.
fn problem(grid: Grid, sides: [Side; 6]) -> Problem {
    let mut problem = Problem::new(grid, sides);
    problem.numerics.weno = Weno { steep: 1e-6, even: None };
    problem
}

/// A tube of n cells on [0, 1] between the gas of a case.
fn tube(case: &Case, n: usize) -> Problem {
    let [low, high] = [case.1, case.2].map(|[density, u, pressure]| Side::far((density, [u, 0.0, 0.0], pressure)));
    problem(
        Grid::new(&[n as i32], [0.0; 3], 1.0 / n as f64),
        [low, high, Side::Wall, Side::Wall, Side::Wall, Side::Wall],
    )
}

fn two_states(problem: &Problem, left: Primitive, right: Primitive) -> State {
    let pick = |x: f64| if x < 0.5 { left } else { right };
    State::new(problem, |x| (pick(x[0])[0], [pick(x[0])[1], 0.0, 0.0], pick(x[0])[2]), Vec::new())
}

/// L1 density error of a case on the cells of `problem`, with the reports of its steps.
fn error_of(case: &Case, problem: &Problem) -> (f64, Vec<Report>) {
    let (_, left, right, time) = *case;
    let mut state = two_states(problem, left, right);
    let reports = advance_to(problem, &mut state, time);
    assert!(reports.iter().all(|r| r.converged));
    assert!((reports.iter().map(|r| r.dt).sum::<f64>() / time - 1.0).abs() < 1e-12);
    let n = problem.grid.cells[0] as usize;
    let reference = exact::riemann_density(left, right, n, time);
    let density = |i: usize| state.gas.conserved[problem.grid.slot([i as i32, 0, 0])][0];
    ((0..n).map(|i| (density(i) - reference[i]).abs() / n as f64).sum(), reports)
}

fn run_case(case: &Case, n: usize, pair: Pair, predictor: bool) -> (f64, Vec<Report>) {
    let mut problem = tube(case, n);
    problem.numerics.pair = pair;
    problem.numerics.predictor = predictor;
    problem.numerics.tolerance = 1e-6;
    error_of(case, &problem)
}

/// Error with the weights of the device, at the time steps of a scene: pair, predictor, two solves.
fn error_as_on_the_device(
    (case, scene): (&Case, &str),
    n: usize,
    (pair, predictor, two_solves): (Pair, bool, bool),
) -> f64 {
    let mut problem = tube(case, n);
    problem.numerics = Numerics {
        pair,
        predictor,
        two_solves,
        fourth: two_solves,
        consistent: two_solves,
        tolerance: 1e-6,
        cfl: Scene::shipped(&format!("gas/{scene}.toml"), &[]).unwrap().time.cfl,
        ..Numerics::default()
    };
    error_of(case, &problem).0
}

/// What the device is compared with: B1B0 without and with the predictor, B2B1 without and with, both with two solves.
#[test]
fn shock_tubes_of_the_device() {
    let settings = [
        (Pair::B1b0, false, false),
        (Pair::B1b0, true, false),
        (Pair::B2b1, false, false),
        (Pair::B2b1, true, false),
        (Pair::B1b0, true, true),
        (Pair::B2b1, true, true),
    ];
    let mut failures = Vec::new();
    for (case, (name, expected)) in CASES.iter().zip(TUBES) {
        let found = settings.map(|setting| error_as_on_the_device((case, name), 400, setting));
        println!("{name}: {found:.5?}");
        for (found, expected) in found.iter().zip(expected) {
            if (found / expected - 1.0).abs() >= 0.01 {
                failures.push(format!("{name}: {found}, expected {expected}"));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

fn iterations(reports: &[Report]) -> (f64, usize) {
    let mean = reports.iter().map(|r| r.iterations).sum::<usize>() as f64 / reports.len() as f64;
    (mean, reports.iter().map(|r| r.iterations).max().unwrap_or(0))
}

fn print_case(case: &Case, n: usize, pair: Pair, predictor: bool) -> f64 {
    let (error, reports) = run_case(case, n, pair, predictor);
    let (mean, most) = iterations(&reports);
    let touched: usize = reports.iter().map(|r| r.limited + r.floored).sum();
    println!(
        "{:9} {pair:?} N {n} predictor {predictor}: L1 {error:.5}, PCG {mean:.1}/{most}, {} steps, touched {touched}",
        case.0,
        reports.len()
    );
    error
}

/// L1 at N = 400, both pairs, without and with the predictor.
#[test]
fn shock_tubes() {
    let plain =
        [[0.00479, 0.00828, 0.00747, 0.0168, 0.506, 0.00596], [0.00482, 0.00828, 0.0075, 0.0172, 0.497, 0.0062]];
    let predicted = [0.00311, 0.00750, 0.00587, 0.0129, 0.495, 0.00502];
    for (k, case) in CASES.iter().enumerate() {
        for (row, pair) in [Pair::B1b0, Pair::B2b1].into_iter().enumerate() {
            let error = print_case(case, 400, pair, false);
            assert!((error / plain[row][k] - 1.0).abs() < 0.03, "{} {pair:?}: {error}", case.0);
        }
        let error = print_case(case, 400, Pair::B1b0, true);
        assert!((error / predicted[k] - 1.0).abs() < 0.03, "{} with predictor: {error}", case.0);
    }
}

/// L1 at N = 100 and 200.
#[test]
fn shock_tubes_coarse() {
    let rows =
        [[0.0132, 0.00815], [0.0213, 0.0129], [0.0194, 0.0133], [0.0469, 0.0294], [1.19, 0.921], [0.016, 0.0102]];
    let predicted =
        [[0.00997, 0.00566], [0.0201, 0.0117], [0.0165, 0.0109], [0.0395, 0.0240], [1.19, 0.908], [0.0147, 0.00895]];
    for (k, case) in CASES.iter().enumerate() {
        for (column, n) in [100, 200].into_iter().enumerate() {
            for (predictor, expected) in [(false, rows[k][column]), (true, predicted[k][column])] {
                let error = print_case(case, n, Pair::B1b0, predictor);
                assert!((error / expected - 1.0).abs() < 0.04, "{} {n} {predictor}: {error}", case.0);
            }
        }
    }
}

/// The L1 errors of `src/verify/measure/tube_errors.rs` that no published table has.
#[test]
#[ignore = "minutes"]
fn shock_tubes_with_predictor() {
    for case in &CASES {
        for n in [100, 200, 400, 800, 1600] {
            print_case(case, n, Pair::B2b1, true);
        }
        print_case(case, 1600, Pair::B1b0, true);
    }
}

/// The same with two solves, as on the device.
#[test]
#[ignore = "minutes"]
fn shock_tubes_with_two_solves() {
    for (case, (name, _)) in CASES.iter().zip(TUBES) {
        for pair in [Pair::B1b0, Pair::B2b1] {
            let error = |n: usize| error_as_on_the_device((case, name), n, (pair, true, true));
            println!("{name} {pair:?}: {:.5?}", [100, 200, 400, 800, 1600].map(error));
        }
    }
}

/// Radial solution, shared by the tests.
static RADIAL: OnceLock<Vec<f64>> = OnceLock::new();

/// Circular explosion: L1 density against the radial solution, and asymmetry.
fn explosion(n: usize, pair: Pair, predictor: bool) -> [f64; 2] {
    let mut problem = problem(Grid::new(&[n as i32; 2], [-1.0, -1.0, 0.0], 2.0 / n as f64), [Side::Wall; 6]);
    problem.numerics.pair = pair;
    problem.numerics.predictor = predictor;
    problem.numerics.tolerance = 1e-6;
    let inside = |x: [f64; 3]| if x[0].hypot(x[1]) < 0.4 { (1.0, 1.0) } else { (0.125, 0.1) };
    let mut state = State::new(&problem, |x| (inside(x).0, [0.0; 3], inside(x).1), Vec::new());
    let reports = advance_to(&problem, &mut state, 0.25);
    let reference = RADIAL.get_or_init(|| exact::radial_density(2000, 1.5, 1, 0.25));
    let (mut error, mut asymmetry) = (0.0, 0.0_f64);
    for c in problem.grid.interior() {
        let density = |c: [i32; 3]| state.gas.conserved[problem.grid.slot(c)][0];
        let x = problem.grid.centre(c);
        let at = x[0].hypot(x[1]) / 1.5 * 2000.0 - 0.5;
        let low = at.floor().max(0.0) as usize;
        let exact = reference[low] + (at - low as f64) * (reference[low + 1] - reference[low]);
        error += (density(c) - exact).abs() / (n * n) as f64;
        let mirrored = [c[1], n as i32 - 1 - c[0], 0];
        asymmetry = asymmetry.max((density(c) - density(mirrored)).abs());
    }
    let (mean, most) = iterations(&reports);
    println!(
        "{pair:?} {n} {predictor}: L1 {error:.5}, asymmetry {asymmetry:.1e}, PCG {mean:.1}/{most}, {} steps",
        reports.len()
    );
    [error, asymmetry]
}

#[test]
fn circular_explosion() {
    for (pair, predictor, expected) in
        [(Pair::B1b0, false, 0.0169), (Pair::B2b1, false, 0.0176), (Pair::B1b0, true, 0.0144)]
    {
        let [error, asymmetry] = explosion(64, pair, predictor);
        assert!((error / expected - 1.0).abs() < 0.08, "{error}");
        assert!(asymmetry < 1e-12);
    }
}

#[test]
#[ignore = "a minute"]
fn circular_explosion_fine() {
    for n in [128, 256] {
        for (pair, predictor) in [(Pair::B1b0, false), (Pair::B2b1, false), (Pair::B1b0, true)] {
            explosion(n, pair, predictor);
        }
    }
}

/// Small repeatable numbers in [-1, 1].
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
    }
}

/// Noise of 1e-3 on gas at rest, closed tube, 400 steps of dt = s dx/c: largest |u|/c.
fn rest_noise(pair: Pair, s: f64, predictor: bool) -> f64 {
    let mut problem = problem(Grid::new(&[128], [0.0; 3], 1.0 / 128.0), [Side::Wall; 6]);
    problem.numerics.pair = pair;
    problem.numerics.predictor = predictor;
    problem.numerics.tolerance = 1e-6;
    let mut state = State::new(&problem, |_| (1.0, [0.0; 3], 1.0), Vec::new());
    let mut noise = Noise(7);
    let sound = 1.4_f64.sqrt();
    for c in problem.grid.interior() {
        let (density, u, p) = (1.0 + 1e-3 * noise.next(), 1e-3 * sound * noise.next(), 1.0 + 1e-3 * noise.next());
        state.gas.set(problem.grid.slot(c), reference::Gas::conserved_from_primitive(density, [u, 0.0, 0.0], p, 1.4));
    }
    fill_ghosts(&problem, &state.cells, &mut state.gas);
    for _ in 0..400 {
        step(&problem, &mut state, s / 128.0 / sound);
    }
    let slots = problem.grid.interior().into_iter().map(|c| problem.grid.slot(c));
    slots.map(|slot| state.gas.velocity(slot)[0].abs() / sound).fold(0.0, f64::max)
}

#[test]
fn rest_noise_decays() {
    for pair in [Pair::B1b0, Pair::B2b1] {
        for predictor in [false, true] {
            let speeds = [1.0, 2.0, 5.0, 20.0].map(|s| rest_noise(pair, s, predictor));
            println!("{pair:?} predictor {predictor}: {speeds:?}");
            assert!(speeds.iter().all(|speed| *speed < 5e-4), "{speeds:?}");
        }
    }
}

/// Sod along one axis of a grid with four cells across the others, fixed dt: densities along the tube.
fn sod_along(axis: usize, dimension: usize) -> Vec<f64> {
    let mut cells = [4; 3];
    cells[axis] = 50;
    let mut problem = problem(Grid::new(&cells[..dimension], [0.0; 3], 0.02), [Side::Wall; 6]);
    problem.numerics.tolerance = 1e-10;
    let low = |x: [f64; 3]| x[axis] < 0.5;
    let gas = |x: [f64; 3]| if low(x) { (1.0, [0.0; 3], 1.0) } else { (0.125, [0.0; 3], 0.1) };
    let mut state = State::new(&problem, gas, Vec::new());
    for _ in 0..12 {
        step(&problem, &mut state, 0.004);
    }
    let at = |i: i32| {
        let mut c = [0; 3];
        for (d, c) in c.iter_mut().enumerate() {
            *c = if d == axis { i } else { i32::from(d < dimension) };
        }
        state.gas.conserved[problem.grid.slot(c)][0]
    };
    (0..50).map(at).collect()
}

#[test]
fn one_two_and_three_dimensions_agree() {
    let one = sod_along(0, 1);
    for (axis, dimension) in [(0, 2), (1, 2), (0, 3), (1, 3), (2, 3)] {
        let other = sod_along(axis, dimension);
        let difference = one.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("axis {axis} of {dimension}: {difference:.1e}");
        assert!(difference < 1e-8);
    }
}

/// Mach 3 flow over a step: positions of the first cell with rho > 2.5 on the floor, the top wall and at y = 0.5.
#[test]
#[ignore = "minutes"]
fn forward_step() {
    let n = 40;
    let inflow = Side::Inlet { density: 1.4, velocity: [3.0, 0.0, 0.0], pressure: 1.0 };
    let sides = [inflow, Side::far((1.4, [3.0, 0.0, 0.0], 1.0)), Side::Wall, Side::Wall, Side::Wall, Side::Wall];
    let mut problem = problem(Grid::new(&[3 * n, n], [0.0; 3], 1.0 / f64::from(n)), sides);
    problem.numerics.predictor = false;
    for c in problem.grid.interior() {
        let x = problem.grid.centre(c);
        let slot = problem.grid.slot(c);
        problem.obstacles[slot] = x[0] > 0.6 && x[1] < 0.2;
    }
    let mut state = State::new(&problem, |_| (1.4, [3.0, 0.0, 0.0], 1.0), Vec::new());
    let reports = advance_to(&problem, &mut state, 4.0);
    let first = |row: i32| {
        let dense = |i: &i32| state.gas.conserved[problem.grid.slot([*i, row, 0])][0] > 2.5;
        (0..3 * n).find(dense).map_or(f64::NAN, |i| (f64::from(i) + 0.5) / f64::from(n))
    };
    let positions = [first(0), first(n - 1), first(n / 2)];
    let touched: usize = reports.iter().map(|r| r.limited + r.floored).sum();
    println!(
        "{positions:?}, {} steps, touched {touched}, PCG {:?}; table 0.338, 0.713, 0.463, 1570 steps",
        reports.len(),
        iterations(&reports)
    );
    for (found, expected) in positions.iter().zip([0.338, 0.713, 0.463]) {
        assert!((found - expected).abs() < 1.5 / f64::from(n), "{found} {expected}");
    }
}
