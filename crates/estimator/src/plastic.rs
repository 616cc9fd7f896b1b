//! Plastic strain in the estimate: that of elements at a level, and the memory of an element.
//!
//! ε* of a plastic strain is the strain in the plane with σ = K(ε − ε*). Formulas of linear elasticity serve where ε*
//! is taken off a strain first.

use crate::components::{COMPONENTS, components, subtract, tensor};
use percute_core::material::{Elastic, Tensor, VonMises};
use percute_core::problem::Problem;
use percute_core::simd::lanes::{LANES, Lanes, Value};

/// ε* of all elements, as xx, yy and xy.
pub(crate) type EigenStrains = Vec<[f64; COMPONENTS]>;

/// ε* of the internal variables of all elements, in rows; none where no material yields.
pub(crate) fn eigenstrains<const D: usize>(problem: &Problem<D>, internal: &[f64]) -> Option<EigenStrains> {
    if !problem.yields() || internal.is_empty() {
        return None;
    }
    let laws = problem.yielding_laws();
    let rows = internal.chunks_exact(VonMises::count(D)).zip(problem.element_material());
    Some(rows.map(|(row, &law)| components(&laws[usize::from(law)].eigenstrain::<f64, D>(row))).collect())
}

/// ε* of all elements at some levels side by side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EigenLevels<'l>([Option<&'l EigenStrains>; LANES]);

impl<'l> EigenLevels<'l> {
    /// Those of levels; none where no level has any.
    #[inline(always)]
    pub(crate) fn new(levels: impl Iterator<Item = Option<&'l EigenStrains>>) -> Option<Self> {
        let mut all = [None; LANES];
        all.iter_mut().zip(levels).for_each(|(to, level)| *to = level);
        all.iter().any(Option::is_some).then_some(Self(all))
    }

    /// ε* of an element.
    #[inline(always)]
    fn of<T: Value<Stored = Lanes>, const D: usize>(&self, like: T, element: usize) -> [[T; D]; D] {
        let component = |c: usize| Lanes::at_levels(|k| self.0[k].map_or(0.0, |strains| strains[element][c]));
        tensor([0, 1, 2].map(
            #[inline(always)]
            |c| like.load(&component(c)),
        ))
    }
}

/// Takes ε* of an element, where there is one, off a displacement gradient.
#[inline(always)]
pub(crate) fn take_off<T: Value<Stored = Lanes>, const D: usize>(
    eigen: Option<&EigenLevels<'_>>,
    gradient: &mut [[T; D]; D],
    element: usize,
) {
    if let Some(eigen) = eigen {
        subtract(gradient, &eigen.of(gradient[0][0], element));
    }
}

/// The plastic part of an element in η at a sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlasticPart<const D: usize, T = f64> {
    /// ε* of σ_CA.
    pub(crate) eigenstrain: [[T; D]; D],
    /// The distance of the hardening of both fields, and the misfit of the flow of CA so far (J).
    pub(crate) energy: T,
}

impl<const D: usize> Default for PlasticPart<D> {
    fn default() -> Self {
        Self { eigenstrain: [[0.0; D]; D], energy: 0.0 }
    }
}

impl<const D: usize> PlasticPart<D> {
    /// Half way between two instants.
    pub(crate) fn middle(a: &Self, b: &Self) -> Self {
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        Self {
            eigenstrain: std::array::from_fn(|i| {
                std::array::from_fn(|j| mean(a.eigenstrain[i][j], b.eigenstrain[i][j]))
            }),
            energy: mean(a.energy, b.energy),
        }
    }
}

impl<const D: usize> PlasticPart<D, Lanes> {
    /// Of no plastic strain.
    pub(crate) fn rest() -> Self {
        Self { eigenstrain: [[Lanes::ZERO; D]; D], energy: Lanes::ZERO }
    }

    /// Sets that of a level.
    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, part: &PlasticPart<D>) {
        for (to, from) in self.eigenstrain.as_flattened_mut().iter_mut().zip(part.eigenstrain.as_flattened()) {
            to.0[lane] = *from;
        }
        self.energy.0[lane] = part.energy;
    }

    /// In the form of a number.
    #[inline(always)]
    pub(crate) fn load<T: Value<Stored = Lanes>>(&self, like: T) -> PlasticPart<D, T> {
        let mut eigenstrain = [[like; D]; D];
        for a in 0..D {
            (0..D).for_each(|b| eigenstrain[a][b] = like.load(&self.eigenstrain[a][b]));
        }
        PlasticPart { eigenstrain, energy: like.load(&self.energy) }
    }
}

/// The memory of an element: the internal variables of both fields, and the misfit of the flow of CA.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PlasticMemory<const D: usize> {
    kinematic: [f64; 4],
    dynamic: [f64; 4],
    /// ∫φ(Ė_CA) − Σ_DA·Ė_CA dt (J).
    misfit: f64,
    /// The part at the last sample.
    pub(crate) last: PlasticPart<D>,
}

impl<const D: usize> PlasticMemory<D> {
    /// Goes on to a sample with this gradient of u_CA and this mean of σ_DA (Pa): the law takes CA to its strain, the
    /// inverse law DA to its stress, and the flow of CA is measured under the forces of DA at the end of the interval.
    pub(crate) fn advance(&mut self, law: &Elastic, volume: f64, gradient: &Tensor<D>, stress: &Tensor<D>) {
        let (law, count) = (VonMises::new(law), VonMises::count(D));
        let (kinematic, dynamic) = (&mut self.kinematic[..count], &mut self.dynamic[..count]);
        let mut now = [0.0; 4];
        now[..count].copy_from_slice(kinematic);
        law.advance(gradient, &mut now[..count]);
        let forces = law.admit(stress, dynamic);
        self.misfit += volume * forces.misfit::<D>(kinematic, &now[..count]);
        kinematic.copy_from_slice(&now[..count]);
        let distance = volume * law.hardening_distance::<D>(dynamic, kinematic);
        self.last = PlasticPart { eigenstrain: law.eigenstrain(kinematic), energy: distance + self.misfit };
    }
}
