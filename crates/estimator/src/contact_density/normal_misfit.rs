//! By how much a density that may act off contact misses the normal contact law.
//!
//! An exact normal contact force F_n acts only where the gap and the normal velocity are zero. Otherwise the energy
//! ∫F_n gap is the misfit of the law at displacement level. It is finite, and zero if and only if the complementarity
//! condition holds. ∫ΣF_n|w_n| dt is the work of the normal forces, which is zero in the exact solution. It
//! accumulates, because the waves that carry this energy in the exact solution are missing afterwards. w_n is the gap
//! rate of the node of each force: the far end of an edge moves freely under it and loses nothing. F_n is here the
//! reaction of the simulation: a reaction that brings a node to rest within a step removes its kinetic energy, even
//! where F_DA distributes the impulse over a time in which the node is at rest.

use super::{Densities, NarrowHat};
use crate::kinematic::ContactMotion;
use crate::numbers::Reader;
use percute_core::problem::Problem;
use percute_core::time::TimeGrid;

/// A normal force on a face: linear along it, and hats.
#[derive(Clone, Debug)]
struct NormalForce<const D: usize> {
    /// Pressure at the nodes (Pa).
    linear: [f64; D],
    hats: Vec<(NarrowHat<D>, f64)>,
}

impl<const D: usize> NormalForce<D> {
    const NONE: Self = Self { linear: [0.0; D], hats: Vec::new() };

    fn is_zero(&self) -> bool {
        self.linear == [0.0; D] && self.hats.is_empty()
    }

    fn append(&self, numbers: &mut Vec<f64>, has_hats: bool) {
        numbers.extend_from_slice(&self.linear);
        if has_hats {
            numbers.push(self.hats.len() as f64);
        }
        for (hat, force) in &self.hats {
            hat.append(numbers);
            numbers.push(*force);
        }
    }

    fn read(numbers: &mut Reader<'_>, has_hats: bool) -> Self {
        let (linear, hats) = (numbers.take(), if has_hats { numbers.count() } else { 0 });
        Self { linear, hats: (0..hats).map(|_| (NarrowHat::read(numbers), numbers.number())).collect() }
    }

    /// ∫F_n gap (J).
    fn gap_energy(&self, area: f64, gap: &[f64; D]) -> f64 {
        let open = gap.map(|gap| gap.max(0.0));
        let hats: f64 = self.hats.iter().map(|(hat, force)| force * hat.mean_positive(gap)).sum();
        gap_energy(area, &self.linear, &open) + hats
    }

    /// The power of the normal force of each node at the rate of its own gap (W).
    fn power(&self, area: f64, speed: &[f64; D]) -> f64 {
        let hats: f64 = self.hats.iter().map(|(hat, force)| force * speed[hat.end].abs()).sum();
        normal_power(area, &self.linear, speed) + hats
    }
}

/// The normal forces on a face at one instant.
#[derive(Clone, Debug)]
struct Normal<const D: usize> {
    /// Of the density.
    acting: NormalForce<D>,
    /// Of the density that the reactions alone give, their impulses not spread in time.
    sudden: NormalForce<D>,
}

/// The part of a normal force that is linear on a face: at the beginning and the end of a step, at the nodes (Pa).
#[derive(Clone, Debug)]
struct LinearForce<const D: usize> {
    face: usize,
    ends: [[f64; D]; 2],
}

/// A hat at the beginning or the end of a step, with its normal force (N).
#[derive(Clone, Debug)]
struct HatForce<const D: usize> {
    end: usize,
    hat: NarrowHat<D>,
    force: f64,
}

impl<const D: usize> HatForce<D> {
    /// Its place in the order.
    fn place(&self) -> (usize, usize) {
        (self.end, self.hat.face)
    }
}

/// Normal forces at the beginning and the end of one step, where there are any, in the order of the faces; those of
/// hats at the beginning come first.
#[derive(Clone, Debug)]
struct NormalForces<const D: usize> {
    linear: Vec<LinearForce<D>>,
    hats: Vec<HatForce<D>>,
}

impl<const D: usize> NormalForces<D> {
    const NONE: Self = Self { linear: Vec::new(), hats: Vec::new() };

    /// Those of the densities at both ends of a step.
    fn new(problem: &Problem<D>, densities: [&Densities<D>; 2]) -> Self {
        let normal = |face: usize, force: &[f64; D]| {
            problem.obstacles()[problem.surface().faces()[face].obstacle].flat_frame().split(force).0
        };
        let linear = (0..problem.surface().faces().len()).filter_map(|face| {
            let wide = densities.map(|density| &density.wide()[face]);
            if wide == [&[[0.0; D]; D]; 2] {
                return None;
            }
            let ends = wide.map(|forces| forces.map(|force| normal(face, &force)));
            (ends != [[0.0; D]; 2]).then_some(LinearForce { face, ends })
        });
        let mut linear: Vec<_> = linear.collect();
        linear.shrink_to_fit();
        let hats = |end: usize| {
            // Non-matching interfaces have a measure of their own.
            let hats = densities[end].hats().iter().filter(|hat| problem.surface().non_matching_of(hat.node).is_none());
            hats.map(move |hat| HatForce { end, hat: *hat, force: normal(hat.face, &hat.resultant) })
        };
        let mut hats: Vec<_> = hats(0).chain(hats(1)).collect();
        // Hats of one face keep their order.
        hats.sort_by_key(HatForce::place);
        Self { linear, hats }
    }

    /// Whether there are any on one face.
    fn act_on(&self, face: usize) -> bool {
        let linear = self.linear.binary_search_by_key(&face, |linear| linear.face);
        linear.is_ok() || self.hats.iter().any(|hat| hat.hat.face == face)
    }

    /// Those on one face.
    fn on(&self, face: usize) -> [NormalForce<D>; 2] {
        let linear = self.linear.binary_search_by_key(&face, |linear| linear.face);
        let ends = linear.map_or([[0.0; D]; 2], |at| self.linear[at].ends);
        [0, 1].map(|k| {
            let start = self.hats.partition_point(|hat| hat.place() < (k, face));
            let hats = self.hats[start..].iter().take_while(|hat| hat.place() == (k, face));
            NormalForce { linear: ends[k], hats: hats.map(|hat| (hat.hat, hat.force)).collect() }
        })
    }
}

/// Normal forces on the candidate faces at the beginning and the end of one step.
#[derive(Clone, Debug)]
pub(crate) struct OffContact<const D: usize> {
    /// Of the density.
    acting: NormalForces<D>,
    /// Of the density that the reactions alone give.
    sudden: NormalForces<D>,
}

impl<const D: usize> OffContact<D> {
    /// Those of the densities at both ends of a step, and of those that the reactions alone give.
    pub(crate) fn new(problem: &Problem<D>, acting: [&Densities<D>; 2], sudden: [&Densities<D>; 2]) -> Self {
        Self { acting: NormalForces::new(problem, acting), sudden: NormalForces::new(problem, sudden) }
    }

    /// Whether there are any on one face.
    pub(crate) fn act_on(&self, face: usize) -> bool {
        self.acting.act_on(face) || self.sudden.act_on(face)
    }

    /// Adds a step to those of an interval. Energies are measured at the ends of the interval and in the middle of its
    /// first step: steps between do not need the acting force.
    pub(crate) fn add_to(self, steps: &mut Vec<Self>) {
        if let [_, .., last] = &mut steps[..] {
            last.acting = NormalForces::NONE;
        }
        steps.push(self);
    }

    /// About how many bytes a step takes while all of so many faces touch.
    pub(crate) const fn memory(faces: usize) -> usize {
        size_of::<Self>() + faces * size_of::<LinearForce<D>>()
    }
}

/// Normal forces on one candidate face over the steps of an interval between samples.
#[derive(Clone, Debug)]
pub(crate) struct FacePressures<const D: usize> {
    /// Position among the candidate faces.
    face: usize,
    /// First step of the interval.
    first: usize,
    /// At the beginning and the end of each step; the acting force is that of the first and the last one only.
    steps: Vec<[Normal<D>; 2]>,
}

/// Energies of an interval (J): at its beginning, middle and end.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NormalMisfit {
    /// ∫F_n gap.
    pub(crate) energy: [f64; 3],
    /// ∫ΣF_n|w_n| dt since its beginning; the middle is that of its first step.
    pub(crate) work: [f64; 3],
}

impl NormalMisfit {
    /// Adds that of another face.
    pub(crate) fn add(&mut self, other: &Self) {
        for k in 0..3 {
            self.energy[k] += other.energy[k];
            self.work[k] += other.work[k];
        }
    }
}

impl<const D: usize> FacePressures<D> {
    /// Those of one face over consecutive steps.
    pub(crate) fn gather(face: usize, first: usize, steps: &[OffContact<D>]) -> Self {
        let both = |step: &OffContact<D>| {
            let ([a, b], [c, d]) = (step.acting.on(face), step.sudden.on(face));
            [Normal { acting: a, sudden: c }, Normal { acting: b, sudden: d }]
        };
        Self { face, first, steps: steps.iter().map(both).collect() }
    }

    /// Whether there is no force.
    pub(crate) fn is_zero(&self) -> bool {
        self.steps.as_flattened().iter().all(|normal| normal.acting.is_zero() && normal.sudden.is_zero())
    }

    /// Appends them to numbers.
    pub(crate) fn append(&self, numbers: &mut Vec<f64>) {
        let hats = |normal: &Normal<D>| normal.acting.hats.len() + normal.sudden.hats.len();
        let has_hats = self.steps.as_flattened().iter().any(|normal| hats(normal) > 0);
        numbers.extend([self.face, self.first, self.steps.len(), usize::from(has_hats)].map(|count| count as f64));
        for (k, step) in self.steps.iter().enumerate() {
            for normal in step {
                if k == 0 || k + 1 == self.steps.len() {
                    normal.acting.append(numbers, has_hats);
                }
                normal.sudden.append(numbers, has_hats);
            }
        }
    }

    /// Pressures that were appended.
    pub(crate) fn read(numbers: &mut Reader<'_>) -> Self {
        let [face, first, steps, has_hats] = [(); 4].map(|()| numbers.count());
        let has_hats = has_hats == 1;
        let mut end = |k: usize| {
            let outer = k == 0 || k + 1 == steps;
            let acting = if outer { NormalForce::read(numbers, has_hats) } else { NormalForce::NONE };
            Normal { acting, sudden: NormalForce::read(numbers, has_hats) }
        };
        Self { face, first, steps: (0..steps).map(|k| [end(k), end(k)]).collect() }
    }

    /// The misfit over the interval, for the motion in the tracks; work by the trapezoidal rule over all half-step
    /// instants.
    pub(crate) fn misfit(
        &self,
        problem: &Problem<D>,
        times: &TimeGrid,
        tracks: &[ContactMotion],
        weight_of_work: f64,
    ) -> NormalMisfit {
        let face = &problem.surface().faces()[self.face];
        let mut misfit = NormalMisfit::default();
        for (k, [start, end]) in self.steps.iter().enumerate() {
            let instant = 2 * (self.first + k);
            let at = |half: usize, normal: &Normal<D>| {
                let motion = face.nodes.map(|at| tracks[at].at(instant + half));
                let energy = normal.acting.gap_energy(face.area, &motion.map(|(_, gap)| gap));
                let speed = motion.map(|(speed, _)| speed);
                (energy, normal.sudden.power(face.area, &speed))
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
        let part = problem.surface().part_of_contact(face.nodes[0]);
        misfit.energy.iter_mut().for_each(|energy| *energy *= part);
        misfit.work.iter_mut().for_each(|work| *work *= part * weight_of_work);
        misfit
    }
}

/// ∫F_n gap over a face (J), both linear, the force in Pa.
fn gap_energy<const D: usize>(area: f64, force: &[f64; D], gap: &[f64; D]) -> f64 {
    let products: f64 = force.iter().zip(gap).map(|(f, g)| f * g).sum();
    area * (products + force.iter().sum::<f64>() * gap.iter().sum::<f64>()) / (D * (D + 1)) as f64
}

/// ΣF_k|w_k| over the nodes of a face (W), F_k = ∫F_nφ_k of the part F_kφ_k of a linear force (Pa).
fn normal_power<const D: usize>(area: f64, force: &[f64; D], speed: &[f64; D]) -> f64 {
    area / D as f64 * force.iter().zip(speed).map(|(force, speed)| force * speed.abs()).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The misfits of the normal law against the midpoint rule, which converges with the square of the interval.
    #[test]
    fn normal_law_on_an_edge() {
        let (area, force, gap) = (0.3, [2.0, 5.0], [1e-3, 4e-3]);
        let count = 20_000;
        let mean =
            |f: &dyn Fn(f64) -> f64| (0..count).map(|k| f((k as f64 + 0.5) / count as f64)).sum::<f64>() / count as f64;
        let line = |[a, b]: [f64; 2], s: f64| (1.0 - s) * a + s * b;
        for speed in [[3.0_f64, 1.0], [-3.0, 1.0], [0.5, -4.0], [0.0, 0.0]] {
            // Of each part alone the density, at the rate of its node.
            let part = |k: usize| {
                let own = std::array::from_fn(|i| if i == k { force[k] } else { 0.0 });
                mean(&|s| line(own, s)) * speed[k].abs()
            };
            let expected = area * (part(0) + part(1));
            assert!((normal_power(area, &force, &speed) - expected).abs() < 1e-12, "{speed:?}");
        }
        let expected = area * mean(&|s| line(force, s) * line(gap, s));
        assert!((gap_energy(area, &force, &gap) - expected).abs() < 1e-11);
        // On a bar both are products.
        assert_eq!((gap_energy(2.0, &[3.0], &[0.5]), normal_power(2.0, &[3.0], &[-0.5])), (3.0, 3.0));
    }
}
