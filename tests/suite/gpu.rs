//! The layer under the physics: wide dispatches, checks by name, times, error messages.

use brisance::Error;
use brisance::gpu::{
    Access, Buffer, Constants, Detail, Extent, Folder, Gpu, GpuOptions, Kernel, Pass, Shader, group_counts, readback,
};

use crate::common::{gpu_or_skip, with_shaders};

/// Writes its index, where there is room, times an override.
const NUMBER: &str = r#"
override FACTOR: u32;
struct Params { count: u32 }
@group(0) @binding(3) var<uniform> params: Params;
@group(0) @binding(0) var<storage, read_write> numbers: array<u32>;
@group(0) @binding(1) var<storage, read> unused: array<u32>;

fn store(i: u32) {
    if (i < params.count) {
        numbers[i] = FACTOR * i;
    }
}

@compute @workgroup_size(WORKGROUP)
fn number(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    store(thread_index(workgroup, local));
}
"#;

const FACTOR: Constants<'_> = Constants { overrides: &[("FACTOR", 3.0), ("DIM", 2.0)], source: "" };

fn number_kernel(gpu: &Gpu) -> Kernel {
    Kernel::new(gpu, "number.wgsl", "number", &FACTOR).unwrap()
}

fn message<T>(result: Result<T, Error>) -> String {
    result.err().map(|error| error.to_string()).expect("an error")
}

#[test]
fn group_counts_cover_every_length() {
    for groups in [0, 1, 65_535, 65_536, 100_000, 65_535 * 65_535] {
        let [x, y, z] = group_counts(groups).map(u64::from);
        assert!(x * y * z >= groups && x.max(y).max(z) <= 65_535, "{groups}: {x} {y} {z}");
        assert!(groups == 0 || x * y * z < groups + x, "{groups}: no idle row");
        assert!(y == 1 || x == 65_535 || groups == 0, "{groups}: the kernels count in whole rows");
    }
    assert_eq!(group_counts(0)[0], 0);
}

#[test]
fn a_dispatch_of_more_than_65535_workgroups_reaches_every_element() {
    let Some(gpu) = with_shaders(&[("number.wgsl", NUMBER)]) else { return };
    let count = 65_535 * 64 + 65;
    let numbers = Buffer::<u32>::new(&gpu, "numbers", count).unwrap();
    let params = Buffer::<u32>::uniform(&gpu, "params", 1).unwrap();
    params.write(&gpu, 0, &[count as u32]);
    let kernel = number_kernel(&gpu);
    let names: Vec<_> = kernel.bindings().iter().map(|binding| (binding.name.as_str(), binding.access)).collect();
    assert_eq!(names, [("numbers", Access::ReadWrite), ("params", Access::Uniform)], "only what the entry point uses");
    let bound = kernel.bind(&gpu, &[("params", params.raw()), ("numbers", numbers.raw())]).unwrap();
    let mut pass = Pass::timed(&gpu, "number", Detail::Stages);
    pass.stage("first");
    pass.dispatch(&bound, &Extent::Threads(count as u64));
    pass.stage("nothing");
    pass.stage("second");
    pass.dispatch(&bound, &Extent::Threads(0));
    let times = pass.submit_timed().unwrap();
    if gpu.timestamps {
        assert_eq!(times.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), ["first", "second"]);
        assert!(times[0].1 > 0.0, "{times:?}");
    }
    let found = readback::read(&gpu, &numbers).unwrap();
    assert_eq!(found.iter().enumerate().position(|(i, number)| *number != 3 * i as u32), None);
    assert_eq!(readback::read_range(&gpu, &numbers, 5, 2).unwrap(), [15, 18]);
    assert!(readback::read_range(&gpu, &numbers, count, 1).is_err());
}

#[test]
fn copies_and_clears_keep_their_place_among_dispatches() {
    let Some(gpu) = with_shaders(&[("number.wgsl", NUMBER)]) else { return };
    let numbers = Buffer::<u32>::new(&gpu, "numbers", 8).unwrap();
    let kept = Buffer::<u32>::new(&gpu, "kept", 2).unwrap();
    let params = Buffer::<u32>::uniform(&gpu, "params", 1).unwrap();
    params.write(&gpu, 0, &[8]);
    let names = [("params", params.raw()), ("numbers", numbers.raw())];
    let bound = number_kernel(&gpu).bind(&gpu, &names).unwrap();
    let mut pass = Pass::new(&gpu, "order");
    pass.dispatch(&bound, &Extent::Threads(8));
    pass.copy((&numbers, 6), (&kept, 0), 2);
    pass.clear(&numbers);
    pass.submit().unwrap();
    assert_eq!(readback::read(&gpu, &kept).unwrap(), [18, 21]);
    assert_eq!(readback::read(&gpu, &numbers).unwrap(), [0; 8]);
}

#[test]
fn binding_by_name_is_checked_both_ways() {
    let Some(gpu) = with_shaders(&[("number.wgsl", NUMBER)]) else { return };
    let kernel = number_kernel(&gpu);
    let numbers = Buffer::<u32>::new(&gpu, "numbers", 4).unwrap();
    let (good, buffer) = (("numbers", numbers.raw()), numbers.raw());
    for (given, expected) in [
        (vec![good], "no buffer for `params`"),
        (vec![good, ("parms", buffer)], "uses no variable `parms`; it uses numbers, params"),
        (vec![good, good], "given twice"),
        (vec![good, ("params", buffer)], "are one buffer"),
    ] {
        let text = message(kernel.bind(&gpu, &given));
        assert!(text.contains(expected) && text.contains("number.wgsl"), "{text}");
    }
    let text = message(Kernel::new(&gpu, "number.wgsl", "nombre", &FACTOR));
    assert!(text.contains("there are number"), "{text}");
    let text = message(Kernel::new(&gpu, "number.wgsl", "number", &Constants::default()));
    assert!(text.contains("number.wgsl") && text.contains("FACTOR"), "{text}");
}

#[test]
fn more_than_eight_storage_buffers_are_refused() {
    let declared = (0..9).map(|i| format!("@group(0) @binding({i}) var<storage, read_write> b{i}: array<u32>;\n"));
    let written = (0..9).map(|i| format!("    b{i}[0] = 1u;\n"));
    let text = format!(
        "{}@compute @workgroup_size(1)\nfn nine() {{\n{}}}\n",
        declared.collect::<String>(),
        written.collect::<String>()
    );
    let Some(gpu) = with_shaders(&[("nine.wgsl", &text)]) else { return };
    let text = message(Kernel::new(&gpu, "nine.wgsl", "nine", &Constants::default()));
    assert!(text.contains("uses 9 storage buffers"), "{text}");
}

#[test]
fn memory_is_counted_and_limits_are_told_before_allocation() {
    let Some(gpu) = gpu_or_skip() else { return };
    let before = gpu.allocated_bytes();
    let buffer = Buffer::<[f32; 4]>::new(&gpu, "vectors", 100).unwrap();
    assert_eq!((gpu.allocated_bytes() - before, buffer.size_bytes()), (1600, 1600));
    drop(buffer);
    assert_eq!(gpu.allocated_bytes(), before);
    let text = message(Buffer::<[f32; 4]>::new(&gpu, "universe", 1 << 40));
    assert!(text.contains("`universe` needs 16384.00 GiB"), "{text}");
    gpu.check().unwrap();
}

#[test]
fn a_refused_call_is_a_bug_of_ours_and_reported_once() {
    let Some(gpu) = gpu_or_skip() else { return };
    Buffer::<u32>::new(&gpu, "short", 1).unwrap().write(&gpu, 0, &[1, 2, 3]);
    let error = gpu.check().unwrap_err();
    let text = error.to_string();
    assert!(matches!(error, Error::Bug(_)) && error.exit_code() == 1, "{text}");
    assert!(text.starts_with("a bug in brisance") && text.contains("report") && text.lines().count() == 1, "{text}");
    gpu.check().unwrap();
}

/// So is a shader of ours that the library refuses, by its text or only as a pipeline; one that the user brings is not.
#[test]
fn a_refused_shader_is_a_bug_of_whoever_wrote_it() {
    let Some(_) = gpu_or_skip() else { return };
    // kernels that are refused are for no other compiler
    let written = tempfile::tempdir().unwrap();
    let options = GpuOptions { kernels: Some(written.path().into()), ..GpuOptions::default() };
    let gpu = Gpu::new(&options).unwrap();
    let mut own = Gpu::new(&options).unwrap();
    own.folder = Folder::Given(std::iter::once(("own.wgsl".to_owned(), String::new())).collect());
    let blocks = |gpu: &Gpu, source: &str, items: f64| {
        let overrides = [("SCAN_ITEMS", items)];
        Kernel::new(gpu, "numerics/scan.wgsl", "scan_blocks", &Constants { overrides: &overrides, source })?;
        gpu.finish_kernels()
    };
    for (source, items) in [("const oops: u32 = -1;", 4.0), ("", -1.0)] {
        let error = blocks(&gpu, source, items).unwrap_err();
        let text = error.to_string();
        assert!(
            matches!(error, Error::Bug(_)) && text.lines().count() == 1 && text.contains("numerics/scan.wgsl"),
            "{text}"
        );
        assert!(matches!(blocks(&own, source, items), Err(Error::Shader(_))));
    }
}

#[test]
fn an_unknown_device_is_answered_with_the_list() {
    let Some(_) = gpu_or_skip() else { return };
    let list = Gpu::adapters();
    assert!(!list.is_empty() && list.iter().enumerate().all(|(index, adapter)| adapter.index == index));
    for wish in ["no such device", "999"] {
        let options = GpuOptions { device: Some(wish.into()), ..GpuOptions::default() };
        let text = message(Gpu::new(&options));
        assert!(text.contains(wish) && text.contains(&list[0].name), "{text}");
    }
    let options = GpuOptions { device: Some(list[0].name.to_uppercase()), ..GpuOptions::default() };
    assert_eq!(Gpu::new(&options).unwrap().info.name, list[0].name);
}

/// Loads and compiles `main.wgsl` among the given files.
fn compiled(files: &[(&str, &str)], constants: &str) -> Result<Shader, Error> {
    let files = files.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect();
    Shader::load("main.wgsl", constants, &Folder::Given(files))?.compile().map(|compiled| compiled.shader)
}

#[test]
fn a_kernel_depends_on_the_overrides_that_it_reads() {
    // Through functions, in whatever statement they are called, and not those of its neighbour.
    let text = "override A: u32; override B: u32 = 1; override C: u32; override D: u32;
        @group(0) @binding(0) var<storage, read_write> out: array<u32>;
        fn deep() { out[0] = A; }
        fn middle(n: u32) { for (var k = 0u; k < n; k++) { switch k { case 1u: { deep(); } default: { } } } }
        fn value() -> u32 { return B; }
        @compute @workgroup_size(1) fn first() { if out[1] > 2u { middle(value()); } }
        @compute @workgroup_size(1) fn second() { out[2] = C; }";
    let files = vec![("main.wgsl".to_owned(), text.to_owned())];
    let compiled = Shader::load("main.wgsl", "", &Folder::Given(files)).unwrap().compile().unwrap();
    let read = |entry: &str| ["A", "B", "C", "D"].map(|name| compiled.reads_override(entry, name).unwrap());
    assert_eq!((read("first"), read("second")), ([true, true, false, false], [false, false, true, false]));
}

#[test]
fn shader_errors_name_the_original_line() {
    let syntax = compiled(&[("main.wgsl", "#include \"a.wgsl\"\nfn f() {}"), ("a.wgsl", "fn g() {}\nfn h( {}")], "");
    let text = message(syntax);
    assert!(text.contains("shaders/a.wgsl:2:7"), "{text}");
    let wrong = "#include \"a.wgsl\"\nfn f() -> f32 {\n    return 1u;\n}";
    let text = message(compiled(&[("main.wgsl", wrong), ("a.wgsl", "fn g() {}")], "const A: u32 = 1u;"));
    assert!(text.contains("shaders/main.wgsl:3:"), "{text}");
    let text = message(compiled(&[("main.wgsl", "fn f() {}")], "const A: u32 = 1.5f;"));
    assert!(text.contains("<constants>:2:"), "{text}");
}

#[test]
fn includes_are_taken_once_and_wrong_ones_are_errors() {
    let twice = "enable f16;\n#include \"a.wgsl\"\n#include \"b.wgsl\"\nfn f() -> u32 { return a() + A; }";
    let files = [("main.wgsl", twice), ("a.wgsl", "fn a() -> u32 { return 1u; }"), ("b.wgsl", "#include \"a.wgsl\"")];
    let given = files.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect();
    let shader = Shader::load("main.wgsl", "const A: u32 = 1u;", &Folder::Given(given)).unwrap();
    assert!(
        shader.text.starts_with(
            "enable f16;\nconst WORKGROUP: u32 = 64u; const MAX_GROUPS: u32 = 65535u; const OCTET: u32 = 8u;\nconst A"
        ),
        "{}",
        shader.text
    );
    assert_eq!(shader.text.matches("fn a()").count(), 1);
    assert_eq!(shader.files(), ["main.wgsl", "a.wgsl", "b.wgsl"]);
    for (files, expected) in [
        (vec![("main.wgsl", "\n#include \"c.wgsl\"")], "`c.wgsl` was given, included from main.wgsl:2"),
        (vec![("main.wgsl", "#include c.wgsl")], "is not a directive"),
        (vec![("main.wgsl", "#if FOO")], "is not a directive"),
        (
            vec![("main.wgsl", "#include \"a.wgsl\""), ("a.wgsl", "#include \"main.wgsl\"")],
            "cycle of includes: main.wgsl -> a.wgsl -> main.wgsl",
        ),
    ] {
        let text = message(compiled(&files, ""));
        assert!(text.contains(expected), "{text}");
    }
}
