//! Shapes by name: those of the scene's own table `shapes`, and the models that the program carries.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::scene::finding::Finding;
use crate::scene::geometry::mesh::{MeshFolder, Surfaces};

use crate::scene::geometry::distance;
use crate::scene::{Boundary, Scene, Shape, shape, vector};
use crate::spelling::did_you_mean;

/// Shapes in each other at most.
pub(crate) const DEEPEST: u32 = 64;

/// Names that a message lists at most.
const MOST_NAMES: usize = 40;

/// A shape by its name, turned, scaled and moved, in this order.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Named {
    /// An entry of the scene's `shapes`, or a model that the program carries.
    pub name: String,
    /// Ratio of lengths.
    #[serde(default = "one")]
    pub scale: f64,
    /// Axis that it is turned about.
    #[serde(default = "shape::along_z", with = "vector::Point")]
    pub axis: [f64; 3],
    /// Angle, by the right-hand rule `[degrees]`.
    #[serde(default)]
    pub degrees: f64,
    /// Where its origin comes to lie `[m]`.
    #[serde(default, with = "vector::Point")]
    pub offset: [f64; 3],
    /// The shape, once the scene that names it has been read; nothing before.
    #[serde(skip)]
    shape: OnceLock<Counted>,
}

/// A shape with its counts, which would otherwise be taken again for every use.
#[derive(Clone, Debug)]
struct Counted {
    shape: Arc<Shape>,
    parts: u64,
    depth: u32,
}

pub(crate) fn one() -> f64 {
    1.0
}

impl PartialEq for Named {
    fn eq(&self, other: &Self) -> bool {
        let keys = |named: &Named| (named.name.clone(), named.scale, named.axis, named.degrees, named.offset);
        keys(self) == keys(other)
    }
}

impl Named {
    pub(crate) fn distance(&self, point: [f64; 3]) -> f64 {
        let Some(Counted { shape, .. }) = self.shape.get() else { return f64::INFINITY };
        let inner = unplaced(point, self.axis, self.degrees, self.offset);
        shape.distance(inner.map(|x| x / self.scale)) * self.scale
    }

    /// See [`Shape::parts_count`].
    pub(crate) fn parts_count(&self) -> u64 {
        self.shape.get().map_or(0, |counted| counted.parts)
    }

    /// See [`Shape::depth`].
    pub(crate) fn depth(&self) -> u32 {
        self.shape.get().map_or(0, |counted| counted.depth)
    }

    pub(crate) fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let Some(Counted { shape, .. }) = self.shape.get() else { return ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]) };
        placed_bounds(shape.bounds(), self.scale, self.axis, self.degrees, self.offset)
    }
}

/// A point as it was before a thing was turned and moved.
pub(crate) fn unplaced(point: [f64; 3], axis: [f64; 3], degrees: f64, offset: [f64; 3]) -> [f64; 3] {
    let arm = distance::minus(point, offset);
    if degrees == 0.0 { arm } else { distance::turn(arm, [0.0; 3], axis, -degrees) }
}

/// Bounds of a thing that has been scaled, turned and moved.
pub(crate) fn placed_bounds(
    (low, high): ([f64; 3], [f64; 3]),
    scale: f64,
    axis: [f64; 3],
    degrees: f64,
    offset: [f64; 3],
) -> ([f64; 3], [f64; 3]) {
    let scaled = (low.map(|x| x * scale), high.map(|x| x * scale));
    let (low, high) = distance::turned_bounds(scaled, [0.0; 3], axis, degrees);
    (distance::plus(low, offset), distance::plus(high, offset))
}

impl Scene {
    /// Every shape that the scene places, with its key.
    pub(crate) fn placed_shapes(&self) -> Vec<(String, &Shape)> {
        let mut found = Vec::new();
        let regions = self.gas.regions.iter().enumerate();
        found.extend(regions.map(|(i, region)| (format!("gas.regions[{i}].shape"), &region.shape)));
        let waves = self.gas.waves.iter().enumerate();
        found.extend(waves.filter_map(|(i, wave)| Some((format!("gas.waves[{i}].shape"), wave.shape.as_ref()?))));
        let bodies = self.bodies.iter().enumerate();
        found.extend(bodies.clone().map(|(i, body)| (format!("bodies[{i}].shape"), &body.shape)));
        found.extend(
            bodies.clone().filter_map(|(i, body)| Some((format!("bodies[{i}].clamped"), body.clamped.as_ref()?))),
        );
        let cracks = bodies.flat_map(|(i, body)| body.cracks.iter().enumerate().map(move |(k, crack)| (i, k, crack)));
        found.extend(cracks.map(|(i, k, crack)| (format!("bodies[{i}].cracks[{k}]"), crack)));
        let obstacles = self.obstacles.iter().enumerate();
        found.extend(obstacles.map(|(i, obstacle)| (format!("obstacles[{i}].shape"), &obstacle.shape)));
        found
    }

    /// The shapes of the openings in the sides, with their keys.
    pub(crate) fn patch_shapes(&self) -> Vec<(String, &Shape)> {
        let names = ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"];
        let sides = self.boundary.sides().into_iter().zip(names);
        let patches = sides.filter_map(|(side, name)| match side {
            Boundary::Patched(patched) => Some((name, patched)),
            _ => None,
        });
        let list = patches.flat_map(|(name, patched)| {
            let key = move |i: usize| format!("boundary.{name}.patched.patches[{i}].shape");
            patched.patches.iter().enumerate().map(move |(i, patch)| (key(i), &patch.shape))
        });
        list.collect()
    }

    /// Gives every `use` its shape and every `mesh` its surface.
    pub(crate) fn resolve_shapes(&self, meshes: MeshFolder<'_>) -> Vec<Finding> {
        let mut library = Library::new(&self.shapes, meshes);
        for name in self.shapes.keys() {
            library.shape(name, &format!("shapes.{name}"));
        }
        for (path, shape) in self.placed_shapes().into_iter().chain(self.patch_shapes()) {
            library.resolve(&path, shape);
        }
        library.findings.extend(self.render.font.as_ref().and_then(|font| font.resolve(meshes)));
        library.findings
    }
}

/// Names of the models that the program carries.
fn models() -> impl Iterator<Item = (&'static str, &'static str)> {
    crate::scene::MODELS.iter().map(|(path, text)| (path.trim_end_matches(".toml"), *text))
}

/// Shapes by name, as far as they are known.
struct Library<'s> {
    own: &'s BTreeMap<String, Shape>,
    meshes: MeshFolder<'s>,
    surfaces: Surfaces,
    ready: BTreeMap<String, Counted>,
    /// Names on the way from a shape to those it uses.
    open: Vec<String>,
    findings: Vec<Finding>,
}

impl<'s> Library<'s> {
    fn new(own: &'s BTreeMap<String, Shape>, meshes: MeshFolder<'s>) -> Self {
        Library {
            own,
            meshes,
            surfaces: Surfaces::default(),
            ready: BTreeMap::new(),
            open: Vec::new(),
            findings: Vec::new(),
        }
    }

    /// Gives the shapes below `shape` what they use.
    fn resolve(&mut self, path: &str, shape: &Shape) {
        if let Shape::Use(named) = shape {
            let path = format!("{path}.use.name");
            if let Some(found) = self.shape(&named.name, &path) {
                // a scene that is read again has it already
                let _ = named.shape.set(found);
            }
        }
        if let Shape::Mesh(mesh) = shape {
            self.findings.extend(mesh.resolve(path, self.meshes, &mut self.surfaces));
        }
        for (key, part) in shape.parts() {
            self.resolve(&format!("{path}.{key}"), part);
        }
    }

    /// The shape of a name, with everything in it resolved.
    fn shape(&mut self, name: &str, path: &str) -> Option<Counted> {
        if let Some(ready) = self.ready.get(name) {
            return Some(ready.clone());
        }
        if self.open.iter().any(|open| open == name) {
            let message = format!("`{name}` is made of itself: {} -> {name}", self.open.join(" -> "));
            self.findings.push(Finding::new(path, message, "remove one of these uses"));
            return None;
        }
        if self.open.len() >= DEEPEST as usize {
            let message = format!("more than {DEEPEST} shapes that use each other");
            self.findings.push(Finding::new(path, message, "use shapes that are made of fewer others"));
            return None;
        }
        let Some(shape) = self.own.get(name).cloned().or_else(|| model(name)) else {
            let own = self.own.keys().map(String::as_str);
            let known: Vec<&str> = own.chain(models().map(|(name, _)| name)).collect();
            let message = format!("no shape `{name}`{}", did_you_mean(name, known.iter().copied()));
            self.findings.push(Finding::new(path, message, format!("there are {}", some(&known))));
            return None;
        };
        self.open.push(name.to_owned());
        self.resolve(&format!("shapes.{name}"), &shape);
        self.open.pop();
        let (parts, depth) = (shape.parts_count(), shape.depth());
        if depth > DEEPEST {
            let message = format!("{depth} shapes in each other");
            self.findings.push(Finding::new(path, message, format!("at most {DEEPEST} are taken; use fewer")));
            return None;
        }
        let counted = Counted { shape: Arc::new(shape), parts, depth };
        self.ready.insert(name.to_owned(), counted.clone());
        Some(counted)
    }
}

/// The first names of a list.
fn some(names: &[&str]) -> String {
    let rest = names.len().saturating_sub(MOST_NAMES);
    let first = names[..names.len() - rest].join(", ");
    if rest == 0 { first } else { format!("{first} and {rest} more") }
}

/// A model that the program carries.
fn model(name: &str) -> Option<Shape> {
    let (_, text) = models().find(|(own, _)| *own == name)?;
    toml::from_str(text).ok()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::scene::check::shape as check_shape;

    #[test]
    fn every_model_is_a_shape_that_stands_on_the_ground() {
        assert!(models().count() >= 10);
        for (name, text) in models() {
            assert!(text.starts_with("# "), "{name} has no head");
            let shape: Shape = toml::from_str(text).unwrap_or_else(|error| panic!("{name}: {error}"));
            let own = BTreeMap::new();
            let nowhere = MeshFolder { folder: Path::new(""), outside: false, dimension: 3 };
            let mut library = Library::new(&own, nowhere);
            library.resolve(name, &shape);
            check_shape::sizes(name, &shape, &mut library.findings);
            assert_eq!(library.findings, [], "{name}");
            let (low, high) = shape.bounds();
            let size = (0..3).map(|d| high[d] - low[d]).fold(0.0, f64::max);
            assert!((0.05..=2.5).contains(&size), "{name}: {low:?} {high:?}");
        }
    }
}
