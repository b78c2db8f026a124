//! What of a scene may change where a state of it goes on.

use super::{Changes, Scene};
use crate::{Error, Result};

/// Keys that may change, with what may follow; materials of the same model may change their strength.
const CHANGEABLE: [&str; 12] = [
    "title", "description", "probes", "gauges", "output.", "render.", "expect.", "boundary.", "gravity", "time.",
    "numerics.tolerance", "materials.",
];
/// Last parts of the keys of materials that may change.
const STRENGTHS: [&str; 5] = ["yield_stress", "hardening", "tensile_strength", "cohesion", "friction_angle"];

const REFUSED: &str = "a state goes on only with the cells, bodies and gas that it has; what may change is probes, gauges, output.*, \
                       render.*, expect.*, boundary.* (states, not rules), gravity, time.*, numerics.tolerance, and the \
                       strength of materials; run the scene anew for the rest";

/// Whether a key may change.
fn may_change(key: &str) -> bool {
    let strength = |key: &str| STRENGTHS.iter().any(|name| key.rsplit('.').next() == Some(name));
    CHANGEABLE.iter().any(|own| key.starts_with(own)) && (!key.starts_with("materials.") || strength(key))
}

impl Changes {
    /// Whether a state can go on with them, and with another resolution; `asked` says of what, as in `--branch`, and `option` where the
    /// changes were written, as in `--set`.
    ///
    /// # Errors
    /// [`Error::Usage`] with the key that a state cannot go on with, and those that it can.
    pub fn of_a_state(&self, resolution: Option<u32>, asked: &str, option: &str) -> Result<()> {
        if !self.variants.is_empty() || resolution.is_some() {
            let reason = format!("the state has the cells and bodies of its run; {option} changes what may change");
            return Err(Error::Usage(format!("--resolution and --variant with {asked}: {reason}")));
        }
        let key = |set: &String| set.split('=').next().unwrap_or_default().trim().to_owned();
        match self.set.iter().map(key).find(|key| !may_change(key)) {
            Some(key) => Err(Error::Usage(format!("{option} {key} with {asked}: {REFUSED}"))),
            None => Ok(()),
        }
    }
}

impl Scene {
    /// The scene that a simulation is built of which takes a state of the scene `was`. It changes to this one behind that, as a simulation at
    /// work does.
    ///
    /// # Errors
    /// [`Error::Usage`] if this one keeps maps and `was` kept none.
    pub fn taking_over(&self, was: &Scene) -> Result<Scene> {
        if self.keeps_maps() && !was.keeps_maps() {
            let text = "maps of the largest values begin with the run: this one kept none, run the scene anew with output.maps=true";
            return Err(Error::Usage(text.to_owned()));
        }
        let mut built = self.clone();
        (built.gravity, built.time, built.boundary) = (was.gravity, was.time.clone(), was.boundary.clone());
        built.time.frames = self.time.frames;
        built.output.clone_from(&was.output);
        built.numerics.tolerance = was.numerics.tolerance;
        Ok(built)
    }
}
