//! Which scenes have a use of an array.

/// Scenes that have a use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scenes {
    /// All.
    All,
    /// Without bodies.
    Gas,
    /// With bodies.
    Bodies,
    /// Without bodies, with two solves per step.
    TwoSolves,
    /// With bodies whose elastic step comes after the solve.
    SolveFirst,
    /// The same, in explicit sub-steps.
    Explicit,
    /// The same, with `numerics.elasticity = "implicit"`.
    Implicit,
    /// With bodies and `numerics.paper.coupling = "last"`.
    ElasticFirst,
    /// With a second gas.
    TwoGases,
    /// With products of an explosive for a second gas.
    Products,
    /// With dust on the ground.
    Dust,
}

impl Scenes {
    /// Whether some scene has both.
    pub fn meet(self, other: Scenes) -> bool {
        use Scenes::{
            All, Bodies, Dust, ElasticFirst, Explicit, Gas, Implicit, Products, SolveFirst, TwoGases, TwoSolves,
        };
        let bodies = |scenes| matches!(scenes, Bodies | SolveFirst | Explicit | Implicit | ElasticFirst);
        match (self, other) {
            (TwoGases | Products | Dust, _) | (_, TwoGases | Products | Dust) => true,
            (Explicit, Implicit | ElasticFirst)
            | (Implicit, Explicit | ElasticFirst)
            | (SolveFirst, ElasticFirst)
            | (ElasticFirst, SolveFirst | Explicit | Implicit) => false,
            (Gas | TwoSolves, other) => !bodies(other),
            (own, Gas | TwoSolves) => !bodies(own),
            (All | Bodies | SolveFirst | Explicit | Implicit | ElasticFirst, _) => true,
        }
    }
}
