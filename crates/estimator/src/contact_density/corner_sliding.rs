//! Friction on faces with a node at two planes.
//!
//! Sliding along one plane is motion towards the other there. It is known when problem P_CA is solved at the other.

use super::{Densities, FaceDensity, NarrowHat, face_power};
use crate::kinematic::{ContactMotion, at_both_planes};
use crate::numbers::Reader;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// The densities and velocities on such a face over a step.
#[derive(Clone, Debug)]
pub(crate) struct CornerSliding<const D: usize> {
    /// Position among the candidate faces.
    pub(crate) face: usize,
    /// The step at whose instant it begins.
    pub(crate) step: usize,
    /// Velocities of the simulation at its nodes at its beginning, middle and end (m/s).
    velocity: [[[f64; D]; D]; 3],
    /// The part of the density that is linear, at its beginning and end (Pa).
    wide: [[[f64; D]; D]; 2],
    /// The rest.
    hats: [Vec<NarrowHat<D>>; 2],
}

impl<const D: usize> CornerSliding<D> {
    /// Those over a step from this one on, with these velocities of all nodes at its beginning, middle and end, and
    /// densities at its beginning and end.
    pub(crate) fn all(
        problem: &Problem<D>,
        step: usize,
        velocities: [&[[f64; D]]; 3],
        densities: [&Densities<D>; 2],
    ) -> Vec<Self> {
        let surface = problem.surface();
        let corners = surface.faces().iter().enumerate().filter(|(_, face)| surface.reaches_a_corner(face));
        let one = |(f, face): (usize, &percute_core::contact::ContactFace<D>)| Self {
            face: f,
            step,
            velocity: velocities.map(|velocity| face.nodes.map(|at| surface.against_obstacle(at, velocity))),
            wide: densities.map(|density| density.wide()[f]),
            hats: densities.map(|density| density.hats().iter().filter(|hat| hat.face == f).copied().collect()),
        };
        corners.map(one).collect()
    }

    /// Its misfit up to the middle and the end of the step (J): the trapezoidal rule over its three half-step instants.
    pub(crate) fn misfit(&self, problem: &Problem<D>, times: &TimeGrid, tracks: &[ContactMotion]) -> [f64; 2] {
        let nodes = problem.surface().faces()[self.face].nodes;
        let density = |k: usize| FaceDensity { wide: &self.wide[k], hats: [&self.hats[k][..]; 1] };
        let [start, end] = [density(0), density(1)];
        let power = |half: usize, densities: &[&FaceDensity<'_, D, 1>]| {
            let instant = 2 * self.step + half;
            let at = |p: usize| at_both_planes(problem, nodes[p], &self.velocity[half][p], tracks, instant);
            face_power(problem, self.face, &std::array::from_fn(at), densities)
        };
        let powers = [power(0, &[&start]), power(1, &[&start, &end]), power(2, &[&end])];
        trapezoids(times.step(self.step), powers)
    }

    /// Appends it to numbers.
    pub(crate) fn append(&self, numbers: &mut Vec<f64>) {
        numbers.extend([self.face, self.step, self.hats[0].len(), self.hats[1].len()].map(|count| count as f64));
        numbers.extend_from_slice(self.velocity.as_flattened().as_flattened());
        numbers.extend_from_slice(self.wide.as_flattened().as_flattened());
        self.hats.iter().flatten().for_each(|hat| hat.append(numbers));
    }

    /// One that was appended.
    pub(crate) fn read(numbers: &mut Reader<'_>) -> Self {
        let [face, step, from, to] = [(); 4].map(|()| numbers.count());
        let velocity = [(); 3].map(|()| numbers.vectors());
        let wide = [(); 2].map(|()| numbers.vectors());
        let hats = [from, to].map(|count| (0..count).map(|_| NarrowHat::read(numbers)).collect());
        Self { face, step, velocity, wide, hats }
    }
}

/// Integrals over the first half and all of a step of this length (s), from powers at its three half-step instants.
pub(crate) fn trapezoids(length: f64, [start, middle, end]: [f64; 3]) -> [f64; 2] {
    // 2∫[…], twice over half a step each.
    [0.5 * length * (start + middle), 0.5 * length * (start + 2.0 * middle + end)]
}
