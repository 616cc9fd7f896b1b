//! Smoothed strains of the auxiliary solution: means over the triangles at an edge and around a node.
//!
//! On a mesh of parallelograms cut in two, the two triangles at an edge and those around a node are point-symmetric, so
//! their mean strain is exact for quadratic fields. The stress of a triangle E
//!
//! σ̄_E = C[(1 − β)/3 Σ_{e⊂E} ε_e + β/3 Σ_{n∈E} ε_n]
//!
//! with means ε_e, ε_n weighted by area, within one material, is too soft by one factor for all waves, which the
//! corrected mass makes up for ([`Coefficients::mass`]). On other meshes edges are less symmetric than nodes: both
//! follow from the asymmetry Q of the pairs of triangles of a body.
//!
//! On a mesh of parallelepipeds cut in six tetrahedra, those at an inner edge and those around an inner node are
//! point-symmetric in the same way:
//!
//! σ̄_E = C[(1 − β)/6 Σ_{e⊂E} ε_e + β/4 Σ_{n∈E} ε_n].

mod mirrors;
mod solid_patches;
mod strains;

use percute_core::cell::CellKind;
use percute_core::ids::{ElementId, FaceId, NodeId};
use percute_core::mesh::Mesh;
use percute_core::problem::Problem;
pub(crate) use solid_patches::SolidPatches;
use std::ops::Range;
pub(crate) use strains::{Smoothed, SmoothedStrains, StrainLevel};

/// How the strains and the mass of a body are corrected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Coefficients {
    /// β, the share of the nodes in smoothed strains.
    nodes: f64,
    /// c₁, c₂ and −c₃ of p(μ) = c₁μ + c₂μ² − c₃μ³ with the lumping difference μ = 1 − M⁻¹M_c.
    pub(crate) mass: [f64; 3],
}

impl Coefficients {
    /// Those of triangles with this asymmetry Q of 0 to 1. c₁ is 1 + β on even meshes, where the mean over edges needs
    /// μ and that over nodes 2μ; c₂ is that of axial waves; c₃ keeps the shortest waves stable. On uneven meshes the
    /// pairs at edges report a false volume strain, which nodes do not.
    fn of_triangles(asymmetry: f64) -> Self {
        let nodes = 0.05 + 0.5 * asymmetry;
        let [first, third] = [1.05 + 0.35 * asymmetry, 2.15 + 1.23 * asymmetry];
        Self { nodes, mass: [first, 0.9 + 1.5 * nodes + nodes * nodes, -third] }
    }

    /// Those of bars, whose strains stay: with c₁ = ½ the errors of mass and of central differences are of one size.
    ///
    /// The simulation of a bar takes the critical step exactly; there its shortest wave grows with time once it is
    /// excited, and an auxiliary solution with the same growth does not show it. With c₂ ≤ −1/36 the auxiliary solution
    /// does not grow, at the price of a larger estimate at that step. This changes errors of the order that is left
    /// anyway.
    const BAR: Self = Self { nodes: 0.0, mass: [0.5, -1.0 / 36.0, 0.0] };

    /// Those of tetrahedra. Smoothed strains of an even mesh are too soft by q = ⅔ + 5β/6 times μ: c₁ = ½ + q makes up
    /// for both; c₂ = ⅖ + q c₁ is that of axial pressure waves; c₃ keeps the shortest waves stable.
    const fn of_tetrahedra() -> Self {
        let nodes = 0.2;
        let soft = 2.0 / 3.0 + 5.0 * nodes / 6.0;
        let first = 0.5 + soft;
        Self { nodes, mass: [first, 0.4 + soft * first, -3.5] }
    }
}

/// The strains that are averaged.
#[derive(Clone, Debug)]
pub(crate) struct Smoothing {
    /// The coefficients of each body.
    bodies: Vec<Coefficients>,
    /// The body of each node; empty where there is one.
    body_of_node: Vec<u32>,
    /// Where the patches of each node begin, one for each material around it; empty where strains stay.
    starts: Vec<u32>,
    /// The material of each patch.
    materials: Vec<u16>,
    /// β/(3V) of each patch, V its volume (1/m³).
    weights: Vec<f64>,
    /// Those of a solid, instead of the patches above.
    solid: SolidPatches,
}

impl Smoothing {
    pub(crate) fn new<const D: usize>(problem: &Problem<D>) -> Self {
        let mesh = problem.mesh();
        let body_of_node: Vec<u32> = match mesh.parts() {
            1 => Vec::new(),
            _ => mesh.part_numbers().into_iter().map(|body| body as u32).collect(),
        };
        let mut made = Self {
            bodies: Vec::new(),
            body_of_node,
            starts: Vec::new(),
            materials: Vec::new(),
            weights: Vec::new(),
            solid: SolidPatches::default(),
        };
        match mesh.kind() {
            CellKind::Bar => made.bodies = vec![Coefficients::BAR; mesh.parts()],
            CellKind::Tetrahedron => {
                let coefficients = Coefficients::of_tetrahedra();
                made.bodies = vec![coefficients; mesh.parts()];
                made.solid = SolidPatches::new(problem, coefficients.nodes);
            }
            CellKind::Triangle => {
                let asymmetry = made.asymmetry(problem);
                made.bodies = asymmetry.into_iter().map(Coefficients::of_triangles).collect();
                made.add_patches(problem);
            }
        }
        made
    }

    /// The asymmetry Q of each body: the mean over its inner edges, within a material, of that of the pair of
    /// triangles.
    fn asymmetry<const D: usize>(&self, problem: &Problem<D>) -> Vec<f64> {
        let (mesh, laws) = (problem.mesh(), problem.element_material());
        let mut sums = vec![[0.0; 2]; mesh.parts()];
        for face in mesh.faces() {
            if let Some(other) = face.neighbour.filter(|other| laws[other.index()] == laws[face.owner.index()]) {
                let sum = &mut sums[self.body(face.nodes[0])];
                sum[0] += asymmetry_of_pair::<D>(mesh, [face.owner, other], face.nodes).min(1.0);
                sum[1] += 1.0;
            }
        }
        sums.into_iter().map(|[sum, count]| if count > 0.0 { sum / count } else { 0.0 }).collect()
    }

    fn add_patches<const D: usize>(&mut self, problem: &Problem<D>) {
        let laws = problem.element_material();
        self.starts.push(0);
        for node in (0..problem.mesh().node_count()).map(NodeId::new) {
            let (first, nodes) = (self.materials.len(), self.bodies[self.body(node)].nodes);
            for element in problem.mesh().stars().star(node).elements {
                let law = laws[element.index()];
                let found = self.materials[first..].iter().position(|&known| known == law);
                let at = found.map_or(self.materials.len(), |found| first + found);
                if at == self.materials.len() {
                    self.materials.push(law);
                    self.weights.push(0.0);
                }
                self.weights[at] += problem.volume(*element);
            }
            self.weights[first..].iter_mut().for_each(|volume| *volume = nodes / (3.0 * *volume));
            self.starts.push(self.materials.len() as u32);
        }
    }

    /// Whether strains are averaged at all.
    pub(crate) fn smooths(&self) -> bool {
        !self.starts.is_empty() || self.solid.count() > 0
    }

    /// The patches of a solid.
    #[inline(always)]
    pub(crate) fn solid(&self) -> &SolidPatches {
        &self.solid
    }

    /// The coefficients of all bodies.
    pub(crate) fn bodies(&self) -> &[Coefficients] {
        &self.bodies
    }

    /// The body of a node.
    #[inline(always)]
    pub(crate) fn body(&self, node: NodeId) -> usize {
        self.body_of_node.get(node.index()).map_or(0, |body| *body as usize)
    }

    /// Number of nodes; 0 where strains stay.
    pub(crate) fn node_count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// The material of a patch.
    #[inline(always)]
    pub(crate) fn material(&self, patch: usize) -> u16 {
        self.materials[patch]
    }

    /// Number of patches.
    pub(crate) fn patch_count(&self) -> usize {
        self.materials.len()
    }

    /// The patches of some nodes.
    #[inline(always)]
    pub(crate) fn patches(&self, nodes: &Range<usize>) -> Range<usize> {
        if self.starts.is_empty() {
            return 0..0;
        }
        self.starts[nodes.start] as usize..self.starts[nodes.end] as usize
    }

    /// The patch of a node in a material.
    #[inline(always)]
    pub(crate) fn patch(&self, node: NodeId, material: u16) -> usize {
        let range = self.patches(&(node.index()..node.index() + 1));
        range.start + self.materials[range].iter().position(|&known| known == material).unwrap_or(0)
    }

    /// β/(3V) of each patch (1/m³).
    pub(crate) fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The element of the same material beyond a face of an element; without one, the element itself.
    #[inline(always)]
    pub(crate) fn beyond<const D: usize>(problem: &Problem<D>, element: ElementId, face: FaceId) -> ElementId {
        let (known, laws) = (&problem.mesh().face(face), problem.element_material());
        let other = known.across(element);
        other.filter(|other| laws[other.index()] == laws[element.index()]).unwrap_or(element)
    }

    /// (1 − β)/(3V) of an edge, V the volume of the elements there (m³), in the body of a node.
    #[inline(always)]
    pub(crate) fn edge_weight(&self, node: NodeId, volume: f64) -> f64 {
        (1.0 - self.bodies[self.body(node)].nodes) / (3.0 * volume)
    }
}

/// By how much two triangles at an edge are not images of each other in its midpoint: ½|λ − (1, 1, −1)|² with the
/// barycentric coordinates λ, in one of them, of the node that only the other one has; the mean of both ways.
fn asymmetry_of_pair<const D: usize>(mesh: &Mesh, pair: [ElementId; 2], common: &[NodeId]) -> f64 {
    let apart = pair.map(|element| {
        let cell = mesh.cell(element);
        cell.iter().find(|node| !common.contains(node)).copied().unwrap_or(cell[0])
    });
    let one_way = |element: ElementId, own: NodeId, other: NodeId| {
        let (cell, gradients) = (mesh.cell(element), mesh.gradients_in::<D>(element));
        let [from, to] = [own, other].map(|node| mesh.points_in::<D>()[node.index()]);
        let square = |(node, gradient): (&NodeId, &[f64; D])| {
            // λ at the node of its own triangle plus its change from there.
            let (start, wanted) = if *node == own { (1.0, -1.0) } else { (0.0, 1.0) };
            let change: f64 = (0..D).map(|c| gradient[c] * (to[c] - from[c])).sum();
            (start + change - wanted).powi(2)
        };
        0.5 * cell.iter().zip(&gradients).map(square).sum::<f64>()
    };
    0.5 * (one_way(pair[0], apart[0], apart[1]) + one_way(pair[1], apart[1], apart[0]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::material::Elastic;
    use percute_core::mesh::Mesh;

    fn of(mesh: Mesh) -> Smoothing {
        let law = Elastic::plane_strain(70e9, 0.3, 2700.0, 1.0).unwrap();
        Smoothing::new(&Problem::<2>::builder(mesh).material(law).build().unwrap())
    }

    /// Parallelograms cut in two have no asymmetry.
    #[test]
    fn parallelograms_are_symmetric() {
        let mesh = Mesh::rectangle(3.0, 1.0, 5, 4).unwrap().mapped(|p| [p[0] + 0.4 * p[1], p[1]]).unwrap();
        let found = of(mesh).bodies[0];
        let even = Coefficients::of_triangles(0.0);
        assert!((found.nodes - even.nodes).abs() < 1e-14, "{found:?}");
        assert_eq!(even.mass, [1.05, 0.9 + 1.5 * 0.05 + 0.05 * 0.05, -2.15]);
    }

    /// In squares with both diagonals the pairs at a side are mirror images, λ = (1, 1, −1) within them; those at half
    /// a diagonal are point-symmetric in no direction: λ = (2, 0, −1) has ½|λ − (1, 1, −1)|² = 1. With as many
    /// half diagonals as 4 n² and inner sides 2n(n − 1), of which a side has λ = (1, 1, −1).
    #[test]
    fn two_diagonals_are_asymmetric() {
        let n = 4;
        let (mut points, mut cells) = (Vec::new(), Vec::new());
        for j in 0..=n {
            (0..=n).for_each(|i| points.push([i as f64, j as f64]));
        }
        for j in 0..n {
            for i in 0..n {
                let (a, centre) = (j * (n + 1) + i, points.len());
                points.push([i as f64 + 0.5, j as f64 + 0.5]);
                let corners = [a, a + 1, a + n + 2, a + n + 1];
                (0..4).for_each(|k| cells.push([corners[k], corners[(k + 1) % 4], centre]));
            }
        }
        let mesh = Mesh::new(points, &cells, &Default::default(), &Default::default()).unwrap();
        let (halves, sides) = ((4 * n * n) as f64, (2 * n * (n - 1)) as f64);
        let q = halves / (halves + sides);
        assert!((of(mesh).bodies[0].nodes - (0.05 + 0.5 * q)).abs() < 1e-14);
    }
}
