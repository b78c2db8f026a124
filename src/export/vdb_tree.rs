//! The tree of a volume in OpenVDB's layout: a root, nodes of 32^3 and 16^3 children, leaves of 8^3 voxels.

use std::collections::BTreeMap;

use flate2::{Compress, Compression, FlushCompress};
use half::slice::HalfFloatSliceExt;
use rayon::prelude::*;

/// Bytes of a file in the making, lowest byte first.
#[derive(Debug, Default)]
pub(super) struct Bytes(pub(super) Vec<u8>);

impl Bytes {
    pub(super) fn words(&mut self, words: &[u32]) {
        self.0.extend(words.iter().flat_map(|word| word.to_le_bytes()));
    }

    pub(super) fn words64(&mut self, words: &[u64]) {
        self.0.extend(words.iter().flat_map(|word| word.to_le_bytes()));
    }

    pub(super) fn reals(&mut self, reals: &[f64]) {
        self.0.extend(reals.iter().flat_map(|real| real.to_le_bytes()));
    }

    /// A text behind its length.
    pub(super) fn text(&mut self, text: &str) {
        self.words(&[text.len() as u32]);
        self.0.extend_from_slice(text.as_bytes());
    }

    /// A value with its name and type.
    pub(super) fn entry(&mut self, name: &str, kind: &str, value: &[u8]) {
        self.text(name);
        self.text(kind);
        self.words(&[value.len() as u32]);
        self.0.extend_from_slice(value);
    }

    pub(super) fn text_entry(&mut self, name: &str, value: &str) {
        self.entry(name, "string", value.as_bytes());
    }
}

/// Voxels along an edge of a leaf, of a node of leaves, of a node of those, as powers of two.
const LEAF: u32 = 3;
const LOWER: u32 = 4;
const UPPER: u32 = 5;
/// Voxels of a leaf.
const VOXELS: usize = 1 << (3 * LEAF);
/// No value of an inactive voxel is written: all are the background.
const ACTIVE_ONLY: u8 = 0;

/// Bits of the voxels or children of a node.
type Mask = Vec<u64>;

/// A leaf: its active voxels, and their values as bytes.
struct Leaf {
    mask: Mask,
    values: Vec<u8>,
}

/// Leaves by place in the lower node.
type Leaves = BTreeMap<usize, Leaf>;
/// Lower nodes by place in the upper one.
type Nodes = BTreeMap<usize, Leaves>;

/// A tree.
pub(super) struct Tree {
    /// Upper nodes by their lowest voxel.
    roots: BTreeMap<[u32; 3], Nodes>,
    half: bool,
    vector: bool,
}

/// Place among the children of a node with `1 << bits` of them along an edge, each `1 << below` voxels long.
fn place(voxel: [u32; 3], bits: u32, below: u32) -> usize {
    let part = |axis: usize| ((voxel[axis] >> below) & ((1 << bits) - 1)) as usize;
    (((part(0) << bits) | part(1)) << bits) | part(2)
}

fn mask(places: impl Iterator<Item = usize>, bits: u32) -> Mask {
    let mut mask = vec![0; 1 << (3 * bits - 6)];
    places.for_each(|place| mask[place / 64] |= 1 << (place % 64));
    mask
}

impl Tree {
    /// From cells, x fastest, of which the active ones are written.
    pub(super) fn new(cells: [u32; 3], (values, components): (&[f32], usize), active: &[bool], half: bool) -> Self {
        let blocks = cells.map(|n| n.div_ceil(1 << LEAF));
        let all: Vec<[u32; 3]> = (0..blocks[0] * blocks[1] * blocks[2])
            .map(|k| [k % blocks[0], k / blocks[0] % blocks[1], k / (blocks[0] * blocks[1])].map(|at| at << LEAF))
            .collect();
        let leaf = |compress: &mut Compress, low: &[u32; 3]| {
            let (mut places, mut own) = (Vec::with_capacity(VOXELS), Vec::with_capacity(components * VOXELS));
            for voxel in 0..VOXELS as u32 {
                let side = (1 << LEAF) - 1;
                let at = [low[0] + (voxel >> (2 * LEAF)), low[1] + ((voxel >> LEAF) & side), low[2] + (voxel & side)];
                if (0..3).any(|axis| at[axis] >= cells[axis]) {
                    continue;
                }
                let cell = (at[0] as usize) + cells[0] as usize * (at[1] as usize + cells[1] as usize * at[2] as usize);
                if active[cell] {
                    places.push(voxel as usize);
                    own.extend_from_slice(&values[components * cell..components * (cell + 1)]);
                }
            }
            if places.is_empty() {
                return None;
            }
            let values = deflated(compress, &numbers(&own, half));
            Some((*low, Leaf { mask: mask(places.into_iter(), LEAF), values }))
        };
        let leaves: Vec<Option<([u32; 3], Leaf)>> =
            all.par_iter().map_init(|| Compress::new(Compression::fast(), true), leaf).collect();
        let mut roots: BTreeMap<[u32; 3], Nodes> = BTreeMap::new();
        for (low, leaf) in leaves.into_iter().flatten() {
            let root = low.map(|at| at >> (LEAF + LOWER + UPPER) << (LEAF + LOWER + UPPER));
            let nodes = roots.entry(root).or_default();
            let own = nodes.entry(place(low, UPPER, LEAF + LOWER)).or_default();
            own.insert(place(low, LOWER, LEAF), leaf);
        }
        Self { roots, half, vector: components == 3 }
    }

    /// The shape of the tree.
    pub(super) fn write_topology(&self, out: &mut Bytes, background: [f32; 3]) {
        let components = if self.vector { 3 } else { 1 };
        out.words(&[1]); // one buffer a leaf
        out.0.extend(background[..components].iter().flat_map(|value| value.to_le_bytes()));
        out.words(&[0, self.roots.len() as u32]);
        for (low, nodes) in &self.roots {
            out.words(low);
            self.write_node(out, nodes.keys(), UPPER);
            for leaves in nodes.values() {
                self.write_node(out, leaves.keys(), LOWER);
                leaves.values().for_each(|leaf| out.words64(&leaf.mask));
            }
        }
    }

    /// A node without values of its own.
    fn write_node<'a>(&self, out: &mut Bytes, children: impl Iterator<Item = &'a usize>, bits: u32) {
        out.words64(&mask(children.copied(), bits));
        out.words64(&mask(std::iter::empty(), bits));
        out.0.push(ACTIVE_ONLY);
        if !self.half {
            out.words64(&[0]); // bytes of no values
        }
    }

    /// The values of all leaves.
    pub(super) fn write_values(&self, out: &mut Bytes) {
        for leaf in self.roots.values().flat_map(Nodes::values).flat_map(Leaves::values) {
            out.words64(&leaf.mask);
            out.0.push(ACTIVE_ONLY);
            out.0.extend_from_slice(&leaf.values);
        }
    }
}

fn numbers(values: &[f32], half: bool) -> Vec<u8> {
    if !half {
        return values.iter().flat_map(|value| value.to_le_bytes()).collect();
    }
    let mut halves = vec![half::f16::ZERO; values.len()];
    halves.convert_from_f32_slice(values);
    halves.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Values behind the number of their bytes: deflated, or where that is no gain as they are, with a negative number.
fn deflated(compress: &mut Compress, raw: &[u8]) -> Vec<u8> {
    compress.reset();
    let mut stream = Vec::with_capacity(raw.len() + 64);
    let done = compress.compress_vec(raw, &mut stream, FlushCompress::Finish);
    let gain = matches!(done, Ok(flate2::Status::StreamEnd)) && stream.len() < raw.len();
    let (length, bytes) = if gain { (stream.len() as i64, &stream[..]) } else { (-(raw.len() as i64), raw) };
    [&length.to_le_bytes(), bytes].concat()
}
