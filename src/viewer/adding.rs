//! Bodies that are added in the window: what they are, and the scene with them.

pub(super) mod mesh;

use std::collections::BTreeMap;

use crate::material::{Material, PRESETS, Units};
use crate::scene::{Body, Scene, Seed, Shape};
use crate::{Error, Result};
pub use mesh::MeshFile;

/// Pressures of air \[Pa\] in scenes in kg, m and s.
pub(super) const AIR: std::ops::Range<f64> = 1e3..1e7;
/// First size over the shortest edge of the domain, and the least in cells.
const SIZE: f64 = 0.14;
const LEAST_CELLS: f64 = 3.0;

/// The form of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// A ball; a disc in 2D.
    #[default]
    Ball,
    /// A cube; a square in 2D.
    Box,
    /// What a mesh file encloses; in 2D what the plane through its middle cuts out of that.
    Mesh,
}

/// A body to add.
#[derive(Clone, Debug, PartialEq)]
pub struct Addition {
    /// Its form.
    pub form: Form,
    /// Diameter, edge, or largest extent of a mesh \[m\].
    pub size: f64,
    /// The mesh that was given last.
    pub mesh: Option<MeshFile>,
    /// Name of a material of the scene, or of a preset.
    pub material: String,
}

/// Bodies that a scene has beside those of its file, with materials that it has not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Added {
    /// The bodies.
    pub bodies: Vec<Body>,
    /// Materials of theirs.
    pub materials: BTreeMap<String, Material>,
}

impl Added {
    /// Those of a scene that is open, which was opened with these.
    #[must_use]
    pub fn of(&self, scene: &Scene) -> Self {
        let was = |body: &&Body| body.joined || self.bodies.iter().any(|own| own.name == body.name);
        let bodies: Vec<Body> =
            scene.bodies.iter().filter(was).map(|body| Body { joined: false, ..body.clone() }).collect();
        let needed = |name: &String| bodies.iter().any(|body| body.material == *name);
        let materials = scene.materials.iter().filter(|(name, _)| needed(name));
        Self { materials: materials.map(|(name, own)| (name.clone(), own.clone())).collect(), bodies }
    }

    /// A scene with them from its start.
    ///
    /// # Errors
    /// [`Error::Scene`] if it has no room for them.
    pub(super) fn to(&self, mut scene: Scene) -> Result<Scene> {
        if self.bodies.is_empty() {
            return Ok(scene);
        }
        for (name, material) in &self.materials {
            scene.materials.entry(name.clone()).or_insert_with(|| material.clone());
        }
        scene.bodies.extend(self.bodies.iter().cloned());
        scene.checked()
    }
}

impl Addition {
    /// One that suits a scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let domain = &scene.domain;
        let shortest = domain.size[..domain.axes()].iter().copied().fold(f64::INFINITY, f64::min);
        let size = (SIZE * shortest).max(LEAST_CELLS * domain.spacing());
        let first = scene.bodies.iter().find(|body| !body.is_driven()).map(|body| body.material.clone());
        let material = first.or_else(|| scene.materials.keys().next().cloned());
        let material = material.unwrap_or_else(|| PRESETS[0].name.to_owned());
        Self { form: Form::default(), size: two_digits(size), mesh: None, material }
    }

    /// Has the form of a mesh, at a size that suits a scene.
    pub(super) fn take(&mut self, mesh: MeshFile, scene: &Scene) {
        self.size = two_digits(mesh.size_in(&scene.domain));
        (self.form, self.mesh) = (Form::Mesh, Some(mesh));
    }

    /// Materials to choose from: those of the scene, then presets.
    #[must_use]
    pub fn materials(scene: &Scene) -> Vec<String> {
        let own = scene.materials.keys().cloned();
        let presets = PRESETS.iter().map(|preset| preset.name.to_owned());
        own.chain(presets.filter(|name| !scene.materials.contains_key(name))).collect()
    }

    /// Half of its largest extent \[m\].
    #[must_use]
    pub fn reach(&self) -> f64 {
        match (self.form, &self.mesh) {
            (Form::Mesh, Some(mesh)) => mesh.reach(self.size),
            (Form::Box, _) => 0.5 * self.size * 3.0_f64.sqrt(),
            _ => 0.5 * self.size,
        }
    }

    /// Its shape with the middle at a point \[m\], and the word that its name begins with.
    fn shape(&self, scene: &Scene, point: [f64; 3]) -> (Shape, &str) {
        let axes = scene.domain.axes();
        let edges = std::array::from_fn(|axis| if axis < axes { self.size } else { f64::INFINITY });
        match (self.form, &self.mesh) {
            (Form::Mesh, Some(mesh)) => (mesh.placed(point, self.size, axes), &mesh.name),
            (Form::Box, _) => (Shape::cuboid(point, edges), "box"),
            _ => (Shape::sphere(point, 0.5 * self.size), "ball"),
        }
    }

    /// A scene at work with it as the last body, at rest, its middle at a point \[m\].
    ///
    /// # Errors
    /// [`Error::Usage`] if the scene is not right with it.
    pub fn joined_to(&self, scene: &Scene, point: [f64; 3]) -> Result<Scene> {
        let wrong = |error: Error| {
            let text = error.to_string();
            Error::Usage(format!("the body is not added, and the scene goes on without it: {text}"))
        };
        self.with(scene, point).and_then(|scene| scene.checked()).map_err(wrong)
    }

    /// Its particles there.
    ///
    /// # Errors
    /// As [`Addition::joined_to`].
    pub fn seeds(&self, scene: &Scene, point: [f64; 3]) -> Result<Vec<Seed>> {
        let mut scene = self.with(scene, point)?;
        let body = scene.bodies.pop().into_iter();
        scene.bodies = body.map(|body| Body { density: body.density.or(Some(1.0)), ..body }).collect();
        Ok(scene.seed_particles())
    }

    fn with(&self, scene: &Scene, point: [f64; 3]) -> Result<Scene> {
        let mut scene = scene.clone();
        let (shape, word) = self.shape(&scene, point);
        let taken = |name: &String| scene.bodies.iter().any(|body| body.name == *name);
        let name = (1..).map(|number| format!("{word}_{number}")).find(|name| !taken(name)).unwrap_or_default();
        let mut body = Body::new(name, shape, &self.material);
        body.joined = true;
        let density = |same: bool| {
            let mut like = scene.bodies.iter().filter(|other| !same || other.material == body.material);
            like.find_map(|other| scene.density_of(other))
        };
        let preset = scene.materials.get(&self.material).is_none_or(|material| material.density().is_some());
        body.density = density(true).or_else(|| if preset { None } else { density(false) });
        if !scene.materials.contains_key(&self.material) {
            let units = if AIR.contains(&scene.gas.ambient.pressure) { Units::Si } else { Units::Scaled };
            let index = PRESETS.iter().position(|preset| preset.name == self.material);
            let index = index.ok_or_else(|| Error::Usage(format!("there is no material `{}`", self.material)))?;
            let material = Material::of_preset(index, units, &[]).map_err(Error::Usage)?;
            scene.materials.insert(self.material.clone(), material);
        }
        scene.bodies.push(body);
        Ok(scene)
    }
}

fn two_digits(size: f64) -> f64 {
    let digit = 10.0_f64.powf(size.log10().floor() - 1.0);
    (size / digit).round() * digit
}
