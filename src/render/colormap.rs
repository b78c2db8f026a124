//! Colour tables: what the shaders and the colour bar look values up in.

use glam::Vec3;

use crate::scene::{Colormap, Field};

/// Entries of a colour table.
pub(crate) const TABLE_LENGTH: usize = 1024;

/// Decay of the schlieren shade over the range of gradients, as in exp(-k |grad rho| / max) [Quirk 1994, app. A].
const SCHLIEREN_DECAY: f32 = 8.0;

/// Colours from the low to the high end, sRGB in 0..1.
///
/// Schlieren in one and two dimensions has its own table: white where the gas is uniform, dark at shocks.
pub(crate) fn table(colormap: Colormap, field: Field, dimension: u32) -> Vec<Vec3> {
    let fractions = (0..TABLE_LENGTH).map(|index| index as f32 / (TABLE_LENGTH - 1) as f32);
    if field == Field::Schlieren && dimension < 3 {
        return fractions.map(|t| Vec3::splat((-SCHLIEREN_DECAY * t).exp())).collect();
    }
    let gradient = match colormap {
        Colormap::Viridis => Some(colorous::VIRIDIS),
        Colormap::Inferno => Some(colorous::INFERNO),
        Colormap::Magma => Some(colorous::MAGMA),
        Colormap::Plasma => Some(colorous::PLASMA),
        Colormap::Cividis => Some(colorous::CIVIDIS),
        Colormap::RedBlue => Some(colorous::RED_BLUE),
        Colormap::Gray => None,
    };
    // Theirs runs from red to blue; here the high end is red.
    let mirrored = colormap == Colormap::RedBlue;
    fractions
        .map(|t| match gradient {
            Some(gradient) => {
                let color = gradient.eval_continuous(f64::from(if mirrored { 1.0 - t } else { t }));
                Vec3::new(color.r.into(), color.g.into(), color.b.into()) / 255.0
            }
            None => Vec3::splat(t),
        })
        .collect()
}

/// Colours of a map from its low to its high end, sRGB, `count` of them, for menus and editors.
#[must_use]
pub fn colors(colormap: Colormap, count: usize) -> Vec<[u8; 3]> {
    let table = table(colormap, Field::Density, 3);
    (0..count).map(|index| lookup(&table, (index as f32 + 0.5) / count as f32)).collect()
}

/// The colour at `fraction` of a table, rounded to 8 bits.
pub(crate) fn lookup(table: &[Vec3], fraction: f32) -> [u8; 3] {
    let last = (table.len() - 1) as f32;
    let place = fraction.clamp(0.0, 1.0) * last;
    let low = (place as usize).min(table.len() - 2);
    let color = table[low].lerp(table[low + 1], place - low as f32);
    (color * 255.0 + 0.5).to_array().map(|channel| channel as u8)
}

/// sRGB value of a light intensity in 0..1 [IEC 61966-2-1].
pub(crate) fn srgb_from_linear(light: f32) -> f32 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

/// Light intensity of an sRGB value in 0..1 [IEC 61966-2-1].
pub(crate) fn linear_from_srgb(value: f32) -> f32 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_of_the_tables() {
        let viridis = table(Colormap::Viridis, Field::Density, 2);
        assert_eq!(lookup(&viridis, 0.0), [68, 1, 84]);
        let signed = table(Colormap::RedBlue, Field::Velocity, 2);
        let [low, middle, high] = [0.0, 0.5, 1.0].map(|fraction| lookup(&signed, fraction));
        assert!(
            low[2] > low[0] && high[0] > high[2] && middle.iter().all(|channel| *channel > 225),
            "{low:?} {middle:?} {high:?}"
        );
        assert_eq!(lookup(&viridis, 2.0), lookup(&viridis, 1.0));
        let schlieren = table(Colormap::Viridis, Field::Schlieren, 2);
        assert_eq!(lookup(&schlieren, 0.0), [255, 255, 255]);
        assert!(lookup(&schlieren, 1.0)[0] < 4);
    }
}
