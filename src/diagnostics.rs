//! Totals, extremes and solver history of each step.

mod point;

use serde::{Deserialize, Serialize};

pub use point::PointRecord;

/// What a probe sees after a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProbeRecord {
    /// Density \[kg m^-3\].
    pub density: f32,
    /// Velocity \[m s^-1\].
    pub velocity: [f32; 3],
    /// Pressure \[Pa\].
    pub pressure: f32,
    /// Kind of the cell: 0 gas, 1 solid, 2 wall.
    pub kind: u8,
}

/// What the gas does to a body or an obstacle in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Load {
    /// Force, mean of the step \[N\].
    pub force: [f32; 3],
    /// Its power \[W\].
    pub power: f32,
    /// Its moment about the zero of the device's coordinates \[N m\].
    pub moment: [f32; 3],
    /// Mean pressure over the faces that gas touches \[Pa\]; no number where it touches none.
    pub pressure: f32,
    /// Their area \[m^2\].
    pub area: f32,
}

/// What a body, an obstacle or a wall has borne.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Borne {
    /// Force, mean since the last row \[N\].
    pub force: [f64; 3],
    /// Its moment \[N m\].
    pub moment: [f64; 3],
    /// Mean pressure over the faces that gas touches \[Pa\]; no number where it touches none.
    pub pressure: f64,
    /// Impulse since the start \[kg m s^-1\].
    pub impulse: [f64; 3],
    /// Work since the start \[J\].
    pub work: f64,
}

impl Load {
    /// The load of a step, its moment about a point of the device's coordinates \[m\], with the impulse since the start.
    #[must_use]
    pub fn borne(&self, about: [f64; 3], impulse: [f64; 3]) -> Borne {
        let force = glam::DVec3::from(self.force.map(f64::from));
        let moment = glam::DVec3::from(self.moment.map(f64::from)) - glam::DVec3::from(about).cross(force);
        let (force, moment, pressure) = (force.into(), moment.into(), self.pressure.into());
        Borne { force, moment, pressure, impulse, work: 0.0 }
    }

    /// From the vec4 entries of its history ring, see `load_record` in `shaders/step/loads.wgsl`; moments there are about `corner`.
    pub(crate) fn from_raw(raw: &[[f32; 4]], corner: [f32; 3]) -> Vec<Self> {
        let load = |raw: &[[f32; 4]]| {
            let [[x, y, z, power], [a, b, c, pressed], [area, ..]] = [raw[0], raw[1], raw[2]];
            let moment = glam::Vec3::new(a, b, c) + glam::Vec3::from(corner).cross(glam::Vec3::new(x, y, z));
            Self { force: [x, y, z], power, moment: moment.into(), pressure: pressed / area, area }
        };
        raw.chunks_exact(3).map(load).collect()
    }
}

/// Mass, momentum and energy of a part of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Total {
    /// \[kg\]
    pub mass: f32,
    /// \[kg m s^-1\]
    pub momentum: [f32; 3],
    /// \[J\]
    pub energy: f32,
}

/// One step, as the device recorded it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepRecord {
    /// Number, from 1.
    pub step: u32,
    /// Time at the end of the step \[s\].
    pub time: f64,
    /// Length \[s\].
    pub dt: f32,
    /// Gas in gas cells.
    pub gas: Total,
    /// Gas owed: under bodies, and not yet given back.
    pub owed: Total,
    /// Gas, impulse and work that have left through the boundary since the start.
    pub crossed: Total,
    /// Solids: mass and momentum; `energy` is kinetic, that of the affine motion around each particle included.
    pub solid: Total,
    /// Elastic energy \[J\].
    pub elastic_energy: f32,
    /// Energy of the ghost pressure \[J\].
    pub ghost_energy: f32,
    /// Heat of plastic flow since the start, in the particles that are still there \[J\]; that of damaged ones is in `fracture_energy`.
    pub plastic_heat: f32,
    /// Energy that cracks have taken since the start, with the heat of plastic flow of what is damaged \[J\].
    pub fracture_energy: f32,
    /// Mass of the particles that have broken and are still there \[kg\].
    pub broken_mass: f32,
    /// Mass of the broken particles that were taken out since the start (`debris = "drop"`) \[kg\].
    #[serde(default)]
    pub dropped_mass: f32,
    /// Mass of the second gas, what is owed included, and what of it has left since the start \[kg\].
    #[serde(default)]
    pub species_mass: [f32; 2],
    /// Mass of dust: in the gas and in bodies, on the ground, and what has left since the start \[kg\].
    #[serde(default)]
    pub dust_mass: [f32; 3],
    /// Momentum and energy that walls, gas films at walls and gravity have given to the bodies since the start, the energy of blasts, and what
    /// charges have given to the gas, their mass among it. What clamped and driven parts give is not in it.
    pub given: Total,
    /// Conjugate gradient iterations.
    pub iterations: u32,
    /// Relative residual of the solve.
    pub residual: f32,
    /// Elastic sub-steps.
    pub substeps: u32,
    /// Rounds of Newton's method in the implicit elastic step; the last one finds balance.
    pub rounds: u32,
    /// Conjugate gradient iterations of all rounds.
    pub elastic_iterations: u32,
    /// The same of the longest round.
    pub longest_round: u32,
    /// Vertices with P, h and Q apart.
    pub extra: u32,
    /// Smallest and largest gas density \[kg m^-3\].
    pub density: [f32; 2],
    /// Smallest and largest gas pressure \[Pa\].
    pub pressure: [f32; 2],
    /// Largest gas speed \[m s^-1\].
    pub gas_speed: f32,
    /// Acoustic Courant number: largest speed of sound in cells per step.
    pub courant: f32,
    /// Largest particle speed \[m s^-1\].
    pub solid_speed: f32,
    /// Kinetic energy of the gas \[J\].
    pub gas_kinetic: f32,
    /// Mass that cells owe or have too much of, whatever its sign \[kg\].
    pub owed_either: f32,
    /// Elastic energy and heat in what has left the domain or was dropped since the start \[J\].
    pub gone_energy: f32,
    /// Least p / rho^gamma of the gas \[Pa (m^3/kg)^gamma\].
    pub min_entropy: f32,
    /// Slot where it is.
    pub coldest_slot: u32,
    /// Cells where the flux limiter acted, and vertices whose gas could not pay for all that they asked.
    pub limited: u32,
    /// Cells where the energy floor acted.
    pub floored: u32,
    /// Cells whose pressure had to be raised before one of two solves (`numerics.integrator = "ars222"`).
    pub raised: u32,
    /// Cells whose products were denser than the law of their explosive allows: it was taken at its limit there.
    #[serde(default)]
    pub dense: u32,
    /// Particles held back at a wall.
    pub clamped: u32,
    /// Loads of the gas: on each body, if one of them is held or driven or has a gauge, then on each obstacle, then on the walls of each
    /// side that has a gauge.
    pub loads: Vec<Load>,
    /// Probes.
    pub probes: Vec<ProbeRecord>,
    /// Points of bodies that have gauges.
    #[serde(default)]
    pub points: Vec<PointRecord>,
}

impl StepRecord {
    /// From the vec4 entries of the history ring (`given` of this step alone), see `totals_record` in `shaders/step/diagnostics.wgsl`.
    pub(crate) fn from_raw(raw: &[[f32; 4]]) -> Self {
        let total =
            |flow: [f32; 4], energy: f32| Total { mass: flow[0], momentum: [flow[1], flow[2], flow[3]], energy };
        let [head, counts, gas, owed, crossed, heat] = [raw[0], raw[1], raw[2], raw[3], raw[4], raw[5]];
        let [extremes, gas_speed, solid, solid_heat, solid_speed] = [raw[6], raw[7], raw[8], raw[9], raw[10]];
        let [given, more, cracks] = [raw[11], raw[12], raw[13]];
        Self {
            step: head[2].to_bits(),
            dt: head[0],
            residual: head[1],
            iterations: head[3].to_bits(),
            substeps: counts[0].to_bits(),
            extra: more[3].to_bits(),
            limited: counts[1].to_bits(),
            floored: counts[2].to_bits(),
            clamped: counts[3].to_bits(),
            gas: total(gas, heat[0]),
            owed: total(owed, heat[1]),
            crossed: total(crossed, heat[2]),
            density: [-extremes[1], extremes[0]],
            pressure: [-extremes[3], extremes[2]],
            gas_speed: gas_speed[0].max(0.0),
            courant: gas_speed[1].max(0.0),
            raised: gas_speed[2].to_bits(),
            dense: raw[14][0].to_bits(),
            min_entropy: -gas_speed[3],
            coldest_slot: heat[3].to_bits(),
            gas_kinetic: more[0],
            owed_either: more[1],
            gone_energy: more[2],
            solid: total(solid, solid_heat[0]),
            elastic_energy: solid_heat[1],
            ghost_energy: solid_heat[2],
            plastic_heat: solid_heat[3],
            fracture_energy: cracks[0],
            broken_mass: cracks[1],
            dropped_mass: raw[15][0],
            species_mass: [cracks[2], cracks[3]],
            dust_mass: [raw[14][1], raw[14][2], raw[14][3]],
            given: total([0.0, given[0], given[1], given[2]], given[3]),
            solid_speed: solid_speed[0].max(0.0),
            rounds: solid_speed[1].to_bits(),
            elastic_iterations: solid_speed[2].to_bits(),
            longest_round: solid_speed[3].to_bits(),
            ..Self::default()
        }
    }

    /// Adds what bodies were given in this step to the sum so far, and takes the sum.
    pub(crate) fn add_up(&mut self, sum: &mut [f64; 4]) {
        let Total { momentum: [x, y, z], energy, .. } = self.given;
        for (total, step) in sum.iter_mut().zip([x, y, z, energy]) {
            *total += f64::from(step);
        }
        let [x, y, z, energy] = sum.map(|total| total as f32);
        self.given = Total { mass: 0.0, momentum: [x, y, z], energy };
    }

    /// From two vec4 entries per probe.
    pub(crate) fn probes_from_raw(raw: &[[f32; 4]]) -> Vec<ProbeRecord> {
        let probe = |pair: &[[f32; 4]]| ProbeRecord {
            density: pair[0][0],
            velocity: [pair[0][1], pair[0][2], pair[0][3]],
            pressure: pair[1][0],
            kind: pair[1][1] as u8,
        };
        raw.chunks_exact(2).map(probe).collect()
    }
}
