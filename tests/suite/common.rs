//! What the tests share: a device and random numbers that are the same on every run.

use std::ops::Deref;
use std::path::{Path, PathBuf};
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

/// A folder of its own for a test that runs the program on a device, or `None`, as [`gpu_or_skip`].
pub(crate) fn folder_or_skip() -> Option<tempfile::TempDir> {
    gpu_or_skip()?;
    Some(tempfile::tempdir().unwrap())
}

/// All files below a folder, in order: paths from there.
pub(crate) fn files_below(folder: &Path) -> Vec<PathBuf> {
    let (mut found, mut folders) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(next) = folders.pop() {
        for path in std::fs::read_dir(next).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() { folders.push(path) } else { found.push(path.strip_prefix(folder).unwrap().to_owned()) }
        }
    }
    found.sort();
    found
}

/// The same with what they hold.
pub(crate) fn contents_below(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let read = |path: PathBuf| (path.clone(), std::fs::read(folder.join(path)).unwrap());
    files_below(folder).into_iter().map(read).collect()
}

/// A path with slashes.
pub(crate) fn slashed(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
}

/// Whether the name of a file ends like that.
pub(crate) fn is_kind(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|found| found == extension)
}

/// A picture on the disk: what its head says, and its bytes.
pub(crate) fn read_png(path: &Path) -> (png::Info<'static>, Vec<u8>) {
    let file = std::fs::File::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    (reader.info().clone(), bytes)
}

/// Fails with all that was found.
pub(crate) fn report(failures: &[String]) {
    assert!(failures.is_empty(), "{} failures\n{}", failures.len(), failures.join("\n"));
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
