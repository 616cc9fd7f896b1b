//! Arrays that become a history.

use crate::errors;
use crate::run::Run;
use numpy::PyReadonlyArray3;
use percute_core::dynamics::Evaluation;
use percute_core::history::{History, SinkError, Step, StepSource};
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::Options;
use percute_workflow::foreign::{Completed, Lacks, Origin};
use pyo3::prelude::*;

/// Arrays of a history, of all instants.
pub(crate) struct HistoryArrays<'a> {
    pub(crate) count: usize,
    pub(crate) displacement: &'a [f64],
    pub(crate) reaction: Option<&'a [f64]>,
    pub(crate) touching: Option<&'a [bool]>,
    pub(crate) motion: [Option<&'a [f64]>; 2],
}

impl HistoryArrays<'_> {
    /// The history, of percute or of another program.
    pub(crate) fn run(
        &self,
        py: Python<'_>,
        problem: &AnyProblem,
        times: &TimeGrid,
        options: Options,
        origin: Option<Origin>,
    ) -> PyResult<Run> {
        let history = self.history(py, problem, times)?;
        Ok(match origin {
            Some(origin) => Run::foreign(problem.clone(), history, options, origin),
            None => Run::new(problem.clone(), history, options, None),
        })
    }

    /// With what it lacks, and the last instant (s) if it was left out.
    pub(crate) fn completed(
        &self,
        py: Python<'_>,
        problem: &AnyProblem,
        times: &TimeGrid,
        program: Option<String>,
    ) -> PyResult<(Run, Option<f64>)> {
        let history = self.history(py, problem, times)?;
        let lacks = Lacks { reaction: self.reaction.is_none(), touching: self.touching.is_none() };
        let refused = |error: SinkError| errors::input(py, error);
        let complete = Completed::new(problem, &history, lacks).map_err(refused)?;
        let mut all = History::new(complete.times());
        complete.replay(&mut |step| all.push(step)).map_err(refused)?;
        let origin = Origin { program, derived: complete.derived().to_vec(), ..Origin::default() };
        Ok((Run::foreign(problem.clone(), all, Options::default(), origin), complete.left_out()))
    }

    fn history(&self, py: Python<'_>, problem: &AnyProblem, times: &TimeGrid) -> PyResult<History> {
        let mut history = History::new(times);
        // Plastic strains follow from the displacements of all steps.
        let mut evaluation = problem.yields().then(|| Evaluation::new(problem, times));
        let (nodes, contact) = (problem.mesh().node_count(), problem.contact_nodes().len());
        let dimension = problem.dimension();
        let (in_body, in_contact) = (dimension * nodes, dimension * contact);
        let (no_force, no_touch) = (vec![0.0; in_contact], vec![false; contact]);
        for (index, &time) in times.instants().iter().enumerate().take(self.count) {
            let step = Step {
                index,
                time,
                displacement: rows(self.displacement, index, in_body),
                reaction: self.reaction.map_or(&no_force, |r| rows(r, index, in_contact)),
                touching: self.touching.map_or(&no_touch, |t| rows(t, index, contact)),
                internal: &[],
                velocity: self.motion[0].map(|a| rows(a, index, in_body)),
                acceleration: self.motion[1].map(|a| rows(a, index, in_body)),
            };
            let state = evaluation.as_mut().map(|evaluation| evaluation.advance(&step)).transpose();
            let state = state.map_err(|error| errors::input(py, error))?;
            let pushed = history.push(state.as_ref().map_or(&step, |state| state.step()));
            pushed.map_err(|error| errors::input(py, error))?;
        }
        Ok(history)
    }
}

/// The rows of one step; too few if the array ends before.
fn rows<T>(array: &[T], step: usize, count: usize) -> &[T] {
    array.get(step * count..(step + 1) * count).unwrap_or_default()
}

/// The numbers of an array that may be missing.
pub(crate) fn slice<'a>(array: Option<&'a PyReadonlyArray3<'_, f64>>) -> PyResult<Option<&'a [f64]>> {
    Ok(array.map(PyReadonlyArray3::as_slice).transpose()?)
}
