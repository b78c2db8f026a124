//! Dust that lies on the ground until the gas takes it along.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Boundary, CutGeometry, Scene};

/// Dust that lies on walls until the gas beside them is fast enough to take it along. It goes where the gas goes and does nothing to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dust {
    /// Sides of the domain that it lies on, by name as `z_min`: where they are walls.
    #[serde(default)]
    pub sides: Vec<String>,
    /// Whether it lies on obstacles, too.
    #[serde(default)]
    pub obstacles: bool,
    /// How much of it lies there `[kg m^-2]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub amount: f64,
    /// Speed of the gas in the cell beside it from which it is taken along `[m s^-1]`.
    #[schemars(extend("minimum" = 0))]
    pub threshold: f64,
    /// What is taken, per area and time, over density times the speed beyond the threshold. It falls with what still lies there.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub rate: f64,
}

impl Scene {
    /// Dust that lies beside each cell at the start, per volume of a whole cell \[kg m^-3\], x fastest; all zero without any.
    #[must_use]
    pub fn loose_dust(&self, geometry: &CutGeometry) -> Vec<f64> {
        let mut loose = vec![0.0; self.domain.cell_count()];
        let Some(dust) = &self.gas.dust else { return loose };
        let cells = self.domain.cells.map(|n| n as usize);
        let at = |[x, y, z]: [usize; 3]| x + cells[0] * (y + cells[1] * z);
        let open = self.open_shares(geometry);
        for (place, wall) in geometry.walls.iter().enumerate() {
            let cell = [place % cells[0], place / cells[0] % cells[1], place / (cells[0] * cells[1])];
            if *wall {
                continue;
            }
            let mut closed = [0.0; 3];
            for side in 0..2 * self.domain.axes() {
                let (axis, up) = (side / 2, side % 2 == 1);
                let share = open(place, side);
                if cell[axis] == if up { cells[axis] - 1 } else { 0 } {
                    let own = self.is_dusty(dust, side, cell.map(|c| c as u32));
                    loose[place] += if own { share } else { 0.0 };
                } else if dust.obstacles {
                    let mut other = cell;
                    other[axis] = if up { cell[axis] + 1 } else { cell[axis] - 1 };
                    let gap = if geometry.walls[at(other)] { 1.0 } else { 1.0 - share };
                    closed[axis] += if up { gap } else { -gap };
                }
            }
            loose[place] += closed.iter().map(|area| area * area).sum::<f64>().sqrt();
        }
        loose.iter_mut().for_each(|area| *area *= dust.amount / self.domain.spacing());
        loose
    }

    /// Whether dust lies on a side before a cell.
    fn is_dusty(&self, dust: &Dust, side: usize, cell: [u32; 3]) -> bool {
        let boundary = &self.boundary;
        let named = dust.sides.iter().any(|name| name == super::Boundaries::NAMES[side]);
        let rule = boundary.sides()[side].rule_at(self.domain.face_center(side, cell));
        named && *boundary.sides()[side].rules()[rule] == Boundary::Wall
    }

    /// Open shares of the faces of cells, by place and side.
    fn open_shares<'g>(&self, geometry: &'g CutGeometry) -> impl Fn(usize, usize) -> f64 + use<'g> {
        let cells = self.domain.cells.map(|n| n as usize);
        let at = |cell: [u32; 3]| cell[0] as usize + cells[0] * (cell[1] as usize + cells[1] * cell[2] as usize);
        let cut: std::collections::BTreeMap<usize, [f64; 6]> =
            geometry.cells.iter().map(|own| (at(own.cell), own.part.apertures)).collect();
        move |place, side| cut.get(&place).map_or(1.0, |apertures| apertures[side])
    }
}
