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

/// Meaning, symbol and unit of a quantity, for the axis of a plot; nothing where there is none of that name.
#[must_use]
pub fn label<T>(quantities: &[Columns<T>], name: &str) -> String {
    let found = quantities.iter().find(|quantity| quantity.name == name);
    found.map_or_else(String::new, |own| {
        // what follows a comma says how it is computed
        let meaning = own.caption.split([',', ';']).next().unwrap_or_default();
        let begin = format!("{meaning} {}", letters(own.symbol));
        if own.unit == "1" { begin } else { format!("{begin} [{}]", printed(own.unit)) }
    })
}

/// A symbol as it is printed: Greek letters instead of their names.
#[must_use]
pub fn letters(symbol: &str) -> String {
    const GREEK: [(&str, &str); 8] = [
        ("rho", "\u{3c1}"),
        ("gamma", "\u{3b3}"),
        ("sigma", "\u{3c3}"),
        ("omega", "\u{3c9}"),
        ("kappa", "\u{3ba}"),
        ("phi", "\u{3c6}"),
        ("eps", "\u{3b5}"),
        ("grad ", "\u{2207}"),
    ];
    GREEK.iter().fold(symbol.to_owned(), |text, (name, letter)| text.replace(name, letter))
}

/// A unit as it is printed: `m/s` instead of `m s^-1`.
fn printed(unit: &str) -> String {
    const POWERS: [(&str, &str); 3] = [("^3", "\u{b3}"), ("^2", "\u{b2}"), (" ", "\u{b7}")];
    if unit.contains('(') {
        return unit.to_owned();
    }
    let (below, above): (Vec<&str>, Vec<&str>) = unit.split(' ').partition(|part| part.contains("^-"));
    let above = if above.is_empty() { "1".to_owned() } else { above.join(" ") };
    let below: String = below.iter().map(|part| format!("/{}", part.replace("^-1", "").replace("^-", "^"))).collect();
    POWERS.iter().fold(above + &below, |text, (name, letter)| text.replace(name, letter))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::{BODY, LOAD};

    #[test]
    fn axes_of_plots_have_meaning_symbol_and_unit() {
        let of_body = |name| label(BODY, name);
        assert_eq!(of_body("kinetic_energy"), "kinetic energy of the particles E_kin [J]");
        assert_eq!(of_body("elastic_energy"), "elastic energy of the particles E_el [J]");
        assert_eq!(of_body("mean_plastic_strain"), "mean equivalent plastic strain <\u{3b5}_p>");
        assert_eq!(of_body("deviatoric_stress"), "largest deviatoric stress \u{3c3}_vM [Pa]");
        assert_eq!(of_body("velocity"), "velocity of the centre of mass v [m/s]");
        assert_eq!(label(LOAD, "impulse"), "force over the time since the start I [kg\u{b7}m/s]");
        assert_eq!(of_body("none"), "");
        assert_eq!(
            [printed("kg m^2 s^-1"), printed("s^-1"), printed("kg m^-3")],
            ["kg\u{b7}m\u{b2}/s", "1/s", "kg/m\u{b3}"]
        );
    }
}
