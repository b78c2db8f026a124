//! Twins of the stages of bodies.

pub(crate) mod elastic_reaction;
pub(crate) mod elastic_solve;
pub(crate) mod g2p;
pub(crate) mod material;
pub(crate) mod mpm_grid_update;
pub(crate) mod p2g;
pub(crate) mod particle_sort;
