//! `percute verify`.

use super::present::refused;
use super::{Console, case, resolved};
use crate::args::VerifyArguments;
use crate::exit::{DONE, INTERRUPTED};
use crate::progress::Watch;
use percute_estimator::Options;
use percute_io::Overwrite;
use percute_presentation::chart::convergence;
use percute_presentation::file;
use percute_workflow::Failure;
use percute_workflow::effort::Long;
use percute_workflow::outputs::{self, OutputFile};
use percute_workflow::quantity::probes;
use percute_workflow::run::located;
use percute_workflow::verify::{announced, cost, prepare, table, verify};

pub(super) fn command(arguments: &VerifyArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    let case = &case(&arguments.case)?;
    let VerifyArguments { levels, json, threads, quiet, force, long, .. } = *arguments;
    let picture = arguments.picture.as_deref().map(|file| OutputFile { what: "--picture", file });
    outputs::check(&case.inputs(Some(&arguments.case)), &[picture], force)?;
    picture.as_ref().map_or(Ok(()), |picture| file::picture(picture).map(drop))?;
    let probes = probes(&arguments.probe, case.problem.mesh(), "--probe")?;
    case.check_run(true, Long::asked(long, "--long"))?;
    console.warn_about(case, quiet);
    let Some(case) = &resolved(case, quiet, console)? else { return Ok(INTERRUPTED) };
    let options = Options { threads, ..case.options };
    let prepared = prepare(&case.problem, &case.times, &options, (levels, Long::asked(long, "--long")))?;
    if !quiet {
        console.say(&announced(&cost(&prepared, &options)));
    }
    let watch = &mut Watch::new(console.progress && !quiet, console.stop);
    let verified = verify(&prepared, options, &probes, watch, &mut |_| ());
    let verification = verified.map_err(|failure| located(case, failure))?;
    watch.clear();
    console.print(&if json { verification.to_json()? } else { table(&verification) })?;
    if let Some(picture) = picture {
        match convergence(&verification) {
            Some(svg) => file::write_picture(&picture, Overwrite::allowed(force), &svg).map_err(refused)?,
            None => console.say("no picture: there are no errors on two meshes"),
        }
    }
    Ok(if verification.interrupted { INTERRUPTED } else { DONE })
}
