//! How long a run may take: bytes of a step by count, and how fast the device copies.

use super::args::Cli;
use crate::gpu::{Gpu, GpuOptions};
use crate::math::plain;
use crate::numerics::{Rounds, copy_bandwidth};
use crate::scene::{Estimate, Pair, Scene};
use crate::stage::traffic::{self, Load};
use crate::state::MemoryPlan;
use crate::state::stages::Stage;

/// Iterations of the pressure solve in a step of most scenes.
const ITERATIONS: u64 = 4;
/// Part of the speed of copying that the stages reach, by the bytes of [`traffic`]: measured in software (docs/results/performance.md).
const REACHED: f64 = 0.2;
/// Least time of a step: its launches `[s]`.
const LAUNCHES: f64 = 1e-3;

/// How long a run may take on a device, about.
#[derive(Debug, serde::Serialize)]
pub(super) struct Duration {
    /// Name of the device.
    pub(super) device: String,
    /// Time of the steps `[s]`.
    pub(super) seconds: f64,
    /// Why a run would not begin there.
    pub(super) refused: Option<String>,
}

impl Duration {
    /// For the device that a run would take; nothing where there is none.
    pub(super) fn of(scene: &Scene, plan: &MemoryPlan, estimate: &Estimate, cli: &Cli) -> Option<Self> {
        let gpu = Gpu::new(&GpuOptions { device: cli.device.clone(), ..GpuOptions::default() }).ok()?;
        let copy = 1e9 * copy_bandwidth(&gpu, Rounds::FEW).ok()?;
        let ring = |n: u32| u64::from(if n > 1 { n + 2 } else { 1 });
        let slots = scene.domain.cells.map(ring).iter().product();
        let load = Load {
            slots,
            particles: plan.particles,
            steps: 1,
            iterations: ITERATIONS,
            substeps: estimate.substeps as u64,
            carrier: scene.consistent(),
            quadratic: scene.numerics.pair == Pair::B2b1,
        };
        let bytes: u64 = Stage::ALL.iter().map(|stage| traffic::bytes(stage.name(), &load)).sum();
        let seconds = estimate.steps * (bytes as f64 / (REACHED * copy)).max(LAUNCHES);
        let refused = plan.check_device(scene, &gpu).err().map(|error| error.to_string());
        Some(Self { device: gpu.info.name.clone(), seconds, refused })
    }
}

/// A time of which one figure counts.
pub(super) fn rough_time(seconds: f64) -> String {
    let (number, unit) = match seconds {
        s if s < 90.0 => (s, "s"),
        s if s < 5400.0 => (s / 60.0, "min"),
        s if s < 172_800.0 => (s / 3600.0, "h"),
        s => (s / 86_400.0, "days"),
    };
    let step = 10f64.powi(number.max(1.0).log10().floor() as i32);
    format!("{} {unit}", plain((number / step).round().max(1.0) * step))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_figure_counts() {
        for (seconds, text) in
            [(0.02, "1 s"), (47.0, "50 s"), (149.0, "2 min"), (3900.0, "70 min"), (9.6e4, "30 h"), (1e9, "10000 days")]
        {
            assert_eq!(rough_time(seconds), text);
        }
    }
}
