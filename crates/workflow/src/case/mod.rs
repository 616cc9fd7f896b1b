//! Case files: TOML in, a checked problem with its instants and options out.
//!
//! Units are SI. A bar takes one number where a plane body takes a vector `[x, y]`. Tables:
//!
//! - `[mesh]`: one of `rectangle = { width, height, nx, ny, diagonals }` (sides `left`, `right`, `bottom`,
//!   `top`), `disc = { radius, rings }` around the origin (outline `boundary`), `bar = { length, elements }` (ends
//!   `start`, `end`); `file = "block.msh"`, a mesh of Gmsh, relative to the folder of the case, with `scale` (metres
//!   per unit of length, 1 unless given); or arrays: `points` and `cells`, with
//!   `edge_groups = { name = [[node, node], …] }` of boundary edges (a bar: `[node, …]`) and
//!   `element_groups = { name = [element, …] }`;
//! - or several `[[body]]` instead of `[mesh]`, `[material]` and `[initial]`: `name`, a mesh as above, `origin` (m) and
//!   `rotation` (degrees) that place it, `material`, `velocity`; its groups are "name.group";
//! - `[material]`, or several `[[material]]` each with a `group` of elements: `young`, `density`, and
//!   `poisson`, `plane` (`"stress"` or `"strain"`), `thickness` (1 unless given); a bar: `section`;
//! - `[initial]`: `velocity`, `displacement`, zero unless given; uniform, or one entry for each node;
//! - `[[obstacle]]`: `point` or `gap` (m, or "auto"), `normal`, `friction` (not for bars), `group`;
//! - `[[contact]]`: `bodies`, two names, or `groups`, a group of edges of each, or neither for all other bodies;
//!   `friction` (not for bars), `matching`;
//! - `[[support]]`: `group`, `components`, `velocity = { time, value }` with a number per instant for
//!   one component, else a list in the order of `components`;
//! - `[[traction]]`: `group`, `value`, or `time` and as many values, `profile = { value, gradient }`;
//!   `[[body_force]]`: the same without `profile`, the group of elements may be left out;
//! - `gravity`, above the tables: the acceleration of the weight of all bodies;
//! - `[time]`: `end` and one of `courant` and `step`; or `steps`, with or without `end`;
//! - `[estimate]`: `reconstruction`, `acceleration`, `every`;
//! - `[output]`: `history` and `estimate`, names of files, relative to the working directory; `instants` of
//!   the estimate file, how many or a list of times; `fields`, whether it holds the admissible fields, or the names of
//!   those that the history keeps; `every` or `times`, the steps that it keeps.
//!
//! The reader goes through the parsed document itself, because every error shall name the line, the path
//! of the key, the value, its unit and what is allowed.

mod body;
mod contact;
mod estimate;
mod keep;
mod language;
mod load;
mod material;
mod mesh;
mod obstacle;
mod output;
mod place;
mod plausibility_warnings;
mod problem;
mod source;
mod statement;
mod stranger;
mod support;
mod syntax;
mod text;
mod time;
mod value;

pub use body::far_origin;
pub use contact::ONE_BODY;
pub use keep::{FIELDS, Keep};
pub use language::SCHEMA;
pub(crate) use language::SchemaPart;
pub use output::{Instants, Output};
pub(crate) use source::At;
pub use source::{CaseError, Source};
pub use statement::{NotRepresentable, problem_from, statement};
pub use stranger::stranger;

use crate::effort::{Effort, Long};
use crate::message::bytes;
use crate::report::{Subject, Warning};
use crate::until::Until;
use body::Bodies;
use mesh::Coarsest;
use percute_core::dynamics::{SimulationError, check_start, critical_time_step, first_stable_step};
use percute_core::memory::can_be_had;
use percute_core::mesh::Mesh;
use percute_core::problem::{AnyProblem, Place, RefusedStart, cause_of_refused_start};
use percute_core::time::TimeGrid;
use percute_estimator::{EstimateError, Options, Reconstruction};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::de::DeTable;
use value::table;
use value::table::Table;

const NO_MESH: &str = "the table [mesh] is missing: give the body, as in rectangle = \
                       { width = 0.05, height = 0.04, nx = 20, ny = 16 }; `percute new block` prints a whole case to \
                       start from";

/// Names of the components.
const AXES: [&str; 3] = ["x", "y", "z"];

/// A case, ready to run.
#[derive(Clone, Debug)]
pub struct Case {
    /// The file it came from.
    pub source: Source,
    /// The problem.
    pub problem: AnyProblem,
    /// The instants; to the latest end, while a run that ends with the rebound has not been resolved.
    pub times: TimeGrid,
    /// The Courant number that the case states, if it does.
    pub courant: Option<f64>,
    /// The Courant number of steps that follow the stiffness of finite laws, if they have not been resolved.
    pub following: Option<f64>,
    /// The end with the rebound, if the run ends so and has not been resolved.
    pub until: Option<Until>,
    /// The warning of a run that was to end with the rebound, if contact does not end before its latest end.
    pub unended: Option<Warning>,
    /// Δt_c (s), eq. \[34\].
    pub critical_step: f64,
    /// Options of the estimate.
    pub options: Options,
    /// The files that a run makes.
    pub output: Output,
    /// The files that meshes were read from.
    pub mesh_files: Vec<PathBuf>,
    /// Metres per unit of length in the mesh file, of a case with one body; 1 without such a file.
    pub mesh_scale: f64,
}

/// Reads and checks a case file.
///
/// # Errors
/// The first thing that is wrong with it.
pub fn parse(source: Source) -> Result<Case, CaseError> {
    check_length(&source)?;
    let document = parsed(&source)?;
    let root = Table::root(&source, document.get_ref());
    root.only()?;
    if let Some(bodies) = body::read(&root)? {
        return of_bodies(&source, &root, bodies);
    }
    let mesh = root.single("mesh")?.ok_or_else(|| root.error(NO_MESH))?;
    let files = mesh::file(&mesh).into_iter().collect();
    if let Some(Coarsest { mesh, nodes }) = mesh::coarsest(&mesh) {
        check_tables(&root, &mesh.into(), &nodes)?;
    }
    let body = mesh::read(&mesh)?.into();
    let case = read(&source, &root, files, || problem::read(&root, &body));
    case.map_err(|error| if body.dimension() == 1 { mesh::of_lines_only(&mesh, error) } else { error })
}

/// Refuses a text whose document would take more memory than there is: with a mesh in it, a case may be long.
fn check_length(source: &Source) -> Result<(), CaseError> {
    /// Bytes of memory for each of the text: 27 to 40 were measured with meshes, 76 with numbers of one digit.
    const MOST: u64 = 80;
    let needed = MOST * source.text().len() as u64;
    if can_be_had(needed) {
        return Ok(());
    }
    let (length, needed) = (bytes(source.text().len() as u64), bytes(needed));
    let told = format!(
        "a case of {length} needs up to {needed} of memory, which is not available: name a mesh of Gmsh in [mesh] by \
         `file`, or use a larger machine or limit (`ulimit -v`)"
    );
    Err(source.error(&At { path: String::new(), span: 0..0 }, told))
}

/// Finds mistakes in all tables but that of the mesh, which may take seconds and gigabytes to make; see [`Coarsest`].
fn check_tables(root: &Table<'_>, coarsest: &Arc<Mesh>, nodes: &[usize]) -> Result<(), CaseError> {
    estimate::read(root)?;
    output::read(root)?;
    time::read(root)?;
    problem::check_coarsest(root, coarsest, nodes)
}

/// The case of several bodies.
fn of_bodies(source: &Source, root: &Table<'_>, mut bodies: Bodies) -> Result<Case, CaseError> {
    let files = std::mem::take(&mut bodies.files);
    read(source, root, files, || problem::of_bodies(root, bodies))
}

fn read(
    source: &Source,
    root: &Table<'_>,
    mesh_files: Vec<PathBuf>,
    problem: impl FnOnce() -> Result<AnyProblem, CaseError>,
) -> Result<Case, CaseError> {
    // Cheap tables first: a slip in the last line should not wait for the critical step.
    let options = estimate::read(root)?;
    let output = output::read(root)?;
    let wanted = time::read(root)?;
    let problem = problem()?;
    let critical_step = critical_time_step(&problem);
    let stable = if wanted.courant().is_some() { first_stable_step(&problem) } else { critical_step };
    let problem = problem.with_planes_moved(wanted.first_step(stable)).unwrap_or(problem);
    let (times, until) = (wanted.grid(stable)?, wanted.until(&problem, stable)?);
    output::check(root, &output, times.end())?;
    let (source, unended, courant) = (source.clone(), None, wanted.courant());
    let mesh_scale = root.single("mesh")?.map_or(1.0, |mesh| mesh::scale(&mesh));
    let following = courant.filter(|_| problem.is_finite());
    Ok(Case {
        source,
        problem,
        times,
        courant,
        following,
        until,
        unended,
        critical_step,
        options,
        output,
        mesh_files,
        mesh_scale,
    })
}

/// The place and the cause of a start that the simulation refuses: a unit that is hardly right, beside which there is
/// no other remedy, else the obstacle.
#[must_use]
pub fn refused_start(
    problem: &AnyProblem,
    times: &TimeGrid,
    obstacle: usize,
    error: &SimulationError,
) -> (Place, String) {
    match cause_of_refused_start(problem, times) {
        Some(RefusedStart { cause, likely: true }) => {
            (cause.place, format!("{}. As it is, the body starts too near to its plane", cause.message))
        }
        // Many bodies are so large, and all may start too near.
        Some(RefusedStart { cause, .. }) => {
            (problem.place_of_obstacle(obstacle), format!("{error}. Else check the unit: {}", cause.message))
        }
        None => (problem.place_of_obstacle(obstacle), error.to_string()),
    }
}

/// The document in a text.
fn parsed(source: &Source) -> Result<toml::Spanned<DeTable<'_>>, CaseError> {
    DeTable::parse(source.text()).map_err(|error| {
        let at = At { path: String::new(), span: error.span().unwrap_or(0..0) };
        if source.text().starts_with("$MeshFormat") {
            let message = "this is a Gmsh mesh, not a case; name it in a case: [mesh], and `file = \"block.msh\"` on \
                the next line";
            return source.error(&at, message);
        }
        let mut wrong = source.error(&at, "");
        let told = error.message().trim().replace('\n', ", ");
        wrong.message = match syntax::advice(&wrong.excerpt, &told) {
            Some(advice) => format!("this is not valid TOML: {advice} ({told})"),
            None => format!("this is not valid TOML: {told}"),
        };
        wrong
    })
}

impl Case {
    /// What a report on it is about.
    #[must_use]
    pub fn subject(&self) -> Subject<'_> {
        let Self { source, problem, times, critical_step, unended, .. } = self;
        let (name, critical_step, unended) = (source.name(), *critical_step, unended.as_ref());
        Subject { name, problem, times, critical_step, held: None, checked: None, unended }
    }

    /// The files that a run reads and must not replace, each with what it is; `case` is its own.
    #[must_use]
    pub fn inputs<'a>(&'a self, case: Option<&'a Path>) -> Vec<(&'static str, &'a Path)> {
        let case = case.map(|file| ("case file", file));
        case.into_iter().chain(self.mesh_files.iter().map(|file| ("mesh file", file.as_path()))).collect()
    }

    /// The place in the file of a start that the simulation refuses; `None` for other failures,
    /// which are not the input's.
    #[must_use]
    pub fn refused_start(&self, error: &SimulationError) -> Option<CaseError> {
        let SimulationError::StartsTooNear { obstacle, .. } = error else { return None };
        let (place, message) = refused_start(&self.problem, &self.times, *obstacle, error);
        self.error_at(place, message)
    }

    /// Refuses an estimate that is not available, a start that the simulation would refuse, a run for which there is no
    /// memory, and one that takes long unless `long` says so, before warnings and before any work; `estimated` if the
    /// error is estimated beside the run.
    ///
    /// # Errors
    /// The place in the file.
    pub fn check_run(&self, estimated: bool, long: Long) -> Result<(), CaseError> {
        if estimated && self.problem.dimension() == 3 && self.options.reconstruction != Reconstruction::Corrected {
            let place = Place { table: "estimate", index: None, key: "reconstruction" };
            self.error_at(place, EstimateError::SolidReconstruction.to_string()).map_or(Ok(()), Err)?;
        }
        if estimated && self.problem.is_finite() && !self.options.balances_turning(self.problem.dimension()) {
            let place = Place { table: "estimate", index: None, key: "reconstruction" };
            self.error_at(place, EstimateError::Finite.to_string()).map_or(Ok(()), Err)?;
        }
        let start = check_start(&self.problem, &self.times).err();
        let refused = start.and_then(|error| self.refused_start(&error)).or_else(|| {
            let effort = Effort::of(&self.problem, &self.times, self.options.every);
            let told = effort.refusal(&self.times, estimated, long)?;
            self.error_at(Place { table: "time", index: None, key: "end" }, told)
        });
        let refused = refused.or_else(|| {
            let (place, told) = self.lack_of_memory(estimated)?;
            self.error_at(place, told)
        });
        refused.map_or(Ok(()), Err)
    }

    /// Refuses keys of `[output]` about a history or an estimate file that the run does not make.
    ///
    /// # Errors
    /// The place in the file.
    pub fn check_files(&self, history: bool, estimate: bool) -> Result<(), CaseError> {
        let document = parsed(&self.source)?;
        let root = Table::root(&self.source, document.get_ref());
        output::check_files(&root, &self.output, [history, estimate])
    }

    fn error_at(&self, place: Place, message: String) -> Option<CaseError> {
        let document = parsed(&self.source).ok()?;
        let root = Table::root(&self.source, document.get_ref());
        Some(self.source.error(&place::find(&root, place), message))
    }
}
