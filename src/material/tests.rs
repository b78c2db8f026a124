//! Tests of the registry and of the WGSL it generates.

use std::collections::BTreeSet;
use std::path::Path;

use wgpu::naga;

use super::*;

fn metal(values: [f64; 3]) -> Material {
    let names = ["young_modulus", "poisson_ratio", "yield_stress"];
    let given = names.iter().zip(values).map(|(name, value)| ((*name).to_owned(), value)).collect::<Vec<_>>();
    Material::new("von_mises", &given).expect("all parameters are given")
}

/// The text of a shader with its includes, each once.
fn flatten(name: &str, seen: &mut BTreeSet<String>) -> String {
    if !seen.insert(name.to_owned()) {
        return String::new();
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders").join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    expand(&text, seen)
}

fn expand(text: &str, seen: &mut BTreeSet<String>) -> String {
    let line = |line: &str| match line.strip_prefix("#include ") {
        Some(name) => flatten(name.trim_matches('"'), seen),
        None => line.to_owned(),
    };
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

#[test]
fn lame_constants() {
    let material = metal([1.0e3, 0.25, 30.0]);
    assert!((material.mu() - 400.0).abs() < 1e-9 && (material.lambda() - 400.0).abs() < 1e-9);
    assert!((material.wave_speed(12.0) - 10.0).abs() < 1e-12);
    let params = material.params(VolumeShare::Split(10.0));
    assert_eq!((params.kind, params.ghost_modulus, params.yield_stress), (1, 10.0, 30.0));
    assert_eq!(params.elastic_lambda, 390.0);
    let stiff = material.params(VolumeShare::Split(1.0));
    assert_eq!((stiff.ghost_modulus, stiff.elastic_lambda), (8.0, 392.0));
    let shared = material.params(VolumeShare::Ghost);
    assert_eq!((shared.ghost_modulus, shared.elastic_lambda), (400.0, 0.0));
}

#[test]
fn elastic_laws_do_not_yield() {
    let given = [("young_modulus".to_owned(), 1.0), ("poisson_ratio".to_owned(), 0.3)];
    let rubber = Material::new("neo_hookean", &given).expect("all parameters are given");
    assert_eq!(rubber.yield_stress(), f64::INFINITY);
    assert_eq!(rubber.params(VolumeShare::Ghost).yield_stress, f32::MAX);
}

#[test]
fn unknown_and_missing_parameters() {
    let error = Material::new("jelly", &[]).expect_err("no such kind");
    assert!(error.contains("`neo_hookean`, `von_mises`"), "{error}");
    let error = Material::new("neo_hookean", &[("young".to_owned(), 1.0)]).expect_err("no such parameter");
    assert!(error.contains("`young`") && error.contains("`young_modulus`"), "{error}");
    let error = Material::new("neo_hookean", &[("young_modulus".to_owned(), 1.0)]).expect_err("a parameter is missing");
    assert!(error.contains("`poisson_ratio`"), "{error}");
}

#[test]
fn the_generated_switch_validates() {
    let text = expand(&format!("{}\n{}", wgsl_includes(), wgsl_switch()), &mut BTreeSet::new());
    let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
    let flags = naga::valid::ValidationFlags::all();
    let validated = naga::valid::Validator::new(flags, naga::valid::Capabilities::empty()).validate(&module);
    assert!(validated.is_ok(), "{validated:?}");
    for name in ["kirchhoff_stress", "return_map", "elastic_energy", "wave_speed"] {
        assert!(module.functions.iter().any(|(_, function)| function.name.as_deref() == Some(name)), "{name}");
    }
}
