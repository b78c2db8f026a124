//! What is wrong with the voids of a metal.

use super::{BASE, expect, parse};

fn with(extra: &str) -> String {
    format!("{BASE}{extra}")
}

#[test]
fn voids_need_flow_and_sound_numbers() {
    let law =
        |law: &str, keys: &str| with(&format!("[materials.m]\n{law}\nfracture = {{ fracture_energy = 1.0{keys} }}\n"));
    let [rubber, metal] = ["neo_hookean = { young_modulus = 1e3, poisson_ratio = 0.3 }", "steel = {}"];
    let voids = |d1: f64, d3: f64| format!(", johnson_cook = {{ d1 = {d1:?}, d2 = 0.0, d3 = {d3:?} }}");
    for (text, words) in [
        (law(rubber, ""), ["materials.m.fracture", "missing field `tensile_strength`"]),
        (law(rubber, &voids(0.1, -1.0)), ["materials.m.fracture.johnson_cook", "the law does not yield"]),
        (law(metal, &voids(0.001, -1.0)), ["materials.m", "make it at least 0.01"]),
        (law(metal, &voids(0.1, 1.0)), ["materials.m", "johnson_cook.d3"]),
        (law(metal, &format!(", tensile_strength = 1e9{}", voids(0.1, 0.0))), ["materials.m", "remove the other"]),
    ] {
        expect(&text, &[], &words);
    }
    // a preset's voids give way to a tensile strength
    let scene = parse(&law(metal, ", tensile_strength = 1e9"), &[]);
    assert!(
        scene.materials["m"].fracture().is_some_and(|own| own.johnson_cook.is_none() && own.tensile_strength == 1e9)
    );
}
