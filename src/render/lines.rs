//! What the line plots of 1D need, read back from the device.

use super::buffers::{Sources, read_species};
use super::palette;
use super::plot::Line;
use super::stored::elements;
use crate::Result;
use crate::gpu::Gpu;
use crate::scene::{Scene, held_energy};
use crate::snapshot::kind;

/// Reads a one-dimensional state; the exact solution beside it has a few points per pixel of `width`.
pub(super) fn read(gpu: &Gpu, sources: &Sources, scene: &Scene, width: u32, time: f64) -> Result<Line> {
    let grid = sources.grid;
    let conserved: Vec<[f32; 4]> = grid.unpadded(&elements(gpu, &sources.conserved, grid.slots())?);
    let energy: Vec<f32> = grid.unpadded(&elements(gpu, &sources.energy, grid.slots())?);
    let cells: Vec<u32> = grid.unpadded(&elements(gpu, &sources.cells, grid.slots())?);
    let velocity: Vec<f32> = conserved.iter().map(|state| state[1] / state[0]).collect();
    let gases = scene.gas.equation_of_state();
    let species = sources.species.as_ref().map(|(buffer, start, parts)| (buffer, *start, *parts));
    let species = read_species(gpu, species, grid.slots())?;
    let parts: Vec<Vec<f32>> = species.chunks(grid.slots()).map(|part| grid.unpadded(part)).collect();
    let thermal = |(cell, (state, energy)): (usize, (&[f32; 4], &f32))| {
        let [own, phi, unburned] = [0, 1, 2].map(|k: usize| parts.get(k).map_or(0.0, |own| own[cell]));
        let [density, x, y, z] = *state;
        let all = [density, x, y, z, *energy, own, phi].map(f64::from);
        gases.pressure(all, held_energy(own, unburned).into()) as f32
    };
    let pressure = conserved.iter().zip(&energy).enumerate().map(thermal).collect();
    let density = conserved.iter().map(|state| state[0]).collect();
    let mut particles = Vec::new();
    if let Some(own) = &sources.particles {
        let count = own.count as usize;
        let position: Vec<[f32; 4]> = elements(gpu, &own.position, count)?;
        let velocity: Vec<[f32; 4]> = elements(gpu, &own.velocity, count)?;
        let deformation: Vec<[[f32; 4]; 3]> = elements(gpu, &own.deformation, count)?;
        let colors = palette::of_bodies(scene);
        let color = |place: &[[f32; 4]; 3]| colors[place[0][3].to_bits() as usize % colors.len()];
        let active = |index: &usize| deformation[*index][1][3] != 0.0;
        particles = (0..count)
            .filter(active)
            .map(|index| (position[index][0], velocity[index][0], color(&deformation[index])))
            .collect();
    }
    let kind = cells.iter().map(|word| (word & u32::from(kind::MASK)) as u8).collect();
    let exact = exact_lines(scene, width, time);
    Ok(Line { grid, kind, gas: [density, velocity, pressure], particles, exact })
}

/// Density, velocity and pressure of the exact solution over x, if the scene has one.
fn exact_lines(scene: &Scene, width: u32, time: f64) -> Option<[Vec<[f64; 2]>; 3]> {
    let (exact, jump) = scene.riemann_until_waves_leave(time).filter(|_| time > 0.0)?;
    let (low, points) = (scene.domain.origin[0], 2 * width);
    let places = (0..=points).map(|k| low + scene.domain.size[0] * f64::from(k) / f64::from(points));
    let mut lines = [const { Vec::new() }; 3];
    for x in places {
        let (density, velocity, pressure) = exact.sample((x - jump) / time);
        for (line, value) in lines.iter_mut().zip([density, velocity, pressure]) {
            line.push([x, value]);
        }
    }
    Some(lines)
}
