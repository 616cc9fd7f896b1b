//! The arguments of `percute export`.

use super::{steps, times};
use clap::Args;
use std::ffi::OsString;
use std::path::PathBuf;

/// Arguments of `percute export`.
#[derive(Clone, Debug, Default, Args)]
pub struct ExportArguments {
    /// The history (.vtkhdf)
    pub history: PathBuf,
    /// The file to write: .vtkhdf (all instants in one file), .vtu or .pvd (a file for each instant, and an index)
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    /// Steps to write, counted from 0 and separated by commas; negative ones count from the end; of a history that
    /// keeps a part of its run, the instants kept are counted [default: all]
    #[arg(long, value_name = "STEPS", value_delimiter = ',', allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["every", "times"])]
    pub steps: Option<Vec<i64>>,
    /// Write every k-th step and the last
    #[arg(long, value_name = "K", value_parser = steps, conflicts_with = "times")]
    pub every: Option<usize>,
    /// Write the steps nearest to these times in s, separated by commas
    #[arg(long, value_name = "TIMES", value_parser = times)]
    pub times: Option<Times>,
    /// Fields, separated by commas, of displacement, velocity, acceleration, reaction, stress, von_mises, pressure,
    /// equivalent_plastic_strain, error [default: displacement, velocity, reaction, stress, von_mises,
    /// equivalent_plastic_strain where a material yields, and error with --estimate]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub fields: Option<Vec<String>>,
    /// An estimate file of this history: adds the error of each element
    #[arg(long, value_name = "FILE")]
    pub estimate: Option<PathBuf>,
    /// Replace existing files
    #[arg(long)]
    pub force: bool,
    /// No progress on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// Whether an option stands where the numbers of `--steps` should be: clap would take it for them, as they may be
/// negative.
pub(crate) fn lacks_steps(arguments: &[OsString]) -> bool {
    let is_option = |argument: &OsString| argument.as_encoded_bytes().starts_with(b"--");
    arguments.get(1).is_some_and(|command| command == "export")
        && arguments.windows(2).any(|pair| pair[0] == "--steps" && is_option(&pair[1]))
}

/// Times (s) of one argument.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times(pub Vec<f64>);
