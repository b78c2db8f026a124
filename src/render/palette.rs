//! Colours of bodies and materials that no value decides.

use crate::scene::{Material, Scene};

/// For what has no colour of its own, by index, sRGB: light enough to stand out from the colour maps.
const PALETTE: [[u8; 3]; 8] = [
    [226, 190, 150],
    [120, 190, 235],
    [240, 150, 90],
    [160, 210, 140],
    [214, 150, 200],
    [235, 215, 110],
    [150, 150, 160],
    [230, 110, 110],
];

/// Of each body, sRGB: its own, that of the preset of its material, or one of the palette. As many as the palette has at least.
pub(crate) fn of_bodies(scene: &Scene) -> Vec<[u8; 3]> {
    let preset = |name: &str| scene.materials.get(name)?.color();
    let own = scene.bodies.iter().map(|body| body.color.map(|color| color.0).or_else(|| preset(&body.material)));
    or_palette(own)
}

/// Of each material in the order of [`Scene::material_index`], sRGB: that of its preset, or one of the palette.
pub(super) fn of_materials(scene: &Scene) -> Vec<[u8; 3]> {
    or_palette(scene.materials.values().map(Material::color))
}

fn or_palette(colors: impl ExactSizeIterator<Item = Option<[u8; 3]>>) -> Vec<[u8; 3]> {
    let count = colors.len().max(PALETTE.len());
    let own = colors.chain(std::iter::repeat(None)).take(count);
    own.enumerate().map(|(index, color)| color.unwrap_or(PALETTE[index % PALETTE.len()])).collect()
}
