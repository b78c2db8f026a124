//! Tables that grow during a run: diagnostics.csv, bodies.csv, probes.csv.

use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::export::atomic;
use crate::quantity::Entry;
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

impl From<Entry> for Value {
    fn from(entry: Entry) -> Self {
        match entry {
            Entry::Whole(number) => Value::Integer(number),
            Entry::Real(number) => Value::Real(number),
        }
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

    /// The same of names that are made.
    #[must_use]
    pub fn named(path: &Path, header: Vec<String>) -> Self {
        let header: Vec<&str> = header.iter().map(String::as_str).collect();
        Self::new(path, &header)
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
            return Err(Error::spoilt(before, reason));
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

    /// Its rows so far, as they are written.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
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

/// A table that was written, column by column.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sheet {
    names: Vec<String>,
    numbers: Vec<Vec<f64>>,
    texts: Vec<Vec<String>>,
}

impl Sheet {
    /// Reads a table; the columns named in `texts` hold names. None where there is no such file.
    ///
    /// # Errors
    /// [`Error::Io`] with the line that has another number of entries than the header, or an entry that is no number.
    pub fn read(path: &Path, texts: &[&str]) -> Result<Option<Self>> {
        match input::text(path, MOST_TABLE) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            text => Self::parse(path, &text.map_err(|source| Error::io(path, source))?, texts).map(Some),
        }
    }

    /// The same of the text of a table, which lies at a place.
    ///
    /// # Errors
    /// As those of [`Sheet::read`].
    pub fn parse(path: &Path, text: &str, texts: &[&str]) -> Result<Self> {
        let wrong = |line: usize, reason: &str| Error::spoilt(path, format_args!("line {}: {reason}", line + 1));
        let mut lines = text.lines().enumerate();
        let names = entries(lines.next().map_or("", |(_, line)| line));
        let mut sheet = Self { numbers: vec![Vec::new(); names.len()], texts: vec![Vec::new(); names.len()], names };
        for (number, line) in lines {
            let row = entries(line);
            if row.len() != sheet.names.len() {
                return Err(wrong(number, &format!("{} entries, {} columns", row.len(), sheet.names.len())));
            }
            for (k, entry) in row.into_iter().enumerate() {
                if texts.contains(&sheet.names[k].as_str()) {
                    sheet.texts[k].push(entry);
                } else {
                    let value = entry.parse().map_err(|_| wrong(number, &format!("`{entry}` is no number")))?;
                    sheet.numbers[k].push(value);
                }
            }
        }
        Ok(sheet)
    }

    /// Names of the columns.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// A column of numbers.
    #[must_use]
    pub fn numbers(&self, name: &str) -> Option<&[f64]> {
        let column = self.names.iter().position(|own| own == name)?;
        Some(&self.numbers[column])
    }

    /// A column of names.
    #[must_use]
    pub fn texts(&self, name: &str) -> Option<&[String]> {
        let column = self.names.iter().position(|own| own == name)?;
        Some(&self.texts[column])
    }
}

/// Entries of a line, without their quotes.
fn entries(line: &str) -> Vec<String> {
    let (mut all, mut quoted) = (vec![String::new()], false);
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        let entry = all.last_mut();
        match (letter, entry) {
            ('"', Some(entry)) if quoted && letters.peek() == Some(&'"') => {
                letters.next();
                entry.push('"');
            }
            ('"', _) => quoted = !quoted,
            (',', _) if !quoted => all.push(String::new()),
            (_, Some(entry)) => entry.push(letter),
            _ => {}
        }
    }
    all
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
        let sheet = Sheet::read(&path, &["name"]).unwrap().unwrap();
        assert_eq!(sheet.texts("name").unwrap(), ["shell, outer \"A\"", "core"]);
        assert_eq!((sheet.numbers("step").unwrap(), sheet.numbers("mass").unwrap()[0]), (&[1.0, 2.0][..], 1.5e-30));
        assert!(sheet.numbers("mass").unwrap()[1].is_nan() && sheet.numbers("speed").is_none());
        assert_eq!(Sheet::read(&folder.path().join("none.csv"), &[]).unwrap(), None);
        std::fs::write(&path, "step,mass\n1,2\n3\n").unwrap();
        assert!(Sheet::read(&path, &[]).unwrap_err().to_string().contains("line 3: 1 entries, 2 columns"));
        std::fs::write(&path, "step,mass\n1,two\n").unwrap();
        assert!(Sheet::read(&path, &[]).unwrap_err().to_string().contains("line 2: `two` is no number"));
    }
}
