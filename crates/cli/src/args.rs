//! The arguments of the command.

mod adapt;
mod export;
mod plan;
mod sweep;

pub use adapt::AdaptArguments;
pub(crate) use export::lacks_steps;
pub use export::{ExportArguments, Times};
pub use plan::PlanArguments;
pub use sweep::SweepArguments;

use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use percute_estimator::{Acceleration, MOST_THREADS, Reconstruction, Sampling, UnknownName, UnknownSampling};
use percute_presentation::About;
use percute_workflow::case::Instants;
use percute_workflow::message::hint;
use std::ffi::OsString;
use std::fmt::Display;
use std::path::PathBuf;
use std::str::FromStr;

const EXIT_CODES: &str = "Exit codes: 0 done, 1 failed, 2 bad input, 130 interrupted (Ctrl-C, SIGTERM; the summary of \
    the completed steps is still printed).";

/// The way to the evidence, which is not installed.
pub(crate) const STUDIES: &str = "the studies of the evidence are not installed with percute. In its source folder, \
    a clone or an unpacked source distribution, `pip install \".[plot]\"` and `python -m studies` compute them \
    (studies/README.md)";

/// The remedy for `percute plot` without the Python package.
pub(crate) const PLOT_NEEDS_PYTHON: &str = "`percute plot` needs the Python package: pip install \"percute[plot]\", or \
    pip install \".[plot]\" in the source folder. Its command `percute` draws the pictures. \
    `percute run` draws the error map with --picture, without Python";

/// Simulates impacts of bodies that are elastic or yield, and estimates the error of the simulation.
#[derive(Clone, Debug, Parser)]
#[command(name = "percute", version, after_help = EXIT_CODES)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Clone, Debug, Subcommand)]
pub enum Command {
    /// Print a commented case to start from (bar, block or drop): percute new block > case.toml
    New(NewArguments),
    /// Print the JSON schema of case files, with which editors complete and check them
    Schema,
    /// Print a script with which a shell completes commands, options and files
    Completion(CompletionArguments),
    /// Simulate a case and estimate its error
    Run(RunArguments),
    /// Simulate a case and store its history, to be estimated later
    Simulate(SimulateArguments),
    /// Estimate the error of a stored history
    Estimate(EstimateArguments),
    /// Write a page on an estimate, a history (estimated first) or a case (run first), as one HTML file
    Report(ReportArguments),
    /// Run a case on its mesh and on nested refinements: true errors, effectivity indices and orders of convergence
    Verify(VerifyArguments),
    /// Find the mesh for a wanted accuracy of a case: runs on meshes that follow from the estimate
    Adapt(AdaptArguments),
    /// Plan the mesh for a wanted accuracy of a case or a history, also of another program, with its element sizes
    Plan(PlanArguments),
    /// Run a case over values of its keys, in several processes, and make one table of the results
    Sweep(SweepArguments),
    /// Describe a case, a mesh (.msh), a history or an estimate file
    Info(InfoArguments),
    /// Write fields of a history for ParaView and other programs: stress, velocity, reaction, error at chosen steps
    Export(ExportArguments),
    /// Finish the history file of a run that was killed
    Recover(RecoverArguments),
    /// Draw a picture of a case, a history or an estimate file (with the Python package): error, energies, contact,
    /// fields, animations
    Plot(PlotArguments),
    /// Tell how to compute the evidence again: the paper's tables and figures, exact solutions, effectivity indices
    Reproduce(ReproduceArguments),
}

/// Arguments of `percute new`.
#[derive(Clone, Debug, Args)]
pub struct NewArguments {
    /// Name of the case
    pub case: Template,
}

/// Cases to start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Template {
    /// A bar strikes a wall
    Bar,
    /// A block strikes a plane at an angle, with friction
    Block,
    /// A disc falls on the ground: the contact grows and shrinks
    Drop,
}

/// Arguments of `percute completion`.
#[derive(Clone, Debug, Args)]
pub struct CompletionArguments {
    /// Name of the shell
    pub shell: Shell,
}

/// Arguments of `percute run`.
#[derive(Clone, Debug, Default, Args)]
pub struct RunArguments {
    /// The case file (TOML)
    pub case: PathBuf,
    /// Store the history, all steps, in this file (.vtkhdf) [default: the file in the case, if any]
    #[arg(long, value_name = "FILE")]
    pub history: Option<PathBuf>,
    /// Store the estimate, element by element, in this file (.vtkhdf) [default: the file in the case, if any]
    #[arg(long, value_name = "FILE")]
    pub estimate: Option<PathBuf>,
    /// Resume the killed or stopped simulation of the history file; without such a file, begin [--force
    /// replaces other files, and a history that keeps a part of its run]
    #[arg(long)]
    pub resume: bool,
    /// Allow a run of more than 1e10 elements times steps, which takes minutes to hours
    #[arg(long)]
    pub long: bool,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub maps: MapArguments,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub print: PrintArguments,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub work: WorkArguments,
}

/// Arguments of `percute simulate`.
#[derive(Clone, Debug, Default, Args)]
pub struct SimulateArguments {
    /// The case file (TOML)
    pub case: PathBuf,
    /// The file of the history (.vtkhdf), also `--output` [default: as in the case, or named after it in the working
    /// directory]
    #[arg(short = 'o', long, alias = "output", value_name = "FILE")]
    pub history: Option<PathBuf>,
    /// Replace an existing history
    #[arg(long)]
    pub force: bool,
    /// Resume the killed or stopped simulation of the history file; without such a file, begin
    #[arg(long, conflicts_with = "force")]
    pub resume: bool,
    /// Allow a simulation of more than 1e10 elements times steps, which takes minutes to hours
    #[arg(long)]
    pub long: bool,
    /// No progress and no warnings on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// Arguments of `percute estimate`.
#[derive(Clone, Debug, Default, Args)]
pub struct EstimateArguments {
    /// The history (.vtkhdf)
    pub history: PathBuf,
    /// Store the estimate, element by element, in this file (.vtkhdf)
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Reconstruction of the admissible contact force [default: as stored in the history]
    #[arg(long, value_name = "NAME", value_parser = choice::<Reconstruction>)]
    #[arg(help = named("Reconstruction of the admissible contact force", Reconstruction::ALL))]
    pub reconstruction: Option<Reconstruction>,
    /// Choice of the admissible acceleration [default: as stored in the history]
    #[arg(long, value_name = "NAME", value_parser = choice::<Acceleration>)]
    #[arg(help = named("Choice of the admissible acceleration", Acceleration::ALL))]
    pub acceleration: Option<Acceleration>,
    /// Sample the error at every k-th step and the last, or at those that "auto" chooses [default: as stored in the
    /// history]
    #[arg(long, value_name = "K", value_parser = sampling)]
    pub every: Option<Sampling>,
    /// Estimate a history of another program even if it contradicts itself or its problem
    #[arg(long)]
    pub accept_inconsistent: bool,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub maps: MapArguments,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub print: PrintArguments,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub work: WorkArguments,
}

/// Arguments of `percute report`.
#[derive(Clone, Debug, Default, Args)]
pub struct ReportArguments {
    /// An estimate file, a history (.vtkhdf) or a case
    pub file: PathBuf,
    /// The page (.html) [default: named after the file, in the working directory]
    pub page: Option<PathBuf>,
    /// The page, as an option; `--report` is the same
    #[arg(short, long, alias = "report", value_name = "PAGE", conflicts_with = "page")]
    pub output: Option<PathBuf>,
    /// Title of the page [default: "Error of the simulation" and the name of the file]
    #[arg(long, value_name = "TEXT")]
    pub title: Option<String>,
    /// Author of the page
    #[arg(long, value_name = "TEXT")]
    pub author: Option<String>,
    /// The program that simulated, of a history of another program [default: as the history states]
    #[arg(long, value_name = "NAME")]
    pub program: Option<String>,
    /// Estimate a history of another program although it contradicts itself or its problem
    #[arg(long)]
    pub accept_inconsistent: bool,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub work: WorkArguments,
}

/// Arguments of `percute verify`.
#[derive(Clone, Debug, Default, Args)]
pub struct VerifyArguments {
    /// The case file (TOML)
    pub case: PathBuf,
    /// Number of refinements, 1 to 5; each has about eight times (a bar: four times) the work of the one before
    #[arg(long, value_name = "N", default_value_t = 2)]
    pub levels: usize,
    /// Follow a field at a point (m) of the undeformed body, such as 0.01,0.02:von_mises, and show its largest value
    /// over time, without its sign, on each mesh: von_mises, pressure, equivalent_plastic_strain, displacement,
    /// velocity; of a plane body stress_xx, stress_yy, stress_xy; of a bar stress. Once for each probe
    #[arg(long, value_name = "X,Y:FIELD", allow_hyphen_values = true)]
    pub probe: Vec<String>,
    /// Print one JSON document instead of the table
    #[arg(long)]
    pub json: bool,
    /// Draw errors, effectivity index, force, impulse, rebound and probes over the size of the elements (.svg, .png)
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    /// Replace an existing picture
    #[arg(long)]
    pub force: bool,
    /// Allow more than 1e10 elements times steps in all, which take minutes to hours
    #[arg(long)]
    pub long: bool,
    /// Number of threads [default: one for each core]; the result does not depend on it
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
    /// No progress, cost and warnings on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// Arguments of `percute info`.
#[derive(Clone, Debug, Default, Args)]
pub struct InfoArguments {
    /// A case, a mesh (.msh), a history or an estimate file
    pub file: PathBuf,
    /// Print one JSON document
    #[arg(long)]
    pub json: bool,
    /// Write tables of a history or an estimate file: forces, energies and error over time in a file (.csv), or all
    /// tables in a folder
    #[arg(long, value_name = "FILE|FOLDER")]
    pub csv: Option<PathBuf>,
    /// Replace existing tables
    #[arg(long)]
    pub force: bool,
}

/// Arguments of `percute recover`.
#[derive(Clone, Debug, Default, Args)]
pub struct RecoverArguments {
    /// The history (.vtkhdf)
    pub history: PathBuf,
}

/// Arguments of `percute reproduce`.
#[derive(Clone, Debug, Args)]
#[command(after_help = STUDIES)]
pub struct ReproduceArguments {
    /// Its arguments, which the studies read
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    pub all: Vec<OsString>,
}

/// Arguments of `percute plot`.
#[derive(Clone, Debug, Args)]
#[command(after_help = PLOT_NEEDS_PYTHON)]
pub struct PlotArguments {
    /// Its arguments, which the Python package reads
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    pub all: Vec<OsString>,
}

/// What an estimate file holds.
#[derive(Clone, Debug, Default, Args)]
pub struct MapArguments {
    /// Instants of the estimate file: how many, or their times in s, separated by commas [default: up to 50]
    #[arg(long, value_name = "N|TIMES", value_parser = instants)]
    pub instants: Option<Instants>,
    /// Store the admissible fields in the estimate file too
    #[arg(long)]
    pub fields: bool,
}

/// What is printed and drawn.
#[derive(Clone, Debug, Default, Args)]
pub struct PrintArguments {
    /// Print one JSON document instead of the summary
    #[arg(long)]
    pub json: bool,
    /// Draw the error of each element on the mesh, as SVG or PNG by the end of the name (.svg, .png)
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    /// Write a page with verdict, figures and tables (.html)
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
    /// The head of this page.
    #[arg(skip)]
    pub about: About,
    /// Write tables: forces, energies and error over time in a file (.csv), or these and tables of elements and contact
    /// nodes in a folder
    #[arg(long, value_name = "FILE|FOLDER")]
    pub csv: Option<PathBuf>,
}

/// How the work is done; nothing of it changes the result.
#[derive(Clone, Debug, Default, Args)]
pub struct WorkArguments {
    /// Replace existing files
    #[arg(long)]
    pub force: bool,
    /// Number of threads [default: one for each core]; the result does not depend on it
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
    /// Number of sampled steps that are estimated at once, from 1; more than 8 count as 8 [default: 8]; the result does
    /// not depend on it
    #[arg(long, value_name = "N", value_parser = steps)]
    pub window: Option<usize>,
    /// No progress and no warnings on standard error; warnings stay in summary and JSON
    #[arg(long)]
    pub quiet: bool,
}

/// What an option of the estimator is, and its names.
fn named<T: Display>(what: &str, all: &[T]) -> String {
    let names = all.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    format!("{what}: one of {names} [default: as stored in the history]")
}

/// The value of an option of the estimator, by its name.
fn choice<T: FromStr<Err = UnknownName>>(text: &str) -> Result<T, String> {
    text.parse().map_err(|error: UnknownName| format!("{error}{}", hint(text, error.known.iter().copied())))
}

fn threads(text: &str) -> Result<usize, String> {
    whole(text, MOST_THREADS).ok_or_else(|| format!("must be a whole number from 1 to {MOST_THREADS}"))
}

fn steps(text: &str) -> Result<usize, String> {
    whole(text, usize::MAX).ok_or_else(|| "must be a whole number of steps, 1 or more".to_string())
}

fn sampling(text: &str) -> Result<Sampling, String> {
    text.parse().map_err(|error: UnknownSampling| error.to_string())
}

fn instants(text: &str) -> Result<Instants, String> {
    if let Some(count) = whole(text, usize::MAX) {
        return Ok(Instants::Count(count));
    }
    let times = numbers(text);
    let wrong = || "must be a whole number, 1 or more, or times in s, such as 0,1e-6,2.5e-6".to_string();
    // A lone 0 is a count that is too small.
    times.filter(|_| text.parse::<usize>().is_err()).map(Instants::Times).ok_or_else(wrong)
}

fn times(text: &str) -> Result<Times, String> {
    numbers(text).map(Times).ok_or_else(|| "must be times in s, such as 0,1e-6,2.5e-6".to_string())
}

/// Times (s), separated by commas.
fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split(',').map(|entry| entry.trim().parse::<f64>().ok().filter(|t| t.is_finite() && *t >= 0.0)).collect()
}

fn whole(text: &str, most: usize) -> Option<usize> {
    text.parse().ok().filter(|n| (1..=most).contains(n))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_is_well_formed() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn numbers_of_threads_and_steps() {
        assert_eq!(threads("3"), Ok(3));
        assert!(threads("0").is_err() && threads("-1").is_err() && threads("1025").is_err() && threads("two").is_err());
        assert_eq!(steps("5000"), Ok(5000));
        assert!(steps("0").is_err());
    }

    #[test]
    fn instants_are_a_number_or_times() {
        assert_eq!(instants("7"), Ok(Instants::Count(7)));
        assert_eq!(instants("1e-6"), Ok(Instants::Times(vec![1e-6])));
        assert_eq!(instants("0, 2.5e-6,1"), Ok(Instants::Times(vec![0.0, 2.5e-6, 1.0])));
        for wrong in ["", "0", "-1", "nan", "1,", "inf,1", "many"] {
            assert!(instants(wrong).is_err(), "{wrong}");
        }
    }
}
