//! Blast of TNT in air at sea level, measured and fitted by Kingery and Bulmash: what a gauge sees at a scaled distance.
//! [C. N. Kingery, G. Bulmash, Airblast Parameters from TNT Spherical Air Burst and Hemispherical Surface Burst, ARBRL-TR-02555, 1984]

/// Where the charge is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Burst {
    /// A ball in free air.
    Air,
    /// Half a ball on rigid ground.
    Surface,
}

/// What a gauge sees of the blast of a charge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blast {
    /// Time of arrival \[s\].
    pub arrival: f64,
    /// Peak overpressure of the wave that passes \[Pa\].
    pub overpressure: f64,
    /// Its impulse in the positive phase \[Pa s\].
    pub impulse: f64,
    /// Length of the positive phase \[s\]; none nearer than the curves reach.
    pub positive_phase: Option<f64>,
    /// Peak overpressure on a rigid wall that the wave meets head-on \[Pa\].
    pub reflected_overpressure: f64,
    /// Its impulse there \[Pa s\].
    pub reflected_impulse: f64,
}

/// Scaled distances for which there are curves \[m kg^(-1/3)\].
pub const RANGE: [f64; 2] = [0.0674, 40.0];

/// A polynomial in U = u0 + u1 log10(Z) for log10 of the scaled value, up to a scaled distance.
struct Curve {
    up_to: f64,
    u: [f64; 2],
    y: &'static [f64],
}

const fn curve(up_to: f64, u: [f64; 2], y: &'static [f64]) -> Curve {
    Curve { up_to, u, y }
}

/// The blast of a mass of TNT \[kg\] at a distance \[m\]; none outside of [`RANGE`].
pub fn blast(burst: Burst, mass: f64, distance: f64) -> Option<Blast> {
    let scale = mass.cbrt();
    let scaled = distance / scale;
    if !(RANGE[0]..=RANGE[1]).contains(&scaled) {
        return None;
    }
    let curves = match burst {
        Burst::Air => &AIR,
        Burst::Surface => &SURFACE,
    };
    let value = |curves: &[Curve]| {
        let curve = curves.iter().find(|curve| scaled <= curve.up_to)?;
        let u = curve.u[0] + curve.u[1] * scaled.log10();
        Some(10.0_f64.powf(curve.y.iter().rev().fold(0.0, |sum, factor| sum * u + factor)))
    };
    let milli = 1e-3 * scale;
    Some(Blast {
        arrival: milli * value(curves.arrival)?,
        overpressure: 1e3 * value(curves.overpressure)?,
        impulse: scale * value(curves.impulse)?,
        positive_phase: if scaled < curves.first_phase { None } else { value(curves.phase).map(|time| milli * time) },
        reflected_overpressure: 1e3 * value(curves.reflected_overpressure)?,
        reflected_impulse: scale * value(curves.reflected_impulse)?,
    })
}

/// The curves of a burst: times \[ms kg^(-1/3)\], pressures \[kPa\], impulses \[kPa ms kg^(-1/3)\].
struct Curves {
    arrival: &'static [Curve],
    overpressure: &'static [Curve],
    impulse: &'static [Curve],
    /// Least scaled distance of the positive phase.
    first_phase: f64,
    phase: &'static [Curve],
    reflected_overpressure: &'static [Curve],
    reflected_impulse: &'static [Curve],
}

#[rustfmt::skip]
const AIR: Curves = Curves {
    arrival: &[
        curve(40.0, [-0.253_273_112, 1.374_070_438],
            &[0.072_070_779, 1.364_568_712, -0.057_003_569, -0.182_832_225, 0.011_885_144, 0.043_264_869, -0.000_799_737, -0.004_360_736]),
    ],
    overpressure: &[
        curve(40.0, [-0.214_362_789, 1.350_342_5],
            &[2.611_368_669, -1.690_128_014, 0.008_049_736, 0.336_743_115, -0.005_162_264, -0.080_922_862, -0.004_785_073, 0.007_930_305,
              0.000_768_447]),
    ],
    impulse: &[
        curve(0.792, [2.347_239_214, 3.242_990_665],
            &[2.388_305_168, -0.443_749_378, 0.168_825_415, 0.034_813_803, -0.010_435_193]),
        curve(40.0, [-1.753_056_603, 2.306_292_318],
            &[1.551_972_271, -0.404_632_921, -0.014_272_195, 0.009_123_663, -0.000_675_068, -0.008_008_637, 0.003_148_195, 0.001_520_448,
              -0.000_747_027]),
    ],
    first_phase: 0.147,
    phase: &[
        curve(0.888, [2.263_672_685, 5.115_885_543],
            &[-0.686_608_55, 0.164_953_518, 0.127_788_499, 0.002_914_301, 0.001_879_574, 0.017_341_396, 0.002_697_398, -0.003_619_765,
              -0.001_009_266]),
        curve(2.28, [-1.333_612_067, 9.299_628_861],
            &[0.230_318_411, -0.029_794_427, 0.030_632_954, 0.018_340_557, -0.017_396_467, -0.001_063_22, 0.005_620_6, 0.000_161_822,
              -0.000_686_019]),
        curve(40.0, [-3.130_058_053, 3.152_472_536],
            &[0.621_036_276, 0.096_703_2, -0.008_013_021, 0.004_827_058, 0.001_875_873, -0.002_467_385, -0.000_841_117, 0.000_619_329]),
    ],
    reflected_overpressure: &[
        curve(40.0, [-0.214_362_789, 1.350_342_5],
            &[3.229_580_314, -2.214_005_39, 0.035_119_031, 0.657_599_992, 0.014_181_895, -0.243_076_636, -0.015_869_98, 0.049_274_118,
              0.002_276_396, -0.003_971_263]),
    ],
    reflected_impulse: &[
        curve(40.0, [-0.204_004_455, 1.378_829_96],
            &[2.558_755_66, -0.903_118_886, 0.101_771_878, -0.024_213_975]),
    ],
};

#[rustfmt::skip]
const SURFACE: Curves = Curves {
    arrival: &[
        curve(40.0, [-0.202_425_716, 1.377_842_236],
            &[-0.059_163_429, 1.357_064_963, 0.052_492_799, -0.196_563_954, -0.060_177_005, 0.069_636_027, 0.021_529_749, -0.016_165_893,
              -0.002_325_32, 0.001_477_521]),
    ],
    overpressure: &[
        curve(40.0, [-0.214_362_789, 1.350_342_5],
            &[2.780_769_166, -1.695_898_874, -0.154_159_377, 0.514_060_731, 0.098_853_437, -0.293_912_623, -0.026_811_235, 0.109_097_496,
              0.001_628_468, -0.021_463_103, 0.000_145_672, 0.001_678_478]),
    ],
    impulse: &[
        curve(0.955, [2.067_619_087, 3.076_032_967],
            &[2.524_556_209, -0.502_992_764, 0.171_335_645, 0.045_017_696, -0.011_896_463]),
        curve(40.0, [-1.947_088_467, 2.406_977_454],
            &[1.672_316_446, -0.384_519_027, -0.026_081_671, 0.005_957_988, 0.014_544_526, -0.006_632_893, -0.002_841_893, 0.001_364_482]),
    ],
    first_phase: 0.178,
    phase: &[
        curve(1.01, [1.929_461_541, 5.250_991_939],
            &[-0.614_227_604, 0.130_143_718, 0.134_872_512, 0.039_157_428, -0.004_759_337, -0.004_281_446]),
        curve(2.78, [-2.124_925_252, 9.299_628_861],
            &[0.315_409_246, -0.029_794_427, 0.030_632_954, 0.018_340_557, -0.017_396_467, -0.001_063_22, 0.005_620_6, 0.000_161_822,
              -0.000_686_019]),
        curve(40.0, [-3.536_262_181, 3.463_497_456],
            &[0.686_906_642, 0.093_303_53, -0.000_584_942, -0.002_268_85, -0.002_959_086, 0.001_480_299]),
    ],
    reflected_overpressure: &[
        curve(40.0, [-0.240_657_323, 1.366_377_192],
            &[3.402_832_176, -2.210_308_706, -0.218_536_586, 0.895_319_589, 0.249_890_098, -0.569_249_437, -0.117_916_824, 0.224_131_161,
              0.024_562_026, -0.045_511_6, -0.001_909_307, 0.003_614_712]),
    ],
    reflected_impulse: &[
        curve(40.0, [-0.246_208_805, 1.334_220_499],
            &[2.705_880_581, -0.949_516_093, 0.112_136_119, -0.025_065_918]),
    ],
};
