//! Files that others wrote: regular files only, no larger than what is expected, and text that is text.

use std::io::{self, Read};
use std::path::Path;

/// Bytes that a scene may have.
pub const MOST_SCENE: u64 = 2 << 20;
/// Bytes that a report, or another file that programs wrote for us, may have.
pub const MOST_REPORT: u64 = 64 << 20;

/// All bytes of a regular file that has at most `most` of them.
///
/// # Errors
/// What the system says; [`io::ErrorKind::InvalidInput`] for a pipe, a device or a folder, [`io::ErrorKind::FileTooLarge`].
pub fn bytes(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let about = std::fs::metadata(path)?;
    if !about.is_file() {
        let text = if about.is_dir() { "is a folder" } else { "is no regular file" };
        return Err(io::Error::new(io::ErrorKind::InvalidInput, text));
    }
    read(std::fs::File::open(path)?, most, about.len())
}

/// As [`bytes`], for text.
///
/// # Errors
/// As [`bytes`]; [`io::ErrorKind::InvalidData`] with line and column of the first byte that is not UTF-8.
pub fn text(path: &Path, most: u64) -> io::Result<String> {
    utf8(bytes(path, most)?)
}

/// The text that comes on standard input.
///
/// # Errors
/// As [`text`].
pub fn standard(most: u64) -> io::Result<String> {
    utf8(read(io::stdin().lock(), most, 0)?)
}

/// `about`: how many there seem to be.
fn read(from: impl Read, most: u64, about: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(usize::try_from(about.min(most)).unwrap_or(0) + 1);
    from.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        let text = format!("is larger than {} MiB, the most that is read", most >> 20);
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, text));
    }
    Ok(bytes)
}

fn utf8(bytes: Vec<u8>) -> io::Result<String> {
    String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + good.iter().filter(|byte| **byte == b'\n').count();
        let start = good.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        let column = 1 + String::from_utf8_lossy(&good[start..]).chars().count();
        let byte = error.as_bytes()[good.len()];
        let text = format!("line {line}, column {column}: the byte 0x{byte:02x} is not UTF-8; save the file as UTF-8");
        io::Error::new(io::ErrorKind::InvalidData, text)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_of_a_known_size_are_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.toml");
        std::fs::write(&path, "a\nbé\u{e9}").unwrap();
        assert_eq!(text(&path, 7).unwrap(), "a\nbé\u{e9}");
        assert_eq!(text(&path, 6).unwrap_err().kind(), io::ErrorKind::FileTooLarge);
        assert_eq!(bytes(folder.path(), 6).unwrap_err().kind(), io::ErrorKind::InvalidInput);
        if cfg!(unix) {
            assert_eq!(bytes(Path::new("/dev/zero"), 6).unwrap_err().to_string(), "is no regular file");
        }
        std::fs::write(&path, b"a\nb\xc3\xa9\xff").unwrap();
        let told = text(&path, 100).unwrap_err().to_string();
        assert!(told.starts_with("line 2, column 3: the byte 0xff"), "{told}");
    }
}
