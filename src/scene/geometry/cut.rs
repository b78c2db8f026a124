//! Static obstacles by their true surface: which part of each cell is gas, how far its faces are open, and which small parts share
//! one state with a neighbour.

use std::collections::BTreeMap;

use crate::scene::geometry::polyhedron::{Part, corner, part};
use crate::scene::{Obstacles, Pair, Paper, Scene};

/// Vertices nearer to the surface than this share of a cell lie on it: no part of a cell is a sliver.
const SNAP: f64 = 1e-3;
/// Parts below this share of a cell join a neighbour: an explicit step of whole cells then suits them.
const SMALL: f64 = 0.5;
/// Axes along which the surface normal has at least this share of its largest component lead to the partner.
const SLANTED: f64 = 0.5;
/// A part from this size on is a whole cell.
const WHOLE: f64 = 1.0 - 1e-9;
/// Halvings that find the surface on an edge.
const HALVINGS: u32 = 40;

/// A cell that the surface of an obstacle crosses, or that shares its state with one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutCell {
    /// Which.
    pub cell: [u32; 3],
    /// Its gas, in units of the cell edge, from the centre of the cell.
    pub part: Part,
    /// Place of its cluster.
    pub cluster: usize,
    /// Whether an obstacle holds its centre: a wall where cells are whole.
    pub walled: bool,
}

/// The obstacles on the grid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CutGeometry {
    /// Cells without gas, x fastest, without padding.
    pub walls: Vec<bool>,
    /// Cells that are not plain.
    pub cells: Vec<CutCell>,
    /// Cells that share one state: places in `cells`, ascending. Each cell is in one of them, most alone.
    pub clusters: Vec<Vec<usize>>,
}

impl CutGeometry {
    /// Whether a cut cell is gas where its cluster is whole: all whose centre is free, or else the one with most gas.
    pub(crate) fn whole_gas(&self, place: usize) -> bool {
        let cluster = &self.clusters[self.cells[place].cluster];
        let volume = |at: &usize| self.cells[*at].part.volume;
        let largest = cluster.iter().copied().max_by(|a, b| volume(a).total_cmp(&volume(b)));
        let walled = |at: usize| self.cells[at].walled;
        !walled(place) || (cluster.iter().all(|&at| walled(at)) && largest == Some(place))
    }
}

impl Scene {
    /// Whether obstacles act by their true surface.
    #[must_use]
    pub fn cut(&self) -> bool {
        let able = self.numerics.pair == Pair::B1b0 && !self.obstacles.is_empty() && self.cuts_beside_bodies();
        able && self.numerics.paper.obstacles != Obstacles::Cells
    }

    /// Whether nothing forbids cut cells in a scene with bodies: forms of the coupling that the paper compares, dust, explosives.
    fn cuts_beside_bodies(&self) -> bool {
        let paper = &self.numerics.paper;
        let default = Paper::default();
        let usual = [
            paper.coupling == default.coupling,
            paper.ghost == default.ghost,
            paper.solid_update == default.solid_update,
            self.gas.dust.is_none(),
            self.gas.products().is_none(),
        ];
        self.bodies.is_empty() || usual.iter().all(|usual| *usual)
    }

    /// Whether an obstacle fills the cell around a point, or a part of it.
    pub(crate) fn holds_obstacle(&self, point: [f64; 3]) -> bool {
        let domain = &self.domain;
        let place = |d: usize| ((point[d] - domain.origin[d]) / domain.spacing()).max(0.0) as u32;
        let cell = std::array::from_fn(|d| place(d).min(domain.cells[d] - 1));
        let cutter = Cutter { scene: self, walls: Vec::new(), parts: BTreeMap::new() };
        let filled = || self.cut() && cutter.part_of(cell).volume < WHOLE;
        self.obstacle_distance(domain.cell_center(cell)) < 0.0 || filled()
    }

    /// What the obstacles leave of the cells; with whole cells the walls alone.
    #[must_use]
    pub fn cut_geometry(&self) -> CutGeometry {
        if !self.cut() {
            return CutGeometry { walls: self.obstacle_cells(), ..CutGeometry::default() };
        }
        let mut cutter = Cutter { scene: self, walls: Vec::new(), parts: BTreeMap::new() };
        cutter.cut();
        cutter.match_seams();
        cutter.close();
        let clusters = cutter.clusters();
        cutter.finish(&clusters)
    }
}

/// Work in progress; cells by their place in the unpadded array.
struct Cutter<'s> {
    scene: &'s Scene,
    walls: Vec<bool>,
    parts: BTreeMap<usize, Part>,
}

impl Cutter<'_> {
    /// Every cell by itself.
    fn cut(&mut self) {
        let domain = &self.scene.domain;
        let reach = 0.5 * domain.spacing() * f64::from(domain.dimension).sqrt();
        for index in 0..domain.cell_count() {
            let cell = self.cell_at(index);
            let middle = self.scene.obstacle_distance(domain.cell_center(cell));
            let mut wall = middle < 0.0;
            if middle.abs() < reach {
                let part = self.part_of(cell);
                // what is thinner than a cell may lie between its vertices
                wall = part.volume <= 0.0 || (part.volume > WHOLE && middle < 0.0);
                if !wall && part.volume <= WHOLE {
                    self.parts.insert(index, part);
                }
            }
            self.walls.push(wall);
        }
    }

    /// The gas part of one cell.
    fn part_of(&self, cell: [u32; 3]) -> Part {
        let (domain, spacing) = (&self.scene.domain, self.scene.domain.spacing());
        let vertex = |k: usize| -> [f64; 3] {
            std::array::from_fn(|d| match d < domain.axes() {
                true => domain.origin[d] + f64::from(cell[d] + (k >> d & 1) as u32) * spacing,
                false => 0.0,
            })
        };
        let distance = |k: usize| {
            let found = self.scene.obstacle_distance(vertex(k));
            if found.abs() < SNAP * spacing { 0.0 } else { found }
        };
        let at_corner: [f64; 8] = std::array::from_fn(distance);
        let crossing = |a: usize, b: usize| {
            let (from, to) = (vertex(a), vertex(b));
            let along = |t: f64| std::array::from_fn(|d| from[d] + t * (to[d] - from[d]));
            let (mut low, mut high) = (0.0, 1.0);
            if at_corner[a] == 0.0 || at_corner[b] == 0.0 {
                low = if at_corner[b] == 0.0 { 1.0 } else { 0.0 };
                high = low;
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                let outside = self.scene.obstacle_distance(along(middle)) > 0.0;
                if low == high || outside == (at_corner[a] > 0.0) { low = middle } else { high = middle }
            }
            let t = 0.5 * (low + high);
            std::array::from_fn(|d| corner(a)[d] + t * (corner(b)[d] - corner(a)[d]))
        };
        part(at_corner.map(|distance| distance > 0.0), crossing)
    }

    /// A face between the ends of a periodic axis is as open as its less open side, whatever shape ends there.
    fn match_seams(&mut self) {
        let axes = (0..self.scene.domain.axes()).filter(|&axis| self.scene.boundary.periodic(axis));
        for (axis, index) in axes.flat_map(|axis| (0..self.walls.len()).map(move |index| (axis, index))) {
            let Some(beyond) = self.neighbour(index, face_offset(2 * axis)).filter(|_| self.cell_at(index)[axis] == 0)
            else {
                continue;
            };
            let whole = || part([true; 8], |_, _| [0.0; 3]);
            let of = |at: usize| self.parts.get(&at).copied().unwrap_or_else(whole);
            let (mut low, mut high) = (of(beyond), of(index));
            let apart = high.apertures[2 * axis] - low.apertures[2 * axis + 1];
            if self.walls[index] || self.walls[beyond] || apart.abs() < 1e-12 {
                continue;
            }
            if apart > 0.0 {
                high.take_face(2 * axis, &low, 2 * axis + 1);
                self.parts.insert(index, high);
            } else {
                low.take_face(2 * axis + 1, &high, 2 * axis);
                self.parts.insert(beyond, low);
            }
        }
    }

    /// Faces towards cells without gas are closed; gas without an open face is none.
    fn close(&mut self) {
        for (&index, part) in &mut self.parts.clone() {
            for face in 0..6 {
                let beyond = self.neighbour(index, face_offset(face));
                if beyond.is_some_and(|beyond| self.walls[beyond]) {
                    part.apertures[face] = 0.0;
                }
            }
            let open = (0..2 * self.scene.domain.axes()).any(|face| part.apertures[face] > 0.0);
            if open {
                self.parts.insert(index, *part);
            } else {
                self.parts.remove(&index);
                self.walls[index] = true;
            }
        }
    }

    /// Small parts join the neighbour in the direction of the surface normal. For each cell in a cluster its partner, if it has one.
    fn clusters(&self) -> BTreeMap<usize, usize> {
        let small = self.parts.iter().filter(|(_, part)| part.volume < SMALL);
        small.filter_map(|(&index, part)| Some((index, self.partner(index, part)?))).collect()
    }

    fn partner(&self, index: usize, part: &Part) -> Option<usize> {
        let axes = self.scene.domain.axes();
        let normal: [f64; 3] =
            std::array::from_fn(|d| if d < axes { part.apertures[2 * d + 1] - part.apertures[2 * d] } else { 0.0 });
        let largest = normal.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let slanted = normal.map(|x| if x.abs() > SLANTED * largest { x.signum() as i32 } else { 0 });
        let volume = |at: usize| self.parts.get(&at).map_or(1.0, |part| part.volume);
        let larger = |at: &usize| !self.walls[*at] && volume(*at) > part.volume && volume(*at) >= SMALL;
        let straight = self.neighbour(index, slanted).filter(larger);
        straight.or_else(|| {
            let open = (0..2 * axes).filter(|&face| part.apertures[face] > 0.0);
            let around = open.filter_map(|face| {
                let beyond = self.neighbour(index, face_offset(face))?;
                (!self.walls[beyond] && volume(beyond) > part.volume).then_some((part.apertures[face], beyond))
            });
            around.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, beyond)| beyond)
        })
    }

    /// Puts cells and clusters in order.
    fn finish(self, partners: &BTreeMap<usize, usize>) -> CutGeometry {
        // partners are larger, so following them ends
        let root = |mut index: usize| {
            while let Some(&next) = partners.get(&index) {
                index = next;
            }
            index
        };
        let mut parts = self.parts.clone();
        for &partner in partners.values() {
            parts.entry(partner).or_insert_with(|| part([true; 8], |_, _| [0.0; 3]));
        }
        let mut geometry = CutGeometry { walls: self.walls.clone(), ..CutGeometry::default() };
        let mut places: BTreeMap<usize, usize> = BTreeMap::new();
        for (place, (&index, &part)) in parts.iter().enumerate() {
            let cluster = *places.entry(root(index)).or_insert_with(|| {
                geometry.clusters.push(Vec::new());
                geometry.clusters.len() - 1
            });
            geometry.clusters[cluster].push(place);
            let cell = self.cell_at(index);
            let walled = self.scene.obstacle_distance(self.scene.domain.cell_center(cell)) < 0.0;
            geometry.cells.push(CutCell { cell, part, cluster, walled });
        }
        geometry
    }

    fn cell_at(&self, index: usize) -> [u32; 3] {
        let [nx, ny, _] = self.scene.domain.cells.map(|n| n as usize);
        [index % nx, index / nx % ny, index / (nx * ny)].map(|n| n as u32)
    }

    /// The cell at an offset; none beyond the domain.
    fn neighbour(&self, index: usize, offset: [i32; 3]) -> Option<usize> {
        let (cell, cells) = (self.cell_at(index), self.scene.domain.cells.map(|n| n as i32));
        let mut place = [0; 3];
        for d in 0..3 {
            let at = cell[d] as i32 + offset[d];
            let at = if self.scene.boundary.periodic(d) { at.rem_euclid(cells[d]) } else { at };
            if at < 0 || at >= cells[d] {
                return None;
            }
            place[d] = at as usize;
        }
        Some(place[0] + cells[0] as usize * (place[1] + cells[1] as usize * place[2]))
    }
}

/// Offset of the cell beyond a face.
fn face_offset(face: usize) -> [i32; 3] {
    let mut offset = [0; 3];
    offset[face / 2] = if face % 2 == 1 { 1 } else { -1 };
    offset
}
