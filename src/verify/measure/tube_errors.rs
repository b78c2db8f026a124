//! L1 density errors of the method in double precision, which single precision on the device has to reach. Those with two solves have the
//! device's reconstruction; the others the weights of Jiang and Shu everywhere, for which differences of up to 0.1 % count as smooth (the
//! device: docs/method/gas_advection.md). Those that no table had come from `reference_tables::shock_tubes_with_predictor` and
//! `..._with_two_solves` in the test suite.

use crate::scene::Pair;
use crate::verify::harness::session::{Integrator, Setting};

/// Cells of the sweep; the quick suite stops at 400.
pub(in crate::verify) const RESOLUTIONS: [u32; 5] = [100, 200, 400, 800, 1600];

/// Errors at 100, 200, 400, 800 and 1600 cells: b1b0 with predictor, b1b0 of the paper, b2b1 with predictor, b2b1 of the paper,
/// b1b0 with two solves, b2b1 with two solves.
/// Not a number where none was measured.
pub(in crate::verify) type Errors = [[f64; 5]; 6];

const NONE: f64 = f64::NAN;

pub(in crate::verify) const SOD: Errors = [
    [0.00997, 0.00566, 0.00311, 0.00173, 0.00097],
    [0.0132, 0.00815, 0.00479, 0.00282, 0.00167],
    [0.01066, 0.00591, 0.00329, 0.00180, 0.00101],
    [0.0133, 0.00822, 0.00482, 0.00283, 0.00168],
    [0.00432, 0.00203, 0.00104, 0.00051, 0.00026],
    [0.00818, 0.00431, 0.00216, 0.00107, 0.00057],
];
pub(in crate::verify) const LAX: Errors = [
    [0.0201, 0.0117, 0.00750, 0.00452, 0.00255],
    [0.0213, 0.0129, 0.00828, 0.00508, 0.00294],
    [0.02074, 0.01167, 0.00756, 0.00456, 0.00257],
    [0.0216, 0.0130, 0.00828, 0.00509, 0.00294],
    [0.01372, 0.00730, 0.00432, 0.00233, 0.00116],
    [0.01534, 0.00778, 0.00496, 0.00269, 0.00137],
];
pub(in crate::verify) const STRONG: Errors = [
    [0.0165, 0.0109, 0.00587, 0.00323, 0.00190],
    [0.0193, 0.0133, 0.00747, 0.00428, 0.00251],
    [0.01745, 0.01110, 0.00608, 0.00328, 0.00193],
    [0.0195, 0.0134, 0.0075, 0.00429, 0.00252],
    [0.01213, 0.00737, 0.00369, 0.00180, 0.00100],
    [0.01401, 0.00848, 0.00429, 0.00214, 0.00120],
];
pub(in crate::verify) const MACH3: Errors = [
    [0.0395, 0.0240, 0.0129, 0.00674, 0.00354],
    [0.0469, 0.0294, 0.0168, 0.00922, 0.00508],
    [0.04186, 0.02517, 0.01347, 0.00701, 0.00367],
    [0.0490, 0.0304, 0.0172, 0.00944, 0.00518],
    [0.02266, 0.01175, 0.00584, 0.00288, 0.00144],
    [0.02784, 0.01528, 0.00807, 0.00415, 0.00210],
];
pub(in crate::verify) const HIGH_MACH: Errors = [
    [1.19, 0.908, 0.495, 0.307, 0.16188],
    [1.19, 0.921, 0.506, 0.310, 0.165],
    [1.13551, 0.90276, 0.48528, 0.29331, 0.15829],
    [1.16, 0.883, 0.497, 0.306, 0.161],
    [1.11613, 0.87994, 0.43459, 0.24630, 0.11491],
    [1.04840, 0.81265, 0.38768, 0.23082, 0.10627],
];
pub(in crate::verify) const RAREFACTIONS: Errors = [
    [0.0147, 0.00895, 0.00502, 0.00278, 0.00169],
    [0.0160, 0.0102, 0.00596, 0.00340, 0.00214],
    [0.01695, 0.00983, 0.00529, 0.00286, 0.00164],
    [0.0181, 0.0110, 0.0062, 0.00349, 0.00208],
    [0.00606, 0.00248, 0.00171, 0.00133, 0.00094],
    [0.01004, 0.00514, 0.00313, 0.00193, 0.00108],
];

pub(in crate::verify) const BLAST: Errors = [
    [0.303, 0.220, 0.138, 0.0752, NONE],
    [0.341, 0.250, 0.157, 0.0893, 0.0478],
    [NONE; 5],
    [0.348, 0.252, 0.157, 0.0891, 0.0477],
    [NONE; 5],
    [NONE; 5],
];

/// The error that a setting should have.
pub(in crate::verify) fn expected(errors: &Errors, setting: Setting) -> Option<f64> {
    let row = match (setting.pair, setting.integrator) {
        (Pair::B1b0, Integrator::Predictor) => 0,
        (Pair::B1b0, Integrator::Paper) => 1,
        (Pair::B2b1, Integrator::Predictor) => 2,
        (Pair::B2b1, Integrator::Paper) => 3,
        (Pair::B1b0, Integrator::Ars222) => 4,
        (Pair::B2b1, Integrator::Ars222) => 5,
        (_, Integrator::Auto) => return None,
    };
    let column = RESOLUTIONS.iter().position(|cells| *cells == setting.cells)?;
    Some(errors[row][column]).filter(|error| error.is_finite())
}
