//! stage.usda: a run as a USD stage with camera, volumes by reference to their vdb files, and bodies as points that move.
//!
//! Points lie in a binary file a frame, usd/NNNN.usdc, which the stage takes as value clips [USD: Sequencable, Re-timeable Animated
//! "Value Clips"]. Lengths are metres, z is up, a frame of the run is a time code.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::usdc::{Array, Layer};
use super::vdb::{VdbExporter, names, volumes};
use crate::Result;
use crate::export::{Exporter, Moment, Needs, atomic};
use crate::quantity::{self, Place, Values};
use crate::scene::{Camera, CameraKey};
use crate::snapshot::Snapshot;
use crate::state::Grid;

/// Frames a second of the stage.
const RATE: u32 = 25;
/// Height of a pinhole's film \[tenths of a unit\]; only its ratio to the focal length counts. Parallel rays fill the film.
const APERTURE: f64 = 24.0;
/// Quantities of the points beside velocity, and their types.
const PRIMVARS: [(&str, &str); 6] = [
    ("plastic_strain", "float[]"),
    ("damage", "float[]"),
    ("deviatoric_stress", "float[]"),
    ("body", "int[]"),
    ("material", "int[]"),
    ("piece", "int[]"),
];

/// What the temperature is where the scene says what its ambient gas has.
const KELVIN: &str = "temperature [K], symbol T, unit K";

/// Writes `stage.usda`, `usd/NNNN.usdc` and `vdb/NNNN.vdb`.
#[derive(Debug)]
pub struct UsdExporter {
    folder: PathBuf,
    volumes: VdbExporter,
    /// Frames with their times \[s\].
    frames: Vec<(u32, f64)>,
    /// Whether there are bodies.
    points: bool,
}

impl UsdExporter {
    /// For one output folder.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), volumes: VdbExporter::new(folder), frames: Vec::new(), points: false }
    }
}

impl Exporter for UsdExporter {
    fn write(&mut self, moment: &Moment) -> Result<()> {
        let snapshot = moment.snapshot.expect("a run reads the snapshot when an exporter needs it");
        self.points |= !moment.origin.source.bodies.is_empty();
        let bodies = self.points.then_some(snapshot);
        let layer = || bodies.map(|snapshot| points(snapshot, moment.index));
        let (volumes, layer) = rayon::join(|| volumes(snapshot, moment), layer);
        self.volumes.put(moment.index, &volumes)?;
        if let Some(layer) = layer {
            let path = self.folder.join(format!("usd/{:04}.usdc", moment.index));
            atomic::write(&path, |out| out.write_all(&layer))?;
            let manifest = manifest();
            atomic::write(&self.folder.join("usd/manifest.usda"), |out| out.write_all(manifest.as_bytes()))?;
        }
        self.frames.push((moment.index, moment.time));
        let text = self.stage(moment, snapshot);
        atomic::write(&self.folder.join("stage.usda"), |out| out.write_all(text.as_bytes()))
    }

    fn go_on(&mut self, frames: u32, time: &dyn Fn(u32) -> f64) -> Result<()> {
        self.frames = (0..frames).map(|index| (index, time(index))).collect();
        Ok(())
    }

    fn needs(&self) -> Needs {
        Needs { snapshot: true, cells: true, ..Needs::default() }
    }
}

impl UsdExporter {
    fn stage(&self, moment: &Moment, snapshot: &Snapshot) -> String {
        let (first, last) = (self.frames.first().map_or(0, |f| f.0), self.frames.last().map_or(0, |f| f.0));
        let grid = &snapshot.grid;
        let low = grid.in_scene(grid.origin).map(|x| x as f32);
        let high: [f32; 3] = std::array::from_fn(|axis| low[axis] + grid.extent()[axis]);
        let extent = format!("[{}, {}]", vector(low), vector(high));
        let mut text = format!(
            "#usda 1.0\n(\n    defaultPrim = \"run\"\n    doc = \"{}\"\n    metersPerUnit = 1\n    upAxis = \"Z\"\n    startTimeCode = {first}\n    \
             endTimeCode = {last}\n    timeCodesPerSecond = {RATE}\n    framesPerSecond = {RATE}\n)\n\ndef Xform \"run\"\n{{\n",
            quoted(&format!(
                "{}, scene {}, brisance {}",
                moment.origin.title,
                moment.origin.hash,
                env!("CARGO_PKG_VERSION")
            ))
        );
        self.volume(&mut text, &extent, &names(snapshot), moment.origin.kelvin.is_some());
        if self.points {
            self.clips(&mut text, grid, (first, last), moment);
        }
        self.camera(&mut text, moment);
        text.push_str("}\n");
        text
    }

    fn volume(&self, text: &mut String, extent: &str, names: &[&str], kelvin: bool) {
        let _ = writeln!(text, "    def Volume \"gas\"\n    {{\n        float3[] extent = {extent}");
        for name in names {
            let _ = writeln!(text, "        rel field:{name} = </run/gas/{name}>");
        }
        for name in names {
            let _ = writeln!(
                text,
                "        def OpenVDBAsset \"{name}\" (\n            doc = \"{}\"\n        )\n        {{\n            \
                 token fieldName = \"{name}\"",
                if kelvin && *name == "temperature" { KELVIN.to_owned() } else { about(Place::Cell, name) }
            );
            text.push_str("            asset filePath.timeSamples = {\n");
            for (index, _) in &self.frames {
                let _ = writeln!(text, "                {index}: @./vdb/{index:04}.vdb@,");
            }
            text.push_str("            }\n        }\n");
        }
        text.push_str("    }\n");
    }

    /// The points of bodies, in the device's coordinates and moved as a whole to those of the scene.
    fn clips(&self, text: &mut String, grid: &Grid, (first, last): (u32, u32), moment: &Moment) {
        let source = &moment.origin.source;
        let high: [f32; 3] = std::array::from_fn(|axis| grid.origin[axis] + grid.extent()[axis]);
        let extent = format!("[{}, {}]", vector(grid.origin), vector(high));
        let list =
            |names: &[String]| names.iter().map(|name| format!("\"{}\"", quoted(name))).collect::<Vec<_>>().join(", ");
        let _ = writeln!(
            text,
            "    def Points \"bodies\" (\n        clips = {{\n            dictionary default = {{\n                \
             asset manifestAssetPath = @./usd/manifest.usda@\n                string primPath = \"/bodies\"\n                \
             string templateAssetPath = \"./usd/####.usdc\"\n                double templateStartTime = {first}\n                \
             double templateEndTime = {last}\n                double templateStride = 1\n            }}\n        }}\n    )\n    {{\n        \
             float3[] extent = {extent}\n        string[] userProperties:bodies = [{}]\n        \
             string[] userProperties:materials = [{}]",
            list(&source.bodies),
            list(&source.materials)
        );
        if grid.is_far() {
            let [x, y, z] = grid.frame;
            let _ = writeln!(
                text,
                "        double3 xformOp:translate = ({x:?}, {y:?}, {z:?})\n        uniform token[] xformOpOrder = [\"xformOp:translate\"]"
            );
        }
        // what no schema declares, clips alone do not bring into being
        for (name, kind) in PRIMVARS {
            let _ = writeln!(
                text,
                "        {kind} primvars:{name} (\n            interpolation = \"vertex\"\n            doc = \"{}\"\n        )",
                about(Place::Particle, name)
            );
        }
        text.push_str("    }\n");
    }

    /// The camera of `[render]` and its path, where the scene has one.
    fn camera(&self, text: &mut String, moment: &Moment) {
        let look = &moment.origin.source.render;
        let first = || look.path.as_ref()?.keys.first().map(CameraKey::camera);
        let Some(base) = look.camera.or_else(first) else { return };
        let aspect = f64::from(look.size[0]) / f64::from(look.size[1].max(1));
        let at = |time: f64| look.path.as_ref().map_or(base, |path| path.at(time, &base));
        let lens = |camera: &Camera| match camera.height {
            Some(height) => (10.0 * height, APERTURE),
            None => (APERTURE, 0.5 * APERTURE / (0.5 * camera.fov_degrees.to_radians()).tan()),
        };
        let projection = if base.height.is_some() { "orthographic" } else { "perspective" };
        let _ = writeln!(
            text,
            "    def Camera \"camera\"\n    {{\n        token projection = \"{projection}\"\n        float2 clippingRange = (0.01, 1000000)"
        );
        let mut samples = |name: &str, value: &dyn Fn(&Camera) -> String| {
            let _ = writeln!(text, "        {name}.timeSamples = {{");
            for (index, time) in &self.frames {
                let _ = writeln!(text, "            {index}: {},", value(&at(*time)));
            }
            text.push_str("        }\n");
        };
        samples("float horizontalAperture", &|camera| format!("{:?}", aspect * lens(camera).0));
        samples("float verticalAperture", &|camera| format!("{:?}", lens(camera).0));
        samples("float focalLength", &|camera| format!("{:?}", lens(camera).1));
        samples("matrix4d xformOp:transform", &|camera| looking(camera.eye, camera.target, camera.up));
        text.push_str("        uniform token[] xformOpOrder = [\"xformOp:transform\"]\n    }\n");
    }
}

/// The matrix of a camera, which looks along its -z, with its y up; vectors are rows.
fn looking(eye: [f64; 3], target: [f64; 3], up: [f64; 3]) -> String {
    let (eye, target, up) = (glam::DVec3::from(eye), glam::DVec3::from(target), glam::DVec3::from(up));
    let back = (eye - target).normalize_or(glam::DVec3::Z);
    let right = up.cross(back).normalize_or(glam::DVec3::X);
    let rows = [(right, 0), (back.cross(right), 0), (back, 0), (eye, 1)];
    let rows: Vec<String> =
        rows.iter().map(|(row, w)| format!("({:?}, {:?}, {:?}, {w})", row.x, row.y, row.z)).collect();
    format!("( {} )", rows.join(", "))
}

/// What the clips hold.
fn manifest() -> String {
    let mut text = "#usda 1.0\n(\n    defaultPrim = \"bodies\"\n)\n\ndef Points \"bodies\"\n{\n    point3f[] points\n    vector3f[] velocities\n    \
                    float[] widths\n    int64[] ids\n"
        .to_owned();
    for (name, kind) in PRIMVARS {
        let _ = writeln!(text, "    {kind} primvars:{name} ( interpolation = \"vertex\" )");
    }
    text + "}\n"
}

/// The points of a frame.
fn points(snapshot: &Snapshot, frame: u32) -> Vec<u8> {
    let particles = &snapshot.particles;
    let axes = snapshot.grid.dimension as f32;
    let mut layer = Layer::new(f64::from(frame));
    let positions: Vec<_> = particles.iter().map(|p| p.position).collect();
    layer.attribute("points", "point3f[]", false, Array::Vectors(&positions));
    let velocities: Vec<_> = particles.iter().map(|p| p.velocity).collect();
    layer.attribute("velocities", "vector3f[]", false, Array::Vectors(&velocities));
    let widths: Vec<_> = particles.iter().map(|p| (p.volume0 * p.volume_ratio()).abs().powf(1.0 / axes)).collect();
    layer.attribute("widths", "float[]", false, Array::Reals(&widths));
    let ids: Vec<_> = particles.iter().map(|p| i64::from(p.index)).collect();
    layer.attribute("ids", "int64[]", false, Array::Long(&ids));
    for (name, kind) in PRIMVARS {
        let values = quantity::find(Place::Particle, name).map(|quantity| quantity.of(snapshot));
        let name = format!("primvars:{name}");
        match &values {
            Some(Values::Real(values)) => layer.attribute(&name, kind, true, Array::Reals(values)),
            Some(Values::Whole(values)) => layer.attribute(&name, kind, true, Array::Whole(values)),
            None => {}
        }
    }
    layer.finish("bodies", "Points")
}

fn vector([x, y, z]: [f32; 3]) -> String {
    format!("({x:?}, {y:?}, {z:?})")
}

/// What a quantity is.
fn about(place: Place, name: &str) -> String {
    quantity::find(place, name).map_or_else(String::new, |quantity| quoted(&quantity.about()))
}

/// A text between quotes, on one line.
fn quoted(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"").replace(['\n', '\r'], " ")
}
