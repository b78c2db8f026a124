//! Tests that Athena++ and AthenaK demand of themselves: Sod's tube to a later time, and waves once through a periodic box.

use std::f64::consts::TAU;

use crate::Result;
use crate::render::{Plot, Style};
use crate::scene::{Changes, Pair};
use crate::verify::exact::profile::{DENSITY, PRESSURE, Profile, VELOCITY};
use crate::verify::harness::row::Limit;
use crate::verify::harness::session::{Integrator, Run, Session, Setting};
use crate::verify::harness::{Case, group};
use crate::verify::measure::sweep::exact_riemann;

/// The cases of this module.
#[rustfmt::skip]
pub(super) const CASES: &[Case] = &[
    Case::quick("sod_athena", "Sod shock tube as Athena++ runs it", group::TUBES, sod,
        "Athena++, sod_shock.py: until t = 0.25, 128 and 256 cells; AthenaK, test_nr_sod_cpu.py; exact Riemann solution."),
    Case::quick("linear_wave", "Linear wave", group::WAVES, linear_wave,
        "Linear wave test of Athena++, hydro_linwave.py, and AthenaK, test_nr_lwave1d_cpu.py; exact simple wave and entropy wave."),
];

/// Points per cell over which exact states are averaged.
const SAMPLES: u32 = 16;
/// Density, velocity and pressure.
type Primitive = (f64, f64, f64);

/// Mean errors of density, momentum and energy per cell. The exact state at a point is averaged over each cell.
fn conserved_errors(run: &Run, exact: impl Fn(f64) -> Primitive) -> [f64; 3] {
    let ours = Profile::of(&run.scene, &run.snapshot);
    let gamma = run.scene.gas.gamma;
    let conserved = |(density, velocity, pressure): Primitive| {
        [density, density * velocity, pressure / (gamma - 1.0) + 0.5 * density * velocity * velocity]
    };
    let mut errors = [0.0; 3];
    for cell in 0..ours.cells() {
        let mut mean = [0.0; 3];
        for sample in 0..SAMPLES {
            let share = (f64::from(sample) + 0.5) / f64::from(SAMPLES) - 0.5;
            let state = conserved(exact(ours.center(cell) + share * ours.spacing));
            mean = std::array::from_fn(|k| mean[k] + state[k] / f64::from(SAMPLES));
        }
        let [density, velocity, pressure] = [DENSITY, VELOCITY, PRESSURE].map(|k| ours.state[k][cell]);
        let own = conserved((density, velocity, pressure));
        errors = std::array::from_fn(|k| errors[k] + (own[k] - mean[k]).abs() / ours.cells() as f64);
    }
    errors
}

/// Root of the sum of squares of the mean errors, which Athena++ calls RMS error; those of the other two momenta are zero.
fn rms(errors: [f64; 3]) -> f64 {
    errors.iter().map(|error| error * error).sum::<f64>().sqrt()
}

/// Why one solve per step misses gates.
const ONE_SOLVE: &str = "one solve per step is of first order in time; ars222 is of second order";

fn sod(session: &mut Session<'_>) -> Result<()> {
    for integrator in [Integrator::Predictor, Integrator::Ars222] {
        let one_solve = integrator == Integrator::Predictor;
        let mut measured = Vec::new();
        for cells in [128, 256] {
            let setting = Setting { pair: Pair::default(), integrator, cells };
            let run = session.run("gas/sod.toml", setting, &["time.until=0.25".to_owned()])?;
            let (exact, jump) = exact_riemann(&run)?;
            let errors = conserved_errors(&run, |x| exact.sample((x - jump) / run.snapshot.time));
            let row = session.check(&run, "RMS of the L1 errors", rms(errors)).source("Athena++ demands it");
            if cells == 128 {
                row.pass(Limit::AtMost(0.011));
                if one_solve {
                    row.known(Limit::AtMost(0.021), ONE_SOLVE);
                }
            }
            let row = session.check(&run, "mean density error", errors[0]);
            if cells == 256 {
                row.reference(1.6e-3, "Athena++, PLM and HLLC").pass(Limit::AtMost(1.6e-3));
                if one_solve {
                    row.known(Limit::AtMost(4.1e-3), ONE_SOLVE);
                }
            }
            measured.push((errors[0], rms(errors)));
        }
        let [coarse, fine] = [measured[0], measured[1]];
        for (quantity, ratio, source) in [
            ("RMS of the L1 errors, ratio", fine.1 / coarse.1, "Athena++ demands it"),
            ("mean density error, ratio", fine.0 / coarse.0, "AthenaK demands it"),
        ] {
            let row = session.push(&format!("{quantity} from 128 to 256 cells"), ratio);
            row.source(source).pass(Limit::AtMost(0.6)).setting = format!("b1b0 {}", integrator.name());
        }
    }
    Ok(())
}

/// Amplitude of the velocity of the sound wave and of the density of the entropy wave, see the scene.
const AMPLITUDES: [f64; 2] = [0.04, 0.1];
/// Turns of the iteration for the simple wave, which gains a factor of three per turn.
const TURNS: u32 = 30;

/// Riemann's simple wave to the right with velocity a cos(2 pi x) at the start, for gamma = 5/3. [Whitham, Linear and Nonlinear Waves,
/// 1974, section 6.8]
fn sound_wave(x: f64, time: f64) -> Primitive {
    let velocity = |foot: f64| AMPLITUDES[0] * (TAU * foot).cos();
    let foot = (0..TURNS).fold(x, |foot, _| x - (1.0 + 4.0 / 3.0 * velocity(foot)) * time);
    let stretched = 1.0 + velocity(foot) / 3.0;
    (stretched.powi(3), velocity(foot), 0.6 * stretched.powi(5))
}

/// The density moves with the gas.
fn entropy_wave(x: f64, time: f64) -> Primitive {
    (1.0 + AMPLITUDES[1] * (TAU * (x - time)).cos(), 1.0, 0.6)
}

fn linear_wave(session: &mut Session<'_>) -> Result<()> {
    let mut plot = Plot::new("Linear waves: RMS of the L1 errors over the amplitude", "cells", "error").logarithmic();
    for (wave, amplitude) in ["sound", "entropy"].into_iter().zip(AMPLITUDES) {
        let sound = wave == "sound";
        let changes = if sound { Changes::default() } else { Changes::variant("entropy") };
        let exact = if sound { sound_wave } else { entropy_wave };
        for integrator in [Integrator::Predictor, Integrator::Ars222] {
            let mut points: Vec<[f64; 2]> = Vec::new();
            for cells in [32, 64, 128] {
                let setting = Setting { pair: Pair::default(), integrator, cells };
                let run = session.run("validation/linear_wave.toml", setting, &changes)?;
                let error = rms(conserved_errors(&run, |x| exact(x, run.snapshot.time))) / amplitude;
                let quantity = format!("{wave} wave: RMS of the L1 errors over the amplitude");
                session.check(&run, &quantity, error).source("exact");
                points.push([f64::from(cells), error]);
            }
            for two in points.windows(2) {
                let quantity = format!("{wave} wave: error ratio from {} to {} cells", two[0][0], two[1][0]);
                let row = session.push(&quantity, two[1][1] / two[0][1]).source("Athena++ demands it");
                row.pass(Limit::AtMost(0.33)).setting = format!("b1b0 {}", integrator.name());
                if sound && integrator == Integrator::Predictor {
                    row.known(Limit::AtMost(0.52), ONE_SOLVE);
                }
            }
            plot = plot.with(format!("{wave} wave, {}", integrator.name()), Style::Both, points);
        }
    }
    session.plot(plot);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// The start of the scene is the simple wave but for terms of the fourth order in its amplitude.
    #[test]
    fn the_scene_starts_with_the_simple_wave() {
        let scene = Scene::shipped("validation/linear_wave.toml", &[]).unwrap();
        for x in [0.0, 0.2, 0.7] {
            let (density, velocity, pressure) = sound_wave(x, 0.0);
            let start = scene.gas_at([x, 0.0, 0.0]);
            let off = [start.density - density, start.velocity[0] - velocity, start.pressure - pressure];
            assert!(off.iter().all(|off| off.abs() < 0.05 * AMPLITUDES[0].powi(4)), "{x}: {off:?}");
        }
        // the crest runs faster than the trough
        assert!((sound_wave(1.0 + 4.0 / 3.0 * AMPLITUDES[0], 1.0).1 - AMPLITUDES[0]).abs() < 1e-12);
    }
}
