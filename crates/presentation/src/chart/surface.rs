//! The contact surface over time, ready to draw.

use crate::document::Document;
use percute_core::border::{Vector, row};
use percute_core::contact_results::{ContactPoint, ContactResults};

/// Most instants of a picture; of more, each piece gives its largest pressure.
const INSTANTS: usize = 600;

/// Pressure along the surface of one contact, that of a plane or of two bodies, over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Name of the contact: "plane 0", "anvil.top with hammer.bottom".
    pub(crate) name: String,
    /// First and last instant (s).
    pub(crate) time: [f64; 2],
    /// Position of the nodes along the surface (m): ascending.
    pub(crate) places: Vec<f64>,
    /// Pressure (Pa), node by node, over time.
    pub(crate) pressure: Vec<Vec<f64>>,
    /// Coordinates of the first and the last node (m).
    pub(crate) ends: [Vec<f64>; 2],
}

impl Surface {
    /// The parts of the surface that come into contact, one for each plane and each two bodies, with the results of all
    /// nodes at all instants; of two bodies, the surface of the first one. None without these, without contact, and
    /// where a single node may touch.
    #[must_use]
    pub fn all(results: &ContactResults, document: &Document) -> Vec<Self> {
        let names = document.names_of_obstacles();
        names.into_iter().filter_map(|(obstacle, name)| Self::new(results, obstacle, name)).collect()
    }

    fn new(results: &ContactResults, obstacle: usize, name: String) -> Option<Self> {
        let (steps, count) = (results.steps.as_ref()?, results.nodes.len());
        let time = [*results.instants.first()?, *results.instants.last()?];
        let nodes: Vec<usize> = (0..count).filter(|&node| results.nodes[node].obstacle == obstacle).collect();
        if nodes.len() < 2 || time[0] >= time[1] {
            return None;
        }
        let pressure = |node: usize, (instant, forces): &(usize, &[f64])| -> f64 {
            let (normal, force) = (&results.nodes[node].normal, row(forces, node, results.dimension));
            (0..3).map(|c| force[c] * normal[c]).sum::<f64>() / results.area(*instant, node)
        };
        let rows: Vec<(usize, &[f64])> = steps.force.chunks_exact(results.dimension * count).enumerate().collect();
        let pieces = rows.chunks(rows.len().div_ceil(INSTANTS).max(1));
        let largest =
            |node: usize, piece: &[(usize, &[f64])]| piece.iter().map(|row| pressure(node, row)).fold(0.0, f64::max);
        let history = |node: usize| pieces.clone().map(|piece| largest(node, piece)).collect();
        let points: Vec<_> = nodes.iter().map(|&node| results.nodes[node]).collect();
        let pressed = |k: usize| results.summary.get(nodes[k]).is_some_and(|s| s.peak_pressure > 0.0);
        let order: Vec<usize> = order(&points, pressed)?.into_iter().map(|k| nodes[k]).collect();
        let mut places = vec![0.0];
        for pair in order.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|node| results.nodes[node].point);
            places.push(places[places.len() - 1] + distance(&a, &b));
        }
        let end = |node: Option<&usize>| {
            node.map(|&node| results.nodes[node].point[..results.dimension].to_vec()).unwrap_or_default()
        };
        let ends = [end(order.first()), end(order.last())];
        Some(Self { name, time, places, pressure: order.iter().map(|&node| history(node)).collect(), ends })
    }
}

fn distance(a: &Vector, b: &Vector) -> f64 {
    (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>().sqrt()
}

/// The nodes to show, in their order along the surface: those that are pressed, and some on both sides. A closed
/// outline is opened in its longest part without contact.
fn order(nodes: &[ContactPoint], pressed: impl Fn(usize) -> bool) -> Option<Vec<usize>> {
    let count = nodes.len();
    let pressed: Vec<bool> = (0..count).map(pressed).collect();
    if !pressed.contains(&true) {
        return None;
    }
    let mut lengths: Vec<f64> = nodes.windows(2).map(|pair| distance(&pair[0].point, &pair[1].point)).collect();
    lengths.sort_by(f64::total_cmp);
    let closed = distance(&nodes[0].point, &nodes[count - 1].point) <= 1.5 * lengths[lengths.len() / 2];
    let mut start = 0;
    if closed && count > 4 {
        let run = |from: usize| (0..count).take_while(|k| !pressed[(from + k) % count]).count();
        let longest = (0..count).max_by_key(|&from| run(from)).unwrap_or(0);
        start = longest + run(longest) / 2;
    }
    let turned: Vec<usize> = (0..count).map(|k| (start + k) % count).collect();
    let first = turned.iter().position(|&node| pressed[node])?;
    let last = turned.iter().rposition(|&node| pressed[node])?;
    let margin = ((last - first) / 8).max(2);
    Some(turned[first.saturating_sub(margin)..(last + margin + 1).min(count)].to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::ids::NodeId;

    fn node([x, y]: [f64; 2]) -> ContactPoint {
        ContactPoint { node: NodeId::new(0), obstacle: 0, point: [x, y, 0.0], normal: [0.0, 1.0, 0.0], area: 1.0 }
    }

    #[test]
    fn a_closed_outline_is_opened_away_from_contact() {
        let angle = |k: usize| std::f64::consts::TAU * k as f64 / 40.0;
        let circle: Vec<_> = (0..40).map(|k| node([angle(k).cos(), angle(k).sin()])).collect();
        // Contact at both ends of the list: one zone of the circle.
        let shown = order(&circle, |k| !(2..=38).contains(&k)).unwrap();
        assert_eq!(shown, [37, 38, 39, 0, 1, 2, 3]);
    }

    #[test]
    fn an_open_outline_keeps_its_ends() {
        let edge: Vec<_> = (0..10).map(|k| node([f64::from(k), 0.0])).collect();
        assert_eq!(order(&edge, |k| !(2..=7).contains(&k)).unwrap(), (0..10).collect::<Vec<_>>());
        assert_eq!(order(&edge, |k| k == 5).unwrap(), [3, 4, 5, 6, 7]);
        assert_eq!(order(&edge, |_| false), None);
    }
}
