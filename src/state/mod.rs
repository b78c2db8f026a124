//! Buffers and their host mirrors; no algorithms. Here the scene meets the device.

pub mod arrays;
pub(crate) mod coarse;
pub mod constants;
pub mod control;
pub mod cut;
mod dust;
mod elastic_solve;
pub mod gas;
pub mod gauges;
pub mod grid;
pub mod interface;
pub mod loads;
pub mod memory;
mod names;
pub mod openings;
pub mod params;
pub mod particles;
pub mod phases;
pub mod stages;
pub mod supports;
pub(crate) mod surface;

pub use control::Control;
pub use elastic_solve::ElasticBuffers;
pub use gas::GasState;
pub use gauges::GaugeBuffers;
pub use grid::Grid;
pub use interface::Interface;
pub use memory::{MemoryPlan, memory_together};
pub use openings::{Knot, MAX_OPENINGS, Opening, Openings};
pub use params::{HISTORY, Params};
pub use particles::{ParticleStart, Particles};
pub use phases::{Over, Phase};
pub use supports::{MotionAt, Support, Supports};

use crate::error::Result;
use crate::gpu::{Bound, Buffer, Constants, Gpu, Kernel, Settings};
use crate::numerics::PcgVectors;
use crate::scene::{Conserved, Pair, Scene};
use params::{DeviceLimits, SolidLimits};

/// Materials that one scene may use.
pub const MAX_MATERIALS: usize = 64;
/// Numbers of a material on the device.
const MATERIAL_WIDTH: usize = size_of::<crate::material::MaterialParams>() / 4;

/// Everything the step reads and writes, and the names the shaders know it by.
#[derive(Debug)]
pub struct State {
    /// The device.
    pub gpu: Gpu,
    /// The grid.
    pub grid: Grid,
    /// What the run fixes.
    pub params: Params,
    /// The same on the device.
    pub params_buffer: Buffer<Params>,
    /// What the device decides.
    pub control: Buffer<Control>,
    /// Group counts of the indirect dispatches.
    pub extents: Buffer<u32>,
    /// What lies beyond the sides, now.
    pub openings: Buffer<Opening>,
    /// Tables of times of the inlets.
    pub knots: Buffer<Knot>,
    /// What holds bodies, now.
    pub supports: Buffer<Support>,
    /// Motions of driven parts over time.
    pub motions: Buffer<MotionAt>,
    /// Materials, as shaders see them.
    pub materials: Buffer<f32>,
    /// Gas.
    pub gas: GasState,
    /// Marks.
    pub interface: Interface,
    /// Solids.
    pub particles: Particles,
    /// Least p / rho^gamma of the gas of the start and of what may flow in, of the first gas and the second \[Pa (m^3/kg)^gamma\].
    pub start_entropy: [f64; 2],
    /// Unknowns of the pressure system: X. Behind them what each vertex asks of the gas around it (`shaders/interface/parting.wgsl`).
    pub pressure: Buffer<f32>,
    /// S^-1 of each unknown.
    pub stiffness: Buffer<f32>,
    /// Vectors of the conjugate gradient method.
    pub pcg: PcgVectors,
    /// What the implicit elastic step needs, in scenes that want it.
    pub elastic_solve: Option<ElasticBuffers>,
    /// Partial results of reductions: [`constants::BLOCKS`] blocks of one vec4 per group.
    pub partials: Buffer<[f32; 4]>,
    /// Sums of the loads of a step, and who owns each slot, see [`loads`].
    pub loads: Buffer<u32>,
    /// Loads of the latest steps.
    pub load_history: Buffer<[f32; 4]>,
    /// Bodies, obstacles and sides whose loads are told.
    pub load_count: [usize; 3],
    /// Momentum of the gas at the start \[kg m s^-1\].
    pub start_momentum: [f64; 3],
    /// Records of the latest steps.
    pub history: Buffer<[f32; 4]>,
    /// Slots that the probes look at.
    pub probe_cells: Buffer<u32>,
    /// Two entries per probe and step.
    pub probe_history: Buffer<[f32; 4]>,
    /// Largest pressure so far \[Pa\], impulse of the pressure above ambient \[Pa s\] and what that sum lost to rounding, largest plastic
    /// strain, per slot; empty where the scene asks for no maps.
    pub maps: Buffer<[f32; 4]>,
    /// Dust in each slot and beside it on the ground, see [`arrays`]; empty without any.
    pub dust: Buffer<f32>,
    /// Points of bodies that have gauges.
    pub gauges: GaugeBuffers,
    /// Whether the gas element pair is B2B1.
    pub quadratic: bool,
    /// Whether some material breaks.
    pub breaks: bool,
    overrides: Vec<(&'static str, f64)>,
}

/// Share of the vertices that may carry P, h and Q apart: only surfaces of fragments do.
const EXTRA_SHARE: usize = 16;

/// Vertices that may carry P, h and Q apart in a scene with this many slots and particles.
fn extra_capacity(slots: usize, particles: usize, dimension: u32) -> usize {
    if particles == 0 { 0 } else { (slots / EXTRA_SHARE).max(4096).min(slots).min(particles << dimension) }
}

impl State {
    /// Gas that flows in may be colder than all that was there.
    pub(crate) fn admit(&mut self, scene: &Scene, openings: &Openings) {
        for (own, beyond) in self.start_entropy.iter_mut().zip(gas::start_entropy(scene, &[], openings)) {
            if beyond > 0.0 && beyond < *own {
                *own = beyond;
            }
        }
        self.keep_entropy(scene, self.start_entropy);
    }

    /// Takes the least entropies of another start.
    pub(crate) fn keep_entropy(&mut self, scene: &Scene, start: [f64; 2]) {
        self.start_entropy = start;
        [self.params.least_entropy, self.params.species_least_entropy] = gas::least_entropies(scene, start);
    }

    /// Fills buffers from a scene.
    ///
    /// # Errors
    /// If the device has no room, or a driver error.
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<State> {
        let (grid, start) = (Grid::of(&scene.domain), ParticleStart::new(scene));
        let (slots, limits) =
            (grid.slots(), SolidLimits { particles: start.len() as u32, max_density: start.max_density });
        let (capacity, geometry) = (extra_capacity(slots, start.len(), grid.dimension), scene.cut_geometry());
        let (unknowns, openings, supports) = (slots + 2 * capacity, Openings::new(scene), Supports::new(scene));
        let start_gas = cut::initial_gas(scene, &geometry);
        let start_entropy = gas::start_entropy(scene, &start_gas, &openings);
        let [least_entropy, species_least_entropy] = gas::least_entropies(scene, start_entropy);
        let params = Params {
            least_entropy,
            species_least_entropy,
            ..Params::new(scene, &grid, &limits, &DeviceLimits::new(gpu.settings == Settings::Software, capacity))
        };
        let cut = cut::words(&grid, &geometry, !start.is_empty(), params.table_at);
        let (params, mut overrides) = (cut.placed(params), params::overrides(scene, !start.is_empty()));
        overrides.extend(loads::overrides(scene, &start_gas, &openings));
        overrides.extend(switches(&supports, &openings, geometry.cells.is_empty()));
        let state = State {
            gpu: gpu.clone(),
            grid,
            params,
            start_entropy,
            params_buffer: Buffer::uniform(gpu, "params", 1)?,
            control: Buffer::new(gpu, "control", 1)?,
            extents: Buffer::indirect(gpu, "extents", phases::LENGTH)?,
            openings: Buffer::uniform_storage(gpu, "openings", &openings.padded())?,
            knots: Buffer::from_slice(gpu, "knots", &openings.knots)?,
            supports: Buffer::uniform_storage(gpu, "supports", &supports.padded())?,
            motions: Buffer::from_slice(gpu, "motions", &supports.motions)?,
            materials: Buffer::uniform(gpu, "materials", MAX_MATERIALS * MATERIAL_WIDTH)?,
            gas: GasState::new(gpu, scene, &grid, start.len())?,
            interface: Interface::new(gpu, &params, grid.dimension, !start.is_empty(), cut.length())?,
            particles: Particles::new(gpu, slots, &start, scene.consistent(), scene.elastic_vectors())?,
            pressure: Buffer::new(gpu, "pressure", unknowns + slots)?,
            stiffness: Buffer::new(gpu, "stiffness", unknowns)?,
            pcg: PcgVectors::new(gpu, unknowns)?,
            elastic_solve: ElasticBuffers::new(gpu, scene, slots, &start)?,
            partials: Buffer::new(gpu, "partials", (constants::BLOCKS * constants::PARTIALS) as usize)?,
            loads: Buffer::from_slice(gpu, "loads", &loads::start(scene, &grid, &geometry))?,
            load_history: Buffer::new(gpu, "load_history", loads::history_length(loads::count(scene)))?,
            load_count: loads::count(scene),
            start_momentum: cut::momentum(scene, &geometry, &start_gas),
            history: Buffer::new(gpu, "history", (HISTORY * constants::HISTORY_WIDTH) as usize)?,
            probe_cells: Buffer::from_slice(gpu, "probe_cells", &probe_slots(scene, &grid))?,
            probe_history: Buffer::new(gpu, "probe_history", 2 * HISTORY as usize * scene.probes.len())?,
            gauges: GaugeBuffers::new(gpu, scene, &start)?,
            maps: Buffer::new(gpu, "maps", if scene.keeps_maps() { slots } else { 0 })?,
            dust: dust::new(gpu, scene, &grid, &geometry)?,
            quadratic: scene.numerics.pair == Pair::B2b1,
            breaks: scene.breaks(),
            overrides,
        };
        state.fill(gpu, scene);
        state.fill_gas(gpu, scene, &openings, &start_gas, &geometry);
        cut.write(gpu, &state.interface.extra);
        Ok(state)
    }

    /// Parameters, control and materials.
    fn fill(&self, gpu: &Gpu, scene: &Scene) {
        self.params_buffer.write(gpu, 0, &[self.params]);
        self.control.write(gpu, 0, &[Control { fault: constants::NO_FAULT, ..Control::default() }]);
        self.materials.write(gpu, 0, bytemuck::cast_slice(&scene.material_parameters()));
    }

    /// Initial gas and kinds of all slots.
    fn fill_gas(
        &self,
        gpu: &Gpu,
        scene: &Scene,
        openings: &Openings,
        gas: &[Conserved],
        geometry: &crate::scene::CutGeometry,
    ) {
        let (grid, slots, gases) = (&self.grid, self.grid.slots(), scene.gas.equation_of_state());
        let mut conserved = vec![[0.0f32; 4]; slots];
        let mut energy = vec![0.0f32; slots];
        let mut pressure = vec![0.0f32; slots];
        let mut species = if gases.species.is_some() { vec![vec![0.0f32; slots]; 2] } else { Vec::new() };
        let (burn, full) = (scene.burn_starts(), gases.full_charge());
        let mut cells = vec![constants::GAS; slots];
        let walls = &geometry.walls;
        let (padding, stride) = (grid.padding(), grid.strides());
        for z in 0..stride[2] as i32 {
            for y in 0..stride[1] as i32 {
                for x in 0..stride[0] as i32 {
                    let cell = [x - padding[0] as i32, y - padding[1] as i32, z - padding[2] as i32];
                    cells[grid.slot(cell)] = openings.word(scene, grid, cell);
                }
            }
        }
        let [nx, ny, nz] = grid.cells.map(|n| n as i32);
        let mut index = 0;
        for z in 0..nz {
            for y in 0..ny {
                for x in 0..nx {
                    let slot = grid.slot([x, y, z]);
                    cells[slot] = if walls[index] { constants::WALL } else { constants::GAS };
                    if !walls[index] {
                        let [density, u, v, w, total, part, phi] = gas[index].map(|value| value as f32);
                        conserved[slot] = [density, u, v, w];
                        energy[slot] = total;
                        let held = gas::held_at_start(&burn, index, full);
                        pressure[slot] = gases.pressure(gas[index], held) as f32;
                        species.iter_mut().zip([part, phi]).for_each(|(own, value)| own[slot] = value);
                    }
                    index += 1;
                }
            }
        }
        for cut in geometry.cells.iter().filter(|_| self.has_solids()) {
            cells[grid.slot(cut.cell.map(|c| c as i32))] |= constants::CUT_MARK;
        }
        if !self.maps.is_empty() {
            self.maps.write(gpu, 0, &gas::first_maps(&conserved, &pressure));
        }
        self.gas.conserved.write(gpu, 0, &conserved);
        self.gas.energy.write(gpu, 0, &energy);
        self.gas.write_burn(gpu, grid, &burn, species.first().map_or(&[], Vec::as_slice), full);
        for (own, part) in species.iter().zip([arrays::SPECIES_DENSITY, arrays::SPECIES_VOLUME]) {
            self.gas.energy.write(gpu, part * slots, own);
        }
        self.interface.cells.write(gpu, 0, &cells);
    }

    /// Whether something may flow through sides.
    pub fn is_open(&self) -> bool {
        self.overrides.iter().any(|(name, value)| *name == "RULES_USED" && *value > 0.0)
    }

    /// Whether obstacles cut cells.
    pub fn cuts(&self) -> bool {
        self.overrides.iter().any(|(name, value)| *name == "CUT" && *value > 0.0)
    }

    /// Whether the scene has bodies.
    pub fn has_solids(&self) -> bool {
        self.particles.count > 0
    }

    /// Compiles an entry point with this scene's switches and binds the buffers that it names. `renamed` adds names, or gives
    /// a name to another buffer; `switches` adds overrides.
    ///
    /// # Errors
    /// If the shader is wrong or uses a name that is not known here.
    pub fn bind(
        &self,
        shader: &str,
        entry: &str,
        renamed: &[(&str, &wgpu::Buffer)],
        switches: &[(&str, f64)],
    ) -> Result<Bound> {
        self.bind_kernel(&self.kernel(shader, entry, switches)?, renamed)
    }

    /// Compiles an entry point with this scene's switches and the given ones, for [`State::bind_kernel`]. Without a switch `SWEEP` it goes
    /// over all slots.
    ///
    /// # Errors
    /// If the shader is wrong.
    pub fn kernel(&self, shader: &str, entry: &str, switches: &[(&str, f64)]) -> Result<Kernel> {
        let mut all: Vec<(&str, f64)> = self.overrides.clone();
        all.extend_from_slice(switches);
        if switches.iter().all(|(name, _)| *name != "SWEEP") {
            all.push(("SWEEP", f64::from(Over::Slots as u32)));
        }
        let source = constants::source_for(shader);
        Kernel::new(&self.gpu, shader, entry, &Constants { overrides: &all, source: &source })
    }

    /// Binds the buffers that a kernel names: once compiled, it can run with several.
    ///
    /// # Errors
    /// If the kernel uses a name that is not known here.
    pub fn bind_kernel(&self, kernel: &Kernel, renamed: &[(&str, &wgpu::Buffer)]) -> Result<Bound> {
        let named = self.names();
        let buffer_of =
            |name: &str| renamed.iter().chain(&named).find(|(known, _)| *known == name).map(|(_, buffer)| *buffer);
        let buffers: Vec<_> = kernel
            .bindings()
            .iter()
            .filter_map(|binding| buffer_of(&binding.name).map(|buffer| (binding.name.as_str(), buffer)))
            .collect();
        kernel.bind(&self.gpu, &buffers)
    }
}

/// What bodies, obstacles and open sides switch on.
fn switches(supports: &Supports, openings: &Openings, whole: bool) -> [(&'static str, f64); 4] {
    let flag = |on: bool| f64::from(u8::from(on));
    [
        ("DRIVEN", flag(supports.driven)),
        ("FRICTION", flag(supports.friction)),
        ("CUT", flag(!whole)),
        ("RULES_USED", f64::from(openings.rules_used())),
    ]
}

/// Slot of the cell that each probe looks at.
pub(crate) fn probe_slots(scene: &Scene, grid: &Grid) -> Vec<u32> {
    let slot = |probe: &crate::scene::Probe| {
        let cell = std::array::from_fn(|axis| {
            let at = ((probe.position[axis] - grid.low()[axis]) / f64::from(grid.spacing)).floor() as i32;
            at.clamp(0, grid.cells[axis] as i32 - 1)
        });
        grid.slot(cell) as u32
    };
    scene.probes.iter().map(slot).collect()
}
