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
        (law(metal, &format!(", rubble = true{}", voids(0.1, 0.0))), ["materials.m", "remove `rubble`"]),
        (law(metal, ", debris = \"burn\""), ["materials.m.fracture.debris", "there are `keep`, `drop`"]),
    ] {
        expect(&text, &[], &words);
    }
    // a preset's voids give way to a tensile strength
    let scene = parse(&law(metal, ", tensile_strength = 1e9"), &[]);
    assert!(
        scene.materials["m"].fracture().is_some_and(|own| own.johnson_cook.is_none() && own.tensile_strength == 1e9)
    );
}

#[test]
fn a_flow_stress_needs_a_metal_and_sound_numbers() {
    let law = |law: &str, keys: &str| {
        with(&format!("[materials.m]\n{law}\nflow = {{ exponent = 0.3, heat_capacity = 450.0{keys} }}\n"))
    };
    let melting = |more: &str| format!(", melting_temperature = 1800.0{more}");
    let [rubber, metal] = ["neo_hookean = { young_modulus = 1e3, poisson_ratio = 0.3 }", "steel = {}"];
    for (text, words) in [
        (law(rubber, &melting("")), ["materials.m.flow", "unknown field `flow`"]),
        (law(metal, ""), ["materials.m.flow", "missing field `melting_temperature`"]),
        (
            law(metal, &melting(", room_temperature = 2e3")),
            ["materials.m.flow.melting_temperature", "room_temperature"],
        ),
        (law(metal, &melting(", taylor_quinney = 1.5")), ["materials.m.flow.taylor_quinney", "from 0 to 1"]),
        (
            with(
                "[materials.m]\nvon_mises = { young_modulus = 1e3, poisson_ratio = 0.3, yield_stress = 1.0 }\nflow = true\n",
            ),
            ["materials.m.flow", "expected table"],
        ),
        (with("[materials.m]\nrubber = {}\nflow = true\n"), ["materials.m.flow", "unknown field `flow`"]),
        (with("[materials.m]\nsteel = {}\nfracture = true\nflow = false\n"), ["johnson_cook.d5", "give `flow`"]),
        (
            with("[numerics]\nelasticity = \"implicit\"\n[materials.m]\nsteel = {}\nflow = true\n"),
            ["numerics.elasticity", "leave `flow` out"],
        ),
    ] {
        expect(&text, &[], &words);
    }
    // numbers of the law that are given stay, the rest are those of the flow stress
    let scene = parse(&with("[materials.m]\nsteel = { yield_stress = 1e9 }\nflow = true\n"), &[]);
    let metal = &scene.materials["m"];
    assert_eq!(metal.parameter("yield_stress"), Some(1e9));
    assert!((metal.flow_stress(1.0, 1.0, 0.0) - 1e9 - (2.0_f64 / 3.0).sqrt() * 2.75e8).abs() < 1e3);
    let text = toml::to_string(&scene).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(parse(&text, &[]).materials["m"].flow(), metal.flow());
}

#[test]
fn a_metal_that_breaks_without_a_flow_stress_is_told() {
    let body =
        "[[bodies]]\nname = \"rod\"\nmaterial = \"m\"\nshape = { sphere = { center = [0.5, 0.5], radius = 0.3 } }\n";
    let told = |more: &str| {
        let voids = "fracture_energy = 1.0, johnson_cook = { d1 = 0.1, d2 = 0.0, d3 = -1.0 }";
        let text = with(&format!("[materials.m]\nsteel = {{}}\nfracture = {{ {voids} }}\n{more}{body}"));
        let tearing = parse(&text, &[]).tearing();
        assert_eq!(tearing.len(), 1, "one body tears");
        tearing[0].warning()
    };
    assert_eq!(told("flow = true\n"), None);
    assert!(told("flow = false\n").is_some_and(|text| text.contains("`rod`") && text.contains("`flow`")));
}
