//! What a run of a scene will take, about: speeds of the start, the step, the number of steps, bytes on the disk.

use crate::math::plain;

use crate::scene::{Boundary, Charge, Elasticity, Gas, GasState, Scene, Wave};

/// Cells that an elastic wave may cross in an implicit step: the motion of a whole body is (c dt / dx)^2 times softer than that of
/// neighbouring nodes against each other, and single precision must still tell it from rounding.
pub const IMPLICIT_COURANT: f64 = 1000.0;

/// Runs of more steps will hardly end.
const MANY_STEPS: f64 = 1e6;

/// Share of the speed of sound up to which gas is quiet.
const QUIET: f64 = 0.1;

/// The estimate.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Estimate {
    /// Largest speed of sound at the start and at the sides `[m s^-1]`.
    pub gas_sound_speed: f64,
    /// Largest speed of pressure waves in the bodies `[m s^-1]`; 0 without bodies.
    pub solid_sound_speed: f64,
    /// Step at the start `[s]`.
    pub step: f64,
    /// Steps of the run, if they stay as long.
    pub steps: f64,
    /// Elastic sub-steps per step; 1 without bodies.
    pub substeps: f64,
    /// How many times as long the step would be but for the limit of implicit elasticity, [`IMPLICIT_COURANT`]; 1 where that does not act.
    pub implicit_cap: f64,
    /// Bytes of all files beside checkpoints.
    pub disk_bytes: f64,
}

impl Estimate {
    /// What will surprise: a run that will not end, and implicit steps that are shorter than they seem.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let endless = (self.steps > MANY_STEPS).then(|| {
            let steps = plain(self.steps);
            format!("about {steps} steps: the run will hardly end; choose larger cells, a shorter time.until or softer bodies")
        });
        let capped = (self.implicit_cap > 1.0).then(|| {
            format!(
                "numerics.elasticity = \"implicit\" is capped: in a step an elastic wave crosses at most {IMPLICIT_COURANT} cells, so steps are \
                 {} times shorter than the gas asks for; choose softer bodies or larger cells",
                plain(self.implicit_cap)
            )
        });
        endless.into_iter().chain(capped).collect()
    }
}

impl Scene {
    /// Speed that gas at rest comes to, about: that of an expansion between its pressures and that of a fall, at most that of its sound; the
    /// latter where something else moves it.
    fn speed_to_come(&self) -> f64 {
        let [sound, speed] = self.gas_speeds();
        let mut rules = self.boundary.sides().into_iter().flat_map(Boundary::rules);
        let quiet = |rule: &Boundary| matches!(rule, Boundary::Wall | Boundary::Periodic | Boundary::Outlet);
        let Gas { gamma, ambient, regions, waves, vortices, radial_flows, noise, .. } = &self.gas;
        let streams = |wave: &Wave| wave.velocity != [0.0; 3];
        let still = self.charges.is_empty() && self.bodies.is_empty() && vortices.is_empty() && radial_flows.is_empty();
        if speed > 0.0 || !still || waves.iter().any(streams) || !rules.all(quiet) {
            return sound;
        }
        let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let extent = length(self.domain.size);
        let pressures = regions.iter().map(|region| region.state.pressure).chain([ambient.pressure]);
        let (low, high) = pressures.fold((f64::INFINITY, 0.0), |(low, high), p: f64| (p.min(low), p.max(high)));
        // between two places a wave differs by no more than twice its amplitude
        let differs = |wave: &Wave| wave.pressure.abs() * (length(wave.vector) * extent).min(2.0);
        let high = high * (1.0 + noise) + waves.iter().map(differs).sum::<f64>();
        let expansion = 2.0 / (gamma - 1.0) * sound * (1.0 - (low / high).powf((gamma - 1.0) / (2.0 * gamma)));
        let gravity = length(self.gravity);
        let fall = (gravity * self.time.until).min((2.0 * gravity * extent).sqrt());
        (expansion + fall).min(sound)
    }

    /// Whether the gas stays far below the speed of its sound, so that pictures show few waves.
    pub(super) fn is_quiet(&self) -> bool {
        self.speed_to_come() < QUIET * self.gas_speeds()[0]
    }

    /// Largest speeds of sound and of gas `[m s^-1]` at the start and at the sides.
    fn gas_speeds(&self) -> [f64; 2] {
        let (mut sound, mut speed) = (0f64, 0f64);
        let mut see = |state: &GasState| {
            sound = sound.max(state.sound_speed(self.gas.gamma));
            speed = speed.max(state.velocity.iter().map(|u| u * u).sum::<f64>().sqrt());
        };
        see(&self.gas.ambient);
        self.gas.regions.iter().for_each(|region| see(&region.state));
        for rule in self.boundary.sides().into_iter().flat_map(Boundary::rules) {
            if let Boundary::Inlet(state) | Boundary::FarField(state) = rule {
                see(state);
            }
        }
        let on_grid = self.charges.iter().filter(|charge| charge.shape.is_some());
        sound = on_grid.filter_map(Charge::made_of).map(|own| own.detonation_speed).fold(sound, f64::max);
        [sound, speed]
    }

    /// What a run will take, with so many particles.
    #[must_use]
    pub fn estimate(&self, particles: usize) -> Estimate {
        let [sound, speed] = self.gas_speeds();
        let moving = self.bodies.iter().map(|body| body.velocity.iter().map(|u| u * u).sum::<f64>().sqrt());
        let speed = moving.fold(speed, f64::max);
        let wave =
            |body: &crate::scene::Body| Some(self.materials.get(&body.material)?.wave_speed(self.density_of(body)?));
        let solid = self.bodies.iter().filter_map(wave).fold(0.0, f64::max);
        let (time, spacing) = (&self.time, self.domain.spacing());
        let carried = time.cfl * spacing / speed.max(self.speed_to_come());
        let heard = time.max_courant * spacing / sound;
        let implicit = self.numerics.elasticity == Elasticity::Implicit;
        let substep = self.numerics.expert.elastic_cfl * spacing / solid;
        let strained =
            if implicit { IMPLICIT_COURANT * spacing / solid } else { substep * f64::from(self.numerics.max_substeps) };
        let free = carried.min(heard);
        let step = time.fixed_step.unwrap_or(free.min(strained));
        let substeps = if implicit { 1.0 } else { (step / substep).ceil().max(1.0) };
        let implicit_cap = if implicit && time.fixed_step.is_none() { (free / strained).max(1.0) } else { 1.0 };
        let frames = f64::from(time.frames.max(1)); // a step ends where a frame is
        let steps =
            if time.fixed_step.is_some() { time.until / step } else { frames * (time.until / frames / step).ceil() };
        let formats: Vec<&str> = ["png"].into_iter().chain(self.output.formats()).collect();
        let disk_bytes = self.disk_bytes((particles, steps), &formats);
        Estimate { gas_sound_speed: sound, solid_sound_speed: solid, step, steps, substeps, implicit_cap, disk_bytes }
    }
}
