//! The auxiliary solution of a solid at a level, and its step to the next one.

use super::operator::{CornerForces, SolidOperator};
use crate::parallel::by_pieces;
use crate::smoothing::SmoothedStrains;
use percute_core::dynamics;
use percute_core::time::TimeGrid;
use std::array::from_fn;

/// The weights of the corrections at a level.
#[derive(Clone, Copy, Debug)]
pub(super) struct CorrectionWeights {
    /// c₁, c₂ and −c₃.
    pub(super) mass: [f64; 3],
    /// That of −M⁻¹Kã (s²).
    pub(super) time: f64,
    /// That of −M⁻¹(K − K_s)v (s); 0 where strains are not smoothed.
    pub(super) damping: f64,
    pub(super) smooths: bool,
    /// The step before the level (s); none at the start.
    pub(super) last_step: Option<f64>,
}

/// The motion at a level, with room for a step.
#[derive(Debug)]
pub(super) struct SolidMotion<const D: usize, const N: usize> {
    /// u_n (m).
    pub(super) displacement: Vec<[f64; D]>,
    /// v_{n−½} (m/s), from the step on v_{n+½}.
    pub(super) half_step: Vec<[f64; D]>,
    /// ã (m/s²).
    pub(super) plain: Vec<[f64; D]>,
    /// a_c and w of a split mass term (m/s²).
    pub(super) consistent: Vec<[f64; D]>,
    pub(super) lumped: Vec<[f64; D]>,
    /// o₂ (m/s²).
    pub(super) skew: Vec<[f64; D]>,
    /// K_s u (N) of the last level and K_s v (N/s).
    internal: Vec<[f64; D]>,
    rate: Vec<[f64; D]>,
    /// The lumping difference of ã, once and twice (m/s²).
    lumping: [Vec<[f64; D]>; 2],
    /// The field whose forces −M⁻¹K of it are both corrections in time and of damping (m).
    plainly_strained: Vec<[f64; D]>,
    strains: SmoothedStrains<f64>,
    corner_forces: CornerForces<D, N>,
    skew_forces: CornerForces<D, N>,
}

impl<const D: usize, const N: usize> SolidMotion<D, N> {
    /// At the start.
    pub(super) fn new(displacement: &[[f64; D]], velocity: &[[f64; D]]) -> Self {
        let field = || vec![[0.0; D]; displacement.len()];
        Self {
            displacement: displacement.to_vec(),
            half_step: velocity.to_vec(),
            plain: field(),
            consistent: field(),
            lumped: field(),
            skew: field(),
            internal: field(),
            rate: field(),
            lumping: [field(), field()],
            plainly_strained: field(),
            strains: SmoothedStrains::default(),
            corner_forces: Vec::new(),
            skew_forces: Vec::new(),
        }
    }

    /// Makes ã of these forces but internal ones (N), and K_s v. It is 0 on prescribed components.
    pub(super) fn respond(
        &mut self,
        operator: &SolidOperator<'_, D, N>,
        weights: &CorrectionWeights,
        external: &[[f64; D]],
    ) {
        let Self { displacement, half_step, plain, internal, rate, strains, corner_forces, .. } = self;
        corner_forces.resize(operator.elements.len(), [[0.0; D]; N]);
        if weights.damping != 0.0 && weights.last_step.is_none() {
            operator.internal_forces(half_step, Some(&mut *strains), corner_forces);
            by_pieces(&mut rate[..], &|first, rate| {
                rate.iter_mut().zip(first..).for_each(|(rate, node)| *rate = operator.sum(node, corner_forces));
            });
        }
        operator.internal_forces(displacement, weights.smooths.then_some(strains), corner_forces);
        // K_s v of the displacements of one step costs no sweep of its own.
        let inverse_step = weights.last_step.map_or(0.0, |step| 1.0 / step);
        let fields = ((&mut plain[..], &mut internal[..], &mut rate[..]), (external, &operator.inverse_mass[..]));
        by_pieces(fields, &|first, ((plain, internal, rate), (external, inverse_mass))| {
            for k in 0..plain.len() {
                let now = operator.sum(first + k, corner_forces);
                if inverse_step > 0.0 {
                    rate[k] = from_fn(|c| (now[c] - internal[k][c]) * inverse_step);
                }
                internal[k] = now;
                plain[k] = from_fn(|c| (external[k][c] - now[c]) * inverse_mass[k][c]);
            }
        });
    }

    /// Makes the corrections of ã, and the fields of a split mass term if they are wanted.
    pub(super) fn correct(&mut self, operator: &SolidOperator<'_, D, N>, weights: &CorrectionWeights, split: bool) {
        let Self { plain, lumping: [once, twice], .. } = self;
        operator.lumping.apply(&operator.inverse_mass, plain, once);
        operator.lumping.apply(&operator.inverse_mass, once, twice);
        self.combine(operator, weights);
        operator.internal_forces(&self.plainly_strained, None, &mut self.corner_forces);
        if split {
            self.skew_forces.resize(operator.elements.len(), [[0.0; D]; N]);
            operator.skew_forces(&self.lumped, &mut self.skew_forces);
            let forces = &self.skew_forces;
            by_pieces((&mut self.skew[..], &operator.inverse_mass[..]), &|first, (skew, inverse_mass)| {
                for (k, (skew, inverse)) in skew.iter_mut().zip(inverse_mass).enumerate() {
                    let sum = operator.sum(first + k, forces);
                    *skew = from_fn(|c| inverse[c] * sum[c]);
                }
            });
        }
    }

    /// a_c = ã + c₁o + c₂μo − c₃μ²o, w = (1 − c₁)ã + (c₁ − c₂)o + (c₂ + c₃)μo − c₃μ²o with o = μã.
    fn combine(&mut self, operator: &SolidOperator<'_, D, N>, weights: &CorrectionWeights) {
        let CorrectionWeights { mass: [first, second, third], time, damping, .. } = *weights;
        let Self { plain, half_step, lumping: [once, twice], consistent, lumped, plainly_strained, .. } = self;
        let (plain, half_step, once, twice) = (&*plain, &*half_step, &*once, &*twice);
        let fields = (&mut consistent[..], &mut lumped[..], &mut plainly_strained[..]);
        by_pieces(fields, &|start, (consistent, lumped, plainly_strained)| {
            for k in 0..consistent.len() {
                let node = start + k;
                let thrice = operator.lumping.at(node, &operator.inverse_mass[node], twice);
                let fields = |c: usize| (plain[node][c], once[node][c], twice[node][c], thrice[c]);
                consistent[k] = from_fn(|c| {
                    let (plain, once, twice, thrice) = fields(c);
                    plain + (first * once + second * twice + third * thrice)
                });
                lumped[k] = from_fn(|c| {
                    let (plain, once, twice, thrice) = fields(c);
                    (1.0 - first) * plain + (first - second) * once + (second - third) * twice + third * thrice
                });
                plainly_strained[k] = from_fn(|c| time * plain[node][c] + damping * half_step[node][c]);
            }
        });
    }

    /// Goes on to the next half step and level.
    pub(super) fn advance(
        &mut self,
        operator: &SolidOperator<'_, D, N>,
        weights: &CorrectionWeights,
        (times, n): (&TimeGrid, usize),
    ) {
        let Self { displacement, half_step, consistent, rate, corner_forces, .. } = self;
        let (consistent, rate, damping) = (&*consistent, &*rate, weights.damping);
        by_pieces((&mut half_step[..], &mut displacement[..]), &|first, (half_step, displacement)| {
            let acceleration = |node: usize| {
                let (forces, inverse) = (operator.sum(node, corner_forces), &operator.inverse_mass[node]);
                from_fn(|c| consistent[node][c] + (damping * rate[node][c] - forces[c]) * inverse[c])
            };
            let nodes = first..first + half_step.len();
            dynamics::advance(times, n, half_step, displacement, nodes.map(acceleration));
        });
    }
}
