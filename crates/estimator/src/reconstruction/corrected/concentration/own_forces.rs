//! The contact forces of the auxiliary solution where a node alone touches.
//!
//! The force of the simulation is too large there, because the mesh lacks the compliance of the body close to the node.

use super::Concentration;
use crate::reconstruction::corrected::auxiliary_solution::Approach;
use percute_core::problem::Problem;

/// A hat with less than this share does not make a node wide.
const SHARE: f64 = 1e-6;

/// A force below this part of the largest one has no direction.
const ROUNDING: f64 = 1e-12;

/// Bisections of the force: to 1e-12 of the largest.
const BISECTIONS: usize = 40;

/// The own forces of the nodes of the contact surface.
#[derive(Clone, Debug)]
pub(in crate::reconstruction::corrected) struct OwnForces<const D: usize> {
    nodes: Vec<OwnForce<D>>,
    /// Largest normal force of the simulation so far (N).
    peak: f64,
}

/// That of one node at the step before.
#[derive(Clone, Copy, Debug)]
struct OwnForce<const D: usize> {
    /// Its normal part (N).
    normal: f64,
    /// The last force of the simulation over its normal part.
    direction: [f64; D],
}

impl<const D: usize> OwnForces<D> {
    pub(in crate::reconstruction::corrected) fn new<const N: usize>(problem: &Problem<D, N>) -> Self {
        let nodes = vec![OwnForce { normal: 0.0, direction: [0.0; D] }; problem.surface().nodes().len()];
        Self { nodes, peak: 0.0 }
    }

    /// Replaces the smoothed forces of the simulation (N), the first of the two fields, at nodes that touch alone. The second
    /// has the reactions of which the normal work is measured: none at these nodes, because the auxiliary solution does not stop
    /// with them, and the loss is in the misfit of the motion. `gap` are the gaps of the simulation (m).
    ///
    /// An own force acts on after the simulation has released the node, but it never grows without it.
    pub(in crate::reconstruction::corrected) fn apply<const N: usize>(
        &mut self,
        problem: &Problem<D, N>,
        concentration: &Concentration<D>,
        gap: &[f64],
        approach: impl Fn(usize) -> Approach,
        [contact, arresting]: [&mut [[f64; D]]; 2],
    ) {
        for (at, (own, force)) in self.nodes.iter_mut().zip(contact).enumerate() {
            let obstacle = &problem.obstacles()[problem.surface().nodes()[at].obstacle];
            // Reactions of a foreign history need not be in the cone.
            let held = obstacle.project_into_cone(force);
            let normal = obstacle.flat_frame().split(&held).0;
            self.peak = self.peak.max(normal);
            if normal > ROUNDING * self.peak {
                own.direction = held.map(|f| f / normal);
            }
            let most = normal.max(own.normal);
            own.normal = normal;
            if most > 0.0
                && let Some(found) = concentration.own_force(problem, at, (most, &own.direction), gap, || approach(at))
            {
                own.normal = found;
                *force = own.direction.map(|d| found * d);
                arresting[at] = [0.0; D];
            }
        }
    }
}

impl<const D: usize> Concentration<D> {
    /// The normal force (N), at most `most` in this direction, under which a node comes to its plane with the local
    /// compliance of its traction. `None` where the mesh has this compliance: where a hat is as wide as its edge.
    fn own_force<const N: usize>(
        &self,
        problem: &Problem<D, N>,
        at: usize,
        (most, direction): (f64, &[f64; D]),
        gap: &[f64],
        approach: impl Fn() -> Approach,
    ) -> Option<f64> {
        let gaps = self.gaps(at, gap)?;
        let costs = self.costs(problem, at, direction, &gaps);
        if costs.shape(most).iter().any(|hat| hat.share > SHARE && hat.halvings == 0) {
            return None;
        }
        let approach = approach();
        let remaining =
            |normal: f64| approach.gap + normal * approach.mobility + costs.approach(&costs.shape(normal), normal);
        if approach.gap >= 0.0 {
            return Some(0.0);
        }
        if remaining(most) <= 0.0 {
            return Some(most);
        }
        let (mut low, mut high) = (0.0, most);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if remaining(middle) < 0.0 { low = middle } else { high = middle }
        }
        Some(0.5 * (low + high))
    }
}
