//! The cases, from what others rest on to whole scenes.

use super::{Case, Found, advance, host, picture};
use crate::expect::{self, Budget};
use crate::gpu::{Gpu, Settings, readback};
use crate::numerics::{Rounds, copy_bandwidth};
use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::{Error, Result};

/// All of them. The first that fails names the stage to blame.
pub(super) const CASES: [Case; 22] = [
    Case { name: "copy", stage: "buffers", run: copy },
    Case { name: "sum, minimum, maximum", stage: "reduction", run: host::reductions },
    Case { name: "prefix sum", stage: "prefix sum", run: host::prefix_sum },
    Case { name: "particles in order", stage: "particle_sort", run: host::sorting },
    Case { name: "particles to nodes, by columns", stage: "p2g", run: host::columns },
    Case { name: "particles to nodes, by nodes", stage: "p2g", run: host::nodes },
    Case { name: "a value that is no number", stage: "time_step", run: fault },
    Case { name: "totals", stage: "totals", run: totals },
    Case { name: "Sod, exact", stage: "gas", run: sod },
    Case { name: "Sod, b2b1", stage: "gas", run: sod_quadratic },
    Case { name: "Sod, two solves", stage: "gas", run: sod_twice },
    Case { name: "blasts in a closed tube", stage: "gas_advection", run: blast },
    Case { name: "gas in space", stage: "coupled_solve", run: space },
    Case { name: "gas past a cut wedge", stage: "cut cells", run: wedge },
    Case { name: "slab in still gas", stage: "interface", run: slab },
    Case { name: "gas drives a slab", stage: "coupled_solve", run: piston },
    Case { name: "implicit elastic steps", stage: "elastic_solve", run: implicit },
    Case { name: "shell: mass and energy", stage: "mpm_grid_update", run: shell },
    Case { name: "shell: equal bits on two runs", stage: "order of sums", run: repeated },
    Case { name: "shell: both transfers", stage: "p2g", run: transfers },
    Case { name: "shell: both settings", stage: "group counts", run: both_settings },
    Case { name: "picture", stage: "render", run: picture::picture },
];

/// Whether a copy arrives at all; its speed comes later.
fn copy(gpu: &Gpu, _full: bool) -> Result<Found> {
    let speed = copy_bandwidth(gpu, Rounds::FEW)?;
    Ok(Found { difference: f64::from(u8::from(speed <= 0.0)), limit: 0.0, place: format!("{speed} GB/s") })
}

/// A scene with overrides, at a resolution; 0 for its own.
fn scene(name: &str, overrides: &[&str], cells: u32) -> Result<Scene> {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    let scene = Scene::find(name, &overrides)?;
    if cells == 0 { Ok(scene) } else { scene.with_resolution(cells) }
}

/// A few steps of a scene.
fn stepped(gpu: &Gpu, scene: &Scene, steps: usize) -> Result<Simulation> {
    let mut simulation = Simulation::new(gpu, scene)?;
    simulation.set_target(1e30)?;
    advance(&mut simulation, steps)?;
    Ok(simulation)
}

/// The scene's own `[expect]`; differences count as shares of their limits.
fn expected(gpu: &Gpu, scene: &Scene) -> Result<Found> {
    let (checks, _) = expect::run(gpu, scene)?;
    let failed = checks.iter().find(|check| !check.passed);
    let place = failed.map_or_else(String::new, ToString::to_string);
    let difference = checks.iter().filter(|check| !check.passed).count() as f64;
    Ok(Found { difference, limit: 0.0, place })
}

/// Mass of the gas that a few steps lose, what has crossed the sides included; and energy, within `energy`.
fn conserved(gpu: &Gpu, scene: &Scene, steps: usize, energy: f64) -> Result<Found> {
    let mut simulation = Simulation::new(gpu, scene)?;
    let start = Budget::read(&simulation, scene, 0.0)?;
    simulation.set_target(1e30)?;
    let mut summary = expect::Summary::default();
    summary.add(&advance(&mut simulation, steps)?);
    let drift = Budget::read(&simulation, scene, summary.stored_energy())?.drift_since(&start);
    let mass = drift["gas_mass"].abs();
    let share = drift["energy"].abs() / energy;
    let place = format!("gas mass drifts by {mass:.1e} (1e-6), energy by {:.1e} ({energy:.1e})", drift["energy"].abs());
    Ok(Found { difference: (mass / 1e-6).max(share), limit: 1.0, place })
}

/// One cell that holds no number must end the run: fast arithmetic may not hide it.
fn fault(gpu: &Gpu, _full: bool) -> Result<Found> {
    let scene = scene("blast", &[], 32)?;
    let mut simulation = stepped(gpu, &scene, 1)?;
    let slot = simulation.state.grid.slot([5, 0, 0]);
    simulation.state.gas.energy.write(gpu, slot, &[f32::NAN]);
    let mut records = Vec::new();
    for _ in 0..3 {
        match simulation.advance_batch_of(&mut records, 1) {
            Err(Error::Diverged { .. }) => {
                return Ok(Found { difference: 0.0, limit: 0.0, place: String::new() });
            }
            other => other?,
        };
    }
    Ok(Found { difference: 1.0, limit: 0.0, place: "three steps have not seen it; cell [5, 0, 0]".to_owned() })
}

/// Mass and energy of the gas as the device and the host add them.
fn totals(gpu: &Gpu, _full: bool) -> Result<Found> {
    let scene = scene("blast", &[], 32)?;
    let mut simulation = stepped(gpu, &scene, 2)?;
    let records = advance(&mut simulation, 1)?;
    let last = &records[records.len() - 1].gas;
    let snapshot = simulation.snapshot()?;
    let volume = f64::from(snapshot.grid.spacing).powi(scene.domain.dimension as i32);
    let sum = |values: &[f32]| values.iter().copied().map(f64::from).sum::<f64>() * volume;
    let should = [sum(&snapshot.density), sum(&snapshot.energy)];
    let is = [f64::from(last.mass) / should[0], f64::from(last.energy) / should[1]];
    Ok(Found::between(&is, &[1.0; 2], 1e-5, |k| ["mass", "energy"][k].to_owned()))
}

fn sod(gpu: &Gpu, _full: bool) -> Result<Found> {
    expected(gpu, &scene("sod", &[], 0)?)
}

/// Against the exact solution, within the limit of the other pair.
fn sod_with(gpu: &Gpu, overrides: &[&str]) -> Result<Found> {
    let scene = scene("sod", overrides, 0)?;
    let mut simulation = Simulation::new(gpu, &scene)?;
    simulation.advance_to(scene.time.until)?;
    let difference = expect::density_error(&scene, &simulation.snapshot()?).unwrap_or(f64::INFINITY);
    Ok(Found { difference, limit: 4e-3, place: "L1 error of the density".to_owned() })
}

fn sod_quadratic(gpu: &Gpu, _full: bool) -> Result<Found> {
    sod_with(gpu, &["numerics.pair=b2b1"])
}

fn sod_twice(gpu: &Gpu, _full: bool) -> Result<Found> {
    sod_with(gpu, &["numerics.integrator=ars222"])
}

fn blast(gpu: &Gpu, full: bool) -> Result<Found> {
    conserved(gpu, &scene("blast", &[], if full { 256 } else { 48 })?, 12, 1e-3)
}

fn space(gpu: &Gpu, full: bool) -> Result<Found> {
    conserved(gpu, &scene("spherical_explosion", &[], if full { 64 } else { 20 })?, 8, 1e-3)
}

fn wedge(gpu: &Gpu, full: bool) -> Result<Found> {
    conserved(gpu, &scene("wedge", &[], if full { 160 } else { 50 })?, 8, 1e-3)
}

fn slab(gpu: &Gpu, _full: bool) -> Result<Found> {
    expected(gpu, &scene("slab_at_rest", &["time.until=0.5", "numerics.tolerance=1e-6"], 0)?)
}

fn piston(gpu: &Gpu, _full: bool) -> Result<Found> {
    expected(gpu, &scene("piston", &[], 0)?)
}

fn implicit(gpu: &Gpu, _full: bool) -> Result<Found> {
    conserved(gpu, &scene("gelatine_3d", &["numerics.elasticity=implicit"], 12)?, 3, 2e-3)
}

/// Cells of the shell.
fn shell_cells(full: bool) -> u32 {
    if full { 48 } else { 16 }
}

fn shell(gpu: &Gpu, full: bool) -> Result<Found> {
    conserved(gpu, &scene("bursting_shell_3d", &[], shell_cells(full))?, 12, 2e-3)
}

/// Everything that a run of the shell leaves.
fn shell_state(gpu: &Gpu, overrides: &[&str], full: bool) -> Result<[Vec<f64>; 2]> {
    let simulation = stepped(gpu, &scene("bursting_shell_3d", overrides, shell_cells(full))?, 12)?;
    let state = &simulation.state;
    let wide = |values: Vec<[f32; 4]>| values.into_iter().flatten().map(f64::from).collect();
    Ok([wide(readback::read(gpu, &state.gas.conserved)?), wide(readback::read(gpu, &state.particles.position)?)])
}

/// The larger difference of gas and particles between two runs.
fn difference([one, other]: [[Vec<f64>; 2]; 2], limit: f64) -> Found {
    let names = ["component of the gas", "component of the particles"];
    let found = [0, 1].map(|k| Found::between(&one[k], &other[k], limit, |at| format!("{} {}", names[k], at / 4)));
    let [gas, particles] = found;
    if gas.difference >= particles.difference { gas } else { particles }
}

fn repeated(gpu: &Gpu, full: bool) -> Result<Found> {
    Ok(difference([shell_state(gpu, &[], full)?, shell_state(gpu, &[], full)?], 0.0))
}

fn transfers(gpu: &Gpu, full: bool) -> Result<Found> {
    let by = |transfer: &str| shell_state(gpu, &[transfer], full);
    Ok(difference([by("numerics.expert.transfer=columns")?, by("numerics.expert.transfer=nodes")?], 1e-3))
}

fn both_settings(gpu: &Gpu, full: bool) -> Result<Found> {
    let with = |settings: Settings| {
        let mut gpu = gpu.clone();
        gpu.settings = settings;
        shell_state(&gpu, &["numerics.expert.transfer=columns"], full)
    };
    Ok(difference([with(Settings::Software)?, with(Settings::Hardware)?], 1e-3))
}
