//! Cylinders that shocks carry away: one that lies on the floor of a channel, and a free one.

use crate::Result;
use crate::render::{Plot, Style};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Journey, Session, Setting, Suite};
use crate::verify::harness::{Case, group};
use crate::verify::measure::budgets;

/// Where the paths come from.
const CUT_CELLS: &str = "conservative cut-cell solver";

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("lifting_cylinder", "Lifting cylinder", group::COUPLING, lifting,
        "J. Falcovitz, G. Alfandary, G. Hanoch, J. Comput. Phys. 138 (1997) 83; Y. Cao et al. 2022, Fig. 17; conservative cut-cell solver, 1600 x 320 cells."),
    Case::full("free_cylinder", "Free cylinder behind a shock", group::COUPLING, free,
        "W. D. Henshaw, D. W. Schwendeman, J. Comput. Phys. 216 (2006) 744; conservative cut-cell solver, 200 cells per unit."),
];

/// Time and centre of the lifting cylinder on the finest grid.
const PATH: [[f64; 3]; 6] = [
    [0.05, 0.176_03, 0.057_142],
    [0.1, 0.245_45, 0.071_636],
    [0.1641, 0.353_97, 0.084_425],
    [0.2, 0.421_46, 0.093_661],
    [0.25, 0.522_29, 0.115_74],
    [0.3, 0.631_09, 0.145_73],
];
/// Heights at 0.3 that a prototype of this method in double precision has on 100, 200 and 400 cells.
const HEIGHTS: [(u32, f64); 3] = [(100, 0.125), (200, 0.133), (400, 0.133)];

fn lifting(session: &mut Session<'_>) -> Result<()> {
    let count = if session.suite == Suite::Quick { 1 } else { 3 };
    let mut heights = Vec::new();
    let exact = PATH.iter().map(|[_, x, y]| [*x, *y]).collect();
    let mut plot = Plot::new("Lifting cylinder: path of the centre", "x", "y").with(CUT_CELLS, Style::Reference, exact);
    for (cells, height) in HEIGHTS.iter().take(count) {
        let times = PATH.iter().map(|station| station[0]);
        let journey = session.follow("paper/fig17_lifting_cylinder.toml", Setting::standard(*cells), &[], times)?;
        let path = journey.path(0);
        let [x, y, _] = path[PATH.len()].1.centroid;
        report_lift(session, &journey, [x, y], *height);
        heights.push(y);
        plot = plot.with(
            journey.run.label.clone(),
            Style::Both,
            path.iter().map(|(_, b)| [b.centroid[0], b.centroid[1]]).collect(),
        );
    }
    session.plot(plot);
    if let [coarse, middle, fine] = heights[..] {
        let rise = (middle - coarse).min(fine - middle);
        let row = session.push("y at 0.3, least rise from grid to grid", rise).source(CUT_CELLS);
        row.pass(Limit::AtLeast(0.0)).known(Limit::AtLeast(-0.005), LOW);
    }
    Ok(())
}

/// Why the cylinder rises too little.
const LOW: &str = "the push of the shock under the cylinder falls short, by 7 % at 0.05 on 400 cells, and that of its reflection by more";

fn report_lift(session: &mut Session<'_>, journey: &Journey, [x, y]: [f64; 2], height: f64) {
    let [_, exact_x, exact_y] = PATH[PATH.len() - 1];
    let run = &journey.run;
    // the gates of a converged answer are for the finest of our grids
    let fine = run.scene.domain.cells[0] >= 400;
    let row = session.check(run, "x at 0.3", x).reference(exact_x, CUT_CELLS);
    if fine {
        row.pass(Limit::Between(exact_x - 0.015, exact_x + 0.015));
    }
    let row = session.check(run, "y at 0.3", y).reference(exact_y, CUT_CELLS);
    if fine {
        row.pass(Limit::Between(exact_y - 0.01, exact_y + 0.01)).known(Limit::Between(exact_y - 0.02, exact_y), LOW);
    }
    let row = session.check(run, "y at 0.3 against the prototype", y).reference(height, "prototype, double precision");
    row.pass(Limit::AtLeast(height)).known(Limit::AtLeast(height - 0.005), LOW);
    let (_, body) = &journey.path(0)[PATH.len()];
    session.check(run, "velocity along x at 0.3", body.velocity[0]).reference(2.2672, CUT_CELLS);
    session.check(run, "velocity along y at 0.3", body.velocity[1]).reference(0.5937, CUT_CELLS);
    budgets::report(session, journey, None);
    let row = session.check(run, "PCG iterations per step, mean, goal", run.solver.mean_iterations);
    row.source("default rules").pass(Limit::AtMost(12.0));
}

/// Why the free cylinder stays behind.
const STAIR: &str = "the error falls by a sixth per doubling; standing, a stair of cells takes 4 to 6 % more impulse than cut cells, \
so gas does not slip along it freely: whether that is all is a guess";

fn free(session: &mut Session<'_>) -> Result<()> {
    let cells: &[u32] = if session.suite == Suite::Quick { &[100] } else { &[100, 200, 400] };
    for &cells in cells {
        let path = "validation/free_cylinder.toml";
        let journey = session.follow(path, Setting::standard(cells), &[], [0.5, 1.0, 1.5])?;
        let run = &journey.run;
        let (_, body) = journey.path(0).swap_remove(3);
        let place = session.check(run, "x at 1.5", body.centroid[0]).reference(0.366_79, CUT_CELLS);
        if cells >= 400 {
            place.pass(Limit::Between(0.366_79 - 0.01, 0.366_79 + 0.01)).known(Limit::AtLeast(0.33), STAIR);
        }
        let velocity = session.check(run, "velocity at 1.5", body.velocity[0]).reference(1.008, CUT_CELLS);
        if cells >= 400 {
            velocity.within(0.02).known(Limit::AtLeast(0.94), STAIR);
        }
        let row = session.check(run, "y at 1.5", body.centroid[1]);
        row.reference(0.0, "symmetry").pass(Limit::Between(-1e-3, 1e-3));
        budgets::report(session, &journey, None);
    }
    Ok(())
}
