//! Presets: well-known materials by name, in SI units or scaled to the air around them.

use serde::{Deserialize, Serialize};

use super::flow::{Flow, PresetFlow};
use super::fracture::{PresetFracture, Softening};
use super::{JohnsonCook, KINDS, Material};

/// A material that scenes may name instead of a law and its numbers.
#[derive(Debug)]
pub struct Preset {
    /// Keyword in scenes.
    pub name: &'static str,
    /// One sentence for documentation.
    pub summary: &'static str,
    /// Keyword of its law.
    pub law: &'static str,
    /// Parameters of the law in SI units; the others take their defaults.
    pub values: &'static [(&'static str, f64)],
    /// Density `[kg m^-3]` of bodies that give none.
    pub density: f64,
    /// How it breaks, if that is known.
    pub fracture: Option<PresetFracture>,
    /// How its flow stress follows strain, rate and temperature, if that is known.
    pub flow: Option<PresetFlow>,
    /// Colour in pictures, sRGB.
    pub color: [u8; 3],
}

impl Preset {
    const fn new(
        name: &'static str,
        law: &'static str,
        density: f64,
        color: [u8; 3],
        summary: &'static str,
        values: &'static [(&'static str, f64)],
    ) -> Self {
        Self { name, summary, law, values, density, fracture: None, flow: None, color }
    }

    /// Breaks where a scene asks for it: strength \[Pa\], energy \[J m^-2\], and where both come from.
    const fn may_break(self, strength: f64, energy: f64, softening: Softening, source: &'static str) -> Self {
        let (tensile_strength, fracture_energy) = (strength, energy);
        let fracture =
            PresetFracture { tensile_strength, fracture_energy, softening, johnson_cook: None, always: false, source };
        Self { fracture: Some(fracture), ..self }
    }

    /// Breaks by voids where a scene asks for it: d1 to d5 from a strain rate of 1 / s on, energy \[J m^-2\], and where both come from.
    const fn may_tear(self, [d1, d2, d3, d4, d5]: [f64; 5], fracture_energy: f64, source: &'static str) -> Self {
        let johnson_cook = Some(JohnsonCook { d1, d2, d3, d4, d5, rate: 1.0 });
        let softening = Softening::Linear;
        let fracture =
            PresetFracture { tensile_strength: 0.0, fracture_energy, softening, johnson_cook, always: false, source };
        Self { fracture: Some(fracture), ..self }
    }

    /// Flows by strain, rate and temperature where it breaks by voids, or where a scene asks for it: A and B of a rod \[Pa\], exponent, rate
    /// from 1 / s on, softening; melting temperature \[K\] and heat capacity \[J kg^-1 K^-1\]; and where they come from.
    const fn flows(
        self,
        [a, b, exponent, rate, softening]: [f64; 5],
        [melting_temperature, heat_capacity]: [f64; 2],
        source: &'static str,
    ) -> Self {
        let (reference_rate, room_temperature, taylor_quinney) = (1.0, 293.0, 0.9);
        let flow = Flow {
            exponent,
            rate,
            reference_rate,
            softening,
            room_temperature,
            melting_temperature,
            heat_capacity,
            taylor_quinney,
        };
        Self { flow: Some(PresetFlow { rod: [a, b], flow, source }), ..self }
    }

    /// Breaks without being asked to.
    const fn breaks(self, strength: f64, energy: f64, softening: Softening, source: &'static str) -> Self {
        let fracture = PresetFracture {
            tensile_strength: strength,
            fracture_energy: energy,
            softening,
            johnson_cook: None,
            always: true,
            source,
        };
        Self { fracture: Some(fracture), ..self }
    }
}

/// The units of a preset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Units {
    /// Metres, kilograms, seconds, pascals.
    #[default]
    Si,
    /// Stresses in atmospheres, densities in that of air: air at rest has density 1 and pressure 1, as in most scenes here.
    Scaled,
}

/// One atmosphere \[Pa\].
const ATMOSPHERE: f64 = 101_325.0;
/// Air at 15 degrees and one atmosphere \[kg m^-3\]. [ISO 2533]
const AIR: f64 = 1.225;

impl Units {
    /// Pascals in a unit of stress.
    #[must_use]
    pub fn stress(self) -> f64 {
        if self == Units::Si { 1.0 } else { ATMOSPHERE }
    }

    /// Kilograms per cubic metre in a unit of density.
    #[must_use]
    pub fn density(self) -> f64 {
        if self == Units::Si { 1.0 } else { AIR }
    }
}

/// All presets. Yield stresses are norms of the deviator, sqrt(2/3) of those of a thin rod. The cohesion of a brittle material
/// follows from its compressive strength f and friction angle a: f (1 - sin a) / (2 cos a). The fracture energy of a brittle one follows from its
/// fracture toughness K: K^2 (1 - nu^2) / E. [Dowling 2013, table 8.2, unless a preset says otherwise]
#[rustfmt::skip]
pub const PRESETS: [Preset; 10] = [
    Preset::new("rubber", "neo_hookean", 1100.0, [62, 60, 66], "Natural rubber.",
        &[("young_modulus", 5e6), ("poisson_ratio", 0.45)]),
    Preset::new("steel", "von_mises", 7850.0, [150, 158, 168], "Structural steel: yields at 250 MPa in a rod, hardening 0.98 GPa.",
        &[("young_modulus", 2e11), ("poisson_ratio", 0.3), ("yield_stress", 2.04e8), ("hardening", 8e8)])
        .may_tear([0.05, 3.44, -2.12, 0.002, 0.61], 1.0e5, "voids: Johnson and Cook, Eng. Fract. Mech. 21 (1985) 31, steel 4340; K_Ic 150 MPa m^1/2")
        .flows([3.5e8, 2.75e8, 0.36, 0.022, 1.0], [1811.0, 452.0], "Johnson and Cook, 7th Int. Symp. Ballistics (1983) 541, steel 1006"),
    Preset::new("aluminium", "von_mises", 2700.0, [196, 200, 206], "Aluminium 6061-T6: yields at 276 MPa in a rod, hardening 0.49 GPa.",
        &[("young_modulus", 6.9e10), ("poisson_ratio", 0.33), ("yield_stress", 2.25e8), ("hardening", 4e8)])
        .may_tear([-0.77, 1.45, -0.47, 0.0, 1.6], 1.1e4, "voids: Lesuer, Kay, LeBlanc, UCRL-JC-134118 (1999); K_Ic 29 MPa m^1/2")
        .flows([3.24e8, 1.14e8, 0.42, 0.002, 1.34], [925.0, 885.0], "Lesuer, Kay, LeBlanc, UCRL-JC-134118 (1999)"),
    Preset::new("concrete", "drucker_prager", 2400.0, [158, 152, 142], "Concrete of a compressive strength of 30 MPa.",
        &[("young_modulus", 3e10), ("poisson_ratio", 0.2), ("friction_angle", 37.0), ("cohesion", 7.5e6)])
        .may_break(2.9e6, 76.0, Softening::Exponential, "CEB-FIP Model Code 1990, C30, aggregate of 16 mm"),
    Preset::new("brick", "drucker_prager", 1900.0, [164, 84, 62], "Solid clay brick of a compressive strength of 20 MPa.",
        &[("young_modulus", 1.67e10), ("poisson_ratio", 0.15), ("friction_angle", 37.0), ("cohesion", 5e6)])
        .may_break(2e6, 80.0, Softening::Exponential, "units of walls, Lourenco and Rots, J. Eng. Mech. 123 (1997) 660; typical compressive strength and density"),
    Preset::new("ice", "drucker_prager", 917.0, [196, 224, 240], "Ice of a compressive strength of 10 MPa.",
        &[("young_modulus", 9.3e9), ("poisson_ratio", 0.33), ("friction_angle", 45.0), ("cohesion", 2.1e6)])
        .may_break(1.43e6, 0.96, Softening::Linear, "Petrovic, J. Mater. Sci. 38 (2003) 1; K_Ic 0.1 MPa m^1/2"),
    Preset::new("soil", "drucker_prager", 1800.0, [130, 98, 68], "Moist sandy soil.",
        &[("young_modulus", 2e7), ("poisson_ratio", 0.3), ("friction_angle", 30.0), ("cohesion", 5e3)]),
    Preset::new("glass", "neo_hookean", 2500.0, [160, 208, 200], "Annealed soda-lime glass.",
        &[("young_modulus", 7e10), ("poisson_ratio", 0.22)])
        .breaks(4.5e7, 7.9, Softening::Linear, "strength in bending, EN 572-1; K_Ic 0.76 MPa m^1/2, Dowling 2013, table 8.2"),
    Preset::new("pmma", "neo_hookean", 1190.0, [206, 222, 236], "Acrylic glass.",
        &[("young_modulus", 3.3e9), ("poisson_ratio", 0.37)])
        .breaks(8e7, 850.0, Softening::Linear, "data sheet of Plexiglas GS; K_Ic 1.8 MPa m^1/2, Dowling"),
    Preset::new("ceramic", "neo_hookean", 3900.0, [238, 232, 222], "Alumina of 99.5 percent.",
        &[("young_modulus", 3.7e11), ("poisson_ratio", 0.22)])
        .breaks(2.62e8, 41.0, Softening::Linear, "data sheet of CoorsTek AD-995; K_Ic 4.0 MPa m^1/2, Dowling"),
];

impl Material {
    /// Colour in pictures, sRGB; presets alone have one.
    #[must_use]
    pub fn color(&self) -> Option<[u8; 3]> {
        self.preset.map(|(index, _)| PRESETS[index].color)
    }
}

/// The names of all kinds and presets, quoted, for messages.
#[must_use]
pub fn kind_names() -> String {
    let names = KINDS.iter().map(|kind| kind.name).chain(PRESETS.iter().map(|preset| preset.name));
    names.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}
