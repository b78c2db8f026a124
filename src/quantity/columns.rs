//! What a table says of a whole: its columns by name, symbol, unit and meaning, and how their entries are computed.

/// An entry of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Entry {
    /// A count.
    Whole(u64),
    /// A measured number.
    Real(f64),
}

/// How many columns a quantity has, and what stands in them.
#[derive(Debug)]
pub(super) enum Compute<T> {
    /// A count.
    Count(fn(&T) -> u64),
    /// A number.
    One(fn(&T) -> f64),
    /// A vector.
    Vector(fn(&T) -> [f64; 3]),
    /// A symmetric tensor.
    Tensor(fn(&T) -> [f64; 6]),
    /// Shares.
    Shares(fn(&T) -> [f64; crate::bodies::SPEEDS]),
}

/// A quantity of a whole: a column for each of its parts.
#[derive(Debug)]
pub struct Columns<T> {
    /// Its name, before those of its parts; of a place there is none.
    pub name: &'static str,
    /// Its symbol in equations.
    pub symbol: &'static str,
    /// Unit; of counts and quantities without dimension `1`.
    pub unit: &'static str,
    /// What it means.
    pub caption: &'static str,
    pub(super) compute: Compute<T>,
}

/// Names of the parts of a vector and of a tensor.
const VECTOR: [&str; 3] = ["x", "y", "z"];
const TENSOR: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "zx"];

impl<T> Columns<T> {
    /// Names of its columns.
    #[must_use]
    pub fn columns(&self) -> Vec<String> {
        let named = |parts: &[&str]| parts.iter().map(|part| self.part(part)).collect();
        match self.compute {
            Compute::Count(_) | Compute::One(_) => vec![self.name.to_owned()],
            Compute::Vector(_) => named(&VECTOR),
            Compute::Tensor(_) => named(&TENSOR),
            Compute::Shares(_) => {
                let all = crate::bodies::SPEEDS;
                (1..=all).map(|part| self.part(&format!("{part}_of_{all}"))).collect()
            }
        }
    }

    fn part(&self, part: &str) -> String {
        if self.name.is_empty() { part.to_owned() } else { format!("{}_{part}", self.name) }
    }

    /// The entries of a row in its columns.
    #[must_use]
    pub fn of(&self, whole: &T) -> Vec<Entry> {
        let real = |values: &[f64]| values.iter().map(|value| Entry::Real(*value)).collect();
        match self.compute {
            Compute::Count(count) => vec![Entry::Whole(count(whole))],
            Compute::One(value) => real(&[value(whole)]),
            Compute::Vector(value) => real(&value(whole)),
            Compute::Tensor(value) => real(&value(whole)),
            Compute::Shares(value) => real(&value(whole)),
        }
    }

    /// Its columns as the book names them: `velocity_*`.
    pub(super) fn written(&self) -> String {
        match self.compute {
            Compute::Count(_) | Compute::One(_) => format!("`{}`", self.name),
            _ if self.name.is_empty() => "`x`, `y`, `z`".to_owned(),
            _ => format!("`{}_*`", self.name),
        }
    }
}

/// Names of all columns of some quantities.
#[must_use]
pub fn names<T>(quantities: &[Columns<T>]) -> Vec<String> {
    quantities.iter().flat_map(Columns::columns).collect()
}

/// The entries of a row.
pub fn row<T>(quantities: &[Columns<T>], whole: &T) -> impl Iterator<Item = Entry> {
    quantities.iter().flat_map(move |quantity| quantity.of(whole))
}

/// Meaning and unit of a quantity, for the axis of a plot; nothing where there is none of that name.
#[must_use]
pub fn label<T>(quantities: &[Columns<T>], name: &str) -> String {
    let found = quantities.iter().find(|quantity| quantity.name == name);
    found.map_or_else(String::new, |own| match own.unit {
        "1" => own.caption.to_owned(),
        unit => format!("{} [{unit}]", own.caption),
    })
}
