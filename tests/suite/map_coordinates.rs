//! Scenes in map coordinates, millions of metres from zero, are the same scenes near zero: to the bit where single precision holds all
//! distances, and told in the coordinates of the scene.

use std::path::{Path, PathBuf};

use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::cli::{succeeds, table};
use crate::common::{folder_or_skip, gpu_or_skip, read_png};

/// Far away on a map; all lengths of the scene are multiples of a sixteenth, so their sums with it are exact.
const FAR: [f64; 3] = [5.0e6, -3.0e6, 1.0e6];

/// A shock, a block that turns about a point, a free block, an obstacle, gauges and a camera, all moved by `by`.
fn plane(by: [f64; 3]) -> String {
    let at = |x: f64, y: f64| format!("[{:?}, {:?}]", by[0] + x, by[1] + y);
    let eye = |z: f64| format!("[{:?}, {:?}, {z:?}]", by[0] + 1.0, by[1] + 0.5);
    [
        "title = \"map\"\n[domain]\ndimension = 2\ncells = [64, 32]\nsize = [2.0, 1.0]\n".to_owned(),
        format!("origin = {}\n[gas]\nambient = {{ density = 1.0, pressure = 1.0 }}\n", at(0.0, 0.0)),
        format!("[[gas.regions]]\nshape = {{ half_space = {{ point = {}, normal = [1.0, 0.0] }} }}\n", at(0.5, 0.0)),
        "density = 3.0\npressure = 4.0\n[materials.rubber.neo_hookean]\nyoung_modulus = 100.0\npoisson_ratio = 0.3\n"
            .to_owned(),
        "[[bodies]]\nname = \"free\"\nmaterial = \"rubber\"\ndensity = 5.0\n".to_owned(),
        format!("shape = {{ box = {{ center = {}, size = [0.25, 0.25] }} }}\n", at(0.875, 0.5)),
        "[[bodies]]\nname = \"wheel\"\nmaterial = \"rubber\"\ndensity = 5.0\n".to_owned(),
        format!("shape = {{ box = {{ center = {}, size = [0.25, 0.25] }} }}\n", at(1.5, 0.75)),
        format!("motion = {{ spin = [0.0, 0.0, 2.0], about = {} }}\n", at(1.5, 0.75)),
        "[[obstacles]]\nname = \"post\"\n".to_owned(),
        format!("shape = {{ box = {{ center = {}, size = [0.25, 0.25] }} }}\n", at(1.5, 0.125)),
        format!("[[probes]]\nname = \"p\"\nposition = {}\n", at(1.25, 0.5)),
        format!("[[gauges]]\nname = \"post\"\nobstacle = \"post\"\nabout = {}\n", at(1.5, 0.125)),
        format!("[[gauges]]\nname = \"corner\"\nbody = \"free\"\npoint = {}\n", at(0.9375, 0.5625)),
        "[time]\nuntil = 0.25\nframes = 2\n[output]\nfields = [\"density\"]\n[render]\nsize = [320, 180]\n".to_owned(),
        format!("[render.camera]\neye = {}\ntarget = {}\nup = [0.0, 1.0, 0.0]\nheight = 0.75\n", eye(2.0), eye(0.0)),
    ]
    .concat()
}

/// A ball and an obstacle in space.
fn space(by: [f64; 3]) -> String {
    let at = |x: f64, y: f64, z: f64| format!("[{:?}, {:?}, {:?}]", by[0] + x, by[1] + y, by[2] + z);
    [
        "title = \"map\"\n[domain]\ndimension = 3\ncells = [16, 8, 8]\nsize = [2.0, 1.0, 1.0]\n".to_owned(),
        format!("origin = {}\n[gas]\nambient = {{ density = 1.0, pressure = 1.0 }}\n", at(0.0, 0.0, 0.0)),
        "[materials.rubber.neo_hookean]\nyoung_modulus = 100.0\npoisson_ratio = 0.3\n".to_owned(),
        "[[bodies]]\nname = \"ball\"\nmaterial = \"rubber\"\ndensity = 5.0\n".to_owned(),
        format!("shape = {{ sphere = {{ center = {}, radius = 0.25 }} }}\n", at(0.5, 0.5, 0.5)),
        "[[obstacles]]\nname = \"post\"\n".to_owned(),
        format!("shape = {{ box = {{ center = {}, size = [0.5, 0.5, 0.5] }} }}\n", at(1.5, 0.5, 0.5)),
        "[time]\nuntil = 0.001\nframes = 1\n[output]\nfields = []\n[render]\nsize = [160, 90]\n".to_owned(),
    ]
    .concat()
}

/// Runs a scene from a file into a folder beside it.
fn run(folder: &Path, name: &str, text: &str, export: &str) -> PathBuf {
    let (scene, out) = (folder.join(format!("{name}.toml")), folder.join(name));
    std::fs::write(&scene, text).unwrap();
    succeeds(&["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap(), "--export", export]);
    out
}

#[test]
fn every_bit_of_the_device_is_that_near_zero() {
    let Some(gpu) = gpu_or_skip() else { return };
    let of = |by: [f64; 3]| {
        let scene = Scene::parse(&plane(by), "map.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
        let mut simulation = Simulation::new(&gpu, &scene).unwrap();
        let records = simulation.advance_to(0.25).unwrap();
        (simulation.snapshot().unwrap(), records)
    };
    let ((near, steps), (far, far_steps)) = (of([0.0; 3]), of(FAR));
    assert_eq!(near.grid.origin, far.grid.origin);
    assert_eq!(far.grid.low(), [FAR[0], FAR[1], 0.0]);
    // as text, where a velocity in covered cells that is no number equals itself
    assert!(format!("{:?}", near.particles) == format!("{:?}", far.particles), "particles");
    assert!(format!("{:?}", near.velocity) == format!("{:?}", far.velocity), "gas");
    assert!(steps == far_steps, "records of steps");
    let particle = &far.particles[0];
    let place = far.place_of(particle);
    assert!((0..2).all(|axis| place[axis] == FAR[axis] + f64::from(particle.position[axis])), "{place:?}");
    assert!(
        far.gas_at([FAR[0] + 1.25, FAR[1] + 0.5]) == near.gas_at([1.25, 0.5]) && near.gas_at([1.25, 0.5]).is_some()
    );
}

/// Tables differ by where the scene lies alone; pictures not at all.
#[test]
fn tables_and_pictures_tell_where_it_is() {
    let Some(folder) = folder_or_skip() else { return };
    let [near, far] =
        [("near", [0.0; 3]), ("far", FAR)].map(|(name, by)| run(folder.path(), name, &plane(by), "npz,vtk"));
    for name in ["diagnostics.csv", "probes.csv"] {
        assert_eq!(std::fs::read(near.join(name)).unwrap(), std::fs::read(far.join(name)).unwrap(), "{name}");
    }
    for name in ["gauges.csv", "bodies.csv", "obstacles.csv"] {
        let ((columns, rows), (_, others)) = (table(&near.join(name)), table(&far.join(name)));
        let column = |name: &str| columns.iter().position(|own| own == name);
        let force = ["x", "y"].map(|axis| column(&format!("force_{axis}")).or(column(&format!("gas_force_{axis}"))));
        for (row, other) in rows.iter().zip(&others) {
            for ((column, a), b) in columns.iter().zip(row).zip(other) {
                let moved = match (column.as_str(), name, force) {
                    ("x" | "min_x" | "max_x", ..) => FAR[0],
                    ("y" | "min_y" | "max_y", ..) => FAR[1],
                    ("moment_z" | "gas_moment_z", "bodies.csv" | "obstacles.csv", [Some(x), Some(y)]) => {
                        FAR[0] * row[y] - FAR[1] * row[x]
                    }
                    _ => 0.0,
                };
                let near = (a + moved - b).abs() <= 1e-6 * a.abs() + 1e-12 * moved.abs() || a.is_nan() && b.is_nan();
                assert!(near, "{name}, {column}: {a} moved by {moved} is not {b}");
            }
        }
    }
    for frame in ["frames/0000.png", "frames/0002.png"] {
        assert!(read_png(&near.join(frame)).1 == read_png(&far.join(frame)).1, "{frame}");
    }
    let head = |path: PathBuf| String::from_utf8_lossy(&std::fs::read(path).unwrap()).into_owned();
    assert!(head(far.join("fields/0002.vti")).contains("Origin=\"5000000.0 -3000000.0 0.0\""));
    assert!(head(far.join("particles/0002.vtp")).contains("type=\"Float64\" Name=\"Points\""));
    assert!(head(near.join("particles/0002.vtp")).contains("type=\"Float32\" Name=\"Points\""));
}

/// Meshes have their places as doubles; points of a stage are moved as a whole.
#[test]
fn meshes_and_stages_lie_where_the_scene_does() {
    let Some(folder) = folder_or_skip() else { return };
    let [near, far] =
        [("near", [0.0; 3]), ("far", FAR)].map(|(name, by)| run(folder.path(), name, &space(by), "mesh,usd"));
    for name in ["0001.ply", "obstacles.ply"] {
        let [one, two] = [&near, &far].map(|run| corners(&run.join("mesh").join(name)));
        assert!(one.len() == two.len() && one.len() > 20, "{name}");
        let apart = |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|k| (a[k] + FAR[k] - b[k]).abs()).fold(0.0, f64::max);
        let most = one.iter().zip(&two).map(apart).fold(0.0, f64::max);
        assert!(most < 1e-6, "{name}: {most}");
    }
    let stage = std::fs::read_to_string(far.join("stage.usda")).unwrap();
    assert!(stage.contains("double3 xformOp:translate = (5000000.0, -3000000.0, 1000000.0)"), "{stage}");
    assert!(!std::fs::read_to_string(near.join("stage.usda")).unwrap().contains("translate = (5"));
}

/// Places of the corners of a binary PLY file, whose first three properties they are.
fn corners(path: &Path) -> Vec<[f64; 3]> {
    let bytes = std::fs::read(path).unwrap();
    let end = bytes.windows(11).position(|window| window == b"end_header\n").unwrap() + 11;
    let head = String::from_utf8_lossy(&bytes[..end]).into_owned();
    let count: usize = head.lines().find_map(|line| line.strip_prefix("element vertex ")).unwrap().parse().unwrap();
    let own = head.split("element face").next().unwrap();
    let sizes = own.lines().filter_map(|line| line.strip_prefix("property "));
    let size: usize = sizes.map(|line| if line.starts_with("double") { 8 } else { 4 }).sum();
    let double = own.contains("property double x");
    let number = |at: usize, axis: usize| {
        if double {
            f64::from_le_bytes(bytes[at + 8 * axis..][..8].try_into().unwrap())
        } else {
            f64::from(f32::from_le_bytes(bytes[at + 4 * axis..][..4].try_into().unwrap()))
        }
    };
    (0..count).map(|k| std::array::from_fn(|axis| number(end + size * k, axis))).collect()
}
