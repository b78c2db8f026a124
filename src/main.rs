//! Command line only: see [`brisance::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    brisance::cli::main()
}
