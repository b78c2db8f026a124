//! Checks that types cannot express: limits, references, geometry. Every finding names key, value, limit and remedy.

pub(crate) mod blast_estimate;
pub(crate) mod body;
pub(crate) mod boundary;
pub(crate) mod budget;
pub(crate) mod charge;
pub(crate) mod disk;
mod dust;
pub(crate) mod estimate;
pub(crate) mod gauge;
pub(crate) mod limits;
pub(crate) mod range;
pub(crate) mod render;
pub(crate) mod shape;
mod species;

use std::fmt::Display;

use crate::scene::finding::Finding;
use crate::scene::{Integrator, MAX_BODIES, Obstacles, Preconditioner, Scene};

/// Cells per active axis at least: the advection stencil needs this many.
const FEWEST_CELLS: u32 = 3;
/// Cells and their ring at most: positions are 32-bit integers on the device.
const MOST_SLOTS: u64 = i32::MAX as u64;
/// Edges of a cell may differ by this much, relative: what decimal numbers in a file lose.
const CUBE_TOLERANCE: f64 = 1e-6;
/// What `obstacles = "cut"` is for.
const CUT_CELLS_NEED: &str = "\"cut\" needs the pair b1b0; with bodies also the default coupling, ghost and solid_update, \
    no dust and no explosive that burns on the grid";

/// Everything that is wrong with a scene.
pub(crate) fn findings(scene: &Scene) -> Vec<Finding> {
    let mut check = Check { scene, sound_domain: false, findings: Vec::new() };
    check.domain();
    check.sound_domain = check.findings.is_empty() && (1..=3).contains(&scene.domain.dimension);
    check.findings.extend(limits::findings(scene));
    check.gas();
    check.boundary();
    check.bodies();
    if scene.bodies.len() > MAX_BODIES {
        // what looks at pairs of bodies would not end
        return check.findings;
    }
    check.names();
    let before = check.findings.len();
    check.geometry();
    let sound_shapes = check.findings.len() == before;
    let too_large = budget::shapes(scene);
    if !too_large.is_empty() {
        // nothing may ask one of them for a distance
        check.findings.extend(too_large);
        return check.findings;
    }
    check.gauges();
    check.charges();
    check.numerics();
    check.render();
    check.expect();
    if check.sound_domain {
        check.ranges();
    }
    // what loops over cells comes last, and only where a count says that it ends
    if check.sound_domain && sound_shapes {
        let too_much = budget::findings(scene);
        if too_much.is_empty() {
            check.patches_cover();
            shape::places(scene, &mut check.findings);
            if check.findings.is_empty() {
                check.remembered();
                check.charge_places();
            }
        }
        check.findings.extend(too_much);
    } else if check.sound_domain {
        shape::strays(scene, &mut check.findings);
    }
    check.findings
}

/// The scene and what has been found so far.
pub(crate) struct Check<'s> {
    pub(crate) scene: &'s Scene,
    /// Whether cells may be counted.
    sound_domain: bool,
    pub(crate) findings: Vec<Finding>,
}

impl Check<'_> {
    pub(crate) fn add(&mut self, path: impl Into<String>, message: impl Into<String>, help: impl Into<String>) {
        self.findings.push(Finding::new(path, message, help));
    }

    /// The same of a value that is wrong whatever stands beside it.
    pub(crate) fn wrong_value(&mut self, path: impl Into<String>, message: impl Into<String>, help: impl Into<String>) {
        self.findings.push(Finding::of_value(path, message, help));
    }

    pub(crate) fn out_of_range(&mut self, path: impl Into<String>, value: impl Display, help: impl Into<String>) {
        self.findings.push(Finding::out_of_range(path, value, help));
    }

    pub(crate) fn positive(&mut self, path: impl Into<String>, value: f64, unit: &str) {
        if !(value > 0.0 && value.is_finite()) {
            self.wrong_value(path, format!("{value} is not positive"), format!("give a finite number above 0 {unit}"));
        }
    }

    fn domain(&mut self) {
        let domain = &self.scene.domain;
        if !(1..=3).contains(&domain.dimension) {
            return;
        }
        let axes = domain.axes();
        for d in 0..axes {
            if domain.cells[d] < FEWEST_CELLS {
                let message = format!("{:?}: too few cells along axis {}", &domain.cells[..axes], ["x", "y", "z"][d]);
                self.add(
                    "domain.cells",
                    message,
                    format!("give at least {FEWEST_CELLS} cells along every active axis"),
                );
            }
            if !(domain.size[d] > 0.0 && domain.size[d].is_finite()) {
                let message = format!("{:?}: no length along axis {}", &domain.size[..axes], ["x", "y", "z"][d]);
                self.add("domain.size", message, "give finite lengths above 0 [m]");
            }
        }
        if domain.cells[axes..].iter().any(|n| *n != 1) {
            let message = format!("{:?} in a scene of dimension {axes}", domain.cells);
            self.add("domain.cells", message, format!("give {axes} entries; inactive axes have one cell"));
        }
        let slots = (0..axes).map(|d| u64::from(domain.cells[d]) + 2).fold(1, u64::saturating_mul);
        if slots > MOST_SLOTS {
            let message = format!("{:?}: {slots} cells with their ring", &domain.cells[..axes]);
            self.add("domain.cells", message, format!("give at most {MOST_SLOTS} in all"));
        }
        self.cubes();
    }

    fn cubes(&mut self) {
        let domain = &self.scene.domain;
        let edges = (0..domain.axes()).map(|d| domain.size[d] / f64::from(domain.cells[d])).collect::<Vec<_>>();
        let even = edges.iter().all(|edge| (edge / edges[0] - 1.0).abs() <= CUBE_TOLERANCE);
        if self.findings.is_empty() && !even {
            let matching = domain.size.map(|size| (size / edges[0]).round().max(1.0) as u32);
            let help = format!(
                "cells must be cubes: size / cells must be equal along all axes, for example cells = {:?}",
                &matching[..domain.axes()]
            );
            self.add("domain.cells", format!("cells of edges {edges:?}"), help);
        }
    }

    fn gas(&mut self) {
        let gas = &self.scene.gas;
        self.species();
        self.dust();
        self.atmosphere();
        self.findings.extend(crate::scene::wave::finding(gas));
        self.findings.extend(crate::scene::vortex::findings(gas));
    }

    fn geometry(&mut self) {
        let scene = self.scene;
        let own = scene.shapes.iter().map(|(name, shape)| (format!("shapes.{name}"), shape));
        for (path, shape) in scene.placed_shapes().into_iter().chain(own) {
            shape::sizes(&path, shape, &mut self.findings);
        }
        for (index, probe) in scene.probes.iter().enumerate() {
            let path = format!("probes[{index}].position");
            let domain = &scene.domain;
            let within = |d: usize| (domain.origin[d]..=domain.origin[d] + domain.size[d]).contains(&probe.position[d]);
            if !(0..domain.axes()).all(within) {
                self.add(&path, format!("{:?} lies outside the domain", probe.position), shape::extent(domain));
            }
        }
    }

    fn numerics(&mut self) {
        let numerics = &self.scene.numerics;
        if self.scene.consistent() && !self.scene.bodies.is_empty() {
            let help = "give \"cell\", or \"auto\", which chooses for the scene";
            self.add(
                "numerics.paper.face_velocity",
                "\"consistent\" carries gas only, and this scene has bodies",
                help,
            );
        }
        if numerics.paper.obstacles == Obstacles::Cut && !self.scene.cut() {
            let help = "give \"cells\", or \"auto\", which chooses for the scene";
            self.add("numerics.paper.obstacles", CUT_CELLS_NEED, help);
        }
        if numerics.expert.preconditioner == Preconditioner::Multigrid && self.scene.domain.dimension == 1 {
            let help = "give \"jacobi\", or \"auto\", which chooses for the scene";
            self.add("numerics.expert.preconditioner", "\"multigrid\" is for two and three dimensions", help);
        }
        if self.scene.solves() == 2 {
            self.ars222();
        }
        self.findings.extend(crate::scene::coupling::findings(self.scene));
    }

    /// What two solves per step cannot do.
    fn ars222(&mut self) {
        let key = "numerics.integrator";
        if !self.scene.bodies.is_empty() {
            let help = "give \"predictor\", or \"auto\", which chooses for the scene";
            self.add(key, "\"ars222\" moves gas only, and this scene has bodies", help);
        }
        if self.scene.time.cfl > Integrator::ARS_CFL {
            let message = format!("\"ars222\" with time.cfl = {}", self.scene.time.cfl);
            self.add(key, message, format!("give a time.cfl of at most {}", Integrator::ARS_CFL));
        }
    }

    fn expect(&mut self) {
        let expect = &self.scene.expect;
        if expect.density_l1.is_some() && self.scene.riemann().is_none() {
            let help = "it needs a scene of dimension 1 whose start has two states: ambient and one region that reaches one end";
            self.add("expect.density_l1", "this scene has no exact solution", help);
        }
        let closed = self.scene.boundary.closed(self.scene.domain.dimension);
        let drifts = [
            ("gas_mass_drift", expect.gas_mass_drift.is_some()),
            ("energy_drift", expect.energy_drift.is_some()),
            ("energy_change", expect.energy_change.is_some()),
        ];
        if let Some((key, _)) = drifts.into_iter().find(|(_, given)| !closed && *given) {
            self.add(format!("expect.{key}"), "the domain is open", "remove the key, or make every side a \"wall\"");
        }
        self.expected_bodies();
    }

    fn expected_bodies(&mut self) {
        let scene = self.scene;
        let expect = &scene.expect;
        let known = |name: &String| scene.bodies.iter().any(|body| body.name == *name);
        let mut unknown = |path: String, kind: &str, name: &str| {
            let help = format!("name an entry of {}", if kind == "body" { "bodies" } else { "probes" });
            self.findings.push(Finding::of_value(path, format!("unknown {kind} `{name}`"), help));
        };
        for (index, order) in expect.order.iter().enumerate() {
            for name in order.bodies.iter().filter(|name| !known(name)) {
                unknown(format!("expect.order[{index}].bodies"), "body", name);
            }
        }
        for (index, expected) in expect.probes.iter().enumerate() {
            if scene.probes.iter().all(|probe| probe.name != expected.probe) {
                unknown(format!("expect.probes[{index}].probe"), "probe", &expected.probe);
            }
        }
        for (index, expected) in expect.bodies.iter().enumerate() {
            if !known(&expected.body) {
                unknown(format!("expect.bodies[{index}].body"), "body", &expected.body);
            }
        }
        for (index, expected) in expect.bodies.iter().enumerate().filter(|(_, expected)| expected.center.is_some()) {
            let tolerance = expected.tolerance.unwrap_or(0.0);
            self.positive(format!("expect.bodies[{index}].tolerance"), tolerance, "[m]");
        }
    }
}
