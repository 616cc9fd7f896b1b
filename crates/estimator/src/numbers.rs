//! Data as sequences of numbers, for memory and files.

/// Reads numbers in the order in which they were appended.
#[derive(Clone, Debug)]
pub(crate) struct Reader<'n> {
    left: &'n [f64],
}

impl<'n> Reader<'n> {
    /// From the first of these numbers on.
    pub(crate) fn new(numbers: &'n [f64]) -> Self {
        Self { left: numbers }
    }

    /// The next K numbers.
    pub(crate) fn take<const K: usize>(&mut self) -> [f64; K] {
        let (taken, left) = self.left.split_at(K);
        self.left = left;
        std::array::from_fn(|k| taken[k])
    }

    /// The next number.
    pub(crate) fn number(&mut self) -> f64 {
        let [number] = self.take();
        number
    }

    /// The next number, a count that was appended as one: exact up to 2⁵³.
    pub(crate) fn count(&mut self) -> usize {
        self.number() as usize
    }

    /// The next vectors.
    pub(crate) fn vectors<const D: usize, const N: usize>(&mut self) -> [[f64; D]; N] {
        [(); N].map(|()| self.take())
    }
}
