//! The star problem of a node of a solid: a graph with the elements as vertices and the unknown faces as edges.
//!
//! With B the incidence matrix of the graph and b⁰ the moments of the averaged finite-element traction, the moments
//! nearest to b⁰ are b = b⁰ + WBᵀy, BWBᵀ y = r − Bb⁰. The matrix is that of Laplace of the graph: where no face of a
//! support takes what is left, one vertex of it is at 0. It is the same for all levels and most components.

use super::star_terms::{Compatibility, StarTerms, mean};
use percute_core::ids::FaceId;
use percute_core::simd::lanes::{Value, load};

/// A pivot below this part of the diagonal is rounding: the sum over all vertices before it is 0.
const ROUNDING: f64 = 1e-9;

/// The inverse weight of a face on a plane of symmetry: the star is half of one that goes on beyond it.
const MIRRORED: f64 = 2.0;

/// A face at the node.
#[derive(Clone, Copy, Debug)]
struct GraphEdge<const D: usize> {
    /// The places of its owner and its neighbour in the star.
    owner: usize,
    neighbour: Option<usize>,
    /// Inverse weight in each component, 0 where its moment is known.
    weight: [f64; D],
}

/// Memory for the graphs of stars, one after the other; `S` is a vector of numbers.
#[derive(Clone, Debug)]
pub(super) struct GraphRoom<S, const D: usize> {
    edges: Vec<GraphEdge<D>>,
    /// What is left of the load of each element.
    rest: Vec<S>,
    /// y.
    potential: Vec<S>,
    /// L of LDLᵀ below the diagonal, row by row.
    lower: Vec<f64>,
    /// 1/D, 0 for a vertex that is at 0.
    inverse: Vec<f64>,
}

impl<S, const D: usize> Default for GraphRoom<S, D> {
    fn default() -> Self {
        Self { edges: Vec::new(), rest: Vec::new(), potential: Vec::new(), lower: Vec::new(), inverse: Vec::new() }
    }
}

/// The star problem of a node of a solid.
pub(super) struct GraphStar<'a, 'p, const D: usize, const N: usize, T: Value> {
    pub(super) terms: StarTerms<'a, 'p, D, N, T>,
    /// The faces at the node.
    pub(super) links: &'a [Option<FaceId>],
}

impl<const D: usize, const N: usize, T: Value> GraphStar<'_, '_, D, N, T> {
    /// Finds the moments: `moments` receives, for each link, the outward moment of the owner of the face; `known` gives
    /// that of a face of the boundary.
    #[inline(always)]
    pub(super) fn solve(
        &self,
        moments: &mut [[T::Stored; D]],
        known: impl Fn(FaceId) -> [T; D],
        room: &mut GraphRoom<[T::Stored; D], D>,
    ) -> Compatibility<T> {
        let mut scale = self.terms.like.zero();
        self.load(room, &mut scale);
        self.start(moments, known, room);
        for c in 0..D {
            if c == 0 || room.edges.iter().any(|edge| edge.weight[c] != edge.weight[c - 1]) {
                factor(room, self.terms.elements.len(), c);
            }
            self.improve(c, moments, room);
        }
        let mut miss = self.terms.like.zero();
        for rest in &room.rest {
            for c in 0..D {
                miss = miss.worse(scale.load(&rest[c]).abs());
            }
        }
        for moment in &*moments {
            for c in 0..D {
                scale = scale.max(scale.load(&moment[c]).abs());
            }
        }
        Compatibility { miss, scale }
    }

    /// Takes in the loads of all elements.
    #[inline(always)]
    fn load(&self, room: &mut GraphRoom<[T::Stored; D], D>, scale: &mut T) {
        room.rest.clear();
        for (m, &place) in self.terms.local.iter().enumerate() {
            let stress = self.terms.stress_at(place);
            let load = self.terms.residual_of(m, self.terms.position(m), &stress, scale);
            room.rest.push(store(&load));
        }
    }

    /// b⁰ on all links, and its part of the loads.
    #[inline(always)]
    fn start(
        &self,
        moments: &mut [[T::Stored; D]],
        known: impl Fn(FaceId) -> [T; D],
        room: &mut GraphRoom<[T::Stored; D], D>,
    ) {
        let (all, mesh) = (self.terms.all, self.terms.all.problem.mesh());
        room.edges.clear();
        for (moment, face) in moments.iter_mut().zip(self.links.iter().flatten()) {
            let sides = mesh.face(*face);
            let place = |element| self.terms.elements.partition_point(|other| *other < element);
            let (owner, neighbour) = (place(sides.owner), sides.neighbour.map(place));
            let faces = &mesh.faces_of::<N>()[sides.owner.index()];
            let k = faces.iter().position(|other| other == face).unwrap_or(0);
            let own = self.terms.stress_at(self.terms.local[owner]);
            let (mut weight, mut start) = ([1.0; D], own[0]);
            if let Some(other) = neighbour {
                start = self.terms.moment(owner, k, &mean(&own, &self.terms.stress_at(self.terms.local[other])));
            } else {
                let (supported, outer) = (all.problem.supported(*face), known(*face));
                let inner = self.terms.moment(owner, k, &own);
                let open = if supported == [true; D] { 1.0 } else { MIRRORED };
                for c in 0..D {
                    weight[c] = if supported[c] { open } else { 0.0 };
                    start[c] = if supported[c] { inner[c] } else { outer[c] };
                }
            }
            room.edges.push(GraphEdge { owner, neighbour, weight });
            *moment = store(&start);
            take(&mut room.rest, owner, neighbour, &start);
        }
    }

    /// Solves for one component and adds WBᵀy to its moments.
    #[inline(always)]
    fn improve(&self, c: usize, moments: &mut [[T::Stored; D]], room: &mut GraphRoom<[T::Stored; D], D>) {
        let (count, like) = (self.terms.elements.len(), self.terms.like);
        room.potential.clone_from(&room.rest);
        let (y, lower, inverse) = (&mut room.potential, &room.lower, &room.inverse);
        for i in 0..count {
            let mut sum = like.load(&y[i][c]);
            for (j, entry) in lower[i * count..i * count + i].iter().enumerate().filter(|(_, entry)| **entry != 0.0) {
                sum -= like.load(&y[j][c]) * *entry;
            }
            y[i][c] = sum.store();
        }
        for i in 0..count {
            y[i][c] = (like.load(&y[i][c]) * inverse[i]).store();
        }
        for i in (0..count).rev() {
            let value = like.load(&y[i][c]);
            for (j, entry) in lower[i * count..i * count + i].iter().enumerate().filter(|(_, entry)| **entry != 0.0) {
                y[j][c] = (like.load(&y[j][c]) - value * *entry).store();
            }
        }
        for (moment, edge) in moments.iter_mut().zip(&room.edges).filter(|(_, edge)| edge.weight[c] != 0.0) {
            let mut change = like.load(&y[edge.owner][c]);
            if let Some(other) = edge.neighbour {
                change -= like.load(&y[other][c]);
            }
            change = change * edge.weight[c];
            moment[c] = (like.load(&moment[c]) + change).store();
            let mut one = [like.zero(); D];
            one[c] = change;
            take(&mut room.rest, edge.owner, edge.neighbour, &one);
        }
    }
}

#[inline(always)]
fn store<T: Value, const D: usize>(vector: &[T; D]) -> [T::Stored; D] {
    let mut stored = [vector[0].store(); D];
    for c in 1..D {
        stored[c] = vector[c].store();
    }
    stored
}

/// Takes an outward moment of the owner off its load, and gives it to the neighbour.
#[inline(always)]
fn take<T: Value, const D: usize>(
    rest: &mut [[T::Stored; D]],
    owner: usize,
    neighbour: Option<usize>,
    moment: &[T; D],
) {
    let mut own = load(moment[0], &rest[owner]);
    (0..D).for_each(|c| own[c] -= moment[c]);
    rest[owner] = store(&own);
    if let Some(other) = neighbour {
        let mut far = load(moment[0], &rest[other]);
        (0..D).for_each(|c| far[c] += moment[c]);
        rest[other] = store(&far);
    }
}

/// LDLᵀ of the matrix of a component.
fn factor<S, const D: usize>(room: &mut GraphRoom<S, D>, count: usize, c: usize) {
    let GraphRoom { edges, lower, inverse, .. } = room;
    lower.clear();
    lower.resize(count * count, 0.0);
    for edge in edges.iter() {
        lower[edge.owner * (count + 1)] += edge.weight[c];
        if let Some(other) = edge.neighbour {
            lower[other * (count + 1)] += edge.weight[c];
            let (low, high) = (edge.owner.min(other), edge.owner.max(other));
            lower[high * count + low] -= edge.weight[c];
        }
    }
    inverse.clear();
    for i in 0..count {
        let diagonal = lower[i * (count + 1)];
        let mut pivot = diagonal;
        for j in 0..i {
            let mut entry = lower[i * count + j];
            for k in 0..j {
                // Entries of finished rows are L, those of this one still LD.
                entry -= lower[i * count + k] * lower[j * count + k];
            }
            lower[i * count + j] = entry;
        }
        for j in 0..i {
            let scaled = lower[i * count + j] * inverse[j];
            pivot -= scaled * lower[i * count + j];
            lower[i * count + j] = scaled;
        }
        inverse.push(if pivot > ROUNDING * diagonal { 1.0 / pivot } else { 0.0 });
    }
}
