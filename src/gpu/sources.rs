//! The shaders inside the binary: one line per file of `shaders/`; the suite compares the list with the folder.

/// Pairs of name and text, embedded at compile time.
macro_rules! sources {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/", $name)))),*]
    };
}

/// All embedded shaders: path below `shaders/`, text.
#[rustfmt::skip]
pub const SOURCES: &[(&str, &str)] = sources![
    "diagnostics.wgsl",
    "field.wgsl",
    "fluid_floor.wgsl",
    "fluid_update.wgsl",
    "g2p.wgsl",
    "gas_advection.wgsl",
    "interface.wgsl",
    "interface_mark.wgsl",
    "intermediate_pressure.wgsl",
    "ledger.wgsl",
    "linear_algebra.wgsl",
    "materials/neo_hookean.wgsl",
    "materials/von_mises.wgsl",
    "mpm_grid_update.wgsl",
    "p2g.wgsl",
    "p2g_scatter.wgsl",
    "particle_sort.wgsl",
    "points.wgsl",
    "reduce.wgsl",
    "scan.wgsl",
    "shared/boundary.wgsl",
    "shared/bspline.wgsl",
    "shared/cell.wgsl",
    "shared/color.wgsl",
    "shared/control.wgsl",
    "shared/element.wgsl",
    "shared/extents.wgsl",
    "shared/flux.wgsl",
    "shared/gas.wgsl",
    "shared/gather.wgsl",
    "shared/grid_wall.wgsl",
    "shared/index.wgsl",
    "shared/interior.wgsl",
    "shared/material.wgsl",
    "shared/matrix.wgsl",
    "shared/params.wgsl",
    "shared/particle.wgsl",
    "shared/reconstruct.wgsl",
    "shared/reduce.wgsl",
    "shared/reduce4.wgsl",
    "shared/surface.wgsl",
    "shared/system.wgsl",
    "shared/thread.wgsl",
    "shared/view.wgsl",
    "slice.wgsl",
    "solid_kick.wgsl",
    "solid_predictor.wgsl",
    "solve_diagonal.wgsl",
    "solve_finish.wgsl",
    "solve_forces.wgsl",
    "solve_operator.wgsl",
    "solve_setup.wgsl",
    "step_control.wgsl",
    "time_step.wgsl",
    "vertex_pressure.wgsl",
    "volume.wgsl",
];
