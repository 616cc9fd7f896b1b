//! An adaptation on its way: a run, then the mesh that follows from it.

use super::iteration::{Iteration, Made, Needed, Reason};
use super::meshing::{Mesher, Meshing};
use super::polygon;
use super::toward::missing;
use super::{Adaptation, Best, Next, Wish};
use crate::effort::Effort;
use crate::failure::Failure;
use crate::memory;
use crate::numbering::Ordered;
use crate::plan::{Basis, Branch, Plan, can_be_planned, sizes};
use crate::report::{Report, Subject};
use crate::restated::Restated;
use crate::run::{Results, whole};
use percute_core::dynamics::critical_time_step;
use percute_core::observer::Observer;
use percute_core::problem::AnyProblem;
use percute_core::time::TimeGrid;
use percute_estimator::{Options, Reconstruction};
use std::ops::ControlFlow::{self, Break, Continue};
use std::sync::Arc;

/// A run that is planned.
#[derive(Clone, Debug)]
struct Planned {
    problem: AnyProblem,
    times: TimeGrid,
    critical_step: f64,
    made: Made,
}

/// An adaptation on its way: as long as [`Adapting::upcoming`] has a run, [`Adapting::run`] does it.
#[derive(Clone, Debug)]
pub struct Adapting {
    wish: Wish,
    options: Options,
    /// The end (s) and the Courant number of all runs.
    end: f64,
    courant: f64,
    restated: Restated,
    meshing: Meshing,
    iterations: Vec<Iteration>,
    planned: Option<Planned>,
    /// The last run, and the basis of the plan that follows from it.
    last: Option<(Arc<Best>, Option<Basis>)>,
    best: Option<Arc<Best>>,
    needed: Option<Needed>,
    /// The work of a run above the limit.
    refused: Option<Needed>,
    warnings: Vec<String>,
    reason: Option<Reason>,
}

impl Adapting {
    /// Begins with a problem on its mesh.
    ///
    /// # Errors
    /// A wish out of range, a reconstruction without sources, a problem that cannot be written down, a mesher that
    /// cannot mesh it.
    pub fn new(
        problem: &AnyProblem,
        times: &TimeGrid,
        options: Options,
        (wish, mesher): (Wish, Mesher),
    ) -> Result<Self, Failure> {
        wish.check()?;
        can_be_planned(problem).map_err(Failure::Argument)?;
        if options.reconstruction != Reconstruction::Corrected {
            return Err(Failure::Argument(format!(
                "the reconstruction \"{}\" has no sources of the error to plan from; take \"corrected\"",
                options.reconstruction
            )));
        }
        let courant = wish.courant.unwrap_or_else(|| times.longest_step() / critical_time_step(problem));
        Ok(Self {
            wish,
            options,
            end: times.end(),
            courant,
            restated: Restated::new(problem)?,
            meshing: Meshing::new(problem, mesher)?,
            iterations: Vec::new(),
            planned: None,
            last: None,
            best: None,
            needed: None,
            refused: None,
            warnings: Vec::new(),
            reason: None,
        })
    }

    /// The next run; none if the adaptation has ended.
    ///
    /// # Errors
    /// A first run that cannot be planned.
    pub fn upcoming(&mut self) -> Result<Option<Next>, Failure> {
        if self.reason.is_none() && self.planned.is_none() {
            let planned = self.plan();
            self.kept(planned)?;
        }
        Ok(self.planned.as_ref().map(|planned| self.announced(planned)))
    }

    /// Does the planned run.
    ///
    /// # Errors
    /// A first run that fails.
    pub fn run(&mut self, observer: &mut dyn Observer) -> Result<(), Failure> {
        let Some(planned) = self.planned.take() else { return Ok(()) };
        let done = self.simulated(planned, observer);
        self.kept(done)
    }

    /// A failure after the first run ends the adaptation: the runs that are done are not lost.
    fn kept(&mut self, done: Result<(), Failure>) -> Result<(), Failure> {
        match done {
            Err(failure) if !self.iterations.is_empty() => {
                self.reason = Some(Reason::Failed(failure.to_string()));
                Ok(())
            }
            done => done,
        }
    }

    /// Plans the next run, or ends.
    fn plan(&mut self) -> Result<(), Failure> {
        self.needed = self.needed_after();
        let (problem, made) = match &self.last {
            None => (self.restated.problem().clone(), Made::default()),
            Some((last, basis)) => match self.problem_after(last, basis.as_ref())? {
                Continue(found) => found,
                Break(reason) => {
                    self.reason = Some(reason);
                    return Ok(());
                }
            },
        };
        let critical_step = critical_time_step(&problem);
        let times = TimeGrid::with_step(self.end, self.courant * critical_step);
        let times = times.map_err(|error| Failure::Argument(error.to_string()))?;
        let work = Needed::of(&Effort::of(&problem, &times, self.options.every));
        if work.element_steps > self.wish.limit {
            self.refused = Some(work);
            self.reason = Some(Reason::Limit);
            return Ok(());
        }
        let bytes =
            memory::of_run(&problem, &times) + percute_estimator::memory(&problem, &times, &self.options) as u64;
        memory::refusal(bytes).map_or(Ok(()), |told| Err(Failure::Memory(told)))?;
        self.planned = Some(Planned { problem, times, critical_step, made });
        Ok(())
    }

    fn announced(&self, planned: &Planned) -> Next {
        let Planned { problem, times, made: Made { branch, predicted }, .. } = planned;
        Next {
            run: self.iterations.len(),
            branch: *branch,
            elements: problem.mesh().element_count(),
            steps: times.step_count(),
            predicted: *predicted,
            work: Needed::of(&Effort::of(problem, times, self.options.every)),
            needed: self.needed,
        }
    }

    fn simulated(&mut self, planned: Planned, observer: &mut dyn Observer) -> Result<(), Failure> {
        let Planned { problem, times, critical_step, made } = planned;
        let (name, held, checked, unended) = ("", None, None, None);
        let subject = Subject { name, problem: &problem, times: &times, critical_step, held, checked, unended };
        let Some((results, report, value)) = self.followed(&subject, observer)? else {
            self.reason = Some(Reason::Interrupted);
            return Ok(());
        };
        let run = self.iterations.len();
        self.take(Arc::new(Best { run, problem, times, critical_step, results, report }), made, value);
        Ok(())
    }

    /// The results of a run, its report, and the value of the quantity of the target; none if the observer broke.
    #[allow(clippy::type_complexity)]
    fn followed(
        &self,
        subject: &Subject<'_>,
        observer: &mut dyn Observer,
    ) -> Result<Option<(Results, Report, Option<f64>)>, Failure> {
        let ordered = Ordered::new(subject.problem);
        let on = self.wish.on.as_ref();
        let mut sink = on.map_or(Ok(None), |quantity| quantity.sink(ordered.problem()))?;
        let Some(results) = whole(&ordered, subject.times, self.options, &mut sink, observer)? else { return Ok(None) };
        let report = Report::new(subject, self.options, results.findings(), 0.0);
        let Some(quantity) = on else { return Ok(Some((results, report, None))) };
        match quantity.value(&report, sink.as_ref()) {
            None => Err(Failure::Argument(missing(quantity))),
            value => Ok(Some((results, report, value))),
        }
    }

    /// Takes a run in, with the value of the quantity of the target.
    fn take(&mut self, last: Arc<Best>, made: Made, quantity: Option<f64>) {
        let mesh = last.problem.mesh();
        let basis = Basis::new(mesh, &last.results.estimate, &last.results.contact);
        let iteration = Iteration::new(&last.report, basis.as_ref(), &sizes(mesh), self.wish.measure, made);
        let iteration = Iteration { quantity, ..iteration };
        if self.warnings.is_empty() && self.meshing.keeps_polygons() {
            self.warnings.extend(basis.as_ref().and_then(|basis| polygon::warning(mesh, basis)));
        }
        let worth = |run: &Iteration| (!run.reasons.is_empty(), run.error);
        // The limit of a quantity is nearer on each finer mesh.
        let better = |best: &Arc<Best>| quantity.is_some() || worth(&iteration) < worth(&self.iterations[best.run]);
        if self.best.as_ref().is_none_or(better) {
            self.best = Some(last.clone());
        }
        let obstruction = self.wish.on.as_ref().and_then(|quantity| quantity.obstruction(mesh, &last.report));
        self.iterations.push(iteration);
        self.reason = self.wish.end(&self.iterations, obstruction.as_ref());
        self.last = Some((last, basis));
    }

    /// The work of a run with the wanted error, by the last one.
    fn needed_after(&self) -> Option<Needed> {
        let (last, basis) = self.last.as_ref()?;
        let effort = Effort::of(&last.problem, &last.times, self.options.every);
        let wanted = self.wish.target / self.iterations[last.run].error;
        // Nothing is known of a quantity.
        let basis = basis.as_ref().filter(|_| self.wish.on.is_none())?;
        Some(Needed::of(&effort).times(Plan::whole(basis, wanted)?.cost))
    }

    /// The problem on the mesh that follows from the last run, or the reason why there is none.
    fn problem_after(
        &self,
        last: &Best,
        basis: Option<&Basis>,
    ) -> Result<ControlFlow<Reason, (AnyProblem, Made)>, Failure> {
        let Some(basis) = basis else { return Ok(Break(Reason::NoSources)) };
        let (mesh, error) = (last.problem.mesh(), self.iterations[last.run].error);
        let wanted = self.wish.wanted(&self.iterations[last.run], basis);
        let plan = Plan::new(basis, wanted, &self.meshing.largest(mesh));
        // The plan of a map holds for a step: its mesh may have all that is missing in a few places.
        let needed = self.needed.filter(|_| plan.branch == Branch::Uniform);
        if needed.is_some_and(|needed| needed.element_steps > self.wish.limit) {
            return Ok(Break(Reason::Limit));
        }
        let made = |predicted: f64| Made { branch: Some(plan.branch), predicted: Some(predicted * error) };
        // The outline of a finer disc may cut a plane that touches the first one.
        if let Some((next, predicted)) = self.meshing.generated(mesh, &plan)
            && next.element_count() != mesh.element_count()
            && let Ok(problem) = self.restated.on(&next)
        {
            return Ok(Continue((problem, made(predicted))));
        }
        let most = (self.wish.limit / last.times.step_count() as f64) as usize;
        let (next, predicted) = self.meshing.next(mesh, (basis, &plan), most.max(1))?;
        if next.points() == mesh.points() && next.cells().eq(mesh.cells()) {
            return Ok(Break(Reason::SameMesh));
        }
        Ok(Continue((self.restated.on(&next)?, made(predicted))))
    }
}

impl Adapting {
    /// The adaptation as far as it is done.
    #[must_use]
    pub fn so_far(&self) -> Adaptation {
        let Self { wish, iterations, best, needed, refused, warnings, reason, .. } = self;
        let needed = needed.filter(|_| *reason != Some(Reason::Reached));
        Adaptation {
            wish: wish.clone(),
            iterations: iterations.clone(),
            reason: reason.clone(),
            needed,
            refused: *refused,
            reachable: self.reachable().filter(|_| *reason == Some(Reason::Limit)),
            warnings: warnings.clone(),
            best: best.clone(),
        }
    }

    /// The relative error of a uniform mesh with as much work as the limit allows, by the last run.
    fn reachable(&self) -> Option<f64> {
        let (last, basis) = self.last.as_ref()?;
        let basis = basis.as_ref().filter(|basis| self.wish.on.is_none() && basis.branch() == Branch::Uniform)?;
        let q = Plan::exponents(basis).far;
        let less =
            (self.wish.limit / basis.element_steps()).powf(-q / (self.restated.problem().dimension() + 1) as f64);
        Some(less * self.iterations[last.run].error)
    }
}
