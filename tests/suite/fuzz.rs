//! Spoilt scenes, overrides and meshes from fixed seeds: none may panic, and every refusal comes by counting, within 2 s of processor time
//! and 500 MB. `scripts/fuzz` runs the same for hours.
//!
//! The work is done by this binary started again, alone in its process, so that time and memory are those of one input.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use brisance::scene::Scene;

/// Processor time that a refusal may take, in a build for tests.
const MOST_TIME: Duration = Duration::from_secs(2);
/// Main memory that it may take \[kB\].
const MOST_MEMORY: u64 = 500_000;
/// Set for the process that does the work: the first seed and the seconds.
const WORK: &str = "BRISANCE_FUZZ";

/// Splitmix64. [Steele, Lea, Flood 2014]
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }

    fn of<'t>(&mut self, list: &[&'t str]) -> &'t str {
        list[self.below(list.len())]
    }
}

/// What numbers become.
const NUMBERS: [&str; 22] = [
    "0", "-1", "1", "2", "3", "7", "100", "10000", "65536", "2147483647", "4294967295", "4294967296",
    "9223372036854775807", "1e300", "-1e300", "1e-300", "1e-38", "0.5", "1e19", "nan", "inf", "1e9",
];
/// What stands in for a value or a line.
const PIECES: [&str; 12] = [
    "[]",
    "{}",
    "\"\"",
    "true",
    "[1, 2, 3, 4]",
    "\"wall\"",
    "{ sphere = { center = [0.5, 0.5], radius = 0.2 } }",
    "\n[[bodies]]\n",
    "[[1e9]]",
    "{ use = { name = \"koala\" } }",
    "\u{0}",
    "\"\\u0000\"",
];
/// Keys of overrides.
const KEYS: [&str; 14] = [
    "domain.cells",
    "domain.size",
    "domain.dimension",
    "gas.gamma",
    "gas.ambient.density",
    "bodies[0].shape",
    "bodies.0.material",
    "time.until",
    "variant",
    "boundary.x_min",
    "render.size",
    "a.b.c.d.e",
    "bodies[99999999999999999999].x",
    "expect",
];
/// Values of overrides.
const VALUES: [&str; 12] =
    ["1", "[1]", "[1000000, 1000000]", "small", "\"", "{", "[0.0]", "1e400", "-0", "[[]]", "{ inlet = {} }", "'''"];

/// A text with a few things spoilt.
fn spoilt(text: &str, random: &mut Random) -> String {
    let mut text = text.to_owned();
    for _ in 0..=random.below(4) {
        let numbers: Vec<(usize, usize)> = numbers(&text);
        let lines: Vec<&str> = text.lines().collect();
        match random.below(6) {
            0..=2 if !numbers.is_empty() => {
                let (start, end) = numbers[random.below(numbers.len())];
                text.replace_range(start..end, random.of(&NUMBERS));
            }
            3 if lines.len() > 1 => {
                let mut lines = lines;
                let (from, to) = (random.below(lines.len()), random.below(lines.len()));
                let line = lines[from];
                lines.insert(to, line);
                text = lines.join("\n");
            }
            4 if lines.len() > 1 => {
                let mut lines = lines;
                lines.remove(random.below(lines.len()));
                text = lines.join("\n");
            }
            _ => {
                let mut place = random.below(text.len() + 1);
                while !text.is_char_boundary(place) {
                    place -= 1;
                }
                text.insert_str(place, random.of(&PIECES));
            }
        }
    }
    text
}

/// Places of numbers in a text.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut start = None;
    for (place, letter) in text.char_indices().chain([(text.len(), ' ')]) {
        match (letter.is_ascii_digit() || (start.is_some() && ".e-+".contains(letter)), start) {
            (true, None) => start = Some(place),
            (false, Some(first)) => {
                found.push((first, place));
                start = None;
            }
            _ => {}
        }
    }
    found
}

/// Files of other programs, small ones, by what their names end with.
fn meshes() -> &'static [(String, Vec<u8>)] {
    static FILES: OnceLock<Vec<(String, Vec<u8>)>> = OnceLock::new();
    FILES.get_or_init(|| {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes");
        let mut paths: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        let end = |path: &Path| path.extension().unwrap().to_str().unwrap().to_owned();
        let files = paths.iter().map(|path| (end(path), std::fs::read(path).unwrap()));
        files.filter(|(end, bytes)| end != "bin" && end != "md" && bytes.len() < 12_000).collect()
    })
}

/// A mesh of another program, or one whose nodes use each other, with bytes spoilt.
fn mesh(random: &mut Random) -> (String, Vec<u8>) {
    let (end, mut bytes) = match random.below(8) {
        0 => ("gltf".to_owned(), gltf().into_bytes()),
        _ => meshes()[random.below(meshes().len())].clone(),
    };
    let name = format!("m.{end}");
    for _ in 0..random.below(4) {
        let text = std::str::from_utf8(&bytes).ok().map(|text| spoilt(text, random));
        match text.filter(|_| random.below(3) > 0) {
            Some(text) => bytes = text.into_bytes(),
            None => {
                let place = random.below(bytes.len());
                bytes[place] = random.next() as u8;
                if random.below(4) == 0 {
                    bytes.truncate(place);
                }
            }
        }
        if bytes.is_empty() {
            break;
        }
    }
    (name, bytes)
}

/// A triangle and nodes that use each other.
fn gltf() -> String {
    "{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0, \"scenes\": [{\"nodes\": [0]}], \"nodes\": [{\"children\": [1, 1]}, {\"mesh\": 0}], \
     \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}], \"buffers\": [{\"byteLength\": 36, \"uri\": \
     \"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}], \"bufferViews\": [{\"buffer\": 0, \
     \"byteOffset\": 0, \"byteLength\": 36}], \"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \
     \"VEC3\", \"min\": [0, 0, 0], \"max\": [1, 1, 0]}]}"
        .to_owned()
}

/// Processor time of this process so far.
fn processor() -> Duration {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<u64> =
        text.rsplit(')').next().unwrap_or_default().split_ascii_whitespace().filter_map(|f| f.parse().ok()).collect();
    // the fields after state are numbers: user and system time are the 11th and 12th, in hundredths of a second
    Duration::from_millis(10 * (fields.get(10).unwrap_or(&0) + fields.get(11).unwrap_or(&0)))
}

/// Most memory since [`forget_memory`] \[kB\].
fn memory() -> u64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or("0");
    line.trim().trim_end_matches("kB").trim().parse().unwrap_or(0)
}

fn forget_memory() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// Scenes to spoil: the small ones, so that what stays sound is read in no time.
fn scenes() -> Vec<String> {
    let mut files: Vec<PathBuf> = Vec::new();
    for folder in ["scenes/gas", "scenes/coupled", "scenes/validation"] {
        let entries = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap();
        files.extend(entries.map(|entry| entry.unwrap().path()));
    }
    files.sort();
    files.iter().map(|path| std::fs::read_to_string(path).unwrap()).filter(|text| text.len() < 6000).collect()
}

/// One input: the scene, its overrides, and the file of its mesh.
fn input(seed: u64, scenes: &[String], folder: &Path) -> (String, Vec<String>) {
    let mut random = Random(seed);
    if random.below(3) == 0 {
        let (name, bytes) = mesh(&mut random);
        std::fs::write(folder.join(&name), bytes).unwrap();
        let text = format!(
            "title = \"m\"\n[domain]\ndimension = 3\ncells = [8, 8, 8]\nsize = [1.0, 1.0, 1.0]\n[gas]\nambient = {{ density = 1.0, \
             pressure = 1.0 }}\n[time]\nuntil = 0.1\n[materials.m]\nneo_hookean = {{ young_modulus = 10.0, poisson_ratio = 0.3 }}\n\
             [[bodies]]\nname = \"b\"\nmaterial = \"m\"\ndensity = 1.0\nshape = {{ mesh = {{ path = \"{name}\", offset = [0.5, 0.5, 0.5] }} }}\n"
        );
        return (text, Vec::new());
    }
    let text = spoilt(&scenes[random.below(scenes.len())], &mut random);
    let overrides = (0..random.below(3)).map(|_| match random.below(8) {
        0 => spoilt(&format!("{}={}", random.of(&KEYS), random.of(&VALUES)), &mut random),
        _ => format!("{}={}", random.of(&KEYS), random.of(&VALUES)),
    });
    let overrides = overrides.collect();
    (text, overrides)
}

/// The process that does the work; without the variable nothing happens here.
#[test]
fn worker() {
    let Ok(work) = std::env::var(WORK) else { return };
    let (seed, seconds) = work.split_once(' ').unwrap();
    let (first, seconds): (u64, u64) = (seed.parse().unwrap(), seconds.parse().unwrap());
    let (folder, scenes) = (tempfile::tempdir().unwrap(), scenes());
    let (start, mut tried, mut refused, mut found) = (Instant::now(), 0u64, 0u64, 0u64);
    while start.elapsed() < Duration::from_secs(seconds) {
        let seed = first + tried;
        let (text, overrides) = input(seed, &scenes, folder.path());
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, &text).unwrap();
        // who is not heard of again says with this line which input it was
        std::fs::write(std::env::temp_dir().join("brisance_fuzz_seed"), seed.to_string()).unwrap();
        forget_memory();
        let (before, at_rest) = (processor(), memory());
        let outcome = catch_unwind(AssertUnwindSafe(|| Scene::load(&path, &overrides).map(|_| ())));
        let (took, held) = (processor() - before, memory().saturating_sub(at_rest));
        tried += 1;
        let slow = matches!(outcome, Ok(Err(_))) && (took > MOST_TIME || held > MOST_MEMORY);
        refused += u64::from(matches!(outcome, Ok(Err(_))));
        if outcome.is_err() || slow {
            found += 1;
            println!(
                "FOUND seed {seed}: {} ms, {held} kB, panic {}\n{overrides:?}\n{text}",
                took.as_millis(),
                outcome.is_err()
            );
        }
    }
    println!("FUZZ tried {tried}, refused {refused}, found {found}");
    assert_eq!(found, 0);
}

#[test]
fn spoilt_inputs_are_refused_in_time() {
    let variable =
        |name: &str, usual: u64| std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(usual);
    let (seed, seconds) = (variable("BRISANCE_FUZZ_SEED", 1), variable("BRISANCE_FUZZ_SECONDS", 20));
    let output = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "fuzz::worker", "--nocapture"])
        .env(WORK, format!("{seed} {seconds}"))
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{}\n{told}\n{}", output.status, String::from_utf8_lossy(&output.stderr));
    let line = told.lines().find(|line| line.contains("FUZZ tried")).unwrap_or_default();
    assert!(!line.is_empty(), "{told}");
    println!("{line}");
}
