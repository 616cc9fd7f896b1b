//! The arguments of the command.

use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

const EXIT_CODES: &str = "Exit codes: 0 done, 1 failed, 2 bad input, 130 interrupted (Ctrl-C; the summary of the steps done is still printed).";

/// More threads than any machine has cores for are a slip.
const MOST_THREADS: usize = 1024;

/// Simulates elastic impacts and estimates the error of the simulation.
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
    /// Simulate a case and estimate its error
    Run(RunArguments),
}

/// Arguments of `percute run`.
#[derive(Clone, Debug, Default, Args)]
pub struct RunArguments {
    /// The case file (TOML)
    pub case: PathBuf,
    /// Print one JSON document instead of the summary
    #[arg(long)]
    pub json: bool,
    /// Draw the error of each element on the mesh; the name must end in .svg
    #[arg(long, value_name = "FILE")]
    pub picture: Option<PathBuf>,
    /// Number of threads [default: one for each core]; the result does not depend on it
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
    /// How many steps are estimated at once [default: as many as fit into a modest memory]; the
    /// result does not depend on it
    #[arg(long, value_name = "N", value_parser = window)]
    pub window: Option<usize>,
    /// No progress and no warnings on standard error; warnings stay in summary and JSON
    #[arg(long)]
    pub quiet: bool,
}

fn threads(text: &str) -> Result<usize, String> {
    whole(text, MOST_THREADS).ok_or_else(|| format!("must be a whole number from 1 to {MOST_THREADS}"))
}

fn window(text: &str) -> Result<usize, String> {
    whole(text, usize::MAX).ok_or_else(|| "must be a whole number of steps, 1 or more".to_string())
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
        assert_eq!(window("5000"), Ok(5000));
        assert!(window("0").is_err());
    }
}
