//! The names under which shaders know the state.

use super::{State, arrays};

impl State {
    /// A vector of the solve that another stage borrows, by the name of its binding there.
    ///
    /// # Panics
    /// If [`arrays::USES`] has no such name: a bug of the caller.
    pub(crate) fn lent(&self, name: &str) -> &wgpu::Buffer {
        let named = self.names();
        named.iter().find(|(known, _)| *known == name).expect("names of lent vectors are literals of this crate").1
    }

    /// The one list of names under which shaders know the state: arrays, and vectors that the solve lends.
    pub(super) fn names(&self) -> Vec<(&'static str, &wgpu::Buffer)> {
        let mut named = self.arrays();
        let own = |array: &str| named.iter().find(|(known, _)| *known == array).map(|(_, buffer)| *buffer);
        let lent = |used: &arrays::Use| match used.name {
            arrays::Name::Lent(name) => own(used.array).map(|buffer| (name, buffer)),
            _ => None,
        };
        let lent: Vec<_> = arrays::USES.iter().filter_map(lent).collect();
        named.extend(lent);
        named
    }

    fn arrays(&self) -> Vec<(&'static str, &wgpu::Buffer)> {
        vec![
            ("params", self.params_buffer.raw()),
            ("control", self.control.raw()),
            ("extents", self.extents.raw()),
            ("materials", self.materials.raw()),
            ("openings", self.openings.raw()),
            ("knots", self.knots.raw()),
            ("supports", self.supports.raw()),
            ("motions", self.motions.raw()),
            ("conserved", self.gas.conserved.raw()),
            ("energy", self.gas.energy.raw()),
            ("work", self.gas.work.raw()),
            ("owed_flow", self.gas.owed_flow.raw()),
            ("owed_energy", self.gas.owed_energy.raw()),
            ("cells", self.interface.cells.raw()),
            ("fill", self.interface.fill.raw()),
            ("ghost", self.interface.ghost.raw()),
            ("extra", self.interface.extra.raw()),
            ("position", self.particles.position.raw()),
            ("velocity", self.particles.velocity.raw()),
            ("affine", self.particles.affine.raw()),
            ("deformation", self.particles.deformation.raw()),
            ("stress", self.particles.stress.raw()),
            ("order", self.particles.order.raw()),
            ("cell_start", self.particles.cell_start.raw()),
            ("node", self.particles.node.raw()),
            ("inertia", self.particles.inertia.raw()),
            ("elastic", self.particles.elastic.raw()),
            ("pressure", self.pressure.raw()),
            ("stiffness", self.stiffness.raw()),
            ("solution", self.pcg.solution.raw()),
            ("residual", self.pcg.residual.raw()),
            ("direction", self.pcg.direction.raw()),
            ("product", self.pcg.product.raw()),
            ("inverse_diagonal", self.pcg.inverse_diagonal.raw()),
            ("partials", self.partials.raw()),
            ("history", self.history.raw()),
            ("probe_cells", self.probe_cells.raw()),
            ("probe_history", self.probe_history.raw()),
            ("maps", self.maps.raw()),
            ("dust", self.dust.raw()),
            ("gauge_particles", self.gauges.particles.raw()),
            ("gauge_history", self.gauges.history.raw()),
            ("loads", self.loads.raw()),
            ("load_history", self.load_history.raw()),
        ]
    }
}
