//! The sizes of least cost for an error.
//!
//! The cost is the number of elements times that of steps, Σ r^−d over min(r h), with r = h_new/h. The squared error is
//! Σ e_E² r^2q (1 + ⁴⁄₃ a (1 − x^−2)), where x is the growth of the size over the smallest one: elements that are
//! larger than the smallest one by another factor x than before have shorter steps for their size, which adds a part
//! of `a` for a factor of 2. For each smallest size the optimum without the last factor is r = (λ q e_E²)^(−1/(2q +
//! d)).

use super::{Basis, PART, SMALLEST};

/// Smallest sizes that are tried, over the smallest of the run, up to `COARSER`.
const FLOORS: usize = 40;
/// The largest smallest size over that of the run.
const COARSER: f64 = 2.0;
/// Parts of the squared error below this part of the largest one count as much.
const LEAST: f64 = 1e-9;
/// The squared error of the sizes found is the wanted one to this part.
const FOUND: f64 = 1e-5;
/// Elements in a graded element, for each halving of its size (e-folding).
const GRADED: f64 = 8.0;

/// The elements of a run with their exponents, to find sizes.
#[derive(Clone, Debug)]
pub(super) struct Sizing<'b> {
    basis: &'b Basis,
    /// q of each element.
    q: &'b [f64],
    /// a of the module's text.
    step: f64,
    /// ln(q e_E²).
    weight: Vec<f64>,
    /// Σ e_E².
    total: f64,
    /// The smallest size (m).
    smallest: f64,
}

impl<'b> Sizing<'b> {
    pub(super) fn new(basis: &'b Basis, q: &'b [f64], step: f64) -> Self {
        let largest = basis.squared.iter().copied().fold(0.0, f64::max);
        let weight = basis.squared.iter().zip(q).map(|(e, q)| (q * e.max(LEAST * largest)).ln()).collect();
        let smallest = basis.size.iter().copied().fold(f64::INFINITY, f64::min);
        Self { basis, q, step, weight, total: basis.squared.iter().sum(), smallest }
    }

    /// The mean error of sizes over that of the run.
    pub(super) fn predicted(&self, ratio: &[f64]) -> f64 {
        self.predicted_beside(ratio, least_size(ratio, &self.basis.size))
    }

    /// The same beside a smallest element of this size (m).
    pub(super) fn predicted_beside(&self, ratio: &[f64], smallest: f64) -> f64 {
        let Basis { size, squared, .. } = self.basis;
        let part = |((r, h), (e, q)): ((&f64, &f64), (&f64, &f64))| {
            let grown = ((r * h / smallest) / (h / self.smallest)).max(1.0);
            e * r.powf(2.0 * q) * (1.0 + 4.0 / 3.0 * self.step * (1.0 - grown.powi(-2)))
        };
        let sum: f64 = ratio.iter().zip(size).zip(squared.iter().zip(self.q)).map(part).sum();
        (sum / self.total).sqrt()
    }

    /// Elements times steps of sizes over those of the run.
    pub(super) fn cost(&self, ratio: &[f64]) -> f64 {
        let (Basis { size, dimension, .. }, count) = (self.basis, ratio.len() as f64);
        let elements: f64 = ratio.iter().map(|r| r.powi(-(*dimension as i32))).sum();
        elements / count * (self.smallest / least_size(ratio, size))
    }

    /// The same if elements that touch are graded inside.
    pub(super) fn graded_cost(&self, ratio: &[f64]) -> f64 {
        let Basis { size, dimension, touches, .. } = self.basis;
        let elements = |(r, touches): (&f64, &bool)| match touches {
            true if *r < 1.0 => 1.0 - GRADED * r.ln(),
            _ => r.powi(-(*dimension as i32)),
        };
        let elements = ratio.iter().zip(touches).map(elements).sum::<f64>();
        elements / ratio.len() as f64 * (self.smallest / least_size(ratio, size))
    }

    /// Sizes of which the smallest is at least `smallest` times that of the run, all as small as that allows.
    pub(super) fn floor(&self, smallest: f64) -> Vec<f64> {
        self.basis.size.iter().map(|h| (smallest * self.smallest / h).max(smallest)).collect()
    }

    /// The error over that of the run that is aimed at: the wanted one, or a part of the way to the least that is
    /// within reach.
    pub(super) fn within_reach(&self, wanted: f64, smallest: f64) -> f64 {
        wanted.max(self.predicted(&self.floor(smallest)).powf(PART))
    }

    /// The cheapest sizes by this cost for an error over that of the run, with all ratios from `least` to `largest`;
    /// none if there are none.
    pub(super) fn cheapest(
        &self,
        wanted: f64,
        (least, largest): (f64, &[f64]),
        cost: fn(&Self, &[f64]) -> f64,
    ) -> Option<Vec<f64>> {
        let mut best: Option<(f64, Vec<f64>)> = None;
        for k in 0..FLOORS {
            let floor = least * (COARSER / least).powf(k as f64 / (FLOORS - 1) as f64) * self.smallest;
            let low = self.basis.size.iter().zip(largest).map(|(h, most)| (floor / h).max(least).min(*most));
            let Some(ratio) = self.with_floor(wanted, &low.collect::<Vec<_>>(), largest) else { continue };
            let cost = cost(self, &ratio);
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, ratio));
            }
        }
        best.map(|(_, ratio)| ratio)
    }

    /// The cheapest sizes between bounds with a common smallest size.
    fn with_floor(&self, wanted: f64, low: &[f64], high: &[f64]) -> Option<Vec<f64>> {
        if self.predicted(low) > wanted {
            return None;
        }
        let bound = |bounds: &[f64]| {
            let of = |((bound, weight), q): ((&f64, &f64), &f64)| -weight - self.power(*q) * bound.ln();
            bounds.iter().zip(&self.weight).zip(self.q).map(of).collect::<Vec<_>>()
        };
        // With the multiplier (a logarithm) at the first bound all sizes are the largest, at the second the smallest.
        let mut range = [
            bound(high).into_iter().fold(f64::INFINITY, f64::min),
            bound(low).into_iter().fold(f64::NEG_INFINITY, f64::max),
        ];
        let mut found = self.with_multiplier(range[0], low, high);
        while self.predicted(&found) > wanted {
            let middle = 0.5 * (range[0] + range[1]);
            let ratio = self.with_multiplier(middle, low, high);
            let error = self.predicted(&ratio) / wanted;
            if error > 1.0 {
                range[0] = middle
            } else {
                range[1] = middle
            }
            if (error <= 1.0 && error > 1.0 - FOUND) || range[1] - range[0] < FOUND {
                found = self.with_multiplier(range[1], low, high);
                break;
            }
        }
        Some(found)
    }

    fn with_multiplier(&self, multiplier: f64, low: &[f64], high: &[f64]) -> Vec<f64> {
        let ratio = |((weight, q), (low, high)): ((&f64, &f64), (&f64, &f64))| {
            ((-multiplier - weight) / self.power(*q)).exp().clamp(*low, *high)
        };
        self.weight.iter().zip(self.q).zip(low.iter().zip(high)).map(ratio).collect()
    }

    fn power(&self, q: f64) -> f64 {
        2.0 * q + self.basis.dimension as f64
    }

    /// Sizes for a mesh that is graded towards the nodes that touch. No element becomes smaller than the multiplier
    /// allows with which the element in the middle of the sorted, accumulated squared error is at the least ratio: the
    /// error of others is not known well beside that of the largest. None becomes larger.
    pub(super) fn graded(&self, wanted: f64, largest: &[f64]) -> Vec<f64> {
        let squared = &self.basis.squared;
        let mut order: Vec<usize> = (0..squared.len()).collect();
        order.sort_by(|&a, &b| squared[b].total_cmp(&squared[a]));
        let accumulated = order.iter().scan(0.0, |sum, &e| {
            *sum += squared[e];
            Some((e, *sum))
        });
        let middle = accumulated.into_iter().find(|(_, sum)| *sum >= 0.5 * self.total).map_or(order[0], |(e, _)| e);
        let multiplier = -self.weight[middle] - self.power(self.q[middle]) * SMALLEST.ln();
        let count = squared.len();
        let trusted = self.with_multiplier(multiplier, &vec![SMALLEST; count], &vec![1.0; count]);
        if self.predicted(&self.floor(SMALLEST)) > wanted {
            return trusted;
        }
        match self.cheapest(wanted, (SMALLEST, largest), Self::graded_cost) {
            Some(found) => trusted.iter().zip(&found).map(|(trusted, found)| trusted.max(found.min(1.0))).collect(),
            None => trusted,
        }
    }
}

/// The smallest new size (m).
fn least_size(ratio: &[f64], size: &[f64]) -> f64 {
    ratio.iter().zip(size).map(|(r, h)| r * h).fold(f64::INFINITY, f64::min)
}

/// A ratio with which all elements would have less than a wanted error over that of the run, but for shorter steps.
pub(super) fn smallest(wanted: f64, q: &[f64]) -> f64 {
    let least = q.iter().copied().fold(f64::INFINITY, f64::min);
    (0.5 * wanted.min(1.0)).powf(1.0 / least).max(1e-4)
}

#[cfg(test)]
mod tests {
    use super::*;
    use percute_estimator::Separation;
    use proptest::prelude::*;

    fn basis(dimension: usize, size: Vec<f64>, squared: Vec<f64>) -> Basis {
        let nothing = Separation {
            at_sup: Default::default(),
            mean: Default::default(),
            halved_elements: Default::default(),
            halved_step: 0.0,
            over_time: Vec::new(),
        };
        let touches = vec![false; size.len()];
        Basis { dimension, size, squared, touches, nodes: Vec::new(), sources: nothing, element_steps: 1.0 }
    }

    /// The optimum in closed form without the step part: elements of the smallest size hold (1 + d f)/(1 + d) of the
    /// squared error, f their part of the elements.
    #[test]
    fn elements_of_the_smallest_size_have_their_share() {
        let count = 4000;
        for (power, q) in [(1.9, 0.35), (1.9, 0.6), (1.0, 0.6), (1.0, 1.0)] {
            let squared: Vec<f64> = (0..count).map(|k| ((k as f64 + 0.5) / count as f64).powf(-power)).collect();
            let basis = basis(2, vec![1.0; count], squared.clone());
            let exponents = vec![q; count];
            let sizing = Sizing::new(&basis, &exponents, 0.0);
            let ratio = sizing.cheapest(0.4, (1e-3, &vec![100.0; count]), Sizing::cost).unwrap();
            assert!((sizing.predicted(&ratio) - 0.4).abs() < 1e-3, "{}", sizing.predicted(&ratio));
            let smallest = least_size(&ratio, &basis.size);
            let (mut new, mut at, mut errors, mut errors_at) = (0.0, 0.0, 0.0, 0.0);
            for (r, e) in ratio.iter().zip(&squared) {
                let (elements, error) = (r.powi(-2), e * r.powf(2.0 * q));
                (new, errors) = (new + elements, errors + error);
                if *r < 1.0001 * smallest {
                    (at, errors_at) = (at + elements, errors_at + error);
                }
            }
            let rule = (1.0 + 2.0 * at / new) / 3.0;
            // Smallest sizes are tried in steps of 20 %: the part moves by some hundredths from one to the next.
            assert!((errors_at / errors - rule).abs() < 0.1, "{power} {q}: {} {rule}", errors_at / errors);
        }
    }

    proptest! {
        /// Sizes have the wanted error, keep their bounds, and cost less than those of a uniform mesh of this error.
        #[test]
        fn sizes_have_the_wanted_error(
            squared in proptest::collection::vec(1e-6..1.0_f64, 2..40),
            (wanted, step, dimension) in (0.5..0.95_f64, 0.0..0.5_f64, 1..3_usize),
            q in 0.3..1.0_f64,
        ) {
            let count = squared.len();
            let basis = basis(dimension, vec![1.0; count], squared);
            let exponents = vec![q; count];
            let sizing = Sizing::new(&basis, &exponents, step);
            let uniform = wanted.powf(1.0 / q);
            let least = 0.5 * uniform;
            let ratio = sizing.cheapest(wanted, (least, &vec![1.5; count]), Sizing::cost).unwrap();
            prop_assert!(ratio.iter().all(|r| (least * (1.0 - 1e-12)..=1.5).contains(r)));
            prop_assert!(sizing.predicted(&ratio) <= wanted * (1.0 + 1e-9));
            // The nearest smallest size that is tried is up to 5 % from that of the uniform mesh of cost r^−(d+1).
            prop_assert!(sizing.cost(&ratio) <= sizing.cost(&vec![uniform; count]) * 1.2);
        }
    }
}
