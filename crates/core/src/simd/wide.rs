//! Numbers at several time levels side by side, in registers.
//!
//! [`Lanes`](super::lanes::Lanes) are memory: where a formula holds many of them, the compiler keeps their arrays in
//! memory too, and moves three numbers for each operation. In registers a formula moves those that do not fit.

use super::lanes::{LANES, Lanes, Value};
use super::{Registers, Two};

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number at each level of some lanes, in registers of one kind.
#[derive(Clone, Copy)]
pub struct Wide<R: Registers> {
    registers: R,
    numbers: R::Eight,
}

impl<R: Registers> Wide<R> {
    /// 0 at all levels; also the form of other numbers.
    #[inline(always)]
    pub fn zeros(registers: R) -> Self {
        Self { registers, numbers: registers.splat(0.0) }
    }

    #[inline(always)]
    fn with(self, numbers: R::Eight) -> Self {
        Self { numbers, ..self }
    }

    /// The first and the second components of a vector at each level.
    #[inline(always)]
    pub fn transpose(self, vectors: [&[f64; 2]; LANES]) -> [Self; 2] {
        let [first, second] = self.registers.transpose(vectors);
        [self.with(first), self.with(second)]
    }

    /// Four vectors, one after the other.
    #[inline(always)]
    pub(crate) fn quad(self, vectors: [Two; 4]) -> Self {
        self.with(self.registers.quad(vectors))
    }

    /// The four vectors.
    #[inline(always)]
    pub(crate) fn vectors(self) -> [R::Two; 4] {
        let [a, c] = self.registers.ends(self.numbers);
        let [b, d] = self.registers.ends(self.registers.swap_pairs(self.numbers));
        [a, b, c, d]
    }

    /// The first components of the vectors of both, two and two, and the second components.
    #[inline(always)]
    pub(crate) fn interleave(self, other: Self) -> [Self; 2] {
        let [first, second] = self.registers.interleave(self.numbers, other.numbers);
        [self.with(first), self.with(second)]
    }

    /// The numbers of the levels before, that of the first level given.
    #[inline(always)]
    pub fn later(self, first: f64) -> Self {
        self.with(self.registers.later(first, self.numbers))
    }
}

impl<R: Registers> Value for Wide<R> {
    type Stored = Lanes;

    #[inline(always)]
    fn load(self, stored: &Lanes) -> Self {
        self.with(self.registers.load(&stored.0))
    }

    #[inline(always)]
    fn store(self) -> Lanes {
        Lanes(self.registers.store(self.numbers))
    }

    #[inline(always)]
    fn fill(self, number: f64) -> Self {
        self.with(self.registers.splat(number))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.with(self.registers.abs(self.numbers))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.with(self.registers.sqrt(self.numbers))
    }

    #[inline(always)]
    fn any(self, wanted: impl Fn(f64) -> bool) -> bool {
        self.store().any(wanted)
    }

    #[inline(always)]
    fn replaced_where(self, x: Self, wanted: impl Fn(f64) -> bool, f: impl Fn(f64) -> f64) -> Self {
        self.load(&replaced_where(&self.store(), &x.store(), wanted, f))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.with(self.registers.max(self.numbers, other.numbers))
    }

    #[inline(always)]
    fn worse(self, other: Self) -> Self {
        self.with(self.registers.max_bits(self.numbers, other.numbers))
    }
}

/// In the rare case: only then the numbers of a loop around it go to memory.
#[cold]
#[inline(never)]
fn replaced_where(of: &Lanes, x: &Lanes, wanted: impl Fn(f64) -> bool, f: impl Fn(f64) -> f64) -> Lanes {
    of.replaced_where(*x, wanted, f)
}

/// An operation on two numbers at each level.
macro_rules! operation {
    ($trait:ident $method:ident $operation:ident) => {
        impl<R: Registers> $trait for Wide<R> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.with(self.registers.$operation(self.numbers, other.numbers))
            }
        }
    };
}

operation!(Add add add);
operation!(Sub sub sub);
operation!(Mul mul mul);
operation!(Div div div);

impl<R: Registers> Mul<f64> for Wide<R> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self * self.fill(factor)
    }
}

impl<R: Registers> Neg for Wide<R> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        // The sign of 0 too.
        self.fill(-0.0) - self
    }
}

impl<R: Registers> AddAssign for Wide<R> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<R: Registers> SubAssign for Wide<R> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
