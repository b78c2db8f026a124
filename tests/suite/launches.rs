//! How many kernels a step launches: each costs a GPU some microseconds, whatever it does.

use brisance::gpu::{Gpu, GpuOptions, Settings};
use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::common::{gpu_or_skip, report};

/// Iterations of a solve that are counted.
const ITERATIONS: u32 = 3;

/// Launches of a step at most, with as many iterations and the settings of a GPU.
const MOST: [(&str, usize); 2] = [("paper/fig16_convergence.toml", 53), ("demos/bursting_shell_3d.toml", 96)];

#[test]
fn a_step_launches_few_kernels() {
    if gpu_or_skip().is_none() {
        return;
    }
    let gpu = Gpu::new(&GpuOptions { settings: Some(Settings::Hardware), ..GpuOptions::default() }).unwrap();
    let mut failures = Vec::new();
    for (name, most) in MOST {
        let scene = Scene::shipped(name, &[]).unwrap_or_else(|error| panic!("{error}"));
        let mut simulation = Simulation::new(&gpu, &scene).unwrap_or_else(|error| panic!("{error}"));
        let launches = simulation.launches(ITERATIONS);
        eprintln!("{name}: {} launches\n{}", launches.len(), launches.join("\n"));
        if launches.len() > most {
            failures.push(format!("{name}: {} launches, at most {most}\n{}", launches.len(), launches.join("\n")));
        }
    }
    report(&failures);
}
