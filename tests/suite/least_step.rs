//! Runs that cannot end are stopped, and the message names what asks for so short steps.

use crate::cli::fails;
use crate::common::gpu_or_skip;

/// Gas at rest for a time, with a thin cell in it.
fn scene(until: &str, density: &str, more: &str) -> String {
    format!(
        "title = \"Short steps\"\ndomain = {{ dimension = 1, cells = [50], size = [1.0] }}\n\
         time = {{ until = {until}, frames = 1{more} }}\n[gas]\nambient = {{ density = 1.0, pressure = 1.0 }}\n\
         regions = [{{ shape = {{ box = {{ center = [0.51], size = [0.02] }} }}, density = {density}, pressure = 1.0 }}]\n"
    )
}

fn stopped(text: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let (path, out) = (folder.path().join("short.toml"), folder.path().join("out"));
    std::fs::write(&path, text).unwrap();
    fails(7, &["run", path.to_str().unwrap(), "--out", out.to_str().unwrap()])
}

#[test]
fn a_cell_that_asks_for_endless_steps_is_named() {
    let Some(_gpu) = gpu_or_skip() else { return };
    let text = stopped(&scene("1e6", "1e-4", ""));
    assert!(text.contains("100 in a row, is below 1e-9 of time.until"), "{text}");
    assert!(text.contains("stage time_step, cell [25, 0, 0]"), "{text}");
    assert!(text.contains("time.max_courant"), "{text}");
}

#[test]
fn a_prescribed_step_that_is_too_short_is_named() {
    let Some(_gpu) = gpu_or_skip() else { return };
    let text = stopped(&scene("1.0", "1.0", ", fixed_step = 5e-10"));
    assert!(text.contains("below 1e-9 of time.until; time.fixed_step asks for it"), "{text}");
}

/// What cannot make its first step has a wrong start in most cases: the message tells it.
#[test]
fn a_fault_in_the_first_step_tells_the_start_there() {
    let Some(_gpu) = gpu_or_skip() else { return };
    let text = stopped(
        "title = \"Too fast\"\ndomain = { dimension = 2, cells = [32, 16], size = [2.0, 1.0] }\ntime = { until = 1.0, frames = 1 }\n\
         [gas]\nambient = { density = 1.0, pressure = 1e-9 }\n[[gas.regions]]\ndensity = 1.0\npressure = 2.0\nvelocity = [1e8, 0.0]\n\
         shape = { sphere = { center = [1.0, 0.5], radius = 0.2 } }\n",
    );
    assert!(text.contains("diverged in step 1, stage gas_advection, cell ["), "{text}");
    assert!(text.contains("in the first step that is usually the start state: density 1, pressure "), "{text}");
    assert!(text.contains("temperature p / rho ") && text.contains(" there"), "{text}");
}
