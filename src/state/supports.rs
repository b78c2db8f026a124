//! What holds bodies: friction, and prescribed motions. One entry per body.

use bytemuck::{Pod, Zeroable};

use crate::scene::{MAX_BODIES, Scene};
use crate::structure::structure;
use crate::structure::types::vec3f;

structure! {
    /// How a body is held.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
    pub Support as "Support" {
        /// Velocity of the driven part now \[m s^-1\].
        velocity: vec3f,
        /// Coefficient of friction at walls and obstacles \[1\]; [`STICK`] for a body that sticks.
        friction: f32,
        /// Angular velocity of the driven part now \[rad s^-1\].
        spin: vec3f,
        /// First entry of the motion over time.
        first: u32,
        /// The point that the driven part turns about, at the start of the step, in the device's coordinates \[m\].
        pivot: vec3f,
        /// Entries of the motion over time.
        entries: u32,
        /// How far that point moves in this step \[m\].
        advance: vec3f,
        /// 1 where only a part of the body is driven: that part strains next to the rest.
        clamped: u32,
    }
}

structure! {
    /// One entry of a motion over time.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
    pub MotionAt as "MotionAt" {
        /// Velocity \[m s^-1\].
        velocity: vec3f,
        /// When \[s\].
        time: f32,
        /// Angular velocity \[rad s^-1\].
        spin: vec3f,
        /// Fills the last 16 bytes.
        unused: u32,
    }
}

/// A coefficient of friction that holds everything; the word of a cell has room for it.
pub const STICK: f32 = 65.0;

/// The supports of a scene.
#[derive(Clone, Debug)]
pub struct Supports {
    /// One entry per body.
    pub table: Vec<Support>,
    /// Motions over time, one after the other.
    pub motions: Vec<MotionAt>,
    /// Whether some body has a driven part.
    pub driven: bool,
    /// Whether some body does not slip.
    pub friction: bool,
}

impl Supports {
    /// Those of a scene.
    pub fn new(scene: &Scene) -> Self {
        let single = |v: [f64; 3]| v.map(|x| x as f32);
        let mut supports = Self { table: Vec::new(), motions: Vec::new(), driven: false, friction: false };
        for body in &scene.bodies {
            let first = supports.motions.len() as u32;
            for at in body.driven_motion() {
                let (velocity, spin) = (single(at.velocity), single(at.spin));
                supports.motions.push(MotionAt { velocity, time: at.time as f32, spin, unused: 0 });
            }
            supports.driven |= body.is_driven();
            supports.friction |= body.friction.coefficient() > 0.0;
            supports.table.push(Support {
                friction: (body.friction.coefficient() as f32).min(STICK),
                first,
                entries: supports.motions.len() as u32 - first,
                clamped: u32::from(body.clamped.is_some()),
                pivot: body.motion.as_ref().map_or([0.0; 3], |motion| scene.domain.in_frame(motion.about)),
                ..Support::default()
            });
        }
        supports
    }

    /// The table with all the room it has on the device.
    pub fn padded(&self) -> Vec<Support> {
        let mut table = self.table.clone();
        table.resize(MAX_BODIES, Support::default());
        table
    }
}
