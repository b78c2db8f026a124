//! Clamped plates under a blast: they bulge, and stay so.

use crate::Result;
use crate::diagnostics::StepRecord;
use crate::render::{Plot, Style};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Session, Setting};
use crate::verify::harness::{Case, group};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::full("blasted_strip", "Clamped strip under a blast", group::SOLIDS, strip,
        "N. Jones, Structural Impact, chapter 7: rigid, perfectly plastic clamped beam under an impulse."),
];

/// Half of the free width \[m\], thickness \[m\], density \[kg m^-3\], yield stress of a rod \[Pa\].
const STRIP: [f64; 4] = [0.05, 0.002, 2700.0, 3e8];
/// Of a square inside the yield curve of a beam over one around it.
const INNER_SQUARE: f64 = 0.618;

/// Deflection over thickness of a beam of a yield stress \[Pa\] that has got a speed \[m s^-1\].
fn jones(speed: f64, yield_stress: f64) -> f64 {
    let [half, thickness, density, _] = STRIP;
    let number = density * speed * speed * half * half / (yield_stress * thickness * thickness);
    0.5 * ((1.0 + 3.0 * number).sqrt() - 1.0)
}

/// Speed \[m s^-1\] that the free part has from the work of the gas: clamps do none.
fn speed_given(records: &[StepRecord]) -> f64 {
    let [half, thickness, density, _] = STRIP;
    let of = |record: &StepRecord| record.loads.first().map_or(0.0, |load| f64::from(record.dt * load.power));
    let work: f64 = records.iter().map(of).sum();
    (2.0 * work / (2.0 * half * thickness * density)).sqrt()
}

fn strip(session: &mut Session<'_>) -> Result<()> {
    for cells in [120, 240] {
        let run = session.run("validation/blasted_strip.toml", Setting::standard(cells), &[])?;
        let speed = speed_given(&run.records);
        let lifted: Vec<[f64; 2]> = run
            .records
            .iter()
            .filter_map(|record| Some([record.time, f64::from(record.points.first()?.displacement[1]) / STRIP[1]]))
            .collect();
        // it swings about where it stays
        let late = lifted.iter().filter(|[time, _]| *time > 0.6 * run.scene.time.until);
        let (count, sum) = late.fold((0.0, 0.0), |(count, sum), [_, y]| (count + 1.0, sum + y));
        let plane = STRIP[3] * 2.0 / 3.0_f64.sqrt();
        let bounds = [jones(speed, plane), jones(speed, INNER_SQUARE * plane)];
        session.check(&run, "speed that the gas gave [m/s]", speed).source("its work");
        let row = session.check(&run, "deflection that stays, over thickness", sum / count);
        row.reference(0.5 * (bounds[0] + bounds[1]), "N. Jones").pass(Limit::Between(bounds[0], bounds[1]));
        session.plot(
            Plot::new("Strip under a blast: middle", "time [s]", "deflection over thickness")
                .with(
                    "bounds",
                    Style::Reference,
                    bounds.iter().flat_map(|y| [[0.0, *y], [run.scene.time.until, *y]]).collect(),
                )
                .with(run.label.clone(), Style::Line, lifted),
        );
    }
    Ok(())
}
