//! Structures that Rust and WGSL share: declared once, in Rust, with the types of WGSL.

use std::fmt::Write as _;

/// Types of WGSL, as Rust has them.
#[allow(non_camel_case_types)]
pub mod types {
    /// Two signless whole numbers.
    pub type vec2u = [u32; 2];
    /// Three of them.
    pub type vec3u = [u32; 3];
    /// Four of them.
    pub type vec4u = [u32; 4];
    /// Three numbers.
    pub type vec3f = [f32; 3];
    /// Four of them.
    pub type vec4f = [f32; 4];
    /// A whole number that threads change together.
    pub type atomic_u32 = u32;
}

/// A structure of both languages, as tests and generated parts of shaders need it.
#[derive(Clone, Debug)]
pub struct Shared {
    /// Its name in WGSL.
    pub name: &'static str,
    /// The file in Rust that declares it.
    pub source: &'static str,
    /// Name and place \[bytes\] of each member.
    pub members: &'static [(&'static str, usize)],
    /// Its size \[bytes\].
    pub size: usize,
    /// The structure as WGSL.
    pub wgsl: String,
}

/// Declares a structure whose members are as visible as it is, and as `shared` the same for shaders, under another name. Members called `unused` fill the
/// space before vectors and at the end, which WGSL leaves by itself.
macro_rules! structure {
    ($(#[$meta:meta])* $vis:vis $name:ident as $shader:literal { $($(#[doc = $doc:literal])+ $member:ident: $kind:tt,)+ }) => {
        $(#[$meta])*
        #[repr(C)]
        $vis struct $name {
            $($(#[doc = $doc])+ $vis $member: $kind,)+
        }

        impl $name {
            /// The structure in both languages.
            $vis fn shared() -> $crate::structure::Shared {
                let members = [$((stringify!($member), stringify!($kind), concat!($($doc),+))),+];
                $crate::structure::Shared {
                    name: $shader,
                    source: file!(),
                    members: &[$((stringify!($member), std::mem::offset_of!($name, $member))),+],
                    size: size_of::<$name>(),
                    wgsl: $crate::structure::wgsl($shader, &members),
                }
            }
        }
    };
}
pub(crate) use structure;

/// Declares names that count from 0, in Rust and as constants of WGSL.
macro_rules! numbers {
    ($(#[$meta:meta])* $name:ident { $($(#[$doc:meta])+ $variant:ident,)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u32)]
        pub enum $name {
            $($(#[$doc])+ $variant),+
        }

        impl $name {
            /// All names, in order.
            pub const NAMES: &'static [&'static str] = &[$(stringify!($variant)),+];

            /// The numbers as WGSL, behind a prefix.
            pub fn wgsl(prefix: &str) -> String {
                $crate::structure::wgsl_numbers(prefix, Self::NAMES)
            }
        }
    };
}
pub(crate) use numbers;

/// Constants that count from 0, as WGSL.
pub(crate) fn wgsl_numbers(prefix: &str, names: &[&str]) -> String {
    let line = |(number, name): (usize, &&str)| format!("const {prefix}_{} = {number}u;\n", name.to_uppercase());
    names.iter().enumerate().map(line).collect()
}

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
