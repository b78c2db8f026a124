//! What the tables tell of the loads of the gas: columns of `bodies.csv`, `obstacles.csv`, and sums for `gauges.csv`.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::diagnostics::{Load, StepRecord};
use crate::export::csv::{Table, Value};
use crate::scene::Scene;
use crate::state::loads;

/// Columns that `bodies.csv` has in scenes with bodies that are held, driven or have gauges.
#[rustfmt::skip]
pub(super) const BODY_COLUMNS: [&str; 11] = [
    "gas_force_x", "gas_force_y", "gas_force_z", "gas_moment_x", "gas_moment_y", "gas_moment_z", "gas_pressure",
    "gas_impulse_x", "gas_impulse_y", "gas_impulse_z", "gas_work",
];

/// Columns of `obstacles.csv`.
#[rustfmt::skip]
const OBSTACLE_COLUMNS: [&str; 13] = [
    "step", "time", "obstacle", "force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z", "pressure",
    "impulse_x", "impulse_y", "impulse_z",
];

/// Loads of a thing so far.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Sum {
    /// Impulse and work since the start.
    borne: [f64; 4],
    /// Impulse and angular impulse since the last row, and its time.
    since: [f64; 6],
    time: f64,
    /// Pressure of the last step.
    pressure: f64,
}

impl Sum {
    fn add(&mut self, dt: f64, load: &Load) {
        let ([x, y, z], [a, b, c]) = (load.force, load.moment);
        for (sum, rate) in self.borne.iter_mut().zip([x, y, z, load.power]) {
            *sum += dt * f64::from(rate);
        }
        for (sum, rate) in self.since.iter_mut().zip([x, y, z, a, b, c]) {
            *sum += dt * f64::from(rate);
        }
        self.time += dt;
        self.pressure = load.pressure.into();
    }
}

/// Loads of bodies, obstacles and walls.
#[derive(Debug)]
pub(super) struct Loads {
    bodies: Vec<Sum>,
    obstacles: Vec<(String, Sum)>,
    sides: Vec<Sum>,
    table: Option<Table>,
}

impl Loads {
    /// Those of a scene.
    pub(super) fn new(folder: &Path, scene: &Scene) -> Self {
        let [bodies, obstacles, sides] = loads::count(scene);
        let named = scene.obstacles[..obstacles].iter().map(|obstacle| (obstacle.name.clone(), Sum::default()));
        Self {
            bodies: vec![Sum::default(); bodies],
            obstacles: named.collect(),
            sides: vec![Sum::default(); sides],
            table: (obstacles > 0).then(|| Table::new(&folder.join("obstacles.csv"), &OBSTACLE_COLUMNS)),
        }
    }

    /// What bodies, obstacles and walls have borne so far.
    pub(super) fn sums(&self) -> Vec<Sum> {
        self.bodies.iter().chain(self.obstacles.iter().map(|(_, sum)| sum)).chain(&self.sides).cloned().collect()
    }

    /// Impulse that a load has come to \[kg m s^-1\]; loads are numbered as in a record.
    pub(super) fn impulse(&self, load: usize) -> [f64; 3] {
        let mut all = self.bodies.iter().chain(self.obstacles.iter().map(|(_, sum)| sum)).chain(&self.sides).skip(load);
        all.next().map_or([0.0; 3], |sum| [sum.borne[0], sum.borne[1], sum.borne[2]])
    }

    /// Goes on from what they had borne.
    pub(super) fn go_on(&mut self, sums: &[Sum]) {
        let obstacles = self.obstacles.iter_mut().map(|(_, sum)| sum);
        let own = self.bodies.iter_mut().chain(obstacles).chain(&mut self.sides);
        own.zip(sums).for_each(|(own, sum)| own.clone_from(sum));
    }

    /// The table of obstacles.
    pub(super) fn table(&mut self) -> Option<&mut Table> {
        self.table.as_mut()
    }

    /// Whether bodies have them.
    pub(super) fn of_bodies(&self) -> bool {
        !self.bodies.is_empty()
    }

    /// Adds a step: a row for each obstacle.
    pub(super) fn add(&mut self, record: &StepRecord) {
        let dt = f64::from(record.dt);
        let obstacles = self.obstacles.iter_mut().map(|(_, sum)| sum);
        let own = self.bodies.iter_mut().chain(obstacles).chain(&mut self.sides);
        own.zip(&record.loads).for_each(|(sum, load)| sum.add(dt, load));
        let Some(table) = &mut self.table else { return };
        for ((name, sum), load) in self.obstacles.iter().zip(record.loads.iter().skip(self.bodies.len())) {
            let head: [Value; 3] = [record.step.into(), record.time.into(), name.as_str().into()];
            let values = load.force.into_iter().chain(load.moment).chain([load.pressure]).map(Value::from);
            table.push(head.into_iter().chain(values).chain(sum.borne[..3].iter().map(|sum| (*sum).into())));
        }
    }

    /// Entries of a row of a body: means since its last row, and what it bore since the start; none where bodies have no loads.
    pub(super) fn row(&mut self, body: usize) -> Vec<Value> {
        let Some(sum) = self.bodies.get_mut(body) else { return Vec::new() };
        let time = std::mem::take(&mut sum.time);
        let means = std::mem::take(&mut sum.since).map(|part| part / time);
        means.into_iter().chain([sum.pressure]).chain(sum.borne).map(Value::from).collect()
    }
}
