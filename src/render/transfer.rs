//! Transfer functions: from values to colour, opacity and the light of hot gas.

use glam::{Vec3, Vec4};

use super::colormap::{TABLE_LENGTH, linear_from_srgb};
use crate::scene::{RAMP_KELVIN, brightness, shining};

/// Opacities below this are none at all: the ray march leaps over them.
const FAINTEST: f32 = 1e-4;

/// What the shaders look up.
#[derive(Debug)]
pub(super) struct Tables {
    /// Colour (linear) and opacity: of the field, of the black-body ramp, of the particles.
    pub(super) colors: Vec<Vec4>,
    /// For field and ramp: how many entries before each are not transparent.
    pub(super) visible: Vec<u32>,
}

impl Tables {
    /// From sRGB colours of field and particles, the field's opacity over its colour bar, and the strength of hot gas.
    pub(super) fn new(field: &[Vec3], opacity: impl Fn(f32) -> f32, strength: f64, particles: &[Vec3]) -> Self {
        let fraction = |index: usize| index as f32 / (TABLE_LENGTH - 1) as f32;
        let linear = |color: &Vec3| Vec3::from(color.to_array().map(linear_from_srgb));
        let seen = |opacity: f32| if opacity < FAINTEST { 0.0 } else { opacity };
        let mut colors = Vec::with_capacity(3 * TABLE_LENGTH);
        colors.extend(field.iter().enumerate().map(|(k, color)| linear(color).extend(seen(opacity(fraction(k))))));
        let ramp = (0..TABLE_LENGTH).map(|k| {
            let kelvin = RAMP_KELVIN[0] + f64::from(fraction(k)) * (RAMP_KELVIN[1] - RAMP_KELVIN[0]);
            (black_body(kelvin) * (strength * brightness(kelvin)) as f32).extend(seen(shining(kelvin) as f32))
        });
        colors.extend(ramp);
        colors.extend(particles.iter().map(|color| linear(color).extend(1.0)));
        let visible = colors.chunks_exact(TABLE_LENGTH).take(2).flat_map(running_count).collect();
        Self { colors, visible }
    }
}

/// How many entries before each, and in all, are not transparent.
fn running_count(colors: &[Vec4]) -> Vec<u32> {
    let mut count = 0;
    let steps = colors.iter().map(|color| {
        count += u32::from(color.w > 0.0);
        count
    });
    std::iter::once(0).chain(steps).collect()
}

/// Opacity of a curve of points at a fraction; constant beyond its ends.
pub(super) fn curve(points: &[[f64; 2]], fraction: f32) -> f32 {
    let at = f64::from(fraction);
    let next = points.partition_point(|point| point[0] < at);
    let (Some(high), Some(low)) = (points.get(next).or(points.last()), points.get(next.saturating_sub(1))) else {
        return 0.0;
    };
    let width = high[0] - low[0];
    let part = if width > 0.0 { ((at - low[0]) / width).clamp(0.0, 1.0) } else { 1.0 };
    (low[1] + part * (high[1] - low[1])) as f32
}

/// The usual opacity: what differs most from `neutral`, the fraction of the ambient gas, is most opaque.
pub(super) fn contrast(neutral: f32, fraction: f32) -> f32 {
    let difference = (fraction - neutral).abs() / neutral.max(1.0 - neutral);
    difference * difference
}

/// Colour of a black body, linear sRGB of luminance 1: Planck's law seen through the eye's response, whose lobes are those
/// of [Wyman et al. 2013].
fn black_body(kelvin: f64) -> Vec3 {
    let lobe = |wave: f64, peak: f64, low: f64, high: f64| {
        let t = (wave - peak) * if wave < peak { low } else { high };
        (-0.5 * t * t).exp()
    };
    let mut sum = [0.0_f64; 3];
    for wave in (380..=780).step_by(5).map(f64::from) {
        // 14388 um K is the second radiation constant; the factor before does not matter.
        let planck = wave.powi(-5) / ((1.4388e7 / (wave * kelvin)).exp() - 1.0);
        let x = 1.056 * lobe(wave, 599.8, 0.0264, 0.0323) + 0.362 * lobe(wave, 442.0, 0.0624, 0.0374)
            - 0.065 * lobe(wave, 501.1, 0.0490, 0.0382);
        let y = 0.821 * lobe(wave, 568.8, 0.0213, 0.0247) + 0.286 * lobe(wave, 530.9, 0.0613, 0.0322);
        let z = 1.217 * lobe(wave, 437.0, 0.0845, 0.0278) + 0.681 * lobe(wave, 459.0, 0.0385, 0.0725);
        for (sum, response) in sum.iter_mut().zip([x, y, z]) {
            *sum += planck * response;
        }
    }
    let [x, y, z] = sum.map(|value| value / sum[1]);
    let color = [
        3.2406 * x - 1.5372 * y - 0.4986 * z,
        -0.9689 * x + 1.8758 * y + 0.0415 * z,
        0.0557 * x - 0.2040 * y + 1.0570 * z,
    ];
    Vec3::from(color.map(|channel| channel.max(0.0) as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_linear_between_points_and_constant_beyond() {
        let points = [[0.2, 0.0], [0.4, 1.0], [0.4, 0.5], [0.8, 0.1]];
        for (fraction, opacity) in [(0.0, 0.0), (0.2, 0.0), (0.3, 0.5), (0.6, 0.3), (0.8, 0.1), (1.0, 0.1)] {
            assert!((curve(&points, fraction) - opacity).abs() < 1e-6, "{fraction}: {}", curve(&points, fraction));
        }
        assert_eq!(curve(&[], 0.5), 0.0);
        assert_eq!(contrast(0.25, 0.25), 0.0);
        assert_eq!(contrast(0.25, 1.0), 1.0);
    }

    #[test]
    fn hotter_bodies_are_bluer_and_daylight_is_white() {
        let [ember, candle, day] = [1200.0, 1900.0, 6500.0].map(black_body);
        assert!(ember.z == 0.0 && ember.x / ember.y > candle.x / candle.y && candle.z < 0.2, "{ember} {candle}");
        assert!((day - Vec3::ONE).abs().max_element() < 0.12, "{day}");
        // luminance
        for color in [candle, day] {
            assert!((color.dot(Vec3::new(0.2126, 0.7152, 0.0722)) - 1.0).abs() < 0.05, "{color}");
        }
    }

    #[test]
    fn transparent_entries_are_counted() {
        let gray = vec![Vec3::splat(0.5); TABLE_LENGTH];
        let tables = Tables::new(&gray, |fraction| if fraction < 0.5 { 0.0 } else { 1.0 }, 1.0, &gray);
        assert_eq!(tables.colors.len(), 3 * TABLE_LENGTH);
        assert_eq!(tables.visible.len(), 2 * (TABLE_LENGTH + 1));
        assert_eq!(tables.visible[TABLE_LENGTH / 2], 0);
        assert_eq!(tables.visible[TABLE_LENGTH], TABLE_LENGTH as u32 / 2);
    }
}
