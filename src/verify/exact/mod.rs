//! Numbers from elsewhere: closed formulas, and solvers that share nothing with the device.

pub mod gasdynamics;
pub mod muscl;
pub mod muscl_plane;
pub(super) mod profile;
pub(super) mod taylor_wave;
