//! VTK files: the head, the offsets and the raw bytes agree with the snapshot.

use std::path::Path;

use brisance::export::{self, Moment, Needs, Origin};
use brisance::snapshot::{ParticleSample, Snapshot, kind};
use brisance::state::Grid;

use crate::cli::{fails, succeeds};

fn snapshot(dimension: u32) -> Snapshot {
    let cells = std::array::from_fn(|axis| if (axis as u32) < dimension { 4 + axis as u32 } else { 1 });
    let grid = Grid { dimension, cells, origin: [0.5, 1.0, 1.5], spacing: 0.25 };
    let count = grid.cell_count();
    let number = |index: usize| index as f32;
    let mut kinds = vec![kind::GAS; count];
    kinds[1] = kind::SOLID;
    let particle = |index: usize| ParticleSample {
        index: index as u32,
        position: [number(index), 0.5, 0.25],
        velocity: [1.0, number(index), 3.0],
        vorticity: [0.0; 3],
        stress: [0.0; 6],
        kinetic_energy: 0.0,
        mass: 2.0,
        volume0: 0.5,
        ghost_pressure: -4.0,
        plastic_strain: 0.125,
        damage: 0.0,
        deformation: [[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.5]],
        body: index as u32,
        material: 1,
    };
    Snapshot {
        time: 0.1,
        step: 3,
        grid,
        gamma: 1.4,
        kind: kinds,
        density: (0..count).map(number).collect(),
        velocity: (0..count).map(|index| [number(index), 10.0, -1.0]).collect(),
        pressure: vec![1.0; count],
        energy: vec![2.5; count],
        owed: (0..count).map(|index| 0.5 * number(index)).collect(),
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
            let origin = Origin { title: "t".to_owned(), hash: String::new(), source: Default::default() };
            let snapshot = Some(&snapshot);
            let moment = Moment { index, origin: &origin, time, step: 3, pictures: &[], snapshot, stored: None };
            assert_eq!(Needs::of(&exporters), Needs { snapshot: true, ..Needs::default() });
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

#[test]
fn unknown_format_lists_the_known_ones() {
    let error = export::open(&["gif".to_owned()], Path::new("out")).err().unwrap();
    assert_eq!(error.to_string(), "no export format `gif`; there are: png, png16, exr, states, vtk, vdb, usd, npz");
    assert_eq!(error.exit_code(), 2);
}

#[test]
fn readers_of_others_find_the_same_numbers() {
    let numpy = std::process::Command::new("python3").args(["-c", "import numpy"]).output();
    if crate::common::gpu_or_skip().is_none() || !numpy.is_ok_and(|output| output.status.success()) {
        eprintln!("SKIPPED: no python3 with numpy, so that nobody reads the files");
        return;
    }
    let place = tempfile::tempdir().unwrap();
    let [run, out] = ["run", "out"].map(|name| place.path().join(name).display().to_string());
    let scene = [
        "run",
        "fig03_elastic_shell_2d",
        "--variant",
        "small",
        "--resolution",
        "32",
        "--until",
        "0.002",
        "--frames",
        "1",
    ];
    succeeds(&[&scene[..], &["--no-frames", "--no-expect", "-q", "--export", "states", "--out", &run]].concat());
    succeeds(&["convert", &run, "--to", "npz,vtk,vdb,usd", "--out", &out, "-q"]);
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/readers-test");
    let read = || std::process::Command::new("python3").args([script, &out]).output().unwrap();
    let output = read();
    let text = String::from_utf8_lossy(&output.stdout);
    eprintln!("{text}");
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    assert!(fails(2, &["convert", &run, "--to", "png"]).contains("brisance render"));
    assert!(fails(2, &["convert", &run, "--to", "npz", "--frame", "7"]).contains("no state of frame 7"));
    assert!(fails(2, &["convert", &run, "--to", "abc"]).contains("there are:"));
    // what is spoiled is noticed, where there is a reader
    let volume = Path::new(&out).join("vdb/0001.vdb");
    let mut bytes = std::fs::read(&volume).unwrap();
    let last = bytes.len() - 1;
    bytes.truncate(last / 2);
    std::fs::write(&volume, bytes).unwrap();
    if text.contains("pyopenvdb  density") || text.contains("lists all grids") {
        assert!(!read().status.success());
    }
}
