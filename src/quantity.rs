//! The table of quantities: what pictures, files and tables show, by name, symbol, unit and caption, and how it is computed. [`TABLE`] has those of
//! cells and particles; those of wholes (bodies, pieces, loads, points, probes, steps) follow.

mod columns;
mod wholes;

use rayon::prelude::*;

use crate::snapshot::{ParticleSample, Snapshot, kind};
pub use columns::{Columns, Entry, label, letters, names, row};
pub use wholes::{BODY, LOAD, PIECE, POINT, PROBE, STEP, WAVE, pages};

/// What a quantity belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Each cell of the domain.
    Cell,
    /// Each particle of a body.
    Particle,
}

/// The values of a quantity, element by element.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Numbers; in cells without gas 0.
    Real(Vec<f32>),
    /// Counts, indices and kinds.
    Whole(Vec<u32>),
}

/// A line of the table.
#[derive(Clone, Copy, Debug)]
pub struct Quantity {
    /// Its name in files.
    pub name: &'static str,
    /// Its symbol in equations.
    pub symbol: &'static str,
    /// Unit; of quantities without dimension `1`.
    pub unit: &'static str,
    /// Its name and unit in pictures, or what it means.
    pub caption: &'static str,
    /// What it belongs to.
    pub place: Place,
    /// Numbers of each element.
    pub components: usize,
    compute: fn(&Snapshot) -> Values,
}

impl Quantity {
    /// Its values in a state.
    #[must_use]
    pub fn of(&self, snapshot: &Snapshot) -> Values {
        (self.compute)(snapshot)
    }

    /// What files say of it: caption, symbol and unit.
    #[must_use]
    pub fn about(&self) -> String {
        format!("{}, symbol {}, unit {}", self.caption, self.symbol, self.unit)
    }
}

const fn quantity(
    place: Place,
    [name, symbol]: [&'static str; 2],
    unit: &'static str,
    caption: &'static str,
    components: usize,
    compute: fn(&Snapshot) -> Values,
) -> Quantity {
    Quantity { name, symbol, unit, caption, place, components, compute }
}

/// All quantities. Inside bodies and obstacles, values of the gas are 0, and `kind` says where that is.
#[rustfmt::skip]
pub const TABLE: &[Quantity] = &[
    quantity(Place::Cell, ["density", "rho"], "kg m^-3", "density [kg/m\u{b3}]", 1, |s| gas(s, |i| [s.density[i]])),
    quantity(Place::Cell, ["pressure", "p"], "Pa", "pressure [Pa]", 1, |s| gas(s, |i| [s.pressure[i]])),
    quantity(Place::Cell, ["velocity", "u"], "m s^-1", "speed [m/s]", 3, |s| gas(s, |i| s.velocity[i])),
    quantity(Place::Cell, ["energy", "E"], "J m^-3", "total energy [J/m\u{b3}]", 1, |s| gas(s, |i| [s.energy[i]])),
    quantity(Place::Cell, ["temperature", "R T"], "m^2 s^-2", "p/rho [m\u{b2}/s\u{b2}]", 1, |s| gas(s, |i| [s.thermal_energy_at(i)])),
    quantity(Place::Cell, ["mach", "M"], "1", "Mach number", 1, |s| gas(s, |i| [mach(s, i)])),
    quantity(Place::Cell, ["schlieren", "|grad rho|"], "kg m^-4", "density gradient [kg/m\u{2074}]", 1, |s| gas(s, |i| [length(gradient(s, i, |j| s.density[j]))])),
    quantity(Place::Cell, ["vorticity", "curl u"], "s^-1", "vorticity [1/s]", 3, |s| gas(s, |i| vorticity(s, i))),
    quantity(Place::Cell, ["entropy", "p / rho^gamma"], "Pa (m^3 kg^-1)^gamma", "p/rho^gamma", 1, |s| gas(s, |i| [s.pressure[i] * s.density[i].powf(-s.gamma_at(i) as f32)])),
    quantity(Place::Cell, ["mass_fraction", "Y"], "1", "mass fraction of the second gas", 1, |s| gas(s, |i| [s.mass_fraction_at(i)])),
    quantity(Place::Cell, ["volume_fraction", "phi"], "1", "volume fraction of the second gas", 1, |s| gas(s, |i| [s.species.get(i).map_or(0.0, |own| own[1])])),
    quantity(Place::Cell, ["soot", "kappa"], "m^-1", "extinction by soot [1/m]", 1, |s| gas(s, |i| [s.fire.soot(second(s, i)) as f32])),
    quantity(Place::Cell, ["flames", "j"], "m^-1", "light of hot gas over that of white paper [1/m]", 1, |s| gas(s, |i| [s.fire.light(second(s, i), s.thermal_energy_at(i).into()) as f32])),
    quantity(Place::Cell, ["dust", "rho_d"], "kg m^-3", "dust [kg/m\u{b3}]", 1, |s| gas(s, |i| [s.dust.get(i).copied().unwrap_or(0.0)])),
    quantity(Place::Cell, ["owed", "rho_owed"], "kg m^-3", "owed gas [kg/m\u{b3}]", 1, |s| Values::Real(s.owed.clone())),
    quantity(Place::Cell, ["peak_pressure", "p_max"], "Pa", "largest pressure so far [Pa]", 1, |s| map(s, 0)),
    quantity(Place::Cell, ["impulse", "I"], "Pa s", "impulse so far [Pa s]", 1, |s| map(s, 1)),
    quantity(Place::Cell, ["peak_plastic_strain", "eps_p,max"], "1", "largest plastic strain so far", 1, |s| map(s, 2)),
    quantity(Place::Cell, ["kind", "k"], "1", "0 gas, 1 solid, 2 wall, 3 beyond an open side", 1, |s| Values::Whole(s.kind.iter().map(|kind| u32::from(*kind)).collect())),
    quantity(Place::Particle, ["velocity", "v"], "m s^-1", "speed of solids [m/s]", 3, |s| each(s, |p| p.velocity)),
    quantity(Place::Particle, ["mass", "m"], "kg", "mass [kg]", 1, |s| each(s, |p| [p.mass])),
    quantity(Place::Particle, ["volume", "V"], "m^3", "volume [m\u{b3}]", 1, |s| each(s, |p| [p.volume0 * p.volume_ratio()])),
    quantity(Place::Particle, ["ghost_pressure", "q"], "Pa", "ghost pressure [Pa]", 1, |s| each(s, |p| [p.ghost_pressure])),
    quantity(Place::Particle, ["plastic_strain", "eps_p"], "1", "plastic strain", 1, |s| each(s, |p| [p.plastic_strain])),
    quantity(Place::Particle, ["damage", "d"], "1", "damage", 1, |s| each(s, |p| [p.damage])),
    quantity(Place::Particle, ["J", "J"], "1", "volume over volume at rest", 1, |s| each(s, |p| [p.volume_ratio()])),
    quantity(Place::Particle, ["deviatoric_stress", "sigma_vM"], "Pa", "deviatoric stress [Pa]", 1, |s| each(s, |p| [p.deviatoric_stress()])),
    quantity(Place::Particle, ["stress", "sigma"], "Pa", "Cauchy stress xx, yy, zz, xy, yz, zx [Pa]", 6, |s| each(s, |p| p.stress)),
    quantity(Place::Particle, ["body", "b"], "1", "index of the body in the scene", 1, |s| whole(s, |p| p.body)),
    quantity(Place::Particle, ["material", "a"], "1", "index of the material in the scene", 1, |s| whole(s, |p| p.material)),
    quantity(Place::Particle, ["id", "i"], "1", "number among the particles of the start", 1, |s| whole(s, |p| p.index)),
    quantity(Place::Particle, ["piece", "c"], "1", "smallest id in the piece", 1, |s| Values::Whole(s.piece_of_each())),
];

impl Snapshot {
    /// Values of a quantity in each cell, x fastest, by its name in [`TABLE`]: `mach`, `schlieren`; nothing if there is none of that name, or
    /// if it is a map and the scene keeps none.
    #[must_use]
    pub fn cell_field(&self, name: &str) -> Option<Values> {
        Some(all(self, Place::Cell).find(|quantity| quantity.name == name)?.of(self))
    }

    /// Values of a quantity of each particle, in the order of [`Snapshot::particles`], by its name in [`TABLE`].
    #[must_use]
    pub fn particle_field(&self, name: &str) -> Option<Values> {
        Some(find(Place::Particle, name)?.of(self))
    }
}

/// The quantity of a name, of cells or of particles.
#[must_use]
pub fn find(place: Place, name: &str) -> Option<&'static Quantity> {
    TABLE.iter().find(|quantity| quantity.place == place && quantity.name == name)
}

/// All quantities of cells or of particles that a state has: maps only where they were kept, fractions where there are two gases, dust where the
/// scene has some, soot and flames where pictures have them.
pub fn all(snapshot: &Snapshot, place: Place) -> impl Iterator<Item = &'static Quantity> {
    let (kept, mixed, fire) = (!snapshot.maps.is_empty(), !snapshot.species.is_empty(), snapshot.fire);
    let dusty = !snapshot.dust.is_empty();
    let has = move |name: &str| match name {
        SOOT => fire.extinction.is_some(),
        FLAMES => fire.emission.is_some(),
        DUST => dusty,
        _ => (kept || !MAPS.contains(&name)) && (mixed || !FRACTIONS.contains(&name)),
    };
    TABLE.iter().filter(move |quantity| quantity.place == place && has(quantity.name))
}

/// Elements that one thread takes at least.
const LEAST: usize = 1 << 12;
/// Quantities of scenes with two gases.
const FRACTIONS: [&str; 2] = ["mass_fraction", "volume_fraction"];
/// What absorbs light, and what shines.
const SOOT: &str = "soot";
const FLAMES: &str = "flames";
/// What the gas takes along from the ground.
const DUST: &str = "dust";
/// Quantities of what has been so far.
const MAPS: [&str; 3] = ["peak_pressure", "impulse", "peak_plastic_strain"];

/// A map; zeros where none was kept.
fn map(snapshot: &Snapshot, number: usize) -> Values {
    let own = snapshot.maps.iter().map(|map| map[number]);
    Values::Real(if snapshot.maps.is_empty() { vec![0.0; snapshot.kind.len()] } else { own.collect() })
}

fn gas<const N: usize>(snapshot: &Snapshot, value: impl Fn(usize) -> [f32; N] + Send + Sync) -> Values {
    let own = |(i, cell): (usize, &u8)| if *cell == kind::GAS { value(i) } else { [0.0; N] };
    let all: Vec<[f32; N]> = snapshot.kind.par_iter().with_min_len(LEAST).enumerate().map(own).collect();
    Values::Real(all.into_flattened())
}

fn each<const N: usize>(snapshot: &Snapshot, value: impl Fn(&ParticleSample) -> [f32; N] + Send + Sync) -> Values {
    let all: Vec<[f32; N]> = snapshot.particles.par_iter().with_min_len(LEAST).map(value).collect();
    Values::Real(all.into_flattened())
}

fn whole(snapshot: &Snapshot, value: impl Fn(&ParticleSample) -> u32) -> Values {
    Values::Whole(snapshot.particles.iter().map(value).collect())
}

fn length([x, y, z]: [f32; 3]) -> f32 {
    (x * x + y * y + z * z).sqrt()
}

/// Density of the second gas \[kg m^-3\].
fn second(snapshot: &Snapshot, i: usize) -> f64 {
    f64::from(snapshot.density[i]) * f64::from(snapshot.mass_fraction_at(i))
}

fn mach(snapshot: &Snapshot, i: usize) -> f32 {
    length(snapshot.velocity[i]) / snapshot.sound_speed_at(i) as f32
}

/// Central difference along each axis; beside cells without gas, and at the edge, that to the one side.
fn gradient(snapshot: &Snapshot, i: usize, value: impl Fn(usize) -> f32) -> [f32; 3] {
    neighbours(snapshot, i).map(|near| difference(snapshot, near, &value))
}

fn difference(snapshot: &Snapshot, [low, high, span]: [usize; 3], value: impl Fn(usize) -> f32) -> f32 {
    if span == 0 { 0.0 } else { (value(high) - value(low)) / (span as f32 * snapshot.grid.spacing) }
}

/// Along each axis the cells between which a difference is taken, and how many cells they are apart.
fn neighbours(snapshot: &Snapshot, i: usize) -> [[usize; 3]; 3] {
    let grid = &snapshot.grid;
    // quotients of 32 bits take half the time of longer ones
    let [wide, high, _] = grid.cells;
    let (row, plane) = (i as u32 / wide, i as u32 / wide / high);
    let places = [i as u32 - row * wide, row - plane * high, plane];
    let steps = [1, wide as usize, wide as usize * high as usize];
    std::array::from_fn(|axis| {
        let (step, cells, at) = (steps[axis], grid.cells[axis], places[axis]);
        let open = |near: bool, j: usize| if near && snapshot.kind[j] == kind::GAS { j } else { i };
        let low = open(at > 0, i.wrapping_sub(step));
        let high = open(at + 1 < cells, i + step);
        [low, high, (high - low) / step]
    })
}

fn vorticity(snapshot: &Snapshot, i: usize) -> [f32; 3] {
    let near = neighbours(snapshot, i);
    let of = |component: usize| near.map(|near| difference(snapshot, near, |j| snapshot.velocity[j][component]));
    let [u, v, w] = [of(0), of(1), of(2)];
    [w[1] - v[2], u[2] - w[0], v[0] - u[1]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Grid;

    /// Gas that turns as a rigid body about z, with a density that rises along x; the middle cell is solid.
    fn turning() -> Snapshot {
        let grid = Grid { dimension: 2, cells: [5, 5, 1], frame: [0.0; 3], origin: [0.0; 3], spacing: 0.5 };
        let at = |i: usize| grid.centre([(i % 5) as i32, (i / 5) as i32, 0]);
        let mut kinds = vec![kind::GAS; 25];
        kinds[12] = kind::SOLID;
        let velocity = (0..25).map(|i| [-3.0 * at(i)[1], 3.0 * at(i)[0], 0.0]).collect();
        let density = (0..25).map(|i| 1.0 + 2.0 * at(i)[0]).collect();
        let (pressure, energy) = (vec![1.0; 25], vec![2.5; 25]);
        Snapshot {
            time: 0.0,
            step: 0,
            grid,
            gases: crate::scene::EquationOfState { gamma: 1.4, species: None },
            fire: crate::scene::Fire::default(),
            laws: crate::material::Laws::default(),
            species: Vec::new(),
            kind: kinds,
            density,
            velocity,
            pressure,
            energy,
            owed: vec![0.0; 25],
            maps: Vec::new(),
            dust: Vec::new(),
            particles: Vec::new(),
        }
    }

    #[test]
    fn names_are_unique_and_values_complete() {
        let state = turning();
        for (k, quantity) in TABLE.iter().enumerate() {
            assert!(!TABLE[..k].iter().any(|other| (other.place, other.name) == (quantity.place, quantity.name)));
            let count = if quantity.place == Place::Cell { 25 } else { 0 };
            let length = match quantity.of(&state) {
                Values::Real(values) => values.len(),
                Values::Whole(values) => values.len(),
            };
            assert_eq!(length, count * quantity.components, "{}", quantity.name);
        }
    }

    #[test]
    fn soot_absorbs_and_shines_where_it_is_hot() {
        let mut state = turning();
        let names = |state: &Snapshot| all(state, Place::Cell).map(|own| own.name).collect::<Vec<_>>();
        assert!(!names(&state).contains(&"soot") && !names(&state).contains(&"flames"));
        state.species = vec![[0.25, 0.5, 0.0]; 25];
        // 1900 K at a pressure over density of 1, which cell 0 has, half of that in cell 1, and cold soot in cell 2
        state.fire = crate::scene::Fire { extinction: Some(8.0), emission: Some([1900.0, 3.0, 5.0]) };
        for (i, heat) in [(0, 1.0), (1, 0.5), (2, 0.2)] {
            (state.density[i], state.pressure[i]) = (2.0, 2.0 * heat);
        }
        let real = |state: &Snapshot, name: &str| match state.cell_field(name) {
            Some(Values::Real(values)) => values,
            _ => Vec::new(),
        };
        assert_eq!((real(&state, "soot")[0], real(&state, "soot")[12]), (4.0, 0.0));
        let flames = real(&state, "flames");
        // what is as bright as white paper is opaque to 1050 of 1750 parts, what has 950 K to 100
        assert!((flames[0] - 3.0 * 0.6 * 4.0).abs() < 1e-5, "{}", flames[0]);
        assert!((flames[1] - 3.0 / 16.0 * 100.0 / 1750.0 * 4.0).abs() < 1e-6, "{}", flames[1]);
        assert_eq!((flames[2], flames[12]), (0.0, 0.0));
        state.fire.extinction = None;
        assert!((real(&state, "flames")[0] - 3.0 * 0.6 * 5.0).abs() < 1e-5 && real(&state, "soot").is_empty());
    }

    #[test]
    fn gradients_are_exact_for_linear_fields() {
        let state = turning();
        let real = |name: &str| match find(Place::Cell, name).unwrap().of(&state) {
            Values::Real(values) => values,
            Values::Whole(_) => Vec::new(),
        };
        let (schlieren, vorticity) = (real("schlieren"), real("vorticity"));
        for i in (0..25).filter(|i| *i != 12) {
            assert!((schlieren[i] - 2.0).abs() < 1e-5 && (vorticity[3 * i + 2] - 6.0).abs() < 1e-5, "cell {i}");
        }
        assert_eq!((schlieren[12], vorticity[38]), (0.0, 0.0));
    }
}
