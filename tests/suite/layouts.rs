//! Structures that Rust and WGSL share: member by member the same offsets, and the same size.

use brisance::gpu::{Folder, Shader};
use brisance::material::MaterialParams;
use brisance::numerics::PcgControl;
use brisance::state::constants;
use brisance::state::{Control, Params};
use wgpu::naga;

/// Name and offset of each member of a WGSL structure, and its size.
fn layout(shader: &str, structure: &str) -> (Vec<(String, usize)>, usize) {
    let folder = Folder::Disk(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders").into());
    let source = constants::source_for(shader);
    let compiled = Shader::load(shader, &source, &folder).and_then(Shader::compile);
    let module = compiled.unwrap_or_else(|error| panic!("{error}")).module;
    let found = module.types.iter().find(|(_, kind)| kind.name.as_deref() == Some(structure));
    let Some((_, naga::Type { inner: naga::TypeInner::Struct { members, span }, .. })) = found else {
        panic!("{shader} has no struct {structure}")
    };
    let name = |member: &naga::StructMember| member.name.clone().unwrap_or_default();
    (members.iter().map(|member| (name(member), member.offset as usize)).collect(), *span as usize)
}

/// Compares a structure with its mirror; fields of the mirror that only fill space are left out.
macro_rules! same_layout {
    ($shader:literal, $name:literal, $mirror:ty, [$($field:ident),* $(,)?]) => {
        let expected = vec![$((stringify!($field).to_owned(), std::mem::offset_of!($mirror, $field))),*];
        let (found, size) = layout($shader, $name);
        assert_eq!(found, expected, concat!($name, " of ", $shader));
        assert_eq!(size, size_of::<$mirror>(), concat!("size of ", $name));
    };
}

#[test]
fn params() {
    same_layout!(
        "time_step.wgsl",
        "Params",
        Params,
        [
            cells,
            slots,
            stride,
            particles,
            origin,
            spacing,
            gravity,
            gamma,
            ambient_density,
            ambient_pressure,
            cfl,
            max_courant,
            max_growth,
            fixed_step,
            elastic_cfl,
            solid_threshold,
            mass_floor,
            tolerance,
            extra_capacity,
            max_iterations,
            probes,
            history,
            bodies,
            max_substeps,
            groups,
            march,
            wall_sides,
            blending,
            least_entropy,
            surface_rows,
            still,
            runs_at,
            still_at,
            table_at,
            list_runs_at,
            scan,
        ]
    );
}

#[test]
fn control() {
    same_layout!(
        "time_step.wgsl",
        "Control",
        Control,
        [
            dt,
            duration,
            dt_previous,
            remaining,
            phase,
            substeps,
            substep,
            stage,
            step,
            fault,
            limited,
            limited_before,
            floored,
            cold,
            raised,
            clamped,
            unsorted,
            escaped,
            extra,
            iterations,
            residual,
            listed,
            frontier,
            runs,
            list_runs,
            sound,
            reach,
            woken,
            woken_before,
            time,
            time_error,
            rounds,
            round_open,
            newly_held,
            elastic_iterations,
            longest_round,
            imbalance,
            borrowed,
        ]
    );
}

#[test]
fn material() {
    same_layout!(
        "g2p.wgsl",
        "MaterialParams",
        MaterialParams,
        [
            mu,
            lambda,
            yield_stress,
            kind,
            ghost_modulus,
            hardening,
            friction,
            elastic_lambda,
            tensile_strength,
            toughness,
            softening,
            crack_modulus
        ]
    );
}

#[test]
fn conjugate_gradients() {
    same_layout!(
        "linear_algebra.wgsl",
        "Pcg",
        PcgControl,
        [
            rho,
            alpha,
            beta,
            reference,
            tolerance,
            iterations,
            max_iterations,
            outcome,
            length,
            listed_wide,
            listed_high,
            frontier_wide,
            frontier_high,
            groups_wide,
            groups_high,
            groups_partial,
            groups_block,
            size,
            most,
            levels,
            joined,
            runs,
            apart,
            reference_at,
            level_groups,
        ]
    );
}
