//! What lies beyond the sides of the domain: one table of rules, and the rule of every slot of the ring.

use bytemuck::{Pod, Zeroable};

use super::{Grid, constants};
use crate::scene::{Boundary, GasState, InletRule, MAX_REMEMBERED, Remembered, Scene, TimedState};
use crate::structure::structure;
use crate::structure::types::{vec3f, vec4f};

/// Rules that the table has room for: those of the scene, then the states that outlets remember.
pub const MAX_OPENINGS: usize = crate::scene::MAX_OPENINGS + MAX_REMEMBERED;

structure! {
    /// What lies beyond a part of a side: one rule.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
    pub Opening as "Opening" {
        /// Density \[kg m^-3\] and momentum \[kg m^-2 s^-1\] of the state beyond; total density of a reservoir.
        flow: vec4f,
        /// Total energy per volume of that state \[J m^-3\].
        energy: f32,
        /// Pressure of that state, far or total pressure \[Pa\].
        pressure: f32,
        /// What is prescribed, `RULE_*` of [`constants::RULES`].
        rule: u32,
        /// Attenuation \[1\], or relaxation over the length of the domain \[m^-1\].
        share: f32,
        /// First knot of the table of times.
        first: u32,
        /// Knots of the table of times, 0 for a constant state.
        knots: u32,
        /// Density of the second gas in that state \[kg m^-3\].
        species_density: f32,
        /// Its volume fraction \[1\].
        species_volume: f32,
    }
}

structure! {
    /// One entry of a table of times.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
    pub Knot as "Knot" {
        /// Velocity \[m s^-1\].
        velocity: vec3f,
        /// When \[s\].
        time: f32,
        /// Density \[kg m^-3\].
        density: f32,
        /// Pressure \[Pa\].
        pressure: f32,
        /// Fills the last 16 bytes.
        unused: [u32; 2],
    }
}

/// The table of a scene.
#[derive(Clone, Debug, Default)]
pub struct Openings {
    /// Rules of all sides that let gas through.
    pub table: Vec<Opening>,
    /// Tables of times, one after the other.
    pub knots: Vec<Knot>,
    /// Rules of the scene: the first of the table. The others are far fields of the states that outlets remember.
    pub named: usize,
    /// For each side and each of its rules, what lies beyond.
    places: [Vec<Place>; 6],
    /// What outlets remember.
    remembered: Remembered,
}

/// Where the rule of a face stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    /// Nowhere: a wall.
    Closed,
    /// In the table.
    Rule(u32),
    /// Among the states that outlets remember.
    Remembered,
}

impl Openings {
    /// The rules of a scene.
    pub fn new(scene: &Scene) -> Openings {
        let mut openings = Openings::default();
        for (index, side) in scene.boundary.sides().into_iter().enumerate() {
            for rule in side.rules() {
                let place = openings.add(scene, rule, scene.domain.size[index / 2]);
                openings.places[index].push(place);
            }
        }
        openings.named = openings.table.len();
        openings.remembered = scene.remembered();
        let far = openings.remembered.states.iter().map(|state| of_state(scene, "FAR", state));
        openings.table.extend(far.take(MAX_REMEMBERED));
        openings
    }

    /// The part of the table that follows the rules of the scene. What outlets remember is of the start, and stays.
    pub fn of_rules(&self) -> &[Opening] {
        &self.table[..self.named]
    }

    /// How many knots the tables of times of a scene have.
    pub fn knots_of(scene: &Scene) -> u64 {
        let knots = |rule: &Boundary| if let Boundary::TimedInlet(inlet) = rule { inlet.table.len() } else { 0 };
        scene.boundary.sides().into_iter().flat_map(Boundary::rules).map(knots).sum::<usize>() as u64
    }

    /// Puts a rule into the table.
    fn add(&mut self, scene: &Scene, rule: &Boundary, length: f64) -> Place {
        let of_state = |name: &str, state: &GasState| of_state(scene, name, state);
        let mass_fraction = rule.mass_fraction();
        let still = |density: f64, pressure: f64| GasState { density, velocity: [0.0; 3], pressure, mass_fraction };
        let mut opening = match rule {
            Boundary::Wall | Boundary::Periodic | Boundary::Patched(_) => return Place::Closed,
            Boundary::Outlet => return Place::Remembered,
            Boundary::Inlet(state) => of_state("FIXED", state),
            Boundary::SubsonicInlet(inflow) => {
                let state =
                    GasState { density: inflow.density, velocity: inflow.velocity, pressure: 0.0, mass_fraction };
                of_state("SUBSONIC", &state)
            }
            Boundary::TotalInlet(total) => of_state("TOTAL", &still(total.density, total.pressure)),
            Boundary::PressureOutlet(outlet) => of_state("PRESSURE", &still(1.0, outlet.pressure)),
            Boundary::AttenuatedOutlet(outlet) => {
                let (density, velocity, pressure) = (outlet.density, outlet.velocity, outlet.pressure);
                of_state("ATTENUATED", &GasState { density, velocity, pressure, mass_fraction })
            }
            Boundary::FarField(state) => of_state("FAR", state),
            Boundary::TimedInlet(inlet) => {
                let name = match inlet.rule {
                    InletRule::Fixed => "FIXED",
                    InletRule::Subsonic => "SUBSONIC",
                    InletRule::Total => "TOTAL",
                };
                let first = self.knots.len() as u32;
                self.knots.extend(inlet.table.iter().map(knot));
                let start = inlet.table.first().map_or(still(1.0, 1.0), |state| GasState {
                    density: state.density,
                    velocity: state.velocity,
                    pressure: state.pressure,
                    mass_fraction,
                });
                Opening { first, knots: inlet.table.len() as u32, ..of_state(name, &start) }
            }
        };
        match rule {
            Boundary::AttenuatedOutlet(outlet) => opening.share = outlet.attenuation as f32,
            Boundary::PressureOutlet(outlet) => opening.share = (outlet.relaxation / length) as f32,
            _ => {}
        }
        self.table.push(opening);
        Place::Rule(self.table.len() as u32 - 1)
    }

    /// Word of a slot outside of the domain: WALL behind any wall, else GHOST with the place of its rule. Behind two sides a
    /// prescribed state comes first. Slots beyond periodic sides are never read.
    pub fn word(&self, scene: &Scene, grid: &Grid, cell: [i32; 3]) -> u32 {
        let inside: [u32; 3] = std::array::from_fn(|d| cell[d].clamp(0, grid.cells[d] as i32 - 1) as u32);
        let behind = (0..grid.dimension as usize).filter(|&d| cell[d] != inside[d] as i32);
        let places = behind.map(|axis| {
            let side = 2 * axis + usize::from(cell[axis] >= 0);
            let rule = scene.boundary.sides()[side].rule_at(scene.domain.face_center(side, inside));
            match self.places[side][rule] {
                Place::Closed => None,
                Place::Rule(place) => Some(place),
                Place::Remembered => {
                    let state = self.remembered.place(&scene.gas_beyond(side, inside));
                    state.map(|place| (self.named + place) as u32)
                }
            }
        });
        let Some(places) = places.collect::<Option<Vec<u32>>>() else { return constants::WALL };
        let prescribed =
            |place: &&u32| self.table[**place as usize].rule <= constants::number(&constants::RULES, "SUBSONIC");
        let place = places.iter().find(prescribed).or(places.first());
        place.map_or(constants::WALL, |place| constants::GHOST | (place << constants::RULE_SHIFT))
    }

    /// Rules in the table, as bits: those of prescribed gas and far fields, or all, so that many scenes share their kernels.
    pub fn rules_used(&self) -> u32 {
        let used = self.table.iter().fold(0, |used, opening| used | 1 << opening.rule);
        let [fixed, far] = ["FIXED", "FAR"].map(|name| 1 << constants::number(&constants::RULES, name));
        [0, fixed | far].into_iter().find(|set| used & !set == 0).unwrap_or((1 << constants::RULES.len()) - 1)
    }

    /// The table with the length that the device expects.
    pub fn padded(&self) -> Vec<Opening> {
        let mut table = self.table.clone();
        table.resize(MAX_OPENINGS, Opening::default());
        table
    }
}

fn of_state(scene: &Scene, name: &str, state: &GasState) -> Opening {
    let gases = scene.gas.equation_of_state();
    let [density, x, y, z, energy, species_density, species_volume] = gases.conserved(state).map(|v| v as f32);
    let flow = [density, x, y, z];
    Opening {
        flow,
        energy,
        pressure: gases.pressure_in_single(state),
        species_density,
        species_volume,
        rule: constants::number(&constants::RULES, name),
        ..Opening::default()
    }
}

fn knot(state: &TimedState) -> Knot {
    Knot {
        velocity: state.velocity.map(|v| v as f32),
        time: state.time as f32,
        density: state.density as f32,
        pressure: state.pressure as f32,
        unused: [0; 2],
    }
}
