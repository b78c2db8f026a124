//! What a stranger's device meets: its list, the self-test, the settings of hardware, kernels for other compilers, waits that end.

use std::path::Path;

use crate::cli::{brisance, err, out, succeeds};
use crate::common::{folder_or_skip, gpu_or_skip};

/// Copies the shaders into a folder, one of them changed.
fn shaders_with(folder: &Path, name: &str, from: &str, to: &str) {
    for (path, text) in crate::shaders::files() {
        let copy = folder.join(path);
        std::fs::create_dir_all(copy.parent().unwrap()).unwrap();
        std::fs::write(copy, text).unwrap();
    }
    let text = std::fs::read_to_string(folder.join(name)).unwrap();
    assert!(text.contains(from), "{name} has no `{from}`");
    std::fs::write(folder.join(name), text.replacen(from, to, 1)).unwrap();
}

#[test]
fn a_wrong_stage_fails_the_selftest_by_name() {
    let Some(folder) = folder_or_skip() else { return };
    let file = folder.path().join("found.json");
    let arguments = ["selftest", "--filter", "prefix sum", "--out", file.to_str().unwrap()];
    let text = succeeds(&arguments);
    assert!(text.contains("ok   prefix sum") && text.contains("1 of 1 cases passed"), "{text}");
    let report: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&file).unwrap()).unwrap();
    assert_eq!((&report["passed"], &report["cases"][0]["passed"]), (&1.into(), &true.into()));
    assert!(report["device"]["limits"]["maxStorageBuffersPerShaderStage"].as_u64() >= Some(8), "{report}");

    let shaders = folder.path().join("shaders");
    shaders_with(&shaders, "numerics/scan.wgsl", "output[i] += offset;", "output[i] += offset + 1u;");
    let output = brisance(&arguments).env("BRISANCE_SHADERS", &shaders).output().unwrap();
    let text = err(&output);
    assert_eq!(output.status.code(), Some(8), "{text}");
    assert!(text.contains("`prefix sum` is the first case that is wrong") && text.contains("element"), "{text}");
    assert_eq!(brisance(&["selftest", "--filter", "abacus"]).output().unwrap().status.code(), Some(2));
}

#[test]
fn nodes_and_order_of_particles_are_those_of_the_host() {
    let Some(folder) = folder_or_skip() else { return };
    let file = folder.path().join("found.json");
    let arguments = ["selftest", "--filter", "particles", "--out", file.to_str().unwrap()];
    assert!(succeeds(&arguments).contains("3 of 3 cases passed"));
    let shaders = folder.path().join("shaders");
    let from = "solid/place.wgsl";
    shaders_with(&shaders, from, "let low = 0.5 * (0.5 - f)", "let low = 0.501 * (0.5 - f)");
    let output = brisance(&arguments).env("BRISANCE_SHADERS", &shaders).output().unwrap();
    let text = err(&output);
    assert_eq!(output.status.code(), Some(8), "{text}");
    assert!(text.contains("stage p2g: cell ["), "{text}");
}

#[test]
fn devices_tell_limits_and_why_one_is_chosen() {
    let Some(_) = gpu_or_skip() else { return };
    let text = brisance(&["devices"]).env_remove("BRISANCE_DEVICE").output().unwrap();
    for part in
        ["maxComputeWorkgroupsPerDimension 65535", "chosen    the first of the list", "features  ", "known     "]
    {
        assert!(out(&text).contains(part), "{part}: {}", out(&text));
    }
    let object: serde_json::Value = serde_json::from_str(&succeeds(&["devices", "--json", "--device", "0"])).unwrap();
    assert_eq!((&object["chosen"]["why"], &object["chosen"]["index"]), (&"--device 0".into(), &0.into()));
    assert!(object["devices"][0]["limits"]["maxStorageBufferBindingSize"].as_u64() >= Some(128 << 20), "{object}");
}

#[test]
fn the_environment_is_checked() {
    let Some(_) = gpu_or_skip() else { return };
    for (name, value, allowed) in
        [("BRISANCE_AS", "abacus", "gpu or software"), ("BRISANCE_WAIT", "0", "whole number of seconds above 0")]
    {
        let output = brisance(&["selftest", "--filter", "prefix"]).env(name, value).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", err(&output));
        assert!(
            err(&output).contains(&format!("{name}={value}")) && err(&output).contains(allowed),
            "{}",
            err(&output)
        );
    }
}

#[test]
fn the_settings_of_hardware_give_the_same_within_rounding() {
    let Some(folder) = folder_or_skip() else { return };
    let file = folder.path().join("found.json");
    let arguments = ["selftest", "--filter", "both settings", "--out", file.to_str().unwrap()];
    assert!(succeeds(&arguments).contains("1 of 1 cases passed"));
    let report: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&file).unwrap()).unwrap();
    assert!(report["cases"][0]["difference"].as_f64() > Some(0.0), "the settings differ: {report}");
}

#[test]
fn kernels_are_written_for_other_compilers() {
    let Some(folder) = folder_or_skip() else { return };
    let text = succeeds(&["shaders", "riemann_2d", "--out", folder.path().to_str().unwrap()]);
    assert!(text.contains("kernels of 1 scenes"), "{text}");
    let files: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path()).collect();
    let mut entries = Vec::new();
    for path in files.iter().filter(|path| path.extension().is_some_and(|end| end == "json")) {
        let kernel: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        let source = std::fs::read_to_string(folder.path().join(kernel["text"].as_str().unwrap())).unwrap();
        let entry = kernel["entry"].as_str().unwrap().to_owned();
        assert!(source.contains(&format!("fn {entry}(")) && !source.contains("#include"), "{entry}");
        assert!(kernel["overrides"].as_object().unwrap().iter().all(|(name, _)| source.contains(name)), "{kernel}");
        entries.push(entry);
    }
    for entry in ["advect_interior", "pcg_step", "interior_operator", "draw_slice"] {
        assert!(entries.iter().any(|known| known == entry), "{entry}: {entries:?}");
    }
}
