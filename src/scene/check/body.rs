//! Checks of materials and bodies, and of all names.

use std::collections::BTreeSet;

use crate::material::{Material, PRESETS, kind_names};
use crate::scene::Body;
use crate::scene::check::Check;
use crate::spelling::did_you_mean;

/// Bodies that one scene may have.
pub const MAX_BODIES: usize = 1024;

/// Bytes that titles and names have at most.
const MOST_LETTERS: usize = 200;

impl Check<'_> {
    pub(crate) fn names(&mut self) {
        let scene = self.scene;
        if scene.title.len() > MOST_LETTERS || scene.title.chars().any(char::is_control) {
            let length = scene.title.len();
            let long = length > MOST_LETTERS;
            let message = if long { format!("{length} bytes") } else { "it holds control characters".to_owned() };
            self.add("title", message, format!("give one line of at most {MOST_LETTERS} bytes; films carry it"));
        }
        let bodies = scene.bodies.iter().map(|body| body.name.as_str()).collect::<Vec<_>>();
        let obstacles = scene.obstacles.iter().map(|obstacle| obstacle.name.as_str()).collect::<Vec<_>>();
        let probes = scene.probes.iter().map(|probe| probe.name.as_str()).collect::<Vec<_>>();
        let gauges = scene.gauges.iter().map(|gauge| gauge.name.as_str()).collect::<Vec<_>>();
        let charges = scene.charges.iter().map(|charge| charge.name.as_str()).collect::<Vec<_>>();
        let lists = [
            ("bodies", bodies),
            ("obstacles", obstacles),
            ("probes", probes),
            ("gauges", gauges),
            ("charges", charges),
        ];
        for (list, names) in lists {
            let mut seen = BTreeSet::new();
            for (index, name) in names.into_iter().enumerate() {
                let plain = |c: char| !(c.is_control() || [',', '"'].contains(&c));
                if name.is_empty() || name.starts_with('=') || name.len() > MOST_LETTERS || !name.chars().all(plain) {
                    let help = "names head columns of tables: give short text without commas, quotes, line breaks or other control \
                                characters, and no `=` in front";
                    self.wrong_value(format!("{list}[{index}].name"), format!("`{name}` is no name"), help);
                } else if !seen.insert(name) {
                    let help = "give every entry its own name";
                    self.wrong_value(format!("{list}[{index}].name"), format!("`{name}` is taken"), help);
                }
            }
        }
    }

    pub(crate) fn bodies(&mut self) {
        let scene = self.scene;
        for (name, material) in &scene.materials {
            if material.fracture().is_some_and(|own| own.johnson_cook.is_some())
                && material.yield_stress().is_infinite()
            {
                let help = "voids grow with plastic flow: give a law that yields, or a `tensile_strength`";
                self.add(format!("materials.{name}.fracture.johnson_cook"), "the law does not yield", help);
            }
            self.flow(name, material);
            if let Some([strength, most]) = material.beyond_strength() {
                let help = format!(
                    "give at most a tenth of Young's modulus, {most:e} [Pa]: are the units those of the scene?"
                );
                self.out_of_range(format!("materials.{name}.fracture.tensile_strength"), strength, help);
            }
        }
        if scene.bodies.len() > MAX_BODIES {
            let help = format!("give at most {MAX_BODIES}; parts of one material may be one body, a union of shapes");
            self.add("bodies", format!("{} bodies", scene.bodies.len()), help);
        }
        for (index, body) in scene.bodies.iter().enumerate() {
            let path = format!("bodies[{index}]");
            if scene.density_of(body).is_none() {
                let help = "give a number above 0 [kg m^-3]; only presets of materials bring their own";
                self.add(format!("{path}.density"), "no density", help);
            }
            self.turning(format!("{path}.spin"), body.spin);
            self.material_of(&path, body);
            self.held(&path, body);
        }
    }

    /// Flow stress by strain, rate and temperature.
    fn flow(&mut self, name: &str, material: &Material) {
        let path = format!("materials.{name}");
        let voids = material.fracture().and_then(|own| own.johnson_cook);
        let Some(flow) = material.flow() else {
            if let Some(d5) = voids.map(|own| own.d5).filter(|d5| *d5 != 0.0 && !material.yield_stress().is_infinite())
            {
                let help =
                    "it counts from the temperature of plastic flow: give `flow` beside the law, or leave `d5` out";
                self.out_of_range(format!("{path}.fracture.johnson_cook.d5"), d5, help);
            }
            return;
        };
        if let Some((key, value, help)) = flow.mistake() {
            self.out_of_range(format!("{path}.flow.{key}"), value, help);
        }
    }

    fn material_of(&mut self, path: &str, body: &Body) {
        if self.scene.materials.contains_key(&body.material) {
            return;
        }
        let known = self.scene.materials.keys().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
        let help = if known.is_empty() {
            format!("the scene has no materials; add [materials.{}] with one of {}", body.material, kind_names())
        } else {
            format!("the scene has {known}")
        };
        let presets = PRESETS.iter().map(|preset| preset.name);
        let like = did_you_mean(&body.material, self.scene.materials.keys().map(String::as_str).chain(presets));
        self.wrong_value(format!("{path}.material"), format!("unknown material `{}`{like}", body.material), help);
    }

    /// What is clamped or moves as prescribed.
    fn held(&mut self, path: &str, body: &Body) {
        let Some(motion) = &body.motion else { return };
        let path = format!("{path}.motion");
        if body.clamped.is_none() && (body.velocity != [0.0; 3] || body.spin != [0.0; 3] || body.expansion != 0.0) {
            let help = "the whole body moves as `motion` says from the start: remove `velocity`, `spin` and `expansion` of the body";
            self.add(&path, "the body has a velocity of its own", help);
        }
        self.turning(format!("{path}.spin"), motion.spin);
        if !motion.table.is_empty() && (motion.velocity != [0.0; 3] || motion.spin != [0.0; 3]) {
            self.add(&path, "a constant velocity and a table", "give one of them");
        }
        for (index, entry) in motion.table.iter().enumerate() {
            self.turning(format!("{path}.table[{index}].spin"), entry.spin);
        }
        if !motion.table.iter().map(|entry| entry.time).is_sorted_by(|a, b| a < b) {
            self.add(format!("{path}.table"), "times do not rise", "give the entries in order of time, each time once");
        }
    }

    /// A body turns within the active axes only.
    fn turning(&mut self, path: String, spin: [f64; 3]) {
        let free = [3, 3, 2].map(|axes| self.scene.domain.axes() >= axes);
        if spin.iter().any(|rate| !rate.is_finite()) {
            self.add(path, format!("{spin:?} is not finite"), "give finite numbers");
        } else if spin.iter().zip(free).any(|(rate, free)| !free && *rate != 0.0) {
            let help = "in 2D a body turns about z alone, in 1D not at all: give one number, or none";
            self.add(path, format!("{spin:?} leaves the active axes"), help);
        }
    }
}
