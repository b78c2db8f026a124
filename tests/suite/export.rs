//! VTK files: the head, the offsets and the raw bytes agree with the snapshot.

use std::path::Path;

use brisance::export::{self, Moment, Needs, Origin};
use brisance::scene::Scene;
use brisance::snapshot::{ParticleSample, Snapshot, kind};
use brisance::state::Grid;

use crate::cli::{fails, succeeds};

fn snapshot(dimension: u32) -> Snapshot {
    let cells = std::array::from_fn(|axis| if (axis as u32) < dimension { 4 + axis as u32 } else { 1 });
    let grid = Grid { dimension, cells, frame: [0.0; 3], origin: [0.5, 1.0, 1.5], spacing: 0.25 };
    let count = grid.cell_count();
    let number = |index: usize| index as f32;
    let mut kinds = vec![kind::GAS; count];
    kinds[1] = kind::SOLID;
    let particle = |index: usize| ParticleSample {
        index: index as u32,
        position: [number(index), 0.5, 0.25],
        velocity: [1.0, number(index), 3.0],
        mass: 2.0,
        volume0: 0.5,
        ghost_pressure: -4.0,
        plastic_strain: 0.125,
        deformation: [[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.5]],
        body: index as u32,
        material: 1,
        ..ParticleSample::default()
    };
    Snapshot {
        time: 0.1,
        step: 3,
        grid,
        gases: brisance::scene::EquationOfState { gamma: 1.4, species: None },
        fire: brisance::scene::Fire::default(),
        laws: brisance::material::Laws::default(),
        kind: kinds,
        density: (0..count).map(number).collect(),
        velocity: (0..count).map(|index| [number(index), 10.0, -1.0]).collect(),
        pressure: vec![1.0; count],
        energy: vec![2.5; count],
        species: Vec::new(),
        owed: (0..count).map(|index| 0.5 * number(index)).collect(),
        maps: Vec::new(),
        dust: Vec::new(),
        particles: (0..5).map(particle).collect(),
    }
}

/// The bytes of one array of an appended file with compressed blocks.
fn raw(file: &Path, name: &str) -> Vec<u8> {
    let bytes = std::fs::read(file).unwrap();
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let start = bytes.windows(mark.len()).position(|window| window == mark).unwrap() + mark.len();
    let head = std::str::from_utf8(&bytes[..start]).unwrap();
    let entry = head.lines().find(|line| line.contains(&format!("Name=\"{name}\""))).unwrap();
    let offset: usize = entry.split("offset=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
    let word = |index: usize| {
        let at = start + offset + 8 * index;
        u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap()) as usize
    };
    let mut at = start + offset + 8 * (3 + word(0));
    let mut raw = Vec::new();
    for block in 0..word(0) {
        let stream = &bytes[at..at + word(3 + block)];
        std::io::Read::read_to_end(&mut flate2::read::ZlibDecoder::new(stream), &mut raw).unwrap();
        at += stream.len();
    }
    raw
}

/// The same as numbers.
fn array(file: &Path, name: &str) -> Vec<f32> {
    raw(file, name).chunks_exact(4).map(|word| f32::from_le_bytes(word.try_into().unwrap())).collect()
}

#[test]
fn vtk_files_hold_the_snapshot() {
    for (dimension, extent) in [(1, "0 4 0 0 0 0"), (2, "0 4 0 5 0 0"), (3, "0 4 0 5 0 6")] {
        // Kept after the test, for VTK's own reader.
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("vtk_{dimension}d"));
        let snapshot = snapshot(dimension);
        let mut exporters = export::open(&["vtk".to_owned()], &folder).unwrap();
        for index in 0..2 {
            let time = 0.1 * f64::from(index);
            let origin = Origin { title: "t".to_owned(), hash: String::new(), ..Origin::default() };
            let snapshot = Some(&snapshot);
            let moment = Moment { index, origin: &origin, time, step: 3, pictures: &[], snapshot, stored: None };
            assert_eq!(Needs::of(&exporters), Needs { snapshot: true, cells: true, ..Needs::default() });
            exporters[0].write(&moment).unwrap();
        }
        let fields = folder.join("fields/0001.vti");
        let head = String::from_utf8_lossy(&std::fs::read(&fields).unwrap()).into_owned();
        assert!(head.contains(&format!("WholeExtent=\"{extent}\"")), "{dimension}D");
        let density = array(&fields, "density");
        assert!(density[..2] == [0.0, 0.0] && density[2..] == snapshot.density[2..]);
        assert_eq!(raw(&fields, "vtkGhostType")[..3], [0, 32, 0], "the solid cell is hidden");
        assert_eq!(array(&fields, "velocity")[6..9], [2.0, 10.0, -1.0]);
        let particles = folder.join("particles/0001.vtp");
        assert_eq!(array(&particles, "J"), [3.0; 5]);
        assert_eq!(array(&particles, "volume"), [1.5; 5]);
        assert_eq!(array(&particles, "Points")[3..6], [1.0, 0.5, 0.25]);
        let series = std::fs::read_to_string(folder.join("particles.pvd")).unwrap();
        assert!(series.contains("timestep=\"0.1\" group=\"\" part=\"0\" file=\"particles/0001.vtp\""));
    }
}

/// A bar of particles, whose right half has gone `gap` cells away.
fn bar(gap: f32) -> Snapshot {
    let mut state = snapshot(3);
    state.grid = Grid { dimension: 3, cells: [16, 8, 8], frame: [0.0; 3], origin: [0.0; 3], spacing: 0.5 };
    let particle = |k: usize| {
        let [x, y, z] = [k % 8, k / 8 % 4, k / 32].map(|x| x as f32);
        let away = if k % 8 < 4 { 0.0 } else { 0.5 * gap };
        ParticleSample {
            index: k as u32,
            position: [0.25 * x + 0.6 + away, 0.25 * y + 1.1, 0.25 * z + 1.1],
            velocity: [away, 0.0, 0.0],
            volume0: 0.015625,
            deformation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            body: 0,
            ..state.particles[0]
        }
    };
    state.particles = (0..128).map(particle).collect();
    state
}

#[test]
fn pieces_have_surfaces_numbers_and_parents() {
    let text = "title = \"t\"\ndomain = { dimension = 3, cells = [16, 8, 8], size = [8.0, 4.0, 4.0] }\ntime = { until = 1.0, frames = 1 }\n\
        gas = { ambient = { density = 1.0, pressure = 1.0 } }\n[[obstacles]]\nname = \"ball\"\n\
        shape = { sphere = { center = [6.0, 2.0, 2.0], radius = 1.0 } }\n";
    let origin = Origin::of(&Scene::parse(text, "t.toml", &[]).unwrap());
    let folder = tempfile::tempdir().unwrap();
    let mesh = ["mesh".to_owned()];
    let write = |exporter: &mut Box<dyn export::Exporter>, index: u32, state: &Snapshot| {
        let (pictures, snapshot, stored) = (&[][..], Some(state), None);
        exporter.write(&Moment { index, origin: &origin, time: f64::from(index), step: 0, pictures, snapshot, stored })
    };
    let rows = |index: u32| {
        let text = std::fs::read_to_string(folder.path().join(format!("mesh/{index:04}.csv"))).unwrap();
        let row = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        text.lines().skip(1).map(row).collect::<Vec<_>>()
    };
    let mut exporters = export::open(&mesh, folder.path()).unwrap();
    for (index, gap) in [(0, 0.0), (1, 0.1), (2, 4.0)] {
        write(&mut exporters[0], index, &bar(gap)).unwrap();
    }
    assert_eq!(rows(0).iter().map(|row| row[..2].join(" ")).collect::<Vec<_>>(), ["0 -"]);
    assert_eq!(rows(1).iter().map(|row| row[..2].join(" ")).collect::<Vec<_>>(), ["0 0"]);
    let split = rows(2);
    assert_eq!(split.iter().map(|row| row[..2].join(" ")).collect::<Vec<_>>(), ["0 0", "4 0"]);
    let number = |row: usize, column: usize| split[row][column].parse::<f64>().unwrap();
    // 1 x 1 x 1 m each, moving with 0 and 2 m/s; edges of a body of four particles are round
    assert!((0..2).all(|row| (14..17).all(|k| (number(row, k) - 1.0).abs() < 1e-5)), "{split:?}");
    assert!((0..2).all(|row| (number(row, 17) - 0.85).abs() < 0.02) && (number(1, 8) - 2.0).abs() < 1e-6, "{split:?}");
    let head = std::fs::read(folder.path().join("mesh/0002.ply")).unwrap();
    let head = String::from_utf8_lossy(&head[..600]).into_owned();
    assert!(
        head.starts_with("ply\nformat binary_little_endian 1.0\n") && head.contains("property uint piece"),
        "{head}"
    );
    assert!(folder.path().join("mesh/obstacles.ply").is_file());
    // a run that goes on knows where pieces come from
    let whole = std::fs::read(folder.path().join("mesh/0002.csv")).unwrap();
    std::fs::remove_file(folder.path().join("mesh/0002.csv")).unwrap();
    let mut again = export::open(&mesh, folder.path()).unwrap();
    again[0].go_on(2, &|index| f64::from(index)).unwrap();
    write(&mut again[0], 2, &bar(4.0)).unwrap();
    assert_eq!(std::fs::read(folder.path().join("mesh/0002.csv")).unwrap(), whole);
    std::fs::write(folder.path().join("mesh/0001.npy"), "cut").unwrap();
    again[0].go_on(2, &|index| f64::from(index)).unwrap();
    let error = write(&mut again[0], 2, &bar(4.0)).unwrap_err();
    assert!(error.exit_code() == 6 && error.to_string().contains("0001.npy"), "{error}");
    let error = write(&mut again[0], 3, &snapshot(2)).unwrap_err();
    assert!(error.exit_code() == 2 && error.to_string().contains("three dimensions"), "{error}");
}

#[test]
fn unknown_format_lists_the_known_ones() {
    let error = export::open(&["gif".to_owned()], Path::new("out")).err().unwrap();
    assert_eq!(
        error.to_string(),
        "no export format `gif`; there are: png, png16, exr, fields, vtk, vdb, usd, mesh, npz"
    );
    assert_eq!(error.exit_code(), 2);
}

/// A shell in space, and the size of pictures.
const SHELL: &str = "bursting_shell_3d";
const SIZE: &str = "render.size=[160, 120]";

#[test]
fn readers_of_others_find_the_same_numbers() {
    let numpy = std::process::Command::new("python3").args(["-c", "import numpy"]).output();
    if crate::common::gpu_or_skip().is_none() || !numpy.is_ok_and(|output| output.status.success()) {
        eprintln!("SKIPPED: no python3 with numpy, so that nobody reads the files");
        return;
    }
    let place = tempfile::tempdir().unwrap();
    let [run, out] = ["run", "out"].map(|name| place.path().join(name).display().to_string());
    let [fire, hot, shell, solid] =
        ["fire", "hot", "shell", "solid"].map(|name| place.path().join(name).display().to_string());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/readers-test");
    let read = |out: &str| std::process::Command::new("python3").args([script, out]).output().unwrap();
    let converted = |(scene, cells, until): (&str, &str, &str), run: &str, out: &str| {
        let given = ["run", scene, "--resolution", cells, "--until", until, "--frames", "1", "--set", SIZE];
        let asked = ["--no-frames", "--no-expect", "-q", "--export", "states", "--out", run];
        let small = if scene == SHELL { &[][..] } else { &["--variant", "small"] };
        succeeds(&[&given[..], &asked, small].concat());
        let formats = if scene == SHELL { "npz,vtk,vdb,usd,mesh,exr" } else { "npz,vtk,vdb,usd" };
        succeeds(&["convert", run, "--to", formats, "--out", out, "-q"]);
        let output = read(out);
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        eprintln!("{text}");
        assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
        text
    };
    // products of TNT are soot, and shine
    let text = converted(("fireball_3d", "24", "0.02"), &fire, &hot);
    let seen = ["flames 0 active", "soot 0 active"].iter().all(|none| !text.contains(none));
    assert!(!text.contains("pyopenvdb  density") || text.contains("flames") && text.contains("soot") && seen, "{text}");
    // surfaces and layers of a picture, in space
    let text = converted((SHELL, "16", "0.01"), &shell, &solid);
    for (reader, found) in
        [("trimesh", "of the particles' volume"), ("meshio", "of 1 pieces"), ("OpenEXR", "are on a body")]
    {
        let line = text.lines().find(|line| line.starts_with(reader)).unwrap();
        assert!(line.contains(found) || line.contains("SKIPPED"), "{line}");
    }
    let text = converted(("fig03_elastic_shell_2d", "32", "0.002"), &run, &out);
    assert!(fails(2, &["convert", &run, "--to", "png"]).contains("brisance render"));
    assert!(fails(2, &["convert", &run, "--to", "npz", "--frame", "7"]).contains("no state of frame 7"));
    assert!(fails(2, &["convert", &run, "--to", "abc"]).contains("there are:"));
    assert!(fails(2, &["convert", &run, "--to", "vdb", "--kelvin", "-3"]).contains("a number above 0"));
    // what is spoiled is noticed, where there is a reader
    let volume = Path::new(&out).join("vdb/0001.vdb");
    let mut bytes = std::fs::read(&volume).unwrap();
    let last = bytes.len() - 1;
    bytes.truncate(last / 2);
    std::fs::write(&volume, bytes).unwrap();
    if text.contains("pyopenvdb  density") || text.contains("lists all grids") {
        assert!(!read(&out).status.success());
    }
}
