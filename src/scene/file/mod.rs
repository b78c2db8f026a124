//! From a file to a scene: its text, its words against the schema, its variants, and what stands for what cannot be read.

pub(in crate::scene) mod earlier;
pub(in crate::scene) mod gas_state;
pub(in crate::scene) mod load;
pub(in crate::scene) mod mended;
pub(in crate::scene) mod numbers;
pub(in crate::scene) mod shipped;
pub(in crate::scene) mod source;
pub(in crate::scene) mod variants;
pub(in crate::scene) mod vocabulary;
