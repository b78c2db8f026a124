//! Headings of the report.

/// Shock tubes in 1D.
pub(in crate::verify) const TUBES: &str = "Shock tubes in 1D";
/// Interactions in 1D.
pub(in crate::verify) const INTERACTIONS: &str = "Interactions in 1D";
/// Walls and waves in 1D.
pub(in crate::verify) const WAVES: &str = "Walls and waves in 1D";
/// Blast in 2D.
pub(in crate::verify) const BLAST_2D: &str = "Blast in 2D";
/// Explosions in 2D and 3D.
pub(in crate::verify) const EXPLOSIONS: &str = "Explosions in 2D and 3D";
/// Supersonic flow in 2D.
pub(in crate::verify) const SUPERSONIC_2D: &str = "Supersonic flow in 2D";
/// Supersonic flow in 3D.
pub(in crate::verify) const SUPERSONIC_3D: &str = "Supersonic flow in 3D";
/// Subsonic flow.
pub(in crate::verify) const SUBSONIC: &str = "Subsonic flow";
/// Unsteady flow in 2D.
pub(in crate::verify) const UNSTEADY_2D: &str = "Unsteady flow in 2D";
/// Gas under gravity.
pub(in crate::verify) const GRAVITY: &str = "Gas under gravity";
/// Quiet gas and closed boxes.
pub(in crate::verify) const QUIET: &str = "Quiet gas and closed boxes";
/// Open sides.
pub(in crate::verify) const OPEN_SIDES: &str = "Open sides";
/// Coupling in 1D.
pub(in crate::verify) const COUPLING_1D: &str = "Coupling in 1D";
/// Coupling in 2D and 3D.
pub(in crate::verify) const COUPLING: &str = "Coupling in 2D and 3D";
/// Entropy beside bodies.
pub(in crate::verify) const ENTROPY: &str = "Entropy beside bodies";
/// Solids.
pub(in crate::verify) const SOLIDS: &str = "Solids";
/// Ablations.
pub(in crate::verify) const ABLATIONS: &str = "Ablations";
