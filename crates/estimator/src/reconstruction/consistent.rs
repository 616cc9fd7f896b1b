//! Densities on the faces that touch throughout a step, statically equivalent to the reactions.

use super::{ReconstructionMethod, StepDensities, SurfaceSteps};
use crate::contact_density::Densities;
use percute_core::cell::CellKind;
use percute_core::problem::Problem;

/// The reconstruction whose densities of a step balance R = B F at both its ends, B the consistent mass matrix of the
/// faces whose nodes touch at both ends. They are projected into the cone. Where these faces change, the densities
/// jump.
#[derive(Debug)]
pub(super) struct Consistent<'p, const D: usize> {
    problem: &'p Problem<D>,
}

impl<'p, const D: usize> Consistent<'p, D> {
    pub(super) fn new(problem: &'p Problem<D>) -> Self {
        Self { problem }
    }
}

impl<const D: usize, const N: usize> ReconstructionMethod<D, N> for Consistent<'_, D> {
    fn densities(&self, steps: &SurfaceSteps<'_, D>) -> StepDensities<D> {
        let (problem, now, next) = (self.problem, steps.now, steps.next);
        let touches = |k: usize| now.touching[k] && next.touching[k];
        let live: Vec<bool> = problem.surface().faces().iter().map(|f| f.nodes.iter().all(|&k| touches(k))).collect();
        if !live.contains(&true) {
            return StepDensities { start: Densities::none(problem), end: Densities::none(problem) };
        }
        let mass = BoundaryMass::new(problem, &live);
        let densities = |force: &[[f64; D]]| mass.densities(problem, &live, force);
        StepDensities { start: densities(&now.force), end: densities(&next.force) }
    }
}

/// ∫φ_iφ_j over the live faces: tridiagonal, for faces join nodes that follow each other.
struct BoundaryMass {
    diagonal: Vec<f64>,
    /// Coupling of node k with node k + 1.
    upper: Vec<f64>,
}

impl BoundaryMass {
    fn new<const D: usize>(problem: &Problem<D>, live: &[bool]) -> Self {
        let count = problem.surface().nodes().len();
        let mut mass = Self { diagonal: vec![0.0; count], upper: vec![0.0; count] };
        for (face, _) in problem.surface().faces().iter().zip(live).filter(|(_, live)| **live) {
            let share = face.area / (D * (D + 1)) as f64;
            for &k in &face.nodes {
                mass.diagonal[k] += 2.0 * share;
            }
            match problem.mesh().kind() {
                CellKind::Bar => {}
                CellKind::Tetrahedron => unreachable!("estimates of solids are refused"),
                CellKind::Triangle => mass.upper[face.nodes[0].min(face.nodes[1])] += share,
            }
        }
        mass
    }

    /// B⁻¹R by elimination along the boundary; nodes without live faces get zero.
    fn solve<const D: usize>(&self, reaction: &[[f64; D]]) -> Vec<[f64; D]> {
        let count = self.diagonal.len();
        let mut pivot = self.diagonal.clone();
        let mut value = reaction.to_vec();
        for k in 1..count {
            if self.upper[k - 1] > 0.0 {
                let factor = self.upper[k - 1] / pivot[k - 1];
                pivot[k] -= factor * self.upper[k - 1];
                let before = value[k - 1];
                (0..D).for_each(|c| value[k][c] -= factor * before[c]);
            }
        }
        for k in (0..count).rev() {
            if pivot[k] == 0.0 {
                value[k] = [0.0; D];
                continue;
            }
            let after = if self.upper[k] > 0.0 { value[k + 1] } else { [0.0; D] };
            (0..D).for_each(|c| value[k][c] = (value[k][c] - self.upper[k] * after[c]) / pivot[k]);
        }
        value
    }

    fn densities<const D: usize>(&self, problem: &Problem<D>, live: &[bool], reaction: &[[f64; D]]) -> Densities<D> {
        let nodal = self.solve(reaction);
        Densities::new(problem, |f, face| match live[f] {
            true => face.nodes.map(|k| problem.obstacles()[face.obstacle].project_into_cone(&nodal[k])),
            false => [[0.0; D]; D],
        })
    }
}
