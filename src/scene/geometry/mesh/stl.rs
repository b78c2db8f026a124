//! STL, text or binary. A text file may hold several solids; all of them count.

use super::Surface;
use super::read::{three_numbers, unreadable};

/// Bytes in front of the triangles of a binary file: a title, and their number.
const HEAD: usize = 84;
/// Bytes of a triangle in a binary file: normal, corners, attribute.
const TRIANGLE: usize = 50;

/// Reads a file.
pub(super) fn read(bytes: &[u8]) -> Result<Surface, String> {
    let count = bytes.get(80..HEAD).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    let length = count.and_then(|count| count.checked_mul(TRIANGLE)?.checked_add(HEAD));
    // binary files may begin with "solid", too
    if length == Some(bytes.len()) {
        return binary(&bytes[HEAD..]);
    }
    if bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid")) {
        return ascii(bytes);
    }
    match length {
        Some(length) if length <= bytes.len() => binary(&bytes[HEAD..length]),
        Some(_) => Err(format!("its head promises {} triangles, more than the file has", count.unwrap_or(0))),
        None => Err("it is neither a text nor a binary STL".to_owned()),
    }
}

fn binary(bytes: &[u8]) -> Result<Surface, String> {
    let mut surface = Surface::default();
    for triangle in bytes.chunks_exact(TRIANGLE) {
        let number = |k: usize| f64::from(f32::from_le_bytes(std::array::from_fn(|b| triangle[4 * k + b])));
        surface.add_triangle([1, 2, 3].map(|corner| std::array::from_fn(|d| number(3 * corner + d))))?;
    }
    Ok(surface)
}

fn ascii(bytes: &[u8]) -> Result<Surface, String> {
    let text = String::from_utf8_lossy(bytes);
    let mut surface = Surface::default();
    let mut corners = Vec::new();
    for line in text.lines() {
        let mut words = line.split_ascii_whitespace();
        match words.next().map(str::to_ascii_lowercase).as_deref() {
            Some("vertex") => corners.push(three_numbers(&mut words).ok_or_else(|| unreadable(line))?),
            Some("endfacet") => {
                let Ok(triangle) = <[[f64; 3]; 3]>::try_from(std::mem::take(&mut corners)) else {
                    return Err("a facet has not three corners".to_owned());
                };
                surface.add_triangle(triangle)?;
            }
            _ => {}
        }
    }
    if corners.is_empty() { Ok(surface) } else { Err("its last facet has no end".to_owned()) }
}
