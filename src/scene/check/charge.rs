//! Checks of charges.

use crate::scene::Charge;
use crate::scene::check::{Check, shape};

/// Charges of a scene at most.
const MOST_CHARGES: usize = 100;

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
        self.known_explosive(format!("{path}.explosive"), &charge.explosive);
        if charge.shape.is_some() {
            self.shaped_charge(path, charge)
        } else {
            self.ball(path, charge)
        }
        if let Some(name) = charge.species.as_ref().filter(|name| !self.scene.gas.species.contains_key(*name)) {
            let help = match self.scene.gas.species.keys().next() {
                Some(own) => format!("give \"{own}\", or leave it out"),
                None => format!("add a table [gas.species.{name}] with gamma; products of TNT have 1.3"),
            };
            self.wrong_value(format!("{path}.species"), format!("there is no gas `{name}`"), help);
        }
    }

    /// A charge without a shape.
    fn ball(&mut self, path: &str, charge: &Charge) {
        if !charge.detonate_at.is_empty() {
            let help = "leave it out: a ball is set off in its middle; or give a shape in place of mass and center";
            self.add(format!("{path}.detonate_at"), "it is for a charge with a shape", help);
        }
        if charge.ball().is_none() {
            let help = "give mass [kg] and center [m], or shape";
            self.add(path, "it does not say how much there is, and where", help);
        }
    }

    /// A charge that stands on the grid.
    fn shaped_charge(&mut self, path: &str, charge: &Charge) {
        let ball = [
            ("center", charge.center.is_some()),
            ("near_field", charge.near_field.is_some()),
            ("roughness", charge.roughness != 0.0),
        ];
        for (key, _) in ball.into_iter().filter(|(_, given)| *given) {
            let help = "leave it out, or the shape: where a shape is follows from it";
            self.add(format!("{path}.{key}"), "it is for a charge without a shape", help);
        }
        if charge.afterburn {
            let help = "give the time constant of burning as gas.species.products.afterburn";
            self.add(format!("{path}.afterburn"), "it is for the near field of a charge without a shape", help);
        }
        if charge.mass.is_some_and(|mass| mass > 0.0) {
            let help = "give a smaller mass [kg], a larger domain, or a shape that ends and lies in gas";
            self.add(format!("{path}.mass"), "the shape cannot be brought to this mass within the gas", help);
        }
        let own = charge.species.as_ref().and_then(|name| self.scene.gas.species.get(name));
        if own.and_then(|species| species.explosive.as_ref()) != Some(&charge.explosive) {
            let message = "the gas that its products are is not that of its explosive";
            let help = format!(
                "give species = \"products\", and a table [gas.species.products] with explosive = \"{}\"",
                charge.explosive
            );
            self.wrong_value(format!("{path}.species"), message.to_owned(), help);
        }
    }

    /// Where it is set off, and whether the detonation comes everywhere.
    fn detonation(&mut self, path: &str, charge: &Charge) {
        let Some(shape) = &charge.shape else { return };
        for (index, point) in charge.detonators().into_iter().enumerate() {
            if shape.distance(point) > 0.0 {
                let place = format!("{:?}", &point[..self.scene.domain.axes()]);
                let (key, help) = match charge.detonate_at.is_empty() {
                    true => (path.to_owned(), "its middle is no part of it: give detonate_at, points within"),
                    false => (format!("{path}.detonate_at[{index}]"), "give points within the shape"),
                };
                return self.add(key, format!("{place} lies outside of the charge"), help);
            }
        }
        if self.scene.burn_times().iter().flatten().any(|time| time.is_infinite()) {
            let help = "give detonate_at, a point in each of its parts";
            self.add(format!("{path}.shape"), "the detonation does not come everywhere", help);
        }
    }

    fn charge_place(&mut self, path: &str, charge: &Charge) {
        let Some((_, own)) = charge.ball() else { return self.detonation(path, charge) };
        let (scene, center) = (self.scene, format!("{path}.center"));
        let place = format!("{:?}", &own[..scene.domain.axes()]);
        let inside = |d: usize| {
            let low = own[d] - scene.domain.origin[d];
            (0.0..=scene.domain.size[d]).contains(&low)
        };
        if !(0..scene.domain.axes()).all(inside) {
            return self.add(center, format!("{place} lies outside the domain"), shape::extent(&scene.domain));
        }
        let bodies = scene.bodies.iter().map(|body| ("body", &body.name, &body.shape));
        let obstacles = scene.obstacles.iter().map(|obstacle| ("obstacle", &obstacle.name, &obstacle.shape));
        for (kind, name, shape) in bodies.chain(obstacles) {
            if shape.distance(own) < 0.0 {
                let help = "a charge lies in gas: move it out, or hollow the shape";
                return self.add(center, format!("{place} lies inside {kind} `{name}`"), help);
            }
        }
        let longest = scene.longest_side();
        let ball = charge.made_of().and_then(|explosive| scene.ball(charge, explosive));
        let radius = ball.map_or(0.0, |ball| ball.radius());
        if 2.0 * radius > longest {
            let message = format!("a charge of radius {radius:.3e} m in a domain of {longest:.3e} m");
            let help = "all of the domain would be products: give less mass [kg], or a larger domain";
            return self.add(format!("{path}.mass"), message, help);
        }
        let Some(placed) = scene.placed(charge) else {
            return self.add(center, format!("there is no gas around {place}"), "move the charge");
        };
        let least = placed.reach;
        if scene.open_distance(own) < least {
            let message = format!(
                "{place} is nearer to an open or periodic side than {least:.3e} m, the reach of its near field"
            );
            self.add(center, message, "move it away from there, or use smaller cells");
        }
    }
}
