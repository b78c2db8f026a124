//! What the arrays that stages share hold, and when: a kernel binds eight storage buffers at most, so an array has parts, and a part has
//! several uses in a step. From this table follow `shaders/shared/state.wgsl`, `docs/inside/arrays.md`, the names of vectors that the solve
//! lends, and a test that no two uses of a part meet (`tests/suite/arrays.rs`).

use Stage::{
    Carrier, CoupledSolve, Dust, ElasticForce, ElasticReaction, ElasticSolve, FluidUpdate, G2p, GasAdvection,
    Interface, IntermediatePressure, MpmGridUpdate, OddEven, P2g, ParticleSort, SolidKick, SolidPredictor, Still,
    TimeStep,
};
use When::{At, Next, Second, Substep};

use super::stages::Stage;
use crate::scene::Scene;

mod scenes;
mod text;

pub use scenes::Scenes;
pub use text::{constants, table};

/// A moment of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// A stage of the step.
    At(Stage),
    /// A stage of the second of two solves per step, after `fluid_update` of the first.
    Second(Stage),
    /// A stage of an elastic sub-step, between `solid_kick` and what follows the sub-steps.
    Substep(Stage),
    /// A stage of the next step.
    Next(Stage),
}

/// Moments of a step, at most.
const STEP: u32 = 1000;

impl When {
    /// Place in the order of two steps.
    pub fn order(self) -> u32 {
        match self {
            At(stage) if stage <= FluidUpdate => stage as u32,
            Second(stage) => STEP / 5 + stage as u32,
            At(stage) if stage == SolidKick => 2 * STEP / 5 + stage as u32,
            Substep(stage) => 3 * STEP / 5 + stage as u32,
            At(stage) => 4 * STEP / 5 + stage as u32,
            Next(stage) => STEP + At(stage).order(),
        }
    }

    fn text(self) -> String {
        match self {
            At(stage) => format!("`{}`", stage.name()),
            Second(stage) => format!("`{}` of the second solve", stage.name()),
            Substep(stage) => format!("`{}` of sub-steps", stage.name()),
            Next(stage) => format!("`{}` of the next step", stage.name()),
        }
    }
}

/// How shaders name a use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Name {
    /// By the array, which has no other part.
    Array,
    /// By the array: its first part.
    First,
    /// By the number of a part and the constant that holds it.
    Part(u32, &'static str),
    /// By the member of `Params` that holds the place of its first word.
    Place(&'static str),
    /// By a binding of its own, of a vector that the solve lends.
    Lent(&'static str),
}

/// Slots that a use takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slots {
    /// All.
    All,
    /// Cells of the domain.
    Domain,
    /// The ring around it.
    Ring,
}

/// One use of a part of an array.
#[derive(Clone, Copy, Debug)]
pub struct Use {
    /// The array, as shaders and [`super::State`] name it.
    pub array: &'static str,
    /// How shaders name the use.
    pub name: Name,
    /// What it holds.
    pub holds: &'static str,
    /// Unit; empty for words and shares.
    pub unit: &'static str,
    /// Who writes it first.
    pub from: When,
    /// Who reads it last.
    pub to: When,
    /// Which scenes have it.
    pub scenes: Scenes,
    /// Which slots it takes.
    pub slots: Slots,
    /// Whether the stage that writes it is the one that reads the use before it last: slot by slot, or in an earlier kernel.
    pub in_place: bool,
}

impl Use {
    const fn new(array: &'static str, name: Name, life: (When, When), unit: &'static str, holds: &'static str) -> Self {
        let (from, to) = life;
        Self { array, name, holds, unit, from, to, scenes: Scenes::All, slots: Slots::All, in_place: false }
    }

    const fn of(self, scenes: Scenes) -> Self {
        Self { scenes, ..self }
    }

    const fn at(self, slots: Slots) -> Self {
        Self { slots, ..self }
    }

    const fn in_place(self) -> Self {
        Self { in_place: true, ..self }
    }

    /// Number of the part.
    pub const fn part(&self) -> u32 {
        match self.name {
            Name::Part(part, _) => part,
            Name::Array | Name::First | Name::Place(_) | Name::Lent(_) => 0,
        }
    }

    /// Whether a use that begins when this one does, or later, would stand in its words while they are needed.
    pub fn meets(&self, later: &Use) -> bool {
        let place = |own: &Use| match own.name {
            Name::Place(member) => Err(member),
            _ => Ok(own.part()),
        };
        let same_words = self.array == later.array && place(self) == place(later);
        let slots = self.slots == later.slots || self.slots == Slots::All || later.slots == Slots::All;
        if !same_words
            || !slots
            || !self.scenes.meet(later.scenes)
            || self.name == later.name && self.name != Name::Array
        {
            return false;
        }
        // In this step, and what outlives it in the next one.
        [0, STEP].into_iter().any(|shift| {
            let from = later.from.order() + shift;
            let replaced = later.in_place && from == self.to.order();
            (self.from.order()..=self.to.order()).contains(&from) && !replaced
        })
    }
}

/// Parts of `energy` that hold density and volume fraction of the second gas, as of every slot.
pub const SPECIES_DENSITY: usize = 7;
/// The other of the two.
pub const SPECIES_VOLUME: usize = 8;
/// Part that holds the density of an explosive that has not burned.
pub const UNBURNED: usize = 9;
/// Part that holds when its detonation comes.
pub const BURN_TIME: usize = 16;

/// Every use, by array and part, in the order of a step.
#[rustfmt::skip]
pub const USES: &[Use] = &[
    Use::new("conserved", Name::Array, (At(IntermediatePressure), Next(IntermediatePressure)), "kg m^-3, kg m^-2 s^-1",
        "density and momentum; in bodies covered gas; in the ring what crosses in the step"),
    Use::new("energy", Name::First, (At(IntermediatePressure), Next(IntermediatePressure)), "J m^-3",
        "total energy, with the same slots"),
    Use::new("energy", Name::Part(1, "HANDED_ENERGY"), (At(Interface), At(Interface)), "J",
        "what the ledger hands on to each receiver").of(Scenes::Bodies),
    Use::new("energy", Name::Part(1, "HALFWAY_ENERGY"), (At(GasAdvection), At(GasAdvection)), "J m^-3",
        "halfway through the advection"),
    Use::new("energy", Name::Part(1, "PREDICTED_PRESSURE"), (At(IntermediatePressure), At(FluidUpdate)), "Pa",
        "pressure that the solve starts from").at(Slots::Domain),
    Use::new("energy", Name::Part(1, "OPEN_PRESSURE"), (At(IntermediatePressure), At(FluidUpdate)), "Pa",
        "p0 of open faces").at(Slots::Ring),
    Use::new("energy", Name::Part(1, "OPEN_PRESSURE"), (At(FluidUpdate), Next(Carrier)), "Pa",
        "the same, for the carrier").at(Slots::Ring).of(Scenes::Gas),
    Use::new("energy", Name::Part(1, "FILTER_ENERGY"), (At(OddEven), At(OddEven)), "J m^-3", "what the filter changes")
        .at(Slots::Domain),
    Use::new("energy", Name::Part(2, "RECEIVERS"), (At(Interface), At(Interface)), "",
        "who receives what a solid slot hands on").of(Scenes::Bodies),
    Use::new("energy", Name::Part(2, "ADVECTED_ENERGY"), (At(GasAdvection), At(IntermediatePressure)), "J m^-3",
        "of the advected state"),
    Use::new("energy", Name::Part(2, "INVERSE_MASS"), (At(CoupledSolve), At(CoupledSolve)), "kg^-1",
        "inverse mass of gas nodes").at(Slots::Domain),
    Use::new("energy", Name::Part(2, "OPEN_VELOCITY"), (At(IntermediatePressure), At(FluidUpdate)), "m s^-1",
        "u0 of open faces").at(Slots::Ring).in_place(),
    Use::new("energy", Name::Part(2, "OPEN_VELOCITY"), (At(FluidUpdate), Next(Carrier)), "m s^-1",
        "the same, for the carrier").at(Slots::Ring).of(Scenes::Gas),
    Use::new("energy", Name::Part(3, "START_ENERGY"), (At(GasAdvection), Second(GasAdvection)), "J m^-3",
        "at the start of the step").of(Scenes::TwoSolves),
    Use::new("energy", Name::Part(4, "KEPT_ENERGY"), (At(GasAdvection), Second(GasAdvection)), "J m^-3",
        "what the first solve started from").of(Scenes::TwoSolves),
    Use::new("energy", Name::Part(5, "START_HEAT"), (At(GasAdvection), Second(FluidUpdate)), "J m^-3",
        "internal energy at the start of the step").of(Scenes::TwoSolves),
    Use::new("energy", Name::Part(6, "COLD_ENERGY"), (At(GasAdvection), Second(IntermediatePressure)), "J m^-3",
        "what the next solve starts from, without the part that it carries").of(Scenes::TwoSolves),
    Use::new("energy", Name::Part(SPECIES_DENSITY as u32, "SPECIES_DENSITY"), (At(IntermediatePressure), Next(IntermediatePressure)), "kg m^-3",
        "density of the second gas, with the slots of `conserved`").of(Scenes::TwoGases),
    Use::new("energy", Name::Part(SPECIES_VOLUME as u32, "SPECIES_VOLUME"), (At(IntermediatePressure), Next(IntermediatePressure)), "1, J m^-3",
        "its volume fraction; in bodies its share of the energy").of(Scenes::TwoGases),
    Use::new("energy", Name::Part(UNBURNED as u32, "UNBURNED"), (At(IntermediatePressure), Next(IntermediatePressure)), "kg m^-3",
        "density of an explosive that has not burned").of(Scenes::Products),
    Use::new("energy", Name::Part(10, "HANDED_SPECIES_MASS"), (At(Interface), At(Interface)), "kg",
        "mass of the second gas that the ledger hands on to each receiver").of(Scenes::TwoGases),
    Use::new("energy", Name::Part(10, "HALFWAY_SPECIES_DENSITY"), (At(GasAdvection), At(GasAdvection)), "kg m^-3",
        "halfway through the advection").of(Scenes::TwoGases),
    Use::new("energy", Name::Part(10, "FILTER_SPECIES_DENSITY"), (At(OddEven), At(OddEven)), "kg m^-3",
        "what the filter changes").of(Scenes::TwoGases),
    Use::new("energy", Name::Part(11, "HANDED_SPECIES_ENERGY"), (At(Interface), At(Interface)), "J",
        "its share of the energy").of(Scenes::TwoGases),
    Use::new("energy", Name::Part(11, "HALFWAY_SPECIES_VOLUME"), (At(GasAdvection), At(GasAdvection)), "1",
        "halfway through the advection").of(Scenes::TwoGases),
    Use::new("energy", Name::Part(11, "FILTER_SPECIES_VOLUME"), (At(OddEven), At(OddEven)), "1",
        "what the filter changes").of(Scenes::TwoGases),
    Use::new("energy", Name::Part(12, "ADVECTED_SPECIES_DENSITY"), (At(GasAdvection), At(IntermediatePressure)), "kg m^-3",
        "of the advected state").of(Scenes::TwoGases),
    Use::new("energy", Name::Part(13, "ADVECTED_SPECIES_VOLUME"), (At(GasAdvection), At(IntermediatePressure)), "1",
        "of the advected state").of(Scenes::TwoGases),
    Use::new("energy", Name::Part(14, "START_SPECIES_DENSITY"), (At(GasAdvection), Second(GasAdvection)), "kg m^-3",
        "at the start of the step, with two solves").of(Scenes::TwoGases),
    Use::new("energy", Name::Part(15, "START_SPECIES_VOLUME"), (At(GasAdvection), Second(GasAdvection)), "1",
        "at the start of the step, with two solves").of(Scenes::TwoGases),
    Use::new("energy", Name::Part(BURN_TIME as u32, "BURN_TIME"), (At(IntermediatePressure), Next(IntermediatePressure)), "s",
        "when a detonation comes").of(Scenes::Products),
    Use::new("energy", Name::Part(17, "HALFWAY_UNBURNED"), (At(GasAdvection), At(GasAdvection)), "kg m^-3",
        "halfway through the advection").of(Scenes::Products),
    Use::new("energy", Name::Part(18, "ADVECTED_UNBURNED"), (At(GasAdvection), At(IntermediatePressure)), "kg m^-3",
        "of the advected state").of(Scenes::Products),
    Use::new("energy", Name::Part(19, "START_UNBURNED"), (At(GasAdvection), Second(GasAdvection)), "kg m^-3",
        "at the start of the step, with two solves").of(Scenes::Products),
    Use::new("work", Name::Part(0, "HANDED_FLOW"), (At(Interface), At(Interface)), "kg, kg m s^-1",
        "mass and momentum that the ledger hands on to each receiver").of(Scenes::Bodies),
    Use::new("work", Name::Part(0, "HALFWAY_FLOW"), (At(GasAdvection), At(GasAdvection)), "kg m^-3, kg m^-2 s^-1",
        "density and momentum halfway through the advection"),
    Use::new("work", Name::Part(0, "FILM_PRESSURE"), (At(SolidPredictor), At(SolidPredictor)), "Pa",
        "pressure of gas films at walls, across each axis").of(Scenes::Bodies),
    Use::new("work", Name::Part(0, "GAS_NODE"), (At(CoupledSolve), At(CoupledSolve)), "m s^-2, kg^-1",
        "velocity change of gas nodes per time, of the right-hand side their velocity; w: inverse mass"),
    Use::new("work", Name::Part(0, "FILTER_FLOW"), (At(OddEven), At(OddEven)), "kg m^-3, kg m^-2 s^-1",
        "what the filter changes"),
    Use::new("work", Name::Part(1, "ELASTIC_FORCE"), (At(P2g), At(ElasticForce)), "N",
        "elastic force of nodes at the start of the step").of(Scenes::Bodies),
    Use::new("work", Name::Part(1, "ADVECTED_FLOW"), (At(GasAdvection), At(IntermediatePressure)),
        "kg m^-3, kg m^-2 s^-1", "density and momentum of the advected state"),
    Use::new("work", Name::Part(1, "LEFT_KICK"), (At(SolidPredictor), At(SolidPredictor)), "m s^-1",
        "velocity that light nodes leave to those around them").of(Scenes::Bodies),
    Use::new("work", Name::Part(1, "SOLID_NODE"), (At(ElasticReaction), At(SolidKick)), "m s^-2, kg^-1",
        "as GAS_NODE, of solid nodes; after the solve by the solved pressures").of(Scenes::Bodies),
    Use::new("work", Name::Part(1, "LEFT_KICK"), (At(SolidKick), At(SolidKick)), "m s^-1",
        "velocity that light nodes leave to those around them").of(Scenes::Bodies).in_place(),
    Use::new("work", Name::Part(1, "ELASTIC_FORCE"), (Substep(P2g), Substep(MpmGridUpdate)), "N, kg",
        "elastic force; w: where something breaks mass times driver").of(Scenes::Explicit),
    Use::new("work", Name::Part(1, "ELASTIC_FORCE"), (At(ElasticSolve), At(ElasticSolve)), "N",
        "elastic force, or that of a change of the stress").of(Scenes::Implicit),
    Use::new("work", Name::Part(2, "START_FLOW"), (At(GasAdvection), Second(GasAdvection)), "kg m^-3, kg m^-2 s^-1",
        "at the start of the step").of(Scenes::TwoSolves),
    Use::new("work", Name::Part(3, "KEPT_FLOW"), (At(GasAdvection), Second(GasAdvection)), "kg m^-3, kg m^-2 s^-1",
        "what the first solve started from").of(Scenes::TwoSolves),
    Use::new("node", Name::Array, (At(P2g), At(G2p)), "m s^-1, kg",
        "velocity and mass of solid nodes; after `mpm_grid_update`, where something breaks, w: driver").of(Scenes::Bodies),
    Use::new("node", Name::Array, (At(Carrier), At(FluidUpdate)), "m s^-1",
        "the carrier; w: sum of its differences; in the ring by how much the velocity of the face exceeds it")
        .of(Scenes::Gas),
    Use::new("inertia", Name::Array, (At(SolidPredictor), At(SolidKick)), "kg",
        "mass of solid nodes, as the solve sees it").of(Scenes::Bodies),
    Use::new("elastic", Name::Part(0, "NODE_FORCE"), (At(ElasticForce), At(ElasticReaction)), "N",
        "elastic force of nodes at the start of the step").of(Scenes::SolveFirst),
    Use::new("elastic", Name::Part(0, "REACTION"), (At(ElasticReaction), At(SolidKick)), "m s^-2",
        "reaction to the load of a node").of(Scenes::SolveFirst).in_place(),
    Use::new("elastic", Name::Part(0, "TO_SPREAD"), (At(SolidKick), Substep(MpmGridUpdate)), "m s^-2, kg",
        "acceleration to spread over the sub-steps; w: the mass that it was for").of(Scenes::Explicit).in_place(),
    Use::new("elastic", Name::Part(0, "KICKED_VELOCITY"), (At(SolidKick), At(ElasticSolve)), "m s^-1",
        "velocity after the solve; w: components that a wall stopped, as bits").of(Scenes::Implicit).in_place(),
    Use::new("elastic", Name::Part(0, "ELASTIC_ACCELERATION"), (At(ElasticForce), At(SolidPredictor)), "m s^-2",
        "of nodes at the start of the step").of(Scenes::ElasticFirst),
    Use::new("elastic", Name::Part(1, "START_VELOCITY"), (At(ElasticForce), At(SolidKick)), "m s^-1, kg",
        "velocity and mass of nodes at the start of the step").of(Scenes::SolveFirst),
    Use::new("elastic", Name::Part(1, "PASSED_ON"), (At(SolidKick), Substep(MpmGridUpdate)), "m s^-1",
        "velocity that nodes which have grown lighter pass on").of(Scenes::SolveFirst).in_place(),
    Use::new("fill", Name::Array, (At(Interface), At(FluidUpdate)), "m^3, Pa^-1",
        "x: solid volume; y: 1 / (gamma p) of gas before the solve, compliance of bodies").at(Slots::Domain),
    Use::new("fill", Name::Array, (At(IntermediatePressure), Next(IntermediatePressure)), "m s^-1, Pa",
        "what a free outlet knows of itself: its last u0 and p0").at(Slots::Ring),
    Use::new("ghost", Name::Array, (At(Interface), At(SolidKick)), "Pa",
        "ghost pressure of vertices").of(Scenes::Bodies),
    Use::new("ghost", Name::Array, (At(SolidKick), At(G2p)), "Pa",
        "its change by the solve").of(Scenes::Bodies).in_place(),
    Use::new("owed_flow", Name::Array, (At(Interface), Next(Interface)), "kg, kg m s^-1",
        "gas that cells owe, in bodies covered gas of their upper side; in the ring what has crossed since the start, over the volume of a cell"),
    Use::new("owed_energy", Name::First, (At(Interface), Next(Interface)), "J", "the same"),
    Use::new("owed_energy", Name::Part(1, "OWED_SPECIES_MASS"), (At(Interface), Next(Interface)), "kg",
        "the same of the second gas").of(Scenes::TwoGases),
    Use::new("owed_energy", Name::Part(2, "OWED_SPECIES_ENERGY"), (At(Interface), Next(Interface)), "J",
        "its share of the energy").of(Scenes::TwoGases),
    Use::new("dust", Name::First, (At(Dust), Next(Dust)), "kg m^-3",
        "dust in gas, and in bodies that cover it; in the ring what has crossed since the start").of(Scenes::Dust),
    Use::new("dust", Name::Part(1, "LOOSE_DUST"), (At(Dust), Next(Dust)), "kg m^-3",
        "what still lies on the ground beside the slot").of(Scenes::Dust),
    Use::new("cells", Name::Array, (At(Interface), Next(Interface)), "", "kind, flags and blocked share of a slot"),
    Use::new("extra", Name::First, (At(Interface), Next(Interface)), "",
        "place among the vertices with P, h and Q apart").of(Scenes::Bodies),
    Use::new("extra", Name::First, (At(TimeStep), Next(TimeStep)), "",
        "number of the cut cell from 1, else 0; fixed").of(Scenes::Gas),
    Use::new("extra", Name::Part(1, "LISTED_SLOTS"), (At(Interface), Next(Interface)), "",
        "slots that are not deep inside the gas; from the end the frontier, the slots whose nodes they need"),
    Use::new("extra", Name::Part(2, "LENGTHS"), (At(Interface), Next(Interface)), "",
        "lengths of both lists: LENGTH_LISTED, LENGTH_FRONTIER"),
    Use::new("extra", Name::Place("still_at"), (At(Still), Next(Still)), "", "rows of blocks in which something moves"),
    Use::new("extra", Name::Place("table_at"), (At(TimeStep), Next(TimeStep)), "",
        "table of cut cells, fixed; with bodies before it their count and of each slot the number of its cut cell"),
    Use::new("pressure", Name::First, (At(IntermediatePressure), Next(IntermediatePressure)), "Pa", "P of every vertex"),
    Use::new("pressure", Name::Part(1, "APART"), (At(IntermediatePressure), Next(IntermediatePressure)), "Pa",
        "h, then Q of vertices that carry them apart; then what each vertex asks of the gas around it"),
    Use::new("stiffness", Name::First, (At(IntermediatePressure), At(CoupledSolve)), "m^3 Pa^-1", "of every vertex"),
    Use::new("stiffness", Name::Part(1, "APART"), (At(IntermediatePressure), At(CoupledSolve)), "m^3 Pa^-1", "of h, then of Q"),
    Use::new("residual", Name::Lent("count"), (At(ParticleSort), At(ParticleSort)), "", "particles of a cell").of(Scenes::Bodies),
    Use::new("residual", Name::Lent("wanted"), (At(Interface), At(Interface)), "",
        "volume of a thin wall; 1 where a vertex wants P, h and Q apart; then where a slot is mixed"),
    Use::new("residual", Name::Lent("passing"), (At(Dust), At(Dust)), "",
        "share of its dust that a slot can give; of bodies who takes it, as bits").of(Scenes::Dust),
    Use::new("residual", Name::First, (At(CoupledSolve), At(CoupledSolve)), "m^3",
        "what open faces let through; right-hand side, residual"),
    Use::new("residual", Name::Lent("count"), (Substep(ParticleSort), Substep(ParticleSort)), "", "particles of a cell")
        .of(Scenes::Explicit),
    Use::new("residual", Name::Part(1, "APART"), (At(IntermediatePressure), At(CoupledSolve)), "m^3", "of h, then of Q"),
    Use::new("direction", Name::Lent("edge"), (At(Interface), At(Interface)), "", "1 where a slot is not deep inside the gas"),
    Use::new("direction", Name::Lent("taken"), (At(Dust), At(Dust)), "kg m^-3", "dust that the gas takes along from the ground")
        .of(Scenes::Dust),
    Use::new("direction", Name::First, (At(CoupledSolve), At(CoupledSolve)), "Pa", "of the search"),
    Use::new("product", Name::Lent("wanted_place"), (At(Interface), At(Interface)), "", "prefix sum of `wanted`"),
    Use::new("product", Name::Lent("busy"), (At(Still), At(Still)), "", "rows in which something moves"),
    Use::new("product", Name::Lent("theta"), (At(GasAdvection), At(GasAdvection)), "",
        "share of the high-order flux that a cell allows"),
    Use::new("product", Name::First, (At(CoupledSolve), At(CoupledSolve)), "m^3", "operator times direction"),
    Use::new("solution", Name::Lent("edge_place"), (At(Interface), At(Interface)), "", "prefix sum of `edge`"),
    Use::new("solution", Name::Lent("settled"), (At(Dust), At(Dust)), "kg m^-3", "dust at the end of the step").of(Scenes::Dust),
    Use::new("solution", Name::First, (At(CoupledSolve), At(CoupledSolve)), "Pa",
        "increment of the pressure; before the first iteration row sums for the coarse levels"),
    Use::new("inverse_diagonal", Name::First, (At(CoupledSolve), At(CoupledSolve)), "Pa m^-3", "of the operator"),
    Use::new("inverse_diagonal", Name::Part(1, "APART"), (At(IntermediatePressure), At(CoupledSolve)), "Pa m^-3",
        "of h, then of Q"),
];

/// Parts of an array in a scene.
pub fn parts(array: &str, scene: &Scene) -> usize {
    let (two_solves, two_gases) = (scene.solves() == 2, !scene.gas.species.is_empty());
    let products = scene.gas.products().is_some();
    let has = |scenes: Scenes| match scenes {
        Scenes::TwoSolves => two_solves,
        Scenes::TwoGases => two_gases,
        Scenes::Products => products,
        Scenes::Dust => scene.gas.dust.is_some(),
        _ => true,
    };
    let own = USES.iter().filter(|own| own.array == array && has(own.scenes));
    own.map(|own| own.part() as usize + 1).max().unwrap_or(0)
}
