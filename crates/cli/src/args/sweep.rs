//! Arguments of `percute sweep`.

use super::{steps, threads};
use clap::Args;
use std::path::PathBuf;

/// Arguments of `percute sweep`.
#[derive(Clone, Debug, Default, Args)]
pub struct SweepArguments {
    /// The sweep file (TOML): the `case`, and values of its keys in `grid`, `list` or a `table`
    pub sweep: PathBuf,
    /// The folder of all cases and of the table [default: as in the file, or named after it in the working directory]
    #[arg(short = 'o', long, value_name = "FOLDER")]
    pub folder: Option<PathBuf>,
    /// Number of processes at a time [default: one for each core]
    #[arg(long, value_name = "N", value_parser = threads)]
    pub jobs: Option<usize>,
    /// Number of threads of each process; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = threads, default_value = "1")]
    pub threads: Option<usize>,
    /// Run a part of the cases only: those with the numbers K, K + N, K + 2N …, counted from 0; for job arrays
    #[arg(long, value_name = "K", requires = "of")]
    pub index: Option<usize>,
    /// The number of parts
    #[arg(long, value_name = "N", requires = "index", value_parser = steps)]
    pub of: Option<usize>,
    /// Run nothing; make the table of the cases that are done
    #[arg(long, conflicts_with_all = ["index", "force"])]
    pub collect: bool,
    /// Run nothing; print the names of the cases, with their status
    #[arg(long, conflicts_with_all = ["index", "force", "collect"])]
    pub list: bool,
    /// Run all cases and replace their results, also those of another case file or version
    #[arg(long)]
    pub force: bool,
    /// Allow runs of more than 1e10 elements times steps, which take minutes to hours
    #[arg(long)]
    pub long: bool,
    /// No progress on standard error
    #[arg(long)]
    pub quiet: bool,
}
