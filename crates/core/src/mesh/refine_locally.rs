//! Nested meshes that are finer in some places, by bisection of the longest edges.
//!
//! M.-C. Rivara, Algorithms for refining triangular grids suitable for adaptive and multigrid techniques, Int. J.
//! Numer. Meth. Eng. 20 (1984) 745–756: the smallest angle of a triangle is at least half of that of the triangle it
//! was cut from, however often it is refined.

use super::bisection::Twins;
use super::{ElementGroups, FaceRows, Mesh, MeshError, Parts, in_kind};
use crate::ids::ElementId;

/// The edges that are cut, and the order in which an element is cut by them.
pub(super) struct Cuts {
    /// The nodes of each edge of the mesh, ascending, in ascending order.
    edges: Vec<[usize; 2]>,
    /// For each edge, the number of edges that come before it by length, then by nodes: no two edges tie.
    rank: Vec<usize>,
    /// The node in the middle of each edge that is cut.
    middle: Vec<Option<usize>>,
}

impl Mesh {
    /// The mesh with each chosen element cut by the middles of its edges, a bar into two elements and a triangle into
    /// four, and as many other elements as a conforming mesh needs.
    ///
    /// An element is cut at its longest edge first, and its parts at the others. Nodes keep their numbers, and the
    /// middles of the edges follow in the order of the nodes of these edges. The parts of an element take its place in
    /// the order of the elements. Groups name the same faces and elements as before.
    ///
    /// # Errors
    /// As for [`Mesh::refined`].
    pub fn refined_where(&self, chosen: impl Fn(ElementId) -> bool) -> Result<Self, MeshError> {
        self.cut(&self.cuts(chosen, &[]))
    }

    /// The mesh with some edges cut.
    pub(super) fn cut(&self, cuts: &Cuts) -> Result<Self, MeshError> {
        in_kind!(self, D, N => self.cut_in::<D, N>(cuts))
    }

    fn cut_in<const D: usize, const N: usize>(&self, cuts: &Cuts) -> Result<Self, MeshError> {
        let corners = self.points_in::<D>();
        let mut points = corners.to_vec();
        points.extend(
            cuts.edges
                .iter()
                .zip(&cuts.middle)
                .filter(|(_, middle)| middle.is_some())
                .map(|(&[a, b], _)| -> [f64; D] { std::array::from_fn(|c| 0.5 * (corners[a][c] + corners[b][c])) }),
        );
        let (mut cells, mut first) = (Vec::new(), Vec::with_capacity(self.element_count() + 1));
        for cell in self.nodes_of::<N>() {
            first.push(cells.len());
            cuts.parts(cell.map(|n| n.index()), &mut cells);
        }
        first.push(cells.len());
        let faces = self.face_groups.iter().map(|(name, group)| {
            let mut parts = Vec::new();
            group.iter().for_each(|&f| cuts.parts(self.face_nodes::<D>(f).map(|n| n.index()), &mut parts));
            (name.clone(), parts.into_flattened())
        });
        let elements = self.element_groups.iter().map(|(name, group)| {
            (name.clone(), group.iter().flat_map(|e| first[e.index()]..first[e.index() + 1]).collect())
        });
        let (faces, elements): (FaceRows, ElementGroups) = (faces.collect(), elements.collect());
        Self::checked(points, &cells, (&faces, &elements), Parts::MayTouch)
    }

    /// All edges of the chosen elements, the longest edge of each element that has an edge that is cut, and the twins
    /// of all these.
    pub(super) fn cuts(&self, chosen: impl Fn(ElementId) -> bool, twins: &[Twins]) -> Cuts {
        let edges = self.edges();
        let (points, d) = (&self.points, self.dimension());
        let square =
            |&[a, b]: &[usize; 2]| -> f64 { (0..d).map(|c| (points[d * a + c] - points[d * b + c]).powi(2)).sum() };
        let squares: Vec<f64> = edges.iter().map(square).collect();
        let mut order: Vec<usize> = (0..edges.len()).collect();
        // The sort is stable: edges of one length stay in the order of their nodes.
        order.sort_by(|&a, &b| squares[a].total_cmp(&squares[b]));
        let mut rank = vec![0; edges.len()];
        order.iter().enumerate().for_each(|(place, &edge)| rank[edge] = place);
        let mut cuts = Cuts { middle: vec![None; edges.len()], edges, rank };
        let of_cells: Vec<usize> = in_kind!(self, D, N => {
            self.nodes_of::<N>().iter().flat_map(|cell| cuts.edges_of(cell.map(|n| n.index()))).collect()
        });
        let of_cells: Vec<&[usize]> = of_cells.chunks(of_cells.len() / self.element_count()).collect();
        let mut cut = vec![false; cuts.edges.len()];
        for (_, edges) in of_cells.iter().enumerate().filter(|&(e, _)| chosen(ElementId::new(e))) {
            edges.iter().for_each(|&edge| cut[edge] = true);
        }
        cuts.close(&of_cells, &cuts.twins(twins), &mut cut);
        let middles = cuts.middle.iter_mut().zip(&cut).filter_map(|(middle, &cut)| cut.then_some(middle));
        (self.node_count()..).zip(middles).for_each(|(node, middle)| *middle = Some(node));
        cuts
    }
}

impl Cuts {
    /// The edges between nodes of an element or face.
    fn edges_of<const M: usize>(&self, nodes: [usize; M]) -> impl Iterator<Item = usize> {
        let pairs = (0..M).flat_map(move |j| (0..j).map(move |i| [nodes[i].min(nodes[j]), nodes[i].max(nodes[j])]));
        pairs.filter_map(|pair| self.edges.binary_search(&pair).ok())
    }

    /// The node in the middle of the edge between two nodes, if it is cut.
    pub(super) fn middle(&self, [a, b]: [usize; 2]) -> Option<usize> {
        self.middle[self.edges.binary_search(&[a.min(b), a.max(b)]).ok()?]
    }

    /// All edges, each by its nodes.
    pub(super) fn edges(&self) -> &[[usize; 2]] {
        &self.edges
    }

    /// Pairs of edges between nodes that face each other.
    fn twins(&self, twins: &[Twins]) -> Vec<[usize; 2]> {
        let facing = |nodes: &Twins, &[a, b]: &[usize; 2]| {
            let (a, b) = (*nodes.get(&a)?, *nodes.get(&b)?);
            self.edges.binary_search(&[a.min(b), a.max(b)]).ok()
        };
        let of = |nodes| {
            let edges = self.edges.iter().enumerate();
            edges.filter_map(move |(edge, ends)| Some([edge, facing(nodes, ends)?]))
        };
        twins.iter().flat_map(of).collect()
    }

    /// Cuts the longest edge of each element that is cut, and the twins of edges that are cut. Edges become longer from
    /// element to element, so that this ends.
    fn close(&self, of_cells: &[&[usize]], twins: &[[usize; 2]], cut: &mut [bool]) {
        let mut changed = true;
        while changed {
            changed = false;
            for &edges in of_cells {
                let longest = edges.iter().copied().max_by_key(|&edge| self.rank[edge]);
                if let Some(longest) = longest.filter(|&longest| !cut[longest] && edges.iter().any(|&edge| cut[edge])) {
                    (cut[longest], changed) = (true, true);
                }
            }
            for &[edge, twin] in twins {
                if cut[edge] && !cut[twin] {
                    (cut[twin], changed) = (true, true);
                }
            }
        }
    }

    /// The parts of an element or face, cut at the longest edge first; a part's edge inside it is not cut.
    fn parts<const M: usize>(&self, nodes: [usize; M], parts: &mut Vec<[usize; M]>) {
        let cut = self.edges_of(nodes).filter_map(|edge| Some((self.rank[edge], edge, self.middle[edge]?)));
        let Some((_, edge, middle)) = cut.max() else {
            parts.push(nodes);
            return;
        };
        // A node in the place of another keeps the orientation.
        for end in self.edges[edge].into_iter().rev() {
            self.parts(nodes.map(|node| if node == end { middle } else { node }), parts);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::FaceGroups;

    /// A skew quadrilateral with a fan of unequal triangles, and groups.
    fn fan() -> Mesh {
        let points = vec![[0.0, 0.0], [1.0, 0.1], [0.9, 0.8], [-0.2, 0.7], [0.35, 0.3], [1.9, 0.3]];
        let cells = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 5, 2]];
        let edges = FaceGroups::from([
            ("lower".to_string(), vec![[0, 1], [1, 5]]),
            ("upper".to_string(), vec![[3, 2], [3, 0]]),
        ]);
        let elements = ElementGroups::from([("left".to_string(), vec![0, 3]), ("right".to_string(), vec![4])]);
        Mesh::new(points, &cells, &edges, &elements).unwrap()
    }

    fn areas(mesh: &Mesh) -> Vec<f64> {
        (0..mesh.element_count()).map(|e| mesh.geometry::<2, 3>(ElementId::new(e)).volume).collect()
    }

    fn smallest_angle(mesh: &Mesh) -> f64 {
        let angle = |e: usize, k: usize| {
            let p = mesh.corners::<2, 3>(ElementId::new(e));
            let [a, b] = [1, 2].map(|j| [p[(k + j) % 3][0] - p[k][0], p[(k + j) % 3][1] - p[k][1]]);
            (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
        };
        (0..mesh.element_count()).flat_map(|e| (0..3).map(move |k| angle(e, k))).fold(f64::INFINITY, f64::min)
    }

    /// A deterministic choice of about one element in `one_in`.
    fn some(round: usize, one_in: usize) -> impl Fn(ElementId) -> bool {
        move |e| (e.index() + 1).wrapping_mul(2_654_435_761).wrapping_add(round * 40_503) / 64 % one_in == 0
    }

    /// Area and outline stay, so that the mesh conforms.
    #[test]
    fn angles_stay_above_half_over_ten_rounds() {
        let flat = Mesh::new(
            vec![[0.0, 0.0], [1.0, 0.0], [0.21, 0.12]],
            &[[0, 1, 2]],
            &FaceGroups::new(),
            &ElementGroups::new(),
        );
        for coarse in [fan(), flat.unwrap(), Mesh::disc(0.5, 3).unwrap(), Mesh::rectangle(0.5, 0.4, 5, 4).unwrap()] {
            let mut mesh = coarse.clone();
            for round in 0..10 {
                mesh = mesh.refined_where(some(round, 6)).unwrap();
                // Rounding of an angle.
                assert!(smallest_angle(&mesh) > 0.5 * smallest_angle(&coarse) - 1e-14, "round {round}");
            }
            assert!(mesh.element_count() > 8 * coarse.element_count(), "{}", mesh.element_count());
            let (fine, total): (f64, f64) = (areas(&mesh).iter().sum(), areas(&coarse).iter().sum());
            // Rounding of a sum of some 10⁴ terms; so below.
            assert!((fine - total).abs() < 1e-11 * total);
            // Both sides of an edge with a node inside it would be boundary.
            let outline = |mesh: &Mesh| -> f64 { mesh.boundary().map(|f| mesh.face_normal(f).1).sum() };
            assert!((outline(&mesh) - outline(&coarse)).abs() < 1e-11 * outline(&coarse));
        }
    }

    /// The parts of an element lie in it and fill it; nodes keep their numbers; a group covers the same edges and
    /// elements.
    #[test]
    fn parts_are_nested() {
        let coarse = fan();
        let fine = coarse.refined_where(|e| e.index() == 1).unwrap();
        assert_eq!(fine.points_in::<2>()[..coarse.node_count()], *coarse.points_in::<2>());
        assert!(fine.element_count() > coarse.element_count() + 3);
        let mut filled = vec![0.0; coarse.element_count()];
        for (part, area) in areas(&fine).into_iter().enumerate() {
            let points = fine.corners::<2, 3>(ElementId::new(part));
            let inside = |e: &usize| {
                let (parent, origin) =
                    (coarse.geometry::<2, 3>(ElementId::new(*e)), coarse.corners::<2, 3>(ElementId::new(*e))[0]);
                points.iter().all(|p| {
                    let w = parent.gradients.map(|g| g[0] * (p[0] - origin[0]) + g[1] * (p[1] - origin[1]));
                    [1.0 + w[0], w[1], w[2]].iter().all(|w| (-1e-13..1.0 + 1e-13).contains(w))
                })
            };
            filled[(0..coarse.element_count()).find(inside).unwrap()] += area;
        }
        for (filled, area) in filled.iter().zip(areas(&coarse)) {
            assert!((filled - area).abs() < 1e-15);
        }
        for name in ["left", "right"] {
            let area =
                |mesh: &Mesh| -> f64 { mesh.element_groups()[name].iter().map(|e| areas(mesh)[e.index()]).sum() };
            assert!((area(&fine) - area(&coarse)).abs() < 1e-15);
        }
        for name in ["lower", "upper"] {
            let length = |mesh: &Mesh| -> f64 { mesh.face_groups()[name].iter().map(|&f| mesh.face_normal(f).1).sum() };
            assert!((length(&fine) - length(&coarse)).abs() < 1e-15);
        }
    }

    /// The chosen element gets four parts, its neighbours across cut edges two or three, the others none.
    #[test]
    fn few_other_elements_are_cut() {
        let coarse = Mesh::rectangle(1.0, 1.0, 8, 8).unwrap();
        let fine = coarse.refined_where(|e| e.index() == 54).unwrap();
        // Its own 3 new parts, the 2 at its short sides cut in 3 each, at their hypotenuse and then at the side, which
        // are the longest edges of 2 more elements; the one at its hypotenuse in 2.
        assert_eq!(fine.element_count(), coarse.element_count() + 3 + 2 * 2 + 2 + 1);
    }

    #[test]
    fn all_and_none() {
        let coarse = fan();
        let same = coarse.refined_where(|_| false).unwrap();
        assert_eq!((same.points_in::<2>(), same.nodes_of::<3>()), (coarse.points_in::<2>(), coarse.nodes_of::<3>()));
        assert_eq!((same.face_groups(), same.element_groups()), (coarse.face_groups(), coarse.element_groups()));
        let (fine, regular) = (coarse.refined_where(|_| true).unwrap(), coarse.refined().unwrap());
        assert_eq!(fine.points_in::<2>(), regular.points_in::<2>());
        for (part, area) in areas(&fine).into_iter().enumerate() {
            assert!((area - 0.25 * areas(&coarse)[part / 4]).abs() < 1e-15);
        }
    }

    #[test]
    fn chosen_bars_are_halved() {
        let fine = Mesh::uniform_bar(3.0, 3).unwrap().refined_where(|e| e.index() == 1).unwrap();
        assert_eq!(fine.points(), [0.0, 1.0, 2.0, 3.0, 1.5]);
        let cells: Vec<_> = fine.nodes_of::<2>().iter().map(|cell| cell.map(|n| n.index())).collect();
        assert_eq!(cells, [[0, 1], [1, 4], [4, 2], [2, 3]]);
    }
}
