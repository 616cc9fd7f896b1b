//! Contact forces averaged over the time in which a wave crosses the struck element.
//!
//! The reaction of the step in which a node arrives stops its lumped mass: the shorter the step, the larger the force.
//! Its impulse is that of the mass, whatever the step, and so is its mean over a time of the mesh. On a uniform bar
//! that strikes a plane, the mean reaches ρcv, the stress of the exact impact.

use crate::material::Law;
use crate::problem::Problem;
use std::collections::VecDeque;

/// The times τ = m/(ρcℓ) in which contact stops the mass m of each node of the contact surface (s): a wave's through
/// the depth m/(ρℓ) of the tributary area ℓ, half of the element. Of two nodes that touch, the mass is 1/(1/m + 1/m'),
/// and 1/(ρc) the sum of both.
#[must_use]
pub fn stopping_times<const D: usize>(problem: &Problem<D>) -> Vec<f64> {
    let (mesh, surface) = (problem.mesh(), problem.surface());
    // ρcℓ.
    let mut impedance = vec![0.0; surface.nodes().len()];
    for face in surface.faces() {
        let law = problem.material(mesh.face(face.face).owner);
        face.nodes.iter().for_each(|&k| impedance[k] += law.density() * law.wave_speed() * face.area / D as f64);
    }
    let time = |at: usize| {
        let mass = surface.moved_mass(at, problem.mass());
        match surface.nodes()[at].partner {
            Some(partner) => mass * (1.0 / impedance[at] + 1.0 / impedance[partner]),
            None => mass / impedance[at],
        }
    };
    (0..surface.nodes().len()).map(time).collect()
}

/// The largest contact force, averaged over the time 2τ in which a wave crosses the struck element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AveragedPeak {
    /// The largest sum of the normal forces of all nodes (N), each averaged.
    pub force: f64,
    /// Its instant (s), at the end of the averages.
    pub time: f64,
    /// The largest pressure of a node (Pa): its averaged normal force over its area.
    pub pressure: f64,
    /// The place of this node in the contact surface.
    pub at: usize,
}

/// The averages of all nodes, over the steps that they take.
#[derive(Clone, Debug)]
pub(super) struct Averages {
    nodes: Vec<Average>,
    peak: Option<AveragedPeak>,
}

/// The average of one node.
#[derive(Clone, Debug)]
struct Average {
    /// 2τ (s).
    time: f64,
    /// Ends of steps (s), and the normal impulse until then (N s), from the last one before the average on; empty as
    /// long as the average is zero.
    past: VecDeque<[f64; 2]>,
}

impl Averages {
    pub(super) fn new<const D: usize>(problem: &Problem<D>) -> Self {
        let average = |time: f64| Average { time: 2.0 * time, past: VecDeque::new() };
        Self { nodes: stopping_times(problem).into_iter().map(average).collect(), peak: None }
    }

    /// The average normal force (N) of a node at the end (s) of a step of `length` (s), over which this force (N) acts;
    /// with its area (m²), for its pressure.
    pub(super) fn node(&mut self, at: usize, [end, length]: [f64; 2], force: f64, area: f64) -> f64 {
        let average = self.nodes[at].advance(end, length, force);
        if average > 0.0 {
            let peak = self.peak.get_or_insert(AveragedPeak { force: 0.0, time: end, pressure: 0.0, at });
            if average / area > peak.pressure {
                (peak.pressure, peak.at) = (average / area, at);
            }
        }
        average
    }

    /// Takes in the sum of the averages (N) at an instant (s).
    pub(super) fn sum(&mut self, time: f64, force: f64) {
        if let Some(peak) = self.peak.as_mut().filter(|peak| force > peak.force) {
            (peak.force, peak.time) = (force, time);
        }
    }

    /// The largest ones; none without any force.
    pub(super) fn peak(&self) -> Option<AveragedPeak> {
        self.peak.filter(|peak| peak.force > 0.0)
    }
}

impl Average {
    /// [`Averages::node`].
    fn advance(&mut self, end: f64, length: f64, force: f64) -> f64 {
        if force == 0.0 && self.past.is_empty() {
            return 0.0;
        }
        let before = self.past.back().map_or(0.0, |[_, impulse]| *impulse);
        if self.past.is_empty() {
            self.past.push_back([end - length, 0.0]);
        }
        self.past.push_back([end, before + force * length]);
        // An average over less than the step is the force of the step.
        if self.time <= length {
            self.past.clear();
            return force;
        }
        let start = end - self.time;
        while self.past.get(1).is_some_and(|[time, _]| *time <= start) {
            self.past.pop_front();
        }
        let average = (before + force * length - self.impulse(start)) / self.time;
        // Nothing acts over all of it: the next force begins anew, without the rounding of what was before.
        if self.past.iter().all(|[_, impulse]| *impulse == self.past[0][1]) {
            self.past.clear();
            return 0.0;
        }
        average
    }

    /// The impulse until an instant (s) between the first two ends, or before the first one (N s).
    fn impulse(&self, time: f64) -> f64 {
        let ([start, before], [end, after]) = (self.past[0], self.past[1]);
        if time <= start { before } else { before + (after - before) * (time - start) / (end - start) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn average(time: f64) -> Average {
        Average { time, past: VecDeque::new() }
    }

    /// An impulse in one step of a tenth gives what a force over the whole time gives, and is gone after it.
    #[test]
    fn an_impulse_counts_for_the_time_of_the_average() {
        let mut average = average(1.0);
        let forces = (0..25).map(|n| average.advance(0.1 * f64::from(n + 1), 0.1, if n == 2 { 50.0 } else { 0.0 }));
        let forces: Vec<f64> = forces.collect();
        for (n, force) in forces.iter().enumerate() {
            let expected = if (2..12).contains(&n) { 5.0 } else { 0.0 };
            assert!((force - expected).abs() < 1e-12, "{n}: {force}");
        }
        assert!(average.past.is_empty());
    }

    /// Over steps of any length the average of a constant force is that force, once it has lasted long enough.
    #[test]
    fn a_constant_force_is_its_average() {
        let (mut average, mut now) = (average(1.0), 0.0);
        for n in 0..40 {
            let length = 0.05 + 0.01 * f64::from(n % 7);
            now += length;
            let found = average.advance(now, length, 3.0);
            assert!((found - 3.0 * f64::min(now, 1.0)).abs() < 1e-12, "{n}: {found}");
        }
    }

    #[test]
    fn a_long_step_keeps_its_force() {
        let mut average = average(0.5);
        assert_eq!([7.3, 0.1, 0.0].map(|force| average.advance(1.0, 0.5, force)), [7.3, 0.1, 0.0]);
    }
}
