//! Meshes of P1 simplices, checked once when they are made.
//!
//! `D` is the dimension and `N = D + 1` the number of nodes of an element: [`BarMesh`] and
//! [`TriangleMesh`] name the two cases.

mod any;
mod any_search;
mod bisection;
mod check;
mod generated;
mod generator;
mod geometry;
mod import_warning;
mod inside;
mod join;
mod locate;
mod order;
mod parts;
mod place;
mod refine;
mod refine_locally;
mod renumber;
mod star;
mod strips;
mod topology;

pub use any::{AnyAround, AnyFacet, AnyMesh, FacetRows};
pub use any_search::{AnyBisection, AnyLocator};
pub use bisection::Bisection;
pub use check::{MeshError, room};
pub use generated::Generated;
pub use generator::Diagonals;
pub use import_warning::ImportWarning;
pub use locate::Locator;
pub use order::Numbering;
pub use place::Around;
pub(crate) use renumber::NewNumbers;
pub use star::{Star, Stars};
pub use strips::Strips;
pub use topology::Facet;

use crate::ids::{ElementId, FacetId, NodeId};
use crate::simplex::{CellGeometry, Element, Simplex};
use std::collections::BTreeMap;

/// A mesh of 2-node bars.
pub type BarMesh = Mesh<1, 2>;
/// A mesh of 3-node triangles.
pub type TriangleMesh = Mesh<2, 3>;

/// Named groups of facets, each facet given by its nodes in any order.
pub type FacetGroups<const D: usize> = BTreeMap<String, Vec<[usize; D]>>;
/// Named groups of elements, by number.
pub type ElementGroups = BTreeMap<String, Vec<usize>>;

/// A conforming mesh of simplices without degenerate elements, unused or duplicate nodes, or
/// non-manifold facets and nodes. Elements are positively oriented. Separate parts do not overlap, and touch only if
/// the mesh is one of several bodies.
#[derive(Clone, Debug)]
pub struct Mesh<const D: usize, const N: usize> {
    simplex: &'static dyn Simplex<D, N>,
    points: Vec<[f64; D]>,
    cells: Vec<[NodeId; N]>,
    facets: Vec<Facet<D>>,
    cell_facets: Vec<[FacetId; N]>,
    stars: Stars,
    facet_groups: BTreeMap<String, Vec<FacetId>>,
    element_groups: BTreeMap<String, Vec<ElementId>>,
    size: f64,
    reoriented: usize,
    parts: usize,
    /// Elements of different parts that touch, in ascending order.
    touching: Vec<[ElementId; 2]>,
    import_warnings: Vec<ImportWarning>,
}

/// How near the separate parts of a mesh may be.
#[derive(Clone, Copy)]
enum Parts {
    Apart,
    MayTouch,
}

impl<const D: usize, const N: usize> Mesh<D, N> {
    /// Builds and checks a mesh.
    ///
    /// `points` are coordinates in metres, `cells` node numbers from 0. Negatively oriented
    /// elements are reoriented (see [`Mesh::reoriented_elements`]).
    ///
    /// # Errors
    /// A mesh that fails a check, with the numbers of the nodes or elements at fault.
    pub fn new(
        points: Vec<[f64; D]>,
        cells: &[[usize; N]],
        facet_groups: &FacetGroups<D>,
        element_groups: &ElementGroups,
    ) -> Result<Self, MeshError>
    where
        Element<D, N>: Simplex<D, N>,
    {
        Self::checked(&Element, points, cells, (facet_groups, element_groups), Parts::Apart)
    }

    /// The same of bodies that may touch: parts of the mesh, of which nodes may be at one place. A problem has contact
    /// where they do.
    ///
    /// # Errors
    /// As [`Mesh::new`], for parts that overlap.
    pub fn of_bodies(
        points: Vec<[f64; D]>,
        cells: &[[usize; N]],
        facet_groups: &FacetGroups<D>,
        element_groups: &ElementGroups,
    ) -> Result<Self, MeshError>
    where
        Element<D, N>: Simplex<D, N>,
    {
        Self::checked(&Element, points, cells, (facet_groups, element_groups), Parts::MayTouch)
    }

    fn checked(
        simplex: &'static dyn Simplex<D, N>,
        points: Vec<[f64; D]>,
        cells: &[[usize; N]],
        (facet_groups, element_groups): (&FacetGroups<D>, &ElementGroups),
        given: Parts,
    ) -> Result<Self, MeshError> {
        room(cells.len())?;
        check::points(&points)?;
        let mut cells = check::cells(points.len(), cells)?;
        let size = geometry::bounding_box_diagonal(&points);
        let part = parts::part_of_nodes(points.len(), &cells);
        match given {
            Parts::Apart => check::duplicate_points(&points, 0..points.len(), size)?,
            Parts::MayTouch => check::duplicate_points_of_parts(&points, &part, size)?,
        }
        let reoriented = check::orient(simplex, &points, &mut cells)?;
        let (facets, cell_facets) = topology::facets(&cells)?;
        let stars = Stars::new(simplex, points.len(), &cells, &facets, &cell_facets)?;
        let (parts, touching) = parts::separate(simplex, (&points, &part), &cells, &facets, size)?;
        if let (Parts::Apart, Some(pair)) = (given, touching.first()) {
            return Err(MeshError::PartsTouch { elements: pair.map(ElementId::index) });
        }
        let facet_groups = check::facet_groups(&facets, points.len(), facet_groups)?;
        let element_groups = check::element_groups(cells.len(), element_groups)?;
        Ok(Self {
            simplex,
            points,
            cells,
            facets,
            cell_facets,
            stars,
            facet_groups,
            element_groups,
            size,
            reoriented,
            parts,
            touching,
            import_warnings: Vec::new(),
        })
    }

    /// The kind of its elements.
    #[must_use]
    pub fn simplex(&self) -> &'static dyn Simplex<D, N> {
        self.simplex
    }

    /// Coordinates of the nodes (m).
    #[must_use]
    pub fn points(&self) -> &[[f64; D]] {
        &self.points
    }

    /// Nodes of each element, positively oriented.
    #[must_use]
    pub fn cells(&self) -> &[[NodeId; N]] {
        &self.cells
    }

    /// All facets: edges in 2D, points in 1D.
    #[must_use]
    pub fn facets(&self) -> &[Facet<D>] {
        &self.facets
    }

    /// Facets of each element; entry `k` lies opposite to local node `k`.
    #[must_use]
    pub fn cell_facets(&self) -> &[[FacetId; N]] {
        &self.cell_facets
    }

    /// The elements around each node, in order.
    #[must_use]
    pub fn stars(&self) -> &Stars {
        &self.stars
    }

    /// Named groups of facets.
    #[must_use]
    pub fn facet_groups(&self) -> &BTreeMap<String, Vec<FacetId>> {
        &self.facet_groups
    }

    /// Named groups of elements.
    #[must_use]
    pub fn element_groups(&self) -> &BTreeMap<String, Vec<ElementId>> {
        &self.element_groups
    }

    /// Diagonal of the bounding box (m), the reference length of geometric tolerances.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Number of elements that were given with the wrong orientation and reoriented.
    #[must_use]
    pub fn reoriented_elements(&self) -> usize {
        self.reoriented
    }

    /// Pairs of elements of different parts that touch, in ascending order: their parts are bodies.
    #[must_use]
    pub fn touching_elements(&self) -> &[[ElementId; 2]] {
        &self.touching
    }

    /// For each node the first node of its part.
    #[must_use]
    pub fn part_of_nodes(&self) -> Vec<NodeId> {
        parts::part_of_nodes(self.points.len(), &self.cells)
    }

    /// For each node the number of its part, from 0, in the order of their first nodes.
    #[must_use]
    pub fn part_numbers(&self) -> Vec<usize> {
        let part = self.part_of_nodes();
        let mut number = vec![0; part.len()];
        let mut count = 0;
        for (node, first) in part.iter().enumerate() {
            if first.index() == node {
                number[node] = count;
                count += 1;
            }
        }
        part.iter().map(|first| number[first.index()]).collect()
    }

    /// The names of the parts: of the first group that has all elements of a part and no others, or "body 0".
    #[must_use]
    pub fn part_names(&self) -> Vec<String> {
        let of_element = self.part_of_elements();
        let mut sizes = vec![0; self.parts];
        of_element.iter().for_each(|&part| sizes[part] += 1);
        let name = |(part, size): (usize, &usize)| {
            let whole = |members: &Vec<ElementId>| {
                members.len() == *size && members.iter().all(|element| of_element[element.index()] == part)
            };
            let found = self.element_groups.iter().find(|(_, members)| whole(members));
            found.map_or_else(|| format!("body {part}"), |(name, _)| name.clone())
        };
        sizes.iter().enumerate().map(name).collect()
    }

    /// The same mesh with more groups of facets.
    pub(crate) fn with_facet_groups(mut self, groups: impl IntoIterator<Item = (String, Vec<FacetId>)>) -> Self {
        self.facet_groups.extend(groups);
        self
    }

    /// For each element the number of its part, in the same order.
    #[must_use]
    pub fn part_of_elements(&self) -> Vec<usize> {
        let of_node = self.part_numbers();
        self.cells.iter().map(|cell| of_node[cell[0].index()]).collect()
    }

    /// Number of separate parts; elements that share a node belong to one part.
    #[must_use]
    pub fn parts(&self) -> usize {
        self.parts
    }

    /// The same mesh with the warnings of its import.
    #[must_use]
    pub fn with_import_warnings(self, import_warnings: Vec<ImportWarning>) -> Self {
        Self { import_warnings, ..self }
    }

    /// The warnings of its import.
    #[must_use]
    pub fn import_warnings(&self) -> &[ImportWarning] {
        &self.import_warnings
    }

    /// Number of nodes.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.points.len()
    }

    /// Number of elements.
    #[must_use]
    pub fn element_count(&self) -> usize {
        self.cells.len()
    }

    /// Coordinates of the nodes of an element (m).
    #[must_use]
    pub fn cell_points(&self, element: ElementId) -> [[f64; D]; N] {
        self.cells[element.index()].map(|node| self.points[node.index()])
    }

    /// The mean of the nodes of an element (m).
    #[must_use]
    pub fn centroid(&self, element: ElementId) -> [f64; D] {
        let corners = self.cell_points(element);
        std::array::from_fn(|c| corners.iter().map(|p| p[c]).sum::<f64>() / N as f64)
    }

    /// The volume of each element (length in 1D, area in 2D).
    #[must_use]
    pub fn volumes(&self) -> Vec<f64> {
        (0..self.element_count()).map(|e| self.cell_geometry(ElementId::new(e)).volume).collect()
    }

    /// Volume and shape-function gradients of an element (length in 1D, area in 2D).
    #[must_use]
    pub fn cell_geometry(&self, element: ElementId) -> CellGeometry<D, N> {
        self.simplex.geometry(&self.cell_points(element))
    }

    /// The local number of `node` in `element`.
    #[must_use]
    pub fn local_node(&self, element: ElementId, node: NodeId) -> Option<usize> {
        self.cells[element.index()].iter().position(|&other| other == node)
    }

    /// Outward unit normal of a boundary facet, and its measure (length in 2D, 1 in 1D).
    #[must_use]
    pub fn facet_normal(&self, facet: FacetId) -> ([f64; D], f64) {
        let owner = self.facets[facet.index()].owner;
        let opposite = self.cell_facets[owner.index()].iter().position(|&f| f == facet).unwrap_or(0);
        self.cell_geometry(owner).facet_normal(opposite)
    }

    /// Whether all nodes of a facet have the same coordinate in a direction, to the rounding of a mesh that was turned
    /// and moved.
    #[must_use]
    pub fn stands_across(&self, facet: FacetId, direction: usize) -> bool {
        let nodes = &self.facets[facet.index()].nodes;
        let [low, high] = [f64::min, f64::max]
            .map(|choose| nodes.iter().map(|node| self.points[node.index()][direction]).reduce(choose).unwrap_or(0.0));
        // Some operations on coordinates as large as the mesh or as its distance from the origin.
        high - low <= 16.0 * f64::EPSILON * (self.size + high.abs().max(low.abs()))
    }

    /// Facets that belong to one element only.
    pub fn boundary(&self) -> impl Iterator<Item = FacetId> + '_ {
        self.facets.iter().enumerate().filter(|(_, facet)| facet.neighbour.is_none()).map(|(i, _)| FacetId::new(i))
    }
}
