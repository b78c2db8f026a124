//! What a picture shows and from where.

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3, Vec4};

use super::camera::{Eye, middle_of};
use super::kernels::LIGHT_CELLS;
use super::paper::Paper;
use crate::explosive::DENSEST;
use crate::scene::{RenderSettings, Scene};
use crate::state::Grid;
use crate::structure::structure;
use crate::structure::types::{vec2u, vec3f, vec3u, vec4f};

/// Diameter of a drawn particle over the edge of its volume: neighbours overlap, so that a body has no holes.
/// Discs of a square lattice must reach the middle of its diagonals; spheres hide each other's gaps.
fn particle_overlap(dimension: u32) -> f32 {
    if dimension == 3 { 1.25 } else { std::f32::consts::SQRT_2 }
}

/// Plastic strain at which a particle has lost half of its brightness.
const DARK_STRAIN: f32 = 0.5;

/// Width of the line around bodies in the plane, in pixels.
const OUTLINE: f32 = 1.2;

/// More cells than a domain has.
const FAR: f32 = 1e6;

/// Length of a step of the ray march over the edge of a cell.
const MARCH_STEP: f32 = 0.7;

structure! {
    /// Uniform of all drawing kernels, one row of 16 bytes per line of fields.
    #[derive(Debug, Clone, Copy, Pod, Zeroable)]
    pub View as "View" {
        /// Cells per axis without the ring; 1 on inactive axes.
        cells: vec3u,
        /// Active axes.
        dimension: u32,
        /// Low corner of the domain \[m\].
        origin: vec3f,
        /// Edge of a cell \[m\].
        spacing: f32,
        /// Where rays start: all of them, or the middle one of parallel rays \[m\].
        eye: vec3f,
        /// 1 for parallel rays.
        parallel: u32,
        /// Unit vector to the right of the picture.
        right: vec3f,
        /// Half the height of the picture: at unit distance, or in metres for parallel rays.
        half_height: f32,
        /// Unit vector to the top of the picture.
        up: vec3f,
        /// Ratio of specific heats.
        gamma: f32,
        /// Unit vector into the picture.
        forward: vec3f,
        /// Quantity shown, a `FIELD_` constant of the shaders.
        field: u32,
        /// Rays across the whole picture.
        size: vec2u,
        /// First row of rays of the band drawn now.
        first_row: u32,
        /// Rows of rays of that band.
        rows: u32,
        /// Samples of a ray's place along each axis where particles are drawn.
        samples: u32,
        /// Rays per pixel along each axis.
        supersampling: u32,
        /// Number of particles.
        particles: u32,
        /// Width of the line around bodies in the plane, in rays.
        outline: f32,
        /// Value at the low end of the colours.
        low: f32,
        /// Value at the high end of the colours.
        high: f32,
        /// Power applied to fractions of the range in the ray march.
        contrast: f32,
        /// Length of a step of the ray march \[m\].
        step: f32,
        /// Extinction at opacity 1 \[m^-1\].
        opacity: f32,
        /// 1 if the ray march draws the gas.
        volume: u32,
        /// Nodes of the obstacles' distance per cell and axis, 0 without obstacles.
        fineness: u32,
        /// Kind of line-of-sight picture, an `OPTICS_` constant of the shaders.
        optics: u32,
        /// The floor: the points x with dot(xyz, x) = w; zero for none.
        ground: vec4f,
        /// Radius of a particle over the edge of its volume.
        particle_scale: f32,
        /// Plastic strain at which a particle has lost half of its brightness.
        dark_strain: f32,
        /// Quantity of the particles, a `PARTICLE_` constant of the shaders.
        particle_color: u32,
        /// 1 if the particles make up a smooth surface.
        smooth_skin: u32,
        /// Value at the low end of the particles' colours.
        particle_low: f32,
        /// Value at the high end of the particles' colours.
        particle_high: f32,
        /// Factor on all light.
        exposure: f32,
        /// Tone map, a `TONE_` constant of the shaders.
        tone: u32,
        /// Unit vector towards the light.
        light: vec3f,
        /// Strength of the light.
        light_strength: f32,
        /// Unit vector across the light.
        light_right: vec3f,
        /// Strength of the sky.
        sky_strength: f32,
        /// Unit vector across the light.
        light_up: vec3f,
        /// 1 if there are shadows.
        shadows: u32,
        /// Corner of the light grid that is nearest to the light \[m\].
        light_origin: vec3f,
        /// Edge of a cell of the light grid \[m\].
        light_spacing: f32,
        /// Place in the black-body ramp per p / rho.
        heat_scale: f32,
        /// What is taken off that place.
        heat_offset: f32,
        /// Extinction of the hottest gas \[m^-1\]; 0 for no emission.
        heat_opacity: f32,
        /// Values at the ends of the line-of-sight pictures' grey are -gain and gain.
        gain: f32,
        /// Ratio of specific heats of the second gas; 0 without one.
        species_gamma: f32,
        /// Its gas constant over that of the first.
        species_constant: f32,
        /// Word where its density begins, behind which is its volume fraction.
        species_start: u32,
        /// Its extinction in the ray march \[m^2 kg^-1\].
        soot: f32,
        /// Number of slices.
        slice_count: u32,
        /// Number of contour lines.
        contour_count: u32,
        /// Velocity arrows along x and y.
        arrows: vec2u,
        /// Products of an explosive: A and B \[Pa\], R1 and R2 times its density \[kg m^-3\]; 0 without.
        products: vec4f,
        /// Energy that the explosive holds \[J kg^-1\].
        chemical_energy: f32,
        /// Density beyond which the law of its products does not hold \[kg m^-3\].
        densest: f32,
        /// Rays from one that is followed through the gas to the next.
        bend_pitch: u32,
        /// What is behind everything, a `BACKDROP_` constant of the shaders.
        backdrop: u32,
        /// n - 1 per density of what bends rays, exaggerated \[m^3 kg^-1\]; 0 where nothing does.
        refraction: f32,
        /// Density of the ambient gas \[kg m^-3\].
        ambient_density: f32,
        /// Distance along rays from which they may be bent \[m\].
        bend_near: f32,
        /// The same up to which \[m\].
        bend_far: f32,
        /// What its products give where they burn on in the first gas, over that energy \[1\].
        fuel: f32,
        /// Extinction of dust in the ray march \[m^2 kg^-1\]; 0 without any.
        dust: f32,
        /// Fills the space before vectors.
        unused: [f32; 2],
        /// Share of the light that dust scatters, by colour.
        dust_color: vec4f,
        /// Added to the distance in cells from the low sides before what is seen of gas fades: 0 for open sides, far for others.
        far_from_low: vec4f,
        /// The same of the high sides.
        far_from_high: vec4f,
        /// Light behind everything in 3D, at the top and the bottom of the picture.
        background: [vec4f; 2],
        /// Slices: the points x with dot(xyz, x) = w.
        slices: [vec4f; 4],
        /// Values of the contour lines, as fractions of the range.
        contours: [vec4f; 8],
    }
}

impl View {
    /// Grid, camera, light and places of a picture of `size` pixels; what depends on field and range is set later.
    pub(super) fn new(scene: &Scene, grid: &Grid, eye: &Eye, look: &RenderSettings, size: [u32; 2]) -> Self {
        let supersampling = look.supersampling.clamp(1, 4);
        let products = scene.gas.products();
        let mut view = Self {
            cells: grid.cells,
            dimension: grid.dimension,
            origin: grid.origin,
            spacing: grid.spacing,
            eye: eye.position.into(),
            parallel: eye.parallel.into(),
            right: eye.forward.cross(eye.up).into(),
            half_height: eye.half_height,
            up: eye.up.into(),
            gamma: scene.gas.gamma as f32,
            forward: eye.forward.into(),
            size: size.map(|pixels| pixels * supersampling),
            // Several rays per pixel smooth edges well enough.
            samples: if supersampling > 1 { 1 } else { 2 },
            supersampling,
            outline: OUTLINE * supersampling as f32,
            low: 0.0,
            high: 1.0,
            contrast: 1.0,
            step: MARCH_STEP * grid.spacing,
            volume: look.volume.into(),
            ground: if look.ground && grid.dimension == 3 { floor(grid, single(scene.gravity)) } else { [0.0; 4] },
            particle_scale: 0.5 * particle_overlap(grid.dimension),
            dark_strain: DARK_STRAIN,
            particle_low: 0.0,
            particle_high: 1.0,
            exposure: look.exposure as f32,
            gain: 1.0,
            species_gamma: scene.gas.equation_of_state().species.map_or(0.0, |species| species.gamma as f32),
            products: products.map_or([0.0; 4], |own| own.products.rates(own.density).map(|term| term as f32)),
            chemical_energy: products.map_or(0.0, |own| own.specific_energy() as f32),
            densest: products.map_or(0.0, |own| (DENSEST * own.density) as f32),
            fuel: scene.gas.equation_of_state().species.map_or(0.0, |species| species.fuel as f32),
            species_constant: scene.gas.equation_of_state().constant_ratio(1.0) as f32,
            background: Paper::sky(look).map(|[red, green, blue]| [red, green, blue, 1.0]),
            ..Self::zeroed()
        };
        view.set_light(grid, look);
        view.set_sides(scene);
        for (plane, slice) in view.slices.iter_mut().zip(&look.slices) {
            let normal = single(slice.normal).normalize_or(Vec3::Z);
            *plane = normal.extend(normal.dot(scene.domain.in_frame(slice.point).into())).into();
        }
        view.slice_count = look.slices.len().min(view.slices.len()) as u32;
        view
    }

    /// Axes of the light, and the box along them that holds the whole domain.
    fn set_light(&mut self, grid: &Grid, look: &RenderSettings) {
        let light = single(look.light.direction).normalize_or(Vec3::Z);
        let (right, up) = light.any_orthonormal_pair();
        let reach = 0.5 * Vec3::from(grid.extent()).length();
        self.light = light.into();
        (self.light_right, self.light_up) = (right.into(), up.into());
        self.light_origin = (middle_of(grid) - reach * right - reach * up + reach * light).into();
        self.light_spacing = 2.0 * reach / LIGHT_CELLS as f32;
        self.light_strength = look.light.strength as f32;
        self.sky_strength = look.light.ambient as f32;
        self.shadows = u32::from(look.light.shadows && grid.dimension == 3);
    }

    /// Gas is cut off at open sides, so that it fades before them; the floor is seen and ends it.
    fn set_sides(&mut self, scene: &Scene) {
        for (index, side) in scene.boundary.sides().into_iter().enumerate() {
            let (axis, high) = (index / 2, index % 2 == 1);
            let towards = if high { -self.ground[axis] } else { self.ground[axis] };
            let far = if side.is_closed() || towards > 0.0 { FAR } else { 0.0 };
            *(if high { &mut self.far_from_high[axis] } else { &mut self.far_from_low[axis] }) = far;
        }
    }

    /// Where a point appears, in rays from the top left corner, and its depth along the view axis \[m\].
    fn project(&self, point: Vec3) -> (Vec2, f32) {
        let relative = point - Vec3::from(self.eye);
        let depth = relative.dot(self.forward.into());
        let offset = Vec2::new(relative.dot(self.right.into()), -relative.dot(self.up.into()));
        let size = Vec2::new(self.size[0] as f32, self.size[1] as f32);
        let scale = if self.parallel == 1 { self.half_height } else { depth * self.half_height };
        (0.5 * size + offset / scale * 0.5 * size.y, depth)
    }

    /// The twelve edges of the domain as the shader reads them: end points in rays, then their depths.
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
            return Self::NO_EDGE;
        }
        let cut = |near: Vec3, far: Vec3| near.lerp(far, (nearest - depth(near)) / (depth(far) - depth(near)));
        let from_seen = if depth_from < nearest { cut(from, to) } else { from };
        let to_seen = if depth_to < nearest { cut(to, from) } else { to };
        let ((a, depth_a), (b, depth_b)) = (self.project(from_seen), self.project(to_seen));
        [Vec4::new(a.x, a.y, b.x, b.y), Vec4::new(depth_a, depth_b, 0.0, 0.0)]
    }

    /// An edge outside of every picture.
    pub(super) const NO_EDGE: [Vec4; 2] = [Vec4::splat(-1e6), Vec4::ONE];
}

/// The plane of the domain's floor, as normal and offset: the side that gravity points to, low z without gravity.
fn floor(grid: &Grid, gravity: Vec3) -> [f32; 4] {
    let axis = (0..3).rev().max_by(|&a, &b| gravity[a].abs().total_cmp(&gravity[b].abs())).unwrap_or(2);
    let axis = if gravity == Vec3::ZERO { 2 } else { axis };
    let high = gravity[axis] > 0.0;
    let mut normal = Vec3::ZERO;
    normal[axis] = if high { -1.0 } else { 1.0 };
    let side = grid.origin[axis] + if high { grid.extent()[axis] } else { 0.0 };
    normal.extend(normal[axis] * side).into()
}

fn single(vector: [f64; 3]) -> Vec3 {
    Vec3::from_array(vector.map(|coordinate| coordinate as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: Grid = Grid { dimension: 3, cells: [4; 3], frame: [0.0; 3], origin: [0.0, 1.0, 2.0], spacing: 0.5 };

    #[test]
    fn the_floor_is_where_things_fall() {
        assert_eq!(floor(&CUBE, Vec3::ZERO), [0.0, 0.0, 1.0, 2.0]);
        assert_eq!(floor(&CUBE, Vec3::new(0.0, -9.8, 0.1)), [0.0, 1.0, 0.0, 1.0]);
        assert_eq!(floor(&CUBE, Vec3::X), [-1.0, 0.0, 0.0, -2.0]);
    }

    /// What is open is cut off; the floor is not, though it is open to gas here.
    #[test]
    fn gas_fades_before_open_sides_alone() {
        let text = "title = \"open\"\ndomain = { dimension = 3, cells = [8, 8, 8], size = [1.0, 1.0, 1.0] }\n\
             gas.ambient = { density = 1.0, pressure = 1.0 }\ntime.until = 1.0\nrender.ground = true\n\
             boundary = { x_min = \"outlet\", z_min = \"outlet\", z_max = \"outlet\" }";
        let scene = Scene::parse(text, "open.toml", &[]).unwrap();
        let grid = Grid::of(&scene.domain);
        let eye = Eye::of_camera(&crate::render::camera::fitting_camera(&grid, [64, 64]), [0.0; 3]);
        let view = View::new(&scene, &grid, &eye, &scene.render, [64, 64]);
        assert_eq!([view.far_from_low, view.far_from_high], [[0.0, FAR, FAR, 0.0], [FAR, FAR, 0.0, 0.0]]);
    }

    /// Points appear where the rays through their pixels pass, for both kinds of camera.
    #[test]
    fn projection_is_the_inverse_of_rays() {
        let camera = |height| crate::scene::Camera {
            eye: [3.0, -4.0, 3.5],
            target: [1.0, 2.0, 3.0],
            up: [0.0, 0.0, 1.0],
            fov_degrees: 40.0,
            height,
        };
        for height in [None, Some(3.0)] {
            let eye = Eye::of_camera(&camera(height), [0.0; 3]);
            let view = View {
                eye: eye.position.into(),
                parallel: eye.parallel.into(),
                right: eye.forward.cross(eye.up).into(),
                up: eye.up.into(),
                forward: eye.forward.into(),
                half_height: eye.half_height,
                size: [640, 480],
                ..View::zeroed()
            };
            let point = Vec3::new(1.3, 1.2, 3.9);
            let (pixel, depth) = view.project(point);
            let ray = eye.ray(Vec2::new(640.0, 480.0), pixel);
            let [origin, direction] = [ray.origin, ray.direction].map(single);
            let passed = origin + direction * (depth / direction.dot(eye.forward));
            assert!(passed.distance(point) < 1e-4, "{height:?}: {passed} instead of {point}");
        }
    }
}
