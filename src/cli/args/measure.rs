//! Arguments of the verbs that judge the program and its device.

use std::path::PathBuf;

use clap::Args;

use super::SceneOptions;
use crate::gpu::Detail;

/// Options of `selftest`.
#[derive(Debug, Args)]
pub struct SelftestOptions {
    /// Larger cases, and a larger bench
    #[arg(long)]
    pub full: bool,
    /// Only cases whose names contain this
    #[arg(long, value_name = "TEXT")]
    pub filter: Option<String>,
    /// Where the file goes [default: selftest-DEVICE.json]
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

/// Options of `shaders`.
#[derive(Debug, Args)]
pub struct ShadersOptions {
    /// Shipped scenes or scene files [default: all shipped scenes]
    pub scenes: Vec<String>,
    /// Folder that gets them; what is there stays
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// Options of `bench`.
#[derive(Debug, Args)]
pub struct BenchOptions {
    /// What to measure.
    #[command(flatten)]
    pub scene: SceneOptions,
    /// Cells of the whole domain at most; chooses the resolution
    #[arg(long, value_name = "N", conflicts_with = "resolution")]
    pub cells: Option<u64>,
    /// Steps to measure
    #[arg(long, value_name = "N", default_value_t = 50, value_parser = clap::value_parser!(u32).range(1..))]
    pub steps: u32,
    /// Steps before the measurement
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub warmup: u32,
    /// Time every kernel instead of whole stages
    #[arg(long)]
    pub kernels: bool,
    /// Compare with what `bench SCENE --json` printed into this file at an earlier time
    #[arg(long, value_name = "FILE", conflicts_with = "sweep")]
    pub compare: Option<PathBuf>,
    /// Measure at several resolutions, cells along the longest axis, for example 32,64,128
    #[arg(long, value_name = "CELLS", value_delimiter = ',', conflicts_with_all = ["resolution", "cells"])]
    pub sweep: Vec<u32>,
}

impl BenchOptions {
    /// What the stopwatch tells apart.
    #[must_use]
    pub fn detail(&self) -> Detail {
        if self.kernels { Detail::Kernels } else { Detail::Stages }
    }
}

/// Options of `verify`.
#[derive(Debug, Args)]
pub struct VerifyOptions {
    /// The short suite: minutes on two processor cores [default]
    #[arg(long, conflicts_with = "full")]
    pub quick: bool,
    /// Every case, resolution, element pair and time integration
    #[arg(long)]
    pub full: bool,
    /// Only cases whose name, title or group contains this
    #[arg(long, value_name = "TEXT", default_value = "")]
    pub filter: String,
    /// Folder for report.html and verify.json
    #[arg(long, value_name = "DIR", default_value = "verify")]
    pub out: PathBuf,
    /// Print the cases and run none
    #[arg(long)]
    pub list: bool,
    /// Print the tables as Markdown
    #[arg(long)]
    pub markdown: bool,
}
