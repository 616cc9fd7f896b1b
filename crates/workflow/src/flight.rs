//! The flight of a body after its last contact: whether its turning brings a point to a plane again.

use percute_core::border::{Vector, row};
use percute_core::contact::AnyObstacle;
use percute_core::problem::{AnyProblem, RigidMotion};
use serde::Serialize;
use std::array::from_fn;
use std::f64::consts::TAU;

/// Instants at which gaps are looked at, in one turn of the body.
const LOOKS: u32 = 720;
/// A spin that moves points by less than this part of the velocity is rounding.
const STILL: f64 = 1e-9;
/// Halvings of the time between two of them.
const HALVINGS: u32 = 40;

/// The first point of a body that would reach a plane.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NextTouch {
    /// Its node.
    pub node: usize,
    /// The plane.
    pub plane: usize,
    /// The instant (s).
    pub time: f64,
}

/// The first node of a plane body in free flight that reaches a plane within one turn, without loads: the motion is
/// that of the rigid body which fits displacements and velocities at an instant. None of several bodies.
pub(crate) fn next_touch(
    problem: &AnyProblem,
    rigid: &RigidMotion,
    now: f64,
    [displacement, velocity]: [&[f64]; 2],
) -> Option<NextTouch> {
    let (speeds, spins) = (rigid.means(velocity), rigid.rotations(velocity));
    let ([speed], [spin]) = (&speeds[..], &spins[..]) else { return None };
    let size = problem.mesh().size();
    if problem.dimension() != 2 || spin.abs() * size <= STILL * speed.iter().fold(0.0_f64, |most, v| most.max(v.abs()))
    {
        return None;
    }
    let places: Vec<f64> = problem.mesh().points().iter().zip(displacement).map(|(x, u)| x + u).collect();
    let centre = *rigid.means(&places).first()?;
    let nodes = problem.contact_nodes();
    let planes: Vec<AnyObstacle> = problem.obstacles().collect();
    let gap = |at: usize, time: f64| {
        let place = row(&places, nodes[at].node.index(), 2);
        let arm: Vector = from_fn(|c| place[c] - centre[c]);
        let (sine, cosine) = (spin * time).sin_cos();
        let across = [-arm[1], arm[0], 0.0];
        let place = from_fn(|c| centre[c] + speed[c] * time + cosine * arm[c] + sine * across[c]);
        planes[nodes[at].obstacle].gap(&place).unwrap_or(f64::INFINITY)
    };
    let look = |k: u32| TAU / spin.abs() * f64::from(k) / f64::from(LOOKS);
    // Nodes that are at the plane now leave it first.
    let mut away: Vec<bool> = (0..nodes.len()).map(|at| gap(at, 0.0) > 0.0).collect();
    for k in 1..=LOOKS {
        let reached = (0..nodes.len()).filter(|&at| {
            let open = gap(at, look(k)) > 0.0;
            let was_away = away[at];
            away[at] |= open;
            was_away && !open
        });
        let exact = |at: usize| {
            let (mut before, mut after) = (look(k - 1), look(k));
            for _ in 0..HALVINGS {
                let middle = 0.5 * (before + after);
                *(if gap(at, middle) > 0.0 { &mut before } else { &mut after }) = middle;
            }
            (after, at)
        };
        let reached: Vec<usize> = reached.collect();
        if let Some((time, at)) = reached.into_iter().map(exact).min_by(|a, b| a.0.total_cmp(&b.0)) {
            let contact = &nodes[at];
            return Some(NextTouch { node: contact.node.index(), plane: contact.obstacle, time: now + time });
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::contact::Obstacle;
    use percute_core::material::Elastic;
    use percute_core::mesh::Mesh;
    use percute_core::problem::{AnyProblem, Problem};

    /// A square of 1 m, 0.3 m above a plane, turns about its middle: its corner is at ½ − √½·sin(π/4 + ωt).
    #[test]
    fn a_corner_reaches_the_plane_by_turning() {
        let build = |gap: f64| {
            Problem::<2>::builder(Mesh::rectangle(1.0, 1.0, 2, 2).unwrap())
                .material(Elastic::plane_strain(1.0, 0.2, 2.0, 1.0).unwrap())
                .obstacle(Obstacle::plane([0.0, -gap], [0.0, 1.0], 0.0, None).unwrap())
                .build()
                .map(AnyProblem::from)
                .unwrap()
        };
        let at = |gap: f64, rise: f64, spin: f64| {
            let problem = build(gap);
            let rigid = RigidMotion::new(&problem);
            let means = rigid.means(problem.mesh().points());
            let turning = |p: Vector| [-spin * (p[1] - means[0][1]), rise + spin * (p[0] - means[0][0])];
            let velocity: Vec<_> = problem.mesh().places().flat_map(turning).collect();
            let still = vec![0.0; velocity.len()];
            next_touch(&problem, &rigid, 5.0, [&still, &velocity])
        };
        // The mean of the nodal masses is not the middle: by symmetry of the diagonals it is on the diagonal, at ½.
        for spin in [2.0, -2.0] {
            let found = at(0.1, 0.0, spin).unwrap();
            let expected = 5.0 + ((0.6 * 2.0_f64.sqrt()).asin() - std::f64::consts::FRAC_PI_4) / 2.0;
            assert!((found.time - expected).abs() < 1e-9, "{found:?} for {expected}");
            assert_eq!((found.node, found.plane), (if spin > 0.0 { 0 } else { 2 }, 0));
        }
        // The half diagonal is 0.707 m.
        assert_eq!([at(0.3, 0.0, 2.0), at(0.1, 5.0, 2.0), at(0.1, -1.0, 0.0)], [None; 3]);
    }
}
