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
        let mut recording = Recording::default();
        times.iter().zip(pressures).for_each(|(time, pressure)| recording.add(*time, *pressure));
        recording.gauge()
    }
}

/// The pressure at a place, step by step.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    first: f64,
    peak: f64,
    /// Times \[s\], overpressures \[Pa\], and their integrals up to there \[Pa s\].
    samples: Vec<[f64; 3]>,
    /// Sample of the peak.
    top: usize,
    /// Sample in which the wave arrives, once there is one; else that which comes next.
    start: usize,
    /// Sample behind the peak in which the first pressure has come back.
    end: Option<usize>,
}

impl Recording {
    /// Adds a pressure \[Pa\] at a time \[s\], unless one of them is no number.
    pub fn add(&mut self, time: f64, pressure: f64) {
        if !(time.is_finite() && pressure.is_finite()) {
            return;
        }
        let k = self.samples.len();
        if k == 0 {
            (self.first, self.peak) = (pressure, pressure);
        }
        let over = pressure - self.first;
        let sum = self.samples.last().map_or(0.0, |[t, p, sum]| sum + 0.5 * (p + over) * (time - t));
        self.samples.push([time, over, sum]);
        if pressure >= self.peak {
            (self.peak, self.top, self.end) = (pressure, k, None);
        } else if self.end.is_none() && over <= 0.0 {
            self.end = Some(k);
        }
        if self.rises() {
            let front = (FRONT * self.first.abs()).min(FOOT * (self.peak - self.first));
            let weak = self.samples[self.start..].iter().take_while(|[_, over, _]| *over <= front).count();
            self.start += weak;
        }
    }

    /// Whether there is a wave at all.
    fn rises(&self) -> bool {
        self.peak - self.first >= WEAKEST * self.first.abs()
    }

    /// Pressure above the first, at the last sample \[Pa\].
    #[must_use]
    pub fn overpressure(&self) -> Option<f64> {
        Some(self.samples.last()?[1])
    }

    /// What there is so far; none without a sample.
    #[must_use]
    pub fn gauge(&self) -> Option<Gauge> {
        let Self { first, peak, samples, top, start, end } = self;
        let [last, _, whole] = *samples.last()?;
        let peak_overpressure = peak - first;
        let gauge =
            Gauge { first: *first, peak: *peak, peak_time: samples[*top][0], peak_overpressure, ..Gauge::default() };
        let Some([arrival, _, before]) = samples.get(*start).copied().filter(|_| self.rises()) else {
            return Some(gauge);
        };
        let (back, until) = match *end {
            None => (last, whole),
            Some(end) => {
                let ([t0, p0, sum], [t1, p1, _]) = (samples[end - 1], samples[end]);
                let back = t0 + (t1 - t0) * p0 / (p0 - p1);
                (back, sum + 0.5 * p0 * (back - t0))
            }
        };
        let positive_phase = end.map(|_| back - arrival);
        Some(Gauge { arrival: Some(arrival), positive_phase, impulse: until - before, ..gauge })
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
        // a second wave that is higher moves the peak, and the phase ends behind it
        let twice = Gauge::of(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0], &[1.0, 3.0, 0.0, 5.0, 3.0, -1.0]).unwrap();
        assert_eq!((twice.arrival, twice.peak_time, twice.positive_phase), (Some(1.0), 3.0, Some(3.5)));
        assert!((twice.impulse - 5.5).abs() < 1e-12, "{twice:?}");
    }
}
