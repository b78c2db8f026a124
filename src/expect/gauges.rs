//! What a gauge has recorded: arrival, peak, positive phase and impulse of the pressure, as blast engineers define them.

use serde::{Deserialize, Serialize};

use super::probes::FRONT;

/// Part of the first pressure that a wave must add to be one.
const WEAKEST: f64 = 0.02;
/// A wave too weak for [`FRONT`] arrives with this part of its peak.
const FOOT: f64 = 0.2;

/// Overpressure over time, from the pressure after the first step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Gauge {
    /// Pressure after the first step \[Pa\].
    pub first: f64,
    /// Largest pressure \[Pa\].
    pub peak: f64,
    /// When that was \[s\].
    pub peak_time: f64,
    /// Largest pressure less the first \[Pa\].
    pub peak_overpressure: f64,
    /// When the pressure was first a twentieth above the first, or a fifth of a weak peak \[s\].
    pub arrival: Option<f64>,
    /// From arrival until the first pressure comes back after the peak \[s\]; none where it has not come back.
    pub positive_phase: Option<f64>,
    /// Overpressure over the positive phase, or over what there is of it \[Pa s\].
    pub impulse: f64,
}

impl Gauge {
    /// Of pressures \[Pa\] at rising times \[s\]; entries that are no numbers are left out. None without a number.
    pub fn of(times: &[f64], pressures: &[f64]) -> Option<Self> {
        let finite = |(t, p): &(f64, f64)| t.is_finite() && p.is_finite();
        let all: Vec<(f64, f64)> = times.iter().copied().zip(pressures.iter().copied()).filter(finite).collect();
        let first = all.first()?.1;
        let (top, (peak_time, peak)) = all.iter().copied().enumerate().max_by(|a, b| a.1.1.total_cmp(&b.1.1))?;
        let mut gauge = Self { first, peak, peak_time, peak_overpressure: peak - first, ..Self::default() };
        if gauge.peak_overpressure < WEAKEST * first.abs() {
            return Some(gauge);
        }
        let front = (FRONT * first.abs()).min(FOOT * gauge.peak_overpressure);
        let Some(start) = all.iter().position(|(_, p)| p - first > front) else { return Some(gauge) };
        gauge.arrival = Some(all[start].0);
        let mut over: Vec<(f64, f64)> = all[start..].iter().map(|(t, p)| (*t, p - first)).collect();
        let end = over.iter().enumerate().position(|(k, (_, p))| k + start > top && *p <= 0.0);
        if let Some(end) = end {
            let ((t0, p0), (t1, p1)) = (over[end - 1], over[end]);
            let back = t0 + (t1 - t0) * p0 / (p0 - p1);
            over.truncate(end);
            over.push((back, 0.0));
            gauge.positive_phase = Some(back - all[start].0);
        }
        gauge.impulse = over.windows(2).map(|pair| 0.5 * (pair[0].1 + pair[1].1) * (pair[1].0 - pair[0].0)).sum();
        Some(gauge)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The wave of Friedlander: `p0 + a (1 - t/d) exp(-t/d)` from `t = 1` on. [Friedlander 1946]
    #[test]
    fn a_blast_wave_is_measured() {
        let (p0, a, d) = (2.0, 3.0, 0.5);
        let times: Vec<f64> = (0..40_000).map(|k| k as f64 * 1e-4).collect();
        let wave = |t: f64| if t < 1.0 { p0 } else { p0 + a * (1.0 - (t - 1.0) / d) * (-(t - 1.0) / d).exp() };
        let pressures: Vec<f64> = times.iter().map(|t| wave(*t)).collect();
        let gauge = Gauge::of(&times, &pressures).unwrap();
        assert_eq!((gauge.first, gauge.peak, gauge.peak_overpressure), (p0, p0 + a, a));
        assert!((gauge.arrival.unwrap() - 1.0).abs() < 2e-4 && (gauge.peak_time - 1.0).abs() < 2e-4);
        assert!((gauge.positive_phase.unwrap() - d).abs() < 1e-3, "{gauge:?}");
        assert!((gauge.impulse / (a * d / std::f64::consts::E) - 1.0).abs() < 1e-3, "{gauge:?}");
    }

    #[test]
    fn what_does_not_come_is_not_measured() {
        let times = [0.1, 0.2, 0.3, 0.4];
        let still = Gauge::of(&times, &[1.0, 1.01, f64::NAN, 1.0]).unwrap();
        assert_eq!((still.arrival, still.positive_phase, still.impulse), (None, None, 0.0));
        let weak = Gauge::of(&times, &[1.0, 1.03, 1.02, 0.99]).unwrap();
        assert!(weak.arrival == Some(times[1]) && weak.impulse > 0.0, "{weak:?}");
        let rising = Gauge::of(&times, &[1.0, 1.0, 2.0, 3.0]).unwrap();
        assert_eq!((rising.arrival, rising.positive_phase), (Some(0.3), None));
        assert!((rising.impulse - 0.15).abs() < 1e-12, "{rising:?}");
        assert_eq!(Gauge::of(&times, &[f64::NAN; 4]), None);
    }
}
