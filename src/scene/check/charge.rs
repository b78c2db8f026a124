//! Checks of charges.

use crate::explosive::EXPLOSIVES;
use crate::scene::Charge;
use crate::scene::check::{Check, shape};
use crate::spelling::did_you_mean;

/// Charges of a scene at most.
const MOST_CHARGES: usize = 100;
/// Share of its radius by which a ball is uneven at most.
const MOST_ROUGHNESS: f64 = 0.3;
/// Masses \[kg\] that are taken for masses.
const MASSES: [f64; 2] = [1e-9, 1e9];

impl Check<'_> {
    /// What charges are.
    pub(crate) fn charges(&mut self) {
        let scene = self.scene;
        if scene.charges.len() > MOST_CHARGES {
            let message = format!("{} charges", scene.charges.len());
            return self.add("charges", message, format!("give at most {MOST_CHARGES}"));
        }
        for (index, charge) in scene.charges.iter().enumerate() {
            self.charge(&format!("charges[{index}]"), charge);
        }
    }

    /// Where charges are. Asked of a scene that is sound else.
    pub(crate) fn charge_places(&mut self) {
        let scene = self.scene;
        for (index, charge) in scene.charges.iter().enumerate() {
            self.charge_place(&format!("charges[{index}]"), charge);
        }
    }

    fn charge(&mut self, path: &str, charge: &Charge) {
        if charge.made_of().is_none() {
            let known = EXPLOSIVES.map(|explosive| format!("\"{}\"", explosive.name)).join(", ");
            let meant = did_you_mean(&charge.explosive, EXPLOSIVES.iter().map(|explosive| explosive.name));
            let message = format!("`{}` is no explosive that is known", charge.explosive);
            self.wrong_value(format!("{path}.explosive"), message, format!("give one of {known}{meant}"));
        }
        if !(MASSES[0]..=MASSES[1]).contains(&charge.mass) {
            let help =
                format!("give a number from {:e} to {:e} [kg]; the scene must be in kg, m and s", MASSES[0], MASSES[1]);
            self.out_of_range(format!("{path}.mass"), charge.mass, help);
        }
        if !(charge.time >= 0.0 && charge.time.is_finite()) {
            self.out_of_range(format!("{path}.time"), charge.time, "give a time from 0 on [s]");
        }
        if let Some(name) = charge.species.as_ref().filter(|name| !self.scene.gas.species.contains_key(*name)) {
            let help = match self.scene.gas.species.keys().next() {
                Some(own) => format!("give \"{own}\", or leave it out"),
                None => format!("add a table [gas.species.{name}] with gamma; products of TNT have 1.3"),
            };
            self.wrong_value(format!("{path}.species"), format!("there is no gas `{name}`"), help);
        }
        if !(0.0..=MOST_ROUGHNESS).contains(&charge.roughness) {
            let help = format!("give a share of the radius from 0 to {MOST_ROUGHNESS}");
            self.out_of_range(format!("{path}.roughness"), charge.roughness, help);
        }
        if let Some(reach) = charge.near_field {
            self.positive(format!("{path}.near_field"), reach, "[m]");
        }
        self.planar(format!("{path}.center"), charge.center);
    }

    fn charge_place(&mut self, path: &str, charge: &Charge) {
        let (scene, center) = (self.scene, format!("{path}.center"));
        let place = format!("{:?}", &charge.center[..scene.domain.axes()]);
        let inside = |d: usize| {
            let low = charge.center[d] - scene.domain.origin[d];
            (0.0..=scene.domain.size[d]).contains(&low)
        };
        if !(0..scene.domain.axes()).all(inside) {
            return self.add(center, format!("{place} lies outside the domain"), shape::extent(&scene.domain));
        }
        let bodies = scene.bodies.iter().map(|body| ("body", &body.name, &body.shape));
        let obstacles = scene.obstacles.iter().map(|obstacle| ("obstacle", &obstacle.name, &obstacle.shape));
        for (kind, name, shape) in bodies.chain(obstacles) {
            if shape.distance(charge.center) < 0.0 {
                let help = "a charge lies in gas: move it out, or hollow the shape";
                return self.add(center, format!("{place} lies inside {kind} `{name}`"), help);
            }
        }
        let longest = scene.longest_side();
        let radius = charge.made_of().map_or(0.0, |explosive| scene.ball(charge, explosive).radius());
        if 2.0 * radius > longest {
            let message = format!("a charge of radius {radius:.3e} m in a domain of {longest:.3e} m");
            let help = "all of the domain would be products: give less mass [kg], or a larger domain";
            return self.add(format!("{path}.mass"), message, help);
        }
        let Some(placed) = scene.placed(charge) else {
            return self.add(center, format!("there is no gas around {place}"), "move the charge");
        };
        let least = placed.reach;
        if scene.open_distance(charge.center) < least {
            let message = format!(
                "{place} is nearer to an open or periodic side than {least:.3e} m, the reach of its near field"
            );
            self.add(center, message, "move it away from there, or use smaller cells");
        }
    }
}
