//! A synthetic state for pictures: a dense blob of hot gas beside the middle, a ring or shell of particles around it, one
//! obstacle.

use std::path::Path;

use brisance::export;
use brisance::gpu::{Buffer, Gpu, GpuOptions};
use brisance::render::{ParticleBuffers, Picture, Renderer, SceneBuffers};
use brisance::scene::Scene;
use brisance::state::Grid;

/// Buffers that play a simulation's state.
pub(crate) struct State {
    pub(crate) grid: Grid,
    pub(crate) conserved: Buffer<[f32; 4]>,
    pub(crate) energy: Buffer<f32>,
    /// Of scenes with a second gas: all of the blob is of it.
    species: Option<Buffer<f32>>,
    pub(crate) cells: Buffer<u32>,
    particles: u32,
    position: Buffer<[f32; 4]>,
    velocity: Buffer<[f32; 4]>,
    affine: Buffer<[f32; 4]>,
    deformation: Buffer<[f32; 4]>,
    stress: Buffer<[f32; 4]>,
}

pub(crate) const BLOB: [f32; 3] = [0.35, 0.6, 0.5];

pub(crate) fn scene(dimension: u32, cells: u32, size: [u32; 2], more: &str) -> Scene {
    let cells = vec![cells; dimension as usize];
    let edges = vec![1.0; dimension as usize];
    let text = format!(
        "title = \"Synthetic state\"\n\
         domain = {{ dimension = {dimension}, cells = {cells:?}, size = {edges:?} }}\n\
         gas.ambient = {{ density = 1.0, pressure = 1.0 }}\n\
         time = {{ until = 1.0, frames = 1 }}\n\
         render.size = {size:?}\n{more}"
    );
    Scene::parse(&text, "synthetic.toml", &[]).expect("the scene of the test is valid")
}

impl State {
    pub(crate) fn new(gpu: &Gpu, scene: &Scene) -> Self {
        let dimension = scene.domain.dimension;
        let spacing = scene.domain.spacing() as f32;
        let grid = Grid { dimension, cells: scene.domain.cells, frame: [0.0; 3], origin: [0.0; 3], spacing };
        let ring: [i32; 3] = grid.padding().map(|n| n as i32);
        let (mut conserved, mut energy, mut cells) =
            (vec![[1.0, 0.0, 0.0, 0.0]; grid.slots()], vec![2.5; grid.slots()], vec![2_u32; grid.slots()]);
        let mut species = vec![0.0; 2 * grid.slots()];
        for (slot, cell) in every_cell(&grid, ring) {
            let inside = (0..3).all(|axis| cell[axis] >= 0 && cell[axis] < grid.cells[axis] as i32);
            let centre = grid.centre(cell);
            let r = distance(&grid, centre);
            let wall = dimension > 1 && centre[0] > 0.85 && centre[1] < 0.15 && (dimension < 3 || centre[2] < 0.3);
            let solid = (r - 0.28).abs() < 0.03;
            cells[slot] = if !inside || wall { 2 } else { u32::from(solid) };
            let density = 1.0 + 3.0 * (1.0 / (1.0 + ((r - 0.2) / 0.012).exp()));
            let speed = r * (-r * r * 40.0).exp();
            let velocity = [speed, 0.5 * speed * centre[2], -0.5 * speed * centre[1]];
            let [u, v, w] = velocity.map(|v| density * v);
            conserved[slot] = [density, u, v, w];
            if r < 0.2 {
                (species[slot], species[grid.slots() + slot]) = (density, 1.0);
            }
            energy[slot] = 2.5 * density.powf(1.4) + 0.5 * (u * u + v * v + w * w) / density;
        }
        let points = shell(&grid);
        let four = |values: Vec<[f32; 4]>, label: &str| Buffer::from_slice(gpu, label, &values).unwrap();
        let volume = (0.5 * spacing).powi(dimension as i32);
        let deformation = points.iter().flat_map(|point| {
            let body = f32::from_bits(u32::from(point[0] > BLOB[0]));
            [[0.0, 0.0, 0.0, body], [0.0, 0.0, 0.0, 1.0], [0.0; 4]]
        });
        let affine = points.iter().flat_map(|point| [[0.0; 4], [0.0, 0.0, 0.0, point[1].powi(4)], [0.0; 4]]);
        Self {
            grid,
            conserved: four(conserved, "conserved"),
            energy: Buffer::from_slice(gpu, "energy", &energy).unwrap(),
            species: (!scene.gas.species.is_empty()).then(|| Buffer::from_slice(gpu, "species", &species).unwrap()),
            cells: Buffer::from_slice(gpu, "cells", &cells).unwrap(),
            particles: points.len() as u32,
            position: four(points.iter().map(|&[x, y, z]| [x, y, z, 1.0]).collect(), "position"),
            velocity: four(points.iter().map(|point| [0.1 + 0.1 * point[0], 0.0, 0.0, volume]).collect(), "velocity"),
            affine: four(affine.collect(), "affine"),
            deformation: four(deformation.collect(), "deformation"),
            stress: four(
                points.iter().flat_map(|point| [[point[0] * volume, 0.0, 0.0, 0.0], [0.0; 4]]).collect(),
                "stress",
            ),
        }
    }

    pub(crate) fn buffers(&self) -> SceneBuffers<'_> {
        SceneBuffers {
            grid: self.grid,
            conserved: self.conserved.raw(),
            energy: self.energy.raw(),
            species: self.species.as_ref().map(|own| (own.raw(), 0, 2)),
            owed: None,
            maps: None,
            dust: None,
            cells: self.cells.raw(),
            particles: Some(ParticleBuffers {
                count: self.particles,
                position: self.position.raw(),
                velocity: self.velocity.raw(),
                affine: self.affine.raw(),
                deformation: self.deformation.raw(),
                stress: self.stress.raw(),
            }),
        }
    }
}

pub(crate) fn every_cell(grid: &Grid, ring: [i32; 3]) -> impl Iterator<Item = (usize, [i32; 3])> {
    let stride = grid.strides().map(|n| n as usize);
    (0..grid.slots()).map(move |slot| {
        let place = [slot % stride[0], slot / stride[0] % stride[1], slot / (stride[0] * stride[1])];
        (slot, std::array::from_fn(|axis| place[axis] as i32 - ring[axis]))
    })
}

fn distance(grid: &Grid, point: [f32; 3]) -> f32 {
    (0..grid.dimension as usize).map(|axis| (point[axis] - BLOB[axis]).powi(2)).sum::<f32>().sqrt()
}

/// Points of a half-cell lattice within a shell around the blob, one quarter left out.
fn shell(grid: &Grid) -> Vec<[f32; 3]> {
    let fine = grid.cells.map(|n| if n > 1 { 2 * n } else { 1 });
    let step = 0.5 * grid.spacing;
    let mut points = Vec::new();
    for index in 0..fine.iter().product::<u32>() {
        let place = [index % fine[0], index / fine[0] % fine[1], index / (fine[0] * fine[1])];
        let point = place.map(|n| (n as f32 + 0.5) * step);
        let left_out = grid.dimension > 1 && point[0] > BLOB[0] && point[1] < BLOB[1];
        if (distance(grid, point) - 0.28).abs() < 0.03 && !left_out {
            points.push(point);
        }
    }
    points
}

pub(crate) fn gpu() -> Gpu {
    Gpu::new(&GpuOptions::default()).expect("the suite needs an adapter; a software one will do")
}

pub(crate) fn render(dimension: u32, cells: u32, size: [u32; 2], more: &str) -> Vec<Picture> {
    let gpu = gpu();
    let scene = scene(dimension, cells, size, more);
    let state = State::new(&gpu, &scene);
    let mut renderer = Renderer::new(&gpu, &scene, &state.buffers()).unwrap();
    let pictures = renderer.render(0.0125).unwrap();
    for picture in &pictures {
        assert_eq!(picture.frame.rgba.len(), 4 * (size[0] * size[1]) as usize);
        let path =
            Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{dimension}d_{}_{}.png", picture.name, size[1]));
        export::png::write(&path, &picture.frame, &[]).unwrap();
    }
    assert_eq!(pictures, Renderer::new(&gpu, &scene, &state.buffers()).unwrap().render(0.0125).unwrap(), "equal bits");
    pictures
}

pub(crate) fn pixel(picture: &Picture, x: u32, y: u32) -> [i32; 3] {
    let first = 4 * (y * picture.frame.width + x) as usize;
    std::array::from_fn(|channel| i32::from(picture.frame.rgba[first + channel]))
}

pub(crate) fn brightness(color: [i32; 3]) -> i32 {
    color.iter().sum()
}
