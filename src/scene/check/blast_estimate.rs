//! What charges do at probes and bodies by the curves of Kingery and Bulmash, and how finely the grid sees them.

use serde::Serialize;

use crate::explosive::kingery_bulmash::{Blast, Burst, blast};
use crate::scene::{Body, Charge, Placed, Probe, Scene};

/// Part of a ball that counts as half of one.
const HALF: [f64; 2] = [0.4, 0.6];
/// Cells between a charge and a place with which the peak there is low by less than a fifth: 16 % along an axis of the grid, 5 % along a
/// diagonal [docs/notes/charges.md].
const CELLS_TO_PLACE: f64 = 60.0;

/// A charge on the grid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChargeEstimate {
    /// Its name.
    pub charge: String,
    /// Mass of TNT that gives the same blast, of what the curves take: a ball in free air, or half of one on the ground \[kg\].
    pub tnt: f64,
    /// Whether the curves are those of a charge on the ground.
    pub on_ground: bool,
    /// Its radius \[m\], and in cells.
    pub radius: f64,
    /// \[cells\]
    pub radius_cells: f64,
    /// Radius of the near field that is computed apart \[cells\].
    pub reach_cells: f64,
    /// What it does at the probes and bodies.
    pub places: Vec<PlaceEstimate>,
}

/// What a charge does at a place, were nothing in the way.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlaceEstimate {
    /// Name of the probe or body.
    pub place: String,
    /// Distance from the middle of the charge; of a body, to its nearest point \[m\].
    pub distance: f64,
    /// Over the cube root of the mass of TNT \[m kg^(-1/3)\].
    pub scaled_distance: f64,
    /// Arrival \[s\], overpressure \[Pa\] and impulse \[Pa s\] of the wave; none outside of the curves.
    pub wave: Option<[f64; 3]>,
    /// Edge of a cell that would be fine enough \[m\].
    pub fine_cell: f64,
}

impl Scene {
    /// The charges of a scene in space; the curves are for balls.
    #[must_use]
    pub fn charge_estimates(&self) -> Vec<ChargeEstimate> {
        let space = self.domain.dimension == 3;
        let estimate = |charge: &Charge| Some(self.charge_estimate(charge, charge.ball()?, &self.placed(charge)?));
        self.charges.iter().filter(|_| space).filter_map(estimate).collect()
    }

    fn charge_estimate(&self, charge: &Charge, (own, center): (f64, [f64; 3]), placed: &Placed) -> ChargeEstimate {
        let on_ground = (HALF[0]..HALF[1]).contains(&placed.share);
        // what two or three walls cut off makes a part of a ball in free air
        let mass = if on_ground { own } else { placed.ball.mass };
        let tnt = mass * placed.ball.explosive.tnt_equivalent;
        let burst = if on_ground { Burst::Surface } else { Burst::Air };
        let place = |(place, distance): (String, f64)| {
            let wave = |found: Blast| [charge.time + found.arrival, found.overpressure, found.impulse];
            PlaceEstimate {
                place,
                distance,
                scaled_distance: distance / tnt.cbrt(),
                wave: blast(burst, tnt, distance).map(wave),
                fine_cell: distance / CELLS_TO_PLACE,
            }
        };
        let cell = self.domain.spacing();
        ChargeEstimate {
            charge: charge.name.clone(),
            tnt,
            on_ground,
            radius: placed.ball.radius(),
            radius_cells: placed.ball.radius() / cell,
            reach_cells: placed.reach / cell,
            places: self.places_around(center).into_iter().map(place).collect(),
        }
    }

    /// Probes and bodies with their distances from a charge.
    fn places_around(&self, center: [f64; 3]) -> Vec<(String, f64)> {
        let probe = |probe: &Probe| {
            let arm = probe.position.iter().zip(center).map(|(a, b)| (a - b).powi(2));
            (probe.name.clone(), arm.sum::<f64>().sqrt())
        };
        let body = |body: &Body| (body.name.clone(), body.shape.distance(center));
        let places = self.probes.iter().map(probe).chain(self.bodies.iter().map(body));
        places.filter(|(_, distance)| *distance > 0.0).collect()
    }
}
