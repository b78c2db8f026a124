//! Laws of the solids on the device against their energies in double precision: stress, objectivity, plastic flow.

use brisance::gpu::{Buffer, Constants, Extent, Gpu, Kernel, Pass, readback};
use brisance::material::{KINDS, Material, VolumeShare, wgsl_includes, wgsl_switch};
use glam::{DMat3, DVec3};

use crate::common::{Random, with_shaders};
use reference::solid::material::eigen;

/// Asks a law for everything it knows of given displacement gradients F - I.
const ASK: &str = r#"
struct Answer { stress: mat3x3f, kept: mat3x3f, energy: f32, plastic_strain: f32, wave_speed: f32 }
@group(0) @binding(0) var<storage, read> material: array<MaterialParams>;
@group(0) @binding(1) var<storage, read> given: array<mat3x3f>;
@group(0) @binding(2) var<storage, read_write> answers: array<Answer>;
const HARDENED = 0.2;

@compute @workgroup_size(WORKGROUP)
fn ask(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let i = thread_index(group, lane);
    if i >= arrayLength(&given) { return; }
    let m = material[0];
    let kept = return_map(m.kind, given[i], HARDENED, m);
    answers[i] = Answer(kirchhoff_stress(m.kind, given[i], m), kept.deformation, elastic_energy(m.kind, given[i], m), kept.plastic_strain,
        wave_speed(m.kind, given[i], m, 1.0));
}
"#;

/// Equivalent plastic strain of all particles before the question.
const HARDENED: f64 = 0.2;

struct Answer {
    stress: DMat3,
    kept: DMat3,
    energy: f64,
    plastic_strain: f64,
    wave_speed: f64,
}

fn material(kind: &str, more: &[(&str, f64)]) -> Material {
    let given = [("young_modulus", 100.0), ("poisson_ratio", 0.3)];
    let given = given.iter().chain(more).map(|(name, value)| ((*name).to_owned(), *value)).collect::<Vec<_>>();
    Material::new(kind, &given).expect("all parameters are given")
}

/// One material of every kind.
fn all() -> Vec<Material> {
    let yields = |kind: &brisance::material::Kind| kind.parameters.iter().any(|p| p.name == "yield_stress");
    KINDS.iter().map(|kind| material(kind.name, if yields(kind) { YIELDS } else { &[] })).collect()
}

const YIELDS: &[(&str, f64)] = &[("yield_stress", 5.0), ("hardening", 20.0)];

fn columns(m: DMat3) -> [f32; 12] {
    let column = |v: DVec3| [v.x as f32, v.y as f32, v.z as f32, 0.0];
    let [a, b, c] = [m.x_axis, m.y_axis, m.z_axis].map(column);
    [a, b, c].concat().try_into().expect("three columns of four")
}

fn asked() -> Option<Gpu> {
    with_shaders(&[("ask.wgsl", &format!("{ASK}\n{}\n{}", wgsl_includes(), wgsl_switch()))])
}

fn ask(gpu: &Gpu, material: &Material, given: &[DMat3]) -> Vec<Answer> {
    let kernel = Kernel::new(gpu, "ask.wgsl", "ask", &Constants { overrides: &[("DIM", 3.0)], source: "" })
        .unwrap_or_else(|error| panic!("{error}"));
    let params = Buffer::<brisance::material::MaterialParams>::new(gpu, "material", 1).expect("memory");
    let matrices = Buffer::<f32>::new(gpu, "given", 12 * given.len()).expect("memory");
    let answers = Buffer::<f32>::new(gpu, "answers", 28 * given.len()).expect("memory");
    params.write(gpu, 0, &[material.params(VolumeShare::Split(0.0))]);
    matrices.write(gpu, 0, &given.iter().flat_map(|f| columns(*f - DMat3::IDENTITY)).collect::<Vec<_>>());
    let names = [("material", params.raw()), ("given", matrices.raw()), ("answers", answers.raw())];
    let mut pass = Pass::new(gpu, "ask");
    pass.dispatch(&kernel.bind(gpu, &names).expect("all names"), &Extent::Threads(given.len() as u64));
    pass.submit().expect("a device");
    let found = readback::read(gpu, &answers).expect("a device");
    let matrix = |at: &[f32]| {
        let column = |k: usize| DVec3::new(at[4 * k].into(), at[4 * k + 1].into(), at[4 * k + 2].into());
        DMat3::from_cols(column(0), column(1), column(2))
    };
    let answer = |at: &[f32]| Answer {
        stress: matrix(at),
        kept: DMat3::IDENTITY + matrix(&at[12..]),
        energy: at[24].into(),
        plastic_strain: at[25].into(),
        wave_speed: at[26].into(),
    };
    found.chunks_exact(28).map(answer).collect()
}

fn rotation(random: &mut Random) -> DMat3 {
    let mut angle = || f64::from(random.between(-3.0, 3.0));
    DMat3::from_euler(glam::EulerRot::XYZ, angle(), angle(), angle())
}

/// Stretches with strains up to `size`; small ones without rotation, large ones turned.
fn gradients(size: f64, count: usize) -> Vec<DMat3> {
    let mut random = Random(7);
    let one = |_| {
        let first = rotation(&mut random);
        let second = if size < 0.01 { first.transpose() } else { rotation(&mut random) };
        let mut stretch = || 1.0 + size * f64::from(random.between(-1.0, 1.0));
        let diagonal = DMat3::from_diagonal(DVec3::new(stretch(), stretch(), stretch()));
        // as the device gets it
        let f = first * diagonal * second;
        DMat3::from_cols_array(&f.to_cols_array().map(|x| f64::from(x as f32)))
    };
    (0..count).map(one).collect()
}

/// Principal logarithmic strains of F, with the axes of F F^T.
fn logarithmic(f: DMat3) -> (DVec3, DMat3) {
    let (squares, axes) = eigen(f * f.transpose());
    (DVec3::new(squares.x.ln(), squares.y.ln(), squares.z.ln()) * 0.5, axes)
}

/// Energies per reference volume as the budgets have them, in double precision.
fn energy(material: &Material, f: DMat3) -> f64 {
    let (mu, lambda) = (material.mu(), material.lambda());
    let (strain, _) = logarithmic(f);
    let volume = strain.element_sum();
    match material.kind().name {
        "neo_hookean" | "von_mises" => {
            let square: f64 = f.to_cols_array().iter().map(|x| x * x).sum();
            0.5 * mu * (square - 3.0) - mu * volume + 0.5 * lambda * volume * volume
        }
        "fixed_corotated" => {
            let stretch = DVec3::new(strain.x.exp_m1(), strain.y.exp_m1(), strain.z.exp_m1());
            mu * stretch.length_squared() + 0.5 * lambda * (f.determinant() - 1.0).powi(2)
        }
        "hencky" | "drucker_prager" => mu * strain.length_squared() + 0.5 * lambda * volume * volume,
        other => panic!("no energy for {other}"),
    }
}

/// Kirchhoff stress: (d psi / d F) F^T by central differences of fourth order.
fn stress(material: &Material, f: DMat3) -> DMat3 {
    let mut slope = DMat3::ZERO;
    for column in 0..3 {
        for row in 0..3 {
            let at = |step: f64| {
                let mut moved = f;
                moved.col_mut(column)[row] += step;
                energy(material, moved)
            };
            let h = 1e-3;
            slope.col_mut(column)[row] = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
        }
    }
    slope * f.transpose()
}

fn largest(m: DMat3) -> f64 {
    m.to_cols_array().iter().fold(0.0, |most, x| most.max(x.abs()))
}

#[test]
fn stress_is_the_derivative_of_energy() {
    let Some(gpu) = asked() else { return };
    for material in all() {
        for (size, of_stress, of_energy) in [(0.3, 2e-5, 2e-5), (1e-3, 3e-4, 1e-3)] {
            let given = gradients(size, 40);
            for (f, found) in given.iter().zip(ask(&gpu, &material, &given)) {
                let (expected, psi) = (stress(&material, *f), energy(&material, *f));
                let scale = (material.lambda() + 2.0 * material.mu()) * size;
                let off = largest(found.stress - expected) / scale;
                let energy_off = (found.energy - psi).abs() / (scale * size);
                let name = material.kind().name;
                assert!(off < of_stress && energy_off < of_energy, "{name} {size}: {off} {energy_off}");
            }
        }
    }
}

/// rho c^2 of a plane wave in a deformed body: the second derivative of the energy of (I + s m n^T) F, n its direction, m its motion.
fn stiffness(material: &Material, f: DMat3, n: DVec3, m: DVec3) -> f64 {
    let at = |s: f64| energy(material, (DMat3::IDENTITY + s * DMat3::from_cols(m * n.x, m * n.y, m * n.z)) * f);
    let h = 1e-3;
    (16.0 * (at(h) + at(-h)) - (at(2.0 * h) + at(-2.0 * h)) - 30.0 * at(0.0)) / (12.0 * h * h)
}

#[test]
fn no_wave_in_a_deformed_body_is_faster_than_the_law_says() {
    let Some(gpu) = asked() else { return };
    let mut random = Random(11);
    let mut given = gradients(0.5, 40);
    given.push(DMat3::IDENTITY);
    for material in all() {
        let name = material.kind().name;
        for (f, found) in given.iter().zip(ask(&gpu, &material, &given)) {
            let (_, axes) = logarithmic(*f);
            let turned = (0..20).map(|_| rotation(&mut random)).chain([axes]).collect::<Vec<_>>();
            let pairs = turned.iter().flat_map(|r| [0, 1, 2].map(|n| [0, 1, 2].map(|m| (r.col(n), r.col(m)))));
            let fastest = pairs.flatten().map(|(n, m)| stiffness(&material, *f, n, m)).fold(0.0, f64::max);
            let share = found.wave_speed.powi(2) / fastest;
            assert!(share > 1.0 - 1e-3 && share < 3.0, "{name} {f}: {share}");
            let rest = material.lambda() + 2.0 * material.mu();
            assert!(*f != DMat3::IDENTITY || (found.wave_speed.powi(2) / rest - 1.0).abs() < 1e-5, "{name} at rest");
        }
    }
}

#[test]
fn laws_do_not_see_rotations() {
    let Some(gpu) = asked() else { return };
    let turn = rotation(&mut Random(3));
    let given = gradients(0.3, 40);
    let turned = given.iter().map(|f| turn * *f).collect::<Vec<_>>();
    for material in all() {
        let pairs = ask(&gpu, &material, &given).into_iter().zip(ask(&gpu, &material, &turned));
        for (a, b) in pairs {
            let off = largest(turn * a.stress * turn.transpose() - b.stress) / material.mu();
            let kept = largest(turn * a.kept - b.kept);
            let name = material.kind().name;
            assert!(
                off < 3e-5 && kept < 1e-5 && (a.energy - b.energy).abs() < 1e-5 * material.mu(),
                "{name}: {off} {kept}"
            );
        }
    }
}

/// Length of the deviator and trace of the stress that is linear in the logarithmic strain.
fn shear_and_trace(material: &Material, f: DMat3) -> [f64; 2] {
    let (strain, _) = logarithmic(f);
    let volume = strain.element_sum();
    let bulk = 3.0 * material.lambda() + 2.0 * material.mu();
    [2.0 * material.mu() * (strain - DVec3::splat(volume / 3.0)).length(), bulk * volume]
}

#[test]
fn metals_flow_down_to_the_grown_yield_stress() {
    let Some(gpu) = asked() else { return };
    for kind in ["von_mises", "hencky"] {
        let metal = material(kind, YIELDS);
        let given = gradients(0.3, 60);
        let answers = ask(&gpu, &metal, &given);
        assert!(answers.iter().any(|found| found.plastic_strain > 0.0));
        for (f, found) in given.iter().zip(answers) {
            let [before, _] = shear_and_trace(&metal, *f);
            let [after, _] = shear_and_trace(&metal, found.kept);
            let grown = 5.0 + 20.0 * (HARDENED + found.plastic_strain);
            let expected = if before > 5.0 + 20.0 * HARDENED { grown } else { before };
            assert!((after / expected - 1.0).abs() < 1e-4, "{kind}: {before} -> {after}, expected {expected}");
            let lost = (before - after) / (2.0 * metal.mu()) * (2.0_f64 / 3.0).sqrt();
            assert!((lost - found.plastic_strain).abs() < 2e-6, "{kind}: strain {lost} {}", found.plastic_strain);
            assert!((found.kept.determinant() / f.determinant() - 1.0).abs() < 1e-5, "volume stays");
        }
    }
}

/// Squares of such strains are below the smallest numbers of single precision.
#[test]
fn the_slightest_strains_are_no_fault() {
    let Some(gpu) = asked() else { return };
    let strained = |step: i32| {
        let e = 10.0_f64.powf(-0.05 * f64::from(step));
        DMat3::from_cols(DVec3::X, DVec3::new(e, 1.0, 2.0 * e), DVec3::new(3.0 * e, 0.0, 1.0))
    };
    let given: Vec<DMat3> = (300..600).map(strained).collect();
    for material in all() {
        for (f, found) in given.iter().zip(ask(&gpu, &material, &given)) {
            assert!(found.kept.is_finite() && found.stress.is_finite(), "{material:?}: {f} became {}", found.kept);
            assert!(largest(found.kept - *f) < 1e-6, "{material:?}: {f} became {}", found.kept);
            assert!(largest(found.stress) < 1e-3 && found.energy.abs() < 1e-6, "{material:?}: {f}");
        }
    }
}

#[test]
fn soil_bears_pressure_by_friction_and_no_tension() {
    let Some(gpu) = asked() else { return };
    for cohesion in [0.0, 2.0] {
        let soil = material("drucker_prager", &[("friction_angle", 35.0), ("cohesion", cohesion)]);
        let given = gradients(0.2, 80);
        let (mut slid, mut opened) = (0, 0);
        for (f, found) in given.iter().zip(ask(&gpu, &soil, &given)) {
            let [before, trace] = shear_and_trace(&soil, *f);
            let [after, pull] = shear_and_trace(&soil, found.kept);
            // Mohr-Coulomb in triaxial compression: (1 - sin) s1 - (1 + sin) s3 = 2 c cos, written for the two invariants
            let (sine, cosine) = 35.0_f64.to_radians().sin_cos();
            let cone =
                |trace: f64| 2.0 * (2.0_f64 / 3.0).sqrt() / (3.0 - sine) * (3.0 * cohesion * cosine - sine * trace);
            let tip = 3.0 * cohesion * cosine / sine;
            let tolerance = 1e-3 * soil.mu();
            if trace > tip {
                opened += 1;
                assert!(after < tolerance && (pull - tip).abs() < tolerance, "opens at the tip: {after} {pull} {tip}");
            } else {
                slid += i32::from(before > cone(trace));
                assert!(
                    (after - before.min(cone(trace))).abs() < tolerance,
                    "{before} -> {after}, cone {}",
                    cone(trace)
                );
                assert!((pull - trace).abs() < tolerance, "volume stays");
            }
        }
        assert!(slid > 5 && opened > 5, "{slid} {opened}");
    }
}
