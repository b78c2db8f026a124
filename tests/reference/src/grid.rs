//! Index space: padded slots, one ring on active axes. Cells, nodes and vertices share it; vertex v is the low corner
//! of cell v.

/// A uniform grid of cubes in one, two or three active axes.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Active axes: x, then y, then z.
    pub dimension: usize,
    /// Cells per axis, 1 on inactive axes.
    pub cells: [i32; 3],
    /// Low corner of the domain.
    pub origin: [f64; 3],
    /// Cell edge.
    pub spacing: f64,
    /// Axes whose ends meet: coordinates there are taken modulo the number of cells.
    pub periodic: [bool; 3],
}

impl Grid {
    /// A grid with one active axis per entry of `cells`.
    pub fn new(cells: &[i32], origin: [f64; 3], spacing: f64) -> Self {
        let mut all = [1; 3];
        all[..cells.len()].copy_from_slice(cells);
        Self { dimension: cells.len(), cells: all, origin, spacing, periodic: [false; 3] }
    }

    fn pad(&self, axis: usize) -> i32 {
        i32::from(axis < self.dimension)
    }

    /// Cells beyond each end that are no others of the domain.
    fn ring(&self, axis: usize) -> i32 {
        if self.periodic[axis] { 0 } else { self.pad(axis) }
    }

    fn extent(&self, axis: usize) -> usize {
        (self.cells[axis] + 2 * self.pad(axis)) as usize
    }

    /// Length of every cell, node and vertex array.
    pub fn slots(&self) -> usize {
        self.extent(0) * self.extent(1) * self.extent(2)
    }

    /// Slot of a cell or vertex; the ring is allowed.
    pub fn slot(&self, c: [i32; 3]) -> usize {
        let place = |axis: usize| if self.periodic[axis] { c[axis].rem_euclid(self.cells[axis]) } else { c[axis] };
        let at = |axis: usize| (place(axis) + self.pad(axis)) as usize;
        at(0) + self.extent(0) * (at(1) + self.extent(1) * at(2))
    }

    /// Inverse of `slot`.
    pub fn coordinates(&self, slot: usize) -> [i32; 3] {
        let (x, y) = (self.extent(0), self.extent(1));
        let raw = [slot % x, slot / x % y, slot / (x * y)];
        [0, 1, 2].map(|axis| raw[axis] as i32 - self.pad(axis))
    }

    /// Is this one of the domain's own cells?
    pub fn contains(&self, c: [i32; 3]) -> bool {
        (0..3).all(|axis| self.periodic[axis] || (c[axis] >= 0 && c[axis] < self.cells[axis]))
    }

    /// Is this a cell of the domain or of its ring?
    pub fn stored(&self, c: [i32; 3]) -> bool {
        (0..3).all(|axis| {
            self.periodic[axis] || (c[axis] >= -self.pad(axis) && c[axis] < self.cells[axis] + self.pad(axis))
        })
    }

    fn range(low: [i32; 3], high: [i32; 3]) -> Vec<[i32; 3]> {
        let mut all = Vec::new();
        for z in low[2]..high[2] {
            for y in low[1]..high[1] {
                for x in low[0]..high[0] {
                    all.push([x, y, z]);
                }
            }
        }
        all
    }

    /// All cells of the domain, x fastest.
    pub fn interior(&self) -> Vec<[i32; 3]> {
        Self::range([0; 3], self.cells)
    }

    /// All cells of the domain and its ring.
    pub fn all(&self) -> Vec<[i32; 3]> {
        Self::range([0, 1, 2].map(|d| -self.ring(d)), [0, 1, 2].map(|d| self.cells[d] + self.ring(d)))
    }

    /// All vertices.
    pub fn vertices(&self) -> Vec<[i32; 3]> {
        Self::range([0; 3], [0, 1, 2].map(|d| self.cells[d] + self.ring(d)))
    }

    /// Low cells of all faces normal to an axis.
    pub fn faces(&self, axis: usize) -> Vec<[i32; 3]> {
        let mut low = [0; 3];
        low[axis] = -self.ring(axis);
        Self::range(low, self.cells)
    }

    /// Offsets from `low` to `high` inclusive on active axes, 0 on the others.
    pub fn offsets(&self, low: i32, high: i32) -> Vec<[i32; 3]> {
        let active = |value: i32| [0, 1, 2].map(|d| if d < self.dimension { value } else { 0 });
        Self::range(active(low), active(high).map(|v| v + 1))
    }

    /// Cell that holds a position.
    pub fn cell_of(&self, position: [f64; 3]) -> [i32; 3] {
        [0, 1, 2].map(|d| {
            if d < self.dimension { ((position[d] - self.origin[d]) / self.spacing).floor() as i32 } else { 0 }
        })
    }

    /// Centre of a cell.
    pub fn centre(&self, c: [i32; 3]) -> [f64; 3] {
        [0, 1, 2].map(|d| self.origin[d] + (f64::from(c[d]) + 0.5) * self.spacing)
    }

    /// Measure of a cell, dx^d.
    pub fn volume(&self) -> f64 {
        self.spacing.powi(self.dimension as i32)
    }

    /// Measure of a face, dx^(d-1).
    pub fn area(&self) -> f64 {
        self.spacing.powi(self.dimension as i32 - 1)
    }
}

/// Component-wise sum.
pub fn add(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// Component-wise difference.
pub fn subtract(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A cell moved by `by` along one axis.
pub fn shift(mut c: [i32; 3], axis: usize, by: i32) -> [i32; 3] {
    c[axis] += by;
    c
}
