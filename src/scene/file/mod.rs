//! From a file to a scene: its text, its words against the schema, its variants, and what stands for what cannot be read.

pub(crate) mod earlier;
pub(crate) mod gas_state;
pub(crate) mod load;
pub(crate) mod mended;
pub(crate) mod numbers;
pub(crate) mod shipped;
pub(crate) mod source;
pub(crate) mod species;
pub(crate) mod variants;
pub(crate) mod vocabulary;
