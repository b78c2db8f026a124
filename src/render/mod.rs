//! Pictures of the state, drawn on the GPU through compute shaders.

mod frame;

pub use frame::{Frame, Picture};
