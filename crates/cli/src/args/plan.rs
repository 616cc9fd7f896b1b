//! The arguments of `percute plan`.

use super::{adapt::target, threads};
use clap::Args;
use std::path::PathBuf;

/// Arguments of `percute plan`.
#[derive(Clone, Debug, Default, Args)]
pub struct PlanArguments {
    /// A case, which is run, or a history (.vtkhdf), also of another program
    pub file: PathBuf,
    /// The relative mean error to reach, such as 3% or 0.03
    #[arg(long, value_name = "ERROR", value_parser = target)]
    pub target: f64,
    /// Write the planned sizes to this file (.pos), a background field for `gmsh -bgm` and other mesh generators
    #[arg(long, value_name = "FILE")]
    pub size_field: Option<PathBuf>,
    /// Metres per unit of length in the size field: 1e-3 for millimetres
    #[arg(long, value_name = "M", default_value_t = 1.0)]
    pub scale: f64,
    /// Print one JSON document instead of the plan
    #[arg(long)]
    pub json: bool,
    /// Replace an existing size field
    #[arg(long)]
    pub force: bool,
    /// Allow a run of more than 1e10 elements times steps, which takes minutes to hours
    #[arg(long)]
    pub long: bool,
    /// Estimate a history of another program although it contradicts itself or its problem
    #[arg(long)]
    pub accept_inconsistent: bool,
    /// Number of threads [default: one for each core]; the result does not depend on it
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
    /// No progress and no warnings on standard error
    #[arg(long)]
    pub quiet: bool,
}
