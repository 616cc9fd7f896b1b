//! The facts that a verdict follows from.

use super::onset::Onset;
use super::uneven::Uneven;
use crate::deformation::Deformation;
use crate::foreign::{Checked, Consistency, Contradiction, by_a_penalty, is_off_contact, off_contact};
use crate::plan::{Basis, Recommendation};
use crate::report::flat::FlatElements;
use crate::report::linearity::{Linearity, largest_flow};
use crate::report::margin::{ElasticMargin, is_at_corner};
use crate::report::poor::{PoorElement, poor_elements};
use crate::report::rebound::Rebound;
use crate::report::symptoms::auxiliary_contact_energy;
use crate::report::touches::{FirstContact, first_contacts};
use percute_core::border::Vector;
use percute_core::contact_results::{ContactResults, Nearest};
use percute_core::ids::ElementId;
use percute_core::material::Law;
use percute_core::mesh::Mesh;
use percute_core::problem::AnyProblem;
use percute_estimator::{Acceleration, ErrorMeasures, Estimate, Options, Reconstruction};

/// Contacts that begin within so many times of a wave along its diagonal belong to one phase. The evidence has 15 µs
/// for bodies of 64 mm with waves of 5.3 km/s.
const APART: f64 = 1.25;

/// What a verdict follows from. More may be added: rules name the facts that they read.
#[derive(Clone, Debug)]
pub(in crate::report) struct Facts {
    pub(super) dimension: usize,
    pub(super) reconstruction: Reconstruction,
    /// Γ_DA, if it is not the default.
    pub(super) acceleration: Option<Acceleration>,
    pub(super) contact: FirstContact,
    /// Normal velocity of the centre of mass before contact over the wave speed; none without contact.
    pub(super) speed_ratio: Option<f64>,
    /// The longest step over the critical one.
    pub(super) courant: f64,
    /// Edges along which the body touches at one instant, at most.
    pub(super) elements_in_contact: usize,
    /// Number of contact phases.
    pub(super) phases: usize,
    /// Time from the first touch to the end over that of a wave along the diagonal of the body; 0 without contact.
    pub(super) passages: f64,
    /// Mean thickness 2 A/P over the diagonal of the body, A its area and P its outline; 1 for a bar.
    pub(super) slenderness: f64,
    /// Whether nearly flat elements have much of the estimate.
    pub(super) flat: bool,
    pub(super) uneven: Uneven,
    /// The elements of bad shape that matter most, if they matter.
    pub(super) poor: Vec<PoorElement>,
    pub(super) linearity: Linearity,
    pub(super) margin: Option<ElasticMargin>,
    /// Whether the largest plastic strain is at a sharp corner, where it has no limit.
    pub(super) flows_at_corner: bool,
    /// The gap that is left where nothing has touched, and the last instant (s).
    pub(super) nearest: Option<(Nearest, f64)>,
    pub(super) onset: Onset,
    pub(super) largest_friction: f64,
    /// The least angle between two planes that touch the body at edges with a common node (degrees).
    pub(super) corner: Option<f64>,
    /// Whether bodies may touch each other.
    pub(super) bodies: bool,
    /// Whether they have non-matching interfaces.
    pub(super) slides: bool,
    /// The farthest that nodes of two bodies in contact were moved along their interface, over their shortest edge.
    pub(super) slip: f64,
    /// The deepest that a node of non-matching interfaces was inside the other body, over its shortest edge.
    pub(super) penetration: f64,
    /// Whether a node of non-matching interfaces that has touched was at the end of the other surface, or beyond it.
    pub(super) at_surface_end: bool,
    /// The largest angle of non-matching surfaces to their common normal (degrees).
    pub(super) inclination: f64,
    pub(super) supported: bool,
    /// Part of the squared mean error in elements with a node that touches.
    pub(super) at_contact: f64,
    pub(super) error: ErrorMeasures,
    pub(super) energy_drift: f64,
    /// Work of contact without friction, over the energy.
    pub(super) contact_energy: f64,
    /// Energy that contact gives to the auxiliary solution, over that of the simulation.
    pub(super) auxiliary_contact_energy: f64,
    pub(super) admissible: bool,
    pub(super) impulse_ratio: Option<f64>,
    pub(super) expected: Option<Expected>,
    /// Of a history of another program: its first figure over a limit.
    pub(super) inconsistent: Option<Contradiction>,
    /// Of a history of another program: the residual of its balance over the largest term.
    pub(super) unbalanced: f64,
    /// Whether the contact of another program is by a penalty.
    pub(super) by_a_penalty: bool,
    /// The largest distance of a node from its plane in contact, over the element size, if it is more than rounding.
    pub(super) off_contact: Option<f64>,
    /// Whether the history has samples instead of steps.
    pub(super) sampled: bool,
    /// Whether its contact forces fit another step better.
    pub(super) shifted: bool,
}

/// What changes the mean error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Expected {
    /// The refinement for half the error.
    pub(super) recommendation: Recommendation,
    /// Whether the layer at a front is a larger source than dispersion.
    pub(super) front: bool,
    pub(super) halved_step: f64,
}

/// What is known beside the problem, the contact results and the estimate.
#[derive(Clone, Copy, Debug)]
pub(in crate::report) struct FurtherFacts<'a> {
    pub(in crate::report) options: Options,
    pub(in crate::report) courant: f64,
    /// Drift of the energy balance.
    pub(in crate::report) drift: f64,
    /// Work of contact without friction, over the energy.
    pub(in crate::report) contact_energy: f64,
    pub(in crate::report) admissible: bool,
    pub(in crate::report) rebound: Option<&'a Rebound>,
    /// Of a history of another program.
    pub(in crate::report) checked: Option<&'a Checked>,
    pub(in crate::report) deformation: &'a Deformation,
}

impl Facts {
    pub(in crate::report) fn new(
        problem: &AnyProblem,
        estimate: &Estimate,
        results: &ContactResults,
        beside: FurtherFacts<'_>,
    ) -> Self {
        let (deformation, figures) = (beside.deformation, beside.checked.map(|checked| &checked.consistency));
        let wave_speed = problem.materials().iter().map(|m| m.wave_speed()).fold(0.0, f64::max);
        let (size, slenderness) = (size_of_bodies(problem.mesh()), slenderness(problem.mesh()));
        let (bodies, by_element) = (!problem.conditions().interfaces.is_empty(), &estimate.by_element);
        let (uneven, d) = (Uneven::new(problem, by_element, results), problem.dimension());
        let flat = FlatElements::new(problem, by_element).is_some();
        let speed = if bodies { approach(problem) } else { beside.rebound.map(|rebound| -rebound.normal_before) };
        Self {
            dimension: d,
            reconstruction: beside.options.reconstruction,
            acceleration: other_acceleration(beside.options, d),
            margin: ElasticMargin::new(problem, deformation, estimate, results),
            contact: FirstContact::new(problem, results),
            speed_ratio: speed.map(|speed| without_rounding(speed / wave_speed)),
            courant: beside.courant,
            elements_in_contact: elements_in_contact(d, results),
            phases: phases(results, APART * size / wave_speed, release(figures, slenderness * size / wave_speed)),
            passages: after_first_touch(results) * wave_speed / size,
            slenderness,
            poor: if flat || uneven.longest > 1.0 { poor_elements(problem.mesh(), by_element) } else { Vec::new() },
            flat,
            uneven,
            flows_at_corner: flows_at_corner(problem, results, deformation),
            linearity: Linearity::new(deformation, problem.is_finite()),
            nearest: results.nearest.zip(results.instants.last().copied()),
            onset: Onset::new(problem, results, beside.rebound, speed),
            largest_friction: problem.obstacles().map(|o| o.law().friction()).fold(0.0, f64::max),
            corner: corner(problem, results),
            bodies,
            slides: problem.non_matching_count() > 0,
            slip: results.slip,
            penetration: results.penetration,
            at_surface_end: results.at_surface_end,
            inclination: results.inclination.to_degrees(),
            supported: !problem.prescribed().is_empty(),
            at_contact: at_contact(problem, estimate, results),
            error: estimate.error,
            energy_drift: beside.drift,
            contact_energy: beside.contact_energy,
            auxiliary_contact_energy: auxiliary_contact_energy(estimate, beside.checked),
            admissible: beside.admissible,
            // An isolated contact node touches at other instants in the admissible fields.
            impulse_ratio: estimate.impulse_ratio.filter(|_| estimate.isolated_contact_nodes == 0),
            expected: expected(problem, estimate, results),
            inconsistent: beside.checked.and_then(|checked| checked.contradiction.clone()),
            unbalanced: figures.map_or(0.0, |found| found.balance),
            by_a_penalty: figures.is_some_and(by_a_penalty),
            off_contact: figures.filter(|found| is_off_contact(found)).map(off_contact),
            sampled: beside.checked.is_some_and(|checked| checked.samples.is_some()),
            shifted: beside.checked.is_some_and(|checked| checked.shifted.is_some()),
        }
    }
}

impl Facts {
    /// Whether a material yields by a law with plasticity, or may do so on a finer mesh.
    pub(super) fn may_flow(&self) -> bool {
        self.linearity.yielded.is_some() || self.margin.as_ref().is_some_and(ElasticMargin::may_flow)
    }

    /// Whether the body that is struck has the mean gaps.
    pub(super) fn acts_late(&self) -> bool {
        self.slides && self.contact.strikes_flat_slave
    }

    /// Whether the error is zero to rounding, as in the flight of a rigid body.
    pub(super) fn is_exact(&self) -> bool {
        self.error.is_zero()
    }
}

/// The shortest release (s): on the springs of a penalty nodes bounce, for less than a wave `crossing` the body.
fn release(figures: Option<&Consistency>, crossing: f64) -> f64 {
    if figures.is_some_and(by_a_penalty) { crossing } else { 0.0 }
}

/// Edges along which the body touches at one instant, at most.
fn elements_in_contact(dimension: usize, results: &ContactResults) -> usize {
    let most = results.total.iter().map(|resultant| resultant.in_contact).max().unwrap_or(0);
    if dimension == 1 { most } else { most.saturating_sub(1).max(most.min(1)) }
}

fn flows_at_corner(problem: &AnyProblem, results: &ContactResults, deformation: &Deformation) -> bool {
    let element = largest_flow(&deformation.materials).map(|(_, _, flow)| flow.equivalent_strain.element);
    element.is_some_and(|element| is_at_corner(problem, results, ElementId::new(element)))
}

fn other_acceleration(options: Options, dimension: usize) -> Option<Acceleration> {
    let default = Options { acceleration: None, ..options }.acceleration(dimension);
    options.acceleration.filter(|&given| given != default)
}

fn expected(problem: &AnyProblem, estimate: &Estimate, results: &ContactResults) -> Option<Expected> {
    let basis = Basis::new(problem.mesh(), estimate, results)?;
    let sources = basis.sources();
    let halved_step = sources.mean_with_halved_step()? / estimate.error.mean - 1.0;
    let front = sources.mean.front > sources.mean.dispersion;
    halved_step.is_finite().then(|| Expected { recommendation: Recommendation::new(&basis), front, halved_step })
}

/// The time from the first touch to the last instant (s); 0 without contact.
fn after_first_touch(results: &ContactResults) -> f64 {
    let first = first_contacts(results).into_iter().flatten().reduce(f64::min);
    results.instants.last().zip(first).map_or(0.0, |(last, first)| last - first)
}

/// Number of contact phases; contacts that begin within `apart` (s) are one, and so are those between which is a
/// release of less than `shortest` (s).
fn phases(results: &ContactResults, apart: f64, shortest: f64) -> usize {
    let (mut count, mut begun, mut released) = (0, f64::NEG_INFINITY, Some(f64::NEG_INFINITY));
    for (resultant, &time) in results.total.iter().zip(&results.instants) {
        match (resultant.in_contact > 0, released) {
            (true, Some(since)) => {
                if time - since >= shortest {
                    count += usize::from(time - begun > apart);
                    begun = time;
                }
                released = None;
            }
            (false, None) => released = Some(time),
            (true, None) | (false, Some(_)) => {}
        }
    }
    count
}

/// The least angle between two planes that are touched in the course of time and meet at a node of the surface
/// (degrees). The node itself may touch one of them only: an impact on one of two planes that open by more than 90
/// degrees throws it away from the other.
fn corner(problem: &AnyProblem, results: &ContactResults) -> Option<f64> {
    let nodes = problem.contact_nodes();
    let mut touched = vec![false; problem.obstacle_count()];
    for (contact, first) in nodes.iter().zip(first_contacts(results)) {
        touched[contact.obstacle] |= first.is_some();
    }
    let planes = nodes.iter().filter_map(|contact| Some([contact.obstacle, nodes[contact.second_slot?].obstacle]));
    let opening = |planes: [usize; 2]| {
        let [one, two] = planes.map(|obstacle| problem.obstacle(obstacle).frame());
        (-one.split(two.normal()).0).clamp(-1.0, 1.0).acos().to_degrees()
    };
    planes.filter(|planes| planes.iter().all(|&plane| touched[plane])).map(opening).min_by(f64::total_cmp)
}

/// The largest speed at which two bodies approach each other at the start, at the nodes of their contact (m/s).
fn approach(problem: &AnyProblem) -> Option<f64> {
    let (nodes, starts) = (problem.contact_nodes(), problem.starts_of_contact());
    let of_bodies = |at: &usize| nodes[*at].partner.is_some() || problem.non_matching_of(*at).is_some();
    (0..starts.len()).filter(of_bodies).map(|at| -starts[at].1).reduce(f64::max)
}

/// Diagonal of the bounding box of the largest body (m).
fn size_of_bodies(mesh: &Mesh) -> f64 {
    if mesh.parts() < 2 {
        return mesh.size();
    }
    let mut boxes = vec![[[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]]; mesh.node_count()];
    for (point, first) in mesh.places().zip(mesh.part_of_nodes()) {
        let [low, high] = &mut boxes[first.index()];
        for c in 0..3 {
            (low[c], high[c]) = (low[c].min(point[c]), high[c].max(point[c]));
        }
    }
    let size = |[low, high]: &[Vector; 2]| (0..3).map(|c| (high[c] - low[c]).powi(2)).sum::<f64>().sqrt();
    boxes.iter().filter(|[low, _]| low[0].is_finite()).map(size).fold(0.0, f64::max)
}

fn slenderness(mesh: &Mesh) -> f64 {
    if mesh.dimension() == 1 {
        return 1.0;
    }
    let area: f64 = mesh.volumes().iter().sum();
    let outline: f64 = mesh.boundary().map(|face| mesh.face_normal(face).1).sum();
    2.0 * area / outline / mesh.size()
}

/// The part of the squared error in the elements with a node that touches.
fn at_contact(problem: &AnyProblem, estimate: &Estimate, results: &ContactResults) -> f64 {
    let mesh = problem.mesh();
    let mut near = vec![false; mesh.element_count()];
    for (place, first) in results.nodes.iter().zip(first_contacts(results)) {
        if first.is_some() {
            mesh.elements_around(place.node).iter().for_each(|element| near[element.index()] = true);
        }
    }
    let sum = |all: bool| -> f64 {
        estimate.by_element.iter().zip(&near).filter(|(_, near)| all || **near).map(|(e, _)| e * e).sum()
    };
    let total = sum(true);
    if total > 0.0 { sum(false) / total } else { 0.0 }
}

/// A ratio of speeds, 0 where it is rounding, as that of a body that only spins.
fn without_rounding(ratio: f64) -> f64 {
    if ratio.abs() < 1e-12 { 0.0 } else { ratio }
}
