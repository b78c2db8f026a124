//! What the columns of a state's arrays are, with their units.

/// Arrays that have a meaning outside of the step: name, columns and units.
#[rustfmt::skip]
const KNOWN: [(&str, &str); 18] = [
    ("conserved", "gas density [kg m^-3], momentum per volume x, y, z [kg m^-2 s^-1]; cells with the ring"),
    ("energy", "total gas energy per volume [J m^-3]; cells with the ring"),
    ("species", "density of the second gas [kg m^-3] of all cells with the ring, then its volume fraction; with an explosive then the density of what has not burned"),
    ("owed", "mass that cells owe [kg]; cells with the ring"),
    ("maps", "since the start: largest pressure [Pa], impulse above ambient [Pa s], what that sum lost to rounding, largest plastic strain"),
    ("dust", "dust [kg m^-3]; cells with the ring; in a full state then what lies on the ground beside them"),
    ("kind", "0 gas, 1 solid, 2 wall, 3 beyond an open side; cells with the ring"),
    ("cells", "words of the cells; bits 0 and 1 are the kind: 0 gas, 1 solid, 2 wall, 3 beyond an open side"),
    ("position", "x, y, z of each particle [m], mass [kg]"),
    ("velocity", "velocity x, y, z of each particle [m s^-1], volume at rest [m^3]"),
    ("affine", "three rows a particle: columns of the affine matrix [s^-1]; fourth: ghost pressure [Pa], plastic strain, bits of the material's index"),
    ("deformation", "three rows a particle: columns of the deformation gradient less the identity; fourth: bits of the body's index, 1 inside or 2 driven"),
    ("stress", "two rows a particle: Kirchhoff stress times volume at rest xx, yy, zz; xy, yz, zx [J]"),
    ("pressure", "pressure at the vertices [Pa], then what vertices ask"),
    ("owed_flow", "gas that is owed or has crossed a side: mass [kg], momentum [kg m s^-1]; beyond the sides per volume of a cell"),
    ("owed_energy", "the same: energy [J]"),
    ("control", "what the device decides: words of `Control` in src/state/control.rs"),
    ("order", "indices of the particles, cell by cell"),
];

/// Columns and units of an array; other arrays have a meaning inside the step only.
pub(super) fn of(name: &str) -> &'static str {
    KNOWN.iter().find(|(own, _)| *own == name).map_or("of the step", |(_, text)| text)
}
