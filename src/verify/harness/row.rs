//! What a case found: one line per quantity, and what it may be.

use std::fmt;

use serde::Serialize;

/// What a value must satisfy. A value that is no number satisfies nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Limit {
    /// Not above.
    AtMost(f64),
    /// Not below.
    AtLeast(f64),
    /// Truly above.
    Above(f64),
    /// From the first to the second.
    Between(f64, f64),
}

impl Limit {
    /// Whether a value satisfies it.
    pub fn holds(&self, value: f64) -> bool {
        match *self {
            Limit::AtMost(most) => value <= most,
            Limit::AtLeast(least) => value >= least,
            Limit::Above(bound) => value > bound,
            Limit::Between(least, most) => value >= least && value <= most,
        }
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Limit::AtMost(most) => write!(f, "<= {}", short(most)),
            Limit::AtLeast(least) => write!(f, ">= {}", short(least)),
            Limit::Above(bound) => write!(f, "> {}", short(bound)),
            Limit::Between(least, most) => write!(f, "{} .. {}", short(least), short(most)),
        }
    }
}

/// Four significant digits, in the shorter of the two notations.
pub fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let exponent = value.abs().log10().floor();
    if !value.is_finite() || !(-3.0..5.0).contains(&exponent) {
        return format!("{value:.3e}");
    }
    let digits = format!("{value:.*}", (3.0 - exponent).max(0.0) as usize);
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.').to_owned() } else { digits }
}

/// How a value stands to its limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Nothing is demanded; the value is there to be read.
    Reported,
    /// The gate holds.
    Pass,
    /// The gate of a sharp method holds too.
    Good,
    /// The gate does not hold, for a reason that is known and written down, and by no more than was known.
    Known,
    /// The gate does not hold.
    Fail,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Verdict::Reported => "-",
            Verdict::Pass => "pass",
            Verdict::Good => "good",
            Verdict::Known => "known miss",
            Verdict::Fail => "FAIL",
        })
    }
}

/// What the pressure solves of a run took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Solver {
    /// Steps of the run.
    pub steps: u64,
    /// Conjugate gradient iterations per step, mean.
    pub mean_iterations: f64,
    /// Most iterations of one step.
    pub max_iterations: u32,
    /// Largest acoustic Courant number c dt / dx of a step.
    pub courant: f64,
    /// Iterations that suffice at that Courant number, see [`super::iteration_bound`].
    pub bound: f64,
}

/// One line of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Identifier of the case.
    pub case: &'static str,
    /// Element pair, integrator and cells of the run; empty where a line speaks of several runs.
    pub setting: String,
    /// What was measured.
    pub quantity: String,
    /// What it should be, where there is such a number.
    pub reference: Option<f64>,
    /// Where that number or the gate comes from.
    pub source: String,
    /// What we found.
    pub ours: f64,
    /// What is demanded.
    pub pass: Option<Limit>,
    /// What a sharp method reaches.
    pub good: Option<Limit>,
    /// How far the value may miss `pass` for a known reason, and the reason.
    pub known: Option<(Limit, &'static str)>,
    /// The solver in that run.
    pub solver: Option<Solver>,
}

impl Row {
    /// Names the value that `ours` should have, and who says so.
    pub fn reference(&mut self, value: f64, source: impl Into<String>) -> &mut Self {
        self.reference = Some(value);
        self.source = source.into();
        self
    }

    /// Names who sets the gate, where there is no reference value.
    pub fn source(&mut self, source: impl Into<String>) -> &mut Self {
        self.source = source.into();
        self
    }

    /// Demands a limit; the run fails without it.
    pub fn pass(&mut self, limit: Limit) -> &mut Self {
        self.pass = Some(limit);
        self
    }

    /// Demands that the value differs from the reference by at most this share of it.
    pub fn within(&mut self, share: f64) -> &mut Self {
        let value = self.reference.unwrap_or(f64::NAN);
        let width = share * value.abs();
        self.pass(Limit::Between(value - width, value + width))
    }

    /// Names the limit of a sharp method; missing it is no failure.
    pub fn good(&mut self, limit: Limit) -> &mut Self {
        self.good = Some(limit);
        self
    }

    /// Says that the method misses the gate, why, and the limit that it keeps all the same. The gate stays in the table.
    pub fn known(&mut self, limit: Limit, reason: &'static str) -> &mut Self {
        self.known = Some((limit, reason));
        self
    }

    /// How the value stands to its limits.
    pub fn verdict(&self) -> Verdict {
        let Some(pass) = self.pass else { return Verdict::Reported };
        if !pass.holds(self.ours) {
            if self.known.is_some_and(|(limit, _)| limit.holds(self.ours)) { Verdict::Known } else { Verdict::Fail }
        } else if self.good.is_some_and(|good| good.holds(self.ours)) {
            Verdict::Good
        } else {
            Verdict::Pass
        }
    }

    /// The limits for people.
    pub fn allowed(&self) -> String {
        let good = self.good.map(|good| format!(" (good {good})")).unwrap_or_default();
        let known = self.known.filter(|_| self.verdict() == Verdict::Known);
        let known = known.map(|(limit, reason)| format!("; {limit}: {reason}")).unwrap_or_default();
        self.pass.map_or_else(String::new, |pass| format!("{pass}{good}{known}"))
    }
}
