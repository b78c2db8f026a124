//! Scenes that would never end are refused by counting; numbers that the device cannot hold are named; every mistake is listed.

use std::fmt::Write as _;

use super::{BASE, expect, owned, parse, report};
use crate::scene::Scene;

fn body(shape: &str) -> String {
    format!("{BASE}[[bodies]]\nname = \"b\"\nmaterial = \"rubber\"\ndensity = 1.0\nshape = {shape}\n")
}

const BALL: &str = "{ sphere = { center = [0.5, 0.5], radius = 0.3 } }";

#[test]
fn copies_of_copies_multiply() {
    let mut shape = BALL.to_owned();
    for _ in 0..2 {
        shape = format!("{{ repeat = {{ count = 9999, offset = [1e-9, 0], shape = {shape} }} }}");
    }
    expect(&body(&shape), &[], &["bodies[0].shape", "single shapes", "at most 1000000"]);
    let patch = format!("{BASE}[boundary.x_min.patched]\npatches = [{{ shape = {shape}, rule = \"outlet\" }}]\n");
    expect(&patch, &[], &["boundary.x_min", "single shapes"]);
}

#[test]
fn uses_of_uses_multiply_and_their_depth_is_limited() {
    let mut wide =
        body("{ use = { name = \"a9\" } }") + "[shapes]\na0 = { sphere = { center = [0.5, 0.5], radius = 0.1 } }\n";
    for k in 1..10 {
        let ten = format!("{{ use = {{ name = \"a{}\" }} }},", k - 1).repeat(10);
        let _ = writeln!(wide, "a{k} = {{ union = [{ten}] }}");
    }
    expect(&wide, &[], &["single shapes"]);
    for names in [(0..3000).collect::<Vec<_>>(), (0..3000).rev().collect()] {
        let mut chain = BASE.to_owned() + "[shapes]\n";
        for k in names {
            let _ = writeln!(chain, "a{k:05} = {{ use = {{ name = \"a{:05}\" }} }}", k + 1);
        }
        chain.push_str("a03000 = { sphere = { center = [0.5, 0.5], radius = 0.1 } }\n");
        let report = report(&chain, &[]);
        assert!(report.contains("use each other") || report.contains("in each other"), "{report}");
        assert!(report.matches("error:").count() <= 20, "at most 20 messages");
    }
    let deep = format!("{}a=1", "a.".repeat(100_000));
    expect(BASE, &[&deep], &["keys inside each other"]);
}

#[test]
fn cells_particles_and_faces_are_counted() {
    let ball = body(BALL);
    expect(&ball, &["domain.cells=[60000, 30000]"], &["particles, about", "134217728"]);
    expect(&ball, &["domain.cells=[2000000000, 1000000000]"], &["domain.cells", "in all"]);
    expect(&ball, &["domain.dimension=4294967295", "gravity=[0, -9.81]"], &["domain.dimension"]);
    let open = format!("{BASE}[boundary.y_min.patched]\npatches = [{{ shape = {BALL}, rule = \"outlet\" }}]\n");
    let open = open.replace("[20, 10]", "[300000000, 3]").replace("[2.0, 1.0]", "[300000000.0, 3.0]");
    expect(&open, &[], &["patches and remembered gas of all faces", "100000000"]);
    let region = format!("[[gas.regions]]\nshape = {BALL}\nstate = {{ density = 2.0, pressure = 2.0 }}\n");
    let outlet = format!("{BASE}{region}[boundary]\ny_min = \"outlet\"\n");
    let outlet = outlet.replace("[20, 10]", "[300000000, 3]").replace("[2.0, 1.0]", "[300000000.0, 3.0]");
    expect(&outlet, &[], &["patches and remembered gas of all faces", "600000000"]);
    let mut many = BASE.to_owned();
    for k in 0..1024 {
        let _ = writeln!(many, "[[bodies]]\nname = \"b{k}\"\nmaterial = \"rubber\"\ndensity = 1.0\nshape = {BALL}");
    }
    expect(&many, &["domain.cells=[80, 40]"], &["distances to single shapes"]);
}

#[test]
fn overrides_of_large_scenes_are_read() {
    let large = format!("{BASE}#{}\n", "x".repeat(70_000));
    assert_eq!(parse(&large, &["time.until=2"]).time.until, 2.0);
    expect(&large, &["time.until=no"], &["--set"]);
}

#[test]
fn numbers_beyond_single_precision_are_named() {
    for (set, key) in [
        ("gas.ambient.density=1e50", "gas.ambient.density"),
        ("gas.ambient.density=1e-50", "gas.ambient.density"),
        ("gas.ambient.pressure=1e25", "gas.ambient.pressure"),
        ("gas.ambient.velocity=[1e60, 0]", "gas.ambient.velocity"),
        ("gas.gamma=1.0000000001", "gas.gamma"),
        ("gas.gamma=1e50", "gas.gamma"),
        ("domain.size=[2e60, 1e60]", "domain.size"),
        ("domain.size=[2e-60, 1e-60]", "domain.size"),
        ("time.fixed_step=1e-300", "time.fixed_step"),
        ("materials.rubber.neo_hookean.young_modulus=1e60", "materials.rubber.neo_hookean.young_modulus: 1e60"),
    ] {
        expect(BASE, &[set], &[key, "range of single precision", "give"]);
    }
    // each number is in range, their quotient is not
    let cold = ["gas.ambient.density=1e18", "gas.ambient.pressure=1e-18", "gas.ambient.velocity=[0, 0]"];
    assert!(Scene::parse(BASE, "a.toml", &owned(&cold)).is_ok());
    expect(BASE, &["gas.ambient.density=1e-19", "gas.ambient.pressure=1e19"], &["range of single precision"]);
}

#[test]
fn every_mistake_is_told_at_once() {
    let text = BASE
        .replace("title", "titel = 1\ntitle")
        .replace("density", "densty = 2.0, density")
        .replace("until", "util = 1\nuntil");
    let text = format!(
        "{text}x_min = 1\n[[obstacles]]\nname = \"=o\"\nshape = {{ spere = {{ radius = 1.0 }} }}\n[output]\nvtk = \"yes\"\n"
    );
    let report = report(&text, &[]);
    for word in [
        "`titel`", "`densty`", "`util`", "`spere`", "expected boolean", "did you mean `sphere`", "did you mean `until`",
    ] {
        assert!(report.contains(word), "no `{word}` in\n{report}");
    }
}

#[test]
fn names_and_titles_that_tables_and_films_cannot_carry() {
    for name in ["=1+1", "a\\u0007b", "a\\u0000"] {
        let text = body(BALL).replace("\"b\"", &format!("\"{name}\""));
        expect(&text, &[], &["bodies[0].name", "is no name"]);
    }
    expect(&BASE.replace("\"test\"", "\"a\\u0000\""), &[], &["title"]);
    expect(&BASE.replace("\"test\"", &format!("\"{}\"", "a".repeat(100_000))), &[], &["title", "100000 bytes"]);
}

#[test]
fn a_preset_is_a_material_by_its_name() {
    let scene = parse(&body(BALL).replace("\"rubber\"\ndensity = 1.0", "\"steel\""), &[]);
    assert_eq!(scene.bodies[0].density, Some(7850.0));
    assert!(scene.materials.contains_key("steel"));
    expect(&body(BALL).replace("\"rubber\"", "\"stel\""), &[], &["unknown material `stel`", "did you mean `steel`"]);
    let pot = "{ revolve = { points = [[0.0, 0.1], [0.2, 0.1], [0.2, 0.4], [0.0, 0.4]] } }";
    parse(&format!("{BASE}[shapes]\npot = {pot}\n"), &[]);
}

#[test]
fn the_run_is_estimated() {
    let estimate = parse(BASE, &[]).estimate(0);
    assert!((estimate.gas_sound_speed - 1.4f64.sqrt()).abs() < 1e-12);
    assert!(estimate.warnings().is_empty() && (10.0..200.0).contains(&estimate.steps), "{estimate:?}");
    let endless = parse(BASE, &["time.fixed_step=1e-9"]).estimate(0).warnings();
    assert!(endless.len() == 1 && endless[0].contains("hardly end"), "{endless:?}");
    let stiff = "materials.rubber.neo_hookean.young_modulus=1e9";
    let held = parse(&body(BALL), &[stiff]).estimate(0);
    assert!(held.substeps > 1000.0 && held.warnings().is_empty(), "{held:?}");
    let implicit = parse(&body(BALL), &[stiff, "numerics.elasticity=\"implicit\""]).estimate(0);
    assert!(implicit.substeps == 1.0 && implicit.warnings()[0].contains("capped"), "{implicit:?}");
}

#[test]
fn scenes_that_nobody_wrote_by_hand_are_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let told = |text: String| {
        std::fs::write(&path, text).unwrap();
        Scene::load(&path, &[]).map(|_| ()).unwrap_err().to_string()
    };
    let many = told(format!("{BASE}[render]\ncontours = [{}]\n", "0.5, ".repeat(120_000)));
    assert!(many.contains("keys and entries of lists") && many.contains("at most 100000"), "{many}");
    let long = told(format!("{BASE}#{}\n", "x".repeat(3 << 20)));
    assert!(long.contains("larger than 2 MiB"), "{long}");
    let mut views = BASE.to_owned();
    for k in 0..101 {
        let _ = writeln!(views, "[render.views.v{k}]\nsize = [64, 64]");
    }
    assert!(told(views).contains("101 views"));
}

#[test]
fn what_is_told_is_short_whatever_stands_in_the_scene() {
    let word = "x".repeat(100_000);
    for text in
        [format!("{BASE}[{word}]\n"), format!("{word} = 1\n{BASE}"), format!("{BASE}[render]\nmode = \"{word}\"\n")]
    {
        let told = report(&text, &[]);
        assert!(told.len() < 5000 && told.contains("100000 bytes") | told.contains("(1000"), "{} bytes", told.len());
        assert!(told.contains("--> "), "it has a place: {told}");
    }
    let set = format!("title={word}");
    assert!(report(BASE, &[&set]).len() < 5000);
    expect(BASE, &["gas.gamma=1.0000000001"], &["1.0000000001 is out"]);
    expect(BASE, &["time.max_growth=0.5"], &["0.5 is out"]);
}
