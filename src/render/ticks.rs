//! Round numbers for axes and colour bars.

/// Round values inside `range`, about `wanted` of them, each with its label.
pub(crate) fn ticks(range: [f64; 2], wanted: usize) -> Vec<(f64, String)> {
    let width = range[1] - range[0];
    if !(width.is_finite() && width > 0.0) {
        return Vec::new();
    }
    let step = round_step(width / wanted.max(1) as f64);
    let (first, last) = ((range[0] / step - 1e-6).ceil() as i64, (range[1] / step + 1e-6).floor() as i64);
    let largest = range[0].abs().max(range[1].abs());
    (first..=last).map(|index| index as f64 * step).map(|value| (value, label(value, step, largest))).collect()
}

/// The nearest of 1, 2, 5 times a power of ten, not below `step`.
fn round_step(step: f64) -> f64 {
    let power = 10_f64.powf(step.log10().floor());
    let factor = step / power;
    let rounded = [1.0, 2.0, 5.0].into_iter().find(|&candidate| factor <= candidate * 1.0001).unwrap_or(10.0);
    rounded * power
}

/// As many digits as neighbours need to differ; times a power of ten where plain digits get long.
fn label(value: f64, step: f64, largest: f64) -> String {
    let places = |unit: f64| (-(step / unit).log10() - 1e-6).ceil().max(0.0) as usize;
    if largest < 1e5 && places(1.0) <= 4 {
        return format!("{value:.*}", places(1.0));
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    scientific(value, places(10_f64.powf(value.abs().log10().floor())))
}

/// A number times a power of ten, as people write it, with so many digits behind the point.
pub(crate) fn scientific(value: f64, places: usize) -> String {
    let text = format!("{value:.places$e}");
    let Some((factor, exponent)) = text.split_once('e') else { return text };
    let raised = exponent.chars().map(|sign| match sign {
        '-' => '\u{207b}',
        digit => SUPERSCRIPTS[digit.to_digit(10).unwrap_or_default() as usize],
    });
    format!("{factor}\u{d7}10{}", raised.collect::<String>())
}

/// Digits of an exponent.
const SUPERSCRIPTS: [char; 10] =
    ['\u{2070}', '\u{b9}', '\u{b2}', '\u{b3}', '\u{2074}', '\u{2075}', '\u{2076}', '\u{2077}', '\u{2078}', '\u{2079}'];

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(range: [f64; 2]) -> Vec<String> {
        ticks(range, 5).into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(labels([0.0, 1.0]), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels([0.98, 2.04]), ["1.00", "1.50", "2.00"].map(|text| &text[..3]));
        assert_eq!(labels([0.0, 4.1e6]), ["0", "1×10⁶", "2×10⁶", "3×10⁶", "4×10⁶"]);
        assert_eq!(
            labels([1.0e5, 1.2e5]),
            ["1.00", "1.05", "1.10", "1.15", "1.20"].map(|factor| format!("{factor}×10⁵"))
        );
        assert_eq!(labels([-2e-6, 2e-6]), ["-2×10⁻⁶", "-1×10⁻⁶", "0", "1×10⁻⁶", "2×10⁻⁶"]);
        assert!(labels([1.0, 1.0]).is_empty() && labels([0.0, f64::NAN]).is_empty());
    }
}
