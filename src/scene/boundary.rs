//! The sides of the domain.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{GasState, Shape, vector};

/// What happens at one side, or at a patch of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Boundary {
    /// Slip wall: nothing passes, nothing sticks.
    #[default]
    Wall,
    /// What leaves here enters at the other end. Both sides of the axis are periodic, along 4 cells or more; there are no bodies.
    Periodic,
    /// Gas of this state flows in; right for supersonic flow, where nothing travels upstream. Solids may leave.
    Inlet(GasState),
    /// Density and velocity are fixed, the pressure comes from inside.
    SubsonicInlet(Inflow),
    /// Gas at rest in a reservoir enters along the normal, without losses, as fast as the pressure inside lets it.
    TotalInlet(Reservoir),
    /// An inlet that changes in time: linear between two entries, constant before the first and after the last.
    TimedInlet(TimedInlet),
    /// A `far_field` of the gas that lies at the side at the start, face by face, without waves and vortices; at most 960 states.
    Outlet,
    /// For ducts: sound leaves, and the pressure returns to this one at the rate `relaxation` c (1 - M^2) / L. M is the Mach number, L the
    /// length of the domain. [Poinsot & Lele 1992]
    PressureOutlet(PressureOutlet),
    /// The paper's outlet: beyond the side lies the nearest cell, mixed with a share of this state. [Kwatra et al. 2009; Cao et al. 2022,
    /// section 2.9]
    AttenuatedOutlet(AttenuatedOutlet),
    /// Undisturbed gas of this state lies beyond: gas may leave and enter, sound leaves.
    FarField(GasState),
    /// Parts of the side have rules of their own.
    Patched(Patched),
}

/// Gas whose pressure comes from elsewhere.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Inflow {
    /// Density `[kg m^-3]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub density: f64,
    /// Velocity `[m s^-1]`.
    #[serde(default, with = "vector::Point")]
    pub velocity: [f64; 3],
    /// Mass fraction of the second gas; both gases have one temperature.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    #[schemars(extend("minimum" = 0, "maximum" = 1, "default" = 0))]
    pub mass_fraction: f64,
}

/// Total state: that of the gas before it was accelerated, without losses, to the speed that it enters with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reservoir {
    /// Total density `[kg m^-3]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub density: f64,
    /// Total pressure `[Pa]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub pressure: f64,
    /// Mass fraction of the second gas; both gases have one temperature.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    #[schemars(extend("minimum" = 0, "maximum" = 1, "default" = 0))]
    pub mass_fraction: f64,
}

/// Which of its numbers an inlet prescribes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InletRule {
    /// All, as `inlet`.
    #[default]
    Fixed,
    /// Density and velocity, as `subsonic_inlet`.
    Subsonic,
    /// Total density and pressure, as `total_inlet`.
    Total,
}

/// An inlet that changes in time; linear between the entries, constant before the first and after the last.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimedInlet {
    /// What the states prescribe.
    #[serde(default)]
    pub rule: InletRule,
    /// The states.
    pub table: Vec<TimedState>,
    /// Mass fraction of the second gas; both gases have one temperature.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    #[schemars(extend("minimum" = 0, "maximum" = 1, "default" = 0))]
    pub mass_fraction: f64,
}

/// The state of an inlet at one time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TimedState {
    /// When `[s]`, in ascending order.
    pub time: f64,
    /// Density `[kg m^-3]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub density: f64,
    /// Velocity `[m s^-1]`.
    #[serde(default, with = "vector::Point")]
    pub velocity: [f64; 3],
    /// Pressure `[Pa]`, above 0; the rule `subsonic` needs none.
    #[serde(default)]
    pub pressure: f64,
}

/// An outlet with a far pressure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PressureOutlet {
    /// Far pressure `[Pa]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub pressure: f64,
    /// How fast the pressure returns to it, in sound crossings of the domain.
    #[serde(default = "default_relaxation")]
    #[schemars(extend("minimum" = 0))]
    pub relaxation: f64,
}

fn default_relaxation() -> f64 {
    0.25
}

/// An outlet whose extrapolated state is attenuated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AttenuatedOutlet {
    /// Far density `[kg m^-3]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub density: f64,
    /// Far velocity `[m s^-1]`.
    #[serde(default, with = "vector::Point")]
    pub velocity: [f64; 3],
    /// Far pressure `[Pa]`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub pressure: f64,
    /// Share of the state in what lies beyond the side.
    #[schemars(extend("minimum" = 0, "maximum" = 1))]
    pub attenuation: f64,
    /// Mass fraction of the second gas; both gases have one temperature.
    #[serde(default, skip_serializing_if = "super::is_zero")]
    #[schemars(extend("minimum" = 0, "maximum" = 1, "default" = 0))]
    pub mass_fraction: f64,
}

/// A side of several rules.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Patched {
    /// Rule of what no patch covers. Solids follow it on the whole side: a wall stops them, everything else lets them leave.
    #[serde(default)]
    pub base: Box<Boundary>,
    /// Parts, each with a `shape` and a `rule`; a later one covers an earlier one.
    pub patches: Vec<Patch>,
}

/// A part of a side.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Patch {
    /// The patch holds the faces of the side whose centre lies inside.
    pub shape: Shape,
    /// What happens there.
    pub rule: Boundary,
}

impl Boundary {
    /// Base rule, then those of the patches.
    #[must_use]
    pub fn rules(&self) -> Vec<&Boundary> {
        match self {
            Boundary::Patched(patched) => {
                std::iter::once(&*patched.base).chain(patched.patches.iter().map(|patch| &patch.rule)).collect()
            }
            rule => vec![rule],
        }
    }

    /// Mass fraction of the second gas in what flows in.
    #[must_use]
    pub fn mass_fraction(&self) -> f64 {
        match self {
            Boundary::Inlet(state) | Boundary::FarField(state) => state.mass_fraction,
            Boundary::SubsonicInlet(inflow) => inflow.mass_fraction,
            Boundary::TotalInlet(reservoir) => reservoir.mass_fraction,
            Boundary::TimedInlet(inlet) => inlet.mass_fraction,
            Boundary::AttenuatedOutlet(outlet) => outlet.mass_fraction,
            Boundary::Wall
            | Boundary::Periodic
            | Boundary::Outlet
            | Boundary::PressureOutlet(_)
            | Boundary::Patched(_) => 0.0,
        }
    }

    /// Pressures that a rule prescribes \[Pa\].
    #[must_use]
    pub fn pressures(&self) -> Vec<f64> {
        match self {
            Boundary::Inlet(state) | Boundary::FarField(state) => vec![state.pressure],
            Boundary::TotalInlet(reservoir) => vec![reservoir.pressure],
            Boundary::TimedInlet(inlet) => inlet.table.iter().map(|state| state.pressure).collect(),
            Boundary::PressureOutlet(outlet) => vec![outlet.pressure],
            Boundary::AttenuatedOutlet(outlet) => vec![outlet.pressure],
            Boundary::Wall
            | Boundary::Periodic
            | Boundary::SubsonicInlet(_)
            | Boundary::Outlet
            | Boundary::Patched(_) => Vec::new(),
        }
    }

    /// Position among [`Boundary::rules`] of the rule that holds at a point of the side \[m\].
    #[must_use]
    pub fn rule_at(&self, point: [f64; 3]) -> usize {
        let Boundary::Patched(patched) = self else { return 0 };
        patched.patches.iter().rposition(|patch| patch.shape.distance(point) < 0.0).map_or(0, |index| index + 1)
    }

    /// True if no gas can cross the side for good.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.rules().iter().all(|rule| matches!(rule, Boundary::Wall | Boundary::Periodic))
    }
}

/// One rule per side; sides of inactive axes stay walls.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Boundaries {
    /// Side of lowest x.
    pub x_min: Boundary,
    /// Side of highest x.
    pub x_max: Boundary,
    /// Side of lowest y.
    pub y_min: Boundary,
    /// Side of highest y.
    pub y_max: Boundary,
    /// Side of lowest z.
    pub z_min: Boundary,
    /// Side of highest z.
    pub z_max: Boundary,
}

/// Share by which pressure or density of a stream change that outlets along it are told of.
const CHANGED: f64 = 0.1;

impl Boundaries {
    /// Keys of the sides in the order of [`Boundaries::sides`].
    pub const NAMES: [&str; 6] = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"];

    /// The sides in the order x_min, x_max, y_min, y_max, z_min, z_max.
    #[must_use]
    pub fn sides(&self) -> [&Boundary; 6] {
        [&self.x_min, &self.x_max, &self.y_min, &self.y_max, &self.z_min, &self.z_max]
    }

    /// The same, to change them.
    pub(super) fn sides_mut(&mut self) -> [&mut Boundary; 6] {
        [&mut self.x_min, &mut self.x_max, &mut self.y_min, &mut self.y_max, &mut self.z_min, &mut self.z_max]
    }

    /// True if no gas can cross any side of a domain with `dimension` active axes.
    #[must_use]
    pub fn closed(&self, dimension: u32) -> bool {
        self.sides().iter().take(2 * dimension as usize).all(|side| side.is_closed())
    }

    /// Sides of which each pair has one thing to tell: an `outlet`, beyond which the gas stays as it is at the start, and a `timed_inlet`
    /// whose stream goes along it, but becomes another one by more than a tenth.
    #[must_use]
    pub fn outlets_along_changing_streams(&self, dimension: u32) -> Vec<[&'static str; 2]> {
        let sides = || self.sides().into_iter().zip(Self::NAMES).enumerate().take(2 * dimension as usize);
        let changes = |side: &Boundary| match side {
            Boundary::TimedInlet(TimedInlet { table, .. }) => table.iter().any(|state| {
                let other = |now: f64, first: f64| (now - first).abs() > CHANGED * first;
                other(state.pressure, table[0].pressure) || other(state.density, table[0].density)
            }),
            _ => false,
        };
        let streams = sides().filter(|(_, (side, _))| changes(side));
        let beside = |stream: usize| sides().filter(move |(index, _)| index / 2 != stream / 2);
        let outlets = |stream: usize| beside(stream).filter(|(_, (side, _))| **side == Boundary::Outlet);
        streams.flat_map(|(at, (_, inlet))| outlets(at).map(move |(_, (_, outlet))| [outlet, inlet])).collect()
    }

    /// Whether what leaves along an axis enters at its other end.
    #[must_use]
    pub fn periodic(&self, axis: usize) -> bool {
        *self.sides()[2 * axis] == Boundary::Periodic
    }
}
