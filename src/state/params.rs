//! What one run fixes, as shaders see it.

use bytemuck::{Pod, Zeroable};

use super::constants::SCAN_DISPATCHES;
use super::gas::ring_ledger;
use super::{Grid, constants, surface};
use crate::explosive::DENSEST;
use crate::gpu::WORKGROUP;
use crate::numerics::Scan;
use crate::scene::{BURN_WIDTH, Boundary, Ghost, Integrator, InterfacePressure, Pair, Scene};
use crate::structure::structure;
use crate::structure::types::{vec3f, vec3u, vec4f, vec4u};

structure! {
    /// What one run fixes: grid, gas, limits.
    #[derive(Clone, Copy, Debug, Pod, Zeroable)]
    pub Params as "Params" {
        /// Cells per axis, 1 on inactive axes.
        cells: vec3u,
        /// Length of every cell, node and vertex array.
        slots: u32,
        /// Cells per axis with the ring.
        stride: vec3u,
        /// Particles.
        particles: u32,
        /// Low corner of the domain \[m\].
        origin: vec3f,
        /// Cell edge \[m\].
        spacing: f32,
        /// Gravity \[m s^-2\].
        gravity: vec3f,
        /// Ratio of specific heats.
        gamma: f32,
        /// Ambient density \[kg m^-3\].
        ambient_density: f32,
        /// Ambient pressure \[Pa\].
        ambient_pressure: f32,
        /// Courant number of the material velocity.
        cfl: f32,
        /// Cap of c dt / dx.
        max_courant: f32,
        /// Cap of dt over the previous dt.
        max_growth: f32,
        /// Fixed step \[s\], 0 for none.
        fixed_step: f32,
        /// Courant number of the elastic sub-steps.
        elastic_cfl: f32,
        /// Share of a cell that makes it solid.
        solid_threshold: f32,
        /// Least node mass that the pressure solve sees \[kg\].
        mass_floor: f32,
        /// Relative tolerance of the solve.
        tolerance: f32,
        /// Vertices that may carry P, h and Q apart.
        extra_capacity: u32,
        /// Iterations after which a solve counts as stalled.
        max_iterations: u32,
        /// Probes.
        probes: u32,
        /// Steps that the history ring holds.
        history: u32,
        /// Bodies.
        bodies: u32,
        /// Largest number of sub-steps of one step.
        max_substeps: u32,
        /// Groups that leave partial results.
        groups: u32,
        /// Slots that one thread of a marching kernel takes one after the other, along the last axis.
        march: u32,
        /// Sides that hold solids back, as bits: x-, x+, y-, y+, z-, z+.
        wall_sides: u32,
        /// p / rho^gamma that no gas falls below.
        least_entropy: f32,
        /// Vertices whose interface pressure has a row in the preconditioner.
        surface_rows: u32,
        /// 1 if the advection leaves out what motion does not reach by the solve, with the same result.
        still: u32,
        /// Place of the rows of blocks in [`super::Interface::extra`].
        still_at: u32,
        /// Place of the table of cut cells there.
        table_at: u32,
        /// Slots of a row, as sums take them (`shaders/shared/pcg.wgsl`).
        row: u32,
        /// Ratio of specific heats of the second gas.
        species_gamma: f32,
        /// p / rho^gamma that none of it falls below.
        species_least_entropy: f32,
        /// Mass fraction of the second gas in the ambient state \[1\].
        ambient_share: f32,
        /// Its volume fraction there \[1\].
        ambient_volume: f32,
        /// Energy that the explosive holds \[J kg^-1\].
        chemical_energy: f32,
        /// Share of it that burns per time where a detonation passes \[s^-1\].
        burn_rate: f32,
        /// What its products give where they burn on in the first gas, over that energy \[1\].
        fuel: f32,
        /// Mass of the first gas with which they burn whole, over their own \[1\].
        air_needed: f32,
        /// How fast those burn that have met enough of it \[s^-1\].
        afterburn_rate: f32,
        /// Density beyond which the law of its products does not hold \[kg m^-3\].
        densest: f32,
        /// Sides that are planes of symmetry, as bits, and from bit 8 on open sides whose nodes go with the cells before them.
        sides: u32,
        /// A and B \[Pa\], R1 and R2 times the density of the explosive \[kg m^-3\].
        products: vec4f,
        /// Groups of each dispatch of a prefix sum over all slots and one more.
        scan: [vec4u; SCAN_DISPATCHES],
    }
}

/// What the scene's particles add to the parameters.
#[derive(Clone, Copy, Debug, Default)]
pub struct SolidLimits {
    /// Number of particles.
    pub particles: u32,
    /// Largest density of a particle \[kg m^-3\].
    pub max_density: f64,
}

/// Smallest share of a full node's mass that the solve sees: lighter nodes would rule its conditioning.
pub(crate) const LIGHTEST_NODE: f64 = 0.01;
/// The same as a share of the heaviest node next to it, in 1D, 2D and 3D: all that the nodes of one particle gain stays below half of
/// its mass.
pub(crate) const LIGHTEST_BESIDE: [f64; 3] = [0.5, 0.2, 0.03];
/// Steps that the history ring holds; the host reads it before it wraps.
pub const HISTORY: u32 = 256;

/// What the device decides about sizes.
#[derive(Clone, Copy, Debug)]
pub struct DeviceLimits {
    /// Vertices that may carry P, h and Q apart.
    pub extra_capacity: u32,
    /// Groups, at most, that leave partial results.
    pub groups: u32,
    /// Slots that each of their threads takes before there is another group.
    pub per_thread: u32,
    /// Slots that one thread of a marching kernel takes.
    pub march: u32,
}

impl DeviceLimits {
    /// Limits for a number of extra vertices. On a CPU every barrier of a reduction costs more than the work it shares out.
    pub fn new(software: bool, extra_capacity: usize) -> Self {
        let extra_capacity = extra_capacity as u32;
        if software {
            return Self {
                extra_capacity,
                groups: SOFTWARE_GROUPS,
                per_thread: SOFTWARE_PER_THREAD,
                march: SOFTWARE_MARCH,
            };
        }
        Self { extra_capacity, groups: constants::PARTIALS, per_thread: 1, march: MARCH }
    }
}

/// Groups that leave partial results on a software driver (measured: 1024 cost 10 ms more per reduction at 512 x 512).
const SOFTWARE_GROUPS: u32 = 64;
/// Slots per thread of these groups in small scenes.
const SOFTWARE_PER_THREAD: u32 = 32;
/// Length of a march on a CPU, where reading a neighbour again costs as much as the first time.
const SOFTWARE_MARCH: u32 = 16;
/// The same on a GPU, which needs the threads more (not measured on one).
pub(super) const MARCH: u32 = 4;

/// Length of the marches over `rows` slots, at most `longest`: all as long as the others, or a row less, so that no thread has little to do.
fn even_march(rows: u32, longest: u32) -> u32 {
    rows.div_ceil(rows.div_ceil(longest))
}

impl Params {
    /// Groups of a kernel over both kinds of slots (`shaders/shared/domain.wgsl`).
    pub(crate) fn groups_over_both(&self) -> u32 {
        self.slots.div_ceil(WORKGROUP).next_multiple_of(constants::LIST_PARTS)
    }

    /// Parameters of a scene on its grid.
    pub fn new(scene: &Scene, grid: &Grid, solids: &SolidLimits, limits: &DeviceLimits) -> Params {
        let (time, numerics) = (&scene.time, &scene.numerics);
        let cell_volume = scene.domain.cell_volume();
        let (gases, ambient) = (scene.gas.equation_of_state(), &scene.gas.ambient);
        let burn = Burn::of(scene);
        let mut params = Params {
            cells: grid.cells,
            slots: grid.slots() as u32,
            stride: grid.strides(),
            particles: solids.particles,
            origin: grid.origin,
            spacing: grid.spacing,
            gravity: scene.gravity.map(|g| g as f32),
            gamma: scene.gas.gamma as f32,
            ambient_density: scene.gas.ambient.density as f32,
            ambient_pressure: scene.gas.equation_of_state().pressure_in_single(&scene.gas.ambient),
            cfl: time.cfl as f32,
            max_courant: scene.time.max_courant as f32,
            max_growth: time.max_growth as f32,
            fixed_step: time.fixed_step.unwrap_or(0.0) as f32,
            elastic_cfl: numerics.expert.elastic_cfl as f32,
            solid_threshold: numerics.paper.solid_threshold as f32,
            mass_floor: (LIGHTEST_NODE * solids.max_density * cell_volume) as f32,
            tolerance: numerics.tolerance as f32,
            extra_capacity: limits.extra_capacity,
            max_iterations: numerics.expert.max_iterations,
            probes: scene.probes.len() as u32,
            history: HISTORY,
            bodies: scene.bodies.len() as u32,
            max_substeps: scene.max_substeps(),
            groups: (grid.slots() as u32)
                .max(solids.particles)
                .div_ceil(WORKGROUP * limits.per_thread)
                .clamp(1, limits.groups),
            march: even_march(grid.strides()[scene.domain.dimension as usize - 1], limits.march),
            wall_sides: wall_sides(scene),
            sides: mirrored_sides(scene, solids.particles > 0) | joined_sides(scene) << 8,
            surface_rows: surface::rows(grid.slots(), limits.extra_capacity as usize) as u32,
            still: 1,
            row: sum_row(scene, grid, solids.particles > 0),
            species_gamma: gases.gamma_at(1.0) as f32,
            ambient_share: ambient.mass_fraction as f32,
            ambient_volume: gases.volume_fraction(ambient.mass_fraction) as f32,
            chemical_energy: burn.energy as f32,
            burn_rate: burn.rate as f32,
            fuel: burn.fuel as f32,
            air_needed: burn.air_needed as f32,
            afterburn_rate: burn.afterburn_rate as f32,
            densest: burn.densest as f32,
            products: burn.terms.map(|term| term as f32),
            ..Zeroable::zeroed()
        };
        let places = super::interface::Places::new(params.stride.map(u64::from), scene.domain.dimension);
        (params.still_at, params.table_at) = (places.still as u32, places.end as u32);
        for (entry, [x, y, z]) in params.scan.iter_mut().zip(Scan::plan(grid.slots() as u32 + 1)) {
            *entry = [x, y, z, 0];
        }
        params
    }
}

/// Numbers of an explosive: energy \[J kg^-1\], share that burns per time \[s^-1\], what its products give in air over the energy, the air
/// that they need over their mass, how fast they burn there \[s^-1\], largest density \[kg m^-3\], and A, B, R1 and R2 as the shaders have them.
#[derive(Debug, Default)]
struct Burn {
    energy: f64,
    rate: f64,
    fuel: f64,
    air_needed: f64,
    afterburn_rate: f64,
    densest: f64,
    terms: [f64; 4],
}

impl Burn {
    fn of(scene: &Scene) -> Self {
        let Some(own) = scene.gas.products() else { return Self::default() };
        Self {
            energy: own.specific_energy(),
            rate: own.detonation_speed / (BURN_WIDTH * scene.domain.spacing()),
            fuel: scene.gas.equation_of_state().species.map_or(0.0, |own| own.fuel),
            air_needed: own.air_needed(),
            afterburn_rate: scene.gas.afterburn().map_or(0.0, f64::recip),
            densest: DENSEST * own.density,
            terms: own.products.rates(own.density),
        }
    }
}

/// Values of the pipeline overrides: dimension and the switches of the method.
pub fn overrides(scene: &Scene, solids: bool) -> Vec<(&'static str, f64)> {
    let numerics = &scene.numerics;
    let flag = |on: bool| f64::from(u8::from(on));
    vec![
        ("DIM", f64::from(scene.domain.dimension)),
        ("SOLIDS", flag(solids)),
        (
            "MATERIALS_USED",
            f64::from(scene.materials.values().fold(0, |used, material| used | 1 << material.kind_index())),
        ),
        ("FRACTURE", flag(scene.breaks())),
        ("JOHNSON_COOK", flag(scene.flows())),
        ("QUADRATIC", flag(numerics.pair == Pair::B2b1)),
        ("PREDICTOR", flag(scene.integrator() != Integrator::Paper)),
        ("CONSISTENT", flag(scene.consistent())),
        ("ARS", flag(scene.solves() == 2)),
        ("SPECIES", flag(!scene.gas.species.is_empty())),
        ("PRODUCTS", flag(scene.gas.products().is_some())),
        ("FOURTH", flag(scene.sound_of_fourth_order())),
        ("RING_LEDGER", flag(ring_ledger(scene, solids))),
        ("LATE_FLUX", flag(scene.late_flux())),
        ("IMPLICIT", flag(numerics.elasticity == crate::scene::Elasticity::Implicit)),
        ("SHARED_VOLUME", flag(numerics.paper.ghost == Ghost::SharedVolume)),
        ("PERIODIC", f64::from((0..3).map(|axis| u32::from(scene.boundary.periodic(axis)) << axis).sum::<u32>())),
        ("MIRRORED", flag(mirrored_sides(scene, solids) != 0)),
        ("JOINED", flag(joined_sides(scene) != 0)),
        (
            "INTERFACE",
            f64::from(constants::number(
                &constants::INTERFACES,
                match scene.interface_pressure() {
                    InterfacePressure::Resolved | InterfacePressure::Auto => "RESOLVED",
                    InterfacePressure::H => "H",
                    InterfacePressure::Single => "SINGLE",
                },
            )),
        ),
    ]
}

/// Slots of a row of sums: those of the grid across its last axis in gas alone with the simplest solve, else all. Either would do; the
/// last bits of what has been computed with them follow from the choice.
fn sum_row(scene: &Scene, grid: &Grid, solids: bool) -> u32 {
    let numerics = &scene.numerics;
    let alone = !solids && scene.obstacles.is_empty() && scene.gravity == [0.0; 3] && scene.filter().is_none();
    let simplest = numerics.pair == Pair::B1b0 && scene.solves() == 1 && super::coarse::plan(scene).is_none();
    let across = scene.domain.dimension > 1 && alone && simplest;
    let last = grid.strides()[scene.domain.axes() - 1];
    grid.slots() as u32 / if across { last } else { 1 }
}

/// Sides that are walls and nothing else, and so planes of symmetry for gas alone, as bits.
fn mirrored_sides(scene: &Scene, solids: bool) -> u32 {
    let wall = |side: &Boundary| !solids && side.rules().iter().all(|rule| **rule == Boundary::Wall);
    let sides = scene.boundary.sides().into_iter().enumerate().take(2 * scene.domain.axes());
    sides.map(|(index, side)| u32::from(wall(side)) << index).sum()
}

/// Sides beyond all of whose faces the gas has the velocity of that before them, as bits; B1B0 only.
fn joined_sides(scene: &Scene) -> u32 {
    if scene.numerics.pair == Pair::B2b1 {
        return 0;
    }
    let joins = |rule: &&Boundary| {
        matches!(rule, Boundary::Outlet | Boundary::FarField(_) | Boundary::PressureOutlet(_) | Boundary::TotalInlet(_))
    };
    let sides = scene.boundary.sides().into_iter().enumerate().take(2 * scene.domain.axes());
    sides.map(|(index, side)| u32::from(side.rules().iter().all(joins)) << index).sum()
}

/// Sides whose base rule is a wall, as bits.
fn wall_sides(scene: &Scene) -> u32 {
    let wall = |side: &Boundary| *side.rules()[0] == Boundary::Wall;
    scene.boundary.sides().iter().enumerate().map(|(index, side)| u32::from(wall(side)) << index).sum()
}
