//! The densities of the paper, eq. \[45\]–\[50\].

use super::{ReconstructionMethod, StepDensities, SurfaceSteps};
use crate::contact_density::Densities;
use crate::time_level::SurfaceStep;
use percute_core::contact::ContactFace;
use percute_core::problem::Problem;

/// Edges that meet at more than 45° are no neighbours: their normals' cosine is below this.
const NEIGHBOUR: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// The reconstruction of the paper: reaction over tributary length, from one step after impact to one step before
/// release.
#[derive(Debug)]
pub(super) struct Published<'p, const D: usize> {
    problem: &'p Problem<D>,
    /// Lengths and neighbours for each node of each candidate face.
    ends: Vec<Vec<End>>,
}

/// One node of one candidate face.
#[derive(Clone, Debug)]
struct End {
    /// Position of the node in the contact surface.
    node: usize,
    /// Tributary area (m²) of the candidate faces that go on smoothly here.
    tributary: f64,
    /// The other nodes of those faces.
    neighbours: Vec<usize>,
}

impl<'p, const D: usize> Published<'p, D> {
    pub(super) fn new(problem: &'p Problem<D>) -> Self {
        let faces = problem.surface().faces();
        let normals: Vec<_> = faces.iter().map(|f| problem.mesh().normal_in::<D>(f.face).0).collect();
        let mut around = vec![Vec::new(); problem.surface().nodes().len()];
        for (f, face) in faces.iter().enumerate() {
            face.nodes.iter().for_each(|&node| around[node].push(f));
        }
        let smooth =
            |a: usize, b: usize| normals[a].iter().zip(&normals[b]).map(|(x, y)| x * y).sum::<f64>() >= NEIGHBOUR;
        let end = |f: usize, node: usize| {
            let piece: Vec<usize> = around[node].iter().copied().filter(|&g| smooth(f, g)).collect();
            let others = |g: &usize| faces[*g].nodes.into_iter().filter(move |&n| n != node);
            End {
                node,
                tributary: piece.iter().map(|&g| faces[g].area / D as f64).sum(),
                neighbours: piece.iter().flat_map(others).collect(),
            }
        };
        let ends = |(f, face): (usize, &ContactFace<D>)| face.nodes.iter().map(|&node| end(f, node)).collect();
        Self { problem, ends: faces.iter().enumerate().map(ends).collect() }
    }

    /// Densities at one instant, given the touching status one step before and after (`None` after
    /// the last step, where an open phase goes on).
    fn at(&self, before: &[bool], now: &SurfaceStep<D>, after: Option<&[bool]>) -> Densities<D> {
        // i+1 ≤ n ≤ j−1: the node touches at the instants before, at and after t_n.
        let keeps = |k: usize| before[k] && now.touching[k] && after.is_none_or(|after| after[k]);
        let value = |face: &ContactFace<D>, end: &End| {
            if !keeps(end.node) || !end.neighbours.iter().all(|&k| keeps(k)) {
                return [0.0; D];
            }
            let force = now.force[end.node].map(|r| r / end.tributary);
            self.problem.obstacles()[face.obstacle].project_into_cone(&force)
        };
        Densities::new(self.problem, |f, face| std::array::from_fn(|p| value(face, &self.ends[f][p])))
    }
}

impl<const D: usize, const N: usize> ReconstructionMethod<D, N> for Published<'_, D> {
    fn densities(&self, steps: &SurfaceSteps<'_, D>) -> StepDensities<D> {
        let SurfaceSteps { before, now, next, after } = *steps;
        let at_start = |before: &SurfaceStep<D>| self.at(&before.touching, now, Some(&next.touching));
        StepDensities {
            start: before.map_or_else(|| Densities::none(self.problem), at_start),
            end: self.at(&now.touching, next, after.map(|after| after.touching.as_slice())),
        }
    }
}
