//! The star of a boundary node, cut into sub-triangles that become smaller towards the node.
//!
//! Each element is cut at its centroid. The triangles between the node and the other points of the cut are cut into
//! rings and a core. Rings of one ratio of radii are similar, and so are their sub-triangles.

/// The side of its layer on which face 0 of a sub-triangle lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arc {
    /// The outline of the star; the other two faces are those of a ring.
    Outline,
    /// Towards the outline.
    Outer,
    /// Towards the node.
    Inner,
}

/// A sub-triangle, counterclockwise. The sub-triangles of a ring or of the core form a chain: each has an edge in
/// common with the one before (its left side), one with the next (its right side), and one with another layer (its
/// arc).
#[derive(Clone, Copy, Debug)]
pub(super) struct SubTriangle {
    /// Places from the node (m), in a layer of outer radius 1.
    pub(super) corners: [[f64; 2]; 3],
    /// Position among the sectors between rays, of which an element has two; the first in a sub-triangle at the
    /// outline.
    pub(super) sector: usize,
    pub(super) arc: Arc,
}

impl SubTriangle {
    /// Its faces at its left and right side and at its arc, and whether they run against the direction of the edge,
    /// which is that of the other sub-triangle there. At the outline: the arcs of two sectors, and the outline.
    pub(super) fn sides(&self) -> [(usize, bool); 3] {
        match self.arc {
            Arc::Outline => [(2, true), (1, true), (0, false)],
            Arc::Outer => [(2, false), (1, true), (0, false)],
            Arc::Inner => [(1, false), (2, true), (0, true)],
        }
    }

    /// Position of its element in the star.
    pub(super) fn element(&self) -> usize {
        self.sector / 2
    }

    /// The corner of the element that its part, one of three around the centroid, does not have: 0 the node, 1 and 2
    /// the others, counterclockwise.
    pub(super) fn opposite(&self) -> usize {
        if self.arc == Arc::Outline { 0 } else { 2 - self.sector % 2 }
    }
}

/// The rays of a star from its node: to the ends of its edges and the centroids between them.
#[derive(Clone, Debug)]
pub(super) struct CutStar {
    pub(super) rays: Vec<[f64; 2]>,
}

impl CutStar {
    /// `fan` has the other ends of the edges, from the node (m), counterclockwise, one more than elements.
    pub(super) fn new(fan: &[[f64; 2]]) -> Self {
        let mut rays = vec![fan[0]];
        for pair in fan.windows(2) {
            rays.push(std::array::from_fn(|c| (pair[0][c] + pair[1][c]) / 3.0));
            rays.push(pair[1]);
        }
        Self { rays }
    }

    /// The sectors between rays, two in each element.
    pub(super) fn sectors(&self) -> usize {
        self.rays.len() - 1
    }

    /// The triangles between the centroids and the outline.
    pub(super) fn outline(&self) -> Vec<SubTriangle> {
        let triangle = |element: usize| {
            let [a, g, b] = [0, 1, 2].map(|k| self.rays[2 * element + k]);
            SubTriangle { corners: [g, a, b], sector: 2 * element, arc: Arc::Outline }
        };
        (0..self.sectors() / 2).map(triangle).collect()
    }

    /// A ring from radius 1 to another radius.
    pub(super) fn ring(&self, inner: f64) -> Vec<SubTriangle> {
        let pair = |sector: usize| {
            let [a, b] = [self.rays[sector], self.rays[sector + 1]];
            let [d, c] = [a, b].map(|p| p.map(|x| inner * x));
            // The diagonals of an element meet at its median: the cut of a mirror image is the mirror image of the cut.
            let halves = if sector.is_multiple_of(2) {
                [(Arc::Outer, [d, a, b]), (Arc::Inner, [b, c, d])]
            } else {
                [(Arc::Inner, [a, c, d]), (Arc::Outer, [c, a, b])]
            };
            halves.map(|(arc, corners)| SubTriangle { corners, sector, arc })
        };
        (0..self.sectors()).flat_map(pair).collect()
    }

    /// The triangles at the node, of radius 1.
    pub(super) fn core(&self) -> Vec<SubTriangle> {
        let triangle = |sector: usize| {
            let corners = [[0.0; 2], self.rays[sector], self.rays[sector + 1]];
            SubTriangle { corners, sector, arc: Arc::Outer }
        };
        (0..self.sectors()).map(triangle).collect()
    }
}
