//! The stresses of the reference tetrahedron that a fluctuation is made of.

use super::reference::{ALL, COMPONENTS, CORNERS, FREE, LOADS, PAIRS, ReferenceTetrahedron, VOLUME};
use super::reference::{pair_products, product};
use crate::stress::combined_gram::{CombinedGram, unit};
use std::sync::OnceLock;

/// Numbers of a fluctuation that belong to faces. On face k, the tractions at its second and at its third node, each
/// less that at its first node: two vectors, which are deviations from any mean.
pub(super) const FACE_LOADS: usize = 24;
/// All numbers that make up a fluctuation: behind those of the faces, the volume load at each node.
pub(super) const FLUCTUATION_LOADS: usize = FACE_LOADS + 12;

/// Free stresses of the reference tetrahedron, and stresses of a unit of each load of a fluctuation.
pub(super) const MODES: usize = FREE + FLUCTUATION_LOADS;
/// The first that belongs to a load.
pub(super) const START: usize = FREE;
/// Numbers that the mean depends on: the force on each node.
pub(super) const FORCES: usize = 12;

/// The products of these stresses, made at first use.
pub(super) fn gram() -> &'static CombinedGram<{ PAIRS.len() }> {
    static GRAM: OnceLock<CombinedGram<{ PAIRS.len() }>> = OnceLock::new();
    GRAM.get_or_init(|| {
        let reference = ReferenceTetrahedron::get();
        let parts = |i: usize| if i < START { unit(LOADS + i) } else { loads(i - START) };
        let stresses: Vec<_> = (0..MODES).map(|i| reference.stress(&parts(i))).collect();
        CombinedGram::new(&stresses, product)
    })
}

/// The products of the mean stresses of unit forces on the nodes, made at first use.
pub(super) fn mean_gram() -> &'static CombinedGram<{ PAIRS.len() }> {
    static GRAM: OnceLock<CombinedGram<{ PAIRS.len() }>> = OnceLock::new();
    GRAM.get_or_init(|| {
        CombinedGram::new(&std::array::from_fn::<_, FORCES, _>(mean_stress), |x, y| {
            pair_products(&x.map(|x| y.map(|y| VOLUME * x * y)))
        })
    })
}

/// The symmetric part of force ⊗ arm, over the volume, for a unit force on a node of the reference tetrahedron; the arm
/// is that from the centroid.
fn mean_stress(force: usize) -> [f64; 6] {
    let (node, along) = (force / 3, force % 3);
    let part = |a: usize, b: usize| if a == along { (CORNERS[node][b] - 0.25) / VOLUME } else { 0.0 };
    COMPONENTS.map(|(a, b)| 0.5 * (part(a, b) + part(b, a)))
}

/// The loads on the reference tetrahedron that a unit of a load of a fluctuation brings about: those that put no force
/// on any node.
fn loads(at: usize) -> [f64; ALL] {
    let c = at % 3;
    // Deviations of the moments on each face from their mean, and forces of the volume load on the nodes.
    let (mut deviations, mut inner, mut loads) = ([[0.0; 3]; 4], [0.0; 4], [0.0; ALL]);
    if at < FACE_LOADS {
        // The deviation of a traction from the mean of the face is 12 times that of the moment.
        let (face, node) = (at / 6, 1 + at / 3 % 2);
        deviations[face] = std::array::from_fn(|p| if p == node { 2.0 / 36.0 } else { -1.0 / 36.0 });
    } else {
        // ∫φ_i φ_j is a twentieth of the volume, and twice that for i = j.
        let node = (at - FACE_LOADS) / 3;
        inner = std::array::from_fn(|i| VOLUME / if i == node { 10.0 } else { 20.0 });
        loads[36 + 3 * node + c] = 1.0;
    }
    // A third of the resultants of the three faces at each node.
    let around: [f64; 4] = std::array::from_fn(|i| {
        let through = |k: usize| if k == i { 0.0 } else { deviations[k][(i + 3 - k) % 4] };
        inner[i] - (0..4).map(through).sum::<f64>()
    });
    let sum = around.iter().sum::<f64>();
    for face in 0..4 {
        let mean = sum / 3.0 - around[face];
        for p in 0..3 {
            // |f|F̂ is 12 b_p − 3 Σb.
            loads[9 * face + 3 * p + c] = 12.0 * (mean + deviations[face][p]) - 9.0 * mean;
        }
    }
    loads
}
