//! `fragments.csv`: the pieces of bodies in each frame of a run, in any dimension.

use std::path::Path;

use brisance::export::csv::Sheet;

use crate::cli::succeeds;
use crate::common::folder_or_skip;

/// Two halves of a bar that fly apart, in so many dimensions; they overlap, so that they are one piece at first.
fn bar(dimension: usize) -> String {
    let list = |values: [f64; 3]| format!("{:?}", &values[..dimension]);
    let half = |name: &str, x: f64, speed: f64| {
        format!(
            "[[bodies]]\nname = \"{name}\"\nmaterial = \"jelly\"\ndensity = 10.0\nvelocity = {}\n\
             shape = {{ box = {{ center = {}, size = {} }} }}\n",
            list([speed, 0.0, 0.0]),
            list([x, 0.5, 0.5]),
            list([0.25, 0.25, 0.25])
        )
    };
    format!(
        "title = \"Halves\"\ndomain = {{ dimension = {dimension}, cells = {:?}, size = {} }}\n\
         gas.ambient = {{ density = 0.001, pressure = 0.001 }}\ntime = {{ until = 0.1, frames = 3 }}\nrender.size = [48, 48]\n\
         [materials.jelly]\nneo_hookean = {{ young_modulus = 20.0, poisson_ratio = 0.3 }}\n{}{}",
        &[16; 3][..dimension],
        list([1.0; 3]),
        half("left", 0.3, -1.0),
        half("right", 0.7, 1.0)
    )
}

/// Rows of the table of a run.
fn table(run: &Path) -> Sheet {
    Sheet::read(&run.join("fragments.csv"), &["parent", "body"]).unwrap().expect("a table of pieces")
}

#[test]
fn every_run_with_bodies_has_its_pieces() {
    let Some(place) = folder_or_skip() else { return };
    for dimension in 1..=3 {
        let file = place.path().join(format!("bar{dimension}.toml"));
        std::fs::write(&file, bar(dimension)).unwrap();
        let run = place.path().join(format!("run{dimension}"));
        let [file, out] = [&file, &run].map(|path| path.display().to_string());
        succeeds(&["run", &file, "--no-frames", "--no-expect", "-q", "--out", &out]);
        let sheet = table(&run);
        let column = |name: &str| sheet.numbers(name).unwrap().to_vec();
        assert_eq!(column("frame"), [0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0], "{dimension}");
        assert_eq!(sheet.texts("body").unwrap()[..2], ["left", "right"]);
        let (piece, parent) = (column("piece"), sheet.texts("parent").unwrap());
        assert!(parent[..2] == ["-", "-"] && parent[2..].iter().zip(&piece).all(|(own, of)| *own == of.to_string()));
        assert!(column("volume").iter().all(|volume| (volume / 0.25f64.powi(dimension as i32) - 1.0).abs() < 0.05));
        let (mass, x, speed) = (column("mass"), column("x"), column("velocity_x"));
        let wanted = 10.0 * 0.25f64.powi(dimension as i32);
        assert!(mass.iter().all(|mass| (mass / wanted - 1.0).abs() < 1e-5), "{mass:?}");
        assert!(speed.iter().zip([-1.0, 1.0].iter().cycle()).all(|(speed, wanted)| (speed - wanted).abs() < 0.02));
        assert!(x[0] > x[6] + 0.09 && x[7] > x[1] + 0.09, "{x:?}");
        let sizes = ["length", "width", "height"].map(&column);
        for (axis, size) in sizes.iter().enumerate() {
            let wanted = if axis < dimension { 0.25 } else { 0.0 };
            assert!(size.iter().all(|size| (size - wanted).abs() < 0.01), "{dimension} {axis}: {size:?}");
        }
        let fast: f64 = (1..=8).map(|part| column(&format!("mass_at_speed_{part}_of_8"))[6]).sum();
        assert!((fast - mass[6]).abs() < 1e-9 && (column("fastest")[6] - 1.0).abs() < 0.03);
        let page = std::fs::read_to_string(run.join("report.html")).unwrap();
        assert!(page.contains("<h2>Pieces</h2>") && page.contains("Speeds of pieces in the last frame"));
        let index = std::fs::read_to_string(run.join("run.json")).unwrap();
        assert!(index.contains("fragments.csv"));
    }
}

/// A run that goes on knows the pieces of the frame before: its rows are those of a run in one piece.
#[test]
fn pieces_know_their_parents_behind_a_checkpoint() {
    let Some(place) = folder_or_skip() else { return };
    let file = place.path().join("bar.toml");
    std::fs::write(&file, bar(2)).unwrap();
    let path = |name: &str| place.path().join(name).display().to_string();
    let (file, whole, parts) = (file.display().to_string(), path("whole"), path("parts"));
    let base = ["run", &file, "--no-frames", "--no-expect", "-q"];
    succeeds(&[&base[..], &["--out", &whole]].concat());
    succeeds(&[&base[..], &["--out", &parts, "--checkpoint", "t=0.05", "--keep", "9"]].concat());
    // the checkpoints behind the first one are lost
    let mut all: Vec<_> =
        std::fs::read_dir(place.path().join("parts/checkpoints")).unwrap().map(|entry| entry.unwrap().path()).collect();
    all.sort();
    assert!(all.len() > 1);
    all[1..].iter().for_each(|path| std::fs::remove_file(path).unwrap());
    succeeds(&["run", "--resume", &parts, "-q"]);
    let [one, two] = [&whole, &parts].map(|run| std::fs::read_to_string(Path::new(run).join("fragments.csv")).unwrap());
    assert!(one == two, "{one}\n{two}");
}
