//! The forces on two nodes of different bodies that touch are opposite.

use percute_core::border::Vector;
use percute_core::problem::AnyProblem;

/// Forces of a pair that differ by more than this share of the largest force at the instant are not opposite: single
/// precision has 1e-7.
const OPPOSITE: f64 = 1e-2;

/// Makes the forces on the nodes of each pair opposite: half of their difference. Forces that are opposite keep their
/// bits.
pub(super) fn make_opposite(problem: &AnyProblem, reaction: &mut [Vector]) {
    for (at, contact) in problem.contact_nodes().iter().enumerate() {
        let Some(partner) = contact.partner.filter(|partner| at < *partner) else { continue };
        let (own, other) = (reaction[at], reaction[partner]);
        if (0..3).all(|c| own[c] == -other[c]) {
            continue;
        }
        let force: Vector = std::array::from_fn(|c| 0.5 * (own[c] - other[c]));
        reaction[at] = force;
        reaction[partner] = force.map(|x| -x);
    }
}

/// The nodes of the first pair whose forces are far from opposite, if there is one.
pub(super) fn not_opposite(problem: &AnyProblem, reaction: &[Vector]) -> Option<[usize; 2]> {
    let most = reaction.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    let nodes = problem.contact_nodes();
    nodes.iter().enumerate().find_map(|(at, contact)| {
        let partner = contact.partner.filter(|partner| at < *partner)?;
        let (own, other) = (&reaction[at], &reaction[partner]);
        let differ = (0..3).any(|c| (own[c] + other[c]).abs() > OPPOSITE * most);
        differ.then(|| [at, partner].map(|row| nodes[row].node.index()))
    })
}
