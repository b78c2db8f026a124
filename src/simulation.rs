//! The step: the whole method on one page, and the run around it.

mod altered;
mod charges;
mod elastic;
mod fault;
mod history;
mod joined;
mod least_step;
mod live;
mod pace;
mod recorded;
mod report;
mod saved;

use std::time::Instant;

use crate::diagnostics::StepRecord;
use crate::error::Result;
use crate::gpu::{Allocation, Detail, Gpu, Pass, Settings, Times, readback, watched};
use crate::scene::Scene;
use crate::snapshot::Snapshot;
use crate::stage::{
    Carried, CarrierVelocity, CoupledSolve, Debris, Decision, Dust, ElasticFirst, ElasticReaction, ElasticSolve,
    FluidUpdate, G2p, GasAdvection, Gauges, InterfaceStage, IntermediatePressure, Loads, Maps, MpmGridUpdate, OddEven,
    P2g, ParticleSort, Still, Supports, TimeStep, Totals, Transfer,
};
use crate::state::constants::NO_FAULT;
use crate::state::{Control, Phase, State};
pub use charges::Released;
pub use joined::Places;
use least_step::LeastStep;
pub use live::Blast;
use live::ByHand;
use pace::Pace;
use recorded::Recorded;
#[doc(hidden)]
pub use saved::{Host, Saved, SavedArray};

/// A running simulation: buffers, stages, clock.
#[derive(Debug)]
pub struct Simulation {
    gpu: Gpu,
    /// What it started from.
    scene: Scene,
    /// Everything the step reads and writes.
    #[doc(hidden)]
    pub state: State,
    time_step: TimeStep,
    particle_sort: Option<ParticleSort>,
    p2g: Option<P2g>,
    supports: Option<Supports>,
    interface: InterfaceStage,
    still: Still,
    dust: Option<Dust>,
    carrier: CarrierVelocity,
    gas_advection: GasAdvection,
    intermediate_pressure: IntermediatePressure,
    elastic_reaction: Option<ElasticReaction>,
    elastic_first: Option<ElasticFirst>,
    elastic_solve: Option<ElasticSolve>,
    coupled_solve: CoupledSolve,
    fluid_update: FluidUpdate,
    mpm_grid_update: Option<MpmGridUpdate>,
    g2p: Option<G2p>,
    debris: Option<Debris>,
    odd_even: Option<OddEven>,
    totals: Totals,
    loads: Option<Loads>,
    gauges: Option<Gauges>,
    maps: Option<Maps>,
    by_hand: ByHand,
    gases: crate::scene::EquationOfState,
    fire: crate::scene::Fire,
    /// Momentum and energy that bodies were given from outside since the start, and gas by blasts.
    given: [f64; 4],
    /// Momentum and energy that gravity has given to the gas since the start, and the gas of the step before.
    pulled: [f64; 4],
    gas_before: [f64; 3],
    /// Impulse and work of the gas on each body, if that is told, on each obstacle, and on walls with gauges, since the start.
    borne: Vec<[f64; 4]>,
    /// Energy of blasts and charges so far \[J\].
    blasts: f64,
    /// Charges in the order in which they go off; `released` counts those that have.
    due: Vec<charges::Due>,
    released: Released,
    /// The time asked for \[s\].
    target: f64,
    /// Pressure solves per step.
    solves: u32,
    time: f64,
    step: u64,
    /// Iterations, sub-steps and rounds that a step is recorded with.
    recorded: Recorded,
    /// All buffers, in the order in which they were made.
    buffers: Vec<Allocation>,
    /// How many steps a submission holds.
    pace: Pace,
    /// What ends a run whose steps become too short.
    least_step: LeastStep,
}

/// Steps per submission at most.
pub const BATCH: u32 = 16;

impl Simulation {
    /// Builds buffers and kernels for a scene.
    ///
    /// # Errors
    /// If the scene is wrong ([`Scene::checked`]), does not fit, or a shader is wrong.
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Simulation> {
        let (simulation, buffers) = watched(|| Self::build(gpu, &scene.checked()?));
        Ok(Simulation { buffers, ..simulation? })
    }

    fn build(gpu: &Gpu, scene: &Scene) -> Result<Simulation> {
        let state = State::new(gpu, scene)?;
        let (solids, transfer) = (state.has_solids(), Transfer::of(scene.numerics.expert.transfer, gpu.settings));
        let coupled_solve = CoupledSolve::new(&state, scene)?;
        let simulation = Simulation {
            time_step: TimeStep::new(&state, scene, coupled_solve.pcg.control.raw())?,
            particle_sort: solids.then(|| ParticleSort::new(&state)).transpose()?,
            p2g: solids.then(|| P2g::new(&state, transfer)).transpose()?,
            supports: scene.has_supports().then(|| Supports::new(&state)).transpose()?,
            interface: InterfaceStage::new(&state)?,
            still: Still::new(&state)?,
            dust: Dust::new(&state, scene)?,
            carrier: CarrierVelocity::new(&state, scene.consistent(), scene.solves())?,
            gas_advection: GasAdvection::new(&state, scene.solves())?,
            intermediate_pressure: IntermediatePressure::new(&state)?,
            elastic_reaction: ElasticReaction::new(&state, scene)?,
            elastic_first: ElasticFirst::new(&state, scene)?,
            elastic_solve: ElasticSolve::new(&state, scene, transfer)?,
            coupled_solve,
            fluid_update: FluidUpdate::new(&state, scene)?,
            mpm_grid_update: solids.then(|| MpmGridUpdate::new(&state)).transpose()?,
            g2p: solids.then(|| G2p::new(&state, transfer)).transpose()?,
            debris: Debris::new(&state, scene)?,
            odd_even: scene.filter().map(|filter| OddEven::new(&state, filter.share)).transpose()?,
            totals: Totals::new(&state)?,
            loads: Loads::new(&state)?,
            gauges: Gauges::new(&state)?,
            maps: Maps::new(&state)?,
            by_hand: ByHand::default(),
            gases: scene.gas.equation_of_state(),
            fire: crate::scene::Fire::of(scene),
            given: [0.0; 4],
            pulled: [0.0; 4],
            gas_before: state.start_momentum,
            borne: vec![[0.0; 4]; state.load_count.iter().sum()],
            blasts: 0.0,
            due: charges::due(scene)?,
            released: Released::default(),
            target: 0.0,
            solves: scene.solves(),
            time: 0.0,
            step: 0,
            recorded: Recorded::FIRST,
            buffers: Vec::new(),
            pace: Pace::default(),
            least_step: LeastStep::new(scene.time.until),
            gpu: gpu.clone(),
            scene: scene.clone(),
            state,
        };
        gpu.finish_kernels()?;
        let mut pass = Pass::new(gpu, "start");
        simulation.time_step.decide(&mut pass, Decision::Start);
        simulation.particle_sort.iter().for_each(|sort| sort.record(&mut pass, &simulation.state));
        simulation.interface.record_start(&mut pass, &simulation.state);
        simulation.time_step.decide(&mut pass, Decision::Listed);
        pass.submit()?;
        Ok(simulation)
    }

    /// Records one step, in the order and with the numbers (1) to (7) of [Cao et al. 2022, section 2.2]; (4) and (5) are in
    /// `record_pressure`. `record` of each stage appends its dispatches to the pass, which runs them when it is submitted. Nothing is read
    /// back: the device chooses dt, ends the iteration, counts the sub-steps, and turns what is not due, by its [`Phase`], into dispatches
    /// of no groups. If the recorded iterations or sub-steps do not suffice, the step goes on in the next call.
    pub fn record_step(&self, pass: &mut Pass) {
        let state = &self.state;
        self.time_step.record(pass, state); // dt from gas, solids and the time asked for
        if let Some(supports) = &self.supports {
            supports.record_motions(pass, state);
        }
        if let (Some(particle_sort), Some(p2g)) = (&self.particle_sort, &self.p2g) {
            particle_sort.record(pass, state);
            p2g.record(pass, state); // (1) particles to grid
        }
        self.interface.record(pass, state); // (2) moving interface, blocked fraction, ledger of covered gas
        if let Some(loads) = &self.loads {
            loads.record_owners(pass, state);
        }
        self.record_held(pass, Phase::Begin);
        self.record_force(pass);
        if state.has_solids() {
            self.time_step.decide(pass, Decision::Listed);
        }
        self.still.record(pass, state);
        if let Some(dust) = &self.dust {
            dust.record(pass, state);
        }
        self.record_advection(pass, 0, Carried::Start, Phase::Begin); // (3) eqs. 10-12
        if self.solves == 1 {
            self.record_advection(pass, 1, Carried::Halfway, Phase::Begin);
            self.record_pressure(pass, Phase::Begin);
        } else {
            self.record_pressure(pass, Phase::Begin);
            self.time_step.decide(pass, Decision::Second); // [Ascher, Ruuth & Spiteri 1997; Wicker & Skamarock 2002]
            self.gas_advection.record(pass, state, &self.time_step, 1, Phase::Second); // with the carrier that `fluid_update` left of the solved state
            self.record_advection(pass, 2, Carried::SecondHalfway, Phase::Second);
            self.record_pressure(pass, Phase::Second);
        }
        self.coupled_solve.record_solid(pass, state); // eq. 36
        if let Some(elastic_reaction) = &self.elastic_reaction {
            elastic_reaction.record_after(pass, state);
        }
        self.record_elastic(pass); // (6) elasticity, walls; (7) grid to particles
        self.time_step.decide(pass, Decision::Finish);
        self.debris.iter().for_each(|debris| debris.record(pass, state));
        self.odd_even.iter().for_each(|odd_even| odd_even.record(pass, state));
    }

    /// One Runge-Kutta stage of the advection, and before it the carrier of the state that it starts from.
    fn record_advection(&self, pass: &mut Pass, runge_kutta: usize, source: Carried, phase: Phase) {
        self.carrier.record(pass, &self.state, source, phase);
        self.gas_advection.record(pass, &self.state, &self.time_step, runge_kutta, phase);
    }

    /// The implicit part: solve and update of the gas.
    fn record_pressure(&self, pass: &mut Pass, phase: Phase) {
        let state = &self.state;
        if self.solves == 1 {
            self.carrier.record(pass, state, Carried::Advected, phase);
        }
        self.intermediate_pressure.record(pass, state, phase); // (4) eqs. 9 and 17
        if let Some(elastic_first) = &self.elastic_first {
            elastic_first.record_before(pass, state, phase);
        }
        self.coupled_solve.record_loads(pass, state, phase);
        if let Some(elastic_reaction) = &self.elastic_reaction {
            elastic_reaction.record_before(pass, state, phase);
        }
        self.coupled_solve.record_setup(pass, state, phase);
        self.coupled_solve.record_iterations(pass, self.recorded.iterations); // (5) eq. 37
        self.time_step.decide(pass, Decision::Solved);
        self.coupled_solve.record_solution(pass, state);
        if let Some(elastic_reaction) = &self.elastic_reaction {
            elastic_reaction.record_aside(pass, state);
        }
        self.fluid_update.record(pass, state, &self.carrier, &self.time_step); // eqs. 14 and 3, local gradients
    }

    /// Clamped and driven nodes, friction at walls.
    fn record_held(&self, pass: &mut Pass, phase: Phase) {
        if let Some(supports) = &self.supports {
            supports.record_nodes(pass, &self.state, phase);
        }
    }

    /// Advances to a time and returns the records of all steps on the way.
    ///
    /// # Errors
    /// [`crate::Error::Diverged`] if a stage raised a fault; driver errors.
    pub fn advance_to(&mut self, time: f64) -> Result<Vec<StepRecord>> {
        let mut records = Vec::new();
        self.set_target(time)?;
        while !self.advance_batch(&mut records)? {}
        self.time = time;
        Ok(records)
    }

    /// Asks for a stop at a time \[s\]; on the way there the charges whose time has come go off.
    ///
    /// # Errors
    /// Driver errors.
    pub fn set_target(&mut self, time: f64) -> Result<()> {
        self.least_step.start_frame();
        self.target = time;
        self.head_for(self.next_charge(time).unwrap_or(time))
    }

    /// Asks the device to stop at a time \[s\].
    fn head_for(&mut self, time: f64) -> Result<()> {
        let mut control = self.control()?;
        control.remaining = (time - self.time).max(0.0) as f32;
        (control.time, control.time_error) = (self.time as f32, 0.0);
        self.state.control.write(&self.gpu, 0, &[control]);
        Ok(())
    }

    /// Runs up to one submission of steps, appends their records, and tells whether the target is reached.
    ///
    /// # Errors
    /// As [`Simulation::advance_to`].
    pub fn advance_batch(&mut self, records: &mut Vec<StepRecord>) -> Result<bool> {
        self.advance_batch_of(records, BATCH)
    }

    /// The same with at most `steps` steps, 1 to 16.
    ///
    /// # Errors
    /// As [`Simulation::advance_to`].
    pub fn advance_batch_of(&mut self, records: &mut Vec<StepRecord>, steps: u32) -> Result<bool> {
        let hardware = self.gpu.settings == Settings::Hardware;
        // A processor serves others beside a long submission.
        let steps = if hardware { self.pace.steps(steps.clamp(1, BATCH)) } else { steps.clamp(1, BATCH) };
        let (start, before) = (Instant::now(), records.len());
        let mut pass = Pass::new(&self.gpu, "steps").cut(hardware && self.pace.cut());
        for _ in 0..steps {
            self.record_step(&mut pass);
            self.record_totals(&mut pass);
        }
        pass.submit()?;
        let reached = self.after_batch(records)?;
        self.pace.note((steps, records.len() - before), 1e3 * start.elapsed().as_secs_f64());
        Ok(reached)
    }

    /// Runs one recording with a stopwatch: as [`Simulation::advance_batch`] with the milliseconds of each stage or kernel.
    ///
    /// # Errors
    /// As [`Simulation::advance_to`].
    pub fn advance_timed(&mut self, records: &mut Vec<StepRecord>, detail: Detail) -> Result<(bool, Times)> {
        let mut pass = Pass::timed(&self.gpu, "steps", detail);
        self.record_step(&mut pass);
        self.record_totals(&mut pass);
        let times = pass.submit_timed()?;
        Ok((self.after_batch(records)?, times))
    }

    /// Reads clock, records and faults after a submission.
    fn after_batch(&mut self, records: &mut Vec<StepRecord>) -> Result<bool> {
        let control = self.control()?;
        let first = records.len();
        self.read_history(u64::from(control.step), records)?;
        let newest = &records[first..];
        let endless = self.pass_time(newest);
        self.step = u64::from(control.step);
        if control.fault != NO_FAULT {
            return Err(self.fault(&control));
        }
        endless.map_or(Ok(()), |endless| Err(self.too_short(&endless)?))?;
        self.recorded = self.recorded.next(newest, control.phase != 0, self.solves, &self.state);
        if control.remaining > 0.0 || control.phase != 0 {
            return Ok(false);
        }
        let Some(time) = self.next_charge(self.target) else { return Ok(true) };
        self.time = time;
        self.release_next()?;
        self.head_for(self.next_charge(self.target).unwrap_or(self.target))?;
        Ok(false)
    }

    /// What the device decided last.
    ///
    /// # Errors
    /// Driver errors.
    pub fn control(&self) -> Result<Control> {
        Ok(readback::read(&self.gpu, &self.state.control)?[0])
    }

    /// Momentum \[kg m s^-1\] and energy \[J\] that walls, films, gravity and pushes have given to bodies, and blasts to gas, since the start.
    #[must_use]
    pub fn given(&self) -> [f64; 4] {
        self.given
    }

    /// Simulated time \[s\].
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Finished steps.
    #[must_use]
    pub fn step_count(&self) -> u64 {
        self.step
    }

    /// The device.
    #[must_use]
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Copies the state to the CPU.
    ///
    /// # Errors
    /// Driver errors.
    pub fn snapshot(&self) -> Result<Snapshot> {
        let read = Snapshot::read(&self.gpu, &self.state, (self.time, self.step), self.gases)?;
        Ok(Snapshot { fire: self.fire, ..read })
    }
}
