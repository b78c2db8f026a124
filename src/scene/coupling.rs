//! How gas and solid are coupled: the method's own rules, and the paper's other ways to compare them with.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finding::Finding;
use super::{Boundary, Scene};
use crate::material::VolumeShare;

/// Pressure unknowns where gas and solid meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum InterfacePressure {
    /// One pressure where the solid is resolved, three (gas, solid, interface) at fragments.
    Resolved,
    /// Gas, solid and interface pressure at every touched vertex: the paper's form.
    H,
    /// One pressure everywhere.
    Single,
    /// `h` with `ghost = "shared_volume"`, else `resolved`.
    // The stress of the solid bears a part of the gas pressure there, and so the ghost pressure differs from it.
    #[default]
    Auto,
}

/// What the solved pressure does to the nodes of bodies. [Cao et al. 2022, eq. 36 and fig. 13]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SolidUpdate {
    /// The forces of the solve, (G Q + H h) / M: momentum is conserved.
    #[default]
    Forces,
    /// The pressure gradient in the node's own cell over the density of the solid there: an ablation.
    Gradients,
}

/// Order of the pressure solve and of the elastic step. [Cao et al. 2022, section 2.8 and fig. 14]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Coupling {
    /// The solve first, from a velocity with the elastic reaction in it, then elastic sub-steps.
    #[default]
    First,
    /// One explicit elastic step, then the solve, whose velocities move the particles: an ablation with the steps of elastic waves.
    Last,
}

/// How the ghost pressure and the elastic law of a body share its volume.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Ghost {
    /// The ghost pressure bears a small part of the law's volumetric stiffness, and the law the rest.
    #[default]
    Absorbs,
    /// The law bears shear alone: for scenes whose static load must strain a body. Of first order in the time step.
    SharedVolume,
}

/// How the elastic part of a step is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Elasticity {
    /// Sub-steps as short as elastic waves demand, without loss.
    #[default]
    Explicit,
    /// One step by backward Euler, whatever the stiffness; it damps waves shorter than the step. For bodies that would need many hundreds of
    /// sub-steps.
    Implicit,
}

impl Scene {
    /// The pressure unknowns of this scene, never [`InterfacePressure::Auto`].
    #[must_use]
    pub fn interface_pressure(&self) -> InterfacePressure {
        match (self.numerics.paper.interface, self.numerics.paper.ghost) {
            (InterfacePressure::Auto, Ghost::SharedVolume) => InterfacePressure::H,
            (InterfacePressure::Auto, Ghost::Absorbs) => InterfacePressure::Resolved,
            (chosen, _) => chosen,
        }
    }

    /// Whether half of what the solve adds to the velocity of a body carries gas: the advection has carried it with the velocity of before
    /// the solve. The paper's other forms go without.
    #[must_use]
    pub fn late_flux(&self) -> bool {
        self.numerics.paper.ghost == Ghost::Absorbs && self.numerics.paper.coupling == Coupling::First
    }

    /// How the laws of this scene and the ghost pressure share the volume of bodies.
    #[must_use]
    pub fn volume_share(&self) -> VolumeShare {
        match self.numerics.paper.ghost {
            Ghost::Absorbs => VolumeShare::Split(self.largest_gas_pressure()),
            Ghost::SharedVolume => VolumeShare::Ghost,
        }
    }

    /// Largest pressure of the gas at the start and at the sides \[Pa\].
    fn largest_gas_pressure(&self) -> f64 {
        let regions = self.gas.regions.iter().map(|region| region.state.pressure);
        let sides = self.boundary.sides().into_iter().flat_map(Boundary::rules).flat_map(Boundary::pressures);
        regions.chain(sides).fold(self.gas.ambient.pressure, f64::max)
    }

    /// Vectors per slot that the order of the elastic step has to keep.
    #[must_use]
    pub fn elastic_vectors(&self) -> usize {
        if self.numerics.paper.coupling == Coupling::Last { 1 } else { 2 }
    }

    /// Elastic sub-steps per step at most.
    #[must_use]
    pub fn max_substeps(&self) -> u32 {
        if self.numerics.paper.coupling == Coupling::Last { 1 } else { self.numerics.max_substeps }
    }
}

/// Choices that do not go together.
pub(super) fn findings(scene: &Scene) -> Vec<Finding> {
    let (paper, elasticity) = (&scene.numerics.paper, scene.numerics.elasticity);
    let mut findings = Vec::new();
    if paper.ghost == Ghost::SharedVolume && paper.coupling == Coupling::Last {
        let message = "\"last\" with numerics.paper.ghost = \"shared_volume\", which has an order of its own";
        let help = "give \"first\", or numerics.paper.ghost = \"absorbs\"";
        findings.push(Finding::new("numerics.paper.coupling", message, help));
    }
    if scene.breaks() && elasticity == Elasticity::Implicit {
        let message =
            "materials with `fracture` and an implicit elastic step, whose one strain per step no crack could follow";
        findings.push(Finding::new("numerics.elasticity", message, "give \"explicit\", or leave `fracture` out"));
    }
    if scene.flows() && elasticity == Elasticity::Implicit {
        let message = "materials with `flow` and an implicit elastic step, which knows linear hardening alone";
        findings.push(Finding::new("numerics.elasticity", message, "give \"explicit\", or leave `flow` out"));
    }
    if scene.breaks() && paper.coupling == Coupling::Last {
        let message = "materials with `fracture` and \"last\", which has no elastic sub-steps";
        findings.push(Finding::new("numerics.paper.coupling", message, "give \"first\", or leave `fracture` out"));
    }
    let plain = paper.ghost == Ghost::Absorbs && paper.coupling == Coupling::First;
    if elasticity == Elasticity::Implicit && !plain {
        let message = "\"implicit\" with numerics.paper.ghost = \"shared_volume\" or numerics.paper.coupling = \"last\", which have \
                       elastic steps of their own";
        findings.push(Finding::new("numerics.elasticity", message, "give \"explicit\", or leave out the other key"));
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::{Ghost, InterfacePressure};
    use crate::scene::Scene;

    fn slab(keys: &[&str]) -> crate::Result<Scene> {
        let overrides: Vec<String> = keys.iter().map(|key| format!("numerics.paper.{key}")).collect();
        Scene::shipped("coupled/slab_at_rest.toml", &overrides)
    }

    #[test]
    fn choices_that_do_not_go_together_are_refused() {
        let message = slab(&["ghost=shared_volume", "coupling=last"]).unwrap_err().to_string();
        assert!(message.contains("numerics.paper.coupling"), "{message}");
    }

    #[test]
    fn what_is_left_open_follows_from_the_rest() {
        let plain = slab(&[]).unwrap();
        assert_eq!((plain.numerics.paper.ghost, plain.max_substeps()), (Ghost::Absorbs, 10_000));
        assert_eq!(plain.interface_pressure(), InterfacePressure::Resolved);
        assert_eq!(slab(&["ghost=shared_volume"]).unwrap().interface_pressure(), InterfacePressure::H);
        assert_eq!(slab(&["interface=single"]).unwrap().interface_pressure(), InterfacePressure::Single);
        assert_eq!(slab(&["coupling=last"]).unwrap().max_substeps(), 1);
    }
}
