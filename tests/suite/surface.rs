//! The preconditioner of the interface pressures, where only it keeps the solve short: pieces as thin as a cell.

use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::common::gpu_or_skip;

/// Eight pieces of a thin shell around hot gas: nearly all their vertices have pressures of gas, interface and body apart.
const PIECES: &str = r#"
title = "Pieces"
domain = { dimension = 3, cells = [12, 12, 12], size = [1.0, 1.0, 1.0] }
boundary = { x_min = "outlet", x_max = "outlet", y_min = "outlet", y_max = "outlet", z_min = "outlet", z_max = "outlet" }
materials.shell.von_mises = { young_modulus = 1000.0, poisson_ratio = 0.3, yield_stress = 30.0 }
time = { until = 0.14, frames = 1 }
[gas]
ambient = { density = 1.0, pressure = 1.0 }
regions = [{ shape = { sphere = { center = [0.5, 0.5, 0.5], radius = 0.26 } }, density = 4.0, pressure = 40.0 }]
[[bodies]]
name = "shell"
material = "shell"
density = 10.0
particles_per_cell = 2
[[bodies.shape.difference]]
shell = { thickness = 0.07, shape = { sphere = { center = [0.5, 0.5, 0.5], radius = 0.295 } } }
[[bodies.shape.difference]]
box = { center = [0.5, 0.5, 0.5], size = [0.08, 1.0, 1.0] }
[[bodies.shape.difference]]
box = { center = [0.5, 0.5, 0.5], size = [1.0, 0.08, 1.0] }
[[bodies.shape.difference]]
box = { center = [0.5, 0.5, 0.5], size = [1.0, 1.0, 0.08] }
"#;

/// The diagonal alone takes up to 30 with B1B0.
#[test]
fn pieces_cost_few_iterations() {
    let Some(gpu) = gpu_or_skip() else { return };
    for (overrides, most) in [(&[][..], 15), (&["numerics.pair=b2b1".to_owned()][..], 20)] {
        let scene = Scene::parse(PIECES, "pieces.toml", overrides).unwrap();
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        let records = simulation.advance_to(scene.time.until).unwrap();
        let iterations: Vec<u32> = records.iter().map(|record| record.iterations).collect();
        let apart = records.iter().map(|record| record.extra).max().unwrap();
        eprintln!("{apart} vertices apart, iterations {iterations:?}");
        assert!(apart > 200, "{apart} vertices");
        assert!(iterations.iter().all(|count| *count <= most), "{iterations:?}");
    }
}
