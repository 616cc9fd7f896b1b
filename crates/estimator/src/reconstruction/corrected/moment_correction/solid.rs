//! Moments of the densities of solids, about the directions along their planes.
//!
//! As in the plane, the normal forces of the nodes of a body that face one plane are multiplied by factors nearest to
//! 1, here α + β·s with s along the plane. Across a plane of symmetry nothing is corrected. The moment of friction
//! about the normal is left as it is.

use super::{NOTHING, centroids};
use crate::direction::along;
use nalgebra::{DMatrix, DVector};
use percute_core::contact::Coulomb;
use percute_core::ids::NodeId;
use percute_core::problem::Problem;

/// The nodes of a body that face one plane.
#[derive(Clone, Debug)]
pub(super) struct SolidGroup<const D: usize> {
    normal: [f64; D],
    /// Directions along the plane in which forces may have a lever, of unit length.
    axes: Vec<[f64; D]>,
    law: Coulomb,
    nodes: Vec<SolidNode<D>>,
}

/// A node of the contact surface.
#[derive(Clone, Copy, Debug)]
struct SolidNode<const D: usize> {
    /// Position in the contact surface.
    at: usize,
    /// Centroid of its shape function (m).
    centroid: [f64; D],
    /// From there to the place of its reaction (m).
    lever: [f64; D],
}

/// The nodes of all bodies by the planes that they face.
pub(super) fn groups<const D: usize>(problem: &Problem<D>) -> Vec<SolidGroup<D>> {
    let (part, surface) = (problem.mesh().part_of_nodes(), problem.surface());
    let (centroids, mirrors) = (centroids(problem), problem.mirrors_at_contact());
    let mut groups: Vec<((NodeId, usize), SolidGroup<D>)> = Vec::new();
    let mut held: Vec<[bool; D]> = Vec::new();
    for (at, contact) in surface.nodes().iter().enumerate() {
        let key = (part[contact.node.index()], contact.obstacle);
        let found = groups.iter().position(|(other, _)| *other == key).unwrap_or_else(|| {
            let obstacle = &problem.obstacles()[contact.obstacle];
            let (normal, law) = (*obstacle.flat_frame().normal(), obstacle.law());
            groups.push((key, SolidGroup { normal, axes: Vec::new(), law, nodes: Vec::new() }));
            held.push([false; D]);
            groups.len() - 1
        });
        (0..D).for_each(|c| held[found][c] |= mirrors[at][c]);
        let (point, centroid) = (problem.mesh().points_in::<D>()[contact.node.index()], centroids[at]);
        let lever = std::array::from_fn(|c| point[c] - centroid[c]);
        groups[found].1.nodes.push(SolidNode { at, centroid, lever });
    }
    let with_axes = |((_, group), held): ((_, SolidGroup<D>), [bool; D])| {
        let axes = axes(&group.normal, &held);
        SolidGroup { axes, ..group }
    };
    groups.into_iter().zip(held).map(with_axes).collect()
}

/// Directions across a normal and across the axes that symmetry holds, orthogonal to each other.
fn axes<const D: usize>(normal: &[f64; D], held: &[bool; D]) -> Vec<[f64; D]> {
    let unit = |axis: usize| -> [f64; D] { std::array::from_fn(|c| f64::from(u8::from(c == axis))) };
    let mut basis = vec![*normal];
    basis.extend((0..D).filter(|&c| held[c]).map(unit));
    let (fixed, mut order) = (basis.len(), (0..D).collect::<Vec<_>>());
    // The axis that is most across the normal comes first.
    order.sort_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs()));
    for axis in order.into_iter().filter(|&c| !held[c]) {
        let rest = basis.iter().fold(unit(axis), |rest, other| {
            let part = along(&rest, other);
            std::array::from_fn(|c| rest[c] - part * other[c])
        });
        let length = along(&rest, &rest).sqrt();
        if length > 1e-6 && basis.len() < D {
            basis.push(rest.map(|x| x / length));
        }
    }
    basis.split_off(fixed)
}

impl<const D: usize> SolidGroup<D> {
    /// Gives reactions in the cone the moment of their places, as far as compressive forces can have it. They stay in
    /// the cone, and their sum stays.
    pub(super) fn apply(&self, reaction: &mut [[f64; D]]) {
        let normal: Vec<f64> = self.nodes.iter().map(|node| along(&reaction[node.at], &self.normal)).collect();
        if self.axes.is_empty() || normal.iter().filter(|n| **n > 0.0).count() < 2 {
            return;
        }
        let tangential: Vec<[f64; D]> = self
            .nodes
            .iter()
            .zip(&normal)
            .map(|(node, n)| std::array::from_fn(|c| reaction[node.at][c] - n * self.normal[c]))
            .collect();
        let missing = |axis: &[f64; D]| -> f64 {
            let one = |((node, n), t): ((&SolidNode<D>, &f64), &[f64; D])| {
                along(&node.lever, axis) * n - along(&node.lever, &self.normal) * along(t, axis)
            };
            self.nodes.iter().zip(&normal).zip(&tangential).map(one).sum()
        };
        let missing: Vec<f64> = self.axes.iter().map(missing).collect();
        let factors = self.factors(&normal, &missing);
        let normal: Vec<f64> = normal.iter().zip(&factors).map(|(n, factor)| n * factor).collect();
        let tangential = self.share_out(&normal, &tangential, &factors);
        for ((node, n), t) in self.nodes.iter().zip(normal).zip(tangential) {
            reaction[node.at] = std::array::from_fn(|c| n * self.normal[c] + t[c]);
        }
    }

    /// α + β·s, nowhere negative, with Σ factor N = ΣN and Σ factor N s = ΣN s + `missing` over those that are not 0.
    fn factors(&self, normal: &[f64], missing: &[f64]) -> Vec<f64> {
        let total: f64 = normal.iter().sum();
        let mut pressed: Vec<usize> = (0..normal.len()).filter(|&k| normal[k] > 0.0).collect();
        let place = |k: usize, a: usize| along(&self.nodes[k].centroid, &self.axes[a]);
        let count = self.axes.len();
        let middle: Vec<f64> =
            (0..count).map(|a| (0..normal.len()).map(|k| normal[k] * place(k, a)).sum::<f64>() / total).collect();
        loop {
            let weight = pressed.iter().map(|&k| normal[k]).sum::<f64>() / total;
            let mean: Vec<f64> = (0..count)
                .map(|a| pressed.iter().map(|&k| normal[k] * (place(k, a) - middle[a])).sum::<f64>() / (total * weight))
                .collect();
            let from = |k: usize, a: usize| place(k, a) - middle[a] - mean[a];
            let spread = DMatrix::from_fn(count, count, |a, b| {
                pressed.iter().map(|&k| normal[k] * from(k, a) * from(k, b)).sum::<f64>() / total
            });
            let way = DVector::from_fn(count, |a, _| missing[a] / total - mean[a]);
            let extent = pressed.iter().flat_map(|&k| (0..count).map(move |a| (k, a)));
            let extent = extent.map(|(k, a)| from(k, a).powi(2)).fold(0.0, f64::max);
            // Nodes on a line have no lever across it, and a node alone has none.
            let slope = if pressed.len() > 1 && extent > 0.0 {
                let inverse =
                    spread.pseudo_inverse(NOTHING.sqrt() * extent).unwrap_or_else(|_| DMatrix::zeros(count, count));
                inverse * way
            } else {
                DVector::zeros(count)
            };
            let factor = |k: usize| 1.0 / weight + (0..count).map(|a| slope[a] * from(k, a)).sum::<f64>();
            let kept: Vec<usize> = pressed.iter().copied().filter(|&k| factor(k) > 0.0).collect();
            if kept.len() == pressed.len() || kept.is_empty() {
                let mut factors = vec![0.0; normal.len()];
                pressed.iter().for_each(|&k| factors[k] = factor(k));
                return factors;
            }
            pressed = kept;
        }
    }

    /// Friction in proportion to its normal force; the rest of its sum is put where there is room up to μN.
    fn share_out(&self, normal: &[f64], tangential: &[[f64; D]], factors: &[f64]) -> Vec<[f64; D]> {
        let mut shared: Vec<[f64; D]> = tangential.iter().zip(factors).map(|(t, f)| t.map(|x| x * f)).collect();
        let sum = |forces: &[[f64; D]], c: usize| forces.iter().map(|force| force[c]).sum::<f64>();
        let lacking: [f64; D] = std::array::from_fn(|c| sum(tangential, c) - sum(&shared, c));
        let size = along(&lacking, &lacking).sqrt();
        if size == 0.0 {
            return shared;
        }
        let direction = lacking.map(|x| x / size);
        // How far each may go this way within the disc of its limit.
        let room = |(n, t): (&f64, &[f64; D])| {
            let (limit, own) = (self.law.limit(*n), along(t, &direction));
            let square = limit * limit - along(t, t) + own * own;
            (square.max(0.0).sqrt() - own).max(0.0)
        };
        let rooms: Vec<f64> = normal.iter().zip(&shared).map(room).collect();
        let total: f64 = rooms.iter().sum();
        if total > 0.0 {
            let part = (size / total).min(1.0);
            for (t, room) in shared.iter_mut().zip(&rooms) {
                (0..D).for_each(|c| t[c] += part * room * direction[c]);
            }
        }
        shared
    }
}
