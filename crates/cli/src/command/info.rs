//! `percute info`.

use super::{Console, case};
use crate::args::InfoArguments;
use crate::exit::DONE;
use percute_io::{Kind, Overwrite, estimate_file, gmsh, kind};
use percute_workflow::Failure;
use percute_workflow::case::Case;
use percute_workflow::history::open;
use percute_workflow::info::{Info, of_case, of_estimate, of_history, of_mesh};
use percute_workflow::report::{reported, units_in};
use percute_workflow::tables::{Destination, TableResults};
use std::path::Path;

pub(super) fn command(arguments: &InfoArguments, console: &mut Console<'_>) -> Result<u8, Failure> {
    if let Some(path) = &arguments.csv {
        tables(&arguments.file, path, arguments.force)?;
    }
    let info = read(&arguments.file, console)?;
    console.print(&if arguments.json { info.to_json()? } else { info.summary() })?;
    Ok(DONE)
}

fn read(file: &Path, console: &mut Console<'_>) -> Result<Info, Failure> {
    if file.is_dir() {
        let told = "this is a folder; name a case, a mesh (.msh), a history or an estimate file in it";
        return Err(Failure::Argument(format!("{}: {told}", file.display())));
    }
    match kind(file)? {
        Kind::Other if file.extension().is_some_and(|end| end.eq_ignore_ascii_case("msh")) => {
            return of_gmsh(file, console);
        }
        Kind::Other => return with_warnings(&case(file)?, console),
        Kind::Estimate => return Ok(of_estimate(file, &estimate_file::open(file)?)),
        // The reader of histories says what a stranger holds instead.
        Kind::History | Kind::OtherHdf5 => {}
    }
    Ok(of_history(&open(file)?)?)
}

/// Writes the tables of a history or an estimate file.
fn tables(file: &Path, path: &Path, force: bool) -> Result<(), Failure> {
    let place = Destination::check("--csv", path, &[("file to be described", file)], force)?;
    let overwrite = Overwrite::allowed(force);
    match kind(file)? {
        Kind::History => {
            let stored = open(file)?;
            let (contact, balance) = stored.results()?;
            let (mesh, contact, units) = (stored.problem.mesh(), Some(&contact), stored.problem.units());
            place.write(
                &TableResults { mesh, contact, units, balance: &balance, error: &[], by_element: &[] },
                overwrite,
            )
        }
        Kind::Estimate => {
            let estimate = estimate_file::open(file)?;
            let (error, by_element) = (&estimate.over_time[..], &estimate.by_element[..]);
            let units = units_in(&estimate.report);
            let contact = estimate_file::contact(file)?;
            let (mesh, contact) = (&estimate.mesh, contact.as_ref());
            place.write(&TableResults { mesh, contact, units, balance: &[], error, by_element }, overwrite)
        }
        Kind::Other | Kind::OtherHdf5 => {
            let told = "--csv applies to a history or an estimate file; `percute run` makes one of a case";
            Err(Failure::Argument(format!("{}: {told}", file.display())))
        }
    }
}

/// A mesh as it is, in the unit of the file.
fn of_gmsh(file: &Path, console: &mut Console<'_>) -> Result<Info, Failure> {
    let mesh = gmsh::read(file, 1.0).map_err(|error| Failure::Argument(error.to_string()))?;
    let info = of_mesh(file, &mesh);
    console.warn(&info.warnings);
    Ok(Info::Mesh(Box::new(info)))
}

/// A case, with its warnings on standard error.
fn with_warnings(case: &Case, console: &mut Console<'_>) -> Result<Info, Failure> {
    console.warn_about(case, false);
    console.warn(&reported(case.problem.mesh()).collect::<Vec<_>>());
    Ok(of_case(case)?)
}
