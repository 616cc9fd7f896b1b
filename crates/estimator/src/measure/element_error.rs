//! The part of an element in η.

use crate::contact_density::ResidualStress;
use percute_core::simd::lanes::{LANES, Lanes, Value};

/// The part of one element in η and d at one sample (J), contact apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ElementError<T = f64> {
    pub(crate) kinetic: T,
    pub(crate) elastic: T,
    /// The distance of the hardening of both fields and the misfit of the flow, where a material yields.
    pub(crate) plastic: T,
    pub(crate) reference: T,
}

impl<T: Value> ElementError<T> {
    /// The same number in all parts.
    #[inline(always)]
    pub(crate) fn filled(number: T) -> Self {
        Self { kinetic: number, elastic: number, plastic: number, reference: number }
    }

    #[inline(always)]
    pub(crate) fn total(&self) -> T {
        self.kinetic + self.elastic + self.plastic
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, other: &Self) {
        self.kinetic += other.kinetic;
        self.elastic += other.elastic;
        self.plastic += other.plastic;
        self.reference += other.reference;
    }
}

impl ElementError {
    /// The error with stresses beside that in it, of which `work` is ∫σ:K⁻¹τ with the misfit of the stress (J).
    /// `energies` are those of the fluctuation of σ_DA and of hats (J).
    ///
    /// Of two stresses whose product is not known, the norm of the sum is at most the sum of the norms. Stresses inside
    /// an element do no work on the mean of the misfit. The reference is that of the sum over a star: the work of its
    /// stress on σ_CA vanishes there.
    pub(crate) fn residual(self, stress: &ResidualStress, work: f64, energies: [f64; 2]) -> Self {
        let ResidualStress { inside, shared, .. } = *stress;
        let [fluctuation, hats] = energies.map(|energy| energy.max(0.0).sqrt());
        let products = shared * hats + inside * (fluctuation + hats + shared);
        let sharp = self.elastic + work + shared * shared + inside * inside + 2.0 * products;
        let plain = (self.elastic.max(0.0).sqrt() + stress.root()).powi(2);
        let elastic = sharp.min(plain);
        Self { elastic, reference: self.reference + 2.0 * (elastic - self.elastic), ..self }
    }
}

impl<T: Value<Stored = Lanes>> ElementError<T> {
    /// To memory.
    #[inline(always)]
    pub(crate) fn store(&self) -> ElementError<Lanes> {
        let Self { kinetic, elastic, plastic, reference } = *self;
        let [kinetic, elastic, plastic, reference] = [kinetic, elastic, plastic, reference].map(T::store);
        ElementError { kinetic, elastic, plastic, reference }
    }

    /// At these levels, 0 at the others.
    #[inline(always)]
    pub(crate) fn only(&self, wanted: &[bool; LANES]) -> Self {
        let (like, ElementError { kinetic, elastic, plastic, reference }) = (self.kinetic, self.store());
        let parts = [kinetic, elastic, plastic, reference].map(|number| number.only(wanted));
        let [kinetic, elastic, plastic, reference] = parts.map(|number| like.load(&number));
        Self { kinetic, elastic, plastic, reference }
    }
}

impl ElementError<Lanes> {
    /// At one level.
    #[inline(always)]
    pub(crate) fn lane(&self, lane: usize) -> ElementError {
        let [kinetic, elastic, plastic, reference] =
            [&self.kinetic, &self.elastic, &self.plastic, &self.reference].map(|number| number.0[lane]);
        ElementError { kinetic, elastic, plastic, reference }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::LOADS;
    use percute_testkit::Random;

    fn energy(stresses: &[[f64; 8]]) -> f64 {
        (0..8).map(|i| 0.5 * stresses.iter().map(|stress| stress[i]).sum::<f64>().powi(2)).sum()
    }

    /// Stresses as vectors: means have two components. The result is never less than the energy of the sum. It is that
    /// energy if there are only stresses of stars, and never more than with the sum of all norms.
    #[test]
    fn stresses_beside_are_bounded() {
        let mut random = Random::new(7);
        for case in 0..2000 {
            let mut vector = |range: std::ops::Range<usize>, size: f64| -> [f64; 8] {
                std::array::from_fn(|i| if range.contains(&i) { random.between(-size, size) } else { 0.0 })
            };
            let sizes = [0, 1, 2].map(|k| if case >> k & 1 == 1 { 1.0 } else { 0.0 });
            let (mean, fluctuation) = (vector(0..2, 1.0), vector(2..8, 0.5));
            let [hats, shared] = [vector(0..8, sizes[0]), vector(0..8, sizes[1])];
            let inside = vector(2..8, sizes[2]);
            let misfit: [f64; 8] = std::array::from_fn(|i| mean[i] + fluctuation[i]);
            let root = |stress: [f64; 8]| energy(&[stress]).sqrt();
            let stress = ResidualStress { inside: root(inside), shared: root(shared), products: [0.0; LOADS] };
            let work = (0..8).map(|i| misfit[i] * shared[i]).sum();
            let alone = ElementError { elastic: energy(&[misfit, hats]), ..ElementError::filled(0.0) };
            let found = alone.residual(&stress, work, [energy(&[fluctuation]), energy(&[hats])]).elastic;
            let whole = energy(&[misfit, hats, shared, inside]);
            // Rounding of some operations.
            assert!(found >= whole * (1.0 - 1e-12), "{case}: {found} {whole}");
            let plain = (alone.elastic.sqrt() + stress.root()).powi(2);
            assert!(found <= plain * (1.0 + 1e-12), "{case}: {found} {plain}");
            if sizes == [0.0, 1.0, 0.0] {
                assert!((found - whole).abs() <= 1e-12 * whole, "{case}: {found} {whole}");
            }
        }
    }
}
