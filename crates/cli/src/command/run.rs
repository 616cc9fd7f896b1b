//! `percute run`.

use super::outputs::{begin_history, check};
use super::result::{Finished, give};
use super::resume::{Left, go_on, left};
use super::simulate::flow_in;
use super::{Console, case};
use crate::args::{MapArguments, RunArguments, WorkArguments};
use crate::exit::INTERRUPTED;
use crate::progress::Watch;
use percute_estimator::{EstimateError, Options, Request, RunError};
use percute_workflow::Failure;
use percute_workflow::case::{Case, Instants};
use percute_workflow::effort::Long;
use percute_workflow::history::{Stored, stored_case};
use percute_workflow::outputs::{OutputFile, chosen};
use percute_workflow::report::simulated;
use percute_workflow::run::{Analysis, Outcome, Results, Storage, located, run};
use percute_workflow::tables::Destination;
use std::ops::ControlFlow::{self, Break, Continue};
use std::time::Instant;

pub(super) fn command(arguments: &RunArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    let case = &case(&arguments.case)?;
    let RunArguments { maps, print, work, .. } = arguments;
    let [history, stored] = files(case, arguments);
    let left = left(case, history, arguments.resume, true)?;
    left.refuse_a_part(arguments)?;
    let mut inputs = case.inputs(Some(&arguments.case));
    inputs.extend(history.filter(|_| left.history().is_some()).map(|history| ("history", history.file)));
    let new = history.filter(|_| left.history().is_none());
    check(&inputs, &[new, stored], Some(print), work.force)?;
    let tables = print.csv.as_deref();
    let tables = tables.map(|path| Destination::check("--csv", path, &inputs, work.force));
    let tables = tables.transpose()?;
    let options = Options { threads: work.threads, window: work.window, ..case.options };
    case.check_files(history.is_some(), stored.is_some())?;
    let instants = maps.instants.as_ref().unwrap_or(&case.output.instants);
    let fields = maps.fields || case.output.fields;
    within("--instants", instants, case.times.end())?;
    request(stored, "--estimate", maps, Request::default)?;
    case.check_run(true, Long::asked(arguments.long, "--long"))?;
    let mut told = console.warn_about(case, work.quiet);
    let Some(case) = &left.resolved(case, work.quiet, console)? else { return Ok(INTERRUPTED) };
    told.extend(case.unended.as_ref().map(|warning| warning.name));
    within("--instants", instants, case.times.end())?;
    let wanted = || Request { steps: instants.steps(&case.times, options.every.stride()), fields };
    let request = request(stored, "--estimate", maps, wanted)?;
    let start = Instant::now();
    let analysis = Analysis { options, request, contact_steps: stored.is_some() || print.report.is_some() };
    let Outcome { results, unstored } = match results(case, left, &analysis, history, work, console)? {
        Continue(outcome) => outcome,
        Break(code) => return Ok(code),
    };
    let (case, seconds, subject) = (Some(stored_case(&case.source)), start.elapsed().as_secs_f64(), case.subject());
    let finished = Finished { subject, options, case, results, seconds, told, tables };
    let given = give(&finished, print, stored, work, console);
    console.but_lost(unstored, given)
}

/// The results of the run, or of the history that it left; an exit code if it was stopped before there were any.
fn results(
    case: &Case,
    left: Left,
    analysis: &Analysis,
    history: Option<OutputFile<'_>>,
    work: &WorkArguments,
    console: &mut Console<'_>,
) -> Result<ControlFlow<u8, Outcome<Results>>, Failure> {
    let start = Instant::now();
    let done = match left {
        // The estimate needs all steps.
        Left::Whole(stored) | Left::Begun(stored) if stored.file.expect_all().is_err() => {
            begin(case, analysis, history, true, work, console)
        }
        Left::Nothing => begin(case, analysis, history, work.force, work, console),
        Left::Whole(stored) => again(&stored, analysis, work, console),
        Left::Begun(stored) => {
            let Outcome { results: simulation, unstored } = go_on(case, &stored, work.threads, work.quiet, console)?;
            if let Some(lost) = unstored {
                return Err(lost.into());
            }
            let file = stored.file.path();
            if simulation.interrupted {
                // An estimate of all steps until there would take long; standard output has results only.
                let seconds = start.elapsed().as_secs_f64();
                let flow = flow_in(file);
                console.say(simulated(&case.subject(), &simulation, (file, flow.as_ref()), seconds).trim_end());
                console.say_to_estimate(file);
                return Ok(Break(INTERRUPTED));
            }
            again(&Stored::of_case(case, file, true)?, analysis, work, console)
        }
    };
    match done {
        // Nothing can be estimated from a run stopped at its very start.
        Err(
            Failure::Run(RunError::Estimate(error @ (EstimateError::TooFewSteps { .. } | EstimateError::Stopped)))
            | Failure::History { cause: error @ (EstimateError::TooFewSteps { .. } | EstimateError::Stopped), .. },
        ) if console.stop.is_asked() => {
            let code = console.interrupted_early(&error);
            if let (EstimateError::Stopped, Some(history)) = (error, history) {
                console.say_to_estimate(history.file);
            }
            Ok(Break(code))
        }
        other => other.map(Continue),
    }
}

/// Simulates and estimates beside the run.
fn begin(
    case: &Case,
    analysis: &Analysis,
    history: Option<OutputFile<'_>>,
    force: bool,
    work: &WorkArguments,
    console: &mut Console<'_>,
) -> Result<Outcome<Results>, Failure> {
    let path = history.map(|history| history.file);
    let history = history.map(|file| begin_history(case, file, force, work.quiet, console)).transpose()?;
    let watch = &mut Watch::new(console.progress && !work.quiet, console.stop);
    let storage = Storage { file: history, memory: None, open: None };
    let done = run(&case.problem, &case.times, analysis, storage, watch).map_err(|failure| located(case, failure));
    watch.clear();
    if let (Err(Failure::Run(RunError::Estimate(EstimateError::Scratch(_)))), Some(path)) = (&done, path) {
        console.say_to_resume(path);
    }
    done
}

/// Estimates the steps of a run that has ended.
fn again(
    stored: &Stored,
    analysis: &Analysis,
    work: &WorkArguments,
    console: &mut Console<'_>,
) -> Result<Outcome<Results>, Failure> {
    let watch = &mut Watch::new(console.progress && !work.quiet, console.stop);
    let done = stored.estimate(analysis, false, watch)?;
    watch.clear();
    Ok(Outcome { results: done.results, unstored: None })
}

/// The files of the history and of the estimate, as far as they are wanted.
fn files<'a>(case: &'a Case, arguments: &'a RunArguments) -> [Option<OutputFile<'a>>; 2] {
    let RunArguments { history, estimate, .. } = arguments;
    let stated = &case.output;
    [
        chosen(["--history", "[output] history"], history.as_deref(), stated.history.as_deref()),
        chosen(["--estimate", "[output] estimate"], estimate.as_deref(), stated.estimate.as_deref()),
    ]
}

/// Refuses instants after the end of the run.
pub(super) fn within(flag: &str, instants: &Instants, end: f64) -> Result<(), Failure> {
    instants.after(end).map_or(Ok(()), |wrong| Err(Failure::Argument(format!("{flag} {wrong}"))))
}

/// Maps are kept for a file only, which `flag` names.
pub(super) fn request(
    file: Option<OutputFile<'_>>,
    flag: &str,
    given: &MapArguments,
    wanted: impl FnOnce() -> Request,
) -> Result<Request, Failure> {
    if file.is_none() && (given.instants.is_some() || given.fields) {
        let message = "--instants and --fields apply to an estimate file; name one with";
        return Err(Failure::Argument(format!("{message} {flag} FILE, or leave them out")));
    }
    Ok(file.map_or_else(Request::default, |_| wanted()))
}
