//! A loop of one's own: stops at every frame, looks at the steps, and writes a numbered picture.

#![allow(clippy::disallowed_macros, reason = "the streams belong to the program")]

use brisance::{Domain, Field, Gas, GasState, Gpu, Renderer, Result, Scene, Shape, Simulation};

const FRAMES: u32 = 4;

fn main() -> Result<()> {
    let dense = GasState::new(2.0, 5.0);
    let gas = Gas::new(GasState::new(1.0, 1.0)).region(Shape::cuboid([0.25, 0.5], [0.3, 1.0]), dense);
    let scene = Scene::builder("A shock and a ball", Domain::new([96, 48], [2.0, 1.0]), gas)
        .obstacle("ball", Shape::sphere([1.0, 0.5], 0.15))
        .probe("behind", [1.5, 0.5])
        .until(0.6)
        .build()?;

    let mut simulation = Simulation::new(&Gpu::best()?, &scene)?;
    let mut renderer = Renderer::of(&simulation, &scene)?;
    let folder = std::env::temp_dir();
    for frame in 0..=FRAMES {
        let steps = simulation.advance_to(scene.time.until * f64::from(frame) / f64::from(FRAMES))?;
        let iterations: u32 = steps.iter().map(|step| step.iterations).sum();
        let picture = renderer.draw(&scene.render, Field::Schlieren, simulation.time())?;
        let path = folder.join(format!("brisance_frame_{frame}.png"));
        picture.save(&path)?;
        println!("{:.2} s, {} steps, {iterations} iterations: {}", simulation.time(), steps.len(), path.display());
    }
    Ok(())
}
