//! The pressure of gas and bodies.

mod coupled_solve;

pub use coupled_solve::CoupledSolve;
pub(super) use coupled_solve::Turn;
