//! Meshes of P1 simplices, checked once when they are made.
//!
//! A mesh has no dimension in its type: cells, faces and coordinates are data in rows. Code that is compiled for a
//! dimension `D` and elements of `N` nodes reads them as arrays: [`Mesh::points_in`], [`Mesh::nodes_of`].

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
mod rows;
mod solids;
mod star;
mod strips;
mod topology;

pub use bisection::Bisection;
pub use check::{MeshError, room};
pub use generator::Diagonals;
pub use import_warning::ImportWarning;
pub use locate::{Locator, MOST_NODES, Weights};
pub use order::Numbering;
pub use place::Around;
pub(crate) use renumber::NewNumbers;
pub use star::{Star, Stars};
pub use strips::Strips;
pub use topology::Face;

use crate::border::{Vector, cut, padded, row};
use crate::cell::{CellGeometry, CellKind, cell};
use crate::ids::{ElementId, FaceId, NodeId};
use std::collections::BTreeMap;
use topology::Faces;

/// Named groups of faces, each face given by its nodes in any order.
pub type FaceGroups<const D: usize> = BTreeMap<String, Vec<[usize; D]>>;
/// Named groups of faces: the nodes of all their faces, in rows.
pub type FaceRows = BTreeMap<String, Vec<usize>>;
/// Named groups of elements, by number.
pub type ElementGroups = BTreeMap<String, Vec<usize>>;

/// A conforming mesh of simplices without degenerate elements, unused or duplicate nodes, or
/// non-manifold faces and nodes. Elements are positively oriented. Separate parts do not overlap, and touch only if
/// the mesh is one of several bodies.
#[derive(Clone, Debug)]
pub struct Mesh {
    kind: CellKind,
    /// Coordinates of the nodes, in rows.
    points: Vec<f64>,
    /// Nodes of the elements, in rows.
    cells: Vec<NodeId>,
    faces: Faces,
    /// Faces of the elements, in rows.
    cell_faces: Vec<FaceId>,
    stars: Stars,
    face_groups: BTreeMap<String, Vec<FaceId>>,
    element_groups: BTreeMap<String, Vec<ElementId>>,
    size: f64,
    reoriented: usize,
    parts: usize,
    /// Elements of different parts that touch, in ascending order.
    touching: Vec<[ElementId; 2]>,
    import_warnings: Vec<ImportWarning>,
}

/// Does something with the dimension and the nodes of an element of a mesh as constants.
macro_rules! in_kind {
    ($mesh:expr, $dimension:ident, $nodes:ident => $body:expr) => {
        match $mesh.kind {
            $crate::cell::CellKind::Bar => {
                #[allow(dead_code)]
                const $dimension: usize = 1;
                #[allow(dead_code)]
                const $nodes: usize = 2;
                $body
            }
            $crate::cell::CellKind::Triangle => {
                #[allow(dead_code)]
                const $dimension: usize = 2;
                #[allow(dead_code)]
                const $nodes: usize = 3;
                $body
            }
            $crate::cell::CellKind::Tetrahedron => {
                #[allow(dead_code)]
                const $dimension: usize = 3;
                #[allow(dead_code)]
                const $nodes: usize = 4;
                $body
            }
        }
    };
}
use in_kind;

/// How near the separate parts of a mesh may be.
#[derive(Clone, Copy)]
enum Parts {
    Apart,
    MayTouch,
}

impl Mesh {
    /// Builds and checks a mesh.
    ///
    /// `points` are coordinates in metres, `cells` node numbers from 0. Negatively oriented
    /// elements are reoriented (see [`Mesh::reoriented_elements`]).
    ///
    /// # Errors
    /// A mesh that fails a check, with the numbers of the nodes or elements at fault.
    pub fn new<const D: usize, const N: usize>(
        points: Vec<[f64; D]>,
        cells: &[[usize; N]],
        face_groups: &FaceGroups<D>,
        element_groups: &ElementGroups,
    ) -> Result<Self, MeshError> {
        Self::checked(points, cells, (&rows(face_groups), element_groups), Parts::Apart)
    }

    /// The same of bodies that may touch: parts of the mesh, of which nodes may be at one place. A problem has contact
    /// where they do.
    ///
    /// # Errors
    /// As [`Mesh::new`], for parts that overlap.
    pub fn of_bodies<const D: usize, const N: usize>(
        points: Vec<[f64; D]>,
        cells: &[[usize; N]],
        face_groups: &FaceGroups<D>,
        element_groups: &ElementGroups,
    ) -> Result<Self, MeshError> {
        Self::checked(points, cells, (&rows(face_groups), element_groups), Parts::MayTouch)
    }

    fn checked<const D: usize, const N: usize>(
        points: Vec<[f64; D]>,
        cells: &[[usize; N]],
        (face_groups, element_groups): (&FaceRows, &ElementGroups),
        given: Parts,
    ) -> Result<Self, MeshError> {
        let kind = cell::<D, N>();
        room(cells.len())?;
        check::points(&points)?;
        let mut cells = check::cells(points.len(), cells)?;
        let size = geometry::bounding_box_diagonal(&points);
        let part = parts::part_of_nodes(points.len(), &cells);
        match given {
            Parts::Apart => check::duplicate_points(&points, 0..points.len(), size)?,
            Parts::MayTouch => check::duplicate_points_of_parts(&points, &part, size)?,
        }
        let reoriented = check::orient(kind, &points, &mut cells)?;
        let (faces, cell_faces) = topology::faces::<D, N>(&cells)?;
        let stars = Stars::new(kind, points.len(), &cells, &faces, &cell_faces)?;
        let (parts, touching) = parts::separate(kind, (&points, &part), &cells, &faces, size)?;
        if let (Parts::Apart, Some(pair)) = (given, touching.first()) {
            return Err(MeshError::PartsTouch { elements: pair.map(ElementId::index) });
        }
        let face_groups = check::face_groups(&faces, points.len(), face_groups)?;
        let element_groups = check::element_groups(cells.len(), element_groups)?;
        Ok(Self {
            kind: kind.kind(),
            points: points.into_flattened(),
            cells: cells.into_flattened(),
            faces,
            cell_faces: cell_faces.into_flattened(),
            stars,
            face_groups,
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
    pub fn kind(&self) -> CellKind {
        self.kind
    }

    /// 1 for bars, 2 for plane bodies, 3 for solids.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.kind.dimension()
    }

    /// Nodes of an element.
    #[must_use]
    pub fn nodes_of_element(&self) -> usize {
        self.kind.nodes()
    }

    /// Coordinates of the nodes (m), in rows.
    #[must_use]
    pub fn points(&self) -> &[f64] {
        &self.points
    }

    /// Coordinates of the nodes (m), in their dimension.
    ///
    /// # Panics
    /// For another dimension.
    #[inline]
    #[must_use]
    pub fn points_in<const D: usize>(&self) -> &[[f64; D]] {
        assert_eq!(D, self.dimension(), "the dimension of the mesh");
        self.points.as_chunks().0
    }

    /// Nodes of all elements, in rows, positively oriented.
    #[must_use]
    pub fn cell_rows(&self) -> &[NodeId] {
        &self.cells
    }

    /// Nodes of each element.
    pub fn cells(&self) -> std::slice::ChunksExact<'_, NodeId> {
        self.cells.chunks_exact(self.nodes_of_element())
    }

    /// Nodes of each element, whose number is known.
    ///
    /// # Panics
    /// For another number.
    #[inline]
    #[must_use]
    pub fn nodes_of<const N: usize>(&self) -> &[[NodeId; N]] {
        assert_eq!(N, self.nodes_of_element(), "nodes of an element");
        self.cells.as_chunks().0
    }

    /// Nodes of an element.
    #[must_use]
    pub fn cell(&self, element: ElementId) -> &[NodeId] {
        let count = self.nodes_of_element();
        &self.cells[count * element.index()..count * (element.index() + 1)]
    }

    /// Faces of each element, whose number is known; entry `k` lies opposite to local node `k`.
    #[inline]
    #[must_use]
    pub fn faces_of<const N: usize>(&self) -> &[[FaceId; N]] {
        self.cell_faces.as_chunks().0
    }

    /// Faces of an element; entry `k` lies opposite to its node `k`.
    #[must_use]
    pub fn cell_faces(&self, element: ElementId) -> &[FaceId] {
        let count = self.nodes_of_element();
        &self.cell_faces[count * element.index()..count * (element.index() + 1)]
    }

    /// Number of faces: triangles in 3D, edges in 2D, points in 1D.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.faces.len()
    }

    /// A face.
    #[inline]
    #[must_use]
    pub fn face(&self, face: FaceId) -> Face<'_> {
        self.faces.get(face.index())
    }

    /// The nodes of a face, ascending.
    #[inline]
    #[must_use]
    pub fn face_nodes<const D: usize>(&self, face: FaceId) -> [NodeId; D] {
        self.faces.nodes.as_chunks().0[face.index()]
    }

    /// All faces, in order.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = Face<'_>> {
        self.faces.iter()
    }

    /// The elements around each node, in order.
    #[must_use]
    pub fn stars(&self) -> &Stars {
        &self.stars
    }

    /// The elements around a node, in order.
    #[must_use]
    pub fn elements_around(&self, node: NodeId) -> &[ElementId] {
        self.stars.star(node).elements
    }

    /// Named groups of faces.
    #[must_use]
    pub fn face_groups(&self) -> &BTreeMap<String, Vec<FaceId>> {
        &self.face_groups
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
        in_kind!(self, D, N => parts::part_of_nodes(self.points.len() / D, self.nodes_of::<N>()))
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

    /// The same mesh with more groups of faces.
    pub(crate) fn with_face_groups(mut self, groups: impl IntoIterator<Item = (String, Vec<FaceId>)>) -> Self {
        self.face_groups.extend(groups);
        self
    }

    /// For each element the number of its part, in the same order.
    #[must_use]
    pub fn part_of_elements(&self) -> Vec<usize> {
        let of_node = self.part_numbers();
        self.cells().map(|cell| of_node[cell[0].index()]).collect()
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
    #[inline]
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.points.len() / self.dimension()
    }

    /// Number of elements.
    #[inline]
    #[must_use]
    pub fn element_count(&self) -> usize {
        self.cells.len() / self.nodes_of_element()
    }

    /// All elements.
    pub fn elements(&self) -> impl ExactSizeIterator<Item = ElementId> + use<> {
        (0..self.element_count()).map(ElementId::new)
    }

    /// The place of a node (m).
    #[must_use]
    pub fn point(&self, node: NodeId) -> Vector {
        row(&self.points, node.index(), self.dimension())
    }

    /// Places of the nodes (m).
    pub fn places(&self) -> impl ExactSizeIterator<Item = Vector> + Clone + '_ {
        (0..self.node_count()).map(|node| self.point(NodeId::new(node)))
    }

    /// Places of the nodes of an element (m).
    #[must_use]
    pub fn cell_points(&self, element: ElementId) -> Vec<Vector> {
        self.cell(element).iter().map(|&node| self.point(node)).collect()
    }

    /// Coordinates of the nodes of an element (m), in their dimension.
    #[inline]
    #[must_use]
    pub fn corners<const D: usize, const N: usize>(&self, element: ElementId) -> [[f64; D]; N] {
        let (points, cells): (&[[f64; D]], &[[NodeId; N]]) = (self.points.as_chunks().0, self.cells.as_chunks().0);
        cells[element.index()].map(|node| points[node.index()])
    }

    /// The mean of the nodes of an element (m), in their dimension.
    #[must_use]
    pub fn centroid_in<const D: usize>(&self, element: ElementId) -> [f64; D] {
        let (points, nodes) = (self.points_in::<D>(), self.cell(element));
        std::array::from_fn(|c| nodes.iter().map(|node| points[node.index()][c]).sum::<f64>() / nodes.len() as f64)
    }

    /// The mean of the nodes of an element (m).
    #[must_use]
    pub fn centroid(&self, element: ElementId) -> Vector {
        in_kind!(self, D, N => padded(&self.centroid_in::<D>(element)))
    }

    /// The volume of each element (length in 1D, area in 2D).
    #[must_use]
    pub fn volumes(&self) -> Vec<f64> {
        self.elements().map(|element| self.volume(element)).collect()
    }

    /// The volume of an element (length in 1D, area in 2D).
    #[must_use]
    pub fn volume(&self, element: ElementId) -> f64 {
        in_kind!(self, D, N => self.geometry::<D, N>(element).volume)
    }

    /// Volume and shape-function gradients of an element (length in 1D, area in 2D).
    #[inline]
    #[must_use]
    pub fn geometry<const D: usize, const N: usize>(&self, element: ElementId) -> CellGeometry<D, N> {
        cell().geometry(&self.corners(element))
    }

    /// ∇φ_i of the nodes of an element (1/m).
    #[must_use]
    pub fn gradients(&self, element: ElementId) -> Vec<Vector> {
        in_kind!(self, D, N => self.geometry::<D, N>(element).gradients.iter().map(padded).collect())
    }

    /// ∇φ_i of the nodes of an element (1/m), in their dimension; 0 beyond its nodes.
    #[inline]
    #[must_use]
    pub fn gradients_in<const D: usize>(&self, element: ElementId) -> [[f64; D]; MOST_NODES] {
        let mut gradients = [[0.0; D]; MOST_NODES];
        in_kind!(self, K, N => {
            let of_cell = self.geometry::<K, N>(element).gradients;
            for (own, slope) in gradients.iter_mut().zip(&of_cell) {
                own.copy_from_slice(slope);
            }
        });
        gradients
    }

    /// The local number of `node` in `element`.
    #[must_use]
    pub fn local_node(&self, element: ElementId, node: NodeId) -> Option<usize> {
        self.cell(element).iter().position(|&other| other == node)
    }

    /// Outward unit normal of a boundary face, in its dimension, and its measure (length in 2D, 1 in 1D).
    #[must_use]
    pub fn normal_in<const D: usize>(&self, face: FaceId) -> ([f64; D], f64) {
        let (normal, measure) = self.face_normal(face);
        (cut(&normal), measure)
    }

    /// Outward unit normal of a boundary face, and its measure (length in 2D, 1 in 1D).
    #[must_use]
    pub fn face_normal(&self, face: FaceId) -> (Vector, f64) {
        let owner = self.face(face).owner;
        let opposite = self.cell_faces(owner).iter().position(|&f| f == face).unwrap_or(0);
        in_kind!(self, D, N => {
            let (normal, measure) = self.geometry::<D, N>(owner).face_normal(opposite);
            (padded(&normal), measure)
        })
    }

    /// Whether all nodes of a face have the same coordinate in a direction, to the rounding of a mesh that was turned
    /// and moved.
    #[must_use]
    pub fn stands_across(&self, face: FaceId, direction: usize) -> bool {
        let places = self.face(face).nodes.iter().map(|&node| self.point(node)[direction]);
        let [low, high] = [f64::min, f64::max].map(|choose| places.clone().reduce(choose).unwrap_or(0.0));
        // Some operations on coordinates as large as the mesh or as its distance from the origin.
        high - low <= 16.0 * f64::EPSILON * (self.size + high.abs().max(low.abs()))
    }

    /// Faces that belong to one element only.
    pub fn boundary(&self) -> impl Iterator<Item = FaceId> + '_ {
        self.faces.sides.iter().enumerate().filter(|(_, side)| side.1.is_none()).map(|(i, _)| FaceId::new(i))
    }
}

fn rows<const D: usize>(groups: &FaceGroups<D>) -> FaceRows {
    groups.iter().map(|(name, faces)| (name.clone(), faces.as_flattened().to_vec())).collect()
}
