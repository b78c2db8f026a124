//! From shapes to cells and particles: distances, surfaces of meshes, cut cells, sampling.

pub(in crate::scene) mod camera_file;
pub(in crate::scene) mod cut;
pub(in crate::scene) mod distance;
pub(in crate::scene) mod extent;
pub(in crate::scene) mod fill;
pub(in crate::scene) mod mesh;
pub(in crate::scene) mod named;
pub(in crate::scene) mod obstacle;
pub(in crate::scene) mod polyhedron;
pub(in crate::scene) mod sample;
