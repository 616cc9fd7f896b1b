//! Numbers at several time levels side by side.
//!
//! The maps of elements and stars do not change in time. A formula that is written over [`Value`] takes a number at one level, an `f64`, or
//! at [`LANES`] levels at once, [`Lanes`]: the map is then read once for all of them, and the compiler turns each operation into
//! vector instructions. No lane depends on another, and both forms do the same operations in the same order: the bits are the
//! same.

use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Levels that are worked on together.
pub(crate) const LANES: usize = 8;

/// A number at each of [`LANES`] levels, in one cache line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(64))]
pub(crate) struct Lanes(pub(crate) [f64; LANES]);

impl Lanes {
    /// The numbers of the levels before, that of the first level given.
    #[inline(always)]
    pub(crate) fn later(self, first: f64) -> Self {
        let [a, b, c, d, e, f, g, _] = self.0;
        Self([first, a, b, c, d, e, f, g])
    }

    /// The numbers of these levels, 0 at the others.
    #[inline(always)]
    pub(crate) fn only(self, wanted: &[bool; LANES]) -> Self {
        Self(from_fn(|lane| if wanted[lane] { self.0[lane] } else { 0.0 }))
    }
}

/// A number at one or more levels.
pub(crate) trait Value:
    Copy
    + std::fmt::Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Mul<f64, Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// 0 at each level.
    const ZERO: Self;

    /// The number at each level, by its position.
    fn at_levels(number: impl FnMut(usize) -> f64) -> Self;

    /// The same number at all levels.
    fn constant(number: f64) -> Self;

    /// Absolute values.
    fn abs(self) -> Self;

    /// The larger of each two; `other` is ignored where it is NaN.
    fn max(self, other: Self) -> Self;

    /// The larger of each two residuals, none of them negative; NaN counts as largest, so that it cannot hide.
    fn worse(self, other: Self) -> Self;
}

impl Value for f64 {
    const ZERO: Self = 0.0;

    #[inline(always)]
    fn at_levels(mut number: impl FnMut(usize) -> f64) -> Self {
        number(0)
    }

    #[inline(always)]
    fn constant(number: f64) -> Self {
        number
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // One instruction, unlike `f64::max`.
        if other > self { other } else { self }
    }

    #[inline(always)]
    fn worse(self, other: Self) -> Self {
        crate::residual::worse(self, other)
    }
}

impl Value for Lanes {
    const ZERO: Self = Self([0.0; LANES]);

    #[inline(always)]
    fn at_levels(number: impl FnMut(usize) -> f64) -> Self {
        Self(from_fn(number))
    }

    #[inline(always)]
    fn constant(number: f64) -> Self {
        Self([number; LANES])
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
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

/// Takes the values of a nodal field at these nodes into their records, at each level that has the field; at the others, any values.
#[inline(always)]
pub(crate) fn gather<'f, R, const D: usize>(
    records: &mut [R],
    nodes: &[u32],
    levels: impl Iterator<Item = Option<&'f [[f64; D]]>> + Clone,
    place: impl Fn(&mut R) -> &mut [Lanes; D],
) {
    let Some(some) = levels.clone().flatten().next() else { return };
    let mut fields = [some; LANES];
    for (to, level) in fields.iter_mut().zip(levels) {
        // All of one length: the first check is then that of all.
        *to = &level.unwrap_or(some)[..some.len()];
    }
    let [a, b, c, d, e, f, g, h] = fields;
    for (to, &node) in records.iter_mut().zip(nodes) {
        let n = node as usize;
        let (a, b, c, d) = (&a[n], &b[n], &c[n], &d[n]);
        let (e, f, g, h) = (&e[n], &f[n], &g[n], &h[n]);
        let to = place(to);
        for k in 0..D {
            to[k] = Lanes([a[k], b[k], c[k], d[k], e[k], f[k], g[k], h[k]]);
        }
    }
}

/// A nodal field at some nodes, at some levels side by side.
#[derive(Clone, Debug, Default)]
pub(crate) struct FieldLanes<const D: usize>(Vec<[Lanes; D]>);

impl<const D: usize> FieldLanes<D> {
    /// Takes the values at these nodes, at each level that has the field; at the others, any values.
    #[inline(always)]
    pub(crate) fn gather<'f>(&mut self, nodes: &[u32], levels: impl Iterator<Item = Option<&'f [[f64; D]]>> + Clone) {
        self.0.resize(nodes.len(), [Lanes::ZERO; D]);
        gather(
            &mut self.0,
            nodes,
            levels,
            #[inline(always)]
            |values| values,
        );
    }

    /// The values by places.
    #[inline(always)]
    pub(crate) fn values(&self) -> &[[Lanes; D]] {
        &self.0
    }

    /// The values at the nodes of an element, which have these places.
    #[inline(always)]
    pub(crate) fn of<const N: usize>(&self, local: &[u32; N]) -> [[Lanes; D]; N] {
        let mut values = [[Lanes::ZERO; D]; N];
        for i in 0..N {
            values[i] = self.0[local[i] as usize];
        }
        values
    }
}
