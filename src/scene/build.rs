//! Scenes made in code: what a file leaves out is left out here, and what a file may not say is refused here with the same words.

use std::path::Path;

use super::check;
use super::finding::{Finding, MOST_TOLD};
use super::geometry::mesh::MeshFolder;
use super::{
    Body, Boundaries, Boundary, Charge, Domain, Expect, Gas, GasState, Gauge, Material, Numerics, Obstacle, Output,
    Probe, Region, RenderSettings, Sampling, Scene, Shape, Time,
};
use crate::{Error, Result};

/// A scene in the making. [`SceneBuilder::build`] checks it.
#[derive(Clone, Debug)]
pub struct SceneBuilder {
    scene: Scene,
}

impl Scene {
    /// Starts a scene of a gas in a domain with walls; it ends at a time of 1 \[s\] unless [`SceneBuilder::until`] says otherwise.
    ///
    /// ```
    /// use brisance::{Domain, Gas, GasState, Scene, Shape};
    ///
    /// let gas = Gas::new(GasState::new(1.0, 1.0)).region(Shape::sphere([0.5, 0.5], 0.1), GasState::new(1.0, 10.0));
    /// let scene = Scene::builder("A blast in a box", Domain::new([64, 64], [1.0, 1.0]), gas).until(0.2).build()?;
    /// assert_eq!(scene.domain.cell_count(), 4096);
    /// # Ok::<(), brisance::Error>(())
    /// ```
    #[must_use]
    pub fn builder(title: impl Into<String>, domain: Domain, gas: Gas) -> SceneBuilder {
        SceneBuilder {
            scene: Scene {
                title: title.into(),
                description: String::new(),
                domain,
                gas,
                boundary: Boundaries::default(),
                materials: std::collections::BTreeMap::new(),
                shapes: std::collections::BTreeMap::new(),
                bodies: Vec::new(),
                obstacles: Vec::new(),
                charges: Vec::new(),
                gravity: [0.0; 3],
                time: Time::default(),
                numerics: Numerics::default(),
                probes: Vec::new(),
                gauges: Vec::new(),
                output: Output::default(),
                render: RenderSettings::default(),
                expect: Expect::default(),
                variants: std::collections::BTreeMap::new(),
            },
        }
    }

    /// The scene with the defaults that depend on other keys put in, after all that a file is checked for.
    ///
    /// # Errors
    /// [`Error::Scene`] with every mistake: key, what is wrong, what is allowed.
    pub fn checked(&self) -> Result<Scene> {
        let mut scene = self.clone();
        scene.resolve();
        match check::findings(&scene) {
            findings if findings.is_empty() => Ok(scene),
            findings => Err(refused(&scene.title, &findings)),
        }
    }
}

impl SceneBuilder {
    /// Adds a body.
    #[must_use]
    pub fn body(mut self, body: Body) -> Self {
        self.scene.bodies.push(body);
        self
    }

    /// Names a material for bodies. Presets such as `steel` need no entry.
    #[must_use]
    pub fn material(mut self, name: impl Into<String>, material: Material) -> Self {
        self.scene.materials.insert(name.into(), material);
        self
    }

    /// Adds a static obstacle.
    #[must_use]
    pub fn obstacle(mut self, name: impl Into<String>, shape: Shape) -> Self {
        self.scene.obstacles.push(Obstacle { name: name.into(), shape });
        self
    }

    /// The same rule at every side of the active axes.
    #[must_use]
    pub fn sides(self, rule: &Boundary) -> Self {
        let active = 2 * self.scene.domain.axes();
        let rule_of = |side: usize| if side < active { rule.clone() } else { Boundary::default() };
        let [x_min, x_max, y_min, y_max, z_min, z_max] = std::array::from_fn(rule_of);
        self.boundaries(Boundaries { x_min, x_max, y_min, y_max, z_min, z_max })
    }

    /// A rule for each side.
    #[must_use]
    pub fn boundaries(mut self, boundary: Boundaries) -> Self {
        self.scene.boundary = boundary;
        self
    }

    /// Acceleration of gravity \[m s^-2\].
    #[must_use]
    pub fn gravity<const N: usize>(mut self, gravity: [f64; N]) -> Self {
        self.scene.gravity = filled(gravity, 0.0);
        self
    }

    /// Adds a point \[m\] whose gas state is recorded every step.
    #[must_use]
    pub fn probe<const N: usize>(mut self, name: impl Into<String>, position: [f64; N]) -> Self {
        self.scene.probes.push(Probe { name: name.into(), position: filled(position, 0.0) });
        self
    }

    /// Adds a charge that goes off during the run.
    #[must_use]
    pub fn charge(mut self, charge: Charge) -> Self {
        self.scene.charges.push(charge);
        self
    }

    /// Adds a gauge on a wall, an obstacle, a body, or a point of a body.
    #[must_use]
    pub fn gauge(mut self, gauge: Gauge) -> Self {
        self.scene.gauges.push(gauge);
        self
    }

    /// End of the run \[s\].
    #[must_use]
    pub fn until(mut self, time: f64) -> Self {
        self.scene.time.until = time;
        self
    }

    /// All choices of time steps and frames.
    #[must_use]
    pub fn time(mut self, time: Time) -> Self {
        self.scene.time = time;
        self
    }

    /// Choices of the method.
    #[must_use]
    pub fn numerics(mut self, numerics: Numerics) -> Self {
        self.scene.numerics = numerics;
        self
    }

    /// How pictures look.
    #[must_use]
    pub fn look(mut self, render: RenderSettings) -> Self {
        self.scene.render = render;
        self
    }

    /// The finished scene. Mesh files are looked for from the current folder on.
    ///
    /// # Errors
    /// [`Error::Scene`] with every mistake: key, what is wrong, what is allowed.
    pub fn build(mut self) -> Result<Scene> {
        let dimension = self.scene.domain.dimension;
        let place = MeshFolder { folder: Path::new(""), outside: true, dimension };
        let mut shapes = self.scene.resolve_shapes(place);
        shapes.extend(self.scene.resolve_cameras(place));
        if !shapes.is_empty() {
            return Err(refused(&self.scene.title, &shapes));
        }
        self.scene.checked()
    }
}

impl Domain {
    /// So many cells and lengths \[m\] along each axis, from the origin on. As many axes are active as are given, 1 to 3.
    #[must_use]
    pub fn new<const N: usize>(cells: [u32; N], size: [f64; N]) -> Self {
        const { assert!(N >= 1 && N <= 3, "a domain has 1 to 3 axes") };
        let cells = std::array::from_fn(|axis| cells.get(axis).copied().unwrap_or(1));
        Domain { dimension: N as u32, cells, origin: [0.0; 3], size: filled(size, 1.0) }
    }
}

impl Gas {
    /// Gas with the ratio of specific heats of air, 1.4, in one state everywhere.
    #[must_use]
    pub fn new(ambient: GasState) -> Self {
        Gas {
            species: std::collections::BTreeMap::new(),
            gamma: super::default_gamma(),
            ambient,
            atmosphere: super::Atmosphere::default(),
            regions: Vec::new(),
            waves: Vec::new(),
            vortices: Vec::new(),
            radial_flows: Vec::new(),
            noise: 0.0,
            dust: None,
        }
    }

    /// Ratio of specific heats, above 1.
    #[must_use]
    pub fn gamma(mut self, gamma: f64) -> Self {
        self.gamma = gamma;
        self
    }

    /// Another state in a part of the domain; covers what was added before.
    #[must_use]
    pub fn region(mut self, shape: Shape, state: GasState) -> Self {
        self.regions.push(Region { shape, state });
        self
    }
}

impl GasState {
    /// Gas at rest of a density \[kg m^-3\] and pressure \[Pa\].
    #[must_use]
    pub fn new(density: f64, pressure: f64) -> Self {
        GasState { density, velocity: [0.0; 3], pressure, mass_fraction: 0.0 }
    }

    /// The same with a velocity \[m s^-1\].
    #[must_use]
    pub fn moving<const N: usize>(self, velocity: [f64; N]) -> Self {
        GasState { velocity: filled(velocity, 0.0), ..self }
    }
}

impl Body {
    /// A body at rest. `material` is a preset such as `steel`, or a name given to [`SceneBuilder::material`].
    #[must_use]
    pub fn new(name: impl Into<String>, shape: Shape, material: impl Into<String>) -> Self {
        Body {
            name: name.into(),
            shape,
            material: material.into(),
            density: None,
            velocity: [0.0; 3],
            spin: [0.0; 3],
            expansion: 0.0,
            particles_per_cell: None,
            color: None,
            sampling: Sampling::default(),
            friction: super::Friction::default(),
            clamped: None,
            cracks: Vec::new(),
            motion: None,
            joined: false,
        }
    }

    /// Density \[kg m^-3\]; presets of materials bring their own.
    #[must_use]
    pub fn density(mut self, density: f64) -> Self {
        self.density = Some(density);
        self
    }

    /// Velocity at the start \[m s^-1\].
    #[must_use]
    pub fn velocity<const N: usize>(mut self, velocity: [f64; N]) -> Self {
        self.velocity = filled(velocity, 0.0);
        self
    }

    /// Colour in pictures: red, green and blue of sRGB.
    #[must_use]
    pub fn color(mut self, color: [u8; 3]) -> Self {
        self.color = Some(super::Color(color));
        self
    }

    /// The part that is held where it is.
    #[must_use]
    pub fn clamped(mut self, shape: Shape) -> Self {
        self.clamped = Some(shape);
        self
    }
}

impl Shape {
    /// A ball around a point \[m\]; a disc in 2D, an interval in 1D.
    #[must_use]
    pub fn sphere<const N: usize>(center: [f64; N], radius: f64) -> Self {
        Shape::Sphere { center: filled(center, 0.0), radius }
    }

    /// A box around a point \[m\] with edges of these lengths \[m\]; endless along axes that are left out.
    #[must_use]
    pub fn cuboid<const N: usize>(center: [f64; N], size: [f64; N]) -> Self {
        Shape::Box { center: filled(center, 0.0), size: filled(size, f64::INFINITY), round: 0.0 }
    }
}

/// One to three numbers, and the rest.
fn filled<const N: usize>(given: [f64; N], rest: f64) -> [f64; 3] {
    std::array::from_fn(|axis| given.get(axis).copied().unwrap_or(rest))
}

/// All mistakes of a scene that no file holds.
fn refused(title: &str, findings: &[Finding]) -> Error {
    let count = findings.len();
    let mut text =
        format!("scene \"{title}\", made in code: {count} {}", if count == 1 { "mistake" } else { "mistakes" });
    for Finding { path, message, help, .. } in findings.iter().take(MOST_TOLD) {
        let key = if path.is_empty() { "scene" } else { path };
        text.push_str(&format!("\n  {key}: {message}; {help}"));
    }
    if count > MOST_TOLD {
        text.push_str(&format!("\n  and {} more", count - MOST_TOLD));
    }
    Error::Scene(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn calm() -> Gas {
        Gas::new(GasState::new(1.0, 1.0))
    }

    fn plate() -> Body {
        Body::new("plate", Shape::cuboid([0.5, 0.5], [0.2, 0.2]), "steel")
    }

    #[test]
    fn what_code_leaves_out_is_what_a_file_leaves_out() {
        let text = "title = \"plate\"\ndomain = { dimension = 2, cells = [16, 16], size = [1, 1] }\n\
                    gas.ambient = { density = 1, pressure = 1 }\ntime.until = 0.5\n\
                    [[bodies]]\nname = \"plate\"\nmaterial = \"steel\"\nshape.box = { center = [0.5, 0.5], size = [0.2, 0.2] }\n";
        let file = Scene::parse(text, "plate.toml", &[]).unwrap();
        let code = Scene::builder("plate", Domain::new([16, 16], [1.0, 1.0]), calm()).body(plate()).until(0.5);
        assert_eq!(code.build().unwrap(), file);
        assert!(file.particle_count() > 0);
    }

    #[test]
    fn a_body_at_its_default_count_does_not_vanish() {
        let mut scene = Scene::builder("plate", Domain::new([16, 16], [1.0, 1.0]), calm()).build().unwrap();
        scene.bodies.push(plate().density(2.0));
        let own = scene.particle_count();
        assert!(own > 0);
        let checked = scene.checked().unwrap();
        assert_eq!((checked.particle_count(), checked.bodies[0].particles_per_cell), (own, Some(2)));
    }

    #[test]
    fn mistakes_in_code_are_told_as_those_of_a_file() {
        let told = |builder: SceneBuilder| builder.build().unwrap_err().to_string();
        let oblong = told(Scene::builder("oblong", Domain::new([64, 32], [1.0, 1.0]), calm()));
        assert!(oblong.contains("domain.cells") && oblong.contains("cells must be cubes"), "{oblong}");
        let square = || Domain::new([32, 32], [1.0, 1.0]);
        let both = told(Scene::builder("cold", square(), Gas::new(GasState::new(-1.0, -4.0))).until(-1.0));
        for part in ["3 mistakes", "gas.ambient.density: -1", "gas.ambient.pressure: -4", "time.until"] {
            assert!(both.contains(part), "{both}");
        }
        let jelly = Body::new("b", Shape::sphere([0.5, 0.5], 0.2), "jelly").density(1.0);
        let unknown = told(Scene::builder("jelly", square(), calm()).body(jelly));
        assert!(unknown.contains("unknown material `jelly`"), "{unknown}");
        let weightless = Body::new("b", Shape::sphere([0.5, 0.5], 0.2), "soft");
        let soft =
            Material::new("neo_hookean", &[("young_modulus".to_owned(), 9.0), ("poisson_ratio".to_owned(), 0.3)]);
        let without = told(Scene::builder("soft", square(), calm()).material("soft", soft.unwrap()).body(weightless));
        assert!(without.contains("bodies[0].density: no density"), "{without}");
    }
}
