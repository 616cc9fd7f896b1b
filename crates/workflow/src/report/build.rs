//! From the results of a run to its report.

use super::columns::{Columns, EnergiesOverTime, PARTS};
use super::flat::FlatElements;
use super::found::found;
use super::linearity::Linearity;
use super::narrow::NarrowContact;
use super::symptoms::auxiliary_contact_energy;
use super::varying_steps::varying_steps;
use super::warnings::{Warning, WarningFacts, few_samples, reported};
use super::{
    ADMISSIBLE, ContactReport, FORMAT, Findings, Impacts, LargestResidual, NonMatchingReport, ObstacleSummary,
    ProblemSummary, Rebound, Report, SourceReport, Subject, Verdict, Versions, WorstElement, meaning, verdict,
};
use crate::foreign::Checked;
use percute_core::contact::AnyObstacle;
use percute_core::dynamics::Balance;
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::mesh::Mesh;
use percute_core::problem::{AnyProblem, PlausibilityWarning, plausibility_warnings};
use percute_estimator::{Estimate, Options};

/// How many elements the report names.
const WORST: usize = 5;

impl Report {
    /// Puts together what a run, or the estimate of a history, gave.
    #[must_use]
    #[allow(clippy::too_many_lines, reason = "a line for each key")]
    pub fn new(subject: &Subject<'_>, options: Options, findings: Findings<'_>, seconds: f64) -> Self {
        let Findings { simulation, estimate, contact, deformation, outline } = findings;
        let Subject { name, times, critical_step, held, checked, problem: problem_of, .. } = *subject;
        let (largest_residual, problem) = (largest_residual(estimate), problem_summary(subject));
        let (rebound, verdict) = judged(subject, options, largest_residual.admissible, findings);
        let [mut warnings, told_before] = warnings(subject, options, findings, rebound.as_ref());
        warnings.extend(told_before);
        Self {
            format: FORMAT,
            versions: Versions::of_this_program(),
            case: name.into(),
            simulated_by: checked.and_then(|checked| checked.program.clone()),
            problem,
            warnings,
            options: options.filled(subject.problem.dimension()),
            time_step: times.longest_step(),
            critical_time_step: critical_step,
            steps: estimate.steps,
            end: estimate.end,
            steps_planned: times.step_count(),
            interrupted: estimate.steps < times.step_count(),
            supplied: estimate.supplied,
            derived: checked.map(|checked| checked.derived.clone()).unwrap_or_default(),
            consistency: checked.map(|checked| checked.consistency),
            samples: checked.and_then(|checked| checked.samples),
            accepted_inconsistent: checked.is_some_and(|checked| checked.contradiction.is_some()),
            held,
            error: estimate.error,
            meaning: meaning(),
            verdict,
            parts: estimate.parts,
            sources: estimate.sources.as_ref().map(SourceReport::new),
            time_of_sup: estimate.time_of_sup,
            worst_elements: worst(subject.problem.mesh(), estimate),
            residuals: estimate.residuals,
            largest_residual,
            balance: simulation.balance,
            balance_over_time: EnergiesOverTime::new(times.instants(), &simulation.balance_over_time),
            impulse_ratio: estimate.impulse_ratio,
            isolated_contact_nodes: estimate.isolated_contact_nodes,
            auxiliary_contact_energy: estimate.auxiliary_contact_energy,
            contact: ContactReport::new(contact),
            rebound,
            impacts: Impacts::new(problem_of, contact, Some(deformation)),
            non_matching: NonMatchingReport::all(problem_of, contact, &estimate.surfaces),
            deformation: deformation.clone(),
            over_time: Columns::new(estimate.over_time.clone(), PARTS),
            by_element: estimate.by_element.clone(),
            outline: outline.cloned(),
            seconds: Some(seconds),
        }
    }
}

/// The rebound and the verdict.
fn judged(
    subject: &Subject<'_>,
    options: Options,
    admissible: bool,
    findings: Findings<'_>,
) -> (Option<Rebound>, Verdict) {
    let Findings { simulation, estimate, contact, deformation, .. } = findings;
    let Subject { problem, times, critical_step, checked, .. } = *subject;
    let (courant, drift) = (times.longest_step() / critical_step, simulation.balance.energy_drift);
    let contact_energy = contact_energy(&simulation.balance, checked);
    let rebound = rebound_of(problem, findings);
    let rebounded = rebound.as_ref();
    let beside = verdict::FurtherFacts {
        options,
        courant,
        drift,
        contact_energy,
        admissible,
        rebound: rebounded,
        checked,
        deformation,
    };
    let verdict = Verdict::new(&verdict::Facts::new(problem, estimate, contact, beside), &estimate.parts);
    (rebound, verdict)
}

/// The plausibility warnings; a contact that came is not foreseen to fail.
fn foreseen(subject: &Subject<'_>, estimate: &Estimate) -> Vec<PlausibilityWarning> {
    let mut all = plausibility_warnings(subject.problem, subject.times);
    all.retain(|warning| warning.name != "never_touches" || estimate.impulse_ratio.is_none());
    all
}

/// The warnings of a result: those that only the result shows, and those that a run is told of before.
pub fn warnings_of(subject: &Subject<'_>, options: Options, findings: Findings<'_>) -> [Vec<Warning>; 2] {
    warnings(subject, options, findings, rebound_of(subject.problem, findings).as_ref())
}

fn rebound_of(problem: &AnyProblem, findings: Findings<'_>) -> Option<Rebound> {
    let Findings { simulation, contact, deformation, .. } = findings;
    Rebound::new(problem, &simulation.balance_over_time, contact, Some(deformation))
}

/// [`warnings_of`], with the rebound.
fn warnings(
    subject: &Subject<'_>,
    options: Options,
    Findings { simulation, estimate, contact, deformation, .. }: Findings<'_>,
    rebound: Option<&Rebound>,
) -> [Vec<Warning>; 2] {
    let balance = &simulation.balance;
    let Subject { times, checked, critical_step, unended, .. } = *subject;
    let foreseen = foreseen(subject, estimate);
    let flat = FlatElements::new(subject.problem, &estimate.by_element);
    let facts = WarningFacts {
        problem: &problem_summary(subject),
        checked,
        plausibility_warnings: &foreseen,
        drift: balance.energy_drift,
        contact_energy: contact_energy(balance, checked),
        published_relative: [estimate.error.published_relative_sup, estimate.error.published_relative_mean],
        steps_vary: times.varies(),
        interrupted: estimate.steps < times.step_count(),
        reconstruction: options.reconstruction,
        impulse_ratio: estimate.impulse_ratio,
        touches: contact.total.iter().any(|sum| sum.force.iter().any(|f| *f != 0.0)),
        isolated_contact_nodes: estimate.isolated_contact_nodes,
        auxiliary_contact_energy: auxiliary_contact_energy(estimate, checked),
        touches_again: rebound.and_then(|rebound| rebound.touches_again),
        narrow: NarrowContact::new(subject.problem, contact),
        slip: contact.slip,
        penetration: contact.penetration,
        inclination: contact.inclination.to_degrees(),
        linearity: &Linearity::new(deformation, subject.problem.is_finite()),
        residual: &largest_residual(estimate),
        flat: flat.as_ref(),
        critical_step,
    };
    let few = few_samples(options.every, times.step_count());
    let few = few.map(|few| Warning { message: format!("every {}", few.message), ..few });
    // The steps of another program have been taken, and its samples are none.
    let varying = checked.is_none().then(|| varying_steps(times, critical_step)).flatten();
    let varying = varying.map(|varying| Warning { message: format!("the steps {}", varying.message), ..varying });
    let before = unended.cloned().into_iter().chain(foreseen.iter().map(Warning::from)).chain(varying).chain(few);
    [found(&facts), before.chain(reported(subject.problem.mesh())).collect()]
}

/// Work of contact without that of friction, over the larger of the first and the last energy; at most 0, to rounding,
/// where contact is what it should be. A history of another program has works of its samples and its own scheme: 0.
fn contact_energy(balance: &Balance, checked: Option<&Checked>) -> f64 {
    let energy = balance.initial.max(balance.kinetic + balance.strain);
    if energy > 0.0 && checked.is_none() { balance.given_by_contact() / energy } else { 0.0 }
}

pub(crate) fn problem_summary(subject: &Subject<'_>) -> ProblemSummary {
    let (problem, mesh) = (subject.problem, subject.problem.mesh());
    let d = mesh.dimension();
    let corner = |pick: fn(f64, f64) -> f64| -> Vec<f64> {
        (0..d).map(|c| mesh.places().map(|place| place[c]).reduce(pick).unwrap_or_default()).collect()
    };
    let obstacle = |obstacle: AnyObstacle| ObstacleSummary {
        point: obstacle.as_plane().map(|[point, _]| point[..d].to_vec()),
        // Without negative zeros.
        normal: obstacle.frame().normal()[..d].iter().map(|x| x + 0.0).collect(),
        friction: obstacle.law().friction(),
        group: obstacle.group().map(str::to_string),
    };
    ProblemSummary {
        dimension: d,
        nodes: mesh.node_count(),
        elements: mesh.element_count(),
        reoriented_elements: mesh.reoriented_elements(),
        lower_corner: corner(f64::min),
        upper_corner: corner(f64::max),
        per_metre: problem.units().per_metre,
        mass: problem.mass().iter().sum(),
        wave_speed: problem.materials().iter().map(|m| m.wave_speed()).fold(0.0, f64::max),
        materials: problem.materials().len(),
        obstacles: problem.obstacles().map(obstacle).collect(),
        contact_nodes: problem.contact_nodes().len(),
        prescribed_components: problem.prescribed().len(),
        loaded_edges: problem.face_loads().len(),
        body_forces: problem.body_loads().len(),
        resampling_error: problem.resampling_error(subject.times.instants()),
    }
}

fn worst(mesh: &Mesh, estimate: &Estimate) -> Vec<WorstElement> {
    let named = |(id, error): (ElementId, f64)| {
        let centroid = mesh.centroid(id)[..mesh.dimension()].to_vec();
        WorstElement { element: id.index(), error, centroid }
    };
    estimate.worst_elements(WORST).into_iter().map(named).collect()
}

/// The largest residual; one that is no number counts as largest, so that it cannot hide.
fn largest_residual(estimate: &Estimate) -> LargestResidual {
    let rank = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
    let entries = estimate.residuals.entries();
    let (name, value) =
        entries.iter().fold(entries[0], |worst, &next| if rank(next.1) > rank(worst.1) { next } else { worst });
    LargestResidual { name, value, admissible: value <= ADMISSIBLE }
}
