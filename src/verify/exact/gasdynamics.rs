//! Closed formulas of steady supersonic flow of an ideal gas. Angles in radians.
//! [Ames Research Staff, NACA report 1135, 1953; Shapiro, The Dynamics and Thermodynamics of Compressible Fluid Flow, 1953]

/// Ratio of specific heats of air.
pub const AIR: f64 = 1.4;
/// Halvings of an interval until it holds one number.
const BISECTIONS: u32 = 80;

/// State behind an oblique shock, relative to that ahead of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObliqueShock {
    /// Angle between the shock and the stream ahead.
    pub angle: f64,
    /// Angle that the stream is turned by.
    pub deflection: f64,
    /// Ratio of the pressures.
    pub pressure: f64,
    /// Ratio of the densities.
    pub density: f64,
    /// Mach number behind.
    pub mach: f64,
}

impl ObliqueShock {
    /// The shock at an angle in a stream. [NACA 1135, eqs. 128, 129, 132, 138]
    pub fn at_angle(gamma: f64, mach: f64, angle: f64) -> Self {
        let normal = (mach * angle.sin()).powi(2);
        let tangent = 2.0 / angle.tan() * (normal - 1.0) / (mach * mach * (gamma + (2.0 * angle).cos()) + 2.0);
        let deflection = tangent.atan();
        let behind = (1.0 + 0.5 * (gamma - 1.0) * normal) / (gamma * normal - 0.5 * (gamma - 1.0));
        ObliqueShock {
            angle,
            deflection,
            pressure: normal_shock_pressure(gamma, normal.sqrt()),
            density: (gamma + 1.0) * normal / ((gamma - 1.0) * normal + 2.0),
            mach: behind.sqrt() / (angle - deflection).sin(),
        }
    }

    /// The weak shock that turns a stream by `deflection`; none if the shock cannot be attached.
    pub fn weak(gamma: f64, mach: f64, deflection: f64) -> Option<Self> {
        let turn = |angle: f64| Self::at_angle(gamma, mach, angle).deflection;
        let steepest = strongest_turn(gamma, mach);
        let angle = bisect((1.0 / mach).asin(), steepest, |angle| turn(angle) < deflection);
        (turn(steepest) >= deflection).then(|| Self::at_angle(gamma, mach, angle))
    }

    /// The shock of a given ratio of pressures.
    pub fn of_pressure(gamma: f64, mach: f64, pressure: f64) -> Self {
        let normal = (((gamma + 1.0) * pressure + gamma - 1.0) / (2.0 * gamma)).sqrt();
        Self::at_angle(gamma, mach, (normal / mach).asin())
    }
}

/// Angle of the shock that turns the stream most. [NACA 1135, eq. 168]
fn strongest_turn(gamma: f64, mach: f64) -> f64 {
    let square = mach * mach;
    let next = gamma + 1.0;
    let root = (next * (1.0 + 0.5 * (gamma - 1.0) * square + next / 16.0 * square * square)).sqrt();
    ((0.25 * next * square - 1.0 + root) / (gamma * square)).sqrt().asin()
}

/// Where `below` turns from true to false.
fn bisect(mut low: f64, mut high: f64, below: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if below(middle) { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Ratio of the pressures across a normal shock. [NACA 1135, eq. 93]
pub fn normal_shock_pressure(gamma: f64, mach: f64) -> f64 {
    1.0 + 2.0 * gamma / (gamma + 1.0) * (mach * mach - 1.0)
}

/// Total pressure over static pressure. [NACA 1135, eq. 44]
pub fn total_pressure(gamma: f64, mach: f64) -> f64 {
    (1.0 + 0.5 * (gamma - 1.0) * mach * mach).powf(gamma / (gamma - 1.0))
}

/// Pressure at the nose of a blunt body over that of the supersonic stream: Rayleigh's pitot formula. [NACA 1135, eq. 100]
pub fn pitot_pressure(gamma: f64, mach: f64) -> f64 {
    let square = mach * mach;
    let strength = 0.5 * (gamma + 1.0) * square;
    let loss = normal_shock_pressure(gamma, mach).powf(-1.0 / (gamma - 1.0));
    strength.powf(gamma / (gamma - 1.0)) * loss
}

/// Angle that a sonic stream turns by until it has a Mach number: the Prandtl-Meyer function. [NACA 1135, eq. 171c]
pub fn prandtl_meyer(gamma: f64, mach: f64) -> f64 {
    let ratio = ((gamma + 1.0) / (gamma - 1.0)).sqrt();
    let excess = (mach * mach - 1.0).sqrt();
    ratio * (excess / ratio).atan() - excess.atan()
}

/// Mach number of a stream that a fan has turned by `deflection`.
pub fn expanded_mach(gamma: f64, mach: f64, deflection: f64) -> f64 {
    let goal = prandtl_meyer(gamma, mach) + deflection;
    bisect(mach, 100.0, |mach| prandtl_meyer(gamma, mach) < goal)
}

/// Area of a stream over its sonic area. [NACA 1135, eq. 80]
pub fn area_ratio(gamma: f64, mach: f64) -> f64 {
    let exponent = (gamma + 1.0) / (2.0 * (gamma - 1.0));
    ((2.0 + (gamma - 1.0) * mach * mach) / (gamma + 1.0)).powf(exponent) / mach
}

/// Length of the shock cells of a plane jet over the height of its nozzle, for weak waves. `pressure` is that of the nozzle over that
/// around it. The jet that has come to the pressure around it, at constant entropy, has Mach number M and height h; standing waves in it
/// are 2 h sqrt(M^2 - 1) long. [Prandtl, Phys. Z. 5 (1904) 599; Pack, Q. J. Mech. Appl. Math. 3 (1950) 173]
pub fn jet_cell_length(gamma: f64, mach: f64, pressure: f64) -> f64 {
    let total = total_pressure(gamma, mach) * pressure;
    let jet = bisect(1.0, 100.0, |mach| total_pressure(gamma, mach) < total);
    2.0 * area_ratio(gamma, jet) / area_ratio(gamma, mach) * (jet * jet - 1.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    const AIR: f64 = 1.4;

    /// Printed digits of the tables and charts of NACA report 1135.
    #[test]
    fn formulas_meet_the_tables() {
        let near =
            |value: f64, printed: f64, digits: f64| assert!((value - printed).abs() <= digits, "{value} {printed}");
        near(normal_shock_pressure(AIR, 2.0), 4.500, 5e-4);
        near(normal_shock_pressure(AIR, 3.0), 10.333, 5e-4);
        near(1.0 / total_pressure(AIR, 2.0), 0.1278, 5e-5);
        near(1.0 / total_pressure(AIR, 3.0), 0.02722, 5e-6);
        near(1.0 / pitot_pressure(AIR, 2.0), 0.1773, 5e-5);
        near(1.0 / pitot_pressure(AIR, 3.0), 0.08291, 5e-6);
        near(prandtl_meyer(AIR, 2.0).to_degrees(), 26.38, 5e-3);
        near(prandtl_meyer(AIR, 3.0).to_degrees(), 49.76, 5e-3);
        near(area_ratio(AIR, 2.0), 1.688, 1e-3);
        near(area_ratio(AIR, 3.0), 4.235, 1e-3);
        near(expanded_mach(AIR, 2.0, (49.757 - 26.380_f64).to_radians()), 3.0, 1e-3);
        let shock = ObliqueShock::weak(AIR, 2.0, 10_f64.to_radians()).unwrap();
        near(shock.angle.to_degrees(), 39.31, 1e-2);
        near(shock.pressure, 1.707, 1e-3);
        near(shock.density, 1.458, 1e-3);
        near(shock.mach, 1.641, 1e-3);
        assert!(ObliqueShock::weak(AIR, 3.0, 34_f64.to_radians()).is_some());
        assert!(
            ObliqueShock::weak(AIR, 3.0, 34.1_f64.to_radians()).is_none(),
            "the shock is detached from 34.07 degrees on"
        );
    }

    #[test]
    fn inverses_and_weak_limits_agree() {
        let shock = ObliqueShock::weak(AIR, 3.0, 0.2).unwrap();
        let again = ObliqueShock::of_pressure(AIR, 3.0, shock.pressure);
        assert!((again.angle - shock.angle).abs() < 1e-12 && (again.deflection - 0.2).abs() < 1e-12);
        let behind = expanded_mach(AIR, 3.0, 0.1);
        assert!((prandtl_meyer(AIR, behind) - prandtl_meyer(AIR, 3.0) - 0.1).abs() < 1e-12);
        // at the pressure around it the jet is the nozzle
        assert!((jet_cell_length(AIR, 3.0, 1.0) - 2.0 * 8_f64.sqrt()).abs() < 1e-9);
    }
}
