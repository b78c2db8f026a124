//! The command line: verbs, their output, exit codes. People read standard output and standard error; `--json` prints one
//! object on standard output for programs.

/// Prints a line on standard output. A reader that has gone away, as in `brisance list | head -1`, is no error of ours.
macro_rules! say {
    ($($text:tt)*) => { $crate::cli::write_line(&mut std::io::stdout(), &format!($($text)*)) };
}

/// Prints a line on standard error. A terminal that has gone away never ends a run.
macro_rules! tell {
    ($($text:tt)*) => { $crate::cli::write_line(&mut std::io::stderr(), &format!($($text)*)) };
}

mod args;
mod bench;
mod check;
mod convert;
mod duration;
mod film;
mod folder;
mod fragments;
mod gallery;
mod gauges;
mod index;
mod init;
mod interrupt;
mod list;
mod loads;
mod outcome;
mod page;
mod probes;
mod progress;
mod render;
mod run;
mod scenes;
mod selftest;
mod shaders;
mod sweep;
mod tables;
#[cfg(feature = "verify")]
mod verify;
mod view;
mod writer;

pub use args::{Cli, Command};

use std::io::Write;
use std::panic::{self, AssertUnwindSafe};
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::{CommandFactory, Parser};
use serde_json::json;

use crate::gpu::{Gpu, GpuOptions};
use crate::{Error, Result};

/// Writes a line, or nothing where nobody reads. What foreign files say may be in it, so characters that command a terminal are spelt.
pub(crate) fn write_line(to: &mut impl Write, text: &str) {
    let commands = |letter: char| letter.is_control() && !matches!(letter, '\n' | '\r' | '\t');
    let mut line = String::with_capacity(text.len() + 1);
    for letter in text.chars() {
        match commands(letter) {
            true => line.extend(letter.escape_default()),
            false => line.push(letter),
        }
    }
    line.push('\n');
    let _ = to.write_all(line.as_bytes());
}

/// Exit code of a bug of ours.
const INTERNAL: u8 = 1;

/// Runs the program: reads the arguments, does what they say, reports errors once, and returns the exit code.
#[must_use]
pub fn main() -> ExitCode {
    with_runtime_folder();
    panic::set_hook(Box::new(|info| tell!("{}", bug_report(info))));
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(message) => {
            // Help and version come this way too, with code 0; a closed pipe is no error of ours.
            let _ = message.print();
            return ExitCode::from(u8::try_from(message.exit_code()).unwrap_or(INTERNAL));
        }
    };
    let json = cli.json;
    match panic::catch_unwind(AssertUnwindSafe(|| execute(&cli))) {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(error)) => {
            report(&error, json);
            ExitCode::from(error.exit_code())
        }
        Err(_) => ExitCode::from(INTERNAL),
    }
}

/// `brisance run` with these arguments, on a device that is open: kernels that it has compiled serve the next run, too.
///
/// # Errors
/// Those of the run; [`Error::Usage`] for arguments that `run` does not take.
pub fn run_on(gpu: &Gpu, arguments: &[String]) -> Result<()> {
    let words = ["brisance", "run"].into_iter().chain(arguments.iter().map(String::as_str));
    let read = Cli::try_parse_from(words).map_err(|error| Error::Usage(error.to_string()))?;
    match &read.command {
        Some(Command::Run(options)) => run::perform_on(gpu, options),
        _ => Ok(()),
    }
}

/// Starts the program again with a folder that graphics drivers ask for and complain about, where there is none by a whole path.
fn with_runtime_folder() {
    #[cfg(target_os = "linux")]
    if !std::env::var_os("XDG_RUNTIME_DIR").is_some_and(|folder| std::path::Path::new(&folder).is_absolute())
        && let Ok(program) = std::env::current_exe()
    {
        use std::os::unix::process::CommandExt;
        // It returns only where that is not possible; then the driver complains.
        let again = &mut std::process::Command::new(program);
        let _ = again.args(std::env::args_os().skip(1)).env("XDG_RUNTIME_DIR", std::env::temp_dir()).exec();
    }
}

/// One line for a panic, which is always a bug.
fn bug_report(info: &panic::PanicHookInfo<'_>) -> String {
    let payload = info.payload();
    let text = payload.downcast_ref::<&str>().copied().or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    let place = info.location().map_or_else(String::new, |place| format!(" at {}:{}", place.file(), place.line()));
    let text = text.unwrap_or("no message").replace('\n', " ");
    let version = env!("CARGO_PKG_VERSION");
    format!("error: a bug in brisance {version}{place}: {text}; please report it with the scene and `brisance devices`")
}

/// Prints an error: one sentence or the scene's findings on standard error, and an object on standard output if asked.
fn report(error: &Error, json: bool) {
    let text = error.to_string();
    // The findings of a scene bring their own heads.
    let head = if text.starts_with("error") { "" } else { "error: " };
    tell!("{head}{}", text.trim_end());
    if json {
        say!("{}", json!({ "error": { "code": error.exit_code(), "kind": kind(error), "message": text } }));
    }
}

/// Name of an error's family in JSON.
fn kind(error: &Error) -> &'static str {
    match error {
        Error::Usage(_) => "usage",
        Error::Scene(_) => "scene",
        Error::NoAdapter(_) => "no_adapter",
        Error::DoesNotFit(_) => "does_not_fit",
        Error::Diverged { .. } => "diverged",
        Error::Expectation(_) => "expectation",
        Error::Spoilt(_) => "spoilt",
        Error::Io { .. } => "io",
        Error::Film(_) => "film",
        Error::Gpu(_) => "gpu",
        Error::Bug(_) => "bug",
        Error::Interrupted => "interrupted",
        Error::Shader(_) => "shader",
    }
}

fn execute(cli: &Cli) -> Result<()> {
    let Some(command) = &cli.command else { return window(cli) };
    match command {
        Command::View(options) => view::view(Some(options), cli),
        Command::Run(options) => run::run(options, cli),
        Command::Render(options) => render::render(options, cli),
        Command::Convert(options) => convert::convert(options, cli),
        Command::Gallery(options) => gallery::gallery(options, cli),
        Command::Sweep(options) => sweep::sweep(options, cli),
        Command::Check(options) => check::check(options, cli),
        Command::Bench(options) => bench::bench(options, cli),
        #[cfg(feature = "verify")]
        Command::Verify(options) => verify::verify(options, cli),
        #[cfg(not(feature = "verify"))]
        Command::Verify(_) => Err(Error::Usage(
            "this program was built without its cases; build it with `cargo build --release --features verify`"
                .to_owned(),
        )),
        Command::Devices => list::devices(cli),
        Command::Selftest(options) => selftest::selftest(options, cli),
        Command::Shaders(options) => shaders::shaders(options, cli),
        Command::List => list::scenes(cli.json),
        Command::Schema => {
            say!("{}", crate::scene::schema());
            Ok(())
        }
        Command::Init(options) => init::init(options),
        Command::Show { scene } => init::show(scene),
        Command::Man => {
            let mut page = Vec::new();
            let written = clap_mangen::Man::new(Cli::command()).render(&mut page);
            written.map_err(|source| Error::io("standard output", source))?;
            say!("{}", String::from_utf8_lossy(&page));
            Ok(())
        }
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut Cli::command(), "brisance", &mut script);
            say!("{}", String::from_utf8_lossy(&script));
            Ok(())
        }
    }
}

/// Without a verb: the window, or the help where there is none.
fn window(cli: &Cli) -> Result<()> {
    view::view(None, cli).inspect_err(|error| {
        if matches!(error, Error::Usage(_)) && !cli.json {
            tell!("{}", Cli::command().render_help());
        }
    })
}

/// Opens the device that the command line names; a processor in the role of a GPU is announced, once.
fn open_device(cli: &Cli) -> Result<Gpu> {
    static ANNOUNCED: AtomicBool = AtomicBool::new(false);
    let gpu = Gpu::new(&GpuOptions {
        device: cli.device.clone(),
        stop: Some(interrupt::wish),
        compiling: Some(progress::compiling),
        ..GpuOptions::default()
    })?;
    if gpu.is_software() && !ANNOUNCED.swap(true, Ordering::Relaxed) {
        let name = &gpu.info.name;
        tell!("warning: SOFTWARE DEVICE: {name} computes on the CPU; results are the same, only slower than on a GPU");
    }
    Ok(gpu)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_a_file_says_commands_the_terminal() {
        let mut line = Vec::new();
        write_line(&mut line, "`\u{1b}[31mred\u{7}\u{9b}` is no name:\n\tcafé");
        assert_eq!(String::from_utf8(line).unwrap(), "`\\u{1b}[31mred\\u{7}\\u{9b}` is no name:\n\tcafé\n");
    }
}
