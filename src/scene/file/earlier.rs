//! Scenes that earlier programs wrote beside their states: each key is put where this program has it.
//!
//! States of an earlier form are only looked at, so that keys without a place here are left out: nothing that is shown asks for them.

use serde_json::{Map, Value};

use crate::scene::Scene;
use crate::scene::numerics::GONE;

/// Form of the scenes that runs write down: it grows when a key of them gets another place, another name or another meaning.
pub const FORM: u32 = 2;

/// Tables of `numerics` with the keys that the first form had beside them.
const PARTED: [(&str, &[&str]); 2] = [
    ("paper", &["face_velocity", "obstacles", "interface", "ghost", "coupling", "solid_update", "solid_threshold"]),
    ("expert", &["preconditioner", "max_iterations", "elastic_cfl", "elastic_tolerance", "transfer"]),
];
/// Words of the first form for ways to sum particles, which leave the same kind of state.
const TRANSFERS: [&str; 2] = ["gather", "scatter"];

impl Scene {
    /// A scene that a run wrote down in some form, as data: the same in the words of this program.
    #[must_use]
    pub fn of_form(form: u32, mut scene: Value) -> Value {
        if form < FORM
            && let Some(scene) = scene.as_object_mut()
        {
            // nobody asks a run that is over for its variants
            scene.remove("variants");
            scene.get_mut("numerics").and_then(Value::as_object_mut).into_iter().for_each(parted);
        }
        scene
    }

    /// The same with the text of a scene.
    ///
    /// # Errors
    /// If the text is no TOML.
    pub fn text_of_form(form: u32, text: &str) -> Result<String, String> {
        if form >= FORM {
            return Ok(text.to_owned());
        }
        let read: Value = toml::from_str(text).map_err(|error| error.to_string())?;
        toml::to_string(&Scene::of_form(form, read)).map_err(|error| error.to_string())
    }
}

/// The numerics of the first form, in tables.
fn parted(numerics: &mut Map<String, Value>) {
    let gone = |key: &String| GONE.iter().any(|(own, _)| own.strip_prefix("numerics.") == Some(key));
    numerics.retain(|key, value| !gone(key) && !value.as_str().is_some_and(|word| TRANSFERS.contains(&word)));
    for (name, keys) in PARTED {
        let moved: Map<String, Value> = keys.iter().filter_map(|key| numerics.remove_entry(*key)).collect();
        if let Some(table) = numerics.entry(name).or_insert_with(|| Value::Object(Map::new())).as_object_mut() {
            table.extend(moved);
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn keys_of_the_first_form_stand_where_they_stand_today() {
        let first = json!({
            "title": "a",
            "numerics": {
                "pair": "b1b0", "tolerance": 1e-6, "obstacles": "cells", "solid_threshold": 0.4, "elastic_cfl": 0.3,
                "transfer": "scatter", "ledger": false, "power": "midpoint", "expert": { "max_iterations": 7 },
            },
            "variants": { "small": { "numerics.obstacles": "cut" } },
        });
        let wanted = json!({
            "title": "a",
            "numerics": {
                "pair": "b1b0", "tolerance": 1e-6,
                "paper": { "obstacles": "cells", "solid_threshold": 0.4 },
                "expert": { "elastic_cfl": 0.3, "max_iterations": 7 },
            },
        });
        assert_eq!(Scene::of_form(1, first.clone()), wanted);
        assert_eq!(Scene::of_form(FORM, first.clone()), first, "a scene of this form stays");
        let text = toml::to_string(&first).unwrap();
        let read: Value = toml::from_str(&Scene::text_of_form(1, &text).unwrap()).unwrap();
        assert_eq!(read, wanted);
        assert_eq!(Scene::text_of_form(FORM, "= no scene").unwrap(), "= no scene");
        assert!(Scene::text_of_form(1, "= no scene").is_err());
        for odd in
            [json!(null), json!([1]), json!({ "numerics": 3 }), json!({ "numerics": { "paper": 1, "ghost": 2 } })]
        {
            let _ = Scene::of_form(1, odd);
        }
    }
}
