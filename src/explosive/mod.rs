//! High explosives: their data, the pressure of their products, how a charge expands into the gas around it, and the curves of Kingery
//! and Bulmash for the blast far away. Numbers and text, no device.

mod jwl;
pub mod kingery_bulmash;
mod near_field;
#[cfg(test)]
mod tests;

pub use jwl::{ChapmanJouguet, Jwl};
pub use near_field::{Expansion, NearField, Profile};

/// An explosive.
#[derive(Debug, PartialEq)]
pub struct Explosive {
    /// Keyword in scenes.
    pub name: &'static str,
    /// What it is.
    pub summary: &'static str,
    /// Density \[kg m^-3\].
    pub density: f64,
    /// Speed of a plane detonation, as measured \[m s^-1\].
    pub detonation_speed: f64,
    /// Chapman-Jouguet pressure, as measured \[Pa\].
    pub detonation_pressure: f64,
    /// Equation of state of the products.
    pub products: Jwl,
    /// Mass of TNT that gives the same blast as a unit mass: ratio of the energies.
    pub tnt_equivalent: f64,
    /// Heat of combustion, water as vapour \[J kg^-1\].
    pub combustion_energy: f64,
    /// Mass of oxygen that it lacks to burn to carbon dioxide and water, over its own \[1\].
    pub oxygen_lack: f64,
}

/// Mass fraction of oxygen in dry air. [U.S. Standard Atmosphere, 1976]
const OXYGEN_IN_AIR: f64 = 0.2314;

/// The law of products does not hold beyond so many times the density of the explosive: its stiffness without heat turns negative.
pub const DENSEST: f64 = 3.0;

impl Explosive {
    /// Energy of detonation \[J kg^-1\].
    pub fn specific_energy(&self) -> f64 {
        self.products.energy / self.density
    }

    /// What its products give where they burn on in air \[J kg^-1\].
    pub fn afterburn_energy(&self) -> f64 {
        self.combustion_energy - self.specific_energy()
    }

    /// Mass of air with which its products burn whole, over their own \[1\].
    pub fn air_needed(&self) -> f64 {
        self.oxygen_lack / OXYGEN_IN_AIR
    }
}

/// All explosives. Coefficients: B. M. Dobratz, P. C. Crawford, LLNL Explosives Handbook, UCRL-52997, 1985, table 8. Combustion and oxygen
/// follow from the formulas and the enthalpies of formation, as a test reckons; of binders from 13.1 MJ per kilogram of oxygen [Thornton
/// 1917].
pub const EXPLOSIVES: [Explosive; 4] = [
    Explosive {
        name: "tnt",
        summary: "Trinitrotoluene, cast or pressed to 1630 kg m^-3.",
        density: 1630.0,
        detonation_speed: 6930.0,
        detonation_pressure: 21.0e9,
        products: Jwl { a: 371.2e9, b: 3.231e9, r1: 4.15, r2: 0.95, omega: 0.30, energy: 7.0e9 },
        tnt_equivalent: 1.0,
        combustion_energy: 14.51e6,
        oxygen_lack: 0.7396,
    },
    Explosive {
        name: "c4",
        summary: "Composition C-4: RDX with a plastic binder.",
        density: 1601.0,
        detonation_speed: 8193.0,
        detonation_pressure: 28.0e9,
        products: Jwl { a: 609.77e9, b: 12.95e9, r1: 4.5, r2: 1.4, omega: 0.25, energy: 9.0e9 },
        tnt_equivalent: 9.0 / 1601.0 * 1630.0 / 7.0,
        combustion_energy: 11.66e6,
        oxygen_lack: 0.468,
    },
    Explosive {
        name: "petn",
        summary: "Pentaerythritol tetranitrate, pressed to 1770 kg m^-3.",
        density: 1770.0,
        detonation_speed: 8300.0,
        detonation_pressure: 33.5e9,
        products: Jwl { a: 617.05e9, b: 16.926e9, r1: 4.4, r2: 1.2, omega: 0.25, energy: 10.1e9 },
        tnt_equivalent: 10.1 / 1770.0 * 1630.0 / 7.0,
        combustion_energy: 7.58e6,
        oxygen_lack: 0.1012,
    },
    Explosive {
        name: "comp_b",
        summary: "Composition B, grade A: RDX and TNT.",
        density: 1717.0,
        detonation_speed: 7980.0,
        detonation_pressure: 29.5e9,
        products: Jwl { a: 524.23e9, b: 7.678e9, r1: 4.2, r2: 1.1, omega: 0.34, energy: 8.5e9 },
        tnt_equivalent: 8.5 / 1717.0 * 1630.0 / 7.0,
        combustion_energy: 11.14e6,
        oxygen_lack: 0.4255,
    },
];

/// The explosive of a name.
pub fn explosive(name: &str) -> Option<&'static Explosive> {
    EXPLOSIVES.iter().find(|explosive| explosive.name == name)
}
