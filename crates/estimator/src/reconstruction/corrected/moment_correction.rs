//! Moments of densities.
//!
//! A density that is linear along faces and R_k/ℓ_k at the nodes has the resultant of the reactions R_k. It acts at
//! the centroids of the shape functions, which are not at the nodes at the end of a contact surface or between unequal
//! faces. The missing moment would give the body an angular acceleration. The normal forces of the nodes of a body
//! that face one plane are therefore multiplied by factors that keep their sum and restore the moment. The factors are
//! those nearest to 1, in the mean weighted by the forces, affine along the plane, and 0 where they would be negative.
//! Friction is multiplied by the factor of its normal force. The rest of its sum is shared out where the cone has room;
//! there is always enough.
//!
//! On a line of symmetry, which supports hold along the plane, the half of a shape function has its centroid beside the
//! node. In the whole body no moment is missing, and the line takes that of its half: nothing is corrected.

mod solid;

use crate::direction::{along, tangent};
use percute_core::cell::CellKind;
use percute_core::contact::Coulomb;
use percute_core::ids::NodeId;
use percute_core::problem::Problem;
use solid::SolidGroup;

/// Such a part of a force is nothing: its place within an edge is known to 1e-16 only, which counts squared.
const NOTHING: f64 = 1e-24;

/// The nodes of a body that face one plane, with their common data.
#[derive(Clone, Debug)]
pub(super) struct Group<const D: usize> {
    normal: [f64; D],
    tangent: [f64; D],
    law: Coulomb,
    nodes: Vec<CorrectedNode>,
}

/// A node of the contact surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct CorrectedNode {
    /// Position in the contact surface.
    pub(super) at: usize,
    /// Its number in the mesh.
    pub(super) node: usize,
    /// Centroid of its shape function along the plane (m).
    pub(super) centroid: f64,
    /// From there to the place of its reaction, along the plane and away from it (m).
    pub(super) lever: [f64; 2],
}

/// Gives reactions as forces whose densities have their moment.
#[derive(Clone, Debug)]
pub(super) struct MomentCorrection<const D: usize> {
    groups: Vec<Group<D>>,
    /// Those of solids, whose planes have two directions.
    solids: Vec<SolidGroup<D>>,
}

impl<const D: usize> MomentCorrection<D> {
    pub(super) fn new(problem: &Problem<D>) -> Self {
        match problem.mesh().kind() {
            CellKind::Bar => return Self { groups: Vec::new(), solids: Vec::new() },
            CellKind::Triangle => {}
            CellKind::Tetrahedron => return Self { groups: Vec::new(), solids: solid::groups(problem) },
        }
        let (part, surface) = (problem.mesh().part_of_nodes(), problem.surface());
        let centroids = centroids(problem);
        let mut groups: Vec<((NodeId, usize), Group<D>)> = Vec::new();
        let flat = |at: usize| surface.leads(at) && surface.non_matching_of(at).is_none();
        let leading = surface.nodes().iter().zip(&centroids).enumerate().filter(|(at, _)| flat(*at));
        for (at, (contact, centroid)) in leading {
            let key = (part[contact.node.index()], contact.obstacle);
            let found = groups.iter().position(|(other, _)| *other == key).unwrap_or_else(|| {
                let obstacle = &problem.obstacles()[contact.obstacle];
                let frame = obstacle.flat_frame();
                let (normal, tangent) = (*frame.normal(), tangent(&frame));
                groups.push((key, Group { normal, tangent, law: obstacle.law(), nodes: Vec::new() }));
                groups.len() - 1
            });
            let group = &mut groups[found].1;
            let point = problem.mesh().points_in::<D>()[contact.node.index()];
            let arm: [f64; D] = std::array::from_fn(|c| point[c] - centroid[c]);
            group.nodes.push(CorrectedNode {
                at,
                node: contact.node.index(),
                centroid: along(centroid, &group.tangent),
                lever: [along(&arm, &group.tangent), along(&arm, &group.normal)],
            });
        }
        let on_line = problem.on_lines_of_symmetry();
        let is_free = |group: &Group<D>| group.nodes.iter().all(|node| !on_line[node.at]);
        Self { groups: groups.into_iter().map(|(_, group)| group).filter(is_free).collect(), solids: Vec::new() }
    }

    /// Forces of the same resultants as these reactions, which are in the cone, and in it as well; their densities have
    /// the moment of the reactions, or come as near as compressive forces can.
    /// Of a body that turns with its displacements (m) of all nodes.
    pub(super) fn apply(
        &self,
        reaction: &mut [[f64; D]],
        displacement: &[[f64; D]],
        centroid: &dyn Fn(usize) -> Option<[f64; D]>,
    ) {
        self.groups.iter().for_each(|group| group.apply(reaction, displacement, centroid));
        self.solids.iter().for_each(|group| group.apply(reaction));
    }
}

impl<const D: usize> Group<D> {
    pub(super) fn new(normal: [f64; D], tangent: [f64; D], law: Coulomb, nodes: Vec<CorrectedNode>) -> Self {
        Self { normal, tangent, law, nodes }
    }

    /// The same for one group.
    pub(super) fn apply(
        &self,
        reaction: &mut [[f64; D]],
        displacement: &[[f64; D]],
        centroid: &dyn Fn(usize) -> Option<[f64; D]>,
    ) {
        let moved = |node: &CorrectedNode| {
            let mut moved = self.moved(node, centroid(node.at));
            moved.centroid += displacement.get(node.node).map_or(0.0, |u| along(u, &self.tangent));
            moved
        };
        let nodes: Vec<CorrectedNode> = self.nodes.iter().map(moved).collect();
        let normal: Vec<f64> = self.nodes.iter().map(|node| along(&reaction[node.at], &self.normal)).collect();
        if normal.iter().filter(|n| **n > 0.0).count() < 2 {
            return;
        }
        let tangential: Vec<f64> = self.nodes.iter().map(|node| along(&reaction[node.at], &self.tangent)).collect();
        let forces = nodes.iter().zip(normal.iter().zip(&tangential));
        let missing: f64 = forces.map(|(node, (n, t))| node.lever[0] * n - node.lever[1] * t).sum();
        let factors = factors(&nodes, &normal, missing);
        let normal: Vec<f64> = normal.iter().zip(&factors).map(|(n, factor)| n * factor).collect();
        let tangential = self.share_out(&normal, &tangential, &factors);
        for ((node, n), t) in self.nodes.iter().zip(normal).zip(tangential) {
            reaction[node.at] = std::array::from_fn(|c| n * self.normal[c] + t * self.tangent[c]);
        }
    }

    /// A node whose traction has another centroid than its tributary density, from the node (m).
    fn moved(&self, node: &CorrectedNode, centroid: Option<[f64; D]>) -> CorrectedNode {
        let Some(arm) = centroid else { return *node };
        let arm = [along(&arm, &self.tangent), along(&arm, &self.normal)];
        CorrectedNode { centroid: node.centroid + node.lever[0] + arm[0], lever: arm.map(|x| -x), ..*node }
    }

    /// Friction in proportion to its normal force; the rest of its sum is put where there is room up to μN.
    fn share_out(&self, normal: &[f64], tangential: &[f64], factors: &[f64]) -> Vec<f64> {
        let mut shared: Vec<f64> = tangential.iter().zip(factors).map(|(t, factor)| t * factor).collect();
        let lacking = tangential.iter().sum::<f64>() - shared.iter().sum::<f64>();
        let room = |(n, t): (&f64, &f64)| (self.law.limit(*n) - lacking.signum() * t).max(0.0);
        let rooms: Vec<f64> = normal.iter().zip(&shared).map(room).collect();
        let room: f64 = rooms.iter().sum();
        if room > 0.0 {
            let part = (lacking / room).clamp(-1.0, 1.0);
            shared.iter_mut().zip(&rooms).for_each(|(t, room)| *t += part * room);
        }
        shared
    }
}

/// α + β s, nowhere negative, with Σ factor N = ΣN and Σ factor N s = Σ N s + `missing` over those that are not 0.
fn factors(nodes: &[CorrectedNode], normal: &[f64], missing: f64) -> Vec<f64> {
    let total: f64 = normal.iter().sum();
    let first: f64 = nodes.iter().zip(normal).map(|(node, n)| node.centroid * n).sum();
    // About the middle of the force, which has to move by this way.
    let (middle, way) = (first / total, missing / total);
    let place = |k: usize| nodes[k].centroid - middle;
    let mut pressed: Vec<usize> = (0..normal.len()).filter(|&k| normal[k] > 0.0).collect();
    loop {
        let sum = |power: i32| pressed.iter().map(|&k| normal[k] * place(k).powi(power)).sum::<f64>() / total;
        let (weight, mean) = (sum(0), sum(1) / sum(0));
        let spread = pressed.iter().map(|&k| normal[k] * (place(k) - mean).powi(2)).sum::<f64>() / total;
        let extent = pressed.iter().map(|&k| (place(k) - mean).powi(2)).fold(0.0, f64::max);
        // One node alone, but for rounding beside it, has no lever.
        let slope = if pressed.len() > 1 && spread > NOTHING * extent { (way - mean) / spread } else { 0.0 };
        let factor = |k: usize| 1.0 / weight + slope * (place(k) - mean);
        let kept: Vec<usize> = pressed.iter().copied().filter(|&k| factor(k) > 0.0).collect();
        if kept.len() == pressed.len() || kept.is_empty() {
            let mut factors = vec![0.0; normal.len()];
            pressed.iter().for_each(|&k| factors[k] = factor(k));
            return factors;
        }
        pressed = kept;
    }
}

/// Centroid of each node's shape function on the candidate faces (m).
fn centroids<const D: usize>(problem: &Problem<D>) -> Vec<[f64; D]> {
    let (points, surface) = (problem.mesh().points_in::<D>(), problem.surface());
    let place = |k: usize| points[surface.nodes()[k].node.index()];
    let mut centroids = vec![[0.0; D]; surface.nodes().len()];
    for face in surface.faces() {
        let sum: [f64; D] = std::array::from_fn(|c| face.nodes.iter().map(|&k| place(k)[c]).sum());
        for &k in &face.nodes {
            (0..D).for_each(|c| centroids[k][c] += face.area / (D * (D + 1)) as f64 * (place(k)[c] + sum[c]));
        }
    }
    for (centroid, area) in centroids.iter_mut().zip(surface.tributary_areas()) {
        centroid.iter_mut().for_each(|x| *x /= area);
    }
    centroids
}

#[cfg(test)]
mod tests;
