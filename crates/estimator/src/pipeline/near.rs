//! Elements with a candidate node of contact: their tractions may have two values at an instant,
//! and their motion is known only when their nodes' next contact is.

use super::maps::{Contribution, Maps};
use super::totals::trapezoid;
use crate::element::Element;
use crate::kinematic::{ContactTrack, ElementMotion, Knot};
use crate::measure::{Balanced, ElementError, ElementMeasure};
use crate::options::Acceleration;
use crate::reconstruction::{FacetPressures, NormalMisfit};
use crate::residual::{Residuals, worse};
use crate::time_level::{Side, TimeLevel};
use crate::traction::Equilibration;
use percute_core::ids::ElementId;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use std::collections::VecDeque;

/// The pointwise equilibrium of σ_DA is checked at every instant of so many, each element in its turn:
/// more often than away from contact, where fewer things happen.
const CHECK: usize = 4;

/// η and d of an element over one interval between samples (J): at its beginning, in its middle and
/// at its end; the contact part comes last.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NearInterval {
    pub(crate) errors: [ElementError; 3],
    pub(crate) contact: [f64; 3],
}

/// The motion of an element at a knot, normal components still those of the simulation.
#[derive(Clone, Copy, Debug)]
struct Provisional<const D: usize, const N: usize> {
    knot: usize,
    motion: ElementMotion<D, N>,
    increment: [[f64; D]; N],
    contact: f64,
}

/// An interval that waits.
#[derive(Clone, Debug)]
struct Waiting<const D: usize, const N: usize> {
    start: Balanced<D, N>,
    end: Balanced<D, N>,
    mid: Option<Provisional<D, N>>,
    stop: Provisional<D, N>,
    /// Which nodes touch at the beginning and at the end.
    touching: [[bool; N]; 2],
    /// What presses on its candidate facets, where that may be off contact.
    pressed: Vec<FacetPressures<D>>,
}

/// One such element.
#[derive(Clone, Debug)]
pub(crate) struct NearElement<const D: usize, const N: usize> {
    pub(crate) element: ElementId,
    /// Position of each node in the contact surface.
    contact: [Option<usize>; N],
    /// Candidate facets that the element owns.
    facets: Vec<usize>,
    /// Where the next interval begins.
    start: Option<Provisional<D, N>>,
    queue: VecDeque<Waiting<D, N>>,
    /// ∫∫F_n|w_n| so far (J).
    normal_work: f64,
    pub(crate) intervals: Vec<NearInterval>,
    /// ∫η_E dt over them (J s).
    pub(crate) integral: f64,
    /// What it contributes at the steps requested.
    pub(crate) kept: Vec<Contribution>,
    pub(crate) residuals: Residuals,
}

/// All such elements, by number.
pub(crate) fn near_elements<const D: usize, const N: usize>(problem: &Problem<D, N>) -> Vec<NearElement<D, N>> {
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
            intervals: Vec::new(),
            integral: 0.0,
            kept: Vec::new(),
            residuals: Residuals::default(),
        })
    };
    facets.into_iter().enumerate().filter_map(near).collect()
}

/// What all near elements share.
#[derive(Clone, Copy)]
pub(crate) struct Context<'a, 'p, const D: usize, const N: usize> {
    pub(crate) problem: &'p Problem<D, N>,
    pub(crate) times: &'p TimeGrid,
    pub(crate) equilibration: &'a Equilibration<'p, D, N>,
    pub(crate) choice: Acceleration,
    /// Weight of the work of normal forces off contact.
    pub(crate) normal_work: f64,
    pub(crate) tracks: &'a [ContactTrack],
    pub(crate) maps: &'a Maps<D>,
}

impl<const D: usize, const N: usize> NearElement<D, N> {
    /// Takes in the intervals between consecutive levels, then works off those whose motion is
    /// known.
    pub(crate) fn advance(&mut self, context: &Context<'_, '_, D, N>, levels: &[TimeLevel<D>]) {
        let element = &context.equilibration.elements[self.element.index()];
        let measure = ElementMeasure::new(context.problem, element, self.element, context.choice);
        if self.start.is_none() {
            let mut first = self.provisional(element, &levels[0].knot, 0, 0.0);
            self.settle(context, &mut first);
            self.check_start(context, element, &first);
            self.start = Some(first);
        }
        for pair in levels.windows(2) {
            self.queue_interval(context, &measure, element, &pair[0], &pair[1]);
        }
        self.work_off(context, &measure);
    }

    fn queue_interval(
        &mut self,
        context: &Context<'_, '_, D, N>,
        measure: &ElementMeasure<'_, D, N>,
        element: &Element<D, N>,
        from: &TimeLevel<D>,
        to: &TimeLevel<D>,
    ) {
        let balanced = |level, side| measure.balanced(context.equilibration, level, &self.contact, side);
        let (start, end) = (balanced(from, Side::After), balanced(to, Side::Before));
        for (balanced, level) in [(&start, from), (&end, to)] {
            measure.check_resultants(balanced, level.force_scale, &mut self.residuals);
            if (level.index + self.element.index()).is_multiple_of(CHECK) {
                measure.check_stress(balanced, level.force_scale, &mut self.residuals);
            }
        }
        let contact = |k: usize| self.facets.iter().map(|&f| to.contact[f][k]).sum::<f64>();
        let single = to.index == from.index + 1;
        let mid = to.mid.as_ref().filter(|_| single);
        let mid = mid.map(|knot| self.provisional(element, knot, 2 * to.index - 1, contact(0)));
        let stop = self.provisional(element, &to.knot, 2 * to.index, contact(1));
        let touching = [from, to].map(|l| self.contact.map(|at| at.is_some_and(|at| l.surface.touching[at])));
        let pressed = |&facet: &usize| {
            let steps: Vec<_> = to.pressures.iter().map(|step| step[facet]).collect();
            FacetPressures { facet, first: from.index, steps }
        };
        let facets = if to.pressures.is_empty() { &[][..] } else { &self.facets };
        let pressed = facets.iter().map(pressed).collect();
        self.queue.push_back(Waiting { start, end, mid, stop, touching, pressed });
    }

    fn provisional(&self, element: &Element<D, N>, knot: &Knot<D>, index: usize, contact: f64) -> Provisional<D, N> {
        Provisional {
            knot: index,
            motion: ElementMotion::gather(knot, &element.nodes),
            increment: element.gather(&knot.increment),
            contact,
        }
    }

    /// Number of knots at which the motion of all contact nodes is known.
    fn known(&self, tracks: &[ContactTrack]) -> usize {
        self.contact.iter().flatten().map(|&at| tracks[at].known()).min().unwrap_or(0)
    }

    /// Replaces the normal components by those of problem P_CA.
    fn settle(&self, context: &Context<'_, '_, D, N>, provisional: &mut Provisional<D, N>) {
        for (i, at) in self.contact.iter().enumerate() {
            if let Some(at) = *at {
                let contact = &context.problem.surface().nodes()[at];
                let plane = &context.problem.obstacles()[contact.obstacle];
                provisional.motion.set_normal(i, plane, &context.tracks[at], provisional.knot);
            }
        }
    }

    fn work_off(&mut self, context: &Context<'_, '_, D, N>, measure: &ElementMeasure<'_, D, N>) {
        let known = self.known(context.tracks);
        while self.queue.front().is_some_and(|w| w.stop.knot < known) {
            let (Some(mut waiting), Some(start)) = (self.queue.pop_front(), self.start.take()) else { break };
            let error =
                |balanced: &Balanced<D, N>, at: &Provisional<D, N>| measure.error(balanced, &at.increment, &at.motion);
            let mut normal = NormalMisfit::default();
            for pressed in &waiting.pressed {
                normal.add(&pressed.misfit(context.problem, context.times, context.tracks));
            }
            normal.work.iter_mut().for_each(|work| *work *= context.normal_work);
            let so_far = self.normal_work;
            let contact = |k: usize, friction: f64| friction + (so_far + normal.work[k]) + normal.energy[k];
            let mut interval = NearInterval::default();
            interval.errors[0] = error(&waiting.start, &start);
            interval.contact[0] = contact(0, start.contact);
            if let Some(mid) = &mut waiting.mid {
                self.settle(context, mid);
                interval.errors[1] = error(&Balanced::middle(&waiting.start, &waiting.end), mid);
                interval.contact[1] = contact(1, mid.contact);
                let [before, after] = waiting.touching;
                let touching = std::array::from_fn(|i| before[i] && after[i]);
                self.check_contact(context, mid, &touching);
            }
            self.settle(context, &mut waiting.stop);
            interval.errors[2] = error(&waiting.end, &waiting.stop);
            interval.contact[2] = contact(2, waiting.stop.contact);
            self.normal_work += normal.work[2];
            self.check_contact(context, &waiting.stop, &waiting.touching[1]);
            self.take(context, [start.knot / 2, waiting.stop.knot / 2], waiting.mid.is_some(), interval);
            self.start = Some(waiting.stop);
        }
    }

    /// Adds an interval between two steps, and keeps what is requested of it.
    fn take(&mut self, context: &Context<'_, '_, D, N>, steps: [usize; 2], single: bool, interval: NearInterval) {
        let [from, to] = steps.map(|n| context.times.instants()[n]);
        let value = |k: usize| interval.errors[k].total() + interval.contact[k];
        self.keep(context, steps[0], &interval, 0);
        self.integral += trapezoid(to - from, value(0), single.then(|| value(1)), value(2));
        // Until the next interval, if there is one, tells what comes after it.
        self.keep(context, steps[1], &interval, 2);
        self.intervals.push(interval);
    }

    fn keep(&mut self, context: &Context<'_, '_, D, N>, step: usize, interval: &NearInterval, at: usize) {
        if context.maps.want(step) {
            self.kept.pop_if(|last| last.step == step);
            let (element, accumulated) = (self.element, self.integral);
            let (error, contact) = (interval.errors[at], interval.contact[at]);
            self.kept.push(Contribution { element, step, error, contact, accumulated });
        }
    }

    /// u_CA and u̇_CA against the initial conditions.
    fn check_start(&mut self, context: &Context<'_, '_, D, N>, element: &Element<D, N>, first: &Provisional<D, N>) {
        let size = context.problem.mesh().size();
        let fastest = context.problem.initial_velocity().iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
        let displacement = element.gather(context.problem.initial_displacement());
        let velocity = element.gather(context.problem.initial_velocity());
        for i in 0..N {
            for c in 0..D {
                let u = (first.motion.displacement()[i][c] - displacement[i][c]).abs() / size;
                let v = (first.motion.velocity()[i][c] - velocity[i][c]).abs();
                let v = if v == 0.0 { 0.0 } else { v / fastest };
                self.residuals.initial_conditions = worse(worse(self.residuals.initial_conditions, u), v);
            }
        }
    }

    /// Normal velocity of nodes that touch at a knot, and penetration of those that may.
    fn check_contact(&mut self, context: &Context<'_, '_, D, N>, at_knot: &Provisional<D, N>, touching: &[bool; N]) {
        let problem = context.problem;
        let speed = |v: &[f64; D]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        for (i, at) in self.contact.iter().enumerate() {
            let Some(at) = *at else { continue };
            let contact = &problem.surface().nodes()[at];
            let (velocity, displacement) = (&at_knot.motion.velocity()[i], &at_knot.motion.displacement()[i]);
            if touching[i] && contact.free {
                let normal = problem.obstacles()[contact.obstacle].split(velocity).0.abs();
                let residual = if normal == 0.0 { 0.0 } else { normal / speed(velocity) };
                self.residuals.normal_velocity = worse(self.residuals.normal_velocity, residual);
            }
            let gap = problem.surface().gap(at, displacement, problem.obstacles());
            let depth = worse(0.0, -gap / problem.mesh().size());
            self.residuals.penetration_at_knots = worse(self.residuals.penetration_at_knots, depth);
        }
    }
}

#[cfg(test)]
mod tests;
