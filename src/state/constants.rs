//! WGSL text that goes before every shader: the numbers that Rust and WGSL share have their home here.

use std::fmt::Write as _;

use super::stages::Stage;
use crate::material;
use crate::structure::wgsl_numbers;

/// Cell kinds, low two bits of a cell word.
pub const GAS: u32 = 0;
/// Holds enough solid to stop the gas.
pub const SOLID: u32 = 1;
/// Static obstacle, or outside of a wall side.
pub const WALL: u32 = 2;
/// Outside of an inlet or outlet side.
pub const GHOST: u32 = 3;
/// What marks a cut cell in scenes with bodies: gas whose faces are all blocked.
pub const CUT_MARK: u32 = 0xffff << 16;

/// What a rule prescribes beyond a side; the position is the number on the device.
pub const RULES: [&str; 6] = ["FIXED", "SUBSONIC", "TOTAL", "PRESSURE", "ATTENUATED", "FAR"];
/// Which pressures a vertex between gas and body has, see [`crate::scene::InterfacePressure`].
pub const INTERFACES: [&str; 3] = ["RESOLVED", "H", "SINGLE"];
/// Lowest bit of the place of its rule in the word of a GHOST slot.
pub const RULE_SHIFT: u32 = 16;

/// Groups, at most, that leave one partial result each.
pub const PARTIALS: u32 = 1024;
/// vec4 entries of one record of the history ring.
pub const HISTORY_WIDTH: u32 = 16;
/// Blocks of partial results that the totals of a step take.
pub const BLOCKS: u32 = 12;
/// The block of the size of the right-hand side of a solve.
pub const BLOCK_REFERENCE: u32 = 1;
/// The block of what the operator of a solve leaves.
pub const BLOCK_DOTS: u32 = 2;
/// The block of what walls, films and gravity give to bodies.
pub const BLOCK_GIVEN: u32 = 9;
/// Rounds of Newton's method at most in a step: what is left then is kept, and shows in diagnostics.csv.
pub const MAX_ROUNDS: u32 = 20;
/// Fault word of a healthy run.
pub const NO_FAULT: u32 = u32::MAX;
/// Dispatches of the longest prefix sum that a step runs.
pub const SCAN_DISPATCHES: usize = 6;
/// Columns of a marching kernel that are still together: as many as one instruction of a CPU takes, or a part of a GPU's.
pub const COLUMN_BLOCK: u32 = 8;
/// Parts of the groups of a kernel over both kinds of slots that take neighbouring places of the list: a multiple of the threads of small CPUs.
pub const LIST_PARTS: u32 = 16;
/// Number on the device of one of names that count from 0, such as [`RULES`].
///
/// # Panics
/// If the name is not among them: a bug of the caller.
pub fn number(names: &[&str], name: &str) -> u32 {
    names.iter().position(|known| *known == name).expect("names are literals of this crate") as u32
}

/// Flags of a slot, from bit 4 of its word.
const FLAGS: [&str; 12] = [
    "NODE_GAS", "NODE_REGULAR", "NODE_INTERIOR", "NODE_SOLID", "NODE_DEEP", "NODE_FILM", "VERTEX_GAS",
    "VERTEX_REGULAR", "VERTEX_SOLID", "VERTEX_DEEP", "INTERIOR", "NODE_DRIVEN",
];

/// Lists of names that count from 0, each with its prefix.
const COUNTED: [(&str, &[&str]); 3] =
    [("RULE", &RULES), ("INTERFACE", &INTERFACES), ("PHASE", &["IDLE", "SOLVE", "BETWEEN", "SUBSTEP", "ELASTIC"])];

/// Single numbers.
const NUMBERS: [(&str, u32); 27] = [
    ("GAS", GAS),
    ("SOLID", SOLID),
    ("WALL", WALL),
    ("GHOST", GHOST),
    ("RULE_SHIFT", RULE_SHIFT),
    ("MAX_OPENINGS", super::MAX_OPENINGS as u32),
    ("MAX_BODIES", crate::scene::MAX_BODIES as u32),
    ("CUT_NEAR", super::cut::NEAR),
    ("CUT_WIDTH", super::cut::WIDTH as u32),
    ("PARTIALS", PARTIALS),
    ("SCAN_DISPATCHES", SCAN_DISPATCHES as u32),
    ("COLUMN_BLOCK", COLUMN_BLOCK),
    ("LIST_PARTS", LIST_PARTS),
    ("SPACES", super::coarse::SPACES as u32),
    ("SURFACE_THREADS", super::surface::THREADS),
    ("COUPLINGS", super::surface::COUPLINGS as u32),
    ("STRENGTH_UNIT", super::particles::STRENGTH_UNIT),
    ("HISTORY_WIDTH", HISTORY_WIDTH),
    ("BLOCKS", BLOCKS),
    ("BLOCK_REFERENCE", BLOCK_REFERENCE),
    ("BLOCK_DOTS", BLOCK_DOTS),
    ("BLOCK_GIVEN", BLOCK_GIVEN),
    ("LOAD_NUMBERS", super::loads::LOAD_NUMBERS),
    ("GAUGE_WIDTH", super::gauges::GAUGE_WIDTH),
    ("NO_FAULT", NO_FAULT),
    ("MAX_ROUNDS", MAX_ROUNDS),
    ("NO_EXTRA", u32::MAX),
];

/// The constants as WGSL.
pub fn source() -> String {
    let mut text = String::new();
    let mut put = |name: &str, value: u32| {
        let _ = writeln!(text, "const {name} = {value}u;");
    };
    for (bit, name) in FLAGS.iter().enumerate() {
        put(name, 1 << (4 + bit));
    }
    for stage in Stage::ALL {
        put(&format!("STAGE_{}", stage.name().to_uppercase()), *stage as u32);
    }
    for (name, value) in super::cut::FIELDS {
        put(&format!("CUT_{name}"), value);
    }
    for (name, value) in NUMBERS {
        put(name, value);
    }
    for (prefix, names) in COUNTED {
        text.push_str(&wgsl_numbers(prefix, names));
    }
    text.push_str(&super::phases::source());
    let _ = writeln!(text, "const LIGHTEST_NODE = {:?};", super::params::LIGHTEST_NODE);
    let [line, plane, space] = super::params::LIGHTEST_BESIDE;
    let _ = writeln!(text, "const LIGHTEST_BESIDE = vec3f({line:?}, {plane:?}, {space:?});");
    let _ = writeln!(text, "const IMPLICIT_COURANT = {:?};", crate::scene::IMPLICIT_COURANT);
    let _ = writeln!(text, "const STICK = {:?};", super::supports::STICK);
    text.push_str(&crate::numerics::pcg::source());
    text
}

/// The constants for one shader file; those that ask materials something also get the switch over the registered laws.
pub fn source_for(shader: &str) -> String {
    let mut text = source();
    if MATERIAL_SHADERS.contains(&shader) {
        let _ = writeln!(text, "const MAX_MATERIALS = {}u;", super::MAX_MATERIALS);
        let _ = writeln!(text, "const SOFTENING_EXPONENTIAL = {}u;", material::Softening::Exponential as u32);
        let _ = writeln!(text, "const GHOST_STIFFENING = {:?};", material::GHOST_STIFFENING);
        let _ = writeln!(text, "@group(0) @binding(15) var<uniform> materials: array<MaterialParams, MAX_MATERIALS>;");
        text.push_str(&material::wgsl_includes());
        text.push_str(&material::wgsl_switch());
    }
    text
}

/// Shaders that include `materials/law.wgsl`.
const MATERIAL_SHADERS: [&str; 6] = [
    "interface/interface.wgsl",
    "solid/debris.wgsl",
    "solid/g2p.wgsl",
    "step/diagnostics.wgsl",
    "step/time_step.wgsl",
    "solid/elastic_solve.wgsl",
];
