//! Numbers that the device sees: it computes in single precision, and kernels square, multiply and divide.

use serde_json::Value;

use crate::math::plain;
use crate::scene::Material;
use crate::scene::check::Check;
use crate::scene::finding::Told;

/// Least number whose square is a normal number in single precision.
const LEAST: f64 = 1.1e-19;
/// Largest number whose square is finite in single precision.
const MOST: f64 = 1.8e19;
/// Least number that is normal in single precision.
const LEAST_PLAIN: f64 = 1.2e-38;
/// Largest number that is finite in single precision.
const MOST_PLAIN: f64 = 3.4e38;
/// Sizes that numbers of these keys may have.
const SEEN: [(&[&str], [f64; 2]); 3] = [
    (&["density", "pressure", "max_courant"], [LEAST, MOST]),
    (&["velocity", "spin", "gravity", "origin", "until", "fixed_step", "time"], [LEAST_PLAIN, MOST]),
    (&["max_growth"], [1.0, MOST]),
];
/// Ratios of specific heats that single precision tells from 1, and that energies bear.
const GAMMA: [f64; 2] = [1.0001, 1000.0];

impl Check<'_> {
    /// Every number of the scene that kernels see. Where something else is wrong with one, its range says nothing.
    pub(crate) fn ranges(&mut self) {
        let before = std::mem::take(&mut self.findings);
        self.all_ranges();
        if self.findings.is_empty() {
            self.products();
        }
        let mut own = std::mem::replace(&mut self.findings, before);
        let told = Told::new(&self.findings);
        own.retain(|finding| !told.below(&finding.path));
        self.findings.extend(own);
    }

    fn all_ranges(&mut self) {
        let scene = self.scene;
        if !(GAMMA[0]..=GAMMA[1]).contains(&scene.gas.gamma) {
            let help = format!("give a number from {} to {}; air has 1.4", GAMMA[0], GAMMA[1]);
            self.add("gas.gamma", format!("{} is out of the range of single precision", scene.gas.gamma), help);
        }
        self.cell_range();
        // numbers that are not finite become null, and others have told them
        let values = serde_json::to_value(scene).unwrap_or_default();
        for section in ["domain", "gravity", "gas", "boundary", "bodies", "time"] {
            self.seen_below(section, section, &values[section]);
        }
        for (name, material) in &scene.materials {
            self.material_range(name, material);
        }
    }

    /// Numbers of the keys that kernels see; amplitudes of waves, and sizes of shapes, may be as small as they like.
    fn seen_below(&mut self, path: &str, key: &str, value: &Value) {
        match value {
            Value::Object(values) => {
                for (key, value) in values.iter().filter(|(key, _)| !["waves", "shape"].contains(&key.as_str())) {
                    self.seen_below(&format!("{path}.{key}"), key, value);
                }
            }
            Value::Array(entries) if entries.iter().any(Value::is_object) => {
                let each = entries.iter().enumerate();
                each.for_each(|(index, entry)| self.seen_below(&format!("{path}[{index}]"), key, entry));
            }
            value => {
                let numbers: Vec<f64> = match value {
                    Value::Array(entries) => entries.iter().filter_map(Value::as_f64).collect(),
                    single => single.as_f64().into_iter().collect(),
                };
                let bounds = SEEN.iter().find(|(keys, _)| keys.contains(&key));
                bounds.into_iter().for_each(|(_, [least, most])| self.seen(path, &numbers, *least, *most));
            }
        }
    }

    /// Numbers that are 0, or lie in a range.
    fn seen(&mut self, path: &str, numbers: &[f64], least: f64, most: f64) {
        let out = |number: &&f64| **number != 0.0 && !(least..=most).contains(&number.abs());
        if let Some(number) = numbers.iter().find(out) {
            let message = format!("{} is out of the range of single precision", plain(*number));
            let help = format!(
                "give a size from {} to {}; other units, in which numbers lie near 1, help",
                plain(least),
                plain(most)
            );
            self.add(path, message, help);
        }
    }

    fn cell_range(&mut self) {
        let domain = &self.scene.domain;
        let edge = domain.spacing();
        // cubes of edges are volumes, squares of their inverses stand in the pressure system
        let [least, most] = [1e-12, 1e12];
        if !(least..=most).contains(&edge) {
            let message = format!("cells of edge {} m are out of the range of single precision", plain(edge));
            self.add(
                "domain.size",
                message,
                format!("give cells of edge {} to {} m; use other units", plain(least), plain(most)),
            );
        }
    }

    /// Moduli and yield stresses are squared by return maps.
    fn material_range(&mut self, name: &str, material: &Material) {
        let before = self.findings.len();
        for (parameter, number) in material.parameters().filter(|(_, number)| number.is_finite()) {
            self.seen(&format!("materials.{name}.{}.{parameter}", material.keyword()), &[number], LEAST_PLAIN, MOST);
        }
        if self.findings.len() > before {
            return;
        }
        let own = material.params(self.scene.volume_share());
        let moduli = [own.mu, own.lambda, own.ghost_modulus, own.hardening].map(f64::from);
        let yields = Some(f64::from(own.yield_stress)).filter(|stress| *stress < f64::from(f32::MAX));
        self.seen(&format!("materials.{name}.{}", material.keyword()), &moduli, LEAST, MOST);
        self.seen(&format!("materials.{name}.{}", material.keyword()), yields.as_slice(), LEAST, MOST);
    }

    /// Energies and squares of speeds, of states whose own numbers are in range.
    fn products(&mut self) {
        let scene = self.scene;
        let regions = scene.gas.regions.iter().enumerate();
        let regions = regions.map(|(index, region)| (format!("gas.regions[{index}]"), &region.state));
        for (path, state) in std::iter::once(("gas.ambient".to_owned(), &scene.gas.ambient)).chain(regions) {
            let gases = scene.gas.equation_of_state();
            let energy = gases.conserved(state)[4];
            let square = state.sound_speed(gases.gamma_at(gases.volume_fraction(state.mass_fraction))).powi(2);
            for (what, value) in [("energy per volume", energy), ("square of the speed of sound", square)] {
                if !(LEAST_PLAIN..=MOST_PLAIN).contains(&value) {
                    let message = format!("its {what}, {}, is out of the range of single precision", plain(value));
                    self.add(path.as_str(), message, "use other units, in which density and pressure lie near 1");
                }
            }
        }
    }
}
