//! How fast the device moves memory when it does nothing else.

use std::time::Instant;

use crate::error::Result;
use crate::gpu::{Buffer, Constants, Extent, Gpu, Kernel, Pass, Settings};

/// Length of each array, in vec4f: 64 MiB, more than caches hold; on GPUs, whose caches are larger, four times as much, as far as the
/// device can bind it.
const LENGTH: usize = 4 << 20;
/// How often the array is copied.
#[derive(Clone, Copy, Debug)]
pub struct Rounds {
    /// Copies per submission, so that its launch does not count; one in software, where a copy takes a thousand launches.
    copies: u32,
    /// Submissions after the first, of which the fastest counts: others share the machine.
    rounds: u32,
}

impl Rounds {
    /// For measurements.
    pub const MANY: Self = Self { copies: 8, rounds: 5 };
    /// For estimates.
    pub const FEW: Self = Self { copies: 2, rounds: 2 };
}

/// Bytes read and written per second by a kernel that copies an array `[GB/s]`.
///
/// # Errors
/// If the device has no room for two arrays, or a driver error.
pub fn copy_bandwidth(gpu: &Gpu, Rounds { copies, rounds }: Rounds) -> Result<f64> {
    let most = (gpu.limits.max_storage_buffer_binding_size.min(gpu.limits.max_buffer_size) / 16) as usize;
    let (wanted, copies) = if gpu.settings == Settings::Software { (LENGTH, 1) } else { (4 * LENGTH, copies) };
    let length = wanted.min(most);
    let from = Buffer::<[f32; 4]>::new(gpu, "copy source", length)?;
    let to = Buffer::<[f32; 4]>::new(gpu, "copy target", length)?;
    let kernel = Kernel::new(gpu, "step/copy.wgsl", "copy", &Constants::default())?;
    let bound = kernel.bind(gpu, &[("from_here", from.raw()), ("to_there", to.raw())])?;
    let mut fastest = f64::INFINITY;
    for _ in 0..=rounds {
        let mut pass = Pass::new(gpu, "copy");
        for _ in 0..copies {
            pass.dispatch(&bound, &Extent::Threads(length as u64));
        }
        let start = Instant::now();
        let submission = pass.submit()?;
        gpu.wait(Some(submission))?;
        fastest = fastest.min(start.elapsed().as_secs_f64());
    }
    Ok(f64::from(copies) * (from.size_bytes() + to.size_bytes()) as f64 / (1e9 * fastest))
}
