//! Arrays of NumPy's format npy: a line of text about the numbers, then the numbers. [NEP 1]

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

/// Kind of the numbers, their shape, and where they begin.
pub(super) fn parse(whole: &[u8]) -> Result<(Kind, Vec<usize>, usize), String> {
    let rest = whole.strip_prefix(MAGIC).ok_or("no array of numpy, version 1.0")?;
    let (length, rest) = rest.split_at_checked(2).ok_or("cut within its head")?;
    let length = usize::from(u16::from_le_bytes([length[0], length[1]]));
    let text = rest.get(..length).and_then(|text| std::str::from_utf8(text).ok()).ok_or("cut within its head")?;
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
    let sides = sides.ok_or_else(|| format!("no shape: ({shape})"))?;
    let count = sides.iter().fold(kind.width(), |all, side| all.saturating_mul(*side));
    let start = MAGIC.len() + 2 + length;
    let there = whole.len() - start;
    if count != there {
        return Err(format!("its head promises {count} bytes, there are {there}"));
    }
    Ok((kind, sides, start))
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
            let start = whole.len();
            assert!(start.is_multiple_of(ALIGN));
            whole.extend(vec![0; bytes]);
            assert_eq!(parse(&whole).unwrap(), (kind, shape, start));
            whole.push(0);
            assert!(parse(&whole).unwrap_err().contains("promises"));
        }
        assert!(parse(b"P6 2 2").unwrap_err().contains("no array"));
        let mut other = head(Kind::F32, &[1]);
        let at = other.windows(3).position(|window| window == b"<f4").unwrap();
        other[at..at + 3].copy_from_slice(b"<c8");
        assert!(parse(&other).unwrap_err().contains("`<c8`"));
    }
}
