//! What a gauge that is fixed to a material point records.

use serde::{Deserialize, Serialize};

use crate::snapshot::ParticleRows;
use crate::state::Grid;
use crate::state::gauges::GAUGE_WIDTH;

/// A material point of a body after a step; no numbers once it has left the domain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PointRecord {
    /// From its place at the start \[m\].
    pub displacement: [f32; 3],
    /// \[m s^-1\]
    pub velocity: [f32; 3],
    /// Elastic part of the strain of Green and Lagrange, (F^T F - 1) / 2: xx, yy, zz, xy, yz, zx.
    pub elastic_strain: [f32; 6],
    /// Cauchy stress \[Pa\]: xx, yy, zz, xy, yz, zx.
    pub stress: [f32; 6],
    /// Accumulated plastic strain.
    pub plastic_strain: f32,
    /// Damage, from 0 to 1 for broken.
    pub damage: f32,
}

impl PointRecord {
    /// From the entries of the history ring, see `shaders/step/gauges.wgsl`, and where the points were at the start.
    pub(crate) fn from_raw(raw: &[[f32; 4]], start: &[[f32; 3]], grid: &Grid) -> Vec<Self> {
        raw.chunks_exact(GAUGE_WIDTH as usize).zip(start).map(|(raw, start)| Self::of(raw, *start, grid)).collect()
    }

    fn of(raw: &[[f32; 4]], start: [f32; 3], grid: &Grid) -> Self {
        let rows = ParticleRows {
            position: raw[..1].to_vec(),
            velocity: raw[1..2].to_vec(),
            affine: raw[2..5].to_vec(),
            deformation: raw[5..8].to_vec(),
            stress: raw[8..10].to_vec(),
        };
        if rows.deformation[1][3] == 0.0 {
            let (gone, tensor) = ([f32::NAN; 3], [f32::NAN; 6]);
            let (displacement, velocity, elastic_strain, stress) = (gone, gone, tensor, tensor);
            return Self { displacement, velocity, elastic_strain, stress, plastic_strain: f32::NAN, damage: f32::NAN };
        }
        let sample = rows.sample(grid, 0);
        Self {
            displacement: std::array::from_fn(|axis| sample.position[axis] - start[axis]),
            velocity: sample.velocity,
            elastic_strain: strain(&rows.deformation),
            stress: sample.stress,
            plastic_strain: sample.plastic_strain,
            damage: sample.damage,
        }
    }
}

/// (H + H^T + H^T H) / 2 of the columns of H = F - 1: small strains keep their digits.
fn strain(columns: &[[f32; 4]]) -> [f32; 6] {
    let h = |row: usize, column: usize| f64::from(columns[column][row]);
    let product = |i: usize, j: usize| (0..3).map(|k| h(k, i) * h(k, j)).sum::<f64>();
    let entry = |(i, j): (usize, usize)| (0.5 * (h(i, j) + h(j, i) + product(i, j))) as f32;
    [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)].map(entry)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body turned by 90 degrees about z and then stretched by a hundredth along y: its material is longer along x.
    #[test]
    fn strain_knows_no_rotation() {
        let grid = Grid { dimension: 3, cells: [4; 3], frame: [0.0; 3], origin: [0.0; 3], spacing: 1.0 };
        let mut raw = vec![[0.0; 4]; 10];
        (raw[0], raw[1]) = ([1.5, 2.0, 0.5, 3.0], [4.0, 5.0, 6.0, 0.25]);
        // F = [[0, -1, 0], [1.01, 0, 0], [0, 0, 1]], less the identity
        (raw[5], raw[6], raw[7]) = ([-1.0, 1.01, 0.0, 0.0], [-1.0, -1.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.5]);
        raw[8] = [1.01, 2.02, 0.0, 0.0];
        let [point] = PointRecord::from_raw(&raw, &[[1.0, 2.0, 0.0]], &grid)[..] else { panic!("one point") };
        let right = [0.5 * (1.01f32 * 1.01 - 1.0), 0.0, 0.0, 0.0, 0.0, 0.0];
        assert!(point.elastic_strain.iter().zip(right).all(|(a, b)| (a - b).abs() < 1e-6), "{point:?}");
        assert_eq!((point.displacement, point.velocity, point.damage), ([0.5, 0.0, 0.5], [4.0, 5.0, 6.0], 0.5));
        assert!((point.stress[0] - 4.0).abs() < 1e-5 && (point.stress[1] - 8.0).abs() < 1e-5, "{point:?}");
        raw[6][3] = 0.0;
        assert!(PointRecord::from_raw(&raw, &[[1.0; 3]], &grid)[0].stress[0].is_nan());
    }
}
