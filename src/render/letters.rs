//! Letters of any size, drawn from vector fonts: that of the scene, then those that egui ships.

use std::sync::LazyLock;

use ab_glyph::{Font as _, FontArc, GlyphId, PxScale, ScaleFont as _, point};

use crate::scene::RenderSettings;

/// Ubuntu Light holds Latin, Greek and Cyrillic; Hack holds signs that it lacks.
static SHIPPED: LazyLock<[FontArc; 2]> = LazyLock::new(|| {
    [epaint_default_fonts::UBUNTU_LIGHT, epaint_default_fonts::HACK_REGULAR]
        .map(|bytes| FontArc::try_from_slice(bytes).expect("the fonts that come with egui are whole"))
});

/// Height of a picture over the height of its lines of text.
const LINES: f32 = 36.0;
/// Least height of a line \[pixels\].
const LEAST_LINE: f32 = 10.0;

/// Power of the share that a thin letter covers of a pixel: below 1, so that small letters are not pale.
const WEIGHT: f32 = 0.75;

/// Fonts and a size.
#[derive(Clone, Debug)]
pub(crate) struct Lettering {
    /// The first one that has a letter draws it.
    fonts: Vec<FontArc>,
    /// From the top of a line to its bottom \[pixels\].
    line: f32,
}

/// A letter of a text.
#[derive(Clone, Copy)]
struct Letter {
    font: usize,
    glyph: GlyphId,
    /// Where it starts \[pixels\].
    left: f32,
}

impl Lettering {
    /// Letters that stay legible at the size of a look's pictures, in the look's font where it has them.
    pub(crate) fn of(look: &RenderSettings) -> Self {
        let [width, height] = look.size;
        let line = height.min(width * 9 / 16) as f32 / LINES * look.text_size as f32;
        let own = look.font.as_ref().and_then(|font| font.outlines());
        Self { fonts: own.into_iter().chain(SHIPPED.iter().cloned()).collect(), line: line.max(LEAST_LINE).round() }
    }

    /// Width of the digit 0 in pixels, the unit of horizontal distances.
    pub(crate) fn advance(&self) -> i32 {
        self.width("0").max(1)
    }

    /// Height of a line in pixels.
    pub(crate) fn line(&self) -> i32 {
        self.line as i32
    }

    /// Width of a thin line, and the unit of small distances, in pixels.
    pub(crate) fn unit(&self) -> i32 {
        ((self.line / 20.0).round() as i32).max(1)
    }

    /// Width of a text in pixels.
    pub(crate) fn width(&self, text: &str) -> i32 {
        self.place(text).1.ceil() as i32
    }

    /// As much of a text as fits into a width in pixels, with a sign of what is missing.
    pub(crate) fn cut(&self, text: &str, room: i32) -> String {
        if self.width(text) <= room {
            return text.to_owned();
        }
        let (letters, _) = self.place(text);
        let end = self.width("\u{2026}");
        let fitting = letters.iter().take_while(|letter| letter.left as i32 + end <= room).count();
        let start: String = text.chars().take(fitting.saturating_sub(1)).collect();
        if fitting == 0 { start } else { start.trim_end().to_owned() + "\u{2026}" }
    }

    /// Gives the pixels of a text that starts at x and whose line has its middle at y, with the share that letters cover of each.
    pub(crate) fn draw(&self, text: &str, [x, y]: [i32; 2], mut ink: impl FnMut([i32; 2], f32)) {
        let scale = PxScale::from(self.line);
        let base = y - self.line() / 2 + SHIPPED[0].as_scaled(scale).ascent().round() as i32;
        for Letter { font, glyph, left } in self.place(text).0 {
            let glyph = glyph.with_scale_and_position(scale, point(left + x as f32, base as f32));
            let Some(outline) = self.fonts[font].outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            outline.draw(|column, row, share| {
                ink(
                    [corner.x as i32 + column as i32, corner.y as i32 + row as i32],
                    share.clamp(0.0, 1.0).powf(WEIGHT),
                );
            });
        }
    }

    /// The letters of a text, and its width in pixels.
    fn place(&self, text: &str) -> (Vec<Letter>, f32) {
        let (mut letters, mut end) = (Vec::<Letter>::new(), 0.0);
        for letter in text.chars() {
            let mut found = self.fonts.iter().map(|font| font.glyph_id(letter)).enumerate();
            let (font, glyph) = found.find(|(_, glyph)| glyph.0 != 0).unwrap_or_default();
            let scaled = self.fonts[font].as_scaled(PxScale::from(self.line));
            if let Some(before) = letters.last().filter(|before| before.font == font) {
                end += scaled.kern(before.glyph, glyph);
            }
            letters.push(Letter { font, glyph, left: end });
            end += scaled.h_advance(glyph);
        }
        (letters, end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lettering(size: [u32; 2], text_size: f64) -> Lettering {
        Lettering::of(&RenderSettings { size, text_size, ..RenderSettings::default() })
    }

    /// Pixels full of ink, about.
    fn ink(letters: &Lettering, text: &str) -> f32 {
        let mut sum = 0.0;
        letters.draw(text, [0, 100], |_, share| sum += share);
        sum
    }

    #[test]
    fn letters_grow_with_the_picture() {
        let lines = [[1280, 720], [3840, 2160], [1280, 4000], [64, 64]].map(|size| lettering(size, 1.0).line());
        assert_eq!(lines, [20, 60, 20, 10]);
        assert_eq!(lettering([1280, 720], 2.0).line(), 40);
        let [small, large] = [1.0, 3.0].map(|size| lettering([1280, 720], size));
        let ratio = f64::from(large.width("pressure [Pa]")) / f64::from(small.width("pressure [Pa]"));
        assert!((ratio - 3.0).abs() < 0.05, "{ratio}");
        let ratio = ink(&large, "pressure") / ink(&small, "pressure");
        assert!((ratio - 9.0).abs() < 1.5, "the ink of letters three times as large: {ratio}");
    }

    /// A letter that no font has is a box, the same for all: no two of these are the same.
    #[test]
    fn latin_greek_cyrillic_and_signs_of_numbers_have_letters() {
        let letters = lettering([1280, 720], 1.0);
        let text = "azAZ09äéßøÅčŁő αβγρσωΔΩ жяЖЯіў ³²×·°±µ⁰¹²³⁴⁵⁶⁷⁸⁹⁻−≤≈∞√→…";
        for letter in text.chars().filter(|letter| *letter != ' ') {
            let found = letters.fonts.iter().any(|font| font.glyph_id(letter).0 != 0);
            assert!(found && ink(&letters, &letter.to_string()) > 0.5, "{letter}");
        }
        assert!(letters.fonts.iter().all(|font| font.glyph_id('\u{13000}').0 == 0));
    }

    #[test]
    fn what_is_cut_says_so_and_fits() {
        let letters = lettering([1280, 720], 1.0);
        let text = "A ring of glass in the way of a blast";
        assert_eq!(letters.cut(text, 1000), text);
        for room in [0, 5, 40, 100, 200] {
            let cut = letters.cut(text, room);
            assert!(letters.width(&cut) <= room, "{cut}");
            assert!(
                room < 40 || cut.ends_with('\u{2026}') && text.starts_with(cut.trim_end_matches('\u{2026}')),
                "{cut}"
            );
        }
    }
}
