//! Checks of dust on the ground.

use crate::scene::check::Check;
use crate::scene::{Boundaries, Boundary};
use crate::spelling::did_you_mean;

impl Check<'_> {
    pub(crate) fn dust(&mut self) {
        let Some(dust) = &self.scene.gas.dust else { return };
        if dust.sides.is_empty() && !dust.obstacles {
            let help = "give sides = [\"z_min\"] for dust on a side, or obstacles = true";
            self.add("gas.dust", "it lies nowhere", help);
        }
        if dust.obstacles && self.scene.obstacles.is_empty() {
            self.add("gas.dust.obstacles", "there are no obstacles", "leave the key out, or add [[obstacles]]");
        }
        let axes = self.scene.domain.axes();
        let names = &Boundaries::NAMES[..2 * axes.min(3)];
        for (index, name) in dust.sides.iter().enumerate() {
            let path = format!("gas.dust.sides[{index}]");
            let Some(side) = names.iter().position(|known| known == name) else {
                let known = names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
                let meant = did_you_mean(name, names.iter().copied());
                self.wrong_value(
                    path,
                    format!("`{name}` is no side of the domain"),
                    format!("give one of {known}{meant}"),
                );
                continue;
            };
            if dust.sides[..index].contains(name) {
                self.add(path, format!("`{name}` is named twice"), "leave one of them out");
            } else if !self.scene.boundary.sides()[side].rules().iter().any(|rule| **rule == Boundary::Wall) {
                let help = format!("name a side that is a wall, or leave boundary.{name} out, which makes it one");
                self.add(path, format!("`{name}` is no wall: dust lies on walls"), help);
            }
        }
    }
}
