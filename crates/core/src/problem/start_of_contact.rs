//! The place of the bodies at the start: none is behind its obstacle, and none moves into one on which it is.

use super::gaps::Gaps;
use super::{Cause, InputError, Problem};
use crate::contact::NonMatchingSurfaces;
use crate::ids::ElementId;

/// Bodies that overlap by less than this part of the size of the mesh are not told from those that touch.
const ROUNDING: f64 = 1e-9;

/// At t = 0 no candidate node may lie behind its obstacle, nor on it with an inward velocity; with
/// `planes_to_be_moved`, on other bodies only.
pub(super) fn check<const D: usize>(problem: &Problem<D>, planes_to_be_moved: bool) -> Result<(), InputError> {
    let starts = problem.starts_of_contact();
    check_deepest(problem, &starts)?;
    check_apart(problem)?;
    let is_plane = |at: &usize| problem.obstacles()[problem.surface().nodes()[*at].obstacle].as_plane().is_some();
    match striking(problem, &starts).find(|at| !(planes_to_be_moved && is_plane(at))) {
        Some(at) => Err(strikes(problem, at, starts[at])),
        None => Ok(()),
    }
}

/// The candidate nodes on their obstacles that move into them, as positions in the contact surface.
pub(super) fn striking<'a, const D: usize>(
    problem: &'a Problem<D>,
    starts: &'a [(f64, f64)],
) -> impl Iterator<Item = usize> + 'a {
    let (surface, tolerance) = (problem.surface(), problem.contact_tolerance());
    let strikes = move |(gap, normal): (f64, f64)| gap <= tolerance && normal < -problem.speed_tolerance();
    (0..starts.len()).filter(move |&at| surface.leads(at) && surface.nodes()[at].free && strikes(starts[at]))
}

pub(super) fn strikes<const D: usize>(problem: &Problem<D>, at: usize, (gap, normal): (f64, f64)) -> InputError {
    let contact = &problem.surface().nodes()[at];
    let cause = Cause::StrikesAtStart { node: contact.node.index(), gap, speed: -normal };
    InputError { place: problem.place_of_obstacle(contact.obstacle), cause }
}

/// The gap of the deepest node, for which contact is solved, is not negative.
fn check_deepest<const D: usize>(problem: &Problem<D>, starts: &[(f64, f64)]) -> Result<(), InputError> {
    let (surface, tolerance) = (problem.surface(), problem.contact_tolerance());
    let deeper = |a: usize, b: usize| if starts[b].0 < starts[a].0 { b } else { a };
    let deepest = (0..starts.len()).filter(|&at| surface.leads(at)).reduce(deeper);
    let Some(at) = deepest.filter(|&at| starts[at].0 < -tolerance) else { return Ok(()) };
    let contact = &surface.nodes()[at];
    let (obstacle, depth, node) = (contact.obstacle, -starts[at].0, contact.node.index());
    let cause = match (problem.obstacles()[obstacle].as_plane(), surface.non_matching_of(at)) {
        (Some(plane), _) => Cause::Penetrates { node, depth, clear: plane.point_behind(depth).to_vec() },
        (None, None) => behind(problem, at, depth),
        // That gap is a mean with weights of both signs: of convex surfaces it is less than all gaps.
        (None, Some(index)) => match gaps(problem, &surface.non_matching()[index]).least() {
            Some((gap, at)) if gap < -tolerance => behind(problem, at, -gap),
            _ => Cause::TooNear { node, depth },
        },
    };
    Err(InputError { place: problem.place_of_obstacle(obstacle), cause })
}

/// Sides of a non-matching interface that do not face each other yet are not behind each other.
fn check_apart<const D: usize>(problem: &Problem<D>) -> Result<(), InputError> {
    for non_matching in problem.surface().non_matching() {
        if let Some((depth, at)) = gaps(problem, non_matching).behind()
            && depth > problem.contact_tolerance()
        {
            let place = problem.place_of_obstacle(problem.surface().nodes()[at].obstacle);
            return Err(InputError { place, cause: behind_surface(problem, at, depth) });
        }
    }
    Ok(())
}

/// The group of a node that faces another body, and that of the other surface.
fn groups<const D: usize>(problem: &Problem<D>, at: usize) -> Box<[String; 2]> {
    let own = problem.surface().nodes()[at].obstacle;
    let other = problem.partner_obstacle(own).unwrap_or(own);
    Box::new([own, other].map(|obstacle| problem.obstacles()[obstacle].group().unwrap_or_default().to_string()))
}

fn gaps<'a, const D: usize>(problem: &'a Problem<D>, non_matching: &'a NonMatchingSurfaces<D>) -> Gaps<'a, D> {
    Gaps { surface: problem.surface(), non_matching, displacement: &problem.initial_displacement }
}

/// Why a node that faces the surface of another body may not be so far (m) behind it.
fn behind<const D: usize>(problem: &Problem<D>, at: usize, depth: f64) -> Cause {
    let node = problem.surface().nodes()[at].node;
    // Surfaces that look away from each other are behind each other, too.
    let rounding = depth <= ROUNDING * problem.mesh().size();
    if rounding || problem.mesh().encloses_after(problem.initial_displacement.as_flattened(), node) {
        return Cause::Overlaps { node: node.index(), depth, groups: groups(problem, at) };
    }
    behind_surface(problem, at, depth)
}

/// Why a node may not be so far (m) behind the surface of another body in which it is not. Displacements alone can make
/// bodies overlap: those of a mesh do not.
fn behind_surface<const D: usize>(problem: &Problem<D>, at: usize, depth: f64) -> Cause {
    if let Some(elements) = problem.mesh().overlap_after(problem.initial_displacement.as_flattened()) {
        return Cause::ElementsOverlap { elements: elements.map(ElementId::index) };
    }
    let surface = problem.surface();
    let contact = &surface.nodes()[at];
    // A few digits are enough to be shown.
    let normal = surface.obstacles()[contact.obstacle].flat_frame().normal().map(|n| (1e3 * n).round() / 1e3);
    let groups = groups(problem, at);
    Cause::BehindSurface { node: contact.node.index(), depth, groups, normal: Box::new(normal) }
}
