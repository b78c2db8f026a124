// The word of a slot: kind of the cell, kind one step ago, and what is known of its node and vertex.
// Bits 0..1 kind, 2..3 previous kind, then the flags; bits 16..31 hold the blocked fraction R as a 16-bit share, in GHOST slots
// the place of their rule, in WALL slots the friction of the bodies there, in thousandths, or without bodies IMAGE beyond a plane of
// symmetry, in INTERIOR slots what they know of the cells around their faces.

const IMAGE = 0x10000u;

fn kind_of(word: u32) -> u32 { return word & 3u; }
// Whether the node has gas and body, or gas and obstacle, around it.
fn is_mixed(word: u32) -> bool {
    return has(word, NODE_GAS | NODE_SOLID) && !has(word, NODE_REGULAR) && !(SOLIDS && has(word, NODE_DEEP));
}
fn previous_kind_of(word: u32) -> u32 { return (word >> 2u) & 3u; }
fn has(word: u32, flag: u32) -> bool { return (word & flag) != 0u; }
fn blocked_of(word: u32) -> f32 { return f32(word >> 16u) / 65535.0; }
fn word_with_blocked(word: u32, fraction: f32) -> u32 {
    return (word & 0xffffu) | (u32(clamp(fraction, 0.0, 1.0) * 65535.0 + 0.5) << 16u);
}

// What INTERIOR slots know of the six cells around their two faces across each axis, below and above: from bit 16 whether all hold gas or are
// images, from bit 22 whether the outermost one, three cells away, is an image.
const WIDE_SHIFT = 16u;
const END_SHIFT = 22u;

fn is_wide(word: u32, n: u32, up: bool) -> bool { return has(word, 1u << (WIDE_SHIFT + 2u * n + u32(up))); }
fn ends_in_image(word: u32, n: u32, up: bool) -> bool { return MIRRORED != 0u && has(word, 1u << (END_SHIFT + 2u * n + u32(up))); }

// Whether the slot stands for the image of the cell before it; see is_image().
fn holds_image(word: u32) -> bool { return MIRRORED != 0u && kind_of(word) == WALL && has(word, IMAGE); }

fn friction_of(word: u32) -> f32 { return 1e-3 * f32(word >> 16u); }
fn word_with_friction(word: u32, friction: f32) -> u32 {
    return (word & 0xffffu) | (u32(1e3 * min(friction, STICK) + 0.5) << 16u);
}
