//! Tables that grow during a run: diagnostics.csv, bodies.csv, probes.csv.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::Result;
use crate::export::atomic;

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
