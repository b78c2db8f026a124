//! The program's own verdict: numbers that are watched in every run, each with a limit, the reason of it, and advice.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use super::{Budget, Ending, Summary};
use crate::diagnostics::{StepRecord, Total};
use crate::material::{Fracture, Material};
use crate::math::plain;
use crate::scene::{Body, Scene, Warned};
use crate::state::Grid;
use crate::state::constants::MAX_ROUNDS;

/// A watched number.
#[derive(Clone, Copy, Debug)]
pub struct Rule {
    /// Its name.
    pub name: Warned,
    /// What it counts.
    pub quantity: &'static str,
    /// What it may be at most \[1\].
    pub limit: f64,
    /// Why.
    pub reason: &'static str,
    /// What to do where it is more.
    pub advice: &'static str,
}

/// All watched numbers. `docs/inside/warnings.md` has the same table.
pub const RULES: [Rule; 11] = [
    Rule {
        name: Warned::GasMass,
        quantity: "gas that is missing, with what is owed and what crossed the sides, over gas and what crossed",
        limit: 1e-5,
        reason: "mass moves in equal parts; sums of single precision keep it to 1e-6 in some thousand steps",
        advice: "report it: mass is lost by a fault of the program alone",
    },
    Rule {
        name: Warned::Momentum,
        quantity: "momentum that is missing, with what crossed the sides and what walls and gravity gave, over what was exchanged",
        limit: 1e-3,
        reason: "forces are equal and opposite; verification holds 1e-4, runs of thousands of steps round off more",
        advice: "try a smaller numerics.tolerance, or a smaller time.max_courant",
    },
    Rule {
        name: Warned::Energy,
        quantity: "energy that is missing or too much, with what crossed the sides and what gravity and blasts gave, over all energy",
        limit: 0.02,
        reason: "bodies exchange energy with gas to one or two percent in the verified cases; gas alone keeps it to rounding",
        advice: "try a smaller time.max_courant, a smaller numerics.expert.elastic_cfl, or a finer resolution",
    },
    Rule {
        name: Warned::OwedGas,
        quantity: "gas that covered cells owe or have too much of, most in any step, over the gas",
        limit: 0.1,
        reason: "a body at rest owes next to nothing, a moving one a part of the cells at its surface; more is a leak or a filled wall",
        advice: "look at field \"owed\"; thicken walls to two cells, or try a smaller time.max_courant",
    },
    Rule {
        name: Warned::Entropy,
        quantity: "1 minus the least p / rho^gamma of any step over that of the start and the inlets",
        limit: 0.15,
        reason: "no process of this gas lowers its entropy; the scheme may at jumps, and stops at 0.1 beside bodies",
        advice: "look at field \"entropy\"; cold specks are beside corners or bodies: refine there, or try a smaller time.cfl",
    },
    Rule {
        name: Warned::FlooredCells,
        quantity: "cells whose energy or pressure was raised to a floor, summed over steps, over cells times steps",
        limit: 1e-3,
        reason: "a floor stands for a value that the method could not find; one cell in a thousand is still local",
        advice: "look at field \"temperature\" near corners and thin gaps; try a smaller time.cfl or a finer resolution",
    },
    Rule {
        name: Warned::DenseProducts,
        quantity: "cells whose products were denser than the law of their explosive allows, summed over steps, over cells times steps",
        limit: 1e-3,
        reason: "beyond three times the density of the explosive the law of Jones, Wilkins and Lee has no stiffness; it is taken there",
        advice: "look at field \"density\" between body and charge; leave a cell of gas there, or try a finer resolution",
    },
    Rule {
        name: Warned::ClampedParticles,
        quantity: "particles set back at walls, summed over steps, over particles times steps",
        limit: 0.01,
        reason: "walls stop nodes, so particles rarely reach them; where many do, a body is pressed flat against a wall",
        advice: "leave a body more room, or try a smaller time.max_courant",
    },
    Rule {
        name: Warned::CappedSteps,
        quantity: "steps whose elastic solve ended without balance, or that max_substeps held short, over steps",
        limit: 0.01,
        reason: "forces that are not in balance move bodies; at the cap of sub-steps rounding adds up instead of motion",
        advice: "try elasticity = \"explicit\", a smaller time.max_courant, or a softer material",
    },
    Rule {
        name: Warned::LostBodies,
        quantity: "bodies of which no particle is left in the domain, over bodies; those that drop their debris are not counted",
        limit: 0.0,
        reason: "what has left pushes no gas; the sums keep what it took along",
        advice: "enlarge the domain, make the side a \"wall\", or expect it with the reason",
    },
    Rule {
        name: Warned::CollapsedBodies,
        quantity: "1 minus the room of the most compressed body over its volume at rest",
        limit: 0.8,
        reason: "no law here holds at a fifth of the volume at rest; particles that share their cells have no shape",
        advice: "give the body a stiffer material, or lower the load on it",
    },
];

/// The rules as a table in Markdown.
pub fn table() -> String {
    let mut text = "| Name | What is watched | Limit | Reason | Advice |\n|---|---|---|---|---|\n".to_owned();
    for Rule { name, quantity, limit, reason, advice } in RULES {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "| `{}` | {quantity} | {limit} | {reason} | {advice} |", name.name());
    }
    text
}

/// A watched number over its limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Warning {
    /// Name of the number.
    pub name: Warned,
    /// What it counts.
    pub quantity: &'static str,
    /// What was measured \[1\].
    pub measured: f64,
    /// What it may be at most.
    pub limit: f64,
    /// Where and when, as far as it has a place.
    pub place: String,
    /// What to do.
    pub advice: &'static str,
    /// Why the scene expects it, if it does.
    pub expected: Option<String>,
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { name, quantity, measured, limit, place, advice, expected } = self;
        let place = if place.is_empty() { String::new() } else { format!(", {place}") };
        let (measured, limit) = (plain(*measured), plain(*limit));
        write!(f, "{} = {measured}, at most {limit}{place} ({quantity}); ", name.name())?;
        match expected {
            Some(reason) => write!(f, "expected: {reason}"),
            None => f.write_str(advice),
        }
    }
}

/// What single steps leave of the watched numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Watched {
    /// Most owed gas over gas, and when \[s\].
    owed: [f64; 2],
    /// Least entropy \[Pa (m^3/kg)^gamma\], when \[s\], and in which slot.
    coldest: Option<(f64, f64, u32)>,
    /// Floored and raised cells, cells of products too dense, and particles held back, of all steps.
    floored: u64,
    #[serde(default)]
    dense: u64,
    clamped: u64,
    /// Steps with so many rounds or sub-steps.
    unbalanced: u64,
    most_substeps: [u64; 2],
    /// Most momentum that parts of the scene had in a step, whatever its direction, and energy that crossed.
    exchanged: f64,
    crossed_energy: f64,
    crossed_mass: f64,
}

fn length(v: [f32; 3]) -> f64 {
    v.map(|x| f64::from(x) * f64::from(x)).iter().sum::<f64>().sqrt()
}

/// Most momentum that a mass \[kg\] can have with a kinetic energy \[J\]. [Cauchy's inequality]
fn momentum_of(mass: f32, kinetic: f32) -> f64 {
    (2.0 * f64::from(mass).max(0.0) * f64::from(kinetic).max(0.0)).sqrt()
}

impl Watched {
    /// Adds a step.
    pub(super) fn add(&mut self, record: &StepRecord) {
        let Total { mass, momentum, energy } = record.crossed;
        let owed = f64::from(record.owed.mass.abs()) / f64::from(record.gas.mass).max(f64::MIN_POSITIVE);
        if owed > self.owed[0] {
            self.owed = [owed, record.time];
        }
        let entropy = f64::from(record.min_entropy);
        if entropy < self.coldest.map_or(1e38, |(least, ..)| least) {
            self.coldest = Some((entropy, record.time, record.coldest_slot));
        }
        self.floored += u64::from(record.floored) + u64::from(record.raised);
        self.dense += u64::from(record.dense);
        self.clamped += u64::from(record.clamped);
        self.unbalanced += u64::from(record.rounds >= MAX_ROUNDS);
        let [most, count] = &mut self.most_substeps;
        if u64::from(record.substeps) > *most {
            (*most, *count) = (record.substeps.into(), 0);
        }
        *count += u64::from(u64::from(record.substeps) == *most);
        let parts =
            momentum_of(record.gas.mass, record.gas_kinetic) + momentum_of(record.solid.mass, record.solid.energy);
        self.exchanged = self.exchanged.max(parts + length(momentum) + length(record.given.momentum));
        self.crossed_energy = self.crossed_energy.max(f64::from(energy).abs());
        self.crossed_mass = self.crossed_mass.max(f64::from(mass).abs());
    }

    /// Steps that a limit of their effort cut short. A scene that asks for one sub-step gets it.
    fn capped(&self, scene: &Scene) -> u64 {
        let cap = u64::from(scene.max_substeps());
        let [most, count] = self.most_substeps;
        self.unbalanced + if cap > 1 && most >= cap { count } else { 0 }
    }
}

/// What a run is warned of, in the order of the rules; those that the scene expects, too.
pub fn warnings(scene: &Scene, ending: &Ending<'_>) -> Vec<Warning> {
    over_limit(scene, |name| measure(name, scene, ending))
}

/// The same from the steps alone, while a run goes on. `start` is its budget before the first step.
pub fn marks(scene: &Scene, start: &Budget, summary: &Summary) -> Vec<Warning> {
    over_limit(scene, |name| of_steps(name, scene, start, summary))
}

fn over_limit(scene: &Scene, measure: impl Fn(Warned) -> Option<(f64, String)>) -> Vec<Warning> {
    let warned = |rule: &Rule| {
        let (measured, place) = measure(rule.name)?;
        // what is no number is over every limit
        (measured > rule.limit || measured.is_nan()).then(|| Warning {
            name: rule.name,
            quantity: rule.quantity,
            measured,
            limit: rule.limit,
            place,
            advice: rule.advice,
            expected: scene.expect.warnings.get(&rule.name).cloned(),
        })
    };
    RULES.iter().filter_map(warned).collect()
}

/// All watched numbers that the scene has.
pub fn watched(scene: &Scene, ending: &Ending<'_>) -> BTreeMap<Warned, f64> {
    RULES.iter().filter_map(|rule| Some((rule.name, measure(rule.name, scene, ending)?.0))).collect()
}

/// Warnings that the scene expects and that did not come.
pub fn absent(scene: &Scene, warnings: &[Warning]) -> Vec<Warned> {
    let came = |name: &Warned| warnings.iter().any(|warning| warning.name == *name);
    scene.expect.warnings.keys().copied().filter(|name| !came(name)).collect()
}

/// A watched number and its place, if the scene has it.
fn measure(name: Warned, scene: &Scene, ending: &Ending<'_>) -> Option<(f64, String)> {
    let Ending { start, end, summary, .. } = *ending;
    let watched = &summary.watched;
    match name {
        Warned::GasMass => {
            let scale = start.gas_mass.abs() + watched.crossed_mass;
            Some(((end.gas_mass_with_crossed - start.gas_mass_with_crossed).abs() / scale, String::new()))
        }
        Warned::Momentum => Some((gap(scene, ending)[0] / (watched.exchanged + end.noise_momentum), String::new())),
        Warned::Energy => Some((gap(scene, ending)[1] / (start.energy.abs() + watched.crossed_energy), String::new())),
        Warned::LostBodies => lost(scene, ending),
        Warned::CollapsedBodies => collapsed(scene, ending),
        Warned::OwedGas => {
            let (share, time) = of_steps(name, scene, end, summary)?;
            Some((share, format!("{time}; at the end most in cell {:?}", end.most_owed)))
        }
        _ => of_steps(name, scene, end, summary),
    }
}

/// A watched number that single steps tell. `budget` knows the entropy and the particles of the start.
fn of_steps(name: Warned, scene: &Scene, budget: &Budget, summary: &Summary) -> Option<(f64, String)> {
    let watched = &summary.watched;
    let (cells, steps) = (scene.domain.cells.map(u64::from).iter().product::<u64>(), summary.steps.max(1));
    let share = |part: u64, all: u64| Some((part as f64 / (all * steps).max(1) as f64, String::new()));
    match name {
        Warned::OwedGas => Some((watched.owed[0], format!("at t = {} s", plain(watched.owed[1])))),
        Warned::Entropy => {
            let (least, time, slot) = watched.coldest?;
            let place = format!("in cell {:?} at t = {} s", Grid::of(&scene.domain).cell(slot), plain(time));
            (budget.start_entropy > 0.0).then(|| (1.0 - least / budget.start_entropy, place))
        }
        Warned::FlooredCells => share(watched.floored, cells),
        Warned::DenseProducts => scene.gas.products().and_then(|_| share(watched.dense, cells)),
        Warned::ClampedParticles => share(watched.clamped, budget.particles),
        Warned::CappedSteps => share(watched.capped(scene), 1),
        _ => None,
    }
}

/// Momentum and energy that are missing or too much. What holds or drives bodies gives to them what no budget knows, but what the gas gives
/// to them is known: there the budgets are those of the gas.
fn gap(scene: &Scene, ending: &Ending<'_>) -> [f64; 2] {
    let of_gas = scene.bodies.iter().any(Body::is_driven);
    let all = |budget: &Budget| {
        let [x, y, z] = budget.momentum;
        if of_gas { budget.gas_budget } else { [x, y, z, budget.energy] }
    };
    let (start, end) = (all(ending.start), all(ending.end));
    let change: [f64; 4] = std::array::from_fn(|k| end[k] - start[k]);
    [change[..3].iter().map(|part| part * part).sum::<f64>().sqrt(), change[3].abs()]
}

fn names(scene: &Scene, bodies: impl Iterator<Item = usize>) -> String {
    let quoted = bodies.map(|index| format!("`{}`", scene.bodies[index].name));
    format!("bodies {}", quoted.collect::<Vec<_>>().join(", "))
}

fn lost(scene: &Scene, ending: &Ending<'_>) -> Option<(f64, String)> {
    let bodies = ending.snapshot.bodies(scene.bodies.len());
    let drops = |index: usize| {
        let material = scene.materials.get(&scene.bodies[index].material);
        material.and_then(Material::fracture).is_some_and(Fracture::drops_debris)
    };
    let lost: Vec<usize> = (0..bodies.len()).filter(|&index| bodies[index].particles == 0 && !drops(index)).collect();
    let share = lost.len() as f64 / bodies.len() as f64;
    (!bodies.is_empty()).then(|| (share, names(scene, lost.into_iter())))
}

fn collapsed(scene: &Scene, ending: &Ending<'_>) -> Option<(f64, String)> {
    let bodies = ending.snapshot.bodies(scene.bodies.len());
    let there = bodies.iter().enumerate().filter(|(_, body)| body.particles > 0);
    let (index, least) = there.map(|(index, body)| (index, body.room)).min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some((1.0 - least, names(scene, std::iter::once(index))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::snapshot::Snapshot;

    const SCENE: &str = "title = \"t\"\n[domain]\ndimension = 1\ncells = [10]\nsize = [1.0]\n[gas]\n\
        ambient = { density = 1.0, pressure = 1.0 }\n[time]\nuntil = 1.0\n[expect]\nwarnings = { owed_gas = \"a leak\", entropy = \"cold\" }\n";

    fn step(record: StepRecord) -> StepRecord {
        let gas = Total { mass: 1.0, momentum: [0.5, 0.0, 0.0], energy: 2.5 };
        StepRecord { gas, gas_kinetic: 0.125, min_entropy: 0.9, coldest_slot: 4, time: 0.5, ..record }
    }

    fn told(records: &[StepRecord], end: Budget) -> Vec<Warning> {
        let scene = Scene::parse(SCENE, "t.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
        let start =
            Budget { gas_mass: 1.0, gas_mass_with_crossed: 1.0, energy: 2.5, start_entropy: 1.0, ..Budget::default() };
        let end = Budget { start_entropy: 1.0, noise_momentum: 1e-3, ..end };
        let mut summary = Summary::default();
        summary.add(records);
        let snapshot = Snapshot::of_particles((1.0, 1), Grid::of(&scene.domain), Vec::new());
        warnings(&scene, &Ending { start: &start, end: &end, summary: &summary, snapshot: &snapshot })
    }

    fn budgets(mass: f64, energy: f64, momentum: f64) -> Budget {
        Budget { gas_mass_with_crossed: mass, energy, momentum: [momentum, 0.0, 0.0], ..Budget::default() }
    }

    #[test]
    fn what_is_over_its_limit_is_told_with_number_place_and_reason() {
        let names = |told: &[Warning]| told.iter().map(|warning| warning.name.name()).collect::<Vec<_>>();
        assert!(told(&[step(StepRecord::default())], budgets(1.0, 2.5, 0.0)).is_empty());
        assert_eq!(
            names(&told(&[step(StepRecord::default())], budgets(1.1, 2.4, 0.01))),
            ["gas_mass", "momentum", "energy"]
        );
        // 0.15 of the gas is owed in one of two steps; a cell loses 0.3 of the entropy and is floored, as 1 of 20
        let owed = Total { mass: -0.15, ..Total::default() };
        let cold = StepRecord { owed, floored: 1, ..StepRecord::default() };
        let steps = [StepRecord { min_entropy: 0.7, ..step(cold) }, step(StepRecord::default())];
        let found = told(&steps, budgets(1.0, 2.5, 0.0));
        assert_eq!(names(&found), ["owed_gas", "entropy", "floored_cells"]);
        assert!(
            (found[1].measured - 0.3).abs() < 1e-6 && found[1].place == "in cell [3, 0, 0] at t = 0.5 s",
            "{}",
            found[1]
        );
        assert!((found[2].measured - 0.05).abs() < 1e-12, "{}", found[2]);
        assert_eq!([&found[0], &found[2]].map(|warning| warning.expected.as_deref()), [Some("a leak"), None]);
        // what is no number is told
        assert_eq!(names(&told(&[step(StepRecord::default())], budgets(1.0, f64::NAN, 0.0))), ["energy"]);
    }

    #[test]
    fn an_expected_warning_that_does_not_come_is_known() {
        let scene = Scene::parse(SCENE, "t.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
        let cold = StepRecord { min_entropy: 0.7, ..step(StepRecord::default()) };
        let found = told(&[cold], budgets(1.0, 2.5, 0.0));
        assert_eq!(absent(&scene, &found), [Warned::OwedGas]);
    }
}
