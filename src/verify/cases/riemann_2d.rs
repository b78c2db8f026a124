//! Four quarters of the plane that meet in a point.

use crate::Result;
use crate::render::{Plot, Style};
use crate::riemann::ExactRiemann;
use crate::scene::Changes;
use crate::verify::exact::muscl_plane;
use crate::verify::exact::profile::{DENSITY, PRESSURE, Profile};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Run, Session, Setting, Suite};
use crate::verify::harness::{Case, group};
use crate::verify::measure::plane::asymmetry;

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("riemann_2d", "2D Riemann problems", group::UNSTEADY_2D, riemann,
        "P. D. Lax, X.-D. Liu, SIAM J. Sci. Comput. 19 (1998) 319, configurations 3, 4, 6 and 12; exact Riemann solution at the edges; inside, \
             an independent MUSCL-HLLC solver on 400 x 400 cells. The gate of 2.4 is that of Sod's tube over what a sharp method has there.")];

/// Why one side of the diagonal may differ from the other.
const FUSED: &str = "a driver that fuses a product with a sum rounds one side of the diagonal otherwise";

/// One of the problems.
struct Configuration {
    number: u32,
    /// The wave of the 1D problem at the top edge, then at the bottom, that is looked for: 0 the left one, 2 the contact, 4 the right one.
    waves: [usize; 2],
    /// Whether x and y play the same part.
    symmetric: bool,
}

const CONFIGURATIONS: [Configuration; 4] = [
    Configuration { number: 3, waves: [0, 0], symmetric: true },
    Configuration { number: 4, waves: [0, 4], symmetric: true },
    Configuration { number: 6, waves: [2, 2], symmetric: false },
    Configuration { number: 12, waves: [4, 2], symmetric: true },
];

/// Why configuration 12 is further off.
const STANDING: &str =
    "HLLC keeps the two slip lines that stand along the grid as they are, a Lax-Friedrichs flux smears them";

/// Cells along each side of the independent solution.
const FINE: u32 = 400;

fn riemann(session: &mut Session<'_>) -> Result<()> {
    let quick = session.suite == Suite::Quick;
    let (cells, count): (&[u32], _) = if quick { (&[100], 1) } else { (&[100, 200], CONFIGURATIONS.len()) };
    for configuration in &CONFIGURATIONS[..count] {
        let number = configuration.number;
        let variant = (number != 3).then(|| format!("configuration_{number}"));
        let changes = Changes { variants: variant.into_iter().collect(), ..Changes::default() };
        let mut fine = None;
        for &cells in cells {
            let run = session.run("validation/riemann_2d.toml", Setting::standard(cells), &changes)?;
            report_edges(session, &run, configuration);
            let density: Vec<f64> = run.snapshot.density.iter().copied().map(f64::from).collect();
            if configuration.symmetric {
                let name = format!("configuration {number}: largest asymmetry about the diagonal");
                let row = session.check(&run, &name, asymmetry(&run)).source("symmetry");
                row.pass(Limit::AtMost(1e-10)).known(Limit::AtMost(1e-3), FUSED);
            }
            if !quick {
                let scene = run.scene.with_resolution(FINE)?;
                let fine = fine.get_or_insert_with(|| muscl_plane::solve(&scene));
                let [ours, theirs] =
                    [density.clone(), muscl_plane::solve(&run.scene)].map(|own| l1_error(&own, cells, fine));
                let name = format!("configuration {number}: L1 density error over that of MUSCL-HLLC");
                let row = session.check(&run, &name, ours / theirs).source("MUSCL-HLLC, 400 x 400");
                row.pass(Limit::AtMost(2.4));
                if number == 12 {
                    row.known(Limit::AtMost(4.0), STANDING);
                }
            }
            let width = run.scene.domain.spacing();
            let middle = (0..cells as usize).map(|k| [(k as f64 + 0.5) * width, density[k * cells as usize + k]]);
            let plot = Plot::new(format!("{}: density on the diagonal", run.scene.title), "x", "density");
            session.plot(plot.with(run.label.clone(), Style::Line, middle.collect()));
        }
    }
    Ok(())
}

/// Where the wave of each edge stands. There the problem is 1D until what happens in the middle arrives.
fn report_edges(session: &mut Session<'_>, run: &Run, configuration: &Configuration) {
    let (spacing, time) = (run.scene.domain.spacing(), run.snapshot.time);
    for ((name, y), wave) in [("top", 1.0), ("bottom", 0.0)].into_iter().zip(configuration.waves) {
        let [left, right] = [0.0, 1.0].map(|x| {
            let state = run.scene.gas_at([x, y, 0.0]);
            (state.density, state.velocity[0], state.pressure)
        });
        let exact = ExactRiemann::new(run.scene.gas.gamma, left, right);
        let speed = exact.wave_speeds()[wave];
        let [before, behind] = [-1e-6, 1e-6].map(|off| exact.sample(speed + off));
        // the pressure is even across a contact
        let (kind, quantity, level) = match wave {
            2 => ("contact", DENSITY, 0.5 * (before.0 + behind.0)),
            _ => ("shock", PRESSURE, 0.5 * (before.2 + behind.2)),
        };
        let place = 0.5 + speed * time;
        let found = Profile::along(run, 0, y).nearest_crossing(quantity, level, place);
        let row = session.check(run, &format!("configuration {}: {kind} at the {name}", configuration.number), found);
        row.reference(place, "exact Riemann solution").pass(Limit::Between(place - spacing, place + spacing));
    }
}

/// Mean difference from the fine solution, which is averaged over the cells.
fn l1_error(density: &[f64], cells: u32, fine: &[f64]) -> f64 {
    let (n, group) = (cells as usize, (FINE / cells) as usize);
    let mean = |x: usize, y: usize| {
        let rows = (y * group..(y + 1) * group).map(|row| row * FINE as usize + x * group);
        rows.flat_map(|start| &fine[start..start + group]).sum::<f64>() / (group * group) as f64
    };
    let differences = density.iter().enumerate().map(|(cell, own)| (own - mean(cell % n, cell / n)).abs());
    differences.sum::<f64>() / density.len() as f64
}
