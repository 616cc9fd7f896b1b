//! Elements with a candidate node of contact: their tractions may have two values at an instant,
//! and their motion is known only when the next contact of their nodes is.

mod append;
mod side_by_side;

use super::maps::Contribution;
use super::non_matching::NonMatchingMisfit;
use super::sampling::{
    ContactPart, Course, ElementInterval, ElementSample, ElementSampler, ElementVelocities, SampledFields, SharedData,
    trapezoid,
};
use super::waiting::{ContactInstant, Waiting};
use crate::concentrated::HatStress;
use crate::contact_density::{NarrowHat, NormalMisfit, ResidualStress};
use crate::element::Element;
use crate::kinematic::ContactMotion;
use crate::measure::Balanced;
use crate::numbers::Reader;
use crate::plastic::{PlasticMemory, PlasticPart};
use crate::reconstruction::ReconstructionMethod;
use crate::residual::{Residuals, worse};
use crate::stress::ElementForm;
use percute_core::ids::ElementId;
use percute_core::problem::Problem;

/// Part of the largest initial velocity below which a node is at rest. Where it sticks, its velocity is rounding, 1e-15
/// of the largest, and a quotient of two of them says nothing.
const AT_REST: f64 = 1e-3;

/// The part of η that comes from stresses beside σ_DA.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ResidualShare {
    /// Its integral (J s).
    pub(super) integral: f64,
    /// It at the last sample (J).
    last: f64,
}

/// One such element.
#[derive(Clone, Debug)]
pub(super) struct NearElement<const D: usize, const N: usize> {
    pub(super) element: ElementId,
    form: ElementForm,
    /// Position of each node in the contact surface, the first one of a node at two planes.
    contact: [Option<usize>; N],
    /// Candidate faces that the element owns.
    faces: Vec<usize>,
    /// Where the next interval to be sampled begins.
    start: Option<ContactInstant<D, N>>,
    /// ∫∫F_n|w_n| so far (J).
    normal_work: f64,
    /// The part of friction beside nodes at two planes so far (J).
    corner_friction: f64,
    /// The part of η of stresses beside σ_DA so far.
    pub(super) residual: ResidualShare,
    /// Intervals so far.
    checks: usize,
    /// The fields that balance at the last level, unless the contact force jumps there.
    reached: Option<Balanced<D, N>>,
    plastic: PlasticMemory<D>,
    pub(super) course: Course,
    /// Its contributions at the steps requested.
    pub(super) kept: Vec<Contribution>,
    pub(super) residuals: Residuals,
}

/// Number of such elements.
pub(super) fn near_count<const D: usize>(problem: &Problem<D>) -> usize {
    let mut touches = vec![false; problem.mesh().node_count()];
    problem.surface().nodes().iter().for_each(|contact| touches[contact.node.index()] = true);
    problem.mesh().cells().filter(|cell| cell.iter().any(|node| touches[node.index()])).count()
}

/// All such elements, by number.
pub(super) fn near_elements<const D: usize, const N: usize>(problem: &Problem<D>) -> Vec<NearElement<D, N>> {
    let mesh = problem.mesh();
    let mut of_node = vec![None; mesh.node_count()];
    for (at, contact) in problem.surface().nodes().iter().enumerate() {
        of_node[contact.node.index()].get_or_insert(at);
    }
    let mut faces = vec![Vec::new(); mesh.element_count()];
    for (f, face) in problem.surface().faces().iter().enumerate() {
        faces[mesh.face(face.face).owner.index()].push(f);
    }
    let near = |(e, faces): (usize, Vec<usize>)| {
        let contact = mesh.nodes_of::<N>()[e].map(|n| of_node[n.index()]);
        contact.iter().any(Option::is_some).then(|| NearElement {
            element: ElementId::new(e),
            form: ElementForm::new::<D, N>(problem, ElementId::new(e)),
            contact,
            faces,
            start: None,
            normal_work: 0.0,
            corner_friction: 0.0,
            residual: ResidualShare::default(),
            checks: 0,
            reached: None,
            plastic: PlasticMemory::default(),
            course: Course::default(),
            kept: Vec::new(),
            residuals: Residuals::default(),
        })
    };
    faces.into_iter().enumerate().filter_map(near).collect()
}

/// The data that all near elements share.
#[derive(Clone, Copy)]
pub(super) struct ContactSampling<'a, 'p, const D: usize, const N: usize> {
    pub(super) shared: &'a SharedData<'a, 'p, D, N>,
    pub(super) reconstruction: &'a dyn ReconstructionMethod<D, N>,
    /// The largest component of the initial velocity (m/s).
    pub(super) fastest: f64,
    /// Those of the contact nodes, with the motion at hand over the intervals that are sampled.
    pub(super) tracks: &'a [ContactMotion],
    /// The normal misfit of non-matching interfaces over these.
    pub(super) non_matching: &'a NonMatchingMisfit,
}

impl<const D: usize, const N: usize> NearElement<D, N> {
    /// Replaces the normal components by those of problem P_CA.
    fn settle(&self, context: &ContactSampling<'_, '_, D, N>, at: &mut ContactInstant<D, N>, instant: usize) {
        for (i, node) in self.contact.iter().enumerate() {
            if let Some(node) = *node {
                at.velocities.motion.set_normal((context.shared.problem, i, node), context.tracks, instant);
            }
        }
    }

    /// Samples the next interval that was appended, between these steps, at its beginning, in the middle and at its
    /// end.
    pub(super) fn sample(
        &mut self,
        context: &ContactSampling<'_, '_, D, N>,
        steps: [usize; 2],
        numbers: &mut Reader<'_>,
    ) -> [ElementSample; 3] {
        let mut waiting = Waiting::read(numbers);
        let sampler = ElementSampler::new(context.shared, self.element);
        let Some(mut start) = self.start.take() else { return Default::default() };
        if steps[0] == 0 {
            self.settle(context, &mut start, 0);
            self.check_start(context, sampler.element, &start.velocities);
            if let Some(stress) = &waiting.start {
                let hats = self.hat_stress(context, &waiting.hats[0]);
                self.yield_further(&sampler, (stress, &start.velocities), &hats);
            }
        }
        let stop = 2 * steps[1];
        if let Some(mid) = &mut waiting.mid {
            self.settle(context, &mut mid.at, stop - 1);
            let [before, after] = waiting.touching;
            let touching = std::array::from_fn(|i| [0, 1].map(|k| before[i][k] && after[i][k]));
            self.check_contact(context, &mid.at.velocities, &touching, stop - 1);
        }
        self.settle(context, &mut waiting.stop.at, stop);
        self.check_contact(context, &waiting.stop.at.velocities, &waiting.touching[1], stop);
        let [from, to] = &waiting.hats;
        let hats = [from, &NarrowHat::mean(from, to), to].map(|hats| self.hat_stress(context, hats));
        let plastic = self.yield_further(&sampler, (&waiting.stop.stress, &waiting.stop.at.velocities), &hats[2]);
        let [before, after] = waiting.residual;
        let interval = ElementInterval {
            steps,
            start: waiting.start.as_ref().map(|stress| (stress, &start.velocities)),
            mid: waiting.mid.as_ref().map(|mid| (&mid.stress, &mid.at.velocities)),
            end: (&waiting.stop.stress, &waiting.stop.at.velocities),
            contact: self.contact_part(context, &waiting, (steps, start.friction)),
            residual: [before, ResidualStress::mean(&before, &after), after],
            hats: [&hats[0], &hats[1], &hats[2]],
            plastic,
        };
        let (samples, [begin, middle, end]) = sampler.sample(&interval, &mut self.course, &mut self.kept);
        let begin = if interval.start.is_some() { begin } else { self.residual.last };
        let [from, to] = steps.map(|n| context.shared.times.instants()[n]);
        self.residual.integral += trapezoid(to - from, begin, interval.mid.map(|_| middle), end);
        self.residual.last = end;
        self.start = Some(waiting.stop.at);
        samples
    }

    /// The plastic parts at the beginning, the middle and the end of an interval, at which these fields are.
    fn yield_further(
        &mut self,
        sampler: &ElementSampler<'_, '_, D, N>,
        (stress, at): SampledFields<'_, D, N>,
        hats: &[HatStress<'_>],
    ) -> Option<[PlasticPart<D>; 3]> {
        let (law, volume) = sampler.measure.yielding()?;
        let (before, mut mean) = (self.plastic.last, stress.mean);
        for hat in hats {
            let of_hat = sampler.measure.mean_of_hats(hat);
            (0..D).for_each(|a| (0..D).for_each(|b| mean[a][b] += of_hat[a][b]));
        }
        self.plastic.advance(law, volume, &sampler.measure.elastic_gradient(&at.motion, None), &mean);
        Some([before, PlasticPart::middle(&before, &self.plastic.last), self.plastic.last])
    }

    /// The non-matching interfaces, by their index, to which the element belongs.
    pub(super) fn non_matching(&self, problem: &Problem<D>) -> Option<usize> {
        self.contact.iter().flatten().find_map(|&at| problem.surface().non_matching_of(at))
    }

    /// The stress of hats in the element.
    fn hat_stress<'c>(&self, context: &ContactSampling<'c, '_, D, N>, hats: &[NarrowHat<D>]) -> Vec<HatStress<'c>> {
        let Some(concentration) = context.reconstruction.concentration() else { return Vec::new() };
        let stars = hats.chunk_by(|a, b| a.star == b.star);
        stars.filter_map(|hats| concentration.in_element(context.shared.problem, hats, self.element)).collect()
    }

    /// The contact part of η at the beginning, middle and end of an interval (J).
    fn contact_part(
        &mut self,
        context: &ContactSampling<'_, '_, D, N>,
        waiting: &Waiting<D, N>,
        (steps, friction): ([usize; 2], f64),
    ) -> [ContactPart; 3] {
        let mut normal = NormalMisfit::default();
        let (surface, weight) = (context.shared.problem.surface(), context.reconstruction.weight_of_work());
        for &f in self.faces.iter().filter(|&&f| surface.non_matching_of(surface.faces()[f].nodes[0]).is_some()) {
            normal.add(&context.non_matching.over(f, steps, context.shared.times, weight));
        }
        for pressures in &waiting.pressures {
            normal.add(&context.reconstruction.normal_misfit(pressures, context.tracks));
        }
        let mut frictions =
            [friction, waiting.mid.as_ref().map_or(0.0, |mid| mid.at.friction), waiting.stop.at.friction];
        frictions.iter_mut().zip(self.beside_corners(context, waiting)).for_each(|(all, corner)| *all += corner);
        let so_far = self.normal_work;
        self.normal_work += normal.work[2];
        std::array::from_fn(|k| {
            let normal_work = so_far + normal.work[k];
            ContactPart { total: frictions[k] + normal_work + normal.energy[k], normal_work }
        })
    }

    /// The part of friction beside nodes at two planes at the beginning, middle and end of an interval (J).
    fn beside_corners(&mut self, context: &ContactSampling<'_, '_, D, N>, waiting: &Waiting<D, N>) -> [f64; 3] {
        let SharedData { problem, times, .. } = context.shared;
        let (start, first) = (self.corner_friction, waiting.sliding.first().map(|sliding| sliding.step));
        let mut middle = start;
        for sliding in &waiting.sliding {
            let [half, all] = sliding.misfit(problem, times, context.tracks);
            middle += if Some(sliding.step) == first { half } else { 0.0 };
            self.corner_friction += all;
        }
        [start, middle, self.corner_friction]
    }

    /// u_CA and u̇_CA against the initial conditions.
    fn check_start(
        &mut self,
        context: &ContactSampling<'_, '_, D, N>,
        element: &Element<D, N>,
        first: &ElementVelocities<D, N>,
    ) {
        let size = context.shared.problem.mesh().size();
        let displacement = element.gather(context.shared.problem.initial_displacement());
        let velocity = element.gather(context.shared.problem.initial_velocity());
        for i in 0..N {
            for c in 0..D {
                let u = (first.motion.displacement()[i][c] - displacement[i][c]).abs() / size;
                let v = (first.motion.velocity()[i][c] - velocity[i][c]).abs();
                let v = if v == 0.0 { 0.0 } else { v / context.fastest };
                self.residuals.initial_conditions = worse(worse(self.residuals.initial_conditions, u), v);
            }
        }
    }

    /// Normal velocity of nodes that touch at an instant, and penetration of those that may.
    fn check_contact(
        &mut self,
        context: &ContactSampling<'_, '_, D, N>,
        velocities: &ElementVelocities<D, N>,
        touching: &[[bool; 2]; N],
        instant: usize,
    ) {
        let problem = context.shared.problem;
        let speed = |v: &[f64; D]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        for (i, first) in self.contact.iter().enumerate() {
            let second = first.and_then(|at| problem.surface().nodes()[at].second_slot);
            for (k, at) in [*first, second].into_iter().enumerate() {
                // Those of non-matching interfaces are checked where their motion is made.
                let Some(at) = at.filter(|&at| problem.surface().non_matching_of(at).is_none()) else { continue };
                let contact = &problem.surface().nodes()[at];
                let (velocity, displacement) = (&velocities.motion.velocity()[i], &velocities.motion.displacement()[i]);
                // The element does not have the motion of a node of another body.
                let (normal, gap) = match contact.partner {
                    Some(_) => context.tracks[at].at(instant),
                    None => {
                        let frame = problem.obstacles()[contact.obstacle].flat_frame();
                        (frame.split(velocity).0, problem.surface().gap(at, displacement))
                    }
                };
                if touching[i][k] && contact.free {
                    let moving = speed(velocity).max(AT_REST * context.fastest);
                    let residual = if normal == 0.0 { 0.0 } else { normal.abs() / moving };
                    self.residuals.normal_velocity = worse(self.residuals.normal_velocity, residual);
                }
                let depth = worse(0.0, -gap / problem.mesh().size());
                self.residuals.penetration_at_instants = worse(self.residuals.penetration_at_instants, depth);
            }
        }
    }
}

#[cfg(test)]
mod tests;
