//! What a picture shows and from where; mirror of `shaders/shared/view.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3, Vec4};

use super::camera::Eye;
use crate::scene::Scene;
use crate::state::Grid;

/// Diameter of a drawn particle over the edge of its volume: neighbours overlap, so that a body has no holes.
/// Discs of a square lattice must reach the middle of its diagonals; spheres hide each other's gaps.
fn particle_overlap(dimension: u32) -> f32 {
    if dimension == 3 { 1.25 } else { std::f32::consts::SQRT_2 }
}

/// Plastic strain at which a particle has lost half of its brightness.
const DARK_STRAIN: f32 = 0.5;

/// Length of a step of the ray march over the edge of a cell.
const MARCH_STEP: f32 = 0.7;

/// Uniform of all drawing kernels, one row of 16 bytes per line of fields.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct View {
    /// Cells per axis without the ring; 1 on inactive axes.
    pub cells: [u32; 3],
    /// Active axes.
    pub dimension: u32,
    /// Low corner of the domain \[m\].
    pub origin: [f32; 3],
    /// Edge of a cell \[m\].
    pub spacing: f32,
    /// Where rays start: all of them, or the middle one of parallel rays \[m\].
    pub eye: [f32; 3],
    /// 1 for parallel rays.
    pub parallel: u32,
    /// Unit vector to the right of the picture.
    pub right: [f32; 3],
    /// Half the height of the picture: at unit distance, or in metres for parallel rays.
    pub half_height: f32,
    /// Unit vector to the top of the picture.
    pub up: [f32; 3],
    /// Ratio of specific heats.
    pub gamma: f32,
    /// Unit vector into the picture.
    pub forward: [f32; 3],
    /// Quantity shown, a `FIELD_` constant of the shaders.
    pub field: u32,
    /// Unit vector towards the light.
    pub light: [f32; 3],
    /// Radius of a particle over the edge of its volume.
    pub particle_scale: f32,
    /// Pixels of the picture.
    pub size: [u32; 2],
    /// Number of particles.
    pub particles: u32,
    /// 1 if cells are drawn as squares, 0 if values are interpolated.
    pub squares: u32,
    /// Value at the low end of the colours.
    pub low: f32,
    /// Value at the high end of the colours.
    pub high: f32,
    /// Fraction of the range that is transparent in the ray march.
    pub neutral: f32,
    /// Extinction of the most opaque value \[m^-1\].
    pub opacity: f32,
    /// Length of a step of the ray march \[m\].
    pub step: f32,
    /// 1 if cells of the domain may be walls.
    pub obstacles: u32,
    /// Power applied to fractions of the range in the ray march.
    pub contrast: f32,
    /// Plastic strain at which a particle has lost half of its brightness.
    pub dark_strain: f32,
}

impl View {
    /// The view of a scene through an eye in a picture of `size` pixels; range and field are set per picture.
    pub(super) fn new(scene: &Scene, grid: &Grid, eye: &Eye, size: [u32; 2], particles: u32) -> Self {
        let right = eye.forward.cross(eye.up);
        let light = (0.75 * eye.up - 0.55 * right - 0.65 * eye.forward).normalize();
        Self {
            cells: grid.cells,
            dimension: grid.dimension,
            origin: grid.origin,
            spacing: grid.spacing,
            eye: eye.position.into(),
            parallel: eye.parallel.into(),
            right: right.into(),
            half_height: eye.half_height,
            up: eye.up.into(),
            gamma: scene.gas.gamma as f32,
            forward: eye.forward.into(),
            field: 0,
            light: light.into(),
            particle_scale: 0.5 * particle_overlap(grid.dimension),
            size,
            particles,
            // Interpolation would hide the cells of a coarse grid and invent detail.
            squares: u32::from(size[0] >= 4 * grid.cells[0]),
            low: 0.0,
            high: 1.0,
            neutral: 0.0,
            opacity: 0.0,
            step: MARCH_STEP * grid.spacing,
            obstacles: u32::from(!scene.obstacles.is_empty()),
            contrast: 1.0,
            dark_strain: DARK_STRAIN,
        }
    }

    /// Where a point appears, in pixels from the top left corner, and its depth along the view axis \[m\].
    fn project(&self, point: Vec3) -> (Vec2, f32) {
        let relative = point - Vec3::from(self.eye);
        let depth = relative.dot(self.forward.into());
        let offset = Vec2::new(relative.dot(self.right.into()), -relative.dot(self.up.into()));
        let size = Vec2::new(self.size[0] as f32, self.size[1] as f32);
        (0.5 * size + offset / (depth * self.half_height) * 0.5 * size.y, depth)
    }

    /// The twelve edges of the domain as the shader reads them: end points in pixels, then their depths.
    /// Edges behind the eye become points outside of the picture.
    pub(crate) fn edges(&self) -> [[Vec4; 2]; 12] {
        let low = Vec3::from(self.origin);
        let extent = Vec3::from_array(self.cells.map(|count| count as f32 * self.spacing));
        std::array::from_fn(|index| {
            let (axis, corner) = (index / 4, index % 4);
            let mut from = low;
            from[(axis + 1) % 3] += extent[(axis + 1) % 3] * (corner & 1) as f32;
            from[(axis + 2) % 3] += extent[(axis + 2) % 3] * (corner >> 1) as f32;
            let mut to = from;
            to[axis] += extent[axis];
            self.edge(from, to)
        })
    }

    fn edge(&self, from: Vec3, to: Vec3) -> [Vec4; 2] {
        let nearest = 1e-3 * self.spacing;
        let depth = |point: Vec3| (point - Vec3::from(self.eye)).dot(self.forward.into());
        let (depth_from, depth_to) = (depth(from), depth(to));
        if depth_from.max(depth_to) <= nearest {
            return [Vec4::splat(-1e6), Vec4::ONE];
        }
        let cut = |near: Vec3, far: Vec3| near.lerp(far, (nearest - depth(near)) / (depth(far) - depth(near)));
        let from_seen = if depth_from < nearest { cut(from, to) } else { from };
        let to_seen = if depth_to < nearest { cut(to, from) } else { to };
        let ((a, depth_a), (b, depth_b)) = (self.project(from_seen), self.project(to_seen));
        [Vec4::new(a.x, a.y, b.x, b.y), Vec4::new(depth_a, depth_b, 0.0, 0.0)]
    }
}
