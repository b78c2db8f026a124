//! Clamped plates under a blast: they bulge, and stay so.

use crate::Result;
use crate::diagnostics::StepRecord;
use crate::render::{Plot, Style};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Run, Session, Setting};
use crate::verify::harness::{Case, group};

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::full("blasted_strip", "Clamped strip under a blast", group::SOLIDS, strip,
        "N. Jones, Structural Impact, chapter 7: rigid, perfectly plastic clamped beam under an impulse."),
    Case::full("blasted_plate", "Clamped square plate of steel under a blast", group::SOLIDS, plate,
        "N. Jones, Structural Impact, chapter 7: rigid, perfectly plastic plate; G. N. Nurick, J. B. Martin, Int. J. Impact Eng. 8 (1989) 171: \
         0.48 phi + 0.277, the mean of many plates of steel that scatter by a thickness."),
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
    (2.0 * work_of(records) / (2.0 * half * thickness * density)).sqrt()
}

/// Work that the gas has done on the first body \[J\].
fn work_of(records: &[StepRecord]) -> f64 {
    let of = |record: &StepRecord| record.loads.first().map_or(0.0, |load| f64::from(record.dt * load.power));
    records.iter().map(of).sum()
}

/// Displacement of the first point along an axis over a length, over the time; and its mean in the last two fifths, for it swings about where it
/// stays.
fn lifted(run: &Run, axis: usize, length: f64) -> (Vec<[f64; 2]>, f64) {
    let of = |record: &StepRecord| Some([record.time, f64::from(record.points.first()?.displacement[axis]) / length]);
    let all: Vec<[f64; 2]> = run.records.iter().filter_map(of).collect();
    let late = all.iter().filter(|[time, _]| *time > 0.6 * run.scene.time.until);
    let (count, sum) = late.fold((0.0, 0.0), |(count, sum), [_, y]| (count + 1.0, sum + y));
    (all, sum / count)
}

fn strip(session: &mut Session<'_>) -> Result<()> {
    for cells in [120, 240] {
        let run = session.run("validation/blasted_strip.toml", Setting::standard(cells), &[])?;
        let speed = speed_given(&run.records);
        let (lifted, stays) = lifted(&run, 1, STRIP[1]);
        let plane = STRIP[3] * 2.0 / 3.0_f64.sqrt();
        let bounds = [jones(speed, plane), jones(speed, INNER_SQUARE * plane)];
        session.check(&run, "speed that the gas gave [m/s]", speed).source("its work");
        let row = session.check(&run, "deflection that stays, over thickness", stays);
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

/// Half of the free side \[m\], thickness \[m\], density \[kg m^-3\], yield stress of a rod \[Pa\].
const PLATE: [f64; 4] = [0.04, 0.004, 7850.0, 5.5e8];
/// Of mild steel: the rate \[s^-1\] at which its yield stress is twice that at rest, and the root by which it grows. [Cowper and Symonds 1957]
const RATE: [f64; 2] = [40.4, 5.0];

/// Deflection over thickness of a square plate of a yield stress \[Pa\] that has got a speed \[m s^-1\].
fn jones_plate(speed: f64, yield_stress: f64) -> f64 {
    let [half, thickness, density, _] = PLATE;
    let number = 4.0 * density * speed * speed * half * half / (yield_stress * thickness * thickness);
    (1.0 + number / 6.0).sqrt() - 1.0
}

/// Why it bulges more than the square inside the yield curve allows.
const COARSE: &str = "two cells through the thickness; a finer plate was not run";

fn plate(session: &mut Session<'_>) -> Result<()> {
    let run = session.run("validation/blasted_plate.toml", Setting::standard(0), &[])?;
    let [half, thickness, density, flow] = PLATE;
    let speed = (2.0 * work_of(&run.records) / (4.0 * half * half * thickness * density)).sqrt();
    let (lifted, stays) = lifted(&run, 2, thickness);
    let bounds = [jones_plate(speed, flow), jones_plate(speed, INNER_SQUARE * flow)];
    session.check(&run, "speed that the gas gave [m/s]", speed).source("its work");
    let row = session.check(&run, "deflection that stays, over thickness", stays);
    row.reference(0.5 * (bounds[0] + bounds[1]), "N. Jones").pass(Limit::Between(bounds[0], bounds[1]));
    row.known(Limit::Between(bounds[0], 1.05 * bounds[1]), COARSE);
    // mean rate of a plate that bulges to there from this speed [Perrone and Bhadra 1984], and the steel at rest that has the yield stress then
    let rate = speed * stays * thickness / (3.0 * std::f64::consts::SQRT_2 * half * half);
    let at_rest = flow / (1.0 + (rate / RATE[0]).powf(1.0 / RATE[1]));
    let number = speed * half / thickness * (density / at_rest).sqrt();
    let measured = 0.48 * number + 0.277;
    session.check(&run, "number of Nurick", number).source("impulse that the gas gave");
    let row = session.check(&run, "deflection that stays, over thickness, beside experiments", stays);
    row.reference(measured, "Nurick and Martin").pass(Limit::Between(measured - 1.0, measured + 1.0));
    let plot = Plot::new("Plate under a blast: middle", "time [s]", "deflection over thickness");
    let ends = |y: f64| [[0.0, y], [run.scene.time.until, y]];
    session.plot(
        plot.with("N. Jones", Style::Reference, bounds.iter().flat_map(|y| ends(*y)).collect())
            .with("Nurick and Martin", Style::Guide, ends(measured).to_vec())
            .with(run.label.clone(), Style::Line, lifted),
    );
    Ok(())
}
