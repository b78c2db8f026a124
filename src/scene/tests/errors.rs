//! Every kind of mistake is reported with its line, its key and what is allowed.

use super::{BASE, expect, parse, report};
use crate::scene::file::load::read;
use crate::scene::file::source::Source;
use crate::scene::{Changes, Scene};

fn with(extra: &str) -> String {
    format!("{BASE}{extra}")
}

#[test]
fn syntax() {
    expect("title = \"a\"\n[domain\n", &[], &["test.toml:2:", "unclosed table"]);
}

#[test]
fn unknown_key_lists_the_known_ones() {
    let text = BASE.replace("until", "util = 3.0\nuntil");
    expect(&text, &[], &["test.toml:10:1", "unknown field `util`", "`until`", "time.util"]);
}

#[test]
fn a_key_in_another_table_is_told_its_place_and_one_that_is_gone_what_to_do() {
    let old = with("[numerics]\ntolerance = 1e-6\nghost = \"shared_volume\"\nmax_iterations = 9\nledger = false\n");
    let words = [
        "numerics.ghost: unknown field `ghost`; it is a key of `numerics.paper`",
        "write numerics.paper.ghost, or the key below the header [numerics.paper]",
        "numerics.max_iterations: unknown field `max_iterations`; it is a key of `numerics.expert`",
        "numerics.ledger: unknown field `ledger`\n   --> test.toml:17:1",
        "remove it: the gas of covered cells is always kept and given back",
    ];
    expect(&old, &[], &words);
    expect(BASE, &["numerics.elastic_cfl=0.2"], &["--set:1:22", "write numerics.expert.elastic_cfl"]);
    expect(&BASE.replace("[domain]", "until = 1.0\n[domain]"), &[], &["test.toml:3:1", "it is a key of `time`"]);
}

#[test]
fn unknown_key_inside_a_region() {
    let region =
        "[[gas.regions]]\nshape = { sphere = { center = [0.5, 0.5], radius = 0.1 } }\ndensity = 1.0\npresure = 2.0\n";
    expect(&with(region), &[], &["test.toml:16:1", "unknown field `presure`", "`pressure`", "gas.regions[0].presure"]);
}

#[test]
fn variants_that_are_wrong() {
    let text = with("[variants.small]\n\"domain.cels\" = [10, 5]\n[variants.long]\n\"probes[0].name\" = \"a\"\n");
    let expect = |text: &str, name: &str, words: &[&str]| {
        let told = Scene::parse(text, "test.toml", Changes::variant(name)).unwrap_err().to_string();
        words.iter().for_each(|word| assert!(told.contains(word), "no `{word}` in\n{told}"));
    };
    expect(&text, "large", &["test.toml:13:2", "no variant `large`", "`long`", "`small`"]);
    expect(&text, "small", &["test.toml:14:1", "unknown field `cels`", "`cells`"]);
    expect(BASE, "a", &["no variants"]);
    let listed = text.replace("title", "probes = []\ntitle");
    expect(&listed, "long", &["variant `long`", "`0` is no entry of a list of 0"]);
}

#[test]
fn wrong_type() {
    let text = BASE.replace("until = 1.0", "until = \"soon\"");
    expect(&text, &[], &["test.toml:10:9", "time.until", "expected f64"]);
}

#[test]
fn missing_key() {
    expect(&BASE.replace("until = 1.0", "cfl = 0.5"), &[], &["test.toml:9:", "missing field `until`", "time"]);
}

#[test]
fn unknown_shape_and_boundary() {
    let obstacle = "[[obstacles]]\nname = \"o\"\nshape = { ball = { radius = 1.0 } }\n";
    expect(&with(obstacle), &[], &["test.toml:15:", "unknown variant `ball`", "`sphere`"]);
    expect(
        &with("[boundary]\nx_min = \"open\"\n"),
        &[],
        &["test.toml:14:", "unknown variant `open`", "`outlet`", "boundary.x_min"],
    );
}

#[test]
fn unknown_material_kind_and_parameter() {
    expect(&with("[materials.m]\njelly = { a = 1.0 }\n"), &[], &["test.toml:14:", "`jelly`", "`von_mises`"]);
    expect(&with("[materials.m]\nneo_hookean = { young = 1.0 }\n"), &[], &["`young`", "`young_modulus`"]);
}

#[test]
fn poisson_ratio_of_one_half() {
    let text = BASE.replace("0.3", "0.5");
    expect(&text, &[], &["test.toml:12:56", "materials.rubber.neo_hookean.poisson_ratio", "above 0 and below 0.5"]);
}

#[test]
fn negative_density_and_pressure_are_both_reported() {
    let text = BASE.replace("density = 1.0, pressure = 1.0", "density = -1.0, pressure = 0");
    expect(&text, &[], &["test.toml:8:23", "gas.ambient.density", "gas.ambient.pressure", "above 0", "2 errors"]);
}

#[test]
fn numbers_that_are_not_finite() {
    expect(&BASE.replace("until = 1.0", "until = inf"), &[], &["test.toml:10:9", "time.until", "not finite"]);
    expect(
        &BASE.replace("size = [2.0, 1.0]", "size = [nan, 1.0]"),
        &[],
        &["test.toml:6:9", "domain.size[0]", "not finite"],
    );
}

#[test]
fn domains() {
    expect(&BASE.replace("[20, 10]", "[20, 0]"), &[], &["test.toml:5:9", "domain.cells", "at least 3 cells"]);
    expect(&BASE.replace("[20, 10]", "[20, -1]"), &[], &["test.toml:5:14", "u32"]);
    expect(&BASE.replace("[20, 10]", "[20, 20]"), &[], &["domain.cells", "cubes", "cells = [20, 10]"]);
    expect(&BASE.replace("[20, 10]", "[20]"), &[], &["domain.cells", "1 entries", "give 2 numbers"]);
    expect(&BASE.replace("[2.0, 1.0]", "[2.0, -1.0]"), &[], &["domain.size", "axis y"]);
    expect(
        &BASE.replace("dimension = 2", "dimension = 4"),
        &[],
        &["test.toml:4:13", "domain.dimension", "from 1 to 3"],
    );
    expect(&BASE.replace("[20, 10]", "[200000, 100000]"), &[], &["domain.cells", "at most"]);
}

fn body(shape: &str) -> String {
    with(&format!("[[bodies]]\nname = \"b\"\nmaterial = \"rubber\"\ndensity = 1.0\nshape = {{ {shape} }}\n"))
}

#[test]
fn bodies() {
    let sphere = body("sphere = { center = [0.5, 0.5], radius = 0.2 }");
    let missing = sphere.replace("material = \"rubber\"", "material = \"stel\"");
    expect(&missing, &[], &["test.toml:15:12", "bodies[0].material", "unknown material `stel`", "`rubber`"]);
    let outside = body("sphere = { center = [5.0, 0.5], radius = 0.2 }");
    expect(&outside, &[], &["test.toml:17:9", "bodies[0].shape", "outside the domain", "x from 0 to 2"]);
    let beyond = body("sphere = { center = [1.9, 0.5], radius = 0.2 }");
    expect(&beyond, &[], &["bodies[0].shape", "reaches out of the domain"]);
    let tiny = body("sphere = { center = [0.5, 0.5], radius = 0.001 }");
    expect(&tiny, &[], &["bodies[0].shape", "holds no particle"]);
    expect(
        &format!("{sphere}particles_per_cell = 0\n"),
        &[],
        &["bodies[0].particles_per_cell", "give a whole number from 1 to 8"],
    );
    expect(&format!("{sphere}velocity = [0.0, 0.0, 1.0]\n"), &[], &["bodies[0].velocity", "active axes"]);
    let twice = format!("{sphere}{}", sphere.strip_prefix(BASE).expect("it starts with the base"));
    expect(&twice, &[], &["bodies[1].name", "`b` is taken"]);
    for (line, words) in [
        ("friction = -0.1", ["bodies[0].friction", "at least 0"]),
        ("friction = \"glue\"", ["bodies[0].friction", "`stick`, or a number"]),
        ("velocity = [1, 0]\nmotion = { velocity = [1, 0] }", ["bodies[0].motion", "velocity of its own"]),
        ("motion = { spin = [1, 0, 0] }", ["bodies[0].motion.spin", "about z alone"]),
        ("motion = { table = [{ time = 1 }, { time = 1 }] }", ["bodies[0].motion.table", "in order of time"]),
        ("clamped = { sphere = { center = [0, 0], radius = -1 } }", ["bodies[0].clamped.sphere.radius", "above 0"]),
        ("clamped = { sphere = { center = [1.5, 0.5], radius = 0.1 } }", ["bodies[0].clamped", "holds no particle"]),
    ] {
        expect(&format!("{sphere}{line}\n"), &[], &words);
    }
    expect(&sphere.replace("density = 1.0\n", ""), &[], &["bodies[0].density", "presets"]);
}

#[test]
fn presets() {
    let scene = |rest: &str| with(&format!("[materials.hull]\nsteel = {{ {rest} }}\n"));
    expect(&scene("units = \"imperial\""), &[], &["si", "scaled"]);
    expect(&scene("units = 3"), &[], &["steel.units", "scaled"]);
    expect(&scene("cohesion = 3"), &[], &["`cohesion`", "`yield_stress`"]);
    expect(&scene("yield_stress = -3"), &[], &["materials.hull.steel.yield_stress", "above 0"]);
    let body =
        "[[bodies]]\nname = \"b\"\nmaterial = \"hull\"\nshape = { sphere = { center = [1, 0.5], radius = 0.3 } }\n";
    let scene = parse(&format!("{}{body}", scene("units = \"scaled\", yield_stress = 5.0")), &[]);
    let hull = &scene.materials["hull"];
    assert_eq!(hull.parameter("yield_stress"), Some(5.0));
    assert_eq!(hull.parameter("young_modulus"), Some(2e11 / 101_325.0));
    assert_eq!((hull.parameter("poisson_ratio"), scene.bodies[0].density), (Some(0.3), Some(7850.0 / 1.225)));
}

#[test]
fn shapes() {
    let negative = body("union = [{ sphere = { center = [0.5, 0.5], radius = -0.2 } }]");
    expect(&negative, &[], &["bodies[0].shape.union[0].sphere.radius", "test.toml:17:63", "above 0"]);
    expect(&body("union = []"), &[], &["bodies[0].shape.union", "the list is empty"]);
    expect(&body("half_space = { point = [0.5, 0.5], normal = [0.0, 0.0] }"), &[], &["half_space.normal", "no length"]);
    expect(&body("polygon = { points = [[0.1, 0.1], [0.2, 0.2]] }"), &[], &["polygon.points", "at least 3"]);
    expect(
        &body("box = { center = [0.5, 0.5], size = [0.2, 0.2], round = 0.2 }"),
        &[],
        &["box.round", "half the shortest edge"],
    );
    let scale = body("scale = { factor = 0.0, shape = { sphere = { center = [0.5, 0.5], radius = 0.1 } } }");
    expect(&scale, &[], &["scale.factor", "above 0"]);
}

#[test]
fn settings() {
    for (setting, key) in [
        ("[numerics]\ntolerance = 0.0\n", "numerics.tolerance"),
        ("[numerics.expert]\nmax_iterations = 0\n", "numerics.expert.max_iterations"),
        ("[numerics.paper]\nsolid_threshold = 1.5\n", "numerics.paper.solid_threshold"),
        ("[numerics]\nfilter = 1.5\n", "numerics.filter: 1.5 is out of range"),
        ("[numerics]\nfilter = -0.5\n", "give a number from 0 to 1"),
        ("[numerics]\ntolerance = 1.0\n", "give a number above 0 and below 1"),
        ("[numerics.expert]\nelastic_tolerance = 0.6\n", "give a number above 0 and at most 0.5"),
        ("[render]\nsize = [8, 720]\n", "render.size"),
        ("[render]\nrange = [1.0, 1.0]\n", "render.range"),
        ("[render]\nparticle_range = [2.0, 1.0]\n", "render.particle_range"),
        ("[render]\nsupersampling = 5\n", "render.supersampling"),
        ("[render]\nexposure = 0.0\n", "render.exposure"),
        ("[render]\nopacity = [[0.5, 0.0], [0.2, 1.0]]\n", "render.opacity"),
        ("[render]\nopacity = [[0.5, 2.0]]\n", "render.opacity"),
        ("[render]\ncontours = 99\n", "render.contours"),
        ("[render]\nemission = { ambient_kelvin = -1.0 }\n", "render.emission.ambient_kelvin"),
        ("[render]\nlight = { direction = [0, 0, 0] }\n", "render.light.direction"),
        ("[render]\nslices = [{ point = [0, 0, 0], normal = [0, 0, 0] }]\n", "render.slices[0].normal"),
        ("[render]\ncamera = { eye = [2, 0, 0], target = [0, 0, 0], height = 0.0 }\n", "render.camera.height"),
        ("[render]\ncamera = { eye = [0, 0, 1], target = [0, 0, 0] }\n", "render.camera.up"),
        ("[boundary]\nz_min = \"outlet\"\n", "boundary.z_min"),
        ("[boundary]\nx_min = { inlet = { density = 1.0, pressure = 0.0 } }\n", "boundary.x_min.inlet.pressure"),
        ("[boundary]\nx_max = { inlet = { density = 1.0, velocity = [1, 0], pressure = 1.0 } }\n", "out of the domain"),
        ("[boundary]\nx_min = \"periodic\"\n", "only one side of the axis is periodic"),
        ("[boundary]\nx_min = { subsonic_inlet = { density = 0.0 } }\n", "boundary.x_min.subsonic_inlet.density"),
        ("[boundary]\nx_min = { total_inlet = { density = 1.0, pressure = -1.0 } }\n", "total_inlet.pressure"),
        ("[boundary]\nx_min = { timed_inlet = { table = [] } }\n", "timed_inlet.table"),
        (
            "[boundary]\nx_min = { timed_inlet = { rule = \"subsonic\", table = [{ time = 1.0, density = 1.0 }, \
             { time = 0.5, density = 1.0 }] } }\n",
            "boundary.x_min.timed_inlet.table[1].time",
        ),
        ("[boundary]\nx_max = { pressure_outlet = { pressure = 0.0 } }\n", "pressure_outlet.pressure"),
        (
            "[boundary]\nx_max = { attenuated_outlet = { density = 1.0, pressure = 1.0, attenuation = 2.0 } }\n",
            "attenuated_outlet.attenuation",
        ),
        ("[boundary]\nx_max = { far_field = { density = 1.0, pressure = 0.0 } }\n", "far_field.pressure"),
        (
            "[boundary]\nx_max = { patched = { patches = [{ shape = { sphere = { center = [0.5, 0.5], radius = 0.1 } }, \
             rule = \"outlet\" }] } }\n",
            "covers no face",
        ),
        ("[boundary]\nx_max = { patched = { base = \"periodic\", patches = [] } }\n", "boundary.x_max.patched.base"),
        ("[[probes]]\nname = \"p\"\nposition = [3.0, 0.5]\n", "probes[0].position"),
        ("[expect]\ndensity_l1 = 0.1\n", "expect.density_l1"),
        ("[expect]\nbodies = [{ body = \"x\", center = [0, 0], tolerance = 1 }]\n", "unknown body `x`"),
        ("[boundary]\nx_min = \"outlet\"\n[expect]\ngas_mass_drift = 0.1\n", "the domain is open"),
    ] {
        expect(&with(setting), &[], &[key]);
    }
    for (setting, key) in
        [("cfl = 2.0", "time.cfl"), ("frames = 0", "time.frames"), ("max_growth = 1.0", "time.max_growth")]
    {
        expect(&BASE.replace("until = 1.0", &format!("until = 1.0\n{setting}")), &[], &[key, "test.toml:11:"]);
    }
    expect(&BASE.replace("[gas]", "[gas]\ngamma = 1.0"), &[], &["gas.gamma", "test.toml:8:9"]);
}

#[test]
fn overrides_reach_every_kind_of_key() {
    let sphere = body("sphere = { center = [0.5, 0.5], radius = 0.2 }");
    let scene = parse(
        &sphere,
        &[
            "gas.ambient.density=2",
            "bodies.0.density = 3.5",
            "bodies[0].shape.sphere.radius=0.3",
            "title=a new title",
            "time.cfl=0.25",
            "domain.cells=[40, 20]",
        ],
    );
    assert_eq!(scene.gas.ambient.density, 2.0);
    assert_eq!((scene.bodies[0].density, scene.domain.cells), (Some(3.5), [40, 20, 1]));
    assert_eq!((scene.title.as_str(), scene.time.cfl), ("a new title", 0.25));
    assert_eq!(scene.bodies[0].shape.bounds().0[0], 0.2);
    assert_eq!(parse(BASE, &["boundary.x_min=outlet"]).boundary.x_min, crate::scene::Boundary::Outlet);
}

#[test]
fn overrides_have_their_own_place_in_messages() {
    expect(BASE, &["gas.ambient.density=-2"], &["--set:1:21", "gas.ambient.density", "-2 is not positive"]);
    expect(BASE, &["time.cfl=0.4", "time.ulti=2"], &["--set:1:", "unknown field `ulti`"]);
    expect(BASE, &["time.cfl=fast"], &["--set:1:10", "time.cfl", "invalid type"]);
    expect(BASE, &["time.cfl"], &["--set:1:1", "has no `=`"]);
    expect(BASE, &["=3"], &["--set:1:1", "names no key"]);
    expect(BASE, &["title.x=3"], &["--set:1:1", "inside a string"]);
    expect(BASE, &["probes[0].name=a"], &["--set"]);
    let sphere = body("sphere = { center = [0.5, 0.5], radius = 0.2 }");
    expect(&sphere, &["bodies[1].density=2"], &["--set:1:1", "no entry of a list of 1"]);
}

#[test]
fn file_that_does_not_exist() {
    let error = Scene::load("/no/such.toml", &[]).expect_err("there is no such file");
    assert_eq!(error.exit_code(), 9);
    assert!(error.to_string().contains("/no/such.toml"));
}

/// What is misspelt, missing or of a wrong type hides nothing else, and what stands for it is never complained of.
#[test]
fn every_mistake_is_told_at_once() {
    let text = BASE
        .replace("dimension", "dimensoin")
        .replace("density = 1.0, pressure", "density = -1.0, presure")
        .replace("neo_hookean = { young_modulus = 100.0", "neo_hokean = { young_modulus = -100.0")
        .replace("until = 1.0", "untill = 1.0\ncfl = \"x\"");
    let more = "[[bodies]]\nname = \"a\"\ndensity = -2.0\nshape = { qqqq = { radius = 1.0 } }\n\
                [[bodies]]\nname = \"b\"\nmaterial = \"ruber\"\ndensty = 1.0\n\
                shape = { sphere = { center = [0.5, 0.5], radius = -0.1 } }\n[render]\nmode = 3\nsize = [0, 64]\n";
    let wanted = [
        "domain.dimensoin: unknown field",
        "gas.ambient.density: -1",
        "gas.ambient.presure: unknown field",
        "materials.rubber: unknown variant `neo_hokean`; did you mean `neo_hookean`?",
        "materials.rubber.neo_hookean.young_modulus: -100",
        "time.untill: unknown field `untill`; did you mean `until`?",
        "time.cfl: invalid type: string",
        "bodies[0]: missing field `material`",
        "bodies[0].density: -2",
        "bodies[0].shape: unknown variant `qqqq`",
        "bodies[1].material: unknown material `ruber`; did you mean `rubber`?",
        "bodies[1].densty: unknown field",
        "bodies[1].shape.sphere.radius: -0.1",
        "render.mode: invalid type: integer",
        "render.size[0]: 0",
    ];
    let told = report(&format!("{text}{more}"), &[]);
    for words in wanted {
        assert!(told.contains(words), "no `{words}` in\n{told}");
    }
    assert!(told.ends_with(&format!("{} errors in this scene", wanted.len())), "{told}");
    // where the domain is not known, nothing is said of what lies in it, but all of what is wrong by itself
    let outside = "[[obstacles]]\nname = \"far\"\nshape = { sphere = { center = [9.0, 9.0], radius = 0.1 } }\n";
    let told = report(&format!("{}{outside}", text.replace("size = [2.0, 1.0]\n", "")), &[]);
    assert!(told.contains("missing field `size`") && !told.contains("obstacles[0]"), "{told}");
    assert!(told.contains("gas.ambient.density: -1") && told.contains("young_modulus: -100"), "{told}");
}

/// Nor does what no schema, but only the reader of a value refuses, or what names a thing that is not there.
#[test]
fn what_its_reader_refuses_hides_no_other_mistake() {
    let more = "[materials.broken]\nneo_hookean = { young_modulus = -1.0, poisson_ratio = 0.3 }\nfracture = {}\n\
                [materials.strong]\nneo_hookean = { young_modulus = -2.0, poisson_ratio = 0.3 }\nfracture = true\n\
                [materials.twice]\nneo_hookean = { young_modulus = -3.0, poisson_ratio = 0.3 }\nsteel = {}\n\
                [materials.none]\nfracture = false\n\
                [materials.scaled]\nsteel = { units = \"bar\", poisson_ratio = 0.7 }\n\
                [[bodies]]\nname = \"a\"\nmaterial = \"rubber\"\ndensity = -4.0\nspin = [1.0, 2.0]\nparticles_per_cell = -1\n\
                shape = { sphere = { center = [], radius = -0.1 }, box = { center = [1.0, 0.5], size = [0.1, 0.1] } }\n\
                [[bodies]]\nname = \"b\"\nmaterial = \"rubber\"\ndensity = -5.0\nshape = { use = { name = \"no such\" } }\n\
                [[bodies]]\nname = \"c\"\nmaterial = \"rubber\"\ndensity = -6.0\nshape = {}\n\
                [render]\nsize = [64, -64]\n[render.views.top]\nexposure = -7.0\n[numerics]\ntolerance = -8.0\n\
                [[obstacles]]\nname = \"far\"\nshape = { sphere = { center = [9.0, 9.0], radius = 0.1 } }\n";
    let wanted = [
        "materials.broken.neo_hookean.young_modulus: -1",
        "materials.broken.fracture: missing field `tensile_strength`",
        "materials.broken.fracture: missing field `fracture_energy`",
        "materials.strong.neo_hookean.young_modulus: -2",
        "materials.strong.fracture: true cannot stand here",
        "materials.twice.neo_hookean.young_modulus: -3",
        "materials.twice: `neo_hookean` and `steel`, of which one stands here",
        "materials.none: no key says what it is",
        "materials.scaled.steel.units: unknown variant `bar`",
        "materials.scaled.steel.poisson_ratio: 0.7",
        "bodies[0].density: -4",
        "bodies[0].spin: expected a number (about z) or three numbers",
        "bodies[0].particles_per_cell: invalid value: integer `-1`",
        "bodies[0].shape: `sphere` and `box`, of which one stands here",
        "bodies[0].shape.sphere.center: 0 entries in a scene of dimension 2",
        "bodies[0].shape.sphere.radius: -0.1",
        "bodies[1].density: -5",
        "bodies[1].shape.use.name: no shape `no such`",
        "bodies[2].density: -6",
        "bodies[2].shape: no key says what it is",
        "render.size[1]: invalid value: integer `-64`",
        "render.views.top.exposure: -7",
        "numerics.tolerance: -8",
        "time.until: 1e-39 is out of the range",
        "obstacles[0].shape: lies outside the domain",
    ];
    let text = format!("{}{more}", BASE.replace("until = 1.0", "until = 1e-39"));
    let findings = read(&mut Source::new(&text, "test.toml", &[]), &Changes::default(), u64::MAX).unwrap_err();
    let told: Vec<String> = findings.iter().map(|finding| format!("{}: {}", finding.path, finding.message)).collect();
    let all = told.join("\n");
    for words in wanted {
        assert!(told.iter().any(|own| own.starts_with(words)), "no `{words}` in\n{all}");
    }
    assert_eq!(told.len(), wanted.len(), "{all}");
}
