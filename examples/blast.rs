//! A blast in a box: a scene made in code, a run, and a picture of the density.

#![allow(clippy::disallowed_macros, reason = "the streams belong to the program")]

use brisance::{Domain, Field, Gas, GasState, Gpu, Renderer, Result, Scene, Shape, Simulation};

fn main() -> Result<()> {
    let hot = GasState::new(1.0, 10.0);
    let gas = Gas::new(GasState::new(1.0, 1.0)).region(Shape::sphere([0.5, 0.5], 0.1), hot);
    let scene = Scene::builder("A blast in a box", Domain::new([128, 128], [1.0, 1.0]), gas).until(0.2).build()?;

    let mut simulation = Simulation::new(&Gpu::best()?, &scene)?;
    let steps = simulation.advance_to(scene.time.until)?;
    println!("{} steps to {} s", steps.len(), simulation.time());

    let path = std::env::temp_dir().join("brisance_blast.png");
    let picture = Renderer::of(&simulation, &scene)?.draw(&scene.render, Field::Density, simulation.time())?;
    picture.save(&path)?;
    println!("density from {:.3} to {:.3} kg/m3: {}", picture.range[0], picture.range[1], path.display());
    Ok(())
}
