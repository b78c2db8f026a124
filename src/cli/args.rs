//! Arguments of all verbs.

mod measure;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use serde::{Deserialize, Serialize};

pub(super) use measure::{BenchOptions, SelftestOptions, ShadersOptions, VerifyOptions};

use super::run::Every;
use crate::export::video::FRAME_RATE;

/// Compressible gas, shock waves and the solids they bend, tear and shatter.
#[derive(Debug, Parser)]
#[command(name = "brisance", version)]
#[command(after_help = "Exit codes: 0 done, 1 internal, 2 usage, 3 scene, 4 no device, 5 does not fit, 7 diverged, \
                        8 expectation or gate failed, 9 disk, 75 device lost, 130 interrupted")]
pub struct Cli {
    /// What to do; without a verb the gallery of scenes opens.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// Print one JSON object on standard output
    #[arg(long, global = true)]
    pub json: bool,
    /// Index or part of the name of the device, see `brisance devices`; BRISANCE_DEVICE does the same
    #[arg(long, global = true, value_name = "DEVICE")]
    pub device: Option<String>,
}

/// The verbs.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a scene: pictures, tables and a report
    Run(RunOptions),
    /// Draw the frames of a run again, with another camera or look, without simulating
    Render(RenderOptions),
    /// Write the states of a run for other programs: vtk, vdb, usd, mesh, npz, exr
    Convert(ConvertOptions),
    /// Watch a scene in a live window; without a verb, the gallery of all scenes
    View(ViewOptions),
    /// Run scenes one after another and write one page that shows them all
    Gallery(GalleryOptions),
    /// Run a scene over ranges of its keys, in one process that compiles its kernels once
    Sweep(SweepOptions),
    /// Check a scene and print cells, particles, memory and every default
    Check(CheckOptions),
    /// Measure a scene: a table of stages, then totals per second
    Bench(BenchOptions),
    /// Compare the method with numbers from elsewhere: a table, a page with plots, an exit code
    Verify(VerifyOptions),
    /// List the devices, best first, with limits, features, and which one is chosen and why
    Devices,
    /// Check that the device computes what it should: a table, a file for an issue, exit code 8 with the first wrong stage
    Selftest(SelftestOptions),
    /// Write every kernel of scenes as other compilers get it: final text, entry point, overrides
    Shaders(ShadersOptions),
    /// List the shipped scenes
    List,
    /// Print the JSON schema of scene files
    Schema,
    /// Write a commented scene to start from
    Init(InitOptions),
    /// Print the text of a shipped scene
    Show {
        /// Name of a shipped scene, see `brisance list`
        scene: String,
    },
    /// Print the manual page, for `man -l -`
    Man,
    /// Print a completion script, for example `brisance completions bash > ~/.local/share/bash-completion/completions/brisance`
    Completions {
        /// For which shell.
        shell: clap_complete::Shell,
    },
}

/// A scene and what to change about it.
#[derive(Clone, Debug, Default, Args, Serialize, Deserialize)]
pub struct SceneOptions {
    /// Scene file, or name of a shipped scene (see `brisance list`)
    pub scene: String,
    /// Variant of the scene, one of those that `brisance check` lists; may be repeated
    #[arg(long = "variant", value_name = "NAME")]
    pub variant: Vec<String>,
    /// Change a key of the scene, for example gas.ambient.density=2; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Read mesh files outside of the scene's folder, too
    #[arg(long)]
    pub allow_outside: bool,
    /// Cells along the longest axis
    #[arg(long, value_name = "CELLS")]
    pub resolution: Option<u32>,
}

/// Options of `init`.
#[derive(Debug, Args)]
pub struct InitOptions {
    /// Name of the new scene file
    #[arg(default_value = "scene.toml")]
    pub name: String,
    /// Three dimensions instead of two
    #[arg(long = "3d", conflicts_with_all = ["shock_tube", "from"])]
    pub in_3d: bool,
    /// A shock tube instead of a blast
    #[arg(long, conflicts_with = "from")]
    pub shock_tube: bool,
    /// A copy of a shipped scene
    #[arg(long, value_name = "SCENE")]
    pub from: Option<String>,
}

/// Options of `view`.
#[derive(Debug, Args)]
pub struct ViewOptions {
    /// What to watch.
    #[command(flatten)]
    pub scene: SceneOptions,
    /// Run as fast as the device can; otherwise the whole run takes 12 seconds at least
    #[arg(long)]
    pub full_speed: bool,
}

/// Options of `check`.
#[derive(Debug, Args)]
pub struct CheckOptions {
    /// What to check.
    #[command(flatten)]
    pub scene: SceneOptions,
    /// Draw the start, as `run` does, and write it here as PNG
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
}

/// Options of `run`.
#[derive(Clone, Debug, Default, Args, Serialize, Deserialize)]
#[serde(default)]
pub struct RunOptions {
    /// What to run.
    #[command(flatten)]
    pub scene: SceneOptions,
    /// Folder for the results [default: out/SCENE, or the next free name beside it]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// End of the run [s], instead of time.until
    #[arg(long, value_name = "TIME", allow_negative_numbers = true)]
    pub until: Option<f64>,
    /// Pictures besides the first, instead of time.frames
    #[arg(long, value_name = "N")]
    pub frames: Option<u32>,
    /// Further formats: png16, exr, fields, vtk, vdb, usd, mesh, npz; separated by commas, may be repeated
    #[arg(long, value_name = "FORMAT", value_delimiter = ',')]
    pub export: Vec<String>,
    /// Go on with a run from its latest checkpoint: SCENE is its folder; --until may be later
    #[arg(long, conflicts_with = "branch")]
    pub resume: bool,
    /// Start a new run from a state of another one: SCENE is DIR@TIME; --set changes probes, output, look, gravity, states of sides,
    /// times, tolerance, strength of materials
    #[arg(long)]
    pub branch: bool,
    /// Leave a checkpoint every so often: 500steps, 90s, 10min, 2h on the clock, t=0.01 in simulated seconds, or off [default: 10min]
    #[arg(long, value_name = "EVERY")]
    pub checkpoint: Option<Every>,
    /// Checkpoints that stay [default: 2]
    #[arg(long, value_name = "N")]
    pub keep: Option<usize>,
    /// A film.
    #[command(flatten)]
    pub film: FilmOptions,
    /// Write tables and report, but no pictures
    #[arg(long)]
    pub no_frames: bool,
    /// Replace what an earlier run wrote into --out
    #[arg(long)]
    pub force: bool,
    /// Do not compare the result with the scene's [expect]
    #[arg(long)]
    pub no_expect: bool,
    /// Fail if the result does not meet the scene's [expect], also where resolution, physics or end were changed by hand
    #[arg(long, conflicts_with = "no_expect")]
    pub expect: bool,
    /// Fail if the run is warned of anything that the scene does not expect, see docs/inside/warnings.md
    #[arg(long)]
    pub strict: bool,
    /// Print nothing but warnings and errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// A film of the pictures.
#[derive(Clone, Debug, Default, Args, Serialize, Deserialize)]
pub struct FilmOptions {
    /// Make a film of the pictures with ffmpeg, where it is installed; the name says the format, as in film.mp4
    #[arg(long, value_name = "FILE")]
    pub video: Option<PathBuf>,
    /// Pictures per second of the film
    #[arg(long, value_name = "N", default_value_t = FRAME_RATE, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub fps: u32,
}

/// Options of `render`.
#[derive(Debug, Default, Args)]
pub struct RenderOptions {
    /// Folder of a run that has states: `brisance run SCENE --export fields`
    pub run: PathBuf,
    /// Read files outside of the folder of the run, too: meshes where the run found them, and what links lead to
    #[arg(long)]
    pub allow_outside: bool,
    /// Take [render] and output.fields from another scene file, or from a shipped scene
    #[arg(long, value_name = "SCENE")]
    pub scene: Option<String>,
    /// Change a key of [render] or output.fields, for example render.colormap=inferno; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Only this view; `main` is the scene's own look; may be repeated
    #[arg(long = "view", value_name = "NAME")]
    pub view: Vec<String>,
    /// Fields instead of output.fields; may be repeated
    #[arg(long = "field", value_name = "FIELD")]
    pub field: Vec<String>,
    /// Camera of the scene's own look as a TOML table, for example "{ eye = [2, -2, 1], target = [0, 0, 0] }"
    #[arg(long, value_name = "TABLE")]
    pub camera: Option<String>,
    /// Width and height in pixels, for example 3840x2160
    #[arg(long, value_name = "WxH")]
    pub size: Option<String>,
    /// Only this frame; may be repeated
    #[arg(long = "frame", value_name = "N")]
    pub frame: Vec<u32>,
    /// Folder for the frames [default: RUN/again]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Formats: png, png16, exr [default: png]; separated by commas, may be repeated
    #[arg(long, value_name = "FORMAT", value_delimiter = ',')]
    pub export: Vec<String>,
    /// A film.
    #[command(flatten)]
    pub film: FilmOptions,
    /// Print nothing but warnings and errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// Options of `sweep`.
#[derive(Debug, Args)]
pub struct SweepOptions {
    /// What to run.
    #[command(flatten)]
    pub scene: SceneOptions,
    /// A key and its values: KEY=a,b,c or KEY=low:high:count; may be repeated, then all combinations run
    #[arg(long = "over", value_name = "KEY=VALUES", required = true)]
    pub over: Vec<String>,
    /// Instead of all combinations so many points of a Latin hypercube, for example lhs:50
    #[arg(long, value_name = "lhs:COUNT")]
    pub sample: Option<String>,
    /// Seed of the sample
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Only one part of the runs, for array jobs, for example 3/10
    #[arg(long, value_name = "PART/PARTS")]
    pub shard: Option<String>,
    /// Run once up to this time [s], and begin every run from there; KEYs are those that `run --branch` may change
    #[arg(long, value_name = "TIME", allow_negative_numbers = true)]
    pub branch_at: Option<f64>,
    /// Folder for the runs, sweep.csv and sweep.html; runs that are finished there are not run again
    #[arg(long, value_name = "DIR", default_value = "out/sweep")]
    pub out: PathBuf,
    /// End of the runs [s], instead of time.until
    #[arg(long, value_name = "TIME")]
    pub until: Option<f64>,
    /// Pictures besides the first, instead of time.frames
    #[arg(long, value_name = "N")]
    pub frames: Option<u32>,
    /// Further formats, as those of `run`; separated by commas, may be repeated
    #[arg(long, value_name = "FORMAT", value_delimiter = ',')]
    pub export: Vec<String>,
    /// Write tables and reports, but no pictures
    #[arg(long)]
    pub no_frames: bool,
    /// Print nothing but warnings and errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// Options of `convert`.
#[derive(Clone, Debug, Args)]
pub struct ConvertOptions {
    /// Folder of a run that has states (`brisance run SCENE --export fields`) or checkpoints
    pub run: PathBuf,
    /// Read files outside of the folder of the run, too: meshes of obstacles where the run found them, and what links lead to
    #[arg(long)]
    pub allow_outside: bool,
    /// Formats: vtk, vdb, usd, mesh, npz, and exr, which needs a device; separated by commas, may be repeated
    #[arg(long, value_name = "FORMAT", value_delimiter = ',', required = true)]
    pub to: Vec<String>,
    /// Only this frame; may be repeated
    #[arg(long = "frame", value_name = "N")]
    pub frame: Vec<u32>,
    /// What the ambient gas has [K]: volumes have temperatures in kelvin; instead of the scene's output.ambient_kelvin
    #[arg(long, value_name = "K", value_parser = kelvin, allow_negative_numbers = true)]
    pub kelvin: Option<f64>,
    /// Folder for the files [default: RUN]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print nothing but warnings and errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// A temperature that gas can have.
fn kelvin(text: &str) -> Result<f64, String> {
    let read = text.parse().ok().filter(|kelvin: &f64| *kelvin > 0.0 && kelvin.is_finite());
    read.ok_or_else(|| "a temperature in kelvin is a number above 0, as in 293".to_owned())
}

/// How large the scenes of a gallery run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Scale {
    /// The variant `small` of scenes that have one; minutes on a processor
    Small,
    /// The variant `gallery` of scenes that have one, else `small`; a quarter of an hour each on a processor
    Gallery,
    /// As the scene is; for a GPU
    Full,
}

impl Scale {
    /// Its word on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Scale::Small => "small",
            Scale::Gallery => "gallery",
            Scale::Full => "full",
        }
    }
}

/// Options of `gallery`.
#[derive(Debug, Args)]
pub struct GalleryOptions {
    /// Scenes, folders of shipped scenes such as `demos`, or SCENE:VARIANT [default: paper demos]
    pub names: Vec<String>,
    /// Size of the scenes
    #[arg(long, value_enum, default_value_t = Scale::Small)]
    pub scale: Scale,
    /// Folder for gallery.html and the runs
    #[arg(long, value_name = "DIR", default_value = "out/gallery")]
    pub out: PathBuf,
    /// Scenes at a time [default: 1; on a software device one per processor core, 4 at most]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..))]
    pub jobs: Option<u8>,
    /// Show no progress within a scene, as when several run at a time
    #[arg(long, short)]
    pub quiet: bool,
}
