//! The house rules that a machine can hold: modules depend downwards, and nothing grows too large.

use std::path::{Path, PathBuf};

use crate::common::{files_below, is_kind, report};

/// Modules from the ground floor to the roof. A module may use lower floors only.
const FLOORS: [&[&str]; 11] = [
    &["math", "error", "input", "riemann", "spelling", "structure", "explosive"],
    &["material", "gpu"],
    &["scene", "numerics"],
    &["state"],
    &["stage", "snapshot"],
    &["simulation", "diagnostics", "bodies"],
    &["quantity"],
    &["render", "expect"],
    &["export", "verify"],
    &["viewer", "cli"],
    &["main"],
];

/// Uses within a floor that are allowed: the first module uses the second.
const SIDEWAYS: [(&str, &str); 2] = [("simulation", "diagnostics"), ("cli", "viewer")];

/// Lines a Rust file may have.
const MAX_FILE: usize = 400;
/// Lines a shader file may have.
const MAX_SHADER: usize = 300;
/// Lines a function may have, from its head to its closing brace.
const MAX_FUNCTION: usize = 60;
/// Lines a shader's entry point may have.
const MAX_ENTRY_POINT: usize = 80;
/// Lines of `src/main.rs`.
const MAX_MAIN: usize = 150;

/// Files with this extension below a folder of the project: path from the project's root, text.
fn files(below: &str, extension: &str) -> Vec<(PathBuf, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(below);
    let paths = files_below(&folder).into_iter().filter(|path| is_kind(path, extension));
    paths.map(|path| (Path::new(below).join(&path), std::fs::read_to_string(folder.join(path)).unwrap())).collect()
}

fn floor(module: &str) -> Option<usize> {
    FLOORS.iter().position(|modules| modules.contains(&module))
}

/// The top module of a source file: `gpu` for `src/gpu/kernel.rs`.
fn module(path: &Path) -> String {
    let part = path.components().nth(1).map(|part| part.as_os_str().to_string_lossy().into_owned());
    part.unwrap_or_default().trim_end_matches(".rs").to_owned()
}

/// Top modules that a line of code names after `crate::`, also in a list in braces.
fn named(line: &str) -> Vec<String> {
    let identifier = |text: &str| -> String { text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect() };
    let mut names = Vec::new();
    for (_, rest) in line.match_indices("crate::").map(|(at, found)| line.split_at(at + found.len())) {
        match rest.strip_prefix('{') {
            Some(list) => names.extend(list.split(',').map(|item| identifier(item.trim()))),
            None => names.push(identifier(rest)),
        }
    }
    // Types at the crate's root are those of `error`.
    names.retain(|name| !name.is_empty());
    names
        .iter()
        .map(|name| if matches!(name.as_str(), "Error" | "Result") { "error".into() } else { name.clone() })
        .collect()
}

#[test]
fn modules_depend_downwards_only() {
    let mut failures = Vec::new();
    for (path, text) in files("src", "rs") {
        let own = module(&path);
        if own == "lib" {
            continue;
        }
        let Some(own_floor) = floor(&own) else {
            failures.push(format!("{}: module `{own}` has no floor in tests/suite/layering.rs", path.display()));
            continue;
        };
        for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//")) {
            for other in named(line).into_iter().filter(|other| *other != own) {
                let allowed = floor(&other).is_some_and(|floor| floor < own_floor);
                if !allowed && !SIDEWAYS.contains(&(own.as_str(), other.as_str())) {
                    failures.push(format!("{}:{}: `{own}` must not use `{other}`", path.display(), number + 1));
                }
            }
        }
    }
    report(&failures);
}

/// Rooms of `verify` from the ground floor to the roof; files of the last do not know each other.
const ROOMS_OF_VERIFY: [&str; 4] = ["exact", "harness", "measure", "cases"];

#[test]
fn rooms_of_verify_depend_downwards_and_its_cases_on_no_other_case() {
    let mut failures = Vec::new();
    for (path, text) in files("src/verify", "rs") {
        let room = path.components().nth(2).map(|part| part.as_os_str().to_string_lossy().into_owned());
        let Some(floor) = ROOMS_OF_VERIFY.iter().position(|name| Some(*name) == room.as_deref()) else { continue };
        let is_case = floor + 1 == ROOMS_OF_VERIFY.len() && !path.ends_with("mod.rs");
        for (number, line) in text.lines().enumerate() {
            let upward = ROOMS_OF_VERIFY[floor + 1..].iter().any(|upper| line.contains(&format!("verify::{upper}")));
            let code = line.trim_start();
            let other_case = is_case && code.starts_with("use super::") && line == code;
            if upward || other_case {
                failures.push(format!("{}:{}: {code}", path.display(), number + 1));
            }
        }
    }
    report(&failures);
}

/// Rooms of `scene` above the data and `geometry`, from the ground floor to the roof. Builder and root know all of them.
const ROOMS_OF_SCENE: [&str; 2] = ["check", "file"];

#[test]
fn rooms_of_scene_depend_downwards() {
    let mut failures = Vec::new();
    let doors = ["src/scene/mod.rs", "src/scene/build.rs"].map(Path::new);
    for (path, text) in files("src/scene", "rs") {
        if doors.contains(&path.as_path()) || path.starts_with("src/scene/tests") {
            continue;
        }
        let own = ROOMS_OF_SCENE.iter().position(|room| path.starts_with(Path::new("src/scene").join(room)));
        let above = &ROOMS_OF_SCENE[own.map_or(0, |own| own + 1)..];
        let code = text.lines().take_while(|line| *line != "#[cfg(test)]");
        for (number, line) in code.enumerate() {
            let names = |room: &&&str| ["scene", "super"].iter().any(|from| line.contains(&format!("{from}::{room}")));
            let found = above.iter().filter(names);
            failures.extend(found.map(|room| format!("{}:{}: {room}", path.display(), number + 1)));
        }
    }
    report(&failures);
}

#[test]
fn the_ground_floors_know_no_physics() {
    let words = ["pressure", "density", "velocity", "viscosity", "plastic", "particle"];
    let mut failures = Vec::new();
    for (path, text) in files("src", "rs") {
        if ["gpu", "numerics"].contains(&module(&path).as_str()) && !path.ends_with("sources.rs") {
            let text = text.to_lowercase();
            let found = words.iter().filter(|word| text.contains(*word));
            failures.extend(found.map(|word| format!("{}: `{word}` belongs to a higher floor", path.display())));
        }
    }
    report(&failures);
}

/// Names of shaders that a text quotes.
fn quoted_shaders(text: &str) -> impl Iterator<Item = &str> {
    text.split('"').skip(1).step_by(2).filter(|quoted| quoted.ends_with(".wgsl"))
}

#[test]
fn every_shader_has_its_user() {
    let is_table = |path: &Path| path.ends_with("sources.rs");
    let users: Vec<_> = files("src", "rs").into_iter().filter(|(path, _)| !is_table(path)).collect();
    let shaders = files("shaders", "wgsl");
    let entry_files: Vec<_> = shaders.iter().filter(|(_, text)| text.contains("\n@compute")).collect();
    assert!(entry_files.len() > 50, "{} files with kernels", entry_files.len());
    let mut failures = Vec::new();
    for (path, _) in entry_files {
        let name = path.strip_prefix("shaders").unwrap_or(path).to_string_lossy();
        if !users.iter().any(|(_, text)| text.contains(&format!("\"{name}\""))) {
            failures.push(format!("{}: no kernel is made of it", path.display()));
        }
    }
    for (path, text) in files("src/stage", "rs") {
        for name in quoted_shaders(&text).filter(|name| !shaders.iter().any(|(path, _)| path.ends_with(name))) {
            failures.push(format!("{}: there is no shaders/{name}", path.display()));
        }
    }
    report(&failures);
}

/// Functions of a formatted text: name, line of the head, lines up to the brace that closes at the head's indentation.
fn functions(text: &str) -> Vec<(String, usize, usize)> {
    let lines: Vec<&str> = text.lines().collect();
    let mut found = Vec::new();
    for (start, line) in lines.iter().enumerate() {
        let code = line.trim_start();
        let head = ["pub ", "pub(crate) ", "pub(super) ", "const ", "async "]
            .iter()
            .fold(code, |code, word| code.strip_prefix(word).unwrap_or(code));
        let Some(rest) = head.strip_prefix("fn ") else { continue };
        let name = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        let closing = format!("{}}}", &line[..line.len() - code.len()]);
        let one_line = line.ends_with('}') || line.ends_with(';');
        let length = lines[start..].iter().position(|line| *line == closing).filter(|_| !one_line).unwrap_or(0) + 1;
        found.push((name, start + 1, length));
    }
    found
}

/// Checks files and their functions against limits and prints the largest of each.
fn check_sizes(files: &[(PathBuf, String)], max_file: usize, max_function: usize, failures: &mut Vec<String>) {
    let mut largest = (0, String::new());
    let mut longest = (0, String::new());
    for (path, text) in files {
        let lines = text.lines().count();
        largest = largest.max((lines, path.display().to_string()));
        if lines > max_file {
            failures.push(format!("{}: {lines} lines, at most {max_file}", path.display()));
        }
        for (name, line, length) in functions(text) {
            longest = longest.max((length, format!("{}:{line}: {name}", path.display())));
            let entry_point = text.lines().nth(line.saturating_sub(2)).is_some_and(|line| line.starts_with("@compute"));
            let limit = if entry_point { MAX_ENTRY_POINT } else { max_function };
            if length > limit {
                failures.push(format!("{}:{line}: {name} has {length} lines, at most {limit}", path.display()));
            }
        }
    }
    eprintln!("largest file: {} lines, {}; longest function: {} lines, {}", largest.0, largest.1, longest.0, longest.1);
}

#[test]
fn nothing_is_too_large() {
    let mut failures = Vec::new();
    check_sizes(&files("src", "rs"), MAX_FILE, MAX_FUNCTION, &mut failures);
    check_sizes(&files("tests", "rs"), MAX_FILE, MAX_FUNCTION, &mut failures);
    check_sizes(&files("shaders", "wgsl"), MAX_SHADER, MAX_FUNCTION, &mut failures);
    let main = files("src", "rs").into_iter().find(|(path, _)| path.ends_with("main.rs"));
    let lines = main.map_or(0, |(_, text)| text.lines().count());
    if lines > MAX_MAIN {
        failures.push(format!("src/main.rs: {lines} lines, at most {MAX_MAIN}"));
    }
    report(&failures);
}
