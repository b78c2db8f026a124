//! What the tests share: a device and random numbers that are the same on every run.

use std::ops::Deref;
use std::sync::{Mutex, PoisonError};

use brisance::gpu::{Folder, Gpu, GpuOptions};

/// Devices that no test has: with the kernels that they know, most tests need not compile any.
static IDLE: Mutex<Vec<Gpu>> = Mutex::new(Vec::new());

/// A device that nobody else has meanwhile. One whose test fails is not used again.
#[derive(Debug)]
pub(crate) struct Borrowed(Option<Gpu>);

impl Deref for Borrowed {
    type Target = Gpu;

    fn deref(&self) -> &Gpu {
        self.0.as_ref().expect("taken out by drop alone")
    }
}

impl Drop for Borrowed {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            IDLE.lock().unwrap_or_else(PoisonError::into_inner).extend(self.0.take());
        }
    }
}

/// The device of a test, or `None` where `BRISANCE_SKIP_GPU=1` allows a machine without one. A missing device without that permission
/// fails the test.
pub(crate) fn gpu_or_skip() -> Option<Borrowed> {
    if std::env::var("BRISANCE_SKIP_GPU").is_ok_and(|value| value == "1") {
        eprintln!("SKIPPED: BRISANCE_SKIP_GPU=1, this test did not run");
        return None;
    }
    let idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner).pop();
    Some(Borrowed(Some(idle.unwrap_or_else(opened))))
}

fn opened() -> Gpu {
    let gpu = Gpu::new(&GpuOptions::default()).unwrap_or_else(|error| panic!("{error}\n(BRISANCE_SKIP_GPU=1 skips)"));
    eprintln!("device: {} ({:?}, {})", gpu.info.name, gpu.info.backend, gpu.info.driver_info);
    gpu
}

/// A device of its own that finds the given texts, then the embedded shaders; or `None`, as [`gpu_or_skip`].
pub(crate) fn with_shaders(files: &[(&str, &str)]) -> Option<Gpu> {
    gpu_or_skip()?;
    let files = files.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned()));
    let mut gpu = opened();
    gpu.folder = Folder::Given(files.collect());
    Some(gpu)
}

/// A small generator of random numbers [Steele et al. 2014, SplitMix64].
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// The next 64 random bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [low, high).
    pub(crate) fn between(&mut self, low: f32, high: f32) -> f32 {
        let unit = (self.bits() >> 40) as f32 / (1u32 << 24) as f32;
        low + (high - low) * unit
    }
}
