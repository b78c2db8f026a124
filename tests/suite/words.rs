//! The words of the slots.

use brisance::gpu::readback;
use brisance::scene::Scene;
use brisance::simulation::Simulation;
use brisance::state::constants::{GAS, WALL};

use crate::common::gpu_or_skip;

/// Bits of a word, as in `shaders/shared/index.wgsl`.
const INTERIOR: u32 = 1 << 14;
const IMAGE: u32 = 1 << 16;
const WIDE_SHIFT: usize = 16;
const END_SHIFT: usize = 22;

#[test]
fn slots_deep_inside_the_gas_know_the_cells_around_their_faces() {
    let Some(gpu) = gpu_or_skip() else { return };
    for (path, changes) in [
        ("coupled/piston.toml", &["domain.cells=[100]"][..]),
        ("paper/fig03_elastic_shell_2d.toml", &["domain.cells=[48, 48]"]),
        ("paper/fig16_convergence.toml", &["domain.cells=[20, 20]"]),
        ("demos/bursting_shell_3d.toml", &["domain.cells=[20, 20, 20]"]),
    ] {
        let changes: Vec<String> = changes.iter().map(|&text| text.to_owned()).collect();
        let scene = Scene::shipped(path, &changes).unwrap_or_else(|error| panic!("{error}"));
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        simulation.advance_to(0.02 * scene.time.until).unwrap();
        let words = readback::read(&gpu, &simulation.state.interface.cells).unwrap();
        let stride = simulation.state.params.stride.map(|n| n as usize);
        let steps = [1, stride[0], stride[0] * stride[1]];
        let (mut faces, mut narrow) = (0, 0);
        for (slot, word) in words.iter().enumerate().filter(|(_, word)| **word & INTERIOR != 0) {
            for (n, step) in steps.iter().enumerate().take(scene.domain.dimension as usize) {
                let ends = [slot.saturating_sub(3 * step), (slot + 3 * step).min(words.len() - 1)];
                for (up, end) in ends.map(|end| words[end]).into_iter().enumerate() {
                    let image = scene.bodies.is_empty() && end & 3 == WALL && end & IMAGE != 0;
                    let wide = end & 3 == GAS || image;
                    let bit = |shift: usize| word >> (shift + 2 * n + up) & 1 == 1;
                    assert_eq!((bit(WIDE_SHIFT), bit(END_SHIFT)), (wide, image), "{path}: slot {slot}, axis {n}, {up}");
                    faces += 1;
                    narrow += usize::from(!wide || image);
                }
            }
        }
        assert!(narrow > 0 && faces > narrow, "{path}: {narrow} of {faces} faces near something else");
    }
}
