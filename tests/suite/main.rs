//! One test binary: see the modules.

mod export;
mod render;
