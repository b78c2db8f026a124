//! The stages of a step, once: the stopwatch and the bench show these names, faults carry their numbers, and the book and
//! `src/state/arrays.rs` follow their order.

use std::fmt::Write as _;

/// Declares the stages with name, question, and pages of the book.
macro_rules! stages {
    ($($stage:ident $name:literal $question:literal [$($page:literal $title:literal),*])*) => {
        /// A stage of a step; the position is its number in a fault.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        #[repr(u32)]
        pub enum Stage {
            $(#[doc = $question] $stage),*
        }

        impl Stage {
            /// All of them, in the order of a step.
            pub const ALL: &'static [Stage] = &[$(Stage::$stage),*];

            /// The name, as the stopwatch shows it.
            pub fn name(self) -> &'static str {
                match self { $(Stage::$stage => $name),* }
            }

            /// The question that the stage answers.
            pub fn question(self) -> &'static str {
                match self { $(Stage::$stage => $question),* }
            }

            /// Address, from the pages of the method, and title of the pages of the book.
            fn pages(self) -> &'static [(&'static str, &'static str)] {
                match self { $(Stage::$stage => &[$(($page, $title)),*]),* }
            }
        }
    };
}

stages! {
    TimeStep "time_step" "how far may we go?" ["time_step.md" "Time step"]
    Supports "supports" "what is held?" ["supports.md" "Supports and walls"]
    ParticleSort "particle_sort" "which particles touch which cell?" ["particles.md" "Particles and grid"]
    P2g "p2g" "what do the solids look like on the grid?" ["particles.md" "Particles and grid"]
    Interface "interface" "where do gas and solid meet?" ["interface.md" "Interface", "ledger.md" "Ledger"]
    ElasticForce "elastic_force" "which elastic force does the present stress give?" ["elastic_reaction.md" "Elastic reaction"]
    Still "still" "where does nothing move?" ["../inside/kernels.md" "Kernels"]
    Dust "dust" "where does the gas carry dust?" ["dust.md" "Dust"]
    Carrier "carrier" "which velocity carries the gas through its faces?" ["face_velocity.md" "Face velocity"]
    GasAdvection "gas_advection" "where does the gas carry itself?" ["gas_advection.md" "Gas advection"]
    IntermediatePressure "intermediate_pressure" "which pressure does the advected gas have?"
        ["intermediate_pressure.md" "Intermediate pressure"]
    SolidPredictor "solid_predictor" "what do gas films and gravity give to bodies?" ["coupled_solve.md" "Coupled solve"]
    ElasticReaction "elastic_reaction" "which part of the elastic force bears the load?"
        ["elastic_reaction.md" "Elastic reaction"]
    CoupledSolve "coupled_solve" "which pressure and velocity satisfy both sides?"
        ["coupled_solve.md" "Coupled solve", "preconditioners.md" "Preconditioners", "open_sides.md" "Open sides"]
    FluidUpdate "fluid_update" "what does that pressure do to the gas?" ["gas_update.md" "Gas update"]
    SolidKick "solid_kick" "and to the bodies?" ["solid_update.md" "Solid update"]
    ElasticSolve "elastic_solve" "which velocities balance the elastic force at the end of the step?"
        ["implicit_elasticity.md" "Implicit elasticity"]
    MpmGridUpdate "mpm_grid_update" "how do the nodes move?" ["solid_update.md" "Solid update"]
    G2p "g2p" "how do the particles move and deform?" ["laws.md" "Laws", "fracture.md" "Fracture"]
    Debris "debris" "which debris is dropped?" ["fracture.md" "Fracture"]
    OddEven "odd_even" "which alternating pressure does the solve not see?" ["gas_at_rest.md" "Gas at rest"]
    Totals "totals" "what are the sums, loads, gauges and maps of the step?" ["../inside/warnings.md" "Warnings and sums"]
}

/// The stages as a table of the book.
pub fn table() -> String {
    let mut text = "| Stage | Question it answers | Pages |\n|---|---|---|\n".to_owned();
    for stage in Stage::ALL {
        let pages: Vec<_> = stage.pages().iter().map(|(page, title)| format!("[{title}]({page})")).collect();
        let _ = writeln!(text, "| `{}` | {} | {} |", stage.name(), stage.question(), pages.join(", "));
    }
    text
}
