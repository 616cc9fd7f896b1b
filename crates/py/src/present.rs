//! The picture and the page of an estimate.

use crate::built::BuiltEstimate;
use crate::estimate::EstimateData;
use crate::history::HistoryData;
use crate::mesh::MeshData;
use crate::{bridge, errors};
use numpy::PyReadonlyArray1;
use percute_core::contact_results::ContactResults;
use percute_io::{Case, Overwrite, estimate_file};
use percute_presentation::picture::svg;
use percute_presentation::{About, Body, ColourScale, Contents, Deformed, Document, Surface, file};
use percute_workflow::Failure;
use percute_workflow::case::statement;
use percute_workflow::outputs::{self, OutputFile};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

/// An estimate to show.
struct Shown {
    body: Body,
    document: Document,
    statement: String,
    case: Option<Case>,
    surfaces: Vec<Surface>,
}

/// Title, author and program of a page.
type PageTexts = (Option<String>, Option<String>, Option<String>);

/// What is to be written.
#[derive(Clone)]
enum Form {
    Picture,
    Page(About),
}

impl Form {
    fn of(page: Option<PageTexts>) -> Self {
        page.map_or(Self::Picture, |(title, author, program)| Self::Page(About { title, author, program }))
    }

    fn is_page(&self) -> bool {
        matches!(self, Self::Page(_))
    }

    /// Checks the file before any work.
    fn check(&self, path: &Path, input: Option<&Path>, overwrite: bool) -> Result<(), Failure> {
        let output = named(path);
        let input: Vec<(&str, &Path)> = input.map(|input| ("estimate", input)).into_iter().collect();
        outputs::check(&input, &[Some(output)], overwrite)?;
        match self {
            Self::Picture => file::picture(&output).map(drop),
            Self::Page(_) => file::page(&output),
        }
    }

    fn write(&self, shown: &Shown, path: &Path, overwrite: bool) -> Result<(), Failure> {
        let Shown { body, document, statement, case, surfaces } = shown;
        let (output, overwrite) = (named(path), Overwrite::allowed(overwrite));
        let Self::Page(about) = self else {
            return file::write_picture(&output, overwrite, &svg(body, document));
        };
        about.fits(document).map_err(Failure::Argument)?;
        let contents = Contents { about, document, body, statement, case: case.as_ref(), surfaces };
        file::write_page(&output, overwrite, &contents).map(drop)
    }
}

fn named(file: &Path) -> OutputFile<'_> {
    OutputFile { what: "`path`", file }
}

fn refused(py: Python<'_>, failure: &Failure) -> PyErr {
    match failure {
        Failure::File(error) => errors::file(py, error),
        other => errors::output(py, other),
    }
}

/// Values with labels.
type Marks = Vec<(f64, String)>;
/// Points (m) of some lines.
type Lines = Vec<Vec<[f64; 2]>>;

/// Colours of values that are not negative: both ends, whether they are logarithmic, and about so many marks with
/// labels.
#[pyfunction]
pub(crate) fn colour_scale(values: PyReadonlyArray1<'_, f64>, count: usize) -> PyResult<(f64, f64, bool, Marks)> {
    let ColourScale { ends: [low, high], logarithmic, marks } =
        percute_presentation::colour_scale(values.as_slice()?, count);
    Ok((low, high, logarithmic, marks))
}

/// The deformed outline that a report has: closed lines (m) and what they are. None without displacements.
#[pyfunction]
pub(crate) fn deformed_outline(py: Python<'_>, mesh: &MeshData, report: &str) -> PyResult<Option<(Lines, String)>> {
    let document = Document::parse(report).map_err(|error| errors::input(py, error))?;
    let body = Body::new(&mesh.mesh);
    Ok(Deformed::new(&body, &document).map(|Deformed { lines, label }| (lines, label)))
}

/// Writes the page of an estimate, or without `page` the picture; the page has the contact results of the history.
#[pyfunction]
pub(crate) fn present(
    py: Python<'_>,
    estimate: &EstimateData,
    page: Option<PageTexts>,
    path: PathBuf,
    overwrite: bool,
    name: String,
    history: Option<&HistoryData>,
) -> PyResult<()> {
    let form = Form::of(page);
    form.check(&path, None, overwrite).map_err(|failure| refused(py, &failure))?;
    let history = history.filter(|_| form.is_page()).map(|history| &history.run);
    let contact = estimate.built.contact_steps(py, history)?;
    let built = estimate.built.clone();
    let work = move |_| {
        let shown = shown(&built, &name, contact.as_deref())?;
        form.write(&shown, &path, overwrite)
    };
    bridge::blocking(py, None, work)?.map_err(|failure| refused(py, &failure))
}

fn shown(built: &BuiltEstimate, name: &str, contact: Option<&ContactResults>) -> Result<Shown, Failure> {
    let json = built.stored_report(name).map_err(Failure::Argument)?;
    let document = Document::parse(&json).map_err(|error| Failure::Argument(error.to_string()))?;
    Ok(Shown {
        body: Body::new(built.problem.mesh()),
        // A problem that the language of the case files cannot say has a page without it.
        statement: statement(&built.problem, Some(&built.options)).unwrap_or_default(),
        case: built.case.clone(),
        surfaces: contact.map_or_else(Vec::new, |contact| Surface::all(contact, &document)),
        document,
    })
}

/// The same of an estimate file.
#[pyfunction]
pub(crate) fn present_file(
    py: Python<'_>,
    estimate: PathBuf,
    page: Option<PageTexts>,
    path: PathBuf,
    overwrite: bool,
) -> PyResult<()> {
    let form = Form::of(page);
    form.check(&path, Some(&estimate), overwrite).map_err(|failure| refused(py, &failure))?;
    let work = move |_| {
        let found = estimate_file::open(&estimate)?;
        let contact = if form.is_page() { estimate_file::contact(&estimate)? } else { None };
        let document = Document::parse(&found.report).map_err(|error| Failure::Argument(error.to_string()))?;
        let surfaces = |contact| Surface::all(&contact, &document);
        let surfaces = contact.map_or_else(Vec::new, surfaces);
        let (body, statement, case) = (Body::new(&found.mesh), found.statement, found.case);
        let shown = Shown { body, document, statement, case, surfaces };
        form.write(&shown, &path, overwrite)
    };
    bridge::blocking(py, None, work)?.map_err(|failure| refused(py, &failure))
}
