//! The fields as pictures know them: names, units, and the smallest range worth showing.

use crate::quantity::{self, Place};
use crate::scene::{Field, GasState, ParticleColor};

/// All fields with the constants that shaders switch on.
const CODES: [(&str, Field); 14] = [
    ("FIELD_DENSITY", Field::Density),
    ("FIELD_PRESSURE", Field::Pressure),
    ("FIELD_VELOCITY", Field::Velocity),
    ("FIELD_TEMPERATURE", Field::Temperature),
    ("FIELD_SCHLIEREN", Field::Schlieren),
    ("FIELD_MACH", Field::Mach),
    ("FIELD_VORTICITY", Field::Vorticity),
    ("FIELD_ENTROPY", Field::Entropy),
    ("FIELD_MASS_FRACTION", Field::MassFraction),
    ("FIELD_DUST", Field::Dust),
    ("FIELD_OWED", Field::Owed),
    ("FIELD_PEAK_PRESSURE", Field::PeakPressure),
    ("FIELD_IMPULSE", Field::Impulse),
    ("FIELD_PEAK_PLASTIC_STRAIN", Field::PeakPlasticStrain),
];

/// What the colours of particles mean, with the constants that shaders switch on.
const PARTICLE_CODES: [(&str, ParticleColor); 7] = [
    ("PARTICLE_BODY", ParticleColor::Body),
    ("PARTICLE_MATERIAL", ParticleColor::Material),
    ("PARTICLE_SPEED", ParticleColor::Speed),
    ("PARTICLE_DEVIATORIC_STRESS", ParticleColor::DeviatoricStress),
    ("PARTICLE_PLASTIC_STRAIN", ParticleColor::PlasticStrain),
    ("PARTICLE_DAMAGE", ParticleColor::Damage),
    ("PARTICLE_TEMPERATURE", ParticleColor::Temperature),
];

/// Changes below this fraction of the ambient state are rounding, and drawn as uniform.
const SMALLEST_CONTRAST: f64 = 2e-3;

/// Number of a field in the shaders.
pub(super) fn code(field: Field) -> u32 {
    CODES.iter().position(|(_, known)| *known == field).unwrap_or_default() as u32
}

/// Number of a quantity of the particles in the shaders.
pub(super) fn particle_code(color: ParticleColor) -> u32 {
    PARTICLE_CODES.iter().position(|(_, known)| *known == color).unwrap_or_default() as u32
}

/// The constants that give each field and each quantity of the particles its number in WGSL.
pub(super) fn constants() -> String {
    let fields = CODES.iter().map(|(name, _)| *name).enumerate();
    let particles = PARTICLE_CODES.iter().map(|(name, _)| *name).enumerate();
    fields.chain(particles).map(|(code, name)| format!("const {name}: u32 = {code}u;\n")).collect()
}

/// Caption of the particles' colour bar, with the unit; nothing where colours stand for names.
#[must_use]
pub fn particle_caption(color: ParticleColor) -> &'static str {
    match color {
        ParticleColor::Body | ParticleColor::Material => "",
        ParticleColor::Speed => named(Place::Particle, "velocity"),
        ParticleColor::DeviatoricStress => named(Place::Particle, "deviatoric_stress"),
        ParticleColor::PlasticStrain => named(Place::Particle, "plastic_strain"),
        ParticleColor::Damage => named(Place::Particle, "damage"),
        ParticleColor::Temperature => "p/rho around [m\u{b2}/s\u{b2}]",
    }
}

fn named(place: Place, name: &str) -> &'static str {
    quantity::find(place, name).map_or("", |quantity| quantity.caption)
}

/// The range to show for values of the particles: all quantities but the temperature start at zero.
pub(super) fn shown_particle_range(color: ParticleColor, seen: [f64; 2], ambient: &GasState, gamma: f64) -> [f64; 2] {
    let smallest = match color {
        ParticleColor::Damage => return [0.0, 1.0],
        ParticleColor::Speed => SMALLEST_CONTRAST * ambient.sound_speed(gamma),
        ParticleColor::DeviatoricStress => SMALLEST_CONTRAST * ambient.pressure,
        ParticleColor::Body | ParticleColor::Material | ParticleColor::PlasticStrain => SMALLEST_CONTRAST,
        ParticleColor::Temperature => {
            return shown_range(Field::Temperature, seen, ambient, gamma, 1.0);
        }
    };
    [0.0, if seen[0] > seen[1] { smallest } else { seen[1].max(smallest) }]
}

/// Caption of a field's colour bar, with the unit.
#[must_use]
pub fn caption(field: Field) -> &'static str {
    named(Place::Cell, field.keyword())
}

/// Symbol of a field in equations.
#[must_use]
pub fn symbol(field: Field) -> String {
    quantity::find(Place::Cell, field.keyword()).map_or_else(String::new, |quantity| quantity::letters(quantity.symbol))
}

/// p / rho^gamma of a state.
pub(super) fn entropy(state: &GasState, gamma: f64) -> f64 {
    state.pressure / state.density.powf(gamma)
}

/// Whether the range of a field always starts at zero.
fn starts_at_zero(field: Field) -> bool {
    match field {
        Field::Velocity | Field::Schlieren | Field::Mach | Field::Vorticity => true,
        Field::Impulse | Field::PeakPlasticStrain | Field::Dust => true,
        Field::Density
        | Field::Pressure
        | Field::Temperature
        | Field::Entropy
        | Field::MassFraction
        | Field::Owed
        | Field::PeakPressure => false,
    }
}

/// The range to show for the values seen: from zero for magnitudes, and never so narrow that rounding becomes a pattern.
pub(super) fn shown_range(field: Field, seen: [f64; 2], ambient: &GasState, gamma: f64, spacing: f64) -> [f64; 2] {
    let sound_speed = (gamma * ambient.pressure / ambient.density).sqrt();
    let scale = match field {
        Field::Density | Field::Owed | Field::Dust => ambient.density,
        Field::Entropy => entropy(ambient, gamma),
        Field::Pressure | Field::PeakPressure => ambient.pressure,
        Field::Impulse => ambient.pressure * spacing / sound_speed,
        Field::Temperature => ambient.pressure / ambient.density,
        Field::Velocity => sound_speed,
        Field::Mach | Field::PeakPlasticStrain | Field::MassFraction => 1.0,
        Field::Schlieren => ambient.density / spacing,
        Field::Vorticity => sound_speed / spacing,
    };
    let smallest = SMALLEST_CONTRAST * scale;
    if seen[0] > seen[1] {
        let middle = if field == Field::Owed { 0.0 } else { scale };
        return if starts_at_zero(field) { [0.0, smallest] } else { [middle - smallest, middle + smallest] };
    }
    if starts_at_zero(field) {
        return [0.0, seen[1].max(smallest)];
    }
    let missing = (smallest - (seen[1] - seen[0])).max(0.0);
    [seen[0] - 0.5 * missing, seen[1] + 0.5 * missing]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_never_empty() {
        let air = GasState::new(1.0, 1.0);
        let range = shown_range(Field::Density, [1.0, 1.0], &air, 1.4, 0.1);
        assert!((range[1] - range[0] - 2e-3).abs() < 1e-12);
        assert_eq!(shown_range(Field::Velocity, [0.5, 3.0], &air, 1.4, 0.1), [0.0, 3.0]);
        let nothing = shown_range(Field::Pressure, [f64::INFINITY, f64::NEG_INFINITY], &air, 1.4, 0.1);
        assert!(nothing[0] < nothing[1]);
    }
}
