//! A bullet strikes a plate that is held at its ends, in air, all made in code.

#![allow(clippy::disallowed_macros, reason = "the streams belong to the program")]

use brisance::{Body, Boundary, Domain, Gas, GasState, Gpu, Material, Result, Scene, Shape, Simulation};

fn main() -> Result<()> {
    let metal = [("young_modulus", 2e3), ("poisson_ratio", 0.3), ("yield_stress", 20.0)];
    let metal = Material::new("von_mises", &metal.map(|(name, value)| (name.to_owned(), value)))
        .map_err(brisance::Error::Usage)?;

    let air = Gas::new(GasState::new(1.0, 1.0));
    let bullet = Body::new("bullet", Shape::sphere([0.3, 0.5], 0.06), "metal").density(40.0).velocity([4.0, 0.0]);
    let plate = Body::new("plate", Shape::cuboid([0.5, 0.5], [0.06, 0.8]), "metal").density(20.0);
    let ends = Shape::Difference(vec![Shape::cuboid([0.5, 0.5], [0.2, 1.0]), Shape::cuboid([0.5, 0.5], [0.3, 0.7])]);
    let scene = Scene::builder("A bullet and a plate", Domain::new([48, 48], [1.0, 1.0]), air)
        .sides(&Boundary::Outlet)
        .material("metal", metal)
        .body(bullet)
        .body(plate.clamped(ends))
        .until(0.06)
        .build()?;

    let mut simulation = Simulation::new(&Gpu::best()?, &scene)?;
    simulation.advance_to(scene.time.until)?;
    let state = simulation.snapshot()?;
    for (index, body) in scene.bodies.iter().enumerate() {
        let own = state.particles.iter().filter(|particle| particle.body == index as u32);
        let (mass, momentum) =
            own.fold((0.0, 0.0), |(mass, momentum), p| (mass + p.mass, momentum + p.mass * p.velocity[0]));
        println!("{}: {mass:.4} kg at {:.3} m/s", body.name, momentum / mass);
    }
    Ok(())
}
