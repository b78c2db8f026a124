//! What stages should compute, on the host in double precision.

use super::Found;
use crate::Result;
use crate::gpu::{Buffer, Gpu, Pass, readback};
use crate::numerics::{Operator, Reduce, Scan};
use crate::scene::Scene;
use crate::simulation::Simulation;
use crate::stage::{P2g, ParticleSort, Transfer};
use crate::state::Grid;

/// Elements of the arrays: two levels of a prefix sum, and no multiple of a workgroup.
const LENGTH: u32 = 2_200_003;

/// Numbers without a pattern, between 0 and 1. [Steele et al. 2014, SplitMix64]
fn random(index: u32) -> f32 {
    let mut z = u64::from(index).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 40) as f32 / 16_777_216.0
}

/// Sum, minimum and maximum of an array.
pub(super) fn reductions(gpu: &Gpu, _full: bool) -> Result<Found> {
    let values: Vec<f32> = (0..LENGTH).map(random).collect();
    let buffer = Buffer::from_slice(gpu, "values", &values)?;
    let mut is = Vec::new();
    for operator in [Operator::Sum, Operator::Min, Operator::Max] {
        let reduce = Reduce::new(gpu, operator, &buffer, LENGTH)?;
        let mut pass = Pass::new(gpu, "reduce");
        reduce.record(&mut pass);
        pass.submit()?;
        is.push(f64::from(readback::read(gpu, reduce.result())?[0]));
    }
    let all = values.iter().copied().map(f64::from);
    let should = [all.clone().sum::<f64>(), all.clone().fold(f64::MAX, f64::min), all.fold(f64::MIN, f64::max)];
    // each on its own scale: the sum is a million times the others
    let relative: Vec<f64> = is.iter().zip(&should).map(|(is, should)| is / should).collect();
    Ok(Found::between(&relative, &[1.0; 3], 2e-6, |k| ["sum", "minimum", "maximum"][k].to_owned()))
}

/// Prefix sum, exact.
pub(super) fn prefix_sum(gpu: &Gpu, _full: bool) -> Result<Found> {
    let counts: Vec<u32> = (0..LENGTH).map(|k| (random(k) * 9.0) as u32).collect();
    let input = Buffer::from_slice(gpu, "counts", &counts)?;
    let output = Buffer::<u32>::new(gpu, "starts", counts.len() + 1)?;
    let scan = Scan::new(gpu, &input, &output, LENGTH)?;
    let mut pass = Pass::new(gpu, "scan");
    scan.record(&mut pass);
    pass.submit()?;
    let is: Vec<f64> = readback::read(gpu, &output)?.into_iter().map(f64::from).collect();
    let mut should = vec![0.0];
    for count in counts {
        should.push(should[should.len() - 1] + f64::from(count));
    }
    Ok(Found::between(&is, &should, 0.0, |k| format!("element {k}")))
}

/// A shell of particles with velocities without a pattern, sorted, with the node sums of a transfer.
struct Transferred {
    simulation: Simulation,
    position: Vec<[f32; 4]>,
    velocity: Vec<[f32; 4]>,
}

fn transferred(gpu: &Gpu, transfer: Transfer) -> Result<Transferred> {
    let scene = Scene::find("bursting_shell_3d", &[])?.with_resolution(16)?;
    let simulation = Simulation::new(gpu, &scene)?;
    let particles = &simulation.state.particles;
    let count = particles.count;
    let velocity: Vec<[f32; 4]> =
        (0..count).map(|p| [0, 1, 2, 3].map(|a| if a < 3 { random(3 * p + a) - 0.5 } else { 0.0 })).collect();
    particles.velocity.write(gpu, 0, &velocity);
    let state = &simulation.state;
    let (sort, p2g) = (ParticleSort::new(state)?, P2g::new(state, transfer)?);
    let mut pass = Pass::new(gpu, "transfer");
    sort.record(&mut pass, &simulation.state);
    p2g.record(&mut pass, &simulation.state);
    pass.submit()?;
    let position = readback::read(gpu, &particles.position)?;
    Ok(Transferred { simulation, position, velocity })
}

/// Cell of a particle, and its place there from the centre, in cells.
fn cell_of(grid: &Grid, position: &[f32; 4]) -> ([i32; 3], [f64; 3]) {
    let place = [0, 1, 2].map(|a| (position[a] - grid.origin[a]) / grid.spacing);
    let cell = place.map(|x| x.floor() as i32);
    (cell, [0, 1, 2].map(|a| f64::from(place[a]) - f64::from(cell[a]) - 0.5))
}

/// Cell of a slot.
fn name_of(grid: &Grid, slot: usize) -> String {
    let [x, y, _] = grid.strides().map(|n| n as usize);
    let ring = grid.padding();
    let at = [slot % x, slot / x % y, slot / (x * y)];
    format!("cell {:?}", [0, 1, 2].map(|a| at[a] as i64 - i64::from(ring[a])))
}

/// Where the particles of every cell begin, and their order.
pub(super) fn sorting(gpu: &Gpu, _full: bool) -> Result<Found> {
    let Transferred { simulation, position, .. } = transferred(gpu, Transfer::Columns)?;
    let grid = simulation.state.grid;
    let slots = grid.slots();
    let mut cells = vec![Vec::new(); slots];
    for (p, x) in position.iter().enumerate() {
        cells[grid.slot(cell_of(&grid, x).0)].push(p as f64);
    }
    let mut should = vec![0.0];
    for cell in &cells {
        should.push(should[should.len() - 1] + cell.len() as f64);
    }
    let is: Vec<f64> =
        readback::read(gpu, &simulation.state.particles.cell_start)?.into_iter().map(f64::from).collect();
    let starts = Found::between(&is, &should, 0.0, |k| name_of(&grid, k.min(slots - 1)));
    if !starts.passed() {
        return Ok(starts);
    }
    let order: Vec<f64> = readback::read(gpu, &simulation.state.particles.order)?.into_iter().map(f64::from).collect();
    Ok(Found::between(&order, &cells.concat(), 0.0, |k| format!("place {k} of the order")))
}

/// Weights of the nodes at -1, 0 and 1 of a quadratic spline. [Steffen et al. 2008]
fn weights(f: f64) -> [f64; 3] {
    [0.5 * (0.5 - f).powi(2), 0.75 - f * f, 0.5 * (0.5 + f).powi(2)]
}

/// Mass and velocity of the nodes.
fn p2g(gpu: &Gpu, transfer: Transfer) -> Result<Found> {
    let Transferred { simulation, position, velocity } = transferred(gpu, transfer)?;
    let grid = simulation.state.grid;
    let mut sums = vec![[0.0_f64; 4]; grid.slots()];
    for (x, v) in position.iter().zip(&velocity) {
        let (cell, place) = cell_of(&grid, x);
        let along = place.map(weights);
        for k in 0..27_usize {
            let offset = [k % 3, k / 3 % 3, k / 9];
            let w = f64::from(x[3]) * along[0][offset[0]] * along[1][offset[1]] * along[2][offset[2]];
            let slot = grid.slot([0, 1, 2].map(|a| cell[a] + offset[a] as i32 - 1));
            for a in 0..3 {
                sums[slot][a] += w * f64::from(v[a]);
            }
            sums[slot][3] += w;
        }
    }
    // momentum and mass: the velocity of a node that hardly has mass says little
    let should: Vec<f64> = sums.iter().flatten().copied().collect();
    let nodes = readback::read(gpu, &simulation.state.particles.node)?;
    let is: Vec<f64> = nodes
        .iter()
        .flat_map(|n| [0, 1, 2, 3].map(|a| f64::from(n[a]) * if a < 3 { f64::from(n[3]) } else { 1.0 }))
        .collect();
    Ok(Found::between(&is, &should, 1e-5, |k| name_of(&grid, k / 4)))
}

/// Particles to nodes, column by column.
pub(super) fn columns(gpu: &Gpu, _full: bool) -> Result<Found> {
    p2g(gpu, Transfer::Columns)
}

/// Particles to nodes, node by node.
pub(super) fn nodes(gpu: &Gpu, _full: bool) -> Result<Found> {
    p2g(gpu, Transfer::Nodes)
}
