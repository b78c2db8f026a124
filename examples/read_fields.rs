//! Reads fields of the gas and numbers of the particles into arrays, from a shipped scene with changes.

#![allow(clippy::disallowed_macros, reason = "the streams belong to the program")]

use brisance::quantity::Values;
use brisance::scene::Changes;
use brisance::{Gpu, Result, Scene, Simulation};

fn main() -> Result<()> {
    let changes = Changes::variant("small").set("time.until=0.02");
    let scene = Scene::shipped("paper/fig03_elastic_shell_2d.toml", changes)?;
    let mut simulation = Simulation::new(&Gpu::best()?, &scene)?;
    simulation.advance_to(scene.time.until)?;

    let state = simulation.snapshot()?;
    let [columns, rows, _] = state.grid.cells;
    if let Some(Values::Real(mach)) = state.cell_field("mach") {
        let row = (rows / 2 * columns) as usize;
        println!("Mach number along the middle: {:.2?}", &mach[row..row + columns as usize]);
    }
    if let Some(Values::Real(stress)) = state.particle_field("deviatoric_stress") {
        let largest = stress.iter().copied().fold(0.0, f32::max);
        println!("{} particles, deviatoric stress at most {largest:.3} Pa", state.particles.len());
    }
    match state.gas_at([0.0, 0.0]) {
        Some(gas) => println!("at the origin: {gas:?}"),
        None => println!("no gas at the origin"),
    }
    Ok(())
}
