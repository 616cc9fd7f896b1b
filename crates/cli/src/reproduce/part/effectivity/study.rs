//! Impacts of plane bodies on meshes that are refined: the estimates beside errors against still finer meshes.

use super::body::Body;
use super::touch::{Touch, Touching};
use crate::reproduce::ReproduceError;
use percute_core::dynamics::{SimulationError, critical_time_step, simulate};
use percute_core::material::{Elastic, Hypothesis};
use percute_core::observer::Observer;
use percute_core::obstacle::Plane;
use percute_core::problem::{Initial, Problem, TriangleProblem};
use percute_core::time::TimeGrid;
use percute_estimator::reference::{Comparison, Motion, Recorder};
use percute_estimator::{ErrorMeasures, Estimator, Options, Reconstruction};

/// Δt/Δt_c, exactly, of all runs but those that are there for short steps.
pub(super) const STEP: f64 = 0.9;
/// Refinements of the meshes that are estimated, coarsest first.
pub(super) const ESTIMATED: [usize; 4] = [0, 1, 2, 3];

/// The readings of the contact force, each on the thread that calls.
pub(super) fn readings() -> Vec<Options> {
    let options = |&reconstruction| Options { reconstruction, threads: Some(1), ..Options::default() };
    Reconstruction::ALL.iter().map(options).collect()
}

/// One impact of an aluminium body (E = 70 GPa, ν = 0.3, ρ = 2700 kg/m³, as in the paper's §7.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct Case {
    /// What hits the plane.
    pub(in super::super) body: Body,
    /// Plane stress or strain.
    pub(in super::super) hypothesis: Hypothesis,
    /// μ.
    pub(in super::super) friction: f64,
    /// By how much the plane is turned clockwise under the body (°).
    pub(in super::super) tilt: f64,
    /// v₀ along and across the plane (m/s).
    pub(in super::super) velocity: [f64; 2],
    /// Distance of the lowest node from the plane (m).
    pub(in super::super) gap: f64,
    /// T (s); a run ends with its first instant at or past it.
    pub(in super::super) end: f64,
    /// Δt/Δt_c on the meshes that are estimated.
    pub(in super::super) ratio: f64,
    /// How many of the meshes are estimated.
    pub(in super::super) meshes: usize,
    /// Refinements of the references, coarsest first; the last one counts.
    pub(in super::super) references: &'static [usize],
}

/// What was found on one mesh.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct Found {
    /// Number of elements.
    pub(in super::super) elements: usize,
    /// Number of steps.
    pub(in super::super) steps: usize,
    /// The estimate of each choice.
    pub(in super::super) estimates: Vec<ErrorMeasures>,
    /// Impulse that the admissible contact force of each keeps.
    pub(in super::super) kept_impulse: Vec<Option<f64>>,
    /// The contact part of η where it is largest, of each.
    pub(in super::super) contact: Vec<f64>,
    /// Sup and mean of e_ref (J^½) against each reference.
    pub(in super::super) exact: Vec<[f64; 2]>,
    /// When the body touches.
    pub(super) touch: Touch,
}

impl Found {
    /// e/e_ref, sup and mean, of a choice, against the finest reference.
    pub(in super::super) fn effectivity(&self, choice: usize) -> [f64; 2] {
        let [sup, mean] = self.exact.last().copied().unwrap_or([f64::NAN; 2]);
        [self.estimates[choice].sup / sup, self.estimates[choice].mean / mean]
    }
}

impl Case {
    /// The problem on one of the meshes.
    pub(in super::super) fn problem(&self, refinements: usize) -> Result<TriangleProblem, ReproduceError> {
        let (sin, cos) = self.tilt.to_radians().sin_cos();
        let (normal, tangent) = ([sin, cos], [cos, -sin]);
        let mesh = self.body.mesh(refinements)?;
        let height = |p: &[f64; 2]| p[0] * normal[0] + p[1] * normal[1];
        let lowest = mesh.points().iter().map(height).fold(f64::INFINITY, f64::min) - self.gap;
        let [along, across] = self.velocity;
        let material = match self.hypothesis {
            Hypothesis::PlaneStrain => Elastic::plane_strain(70e9, 0.3, 2700.0, 1.0)?,
            _ => Elastic::plane_stress(70e9, 0.3, 2700.0, 1.0)?,
        };
        Ok(Problem::builder(mesh)
            .material(material)
            .initial_velocity(Initial::Uniform([0, 1].map(|c| along * tangent[c] + across * normal[c])))
            .obstacle(Plane::new(normal.map(|n| n * lowest), normal, self.friction, None)?)
            .build()?)
    }

    /// About how long it takes, in any unit: its finest reference decides.
    pub(super) fn cost(&self) -> u64 {
        let finest = self.references.last().map_or(0, |&refinements| 1 << (3 * refinements));
        // Time in ns.
        finest * (1e9 * self.end) as u64
    }

    /// What is found on the finest of the meshes that are estimated.
    pub(super) fn run_finest(&self, choices: &[Options], observer: &mut dyn Observer) -> Result<Found, ReproduceError> {
        let finest = self.run(choices, observer)?.into_iter().flatten().next_back();
        finest.ok_or_else(|| ReproduceError::Unexpected(format!("no run: {}", self.name())))
    }

    /// Estimates on each mesh, then compares with the references. A mesh that is not wanted, or on which the body starts
    /// too near to the plane, is left out: `None`.
    pub(in super::super) fn run(
        &self,
        choices: &[Options],
        observer: &mut dyn Observer,
    ) -> Result<Vec<Option<Found>>, ReproduceError> {
        let mut runs = Vec::new();
        for &refinements in ESTIMATED.iter().take(self.meshes) {
            let problem = self.problem(refinements)?;
            let times = steps_past(self.end, self.ratio, &problem)?;
            let run = estimate(&problem, &times, choices, observer)?;
            runs.push((problem, times, run));
        }
        let end = runs.iter().map(|run| run.1.end()).fold(0.0, f64::max);
        for &refinements in self.references {
            let fine = self.problem(refinements)?;
            let times = steps_past(end, STEP, &fine)?;
            let mut comparison = Comparison::new(&fine, &times);
            for (problem, _, run) in &runs {
                if let Some((motion, _)) = run {
                    comparison.add(problem, motion)?;
                }
            }
            simulate(&fine, &times, &mut comparison, observer)?;
            let errors = comparison.finish()?;
            let found = runs.iter_mut().filter_map(|run| run.2.as_mut().map(|run| &mut run.1));
            found.zip(errors).for_each(|(found, error)| found.exact.push([error.sup, error.mean]));
        }
        let mut found: Vec<_> = runs.into_iter().map(|(_, _, run)| run.map(|run| run.1)).collect();
        found.resize_with(ESTIMATED.len(), || None);
        Ok(found)
    }
}

/// Steps of exactly a part of Δt_c that reach an instant.
fn steps_past(reach: f64, ratio: f64, problem: &TriangleProblem) -> Result<TimeGrid, ReproduceError> {
    let step = ratio * critical_time_step(problem);
    let count = (reach / step).ceil();
    Ok(TimeGrid::uniform(count * step, count as usize)?)
}

/// Simulates and estimates with each choice; nothing if the body starts too near to the plane.
fn estimate(
    problem: &TriangleProblem,
    times: &TimeGrid,
    choices: &[Options],
    observer: &mut dyn Observer,
) -> Result<Option<(Motion<2>, Found)>, ReproduceError> {
    let estimator = |options: &Options| Estimator::new(problem, times, *options);
    let estimators = choices.iter().map(estimator).collect::<Result<Vec<_>, _>>()?;
    let mut sink = (Recorder::new(problem, times), (Touching::default(), estimators));
    match simulate(problem, times, &mut sink, observer) {
        Ok(_) => {}
        Err(SimulationError::StartsTooNear { .. }) => return Ok(None),
        Err(other) => return Err(other.into()),
    }
    let (recorder, (touching, estimators)) = sink;
    let estimates = estimators.into_iter().map(Estimator::finish).collect::<Result<Vec<_>, _>>()?;
    let found = Found {
        elements: problem.mesh().element_count(),
        steps: times.step_count(),
        estimates: estimates.iter().map(|estimate| estimate.error).collect(),
        kept_impulse: estimates.iter().map(|estimate| estimate.kept_impulse).collect(),
        contact: estimates.iter().map(|estimate| estimate.parts.contact / estimate.parts.total()).collect(),
        exact: Vec::new(),
        touch: touching.finish(),
    };
    Ok(Some((recorder.finish(), found)))
}
