//! Numbers at several time levels side by side.
//!
//! The maps of elements and stars do not change in time. A formula that is written over [`Value`] takes a number at one
//! level, an `f64`, or at [`LANES`] levels at once: the map is then read once for all of them. [`Lanes`] are such
//! numbers in memory, [`Wide`](super::Wide) in registers. No lane depends on another, and all forms do the same
//! operations in the same order: the bits are the same.

use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Levels that are worked on together.
pub const LANES: usize = 8;

/// A number at each of [`LANES`] levels, in one cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(64))]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    /// 0 at each level.
    pub const ZERO: Self = Self([0.0; LANES]);

    /// The number at each level, by its position.
    #[inline(always)]
    pub fn at_levels(number: impl FnMut(usize) -> f64) -> Self {
        Self(from_fn(number))
    }

    /// The same number at all levels.
    #[inline(always)]
    pub fn constant(number: f64) -> Self {
        Self([number; LANES])
    }

    /// The numbers of these levels, 0 at the others.
    #[inline(always)]
    pub fn only(self, wanted: &[bool; LANES]) -> Self {
        Self(from_fn(|lane| if wanted[lane] { self.0[lane] } else { 0.0 }))
    }
}

/// A number at one or more levels.
pub trait Value:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Mul<f64, Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// Its form in memory.
    type Stored: Copy;

    /// The number in memory, in the form of this one.
    fn load(self, stored: &Self::Stored) -> Self;

    /// To memory.
    fn store(self) -> Self::Stored;

    /// The same number at all levels, in the form of this one.
    fn fill(self, number: f64) -> Self;

    /// 0 at all levels, in the form of this one.
    #[inline(always)]
    fn zero(self) -> Self {
        self.fill(0.0)
    }

    /// Absolute values.
    fn abs(self) -> Self;

    /// Square roots.
    fn sqrt(self) -> Self;

    /// Whether `wanted` holds of any of the numbers.
    fn any(self, wanted: impl Fn(f64) -> bool) -> bool;

    /// The same numbers, but f(x) where `wanted` holds of the number x of another.
    fn replaced_where(self, x: Self, wanted: impl Fn(f64) -> bool, f: impl Fn(f64) -> f64) -> Self;

    /// The larger of each two; `other` is ignored where it is NaN.
    fn max(self, other: Self) -> Self;

    /// The larger of each two residuals, none of them negative; NaN counts as largest, so that it cannot hide.
    fn worse(self, other: Self) -> Self;
}

impl Value for f64 {
    type Stored = Self;

    #[inline(always)]
    fn load(self, stored: &Self) -> Self {
        *stored
    }

    #[inline(always)]
    fn store(self) -> Self {
        self
    }

    #[inline(always)]
    fn fill(self, number: f64) -> Self {
        number
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn any(self, wanted: impl Fn(f64) -> bool) -> bool {
        wanted(self)
    }

    #[inline(always)]
    fn replaced_where(self, x: Self, wanted: impl Fn(f64) -> bool, f: impl Fn(f64) -> f64) -> Self {
        if wanted(x) { f(x) } else { self }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // One instruction, unlike `f64::max`.
        if other > self { other } else { self }
    }

    #[inline(always)]
    fn worse(self, other: Self) -> Self {
        if other > self || other.is_nan() { other } else { self }
    }
}

impl Value for Lanes {
    type Stored = Self;

    #[inline(always)]
    fn load(self, stored: &Self) -> Self {
        *stored
    }

    #[inline(always)]
    fn store(self) -> Self {
        self
    }

    #[inline(always)]
    fn fill(self, number: f64) -> Self {
        Self::constant(number)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }

    #[inline(always)]
    fn any(self, wanted: impl Fn(f64) -> bool) -> bool {
        // No branch in between, so that it is one comparison of vectors.
        self.0.iter().fold(false, |any, x| any | wanted(*x))
    }

    #[inline(always)]
    fn replaced_where(self, x: Self, wanted: impl Fn(f64) -> bool, f: impl Fn(f64) -> f64) -> Self {
        Self(from_fn(|lane| if wanted(x.0[lane]) { f(x.0[lane]) } else { self.0[lane] }))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(from_fn(|lane| Value::max(self.0[lane], other.0[lane])))
    }

    #[inline(always)]
    fn worse(self, other: Self) -> Self {
        // Numbers that are not negative have the order of their bits, and NaN comes last.
        Self(from_fn(|lane| f64::from_bits(self.0[lane].to_bits().max(other.0[lane].to_bits()))))
    }
}

/// An operation on two numbers at each level, and its assigning form.
macro_rules! operation {
    ($trait:ident $method:ident $operator:tt) => {
        impl $trait for Lanes {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(from_fn(|lane| self.0[lane] $operator other.0[lane]))
            }
        }
    };
}

operation!(Add add +);
operation!(Sub sub -);
operation!(Mul mul *);
operation!(Div div /);

impl Mul<f64> for Lanes {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self(from_fn(|lane| self.0[lane] * factor))
    }
}

impl Neg for Lanes {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(from_fn(|lane| -self.0[lane]))
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lanes {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

/// A vector in memory, in the form of a number.
#[inline(always)]
pub fn load<T: Value, const D: usize>(like: T, stored: &[T::Stored; D]) -> [T; D] {
    let mut vector = [like; D];
    for c in 0..D {
        vector[c] = like.load(&stored[c]);
    }
    vector
}

/// A vector to memory.
#[inline(always)]
pub fn store<T: Value<Stored = Lanes>, const D: usize>(vector: &[T; D]) -> [Lanes; D] {
    let mut stored = [Lanes::ZERO; D];
    for c in 0..D {
        stored[c] = vector[c].store();
    }
    stored
}
