//! Bodies that break by stress: strength, energy and way of a crack, and how many pieces there are.

use crate::Result;
use crate::render::{Plot, Style};
use crate::snapshot::{ParticleSample, Snapshot};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Session, Setting, Suite};
use crate::verify::harness::{Case, group};
use crate::verify::measure::plane::fitted_line;

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("spall", "Spall of a struck plate", group::SOLIDS, spall,
        "Exact for elastic waves; T. Antoun et al., Spall Fracture, 2003, chapter 2."),
    Case::quick("notched_plate", "Crack from a notch, aslant to the grid", group::SOLIDS, notched_plate,
        "Exact: by symmetry the crack runs along the line of the notch."),
    Case::quick("brazilian_disc", "Disc split between platens", group::SOLIDS, brazilian_disc,
        "Elasticity: G. Hondros, Aust. J. Appl. Sci. 10 (1959) 243; ASTM D3967."),
    Case::full("breaking_ring", "Ring that grows until it breaks", group::SOLIDS, breaking_ring,
        "Sizes of fragments: D. E. Grady, J. Appl. Phys. 53 (1982) 322; F. Zhou, J.-F. Molinari, K. T. Ramesh, Int. J. Fracture 139 (2006) 169."),
    Case::full("kalthoff_winkler", "Crack in a plate that is struck beside a notch", group::SOLIDS, kalthoff_winkler,
        "J. F. Kalthoff, S. Winkler, in Impact Loading and Dynamic Behaviour of Materials, 1988; T. Belytschko et al., \
         Int. J. Numer. Meth. Eng. 58 (2003) 1873."),
];

/// Tensile strength of the scenes without units, whose Young's modulus, density and Poisson's ratio are 1, 1 and 0.2.
const STRENGTH: f64 = 1e-3;

/// Why the direction of a crack aslant to the grid is off.
const ASLANT: &str = "the band is some three cells wide, and a degree moves its end by half a cell";

/// Why the cracks of a ring take more.
const HALF_WAY: &str = "places that the wave from a crack relieves before they are broken have taken energy, too";

/// Particles of a body.
fn of_body(stop: &Snapshot, body: u32) -> impl Iterator<Item = &ParticleSample> {
    stop.particles.iter().filter(move |particle| particle.body == body)
}

fn is_broken(particle: &ParticleSample) -> bool {
    particle.damage >= 1.0
}

fn spall(session: &mut Session<'_>) -> Result<()> {
    /// rho c of the plates.
    const IMPEDANCE: f64 = 1.054_09;
    let all: &[u32] = if session.suite == Suite::Quick { &[600] } else { &[600, 1200] };
    for &cells in all {
        let times = (0..90).map(|k| 1.36 + 0.01 * f64::from(k));
        let journey = session.follow("validation/spall.toml", Setting::standard(cells), &[], times)?;
        let run = &journey.run;
        let at_face = |stop: &Snapshot| {
            let last = of_body(stop, 1).max_by(|a, b| a.position[0].total_cmp(&b.position[0]));
            last.map_or(f64::NAN, |particle| f64::from(particle.velocity[0]))
        };
        let face: Vec<[f64; 2]> = journey.stops[1..].iter().map(|stop| [stop.time, at_face(stop)]).collect();
        let highest = face[0][1];
        let lowest = face.iter().map(|point| point[1]).fold(f64::INFINITY, f64::min);
        let pull_back = 0.5 * IMPEDANCE * (highest - lowest) / STRENGTH;
        let row = session.check(run, "strength by the pull-back of the face, over the strength", pull_back);
        row.reference(1.0, "exact").within(0.05);
        let mut order: Vec<&ParticleSample> = of_body(&run.snapshot, 1).collect();
        order.sort_by(|a, b| a.position[0].total_cmp(&b.position[0]));
        let broken: Vec<f64> =
            (0..).zip(&order).filter(|(_, own)| is_broken(own)).map(|(place, _)| f64::from(place)).collect();
        let middle = broken.iter().sum::<f64>() / broken.len() as f64 + 0.5;
        let depth = 1.0 - middle / order.len() as f64;
        let row = session.check(run, "split below the free face", depth).reference(0.5, "exact");
        row.pass(Limit::Between(0.495, 0.505));
        if cells == 600 {
            let plot = Plot::new("Spall: velocity of the free face", "time", "velocity");
            session.plot(plot.with(run.label.clone(), Style::Line, face));
        }
    }
    Ok(())
}

/// Keys that turn the notched plate with its grips against the grid.
fn turned(degrees: f64) -> Vec<String> {
    /// Speed of each grip.
    const PULL: f64 = 5.333e-5;
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let mut keys: Vec<String> = (0..5).map(|body| format!("bodies[{body}].shape.rotate.degrees={degrees:?}")).collect();
    keys.push(format!("bodies[0].cracks[0].rotate.degrees={degrees:?}"));
    for (body, sign) in [(3, 1.0), (4, -1.0)] {
        let velocity = [sign * PULL * sine, -sign * PULL * cosine];
        keys.push(format!("bodies[{body}].motion.velocity={velocity:?}"));
    }
    keys
}

fn notched_plate(session: &mut Session<'_>) -> Result<()> {
    let (cells, angles): (u32, &[f64]) =
        if session.suite == Suite::Quick { (48, &[30.0]) } else { (80, &[0.0, 15.0, 30.0, 45.0]) };
    for &degrees in angles {
        let mut run = session.run("validation/notched_plate.toml", Setting::standard(cells), &turned(degrees)[..])?;
        run.label = format!("{} {degrees} degrees", run.label);
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let along = |particle: &ParticleSample| {
            let [x, y] = [0, 1].map(|axis| f64::from(particle.position[axis]) - 1.0);
            [cosine * x + sine * y, cosine * y - sine * x]
        };
        let crack: Vec<[f64; 2]> = of_body(&run.snapshot, 0).filter(|own| is_broken(own)).map(along).collect();
        let beyond: Vec<[f64; 2]> = crack.iter().copied().filter(|[x, _]| *x > -0.2).collect();
        let [slope, _] = fitted_line(&beyond);
        let row = session.check(&run, "crack off the line of the notch [degrees]", slope.atan().to_degrees());
        row.reference(0.0, "symmetry").pass(Limit::Between(-2.0, 2.0)).known(Limit::Between(-3.0, 3.0), ASLANT);
        let end: Vec<f64> = crack.iter().filter(|[x, _]| *x > 0.4).map(|[_, y]| *y).collect();
        let off = end.iter().sum::<f64>() / end.len() as f64 / run.scene.domain.spacing();
        let row = session.check(&run, "its end off that line, cells", off);
        row.reference(0.0, "symmetry").pass(Limit::Between(-2.0, 2.0));
        let widest = crack.iter().map(|[_, y]| y.abs()).fold(0.0, f64::max) / run.scene.domain.spacing();
        let row = session.check(&run, "broken farthest from that line, cells", widest);
        row.source("method").pass(Limit::AtMost(3.5));
    }
    Ok(())
}

/// Load on a disc from the stress along the line between the platens, in the two rows of particles beside the middle.
fn load(stop: &Snapshot, spacing: f64) -> f64 {
    let beside = of_body(stop, 2).filter(|own| (f64::from(own.position[1]) - 0.7).abs() < spacing);
    let sum: f64 = beside.map(|own| f64::from(own.stress[1]) * f64::from(own.volume0 * own.volume_ratio())).sum();
    -sum / (2.0 * spacing)
}

fn brazilian_disc(session: &mut Session<'_>) -> Result<()> {
    let all: &[u32] = if session.suite == Suite::Quick { &[34] } else { &[34, 56] };
    for &cells in all {
        let times = (0..25).map(|k| 14.0 + f64::from(k));
        let journey = session.follow("validation/brazilian_disc.toml", Setting::standard(cells), &[], times)?;
        let run = &journey.run;
        let spacing = run.scene.domain.spacing();
        let tension = |stop: &Snapshot| 2.0 * load(stop, spacing) / std::f64::consts::PI / STRENGTH;
        let curve: Vec<[f64; 2]> = journey.stops[1..].iter().map(|stop| [stop.time, tension(stop)]).collect();
        let (split, most) =
            curve.iter().enumerate().max_by(|a, b| a.1[1].total_cmp(&b.1[1])).map_or((0, f64::NAN), |(k, p)| (k, p[1]));
        let row = session.check(run, "largest 2 P / (pi D), over the strength", most);
        row.reference(1.0, "Hondros 1959").within(0.1);
        // the first state after it in which half of the load is gone
        let after =
            curve.iter().skip(split).position(|point| point[1] < 0.5 * most).map(|k| &journey.stops[split + k + 1]);
        let inside = |own: &&ParticleSample| is_broken(own) && (f64::from(own.position[1]) - 0.7).abs() < 0.25;
        let off: Vec<f64> = after
            .into_iter()
            .flat_map(|stop| {
                of_body(stop, 2).filter(inside).map(|own| f64::from(own.position[0]) - 0.7).collect::<Vec<f64>>()
            })
            .collect();
        let widest = off.iter().map(|x| x.abs()).fold(if off.is_empty() { f64::NAN } else { 0.0 }, f64::max) / spacing;
        let row =
            session.check(run, "split within half of the diameter: farthest from the line of the load, cells", widest);
        row.source("method").pass(Limit::AtMost(4.0));
        let plot = Plot::new("Brazilian disc: 2 P / (pi D) over the strength", "time", "load");
        session.plot(plot.with(run.label.clone(), Style::Line, curve));
    }
    Ok(())
}

/// Arcs between broken places all around a ring: runs of sectors of half a degree that hold a whole particle.
fn arcs(stop: &Snapshot) -> usize {
    const SECTORS: usize = 720;
    let mut whole = vec![false; SECTORS];
    let mut any = vec![false; SECTORS];
    for own in of_body(stop, 0) {
        let angle = (f64::from(own.position[1]) - 1.4).atan2(f64::from(own.position[0]) - 1.4);
        let sector = ((angle / std::f64::consts::TAU).rem_euclid(1.0) * SECTORS as f64) as usize % SECTORS;
        any[sector] = true;
        whole[sector] |= !is_broken(own);
    }
    let cut: Vec<bool> = whole.iter().zip(&any).filter(|(_, any)| **any).map(|(whole, _)| !whole).collect();
    (0..cut.len()).filter(|&k| cut[k] && !cut[(k + 1) % cut.len()]).count()
}

fn breaking_ring(session: &mut Session<'_>) -> Result<()> {
    const WALL: f64 = 0.08;
    const ENERGY: f64 = 3e-7;
    for (cells, seed) in [(140, 0), (140, 1), (210, 0), (210, 1)] {
        let key = [format!("materials.brittle.fracture.weibull.seed={seed}")];
        let mut run = session.run("validation/breaking_ring.toml", Setting::standard(cells), &key[..])?;
        run.label = format!("{} seed {seed}", run.label);
        let count = arcs(&run.snapshot);
        let row = session.check(&run, "arcs", count as f64);
        row.reference(5.0, "solver in double precision: 4 to 6").pass(Limit::Between(4.0, 6.0));
        let energy = run.records.last().map_or(f64::NAN, |record| f64::from(record.fracture_energy));
        let row = session.check(
            &run,
            "energy of the cracks, over that of as many cuts through the wall",
            energy / (ENERGY * WALL * count as f64),
        );
        row.source("solver in double precision: 0.98 to 1.25");
        row.pass(Limit::Between(0.85, 1.35)).known(Limit::Between(0.85, 1.45), HALF_WAY);
    }
    Ok(())
}

fn kalthoff_winkler(session: &mut Session<'_>) -> Result<()> {
    /// End of the notch \[m\].
    const NOTCH: [f64; 2] = [0.154, 0.0265];
    let run = session.run("validation/kalthoff_winkler.toml", Setting::standard(0), &[])?;
    let crack: Vec<[f64; 2]> = of_body(&run.snapshot, 2)
        .filter(|own| is_broken(own))
        .map(|own| [0, 1].map(|axis| f64::from(own.position[axis]) - NOTCH[axis]))
        .filter(|[_, y]| *y > 1e-3)
        .collect();
    let first: Vec<[f64; 2]> = crack.iter().filter(|[_, y]| *y < 0.03).map(|[x, y]| [*y, *x]).collect();
    let [slope, _] = fitted_line(&first);
    let angle = 90.0 - slope.atan().to_degrees();
    let row = session.check(&run, "angle of the first 30 mm of the crack [degrees]", angle);
    row.reference(70.0, "experiment; 60 to 70 computed").pass(Limit::Between(60.0, 70.0));
    let length = crack.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
    let row = session.check(&run, "length of the crack at the end [mm]", 1e3 * length);
    row.source("slower than Rayleigh's waves, which run 60 mm once the notch is loaded")
        .pass(Limit::Between(30.0, 60.0));
    Ok(())
}
