//! What the shaders get of the registry: includes, and a switch per question.

use std::fmt::Write as _;

use super::KINDS;

/// The files with the functions of all kinds, as `#include` lines.
#[must_use]
pub fn wgsl_includes() -> String {
    KINDS.iter().map(|kind| format!("#include \"materials/{}.wgsl\"\n", kind.name)).collect()
}

/// WGSL functions that ask the material `kind` (its number in [`KINDS`]): `kirchhoff_stress`, `return_map`, `elastic_energy`, `wave_speed`.
/// They need the files of [`wgsl_includes`]. Kinds whose bit is not in the override `MATERIALS_USED` are left out: lanes of a
/// software device run every case of a switch.
#[must_use]
pub fn wgsl_switch() -> String {
    let mut text = String::new();
    for (index, kind) in KINDS.iter().enumerate() {
        // writing to a String cannot fail
        let _ = writeln!(text, "const MATERIAL_{}: u32 = {index}u;", kind.name.to_uppercase());
    }
    let loose = KINDS.iter().filter(|kind| !kind.keeps_volume);
    let loose: Vec<String> = loose.map(|kind| format!("kind != MATERIAL_{}", kind.name.to_uppercase())).collect();
    text.push_str(
        "\n// Whether plastic flow of a kind is shear alone, so that its deformation gradient knows its volume.\n",
    );
    let _ = writeln!(text, "fn keeps_volume(kind: u32) -> bool {{ return {}; }}\n", loose.join(" && "));
    text.push_str("override MATERIALS_USED: u32 = 0xffffffffu; // bit k: the scene uses kind k\n");
    for question in &QUESTIONS {
        let _ = writeln!(text, "\n// {}", question.summary);
        let _ = writeln!(
            text,
            "fn {}(kind: u32, {}) -> {} {{\n    switch kind {{",
            question.name, question.parameters, question.result
        );
        for kind in KINDS {
            let label = kind.name.to_uppercase();
            let used = format!("(MATERIALS_USED & (1u << MATERIAL_{label})) != 0u");
            let _ = writeln!(
                text,
                "        case MATERIAL_{label}: {{ if {used} {{ return {}_{}({}); }} }}",
                question.function, kind.name, question.arguments
            );
        }
        let _ = writeln!(text, "        default: {{ }}\n    }}\n    return {};\n}}", question.otherwise);
    }
    text
}

/// A question that shaders ask a material.
struct Question {
    summary: &'static str,
    name: &'static str,
    function: &'static str,
    parameters: &'static str,
    arguments: &'static str,
    result: &'static str,
    /// Answer for a number that no kind has; never used.
    otherwise: &'static str,
}

const QUESTIONS: [Question; 4] = [
    Question {
        summary: "Kirchhoff stress [Pa] of the displacement gradient h.",
        name: "kirchhoff_stress",
        function: "stress",
        parameters: "h: mat3x3f, m: MaterialParams",
        arguments: "h, m",
        result: "mat3x3f",
        otherwise: "mat3x3f()",
    },
    Question {
        summary: "Elastic part of the displacement gradient h after plastic flow, and the plastic strain that the flow added to `hardened`.",
        name: "return_map",
        function: "return",
        parameters: "h: mat3x3f, hardened: f32, m: MaterialParams",
        arguments: "h, hardened, m",
        result: "PlasticReturn",
        otherwise: "PlasticReturn(h, 0.0)",
    },
    Question {
        summary: "Elastic energy per reference volume [J m^-3] of the displacement gradient h.",
        name: "elastic_energy",
        function: "energy",
        parameters: "h: mat3x3f, m: MaterialParams",
        arguments: "h, m",
        result: "f32",
        otherwise: "0.0",
    },
    Question {
        summary: "Fastest elastic wave [m s^-1] of a body deformed by I + h, at a density at rest [kg m^-3].",
        name: "wave_speed",
        function: "wave_speed",
        parameters: "h: mat3x3f, m: MaterialParams, density: f32",
        arguments: "h, m, density",
        result: "f32",
        otherwise: "0.0",
    },
];
