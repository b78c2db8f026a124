//! Twins of the stages of bodies.

pub mod elastic_reaction;
pub mod elastic_solve;
pub mod g2p;
pub mod material;
pub mod mpm_grid_update;
pub mod p2g;
pub mod particle_sort;
