//! Materials: parameters, limits and the names of their WGSL functions. Pure data and text, no device.
//!
//! A material kind is one line in [`KINDS`]. The line names a file here and a file `shaders/materials/<name>.wgsl` with the
//! functions `stress_<name>`, `return_<name>`, `energy_<name>` and `wave_speed_<name>`; keyword, checks, index and the
//! WGSL switch follow from it.

mod drucker_prager;
mod energy;
mod fixed_corotated;
mod flow;
mod fracture;
mod hencky;
mod neo_hookean;
mod preset;
#[cfg(test)]
mod tests;
mod text;
mod voids;
mod von_mises;
mod wgsl;

pub use energy::{Hyperelastic, Laws, Strained};
pub use flow::{Flow, PresetFlow};
pub use fracture::{AtCoarse, BAND, Debris, Fracture, LEAST_RATIO, Softening, Weibull};
pub use preset::{PRESETS, Preset, Units, kind_names};
pub use voids::JohnsonCook;
#[doc(hidden)]
pub use wgsl::{wgsl_includes, wgsl_switch};

use std::ops::Bound;

use bytemuck::{Pod, Zeroable};

use crate::structure::structure;
use crate::structure::types::vec4f;

/// All kinds of material. The position is the number that shaders see.
pub const KINDS: [&Kind; 5] =
    [&neo_hookean::KIND, &von_mises::KIND, &fixed_corotated::KIND, &hencky::KIND, &drucker_prager::KIND];

/// A constitutive law.
#[derive(Debug)]
pub struct Kind {
    /// Keyword in scenes and suffix of the WGSL functions.
    pub name: &'static str,
    /// One sentence for documentation.
    pub summary: &'static str,
    /// Parameters in the order in which [`Kind::constants`] takes them.
    pub parameters: &'static [Parameter],
    /// Constants of the law from checked parameter values.
    pub constants: fn(&[f64]) -> Constants,
    /// Whether its plastic flow is shear alone, so that the deformation gradient knows the volume.
    pub keeps_volume: bool,
    /// Its energy.
    pub energy: Hyperelastic,
}

/// A parameter of a law.
#[derive(Debug)]
pub struct Parameter {
    /// Key in scenes.
    pub name: &'static str,
    /// Dimension, "1" for a pure number.
    pub unit: &'static str,
    /// Value when left out; `None` if it must be given.
    pub default: Option<f64>,
    /// The least value.
    pub low: Bound<f64>,
    /// The largest value.
    pub high: Bound<f64>,
    /// One sentence for documentation.
    pub summary: &'static str,
}

impl Parameter {
    const fn positive(name: &'static str, unit: &'static str, summary: &'static str) -> Self {
        Self { name, unit, default: None, low: Bound::Excluded(0.0), high: Bound::Unbounded, summary }
    }

    /// From 0 on, which is also its default.
    const fn not_negative(name: &'static str, unit: &'static str, summary: &'static str) -> Self {
        Self { low: Bound::Included(0.0), ..Self::positive(name, unit, summary).or(0.0) }
    }

    const fn below(self, limit: f64) -> Self {
        Self { high: Bound::Excluded(limit), ..self }
    }

    const fn or(self, default: f64) -> Self {
        Self { default: Some(default), ..self }
    }
}

/// Young's modulus, shared by the elastic laws.
const YOUNG_MODULUS: Parameter =
    Parameter::positive("young_modulus", "Pa", "Young's modulus: stress over strain of a thin rod");

/// Poisson's ratio, shared by the elastic laws. At 0.5 lambda has no finite value; at 0 it vanishes, and with it the stiffness
/// of the ghost pressure, which the pressure system divides by.
const POISSON_RATIO: Parameter =
    Parameter::positive("poisson_ratio", "1", "Poisson's ratio: lateral over axial strain of a thin rod").below(0.5);

/// Stress at which metals start to flow.
const YIELD_STRESS: Parameter = Parameter::positive(
    "yield_stress",
    "Pa",
    "Norm of the deviatoric Kirchhoff stress at which plastic flow starts, sqrt(2/3) of the yield stress of a thin rod",
);

/// How the yield stress of metals grows.
const HARDENING: Parameter = Parameter::not_negative(
    "hardening",
    "Pa",
    "Growth of the yield stress per equivalent plastic strain; 0 is perfect plasticity",
);

/// How stiffly the ghost pressure follows the pressure of the gas. [Cao et al. 2022, eq. 17]
const GHOST_MODULUS: Parameter = Parameter::not_negative(
    "ghost_modulus",
    "Pa",
    "Part of the first Lame constant lambda that the ghost pressure bears, which couples the body to the gas. The value 0 stands \
              for 0.02 lambda, or for the largest pressure of the gas at the start and at the sides if that is more",
);

/// Parameters of metals, in the order of [`Constants::metal`].
const METAL: [Parameter; 5] = [YOUNG_MODULUS, POISSON_RATIO, YIELD_STRESS, HARDENING, GHOST_MODULUS];

/// Constants that every law is built from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constants {
    /// Shear modulus mu `[Pa]`.
    pub mu: f64,
    /// First Lame constant lambda `[Pa]`.
    pub lambda: f64,
    /// Yield stress `[Pa]`; infinite for laws that do not yield.
    pub yield_stress: f64,
    /// Growth of the yield stress per equivalent plastic strain `[Pa]`.
    pub hardening: f64,
    /// Growth of the yield stress with the pressure: over minus the trace of the Kirchhoff stress `[1]`.
    pub friction: f64,
    /// Modulus of the ghost pressure that is asked for, 0 where it is left open `[Pa]`.
    pub ghost_modulus: f64,
}

/// How the elastic law and the ghost pressure share the volumetric stiffness of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VolumeShare {
    /// The ghost pressure bears a part of lambda, the law what is left of it. Left open, the part is [`GHOST_SHARE`] or this pressure of the
    /// gas `[Pa]`, whichever is larger: less could not hold it.
    Split(f64),
    /// The ghost pressure bears all of lambda, the law shear alone.
    Ghost,
}

/// Part of lambda that the ghost pressure bears in gas of low pressure: the less, the less it damps waves, but the pressure solve divides
/// by it.
pub const GHOST_SHARE: f64 = 0.02;
/// Growth of the ghost pressure's stiffness with its pressure. [Murnaghan 1944]
pub const GHOST_STIFFENING: f64 = 7.0;

impl Constants {
    /// A metal from the values of [`METAL`].
    fn metal(values: &[f64]) -> Self {
        Constants {
            yield_stress: values[2],
            hardening: values[3],
            ..Constants::elastic(values[0], values[1], values[4])
        }
    }

    /// Lame constants of an isotropic elastic law: mu = E / (2 (1 + nu)), lambda = E nu / ((1 + nu) (1 - 2 nu)).
    fn elastic(young_modulus: f64, poisson_ratio: f64, ghost_modulus: f64) -> Self {
        let mu = young_modulus / (2.0 * (1.0 + poisson_ratio));
        let lambda = young_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio));
        Constants { mu, lambda, yield_stress: f64::INFINITY, hardening: 0.0, friction: 0.0, ghost_modulus }
    }
}

/// A material of a scene: a kind and the values of its parameters. In TOML `shell.von_mises = { young_modulus = ... }`, or a preset
/// such as `shell.steel = { units = "scaled" }`.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    kind: usize,
    values: Vec<f64>,
    /// Position in [`PRESETS`], and its units.
    preset: Option<(usize, Units)>,
    /// How it breaks, if it does.
    fracture: Option<Fracture>,
    /// How its flow stress follows strain, rate and temperature, if not by linear hardening.
    flow: Option<Flow>,
}

structure! {
    /// A material as the device sees it, 112 bytes.
    #[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
    pub MaterialParams as "MaterialParams" {
        /// Shear modulus `[Pa]`.
        mu: f32,
        /// First Lame constant of the body `[Pa]`.
        lambda: f32,
        /// Yield stress `[Pa]`; `f32::MAX` for laws that do not yield.
        yield_stress: f32,
        /// Position in [`KINDS`].
        kind: u32,
        /// Modulus of the ghost pressure at the pressure that bodies start with `[Pa]`.
        ghost_modulus: f32,
        /// Growth of the yield stress per equivalent plastic strain `[Pa]`.
        hardening: f32,
        /// Growth of the yield stress over minus the trace of the Kirchhoff stress `[1]`.
        friction: f32,
        /// What the ghost pressure leaves of lambda to the elastic stress `[Pa]`.
        elastic_lambda: f32,
        /// Tensile strength `[Pa]`; 0 for what does not break.
        tensile_strength: f32,
        /// Twice the fracture energy over the width of a band, times the modulus of pressure waves `[Pa^2]`.
        toughness: f32,
        /// [`Softening`] as a number.
        softening: u32,
        /// Density times the square of the rate of damage at most: Rayleigh's waves over the width of a band `[kg m^-3 s^-2]`.
        crack_modulus: f32,
        /// Plastic strain at which voids join, see [`JohnsonCook`]: d1, d2, d3, d4 `[1]`.
        voids: vec4f,
        /// Strain rate from which on it grows `[s^-1]`.
        void_rate: f32,
        /// Damage over the sum of plastic strains over those at failure, beyond 1; 0 for what does not break by voids `[1]`.
        void_softening: f32,
        /// Growth of the strain at failure from the start to melting, see [`JohnsonCook`]: d5 `[1]`.
        void_heat: f32,
        /// Share of the way to melting per plastic work and mass `[kg J^-1]`.
        heating: f32,
        /// Flow stress, see [`Flow`]: exponent of the strain, 0 for linear hardening; rate `[1]`, reference rate `[s^-1]`, softening `[1]`.
        flow: vec4f,
        /// Growth of the yield stress of what has crumbled over minus the trace of the Kirchhoff stress; 0 for what does not crumble `[1]`.
        rubble: f32,
        /// [`Debris`] as a number.
        debris: u32,
        /// Fills the last row.
        unused: [u32; 2],
    }
}

impl Material {
    /// A material of the given kind; parameters that are left out take their default.
    ///
    /// # Errors
    /// A sentence that names the unknown kind, the unknown or the missing parameter. Limits are checked with the scene.
    pub fn new(kind: &str, given: &[(String, f64)]) -> Result<Self, String> {
        let Some(index) = KINDS.iter().position(|k| k.name == kind) else {
            return Err(format!("unknown material `{kind}`, expected one of {}", kind_names()));
        };
        let parameters = KINDS[index].parameters;
        let names = parameters.iter().map(|p| format!("`{}`", p.name)).collect::<Vec<_>>().join(", ");
        if let Some((name, _)) = given.iter().find(|(name, _)| parameters.iter().all(|p| p.name != name)) {
            return Err(format!("unknown parameter `{name}` of material kind `{kind}`, expected {names}"));
        }
        let value = |p: &Parameter| {
            let entry = given.iter().find(|(name, _)| name == p.name).map(|(_, value)| *value);
            entry
                .or(p.default)
                .ok_or_else(|| format!("missing parameter `{}` [{}] of material kind `{kind}`", p.name, p.unit))
        };
        Ok(Material {
            kind: index,
            values: parameters.iter().map(value).collect::<Result<_, _>>()?,
            preset: None,
            fracture: None,
            flow: None,
        })
    }

    /// A preset in the given units; parameters of its law that are given replace those of the preset.
    ///
    /// # Errors
    /// As [`Material::new`].
    pub fn of_preset(index: usize, units: Units, given: &[(String, f64)]) -> Result<Self, String> {
        let preset = &PRESETS[index];
        let law = KINDS.iter().find(|kind| kind.name == preset.law);
        let scale = |name: &str| {
            let stress = law.is_some_and(|law| law.parameters.iter().any(|p| p.name == name && p.unit == "Pa"));
            if stress { units.stress() } else { 1.0 }
        };
        let own = preset.values.iter().filter(|(name, _)| given.iter().all(|(key, _)| key != name));
        let own = own.map(|(name, value)| ((*name).to_owned(), value / scale(name)));
        let all: Vec<_> = given.iter().cloned().chain(own).collect();
        let own = preset.fracture.map(|own| (own, units.stress()));
        let fracture = Fracture::resolve(None, own)?;
        Ok(Material { preset: Some((index, units)), fracture, ..Material::new(preset.law, &all)? })
    }

    /// The key of the material in a scene: its kind, or the preset.
    #[must_use]
    pub fn keyword(&self) -> &'static str {
        self.preset.map_or(self.kind().name, |(index, _)| PRESETS[index].name)
    }

    /// Density of bodies that give none `[kg m^-3]`; presets alone have one.
    #[must_use]
    pub fn density(&self) -> Option<f64> {
        self.preset.map(|(index, units)| PRESETS[index].density / units.density())
    }

    /// Position of the kind in [`KINDS`].
    #[must_use]
    pub fn kind_index(&self) -> u32 {
        self.kind as u32
    }

    /// The kind.
    #[must_use]
    pub fn kind(&self) -> &'static Kind {
        KINDS[self.kind]
    }

    /// Value of a parameter by name.
    #[must_use]
    pub fn parameter(&self, name: &str) -> Option<f64> {
        self.kind().parameters.iter().position(|p| p.name == name).map(|index| self.values[index])
    }

    /// The same with another value of a parameter, where its kind has one of that name.
    #[must_use]
    pub fn with(&self, name: &str, value: f64) -> Self {
        let mut other = self.clone();
        for (parameter, own) in self.kind().parameters.iter().zip(&mut other.values) {
            *own = if parameter.name == name { value } else { *own };
        }
        other
    }

    /// Shear modulus mu `[Pa]`.
    #[must_use]
    pub fn mu(&self) -> f64 {
        self.constants().mu
    }

    /// First Lame constant lambda `[Pa]`.
    #[must_use]
    pub fn lambda(&self) -> f64 {
        self.constants().lambda
    }

    /// Yield stress `[Pa]`; infinite for laws that do not yield.
    #[must_use]
    pub fn yield_stress(&self) -> f64 {
        self.constants().yield_stress
    }

    /// Speed of pressure waves at rest, sqrt((lambda + 2 mu) / rho) `[m s^-1]`.
    #[must_use]
    pub fn wave_speed(&self, density: f64) -> f64 {
        ((self.lambda() + 2.0 * self.mu()) / density).sqrt()
    }

    /// The material as the device sees it.
    #[must_use]
    pub fn params(&self, share: VolumeShare) -> MaterialParams {
        let Constants { mu, lambda, yield_stress, hardening, friction, ghost_modulus } = self.constants();
        let (least, left) = match share {
            VolumeShare::Split(pressure) => ((GHOST_SHARE * lambda).max(pressure), lambda),
            VolumeShare::Ghost => (lambda, 0.0),
        };
        let ghost_modulus = if ghost_modulus > 0.0 { ghost_modulus } else { least };
        let params = MaterialParams {
            mu: mu as f32,
            lambda: lambda as f32,
            yield_stress: yield_stress.min(f64::from(f32::MAX)) as f32,
            kind: self.kind_index(),
            ghost_modulus: ghost_modulus as f32,
            hardening: hardening as f32,
            friction: friction as f32,
            elastic_lambda: (left - ghost_modulus).max(0.0) as f32,
            ..Zeroable::zeroed()
        };
        self.params_with_flow(params)
    }

    /// Parameters of the law as the scene has them, by name.
    pub fn parameters(&self) -> impl Iterator<Item = (&'static str, f64)> + '_ {
        self.kind().parameters.iter().zip(&self.values).map(|(parameter, value)| (parameter.name, *value))
    }

    /// Constants of the law.
    #[must_use]
    pub fn constants(&self) -> Constants {
        (self.kind().constants)(&self.values)
    }
}
