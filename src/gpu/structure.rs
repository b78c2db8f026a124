//! Structures that Rust and WGSL share: declared once, in Rust, with the types of WGSL.

use std::fmt::Write as _;

/// Types of WGSL, as Rust has them.
#[allow(non_camel_case_types)]
pub mod types {
    /// Three signless whole numbers.
    pub type vec3u = [u32; 3];
    /// Four of them.
    pub type vec4u = [u32; 4];
    /// Three numbers.
    pub type vec3f = [f32; 3];
    /// A whole number that threads change together.
    pub type atomic_u32 = u32;
}

/// Declares a structure with public members, and as `wgsl` the same for shaders, under another name. Members called `unused` fill the space
/// before vectors, which WGSL leaves by itself.
macro_rules! structure {
    ($(#[$meta:meta])* $name:ident as $shader:literal { $($(#[doc = $doc:literal])+ $member:ident: $kind:tt,)+ }) => {
        $(#[$meta])*
        #[repr(C)]
        pub struct $name {
            $($(#[doc = $doc])+ pub $member: $kind,)+
        }

        impl $name {
            /// Name and place \[bytes\] of each member.
            pub const MEMBERS: &'static [(&'static str, usize)] =
                &[$((stringify!($member), std::mem::offset_of!($name, $member))),+];

            /// The structure as WGSL.
            #[must_use]
            pub fn wgsl() -> String {
                let members = [$((stringify!($member), stringify!($kind), concat!($($doc),+))),+];
                $crate::gpu::structure::wgsl($shader, &members)
            }
        }
    };
}
pub(crate) use structure;

/// A structure as WGSL, from names, types and comments.
pub(crate) fn wgsl(name: &str, members: &[(&str, &str, &str)]) -> String {
    let mut text = format!("struct {name} {{\n");
    for (member, kind, comment) in members.iter().filter(|(member, _, _)| *member != "unused") {
        let kind = match kind.strip_prefix('[').and_then(|kind| kind.strip_suffix(']')) {
            Some(array) => format!("array<{}>", array.replace(';', ",")),
            None => (*kind).to_owned(),
        };
        let declared = format!("{member}: {},", kind.replace("atomic_u32", "atomic<u32>"));
        let comment = comment.trim().trim_end_matches('.').replace("\\[", "[").replace("\\]", "]");
        let comment = comment.replace("[`", "").replace("`]", "").replace('`', "");
        // Writing to a String cannot fail.
        let _ = writeln!(text, "    {declared:<27} // {comment}");
    }
    text.push_str("}\n");
    text
}
