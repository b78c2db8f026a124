//! The gases of a scene: the one that every scene has, and a second one that some have.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Gas, GasState};
use crate::explosive::{DENSEST, Explosive, explosive};

/// Gas constant of dry air \[J kg^-1 K^-1\]. [U.S. Standard Atmosphere, 1976]
pub(super) const AIR_CONSTANT: f64 = 287.053;
/// Share of the density that a gas of no volume has in it. Mirror of `shaders/shared/state.wgsl`.
const TRACE: f64 = 1e-6;

/// A second gas, that does not mix with the first below the size of a cell: both have one velocity and one pressure there. An ideal gas has
/// `gamma`, the products of an explosive its name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Species {
    /// Ratio of specific heats of an ideal gas, in place of `explosive`; helium has 1.667.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 1))]
    pub gamma: Option<f64>,
    /// Explosive whose products it is: `tnt`, `c4`, `petn` or `comp_b`. Their pressure is that of Jones, Wilkins and Lee.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub explosive: Option<String>,
    /// Time constant `[s]` with which products of charges burn on where they meet the first gas, air; they do not when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub afterburn: Option<f64>,
    /// Gas constant `[J kg^-1 K^-1]`, by default that of air, which the first gas has. It tells temperatures, and volumes where both gases
    /// are in one state.
    #[serde(default = "air_constant")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub gas_constant: f64,
}

fn air_constant() -> f64 {
    AIR_CONSTANT
}

impl Species {
    /// The explosive whose products it is.
    #[must_use]
    pub fn made_of(&self) -> Option<&'static Explosive> {
        self.explosive.as_deref().and_then(explosive)
    }
}

/// What is conserved in a cell: density \[kg m^-3\], momentum \[kg m^-2 s^-1\], energy \[J m^-3\], density of the second gas \[kg m^-3\], each
/// per volume; then its volume fraction, which is carried along.
pub type Conserved = [f64; 7];

/// The second of two gases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SecondGas {
    /// Ratio of specific heats; of products that of their ideal part, 1 + w.
    pub gamma: f64,
    /// Gas constant \[J kg^-1 K^-1\].
    pub gas_constant: f64,
    /// The explosive whose products it is.
    pub products: Option<&'static Explosive>,
    /// What its products give where they burn on, over the energy of detonation \[1\]; 0 where they do not.
    pub fuel: f64,
}

/// The equation of state of one or two gases: rho e = p G + r, G = phi / (gamma_1 - 1) + (1 - phi) / (gamma - 1), r the energy at no
/// pressure, 0 of ideal gases. [Allaire, Clerc and Kokh 2002]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquationOfState {
    /// Ratio of specific heats of the first gas.
    pub gamma: f64,
    /// The second gas.
    pub species: Option<SecondGas>,
}

impl EquationOfState {
    /// The explosive whose products the second gas is.
    #[must_use]
    pub fn products(&self) -> Option<&'static Explosive> {
        self.species?.products
    }

    /// gamma - 1 at a volume fraction of the second gas.
    #[must_use]
    pub fn grueneisen(&self, phi: f64) -> f64 {
        let Some(species) = self.species else { return self.gamma - 1.0 };
        1.0 / (phi / (species.gamma - 1.0) + (1.0 - phi) / (self.gamma - 1.0))
    }

    /// Ratio of specific heats at a volume fraction, of ideal gases.
    #[must_use]
    pub fn gamma_at(&self, phi: f64) -> f64 {
        if self.species.is_none() { self.gamma } else { 1.0 + self.grueneisen(phi) }
    }

    /// Gas constant of the mixture over that of the first gas.
    #[must_use]
    pub fn constant_ratio(&self, mass_fraction: f64) -> f64 {
        let own = self.species.map_or(1.0, |species| species.gas_constant / AIR_CONSTANT);
        1.0 + mass_fraction * (own - 1.0)
    }

    /// What the second gas of a charge holds before it burns, in energies of detonation \[1\].
    #[must_use]
    pub fn full_charge(&self) -> f64 {
        1.0 + self.species.map_or(0.0, |own| own.fuel)
    }

    /// Share of an explosive that a detonation has burned, from what the second gas holds, in energies of detonation \[1\].
    #[must_use]
    pub fn burned_share(&self, held: f64) -> f64 {
        (self.full_charge() - held).clamp(0.0, 1.0)
    }

    /// Pressure \[Pa\] of gas that holds so many energies of detonation \[1\].
    #[must_use]
    pub fn pressure(&self, state: Conserved, held: f64) -> f64 {
        let [density, x, y, z, energy, _, phi] = state;
        self.grueneisen(phi) * (energy - 0.5 * (x * x + y * y + z * z) / density - self.reference_energy(state, held))
    }

    /// Energy at no pressure \[J m^-3\]: what an explosive still holds, and of its products what Jones, Wilkins and Lee add.
    #[must_use]
    pub fn reference_energy(&self, state: Conserved, held: f64) -> f64 {
        let Some(own) = self.products() else { return 0.0 };
        let cold = own.products.cold(expansion(own, state));
        held * own.specific_energy() * state[5] - self.burned_share(held) * state[6] * cold / own.products.omega
    }

    /// Pressure of products at no temperature \[Pa\].
    #[must_use]
    pub fn cold_pressure(&self, state: Conserved, held: f64) -> f64 {
        let burned = self.burned_share(held);
        let term = |own: &'static Explosive| burned * state[6] * own.products.at_rest(expansion(own, state));
        self.products().map_or(0.0, term)
    }

    /// Pressure of a state \[Pa\] as the device has it from the internal energy of a cell of the first gas alone, to the bit. Bodies and open
    /// sides start with it: gas that is even then stays at rest.
    #[must_use]
    pub fn pressure_in_single(&self, state: &GasState) -> f32 {
        let energy = (state.pressure / (self.gamma - 1.0)) as f32;
        let alone = self.species.is_none() && energy.is_finite();
        if alone { (self.gamma as f32 - 1.0) * energy } else { state.pressure as f32 }
    }

    /// Speed of sound \[m s^-1\].
    #[must_use]
    pub fn sound_speed(&self, state: Conserved, held: f64) -> f64 {
        let ideal = self.gamma_at(state[6]) * self.pressure(state, held);
        let beyond = |own: &'static Explosive| {
            let share = self.burned_share(held) * state[6] * self.grueneisen(state[6]) / own.products.omega;
            share * own.products.cold_stiffness(expansion(own, state))
        };
        ((ideal + self.products().map_or(0.0, beyond)) / state[0]).max(0.0).sqrt()
    }

    /// Volume fraction of the second gas at a mass fraction, where both have one temperature.
    #[must_use]
    pub fn volume_fraction(&self, mass_fraction: f64) -> f64 {
        let own = mass_fraction * self.species.map_or(AIR_CONSTANT, |species| species.gas_constant);
        own / (own + (1.0 - mass_fraction) * AIR_CONSTANT)
    }

    /// A state per volume, of gas that holds nothing.
    #[must_use]
    pub fn conserved(&self, state: &GasState) -> Conserved {
        self.conserved_of(state, 0.0)
    }

    /// A state per volume, that holds so many energies of detonation.
    pub(crate) fn conserved_of(&self, state: &GasState, held: f64) -> Conserved {
        let phi = self.volume_fraction(state.mass_fraction);
        let [density, x, y, z, energy] = state.conserved(self.gamma_at(phi));
        let mut all = [density, x, y, z, energy, density * state.mass_fraction, phi];
        all[4] += self.reference_energy(all, held);
        all
    }
}

/// What the second gas holds, in energies of detonation \[1\], from its density and that of what has not burned \[kg m^-3\].
pub(crate) fn held_energy(density: f32, unburned: f32) -> f32 {
    (unburned / density.max(f32::MIN_POSITIVE)).max(0.0)
}

/// Volume of products over that of the explosive.
fn expansion(own: &Explosive, [density, _, _, _, _, part, phi]: Conserved) -> f64 {
    let trace = TRACE * density;
    (own.density / ((part + trace) / (phi + TRACE)).max(trace)).max(1.0 / DENSEST)
}

impl Gas {
    /// The equation of state.
    #[must_use]
    pub fn equation_of_state(&self) -> EquationOfState {
        let second = |own: &Species| {
            let products = own.made_of();
            let gamma = products.map_or(own.gamma.unwrap_or(self.gamma), |own| 1.0 + own.products.omega);
            let burns = products.filter(|_| own.afterburn.is_some());
            let fuel = burns.map_or(0.0, |own| own.afterburn_energy() / own.specific_energy());
            SecondGas { gamma, gas_constant: own.gas_constant, products, fuel }
        };
        EquationOfState { gamma: self.gamma, species: self.species.values().next().map(second) }
    }

    /// The explosive whose products the second gas is.
    #[must_use]
    pub fn products(&self) -> Option<&'static Explosive> {
        self.equation_of_state().products()
    }

    /// Time constant with which products burn on in air \[s\], if they do.
    #[must_use]
    pub fn afterburn(&self) -> Option<f64> {
        self.species.values().next()?.afterburn
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_have_the_pressure_and_the_sound_of_their_law() {
        for own in &crate::explosive::EXPLOSIVES {
            let products = Some(own);
            let species =
                Some(SecondGas { gamma: 1.0 + own.products.omega, gas_constant: AIR_CONSTANT, products, fuel: 0.0 });
            let gases = EquationOfState { gamma: 1.4, species };
            for volume in [0.75, 1.0, 2.0, 10.0] {
                let density = own.density / volume;
                let energy = own.products.energy / volume;
                let state = [density, 3.0 * density, 0.0, 0.0, energy + 4.5 * density, density, 1.0];
                let [pressure, sound] = [gases.pressure(state, 0.0), gases.sound_speed(state, 0.0)];
                let exact = own.products.pressure(volume, own.products.energy);
                assert!((pressure / exact - 1.0).abs() < 1e-5, "{} {volume}: {pressure} {exact}", own.name);
                let exact = (own.products.stiffness(volume, own.products.energy) / own.density).sqrt();
                assert!((sound / exact - 1.0).abs() < 1e-5, "{} {volume}: {sound} {exact}", own.name);
            }
            // what has not burned holds its energy
            let solid = GasState { density: own.density, velocity: [0.0; 3], pressure: 1e5, mass_fraction: 1.0 };
            let state = gases.conserved_of(&solid, 1.0);
            assert!((gases.pressure(state, 1.0) / 1e5 - 1.0).abs() < 1e-6);
            assert!((state[4] / own.products.energy - 1.0).abs() < 1e-3, "{}", state[4]);
        }
    }
}
