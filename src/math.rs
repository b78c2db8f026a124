//! glam re-exports and small pure helpers.
