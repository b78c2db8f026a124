//! What a scene needs on the device, before anything is allocated.

use serde::Serialize;

use super::{
    HISTORY, Knot, MAX_MATERIALS, MAX_OPENINGS, Opening, Openings, Params, Support, coarse, constants,
    control::Control, elastic_solve, extra_capacity, gauges, loads, surface,
};
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::math::greatest_divisor;
use crate::numerics::{PcgControl, Scan, pcg};
use crate::scene::{MAX_BODIES, Scene};

/// Labels of buffers that the plan counts together with others: of prefix sums, of terms of the surface, of colours of
/// columns, of stages of the advection.
const COUNTED_TOGETHER: [&str; 6] = ["scan level", "scan totals", "scan offsets", "turn", "color", "advection"];

/// Bytes in a gibibyte.
const GIB: f64 = (1u64 << 30) as f64;

/// One buffer to come.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Planned {
    /// `gas`, `interface`, `pressure`, `nodes`, `particles`, or `fixed` for what does not grow with the scene.
    pub group: &'static str,
    /// Label of the buffer.
    pub name: &'static str,
    /// Size \[bytes\].
    pub bytes: u64,
}

/// All buffers of a simulation.
#[derive(Clone, Debug, Serialize)]
pub struct MemoryPlan {
    /// Cells of the domain, without the ring.
    pub cells: u64,
    /// Particles.
    pub particles: u64,
    /// Cells that obstacles cut.
    pub cut_cells: u64,
    /// The buffers.
    pub buffers: Vec<Planned>,
}

impl MemoryPlan {
    /// The plan for a scene with so many particles ([`Scene::particle_count`]).
    pub fn new(scene: &Scene, particles: usize) -> Self {
        Self::with_cut_cells(scene, particles, cut_cells(scene))
    }

    /// The same with a known number of cut cells.
    fn with_cut_cells(scene: &Scene, particles: usize, cut_cells: u64) -> Self {
        let dimension = scene.domain.dimension;
        let padded = |axis: usize| u64::from(scene.domain.cells[axis]) + 2 * u64::from((axis as u32) < dimension);
        let slots = padded(0) * padded(1) * padded(2);
        let places = super::interface::Places::new([0, 1, 2].map(padded), dimension);
        let count = particles as u64;
        let solid = if particles == 0 { 1 } else { slots };
        let parts = |array: &str| super::arrays::parts(array, scene) as u64 * slots;
        let numbers = if particles > 0 && cut_cells > 0 { slots + 1 } else { 0 };
        let table = super::cut::WIDTH as u64 * cut_cells + numbers;
        let mut plan = Self {
            cells: scene.domain.cells.iter().map(|&n| u64::from(n)).product(),
            particles: count,
            cut_cells,
            buffers: Vec::new(),
        };
        plan.add("gas", &[("conserved", slots, 16), ("work", parts("work"), 16)]);
        plan.add("gas", &[("energy", parts("energy"), 4)]);
        let ledger = if super::gas::ring_ledger(scene, particles > 0) { slots - plan.cells } else { slots };
        let owed = super::arrays::parts("owed_energy", scene) as u64 * ledger;
        plan.add("gas", &[("owed_flow", ledger, 16), ("owed_energy", owed, 4)]);
        plan.add("interface", &[("cells", slots, 4), ("fill", slots, 8), ("ghost", solid, 4)]);
        plan.add("interface", &[("extra", places.end + table, 4)]);
        plan.add_pressure(slots as usize, extra_capacity(slots as usize, particles, dimension), dimension as usize);
        plan.add("particles", &[("position", count, 16), ("velocity", count, 16), ("affine", 3 * count, 16)]);
        plan.add("particles", &[("deformation", 3 * count, 16), ("stress", 2 * count, 16), ("order", count, 4)]);
        plan.add(
            "nodes",
            &[
                ("node", if scene.consistent() { slots } else { solid }, 16),
                ("cell_start", solid + 1, 4),
                ("inertia", solid, 4),
            ],
        );
        let elastic = if particles == 0 { 0 } else { scene.elastic_vectors() as u64 * slots };
        plan.add("nodes", &[("elastic", elastic, 16)]);
        if elastic_solve::wanted(scene, particles) {
            plan.add_elastic_solve(slots, count, scene.bodies.len() as u64);
        }
        plan.add_levels(scene);
        let scan = Scan::planned_bytes(slots as u32 + 1);
        plan.add("interface", &[("list scans", 2 * scan, 1)]);
        if particles > 0 {
            plan.add("nodes", &[("sort scan", scan, 1)]);
        }
        plan.add("fixed", &[("openings", MAX_OPENINGS as u64, size_of::<Opening>() as u64)]);
        plan.add("fixed", &[("knots", Openings::knots_of(scene), size_of::<Knot>() as u64)]);
        plan.add("fixed", &[("supports", MAX_BODIES as u64, size_of::<Support>() as u64)]);
        let motions = super::Supports::new(scene).motions.len() as u64;
        plan.add("fixed", &[("motions", motions, size_of::<super::MotionAt>() as u64)]);
        plan.add("gas", &[("maps", if scene.keeps_maps() { slots } else { 0 }, 16), ("dust", parts("dust"), 4)]);
        plan.add_recorded(scene, slots as usize);
        plan.add_fixed(scene.probes.len() as u64);
        plan
    }

    /// What is recorded in every step beside the totals.
    fn add_recorded(&mut self, scene: &Scene, slots: usize) {
        let load_history = loads::history_length(loads::count(scene)) as u64;
        self.add("fixed", &[("loads", loads::length(scene, slots) as u64, 4), ("load_history", load_history, 16)]);
        let points = gauges::count(scene) as u64;
        let states = u64::from(gauges::GAUGE_WIDTH) * u64::from(HISTORY) * points;
        self.add("fixed", &[("gauge_particles", points, 4), ("gauge_history", states, 16)]);
    }

    /// Buffers of the pressure system.
    fn add_pressure(&mut self, slots: usize, capacity: usize, dimension: usize) {
        let unknowns = (slots + 2 * capacity) as u64;
        let names = ["pressure", "stiffness", "solution", "residual", "direction", "product", "inverse_diagonal"];
        self.add("pressure", &names.map(|name| (name, unknowns, 4)));
        self.add("pressure", &[("what vertices ask", slots as u64, 4)]);
        let rows = surface::rows(slots, capacity);
        let entries = (rows * surface::row_length(dimension)) as u64;
        if rows > 0 {
            self.add("pressure", &[("surface rows", entries, 4)]);
            self.add("fixed", &[("turns", surface::turns(rows).into(), 16)]);
        }
    }

    /// What the implicit elastic step needs.
    fn add_elastic_solve(&mut self, slots: u64, particles: u64, bodies: u64) {
        let (length, portions) = (elastic_solve::WIDTH as u64 * slots, elastic_solve::PORTIONS as u64);
        self.add("nodes", &["solution", "residual", "direction", "product"].map(|name| (name, length, 4)));
        self.add("nodes", &[("inverse_diagonal", length, 4)]);
        self.add("particles", &[("stress change", 2 * particles, 16)]);
        self.add("fixed", &[("portions", portions * bodies, 8), ("missing", (portions + 1) * bodies, 16)]);
        self.add("fixed", &[("pcg", 1, size_of::<PcgControl>() as u64), ("pcg_extents", pcg::EXTENTS as u64, 4)]);
    }

    /// Coarse levels of the pressure solve.
    fn add_levels(&mut self, scene: &Scene) {
        let Some(levels) = coarse::plan(scene) else { return };
        self.add("pressure", &[("levels", coarse::length(&levels) as u64, 8)]);
        self.add("fixed", &vec![("level", 1, size_of::<coarse::Level>() as u64); levels.len()]);
        self.add("fixed", &[("coarse_extents", coarse::EXTENTS as u64, 4)]);
    }

    /// Buffers whose size does not depend on cells and particles.
    fn add_fixed(&mut self, probes: u64) {
        let extents = super::phases::LENGTH as u64;
        let history = u64::from(HISTORY);
        self.add("fixed", &[("params", 1, size_of::<Params>() as u64), ("control", 1, size_of::<Control>() as u64)]);
        self.add("fixed", &[("extents", extents, 4), ("materials", (MAX_MATERIALS * super::MATERIAL_WIDTH) as u64, 4)]);
        self.add("fixed", &[("partials", u64::from(constants::BLOCKS * constants::PARTIALS), 16)]);
        self.add("fixed", &[("history", history * u64::from(constants::HISTORY_WIDTH), 16)]);
        self.add("fixed", &[("probe_cells", probes, 4), ("probe_history", 2 * history * probes, 16)]);
        self.add("fixed", &[("pcg", 1, size_of::<PcgControl>() as u64), ("pcg_extents", pcg::EXTENTS as u64, 4)]);
    }

    /// Adds buffers: label, elements, bytes of an element. An empty buffer takes the room of one element.
    fn add(&mut self, group: &'static str, buffers: &[(&'static str, u64, u64)]) {
        let planned = |&(name, elements, size): &(_, u64, u64)| Planned { group, name, bytes: elements.max(1) * size };
        self.buffers.extend(buffers.iter().map(planned));
    }

    /// Whether a full state of the scene may have an array of this name: that of a buffer, or of one of several with the same label.
    pub fn has_array(&self, name: &str) -> bool {
        let plain = name.trim_end_matches(|digit: char| digit.is_ascii_digit());
        let label = plain.strip_suffix('_').filter(|_| plain.len() < name.len()).unwrap_or(name);
        let known = |own: &str| label == own.replace(' ', "_");
        COUNTED_TOGETHER.iter().any(|own| known(own)) || self.buffers.iter().any(|buffer| known(buffer.name))
    }

    /// Bytes of a group, or of all.
    pub fn bytes(&self, group: Option<&str>) -> u64 {
        let chosen = self.buffers.iter().filter(|buffer| group.is_none_or(|group| group == buffer.group));
        chosen.map(|buffer| buffer.bytes).sum()
    }

    /// Groups in order, with their bytes.
    pub fn groups(&self) -> Vec<(&'static str, u64)> {
        let mut groups: Vec<(&'static str, u64)> = Vec::new();
        for buffer in &self.buffers {
            match groups.iter_mut().find(|(name, _)| *name == buffer.group) {
                Some((_, sum)) => *sum += buffer.bytes,
                None => groups.push((buffer.group, buffer.bytes)),
            }
        }
        groups
    }

    /// Bytes per cell of everything that grows with the number of cells.
    pub fn per_cell(&self) -> f64 {
        (self.bytes(None) - self.bytes(Some("particles")) - self.bytes(Some("fixed"))) as f64 / self.cells as f64
    }

    /// Bytes per particle of everything that grows with the number of particles.
    pub fn per_particle(&self) -> f64 {
        if self.particles == 0 { 0.0 } else { self.bytes(Some("particles")) as f64 / self.particles as f64 }
    }

    /// The largest buffer.
    pub fn largest(&self) -> Option<&Planned> {
        self.buffers.iter().max_by_key(|buffer| buffer.bytes)
    }

    /// Compares the plan with what one buffer and all buffers together may take \[bytes\].
    ///
    /// # Errors
    /// [`Error::DoesNotFit`] that names what is too large, the limit, and the resolution that fits.
    pub fn check(&self, scene: &Scene, device: &str, per_buffer: u64, together: Option<u64>) -> Result<()> {
        let fits = |plan: &Self| {
            plan.largest().is_none_or(|buffer| buffer.bytes <= per_buffer)
                && together.is_none_or(|limit| plan.bytes(None) <= limit)
        };
        if fits(self) {
            return Ok(());
        }
        let gib = |bytes: u64| bytes as f64 / GIB;
        let problem = match self.largest() {
            Some(buffer) if buffer.bytes > per_buffer => {
                let need = gib(buffer.bytes);
                format!("`{}` needs {need:.2} GiB, {device} allows {:.2} GiB per buffer", buffer.name, gib(per_buffer))
            }
            _ => {
                let limit = gib(together.unwrap_or(u64::MAX));
                format!("the scene needs {:.2} GiB, {device} has {limit:.2} GiB free", gib(self.bytes(None)))
            }
        };
        let advice = finest_resolution(scene, |cells| fits(&self.at(scene, cells)))
            .map_or_else(|| "use another --device".to_owned(), |cells| format!("--resolution {cells} fits"));
        Err(Error::DoesNotFit(format!("{problem}; {advice}")))
    }

    /// Counts particles, plans memory and compares the plan with the device before anything is allocated; the gas alone is checked
    /// first, because seeding a hopeless scene takes memory too.
    ///
    /// # Errors
    /// As [`MemoryPlan::check`].
    pub fn fitting(scene: &Scene, gpu: &Gpu) -> Result<Self> {
        Self::with_cut_cells(scene, 0, 0).check_device(scene, gpu)?;
        let plan = Self::new(scene, scene.particle_count());
        plan.check_device(scene, gpu)?;
        Ok(plan)
    }

    /// Compares the plan with a device.
    ///
    /// # Errors
    /// As [`MemoryPlan::check`].
    pub fn check_device(&self, scene: &Scene, gpu: &Gpu) -> Result<()> {
        let per_buffer = gpu.limits.max_storage_buffer_binding_size.min(gpu.limits.max_buffer_size);
        self.check(scene, &gpu.info.name, per_buffer, memory_together(gpu))
    }

    /// The plan at another number of cells along the longest axis, with particles in proportion.
    fn at(&self, scene: &Scene, cells: u32) -> Self {
        let longest = scene.domain.cells.iter().copied().max().unwrap_or(1);
        let mut scaled = scene.clone();
        for axis in 0..scene.domain.axes() {
            let along = u64::from(scene.domain.cells[axis]) * u64::from(cells) / u64::from(longest);
            scaled.domain.cells[axis] = along as u32;
        }
        let ratio = f64::from(cells) / f64::from(longest);
        let particles = self.particles as f64 * ratio.powi(scene.domain.dimension as i32);
        let cut = self.cut_cells as f64 * ratio.powi(scene.domain.dimension as i32 - 1);
        Self::with_cut_cells(&scaled, particles.ceil() as usize, cut.ceil() as u64)
    }
}

/// Bytes that a device has for all buffers together, where that is known: a software device takes main memory.
pub fn memory_together(gpu: &Gpu) -> Option<u64> {
    if gpu.is_software() { free_memory() } else { None }
}

/// Bytes of main memory that are free, where the system says so; a software device takes its memory there.
fn free_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: u64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(1024 * kibibytes)
}

/// Cells of the largest domain whose cut cells are counted.
const MOST_COUNTED: usize = 1 << 24;

/// Cut cells of a scene; those of huge domains in proportion to the surface, from a coarser one.
fn cut_cells(scene: &Scene) -> u64 {
    if !scene.cut() {
        return 0;
    }
    let (mut coarse, mut factor) = (scene.clone(), 1);
    while coarse.domain.cell_count() > MOST_COUNTED {
        factor *= 2;
        for axis in 0..scene.domain.axes() {
            coarse.domain.cells[axis] = (scene.domain.cells[axis] / factor).max(1);
        }
    }
    coarse.cut_geometry().cells.len() as u64 * u64::from(factor).pow(scene.domain.dimension - 1)
}

/// The largest number of cells along the longest axis below the scene's own that gives whole cubes on all axes and fits; what fits at
/// some number fits at every smaller one.
pub fn finest_resolution(scene: &Scene, fits: impl Fn(u32) -> bool) -> Option<u32> {
    let cells = &scene.domain.cells[..scene.domain.axes()];
    let divisor = cells.iter().copied().reduce(greatest_divisor).unwrap_or(1).max(1);
    let longest = cells.iter().copied().max().unwrap_or(1);
    let step = longest / divisor;
    let (mut good, mut bad) = (0, divisor);
    while bad - good > 1 {
        let middle = good + (bad - good) / 2;
        if fits(middle * step) { good = middle } else { bad = middle }
    }
    (good > 0).then_some(good * step)
}
