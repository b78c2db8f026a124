//! Tables that grow during a run: diagnostics.csv, bodies.csv, probes.csv.

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::export::atomic;
use crate::{Error, Result, input};

/// Bytes of a table that is read again.
const MOST_TABLE: u64 = 4 << 30;

/// One entry of a row.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A count.
    Integer(u64),
    /// A measured number; written with as many digits as its bits need.
    Real(f64),
    /// A name.
    Text(String),
}

impl From<u64> for Value {
    fn from(value: u64) -> Self {
        Value::Integer(value)
    }
}

impl From<u32> for Value {
    fn from(value: u32) -> Self {
        Value::Integer(value.into())
    }
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Value::Real(value)
    }
}

impl From<f32> for Value {
    fn from(value: f32) -> Self {
        Value::Real(value.into())
    }
}

impl From<&str> for Value {
    fn from(value: &str) -> Self {
        Value::Text(value.to_owned())
    }
}

/// A CSV file with a header line. Rows gather in memory; [`Table::save`] replaces the file as a whole,
/// so a reader at any time sees complete rows of complete frames.
#[derive(Debug, Clone)]
pub struct Table {
    path: PathBuf,
    columns: usize,
    text: String,
    saved: usize,
}

impl Table {
    /// A table with these column names; nothing is written yet.
    #[must_use]
    pub fn new(path: &Path, header: &[&str]) -> Self {
        let mut table = Self { path: path.to_owned(), columns: header.len(), text: String::new(), saved: 0 };
        table.push(header.iter().map(|&name| name.into()));
        table
    }

    /// Takes the rows of a file, as far as [`Table::mark`] says. Where it has other columns, the table stays as it is.
    ///
    /// # Errors
    /// [`Error::Io`] if the file begins otherwise.
    pub fn go_on_from(&mut self, (before, mark): (&Path, &Mark)) -> Result<()> {
        let text = input::text(before, MOST_TABLE).map_err(|source| Error::io(before, source))?;
        let kept = usize::try_from(mark.bytes).ok().and_then(|bytes| text.get(..bytes));
        let Some(kept) = kept.filter(|kept| checksum(kept) == mark.checksum) else {
            let reason = "its rows up to the checkpoint are not those that the run wrote";
            return Err(Error::io(before, io::Error::new(io::ErrorKind::InvalidData, reason)));
        };
        if kept.lines().next() == self.text.lines().next() {
            kept.clone_into(&mut self.text);
        }
        Ok(())
    }

    /// How far the table has come, for [`Table::go_on_from`].
    #[must_use]
    pub fn mark(&self) -> Mark {
        Mark { bytes: self.text.len() as u64, checksum: checksum(&self.text) }
    }

    /// Where the table lies.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Adds a row of as many values as the header has names.
    pub fn push(&mut self, row: impl IntoIterator<Item = Value>) {
        let mut count = 0;
        for value in row {
            if count > 0 {
                self.text.push(',');
            }
            push_value(&mut self.text, &value);
            count += 1;
        }
        debug_assert_eq!(count, self.columns, "a row of {} must match its header", self.path.display());
        self.text.push('\n');
    }

    /// Writes the file if rows were added since the last time.
    pub fn save(&mut self) -> Result<()> {
        if self.saved < self.text.len() {
            atomic::write(&self.path, |out| out.write_all(self.text.as_bytes()))?;
            self.saved = self.text.len();
        }
        Ok(())
    }
}

/// The beginning of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Mark {
    /// Its bytes.
    pub bytes: u64,
    /// Their CRC-32.
    pub checksum: u32,
}

fn checksum(text: &str) -> u32 {
    let mut crc = flate2::Crc::new();
    crc.update(text.as_bytes());
    crc.sum()
}

fn push_value(text: &mut String, value: &Value) {
    // Writing to a String cannot fail.
    let _ = match value {
        Value::Integer(number) => write!(text, "{number}"),
        // Debug form: the shortest that reads back to the same bits, with an exponent where that is shorter.
        Value::Real(number) => write!(text, "{number:?}"),
        Value::Text(name) if name.contains([',', '"', '\n', '\r']) => {
            write!(text, "\"{}\"", name.replace('"', "\"\""))
        }
        Value::Text(name) => write!(text, "{name}"),
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_and_quotes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bodies.csv");
        let mut table = Table::new(&path, &["step", "name", "mass"]);
        table.push([Value::from(1_u64), "shell, outer \"A\"".into(), 1.5e-30_f64.into()]);
        table.save().unwrap();
        table.push([Value::from(2_u64), "core".into(), f64::NAN.into()]);
        table.save().unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(text, "step,name,mass\n1,\"shell, outer \"\"A\"\"\",1.5e-30\n2,core,NaN\n");
    }
}
