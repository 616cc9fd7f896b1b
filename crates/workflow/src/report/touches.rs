//! How a body touches its planes, from the outline of the mesh and from the contact results.

use percute_core::contact::CORNER;
use percute_core::contact_results::ContactResults;
use percute_core::ids::{ElementId, NodeId};
use percute_core::material::Elastic;
use percute_core::problem::AnyProblem;
use serde::Serialize;
use std::f64::consts::PI;

/// Sine of the largest angle between a plane and an edge that counts as parallel to it: coordinates with six digits.
const PARALLEL: f64 = 1e-5;
/// Gaps that differ by less than this part of the size of the mesh are equal.
const EQUAL: f64 = 1e-9;
/// An edge that ends at a larger angle inside the body (rad) has an inclined side beside it, or a side that goes
/// straight on: the stress is singular there. The evidence has angles of 90° and of 117° and more.
const OBTUSE: f64 = 100.0 * PI / 180.0;
/// A node of a solid with less than this part of the half of all directions is a corner. A ball of four elements across
/// has 0.9, an edge of a box 0.5.
const SHARP: f64 = 0.75;

/// How the body touches first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Touches {
    /// With faces of a solid that are parallel to the plane.
    Face,
    /// Along an edge of the outline that is parallel to the plane. A bar touches so.
    Edge,
    /// Along such an edge, at an end of which the outline turns by less than 80°: beside an inclined side, or within a
    /// straight one.
    End,
    /// With a curve: the outline turns little by little.
    Curve,
    /// With a corner.
    Corner,
    /// Not at all.
    None,
}

/// How the body touches, and the mesh there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FirstContact {
    pub(super) touches: Touches,
    /// Number of separate parts of the surface that touch in the course of time.
    pub(super) zones: usize,
    /// Whether a single element fills an obtuse corner at which contact begins or ends.
    pub(super) single_element: bool,
    /// Whether a corner or a curve of a master strikes a straighter part of a slave, along which it slides.
    pub(super) strikes_flat_slave: bool,
}

impl FirstContact {
    pub(super) fn new(problem: &AnyProblem, results: &ContactResults) -> Self {
        let surface = Surface::new(problem, results);
        let Some(start) = surface.start() else {
            return Self { touches: Touches::None, zones: 0, single_element: false, strikes_flat_slave: false };
        };
        let (touches, places) = surface.situation(&start);
        let single =
            |&at: &usize| !surface.on_line[at] && surface.turn(at) < PI - OBTUSE && surface.elements(at).len() == 1;
        let single_element = problem.dimension() > 1 && places.iter().any(single);
        let strikes = matches!(touches, Touches::Corner | Touches::Curve);
        let strikes_flat_slave = strikes && surface.striking(&start).is_some_and(|(_, is_master)| is_master);
        Self { touches, zones: surface.zones(), single_element, strikes_flat_slave }
    }
}

/// When each node of the surface touches first (s). A reaction brings a node to its plane at the next instant: if it
/// acts at the last instant only, no node touches yet, and contact begins with the force.
pub(super) fn first_contacts(results: &ContactResults) -> Vec<Option<f64>> {
    let touches = results.summary.iter().any(|summary| summary.first_touch.is_some());
    let first = results.summary.iter().map(|summary| if touches { summary.first_touch } else { summary.time_of_peak });
    first.collect()
}

/// The contact surface with the first touch of its nodes.
pub(super) struct Surface<'a> {
    problem: &'a AnyProblem,
    first_touch: Vec<Option<f64>>,
    /// The nodes beside each node on the surface.
    beside: Vec<Vec<usize>>,
    /// Gaps at the start of the run (m).
    gap: Vec<f64>,
    /// Whether each node is on a line of symmetry: the other half of the body is beyond it.
    on_line: Vec<bool>,
}

impl<'a> Surface<'a> {
    pub(super) fn new(problem: &'a AnyProblem, results: &ContactResults) -> Self {
        let first_touch = first_contacts(results);
        let mut beside = vec![Vec::new(); first_touch.len()];
        for face in problem.contact_faces() {
            for &a in face.nodes {
                beside[a].extend(face.nodes.iter().filter(|&&b| b != a));
            }
        }
        let gap = problem.starts_of_contact().into_iter().map(|(gap, _)| gap).collect();
        Self { problem, first_touch, beside, gap, on_line: problem.on_lines_of_symmetry() }
    }

    /// The nodes that touch first.
    fn start(&self) -> Option<Vec<usize>> {
        let first = self.first_touch.iter().flatten().copied().min_by(f64::total_cmp)?;
        Some((0..self.first_touch.len()).filter(|&at| self.first_touch[at] == Some(first)).collect())
    }

    /// How these nodes touch, and the nodes that decide it.
    fn situation(&self, start: &[usize]) -> (Touches, Vec<usize>) {
        if self.problem.dimension() == 1 {
            return (Touches::Edge, start.to_vec());
        }
        let zone = self.flat_zone(start);
        if self.problem.dimension() == 3 {
            return (self.of_solid(&zone, start), Vec::new());
        }
        if !self.is_along(&zone, start) {
            let turns = match self.striking(start) {
                Some((at, _)) => self.turn(at) > CORNER,
                None => start.iter().any(|&at| self.turn(at) > CORNER),
            };
            return (if turns { Touches::Corner } else { Touches::Curve }, start.to_vec());
        }
        let inside = |at: usize| self.on_line[at] || self.beside[at].iter().filter(|&&other| zone[other]).count() > 1;
        let ends: Vec<_> = (0..zone.len()).filter(|&at| zone[at] && !inside(at)).collect();
        let goes_on = |&at: &usize| {
            let touched = self.beside[at].iter().any(|&next| !zone[next] && self.first_touch[next].is_some());
            touched && self.turn(at) <= CORNER
        };
        let touches = match () {
            () if ends.iter().any(goes_on) => Touches::Curve,
            () if ends.iter().any(|&at| self.turn(at) < PI - OBTUSE) => Touches::End,
            () => Touches::Edge,
        };
        (touches, ends)
    }

    /// How the nodes of a solid touch that are first, with the zone around them that is parallel to the plane.
    fn of_solid(&self, zone: &[bool], start: &[usize]) -> Touches {
        let solid_angle = |at: usize| -> f64 {
            let node = self.node(at);
            self.elements(at).iter().map(|&element| self.problem.mesh().angle(element, node)).sum()
        };
        let mirrored = |at: usize| if self.on_line[at] { 2.0 } else { 1.0 };
        match () {
            () if self.problem.contact_faces().iter().any(|face| face.nodes.iter().all(|&at| zone[at])) => {
                Touches::Face
            }
            () if start.iter().any(|&at| zone[at]) => Touches::Edge,
            () if start.iter().any(|&at| mirrored(at) * solid_angle(at) < SHARP * 2.0 * PI) => Touches::Corner,
            () => Touches::Curve,
        }
    }

    /// Whether contact begins along an edge of this zone: of a non-matching interface, along edges of both.
    fn is_along(&self, zone: &[bool], start: &[usize]) -> bool {
        let (slaves, masters) = self.sides(start);
        let along = |nodes: &[usize]| nodes.iter().any(|&at| zone[at]);
        if slaves.is_empty() && masters.is_empty() { along(start) } else { along(&slaves) && along(&masters) }
    }

    /// Whether each node is on an edge that is parallel to the plane and joined with the start by such edges.
    fn flat_zone(&self, start: &[usize]) -> Vec<bool> {
        let (mut zone, mut next) = (vec![false; self.beside.len()], start.to_vec());
        while let Some(at) = next.pop() {
            for &other in self.beside[at].iter().filter(|&&other| self.parallel(at, other)) {
                zone[at] = true;
                if !std::mem::replace(&mut zone[other], true) {
                    next.push(other);
                }
            }
        }
        zone
    }

    /// Whether the edge between two nodes is parallel to the plane at the start of the run.
    fn parallel(&self, a: usize, b: usize) -> bool {
        let at = |at: usize| self.problem.contact_point(at);
        let length = (0..3).map(|c| (at(a)[c] - at(b)[c]).powi(2)).sum::<f64>().sqrt();
        let apart = if self.gap[a].is_finite() && self.gap[b].is_finite() {
            self.gap[a] - self.gap[b]
        } else {
            // Beside a surface along which it slides: along the common tangent.
            let frame = self.problem.frame(a);
            frame.split(&std::array::from_fn(|c| at(a)[c] - at(b)[c])).0
        };
        apart.abs() <= PARALLEL * length
    }

    /// The node that touches an obstacle first.
    pub(super) fn first_of(&self, obstacle: usize) -> Option<usize> {
        let nodes = self.problem.contact_nodes();
        let touched = (0..nodes.len()).filter(|&at| nodes[at].obstacle == obstacle);
        let touched = touched.filter_map(|at| Some((self.first_touch[at]?, at)));
        touched.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, at)| at)
    }

    /// The mean length of the edges at a node (m) and the material there.
    pub(super) fn edges(&self, at: usize) -> Option<(f64, &Elastic)> {
        let mesh = self.problem.mesh();
        let faces = self.problem.contact_faces().into_iter().filter(|face| face.nodes.contains(&at));
        let lengths: Vec<f64> = faces.map(|face| mesh.face_normal(face.face).1).collect();
        let element = *self.elements(at).first()?;
        let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
        (!lengths.is_empty()).then(|| (mean, self.problem.material(element)))
    }

    /// The nodes that touch at a corner of the outline.
    pub(super) fn touched_corners(&self) -> impl Iterator<Item = NodeId> {
        let touched = (0..self.first_touch.len()).filter(|&at| self.first_touch[at].is_some());
        touched.filter(|&at| self.turn(at) > CORNER).map(|at| self.node(at))
    }

    fn node(&self, at: usize) -> NodeId {
        self.problem.contact_nodes()[at].node
    }

    fn elements(&self, at: usize) -> &[ElementId] {
        self.problem.mesh().elements_around(self.node(at))
    }

    /// By how much the outline turns at a node (rad): π less the angle inside the body.
    pub(super) fn turn(&self, at: usize) -> f64 {
        let angles = self.elements(at).iter().map(|&element| self.problem.mesh().angle(element, self.node(at)));
        PI - angles.sum::<f64>() * if self.on_line[at] { 2.0 } else { 1.0 }
    }

    /// Of nodes on non-matching interfaces, the one that strikes the other surface, and whether it is of the master:
    /// there it is not farther than the mean gap of the slave, and the outline turns more. Nodes far from contact share
    /// the force, too.
    fn striking(&self, nodes: &[usize]) -> Option<(usize, bool)> {
        let (slaves, masters) = self.sides(nodes);
        let least = |nodes: Vec<usize>| nodes.into_iter().min_by(|&a, &b| self.gap[a].total_cmp(&self.gap[b]));
        let slave = least(slaves)?;
        let strikes = |&at: &usize| {
            let near = self.gap[at] <= self.gap[slave] + EQUAL * self.problem.mesh().size();
            near && self.turn(at) > self.turn(slave) + PARALLEL
        };
        Some(least(masters).filter(strikes).map_or((slave, false), |at| (at, true)))
    }

    /// The nodes among these of slaves, and those of masters, of non-matching interfaces.
    fn sides(&self, nodes: &[usize]) -> (Vec<usize>, Vec<usize>) {
        let non_matching = nodes.iter().copied().filter(|&at| self.problem.non_matching_of(at).is_some());
        non_matching.partition(|&at| self.problem.is_slave(at))
    }

    /// The parts of the surface that touch, each joined by edges.
    fn zones(&self) -> usize {
        // Of two surfaces that touch, the first one counts.
        let counts = |(at, touch): (usize, &Option<f64>)| touch.is_none() || !self.problem.leads(at);
        let mut seen: Vec<bool> = self.first_touch.iter().enumerate().map(counts).collect();
        let mut zones = 0;
        for at in 0..seen.len() {
            let mut next = vec![at];
            zones += usize::from(!seen[at]);
            while let Some(at) = next.pop() {
                if !std::mem::replace(&mut seen[at], true) {
                    next.extend(&self.beside[at]);
                }
            }
        }
        zones
    }
}
