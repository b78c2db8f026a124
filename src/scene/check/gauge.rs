//! Checks of gauges.

use crate::scene::check::Check;
use crate::scene::{Boundary, Gauge, GaugePlace};

/// Gauges of a scene at most.
const MOST_GAUGES: usize = 1000;

impl Check<'_> {
    pub(crate) fn gauges(&mut self) {
        let scene = self.scene;
        if scene.gauges.len() > MOST_GAUGES {
            return self.add("gauges", format!("{} gauges", scene.gauges.len()), format!("give at most {MOST_GAUGES}"));
        }
        for (index, gauge) in scene.gauges.iter().enumerate() {
            let path = format!("gauges[{index}]");
            if scene.probes.iter().any(|probe| probe.name == gauge.name) {
                let message = format!("`{}` is the name of a probe", gauge.name);
                self.add(format!("{path}.name"), message, "give gauges and probes names of their own");
            }
            match scene.gauge_place(gauge) {
                None => self.gauge_without_place(&path, gauge),
                Some(GaugePlace::Side(side)) => self.gauge_side(format!("{path}.side"), side),
                Some(GaugePlace::Point(body, point)) => self.gauge_point(format!("{path}.point"), body, point),
                Some(_) => {}
            }
        }
    }

    fn gauge_without_place(&mut self, path: &str, gauge: &Gauge) {
        let scene = self.scene;
        let given = [gauge.side.is_some(), gauge.obstacle.is_some(), gauge.body.is_some()];
        if given.iter().filter(|given| **given).count() != 1 {
            let help = "give one of `side`, `obstacle` and `body`; `probes` measure in the gas";
            return self.add(path, "it is not said what the gauge sits on, or more than one thing", help);
        }
        if gauge.point.is_some() && gauge.body.is_none() {
            let help = "a point moves with the material of a `body`; leave it out";
            return self.add(format!("{path}.point"), "walls and obstacles do not move", help);
        }
        let (key, name, names): (_, _, Vec<&str>) = match (&gauge.obstacle, &gauge.body) {
            (Some(name), _) => ("obstacle", name, scene.obstacles.iter().map(|own| own.name.as_str()).collect()),
            (_, Some(name)) => ("body", name, scene.bodies.iter().map(|own| own.name.as_str()).collect()),
            _ => return,
        };
        let like = crate::spelling::did_you_mean(name, names.iter().copied());
        let help = if names.is_empty() { format!("the scene has no {key}") } else { format!("there are {names:?}") };
        self.wrong_value(format!("{path}.{key}"), format!("unknown {key} `{name}`{like}"), help);
    }

    fn gauge_side(&mut self, path: String, side: usize) {
        let wall = |rule: &&Boundary| **rule == Boundary::Wall;
        if side / 2 >= self.scene.domain.axes() {
            self.add(path, "the domain has no such axis", "name a side of an active axis");
        } else if !self.scene.boundary.sides()[side].rules().iter().any(wall) {
            self.add(
                path,
                "no part of this side is a wall",
                "what crosses open sides is in diagnostics.csv: `crossed_*`",
            );
        }
    }

    fn gauge_point(&mut self, path: String, body: usize, point: [f64; 3]) {
        let (shape, spacing) = (&self.scene.bodies[body].shape, self.scene.domain.spacing());
        let distance = shape.distance(point);
        if distance > 0.5 * spacing || distance.is_nan() {
            let help = format!("give a place inside of it, where it is at the start; {distance:.3} m are missing");
            let message = format!("{point:?} lies outside of `{}`", self.scene.bodies[body].name);
            self.add(path, message, help);
        }
    }
}
