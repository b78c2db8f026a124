//! Tests of scenes: reading and its errors, geometry, the shipped files and their documentation.

mod cameras;
mod errors;
mod files;
mod foreign;
mod geometry;
mod hostile;
mod meshes;
mod sampling;
mod voids;

use super::Scene;

/// A complete small scene; tests append to it or replace parts of it.
const BASE: &str = r#"
title = "test"
[domain]
dimension = 2
cells = [20, 10]
size = [2.0, 1.0]
[gas]
ambient = { density = 1.0, pressure = 1.0 }
[time]
until = 1.0
[materials.rubber]
neo_hookean = { young_modulus = 100.0, poisson_ratio = 0.3 }
"#;

/// Reads text with overrides; panics with the report if it is wrong.
fn parse(text: &str, overrides: &[&str]) -> Scene {
    Scene::parse(text, "test.toml", &owned(overrides)).unwrap_or_else(|error| panic!("{error}"))
}

/// The report of a scene that must be wrong.
fn report(text: &str, overrides: &[&str]) -> String {
    match Scene::parse(text, "test.toml", &owned(overrides)) {
        Ok(_) => panic!("accepted:\n{text}"),
        Err(error) => {
            assert_eq!(error.exit_code(), 3);
            error.to_string()
        }
    }
}

/// The report must hold every one of the words.
fn expect(text: &str, overrides: &[&str], words: &[&str]) {
    let report = report(text, overrides);
    for word in words {
        assert!(report.contains(word), "no `{word}` in\n{report}");
    }
}

fn owned(overrides: &[&str]) -> Vec<String> {
    overrides.iter().map(|text| (*text).to_owned()).collect()
}
