//! The shaders inside the binary: one line per file of `shaders/`; the suite compares the list with the folder.

/// Pairs of name and text, embedded at compile time.
macro_rules! sources {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/", $name)))),*]
    };
}

/// All embedded shaders: path below `shaders/`, text.
#[rustfmt::skip]
pub const SOURCES: &[(&str, &str)] = sources![
    "reduce.wgsl",
    "scan.wgsl",
    "shared/reduce.wgsl",
    "shared/thread.wgsl",
];
