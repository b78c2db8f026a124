//! A cylindrical blast wave in gas under pressure: how its shock decays to sound.

use crate::Result;
use crate::render::{Plot, Style};
use crate::verify::harness::row::short;
use crate::verify::harness::session::{Run, Session, Setting, Suite};
use crate::verify::harness::{Case, group};
use crate::verify::measure::plane::fitted_line;
use crate::verify::measure::plane::front;

/// Who computed the reference.
const TABLE: &str = "blast-ips";

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("line_explosion", "Line explosion in gas under pressure", group::BLAST_2D, explosion,
        "Ideal line explosion with counter-pressure, gamma 1.4: table of the solver blast-ips (github.com/shancock9/blast-ips, case C1x4), error 1e-6."),
];

/// Radius over sqrt(E / p0), rise of the pressure over p0, and time of arrival times c0 over sqrt(E / p0).
const SHOCKS: [[f64; 3]; 5] = [
    [0.261_760_18, 3.971_882_4, 0.069_957_109],
    [0.401_953_21, 2.039_620_3, 0.146_374_21],
    [0.626_994_54, 1.100_911_1, 0.296_362_36],
    [1.028_021_2, 0.598_729_94, 0.605_881_17],
    [1.836_869, 0.316_882_62, 1.298_564],
];
/// Width of the domain over the radius of the shock.
const WIDTH: f64 = 1.12;
/// Radius of the hot gas at the start over that of the shock.
const SOURCE: f64 = 0.015;
/// Depth behind the shock over its radius in which the pressure is extended to the shock by a straight line.
const BEHIND: [f64; 2] = [0.015, 0.1];

fn explosion(session: &mut Session<'_>) -> Result<()> {
    let (shocks, cells) = if session.suite == Suite::Quick { (&SHOCKS[2..3], 112) } else { (&SHOCKS[..], 224) };
    let mut found = Vec::new();
    for &[radius, rise, time] in shocks {
        let run = session.run("validation/line_explosion.toml", Setting::standard(cells), &overrides(radius, time))?;
        let points = front(&run, 1.0 + 0.5 * rise);
        let mean = points.iter().map(|point| point[1]).sum::<f64>() / points.len() as f64;
        // Mach number of the shock; it is late by what is missing of the way
        let mach = (1.0 + 1.2 / 1.4 * rise).sqrt();
        let arrival = run.snapshot.time + (radius - mean) / mach;
        let fine = cells == 224;
        let row = session.check(&run, &format!("arrival at {}", short(radius)), arrival).reference(time, TABLE);
        row.within(if fine { 0.01 } else { 0.02 });
        let ours = rise_at_shock(&run, mean);
        let row = session.check(&run, &format!("rise of the pressure at {}", short(radius)), ours);
        row.reference(rise, TABLE).within(if fine { 0.05 } else { 0.1 });
        found.push([radius, ours]);
    }
    let table = SHOCKS.iter().map(|shock| [shock[0], shock[1]]).collect();
    let plot = Plot::new("Line explosion: rise of the pressure at the shock", "radius", "rise").logarithmic();
    session.plot(plot.with(TABLE, Style::Reference, table).with("ours", Style::Marks, found));
    Ok(())
}

/// The scene in a domain for a shock at a radius. In the whole plane the hot gas has energy 1 above that of the gas around.
fn overrides(radius: f64, time: f64) -> Vec<String> {
    let (size, source) = (WIDTH * radius, SOURCE * radius);
    let pressure = 1.0 + 0.4 / (std::f64::consts::PI * source * source);
    vec![
        format!("domain.size=[{size}, {size}]"),
        format!("gas.regions[0].shape={{ sphere = {{ center = [0.0, 0.0], radius = {source} }} }}"),
        format!("gas.regions[0].pressure={pressure}"),
        format!("time.until={time}"),
    ]
}

/// Pressure behind the shock, extended to it, above that ahead.
fn rise_at_shock(run: &Run, radius: f64) -> f64 {
    let domain = &run.scene.domain;
    let width = domain.cells[0];
    let points: Vec<[f64; 2]> = (run.snapshot.pressure.iter().enumerate())
        .map(|(cell, pressure)| {
            let [x, y, _] = domain.cell_center([cell as u32 % width, cell as u32 / width, 0]);
            [1.0 - x.hypot(y) / radius, f64::from(*pressure) - 1.0]
        })
        .filter(|point| (BEHIND[0]..BEHIND[1]).contains(&point[0]))
        .collect();
    fitted_line(&points)[1]
}
