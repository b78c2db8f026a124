//! Numbers that the device sees: it computes in single precision, and kernels square, multiply and divide.

use crate::math::plain;
use crate::scene::check::Check;
use crate::scene::finding::Told;
use crate::scene::{Boundary, GasState, Material};

/// Least number whose square is a normal number in single precision.
const LEAST: f64 = 1.1e-19;
/// Largest number whose square is finite in single precision.
const MOST: f64 = 1.8e19;
/// Least number that is normal in single precision.
const LEAST_PLAIN: f64 = 1.2e-38;
/// Largest number that is finite in single precision.
const MOST_PLAIN: f64 = 3.4e38;
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
        self.seen("gravity", &scene.gravity, LEAST_PLAIN, MOST);
        self.state_range("gas.ambient", &scene.gas.ambient);
        for (index, region) in scene.gas.regions.iter().enumerate() {
            self.state_range(&format!("gas.regions[{index}]"), &region.state);
        }
        for (side, name) in scene.boundary.sides().into_iter().zip(crate::scene::Boundaries::NAMES) {
            for rule in side.rules() {
                self.rule_range(&format!("boundary.{name}"), rule);
            }
        }
        for (name, material) in &scene.materials {
            self.material_range(name, material);
        }
        for (index, body) in scene.bodies.iter().enumerate() {
            self.seen(&format!("bodies[{index}].density"), scene.density_of(body).as_slice(), LEAST, MOST);
            self.seen(&format!("bodies[{index}].velocity"), &body.velocity, LEAST_PLAIN, MOST);
            self.seen(&format!("bodies[{index}].spin"), &body.spin, LEAST_PLAIN, MOST);
        }
        let time = &scene.time;
        self.seen("time.until", &[time.until], LEAST_PLAIN, MOST);
        self.seen("time.fixed_step", time.fixed_step.as_slice(), LEAST_PLAIN, MOST);
        self.seen("time.max_courant", &[time.max_courant], LEAST, MOST);
        self.seen("time.max_growth", &[time.max_growth], 1.0, MOST);
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
        self.seen("domain.origin", &domain.origin, LEAST_PLAIN, MOST);
    }

    fn state_range(&mut self, path: &str, state: &GasState) {
        self.seen(&format!("{path}.density"), &[state.density], LEAST, MOST);
        self.seen(&format!("{path}.pressure"), &[state.pressure], LEAST, MOST);
        self.seen(&format!("{path}.velocity"), &state.velocity, LEAST_PLAIN, MOST);
    }

    fn rule_range(&mut self, path: &str, rule: &Boundary) {
        match rule {
            Boundary::Inlet(state) | Boundary::FarField(state) => self.state_range(path, state),
            Boundary::SubsonicInlet(inflow) => {
                self.seen(&format!("{path}.density"), &[inflow.density], LEAST, MOST);
                self.seen(&format!("{path}.velocity"), &inflow.velocity, LEAST_PLAIN, MOST);
            }
            Boundary::TotalInlet(total) => {
                self.seen(&format!("{path}.density"), &[total.density], LEAST, MOST);
                self.seen(&format!("{path}.pressure"), &[total.pressure], LEAST, MOST);
            }
            Boundary::TimedInlet(inlet) => {
                for (number, at) in inlet.table.iter().enumerate() {
                    let path = format!("{path}.timed_inlet.table[{number}]");
                    self.seen(&format!("{path}.time"), &[at.time], LEAST_PLAIN, MOST);
                    self.seen(&format!("{path}.density"), &[at.density], LEAST, MOST);
                    self.seen(&format!("{path}.pressure"), &[at.pressure], LEAST, MOST);
                    self.seen(&format!("{path}.velocity"), &at.velocity, LEAST_PLAIN, MOST);
                }
            }
            Boundary::PressureOutlet(outlet) => {
                self.seen(&format!("{path}.pressure"), &[outlet.pressure], LEAST, MOST);
            }
            Boundary::AttenuatedOutlet(outlet) => {
                let (density, velocity, pressure) = (outlet.density, outlet.velocity, outlet.pressure);
                self.state_range(path, &GasState { density, velocity, pressure, mass_fraction: 0.0 });
            }
            Boundary::Wall | Boundary::Outlet | Boundary::Periodic | Boundary::Patched(_) => {}
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
