//! The star of a boundary node, cut into sub-triangles that become smaller towards the node.
//!
//! Each element is cut at its centroid. The triangles between the node and the other points of the cut are cut into rings, each
//! half as large as the ring before, and a core. With them, sub-triangles are similar from ring to ring.

use std::collections::HashMap;

/// A sub-triangle, counterclockwise.
#[derive(Clone, Copy, Debug)]
pub(super) struct SubTriangle {
    pub(super) corners: [[f64; 2]; 3],
    /// Position of its element in the star.
    pub(super) element: usize,
    /// 0 beside the far edges of the star, then the ring, the core last.
    pub(super) layer: usize,
    /// The corner of the element that its part, one of three around the centroid, does not have: 0 the node, 1 and 2
    /// the others, counterclockwise.
    pub(super) opposite: usize,
}

/// One side of an edge between sub-triangles: the facet of a sub-triangle, opposite to its corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SideOf {
    pub(super) triangle: usize,
    pub(super) corner: usize,
}

/// The star of a node, cut.
#[derive(Clone, Debug)]
pub(super) struct CutStar {
    /// Layer by layer.
    pub(super) triangles: Vec<SubTriangle>,
    /// The sides of each edge between two of them.
    pub(super) inner: Vec<[SideOf; 2]>,
    /// The pieces of the first and the last edge at the node, from the far end to the node.
    pub(super) ends: [Vec<SideOf>; 2],
}

impl CutStar {
    /// Cuts a star at the node `origin`. `fan` has the other ends of its edges, counterclockwise, one more than elements.
    pub(super) fn new(origin: [f64; 2], fan: &[[f64; 2]], rings: usize) -> Self {
        let rays = rays(origin, fan);
        let count = rays.len();
        // Points of the cut by their numbers: those of a ring, ring after ring, then the node itself.
        let number = |ring: usize, ray: usize| ring * count + ray;
        let node = (rings + 1) * count;
        let point = |at: usize| {
            if at == node {
                return origin;
            }
            let shrink = 0.5_f64.powi((at / count) as i32);
            std::array::from_fn(|c| origin[c] + shrink * (rays[at % count][c] - origin[c]))
        };
        let mut cut = Vec::new();
        for element in 0..fan.len() - 1 {
            let ray = 2 * element;
            cut.push((0, ray, [number(0, ray + 1), number(0, ray), number(0, ray + 2)]));
        }
        for ring in 0..rings {
            for ray in 0..count - 1 {
                let [a, b] = [number(ring, ray), number(ring, ray + 1)];
                let [d, c] = [number(ring + 1, ray), number(ring + 1, ray + 1)];
                // The diagonals of an element meet at its median: the cut of a mirror image is the mirror image of the cut.
                let halves = if ray % 2 == 0 { [[d, a, b], [d, b, c]] } else { [[a, b, c], [a, c, d]] };
                halves.into_iter().for_each(|corners| cut.push((ring + 1, ray, corners)));
            }
        }
        for ray in 0..count - 1 {
            cut.push((rings + 1, ray, [node, number(rings, ray), number(rings, ray + 1)]));
        }
        let triangles = cut.iter().map(|&(layer, ray, at)| {
            let opposite = if layer == 0 { 0 } else { 2 - ray % 2 };
            SubTriangle { corners: at.map(point), element: ray / 2, layer, opposite }
        });
        let mut sides = HashMap::new();
        let mut inner = Vec::new();
        for (triangle, (_, _, at)) in cut.iter().enumerate() {
            for corner in 0..3 {
                let (start, end) = (at[(corner + 1) % 3], at[(corner + 2) % 3]);
                let side = SideOf { triangle, corner };
                match sides.remove(&(end, start)) {
                    Some(other) => inner.push([other, side]),
                    None => _ = sides.insert((start, end), side),
                }
            }
        }
        let spoke = |ray: usize| {
            (0..=rings).map(move |ring| (number(ring, ray), if ring == rings { node } else { number(ring + 1, ray) }))
        };
        let first = spoke(0).filter_map(|(far, near)| sides.get(&(near, far)).copied()).collect();
        let last = spoke(count - 1).filter_map(|(far, near)| sides.get(&(far, near)).copied()).collect();
        Self { triangles: triangles.collect(), inner, ends: [first, last] }
    }
}

/// The points of the cut at the far edges: the ends of the edges and the centroids between them.
fn rays(origin: [f64; 2], fan: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut rays = vec![fan[0]];
    for pair in fan.windows(2) {
        rays.push(std::array::from_fn(|c| (origin[c] + pair[0][c] + pair[1][c]) / 3.0));
        rays.push(pair[1]);
    }
    rays
}
