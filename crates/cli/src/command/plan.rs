//! `percute plan`.

use super::{Console, case, resolved};
use crate::args::PlanArguments;
use crate::exit::{DONE, INTERRUPTED};
use crate::progress::Watch;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::Options;
use percute_io::{Overwrite, gmsh, is_hdf5, is_vtkhdf_name};
use percute_workflow::Failure;
use percute_workflow::adapt::Wish;
use percute_workflow::effort::{Effort, Long};
use percute_workflow::grade::Graded;
use percute_workflow::history::open;
use percute_workflow::outputs::{self, OutputFile};
use percute_workflow::plan::{Basis, NextMesh, SizeField, can_be_planned};
use percute_workflow::run::{Analysis, Results, Storage, located, run};
use std::path::Path;

/// The most elements that carry a size field.
const MOST: usize = 200_000;

pub(super) fn command(arguments: &PlanArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    let PlanArguments { file, target, scale, force, long, threads, quiet, .. } = arguments;
    Wish::new(*target).check()?;
    if !(*scale > 0.0 && scale.is_finite()) {
        return Err(Failure::Argument(format!("--scale is {scale}; give metres per unit of length, such as 1e-3")));
    }
    let is_history = is_hdf5(file).unwrap_or(false) || is_vtkhdf_name(file);
    let what = if is_history { "history" } else { "case file" };
    outputs::check(&[(what, file)], &[size_field(arguments)], *force)?;
    if is_history {
        let stored = open(file)?;
        can_be_planned(&stored.problem).map_err(Failure::Argument)?;
        let options = Options { threads: *threads, ..stored.options };
        let watch = &mut Watch::new(console.progress && !quiet, console.stop);
        let analysis = Analysis { options, ..Analysis::default() };
        let Graded { results, times, .. } = stored.estimate(&analysis, arguments.accept_inconsistent, watch)?;
        watch.clear();
        return planned(&stored.problem, &times, options, &results, arguments, console);
    }
    let case = case(file)?;
    case.check_run(true, Long::asked(*long, "--long"))?;
    can_be_planned(&case.problem).map_err(Failure::Argument)?;
    console.warn_about(&case, *quiet);
    let Some(case) = &resolved(&case, *quiet, console)? else { return Ok(INTERRUPTED) };
    let options = Options { threads: *threads, ..case.options };
    let watch = &mut Watch::new(console.progress && !quiet, console.stop);
    let analysis = Analysis { options, ..Analysis::default() };
    let done = run(&case.problem, &case.times, &analysis, Storage::default(), watch);
    let results = done.map_err(|failure| located(case, failure))?.stored()?;
    watch.clear();
    planned(&case.problem, &case.times, options, &results, arguments, console)
}

fn size_field(arguments: &PlanArguments) -> Option<OutputFile<'_>> {
    arguments.size_field.as_deref().map(|file| OutputFile { what: "--size-field", file })
}

/// Prints the plan and writes the size field.
fn planned(
    problem: &AnyProblem,
    times: &TimeGrid,
    options: Options,
    results: &Results,
    arguments: &PlanArguments,
    console: &mut Console<'_>,
) -> Result<u8, Failure> {
    if results.interrupted() {
        console.say("interrupted: a plan needs the whole run");
        return Ok(INTERRUPTED);
    }
    let PlanArguments { target, scale, json, force, .. } = *arguments;
    let mesh = problem.mesh();
    let basis = Basis::new(mesh, &results.estimate, &results.contact).ok_or_else(|| {
        Failure::Argument(
            "there is nothing to plan from: the error is zero, or its sources are unknown, which the reconstruction \
             \"corrected\" finds"
                .to_string(),
        )
    })?;
    let effort = Effort::of(problem, times, options.every);
    let next = NextMesh::new(mesh, &basis, &effort, [results.estimate.error.relative_mean, target]);
    console.print(&if json { next.to_json()? } else { next.told() })?;
    if let Some(OutputFile { file, .. }) = size_field(arguments) {
        write(file, Overwrite::allowed(force), scale, SizeField::new(mesh, &basis, &next.plan, MOST))?;
    }
    Ok(DONE)
}

fn write(
    file: &Path,
    overwrite: Overwrite,
    scale: f64,
    field: Result<SizeField, percute_core::mesh::MeshError>,
) -> Result<(), Failure> {
    let told = |error: &dyn std::fmt::Display| Failure::Argument(format!("--size-field: {error}"));
    let field = field.map_err(|error| told(&error))?;
    gmsh::write_sizes(file, overwrite, &field.mesh, &field.size, scale).map_err(|error| told(&error))
}
