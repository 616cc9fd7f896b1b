//! Smoothing of the impulses that stop a node.
//!
//! The simulation stops the lumped mass of a node that arrives within a step. As a density, the reaction of that step
//! would grow without bound as steps become shorter. An exact impact at speed v exerts ρcv: it
//! stops the mass m of the tributary depth m/(ρℓ) in a time of the order of τ = m/(ρcℓ), a wave's through that depth.
//! So the part of a reaction that changes the motion of its node is spread, with decreasing weight, over the time τ
//! that follows. Of two nodes that touch, the mass is 1/(1/m + 1/m'), and 1/(ρc) the sum of both. Steps as long as τ
//! change nothing; on a uniform bar these are steps from half the critical one on.

use percute_core::contact_results::stopping_times;
use percute_core::material::VonMises;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;
use std::collections::VecDeque;

/// The share of a reaction at a node at rest that is rounding: not worth a record for the steps to come.
const NEGLIGIBLE: f64 = 1e-9;

/// The impulses under way at each node of the contact surface.
#[derive(Clone, Debug)]
pub(super) struct ImpulseSmoothing<const D: usize> {
    /// τ (s) of an elastic body.
    time: Vec<f64>,
    /// The law of each node, where materials yield.
    laws: Vec<VonMises>,
    /// Speeds at which nodes approached before they touched (m/s), where materials yield.
    speeds: Vec<f64>,
    pending: Vec<VecDeque<Pending<D>>>,
}

/// What a force of a node stops, where it changes in time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stopped {
    /// The mass that it moves (kg).
    pub(super) mass: f64,
    /// τ (s).
    pub(super) time: f64,
    /// The relative acceleration along the normal (m/s²).
    pub(super) acceleration: f64,
}

/// An impulse on its way.
#[derive(Clone, Copy, Debug)]
struct Pending<const D: usize> {
    /// When it began (s).
    start: f64,
    /// τ over that of an elastic body.
    slowing: f64,
    /// Its rest (N s).
    impulse: [f64; D],
}

impl<const D: usize> ImpulseSmoothing<D> {
    pub(super) fn new(problem: &Problem<D>) -> Self {
        let time = stopping_times(problem);
        let laws = if problem.yields() { laws(problem) } else { Vec::new() };
        Self { pending: vec![VecDeque::new(); time.len()], time, speeds: vec![0.0; laws.len()], laws }
    }

    /// The time τ of a node (s): longer in a material that has yielded under the impact.
    pub(super) fn time(&self, at: usize) -> f64 {
        self.slowing(at) * self.time[at]
    }

    /// τ over that of an elastic body.
    fn slowing(&self, at: usize) -> f64 {
        self.laws.get(at).map_or(1.0, |law| law.slowing(self.speeds[at]))
    }

    /// Takes in v_{n−½} of the nodes (m/s), against their obstacles, and the reactions (N): nodes without any approach.
    pub(super) fn approach(&mut self, problem: &Problem<D>, half_step: &[[f64; D]], reaction: &[[f64; D]]) {
        let surface = problem.surface();
        for (at, speed) in self.speeds.iter_mut().enumerate().filter(|(at, _)| reaction[*at] == [0.0; D]) {
            let frame = problem.obstacles()[surface.nodes()[at].obstacle].flat_frame();
            let approach = -frame.split(&surface.against_obstacle(at, half_step)).0;
            // Of two bodies, each is stopped from about half of their relative speed.
            let rigid = problem.obstacles()[surface.nodes()[at].obstacle].as_plane().is_some();
            *speed = if rigid { approach } else { 0.5 * approach };
        }
    }

    /// The forces (N) of step n, of which reactions and total accelerations are given, and the nodes that forces of
    /// non-matching interfaces stop. All their impulse is kept, but for the rest after the last step. Nothing depends
    /// on the length of later steps.
    pub(super) fn advance(
        &mut self,
        problem: &Problem<D>,
        times: &TimeGrid,
        n: usize,
        reaction: &[[f64; D]],
        acceleration: impl Fn(usize) -> [f64; D],
        stopped: &[Option<Stopped>],
    ) -> Vec<[f64; D]> {
        let (now, step) = (times.instants()[n], times.step(n.max(1) - 1));
        // The reaction at t_0 acts for half a step.
        let length = if n == 0 { times.velocity_step(0) } else { step };
        let mut forces = reaction.to_vec();
        let surface = problem.surface();
        for (k, (contact, force)) in surface.nodes().iter().zip(&mut forces).enumerate() {
            let frame = problem.obstacles()[contact.obstacle].flat_frame();
            let slides = stopped.get(k).copied().flatten();
            let (slowing, elastic) = (self.slowing(k), slides.map_or(self.time[k], |stopped| stopped.time));
            let time = slowing * elastic;
            let pending = &mut self.pending[k];
            let (normal, _) = frame.split(force);
            if normal > 0.0 && step < time {
                let stopped = slides.map_or_else(
                    || {
                        let mut towards = acceleration(contact.node.index());
                        if let Some(partner) = contact.partner {
                            let other = acceleration(surface.nodes()[partner].node.index());
                            (0..D).for_each(|c| towards[c] -= other[c]);
                        }
                        let mut part = frame.split(&towards).0;
                        if let Some(second) = contact.second_slot {
                            part = stopped_in_corner(problem, [k, second], reaction, part, &towards);
                        }
                        surface.moved_mass(k, problem.mass()) * part
                    },
                    |stopped| stopped.mass * stopped.acceleration,
                );
                let share = (stopped / normal).min(1.0);
                if share > NEGLIGIBLE {
                    pending.push_back(Pending { start: now, slowing, impulse: force.map(|f| share * f * length) });
                    *force = force.map(|f| (1.0 - share) * f);
                }
            }
            for one in pending.iter_mut() {
                let time = one.slowing * elastic;
                let part = part(1.0 - (now - one.start) / time, step / time, length / step);
                for c in 0..D {
                    force[c] += part * one.impulse[c] / length;
                    one.impulse[c] -= part * one.impulse[c];
                }
            }
            pending.retain(|one| one.start + one.slowing * elastic > now + step);
        }
        forces
    }
}

/// The law at each node of the contact surface: that of a face there.
fn laws<const D: usize>(problem: &Problem<D>) -> Vec<VonMises> {
    let (mesh, surface) = (problem.mesh(), problem.surface());
    let mut laws = vec![VonMises::new(&problem.materials()[0]); surface.nodes().len()];
    for face in surface.faces() {
        let law = VonMises::new(problem.material(mesh.face(face.face).owner));
        face.nodes.iter().for_each(|&k| laws[k] = law);
    }
    laws
}

/// The part of the acceleration of a node at two planes that the reaction of the first one causes, along its normal, if
/// both act. `across` is the acceleration along this normal.
fn stopped_in_corner<const D: usize>(
    problem: &Problem<D>,
    slots: [usize; 2],
    reaction: &[[f64; D]],
    across: f64,
    acceleration: &[f64; D],
) -> f64 {
    let frames = slots.map(|at| problem.obstacles()[problem.surface().nodes()[at].obstacle].flat_frame());
    if frames[1].split(&reaction[slots[1]]).0 <= 0.0 {
        return across;
    }
    let cosine = frames[0].split(frames[1].normal()).0;
    (across - cosine * frames[1].split(acceleration).0) / (1.0 - cosine * cosine)
}

/// The part of the rest of an impulse that is due. Its weight is now `weight` and falls by `fall` in each step; this
/// step counts for a `share` of one. The part is this weight over the sum of all that follow, an arithmetic series.
fn part(weight: f64, fall: f64, share: f64) -> f64 {
    let count = (weight / fall).ceil() - 1.0;
    if count < 1.0 {
        return 1.0;
    }
    let later = count * weight - 0.5 * count * (count + 1.0) * fall;
    share * weight / (share * weight + later)
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::contact::Obstacle;
    use percute_core::material::Elastic;
    use percute_core::mesh::Mesh;

    /// h = ½, c = 2, ρS = 3: m = ¾ at the end of the bar, ρcS = 6, so that τ = ⅛.
    fn bar() -> Problem<1> {
        Problem::<1>::builder(Mesh::uniform_bar(1.0, 2).unwrap())
            .material(Elastic::bar(12.0, 3.0, 1.0).unwrap())
            .obstacle(Obstacle::plane([-1.0], [1.0], 0.0, None).unwrap())
            .build()
            .unwrap()
    }

    /// Forces of some steps, from reactions at the end of the bar and the accelerations of its node.
    fn forces(times: &TimeGrid, steps: &[(f64, f64)]) -> Vec<f64> {
        let problem = bar();
        let mut smoothing = ImpulseSmoothing::new(&problem);
        let one = |(n, &(reaction, acceleration)): (usize, &(f64, f64))| {
            let all = |node| [if node == 0 { acceleration } else { 0.0 }];
            smoothing.advance(&problem, times, n, &[[reaction]], all, &[])[0][0]
        };
        steps.iter().enumerate().map(one).collect()
    }

    /// Steps of τ/2 have weights 1 and ½. A reaction of 9 of which ma = ¾·8 = 6 stops the node leaves 3 + 6·⅔ and
    /// 6·⅓ at the next step; what holds a node at rest is not touched.
    #[test]
    fn impulses_are_spread_and_kept() {
        let times = TimeGrid::uniform(1.0, 16).unwrap();
        let made = forces(&times, &[(0.0, 0.0), (9.0, 8.0), (5.0, 0.0), (0.0, 0.0)]);
        let expected = [0.0, 7.0, 7.0, 0.0];
        assert!(made.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{made:?}");
    }

    /// As steps become shorter, the force tends to twice what the exact impact exerts, 2ρcv = 24 for v = 2, and its
    /// impulse is mv.
    #[test]
    fn short_steps_make_no_spike() {
        for count in [400, 4000] {
            let (times, step) = (TimeGrid::uniform(1.0, count).unwrap(), 1.0 / count as f64);
            let stop = 2.0 / step;
            let mut steps = vec![(0.75 * stop, stop)];
            steps[0] = (0.0, 0.0);
            steps.push((0.75 * stop, stop));
            steps.resize(count / 4, (0.0, 0.0));
            let made = forces(&times, &steps);
            assert!((made.iter().sum::<f64>() * step - 1.5).abs() < 1e-12);
            // Of first order in Δt/τ.
            assert!((made[1] / 24.0 - 1.0).abs() < 1.1 * step / 0.125, "{}", made[1]);
        }
    }

    /// What would come after the end is lost, in a time that does not depend on how short the last step is: half of the
    /// impulse where the end is at (1 − √½)τ, wherever steps are short.
    #[test]
    fn a_short_last_step_is_no_work() {
        let reach = (1.0 - 0.5_f64.sqrt()) * 0.125;
        let mut instants: Vec<f64> = (0..=1000).map(|k| reach * k as f64 / 1000.0).collect();
        instants.push(reach + 1e-13);
        let times = TimeGrid::from_instants(instants).unwrap();
        let step = times.step(0);
        let mut steps = vec![(0.0, 0.0); 1002];
        steps[1] = (0.75 * 2.0 / step, 2.0 / step);
        let kept: f64 = forces(&times, &steps).iter().sum::<f64>() * step;
        // Of first order in Δt/τ.
        assert!((kept / 1.5 - 0.5).abs() < 2e-3, "{kept}");
    }

    /// Steps as long as τ are left alone, to the bit.
    #[test]
    fn long_steps_are_left_alone() {
        let times = TimeGrid::uniform(1.0, 8).unwrap();
        assert_eq!(forces(&times, &[(0.1, 0.0), (0.3, 0.4), (0.7, 0.1)]), [0.1, 0.3, 0.7]);
    }
}
