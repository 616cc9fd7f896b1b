//! The changes of the tractions that leave the resultant and the moment on each element as they are.
//!
//! The moments of an edge act on an element like forces at the two nodes of the edge. The changes without resultant and
//! moment on any element are spanned by:
//! - on each edge, opposite forces at its ends, along it: one for each edge;
//! - around each node that is surrounded by unknown edges, the same force and the same couple through all of
//!   them: three for each such node.

use super::energy::{Form, MOMENTS};
use super::{LANES, Lanes};
use crate::stress::facet_node;
use percute_core::ids::{FacetId, NodeId};
use percute_core::problem::Problem;

/// Facet without unknown moments.
const KNOWN: u32 = u32::MAX;

/// Moments of one facet at its two nodes, outward from its owner (N).
pub(super) type FacetMoments<const D: usize> = [[Lanes; D]; D];

/// An edge of an element, in the order and with the sign of the element.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElementEdge {
    /// Place among the unknown facets, or [`KNOWN`].
    facet: u32,
    /// Whether the element's order of the two nodes is not the facet's.
    flipped: bool,
    /// 1 for the owner, −1 for the neighbour.
    sign: f64,
}

/// A spoke of a surrounded node.
#[derive(Clone, Copy, Debug)]
struct Spoke<const D: usize> {
    facet: u32,
    /// Position of the node in the facet.
    position: usize,
    /// 1 where the star of the node leaves the facet's owner by it, else −1.
    sign: f64,
    /// d⊥/|d|² with d from the node to the other end (1/m): a unit couple of opposite forces.
    lever: [f64; D],
}

/// Where the moments of a link of a star are kept.
#[derive(Clone, Copy, Debug)]
struct Link {
    facet: u32,
    position: usize,
    sign: f64,
}

/// Coefficients of all modes.
#[derive(Clone, Debug)]
pub(super) struct Modes {
    pub(super) edges: Vec<Lanes>,
    pub(super) nodes: Vec<[Lanes; 3]>,
}

/// Modes of a mesh, and the preconditioner of the energy in them.
#[derive(Debug)]
pub(super) struct Basis<const D: usize> {
    /// Unit vector along each unknown facet.
    tangents: Vec<[f64; D]>,
    pub(super) sides: Vec<[ElementEdge; 3]>,
    /// Spokes of surrounded nodes, one node after the other, and where each begins.
    spokes: Vec<Spoke<D>>,
    starts: Vec<usize>,
    links: Vec<Option<Link>>,
    /// Inverse of the energy of each edge mode alone.
    edge_inverse: Vec<f64>,
    /// Inverse of the energy of the three modes of each node.
    node_inverse: Vec<nalgebra::Matrix3<f64>>,
}

impl<const D: usize> Basis<D> {
    pub(super) fn new<const N: usize>(problem: &Problem<D, N>, forms: &[Form]) -> Self {
        let mesh = problem.mesh();
        // A facet held in all components has unknown moments like an inner one.
        let unknown = |(f, facet): (usize, &percute_core::mesh::Facet<D>)| {
            facet.neighbour.is_some() || problem.supported(FacetId::new(f)) == [true; D]
        };
        let mut place = vec![KNOWN; mesh.facets().len()];
        let mut tangents = Vec::new();
        for (f, facet) in mesh.facets().iter().enumerate().filter(|&each| unknown(each)) {
            place[f] = tangents.len() as u32;
            tangents.push(unit(&difference(problem, facet.nodes[0], facet.nodes[1])));
        }
        let sides = (0..mesh.element_count()).map(|e| std::array::from_fn(|k| side(problem, &place, e, k))).collect();
        let mut basis = Self {
            tangents,
            sides,
            spokes: Vec::new(),
            starts: vec![0],
            links: Vec::new(),
            edge_inverse: Vec::new(),
            node_inverse: Vec::new(),
        };
        for node in (0..mesh.node_count()).map(NodeId::new) {
            basis.add_star(problem, &place, node);
        }
        basis.precondition(forms);
        basis
    }

    /// Where a star's links are kept, and its spokes if it is surrounded by unknown facets.
    fn add_star<const N: usize>(&mut self, problem: &Problem<D, N>, place: &[u32], node: NodeId) {
        let mesh = problem.mesh();
        let star = mesh.stars().star(node);
        let last = star.elements.len();
        let first_link = self.links.len();
        for (k, facet) in star.links.iter().enumerate() {
            let link = facet.filter(|f| place[f.index()] != KNOWN).map(|f| {
                let data = &mesh.facets()[f.index()];
                // The element before the link; a chain that begins at the boundary enters its first one.
                let leaves = match k {
                    0 if star.is_closed() => data.owner == star.elements[last - 1],
                    0 => false,
                    _ => data.owner == star.elements[k - 1],
                };
                let sign = if leaves { 1.0 } else { -1.0 };
                Link { facet: place[f.index()], position: usize::from(data.nodes[0] != node), sign }
            });
            self.links.push(link);
        }
        if self.links[first_link..].iter().any(Option::is_none) {
            return;
        }
        let distinct = if star.is_closed() { last } else { last + 1 };
        for (facet, link) in star.links.iter().zip(&self.links[first_link..]).take(distinct) {
            let (Some(facet), Some(Link { facet: at, position, sign })) = (facet, *link) else { continue };
            let other = mesh.facets()[facet.index()].nodes[1 - position];
            let arm = difference(problem, node, other);
            let square: f64 = arm.iter().map(|x| x * x).sum();
            let mut lever = [0.0; D];
            (lever[0], lever[1]) = (-arm[1] / square, arm[0] / square);
            self.spokes.push(Spoke { facet: at, position, sign, lever });
        }
        self.starts.push(self.spokes.len());
    }

    /// Energies of the modes, each edge and each node by itself.
    fn precondition(&mut self, forms: &[Form]) {
        let mut touched = vec![Vec::new(); self.tangents.len()];
        for (e, sides) in self.sides.iter().enumerate() {
            for side in sides.iter().filter(|side| side.facet != KNOWN) {
                touched[side.facet as usize].push(e);
            }
        }
        let mut moments = self.no_moments();
        for (edge, elements) in touched.iter().enumerate() {
            self.spread_edge(edge, &[1.0; LANES], &mut moments);
            let energy: f64 = elements.iter().map(|&e| self.work(&forms[e], e, &moments)[0][0]).sum();
            moments[edge] = [[[0.0; LANES]; D]; D];
            self.edge_inverse.push(if energy > 0.0 { 1.0 / energy } else { 0.0 });
        }
        for node in 0..self.starts.len() - 1 {
            let spokes = &self.spokes[self.starts[node]..self.starts[node + 1]];
            let around: std::collections::BTreeSet<usize> =
                spokes.iter().flat_map(|spoke| touched[spoke.facet as usize].iter().copied()).collect();
            // The three modes in three lanes.
            let modes = std::array::from_fn(|i| std::array::from_fn(|lane| f64::from(u8::from(i == lane))));
            self.spread_node(node, &modes, &mut moments);
            let mut energy = nalgebra::Matrix3::zeros();
            for e in around {
                let work = self.work(&forms[e], e, &moments);
                energy += nalgebra::Matrix3::from_fn(|i, j| work[i][j]);
            }
            spokes.iter().for_each(|spoke| moments[spoke.facet as usize] = [[[0.0; LANES]; D]; D]);
            self.node_inverse.push(energy.try_inverse().unwrap_or_else(nalgebra::Matrix3::zeros));
        }
    }

    /// The work of the moments of each lane on one element through those of each other.
    fn work(&self, form: &Form, e: usize, moments: &[FacetMoments<D>]) -> [[f64; LANES]; LANES] {
        let moments = self.of_element(e, moments);
        let product = apply(form, &moments);
        let work = |i: usize, j: usize| moments.iter().zip(&product).map(|(m, p)| m[i] * p[j]).sum();
        std::array::from_fn(|i| std::array::from_fn(|j| work(i, j)))
    }

    pub(super) fn no_moments(&self) -> Vec<FacetMoments<D>> {
        vec![[[[0.0; LANES]; D]; D]; self.tangents.len()]
    }

    pub(super) fn no_modes(&self) -> Modes {
        Modes { edges: vec![[0.0; LANES]; self.tangents.len()], nodes: vec![[[0.0; LANES]; 3]; self.starts.len() - 1] }
    }

    fn spread_edge(&self, edge: usize, s: &Lanes, moments: &mut [FacetMoments<D>]) {
        for (c, t) in self.tangents[edge].iter().enumerate() {
            for lane in 0..LANES {
                moments[edge][0][c][lane] += s[lane] * t;
                moments[edge][1][c][lane] -= s[lane] * t;
            }
        }
    }

    fn spread_node(&self, node: usize, mode: &[Lanes; 3], moments: &mut [FacetMoments<D>]) {
        for spoke in &self.spokes[self.starts[node]..self.starts[node + 1]] {
            let moments = &mut moments[spoke.facet as usize];
            for c in 0..D {
                for lane in 0..LANES {
                    let couple = spoke.sign * mode[2][lane] * spoke.lever[c];
                    moments[spoke.position][c][lane] += spoke.sign * mode[c][lane] - couple;
                    moments[1 - spoke.position][c][lane] += couple;
                }
            }
        }
    }

    /// The moments that modes make.
    pub(super) fn spread(&self, modes: &Modes, moments: &mut [FacetMoments<D>]) {
        moments.fill([[[0.0; LANES]; D]; D]);
        modes.edges.iter().enumerate().for_each(|(edge, s)| self.spread_edge(edge, s, moments));
        modes.nodes.iter().enumerate().for_each(|(node, mode)| self.spread_node(node, mode, moments));
    }

    /// Work of moments on the modes: the transpose of [`Basis::spread`].
    pub(super) fn gather(&self, moments: &[FacetMoments<D>], modes: &mut Modes) {
        for ((s, tangent), moments) in modes.edges.iter_mut().zip(&self.tangents).zip(moments) {
            *s = [0.0; LANES];
            for c in 0..D {
                (0..LANES).for_each(|lane| s[lane] += tangent[c] * (moments[0][c][lane] - moments[1][c][lane]));
            }
        }
        for (node, mode) in modes.nodes.iter_mut().enumerate() {
            *mode = [[0.0; LANES]; 3];
            for spoke in &self.spokes[self.starts[node]..self.starts[node + 1]] {
                let moments = &moments[spoke.facet as usize];
                for c in 0..D {
                    let (here, there) = (&moments[spoke.position][c], &moments[1 - spoke.position][c]);
                    for lane in 0..LANES {
                        mode[c][lane] += spoke.sign * here[lane];
                        mode[2][lane] += spoke.sign * spoke.lever[c] * (there[lane] - here[lane]);
                    }
                }
            }
        }
    }

    /// The inverse of the energies of edges and nodes alone.
    pub(super) fn scale(&self, slope: &Modes, scaled: &mut Modes) {
        for ((z, r), inverse) in scaled.edges.iter_mut().zip(&slope.edges).zip(&self.edge_inverse) {
            *z = r.map(|r| r * inverse);
        }
        for ((z, r), inverse) in scaled.nodes.iter_mut().zip(&slope.nodes).zip(&self.node_inverse) {
            for i in 0..3 {
                for lane in 0..LANES {
                    z[i][lane] = (0..3).map(|j| inverse[(i, j)] * r[j][lane]).sum();
                }
            }
        }
    }

    /// Moments on the edges of an element, outward from it, in its own order; known ones do not change.
    #[inline]
    pub(super) fn of_element(&self, e: usize, moments: &[FacetMoments<D>]) -> [Lanes; MOMENTS] {
        let mut all = [[0.0; LANES]; MOMENTS];
        for (k, side) in self.sides[e].iter().enumerate().filter(|(_, side)| side.facet != KNOWN) {
            let facet = &moments[side.facet as usize];
            for p in 0..D {
                for c in 0..D {
                    all[4 * k + 2 * p + c] = facet[p ^ usize::from(side.flipped)][c].map(|m| side.sign * m);
                }
            }
        }
        all
    }

    /// Adds an element's slopes to those of its facets: the transpose of [`Basis::of_element`].
    #[inline]
    pub(super) fn add_to_facets(&self, e: usize, slope: &[Lanes; MOMENTS], moments: &mut [FacetMoments<D>]) {
        for (k, side) in self.sides[e].iter().enumerate().filter(|(_, side)| side.facet != KNOWN) {
            let facet = &mut moments[side.facet as usize];
            for p in 0..D {
                for c in 0..D {
                    let (sum, slope) = (&mut facet[p ^ usize::from(side.flipped)][c], &slope[4 * k + 2 * p + c]);
                    (0..LANES).for_each(|lane| sum[lane] += side.sign * slope[lane]);
                }
            }
        }
    }

    /// Adds the change of one lane to the moments on the links of all stars.
    pub(super) fn add(&self, change: &[FacetMoments<D>], lane: usize, moments: &mut [[crate::lanes::Lanes; D]]) {
        for (moments, link) in moments.iter_mut().zip(&self.links) {
            if let Some(Link { facet, position, sign }) = link {
                (0..D).for_each(|c| moments[c].0[lane] += sign * change[*facet as usize][*position][c][lane]);
            }
        }
    }
}

/// H m.
#[inline]
pub(super) fn apply(form: &Form, moments: &[Lanes; MOMENTS]) -> [Lanes; MOMENTS] {
    let mut product = [[0.0; LANES]; MOMENTS];
    for (row, moment) in form.iter().zip(moments) {
        for (sum, entry) in product.iter_mut().zip(row) {
            (0..LANES).for_each(|lane| sum[lane] += entry * moment[lane]);
        }
    }
    product
}

/// Edge k of element e.
fn side<const D: usize, const N: usize>(problem: &Problem<D, N>, place: &[u32], e: usize, k: usize) -> ElementEdge {
    let mesh = problem.mesh();
    let id = mesh.cell_facets()[e][k];
    let facet = &mesh.facets()[id.index()];
    let flipped = mesh.cells()[e][facet_node::<N>(k, 0)] != facet.nodes[0];
    ElementEdge { facet: place[id.index()], flipped, sign: if facet.owner.index() == e { 1.0 } else { -1.0 } }
}

/// From one node to another (m).
fn difference<const D: usize, const N: usize>(problem: &Problem<D, N>, from: NodeId, to: NodeId) -> [f64; D] {
    let points = problem.mesh().points();
    std::array::from_fn(|c| points[to.index()][c] - points[from.index()][c])
}

fn unit<const D: usize>(vector: &[f64; D]) -> [f64; D] {
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    vector.map(|x| x / length)
}
