//! What the cells of a scene make of the fracture of its bodies.

use serde::Serialize;

use super::Scene;
use crate::material::{BAND, Fracture, Material};

/// How a body that can break will do so on this grid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Breaking {
    /// Name of the body.
    pub body: String,
    /// Width of the band over which a crack is smeared `[m]`.
    pub band: f64,
    /// Largest cell at which both strength and fracture energy hold `[m]`.
    pub coarsest_cell: f64,
    /// Strength that the run has `[Pa]`.
    pub tensile_strength: f64,
    /// Strength that is asked for `[Pa]`.
    pub asked_strength: f64,
    /// Fracture energy that the run has `[J m^-2]`.
    pub fracture_energy: f64,
    /// Fracture energy that is asked for `[J m^-2]`.
    pub asked_energy: f64,
    /// Smallest piece that can be told from rubble `[m]`.
    pub smallest_piece: f64,
    /// Strain rate below which pieces are larger than that `[s^-1]`: size^3 = 24 G / (rho rate^2). [Grady 1982]
    pub fastest_rate: f64,
    /// Thinnest extent of the body in cells.
    pub thickness: f64,
}

/// How a body of metal will break on this grid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tearing {
    /// Name of the body.
    pub body: String,
    /// Width of the band over which a crack is smeared `[m]`.
    pub band: f64,
    /// Plastic strain of a pulled rod at which voids join.
    pub strain: f64,
    /// How far it is pulled apart from then on `[m]`.
    pub opening: f64,
    /// Whether rate and temperature change how it flows.
    pub flows: bool,
}

/// Cells across the smallest piece: broken bands of two cells on either side leave nothing of smaller ones.
const SMALLEST_PIECE: f64 = 4.0;
/// Cells of a plate that is as thick as the band is wide.
const THIN: f64 = 4.0;

impl Breaking {
    /// What to warn of, if anything.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        (self.thickness < THIN).then(|| {
            format!(
                "`{}` is {:.1} cells thick: a crack is a band of {BAND} cells, so it breaks through at once instead of from one side; \
                 strength in tension holds, in bending it does not",
                self.body, self.thickness
            )
        })
    }
}

impl Tearing {
    /// What to warn of, if anything.
    #[must_use]
    pub fn warning(&self) -> Option<String> {
        (!self.flows).then(|| {
            format!(
                "`{}` breaks by voids and knows neither rate nor temperature in its flow: nothing but the cells gives a shear band its width; \
                 give its material `flow`",
                self.body
            )
        })
    }
}

impl Scene {
    /// Whether the flow stress of some metal follows strain, rate and temperature.
    #[must_use]
    pub fn flows(&self) -> bool {
        self.materials.values().any(|material| material.flow().is_some())
    }

    /// Whether some material breaks.
    #[must_use]
    pub fn breaks(&self) -> bool {
        self.materials.values().any(|material| material.fracture().is_some())
    }

    /// Whether some material drops its debris.
    #[must_use]
    pub fn drops_debris(&self) -> bool {
        self.materials.values().filter_map(Material::fracture).any(Fracture::drops_debris)
    }

    /// How the bodies that can break will do so.
    #[must_use]
    pub fn breaking(&self) -> Vec<Breaking> {
        let cell = self.domain.spacing();
        let of = |body: &super::Body| {
            let material = self.materials.get(&body.material)?;
            let fracture = material.fracture().filter(|fracture| fracture.johnson_cook.is_none())?;
            let modulus = material.lambda() + 2.0 * material.mu();
            let [tensile_strength, fracture_energy] = fracture.at_cell(modulus, cell);
            let (low, high) = body.shape.bounds();
            let extents = (0..self.domain.axes()).map(|axis| (high[axis] - low[axis]) / cell);
            let smallest_piece = SMALLEST_PIECE * cell;
            Some(Breaking {
                body: body.name.clone(),
                band: BAND * cell,
                coarsest_cell: fracture.coarsest_cell(modulus),
                tensile_strength,
                asked_strength: fracture.tensile_strength,
                fracture_energy,
                asked_energy: fracture.fracture_energy,
                smallest_piece,
                fastest_rate: (24.0 * fracture_energy / (self.density_of(body)? * smallest_piece.powi(3))).sqrt(),
                thickness: extents.fold(f64::INFINITY, f64::min),
            })
        };
        self.bodies.iter().filter_map(of).collect()
    }

    /// How the bodies of metal that can break will do so.
    #[must_use]
    pub fn tearing(&self) -> Vec<Tearing> {
        let of = |body: &super::Body| {
            let material = self.materials.get(&body.material)?;
            let fracture = material.fracture()?;
            Some(Tearing {
                body: body.name.clone(),
                band: BAND * self.domain.spacing(),
                strain: fracture.johnson_cook?.strain_of_a_rod(),
                opening: material.tearing(fracture),
                flows: material.flow().is_some(),
            })
        };
        self.bodies.iter().filter_map(of).collect()
    }
}
