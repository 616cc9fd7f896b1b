//! What a file holds, without any simulation. The fields are the keys of the JSON document, described in
//! `docs/json.md`.

mod estimate;
mod mesh;
mod setting;

pub use estimate::{EstimateInfo, of_estimate};
pub use mesh::{GroupInfo, MeshInfo, of_mesh};
pub use setting::{MaterialInfo, PlaneInfo};

use crate::case::{Case, FIELDS, NotRepresentable, Output};
use crate::deformation::StoredFlow;
use crate::effort::{Effort, duration};
use crate::history::{Stored, plan};
use crate::memory;
use crate::message::{bytes, counted, printable, trimmed};
use crate::report::build::problem_summary;
use crate::report::summary::{body, layout, step};
use crate::report::{FORMAT, ProblemSummary, Versions};
use percute_core::time::TimeGrid;
use percute_estimator::Supplied;
use percute_io::{FileError, Provenance};
use serde::Serialize;

/// What a file holds.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Info {
    /// A case.
    Case(Box<CaseInfo>),
    /// A history.
    History(Box<HistoryInfo>),
    /// An estimate.
    Estimate(Box<EstimateInfo>),
    /// A mesh.
    Mesh(Box<MeshInfo>),
}

/// A case: what its run will take.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct CaseInfo {
    pub format: u32,
    pub versions: Versions,
    pub file: String,
    pub problem: ProblemSummary,
    pub materials: Vec<MaterialInfo>,
    pub planes: Vec<PlaneInfo>,
    pub time: TimeInfo,
    pub history_bytes: u64,
    pub run_memory: u64,
    pub estimate_memory: u64,
    pub contact_memory: u64,
    pub output_history: Option<String>,
    pub output_estimate: Option<String>,
    pub element_steps: u64,
    pub simulation_seconds: f64,
    pub run_seconds: f64,
    pub long: bool,
}

/// A history.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct HistoryInfo {
    pub format: u32,
    pub versions: Versions,
    pub file: String,
    pub written_by: Provenance,
    pub foreign: bool,
    pub simulated_by: Option<String>,
    pub derived: Vec<String>,
    pub checksums: bool,
    pub case: Option<String>,
    pub problem: ProblemSummary,
    pub materials: Vec<MaterialInfo>,
    pub planes: Vec<PlaneInfo>,
    pub time: TimeInfo,
    pub steps: Option<usize>,
    pub complete: bool,
    pub yielding: Option<StoredFlow>,
    pub supplied: Supplied,
    pub stored: Option<StoredInfo>,
    pub bytes: u64,
    pub estimate_memory: u64,
}

/// The part of its run that a thinned history keeps.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct StoredInfo {
    pub instants: usize,
    pub fields: Vec<&'static str>,
}

/// The instants and fields of a history.
fn stored_info(stored: &Stored) -> StoredInfo {
    let [velocity, acceleration] = stored.file.stored();
    let there = [true, velocity, acceleration, !stored.file.lacks_reactions()];
    let fields = FIELDS.into_iter().zip(there).filter(|(_, there)| *there).map(|(name, _)| name).collect();
    StoredInfo { instants: stored.file.count(), fields }
}

/// The steps of a run.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)]
pub struct TimeInfo {
    pub time_step: f64,
    pub critical_time_step: f64,
    pub steps_planned: usize,
    pub end: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub after_contact: Option<f64>,
    /// Whether the run has more steps, which follow the stiffness of finite laws.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub follows_stiffness: bool,
}

impl TimeInfo {
    fn new(times: &TimeGrid, critical_step: f64) -> Self {
        Self {
            time_step: times.longest_step(),
            critical_time_step: critical_step,
            steps_planned: times.step_count(),
            end: times.end(),
            after_contact: None,
            follows_stiffness: false,
        }
    }

    fn lines(&self) -> [(&'static str, String); 2] {
        let (end, mut steps) = (trimmed(self.end, 5), counted(self.steps_planned, "step"));
        if self.follows_stiffness {
            steps += " or more, as the body stiffens";
        }
        let time = match self.after_contact {
            None => format!("{end} s in {steps};"),
            Some(after) => format!("to {} s after the rebound, at most {end} s in {steps};", trimmed(after, 3)),
        };
        [("time", time), ("", step(self.time_step, self.critical_time_step))]
    }
}

/// The writer of a file, in words.
fn writer(Provenance { program, architecture, system }: &Provenance) -> String {
    let known: Vec<_> = [program, architecture, system].into_iter().filter(|s| !s.is_empty()).cloned().collect();
    if known.is_empty() { "an unknown program".to_string() } else { known.join(", ") }
}

/// What a case holds and what its run will take.
///
/// # Errors
/// A problem that cannot be stored.
pub fn of_case(case: &Case) -> Result<Info, NotRepresentable> {
    let Output { history, estimate, .. } = &case.output;
    let name = |file: &Option<std::path::PathBuf>| file.as_ref().map(|file| file.display().to_string());
    let effort = Effort::of(&case.problem, &case.times, case.options.every);
    Ok(Info::Case(Box::new(CaseInfo {
        format: FORMAT,
        versions: Versions::of_this_program(),
        file: case.source.name().to_string(),
        problem: problem_summary(&case.subject()),
        materials: setting::materials(&case.problem),
        planes: setting::planes(&case.problem),
        time: TimeInfo {
            after_contact: case.until.map(|until| until.after),
            follows_stiffness: case.following.is_some(),
            ..TimeInfo::new(&case.times, case.critical_step)
        },
        history_bytes: plan(&case.problem, &case.times, &case.options, Some(&case.source), &case.output.keep)?.bytes(),
        run_memory: memory::of_run(&case.problem, &case.times),
        estimate_memory: percute_estimator::memory(&case.problem, &case.times, &case.options) as u64,
        contact_memory: memory::of_contact(&case.problem, &case.times),
        output_history: name(history),
        output_estimate: name(estimate),
        element_steps: effort.element_steps,
        simulation_seconds: effort.simulation_seconds,
        run_seconds: effort.run_seconds,
        long: effort.is_long(),
    })))
}

/// What a history holds.
///
/// # Errors
/// Internal variables of its last instant that cannot be read.
pub fn of_history(stored: &Stored) -> Result<Info, FileError> {
    let (file, problem, subject) = (&stored.file, &stored.problem, stored.subject());
    let [velocity, acceleration] = file.supplied();
    Ok(Info::History(Box::new(HistoryInfo {
        format: FORMAT,
        versions: Versions::of_this_program(),
        file: stored.name.clone(),
        written_by: file.provenance().clone(),
        foreign: file.is_foreign(),
        simulated_by: file.simulated_by().map(str::to_string),
        derived: file.derived().to_vec(),
        checksums: file.has_checksums(),
        case: file.case().map(|case| case.name.clone()),
        problem: problem_summary(&subject),
        materials: setting::materials(problem),
        planes: setting::planes(problem),
        time: TimeInfo::new(file.thinned_steps().map_or(file.times(), |kept| &kept.times), subject.critical_step),
        steps: file.count().checked_sub(1).map(|last| file.thinned_steps().map_or(last, |kept| kept.steps[last])),
        stored: file.thinned_steps().map(|_| stored_info(stored)),
        complete: file.is_complete(),
        yielding: stored.flow()?,
        supplied: Supplied { velocity, acceleration },
        bytes: file.bytes(),
        estimate_memory: percute_estimator::memory(problem, file.times(), &stored.options) as u64,
    })))
}

impl Info {
    /// A few lines of at most 80 columns.
    #[must_use]
    pub fn summary(&self) -> String {
        layout(&match self {
            Self::Case(info) => info.lines(),
            Self::History(info) => info.lines(),
            Self::Estimate(info) => info.lines(),
            Self::Mesh(info) => info.lines(),
        })
    }

    /// One JSON document. Numbers that are not finite become `null`.
    ///
    /// # Errors
    /// None that is known; whatever the serialiser reports.
    pub fn to_json(&self) -> Result<String, std::io::Error> {
        serde_json::to_string(self).map_err(std::io::Error::from)
    }
}

impl CaseInfo {
    fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines = vec![("case", self.file.clone()), ("body", body(&self.problem))];
        lines.extend(self.materials.iter().map(MaterialInfo::line));
        lines.extend(self.planes.iter().map(PlaneInfo::line));
        lines.extend(self.time.lines());
        let (run, simulation) = (duration(self.run_seconds), duration(self.simulation_seconds));
        let long = if self.long { "; such a run needs --long" } else { "" };
        lines.push(("duration", format!("run {run}, simulate {simulation}{long}")));
        lines.push(("history", format!("{} on disk", bytes(self.history_bytes))));
        let (run, estimate) = (bytes(self.run_memory), bytes(self.estimate_memory));
        let estimate = match self.problem.dimension {
            3 => "no estimate of solids yet".to_string(),
            _ => format!("{estimate} for the estimate"),
        };
        lines.push(("memory", format!("about {run} for the run, and {estimate}")));
        if self.output_estimate.is_some() {
            lines
                .push(("", format!("and {} for the contact results of the estimate file", bytes(self.contact_memory))));
        }
        for (name, file) in [("history", &self.output_history), ("estimate", &self.output_estimate)] {
            lines.extend(file.as_ref().map(|file| ("output", format!("{name} to {file}"))));
        }
        lines
    }
}

impl HistoryInfo {
    fn lines(&self) -> Vec<(&'static str, String)> {
        let mut lines =
            vec![("history", format!("{}, {}", self.file, bytes(self.bytes))), ("written", writer(&self.written_by))];
        if self.foreign {
            let program =
                self.simulated_by.as_deref().map_or_else(String::new, |name| format!(": {}", printable(name)));
            lines.push(("", format!("simulated by another program{program}")));
        }
        if !self.checksums {
            lines.push(("", "without checksums: damage to its numbers is not found".to_string()));
        }
        lines.extend(self.case.as_ref().map(|case| ("case", case.clone())));
        lines.push(("body", body(&self.problem)));
        lines.extend(self.materials.iter().map(MaterialInfo::line));
        lines.extend(self.planes.iter().map(PlaneInfo::line));
        lines.extend(self.time.lines());
        let held = self.steps.map_or_else(|| "no step".to_string(), |steps| counted(steps, "step"));
        let ended = match (self.complete, self.steps == Some(self.time.steps_planned)) {
            (true, true) => "complete".to_string(),
            (true, false) => "the run was stopped there; `--resume` continues it".to_string(),
            (false, _) if self.steps.is_none() => {
                "INCOMPLETE: the run is active or was killed; after a kill, delete the file".to_string()
            }
            (false, _) => {
                let file = &self.file;
                format!(
                    "INCOMPLETE: the run is active or was killed; after a kill, `--resume` continues it, and `percute \
                     recover {file}` closes the file"
                )
            }
        };
        lines.push(("holds", format!("{held} of {} planned; {ended}", self.time.steps_planned)));
        lines.extend(self.yielding.as_ref().map(StoredFlow::line));
        if let Some(StoredInfo { instants, fields }) = &self.stored {
            lines.push(("keeps", format!("{} only: {}", counted(*instants, "instant"), fields.join(", "))));
        }
        let supplied = [("velocities", self.supplied.velocity), ("accelerations", self.supplied.acceleration)];
        lines.extend(
            supplied.iter().filter(|(_, supplied)| *supplied).map(|(what, _)| ("", format!("{what} of its own"))),
        );
        // There is no estimate of a part of a run.
        if self.stored.is_none() {
            let estimate = match self.problem.dimension {
                3 => "no estimate of solids yet".to_string(),
                _ => format!("about {} for the estimate", bytes(self.estimate_memory)),
            };
            lines.push(("memory", estimate));
        }
        lines
    }
}
