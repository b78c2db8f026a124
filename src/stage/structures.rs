//! Structures that Rust and WGSL share. Each is declared once, in Rust; `scripts/generate` writes it into a shader.

use super::gas::Ball;
use super::solid::Shove;
use super::solve::Turn;
use crate::material::MaterialParams;
use crate::numerics::PcgControl;
use crate::state::coarse::{Grid, Level};
use crate::state::{Control, Knot, MotionAt, Opening, Params, Support};
use crate::structure::Shared;

/// For each file below `shaders/` that shows some: a kernel that takes it, and the structures.
pub fn all() -> Vec<(&'static str, &'static str, Vec<Shared>)> {
    vec![
        ("shared/state.wgsl", "step/time_step.wgsl", vec![Params::shared()]),
        ("shared/state.wgsl", "step/time_step.wgsl", vec![Control::shared()]),
        ("shared/pcg.wgsl", "numerics/linear_algebra.wgsl", vec![PcgControl::shared()]),
        ("materials/law.wgsl", "solid/g2p.wgsl", vec![MaterialParams::shared()]),
        ("shared/state.wgsl", "gas/openings.wgsl", vec![Opening::shared()]),
        ("shared/driven.wgsl", "solid/g2p.wgsl", vec![Support::shared()]),
        ("solve/coarse.wgsl", "solve/solve_coarse.wgsl", vec![Grid::shared(), Level::shared()]),
        ("gas/openings.wgsl", "gas/openings.wgsl", vec![Knot::shared()]),
        ("solid/motions.wgsl", "solid/motions.wgsl", vec![MotionAt::shared(), Support::shared()]),
        ("solve/solve_surface.wgsl", "solve/solve_surface.wgsl", vec![Turn::shared()]),
        ("gas/detonate.wgsl", "gas/detonate.wgsl", vec![Ball::shared()]),
        ("solid/push.wgsl", "solid/push.wgsl", vec![Shove::shared()]),
    ]
}
