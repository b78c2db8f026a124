//! From shapes to cells and particles: distances, surfaces of meshes, cut cells, sampling.

pub(crate) mod camera_file;
pub(crate) mod cut;
pub(crate) mod distance;
pub(crate) mod extent;
pub(crate) mod fill;
pub(crate) mod mesh;
pub(crate) mod named;
pub(crate) mod obstacle;
pub(crate) mod polyhedron;
pub(crate) mod sample;
