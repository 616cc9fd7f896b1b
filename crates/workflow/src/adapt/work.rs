//! An adaptation on its way: a run, then the mesh that follows from it.

use super::bisect::bisected;
use super::iteration::{Iteration, Made, Needed, Reason};
use super::{Adaptation, Best, Next, Wish};
use crate::effort::Effort;
use crate::failure::Failure;
use crate::info::memory;
use crate::numbering::Ordered;
use crate::plan::{Basis, Branch, LARGEST, Plan, sizes};
use crate::report::{Report, Subject};
use crate::restated::Restated;
use crate::run::whole;
use percute_core::dynamics::critical_time_step;
use percute_core::history::Discard;
use percute_core::ids::ElementId;
use percute_core::mesh::{Bisection, Generated, Locator, Mesh};
use percute_core::observer::Observer;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use percute_estimator::Options;

/// The next mesh, or the end.
pub(super) enum Planned<const D: usize, const N: usize> {
    Mesh(Box<Mesh<D, N>>, Made),
    End(Reason),
}

/// An adaptation on its way.
pub(super) struct Work<'p, const D: usize, const N: usize> {
    wish: Wish,
    options: Options,
    /// The end (s) and the Courant number of all runs.
    end: f64,
    courant: f64,
    restated: Restated<'p, D, N>,
    first: Bisection<D, N>,
    iterations: Vec<Iteration>,
    /// The last run, and the basis of the plan that follows from it.
    last: Option<(Best<D, N>, Option<Basis>)>,
    best: Option<Best<D, N>>,
    needed: Option<Needed>,
}

impl<'p, const D: usize, const N: usize> Work<'p, D, N>
where
    Mesh<D, N>: Generated,
{
    pub(super) fn new(
        problem: &'p Problem<D, N>,
        times: &TimeGrid,
        options: Options,
        wish: Wish,
    ) -> Result<Self, Failure> {
        Ok(Self {
            wish,
            options,
            end: times.end(),
            courant: times.longest_step() / critical_time_step(problem),
            restated: Restated::new(problem)?,
            first: Bisection::new(problem.mesh().clone(), &problem.facing_nodes()),
            iterations: Vec::new(),
            last: None,
            best: None,
            needed: None,
        })
    }

    /// The problem on another mesh.
    pub(super) fn on(&self, mesh: Mesh<D, N>) -> Result<Problem<D, N>, Failure> {
        self.restated.on(mesh)
    }

    /// Whether no run is done.
    pub(super) fn is_first(&self) -> bool {
        self.iterations.is_empty()
    }

    /// Runs a problem; with a reason, the adaptation ends with this run.
    pub(super) fn run(
        &mut self,
        problem: Problem<D, N>,
        made: Made,
        observer: &mut dyn Observer,
        tell: &mut dyn FnMut(&Next),
    ) -> Result<Option<Reason>, Failure> {
        let critical_step = critical_time_step(&problem);
        let times = TimeGrid::with_step(self.end, self.courant * critical_step);
        let times = times.map_err(|error| Failure::Argument(error.to_string()))?;
        let (run, work) = (self.iterations.len(), Needed::of(&Effort::of(&problem, &times, self.options.every)));
        if work.element_steps > self.wish.limit {
            self.needed = self.needed.or(Some(work));
            return Ok(Some(Reason::Limit));
        }
        let bytes = memory::of_run(&problem, &times) + percute_estimator::memory(&problem, &times, &self.options) as u64;
        memory::refusal(bytes).map_or(Ok(()), |told| Err(Failure::Memory(told)))?;
        let (elements, steps, needed) = (problem.mesh().element_count(), times.step_count(), self.needed);
        tell(&Next { run, branch: made.branch, elements, steps, predicted: made.predicted, work, needed });
        let ordered = Ordered::new(&problem);
        let Some(results) = whole(&ordered, &times, self.options, &mut Discard, observer)? else {
            return Ok(Some(Reason::Interrupted));
        };
        let (name, held, checked, unended) = ("", None, None, None);
        let subject = Subject { name, problem: &problem, times: &times, critical_step, held, checked, unended };
        let report = Report::new(&subject, self.options, results.findings(), 0.0);
        self.take(Best { run, problem, times, critical_step, results, report }, made)
    }

    /// Takes a run in.
    fn take(&mut self, last: Best<D, N>, made: Made) -> Result<Option<Reason>, Failure> {
        let mesh = last.problem.mesh();
        let basis = Basis::new(mesh, &last.results.estimate, &last.results.contact);
        let iteration = Iteration::new(&last.report, basis.as_ref(), &sizes(mesh), self.wish.measure, made);
        let (error, doubtful) = (iteration.error, !iteration.doubts.is_empty());
        let trusted = self.iterations.iter().any(|earlier| earlier.doubts.is_empty());
        self.iterations.push(iteration);
        let reached = error <= self.wish.target;
        if doubtful && (trusted || reached) {
            self.best = self.best.take().or(Some(last));
            return Ok(Some(Reason::Doubt));
        }
        let better = |best: &Best<D, N>| {
            let best = &self.iterations[best.run];
            (doubtful, error) < (!best.doubts.is_empty(), best.error)
        };
        if self.best.as_ref().is_none_or(better) {
            self.best = Some(last.clone());
        }
        self.last = Some((last, basis));
        Ok(match () {
            () if reached => Some(Reason::Reached),
            () if self.iterations.len() == self.wish.runs => Some(Reason::Runs),
            () => None,
        })
    }

    /// The mesh that follows from the last run.
    pub(super) fn next(&mut self) -> Result<Planned<D, N>, Failure> {
        let Some((last, Some(basis))) = &self.last else { return Ok(Planned::End(Reason::NoSources)) };
        let (mesh, iteration) = (last.problem.mesh(), &self.iterations[last.run]);
        let wanted = self.wish.target / iteration.error;
        let effort = Effort::of(&last.problem, &last.times, self.options.every);
        let needed = Needed::of(&effort).times(Plan::whole(basis, wanted).cost);
        self.needed = Some(needed);
        let plan = Plan::new(basis, wanted, &self.largest(mesh, basis));
        // Other plans hold for a step: their mesh may have all that is missing in a few places.
        if plan.branch == Branch::Uniform && needed.element_steps > self.wish.limit {
            return Ok(Planned::End(Reason::Limit));
        }
        let again = self.again(mesh, &plan);
        let (next, predicted) = match again {
            Some(made) => made,
            None => {
                let most = (self.wish.limit / last.times.step_count() as f64) as usize;
                bisected(&self.first, mesh, (basis, &plan), most.max(1))?
            }
        };
        if next.points() == mesh.points() && next.cells() == mesh.cells() {
            return Ok(Planned::End(Reason::SameMesh));
        }
        let made = Made { branch: Some(plan.branch), predicted: Some(predicted * iteration.error) };
        Ok(Planned::Mesh(Box::new(next), made))
    }

    /// The mesh of the generator of the first one, and its expected error over that of the last run, as long as all
    /// elements became smaller alike.
    fn again(&self, mesh: &Mesh<D, N>, plan: &Plan) -> Option<(Mesh<D, N>, f64)> {
        if plan.branch != Branch::Uniform {
            return None;
        }
        let next = mesh.resized(1.0 / plan.ratio.first()?)?;
        let finer = next.element_count() as f64 / mesh.element_count() as f64;
        Some((next, finer.powf(-plan.exponents.far / D as f64)))
    }

    /// How much larger than in the last run each element may become: not larger than in the first mesh, of which all
    /// meshes are bisections.
    fn largest(&self, mesh: &Mesh<D, N>, basis: &Basis) -> Vec<f64> {
        let (locator, first) = (Locator::new(self.first.mesh()), sizes(self.first.mesh()));
        let of = |(e, h): (usize, &f64)| {
            let corners = mesh.cell_points(ElementId::new(e));
            let middle = std::array::from_fn(|c| corners.iter().map(|p| p[c]).sum::<f64>() / N as f64);
            (first[locator.element_near(&middle).index()] / h).clamp(1.0, LARGEST)
        };
        basis.size().iter().enumerate().map(of).collect()
    }

    /// The adaptation as it ended.
    pub(super) fn ended(self, reason: Reason) -> Adaptation<D, N> {
        let Self { wish, iterations, best, needed, .. } = self;
        let needed = needed.filter(|_| reason != Reason::Reached);
        Adaptation { wish, iterations, reason, needed, best }
    }
}
