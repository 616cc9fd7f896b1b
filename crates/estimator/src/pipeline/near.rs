//! Elements with a candidate node of contact: their tractions may have two values at an instant,
//! and their motion is known only when the next contact of their nodes is.

use super::maps::Contribution;
use super::sampled_levels::SampledLevels;
use super::sampling::{
    ContactPart, Course, ElementInterval, ElementSample, ElementSampler, ElementVelocities, Sampling,
};
use crate::concentrated::HatStress;
use crate::contact_density::{FacetPressures, NarrowHat, NormalMisfit};
use crate::element::Element;
use crate::kinematic::ContactTrack;
use crate::measure::Balanced;
use crate::reconstruction::ReconstructionMethod;
use crate::residual::{Residuals, worse};
use crate::time_level::{Side, Velocities};
use crate::traction::EquilibratedLevel;

use percute_core::ids::ElementId;
use percute_core::problem::Problem;
use std::collections::VecDeque;

/// The pointwise equilibrium of σ_DA is checked at every level of so many, more often than away from contact.
const CHECK: usize = 4;

/// An element at a half-step instant; until contact is solved for, its normal components are those of the simulation.
#[derive(Clone, Copy, Debug)]
struct ContactInstant<const D: usize, const N: usize> {
    instant: usize,
    velocities: ElementVelocities<D, N>,
    /// The part of friction in the contact part of η (J).
    friction: f64,
}

/// An interval whose motion is not known yet.
#[derive(Clone, Debug)]
struct Waiting<const D: usize, const N: usize> {
    start: Balanced<D, N>,
    end: Balanced<D, N>,
    /// Whether its beginning has to be sampled: the first one, or one after a jump.
    begins: bool,
    mid: Option<ContactInstant<D, N>>,
    stop: ContactInstant<D, N>,
    /// Which nodes touch at the beginning and at the end.
    touching: [[bool; N]; 2],
    /// Pressures on its candidate facets, where they may act off contact.
    pressures: Vec<FacetPressures<D>>,
    /// Narrow hats of its nodes at the beginning and the end, sorted by nodes.
    hats: [Vec<NarrowHat<D>>; 2],
}

/// One such element.
#[derive(Clone, Debug)]
pub(super) struct NearElement<const D: usize, const N: usize> {
    pub(super) element: ElementId,
    /// Position of each node in the contact surface.
    contact: [Option<usize>; N],
    /// Candidate facets that the element owns.
    facets: Vec<usize>,
    /// Where the next interval begins.
    start: Option<ContactInstant<D, N>>,
    queue: VecDeque<Waiting<D, N>>,
    /// ∫∫F_n|w_n| so far (J).
    normal_work: f64,
    /// At the beginning, in the middle and at the end of each interval between sampled levels.
    pub(super) samples: Vec<[ElementSample; 3]>,
    pub(super) course: Course,
    /// Its contributions at the steps requested.
    pub(super) kept: Vec<Contribution>,
    pub(super) residuals: Residuals,
}

/// All such elements, by number.
pub(super) fn near_elements<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Vec<NearElement<D, N>> {
    let mesh = problem.mesh();
    let mut of_node = vec![None; mesh.node_count()];
    for (at, contact) in problem.surface().nodes().iter().enumerate() {
        of_node[contact.node.index()] = Some(at);
    }
    let mut facets = vec![Vec::new(); mesh.element_count()];
    for (f, facet) in problem.surface().facets().iter().enumerate() {
        facets[mesh.facets()[facet.facet.index()].owner.index()].push(f);
    }
    let near = |(e, facets): (usize, Vec<usize>)| {
        let contact = mesh.cells()[e].map(|n| of_node[n.index()]);
        contact.iter().any(Option::is_some).then(|| NearElement {
            element: ElementId::new(e),
            contact,
            facets,
            start: None,
            queue: VecDeque::new(),
            normal_work: 0.0,
            samples: Vec::new(),
            course: Course::default(),
            kept: Vec::new(),
            residuals: Residuals::default(),
        })
    };
    facets.into_iter().enumerate().filter_map(near).collect()
}

/// The data that all near elements share.
#[derive(Clone, Copy)]
pub(super) struct ContactSampling<'a, 'p, const D: usize, const N: usize> {
    pub(super) shared: &'a Sampling<'a, 'p, D, N>,
    pub(super) reconstruction: &'a dyn ReconstructionMethod<D, N>,
    pub(super) tracks: &'a [ContactTrack],
}

impl<const D: usize, const N: usize> NearElement<D, N> {
    /// Takes in the intervals between consecutive levels, then samples those whose motion is known.
    pub(super) fn advance(&mut self, context: &ContactSampling<'_, '_, D, N>, levels: &SampledLevels<'_, D>) {
        let sampler = ElementSampler::new(context.shared, self.element);
        if self.start.is_none() {
            let mut first = self.at(&sampler, &levels.levels.forces()[0].now, 0, 0.0);
            self.settle(context, &mut first);
            self.check_start(context, sampler.element, &first.velocities);
            self.start = Some(first);
        }
        for [from, to] in levels.intervals() {
            self.queue_interval(&sampler, &from, &to);
        }
        self.sample_known(context, &sampler);
    }

    fn queue_interval(
        &mut self,
        sampler: &ElementSampler<'_, '_, D, N>,
        from: &EquilibratedLevel<'_, D>,
        to: &EquilibratedLevel<'_, D>,
    ) {
        let start = sampler.balanced(from, &self.contact, Side::After);
        let end = sampler.balanced(to, &self.contact, Side::Before);
        let first = self.samples.is_empty() && self.queue.is_empty();
        let begins = first || from.forces().before.is_some();
        if begins {
            sampler.check(&start, from, CHECK, &mut self.residuals);
        }
        sampler.check(&end, to, CHECK, &mut self.residuals);
        let forces = to.forces();
        let friction = |k: usize| self.facets.iter().map(|&f| forces.friction[f][k]).sum::<f64>();
        let single = to.index() == from.index() + 1;
        let mid = forces.mid.as_ref().filter(|_| single);
        let mid = mid.map(|mid| self.at(sampler, mid, 2 * to.index() - 1, friction(0)));
        let stop = self.at(sampler, &forces.now, 2 * to.index(), friction(1));
        let touches = |level: &EquilibratedLevel<'_, D>, at: usize| level.forces().level.surface.touching[at];
        let touching = [from, to].map(|level| self.contact.map(|at| at.is_some_and(|at| touches(level, at))));
        let facets = if forces.off_contact.is_empty() { &[][..] } else { &self.facets };
        let pressures = facets.iter().map(|&f| FacetPressures::gather(f, from.index(), &forces.off_contact)).collect();
        let hats = [from, to].map(|level| {
            self.contact.iter().flatten().flat_map(|&at| level.forces().density.hats_of(at)).copied().collect()
        });
        self.queue.push_back(Waiting { start, end, begins, mid, stop, touching, pressures, hats });
    }

    fn at(
        &self,
        sampler: &ElementSampler<'_, '_, D, N>,
        velocities: &Velocities<D>,
        instant: usize,
        friction: f64,
    ) -> ContactInstant<D, N> {
        ContactInstant { instant, velocities: sampler.velocities(velocities), friction }
    }

    /// Number of half-step instants at which the motion of all contact nodes is known.
    fn known(&self, tracks: &[ContactTrack]) -> usize {
        self.contact.iter().flatten().map(|&at| tracks[at].known()).min().unwrap_or(0)
    }

    /// Replaces the normal components by those of problem P_CA.
    fn settle(&self, context: &ContactSampling<'_, '_, D, N>, at: &mut ContactInstant<D, N>) {
        let problem = context.shared.problem;
        for (i, node) in self.contact.iter().enumerate() {
            if let Some(node) = *node {
                let frame = problem.obstacles()[problem.surface().nodes()[node].obstacle].flat_frame();
                at.velocities.motion.set_normal(i, &frame, &context.tracks[node], at.instant);
            }
        }
    }

    fn sample_known(&mut self, context: &ContactSampling<'_, '_, D, N>, sampler: &ElementSampler<'_, '_, D, N>) {
        let known = self.known(context.tracks);
        while self.queue.front().is_some_and(|waiting| waiting.stop.instant < known) {
            let (Some(mut waiting), Some(start)) = (self.queue.pop_front(), self.start.take()) else { break };
            if let Some(mid) = &mut waiting.mid {
                self.settle(context, mid);
                let [before, after] = waiting.touching;
                self.check_contact(context, &mid.velocities, &std::array::from_fn(|i| before[i] && after[i]));
            }
            self.settle(context, &mut waiting.stop);
            self.check_contact(context, &waiting.stop.velocities, &waiting.touching[1]);
            let [from, to] = &waiting.hats;
            let hats = [from, &NarrowHat::mean(from, to), to].map(|hats| self.hat_stress(context, hats));
            let interval = ElementInterval {
                steps: [start.instant / 2, waiting.stop.instant / 2],
                balanced: [&waiting.start, &waiting.end],
                start: waiting.begins.then_some(&start.velocities),
                mid: waiting.mid.as_ref().map(|mid| &mid.velocities),
                end: &waiting.stop.velocities,
                contact: self.contact_part(context, &waiting, start.friction),
                hats: [&hats[0], &hats[1], &hats[2]],
            };
            self.samples.push(sampler.sample(&interval, &mut self.course, &mut self.kept));
            self.start = Some(waiting.stop);
        }
    }

    /// The stress of hats in the element.
    fn hat_stress<'c>(&self, context: &ContactSampling<'c, '_, D, N>, hats: &[NarrowHat<D>]) -> Vec<HatStress<'c>> {
        let Some(concentration) = context.reconstruction.concentration() else { return Vec::new() };
        let nodes = hats.chunk_by(|a, b| a.node == b.node);
        nodes.filter_map(|hats| concentration.in_element(context.shared.problem, hats, self.element)).collect()
    }

    /// The contact part of η at the beginning, middle and end of an interval (J).
    fn contact_part(
        &mut self,
        context: &ContactSampling<'_, '_, D, N>,
        waiting: &Waiting<D, N>,
        friction: f64,
    ) -> [ContactPart; 3] {
        let mut normal = NormalMisfit::default();
        for pressures in &waiting.pressures {
            normal.add(&context.reconstruction.normal_misfit(pressures, context.tracks));
        }
        let frictions = [friction, waiting.mid.as_ref().map_or(0.0, |mid| mid.friction), waiting.stop.friction];
        let so_far = self.normal_work;
        self.normal_work += normal.work[2];
        std::array::from_fn(|k| {
            let normal_work = so_far + normal.work[k];
            ContactPart { total: frictions[k] + normal_work + normal.energy[k], normal_work }
        })
    }

    /// u_CA and u̇_CA against the initial conditions.
    fn check_start(
        &mut self,
        context: &ContactSampling<'_, '_, D, N>,
        element: &Element<D, N>,
        first: &ElementVelocities<D, N>,
    ) {
        let size = context.shared.problem.mesh().size();
        let fastest = context.shared.problem.initial_velocity().iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
        let displacement = element.gather(context.shared.problem.initial_displacement());
        let velocity = element.gather(context.shared.problem.initial_velocity());
        for i in 0..N {
            for c in 0..D {
                let u = (first.motion.displacement()[i][c] - displacement[i][c]).abs() / size;
                let v = (first.motion.velocity()[i][c] - velocity[i][c]).abs();
                let v = if v == 0.0 { 0.0 } else { v / fastest };
                self.residuals.initial_conditions = worse(worse(self.residuals.initial_conditions, u), v);
            }
        }
    }

    /// Normal velocity of nodes that touch at an instant, and penetration of those that may.
    fn check_contact(
        &mut self,
        context: &ContactSampling<'_, '_, D, N>,
        velocities: &ElementVelocities<D, N>,
        touching: &[bool; N],
    ) {
        let problem = context.shared.problem;
        let speed = |v: &[f64; D]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        for (i, at) in self.contact.iter().enumerate() {
            let Some(at) = *at else { continue };
            let contact = &problem.surface().nodes()[at];
            let (velocity, displacement) = (&velocities.motion.velocity()[i], &velocities.motion.displacement()[i]);
            if touching[i] && contact.free {
                let normal = problem.obstacles()[contact.obstacle].flat_frame().split(velocity).0.abs();
                let residual = if normal == 0.0 { 0.0 } else { normal / speed(velocity) };
                self.residuals.normal_velocity = worse(self.residuals.normal_velocity, residual);
            }
            let gap = problem.surface().gap(at, displacement);
            let depth = worse(0.0, -gap / problem.mesh().size());
            self.residuals.penetration_at_instants = worse(self.residuals.penetration_at_instants, depth);
        }
    }
}

#[cfg(test)]
mod tests;
