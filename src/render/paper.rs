//! Colours of what lies behind and around a picture: for a screen, or for print.

use crate::scene::{Look, RenderSettings, ToneMap};

/// Light behind everything in 3D, at the top and the bottom of the picture; linear.
const SKY: [[f32; 3]; 2] = [[0.0045, 0.0060, 0.0100], [0.0200, 0.0240, 0.0330]];
/// Light that the filmic tone map turns into white.
const FILMIC_WHITE: f32 = 16.1;

/// Colours, sRGB.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Paper {
    /// Behind everything.
    pub(crate) ground: [u8; 3],
    /// Letters.
    pub(crate) ink: [u8; 3],
    /// Frames and ticks.
    pub(crate) faint: [u8; 3],
    /// Behind the curves of a line plot.
    pub(crate) panel: [u8; 3],
    /// Lines across it.
    pub(crate) grid_line: [u8; 3],
    /// Bands in it: where a body takes the place of the gas, and an obstacle.
    pub(crate) bands: [[u8; 3]; 2],
    /// Curves of density, velocity, pressure.
    pub(crate) curves: [[u8; 3]; 3],
}

const SCREEN: Paper = Paper {
    ground: [14, 17, 22],
    ink: [222, 226, 232],
    faint: [118, 126, 138],
    panel: [22, 26, 33],
    grid_line: [42, 48, 58],
    bands: [[74, 68, 60], [62, 66, 74]],
    curves: [[102, 194, 255], [255, 184, 77], [140, 220, 120]],
};

const PRINT: Paper = Paper {
    ground: [255; 3],
    ink: [20, 20, 20],
    faint: [110, 110, 110],
    panel: [255; 3],
    grid_line: [224, 224, 224],
    bands: [[226, 214, 196], [208, 210, 214]],
    // blue, vermilion, bluish green: told apart by the colour-blind and on a grey printer
    curves: [[0, 90, 160], [196, 78, 0], [0, 120, 88]],
};

impl Paper {
    /// Of a look.
    pub(crate) fn of(look: &RenderSettings) -> Self {
        if look.look == Look::Print { PRINT } else { SCREEN }
    }

    /// Light behind everything in a 3D picture, at its top and its bottom; linear, before exposure and tone map.
    pub(crate) fn sky(look: &RenderSettings) -> [[f32; 3]; 2] {
        if look.look != Look::Print {
            return SKY;
        }
        let white = if look.tone == ToneMap::Aces { FILMIC_WHITE } else { 1.0 };
        [[white / look.exposure as f32; 3]; 2]
    }
}
