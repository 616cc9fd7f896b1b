//! From the results of a run to its report.

use super::warnings::{Facts, Warning, few_samples, reported, warnings};
use super::{
    ADMISSIBLE, BalanceOverTime, BalanceSummary, ContactReport, FORMAT, Given, LargestResidual, Measures,
    ObstacleSummary, OptionsUsed, OverTime, Parts, ProblemSummary, Report, Subject, Versions, WorstElement, meaning,
};
use percute_core::contact::ContactResults;
use percute_core::dynamics::{Balance, Simulation};
use percute_core::ids::ElementId;
use percute_core::mesh::Mesh;
use percute_core::problem::plausibility_warnings;
use percute_estimator::{ErrorMeasures, Estimate, Options, Sample};

/// How many elements the report names.
const WORST: usize = 5;

impl Report {
    /// Puts together what a run, or the estimate of a history, gave.
    #[must_use]
    pub fn new<const D: usize, const N: usize>(
        subject: &Subject<'_, D, N>,
        options: Options,
        simulation: &Simulation,
        estimate: &Estimate<D>,
        contact: &ContactResults<D>,
        seconds: f64,
    ) -> Self {
        let Subject { name, times, critical_step, held, .. } = *subject;
        let (largest_residual, problem) = (largest_residual(estimate), problem_summary(subject));
        let mut plausibility_warnings = plausibility_warnings(subject.problem, times);
        // What was foreseen and did not come is no warning any more.
        plausibility_warnings.retain(|plausibility_warning| {
            plausibility_warning.name != "never_touches" || estimate.kept_impulse.is_none()
        });
        let (kept_impulse, residual, planned) = (estimate.kept_impulse, &largest_residual, times.step_count());
        let (drift, interrupted) = (simulation.balance.energy_drift, estimate.steps < planned);
        let reconstruction = options.reconstruction;
        let facts = Facts {
            problem: &problem,
            plausibility_warnings: &plausibility_warnings,
            drift,
            interrupted,
            reconstruction,
            kept_impulse,
            residual,
        };
        let mut warnings = warnings(&facts);
        warnings.extend(
            few_samples(options.every, planned).map(|few| Warning { message: format!("every {}", few.message), ..few }),
        );
        warnings.extend(reported(subject.problem.mesh()));
        Self {
            format: FORMAT,
            versions: Versions::of_this_program(),
            case: name.into(),
            problem,
            warnings,
            options: options_used(options),
            time_step: times.longest_step(),
            critical_time_step: critical_step,
            steps: estimate.steps,
            end: estimate.end,
            steps_planned: planned,
            interrupted,
            given: given(estimate),
            held,
            error: measures(&estimate.error),
            meaning: meaning(Some(options.reconstruction)),
            parts: parts(&estimate.parts),
            time_of_sup: estimate.time_of_sup,
            worst_elements: worst(subject.problem.mesh(), estimate),
            residuals: estimate.residuals.entries().to_vec(),
            largest_residual,
            balance: balance_summary(&simulation.balance),
            balance_over_time: balance_over_time(&simulation.balance_over_time, times.instants()),
            kept_impulse,
            contact: ContactReport::new(contact),
            over_time: over_time(&estimate.over_time),
            by_element: estimate.by_element.clone(),
            seconds,
        }
    }
}

fn given<const D: usize>(estimate: &Estimate<D>) -> Given {
    Given { velocity: estimate.given.velocity, acceleration: estimate.given.acceleration }
}

fn options_used(options: Options) -> OptionsUsed {
    OptionsUsed {
        reconstruction: options.reconstruction.to_string(),
        acceleration: options.acceleration.to_string(),
        every: options.every,
        threads: options.threads,
        window: options.window,
    }
}

pub(crate) fn problem_summary<const D: usize, const N: usize>(subject: &Subject<'_, D, N>) -> ProblemSummary {
    let (problem, mesh) = (subject.problem, subject.problem.mesh());
    let extreme =
        |c: usize, pick: fn(f64, f64) -> f64| mesh.points().iter().map(|p| p[c]).fold(mesh.points()[0][c], pick);
    let obstacle = |obstacle: &percute_core::contact::Obstacle<D>| ObstacleSummary {
        point: obstacle.shape().point().to_vec(),
        normal: obstacle.flat_frame().normal().to_vec(),
        friction: obstacle.law().friction(),
        group: obstacle.group().map(str::to_string),
    };
    ProblemSummary {
        dimension: D,
        nodes: mesh.node_count(),
        elements: mesh.element_count(),
        reoriented_elements: mesh.reoriented_elements(),
        lower_corner: (0..D).map(|c| extreme(c, f64::min)).collect(),
        upper_corner: (0..D).map(|c| extreme(c, f64::max)).collect(),
        mass: problem.mass().iter().sum(),
        wave_speed: problem.materials().iter().map(|m| m.wave_speed()).fold(0.0, f64::max),
        materials: problem.materials().len(),
        obstacles: problem.obstacles().iter().map(obstacle).collect(),
        contact_nodes: problem.surface().nodes().len(),
        prescribed_components: problem.prescribed().len(),
        loaded_facets: problem.facet_loads().len(),
        body_forces: problem.body_loads().len(),
        resampling_error: problem.resampling_error(subject.times.instants()),
    }
}

fn measures(error: &ErrorMeasures) -> Measures {
    Measures {
        sup: error.sup,
        mean: error.mean,
        relative_sup: error.relative_sup,
        relative_mean: error.relative_mean,
        reference_sup: error.reference_sup,
        reference_mean: error.reference_mean,
    }
}

fn parts(parts: &percute_estimator::Parts) -> Parts {
    Parts { kinetic: parts.kinetic, elastic: parts.elastic, contact: parts.contact }
}

pub(crate) fn balance_summary(balance: &Balance) -> BalanceSummary {
    BalanceSummary {
        kinetic: balance.kinetic,
        strain: balance.strain,
        initial: balance.initial,
        work_of_loads: balance.work_of_loads,
        work_of_supports: balance.work_of_supports,
        work_of_contact: balance.work_of_contact,
        friction: balance.friction,
        energy_drift: balance.energy_drift,
        impulse_drift: balance.impulse_drift,
    }
}

fn worst<const D: usize, const N: usize>(mesh: &Mesh<D, N>, estimate: &Estimate<D>) -> Vec<WorstElement> {
    let centroid = |element: ElementId| {
        let corners = mesh.cell_points(element);
        (0..D).map(|c| corners.iter().map(|p| p[c]).sum::<f64>() / N as f64).collect()
    };
    let named = |(id, error): (ElementId, f64)| WorstElement { element: id.index(), error, centroid: centroid(id) };
    estimate.worst_elements(WORST).into_iter().map(named).collect()
}

/// The largest residual; one that is no number counts as largest, so that it cannot hide.
fn largest_residual<const D: usize>(estimate: &Estimate<D>) -> LargestResidual {
    let rank = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
    let entries = estimate.residuals.entries();
    let (name, value) =
        entries.iter().fold(entries[0], |worst, &next| if rank(next.1) > rank(worst.1) { next } else { worst });
    LargestResidual { name, value, admissible: value <= ADMISSIBLE }
}

fn balance_over_time(balances: &[Balance], instants: &[f64]) -> BalanceOverTime {
    let column = |of: fn(&Balance) -> f64| balances.iter().map(of).collect();
    BalanceOverTime {
        time: instants[..balances.len()].to_vec(),
        kinetic: column(|b| b.kinetic),
        strain: column(|b| b.strain),
        work_of_loads: column(|b| b.work_of_loads),
        work_of_supports: column(|b| b.work_of_supports),
        work_of_contact: column(|b| b.work_of_contact),
        friction: column(|b| b.friction),
    }
}

fn over_time(samples: &[Sample]) -> OverTime {
    let column = |of: fn(&Sample) -> f64| samples.iter().map(of).collect();
    OverTime {
        time: column(|s| s.time),
        kinetic: column(|s| s.parts.kinetic),
        elastic: column(|s| s.parts.elastic),
        contact: column(|s| s.parts.contact),
        total: column(|s| s.parts.total()),
        reference: column(|s| s.reference),
    }
}
