//! The deformed outline of plane bodies: the rigid motion of each as it is, their deformation by a factor that shows
//! it.

use crate::body::Body;
use crate::document::{Document, numbers};
use crate::scale::quantity;
use percute_workflow::message::trimmed;
use std::collections::BTreeMap;

/// A deformation of this part of the body is visible as it is.
const VISIBLE: f64 = 0.01;
/// A smaller one is drawn at most this large.
const SHOWN: f64 = 0.04;
/// A deformation below this part is rounding.
const ROUNDING: f64 = 1e-12;
/// If a body has moved farther than this part of the size of all, all are drawn where they were.
const FAR: f64 = 0.5;

/// The outline of the bodies at the end of an estimate.
#[derive(Clone, Debug, PartialEq)]
pub struct Deformed {
    /// Closed lines (m), each with its first point at the end again.
    pub lines: Vec<Vec<[f64; 2]>>,
    /// What they are: the instant and the factor.
    pub label: String,
}

/// The place of a point before and after.
type Moved = ([f64; 2], [f64; 2]);

/// A motion without deformation: about a centre to another place, with a turn.
struct Rigid {
    from: [f64; 2],
    to: [f64; 2],
    /// Cosine and sine.
    turn: [f64; 2],
}

impl Rigid {
    /// The one that is nearest to the motion of some points, by least squares.
    fn nearest(points: &[Moved]) -> Self {
        let count = points.len() as f64;
        let mean =
            |pick: fn(&Moved) -> [f64; 2]| [0, 1].map(|c| points.iter().map(|pair| pick(pair)[c]).sum::<f64>() / count);
        let (from, to) = (mean(|pair| pair.0), mean(|pair| pair.1));
        let (mut along, mut across) = (0.0, 0.0);
        for (p, q) in points {
            let (a, b) = ([0, 1].map(|c| p[c] - from[c]), [0, 1].map(|c| q[c] - to[c]));
            along += a[0] * b[0] + a[1] * b[1];
            across += a[0] * b[1] - a[1] * b[0];
        }
        let length = along.hypot(across);
        let turn = if length > 0.0 { [along / length, across / length] } else { [1.0, 0.0] };
        Self { from, to, turn }
    }

    /// The one that supports leave to a body. Fixed nodes have not moved at all: if several have not moved along an
    /// axis, the body neither turns nor moves along it.
    fn left_by_supports(points: &[Moved]) -> Self {
        let mut motion = Self::nearest(points);
        for axis in [0, 1] {
            if points.iter().filter(|(p, q)| p[axis] == q[axis]).count() > 1 {
                motion.to[axis] = motion.from[axis];
                motion.turn = [1.0, 0.0];
            }
        }
        motion
    }

    fn place(&self, point: [f64; 2]) -> [f64; 2] {
        let ([x, y], [c, s]) = ([0, 1].map(|c| point[c] - self.from[c]), self.turn);
        [self.to[0] + c * x - s * y, self.to[1] + s * x + c * y]
    }
}

impl Deformed {
    /// That of a document; none of a bar, or without displacements that fit the mesh.
    #[must_use]
    pub fn new(body: &Body, document: &Document) -> Option<Self> {
        let (nodes, rows) = (document.list("outline.node"), document.list("outline.displacement"));
        let moved = |(node, row): (&serde_json::Value, &serde_json::Value)| {
            let point = *body.points.get(usize::try_from(node.as_u64()?).ok()?)?;
            let &[u, v] = numbers(row).as_slice() else { return None };
            let to = [point[0] + u, point[1] + v];
            to.iter().all(|x| x.is_finite()).then_some((point, to))
        };
        let points: Vec<_> = nodes.iter().zip(rows).map(moved).collect::<Option<_>>()?;
        let nodes = nodes.iter().map(|node| usize::try_from(node.as_u64()?).ok()).collect::<Option<Vec<_>>>()?;
        let mut bodies: BTreeMap<usize, Vec<Moved>> = BTreeMap::new();
        nodes.iter().zip(&points).for_each(|(&node, &moved)| bodies.entry(body.part[node]).or_default().push(moved));
        let motions: BTreeMap<usize, Rigid> =
            bodies.into_iter().map(|(part, points)| (part, Rigid::left_by_supports(&points))).collect();
        let motion = |node: usize| &motions[&body.part[node]];
        let mut at = BTreeMap::new();
        let [low, high] = body.bounds();
        let size = (high[0] - low[0]).max(high[1] - low[1]);
        let distance = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        let all = || nodes.iter().zip(&points).map(|(&node, &(p, q))| (p, q, motion(node).place(p)));
        let factor = factor(all().map(|(_, q, rigid)| distance(q, rigid)).fold(0.0, f64::max) / size);
        let far = all().any(|(p, _, rigid)| distance(p, rigid) > FAR * size);
        for ((p, q), &node) in points.iter().zip(&nodes) {
            let motion = motion(node);
            let rigid = motion.place(*p);
            let [x, y] = [0, 1].map(|c| q[c] - rigid[c]);
            // Deformation is turned back with the body.
            let [cos, sin] = if far { motion.turn } else { [1.0, 0.0] };
            let start = if far { *p } else { rigid };
            let place = [start[0] + factor * (cos * x + sin * y), start[1] + factor * (cos * y - sin * x)];
            at.insert(node, place);
        }
        let line = |nodes: Vec<usize>| nodes.iter().map(|node| at.get(node).copied()).collect::<Option<Vec<_>>>();
        let lines = body.outline().into_iter().map(line).collect::<Option<Vec<_>>>()?;
        let time = quantity(document.number("outline.time")?, "s", 4);
        let back = if far { ", moved back" } else { "" };
        let label = format!("outline at {time}, deformation × {}{back}", trimmed(factor, 4));
        (!lines.is_empty()).then_some(Self { lines, label })
    }

    /// All points (m).
    pub(crate) fn points(&self) -> impl Iterator<Item = [f64; 2]> {
        self.lines.iter().flatten().copied()
    }
}

/// A round factor for a deformation that is a part of the body; 1 if it is visible.
fn factor(part: f64) -> f64 {
    if part >= VISIBLE || part <= ROUNDING {
        return 1.0;
    }
    let most = SHOWN / part;
    let power = 10.0_f64.powf(most.log10().floor());
    [5.0, 2.0].into_iter().map(|digit| digit * power).find(|round| *round <= most).unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::mesh::Mesh;

    /// A square of four triangles around a centre.
    fn square() -> Body {
        let points = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.5]];
        let cells = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
        Body::new(&Mesh::new(points, &cells, &Default::default(), &Default::default()).unwrap())
    }

    /// The outline where the corners have moved by a map.
    fn moved(place: impl Fn([f64; 2]) -> [f64; 2]) -> Deformed {
        let body = square();
        let row = |node: usize| {
            let (p, q) = (body.points[node], place(body.points[node]));
            format!("[{:?}, {:?}]", q[0] - p[0], q[1] - p[1])
        };
        let rows = (0..4).map(row).collect::<Vec<_>>().join(", ");
        let outline = format!(r#"{{"time": 1.3e-5, "node": [0, 1, 2, 3], "displacement": [{rows}]}}"#);
        let text = format!(r#"{{"error": {{"sup": 1}}, "outline": {outline}}}"#);
        Deformed::new(&body, &Document::parse(&text).unwrap()).unwrap()
    }

    fn near(line: &[[f64; 2]], wanted: &[[f64; 2]]) -> bool {
        line.len() == wanted.len()
            && line.iter().zip(wanted).all(|(a, b)| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-9)
    }

    #[test]
    fn rigid_motion_stays_as_it_is() {
        let (sin, cos) = 0.3_f64.sin_cos();
        let turned = moved(|[x, y]| [cos * x - sin * y + 0.1, sin * x + cos * y - 0.2]);
        let wanted = [[0.1, -0.2], [0.1 + cos, sin - 0.2], [0.1 + cos - sin, sin + cos - 0.2], [0.1 - sin, cos - 0.2]];
        assert!(near(&turned.lines[0][..4], &wanted), "{turned:?}");
        assert_eq!((turned.lines[0][0], turned.lines.len()), (turned.lines[0][4], 1));
        assert_eq!(turned.label, "outline at 13 µs, deformation × 1");
    }

    #[test]
    fn a_small_deformation_is_enlarged_and_a_large_one_is_not() {
        // Widened by 2e-4: each corner moves by 1e-4, of which 4 % is a factor of 400; 200 is the next round one.
        let wide = moved(|[x, y]| [x + 2e-4 * (x - 0.5), y]);
        assert!(near(&wide.lines[0][..2], &[[-0.02, 0.0], [1.02, 0.0]]), "{wide:?}");
        assert!(wide.label.ends_with("deformation × 200"), "{}", wide.label);
        assert!(moved(|[x, y]| [1.1 * x, y]).label.ends_with("deformation × 1"));
        assert_eq!([0.02, 1e-3, 0.008, 1e-14, 0.0].map(factor), [1.0, 20.0, 5.0, 1.0, 1.0]);
    }

    /// Fixed below and sheared: a motion of its own would lift the fixed corners from their places.
    #[test]
    fn a_body_that_supports_hold_does_not_float() {
        let sheared = moved(|[x, y]| [x + 1e-3 * y, y]);
        // The upper corners move by 1e-3, of which 4 % is a factor of 40; 20 is the next round one.
        let wanted = [[0.0, 0.0], [1.0, 0.0], [1.02, 1.0], [0.02, 1.0]];
        assert!(near(&sheared.lines[0][..4], &wanted), "{sheared:?}");
        assert!(sheared.label.ends_with("deformation × 20"), "{}", sheared.label);
        // Rollers below leave the motion along x.
        let rolled = moved(|[x, y]| [x + 0.1, y * (1.0 + 1e-3)]);
        assert!(near(&rolled.lines[0][..4], &[[0.1, 0.0], [1.1, 0.0], [1.1, 1.02], [0.1, 1.02]]), "{rolled:?}");
    }

    #[test]
    fn a_body_that_is_far_away_is_drawn_where_it_was() {
        let far = moved(|[x, y]| [-1.2 * y + 5.0, x + 1.0]);
        // Turned by a right angle and stretched along x, which was y.
        assert!(near(&far.lines[0][..4], &[[0.0, -0.1], [1.0, -0.1], [1.0, 1.1], [0.0, 1.1]]), "{far:?}");
        assert!(far.label.ends_with("deformation × 1, moved back"), "{}", far.label);
    }

    /// Two squares of a mesh, of which each turns by itself about its centre: no part of it is deformation.
    #[test]
    fn each_body_has_a_rigid_motion_of_its_own() {
        let square = Mesh::rectangle(1.0, 1.0, 1, 1).unwrap();
        let beside = square.mapped(|[x, y]| [x + 1.5, *y]).unwrap();
        let body = Body::new(&Mesh::joined(&[("a", &square), ("b", &beside)]).unwrap());
        let turned = |node: usize| {
            let [x, y] = body.points[node];
            let centre = if node < 4 { [0.5, 0.5] } else { [2.0, 0.5] };
            let (sin, cos) = (if node < 4 { 0.1_f64 } else { -0.1 }).sin_cos();
            let (a, b) = (x - centre[0], y - centre[1]);
            [centre[0] + cos * a - sin * b, centre[1] + sin * a + cos * b]
        };
        let row = |node: usize| {
            format!("[{:?}, {:?}]", turned(node)[0] - body.points[node][0], turned(node)[1] - body.points[node][1])
        };
        let rows = (0..8).map(row).collect::<Vec<_>>().join(", ");
        let outline = format!(r#"{{"time": 1.0, "node": [0, 1, 2, 3, 4, 5, 6, 7], "displacement": [{rows}]}}"#);
        let text = format!(r#"{{"error": {{"sup": 1}}, "outline": {outline}}}"#);
        let deformed = Deformed::new(&body, &Document::parse(&text).unwrap()).unwrap();
        assert!(deformed.label.ends_with("deformation × 1"), "{}", deformed.label);
        let outline = body.outline();
        assert_eq!(outline.len(), 2);
        for (line, nodes) in deformed.lines.iter().zip(outline) {
            assert!(near(line, &nodes.into_iter().map(turned).collect::<Vec<_>>()), "{line:?}");
        }
    }

    #[test]
    fn documents_without_displacements_have_no_outline() {
        for outline in ["null", r#"{"time": 0, "node": [9], "displacement": [[0, 0]]}"#, "{}"] {
            let text = format!(r#"{{"error": {{"sup": 1}}, "outline": {outline}}}"#);
            assert_eq!(Deformed::new(&square(), &Document::parse(&text).unwrap()), None, "{outline}");
        }
    }
}
