//! The wanted size of elements at each point.

use super::{Basis, Branch, Plan, sizes};
use percute_core::border::Vector;
use percute_core::ids::{ElementId, NodeId};
use percute_core::mesh::{Locator, Mesh};
use std::collections::BTreeMap;

/// Growth of the size with the distance from a node that touches, in a graded mesh.
const SLOPE: f64 = 0.5;
/// Points of an element at which its size is asked for lie at its middle, and at this part of the way to its corners.
const TOWARDS: f64 = 0.9;

/// A size of elements at each point of a body.
///
/// It is constant in each element of the mesh of a run. In a graded mesh, the elements that touch keep their size, but
/// towards nodes that touch it falls to that which is planned there.
#[derive(Clone, Debug)]
pub(crate) struct PlannedSizes<'m> {
    mesh: &'m Mesh,
    locator: Locator<'m>,
    size: Vec<f64>,
    /// For each element the nodes that touch in the elements around it, and the planned size there (m).
    near: BTreeMap<ElementId, Vec<(NodeId, f64)>>,
}

impl<'m> PlannedSizes<'m> {
    /// Of a plan for the mesh of a run.
    pub(crate) fn new(mesh: &'m Mesh, basis: &Basis, plan: &Plan) -> Self {
        let planned: Vec<f64> = plan.ratio.iter().zip(&basis.size).map(|(r, h)| r * h).collect();
        let locator = Locator::new(mesh);
        if plan.branch != Branch::Graded {
            return Self { mesh, locator, size: planned, near: BTreeMap::new() };
        }
        let kept = |e: usize| if basis.touches[e] && plan.ratio[e] < 1.0 { basis.size[e] } else { planned[e] };
        let size = (0..planned.len()).map(kept).collect();
        Self { mesh, locator, size, near: near(mesh, basis, &planned) }
    }

    /// The size at a point (m).
    pub(crate) fn at(&self, point: &Vector) -> f64 {
        let element = self.locator.element_near(point);
        let from = |(node, size): &(NodeId, f64)| {
            let place = self.mesh.point(*node);
            let square: f64 = (0..3).map(|c| (point[c] - place[c]).powi(2)).sum();
            size + SLOPE * square.sqrt()
        };
        let towards = self.near.get(&element).into_iter().flatten().map(from);
        towards.fold(self.size[element.index()], f64::min)
    }

    /// The size of an element of the mesh of the run, without its fall towards nodes that touch (m).
    pub(crate) fn planned_in(&self, element: ElementId) -> f64 {
        self.size[element.index()]
    }

    /// Whether each element of a mesh has more than so many times the wanted size.
    pub(crate) fn too_large(&self, mesh: &Mesh, times: f64) -> Vec<bool> {
        let is_too_large = |(e, size): (usize, f64)| size > times * self.within(mesh, ElementId::new(e));
        sizes(mesh).into_iter().enumerate().map(is_too_large).collect()
    }

    /// The smallest size in an element of a mesh (m).
    fn within(&self, mesh: &Mesh, element: ElementId) -> f64 {
        let middle = mesh.centroid(element);
        let towards =
            |corner: &Vector| self.at(&std::array::from_fn(|c| middle[c] + TOWARDS * (corner[c] - middle[c])));
        mesh.cell_points(element).iter().map(towards).fold(self.at(&middle), f64::min)
    }

    /// The element of the mesh of the run that an element of a mesh lies in.
    pub(crate) fn element_of(&self, mesh: &Mesh, element: ElementId) -> ElementId {
        self.locator.element_near(&mesh.centroid(element))
    }
}

/// The nodes that touch around each element, each with the smallest planned size of its elements.
fn near(mesh: &Mesh, basis: &Basis, planned: &[f64]) -> BTreeMap<ElementId, Vec<(NodeId, f64)>> {
    let mut near: BTreeMap<ElementId, Vec<(NodeId, f64)>> = BTreeMap::new();
    for &node in &basis.nodes {
        let around = mesh.elements_around(node);
        let size = around.iter().map(|e| planned[e.index()]).fold(f64::INFINITY, f64::min);
        let corners = around.iter().flat_map(|e| mesh.cell(*e));
        let mut patch: Vec<ElementId> = corners.flat_map(|corner| mesh.elements_around(*corner)).copied().collect();
        patch.sort_unstable();
        patch.dedup();
        patch.into_iter().for_each(|element| near.entry(element).or_default().push((node, size)));
    }
    near
}
