//! Layers of USD in its binary form, file version 0.8.0: one prim whose attributes have a value at one time.
//!
//! The layout is that of OpenUSD [pxr/usd/sdf/crateFile.h, integerCoding.h; pxr/base/tf/fastCompression.h]: values first, then six
//! tables, and where those lie. Tables, whole numbers and reals that are whole are packed with LZ4, other reals lie there as they are.

use std::collections::HashMap;

use bytemuck::cast_slice;
use lz4_flex::block::compress;

/// First letters of every file.
const MAGIC: &[u8; 8] = b"PXR-USDC";
/// Version of the layout: the first one that OpenUSD does not call deprecated.
const VERSION: [u8; 8] = [0, 8, 0, 0, 0, 0, 0, 0];
/// Bytes before the values: letters, version, place of the list of tables, eight words in reserve.
const HEAD: usize = 88;
/// Arrays of fewer numbers are never packed.
const LEAST_PACKED: usize = 16;
/// Values begin at a multiple of so many bytes.
const ALIGN: usize = 8;
/// What ends a list of fields.
const END: u32 = u32::MAX;
/// Kinds of what a table describes.
const ATTRIBUTE: u32 = 1;
const PRIM: u32 = 6;
const ROOT: u32 = 7;
/// What follows a path in its tree: nothing, children only, a neighbour only; anything above is how far the neighbour lies.
const LEAF: i64 = -2;
const CHILDREN: i64 = -1;
const NEIGHBOUR: i64 = 0;

/// Flags of a value: an array, within the word itself, packed.
const ARRAY: u64 = 1 << 63;
const INLINED: u64 = 1 << 62;
const PACKED: u64 = 1 << 61;

/// Types of values.
#[derive(Clone, Copy)]
enum Type {
    Int = 3,
    Int64 = 5,
    Float = 8,
    Token = 11,
    Vec3f = 24,
    TokenVector = 41,
    Specifier = 42,
    TimeSamples = 46,
    DoubleVector = 48,
}

impl Type {
    fn at(self, place: u64) -> u64 {
        ((self as u64) << 48) | place
    }
}

/// Values of an attribute, one for each point.
#[derive(Clone, Copy, Debug)]
pub(super) enum Array<'a> {
    Reals(&'a [f32]),
    Vectors(&'a [[f32; 3]]),
    Whole(&'a [u32]),
    Long(&'a [i64]),
}

/// A layer in the making.
pub(super) struct Layer {
    time: f64,
    tokens: Vec<String>,
    known: HashMap<String, u32>,
    /// Fields: a name and a value.
    fields: Vec<(u32, u64)>,
    /// Lists of fields, each with its end.
    lists: Vec<u32>,
    /// Attributes: a name and where its list of fields begins.
    attributes: Vec<(u32, u32)>,
    bytes: Vec<u8>,
}

impl Layer {
    /// Values belong to a time.
    pub(super) fn new(time: f64) -> Self {
        let mut layer = Self {
            time,
            tokens: Vec::new(),
            known: HashMap::new(),
            fields: Vec::new(),
            lists: Vec::new(),
            attributes: Vec::new(),
            bytes: vec![0; HEAD],
        };
        // names of attributes are negative in the tree of paths, which 0 cannot be
        layer.token("");
        layer
    }

    /// Adds an attribute of a type (`point3f[]`), whose values vary over the points where it is a primvar.
    pub(super) fn attribute(&mut self, name: &str, kind: &str, primvar: bool, values: Array) {
        let kind = Type::Token.at(self.token(kind).into()) | INLINED;
        let mut fields = vec![("typeName", kind)];
        if primvar {
            fields.push(("interpolation", Type::Token.at(self.token("vertex").into()) | INLINED));
        }
        let samples = self.samples(values);
        fields.push(("timeSamples", samples));
        let list = self.list(&fields);
        let name = self.token(name);
        self.attributes.push((name, list));
    }

    /// The bytes of the layer, which has one prim of a type.
    pub(super) fn finish(mut self, prim: &str, kind: &str) -> Vec<u8> {
        let (prim, kind) = (self.token(prim), self.token(kind));
        let attributes = std::mem::take(&mut self.attributes);
        let names: Vec<u32> = attributes.iter().map(|(name, _)| *name).collect();
        let (properties, children) = (self.names(&names), self.names(&[prim]));
        let of_root = self.list(&[("defaultPrim", Type::Token.at(prim.into()) | INLINED), ("primChildren", children)]);
        let of_prim = self.list(&[
            ("specifier", Type::Specifier.at(0) | INLINED),
            ("typeName", Type::Token.at(kind.into()) | INLINED),
            ("properties", properties),
        ]);
        // paths in the order of their tree: root, prim, its attributes
        let count = attributes.len() as u32 + 2;
        let paths: Vec<u32> = (0..count).collect();
        let elements =
            [0, prim.into()].into_iter().chain(names.iter().map(|name| -i64::from(*name))).collect::<Vec<_>>();
        let mut jumps = vec![CHILDREN, CHILDREN];
        jumps.resize(count as usize, NEIGHBOUR);
        jumps[count as usize - 1] = LEAF;
        let lists: Vec<u32> = [of_root, of_prim].into_iter().chain(attributes.iter().map(|(_, list)| *list)).collect();
        let mut kinds = vec![ROOT, PRIM];
        kinds.resize(count as usize, ATTRIBUTE);
        let tables = [
            ("TOKENS", self.token_table()),
            ("STRINGS", words(&[0])),
            ("FIELDS", self.field_table()),
            ("FIELDSETS", [words(&[self.lists.len() as u64]), indices(&self.lists)].concat()),
            (
                "PATHS",
                [
                    words(&[count.into(), count.into()]),
                    indices(&paths),
                    table(elements.into_iter(), 4),
                    table(jumps.into_iter(), 4),
                ]
                .concat(),
            ),
            ("SPECS", [words(&[count.into()]), indices(&paths), indices(&lists), indices(&kinds)].concat()),
        ];
        self.close(&tables)
    }

    fn close(mut self, tables: &[(&str, Vec<u8>)]) -> Vec<u8> {
        let mut list = words(&[tables.len() as u64]);
        for (name, table) in tables {
            let mut letters = [0; 16];
            letters[..name.len()].copy_from_slice(name.as_bytes());
            list.extend(letters);
            list.extend(words(&[self.bytes.len() as u64, table.len() as u64]));
            self.bytes.extend_from_slice(table);
        }
        let place = self.bytes.len() as u64;
        self.bytes.extend(list);
        self.bytes[..8].copy_from_slice(MAGIC);
        self.bytes[8..16].copy_from_slice(&VERSION);
        self.bytes[16..24].copy_from_slice(&place.to_le_bytes());
        self.bytes
    }

    fn token(&mut self, text: &str) -> u32 {
        if let Some(known) = self.known.get(text) {
            return *known;
        }
        let new = self.tokens.len() as u32;
        self.tokens.push(text.to_owned());
        self.known.insert(text.to_owned(), new);
        new
    }

    /// A list of fields; where it begins.
    fn list(&mut self, fields: &[(&str, u64)]) -> u32 {
        let begin = self.lists.len() as u32;
        for (name, value) in fields {
            let name = self.token(name);
            self.lists.push(self.fields.len() as u32);
            self.fields.push((name, *value));
        }
        self.lists.push(END);
        begin
    }

    fn names(&mut self, tokens: &[u32]) -> u64 {
        let place = self.place();
        self.bytes.extend(words(&[tokens.len() as u64]));
        self.bytes.extend_from_slice(cast_slice(tokens));
        Type::TokenVector.at(place)
    }

    /// Times and values of an attribute: both are words behind an offset that leads to them.
    fn samples(&mut self, values: Array) -> u64 {
        let value = self.array(values);
        let times = self.place();
        self.bytes.extend(words(&[1, self.time.to_bits()]));
        let place = self.place();
        self.bytes.extend(words(&[8, Type::DoubleVector.at(times), 8, 1, value]));
        Type::TimeSamples.at(place)
    }

    fn array(&mut self, values: Array) -> u64 {
        let (kind, count, raw) = match values {
            Array::Reals(values) => (Type::Float, values.len(), cast_slice(values)),
            Array::Vectors(values) => (Type::Vec3f, values.len(), cast_slice(values)),
            Array::Whole(values) => (Type::Int, values.len(), cast_slice(values)),
            Array::Long(values) => (Type::Int64, values.len(), cast_slice(values)),
        };
        if count == 0 {
            return kind.at(0) | ARRAY;
        }
        let packed = (count >= LEAST_PACKED).then(|| packed(values)).flatten();
        let place = self.place();
        self.bytes.extend(words(&[count as u64]));
        self.bytes.extend_from_slice(packed.as_deref().unwrap_or(raw));
        kind.at(place) | ARRAY | if packed.is_some() { PACKED } else { 0 }
    }

    /// Where the next value begins.
    fn place(&mut self) -> u64 {
        self.bytes.resize(self.bytes.len().next_multiple_of(ALIGN), 0);
        self.bytes.len() as u64
    }

    fn token_table(&self) -> Vec<u8> {
        let letters: Vec<u8> = self.tokens.iter().flat_map(|token| [token.as_bytes(), &[0]].concat()).collect();
        let packed = lz4(&letters);
        [words(&[self.tokens.len() as u64, letters.len() as u64, packed.len() as u64]), packed].concat()
    }

    fn field_table(&self) -> Vec<u8> {
        let names: Vec<u32> = self.fields.iter().map(|(name, _)| *name).collect();
        let values = lz4(&words(&self.fields.iter().map(|(_, value)| *value).collect::<Vec<_>>()));
        [words(&[self.fields.len() as u64]), indices(&names), words(&[values.len() as u64]), values].concat()
    }
}

/// Bytes of an array in fewer bytes, where its kind has such a form.
fn packed(values: Array) -> Option<Vec<u8>> {
    match values {
        Array::Vectors(_) => None,
        Array::Whole(values) => Some(indices(values)),
        Array::Long(values) => Some(table(values.iter().copied(), 8)),
        Array::Reals(values) => {
            let whole: Option<Vec<i32>> = values
                .iter()
                .map(|value| Some(*value as i32).filter(|whole| (*whole as f32).to_bits() == value.to_bits()))
                .collect();
            whole.map(|whole| [b"i".to_vec(), table(whole.into_iter().map(i64::from), 4)].concat())
        }
    }
}

fn words(values: &[u64]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// A block of LZ4 behind a byte that says it is the only one.
fn lz4(bytes: &[u8]) -> Vec<u8> {
    [vec![0], compress(bytes)].concat()
}

/// Whole numbers of 4 or 8 bytes with the length of their packed form: the common step from one to the next, two bits for each number
/// (0 for that step, else how wide its own is), then the other steps.
fn table(values: impl Iterator<Item = i64>, bytes: usize) -> Vec<u8> {
    let fits = |step: i64, width: usize| (step << (64 - 8 * width)) >> (64 - 8 * width) == step;
    let steps: Vec<i64> = values
        .scan(0, |before, value| {
            let step = value.wrapping_sub(std::mem::replace(before, value));
            Some(if bytes == 4 { i64::from(step as i32) } else { step })
        })
        .collect();
    let common = most_common(&steps);
    let mut out = common.to_le_bytes()[..bytes].to_vec();
    out.resize(bytes + steps.len().div_ceil(4), 0);
    for (number, step) in steps.iter().enumerate().filter(|(_, step)| **step != common) {
        let code = if fits(*step, bytes / 4) { 1 } else { 2 + usize::from(!fits(*step, bytes / 2)) };
        out[bytes + number / 4] |= (code as u8) << (2 * (number % 4));
        out.extend_from_slice(&step.to_le_bytes()[..bytes >> (3 - code)]);
    }
    let packed = lz4(&out);
    [words(&[packed.len() as u64]), packed].concat()
}

/// The same of indices.
fn indices(values: &[u32]) -> Vec<u8> {
    table(values.iter().map(|value| i64::from(*value as i32)), 4)
}

/// The number that most are, if it is more than half of all.
fn most_common(values: &[i64]) -> i64 {
    let vote = |(best, lead): (i64, usize), value: &i64| match lead {
        0 => (*value, 1),
        _ if best == *value => (best, lead + 1),
        _ => (best, lead - 1),
    };
    values.iter().fold((0, 0), vote).0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whole numbers of a packed form, as OpenUSD takes them apart.
    fn unpacked(packed: &[u8], count: usize, bytes: usize) -> Vec<i64> {
        let most = bytes * (count + 1) + count.div_ceil(4);
        let coded = lz4_flex::block::decompress(&packed[9..], most).unwrap();
        let number = |from: &[u8]| {
            let mut word = [if from[from.len() - 1] > 127 { 255 } else { 0 }; 8];
            word[..from.len()].copy_from_slice(from);
            i64::from_le_bytes(word)
        };
        let mut at = bytes + count.div_ceil(4);
        let mut value = 0;
        let mut next = |index: usize| {
            let width = match coded[bytes + index / 4] >> (2 * (index % 4)) & 3 {
                0 => return number(&coded[..bytes]),
                code => bytes >> (3 - code),
            };
            at += width;
            number(&coded[at - width..at])
        };
        let values = (0..count).map(|index| {
            value += next(index);
            if bytes == 4 { i64::from(value as i32) } else { value }
        });
        values.collect()
    }

    #[test]
    fn whole_numbers_come_back() {
        let many: Vec<i64> = (0..1000).map(|k| if k % 7 == 0 { k * k * k - 300 } else { 5 * k }).collect();
        let ends = [i32::MAX, i32::MIN, 0, -1, 127, -128, 32767, -32768].map(i64::from).to_vec();
        let far = vec![i64::MAX, i64::MAX - 3, 1 << 40, 5, 6, 7, -(1 << 31), 0];
        for (values, bytes) in [(&many, 4), (&many, 8), (&ends, 4), (&ends, 8), (&far, 8), (&vec![], 4)] {
            let packed = table(values.iter().copied(), bytes);
            assert_eq!(packed.len() as u64, 8 + u64::from_le_bytes(packed[..8].try_into().unwrap()));
            assert_eq!(&unpacked(&packed, values.len(), bytes), values);
        }
    }

    #[test]
    fn reals_are_packed_only_where_nothing_is_lost() {
        assert!(packed(Array::Reals(&[0.0, 1.0, -5.0])).is_some());
        for lossy in [-0.0, 0.5, f32::NAN, f32::INFINITY, 3e9] {
            assert!(packed(Array::Reals(&[1.0, lossy])).is_none(), "{lossy}");
        }
    }

    #[test]
    fn tables_lie_where_the_head_says() {
        let mut layer = Layer::new(3.0);
        layer.attribute("points", "point3f[]", false, Array::Vectors(&[[1.0, 2.0, 3.0]]));
        layer.attribute("ids", "int64[]", false, Array::Long(&[]));
        let bytes = layer.finish("bodies", "Points");
        let word = |at: usize| u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize;
        assert_eq!((&bytes[..8], &bytes[8..16]), (&MAGIC[..], &VERSION[..]));
        let list = word(16);
        assert_eq!((word(list), list + 8 + 6 * 32), (6, bytes.len()));
        for (number, name) in ["TOKENS", "STRINGS", "FIELDS", "FIELDSETS", "PATHS", "SPECS"].iter().enumerate() {
            let entry = list + 8 + 32 * number;
            assert!(bytes[entry..].starts_with(name.as_bytes()));
            let next = if number < 5 { word(entry + 48) } else { list };
            assert_eq!(word(entry + 16) + word(entry + 24), next, "{name}");
        }
    }
}
