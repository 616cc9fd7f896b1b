//! The part of an element in η.

use crate::lanes::{LANES, Lanes, Value};

/// The part of one element in η and d at one sample (J), contact apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ElementError<T = f64> {
    pub(crate) kinetic: T,
    pub(crate) elastic: T,
    pub(crate) reference: T,
}

impl<T: Value> ElementError<T> {
    /// The same number in all parts.
    #[inline(always)]
    pub(crate) fn filled(number: T) -> Self {
        Self { kinetic: number, elastic: number, reference: number }
    }

    #[inline(always)]
    pub(crate) fn total(&self) -> T {
        self.kinetic + self.elastic
    }

    #[inline(always)]
    pub(crate) fn add(&mut self, other: &Self) {
        self.kinetic += other.kinetic;
        self.elastic += other.elastic;
        self.reference += other.reference;
    }
}

impl ElementError {
    /// The error with a stress beside that in it, of which this is the root of the energy (J^½): the norm of the sum is
    /// at most the sum of both.
    pub(crate) fn beside(self, root: f64) -> Self {
        if root == 0.0 {
            return self;
        }
        let elastic = (self.elastic.max(0.0).sqrt() + root).powi(2);
        Self { elastic, reference: self.reference + 2.0 * (elastic - self.elastic), ..self }
    }
}

impl<T: Value<Stored = Lanes>> ElementError<T> {
    /// To memory.
    #[inline(always)]
    pub(crate) fn store(&self) -> ElementError<Lanes> {
        let Self { kinetic, elastic, reference } = *self;
        ElementError { kinetic: kinetic.store(), elastic: elastic.store(), reference: reference.store() }
    }

    /// At these levels, 0 at the others.
    #[inline(always)]
    pub(crate) fn only(&self, wanted: &[bool; LANES]) -> Self {
        let (like, ElementError { kinetic, elastic, reference }) = (self.kinetic, self.store());
        let [kinetic, elastic, reference] = [kinetic, elastic, reference].map(|number| number.only(wanted));
        Self { kinetic: like.load(&kinetic), elastic: like.load(&elastic), reference: like.load(&reference) }
    }
}

impl ElementError<Lanes> {
    /// At one level.
    #[inline(always)]
    pub(crate) fn lane(&self, lane: usize) -> ElementError {
        let Self { kinetic, elastic, reference } = self;
        ElementError { kinetic: kinetic.0[lane], elastic: elastic.0[lane], reference: reference.0[lane] }
    }
}
