//! Small pure helpers.

use glam::DMat3;

/// Turns of the axes, at most: each makes the products off the diagonal smaller.
const TURNS: usize = 32;

/// A number as people write it, with about five digits: 4, 0.81, 12345, 1.5e-7.
pub fn plain(number: f64) -> String {
    let rounded: f64 = format!("{number:.4e}").parse().unwrap_or(number);
    match rounded.abs() {
        0.0 => "0".to_owned(),
        size if (1e-4..1e6).contains(&size) => format!("{rounded}"),
        _ => format!("{rounded:e}"),
    }
}

/// The largest number that divides both.
pub fn greatest_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_divisor(b, a % b) }
}

/// Eigenvalues of a symmetric matrix, largest first. [Jacobi 1846]
pub fn principal(matrix: DMat3) -> [f64; 3] {
    let mut a = matrix.to_cols_array_2d();
    for turn in 0..TURNS {
        let (p, q) = [(0, 1), (0, 2), (1, 2)][turn % 3];
        let off = a[p][q];
        if off == 0.0 {
            continue;
        }
        let theta = (a[q][q] - a[p][p]) / (2.0 * off);
        let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
        let c = 1.0 / t.hypot(1.0);
        let s = t * c;
        for row in &mut a {
            (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
        }
        let (first, second) = (a[p], a[q]);
        a[p] = std::array::from_fn(|k| c * first[k] - s * second[k]);
        a[q] = std::array::from_fn(|k| s * first[k] + c * second[k]);
    }
    let mut values = [a[0][0], a[1][1], a[2][2]];
    values.sort_by(|one, two| two.total_cmp(one));
    values
}
