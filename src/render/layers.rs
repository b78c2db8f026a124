//! What compositors take of a picture: light with alpha, depth, objects, velocities, and the camera.

use glam::{Mat4, Vec3, Vec4};

use super::camera::Eye;
use super::kernels::bind_numbers;
use super::screen::Shared;
use crate::Result;
use crate::gpu::{Bound, Buffer, Extent, Pass, readback};

/// A pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerPixel {
    /// Linear light before the tone map without the background, red, green, blue, times alpha; and alpha.
    pub light: [f32; 4],
    /// Depth along the view axis of what is nearest of bodies, obstacles and the floor \[m\]; infinite for nothing.
    pub depth: f32,
    /// What that is: 0 nothing, then the bodies in their order from 1 on, then obstacles and the floor.
    pub object: u32,
    /// Its velocity \[m s^-1\].
    pub velocity: [f32; 3],
}

impl LayerPixel {
    /// A pixel of flat colour with nothing in it.
    #[must_use]
    pub(super) fn flat([red, green, blue]: [f32; 3]) -> Self {
        Self { light: [red, green, blue, 1.0], depth: f32::INFINITY, object: 0, velocity: [0.0; 3] }
    }
}

/// The layers of a picture without letters and what else is around the plot.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Layers {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Rows from the top.
    pub pixels: Vec<LayerPixel>,
    /// From the world to the camera, which looks along -z with y upwards; then to the picture, -1 to 1 from left to right and from below.
    /// Columns one after the other. None of line plots.
    pub camera: Option<[[f32; 16]; 2]>,
}

/// The matrices of an eye for a picture of a width over its height.
pub(super) fn camera(eye: &Eye, aspect: f32) -> [[f32; 16]; 2] {
    let right = eye.forward.cross(eye.up);
    let place = eye.frame + eye.position.as_dvec3();
    let row = |axis: Vec3| axis.extend(-axis.as_dvec3().dot(place) as f32);
    let to_camera = Mat4::from_cols(row(right), row(eye.up), row(-eye.forward), Vec4::W).transpose();
    let (x, y) = (1.0 / (aspect * eye.half_height), 1.0 / eye.half_height);
    // depths from a thousandth of a metre to a thousand kilometres
    let (near, far) = (1e-3f32, 1e6f32);
    let to_picture = if eye.parallel {
        let depth = -2.0 / (far - near);
        Mat4::from_cols_array(&[
            x,
            0.0,
            0.0,
            0.0,
            0.0,
            y,
            0.0,
            0.0,
            0.0,
            0.0,
            depth,
            0.0,
            0.0,
            0.0,
            -(far + near) / (far - near),
            1.0,
        ])
    } else {
        let (a, b) = (-(far + near) / (far - near), -2.0 * far * near / (far - near));
        Mat4::from_cols_array(&[x, 0.0, 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, 0.0, a, -1.0, 0.0, 0.0, b, 0.0])
    };
    [to_camera, to_picture * to_camera].map(|matrix| matrix.to_cols_array())
}

/// The kernel and what it writes.
#[derive(Debug)]
pub(super) struct LayerKernel {
    finish: Bound,
    layers: Buffer<[[f32; 4]; 3]>,
}

impl LayerKernel {
    /// For so many pixels of a band, with its rays' light, solids and bends, and depths and particles of its samples if there are any.
    pub(super) fn new(
        shared: &Shared,
        pixels: usize,
        drawn: [(&str, &wgpu::Buffer); 3],
        switches: &[(&str, bool)],
        samples: Option<[&Buffer<u32>; 2]>,
    ) -> Result<Self> {
        let Shared { gpu, sources, gas, .. } = *shared;
        let layers: Buffer<[[f32; 4]; 3]> = Buffer::new(gpu, "layers", pixels)?;
        let (nothing, none): (Buffer<u32>, Buffer<[f32; 4]>) =
            (Buffer::new(gpu, "no samples", 1)?, Buffer::new(gpu, "no particles", 1)?);
        let [depth, nearest] = samples.map_or([nothing.raw(); 2], |own| own.map(Buffer::raw));
        let [deformation, velocity] =
            sources.particles.as_ref().map_or([none.raw(); 2], |own| [&own.deformation, &own.velocity]);
        let own = [
            ("view", gas.view.raw()),
            ("depth_in", depth),
            ("nearest", nearest),
            ("deformation", deformation),
            ("velocity", velocity),
            ("layers", layers.raw()),
        ];
        let mut numbers = vec![("OBSTACLES", shared.bodies as f64 + 1.0)];
        numbers.extend(switches.iter().map(|&(name, on)| (name, f64::from(u8::from(on)))));
        let finish = bind_numbers(gpu, "picture/layers.wgsl", "finish_layers", &numbers, &[&own[..], &drawn].concat())?;
        Ok(Self { finish, layers })
    }

    /// Appends the pixels of the band drawn last.
    pub(super) fn read(&self, shared: &Shared, count: usize, all: &mut Vec<LayerPixel>) -> Result<()> {
        let mut pass = Pass::new(shared.gpu, "layers");
        pass.dispatch(&self.finish, &Extent::Threads(count as u64));
        pass.submit()?;
        readback::read_into(shared.gpu, &self.layers, count, pixel, all)
    }
}

fn pixel([light, [depth, object, ..], [x, y, z, _]]: [[f32; 4]; 3]) -> LayerPixel {
    let depth = if depth < 0.0 { f32::INFINITY } else { depth };
    LayerPixel { light, depth, object: object as u32, velocity: [x, y, z] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Camera;

    /// The middle of the picture is the target, and the upper edge is half the opening angle away.
    #[test]
    fn matrices_put_points_where_rays_show_them() {
        let mut seen =
            Camera { eye: [2.0, -3.0, 1.5], target: [0.5; 3], up: [0.0, 0.0, 1.0], fov_degrees: 30.0, height: None };
        for height in [None, Some(2.0)] {
            seen.height = height;
            let (eye, size) = (Eye::of_camera(&seen, [0.0; 3]), glam::Vec2::new(640.0, 360.0));
            let [to_camera, to_picture] = camera(&eye, size.x / size.y).map(|all| Mat4::from_cols_array(&all));
            for pixel in [[320.0, 180.0], [0.0, 0.0], [640.0, 270.0]] {
                let ray = eye.ray(size, pixel.into());
                let point = (glam::DVec3::from(ray.origin) + 2.5 * glam::DVec3::from(ray.direction)).as_vec3();
                let place = to_picture.project_point3(point);
                let right = glam::Vec2::new(pixel[0] / 320.0 - 1.0, 1.0 - pixel[1] / 180.0);
                assert!(place.truncate().distance(right) < 1e-4, "{pixel:?}: {place}, not {right}");
                assert!(to_camera.transform_point3(point).z < 0.0);
            }
        }
    }
}
