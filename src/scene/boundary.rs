//! The sides of the domain.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::GasState;

/// What happens at one side, for gas and solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Boundary {
    /// Slip wall: nothing passes, nothing sticks.
    #[default]
    Wall,
    /// Gas of a fixed state flows in; solids may leave through it.
    Inlet(GasState),
    /// Gas leaves freely; so do solids.
    Outlet,
}

/// One rule per side; sides of inactive axes stay walls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
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

impl Boundaries {
    /// Keys of the sides in the order of [`Boundaries::sides`].
    pub const NAMES: [&str; 6] = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"];

    /// The sides in the order x_min, x_max, y_min, y_max, z_min, z_max.
    #[must_use]
    pub fn sides(&self) -> [Boundary; 6] {
        [self.x_min, self.x_max, self.y_min, self.y_max, self.z_min, self.z_max]
    }

    /// True if no gas can cross any side of a domain with `dimension` active axes.
    #[must_use]
    pub fn closed(&self, dimension: u32) -> bool {
        self.sides().iter().take(2 * dimension as usize).all(|side| *side == Boundary::Wall)
    }
}
