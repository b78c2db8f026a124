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
    "field.wgsl",
    "points.wgsl",
    "reduce.wgsl",
    "scan.wgsl",
    "shared/color.wgsl",
    "shared/reduce.wgsl",
    "shared/surface.wgsl",
    "shared/thread.wgsl",
    "shared/view.wgsl",
    "slice.wgsl",
    "volume.wgsl",
];
