//! Charges that stand on the grid: a plane detonation, what it leaves in a tube of air, and a tube of copper that it drives.

use crate::Result;
use crate::diagnostics::StepRecord;
use crate::explosive::{Expansion, NearField, explosive};
use crate::scene::Pair;
use crate::snapshot::Snapshot;
use crate::verify::exact::profile::{DENSITY, PRESSURE, Profile, VELOCITY};
use crate::verify::exact::taylor_wave::TaylorWave;
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Integrator, Run, Session, Setting, Suite};
use crate::verify::harness::{Case, group};

/// The cases of this module.
pub(super) const CASES: &[Case] = &[
    Case {
        id: "plane_detonation",
        title: "Plane detonation",
        group: group::EXPLOSIONS,
        quick: true,
        source: "Exact: Chapman-Jouguet state and the wave behind it, G. I. Taylor, Proc. R. Soc. A 200 (1950) 235.",
        run: plane,
    },
    Case {
        id: "detonated_slab",
        title: "TNT on the grid, in a tube of air",
        group: group::EXPLOSIONS,
        quick: true,
        source: "Lagrangian run in one dimension, after M. L. Wilkins, UCRL-7322, 1963.",
        run: slab,
    },
    Case {
        id: "copper_cylinder",
        title: "Cylinder test",
        group: group::EXPLOSIONS,
        quick: true,
        source: "B. M. Dobratz, P. C. Crawford, LLNL Explosives Handbook, UCRL-52997, 1985: wall velocity with TNT.",
        run: cylinder,
    },
];

/// The scene of the first two.
const BLOCK: &str = "validation/plane_detonation.toml";
/// Cells behind the front where the products are compared: it is three cells wide.
const BEHIND: f64 = 10.0;

fn setting(integrator: Integrator, cells: u32) -> Setting {
    Setting { pair: Pair::B1b0, integrator, cells }
}

fn plane(session: &mut Session<'_>) -> Result<()> {
    let fine = if session.suite == Suite::Full { Some((Integrator::Predictor, 800)) } else { None };
    let runs = [(Integrator::Predictor, 400), (Integrator::Ars222, 400)].into_iter().chain(fine);
    for (integrator, cells) in runs {
        let run = session.run(BLOCK, setting(integrator, cells), &[] as &[String])?;
        let Some(tnt) = explosive("tnt") else { continue };
        let wave = TaylorWave::of(tnt);
        let row = Profile::of(&run.scene, &run.snapshot);
        let time = run.scene.time.until;
        // in the order of TaylorWave::at
        for (k, (name, field)) in
            [("velocity", VELOCITY), ("pressure", PRESSURE), ("density", DENSITY)].into_iter().enumerate()
        {
            let front = wave.speed * time - BEHIND * row.spacing;
            let cells = (0..row.cells()).take_while(|cell| row.center(*cell) < front);
            let off = |cell: usize| (row.state[field][cell] - wave.at(row.center(cell) / time)[k]).abs();
            let most = cells.map(off).fold(0.0, f64::max) / wave.at(wave.speed)[k];
            let row =
                session.check(&run, &format!("{name} behind the front, largest error over that at the front"), most);
            row.reference(0.0, "exact").pass(Limit::AtMost(if k == 0 { 0.03 } else { 0.02 }));
        }
        let level = 0.5 * tnt.detonation_pressure;
        let place = row.crossings(PRESSURE, level).next_back().unwrap_or(f64::NAN);
        let row = session.check(&run, "speed of the detonation", place / time);
        row.reference(wave.speed, "Chapman and Jouguet").within(0.01);
        books(session, &run);
    }
    Ok(())
}

/// Energy, with what the explosive holds.
fn books(session: &mut Session<'_>, run: &Run) {
    let energy = |record: Option<&StepRecord>| record.map_or(f64::NAN, |record| record.gas.energy.into());
    let drift = energy(run.records.last()) / energy(run.records.first()) - 1.0;
    let row = session.check(run, "drift of the energy", drift.abs());
    row.source("conservation law").pass(Limit::AtMost(1e-6));
}

/// Length of the tube, of the charge \[m\], and when they are looked at \[s\].
const TUBE: [f64; 3] = [1.0, 0.1, 4e-5];

fn slab(session: &mut Session<'_>) -> Result<()> {
    let [length, charge, until] = TUBE;
    let changes = [
        format!("domain.size=[{length:?}]"),
        format!("charges[0].shape.half_space.point=[{charge:?}]"),
        format!("time.until={until:?}"),
    ];
    let Some(expected) = lagrangian(charge, until) else { return Ok(()) };
    let cells: &[u32] = if session.suite == Suite::Full { &[400, 800] } else { &[400] };
    for &cells in cells {
        let run = session.run(BLOCK, setting(Integrator::Predictor, cells), &changes[..])?;
        let row = Profile::of(&run.scene, &run.snapshot);
        let phi: Vec<f64> = run.snapshot.species.iter().map(|own| own[1].into()).collect();
        let crosses = |k: usize| (phi[k] < 0.5) != (phi[k + 1] < 0.5);
        let contact =
            (0..row.cells() - 1).rfind(|k| crosses(*k)).map_or(f64::NAN, |k| row.center(k) + 0.5 * row.spacing);
        let shock = row.crossings(PRESSURE, 1e7).next_back().unwrap_or(f64::NAN);
        let coarse = 400.0 / f64::from(cells);
        for (name, ours, exact, gate) in
            [("contact", contact, expected.contact(), 0.08), ("shock", shock, expected.front(), 0.12)]
        {
            let row = session.check(&run, &format!("place of the {name} [m]"), ours);
            row.reference(exact, "Lagrangian").within(gate * coarse);
        }
        let count = (expected.front() / row.spacing) as usize;
        let shells = expected.profile(count as f64 * row.spacing, count).shells;
        let off = shells.iter().enumerate().map(|(k, shell)| (row.state[DENSITY][k] - shell[0]).abs()).sum::<f64>();
        let all = shells.iter().map(|shell| shell[0]).sum::<f64>();
        let row = session.check(&run, "L1 error of the density over its mean", off / all);
        row.reference(0.0, "Lagrangian").pass(Limit::AtMost(0.04 * coarse));
        books(session, &run);
    }
    Ok(())
}

/// The same slab, half of one that burns from its middle, by zones that move with the material.
fn lagrangian(charge: f64, until: f64) -> Option<Expansion> {
    let tnt = explosive("tnt")?;
    let mass = 2.0 * charge * tnt.density;
    let field = NearField { explosive: tnt, mass, axes: 1, density: 1.2, pressure: 1e5, gamma: 1.4, afterburn: false };
    let mut expansion = field.start(1.0, 1e-3);
    while expansion.time < until {
        expansion.step(until);
    }
    Some(expansion)
}

/// How far the outer side of the copper has come where its velocity is compared \[m\], and the velocity there \[m s^-1\].
const WALL: [f64; 2] = [0.019, 1400.0];
/// Radius of that side at the start \[m\].
const OUTSIDE: f64 = 0.0153;

fn cylinder(session: &mut Session<'_>) -> Result<()> {
    let full = session.suite == Suite::Full;
    let [cells, gate] = if full { [192.0, 0.03] } else { [96.0, 0.06] };
    let times = [1.8e-5, 1.9e-5, 2.0e-5, 2.1e-5, 2.2e-5];
    let journey = session.follow(
        "validation/copper_cylinder.toml",
        setting(Integrator::Predictor, cells as u32),
        &[] as &[String],
        times,
    )?;
    let walls: Vec<[f64; 2]> = journey.stops[1..].iter().map(wall).collect();
    let passes = |pair: &&[[f64; 2]]| pair[0][0] < WALL[0] && pair[1][0] >= WALL[0];
    let speed = walls.windows(2).find(passes).map_or(f64::NAN, |pair| {
        let share = (WALL[0] - pair[0][0]) / (pair[1][0] - pair[0][0]);
        pair[0][1] + share * (pair[1][1] - pair[0][1])
    });
    let row = session.check(&journey.run, "velocity of the wall at 19 mm [m/s]", speed);
    row.reference(WALL[1], "LLNL").within(gate);
    Ok(())
}

/// How far the outer side has come, and the mean velocity of the tube away from its middle.
fn wall(snapshot: &Snapshot) -> [f64; 2] {
    let middle = 0.5 * f64::from(snapshot.grid.spacing) * f64::from(snapshot.grid.cells[0]);
    let (mut outside, mut momentum, mut mass) = (0.0, 0.0, 0.0);
    for particle in &snapshot.particles {
        let arm: [f64; 2] = std::array::from_fn(|d| f64::from(particle.position[d]) - middle);
        let radius = (arm[0] * arm[0] + arm[1] * arm[1]).sqrt();
        let outward = (0..2).map(|d| arm[d] * f64::from(particle.velocity[d])).sum::<f64>() / radius;
        outside = f64::max(outside, radius);
        momentum += f64::from(particle.mass) * outward;
        mass += f64::from(particle.mass);
    }
    [outside - OUTSIDE, momentum / mass]
}
