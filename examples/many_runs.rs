//! Runs of the command line in one process: kernels are compiled for the first of them. `scripts/resume-test` works with it.
//!
//! Each line of standard input is a list of arguments of `brisance run` in JSON, as in `["sod", "--out", "out/sod"]`; each is answered by a
//! line with `ok`, or with the error in JSON.

#![allow(clippy::disallowed_macros, reason = "the streams belong to the program")]

use std::io::BufRead;

use brisance::{Gpu, Result, cli};

fn main() -> Result<()> {
    let gpu = Gpu::best()?;
    for line in std::io::stdin().lock().lines().map_while(std::result::Result::ok) {
        let words: Vec<String> = serde_json::from_str(&line).unwrap_or_default();
        match cli::run_on(&gpu, &words) {
            Ok(()) => println!("ok"),
            Err(error) => println!("{}", serde_json::json!({ "code": error.exit_code(), "error": error.to_string() })),
        }
    }
    Ok(())
}
