//! What the tables tell of the loads of the gas: columns of `bodies.csv`, `obstacles.csv`, and sums for `gauges.csv`.

use std::path::Path;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::diagnostics::{Borne, Load, StepRecord};
use crate::export::csv::{Table, Value};
use crate::quantity::{self, Columns, LOAD};
use crate::scene::Scene;
use crate::state::loads;

/// Columns that `bodies.csv` has in scenes with bodies that are held, driven or have gauges.
pub(super) fn body_columns() -> Vec<String> {
    quantity::names(LOAD).iter().map(|name| format!("gas_{name}")).collect()
}

/// Columns of `obstacles.csv`: its quantities have no work.
fn obstacle_columns() -> Vec<String> {
    let head = ["step", "time", "obstacle"].map(str::to_owned);
    head.into_iter().chain(quantity::names(of_obstacles())).collect()
}

fn of_obstacles() -> &'static [Columns<Borne>] {
    &LOAD[..LOAD.len() - 1]
}

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
    /// The zero that moments in a record are about, in the coordinates of the scene \[m\].
    frame: DVec3,
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
            frame: scene.domain.frame().into(),
            table: (obstacles > 0).then(|| Table::named(&folder.join("obstacles.csv"), obstacle_columns())),
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
            let [x, y, z, _] = sum.borne;
            let borne = load.borne((-self.frame).into(), [x, y, z]);
            table.push(head.into_iter().chain(quantity::row(of_obstacles(), &borne).map(Value::from)));
        }
    }

    /// Entries of a row of a body: means since its last row, and what it bore since the start; none where bodies have no loads.
    pub(super) fn row(&mut self, body: usize) -> Vec<Value> {
        let Some(sum) = self.bodies.get_mut(body) else { return Vec::new() };
        let time = std::mem::take(&mut sum.time);
        let [x, y, z, a, b, c] = std::mem::take(&mut sum.since).map(|part| part / time);
        let [along, up, aside, work] = sum.borne;
        let (force, impulse) = ([x, y, z], [along, up, aside]);
        let moment = (DVec3::new(a, b, c) + self.frame.cross(force.into())).into();
        let borne = Borne { force, moment, pressure: sum.pressure, impulse, work };
        quantity::row(LOAD, &borne).map(Value::from).collect()
    }
}
