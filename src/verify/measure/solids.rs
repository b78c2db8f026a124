//! What cases with bodies measure: means, fronts and energy of particles.

use crate::diagnostics::StepRecord;
use crate::snapshot::Snapshot;

/// Mean velocity along x of the particles between two x \[m/s\].
pub(in crate::verify) fn mean_velocity(stop: &Snapshot, [low, high]: [f64; 2]) -> f64 {
    let inside = stop.particles.iter().filter(|p| (low..=high).contains(&f64::from(p.position[0])));
    let (sum, count) = inside.fold((0.0, 0.0), |(sum, count), p| (sum + f64::from(p.velocity[0]), count + 1.0));
    sum / count
}

/// Last place along x where the velocity of the particles falls below a level \[m\].
pub(in crate::verify) fn front(stop: &Snapshot, level: f64) -> f64 {
    let mut points: Vec<[f64; 2]> =
        stop.particles.iter().map(|p| [p.position[0].into(), p.velocity[0].into()]).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let crossing = points.windows(2).rfind(|pair| pair[0][1] >= level && pair[1][1] < level);
    crossing.map_or(f64::NAN, |pair| {
        let share = (pair[0][1] - level) / (pair[0][1] - pair[1][1]);
        pair[0][0] + share * (pair[1][0] - pair[0][0])
    })
}

/// Kinetic and elastic energy of the solids \[J\].
pub(in crate::verify) fn mechanical(record: &StepRecord) -> f64 {
    f64::from(record.solid.energy) + f64::from(record.elastic_energy)
}
