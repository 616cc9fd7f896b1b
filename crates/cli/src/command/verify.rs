//! `percute verify`.

use super::{Console, case, resolved};
use crate::args::VerifyArguments;
use crate::exit::{DONE, INTERRUPTED};
use crate::progress::Watch;
use percute_core::each_dimension;
use percute_estimator::Options;
use percute_workflow::Failure;
use percute_workflow::case::CaseOf;
use percute_workflow::run::located;
use percute_workflow::verify::{announced, cost, prepare, table, verify};

pub(super) fn command(arguments: &VerifyArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    each_dimension!(case(&arguments.case)?, case => verify_case(&case, arguments, console))
}

fn verify_case<const D: usize, const N: usize>(
    case: &CaseOf<D, N>,
    arguments: &VerifyArguments,
    console: &mut Console<'_>,
) -> Result<u8, Failure> {
    let VerifyArguments { levels, json, threads, quiet, .. } = *arguments;
    console.warn_about(case, quiet);
    let Some(case) = &resolved(case, quiet, console)? else { return Ok(INTERRUPTED) };
    let prepared = prepare(&case.problem, &case.times, levels)?;
    let options = Options { threads, ..case.options };
    if !quiet {
        console.say(&announced(&cost(&prepared, &options)));
    }
    let watch = &mut Watch::new(console.progress && !quiet, console.interrupted);
    let verification = verify(&prepared, options, watch).map_err(|failure| located(case, failure))?;
    watch.clear();
    console.print(&if json { verification.to_json()? } else { table(&verification) })?;
    Ok(if verification.interrupted { INTERRUPTED } else { DONE })
}
