//! The outer edges of the bodies of a mesh, in the plane: a bar has the height 2.

use crate::ids::{FaceId, NodeId};
use crate::mesh::Mesh;
use crate::problem::symmetry::{SymmetryLine, common_lines, distinct};

/// A point or a vector of the plane.
pub(in crate::problem) type PlaneVector = [f64; 2];

/// An outer edge, or an end of a bar.
pub(in crate::problem) struct Edge {
    pub(in crate::problem) face: FaceId,
    pub(in crate::problem) nodes: Vec<NodeId>,
    /// Where it ends at the start (m).
    pub(in crate::problem) ends: [PlaneVector; 2],
    /// Outward unit normal.
    pub(in crate::problem) normal: PlaneVector,
    /// Whether neither a support nor a load is on it.
    pub(in crate::problem) free: bool,
}

/// A body.
pub(in crate::problem) struct Outline {
    pub(in crate::problem) name: String,
    pub(in crate::problem) edges: Vec<Edge>,
    /// Corners of its convex hull, counterclockwise.
    pub(in crate::problem) hull: Vec<PlaneVector>,
    /// The lines of symmetry that it meets.
    pub(in crate::problem) lines: Vec<SymmetryLine>,
    /// Velocity of the centre of mass at the start (m/s).
    pub(in crate::problem) velocity: PlaneVector,
    /// The largest distance of two of its points (m).
    pub(in crate::problem) size: f64,
    /// How long a wave takes from end to end (s).
    pub(in crate::problem) passage: f64,
}

impl Outline {
    /// The direction across which the lines of symmetry stand of which this body and another one are halves, if it is
    /// one alone.
    pub(in crate::problem) fn line_with(&self, other: &Self) -> Option<usize> {
        let (points, size) = (self.hull.iter().chain(&other.hull), self.size.max(other.size));
        let lines = common_lines([&self.lines, &other.lines], points, size);
        let across = lines.first()?.across;
        lines.iter().all(|line| line.across == across).then_some(across)
    }

    /// The place of a point after a time (s).
    pub(in crate::problem) fn moved(&self, point: &PlaneVector, time: f64) -> PlaneVector {
        std::array::from_fn(|c| point[c] + self.velocity[c] * time)
    }
}

/// What is known of the nodes: displacements at the start (m), velocities (m/s) and masses (kg).
pub(in crate::problem) struct Start<'a, const D: usize> {
    pub(in crate::problem) displacement: &'a [[f64; D]],
    pub(in crate::problem) velocity: &'a [[f64; D]],
    pub(in crate::problem) mass: &'a [f64],
}

/// The bodies of a mesh, with these names; `free` says whether an edge may touch, `wave_speed` is that at an edge
/// (m/s). `line_of` has the line of symmetry on which an edge is.
pub(in crate::problem) fn outlines<const D: usize>(
    mesh: &Mesh,
    names: Vec<String>,
    start: &Start<'_, D>,
    free: impl Fn(FaceId) -> bool,
    wave_speed: impl Fn(FaceId) -> f64,
    line_of: impl Fn(FaceId) -> Option<SymmetryLine>,
) -> Vec<Outline> {
    let body_of_node = mesh.part_numbers();
    let mut edges: Vec<Vec<Edge>> = names.iter().map(|_| Vec::new()).collect();
    let place = |node: NodeId| -> [f64; D] {
        std::array::from_fn(|c| mesh.points_in::<D>()[node.index()][c] + start.displacement[node.index()][c])
    };
    for face in mesh.boundary() {
        let nodes = mesh.face_nodes::<D>(face);
        let mut ends = [nodes[0], nodes[D - 1]].map(|node| in_plane(&place(node)));
        if D == 1 {
            (ends[0][1], ends[1][1]) = (-1.0, 1.0);
        }
        let normal = in_plane(&mesh.normal_in::<D>(face).0);
        let edge = Edge { face, nodes: nodes.to_vec(), ends, normal, free: free(face) };
        edges[body_of_node[nodes[0].index()]].push(edge);
    }
    let (mut mass, mut momentum) = (vec![0.0; names.len()], vec![[0.0; 2]; names.len()]);
    for (node, &body) in body_of_node.iter().enumerate() {
        let velocity = in_plane(&start.velocity[node]);
        mass[body] += start.mass[node];
        (0..2).for_each(|c| momentum[body][c] += start.mass[node] * velocity[c]);
    }
    let outline = |(body, (name, edges)): (usize, (String, Vec<Edge>))| {
        let hull = hull(edges.iter().flat_map(|edge| edge.ends).collect());
        let apart = |a: &PlaneVector| hull.iter().map(|b| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max);
        let size = hull.iter().map(apart).fold(0.0, f64::max);
        let slowest = edges.iter().map(|edge| wave_speed(edge.face)).fold(f64::INFINITY, f64::min);
        let velocity = momentum[body].map(|p| p / mass[body]);
        let lines = lines(&edges, &line_of);
        Outline { name, edges, hull, lines, velocity, size, passage: size / slowest }
    };
    names.into_iter().zip(edges).enumerate().map(outline).collect()
}

/// The lines of symmetry on which edges are.
fn lines(edges: &[Edge], line_of: impl Fn(FaceId) -> Option<SymmetryLine>) -> Vec<SymmetryLine> {
    let on_line = edges.iter().filter_map(|edge| Some((line_of(edge.face)?, edge.ends[0])));
    distinct(on_line.map(|(line, end)| SymmetryLine { place: end[line.across], ..line }))
}

fn in_plane<const D: usize>(vector: &[f64; D]) -> PlaneVector {
    [vector[0], vector.get(1).copied().unwrap_or(0.0)]
}

/// Corners that turn by a smaller sine lie on a straight side: far from the origin, coordinates are rounded more.
const STRAIGHT: f64 = 1e-9;

/// The corners of the convex hull of some points, counterclockwise.
fn hull(mut points: Vec<PlaneVector>) -> Vec<PlaneVector> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    let turns = |a: &PlaneVector, b: &PlaneVector, c: &PlaneVector| {
        let ([x, y], [v, w]) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        x * w - y * v > STRAIGHT * x.hypot(y) * v.hypot(w)
    };
    let half = |points: &mut dyn Iterator<Item = &PlaneVector>| {
        let mut chain: Vec<PlaneVector> = Vec::new();
        for point in points {
            while let [.., a, b] = chain.as_slice()
                && !turns(a, b, point)
            {
                chain.pop();
            }
            chain.push(*point);
        }
        chain.pop();
        chain
    };
    let mut corners = half(&mut points.iter());
    corners.extend(half(&mut points.iter().rev()));
    corners
}

#[cfg(test)]
mod tests {
    use super::hull;

    #[test]
    fn a_hull_has_the_corners_alone() {
        let points = vec![[1.0, 1.0], [0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [0.5, 0.5], [0.0, 1.0], [1.0, 0.25]];
        assert_eq!(hull(points), [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    }
}
