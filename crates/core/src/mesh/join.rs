//! Several bodies as one mesh, each in its place, and a body out of such a mesh.

use super::{ElementGroups, FaceRows, Mesh, MeshError};
use crate::border::{Vector, cut, padded};
use crate::ids::{ElementId, FaceId, NodeId};
use crate::message::{short, vector};
use std::collections::BTreeMap;

/// Nodes that are inside by less than this share of the larger body touch it: rounding of places.
const ROUNDING: f64 = 1e-12;

impl Mesh {
    /// The mesh of some bodies with their names: nodes and elements one body after the other. The elements of a body
    /// are the group of its name; the groups of its mesh become "body.group".
    ///
    /// # Errors
    /// Bodies that overlap, or too many elements.
    pub fn joined(bodies: &[(&str, &Self)]) -> Result<Self, MeshError> {
        let (mut points, mut cells) = (Vec::new(), Vec::new());
        let (mut face_groups, mut element_groups) = (FaceRows::new(), ElementGroups::new());
        let (mut first_node, mut first_element) = (0, 0);
        for (body, mesh) in bodies {
            points.extend_from_slice(mesh.points());
            cells.extend(mesh.cells.iter().map(|node| first_node + node.index()));
            for (group, nodes) in mesh.plain_face_groups() {
                face_groups.insert(format!("{body}.{group}"), nodes.into_iter().map(|n| first_node + n).collect());
            }
            for (group, elements) in mesh.plain_element_groups() {
                let elements = elements.into_iter().map(|element| first_element + element).collect();
                element_groups.insert(format!("{body}.{group}"), elements);
            }
            let all = (first_element..first_element + mesh.element_count()).collect();
            element_groups.insert((*body).to_string(), all);
            (first_node, first_element) = (first_node + mesh.node_count(), first_element + mesh.element_count());
        }
        let dimension = bodies.first().map_or(1, |(_, mesh)| mesh.dimension());
        let groups = (&face_groups, &element_groups);
        let made = Self::bodies_from_rows(dimension, &points, &cells, groups)?;
        let import_warnings = bodies.iter().flat_map(|(_, mesh)| mesh.import_warnings.iter().cloned()).collect();
        Ok(Self {
            reoriented: bodies.iter().map(|(_, mesh)| mesh.reoriented).sum(),
            ..made.with_import_warnings(import_warnings)
        })
    }

    /// The place of the body that overlaps an earlier one, and what to say of it, if that is why
    /// [`Mesh::joined`] refused these bodies.
    #[must_use]
    pub fn overlapping(bodies: &[(&str, &Self)], error: &MeshError) -> Option<(usize, String)> {
        let body_of = |mut at: usize| {
            bodies.iter().position(|(_, mesh)| {
                let here = at < mesh.element_count();
                at = at.wrapping_sub(mesh.element_count());
                here
            })
        };
        let MeshError::PartsTouch { elements: [first, second] } = *error else { return None };
        let (first, second) = (body_of(first)?, body_of(second)?);
        let message = format!(
            "overlaps \"{}\"{}; bodies may touch where they do not move against each other; else leave a gap between \
             them, of more than a quarter of their relative speed times the first step",
            bodies[first].0,
            Self::deepest(bodies, [second, first]).unwrap_or_default()
        );
        Some((second, message))
    }

    /// The deepest node of either of two bodies inside the other one.
    fn deepest(bodies: &[(&str, &Self)], pair: [usize; 2]) -> Option<String> {
        let [second, first] = pair;
        let tolerance = ROUNDING * bodies[first].1.size().max(bodies[second].1.size());
        let inside = [[second, first], [first, second]].into_iter().filter_map(|[own, other]| {
            bodies[own].1.deepest_in(bodies[other].1, tolerance).map(|inside| (own, other, inside))
        });
        let (own, other, inside) = inside.max_by(|a, b| a.2.depth.total_cmp(&b.2.depth))?;
        let surface = |body: usize, k: usize| {
            let group = bodies[body].1.groups_of(inside.faces[k]).next();
            group.map_or_else(|| format!("\"{}\"", bodies[body].0), |group| format!("\"{}.{group}\"", bodies[body].0))
        };
        let before: usize = bodies[..own].iter().map(|(_, mesh)| mesh.node_count()).sum();
        let (mesh, place) = (bodies[own].1, bodies[own].1.point(inside.node));
        Some(format!(
            ": node {} of {} at {} m is {} m inside, behind {}",
            before + inside.node.index(),
            surface(own, 0),
            vector(&place[..mesh.dimension()]),
            short(inside.depth),
            surface(other, 1)
        ))
    }

    /// The elements of a group as a mesh of their own, with the parts of all groups that lie in it; none if there is no
    /// such group.
    ///
    /// # Errors
    /// As [`Mesh::new`].
    pub fn part_of_group(&self, group: &str) -> Option<Result<Self, MeshError>> {
        let chosen = self.element_groups.get(group)?;
        let elements: BTreeMap<ElementId, usize> = chosen.iter().enumerate().map(|(new, &old)| (old, new)).collect();
        let mut nodes: BTreeMap<NodeId, usize> = chosen.iter().flat_map(|&e| self.cell(e)).map(|&n| (n, 0)).collect();
        nodes.values_mut().enumerate().for_each(|(new, number)| *number = new);
        let dimension = self.dimension();
        let points: Vec<f64> = nodes.keys().flat_map(|&node| self.point(node).into_iter().take(dimension)).collect();
        let cells: Vec<_> = chosen.iter().flat_map(|&e| self.cell(e)).map(|node| nodes[node]).collect();
        let of_chosen = |face: &&FaceId| {
            let face = self.face(**face);
            elements.contains_key(&face.owner) || face.neighbour.is_some_and(|e| elements.contains_key(&e))
        };
        let along = |&face: &FaceId| self.face(face).nodes.iter().map(|node| nodes[node]);
        let faces = self
            .face_groups
            .iter()
            .map(|(name, all)| (name.clone(), all.iter().filter(of_chosen).flat_map(along).collect::<Vec<_>>()));
        let inside = self
            .element_groups
            .iter()
            .map(|(name, all)| (name.clone(), all.iter().filter_map(|e| elements.get(e).copied()).collect::<Vec<_>>()));
        let (faces, inside) = (faces.filter(|(_, all)| !all.is_empty()), inside.filter(|(_, all)| !all.is_empty()));
        let groups: (FaceRows, ElementGroups) = (faces.collect(), inside.collect());
        let made = Self::bodies_from_rows(dimension, &points, &cells, (&groups.0, &groups.1));
        Some(made.map(|mesh| mesh.with_import_warnings(self.import_warnings.clone())))
    }

    /// The mesh with its points mapped: moved, or turned.
    ///
    /// # Errors
    /// As [`Mesh::new`]: points that fall together or are not finite.
    pub fn mapped<const D: usize>(&self, map: impl Fn(&[f64; D]) -> [f64; D]) -> Result<Self, MeshError> {
        let (dimension, cells) = (self.dimension(), self.cells.iter().map(|node| node.index()).collect::<Vec<_>>());
        let points: Vec<f64> =
            self.places().flat_map(|place| padded(&map(&cut(&place))).into_iter().take(dimension)).collect();
        let groups = (&self.plain_face_groups(), &self.plain_element_groups());
        let made = Self::bodies_from_rows(dimension, &points, &cells, groups)?;
        Ok(Self { reoriented: self.reoriented, ..made.with_import_warnings(self.import_warnings.clone()) })
    }

    /// The mesh with its origin in another place (m), turned about it by an angle (degrees, counterclockwise); a bar is
    /// not turned.
    ///
    /// # Errors
    /// As [`Mesh::mapped`].
    pub fn placed<const D: usize>(&self, origin: &[f64; D], degrees: f64) -> Result<Self, MeshError> {
        // A body that is not turned keeps the bits of its mesh.
        let (sin, cos) = degrees.to_radians().sin_cos();
        let (turns, origin) = (self.dimension() > 1, padded(origin));
        self.mapped(|&[x, y, z]: &Vector| {
            let turned = if turns { [cos * x - sin * y, sin * x + cos * y, z] } else { [x, y, z] };
            std::array::from_fn(|c| origin[c] + turned[c])
        })
    }

    fn plain_face_groups(&self) -> FaceRows {
        let nodes = |&face: &FaceId| self.face(face).nodes.iter().map(|node| node.index());
        let groups = self.face_groups().iter();
        groups.map(|(name, faces)| (name.clone(), faces.iter().flat_map(nodes).collect())).collect()
    }

    fn plain_element_groups(&self) -> ElementGroups {
        let groups = self.element_groups().iter();
        groups.map(|(name, group)| (name.clone(), group.iter().copied().map(ElementId::index).collect())).collect()
    }
}
