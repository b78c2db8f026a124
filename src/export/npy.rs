//! Arrays of NumPy's format npy: a line of text about the numbers, then the numbers. [NEP 1]

use std::io::Read;

use bytemuck::{Pod, cast_slice, cast_slice_mut, pod_collect_to_vec, try_cast_vec};
use serde::{Deserialize, Serialize};

/// First bytes of every array, with the version of the format.
const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";
/// Heads end at a multiple of so many bytes.
const ALIGN: usize = 64;
/// Bytes of a head at most.
pub(super) const MOST_HEAD: u64 = 1 << 16;

/// Kinds of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Kind {
    /// Bytes.
    U8,
    /// Unsigned words.
    U32,
    /// Floating point numbers of 32 bits.
    F32,
    /// Floating point numbers of 64 bits.
    F64,
}

/// All kinds with their names in heads.
const KINDS: [(Kind, &str); 4] = [(Kind::U8, "|u1"), (Kind::U32, "<u4"), (Kind::F32, "<f4"), (Kind::F64, "<f8")];

impl Kind {
    /// Bytes of a number.
    #[must_use]
    pub fn width(self) -> usize {
        match self {
            Kind::U8 => 1,
            Kind::U32 | Kind::F32 => 4,
            Kind::F64 => 8,
        }
    }

    fn name(self) -> &'static str {
        KINDS.iter().find(|(kind, _)| *kind == self).map_or("", |(_, name)| name)
    }
}

/// The head of an array of a shape.
pub(super) fn head(kind: Kind, shape: &[usize]) -> Vec<u8> {
    let sides: Vec<String> = shape.iter().map(ToString::to_string).collect();
    let shape = if sides.len() == 1 { format!("({},)", sides[0]) } else { format!("({})", sides.join(", ")) };
    let mut text = format!("{{'descr': '{}', 'fortran_order': False, 'shape': {shape}, }}", kind.name());
    let unpadded = MAGIC.len() + 2 + text.len() + 1;
    text.push_str(&" ".repeat(unpadded.next_multiple_of(ALIGN) - unpadded));
    text.push('\n');
    let length = (text.len() as u16).to_le_bytes();
    [MAGIC, &length, text.as_bytes()].concat()
}

/// Numbers of one kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Numbers {
    /// Bytes.
    U8(Vec<u8>),
    /// Unsigned words.
    U32(Vec<u32>),
    /// Floating point numbers of 32 bits.
    F32(Vec<f32>),
    /// Floating point numbers of 64 bits.
    F64(Vec<f64>),
}

impl Numbers {
    /// So many zeros, where there is memory for them.
    fn zeros(kind: Kind, count: usize) -> Option<Self> {
        fn room<T: Pod>(count: usize) -> Option<Vec<T>> {
            let mut all = Vec::new();
            all.try_reserve_exact(count).ok()?;
            all.resize(count, T::zeroed());
            Some(all)
        }
        Some(match kind {
            Kind::U8 => Self::U8(room(count)?),
            Kind::U32 => Self::U32(room(count)?),
            Kind::F32 => Self::F32(room(count)?),
            Kind::F64 => Self::F64(room(count)?),
        })
    }

    /// Their kind.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::U8(_) => Kind::U8,
            Self::U32(_) => Kind::U32,
            Self::F32(_) => Kind::F32,
            Self::F64(_) => Kind::F64,
        }
    }

    /// All of them, lowest byte first.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        match self {
            Self::U8(all) => all,
            Self::U32(all) => cast_slice(all),
            Self::F32(all) => cast_slice(all),
            Self::F64(all) => cast_slice(all),
        }
    }

    fn bytes_mut(&mut self) -> &mut [u8] {
        match self {
            Self::U8(all) => all,
            Self::U32(all) => cast_slice_mut(all),
            Self::F32(all) => cast_slice_mut(all),
            Self::F64(all) => cast_slice_mut(all),
        }
    }

    /// The same bits as elements of a type, whose size divides theirs; the memory stays where it can.
    pub(super) fn cast<T: Pod>(self) -> Vec<T> {
        match self {
            Self::U8(all) => try_cast_vec(all).unwrap_or_else(|(_, all)| pod_collect_to_vec(&all)),
            Self::U32(all) => try_cast_vec(all).unwrap_or_else(|(_, all)| pod_collect_to_vec(&all)),
            Self::F32(all) => try_cast_vec(all).unwrap_or_else(|(_, all)| pod_collect_to_vec(&all)),
            Self::F64(all) => try_cast_vec(all).unwrap_or_else(|(_, all)| pod_collect_to_vec(&all)),
        }
    }
}

/// Reads an array of so many bytes with its head, to the end: its shape and its numbers, which come where they stay.
pub(super) fn read(mut from: impl Read, size: u64) -> Result<(Vec<usize>, Numbers), String> {
    let mut begin = [0; MAGIC.len() + 2];
    from.read_exact(&mut begin).map_err(|error| format!("no array of numpy: {error}"))?;
    let rest = begin.strip_prefix(MAGIC).ok_or("no array of numpy, version 1.0")?;
    let mut text = vec![0; usize::from(u16::from_le_bytes([rest[0], rest[1]]))];
    from.read_exact(&mut text).map_err(|error| format!("cut within its head: {error}"))?;
    let (kind, sides) = described(std::str::from_utf8(&text).map_err(|error| format!("its head: {error}"))?)?;
    let count = sides.iter().fold(1, |all: usize, side| all.saturating_mul(*side));
    let promised = (count as u64).saturating_mul(kind.width() as u64);
    let there = size.saturating_sub((begin.len() + text.len()) as u64);
    if promised != there {
        return Err(format!("its head promises {promised} bytes, there are {there}"));
    }
    let mut numbers =
        Numbers::zeros(kind, count).ok_or_else(|| format!("there is no memory for its {promised} bytes"))?;
    from.read_exact(numbers.bytes_mut()).map_err(|error| error.to_string())?;
    // its checksum is compared at the end
    match from.read(&mut [0]).map_err(|error| error.to_string())? {
        0 => Ok((sides, numbers)),
        _ => Err(format!("has more than its {size} bytes")),
    }
}

/// Kind of the numbers and their shape, as a head describes them.
fn described(text: &str) -> Result<(Kind, Vec<usize>), String> {
    let between = |before: &str, after: char| text.split_once(before)?.1.trim_start().split(after).next();
    let name = between("'descr':", ',').unwrap_or_default().trim_matches([' ', '\'']);
    let kind = KINDS.iter().find(|(_, own)| *own == name).map(|(kind, _)| *kind);
    let kind = kind.ok_or_else(|| {
        let known: Vec<&str> = KINDS.iter().map(|(_, name)| *name).collect();
        format!("numbers of the kind `{name}`; there are: {}", known.join(", "))
    })?;
    if between("'fortran_order':", ',') != Some("False") {
        return Err("its columns come first; write it with numpy.ascontiguousarray".to_owned());
    }
    let shape = between("'shape':", ')').unwrap_or_default().trim_start_matches('(');
    let sides: Option<Vec<usize>> =
        shape.split(',').map(str::trim).filter(|side| !side.is_empty()).map(|side| side.parse().ok()).collect();
    Ok((kind, sides.ok_or_else(|| format!("no shape: ({shape})"))?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_come_back() {
        for (kind, bytes, shape) in [
            (Kind::F32, 48, vec![3, 4]),
            (Kind::U8, 7, vec![7]),
            (Kind::U32, 0, vec![0]),
            (Kind::F64, 48, vec![1, 2, 3]),
        ] {
            let mut whole = head(kind, &shape);
            assert!(whole.len().is_multiple_of(ALIGN));
            whole.extend((0..bytes).map(|byte| byte as u8));
            let size = whole.len() as u64;
            let (sides, numbers) = read(&whole[..], size).unwrap();
            assert_eq!((numbers.kind(), sides, numbers.bytes()), (kind, shape, &whole[whole.len() - bytes..]));
            assert!(bytes == 0 || read(&whole[..whole.len() - 1], size).is_err());
            whole.push(0);
            assert!(read(&whole[..], size + 1).unwrap_err().contains("promises"));
            assert!(read(&whole[..], size).unwrap_err().contains("more than its"));
        }
        assert!(read(&b"P6 2 2 and more"[..], 15).unwrap_err().contains("no array"));
        let mut other = head(Kind::F32, &[1]);
        let at = other.windows(3).position(|window| window == b"<f4").unwrap();
        other[at..at + 3].copy_from_slice(b"<c8");
        let size = other.len() as u64;
        assert!(read(&other[..], size).unwrap_err().contains("`<c8`"));
        assert_eq!(Numbers::F32(vec![1.0, 2.0, 3.0, 4.0]).cast::<[f32; 2]>(), [[1.0, 2.0], [3.0, 4.0]]);
    }
}
