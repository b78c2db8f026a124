//! The kernels that write pixels, and everything that has the size of the picture. Large pictures are drawn in bands.

use glam::Vec4;

use super::bend::Bend;
use super::buffers::Sources;
use super::frame::{Depth, Drawn};
use super::gas::{Gas, RANGE_GROUPS};
use super::kernels::{BACKDROP_DAYLIGHT, SAMPLE_MARGIN, bind, bind_numbers, bind_with};
use super::layers::LayerKernel;
use super::light::{Distance, Light};
use super::particles::Particles;
use super::plane::Wanted;
use super::sheets::Sheets;
use super::view::View;
use crate::Result;
use crate::gpu::{Bound, Buffer, Extent, Gpu, Pass, readback};

/// Rays of a band at most: more need more memory and gain nothing.
const BAND_RAYS: u32 = 1 << 21;
/// The same where a processor plays the GPU: whoever wants to stop waits for a band.
const BAND_RAYS_SOFTWARE: u32 = 1 << 19;

/// Root mean squares of a line-of-sight picture that reach half way to black or white.
const OPTICS_CONTRAST: f64 = 1.5;

/// What all pictures of a scene share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shared<'a> {
    pub(super) gpu: &'a Gpu,
    pub(super) sources: &'a Sources,
    pub(super) gas: &'a Gas,
    pub(super) particles: Option<&'a Particles>,
    pub(super) light: &'a Light,
    pub(super) distance: &'a Distance,
    /// Bodies of the scene.
    pub(super) bodies: usize,
}

/// Everything bound for one size of picture.
#[derive(Debug)]
pub(super) struct Screen {
    /// What this is made for.
    key: Key,
    band_rows: u32,
    edges: Buffer<[Vec4; 2]>,
    surface: Buffer<[u32; 4]>,
    pixels: Buffer<u32>,
    skin: Option<Skin>,
    trace_solids: Option<Bound>,
    bend: Bend,
    optics: Option<Optics>,
    draw: Bound,
    finish: Bound,
    deep: Option<Deep>,
    layers: Option<LayerKernel>,
}

/// The kernel that writes more than 8 bits per channel.
#[derive(Debug)]
struct Deep {
    light: Buffer<[f32; 4]>,
    toned: Bound,
}

/// The kernels that draw particles, in order.
#[derive(Debug)]
struct Skin {
    count: u64,
    depth: Buffer<u32>,
    nearest: Buffer<u32>,
    /// The particles of a smooth surface.
    kept: Buffer<u32>,
    /// Number and list of the rays that meet particles.
    covered: Buffer<u32>,
    /// Workgroups for them.
    groups: Buffer<u32>,
    splat_depth: Bound,
    splat_nearest: Bound,
    sheets: Option<Sheets>,
    list_skin: Bound,
    shade_skin: Bound,
}

/// The kernels of line-of-sight pictures.
#[derive(Debug)]
struct Optics {
    ranges: Buffer<[f32; 2]>,
    integrate_lines: Bound,
    measure_lines: Bound,
    draw_lines: Bound,
}

/// What a screen depends on: rays across, samples and rays per pixel, and the switches of its kernels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Key {
    rays: [u32; 2],
    samples: [u32; 2],
    emission: bool,
    soot: bool,
    dust: bool,
    slices: bool,
    smooth: bool,
    refraction: bool,
    daylight: bool,
    walls: bool,
    depth: Depth,
}

impl Key {
    fn of(view: &View, depth: Depth) -> Self {
        Self {
            rays: view.size,
            samples: [view.samples, view.supersampling],
            emission: view.heat_opacity > 0.0,
            soot: view.soot > 0.0,
            dust: view.dust > 0.0,
            slices: view.slice_count > 0,
            smooth: view.smooth_skin == 1,
            refraction: view.refraction > 0.0,
            daylight: view.backdrop == BACKDROP_DAYLIGHT,
            walls: view.fineness > 0,
            depth,
        }
    }

    fn switches(&self) -> [(&'static str, bool); 7] {
        [
            ("EMISSION", self.emission),
            ("SOOT", self.soot),
            ("DUST", self.dust),
            ("SLICES", self.slices),
            ("REFRACTION", self.refraction),
            ("DAYLIGHT", self.daylight),
            ("WALLS", self.walls),
        ]
    }
}

impl Screen {
    pub(super) fn new(shared: &Shared, view: &View, depth: Depth) -> Result<Self> {
        let Shared { gpu, sources, gas, light, distance, .. } = *shared;
        let key = Key::of(view, depth);
        let [width, height] = view.size;
        let n = view.supersampling;
        let most = if gpu.is_software() { BAND_RAYS_SOFTWARE } else { BAND_RAYS };
        let band_rows = (most / width / n * n).clamp(n, height);
        let rays = width as usize * band_rows as usize;
        let edges: Buffer<[Vec4; 2]> = Buffer::uniform(gpu, "edges", 12)?;
        let volume = sources.grid.dimension == 3;
        let surface: Buffer<[u32; 4]> = Buffer::new(gpu, "surface", if volume { 2 * rays } else { rays })?;
        let gathered: Buffer<[f32; 4]> = Buffer::new(gpu, "light", rays)?;
        let pixels: Buffer<u32> = Buffer::new(gpu, "pixels", rays / (n * n) as usize)?;
        let of_view = ("view", gas.view.raw());
        let drawn = [of_view, ("surface", surface.raw()), ("light", gathered.raw())];
        let bend = Bend::new(shared, view)?;
        let of_bends = ("bends", bend.bends.raw());
        let tables = ("colors", gas.colors.raw());
        let draw = if volume {
            let field =
                [("corners", gas.corners.raw()), ("glow", gas.glow.raw()), ("bricks", gas.bricks.raw()), tables];
            let own = [("edges", edges.raw()), ("light_grid", light.grid.raw()), of_bends];
            bind_with(gpu, "picture/volume.wgsl", "draw_volume", &key.switches(), &[&drawn[..], &field, &own].concat())?
        } else {
            let own = [
                ("cells", &sources.cells),
                ("conserved", &sources.conserved),
                ("field", gas.field.raw()),
                ("distance", distance.nodes.raw()),
                tables,
            ];
            bind(gpu, "picture/slice.wgsl", "draw_slice", &[&drawn[..], &own].concat())?
        };
        let trace = || {
            let shade = light.of_surfaces();
            let own = [of_view, ("distance", distance.nodes.raw()), drawn[1], of_bends];
            bind_with(gpu, "picture/solids.wgsl", "trace_solids", &key.switches(), &[&shade[..], &own].concat())
        };
        let skin = shared.particles.map(|own| Skin::new(shared, own, (view, &key), band_rows, &surface)).transpose()?;
        let samples = skin.as_ref().map(|skin| [&skin.depth, if key.smooth { &skin.kept } else { &skin.nearest }]);
        let layered =
            || LayerKernel::new(shared, pixels.len(), [drawn[2], drawn[1], of_bends], &key.switches(), samples);
        let optics = || Optics::new(shared, width as usize * height as usize, &surface, &gathered);
        Ok(Self {
            key,
            band_rows,
            trace_solids: volume.then(trace).transpose()?,
            optics: (view.optics > 0).then(optics).transpose()?,
            draw,
            finish: bind(gpu, "picture/finish.wgsl", "finish", &[of_view, drawn[2], ("pixels", pixels.raw())])?,
            deep: depth.fine.then(|| Deep::new(gpu, &[of_view, drawn[2]], pixels.len())).transpose()?,
            layers: depth.layers.then(layered).transpose()?,
            skin,
            bend,
            edges,
            surface,
            pixels,
        })
    }

    /// Whether this screen can draw a view.
    pub(super) fn fits(&self, view: &View, depth: Depth) -> bool {
        self.key == Key::of(view, depth) && (view.optics == 0 || self.optics.is_some())
    }

    /// Draws what was prepared.
    pub(super) fn draw(&self, shared: &Shared, view: &mut View, wanted: Wanted) -> Result<Drawn> {
        let Shared { gpu, gas, .. } = *shared;
        self.edges.write(gpu, 0, &if wanted.edges { view.edges() } else { [View::NO_EDGE; 12] });
        if let Some(optics) = self.optics.as_ref().filter(|_| view.optics > 0) {
            view.gain = optics.measure(shared, view)?;
        }
        self.bend.follow(shared, view)?;
        let n = view.supersampling;
        let all = (view.size[0] / n * (view.size[1] / n)) as usize;
        let size = [0, 1].map(|axis| (view.size[axis] / n) as usize);
        let mut drawn = Drawn { size, ..Drawn::default() };
        for first_row in (0..view.size[1]).step_by(self.band_rows as usize) {
            wanted.go_on()?;
            view.first_row = first_row;
            view.rows = self.band_rows.min(view.size[1] - first_row);
            gas.view.write(gpu, 0, &[*view]);
            let mut pass = Pass::new(gpu, "picture");
            self.record_band(gpu, &mut pass, view);
            pass.submit()?;
            let count = view.size[0] / n * (view.rows / n);
            drawn.pixels.extend(readback::read_range(gpu, &self.pixels, 0, count as usize)?);
            if let Some(deep) = &self.deep {
                drawn.toned.extend(deep.read(gpu, count as usize)?);
            }
            if let Some(layers) = &self.layers {
                drawn.layers.reserve_exact(all - drawn.layers.len());
                layers.read(shared, count as usize, &mut drawn.layers)?;
            }
        }
        Ok(drawn)
    }

    fn record_band(&self, gpu: &Gpu, pass: &mut Pass, view: &View) {
        let rays = Extent::Threads(u64::from(view.size[0]) * u64::from(view.rows));
        pass.clear(&self.surface);
        if let Some(skin) = self.skin.as_ref().filter(|_| view.particles > 0) {
            skin.record(gpu, pass, view, &rays);
        }
        if let Some(trace_solids) = self.trace_solids.as_ref().filter(|_| view.fineness > 0 || view.ground != [0.0; 4])
        {
            pass.dispatch(trace_solids, &rays);
        }
        let optics = self.optics.as_ref().filter(|_| view.optics > 0);
        pass.dispatch(optics.map_or(&self.draw, |optics| &optics.draw_lines), &rays);
        pass.dispatch(&self.finish, &rays);
    }
}

impl Deep {
    fn new(gpu: &Gpu, shared: &[(&str, &wgpu::Buffer)], pixels: usize) -> Result<Self> {
        let light: Buffer<[f32; 4]> = Buffer::new(gpu, "deep pixels", pixels)?;
        let own = [shared, &[("deep", light.raw())]].concat();
        Ok(Self { toned: bind(gpu, "picture/finish.wgsl", "finish_deep", &own)?, light })
    }

    /// What the kernel makes of the band drawn last.
    fn read(&self, gpu: &Gpu, count: usize) -> Result<Vec<[f32; 4]>> {
        let mut pass = Pass::new(gpu, "deep pixels");
        pass.dispatch(&self.toned, &Extent::Threads(count as u64));
        pass.submit()?;
        readback::read_range(gpu, &self.light, 0, count)
    }
}

impl Skin {
    fn new(
        shared: &Shared,
        own: &Particles,
        (view, key): (&View, &Key),
        rows: u32,
        surface: &Buffer<[u32; 4]>,
    ) -> Result<Self> {
        let Shared { gpu, sources, gas, light, .. } = *shared;
        let flat = f64::from(u8::from(sources.grid.dimension < 3));
        let made_for = [("FLAT", flat), ("SHARED", if key.smooth { 2.0 } else { 1.0 })];
        let samples = (view.size[0] * view.samples) as usize * (rows * view.samples + 2 * SAMPLE_MARGIN) as usize;
        let depth: Buffer<u32> = Buffer::new(gpu, "sample depths", samples)?;
        let nearest: Buffer<u32> = Buffer::new(gpu, "sample particles", samples)?;
        let of_view = ("view", gas.view.raw());
        let kept: Buffer<u32> = Buffer::new(gpu, "kept particles", if key.smooth { samples } else { 1 })?;
        let of_nearest = ("nearest", nearest.raw());
        let of_shown = ("nearest", if key.smooth { kept.raw() } else { nearest.raw() });
        let balls = ("balls", own.balls.raw());
        let rays = view.size[0] as usize * rows as usize;
        let covered: Buffer<u32> = Buffer::new(gpu, "covered rays", 1 + rays)?;
        let groups: Buffer<u32> = Buffer::indirect(gpu, "skin groups", 3)?;
        let of_covered = ("covered", covered.raw());
        let of_splat = [of_view, balls, ("deformation", &own.deformation), ("depth_bits", depth.raw())];
        let splat = |entry: &str, own: &[(&str, &wgpu::Buffer)]| {
            bind_numbers(gpu, "picture/points.wgsl", entry, &made_for, &[&of_splat, own].concat())
        };
        let sheets = key.smooth.then(|| Sheets::new(shared, own, &depth, &kept)).transpose()?;
        let shade = light.of_surfaces();
        let result = [of_view, of_covered, ("depth_in", depth.raw()), ("surface", surface.raw())];
        let of_samples = sheets.as_ref().map_or([of_shown, balls], Sheets::of_light);
        let entry = if key.smooth { "shade_sheets" } else { "shade_skin" };
        let lit = [&shade[..], &result, &of_samples].concat();
        Ok(Self {
            count: own.count,
            splat_depth: splat("splat_depth", &[])?,
            splat_nearest: splat("splat_nearest", &[of_nearest])?,
            list_skin: bind(
                gpu,
                "picture/skin.wgsl",
                "list_skin",
                &[of_view, of_shown, of_covered, ("skin_groups", groups.raw())],
            )?,
            shade_skin: bind_with(gpu, "picture/skin.wgsl", entry, &key.switches(), &lit)?,
            sheets,
            depth,
            nearest,
            kept,
            covered,
            groups,
        })
    }

    fn record(&self, gpu: &Gpu, pass: &mut Pass, view: &View, rays: &Extent) {
        self.covered.write(gpu, 0, &[0]);
        self.groups.write(gpu, 0, &[0, 1, 1]);
        pass.clear(&self.depth);
        pass.clear(if self.sheets.is_some() { &self.kept } else { &self.nearest });
        pass.dispatch(&self.splat_depth, &Extent::Threads(self.count));
        if let Some(sheets) = &self.sheets {
            sheets.record(gpu, pass, view);
        } else {
            pass.dispatch(&self.splat_nearest, &Extent::Threads(self.count));
        }
        pass.dispatch(&self.list_skin, rays);
        pass.dispatch(&self.shade_skin, &Extent::Indirect(&self.groups, 0));
    }
}

impl Optics {
    fn new(shared: &Shared, rays: usize, surface: &Buffer<[u32; 4]>, light: &Buffer<[f32; 4]>) -> Result<Self> {
        let Shared { gpu, gas, .. } = *shared;
        let columns: Buffer<f32> = Buffer::new(gpu, "columns", rays)?;
        let ranges: Buffer<[f32; 2]> = Buffer::new(gpu, "column ranges", RANGE_GROUPS as usize)?;
        let both = [("view", gas.view.raw()), ("columns", columns.raw())];
        let bind = |entry: &str, own: &[(&str, &wgpu::Buffer)]| {
            bind(gpu, "picture/optics.wgsl", entry, &[&both[..], own].concat())
        };
        let drawn = [("surface", surface.raw()), ("light", light.raw())];
        Ok(Self {
            integrate_lines: bind("integrate_lines", &[("field", gas.field.raw())])?,
            measure_lines: bind("measure_lines", &[("ranges", ranges.raw())])?,
            draw_lines: bind("draw_lines", &drawn)?,
            ranges,
        })
    }

    /// Integrates along all lines of sight and finds the contrast of the picture.
    fn measure(&self, shared: &Shared, view: &View) -> Result<f32> {
        shared.gas.view.write(shared.gpu, 0, &[*view]);
        let mut pass = Pass::new(shared.gpu, "lines of sight");
        pass.dispatch(&self.integrate_lines, &Extent::Threads(u64::from(view.size[0]) * u64::from(view.size[1])));
        pass.dispatch(&self.measure_lines, &Extent::Groups([RANGE_GROUPS, 1, 1]));
        pass.submit()?;
        let sums = readback::read(shared.gpu, &self.ranges)?;
        let [squares, count] = sums.iter().fold([0.0; 2], |sum, own| [0, 1].map(|k| sum[k] + f64::from(own[k])));
        // Differences below rounding are no picture.
        let smallest = 1e-5 * f64::from(view.low.abs().max(f32::MIN_POSITIVE)) * f64::from(view.spacing);
        Ok((OPTICS_CONTRAST * (squares / f64::max(count, 1.0)).sqrt()).max(smallest) as f32)
    }
}
