//! Bodies that enter each other where no contact is solved for: an error, never silence.

use super::SimulationError;
use crate::history::{SinkError, State, StateSink};
use crate::ids::{FaceId, NodeId};
use crate::problem::Problem;
use crate::problem::symmetry::{self, SymmetryLine, common_lines, distinct};
use std::collections::{BTreeMap, BTreeSet};

/// Bodies are looked at after so many steps. A wave passes an element in a step, and bodies move at a small part of its
/// speed: at a hundredth by less than the depth that is allowed.
const EVERY: usize = 8;
/// How deep a node may be in another body, over the height of the element there.
const DEEP: f64 = 0.1;
/// Of halves of a symmetric model, a node on their line is looked at beside it, in the body, by this part of the height
/// of its element.
const BESIDE: f64 = 1e-3;

/// A point of the plane; a bar is on the first axis.
type Point = [f64; 2];

/// Looks for nodes inside other bodies.
pub(super) struct MissedContact<'p, const D: usize> {
    problem: &'p Problem<D>,
    last: usize,
    bodies: Vec<Body>,
    /// For each two bodies, the lines of symmetry of which they are halves.
    halves: BTreeMap<[usize; 2], Vec<SymmetryLine>>,
    /// Nodes that may touch another body, with that body: contact is solved for. With the place in the contact surface,
    /// where it is only while the node faces the other surface.
    solved: BTreeMap<(NodeId, usize), Option<usize>>,
}

/// The boundary of a body.
#[derive(Default)]
struct Body {
    /// Nodes, each with the way from a line of symmetry into the body (m), if it is on one.
    nodes: BTreeMap<NodeId, Point>,
    faces: Vec<BoundaryFace>,
}

/// A face of a boundary.
struct BoundaryFace {
    face: FaceId,
    /// The height of its element there (m).
    height: f64,
    /// The line of symmetry on which it is.
    line: Option<SymmetryLine>,
}

impl<'p, const D: usize> MissedContact<'p, D> {
    /// For a run with so many steps; it costs nothing with a single body.
    pub(super) fn new(problem: &'p Problem<D>, steps: usize) -> Self {
        let mesh = problem.mesh();
        let mut made =
            Self { problem, last: steps, bodies: Vec::new(), halves: BTreeMap::new(), solved: BTreeMap::new() };
        if mesh.parts() == 1 {
            return made;
        }
        let of_node = mesh.part_numbers();
        let node_lines = problem.node_lines();
        made.bodies = (0..mesh.parts()).map(|_| Body::default()).collect();
        for face in mesh.boundary() {
            let (nodes, owner) = (mesh.face_nodes::<D>(face), mesh.face(face).owner);
            let (normal, area) = mesh.normal_in::<D>(face);
            let height = D as f64 * mesh.volume(owner) / area;
            let line = symmetry::line_of(mesh, &problem.supported(face), &node_lines, face);
            let body = &mut made.bodies[of_node[nodes[0].index()]];
            body.faces.push(BoundaryFace { face, height, line });
            for node in nodes {
                let way = body.nodes.entry(node).or_default();
                line.iter().for_each(|line| way[line.across] = -BESIDE * height * normal[line.across]);
            }
        }
        let lines = made.bodies.iter().map(|body| distinct(body.faces.iter().filter_map(|side| side.line)));
        let lines: Vec<Vec<SymmetryLine>> = lines.collect();
        for (a, own) in made.bodies.iter().enumerate() {
            for (b, other) in made.bodies.iter().enumerate().filter(|(b, _)| *b != a) {
                let points =
                    own.nodes.keys().chain(other.nodes.keys()).map(|node| &mesh.points_in::<D>()[node.index()]);
                made.halves.insert([a, b], common_lines([&lines[a], &lines[b]], points, mesh.size()));
            }
        }
        let mut bodies = vec![BTreeSet::new(); problem.obstacles().len()];
        for contact in problem.surface().nodes() {
            bodies[contact.obstacle].insert(of_node[contact.node.index()]);
        }
        for (at, contact) in problem.surface().nodes().iter().enumerate() {
            let slides = problem.surface().non_matching_of(at).map(|_| at);
            let others = problem.partner_obstacle(contact.obstacle).into_iter().flat_map(|other| &bodies[other]);
            made.solved.extend(others.map(|&body| ((contact.node, body), slides)));
        }
        made
    }

    fn place(&self, displacement: &[[f64; D]], node: NodeId) -> Point {
        let (x, u) = (&self.problem.mesh().points_in::<D>()[node.index()], &displacement[node.index()]);
        std::array::from_fn(|c| if c < D { x[c] + u[c] } else { 0.0 })
    }

    /// The ends of a face; one of a bar stands across it.
    fn ends(&self, displacement: &[[f64; D]], face: FaceId) -> [Point; 2] {
        let nodes = self.problem.mesh().face_nodes::<D>(face);
        let [mut a, mut b] = [nodes[0], nodes[D - 1]].map(|node| self.place(displacement, node));
        if D == 1 {
            (a[1], b[1]) = (-1.0, 1.0);
        }
        [a, b]
    }

    /// Lower and upper ends of a body along each axis (m).
    fn limits(&self, displacement: &[[f64; D]], body: &Body) -> [[f64; 2]; 2] {
        let mut limits = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for node in body.nodes.keys() {
            let place = self.place(displacement, *node);
            limits.iter_mut().zip(place).for_each(|([low, high], x)| (*low, *high) = (low.min(x), high.max(x)));
        }
        limits
    }

    /// How deep a point is in a body (m), if it is deeper than allowed. Faces on lines of symmetry of both bodies do
    /// not count: the other half of the body is beyond.
    fn depth(&self, displacement: &[[f64; D]], body: &Body, point: &Point, common: &[SymmetryLine]) -> Option<f64> {
        let (mut inside, mut nearest) = (false, (f64::INFINITY, 0.0));
        let size = self.problem.mesh().size();
        for &BoundaryFace { face, height, line } in &body.faces {
            let [a, b] = self.ends(displacement, face);
            // How often a line to the right crosses the boundary.
            if (a[1] > point[1]) != (b[1] > point[1]) {
                let x = a[0] + (b[0] - a[0]) * (point[1] - a[1]) / (b[1] - a[1]);
                inside ^= x > point[0];
            }
            let distance = distance(point, &a, &b);
            let is_cut = line.is_some_and(|line| common.iter().any(|common| line.is_at(common, size)));
            if distance < nearest.0 && !is_cut {
                nearest = (distance, height);
            }
        }
        (inside && nearest.0 > DEEP * nearest.1).then_some(nearest.0)
    }

    /// The first node that is in another body, the number of its own body and of that one, and how deep it is (m).
    fn found(&self, displacement: &[[f64; D]]) -> Option<(NodeId, [usize; 2], f64)> {
        let (points, size) = (self.problem.mesh().points_in::<D>(), self.problem.mesh().size());
        let limits: Vec<_> = self.bodies.iter().map(|body| self.limits(displacement, body)).collect();
        let configuration = self.problem.surface().configuration(displacement);
        let is_solved = |node: NodeId, body: usize| match self.solved.get(&(node, body)) {
            Some(Some(at)) => configuration.gap(*at, displacement).is_finite(),
            other => other.is_some(),
        };
        for (a, own) in self.bodies.iter().enumerate() {
            for (b, other) in self.bodies.iter().enumerate().filter(|(b, _)| *b != a) {
                let apart = (0..D).any(|c| limits[a][c][1] <= limits[b][c][0] || limits[b][c][1] <= limits[a][c][0]);
                if apart {
                    continue;
                }
                let lines = self.halves.get(&[a, b]).map_or(&[][..], Vec::as_slice);
                for (&node, way) in own.nodes.iter().filter(|(node, _)| !is_solved(**node, b)) {
                    let mut place = self.place(displacement, node);
                    let is_on = |line: &SymmetryLine| line.beyond(&points[node.index()], size) == 0.0;
                    for across in (0..D).filter(|&c| lines.iter().any(|line| line.across == c && is_on(line))) {
                        place[across] += way[across];
                    }
                    let near = (0..D).all(|c| limits[b][c][0] < place[c] && place[c] < limits[b][c][1]);
                    if near && let Some(depth) = self.depth(displacement, other, &place, lines) {
                        return Some((node, [a, b], depth));
                    }
                }
            }
        }
        None
    }
}

/// The distance of a point from a straight line between two others (m).
fn distance(point: &Point, a: &Point, b: &Point) -> f64 {
    let (along, from) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
    let length = along[0] * along[0] + along[1] * along[1];
    let part = ((from[0] * along[0] + from[1] * along[1]) / length).clamp(0.0, 1.0);
    (from[0] - part * along[0]).hypot(from[1] - part * along[1])
}

impl<const D: usize> StateSink for MissedContact<'_, D> {
    fn accept(&mut self, state: &State<'_>) -> Result<(), SinkError> {
        let step = state.step();
        if self.bodies.is_empty() || !(step.index.is_multiple_of(EVERY) || step.index == self.last) {
            return Ok(());
        }
        let Some((node, bodies, depth)) = self.found(step.displacement()) else { return Ok(()) };
        let names = self.problem.mesh().part_names();
        let bodies = bodies.map(|body| names[body].clone());
        let error = SimulationError::Missed { step: step.index, time: step.time, node: node.index(), bodies, depth };
        Err(Box::new(error))
    }
}
