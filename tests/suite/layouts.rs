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

/// The same for a structure whose WGSL is generated: the driver's rules must leave the space that Rust fills.
fn same_members(shader: &str, name: &str, members: &[(&str, usize)], size: usize) {
    let filled = members.iter().filter(|(member, _)| *member != "unused");
    let expected = filled.map(|(member, at)| ((*member).to_owned(), *at)).collect();
    assert_eq!(layout(shader, name), (expected, size), "{name} of {shader}");
}

#[test]
fn generated_structures() {
    same_members("step/time_step.wgsl", "Params", Params::MEMBERS, size_of::<Params>());
    same_members("step/time_step.wgsl", "Control", Control::MEMBERS, size_of::<Control>());
    same_members("numerics/linear_algebra.wgsl", "Pcg", PcgControl::MEMBERS, size_of::<PcgControl>());
}

#[test]
fn material() {
    same_layout!(
        "solid/g2p.wgsl",
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
