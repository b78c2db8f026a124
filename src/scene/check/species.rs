//! Checks of the second gas.

use crate::explosive::EXPLOSIVES;
use crate::scene::Species;
use crate::scene::check::Check;
use crate::spelling::did_you_mean;

impl Check<'_> {
    pub(crate) fn species(&mut self) {
        for (index, (name, own)) in self.scene.gas.species.iter().enumerate() {
            let path = format!("gas.species.{name}");
            if index > 0 {
                self.add(&path, "there is a second gas already", "leave one: a scene has two gases at most");
            }
            self.species_law(&path, own);
            self.afterburn(&path, own);
        }
    }

    /// Either an ideal gas or the products of an explosive.
    fn species_law(&mut self, path: &str, own: &Species) {
        match (own.gamma, &own.explosive) {
            (Some(_), None) => {}
            (None, Some(name)) => self.known_explosive(format!("{path}.explosive"), name),
            (Some(_), Some(_)) => {
                let help = "leave one of them out: products have the ratio that follows from their explosive";
                self.add(path, "`gamma` and `explosive` are both given", help);
            }
            (None, None) => {
                let help = "give gamma, helium has 1.667, or explosive = \"tnt\" for its products";
                self.add(path, "`gamma` is missing", help);
            }
        }
    }

    /// Burning in air is for the products of an explosive.
    fn afterburn(&mut self, path: &str, own: &Species) {
        if own.afterburn.is_some() && own.explosive.is_none() {
            let help = "give explosive = \"tnt\" in place of gamma, or leave afterburn out";
            self.add(format!("{path}.afterburn"), "it is for the products of an explosive", help);
        }
    }

    /// A name of an explosive.
    pub(crate) fn known_explosive(&mut self, path: String, name: &str) {
        if EXPLOSIVES.iter().all(|explosive| explosive.name != name) {
            let known = EXPLOSIVES.map(|explosive| format!("\"{}\"", explosive.name)).join(", ");
            let meant = did_you_mean(name, EXPLOSIVES.iter().map(|explosive| explosive.name));
            let message = format!("`{name}` is no explosive that is known");
            self.wrong_value(path, message, format!("give one of {known}{meant}"));
        }
    }
}
