//! What may change while a simulation runs: parameters, the gas beyond open sides, blasts, and pushes. All of it happens between two steps.

use std::collections::BTreeMap;

use super::Simulation;
use crate::diagnostics::StepRecord;
use crate::error::{Error, Result};
use crate::scene::{Boundary, Scene};
use crate::stage::{Detonate, Push};
use crate::state::Openings;

/// Energy to be set free in a ball of gas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blast {
    /// Its middle \[m\].
    pub center: [f64; 3],
    /// Its radius \[m\]: cells whose centre lies inside belong to it.
    pub radius: f64,
    /// Energy \[J\]; per metre of depth in 2D, per square metre in 1D.
    pub energy: f64,
}

/// Kernels of what a user does between two steps, once it is done.
#[derive(Debug, Default)]
pub(super) struct ByHand {
    detonate: Option<Detonate>,
    pub(super) push: Option<Push>,
    /// Bodies whose density is another one than at the start, and which \[kg m^-3\].
    pub(super) densities: BTreeMap<usize, f64>,
}

impl Simulation {
    /// Finishes the step that is under way, if any; its record is appended.
    ///
    /// # Errors
    /// As [`Simulation::advance_to`].
    pub fn settle(&mut self, records: &mut Vec<StepRecord>) -> Result<()> {
        while self.control()?.phase != 0 {
            self.advance_batch_of(records, 1)?;
        }
        Ok(())
    }

    /// Whether no step is under way, so that the state can be copied.
    ///
    /// # Errors
    /// Driver errors.
    pub fn is_settled(&self) -> Result<bool> {
        Ok(self.control()?.phase == 0)
    }

    /// Goes on with the parameters of `to` instead of those of `from`, the scene as it is now. Gravity, `time.cfl`, `time.max_courant`,
    /// `time.max_growth`, `numerics.tolerance` and the states of open sides may differ.
    ///
    /// # Errors
    /// [`Error::Usage`] if something else differs; driver errors.
    pub fn change(&mut self, from: &Scene, to: &Scene, records: &mut Vec<StepRecord>) -> Result<()> {
        Self::can_change(from, to)?;
        self.settle(records)?;
        let (openings, state) = (Openings::new(to), &mut self.state);
        state.admit(to, &openings);
        let params = &mut state.params;
        params.gravity = to.gravity.map(|g| g as f32);
        params.cfl = to.time.cfl as f32;
        params.max_courant = to.time.max_courant as f32;
        params.max_growth = to.time.max_growth as f32;
        params.tolerance = to.numerics.tolerance as f32;
        self.coupled_solve.pcg.set_tolerance(&self.gpu, params.tolerance);
        state.params_buffer.write(&self.gpu, 0, &[state.params]);
        state.openings.write(&self.gpu, 0, openings.of_rules());
        state.knots.write(&self.gpu, 0, &openings.knots);
        self.gpu.check()
    }

    /// Whether a simulation of `from` can go on with the parameters of `to`, see [`Simulation::change`].
    ///
    /// # Errors
    /// [`Error::Usage`] if not.
    pub fn can_change(from: &Scene, to: &Scene) -> Result<()> {
        check(from, to)
    }

    /// Sets energy free in the gas of a ball, evenly over its volume: pressure rises, density and velocity stay. The budgets count it among
    /// what was given from outside. Returns the energy \[J\], rounded to what the device can add.
    ///
    /// # Errors
    /// [`Error::Usage`] if the numbers are not positive or there is no gas in the ball; driver errors.
    pub fn detonate(&mut self, blast: &Blast, records: &mut Vec<StepRecord>) -> Result<f64> {
        let Blast { center, radius, energy } = *blast;
        if !(radius > 0.0 && radius.is_finite() && energy > 0.0 && energy.is_finite()) {
            return Err(Error::Usage(format!(
                "a blast of {energy} J within {radius} m: both numbers must be positive and finite"
            )));
        }
        self.settle(records)?;
        if self.by_hand.detonate.is_none() {
            self.by_hand.detonate = Some(Detonate::new(&self.state)?);
        }
        let Some(kernels) = &self.by_hand.detonate else { return Ok(0.0) };
        let energy = kernels.run(&self.gpu, &self.state, center, radius, energy)?;
        self.given[3] += energy;
        self.blasts += energy;
        Ok(energy)
    }

    /// Momentum \[kg m s^-1\] and mass \[kg\] of what of a body is inside the domain and moves by itself.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is no such body; driver errors.
    pub fn moving(&mut self, body: usize, records: &mut Vec<StepRecord>) -> Result<[f64; 4]> {
        self.get_ready_to_push(body, records)?;
        self.by_hand.push.as_ref().map_or(Ok([0.0; 4]), |push| push.moving(&self.state, body as u32))
    }

    /// Changes the velocity of a body by so much \[m s^-1\], everywhere alike: it is pushed and does not turn. What of it is clamped or driven
    /// stays as it is. The budgets count momentum \[kg m s^-1\] and energy \[J\] among what was given from outside; both are returned.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is no such body or the change is not finite; driver errors.
    pub fn push(&mut self, body: usize, change: [f64; 3], records: &mut Vec<StepRecord>) -> Result<[f64; 4]> {
        let axes = self.scene.domain.axes();
        if !change.iter().all(|part| (*part as f32).is_finite()) || change[axes..].iter().any(|part| *part != 0.0) {
            let text = format!("a push by {change:?} m/s: {axes} finite numbers are wanted, and 0 across the domain");
            return Err(Error::Usage(text));
        }
        self.get_ready_to_push(body, records)?;
        let Some(push) = &self.by_hand.push else { return Ok([0.0; 4]) };
        let given = push.change(&self.state, body as u32, change)?;
        for (sum, part) in self.given.iter_mut().zip(given) {
            *sum += part;
        }
        Ok(given)
    }

    /// Finishes the step that is under way, and compiles what a push wants.
    pub(super) fn get_ready_to_push(&mut self, body: usize, records: &mut Vec<StepRecord>) -> Result<()> {
        if body >= self.scene.bodies.len() {
            return Err(Error::Usage(format!("body {body}: this scene has {}", self.scene.bodies.len())));
        }
        self.settle(records)?;
        if self.by_hand.push.is_none() {
            self.by_hand.push = Some(Push::new(&self.state)?);
        }
        Ok(())
    }
}

/// Whether only what may change differs.
fn check(from: &Scene, to: &Scene) -> Result<()> {
    let mut same = to.clone();
    same.gravity = from.gravity;
    same.time.cfl = from.time.cfl;
    same.time.max_courant = from.time.max_courant;
    same.time.max_growth = from.time.max_growth;
    same.time.until = from.time.until;
    same.numerics.tolerance = from.numerics.tolerance;
    same.boundary = from.boundary.clone();
    same.render = from.render.clone();
    same.output = from.output.clone();
    if same != *from {
        return Err(Error::Usage(
            "only gravity, time.cfl, time.max_courant, time.max_growth, numerics.tolerance and the states of open \
             sides can change while a scene runs; restart it for the rest"
                .to_owned(),
        ));
    }
    let (before, after) = (Openings::new(from), Openings::new(to));
    let kinds =
        |openings: &Openings| openings.of_rules().iter().map(|o| (o.rule, o.first, o.knots)).collect::<Vec<_>>();
    let sides = from.boundary.sides().into_iter().zip(to.boundary.sides());
    if kinds(&before) == kinds(&after) && sides.into_iter().all(|(a, b)| same_kind(a, b)) {
        return Ok(());
    }
    Err(Error::Usage(
        "the state beyond a side can change while a scene runs, its rule and its patches cannot; restart the scene"
            .to_owned(),
    ))
}

/// Whether two sides follow the same rules at the same places.
fn same_kind(a: &Boundary, b: &Boundary) -> bool {
    match (a, b) {
        (Boundary::Patched(a), Boundary::Patched(b)) => {
            let pairs = a.patches.iter().zip(&b.patches);
            same_kind(&a.base, &b.base)
                && a.patches.len() == b.patches.len()
                && pairs.into_iter().all(|(a, b)| a.shape == b.shape && same_kind(&a.rule, &b.rule))
        }
        _ => std::mem::discriminant(a) == std::mem::discriminant(b),
    }
}
