use super::kingery_bulmash::{Burst, blast};
use super::{EXPLOSIVES, NearField, explosive};

fn tnt(axes: usize) -> NearField {
    let tnt = explosive("tnt").unwrap();
    NearField { explosive: tnt, mass: 1.0, axes, density: 1.225, pressure: 101_325.0, gamma: 1.4, afterburn: false }
}

#[test]
fn coefficients_give_the_measured_detonations() {
    for explosive in &EXPLOSIVES {
        let found = explosive.products.chapman_jouguet(explosive.density);
        assert!((found.speed / explosive.detonation_speed - 1.0).abs() < 2e-3, "{}: {found:?}", explosive.name);
        assert!((found.pressure / explosive.detonation_pressure - 1.0).abs() < 5e-3, "{}: {found:?}", explosive.name);
    }
}

#[test]
fn stiffness_is_the_slope_of_the_isentrope() {
    for explosive in &EXPLOSIVES {
        let jwl = explosive.products;
        for volume in [0.6_f64, 1.0, 3.0, 20.0] {
            let energy = jwl.energy / volume.powf(jwl.omega);
            // dE = -p dV
            let step = 1e-5 * volume;
            let beside = |sign: f64| {
                let middle =
                    jwl.pressure(volume + 0.5 * sign * step, energy - 0.5 * sign * step * jwl.pressure(volume, energy));
                jwl.pressure(volume + sign * step, energy - sign * step * middle)
            };
            let slope = -(beside(1.0) - beside(-1.0)) / (2.0 * step) * volume * volume;
            let found = jwl.stiffness(volume, energy);
            assert!((found / slope - 1.0).abs() < 1e-4, "{} {volume}: {found:e} {slope:e}", explosive.name);
        }
    }
}

/// The table of Swisdak for 10 kg on the ground: distance [m], overpressure [kPa], arrival [ms].
/// [M. M. Swisdak, Simplified Kingery Airblast Calculations, 1994]
const SWISDAK: [[f64; 3]; 5] =
    [[1.0, 5472.0, 0.2744], [2.0, 1585.0, 0.8809], [4.0, 336.7, 3.18], [7.0, 97.98, 8.775], [10.0, 49.27, 15.82]];

#[test]
fn curves_are_those_of_the_simplified_ones() {
    for [distance, pressure, arrival] in SWISDAK {
        let found = blast(Burst::Surface, 10.0, distance).unwrap();
        assert!((found.overpressure / (1e3 * pressure) - 1.0).abs() < 1e-3, "{distance}: {found:?}");
        assert!((found.arrival / (1e-3 * arrival) - 1.0).abs() < 1e-3, "{distance}: {found:?}");
    }
}

#[test]
fn curves_join_and_reflection_tends_to_twice() {
    for burst in [Burst::Air, Burst::Surface] {
        for edge in [0.792, 0.888, 0.955, 1.01, 2.28, 2.78] {
            let [a, b] = [1.0 - 1e-6, 1.0 + 1e-6].map(|nudge| blast(burst, 1.0, edge * nudge).unwrap());
            assert!((a.impulse / b.impulse - 1.0).abs() < 0.03, "{burst:?} {edge}: {a:?} {b:?}");
            let [a, b] = [a, b].map(|blast| blast.positive_phase.unwrap());
            assert!((a / b - 1.0).abs() < 0.05, "{burst:?} {edge}: {a} {b}");
        }
        let far = blast(burst, 1.0, 39.0).unwrap();
        assert!((far.reflected_overpressure / far.overpressure - 2.0).abs() < 0.1, "{far:?}");
        assert_eq!(blast(burst, 1.0, 41.0), None);
        // scaled distance alone counts
        let [one, thousand] = [blast(burst, 1.0, 3.0).unwrap(), blast(burst, 1000.0, 30.0).unwrap()];
        assert!((one.overpressure / thousand.overpressure - 1.0).abs() < 1e-12);
        assert!((10.0 * one.impulse / thousand.impulse - 1.0).abs() < 1e-12);
    }
}

#[test]
fn an_expansion_keeps_mass_and_energy() {
    for axes in 1..=3 {
        let field = tnt(axes);
        let mut expansion = field.start(20.0 * field.radius(), 0.02);
        let [mass, energy] = expansion.totals();
        expansion.run_to(10.0 * field.radius(), 200_000);
        assert!(expansion.front() >= 10.0 * field.radius(), "{axes} axes");
        let [mass_after, energy_after] = expansion.totals();
        // no zone moves through the outer end, so the gas there does no work
        assert!(
            (mass_after / mass - 1.0).abs() < 1e-12 && (energy_after / energy - 1.0).abs() < 5e-4,
            "{axes} axes: {mass_after} {mass} {energy_after} {energy}"
        );
        let profile = expansion.profile(expansion.front(), 500);
        let power = axes as i32;
        let thickness = profile.radius / profile.shells.len() as f64;
        let volume =
            |shell: usize| ((shell + 1) as f64 * thickness).powi(power) - (shell as f64 * thickness).powi(power);
        let surface = [2.0, 2.0 * std::f64::consts::PI, 4.0 * std::f64::consts::PI][axes - 1];
        let mapped: f64 = profile.shells.iter().enumerate().map(|(shell, state)| volume(shell) * state[0]).sum();
        let ball =
            surface / f64::from(power) * (profile.radius.powi(power) - field.radius().powi(power)) * field.density;
        let mapped = surface / f64::from(power) * mapped;
        assert!((mapped / (ball + field.mass) - 1.0).abs() < 1e-3, "{axes} axes: {mapped} {ball}");
    }
}

#[test]
fn a_kilogram_of_tnt_in_free_air_arrives_as_measured() {
    let field = tnt(3);
    let mut expansion = field.start(3.0, 0.01);
    let distance = 2.0;
    let mut peak: f64 = 0.0;
    let mut arrival = None;
    while expansion.time < 2.5e-3 {
        expansion.step(2.5e-3);
        let rise = expansion.pressure_at(distance) - field.pressure;
        peak = peak.max(rise);
        if rise > 0.5 * blast(Burst::Air, 1.0, distance).unwrap().overpressure {
            arrival.get_or_insert(expansion.time);
        }
    }
    let measured = blast(Burst::Air, 1.0, distance).unwrap();
    let arrival = arrival.unwrap();
    assert!((arrival / measured.arrival - 1.0).abs() < 0.05, "{arrival} {}", measured.arrival);
    // without afterburning the wave is weaker
    assert!((0.8..1.0).contains(&(peak / measured.overpressure)), "{peak} {}", measured.overpressure);
}

/// Carbon, hydrogen, nitrogen, oxygen, enthalpy of formation \[J mol^-1\]. [CRC Handbook; PETN: Dobratz and Crawford]
const TNT: [f64; 5] = [7.0, 5.0, 3.0, 6.0, -62.8e3];
const RDX: [f64; 5] = [3.0, 6.0, 6.0, 6.0, 69.9e3];
const PETN: [f64; 5] = [5.0, 8.0, 4.0, 12.0, -538.5e3];
/// Dioctyl sebacate and polyisobutylene, binders of C-4: oxygen that they lack \[1\].
const BINDERS: [f64; 2] = [2.737, 3.422];

/// Heat of combustion \[J kg^-1\] to carbon dioxide, vapour and nitrogen, and the oxygen that is lacking \[1\].
fn combustion([carbon, hydrogen, nitrogen, oxygen, formed]: [f64; 5]) -> [f64; 2] {
    let mass = 0.012_011 * carbon + 0.001_008 * hydrogen + 0.014_007 * nitrogen + 0.015_999 * oxygen;
    let lack = 2.0 * carbon + 0.5 * hydrogen - oxygen;
    [(carbon * 393.51e3 + 0.5 * hydrogen * 241.83e3 + formed) / mass, 0.015_999 * lack / mass]
}

#[test]
fn combustion_follows_from_the_formulas() {
    let [tnt, rdx, petn] = [TNT, RDX, PETN].map(combustion);
    let bound = 0.053 * BINDERS[0] + 0.037 * BINDERS[1];
    let c4 = [0.91 * rdx[0] + 13.1e6 * bound, 0.91 * rdx[1] + bound];
    let comp_b = std::array::from_fn(|k| 0.6 * rdx[k] + 0.4 * tnt[k]);
    for (own, [energy, lack]) in EXPLOSIVES.iter().zip([tnt, c4, petn, comp_b]) {
        assert!((own.combustion_energy / energy - 1.0).abs() < 2e-3, "{}: {energy}", own.name);
        assert!((own.oxygen_lack / lack - 1.0).abs() < 2e-3, "{}: {lack}", own.name);
        assert!(own.afterburn_energy() > 0.0);
    }
}
