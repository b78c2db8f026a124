//! Structures that Rust and WGSL share: member by member the same offsets, and the same size.

use brisance::gpu::{Folder, Shader};
use wgpu::naga;

/// Name and offset of each member of a WGSL structure, and its size.
fn layout(shader: &str, structure: &str) -> (Vec<(String, usize)>, usize) {
    let folder = Folder::Disk(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders").into());
    let source = crate::shaders::constants(shader);
    let compiled = Shader::load(shader, &source, &folder).and_then(Shader::compile);
    let module = compiled.unwrap_or_else(|error| panic!("{error}")).module;
    let found = module.types.iter().find(|(_, kind)| kind.name.as_deref() == Some(structure));
    let Some((_, naga::Type { inner: naga::TypeInner::Struct { members, span }, .. })) = found else {
        panic!("{shader} has no struct {structure}")
    };
    let name = |member: &naga::StructMember| member.name.clone().unwrap_or_default();
    (members.iter().map(|member| (name(member), member.offset as usize)).collect(), *span as usize)
}

/// The rules of WGSL must leave the space that Rust fills.
#[test]
fn generated_structures() {
    for (_, kernel, shown) in crate::generated::shown() {
        for own in shown {
            let filled = own.members.iter().filter(|(member, _)| *member != "unused");
            let expected = filled.map(|(member, at)| ((*member).to_owned(), *at)).collect();
            assert_eq!(layout(kernel, own.name), (expected, own.size), "{} of {kernel}", own.name);
        }
    }
}
