//! What a user may make of bodies and probes while a simulation runs: stiffness, strength, density, colour; probes come and go. All of it
//! happens between two steps.

use super::Simulation;
use crate::diagnostics::StepRecord;
use crate::error::{Error, Result};
use crate::gpu::Buffer;
use crate::scene::{Body, Scene};
use crate::stage::Totals;
use crate::state::params::LIGHTEST_NODE;
use crate::state::{HISTORY, probe_slots};

impl Simulation {
    /// As [`Simulation::change`]; besides, the numbers of materials, densities and colours of bodies, and all probes may differ. Bodies keep
    /// their shape, their strain and their velocity; what their momentum and energy change by counts as given from outside. Returns what
    /// their mass changes by \[kg\].
    ///
    /// # Errors
    /// [`Error::Usage`] if something else differs; what [`Scene::checked`] finds; driver errors.
    pub fn alter(&mut self, from: &Scene, to: &Scene, records: &mut Vec<StepRecord>) -> Result<f64> {
        check(from, to)?;
        let mut plain = to.clone();
        (plain.materials, plain.bodies) = (from.materials.clone(), from.bodies.clone());
        plain.probes.clone_from(&from.probes);
        if plain != *to {
            to.checked().map_err(|error| Error::Usage(error.to_string()))?;
        }
        self.change(from, &plain, records)?;
        let gained = self.alter_bodies(from, to, records)?;
        if from.probes != to.probes {
            self.place_probes(to)?;
        }
        Ok(gained)
    }

    fn alter_bodies(&mut self, from: &Scene, to: &Scene, records: &mut Vec<StepRecord>) -> Result<f64> {
        let heavier: Vec<usize> =
            (0..to.bodies.len()).filter(|body| density(from, *body) != density(to, *body)).collect();
        if from.materials == to.materials && heavier.is_empty() {
            return Ok(0.0);
        }
        self.get_ready_to_push(0, records)?;
        let before = self.totals.of_bodies(&self.state)?;
        self.state.materials.write(&self.gpu, 0, bytemuck::cast_slice(&to.material_parameters()));
        if !heavier.is_empty() {
            let largest = (0..to.bodies.len()).map(|body| density(to, body)).fold(0.0, f64::max);
            self.state.params.mass_floor = (LIGHTEST_NODE * largest * to.domain.cell_volume()) as f32;
            self.state.params_buffer.write(&self.gpu, 0, &[self.state.params]);
            self.by_hand.densities.extend(heavier.iter().map(|body| (*body, density(to, *body))));
        }
        self.weigh(before)
    }

    /// Gives bodies the densities that they have by hand, and books what they were given since `before`; the mass that they gained \[kg\].
    fn weigh(&mut self, before: [f64; 5]) -> Result<f64> {
        if let Some(push) = &self.by_hand.push {
            for (body, density) in &self.by_hand.densities {
                push.weigh(&self.state, *body as u32, *density)?;
            }
        }
        let after = self.totals.of_bodies(&self.state)?;
        for (sum, part) in self.given.iter_mut().zip(0..4) {
            *sum += after[part] - before[part];
        }
        Ok(after[4] - before[4])
    }

    /// A state that was saved before has the densities of then.
    pub(super) fn weigh_again(&mut self) -> Result<()> {
        if self.by_hand.densities.is_empty() {
            return Ok(());
        }
        let before = self.totals.of_bodies(&self.state)?;
        self.weigh(before).map(|_| ())
    }

    /// Probes of a scene in the place of those that there are.
    fn place_probes(&mut self, scene: &Scene) -> Result<()> {
        let (gpu, state) = (&self.gpu, &mut self.state);
        let cells = probe_slots(scene, &state.grid);
        state.probe_cells = Buffer::from_slice(gpu, "probe_cells", &cells)?;
        state.probe_history = Buffer::new(gpu, "probe_history", 2 * HISTORY as usize * cells.len())?;
        state.params.probes = cells.len() as u32;
        state.params_buffer.write(gpu, 0, &[state.params]);
        self.totals = Totals::new(state)?;
        gpu.finish_kernels()?;
        gpu.check()
    }
}

fn density(scene: &Scene, body: usize) -> f64 {
    scene.density_of(&scene.bodies[body]).unwrap_or(0.0)
}

/// Whether bodies and materials are the same ones but for their numbers.
fn check(from: &Scene, to: &Scene) -> Result<()> {
    let plain = |body: &Body| Body { density: None, color: None, ..body.clone() };
    let bodies =
        from.bodies.len() == to.bodies.len() && from.bodies.iter().zip(&to.bodies).all(|(a, b)| plain(a) == plain(b));
    let materials = from.materials.len() == to.materials.len()
        && from.materials.iter().zip(&to.materials).all(|((name, a), (other, b))| {
            name == other
                && a.kind_index() == b.kind_index()
                && a.fracture() == b.fracture()
                && a.flow().is_some() == b.flow().is_some()
        });
    if bodies && materials {
        return Ok(());
    }
    let text =
        "numbers of materials, densities and colours of bodies can change while a scene runs; restart it for the rest";
    Err(Error::Usage(text.to_owned()))
}
