//! Twin of the solve, and the elements.

pub mod coupled_solve;
pub mod element;
