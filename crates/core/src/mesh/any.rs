//! A mesh of either dimension, as other crates see it.

use super::{Around, BarMesh, Diagonals, ElementGroups, Generated, ImportWarning, Locator, Mesh, MeshError};
use super::{Numbering, TriangleMesh};
use crate::border::{Vector, cut, padded, vectors};
use crate::ids::{ElementId, FacetId, NodeId};
use crate::simplex::{Element, Shape, Simplex};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Named groups of facets: the nodes of all their facets, in rows.
pub type FacetRows = BTreeMap<String, Vec<usize>>;

/// A mesh of either dimension, shared. Coordinates and fields are in rows, as [`border`](crate::border) says.
#[derive(Clone, Debug)]
pub enum AnyMesh {
    /// Of a bar.
    D1(Arc<BarMesh>),
    /// Of a plane body.
    D2(Arc<TriangleMesh>),
}

macro_rules! on_mesh {
    ($any:expr, $mesh:pat => $body:expr) => {
        match $any {
            $crate::mesh::AnyMesh::D1($mesh) => $body,
            $crate::mesh::AnyMesh::D2($mesh) => $body,
        }
    };
}

impl From<BarMesh> for AnyMesh {
    fn from(mesh: BarMesh) -> Self {
        Self::D1(Arc::new(mesh))
    }
}

impl From<TriangleMesh> for AnyMesh {
    fn from(mesh: TriangleMesh) -> Self {
        Self::D2(Arc::new(mesh))
    }
}

/// A facet of a mesh of either dimension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AnyFacet<'m> {
    /// Its nodes.
    pub nodes: &'m [NodeId],
    /// The element whose outward normal is that of the facet.
    pub owner: ElementId,
    /// The element behind it; none on the boundary.
    pub neighbour: Option<ElementId>,
}

/// An element that contains a point.
#[derive(Clone, Debug, PartialEq)]
pub struct AnyAround {
    /// The element.
    pub element: ElementId,
    /// φ_i of its nodes there.
    pub shapes: Vec<f64>,
    /// Its share of the point.
    pub share: f64,
}

impl<const N: usize> From<Around<N>> for AnyAround {
    fn from(Around { element, shapes, share }: Around<N>) -> Self {
        Self { element, shapes: shapes.to_vec(), share }
    }
}

/// A mesh from rows; `of_bodies` if its parts may touch.
fn built<const D: usize, const N: usize>(
    points: &[f64],
    cells: &[usize],
    (facets, elements): (&FacetRows, &ElementGroups),
    of_bodies: bool,
) -> Result<AnyMesh, MeshError>
where
    Element<D, N>: Simplex<D, N>,
    AnyMesh: From<Mesh<D, N>>,
{
    let facets = facets.iter().map(|(name, rows)| (name.clone(), rows.as_chunks().0.to_vec())).collect();
    let (points, cells) = (vectors(points).to_vec(), cells.as_chunks().0);
    let mesh = if of_bodies { Mesh::of_bodies } else { Mesh::new };
    mesh(points, cells, &facets, elements).map(AnyMesh::from)
}

impl AnyMesh {
    /// Builds and checks a mesh of bars (dimension 1) or of triangles (2), from coordinates (m), nodes of the elements
    /// and groups, in rows.
    ///
    /// # Errors
    /// As [`Mesh::new`].
    ///
    /// # Panics
    /// For another dimension.
    pub fn new(
        dimension: usize,
        points: &[f64],
        cells: &[usize],
        groups: (&FacetRows, &ElementGroups),
    ) -> Result<Self, MeshError> {
        match dimension {
            1 => built::<1, 2>(points, cells, groups, false),
            2 => built::<2, 3>(points, cells, groups, false),
            other => unreachable!("a mesh of dimension {other}"),
        }
    }

    /// The same of bodies that may touch: [`Mesh::of_bodies`].
    ///
    /// # Errors
    /// As [`Mesh::of_bodies`].
    ///
    /// # Panics
    /// For another dimension.
    pub fn of_bodies(
        dimension: usize,
        points: &[f64],
        cells: &[usize],
        groups: (&FacetRows, &ElementGroups),
    ) -> Result<Self, MeshError> {
        match dimension {
            1 => built::<1, 2>(points, cells, groups, true),
            2 => built::<2, 3>(points, cells, groups, true),
            other => unreachable!("a mesh of dimension {other}"),
        }
    }

    /// A uniform bar, as [`BarMesh::uniform_bar`].
    ///
    /// # Errors
    /// Numbers out of range.
    pub fn uniform_bar(length: f64, elements: usize) -> Result<Self, MeshError> {
        BarMesh::uniform_bar(length, elements).map(Self::from)
    }

    /// A rectangle, as [`TriangleMesh::rectangle_cut`].
    ///
    /// # Errors
    /// Numbers out of range.
    pub fn rectangle_cut(sides: [f64; 2], [nx, ny]: [usize; 2], diagonals: Diagonals) -> Result<Self, MeshError> {
        TriangleMesh::rectangle_cut(sides[0], sides[1], nx, ny, diagonals).map(Self::from)
    }

    /// A disc, as [`TriangleMesh::disc`].
    ///
    /// # Errors
    /// Numbers out of range.
    pub fn disc(radius: f64, rings: usize) -> Result<Self, MeshError> {
        TriangleMesh::disc(radius, rings).map(Self::from)
    }

    /// The same mesh in another size, if a generator has made it: [`Generated::resized`].
    #[must_use]
    pub fn resized(&self, factor: f64) -> Option<Self> {
        match self {
            Self::D1(mesh) => mesh.resized(factor).map(Self::from),
            Self::D2(mesh) => mesh.resized(factor).map(Self::from),
        }
    }

    /// 1 for bars, 2 for plane bodies.
    #[must_use]
    pub fn dimension(&self) -> usize {
        match self {
            Self::D1(_) => 1,
            Self::D2(_) => 2,
        }
    }

    /// The kind of its elements.
    #[must_use]
    pub fn shape(&self) -> Shape {
        on_mesh!(self, mesh => mesh.simplex().shape())
    }

    /// Nodes of an element.
    #[must_use]
    pub fn nodes_of_element(&self) -> usize {
        self.dimension() + 1
    }

    /// Coordinates of the nodes (m), in rows.
    #[must_use]
    pub fn points(&self) -> &[f64] {
        on_mesh!(self, mesh => mesh.points().as_flattened())
    }

    /// The place of a node (m).
    #[must_use]
    pub fn point(&self, node: NodeId) -> Vector {
        on_mesh!(self, mesh => padded(&mesh.points()[node.index()]))
    }

    /// Places of the nodes (m).
    pub fn places(&self) -> impl ExactSizeIterator<Item = Vector> + Clone + '_ {
        (0..self.node_count()).map(|node| self.point(NodeId::new(node)))
    }

    /// Nodes of each element, positively oriented.
    pub fn cells(&self) -> std::slice::ChunksExact<'_, NodeId> {
        self.cell_rows().chunks_exact(self.nodes_of_element())
    }

    /// Nodes of all elements, in rows.
    #[must_use]
    pub fn cell_rows(&self) -> &[NodeId] {
        on_mesh!(self, mesh => mesh.cells().as_flattened())
    }

    /// Nodes of an element, positively oriented.
    #[must_use]
    pub fn cell(&self, element: ElementId) -> &[NodeId] {
        on_mesh!(self, mesh => &mesh.cells()[element.index()])
    }

    /// Places of the nodes of an element (m).
    #[must_use]
    pub fn cell_points(&self, element: ElementId) -> Vec<Vector> {
        on_mesh!(self, mesh => mesh.cell_points(element).iter().map(padded).collect())
    }

    /// Facets of an element; entry `k` lies opposite to its node `k`.
    #[must_use]
    pub fn cell_facets(&self, element: ElementId) -> &[FacetId] {
        on_mesh!(self, mesh => &mesh.cell_facets()[element.index()])
    }

    /// A facet.
    #[must_use]
    pub fn facet(&self, facet: FacetId) -> AnyFacet<'_> {
        on_mesh!(self, mesh => {
            let facet = &mesh.facets()[facet.index()];
            AnyFacet { nodes: &facet.nodes, owner: facet.owner, neighbour: facet.neighbour }
        })
    }

    /// Number of facets.
    #[must_use]
    pub fn facet_count(&self) -> usize {
        on_mesh!(self, mesh => mesh.facets().len())
    }

    /// The elements around a node, in order.
    #[must_use]
    pub fn elements_around(&self, node: NodeId) -> &[ElementId] {
        on_mesh!(self, mesh => mesh.stars().star(node).elements)
    }

    /// Named groups of facets.
    #[must_use]
    pub fn facet_groups(&self) -> &BTreeMap<String, Vec<FacetId>> {
        on_mesh!(self, mesh => mesh.facet_groups())
    }

    /// Named groups of elements.
    #[must_use]
    pub fn element_groups(&self) -> &BTreeMap<String, Vec<ElementId>> {
        on_mesh!(self, mesh => mesh.element_groups())
    }

    /// Diagonal of the bounding box (m).
    #[must_use]
    pub fn size(&self) -> f64 {
        on_mesh!(self, mesh => mesh.size())
    }

    /// Number of elements that were given with the wrong orientation and reoriented.
    #[must_use]
    pub fn reoriented_elements(&self) -> usize {
        on_mesh!(self, mesh => mesh.reoriented_elements())
    }

    /// Pairs of elements of different parts that touch: [`Mesh::touching_elements`].
    #[must_use]
    pub fn touching_elements(&self) -> &[[ElementId; 2]] {
        on_mesh!(self, mesh => mesh.touching_elements())
    }

    /// For each node the first node of its part.
    #[must_use]
    pub fn part_of_nodes(&self) -> Vec<NodeId> {
        on_mesh!(self, mesh => mesh.part_of_nodes())
    }

    /// For each node the number of its part: [`Mesh::part_numbers`].
    #[must_use]
    pub fn part_numbers(&self) -> Vec<usize> {
        on_mesh!(self, mesh => mesh.part_numbers())
    }

    /// The names of the parts: [`Mesh::part_names`].
    #[must_use]
    pub fn part_names(&self) -> Vec<String> {
        on_mesh!(self, mesh => mesh.part_names())
    }

    /// For each element the number of its part.
    #[must_use]
    pub fn part_of_elements(&self) -> Vec<usize> {
        on_mesh!(self, mesh => mesh.part_of_elements())
    }

    /// Number of separate parts.
    #[must_use]
    pub fn parts(&self) -> usize {
        on_mesh!(self, mesh => mesh.parts())
    }

    /// The same mesh with the warnings of its import.
    #[must_use]
    pub fn with_import_warnings(self, warnings: Vec<ImportWarning>) -> Self {
        match self {
            Self::D1(mesh) => Arc::unwrap_or_clone(mesh).with_import_warnings(warnings).into(),
            Self::D2(mesh) => Arc::unwrap_or_clone(mesh).with_import_warnings(warnings).into(),
        }
    }

    /// The warnings of its import.
    #[must_use]
    pub fn import_warnings(&self) -> &[ImportWarning] {
        on_mesh!(self, mesh => mesh.import_warnings())
    }

    /// Number of nodes.
    #[must_use]
    pub fn node_count(&self) -> usize {
        on_mesh!(self, mesh => mesh.node_count())
    }

    /// Number of elements.
    #[must_use]
    pub fn element_count(&self) -> usize {
        on_mesh!(self, mesh => mesh.element_count())
    }

    /// All elements.
    pub fn elements(&self) -> impl ExactSizeIterator<Item = ElementId> + use<> {
        (0..self.element_count()).map(ElementId::new)
    }

    /// The mean of the nodes of an element (m).
    #[must_use]
    pub fn centroid(&self, element: ElementId) -> Vector {
        on_mesh!(self, mesh => padded(&mesh.centroid(element)))
    }

    /// The volume of each element (length in 1D, area in 2D).
    #[must_use]
    pub fn volumes(&self) -> Vec<f64> {
        on_mesh!(self, mesh => mesh.volumes())
    }

    /// The volume of an element (length in 1D, area in 2D).
    #[must_use]
    pub fn volume(&self, element: ElementId) -> f64 {
        on_mesh!(self, mesh => mesh.cell_geometry(element).volume)
    }

    /// ∇φ_i of the nodes of an element (1/m).
    #[must_use]
    pub fn gradients(&self, element: ElementId) -> Vec<Vector> {
        on_mesh!(self, mesh => mesh.cell_geometry(element).gradients.iter().map(padded).collect())
    }

    /// The angle of an element at one of its nodes (rad): [`Mesh::angle`].
    #[must_use]
    pub fn angle(&self, element: ElementId, node: NodeId) -> f64 {
        on_mesh!(self, mesh => mesh.angle(element, node))
    }

    /// Outward unit normal of a boundary facet, and its measure (length in 2D, 1 in 1D).
    #[must_use]
    pub fn facet_normal(&self, facet: FacetId) -> (Vector, f64) {
        on_mesh!(self, mesh => {
            let (normal, measure) = mesh.facet_normal(facet);
            (padded(&normal), measure)
        })
    }

    /// Facets that belong to one element only.
    #[must_use]
    pub fn boundary(&self) -> Vec<FacetId> {
        on_mesh!(self, mesh => mesh.boundary().collect())
    }

    /// Elements that contain a point, with their shares of it: [`Mesh::around`].
    #[must_use]
    pub fn around(&self, point: &Vector) -> Vec<AnyAround> {
        on_mesh!(self, mesh => mesh.around(&cut(point)).into_iter().map(AnyAround::from).collect())
    }

    /// The point of the outline next to another one, and their distance (m).
    #[must_use]
    pub fn nearest_of_outline(&self, point: &Vector) -> (Vector, f64) {
        on_mesh!(self, mesh => {
            let (nearest, distance) = mesh.nearest_of_outline(&cut(point));
            (padded(&nearest), distance)
        })
    }

    /// The angle inside the body at a node of the outline (rad): [`Mesh::angle_of_outline`].
    #[must_use]
    pub fn angle_of_outline(&self, node: NodeId) -> Option<f64> {
        on_mesh!(self, mesh => mesh.angle_of_outline(node))
    }

    /// Nodes of the outline with an angle inside the body above this one (rad): [`Mesh::corners_above`].
    #[must_use]
    pub fn corners_above(&self, angle: f64) -> Vec<NodeId> {
        on_mesh!(self, mesh => mesh.corners_above(angle))
    }

    /// A uniform refinement: [`Mesh::refined`].
    ///
    /// # Errors
    /// Too many elements.
    pub fn refined(&self) -> Result<Self, MeshError> {
        match self {
            Self::D1(mesh) => mesh.refined().map(Self::from),
            Self::D2(mesh) => mesh.refined().map(Self::from),
        }
    }

    /// A refinement of some elements: [`Mesh::refined_where`].
    ///
    /// # Errors
    /// Too many elements.
    pub fn refined_where(&self, chosen: impl Fn(ElementId) -> bool) -> Result<Self, MeshError> {
        match self {
            Self::D1(mesh) => mesh.refined_where(chosen).map(Self::from),
            Self::D2(mesh) => mesh.refined_where(chosen).map(Self::from),
        }
    }

    /// A nodal field, in rows, on the uniform refinement: [`Mesh::prolonged`].
    #[must_use]
    pub fn prolonged(&self, nodal: &[f64]) -> Vec<f64> {
        on_mesh!(self, mesh => mesh.prolonged(vectors(nodal)).into_flattened())
    }

    /// Joins the meshes of bodies of one dimension: [`Mesh::joined`].
    ///
    /// # Errors
    /// As [`Mesh::of_bodies`].
    pub fn joined(bodies: &[(&str, &Self)]) -> Result<Self, MeshError> {
        match bodies {
            [(_, Self::D1(_)), ..] => BarMesh::joined(&Self::bars(bodies)).map(Self::from),
            _ => TriangleMesh::joined(&Self::triangles(bodies)).map(Self::from),
        }
    }

    /// Which body overlaps which, in words: [`Mesh::overlapping`].
    #[must_use]
    pub fn overlapping(bodies: &[(&str, &Self)], error: &MeshError) -> Option<(usize, String)> {
        match bodies {
            [(_, Self::D1(_)), ..] => BarMesh::overlapping(&Self::bars(bodies), error),
            _ => TriangleMesh::overlapping(&Self::triangles(bodies), error),
        }
    }

    fn bars<'m>(bodies: &[(&'m str, &'m Self)]) -> Vec<(&'m str, &'m BarMesh)> {
        let of = |(name, mesh): &(&'m str, &'m Self)| match mesh {
            Self::D1(mesh) => Some((*name, &**mesh)),
            Self::D2(_) => None,
        };
        bodies.iter().filter_map(of).collect()
    }

    fn triangles<'m>(bodies: &[(&'m str, &'m Self)]) -> Vec<(&'m str, &'m TriangleMesh)> {
        let of = |(name, mesh): &(&'m str, &'m Self)| match mesh {
            Self::D1(_) => None,
            Self::D2(mesh) => Some((*name, &**mesh)),
        };
        bodies.iter().filter_map(of).collect()
    }

    /// The part of a group of elements as a mesh of its own: [`Mesh::part_of_group`].
    #[must_use]
    pub fn part_of_group(&self, group: &str) -> Option<Result<Self, MeshError>> {
        match self {
            Self::D1(mesh) => mesh.part_of_group(group).map(|part| part.map(Self::from)),
            Self::D2(mesh) => mesh.part_of_group(group).map(|part| part.map(Self::from)),
        }
    }

    /// The mesh moved by an origin (m) and turned about it by an angle (degrees): [`Mesh::placed`].
    ///
    /// # Errors
    /// Coordinates out of range.
    pub fn placed(&self, origin: &Vector, degrees: f64) -> Result<Self, MeshError> {
        match self {
            Self::D1(mesh) => mesh.placed(&cut(origin), degrees).map(Self::from),
            Self::D2(mesh) => mesh.placed(&cut(origin), degrees).map(Self::from),
        }
    }

    /// The mesh with other coordinates.
    ///
    /// # Errors
    /// As [`Mesh::mapped`].
    pub fn mapped(&self, map: impl Fn(&Vector) -> Vector) -> Result<Self, MeshError> {
        match self {
            Self::D1(mesh) => mesh.mapped(|point| cut(&map(&padded(point)))).map(Self::from),
            Self::D2(mesh) => mesh.mapped(|point| cut(&map(&padded(point)))).map(Self::from),
        }
    }

    /// The order in which it is solved: [`Mesh::local_numbering`].
    #[must_use]
    pub fn local_numbering(&self) -> Option<Numbering> {
        on_mesh!(self, mesh => mesh.local_numbering())
    }

    /// The part of this mesh that each part of another mesh of the same bodies is: [`Locator::matching`]. None for a
    /// mesh of another dimension.
    #[must_use]
    pub fn matching_parts(&self, other: &Self) -> Option<Vec<usize>> {
        match (self, other) {
            (Self::D1(own), Self::D1(other)) => Some(Locator::matching(&Locator::of_bodies(own), other)),
            (Self::D2(own), Self::D2(other)) => Some(Locator::matching(&Locator::of_bodies(own), other)),
            _ => None,
        }
    }
}
