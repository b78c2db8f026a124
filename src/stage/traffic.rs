//! How many bytes a step moves, by count: the yardstick for the times that `brisance bench` measures.
//!
//! Every array that a kernel names counts once per dispatch and direction, with the bytes of the entries it needs; what
//! neighbouring threads share is taken to come from caches. A stage that reaches the device's bandwidth with these bytes
//! cannot be made faster without moving less. The preconditioner's rows are left out: they follow the bodies' surface, not the grid.

use crate::state::stages::Stage;

/// Bytes that one stage moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Traffic {
    /// The stage.
    pub stage: Stage,
    /// How often it moves them.
    pub per: Per,
    /// Bytes per slot in scenes without bodies.
    pub slot: u32,
    /// Bytes per slot that bodies add.
    pub slot_with_solids: u32,
    /// Bytes per slot that the consistent face velocity adds.
    pub slot_with_carrier: u32,
    /// Bytes per slot that the element pair B2B1 adds.
    pub slot_with_quadratic: u32,
    /// Bytes per particle.
    pub particle: u32,
}

/// How often a stage moves its bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Per {
    /// Once per step.
    Step,
    /// Once per iteration of the solve.
    Iteration,
    /// Once per elastic sub-step.
    Substep,
}

const fn row(stage: Stage, per: Per, slot: u32, slot_with_solids: u32, particle: u32) -> Traffic {
    Traffic { stage, per, slot, slot_with_solids, slot_with_carrier: 0, slot_with_quadratic: 0, particle }
}

const fn carrier(stage: Stage, slot_with_carrier: u32) -> Traffic {
    Traffic { slot_with_carrier, ..row(stage, Per::Step, 0, 0, 0) }
}

const fn quadratic(stage: Stage, per: Per, slot_with_quadratic: u32) -> Traffic {
    Traffic { slot_with_quadratic, ..row(stage, per, 0, 0, 0) }
}

/// The bytes of all stages; stages with several parts have several lines. Of the sort it is what one takes where it is due. Particle transfers are those of the gather form in
/// 3D, whose nine colors each read and write the nodes.
pub const TRAFFIC: [Traffic; 24] = [
    row(Stage::TimeStep, Per::Step, 24, 0, 128),
    row(Stage::ParticleSort, Per::Step, 0, 16, 88),
    row(Stage::ParticleSort, Per::Substep, 0, 16, 88),
    row(Stage::P2g, Per::Substep, 0, 640, 108),
    row(Stage::Interface, Per::Step, 0, 360, 264),
    row(Stage::P2g, Per::Step, 0, 304, 68),
    row(Stage::ElasticForce, Per::Step, 0, 64, 0),
    row(Stage::Still, Per::Step, 20, 0, 0),
    row(Stage::GasAdvection, Per::Step, 116, 32, 0),
    carrier(Stage::Carrier, 128),
    carrier(Stage::IntermediatePressure, 4),
    row(Stage::IntermediatePressure, Per::Step, 84, 8, 0),
    row(Stage::SolidPredictor, Per::Step, 0, 176, 36),
    row(Stage::ElasticReaction, Per::Step, 0, 104, 0),
    row(Stage::CoupledSolve, Per::Step, 116, 0, 0),
    // The operator names kinds, direction, stiffness, node masses, product and diagonal; the vectors are direction, residual and
    // solution, to and fro, product and diagonal. With bodies residual and direction take a sweep each: 60.
    row(Stage::CoupledSolve, Per::Iteration, 56, 56, 0),
    // Forces and operator apart, with the nodes' velocities in between, and the vectors as with bodies.
    quadratic(Stage::CoupledSolve, Per::Iteration, 56),
    row(Stage::FluidUpdate, Per::Step, 176, 32, 0),
    carrier(Stage::FluidUpdate, 16),
    row(Stage::SolidKick, Per::Step, 0, 304, 0),
    row(Stage::MpmGridUpdate, Per::Substep, 0, 52, 0),
    row(Stage::G2p, Per::Substep, 0, 20, 288),
    row(Stage::Totals, Per::Step, 24, 20, 0),
    row(Stage::Totals, Per::Step, 0, 0, 128),
];

/// What the bytes of a run depend on: sizes, and sums over its steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Load {
    /// Slots of the grid.
    pub slots: u64,
    /// Particles.
    pub particles: u64,
    /// Steps.
    pub steps: u64,
    /// Iterations of all steps.
    pub iterations: u64,
    /// Elastic sub-steps of all steps.
    pub substeps: u64,
    /// Whether the gas is carried by the consistent face velocity.
    pub carrier: bool,
    /// Whether the element pair is B2B1.
    pub quadratic: bool,
}

/// Bytes that a stage has moved in a run, by its name.
pub fn bytes(stage: &str, load: &Load) -> u64 {
    let solids = u64::from(load.particles > 0);
    let of_row = |row: &Traffic| {
        let times = match row.per {
            Per::Step => load.steps,
            Per::Iteration => load.iterations,
            Per::Substep => load.substeps * solids,
        };
        let slot = u64::from(row.slot)
            + solids * u64::from(row.slot_with_solids)
            + u64::from(load.carrier) * u64::from(row.slot_with_carrier)
            + u64::from(load.quadratic) * u64::from(row.slot_with_quadratic);
        times * (slot * load.slots + u64::from(row.particle) * load.particles)
    };
    TRAFFIC.iter().filter(|row| row.stage.name() == stage).map(of_row).sum()
}
