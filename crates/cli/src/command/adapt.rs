//! `percute adapt`.

use super::present::refused;
use super::{Console, case, resolved};
use crate::args::AdaptArguments;
use crate::exit::{DONE, FAILED, INTERRUPTED};
use crate::progress::Watch;
use percute_estimator::Options;
use percute_io::{Overwrite, gmsh};
use percute_presentation::chart::adaptation as adaptation_chart;
use percute_presentation::file;
use percute_workflow::Failure;
use percute_workflow::adapt::{Adaptation, Geometry, Mesher, Next, Reason, Wish, adapt, announced, table};
use percute_workflow::effort::Long;
use percute_workflow::outputs::{self, OutputFile};
use percute_workflow::run::located;

pub(super) fn command(arguments: &AdaptArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    let case = &case(&arguments.case)?;
    let AdaptArguments { target, measure, limit, runs, json, force, threads, quiet, .. } = *arguments;
    let save = arguments.save.as_deref().map(|file| OutputFile { what: "--save", file });
    let picture = arguments.picture.as_deref().map(|file| OutputFile { what: "--picture", file });
    outputs::check(&case.inputs(Some(&arguments.case)), &[save, picture], force)?;
    picture.as_ref().map_or(Ok(()), |picture| file::picture(picture).map(drop))?;
    let wish = Wish { target, measure, on: arguments.target_on.clone(), courant: case.courant, limit, runs };
    wish.check()?;
    case.check_run(true, Long::Allowed)?;
    console.warn_about(case, quiet);
    let Some(case) = &resolved(case, quiet, console)? else { return Ok(INTERRUPTED) };
    let options = Options { threads, ..case.options };
    let watch = &mut Watch::new(console.progress && !quiet, console.stop);
    let mut tell = |next: &Next| {
        if !quiet {
            console.say(&announced(next));
        }
    };
    let wish = (wish, mesher(arguments, case.mesh_scale)?);
    let adapted = adapt(&case.problem, &case.times, options, wish, watch, &mut tell);
    let adaptation = adapted.map_err(|failure| located(case, failure))?;
    watch.clear();
    if !quiet {
        adaptation.warnings.iter().for_each(|warning| console.say(&format!("warning: {warning}")));
    }
    console.print(&if json { adaptation.to_json()? } else { table(&adaptation) })?;
    if let (Some(save), Some(best)) = (save, &adaptation.best) {
        let (mesh, overwrite) = (best.problem.mesh(), Overwrite::allowed(force));
        let written = gmsh::write(save.file, overwrite, mesh, gmsh::MeshFormat::default());
        written.map_err(|error| Failure::Argument(format!("--save: {error}")))?;
    }
    if let Some(picture) = picture {
        match adaptation_chart(&adaptation)? {
            Some(svg) => file::write_picture(&picture, Overwrite::allowed(force), &svg).map_err(refused)?,
            None => console.say("no picture: no run is done"),
        }
    }
    Ok(code(&adaptation))
}

/// The way to make meshes that was chosen.
fn mesher(arguments: &AdaptArguments, scale: f64) -> Result<Mesher, Failure> {
    let AdaptArguments { mesher, geometry, scale: given, .. } = arguments;
    match (mesher.as_str(), geometry) {
        ("gmsh", None) => Ok(Mesher::Gmsh(Geometry::Outline)),
        ("gmsh", Some(file)) if !file.is_file() => {
            Err(Failure::Argument(format!("--geometry {}: there is no file of this name", file.display())))
        }
        ("gmsh", Some(file)) => Ok(Mesher::Gmsh(Geometry::File(file.clone(), given.unwrap_or(scale)))),
        (_, Some(_)) => Err(Failure::Argument("--geometry needs --mesher gmsh".to_string())),
        _ => Ok(Mesher::Bisection),
    }
}

fn code(adaptation: &Adaptation) -> u8 {
    match adaptation.reason {
        Some(Reason::Reached) => DONE,
        Some(Reason::Interrupted) => INTERRUPTED,
        _ => FAILED,
    }
}
