//! Moments of densities.
//!
//! A density that is linear along facets and R_k/ℓ_k at the nodes has the resultant of the reactions R_k, but acts
//! at the centroids of the shape functions, and at the end of a contact surface or between unequal facets those are
//! not at the nodes. What is missing would turn the body, ever faster as long as it acts. Nodal factors 1 + δ_k
//! leave each direction, and with it the cone, as it is; the least δ, in the mean that the reactions weigh, that keeps the
//! resultant and brings the moment is affine in space where all reactions have one direction.

use percute_core::ids::NodeId;
use percute_core::problem::Problem;

/// Directions that add less than this part to those before are rounding.
const INDEPENDENT: f64 = 1e-9;

/// Places of the nodes of the contact surface.
#[derive(Clone, Debug)]
pub(super) struct Tilt<const D: usize> {
    /// Centroid of each node's shape function on the candidate facets (m).
    centroid: Vec<[f64; D]>,
    /// From the centroid to the node (m).
    lever: Vec<[f64; D]>,
    /// The nodes of each part of the mesh that may touch.
    bodies: Vec<Vec<usize>>,
}

impl<const D: usize> Tilt<D> {
    pub(super) fn new<const N: usize>(problem: &Problem<D, N>) -> Self {
        let (points, surface) = (problem.mesh().points(), problem.surface());
        let place = |k: usize| points[surface.nodes()[k].node.index()];
        let mut centroid = vec![[0.0; D]; surface.nodes().len()];
        for facet in surface.facets() {
            let sum: [f64; D] = std::array::from_fn(|c| facet.nodes.iter().map(|&k| place(k)[c]).sum());
            for &k in &facet.nodes {
                (0..D).for_each(|c| centroid[k][c] += facet.area / (D * (D + 1)) as f64 * (place(k)[c] + sum[c]));
            }
        }
        for (centroid, area) in centroid.iter_mut().zip(surface.tributary_areas()) {
            centroid.iter_mut().for_each(|x| *x /= area);
        }
        let lever = centroid.iter().enumerate().map(|(k, x)| std::array::from_fn(|c| place(k)[c] - x[c])).collect();
        Self { centroid, lever, bodies: bodies(problem) }
    }

    /// One that leaves all densities as they are.
    pub(super) fn none() -> Self {
        Self { centroid: Vec::new(), lever: Vec::new(), bodies: Vec::new() }
    }

    /// 1 + δ_k for these reactions; at most 2 and not negative: where that is too little, part of the moment is missing.
    pub(super) fn factors(&self, reaction: &[[f64; D]]) -> Vec<f64> {
        let mut factors = vec![1.0; reaction.len()];
        if D == 2 {
            self.bodies.iter().for_each(|body| self.tilt(body, reaction, &mut factors));
        }
        factors
    }

    fn tilt(&self, body: &[usize], reaction: &[[f64; D]], factors: &mut [f64]) {
        let size = |k: usize| reaction[k].iter().map(|r| r * r).sum::<f64>().sqrt();
        let pressed: Vec<(usize, f64)> = body.iter().map(|&k| (k, size(k))).filter(|(_, w)| *w > 0.0).collect();
        let whole: f64 = pressed.iter().map(|(_, w)| w).sum();
        let missing: f64 = pressed.iter().map(|&(k, _)| cross(&self.lever[k], &reaction[k])).sum();
        if pressed.len() < 2 || missing == 0.0 {
            return;
        }
        let mean = |c: usize| pressed.iter().map(|&(k, w)| w * self.centroid[k][c]).sum::<f64>() / whole;
        let middle: [f64; D] = std::array::from_fn(mean);
        let direction = |&(k, w): &(usize, f64)| reaction[k].map(|r| r / w);
        let arm = |&(k, _): &(usize, f64)| std::array::from_fn(|c| self.centroid[k][c] - middle[c]);
        let inner =
            |a: &[f64], b: &[f64]| pressed.iter().zip(a.iter().zip(b)).map(|((_, w), (a, b))| w * a * b).sum::<f64>();
        // What a δ adds to the resultant and to the moment, the moment's part that leaves the resultant alone last.
        let mut rows: Vec<Vec<f64>> = (0..D).map(|c| pressed.iter().map(|one| direction(one)[c]).collect()).collect();
        rows.push(pressed.iter().map(|one| cross(&arm(one), &direction(one))).collect());
        let mut basis: Vec<(Vec<f64>, f64)> = Vec::new();
        for mut row in rows {
            let before = inner(&row, &row);
            for (other, norm) in &basis {
                let along = inner(&row, other) / norm;
                row.iter_mut().zip(other).for_each(|(a, b)| *a -= along * b);
            }
            let norm = inner(&row, &row);
            basis.push((row, if norm > INDEPENDENT * before { norm } else { f64::INFINITY }));
        }
        let Some((row, norm)) = basis.pop() else { return };
        let largest = row.iter().fold(0.0_f64, |m, x| m.max((missing / norm * x).abs()));
        let step = missing / norm / largest.max(1.0);
        // Rounding must not turn a force that is to vanish.
        pressed.iter().zip(&row).for_each(|(&(k, _), x)| factors[k] = (1.0 + step * x).max(0.0));
    }
}

/// The nodes of the contact surface, by the part of the mesh to which they belong.
fn bodies<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Vec<Vec<usize>> {
    let part = problem.mesh().part_of_nodes();
    let mut bodies: Vec<(NodeId, Vec<usize>)> = Vec::new();
    for (k, contact) in problem.surface().nodes().iter().enumerate() {
        let own = part[contact.node.index()];
        match bodies.iter_mut().find(|(other, _)| *other == own) {
            Some((_, nodes)) => nodes.push(k),
            None => bodies.push((own, vec![k])),
        }
    }
    bodies.into_iter().map(|(_, nodes)| nodes).collect()
}

/// The moment of a force with a lever in the plane.
fn cross<const D: usize>(lever: &[f64; D], force: &[f64; D]) -> f64 {
    lever[0] * force[D - 1] - lever[D - 1] * force[0]
}

#[cfg(test)]
mod tests;
