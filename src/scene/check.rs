//! Checks that types cannot express.

use toml::de::DeTable;

use super::Scene;
use super::source::Finding;

/// Numbers that are not finite and vectors of the wrong length, in the text itself.
pub(super) fn numbers(_root: &DeTable<'_>, _findings: &mut Vec<Finding>) {}

/// Everything that is wrong with a scene.
pub(super) fn findings(_scene: &Scene) -> Vec<Finding> {
    Vec::new()
}
