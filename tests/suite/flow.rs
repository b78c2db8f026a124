//! Flow stress by strain, rate and temperature: the return mapping against double precision, and bars against the law.

use brisance::gpu::{Buffer, Constants, Extent, Gpu, Kernel, Pass, readback};
use brisance::material::{Flow, Material, MaterialParams, VolumeShare, wgsl_includes, wgsl_switch};
use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::common::{gpu_or_skip, with_shaders};

/// A rod of constant volume is stretched in equal steps; what it bears, how it has flowed and how far it is to melting after each.
const ASK: &str = r#"
@group(0) @binding(0) var<storage, read> material: array<MaterialParams>;
@group(0) @binding(1) var<storage, read> given: array<vec4f>;        // stretch [1] and time [s] of a step, density
@group(0) @binding(2) var<storage, read_write> answers: array<vec4f>;

fn elongation(y: f32) -> vec3f { return vec3f(exp_minus_one(y), exp_minus_one(-0.5 * y), exp_minus_one(-0.5 * y)); }

@compute @workgroup_size(WORKGROUP)
fn ask(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let i = thread_index(group, lane);
    if i >= arrayLength(&given) { return; }
    let m = material[0];
    var h = mat3x3f();
    var flowed = 0.0;
    var heat = 0.0;
    for (var turn = 0u; turn < STEPS; turn++) {
        let heated = m.heating * heat / given[i].z;
        let step = diagonal(elongation(given[i].x));
        let trial = h + step + step * h;
        let kept = return_map(m.kind, trial, flowed, heated_metal(m, heated, given[i].y));
        flowed += kept.plastic_strain;
        heat += elastic_energy(m.kind, trial, m) - elastic_energy(m.kind, kept.deformation, m);
        h = kept.deformation;
        let l = logarithmic_strain(h);
        let size = 2.0 * m.mu * length(l.strain - vec3f((l.strain.x + l.strain.y + l.strain.z) / 3.0));
        answers[i * STEPS + turn] = vec4f(size, flowed, kept.plastic_strain, heated);
    }
}
"#;

const STEPS: usize = 400;

/// Steel 1006 by Johnson and Cook, in gigapascals, with a heat capacity so small that a stretch of a twentieth heats it by a sixth.
fn steel(kind: &str, flow: &str, more: &str) -> Material {
    let text = format!(
        "title = \"flow\"\n[domain]\ndimension = 1\ncells = [8]\nsize = [1.0]\n[gas]\nambient = {{ density = 1.0, pressure = 1.0 }}\n\
         [time]\nuntil = 1.0\n[materials.m]\n{kind} = {{ young_modulus = 200.0, poisson_ratio = 0.3, yield_stress = 0.286, hardening = 0.225 }}\n\
         flow = {{ exponent = 0.36, {flow} melting_temperature = 1811.0, heat_capacity = 1e-5 }}\n{more}\n"
    );
    Scene::parse(&text, "flow.toml", &[]).unwrap_or_else(|error| panic!("{error}")).materials["m"].clone()
}

fn ask(gpu: &Gpu, material: &Material, given: &[[f32; 4]]) -> Vec<[f32; 4]> {
    let overrides = [("DIM", 3.0), ("JOHNSON_COOK", 1.0), ("FRACTURE", 1.0)];
    let kernel = Kernel::new(gpu, "ask.wgsl", "ask", &Constants { overrides: &overrides, source: "" })
        .unwrap_or_else(|error| panic!("{error}"));
    let params = Buffer::<MaterialParams>::new(gpu, "material", 1).expect("memory");
    let cases = Buffer::<[f32; 4]>::new(gpu, "given", given.len()).expect("memory");
    let answers = Buffer::<[f32; 4]>::new(gpu, "answers", given.len() * STEPS).expect("memory");
    params.write(gpu, 0, &[material.params_with_fracture(VolumeShare::Split(0.0), 1.0)]);
    cases.write(gpu, 0, given);
    let names = [("material", params.raw()), ("given", cases.raw()), ("answers", answers.raw())];
    let mut pass = Pass::new(gpu, "ask");
    pass.dispatch(&kernel.bind(gpu, &names).expect("all names"), &Extent::Threads(given.len() as u64));
    pass.submit().expect("a device");
    readback::read(gpu, &answers).expect("a device")
}

/// Plastic strain at which voids join, under a von Mises stress of 1.
const ASK_VOIDS: &str = r#"
#include "materials/voids.wgsl"
override FRACTURE: bool;
const MOST_DRIVE = 1.0;     // of a function that nothing here calls

@group(0) @binding(0) var<storage, read> material: array<MaterialParams>;
@group(0) @binding(1) var<storage, read> given: array<vec4f>;        // mean stress, strain rate, way to melting
@group(0) @binding(2) var<storage, read_write> answers: array<vec4f>;

@compute @workgroup_size(WORKGROUP)
fn ask(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let i = thread_index(group, lane);
    if i >= arrayLength(&given) { return; }
    let stress = vec3f(given[i].x) + vec3f(2.0, -1.0, -1.0) / 3.0;
    answers[i] = vec4f(strain_of_voids(material[0], stress, given[i].y, given[i].z), 0.0, 0.0, 0.0);
}
"#;

#[test]
fn voids_join_by_tension_rate_and_temperature() {
    let text = format!("{ASK_VOIDS}\n{}\n{}", wgsl_includes(), wgsl_switch());
    let Some(gpu) = with_shaders(&[("ask.wgsl", &text)]) else { return };
    let voids = "fracture = { fracture_energy = 1.0, johnson_cook = { d1 = 0.05, d2 = 3.44, d3 = -2.12, d4 = 0.02, d5 = 0.61 } }";
    let metal = steel("von_mises", "rate = 0.022,", voids);
    let own = metal.fracture().and_then(|own| own.johnson_cook).expect("voids");
    let given = [
        [0.33, 0.1, 0.0, 0.0],
        [0.33, 0.1, 0.5, 0.0],
        [1.5, 1e4, 0.0, 0.0],
        [-0.2, 1e4, 1.0, 0.0],
        [9.0, 1.0, 0.2, 0.0],
    ];
    for (found, ask) in ask(&gpu, &metal, &given).iter().zip(given) {
        let [tension, rate, heated, _] = ask.map(f64::from);
        let expected = own.strain(tension, rate, heated);
        assert!((f64::from(found[0]) / expected - 1.0).abs() < 1e-4, "{} at {ask:?}, expected {expected}", found[0]);
    }
    assert_eq!(own.strain(-0.4, 1.0, 0.0), f64::INFINITY, "pressed by more than a rod");
}

/// Density of steel, and stretches with the times that they take: strain rates of 0.5 / s, where rate has no part, to 2e6 / s.
const DENSITY: f32 = 7.85;
const STRETCH: f32 = 1.25e-4;
const RATES: [f32; 4] = [0.5, 1e2, 1e4, 2e6];

#[test]
fn metals_flow_by_strain_rate_and_temperature() {
    let text = ASK.replace("STEPS", &format!("{STEPS}u"));
    let Some(gpu) = with_shaders(&[("ask.wgsl", &format!("{text}\n{}\n{}", wgsl_includes(), wgsl_switch()))]) else {
        return;
    };
    let given = RATES.map(|rate| [STRETCH, STRETCH / rate, DENSITY, 0.0]);
    for kind in ["von_mises", "hencky"] {
        let metal = steel(kind, "rate = 0.022,", "");
        let found = ask(&gpu, &metal, &given);
        for (own, [_, time, ..]) in found.chunks_exact(STEPS).zip(given) {
            for [size, flowed, step, heated] in own.iter().map(|answer| answer.map(f64::from)).skip(40) {
                let expected = metal.flow_stress(flowed, step / f64::from(time), heated);
                assert!((size / expected - 1.0).abs() < 2e-5, "{kind}: {size} at {flowed}, expected {expected}");
            }
        }
        // steps of a twentieth of the elastic strain book 3 % more heat than the curve has
        // the closed curve of a rod that is stretched at one rate: sqrt(3/2) of the deviator's length, at what is stretched plastically
        let slow = &found[STEPS - 1];
        let flow: &Flow = metal.flow().expect("flow");
        let total = f64::from(STRETCH) * STEPS as f64;
        let expected = adiabatic(flow, total, 1.0);
        assert!(
            (f64::from(slow[1]) - (total - expected[0] / STIFF)).abs() < 1e-4,
            "{kind}: plastic strain {}",
            slow[1]
        );
        assert!(
            (f64::from(slow[0]) * 1.5_f64.sqrt() / expected[0] - 1.0).abs() < 1e-2,
            "{kind}: {} {expected:?}",
            slow[0]
        );
        assert!((f64::from(slow[3]) / expected[1] - 1.0).abs() < 0.04, "{kind}: heated {} {expected:?}", slow[3]);
    }
}

/// Three times the shear modulus of the steel: stress of a rod of constant volume over its elastic strain.
const STIFF: f64 = 3.0 * 200.0 / 2.6;

/// Stress of a rod, and share of the way to melting, after a stretch: d heated = stress d strain / (density melting work).
fn adiabatic(flow: &Flow, total: f64, rate: f64) -> [f64; 2] {
    const PARTS: usize = 100_000;
    let [a, b] = [0.286, 0.225].map(|deviator| deviator * 1.5_f64.sqrt());
    let (mut heated, mut stress) = (0.0, a);
    // elastic strains, a thousandth, come off the plastic strain
    for part in 0..PARTS {
        let strain = (total - stress / STIFF) * (part as f64 + 0.5) / PARTS as f64;
        stress = (a + b * strain.powf(flow.exponent)) * flow.factor(rate, heated);
        heated += flow.heating() * stress * (total - stress / STIFF) / PARTS as f64 / f64::from(DENSITY);
    }
    [stress, heated]
}

/// Share of the way to melting of a metal of density 1 that has flowed by a strain at one rate or another.
fn heated_by(metal: &Material, strain: f64) -> f64 {
    const PARTS: i32 = 400;
    let heating = metal.flow().map_or(0.0, Flow::heating);
    let part = strain / f64::from(PARTS);
    (0..PARTS).fold(0.0, |heated, k| {
        heated + 1.5_f64.sqrt() * metal.flow_stress(part * (f64::from(k) + 0.5), 0.0, heated) * part * heating
    })
}

/// A bar that grips press along x, in one, two or three dimensions.
fn bar(axes: usize, more: &str) -> Scene {
    let list = |values: [f64; 3]| values[..axes].iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(", ");
    let cells = ["20", "6", "6"][..axes].join(", ");
    let grip = |name: &str, x: f64, speed: f64| {
        format!(
            "[[bodies]]\nname = \"{name}\"\nmaterial = \"grip\"\ndensity = 1.0\nmotion = {{ velocity = [{}] }}\n\
             shape = {{ box = {{ center = [{}], size = [{}] }} }}\n",
            list([speed, 0.0, 0.0]),
            list([x, 0.3, 0.3]),
            list([0.2, 0.4, 0.4])
        )
    };
    let text = format!(
        "title = \"bar\"\n[domain]\ndimension = {axes}\ncells = [{cells}]\nsize = [{}]\n[time]\nuntil = 20.0\n\
         [gas]\nambient = {{ density = 1e-6, pressure = 1e-10 }}\n{more}\n\
         [materials.grip]\nneo_hookean = {{ young_modulus = 1.0, poisson_ratio = 0.3 }}\n\
         [materials.m]\nvon_mises = {{ young_modulus = 1.0, poisson_ratio = 0.3, yield_stress = 1e-3, hardening = 1e-3 }}\n\
         flow = {{ exponent = 0.4, melting_temperature = 1293.0, heat_capacity = 4e-7, taylor_quinney = 1.0 }}\n{}{}\
         [[bodies]]\nname = \"bar\"\nmaterial = \"m\"\ndensity = 1.0\nshape = {{ box = {{ center = [{}], size = [{}] }} }}\n",
        list([2.0, 0.6, 0.6]),
        grip("left", 0.4, 1e-3),
        grip("right", 1.6, -1e-3),
        list([1.0, 0.3, 0.3]),
        list([1.0, 0.4, 0.4]),
    );
    Scene::parse(&text, "bar.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// Whatever the dimension and the form of the transfers, what flows bears the stress that its strain and the heat of its flow leave.
#[test]
fn pressed_bars_soften_by_the_heat_of_their_flow() {
    let Some(gpu) = gpu_or_skip() else { return };
    let nodes = "[numerics]\nexpert.transfer = \"nodes\"\n";
    for (axes, more) in [(1, ""), (1, nodes), (2, ""), (2, nodes), (3, ""), (3, nodes)] {
        let scene = bar(axes, more);
        let metal = scene.materials["m"].clone();
        let mut simulation = Simulation::new(&gpu, &scene).unwrap_or_else(|error| panic!("{error}"));
        simulation.advance_to(20.0).unwrap_or_else(|error| panic!("{error}"));
        let snapshot = simulation.snapshot().expect("a device");
        let (mut flowing, mut hottest) = (0, 0.0_f64);
        for own in snapshot.particles.iter().filter(|own| own.body == 2 && own.plastic_strain > 2e-3) {
            let s = own.stress.map(f64::from);
            let mean = (s[0] + s[1] + s[2]) / 3.0;
            let ring = [s[0] - mean, s[1] - mean, s[2] - mean].map(|x| x * x).iter().sum::<f64>();
            let size = (ring + 2.0 * s[3..].iter().map(|x| x * x).sum::<f64>()).sqrt() * f64::from(own.volume_ratio());
            let heated = heated_by(&metal, own.plastic_strain.into());
            let limit = metal.flow_stress(own.plastic_strain.into(), 0.0, heated);
            // the laws are linear in different strains: a hundredth of strain is a hundredth of stress
            assert!(size < 1.03 * limit, "{axes} axes, {more}: {size}, the law has {limit}");
            flowing += usize::from(size > 0.97 * limit);
            hottest = hottest.max(heated);
        }
        assert!(flowing > 5 && hottest > 0.05, "{axes} axes, {more}: {flowing} flow, heated {hottest}");
    }
}
