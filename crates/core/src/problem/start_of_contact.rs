//! The place of the bodies at the start: none is behind its obstacle, and none moves into one on which it is.

use super::{Cause, InputError, Problem};
use crate::contact::{Coupling, Side, SlidingSurfaces};

/// At t = 0 no candidate node may lie behind its obstacle, nor on it with an inward velocity.
pub(super) fn check<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Result<(), InputError> {
    let starts = problem.starts_of_contact();
    check_deepest(problem, &starts)?;
    check_apart(problem)?;
    let tolerance = problem.contact_tolerance();
    for (at, contact) in problem.surface().nodes().iter().enumerate().filter(|&(at, _)| problem.surface().leads(at)) {
        let (gap, normal) = starts[at];
        if gap <= tolerance && normal < -problem.speed_tolerance() && contact.free {
            let cause = Cause::StrikesAtStart { node: contact.node.index(), gap, speed: -normal };
            return Err(InputError { place: problem.place_of_obstacle(contact.obstacle), cause });
        }
    }
    Ok(())
}

/// The gap of the deepest node, for which contact is solved, is not negative.
fn check_deepest<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    starts: &[(f64, f64)],
) -> Result<(), InputError> {
    let (surface, tolerance) = (problem.surface(), problem.contact_tolerance());
    let deeper = |a: usize, b: usize| if starts[b].0 < starts[a].0 { b } else { a };
    let deepest = (0..starts.len()).filter(|&at| surface.leads(at)).reduce(deeper);
    let Some(at) = deepest.filter(|&at| starts[at].0 < -tolerance) else { return Ok(()) };
    let contact = &surface.nodes()[at];
    let (obstacle, depth, node) = (contact.obstacle, -starts[at].0, contact.node.index());
    let cause = match (problem.obstacles()[obstacle].as_plane(), surface.sliding_of(at)) {
        (Some(plane), _) => Cause::Penetrates { node, depth, clear: plane.point_behind(depth).to_vec() },
        (None, None) => Cause::Overlaps { node, depth },
        // That gap is a mean with weights of both signs: of convex surfaces it is less than all gaps.
        (None, Some(index)) => match least_gap(problem, &surface.sliding()[index]) {
            Some((gap, node)) if gap < -tolerance => Cause::Overlaps { node, depth: -gap },
            _ => Cause::TooNear { node, depth },
        },
    };
    Err(InputError { place: problem.place_of_obstacle(obstacle), cause })
}

/// The least distance (m) of two surfaces that slide, at places of nodes of one where the other one is, and that node.
fn least_gap<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    sliding: &SlidingSurfaces<D>,
) -> Option<(f64, usize)> {
    let coupling: Coupling = sliding.coupling(problem.surface(), &problem.initial_displacement);
    let (slave, master) = (sliding.slave(), sliding.master());
    // η on an edge, at a place between those of its nodes, and the node that is there.
    let on = |side: &Side, first: usize, [low, high]: [f64; 2], xi: f64| {
        let eta = [first, first + 1].map(|k| eta(problem, sliding, side, k));
        let part = (xi - low) / (high - low);
        let node = if xi == low { Some(first) } else { (xi == high).then_some(first + 1) };
        ((1.0 - part) * eta[0] + part * eta[1], node.map(|k| side.position(k)))
    };
    let mut least: Option<(f64, usize)> = None;
    for segment in coupling.segments() {
        let (own, other) = (slave.edges()[segment.slave], master.edges()[segment.master]);
        let places = coupling.places(slave.part_of_edge(segment.slave));
        for xi in segment.ends {
            let (up, of_slave) = on(slave, own, [slave.xi()[own], slave.xi()[own + 1]], xi);
            let (down, of_master) = on(master, other, [places[other], places[other + 1]], xi);
            let Some(at) = of_slave.or(of_master) else { continue };
            if least.is_none_or(|(gap, _)| up - down < gap) {
                least = Some((up - down, problem.surface().nodes()[at].node.index()));
            }
        }
    }
    least
}

/// Surfaces that slide and do not face each other yet are not behind each other.
fn check_apart<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Result<(), InputError> {
    for sliding in problem.surface().sliding() {
        if !sliding.coupling(problem.surface(), &problem.initial_displacement).segments().is_empty() {
            continue;
        }
        let (slave, master) = (sliding.slave(), sliding.master());
        let low = (0..slave.len()).map(|k| (eta(problem, sliding, slave, k), k)).min_by(|a, b| a.0.total_cmp(&b.0));
        let high = (0..master.len()).map(|k| eta(problem, sliding, master, k)).max_by(f64::total_cmp);
        if let (Some((low, k)), Some(high)) = (low, high)
            && low < high - problem.contact_tolerance()
        {
            let contact = &problem.surface().nodes()[slave.position(k)];
            let cause = Cause::Overlaps { node: contact.node.index(), depth: high - low };
            return Err(InputError { place: problem.place_of_obstacle(contact.obstacle), cause });
        }
    }
    Ok(())
}

/// η of a node of a side at the start (m).
fn eta<const D: usize, const N: usize>(
    problem: &Problem<D, N>,
    sliding: &SlidingSurfaces<D>,
    side: &Side,
    k: usize,
) -> f64 {
    let node = problem.surface().nodes()[side.position(k)].node.index();
    side.eta()[k] + sliding.frame().split(&problem.initial_displacement[node]).0
}
