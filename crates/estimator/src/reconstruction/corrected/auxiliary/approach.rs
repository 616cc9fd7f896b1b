//! The motion of the auxiliary solution at the contact nodes over the next step, before the contact forces are known.

use super::MotionFields;
use super::blocks::Blocks;
use super::lanes::Nodal;
use super::pairs::{PairSurroundings, Pairs, TrianglePair};
use super::patch::{Factors, Near, Patch, PatchOperator};
use super::response::{Neighbours, Response, dot};
use super::surface::SurfaceForces;
use crate::reconstruction::corrected::present_stars::PresentStars;
use crate::smoothing::Smoothing;
use percute_core::material::Tensor;
use percute_core::problem::Problem;
use std::array::from_fn;
use std::sync::OnceLock;

/// The motion of a contact node against its obstacle over the next step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::reconstruction::corrected) struct Approach<const D: usize> {
    /// Gap now (m).
    pub(in crate::reconstruction::corrected) gap_now: f64,
    /// Gap at the next instant without a normal force (m).
    pub(in crate::reconstruction::corrected) gap: f64,
    /// Displacement along the plane now, and at the next instant without a contact force (m).
    pub(in crate::reconstruction::corrected) along: [[f64; D]; 2],
    pub(in crate::reconstruction::corrected) mobility: Mobility<D>,
    /// The nodes at the far ends of its edges, on which its traction acts in part.
    pub(in crate::reconstruction::corrected) far: [Option<Far<D>>; 2],
}

/// The motion of a node at the far end of an edge of another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::reconstruction::corrected) struct Far<const D: usize> {
    /// Gap at the next instant without a normal force of the other (m).
    gap: f64,
    along: [[f64; D]; 2],
    /// Displacement here under unit forces at each of both far ends (m/N).
    of: [Mobility<D>; 2],
    /// The same of the other one under forces here, or here under forces there.
    other: Mobility<D>,
}

/// Displacement that unit forces add until the next instant, by its component and that of the force (m/N).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::reconstruction::corrected) struct Mobility<const D: usize>(pub(super) [[f64; D]; D]);

/// The motion of a contact node over the next step without a contact force.
#[derive(Clone, Copy, Debug)]
pub(in crate::reconstruction::corrected) struct FreeFlight<const D: usize> {
    /// Displacement now and at the next instant (m).
    pub(in crate::reconstruction::corrected) displacements: [[f64; D]; 2],
    /// Displacement that a unit force adds until then at the lumped mass (m/N).
    pub(in crate::reconstruction::corrected) mobility: f64,
}

impl<const D: usize> Approach<D> {
    /// The motion of the traction whose parts on the far nodes are these: its mean gap and displacement, and what a
    /// unit force adds to them. A force that is the answer to the mean over its own density takes energy, whatever the
    /// scheme is.
    pub(in crate::reconstruction::corrected) fn of_traction(&self, far: [f64; 2]) -> Self {
        let mut mean = *self;
        // Parts on nodes that are not known stay with the node.
        let ends = [0, 1].map(|e| self.far[e].filter(|_| far[e] != 0.0).map(|end| (far[e], end)));
        let own = 1.0 - ends.iter().flatten().map(|(part, _)| part).sum::<f64>();
        mean.gap *= own;
        mean.along = mean.along.map(|along| along.map(|x| own * x));
        mean.mobility = mean.mobility.times(own * own);
        for (part, end) in ends.iter().flatten() {
            mean.gap += part * end.gap;
            for (sum, along) in mean.along.iter_mut().zip(end.along) {
                (0..D).for_each(|c| sum[c] += part * along[c]);
            }
            mean.mobility.add(2.0 * own * part, &end.other);
            for (of, other) in end.of.iter().zip(ends) {
                let both = other.map_or(0.0, |(other, _)| part * other);
                mean.mobility.add(both, of);
            }
        }
        mean.far = [None; 2];
        mean
    }
}

impl<const D: usize> Mobility<D> {
    /// That of a mass: the same in all directions.
    pub(in crate::reconstruction::corrected) fn of_mass(mobility: f64) -> Self {
        Self(from_fn(|c| from_fn(|d| if c == d { mobility } else { 0.0 })))
    }

    /// The symmetric part: both ways count.
    fn symmetric(&self) -> Self {
        Self(from_fn(|c| from_fn(|d| 0.5 * (self.0[c][d] + self.0[d][c]))))
    }

    /// R G Rᵀ.
    fn turned(&self, rotation: &Tensor<D>) -> Self {
        Self(from_fn(|c| {
            from_fn(|d| {
                let entry = |a: usize| (0..D).map(move |b| rotation[c][a] * self.0[a][b] * rotation[d][b]).sum::<f64>();
                (0..D).map(entry).sum()
            })
        }))
    }

    fn times(&self, factor: f64) -> Self {
        Self(self.0.map(|row| row.map(|x| factor * x)))
    }

    fn add(&mut self, factor: f64, other: &Self) {
        for (row, other) in self.0.iter_mut().zip(other.0) {
            (0..D).for_each(|c| row[c] += factor * other[c]);
        }
    }

    /// The displacement under a force (N).
    pub(super) fn under(&self, force: &[f64; D]) -> [f64; D] {
        self.0.map(|row| dot(&row, force))
    }

    /// The displacement in a direction under a unit force in another one (m/N).
    pub(in crate::reconstruction::corrected) fn between(&self, to: &[f64; D], force: &[f64; D]) -> f64 {
        dot(to, &self.under(force))
    }
}

/// The foreseen motion of all contact nodes over the next step.
#[derive(Clone, Copy, Debug)]
pub(in crate::reconstruction::corrected) struct Foreseen<'a, const D: usize> {
    pub(super) problem: &'a Problem<D>,
    pub(super) near: &'a ContactElements<D>,
    pub(super) operator: PatchOperator<'a>,
    pub(super) factors: Factors,
    /// Δt_n h_n (s²).
    pub(super) square: f64,
    /// Those of a body that turns: it responds as the undeformed body does, turned with the stars.
    pub(super) turned: Option<&'a PresentStars<'a, D>>,
}

impl<const D: usize> Foreseen<'_, D> {
    /// That without a contact force.
    pub(in crate::reconstruction::corrected) fn free(&self) -> &[FreeFlight<D>] {
        &self.near.free
    }

    /// The gap of a node to its obstacle, or to the node that it faces, without a contact force (m).
    pub(in crate::reconstruction::corrected) fn free_gap(&self, at: usize) -> f64 {
        self.problem.surface().gap(at, &self.displacements(at)[1])
    }

    /// Displacements against the obstacle, now and at the next instant (m).
    fn displacements(&self, at: usize) -> [[f64; D]; 2] {
        let FreeFlight { mut displacements, .. } = self.free()[at];
        if let Some(partner) = self.problem.surface().nodes()[at].partner {
            let other = &self.free()[partner].displacements;
            let both = displacements.as_flattened_mut().iter_mut().zip(other.as_flattened());
            both.for_each(|(own, other)| *own -= other);
        }
        displacements
    }

    /// That of a node to its obstacle or to the node that it faces, with the forces of these (N) that are those of
    /// other nodes or its own friction; `far` are the nodes at the far ends of its edges.
    pub(in crate::reconstruction::corrected) fn approach(
        &self,
        at: usize,
        far: [Option<usize>; 2],
        forces: &[[f64; D]],
    ) -> Approach<D> {
        let frame = self.problem.obstacles()[self.problem.surface().nodes()[at].obstacle].flat_frame();
        let normal = frame.split(&forces[at]).0;
        let own: [f64; D] = from_fn(|c| normal * frame.normal()[c]);
        let [now, next] = self.places(at, forces, (at, &own));
        let gap = |place: &[f64; D]| self.problem.surface().gap(at, place);
        let far = far.map(|end| {
            let end = end?;
            let [now, next] = self.places(end, forces, (at, &own));
            Some(Far {
                gap: self.problem.surface().gap(end, &next),
                along: [now, next].map(|place| frame.split(&place).1),
                of: far.map(|other| other.map_or(Mobility([[0.0; D]; D]), |other| self.mobility(end, other))),
                other: self.mobility(at, end).symmetric(),
            })
        });
        let along = [now, next].map(|place| frame.split(&place).1);
        Approach { gap_now: gap(&now), gap: gap(&next), along, mobility: self.mobility(at, at), far }
    }

    /// The displacement of a node under unit forces on another one, each against its obstacle (m/N).
    fn mobility(&self, at: usize, by: usize) -> Mobility<D> {
        let response = self.near.response(self.problem, self.operator, at);
        let partner = self.problem.surface().nodes()[by].partner;
        let compliance = if at == by { response.own(&self.factors) } else { response.of(&self.factors, by, partner) };
        let compliance = Mobility(compliance.map(|row| row.map(|g| self.square * g)));
        self.turned.map_or(compliance, |stars| compliance.turned(stars.rotation(at)))
    }

    /// Displacements of a node against its obstacle (m), now and at the next instant under these forces (N) but this
    /// one on a node.
    fn places(&self, at: usize, forces: &[[f64; D]], (by, without): (usize, &[f64; D])) -> [[f64; D]; 2] {
        let response = self.near.response(self.problem, self.operator, at);
        let [now, next] = self.displacements(at);
        let moved = match self.turned {
            Some(stars) => stars.turn(at, &response.under(&self.factors, |by| stars.turn_back(at, &forces[by]))),
            None => response.under(&self.factors, |by| forces[by]),
        };
        let own = self.mobility(at, at).under(&forces[at]);
        let less = self.mobility(at, by).under(without);
        [now, from_fn(|c| next[c] + self.square * moved[c] + own[c] - less[c])]
    }
}

/// The data of the level before its pass.
#[derive(Clone, Copy, Debug)]
pub(super) struct BeforePass<'a, const D: usize> {
    pub(super) operator: PatchOperator<'a>,
    pub(super) surface: &'a SurfaceForces,
    pub(super) fields: &'a MotionFields,
    /// F_n (N); empty without loads.
    pub(super) external: &'a [[f64; D]],
    /// The step that the displacement of the fields has still to make (s).
    pub(super) due: f64,
    pub(super) factors: Factors,
    /// Δt_n and h_n (s).
    pub(super) steps: [f64; 2],
}

/// The elements around the contact nodes. They go through the sweeps twice: here and in the pass.
#[derive(Debug)]
pub(super) struct ContactElements<const D: usize> {
    patch: Patch,
    neighbours: Neighbours,
    /// The place of each contact node in the patch.
    places: Vec<u32>,
    /// Places and positions of the contact nodes whose forces are on nodes, ascending: not those of non-matching
    /// interfaces.
    loaded: Vec<(u32, u32)>,
    /// Made at first use.
    responses: Vec<OnceLock<Response<D>>>,
    free: Vec<FreeFlight<D>>,
}

impl<const D: usize> ContactElements<D> {
    pub(super) fn new(problem: &Problem<D>, blocks: &Blocks, all: &Pairs, smoothing: &Smoothing) -> Self {
        let (surface, contacts) = (problem.surface(), problem.surface().nodes());
        let pairs = (0..blocks.count()).flat_map(|block| {
            let nodes = blocks.nodes(block);
            let (first, first_patch) = (nodes.start as u32, smoothing.patches(&nodes).start as u32);
            all.block(block).iter().zip(all.range(block)).map(move |(pair, k)| Near {
                pair: TrianglePair { nodes: pair.nodes.map(|n| n + first), ..*pair },
                around: all
                    .around_pair(k)
                    .map(|a| PairSurroundings { patches: a.patches.map(|p| p + first_patch), ..*a }),
                number: k as u32,
            })
        });
        let patch = Patch::new(problem, smoothing, contacts.iter().map(|contact| contact.node.index()), pairs);
        let places: Vec<u32> = contacts.iter().map(|contact| patch.place(contact.node.index() as u32) as u32).collect();
        let mut loaded: Vec<(u32, u32)> = places.iter().copied().zip(0..).collect();
        loaded.retain(|(_, at)| surface.non_matching_of(*at as usize).is_none());
        loaded.sort_unstable();
        Self {
            neighbours: Neighbours::new(&patch),
            patch,
            responses: places.iter().map(|_| OnceLock::new()).collect(),
            free: Vec::with_capacity(places.len()),
            places,
            loaded,
        }
    }

    fn response(&self, problem: &Problem<D>, operator: PatchOperator<'_>, at: usize) -> &Response<D> {
        self.responses[at].get_or_init(|| {
            let facing = [Some(at), problem.surface().nodes()[at].partner].into_iter().flatten();
            let facing: Vec<(u32, u32)> = facing.map(|at| (self.places[at], at as u32)).collect();
            Response::new((&self.patch, &self.neighbours), operator, &facing, &self.loaded)
        })
    }

    /// Takes in the motions of all contact nodes until t_{n+1} without a contact force.
    pub(super) fn set_free(&mut self, free: Vec<FreeFlight<D>>) {
        self.free = free;
    }

    /// Foresees the motions of all contact nodes until t_{n+1} without a contact force.
    pub(super) fn foresee(&mut self, problem: &Problem<D>, before: &BeforePass<'_, D>) {
        let Self { patch, places, free, .. } = self;
        let BeforePass { operator, surface, fields, external, due, factors, steps: [step, length] } = *before;
        let PatchOperator { laws, weights } = operator;
        let each = patch.nodes.iter().zip(&mut patch.displacement).zip(&mut patch.rate);
        for ((node, displacement), force) in each {
            let i = *node as usize;
            let (u, v) = (&fields.displacement[i].0, &fields.half_step[i].0);
            displacement.0 = from_fn(|k| u[k] + v[k] * due);
            *force = external.get(i).map_or(Nodal::ZERO, Nodal::all_but_contact);
        }
        patch.subtract_forces(laws, weights.corrects());
        for (node, force) in patch.nodes.iter().zip(&mut patch.rate) {
            surface.supports_of(*node).for_each(|(c, needed)| force.set(c, needed));
        }
        patch.accelerate(laws);
        free.clear();
        free.extend(problem.surface().nodes().iter().zip(&*places).map(|(contact, &place)| {
            let (node, place) = (contact.node.index(), place as usize);
            let (now, velocity) = (patch.displacement[place].of::<D>(0), fields.half_step[node].of::<D>(0));
            let acceleration: [f64; D] = factors.sum(&patch.acceleration(weights, place));
            let next = from_fn(|c| now[c] + step * (velocity[c] + length * acceleration[c]));
            FreeFlight { displacements: [now, next], mobility: step * length / problem.mass()[node] }
        }));
    }
}
