//! What other programs and spoiled files hold: refused with a reason, or read.

use std::path::Path;

use brisance::export::container::{self, Array, Numbers, Source};

use crate::checkpoint::SHORT;
use crate::cli::{fails, succeeds};
use crate::common::folder_or_skip;

#[test]
fn what_a_later_program_wrote_is_refused_and_what_the_first_wrote_is_read() {
    let Some(place) = folder_or_skip() else { return };
    let run = place.path().join("run");
    let out = run.display().to_string();
    let asked = ["--until", "0.02", "--frames", "1", "--no-frames", "--export", "states", "--checkpoint", "t=0.01"];
    succeeds(&[&SHORT[..], &asked, &["--out", &out]].concat());
    let convert = ["convert", &out, "--to", "npz", "-q"];
    let swap = |name: &str, one: &str, other: &str| {
        let text = std::fs::read_to_string(run.join(name)).unwrap();
        assert!(text.contains(one), "{name}: {text}");
        std::fs::write(run.join(name), text.replacen(one, other, 1)).unwrap();
    };
    let (at, branch) = (format!("{out}@0.01"), place.path().join("branch").display().to_string());
    let refused = |file: &str, form: u32| {
        let verbs: [&[&str]; 5] = [
            &convert,
            &["render", &out],
            &["run", "--resume", &out, "-q"],
            &["run", "--branch", &at, "-q", "--out", &branch],
            #[cfg(feature = "viewer")]
            &["view", &out],
            #[cfg(not(feature = "viewer"))]
            &convert,
        ];
        for verb in verbs {
            let told = fails(6, verb);
            assert!(
                told.contains(file) && told.contains(&format!("in form {form}")) && told.contains("newer program"),
                "{told}"
            );
        }
    };
    swap("report.json", "\"form\": 2,", "\"form\": 3,");
    refused("report.json", 3);
    swap("report.json", "\"form\": 3,", "");
    succeeds(&convert);
    spoiled_states_are_refused(&run, &convert);
    swap("run.json", "\"version\": 1,", "\"version\": 2,");
    refused("run.json", 2);
    swap("run.json", "\"version\": 2,", "\"version\": 1,");
    succeeds(&["run", "--resume", &out, "-q", "--no-expect"]);
}

/// Changes the arrays of a state.
type Spoil<'a> = &'a dyn Fn(&mut Vec<Array>);

/// States with an array too many, one cut, one with NaN: what `convert` says of them, and what whoever goes on from them or looks at them.
fn spoiled_states_are_refused(run: &Path, convert: &[&str]) {
    let one_more = |arrays: &mut Vec<Array>| {
        let other = Array { name: "banana".to_owned(), ..energy(arrays).clone() };
        arrays.push(other);
    };
    let cut = |arrays: &mut Vec<Array>| {
        let array = energy(arrays);
        array.numbers = Numbers::F32(vec![1.0; 3]);
        array.shape = vec![3];
    };
    let not_finite = |arrays: &mut Vec<Array>| {
        let array = energy(arrays);
        array.numbers = Numbers::F32(vec![f32::NAN; array.shape[0]]);
    };
    let spoilt: [(Spoil, &str, &str); 3] = [
        (&one_more, "`banana` is none of a state", "`banana` is none of this scene's"),
        (&cut, "`energy` has a wrong length", "`energy` has 3 words"),
        (&not_finite, "`energy` holds numbers that are not finite", "`energy`, word"),
    ];
    let state = run.join("states/0001.npz");
    let newest = brisance::export::checkpoint::list(run).unwrap().pop().unwrap().1;
    for (spoil, told, told_of_all) in spoilt {
        let good = [&state, &newest].map(|path| std::fs::read(path).unwrap());
        spoil_file(&state, spoil);
        let text = fails(6, convert);
        assert!(text.contains(told) && text.contains("0001.npz"), "{text}");
        spoil_file(&newest, spoil);
        let (out, name) = (run.to_str().unwrap(), newest.file_name().unwrap().to_str().unwrap());
        let branch = run.with_file_name("spoilt").display().to_string();
        let verbs: [&[&str]; 2] = [
            &["run", "--resume", out, "-q"],
            &["run", "--branch", &format!("{out}@0.02"), "--force", "--out", &branch],
        ];
        for verb in verbs {
            let text = fails(6, verb);
            assert!(text.contains(told_of_all) && text.contains(name), "{text}");
            assert!(!Path::new(&branch).exists(), "{verb:?} leaves a folder");
        }
        let (states, aside) = (run.join("states"), run.join("states_aside"));
        std::fs::rename(&states, &aside).unwrap();
        let text = fails(6, convert);
        assert!(text.contains(told) && text.contains(name), "{text}");
        std::fs::rename(&aside, &states).unwrap();
        #[cfg(feature = "viewer")]
        looked_at(run, (told_of_all, name));
        std::fs::write(&state, &good[0]).unwrap();
        std::fs::write(&newest, &good[1]).unwrap();
    }
}

/// The window shows no spoilt state.
#[cfg(feature = "viewer")]
fn looked_at(run: &Path, (told, name): (&str, &str)) {
    let Some(gpu) = crate::common::gpu_or_skip() else { return };
    let opened = brisance::viewer::session::Session::open_run(&gpu, run, &brisance::scene::Changes::default());
    let text = opened.map(|_| ()).unwrap_err().to_string();
    assert!(text.contains(told) && text.contains(name), "{text}");
}

fn spoil_file(path: &Path, spoil: Spoil) {
    let mut state = container::read(path, 1 << 24).unwrap();
    spoil(&mut state.arrays);
    let head = &state.head;
    let source = Source { scene: state.texts[container::SCENE].clone(), ..head.source.clone() };
    let texts = state.texts.iter().filter(|(name, _)| *name != container::SCENE);
    let texts: Vec<(&str, &str)> = texts.map(|(name, text)| (name.as_str(), text.as_str())).collect();
    container::write(path, (head.form, &source), (head.time, head.step), &texts, state.arrays.clone()).unwrap();
}

fn energy(arrays: &mut [Array]) -> &mut Array {
    arrays.iter_mut().find(|array| array.name == "energy").unwrap()
}
