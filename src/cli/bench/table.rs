//! Tables of `bench`.

use super::super::check::size;
use super::{Measurement, StageRow};

/// One measurement; beside an earlier one the last column is the time over that of then.
pub(super) fn print(m: &Measurement, before: Option<&Measurement>) {
    say!("{} on {}: {} cells, {} particles", m.scene, m.device, m.cells, m.particles);
    say!("a kernel that only copies moves {:.2} GB/s", m.copy_gigabytes_per_second);
    if let Some(before) = before.filter(|b| !comparable(m, b)) {
        say!(
            "compared with another measurement: {} on {}, {} cells, {} particles",
            before.scene,
            before.device,
            before.cells,
            before.particles
        );
    }
    print_stages(m, before);
    print_totals(m, before);
}

fn comparable(m: &Measurement, before: &Measurement) -> bool {
    (&m.scene, &m.device, m.cells, m.particles) == (&before.scene, &before.device, before.cells, before.particles)
}

/// Now over then, as a factor.
fn ratio(now: f64, before: Option<f64>) -> String {
    before.map(|before| format!(" {:8.3}", now / before)).unwrap_or_default()
}

fn print_stages(m: &Measurement, before: Option<&Measurement>) {
    let width = m.stages.iter().map(|row| row.stage.len()).max().unwrap_or(0).max(24);
    let compared = if before.is_some() { "     now/before" } else { "" };
    say!(
        "\n{:width$} {:>10} {:>8} {:>12} {:>8} {:>8}{compared}",
        "stage",
        "ms/step",
        "share",
        "MB/step",
        "GB/s",
        "of copy"
    );
    for row in &m.stages {
        let (share, megabytes) = (100.0 * row.share, row.bytes / 1e6);
        let (speed, of_copy) = (row.gigabytes_per_second, 100.0 * row.share_of_copy);
        // Bytes are counted per stage, not per kernel.
        let counted = row.bytes > 0.0;
        let moved = if counted { format!("{megabytes:12.3} {speed:8.2} {of_copy:6.1} %") } else { " ".repeat(30) };
        let then =
            |b: &Measurement| b.stages.iter().find(|old| old.stage == row.stage).map(|old: &StageRow| old.milliseconds);
        let compared = ratio(row.milliseconds, before.and_then(then));
        say!("{:width$} {:10.4} {share:6.1} % {moved}{compared}", row.stage, row.milliseconds);
    }
}

fn print_totals(m: &Measurement, before: Option<&Measurement>) {
    let of = |pick: fn(&Measurement) -> f64| ratio(pick(m), before.map(pick));
    say!("\n{:24} {:>14}", "steps", m.steps);
    say!("{:24} {:>14.4}{}", "milliseconds per step", m.milliseconds_per_step, of(|m| m.milliseconds_per_step));
    say!("{:24} {:>14.4e}{}", "cells/s", m.cells_per_second, of(|m| m.cells_per_second));
    say!("{:24} {:>14.4e}", "particles/s", m.particles_per_second);
    say!("{:24} {:>14.4e}", "particle sub-steps/s", m.particle_substeps_per_second);
    say!("{:24} {:>14.2}{}", "PCG iterations per step", m.pcg_iterations_per_step, of(|m| m.pcg_iterations_per_step));
    say!("{:24} {:>14.2}", "sub-steps per step", m.substeps_per_step);
    say!("{:24} {:>14}", "bytes allocated", size(m.bytes_allocated));
    say!("{:24} {:>14.1}{}", "planned bytes per cell", m.bytes_per_cell_planned, of(|m| m.bytes_per_cell_planned));
    say!("{:24} {:>14.1}", "... per particle", m.bytes_per_particle_planned);
    say!("{:24} {:>14.1e}", "gas lost or gained", m.mass_drift);
    say!("{:24} {:>14.1e}", "energy lost or gained", m.energy_drift);
}

/// One line per size: where the time per cell stops falling, launches no longer count.
pub(super) fn print_sizes(sizes: &[Measurement]) {
    let Some(first) = sizes.first() else { return };
    say!(
        "{} on {}; a kernel that only copies moves {:.2} GB/s\n",
        first.scene,
        first.device,
        first.copy_gigabytes_per_second
    );
    say!(
        "{:>10} {:>10} {:>10} {:>10} {:>10} {:>8} {:>12} {:>8}",
        "cells",
        "particles",
        "ms/step",
        "ns/cell",
        "cells/s",
        "PCG",
        "memory",
        "of copy"
    );
    for m in sizes {
        let nanoseconds = 1e6 * m.milliseconds_per_step / m.cells as f64;
        let (bytes, milliseconds): (f64, f64) =
            m.stages.iter().fold((0.0, 0.0), |(b, t), row| (b + row.bytes, t + row.milliseconds));
        let of_copy = 100.0 * bytes / (1e6 * milliseconds * m.copy_gigabytes_per_second);
        say!(
            "{:>10} {:>10} {:>10.3} {nanoseconds:>10.2} {:>10.3e} {:>8.2} {:>12} {of_copy:>6.1} %",
            m.cells,
            m.particles,
            m.milliseconds_per_step,
            m.cells_per_second,
            m.pcg_iterations_per_step,
            size(m.bytes_allocated)
        );
    }
}
