//! By how much a density that may act off contact misses the normal contact law.
//!
//! An exact normal contact force F_n acts only where the gap and the normal velocity are zero. Otherwise the energy
//! ∫F_n gap is the misfit of the law at displacement level. It is finite, and zero if and only if the complementarity
//! condition holds. ∫∫F_n|w_n| dt is the work of the normal force, which is zero in the exact solution. It accumulates,
//! because the waves that carry this energy in the exact solution are missing afterwards. F_n is here the reaction of
//! the simulation: a reaction that brings a node to rest within a step removes its kinetic energy, even where F_DA
//! distributes the impulse over a time in which the node is at rest.

use super::{Densities, NarrowHat, along};
use crate::kinematic::ContactTrack;
use crate::numbers::Reader;
use percute_core::problem::Problem;
use percute_core::simplex::Simplex;
use percute_core::time::TimeGrid;

/// A normal force on a facet: linear along it, and hats.
#[derive(Clone, Debug)]
struct NormalForce<const D: usize> {
    /// Pressure at the nodes (Pa).
    linear: [f64; D],
    hats: Vec<(NarrowHat<D>, f64)>,
}

impl<const D: usize> NormalForce<D> {
    /// Those of a density on all facets.
    fn all<const N: usize>(problem: &Problem<D, N>, densities: &Densities<D>) -> Vec<Self> {
        let normal = |facet: usize, force: &[f64; D]| {
            problem.obstacles()[problem.surface().facets()[facet].obstacle].flat_frame().split(force).0
        };
        let linear = densities.wide().iter().enumerate().map(|(f, values)| values.map(|force| normal(f, &force)));
        let mut all: Vec<Self> = linear.map(|linear| Self { linear, hats: Vec::new() }).collect();
        for hat in densities.hats() {
            all[hat.facet].hats.push((*hat, normal(hat.facet, &hat.resultant)));
        }
        all
    }

    fn is_zero(&self) -> bool {
        self.linear == [0.0; D] && self.hats.is_empty()
    }

    fn append(&self, numbers: &mut Vec<f64>) {
        numbers.extend_from_slice(&self.linear);
        numbers.push(self.hats.len() as f64);
        for (hat, force) in &self.hats {
            hat.append(numbers);
            numbers.push(*force);
        }
    }

    fn read(numbers: &mut Reader<'_>) -> Self {
        let (linear, hats) = (numbers.take(), numbers.count());
        Self { linear, hats: (0..hats).map(|_| (NarrowHat::read(numbers), numbers.number())).collect() }
    }

    /// ∫F_n gap (J).
    fn gap_energy(&self, area: f64, gap: &[f64; D]) -> f64 {
        let open = gap.map(|gap| gap.max(0.0));
        let hats: f64 = self.hats.iter().map(|(hat, force)| force * hat.mean_positive(gap)).sum();
        gap_energy(area, &self.linear, &open) + hats
    }

    /// ∫F_n|w_n| (W).
    fn power<const N: usize>(&self, simplex: &dyn Simplex<D, N>, area: f64, speed: &[f64; D]) -> f64 {
        let hats: f64 = self.hats.iter().map(|(hat, force)| force * hat.mean_absolute(speed)).sum();
        normal_power(simplex, area, &self.linear, speed) + hats
    }
}

/// The normal forces on a facet at one instant.
#[derive(Clone, Debug)]
struct Normal<const D: usize> {
    /// Of the density.
    acting: NormalForce<D>,
    /// Of the density that the reactions alone give, their impulses not spread in time.
    sudden: NormalForce<D>,
}

/// Normal forces on each candidate facet at the beginning and the end of one step.
#[derive(Clone, Debug)]
pub(crate) struct OffContact<const D: usize>(Vec<[Normal<D>; 2]>);

impl<const D: usize> OffContact<D> {
    /// Those of the densities at both ends of a step, and of those that the reactions alone give.
    pub(crate) fn new<const N: usize>(
        problem: &Problem<D, N>,
        acting: [&Densities<D>; 2],
        sudden: [&Densities<D>; 2],
    ) -> Self {
        let end = |k: usize| {
            let (acting, sudden) = (NormalForce::all(problem, acting[k]), NormalForce::all(problem, sudden[k]));
            acting.into_iter().zip(sudden).map(|(acting, sudden)| Normal { acting, sudden })
        };
        Self(end(0).zip(end(1)).map(|(start, end)| [start, end]).collect())
    }
}

/// Normal forces on one candidate facet over the steps of an interval between samples.
#[derive(Clone, Debug)]
pub(crate) struct FacetPressures<const D: usize> {
    /// Position among the candidate facets.
    facet: usize,
    /// First step of the interval.
    first: usize,
    steps: Vec<[Normal<D>; 2]>,
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
        Self { facet, first, steps: steps.iter().map(|step| step.0[facet].clone()).collect() }
    }

    /// Whether there is no force.
    pub(crate) fn is_zero(&self) -> bool {
        self.steps.as_flattened().iter().all(|normal| normal.acting.is_zero() && normal.sudden.is_zero())
    }

    /// Appends them to numbers.
    pub(crate) fn append(&self, numbers: &mut Vec<f64>) {
        numbers.extend([self.facet, self.first, self.steps.len()].map(|count| count as f64));
        for normal in self.steps.as_flattened() {
            normal.acting.append(numbers);
            normal.sudden.append(numbers);
        }
    }

    /// Pressures that were appended.
    pub(crate) fn read(numbers: &mut Reader<'_>) -> Self {
        let [facet, first, steps] = [(); 3].map(|()| numbers.count());
        let mut end = || Normal { acting: NormalForce::read(numbers), sudden: NormalForce::read(numbers) };
        Self { facet, first, steps: (0..steps).map(|_| [end(), end()]).collect() }
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
            let at = |half: usize, normal: &Normal<D>| {
                let motion = facet.nodes.map(|at| tracks[at].at(instant + half));
                let energy = normal.acting.gap_energy(facet.area, &motion.map(|(_, gap)| gap));
                let speed = motion.map(|(speed, _)| speed);
                (energy, normal.sudden.power(problem.mesh().simplex(), facet.area, &speed))
            };
            let ([(before, p0), (after, p2)], [a, b]) = ([at(0, start), at(2, end)], [at(1, start), at(1, end)]);
            // Forces are linear in time over a step.
            let (between, p1) = (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1));
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
