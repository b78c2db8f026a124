//! What happens to bodies, on particles and nodes.

mod debris;
mod elastic_first;
mod elastic_reaction;
mod elastic_solve;
mod g2p;
mod mpm_grid_update;
mod p2g;
mod particle_sort;
mod push;
mod supports;

pub use debris::Debris;
pub use elastic_first::ElasticFirst;
pub use elastic_reaction::ElasticReaction;
pub use elastic_solve::{ElasticSolve, MAX_ITERATIONS as MAX_ELASTIC_ITERATIONS};
pub use g2p::G2p;
pub use mpm_grid_update::MpmGridUpdate;
pub use p2g::{P2g, Transfer};
pub use particle_sort::ParticleSort;
pub use push::Push;
pub(super) use push::Shove;
pub use supports::Supports;
