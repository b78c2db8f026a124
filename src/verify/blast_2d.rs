//! The strong blast wave in 2D: speed, peak, centre, and whether it is round.

use super::Case;
use super::plot::{Plot, Style};
use super::row::Limit;
use super::session::{Run, Session, Setting};
use crate::Result;

/// Who computed the reference.
const SEDOV: &str = "Sedov";
/// Energy over density times radius to the fourth over time squared, for 1.4. [Sedov 1959]
const ALPHA: f64 = 0.984_074_02;

/// The cases of this module.
pub(super) const CASES: &[Case] = &[Case {
    id: "sedov_cylindrical",
    title: "Cylindrical Sedov blast wave",
    group: "Blast in 2D",
    quick: true,
    source: "L. I. Sedov, Similarity and Dimensional Methods in Mechanics, 1959; self-similar solution.",
    run: sedov,
}];

fn sedov(session: &mut Session<'_>) -> Result<()> {
    let run = session.run("validation/sedov_cylindrical.toml", Setting::standard(0), &[])?;
    let time = run.snapshot.time;
    let radius = (energy(&run) * time * time / ALPHA).powf(0.25);
    // behind a strong shock 2 / (gamma + 1) of its speed squared; the radius grows like the root of the time
    let behind = 2.0 / 2.4 * (0.5 * radius / time).powi(2);
    let radii = front(&run, 0.5 * behind);
    let mean = radii.iter().map(|point| point[1]).sum::<f64>() / radii.len() as f64;
    let spread = radii.iter().map(|point| (point[1] - mean).abs()).fold(f64::NAN, f64::max);
    let peak = run.snapshot.density.iter().copied().fold(f32::NAN, f32::max);
    session.check(&run, "radius of the shock", mean).reference(radius, SEDOV).within(0.01);
    session.check(&run, "highest density", peak.into()).reference(6.0, SEDOV).pass(Limit::AtLeast(4.0));
    let center = f64::from(run.snapshot.pressure[0]) / behind;
    session
        .check(&run, "pressure in the middle over that behind the shock", center)
        .reference(0.372_92, SEDOV)
        .within(0.05);
    let row = session.check(&run, "largest deviation from the mean radius, cells", spread / run.scene.domain.spacing());
    row.source("symmetry").pass(Limit::AtMost(1.0));
    session.plot(scatter(&run, radius));
    Ok(())
}

/// Energy of the whole plane at the start: the domain has a quarter of it.
fn energy(run: &Run) -> f64 {
    let cells = run.scene.initial_gas();
    4.0 * run.scene.domain.cell_volume() * cells.iter().map(|cell| cell[4]).sum::<f64>()
}

/// Angle and radius of the outermost points where the pressure crosses `level`, by rows below the diagonal.
fn front(run: &Run, level: f64) -> Vec<[f64; 2]> {
    let [nx, ny, _] = run.scene.domain.cells.map(|n| n as usize);
    let h = run.scene.domain.spacing();
    let mut points = Vec::new();
    for row in 0..ny {
        let pressure = |x: usize| f64::from(run.snapshot.pressure[row * nx + x]);
        let Some(x) = (0..nx - 1).rev().find(|x| pressure(*x) >= level) else { continue };
        let share = (pressure(x) - level) / (pressure(x) - pressure(x + 1));
        let (x, y) = ((x as f64 + 0.5 + share) * h, (row as f64 + 0.5) * h);
        if y <= x {
            points.push([y.atan2(x).to_degrees(), x.hypot(y)]);
        }
    }
    points
}

/// Density of every cell over its radius: a round wave is a line.
fn scatter(run: &Run, radius: f64) -> Plot {
    let nx = run.scene.domain.cells[0] as usize;
    let h = run.scene.domain.spacing();
    let place = |cell: usize| [(cell % nx) as f64 + 0.5, (cell / nx) as f64 + 0.5];
    let radial = |cell: usize| h * place(cell)[0].hypot(place(cell)[1]);
    let cells = (0..run.snapshot.density.len()).filter(|cell| radial(*cell) < 0.4);
    let points = cells.map(|cell| [radial(cell), run.snapshot.density[cell].into()]).collect();
    Plot::new(run.scene.title.as_str(), "radius", "density")
        .with("exact front", Style::Reference, vec![[radius, 1.0], [radius, 6.0]])
        .with(run.label.clone(), Style::Marks, points)
}
