//! Twin of the solve, and the elements.

pub(crate) mod coupled_solve;
pub(crate) mod element;
