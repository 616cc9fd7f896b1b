//! The arguments of `percute adapt`.

use super::threads;
use clap::Args;
use percute_workflow::adapt::{LIMIT, Measure, RUNS};
use percute_workflow::message::hint;
use percute_workflow::quantity::Quantity;
use std::path::PathBuf;

/// Arguments of `percute adapt`.
#[derive(Clone, Debug, Default, Args)]
pub struct AdaptArguments {
    /// The case file (TOML); its mesh is the first
    pub case: PathBuf,
    /// The relative error to reach, such as 3% or 0.03
    #[arg(long, value_name = "ERROR", value_parser = target)]
    pub target: f64,
    /// Error of the target: the mean or the largest (sup)
    #[arg(long, value_name = "MEASURE", default_value = "mean", value_parser = measure)]
    pub measure: Measure,
    /// Quantity of the target instead of the error, to this relative distance from its limit: peak_force, impulse,
    /// rebound, or a probe such as probe:0.01,0.02:von_mises
    #[arg(long, value_name = "QUANTITY", conflicts_with = "measure")]
    pub target_on: Option<Quantity>,
    /// Source of the meshes: bisection of the first mesh, or the program Gmsh
    #[arg(long, value_name = "MESHER", default_value = "bisect", value_parser = ["bisect", "gmsh"])]
    pub mesher: String,
    /// The geometry that Gmsh meshes (.geo, .step), with the groups of the first mesh [default: the outline of the
    /// first mesh, polygons]
    #[arg(long, value_name = "FILE", requires_if("gmsh", "mesher"))]
    pub geometry: Option<PathBuf>,
    /// Metres per unit of length in the geometry [default: `scale` of the case's mesh]
    #[arg(long, value_name = "M", requires = "geometry")]
    pub scale: Option<f64>,
    /// The most elements times steps of a run
    #[arg(long, value_name = "N", default_value_t = LIMIT)]
    pub limit: f64,
    /// The most runs
    #[arg(long, value_name = "N", default_value_t = RUNS)]
    pub runs: usize,
    /// Write the best mesh to this file (.msh)
    #[arg(long, value_name = "FILE")]
    pub save: Option<PathBuf>,
    /// Draw the error on the best mesh, and over the cost of the runs (.svg, .png)
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    /// Print one JSON document instead of the table
    #[arg(long)]
    pub json: bool,
    /// Replace existing files
    #[arg(long)]
    pub force: bool,
    /// Number of threads [default: one for each core]; the result does not depend on it
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
    /// No progress, cost and warnings on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// A relative error as a percentage or a fraction.
pub(super) fn target(text: &str) -> Result<f64, String> {
    let (number, unit) = text.trim().strip_suffix('%').map_or((text.trim(), 1.0), |number| (number.trim_end(), 100.0));
    let value: f64 = number.parse().map_err(|_| "must be a relative error, such as 3% or 0.03".to_string())?;
    if unit == 1.0 && (1.0..100.0).contains(&value) {
        return Err(format!("{value} is {} %; give {value}% or {}", 100.0 * value, value / 100.0));
    }
    Ok(value / unit)
}

fn measure(text: &str) -> Result<Measure, String> {
    let names = Measure::NAMES.map(|(name, _)| name);
    let found = Measure::NAMES.into_iter().find(|(name, _)| *name == text).map(|(_, measure)| measure);
    found.ok_or_else(|| format!("must be one of {}{}", names.join(", "), hint(text, names)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_are_percentages_or_fractions() {
        for (text, value) in [("3%", 0.03), ("2.5 %", 0.025), ("0.05", 0.05), ("5e-2", 0.05)] {
            assert!((target(text).unwrap() - value).abs() < 1e-15, "{text}");
        }
        assert_eq!(target("3").unwrap_err(), "3 is 300 %; give 3% or 0.03");
        assert!(target("three").is_err() && target("%").is_err() && target("").is_err());
    }
}
