//! By how much a density that may act off contact misses the normal contact law.
//!
//! An exact normal contact force F_n acts only where the gap and the normal velocity are zero. Otherwise the energy
//! ∫F_n gap is the misfit of the law at displacement level. It is finite, and zero if and only if the complementarity
//! condition holds. ∫∫F_n|w_n| dt is the work of the normal force, which is zero in the exact solution. It accumulates,
//! because the waves that carry this energy in the exact solution are missing afterwards. F_n is here the reaction of
//! the simulation: a reaction that brings a node to rest within a step removes its kinetic energy, even where F_DA
//! distributes the impulse over a time in which the node is at rest.

use super::{Densities, along};
use crate::kinematic::ContactTrack;
use percute_core::contact::ContactFacet;
use percute_core::problem::Problem;
use percute_core::simplex::Simplex;
use percute_core::time::TimeGrid;

/// Normal pressures (Pa) at the nodes of a facet at one instant.
#[derive(Clone, Copy, Debug)]
struct Pressure<const D: usize> {
    /// Of the density.
    acting: [f64; D],
    /// Of the density that the reactions alone give, their impulses not spread in time.
    sudden: [f64; D],
}

impl<const D: usize> Pressure<D> {
    /// Halfway between two: pressures are linear in time over a step.
    fn middle(start: &Self, end: &Self) -> Self {
        let mean = |a: &[f64; D], b: &[f64; D]| std::array::from_fn(|p| 0.5 * (a[p] + b[p]));
        Self { acting: mean(&start.acting, &end.acting), sudden: mean(&start.sudden, &end.sudden) }
    }
}

/// Normal pressures on each candidate facet at the beginning and the end of one step.
#[derive(Clone, Debug)]
pub(crate) struct OffContact<const D: usize>(Vec<[Pressure<D>; 2]>);

impl<const D: usize> OffContact<D> {
    /// The pressures of the densities at both ends of a step, and of those that the reactions alone give.
    pub(crate) fn new<const N: usize>(
        problem: &Problem<D, N>,
        acting: [&Densities<D>; 2],
        sudden: &[Densities<D>; 2],
    ) -> Self {
        let one = |(f, facet): (usize, &ContactFacet<D>)| {
            let frame = problem.obstacles()[facet.obstacle].flat_frame();
            let normal = |densities: &Densities<D>| densities[f].map(|force| frame.split(&force).0);
            [0, 1].map(|end| Pressure { acting: normal(acting[end]), sudden: normal(&sudden[end]) })
        };
        Self(problem.surface().facets().iter().enumerate().map(one).collect())
    }
}

/// Normal pressures on one candidate facet over the steps of an interval between samples.
#[derive(Clone, Debug)]
pub(crate) struct FacetPressures<const D: usize> {
    /// Position among the candidate facets.
    facet: usize,
    /// First step of the interval.
    first: usize,
    steps: Vec<[Pressure<D>; 2]>,
}

/// Energies of an interval (J): at its beginning, middle and end.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NormalMisfit {
    /// ∫F_n gap.
    pub(crate) energy: [f64; 3],
    /// ∫∫F_n|w_n| dt since its beginning; the middle is that of its first step.
    pub(crate) work: [f64; 3],
}

impl NormalMisfit {
    /// Adds that of another facet.
    pub(crate) fn add(&mut self, other: &Self) {
        for k in 0..3 {
            self.energy[k] += other.energy[k];
            self.work[k] += other.work[k];
        }
    }
}

impl<const D: usize> FacetPressures<D> {
    /// Those of one facet over consecutive steps.
    pub(crate) fn gather(facet: usize, first: usize, steps: &[OffContact<D>]) -> Self {
        Self { facet, first, steps: steps.iter().map(|step| step.0[facet]).collect() }
    }

    /// The misfit over the interval, for the motion in the tracks; work by the trapezoidal rule over all half-step
    /// instants.
    pub(crate) fn misfit<const N: usize>(
        &self,
        problem: &Problem<D, N>,
        times: &TimeGrid,
        tracks: &[ContactTrack],
        weight_of_work: f64,
    ) -> NormalMisfit {
        let facet = &problem.surface().facets()[self.facet];
        let mut misfit = NormalMisfit::default();
        for (k, [start, end]) in self.steps.iter().enumerate() {
            let instant = 2 * (self.first + k);
            let middle = Pressure::middle(start, end);
            let at = |half: usize, pressure: &Pressure<D>| {
                let motion = facet.nodes.map(|at| tracks[at].at(instant + half));
                let energy = gap_energy(facet.area, &pressure.acting, &motion.map(|(_, gap)| gap.max(0.0)));
                let speed = motion.map(|(speed, _)| speed);
                (energy, normal_power(problem.mesh().simplex(), facet.area, &pressure.sudden, &speed))
            };
            let [(before, p0), (between, p1), (after, p2)] = [at(0, start), at(1, &middle), at(2, end)];
            let half = 0.5 * times.step(self.first + k);
            if k == 0 {
                misfit.energy[0] = before;
                misfit.energy[1] = between;
                misfit.work[1] = 0.5 * half * (p0 + p1);
            }
            misfit.energy[2] = after;
            misfit.work[2] += 0.5 * half * (p0 + 2.0 * p1 + p2);
        }
        misfit.work.iter_mut().for_each(|work| *work *= weight_of_work);
        misfit
    }
}

/// ∫F_n gap over a facet (J), both linear, the force in Pa.
fn gap_energy<const D: usize>(area: f64, force: &[f64; D], gap: &[f64; D]) -> f64 {
    let products: f64 = force.iter().zip(gap).map(|(f, g)| f * g).sum();
    area * (products + force.iter().sum::<f64>() * gap.iter().sum::<f64>()) / (D * (D + 1)) as f64
}

/// ∫F_n|w_n| over a facet (W), both linear, the force in Pa.
fn normal_power<const D: usize, const N: usize>(
    simplex: &dyn Simplex<D, N>,
    area: f64,
    force: &[f64; D],
    speed: &[f64; D],
) -> f64 {
    area * simplex.facet_mean(speed, &|weights| along(weights, force) * along(weights, speed).abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_core::simplex::{Bar, Triangle};

    /// The misfits of the normal law against the midpoint rule, which converges with the square of the interval.
    #[test]
    fn normal_law_on_an_edge() {
        let (area, force, gap) = (0.3, [2.0, 5.0], [1e-3, 4e-3]);
        let count = 20_000;
        let mean =
            |f: &dyn Fn(f64) -> f64| (0..count).map(|k| f((k as f64 + 0.5) / count as f64)).sum::<f64>() / count as f64;
        let line = |[a, b]: [f64; 2], s: f64| (1.0 - s) * a + s * b;
        for speed in [[3.0, 1.0], [-3.0, 1.0], [0.5, -4.0], [0.0, 0.0]] {
            let expected = area * mean(&|s| line(force, s) * line(speed, s).abs());
            assert!((normal_power(&Triangle {}, area, &force, &speed) - expected).abs() < 1e-8, "{speed:?}");
        }
        let expected = area * mean(&|s| line(force, s) * line(gap, s));
        assert!((gap_energy(area, &force, &gap) - expected).abs() < 1e-11);
        // On a bar both are products.
        assert_eq!((gap_energy(2.0, &[3.0], &[0.5]), normal_power(&Bar {}, 2.0, &[3.0], &[-0.5])), (3.0, 3.0));
    }
}
