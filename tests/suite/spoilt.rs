//! What other programs and spoiled files hold: refused with a reason, or read.

use std::path::Path;

use brisance::export::container::{self, Array, Form, Numbers, Source};

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
            let told = fails(2, verb);
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

/// A state with an array too many, one cut, one with NaN.
fn spoiled_states_are_refused(run: &Path, convert: &[&str]) {
    let path = run.join("states/0001.npz");
    let good = std::fs::read(&path).unwrap();
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
    let spoilt: [(Spoil, &str); 3] = [
        (&one_more, "`banana` is none of a state"),
        (&cut, "`energy` has a wrong length"),
        (&not_finite, "`energy` holds numbers that are not finite"),
    ];
    for (spoil, told) in spoilt {
        let mut state = container::read(&path, 1 << 20).unwrap();
        spoil(&mut state.arrays);
        let head = &state.head;
        let source = Source { scene: state.texts[container::SCENE].clone(), ..head.source.clone() };
        container::write(&path, (Form::Fields, &source), (head.time, head.step), &[], state.arrays.clone()).unwrap();
        let code = if told.contains("none of") { 9 } else { 2 };
        let text = fails(code, convert);
        assert!(text.contains(told) && text.contains("0001.npz"), "{text}");
        std::fs::write(&path, &good).unwrap();
    }
}

fn energy(arrays: &mut [Array]) -> &mut Array {
    arrays.iter_mut().find(|array| array.name == "energy").unwrap()
}
