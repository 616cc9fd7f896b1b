//! The fields of the nodes of a block of elements, at some levels side by side.

use super::balanced::{NodalBalance, outward};
use crate::element::{Element, Link};
use crate::field_lanes::gather;
use crate::traction::EquilibratedLevels;
use percute_core::ids::ElementId;
use percute_core::problem::Problem;
use percute_core::simd::Registers;
use percute_core::simd::Wide;
use percute_core::simd::lanes::{Lanes, Value, load};

/// A node of a block of elements, with the fields of which tractions and Γ_DA are made at some levels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BalanceNode<const D: usize> {
    /// Its place (m).
    point: [f64; D],
    /// Its initial velocity (m/s).
    pub(super) start: [f64; D],
    displacement: [Lanes; D],
    acceleration: [Lanes; D],
    skew: [Lanes; D],
}

/// The nodes of a block of elements, at some levels.
#[derive(Clone, Debug, Default)]
pub(crate) struct BalanceFields<const D: usize> {
    nodes: Vec<BalanceNode<D>>,
    /// The moments on the links of the nodes of some elements (N): those of a node follow each other.
    moments: Vec<[[Lanes; D]; D]>,
    split: bool,
    /// Whether the body may turn.
    turning: bool,
    has_body_force: bool,
}

impl<const D: usize> BalanceFields<D> {
    /// Takes the fields of these nodes.
    #[inline(always)]
    pub(crate) fn gather<R: Registers>(
        &mut self,
        like: Wide<R>,
        problem: &Problem<D>,
        nodes: &[u32],
        levels: &EquilibratedLevels<D>,
    ) {
        let forces = levels.forces();
        self.split = forces.iter().any(|f| f.level.split.is_some());
        self.has_body_force = forces.iter().any(|f| !f.level.body_force.is_empty());
        self.turning = problem.is_finite();
        let (zero, none) = ([0.0; D], [Lanes::ZERO; D]);
        let rest = BalanceNode { point: zero, start: zero, displacement: none, acceleration: none, skew: none };
        self.nodes.resize(nodes.len(), rest);
        for (record, &node) in self.nodes.iter_mut().zip(nodes) {
            record.point = problem.mesh().points_in::<D>()[node as usize];
            record.start = problem.initial_velocity()[node as usize];
        }
        gather(
            like,
            &mut self.nodes,
            nodes,
            forces.iter().map(|f| Some(&f.acceleration[..])),
            #[inline(always)]
            |node| &mut node.acceleration,
        );
        if self.split {
            gather(
                like,
                &mut self.nodes,
                nodes,
                forces.iter().map(|f| f.level.skew()),
                #[inline(always)]
                |node| &mut node.skew,
            );
        }
        if self.turning {
            self.gather_displacement(like, nodes, levels);
        }
    }

    /// Takes the displacements that are equilibrated too.
    #[inline(always)]
    pub(crate) fn gather_displacement<R: Registers>(
        &mut self,
        like: Wide<R>,
        nodes: &[u32],
        levels: &EquilibratedLevels<D>,
    ) {
        gather(
            like,
            &mut self.nodes,
            nodes,
            levels.forces().iter().map(|f| Some(&f.level.displacement[..])),
            #[inline(always)]
            |node| &mut node.displacement,
        );
    }

    /// ã, or a_c, and o₂ at the nodes, by their places (m/s²).
    #[inline(always)]
    pub(crate) fn accelerations(&self) -> impl Iterator<Item = [&[Lanes; D]; 2]> {
        self.nodes.iter().map(
            #[inline(always)]
            |node| [&node.acceleration, &node.skew],
        )
    }

    /// Whether the mass term is split.
    #[inline(always)]
    pub(crate) fn is_split(&self) -> bool {
        self.split
    }

    /// The nodes of an element, which have these places.
    #[inline(always)]
    pub(crate) fn nodes<const N: usize>(&self, local: &[u32; N]) -> [&BalanceNode<D>; N] {
        at_places(&self.nodes, local)
    }

    /// Takes the moments of some elements: one loop for all, so that none waits for another to come from memory.
    #[inline(always)]
    pub(crate) fn gather_moments<const N: usize>(
        &mut self,
        elements: &[Element<D, N>],
        levels: &EquilibratedLevels<D>,
    ) {
        let moments = levels.moments();
        self.moments.resize(N * elements.len(), [[Lanes::ZERO; D]; D]);
        for (own, element) in self.moments.chunks_exact_mut(N).zip(elements) {
            for i in 0..N {
                for p in 0..D {
                    own[i][p] = moments[element.links[i][p].place()];
                }
            }
        }
    }

    /// The fields of an element without contact node, the k-th whose moments were taken, in the form of a number.
    #[inline(always)]
    pub(crate) fn nodal_balance<T: Value<Stored = Lanes>, const N: usize>(
        &self,
        like: T,
        k: usize,
        levels: &EquilibratedLevels<D>,
        (id, links): (ElementId, &[[Link; D]; N]),
        nodes: &[&BalanceNode<D>; N],
    ) -> NodalBalance<D, N, T> {
        let own = &self.moments[N * k..][..N];
        let (mut acceleration, mut skew) = ([[like; D]; N], [[like; D]; N]);
        for i in 0..N {
            acceleration[i] = load(like, &nodes[i].acceleration);
            skew[i] = load(like, &nodes[i].skew);
        }
        NodalBalance {
            moments: outward(
                links,
                #[inline(always)]
                |i| on_links(like, &own[i]),
            ),
            acceleration,
            skew: self.split.then_some(skew),
            body_force: if self.has_body_force { load(like, &levels.body_force(id)) } else { [like.zero(); D] },
            displacement: self.turning.then(
                #[inline(always)]
                || BalanceNode::displacements(like, nodes),
            ),
        }
    }
}

impl<const D: usize> BalanceNode<D> {
    /// The places of the nodes of an element (m).
    #[inline(always)]
    pub(crate) fn points<const N: usize>(nodes: &[&Self; N]) -> [[f64; D]; N] {
        let mut points = [[0.0; D]; N];
        for i in 0..N {
            points[i] = nodes[i].point;
        }
        points
    }

    /// The displacements of the nodes of an element that are equilibrated (m), in the form of a number.
    #[inline(always)]
    pub(crate) fn displacements<T: Value<Stored = Lanes>, const N: usize>(like: T, nodes: &[&Self; N]) -> [[T; D]; N] {
        let mut displacements = [[like; D]; N];
        for i in 0..N {
            displacements[i] = load(like, &nodes[i].displacement);
        }
        displacements
    }
}

/// Moments on the links of a node, in the form of a number.
#[inline(always)]
fn on_links<T: Value<Stored = Lanes>, const D: usize>(like: T, stored: &[[Lanes; D]; D]) -> [[T; D]; D] {
    let mut moments = [[like; D]; D];
    for p in 0..D {
        moments[p] = load(like, &stored[p]);
    }
    moments
}

/// The records at these places.
#[inline(always)]
pub(crate) fn at_places<'r, R, const N: usize>(records: &'r [R], local: &[u32; N]) -> [&'r R; N] {
    let mut found = [&records[local[0] as usize]; N];
    for i in 1..N {
        found[i] = &records[local[i] as usize];
    }
    found
}
