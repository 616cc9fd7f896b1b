//! The misfit of the contact law on a face, for densities and velocities that are linear along it.

use super::NarrowHat;
use crate::direction::{along, tangent};
use percute_core::cell::face_mean;
use percute_core::contact::ContactFace;
use percute_core::problem::Problem;

/// A density on one face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceDensity<'a, const D: usize, const M: usize> {
    /// The part that is linear (Pa at its nodes).
    pub(crate) wide: &'a [[f64; D]; D],
    /// Hats, among them those of the face.
    pub(crate) hats: [&'a [NarrowHat<D>]; M],
}

impl<const D: usize, const M: usize> FaceDensity<'_, D, M> {
    /// Whether nothing acts on the face and on those beside it.
    pub(crate) fn is_zero(&self) -> bool {
        *self.wide == [[0.0; D]; D] && self.hats.iter().all(|hats| hats.is_empty())
    }
}

/// The power of the misfit of the mean of densities on a face (W), with this velocity at its nodes (m/s): hats keep
/// their shapes.
pub(crate) fn face_power<const D: usize, const M: usize>(
    problem: &Problem<D>,
    f: usize,
    velocity: &[[f64; D]; D],
    densities: &[&FaceDensity<'_, D, M>],
) -> f64 {
    let (surface, share) = (problem.surface(), 1.0 / densities.len() as f64);
    let face = &surface.faces()[f];
    let mut mean = [[0.0; D]; D];
    let mut power = 0.0;
    for density in densities {
        (0..D).for_each(|p| (0..D).for_each(|c| mean[p][c] += share * density.wide[p][c]));
        let hats = density.hats.iter().copied().flatten().filter(|hat| hat.face == f);
        power += hats.map(|hat| share * hat_misfit_power(problem, hat, velocity)).sum::<f64>();
    }
    surface.part_of_contact(face.nodes[0]) * (power + misfit_power(problem, face, &mean, velocity))
}

/// Power of ∫[b(−w, F) + w·F] on a face: μF_n‖w_t‖ + w_t·F_t (W). The normal part vanishes where F is zero
/// unless both nodes stay on the plane; elsewhere [`NormalMisfit`](super::NormalMisfit) measures it. In 2D both factors
/// are linear along the edge. In 3D ‖w_t‖ is not: the mean is that of points with positive weights, at none of which
/// the power is negative.
fn misfit_power<const D: usize>(
    problem: &Problem<D>,
    face: &ContactFace<D>,
    density: &[[f64; D]; D],
    velocity: &[[f64; D]; D],
) -> f64 {
    if D == 1 {
        return 0.0;
    }
    if density.iter().flatten().all(|f| *f == 0.0) {
        return 0.0;
    }
    let obstacle = &problem.obstacles()[face.obstacle];
    let (law, frame) = (obstacle.law(), obstacle.flat_frame());
    if D == 3 {
        let at = |weights: &[f64; D], values: &[[f64; D]; D]| -> [f64; D] {
            std::array::from_fn(|c| (0..D).map(|k| weights[k] * values[k][c]).sum())
        };
        let power = |weights: &[f64; D]| law.misfit_along(&frame, &at(weights, density), &at(weights, velocity));
        return face.area * face_mean(&[0.0; D], power);
    }
    let tangent = tangent(&frame);
    let (normal, tangential) = (density.map(|f| frame.split(&f).0), density.map(|f| along(&f, &tangent)));
    let sliding = velocity.map(|v| along(&v, &tangent));
    let power =
        |weights: &[f64; D]| law.misfit(along(weights, &normal), along(weights, &tangential), along(weights, &sliding));
    face.area * face_mean(&sliding, power)
}

/// The same of a hat (W).
fn hat_misfit_power<const D: usize>(problem: &Problem<D>, hat: &NarrowHat<D>, velocity: &[[f64; D]; D]) -> f64 {
    let obstacle = &problem.obstacles()[problem.surface().faces()[hat.face].obstacle];
    let (law, frame) = (obstacle.law(), obstacle.flat_frame());
    let tangent = tangent(&frame);
    let sliding = velocity.map(|v| along(&v, &tangent));
    let normal = frame.split(&hat.resultant).0;
    law.limit(normal) * hat.mean_absolute(&sliding) + along(&hat.resultant, &tangent) * hat.mean_of(&sliding)
}
