//! One-dimensional building blocks of the two element pairs (rows: node -1, 0, +1; columns: low, high vertex).

use crate::Pair;
use crate::grid::Grid;

/// -int N_v dN_i on a unit cell.
pub fn gradient(pair: Pair) -> [[f64; 2]; 3] {
    match pair {
        Pair::B2b1 => [[1.0 / 3.0, 1.0 / 6.0], [-1.0 / 6.0, 1.0 / 6.0], [-1.0 / 6.0, -1.0 / 3.0]],
        Pair::B1b0 => [[0.5, 0.0], [-0.5, 0.5], [0.0, -0.5]],
    }
}

/// int N_v N_i on a unit cell.
pub fn overlap(pair: Pair) -> [[f64; 2]; 3] {
    match pair {
        Pair::B2b1 => [[1.0 / 8.0, 1.0 / 24.0], [1.0 / 3.0, 1.0 / 3.0], [1.0 / 24.0, 1.0 / 8.0]],
        Pair::B1b0 => [[1.0 / 8.0, 0.0], [3.0 / 8.0, 3.0 / 8.0], [0.0, 1.0 / 8.0]],
    }
}

/// int N_i on a unit cell.
pub fn weight(pair: Pair) -> [f64; 3] {
    match pair {
        Pair::B2b1 => [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0],
        Pair::B1b0 => [1.0 / 8.0, 3.0 / 4.0, 1.0 / 8.0],
    }
}

/// Product of `overlap` over the active axes other than `axis`.
pub fn tangential(grid: &Grid, overlap: &[[f64; 2]; 3], axis: usize, node: [i32; 3], corner: [i32; 3]) -> f64 {
    (0..grid.dimension).filter(|d| *d != axis).map(|d| overlap[(node[d] + 1) as usize][corner[d] as usize]).product()
}

/// Mass weight of a node of an element, product over the active axes.
pub fn node_weight(grid: &Grid, pair: Pair, node: [i32; 3]) -> f64 {
    (0..grid.dimension).map(|d| weight(pair)[(node[d] + 1) as usize]).product()
}
