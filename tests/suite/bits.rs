//! A fingerprint of what every shipped scene computes, to show that a change of the code's form moves no bit. `scripts/bits` runs it.

use std::fmt::Write as _;
use std::path::Path;

use brisance::gpu::{Gpu, readback};
use brisance::scene::{Changes, SMALL, Scene};
use brisance::simulation::Simulation;

use crate::common::{files_below, gpu_or_skip, is_kind};

/// Steps of each run.
const STEPS: u64 = 8;
/// Cells along the longest axis that a scene without a small variant gets, by its dimension.
const MOST_CELLS: [u32; 4] = [0, 100, 48, 16];
/// Choices of the method that each scene runs with, where it allows them.
const METHODS: [&str; 4] = ["numerics.pair=b1b0", "numerics.pair=b2b1", "numerics.integrator=ars222", ""];
/// Scenes of the short table: each dimension, bodies, obstacles, open sides, inlets, sand, plastic and soft bodies.
const FEW: [&str; 12] = [
    "coupled/slab_at_rest.toml",
    "demos/bursting_shell_3d.toml",
    "gas/sod.toml",
    "paper/fig03_elastic_shell_2d.toml",
    "paper/fig05_bullets_2d.toml",
    "paper/fig11_airplane.toml",
    "paper/fig16_convergence.toml",
    "validation/driven_piston.toml",
    "validation/fragments.toml",
    "validation/hydrostatic_column.toml",
    "validation/materials_in_flow.toml",
    "validation/wedge.toml",
];

#[test]
#[ignore = "minutes; scripts/bits runs it"]
fn every_scene_has_its_fingerprint() {
    let Some(gpu) = gpu_or_skip() else { return };
    let all = std::env::var("BRISANCE_BITS").is_ok_and(|value| value == "all");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut table = String::new();
    let scenes = files_below(&folder).into_iter().filter(|path| is_kind(path, "toml"));
    for path in scenes.filter(|path| all || FEW.iter().any(|few| path.ends_with(few))) {
        let name = path.display();
        let mut seen = Vec::new();
        for method in METHODS {
            let Some(scene) = small(&folder.join(&path), method) else { continue };
            if seen.contains(&scene.hash()) {
                continue;
            }
            seen.push(scene.hash());
            let row =
                fingerprint(&gpu, &scene).unwrap_or_else(|error| format!("ends with: {error}").replace('\n', " "));
            writeln!(table, "{name} {} {row}", if method.is_empty() { "as_shipped" } else { method }).unwrap();
        }
        eprintln!("{}", table.lines().last().unwrap_or_default());
    }
    let rows = table.lines().count();
    assert!(rows >= FEW.len(), "{rows} rows");
    std::fs::write(std::env::var("BRISANCE_BITS_TABLE").expect("scripts/bits names the file"), table).unwrap();
}

/// The scene in its small variant, or at a third of its resolution at most; nothing where the method does not suit it.
fn small(path: &Path, method: &str) -> Option<Scene> {
    let load = |changes: Changes| {
        let set = if method.is_empty() { Vec::new() } else { vec![method.to_owned()] };
        Scene::load(path, Changes { set, ..changes })
    };
    if let Ok(scene) = load(Changes::variant(SMALL)) {
        return Some(scene);
    }
    let scene = load(Changes::default()).ok()?;
    let longest = *scene.domain.cells.iter().max()?;
    let most = MOST_CELLS[scene.domain.dimension as usize].min(longest / 3).max(1);
    // The nearest resolution that keeps the cells cubic and the scene valid.
    let coarse = (1..=most).rev().chain(most + 1..longest).find_map(|cells| scene.with_resolution(cells).ok());
    Some(coarse.unwrap_or(scene))
}

/// Steps done, and a hash each of the gas, its energy, the kinds of cells and the particles.
fn fingerprint(gpu: &Gpu, scene: &Scene) -> brisance::Result<String> {
    let mut simulation = Simulation::new(gpu, scene)?;
    let mut records = Vec::new();
    simulation.set_target(scene.time.until)?;
    while records.len() < STEPS as usize {
        if simulation.advance_batch_of(&mut records, 1)? {
            break;
        }
    }
    let state = &simulation.state;
    let slots = state.params.slots as usize;
    let particles = &state.particles;
    let hashes = [
        hash(&readback::read(gpu, &state.gas.conserved)?),
        hash(&readback::read(gpu, &state.gas.energy)?[..slots]),
        hash(&readback::read(gpu, &state.interface.cells)?),
        [&particles.position, &particles.velocity, &particles.affine, &particles.deformation]
            .into_iter()
            .map(|buffer| readback::read(gpu, buffer).map(|rows| hash(&rows)))
            .try_fold(0, |all: u64, own| own.map(|own| all.rotate_left(16) ^ own))?,
    ];
    Ok(format!("{} {}", records.len(), hashes.map(|hash| format!("{hash:016x}")).join(" ")))
}

/// FNV-1a of 64 bits.
fn hash<T: bytemuck::Pod>(values: &[T]) -> u64 {
    let bytes = bytemuck::cast_slice::<T, u8>(values);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}
