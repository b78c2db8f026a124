//! States of gas by their temperature, or as the standard atmosphere has them: what stands in a file becomes density and pressure.

use std::borrow::Cow;

use serde_json::{Value, json};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::scene::file::mended;
use crate::scene::finding::Finding;
use crate::scene::species::AIR_CONSTANT;
use crate::scene::{Boundaries, Boundary, Scene};

/// Temperature \[K\], pressure \[Pa\] and fall of temperature \[K m^-1\] of the standard atmosphere at sea level.
const SEA_LEVEL: [f64; 3] = [288.15, 101_325.0, 0.0065];
/// Gravity of the standard atmosphere \[m s^-2\].
const GRAVITY: f64 = 9.806_65;
/// Heights for which its lowest layer stands \[m\].
const LAYER: [f64; 2] = [-5000.0, 11_000.0];
/// Keys of a state that become others.
const KEYS: [&str; 2] = ["temperature", "air"];

/// Temperature \[K\] and pressure \[Pa\] of the standard atmosphere at a height \[m\].
fn standard_atmosphere(altitude: f64) -> [f64; 2] {
    let [temperature, pressure, fall] = SEA_LEVEL;
    let here = temperature - fall * altitude;
    [here, pressure * (here / temperature).powf(GRAVITY / (AIR_CONSTANT * fall))]
}

/// Where a state stands.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Place {
    Ambient,
    Region(usize),
    /// Numbered as in [`Boundaries::sides`].
    Side(usize),
}

/// What `temperature` and `air` say of a state: density and pressure.
pub(crate) type Settled = (Place, [f64; 2]);

/// Takes `temperature` and `air` out of all states of a document and tells what they mean.
pub(crate) fn take(root: &mut DeTable<'_>, findings: &mut Vec<Finding>) -> Vec<Settled> {
    let mut all = Vec::new();
    let mut take = |place: Place, path: &str, state: &mut Spanned<DeValue<'_>>| {
        if let DeValue::Table(state) = state.get_mut() {
            all.extend(settle(path, state, findings).map(|settled| (place, settled)));
        }
    };
    if let Some(DeValue::Table(gas)) = root.get_mut("gas").map(Spanned::get_mut) {
        if let Some(ambient) = gas.get_mut("ambient") {
            take(Place::Ambient, "gas.ambient", ambient);
        }
        if let Some(DeValue::Array(regions)) = gas.get_mut("regions").map(Spanned::get_mut) {
            let each = regions.iter_mut().enumerate();
            each.for_each(|(index, region)| take(Place::Region(index), &format!("gas.regions[{index}]"), region));
        }
    }
    let Some(DeValue::Table(boundary)) = root.get_mut("boundary").map(Spanned::get_mut) else { return all };
    for (side, name) in Boundaries::NAMES.into_iter().enumerate() {
        let Some(DeValue::Table(rule)) = boundary.get_mut(name).map(Spanned::get_mut) else { continue };
        for kind in ["inlet", "far_field"] {
            if let Some(state) = rule.get_mut(kind) {
                take(Place::Side(side), &format!("boundary.{name}.{kind}"), state);
            }
        }
    }
    all
}

impl Scene {
    /// Takes over what [`take`] has found.
    pub(crate) fn settle(&mut self, settled: &[Settled]) {
        for &(place, [density, pressure]) in settled {
            let state = match place {
                Place::Ambient => Some(&mut self.gas.ambient),
                Place::Region(index) => self.gas.regions.get_mut(index).map(|region| &mut region.state),
                Place::Side(side) => match self.boundary.sides_mut()[side] {
                    Boundary::Inlet(state) | Boundary::FarField(state) => Some(state),
                    _ => None,
                },
            };
            if let Some(state) = state {
                (state.density, state.pressure) = (density, pressure);
            }
        }
    }
}

/// What a state says beside its velocity.
#[derive(Default)]
struct Said {
    density: Option<f64>,
    pressure: Option<f64>,
    temperature: Option<f64>,
}

/// The same in one state; other numbers stand in its place until the scene is read.
fn settle(path: &str, state: &mut DeTable<'_>, findings: &mut Vec<Finding>) -> Option<[f64; 2]> {
    let place = KEYS.iter().find_map(|key| state.get(*key).map(Spanned::span))?;
    let mut wrong = |key: &str, message: String, help: &str| {
        let finding = Finding::new(format!("{path}.{key}"), message, help);
        findings.push(Finding { span: Some(place.clone()), ..finding });
    };
    let mut said = Said {
        density: state.get("density").and_then(number),
        pressure: state.get("pressure").and_then(number),
        temperature: state.get("temperature").and_then(number),
    };
    let by_air = state.get("air").is_some();
    if let Some(air) = state.get("air") {
        let altitude = match air.get_ref() {
            DeValue::Table(air) => air.get("altitude").map_or(Some(0.0), number),
            _ => None,
        };
        match altitude.filter(|altitude| (LAYER[0]..=LAYER[1]).contains(altitude)) {
            _ if said.density.is_some() || said.pressure.is_some() => {
                wrong("air", "it says density and pressure, and so does the state".to_owned(), "leave one of them out");
            }
            Some(altitude) => {
                let [temperature, pressure] = standard_atmosphere(altitude);
                (said.temperature, said.pressure) = (said.temperature.or(Some(temperature)), Some(pressure));
            }
            None => {
                let help = "write air = { altitude = 0.0 }, from -5000 to 11000 [m] above sea level";
                wrong("air", "no height of the standard atmosphere".to_owned(), help);
            }
        }
    }
    let hot = said.temperature.filter(|temperature| *temperature > 0.0 && temperature.is_finite());
    let found = match (said.density, said.pressure, hot) {
        (None, Some(pressure), Some(hot)) => Some([pressure / (AIR_CONSTANT * hot), pressure]),
        (Some(density), None, Some(hot)) => Some([density, density * AIR_CONSTANT * hot]),
        _ => None,
    };
    if found.is_none() && !by_air {
        let help = "give one of density and pressure beside it; the other follows as in air, p = 287.053 rho T";
        let message =
            if hot.is_none() { "no temperature above 0 K" } else { "two of density, pressure and temperature say all" };
        wrong("temperature", message.to_owned(), help);
    }
    for key in KEYS {
        state.remove(key);
    }
    for key in ["density", "pressure"] {
        let stand_in = Spanned::new(place.clone(), mended::number("v = 1.0")?);
        state.insert(Spanned::new(place.clone(), Cow::Borrowed(key)), stand_in);
    }
    found
}

fn number(value: &Spanned<DeValue<'_>>) -> Option<f64> {
    match value.get_ref() {
        DeValue::Float(number) => number.as_str().parse().ok(),
        DeValue::Integer(number) => {
            i64::from_str_radix(number.as_str(), number.radix()).ok().map(|number| number as f64)
        }
        _ => None,
    }
}

/// Adds the keys to the schema that editors use: any two of density, pressure and temperature, or `air`.
pub(crate) fn add_keys(schema: &mut Value) {
    for name in ["GasState", "Region"] {
        let state = &mut schema["$defs"][name];
        state["properties"]["temperature"] = json!({
            "type": "number", "format": "double", "exclusiveMinimum": 0,
            "description": "Temperature `[K]`, of which p = 287.053 rho T as in air; in place of density or pressure."
        });
        state["properties"]["air"] = json!({
            "type": "object",
            "description": "The standard atmosphere at an `altitude` from -5000 to 11000 `[m]`, in place of density and pressure.",
            "additionalProperties": false,
            "properties": {
                "altitude": { "type": "number", "format": "double", "default": 0.0, "minimum": LAYER[0], "maximum": LAYER[1], "description": "Height above sea level `[m]`." }
            }
        });
        if let Some(required) = state["required"].as_array_mut() {
            required.retain(|key| key != "density" && key != "pressure");
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::Scene;

    fn ambient(state: &str) -> Result<[f64; 2], String> {
        let text = format!(
            "title = \"t\"\n[domain]\ndimension = 1\ncells = [8]\nsize = [1.0]\n[gas]\nambient = {{ {state} }}\n[time]\nuntil = 1.0\n"
        );
        let scene = Scene::parse(&text, "t.toml", &[] as &[String]).map_err(|error| error.to_string())?;
        Ok([scene.gas.ambient.density, scene.gas.ambient.pressure])
    }

    #[test]
    fn air_and_temperature_give_a_state() {
        // U.S. Standard Atmosphere, 1976, table 1; heights are geopotential
        for (altitude, density, pressure) in
            [(0.0, 1.2250, 101_325.0), (2000.0, 1.0065, 79_495.0), (10_000.0, 0.4127, 26_436.0)]
        {
            let found = ambient(&format!("air = {{ altitude = {altitude:?} }}")).unwrap();
            assert!((found[0] / density - 1.0).abs() < 1e-3 && (found[1] / pressure - 1.0).abs() < 1e-3, "{found:?}");
        }
        let hot = ambient("pressure = 101325.0, temperature = 576.3").unwrap();
        assert!((hot[0] / 0.6125 - 1.0).abs() < 1e-3, "{hot:?}");
        let dense = ambient("density = 2.45, temperature = 288.15").unwrap();
        assert!((dense[1] / 202_650.0 - 1.0).abs() < 1e-3, "{dense:?}");
        let cold = ambient("air = {}, temperature = 263.15").unwrap();
        assert!((cold[1] - 101_325.0).abs() < 1.0 && (cold[0] / 1.3414 - 1.0).abs() < 1e-3, "{cold:?}");
    }

    #[test]
    fn states_that_are_told_wrong_are_refused() {
        for (state, told) in [
            ("density = 1.0", "missing field `pressure`"),
            ("pressure = 1.0", "missing field `density`"),
            ("temperature = 300.0", "give one of density and pressure"),
            ("density = 1.0, pressure = 1.0, temperature = 1.0", "say all"),
            ("temperature = -3.0, density = 1.0", "above 0 K"),
            ("air = { altitude = 20000.0 }", "from -5000 to 11000"),
            ("air = {}, density = 1.0", "leave one of them out"),
        ] {
            let found = ambient(state).unwrap_err();
            assert!(found.contains(told) && found.contains("gas.ambient"), "{state}: {found}");
        }
    }
}
