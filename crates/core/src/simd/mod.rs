//! The instruction set of the hot loops, chosen when the program runs.
//!
//! A binary is compiled for the oldest processor that it must run on. Its loops then use registers of two numbers. On a
//! newer processor, [`dispatch`] and [`run_task`] run a copy of the loops that was compiled for registers of four or
//! eight. Products and sums are never fused, so the bits are those of the portable copy. No other folder of the crate
//! has instruction sets.
//!
//! [`dispatch`] is for loops that the compiler turns into vectors by itself. Where lanes are gathered and exchanged, it
//! makes short vectors with many permutations, three times as many instructions. Such loops are a
//! [`Task`] over [`Registers`].

pub mod lanes;
mod wide;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use wide::Wide;

use pulp::{Arch, NullaryFnOnce};

/// Runs a task with the widest registers of this processor. The task and all functions of its loops must be
/// `#[inline(always)]`: other functions keep the instructions of the oldest processor.
///
/// ```ignore
/// dispatch(#[inline(always)] || sweep(cells, values));
/// ```
#[inline]
pub fn dispatch<R>(task: impl FnOnce() -> R) -> R {
    if cfg!(feature = "portable") { task() } else { Arch::new().dispatch(Closure(task)) }
}

/// A task that is compiled anew for each instruction set.
struct Closure<F>(F);

impl<R, F: FnOnce() -> R> NullaryFnOnce for Closure<F> {
    type Output = R;

    #[inline(always)]
    fn call(self) -> R {
        (self.0)()
    }
}

/// Eight numbers: two components of four vectors. Number 4 p + 2 c + l is component c of vector l of pair p.
pub type Eight = [f64; 8];
/// Four numbers: a pair of vectors.
pub type Four = [f64; 4];
/// Two numbers: the components at a node.
pub type Two = [f64; 2];

/// Operations on eight numbers, and on the first four of them.
pub trait Registers: Copy {
    /// Eight numbers in registers.
    type Eight: Copy;
    /// Four numbers in registers.
    type Four: Copy;
    /// Two numbers in a register.
    type Two: Copy;

    /// From memory.
    fn load(self, from: &Eight) -> Self::Eight;
    /// To memory.
    fn store(self, from: Self::Eight) -> Eight;
    /// Eight times the same number.
    fn splat(self, x: f64) -> Self::Eight;
    /// Sum.
    fn add(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    /// Difference.
    fn sub(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    /// Product.
    fn mul(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    /// Quotient.
    fn div(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    /// Square roots.
    fn sqrt(self, v: Self::Eight) -> Self::Eight;
    /// The larger of each two; that of `b` is ignored where it is NaN.
    fn max(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    /// The larger of each two numbers by their bits: NaN counts as largest among numbers that are not negative.
    fn max_bits(self, a: Self::Eight, b: Self::Eight) -> Self::Eight;
    /// Absolute values.
    fn abs(self, v: Self::Eight) -> Self::Eight;
    /// Each number at the place after its own, behind the one given; the last is left out.
    fn later(self, first: f64, v: Self::Eight) -> Self::Eight;

    /// The first components of the vectors of both, two and two, and the second components.
    fn interleave(self, a: Self::Eight, b: Self::Eight) -> [Self::Eight; 2];
    /// The first and the second components of eight vectors.
    fn transpose(self, vectors: [&[f64; 2]; 8]) -> [Self::Eight; 2];

    /// Components exchanged.
    fn swap_pairs(self, v: Self::Eight) -> Self::Eight;
    /// Pairs exchanged, and the vectors of each.
    fn turn(self, v: Self::Eight) -> Self::Eight;
    /// The first pair.
    fn first(self, v: Self::Eight) -> Self::Four;
    /// The second pair.
    fn last(self, v: Self::Eight) -> Self::Four;
    /// The first pair of another, with the second of this.
    fn with_first(self, v: Self::Eight, first: Self::Four) -> Self::Eight;
    /// Two pairs.
    fn join(self, first: Self::Four, last: Self::Four) -> Self::Eight;

    /// From memory.
    fn load4(self, from: &Four) -> Self::Four;
    /// To memory.
    fn store4(self, from: Self::Four) -> Four;
    /// Four times the same number.
    fn splat4(self, x: f64) -> Self::Four;
    /// Sum.
    fn add4(self, a: Self::Four, b: Self::Four) -> Self::Four;
    /// Difference.
    fn sub4(self, a: Self::Four, b: Self::Four) -> Self::Four;
    /// Product.
    fn mul4(self, a: Self::Four, b: Self::Four) -> Self::Four;

    /// From four vectors.
    fn quad(self, parts: [Two; 4]) -> Self::Eight;
    /// Each of two vectors twice.
    fn twice(self, parts: [Two; 2]) -> Self::Eight;
    /// Each of four numbers twice.
    fn repeat(self, numbers: &[f64; 4]) -> Self::Eight;
    /// The first component of each vector, twice.
    fn evens(self, v: Self::Eight) -> Self::Eight;
    /// The second component of each vector, twice.
    fn odds(self, v: Self::Eight) -> Self::Eight;
    /// Components exchanged.
    fn swap_lanes(self, v: Self::Eight) -> Self::Eight;
    /// Vectors 0 and 2.
    fn ends(self, v: Self::Eight) -> [Self::Two; 2];
    /// `to` + `v`.
    fn add_to(self, to: &mut Two, v: Self::Two);
    /// `to` − `v`.
    fn take_from(self, from: &mut Two, v: Self::Two);
}

/// Work that is done with registers.
pub trait Task {
    /// Its result.
    type Output;

    /// Does the work. All functions of its loops must be `#[inline(always)]`.
    fn run<R: Registers>(self, r: R) -> Self::Output;
}

/// Does the work with the widest registers of this processor.
#[inline]
pub fn run_task<T: Task>(task: T) -> T::Output {
    #[cfg(all(target_arch = "x86_64", not(feature = "portable")))]
    {
        use pulp::x86::{V3, V4};
        if let Some(set) = V4::try_new() {
            return set.vectorize(
                #[inline(always)]
                || task.run(set),
            );
        }
        if let Some(set) = V3::try_new() {
            return set.vectorize(
                #[inline(always)]
                || task.run(set),
            );
        }
    }
    task.run(Portable)
}

/// Plain arrays, for every processor.
#[derive(Clone, Copy, Debug)]
pub struct Portable;

#[inline(always)]
fn each<const W: usize>(a: [f64; W], b: [f64; W], f: impl Fn(f64, f64) -> f64) -> [f64; W] {
    std::array::from_fn(
        #[inline(always)]
        |i| f(a[i], b[i]),
    )
}

#[inline(always)]
fn plus(a: f64, b: f64) -> f64 {
    a + b
}

#[inline(always)]
fn minus(a: f64, b: f64) -> f64 {
    a - b
}

#[inline(always)]
fn times(a: f64, b: f64) -> f64 {
    a * b
}

#[inline(always)]
fn over(a: f64, b: f64) -> f64 {
    a / b
}

#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    // One instruction, unlike `f64::max`.
    if b > a { b } else { a }
}

#[inline(always)]
fn larger_bits(a: f64, b: f64) -> f64 {
    f64::from_bits(a.to_bits().max(b.to_bits()))
}

#[inline(always)]
fn pick(v: Eight, of: [usize; 8]) -> Eight {
    let mut result = [0.0; 8];
    for i in 0..8 {
        result[i] = v[of[i]];
    }
    result
}

impl Registers for Portable {
    type Eight = Eight;
    type Four = Four;
    type Two = Two;

    #[inline(always)]
    fn load(self, from: &Eight) -> Eight {
        *from
    }

    #[inline(always)]
    fn store(self, from: Eight) -> Eight {
        from
    }

    #[inline(always)]
    fn splat(self, x: f64) -> Eight {
        [x; 8]
    }

    #[inline(always)]
    fn add(self, a: Eight, b: Eight) -> Eight {
        each(a, b, plus)
    }

    #[inline(always)]
    fn sub(self, a: Eight, b: Eight) -> Eight {
        each(a, b, minus)
    }

    #[inline(always)]
    fn mul(self, a: Eight, b: Eight) -> Eight {
        each(a, b, times)
    }

    #[inline(always)]
    fn div(self, a: Eight, b: Eight) -> Eight {
        each(a, b, over)
    }

    #[inline(always)]
    fn sqrt(self, v: Eight) -> Eight {
        v.map(f64::sqrt)
    }

    #[inline(always)]
    fn max(self, a: Eight, b: Eight) -> Eight {
        each(a, b, larger)
    }

    #[inline(always)]
    fn max_bits(self, a: Eight, b: Eight) -> Eight {
        each(a, b, larger_bits)
    }

    #[inline(always)]
    fn abs(self, v: Eight) -> Eight {
        v.map(f64::abs)
    }

    #[inline(always)]
    fn later(self, first: f64, [a, b, c, d, e, f, g, _]: Eight) -> Eight {
        [first, a, b, c, d, e, f, g]
    }

    #[inline(always)]
    fn interleave(self, a: Eight, b: Eight) -> [Eight; 2] {
        [[a[0], b[0], a[2], b[2], a[4], b[4], a[6], b[6]], [a[1], b[1], a[3], b[3], a[5], b[5], a[7], b[7]]]
    }

    #[inline(always)]
    fn transpose(self, [a, b, c, d, e, f, g, h]: [&[f64; 2]; 8]) -> [Eight; 2] {
        [[a[0], b[0], c[0], d[0], e[0], f[0], g[0], h[0]], [a[1], b[1], c[1], d[1], e[1], f[1], g[1], h[1]]]
    }

    #[inline(always)]
    fn swap_pairs(self, [a, b, c, d, e, f, g, h]: Eight) -> Eight {
        [c, d, a, b, g, h, e, f]
    }

    #[inline(always)]
    fn turn(self, [a, b, c, d, e, f, g, h]: Eight) -> Eight {
        [f, e, h, g, b, a, d, c]
    }

    #[inline(always)]
    fn first(self, [a, b, c, d, ..]: Eight) -> Four {
        [a, b, c, d]
    }

    #[inline(always)]
    fn last(self, [.., e, f, g, h]: Eight) -> Four {
        [e, f, g, h]
    }

    #[inline(always)]
    fn with_first(self, [.., e, f, g, h]: Eight, [a, b, c, d]: Four) -> Eight {
        [a, b, c, d, e, f, g, h]
    }

    #[inline(always)]
    fn join(self, [a, b, c, d]: Four, [e, f, g, h]: Four) -> Eight {
        [a, b, c, d, e, f, g, h]
    }

    #[inline(always)]
    fn load4(self, from: &Four) -> Four {
        *from
    }

    #[inline(always)]
    fn store4(self, from: Four) -> Four {
        from
    }

    #[inline(always)]
    fn splat4(self, x: f64) -> Four {
        [x; 4]
    }

    #[inline(always)]
    fn add4(self, a: Four, b: Four) -> Four {
        each(a, b, plus)
    }

    #[inline(always)]
    fn sub4(self, a: Four, b: Four) -> Four {
        each(a, b, minus)
    }

    #[inline(always)]
    fn mul4(self, a: Four, b: Four) -> Four {
        each(a, b, times)
    }

    #[inline(always)]
    fn quad(self, [a, b, c, d]: [Two; 4]) -> Eight {
        [a[0], a[1], b[0], b[1], c[0], c[1], d[0], d[1]]
    }

    #[inline(always)]
    fn twice(self, [a, b]: [Two; 2]) -> Eight {
        self.quad([a, a, b, b])
    }

    #[inline(always)]
    fn repeat(self, [a, b, c, d]: &[f64; 4]) -> Eight {
        [*a, *a, *b, *b, *c, *c, *d, *d]
    }

    #[inline(always)]
    fn evens(self, v: Eight) -> Eight {
        pick(v, [0, 0, 2, 2, 4, 4, 6, 6])
    }

    #[inline(always)]
    fn odds(self, v: Eight) -> Eight {
        pick(v, [1, 1, 3, 3, 5, 5, 7, 7])
    }

    #[inline(always)]
    fn swap_lanes(self, v: Eight) -> Eight {
        pick(v, [1, 0, 3, 2, 5, 4, 7, 6])
    }

    #[inline(always)]
    fn ends(self, v: Eight) -> [Two; 2] {
        [[v[0], v[1]], [v[4], v[5]]]
    }

    #[inline(always)]
    fn add_to(self, to: &mut Two, v: Two) {
        *to = [to[0] + v[0], to[1] + v[1]];
    }

    #[inline(always)]
    fn take_from(self, from: &mut Two, v: Two) {
        *from = [from[0] - v[0], from[1] - v[1]];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[inline(always)]
    fn sweep(values: &[[f64; 8]], to: &mut [[f64; 8]]) {
        for (to, value) in to.iter_mut().zip(values) {
            let (sum, value) = (*to, *value);
            *to = std::array::from_fn(|l| sum[l] / 3.0 + value[l] * value[l]);
        }
    }

    /// A fused product and sum would change the last bit of some of the thousand numbers.
    #[test]
    fn the_bits_are_those_of_the_portable_copy() {
        let values: Vec<[f64; 8]> = (0..128).map(|i| std::array::from_fn(|l| ((8 * i + l) as f64).sin())).collect();
        let (mut plain, mut wide) = (values.clone(), values.clone());
        sweep(&values, &mut plain);
        dispatch(
            #[inline(always)]
            || sweep(&values, &mut wide),
        );
        assert_eq!(plain, wide);
    }

    /// Every operation on numbers without a pattern.
    struct All([Eight; 2]);

    impl Task for All {
        type Output = (Vec<Eight>, Vec<Four>, Vec<Two>);

        fn run<R: Registers>(self, r: R) -> Self::Output {
            let [a, b] = self.0.map(|v| r.load(&v));
            let (c, d) = (r.first(a), r.load4(&[self.0[1][1], self.0[1][3], self.0[1][5], self.0[1][7]]));
            let nothing = r.splat(f64::NAN);
            let pairs: [[f64; 2]; 8] = std::array::from_fn(|i| [self.0[0][i], self.0[1][i]]);
            let (transposed, interleaved) = (r.transpose(pairs.each_ref()), r.interleave(a, b));
            let eight = [
                r.splat(self.0[0][3]),
                r.add(a, b),
                r.sub(a, b),
                r.mul(a, b),
                r.div(a, b),
                r.max(a, r.sub(b, r.splat(2.0))),
                r.max(a, nothing),
                r.max(nothing, a),
                r.max_bits(a, r.abs(r.sub(b, r.splat(5.0)))),
                r.max_bits(a, nothing),
                r.abs(r.sub(a, b)),
                r.later(self.0[1][6], a),
                transposed[0],
                transposed[1],
                interleaved[0],
                interleaved[1],
                r.swap_pairs(a),
                r.turn(a),
                r.with_first(b, c),
                r.join(d, c),
                r.quad([pairs[3], pairs[0], pairs[2], pairs[1]]),
                r.twice([pairs[1], pairs[0]]),
                r.repeat(&[0.1, 0.2, 0.3, 0.7]),
                r.evens(a),
                r.odds(a),
                r.swap_lanes(a),
            ];
            let four = [c, d, r.last(b), r.splat4(self.0[0][2]), r.add4(c, d), r.sub4(c, d), r.mul4(c, d)];
            let [first, last] = r.ends(a);
            let (mut more, mut less) = (pairs[4], pairs[5]);
            r.add_to(&mut more, first);
            r.take_from(&mut less, last);
            (eight.map(|v| r.store(v)).to_vec(), four.map(|v| r.store4(v)).to_vec(), vec![more, less])
        }
    }

    /// Every instruction set of this processor does what plain arrays do.
    #[test]
    fn the_operations_are_those_of_plain_arrays() {
        let values = [0, 8].map(|start| std::array::from_fn(|i| ((start + i + 1) as f64).sqrt()));
        let plain = All(values).run(Portable);
        // By bits: NaN is not equal to itself.
        let bits = |(eight, four, two): (Vec<Eight>, Vec<Four>, Vec<Two>)| {
            let all = eight.as_flattened().iter().chain(four.as_flattened()).chain(two.as_flattened());
            all.map(|x| x.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(bits(plain.clone()), bits(run_task(All(values))));
        #[cfg(target_arch = "x86_64")]
        if let Some(set) = pulp::x86::V3::try_new() {
            let run = || All(values).run(set);
            assert_eq!(bits(plain.clone()), bits(set.vectorize(run)));
        }
        assert!(plain.0[7].iter().chain(&plain.0[9]).all(|x| x.is_nan()));
        assert_eq!([plain.0[6], plain.0[12], plain.0[13]], [values[0], values[0], values[1]]);
        let alternating = |c: usize| std::array::from_fn(|i| values[i % 2][i - i % 2 + c]);
        assert_eq!([plain.0[14], plain.0[15]], [0, 1].map(alternating));
        assert_eq!(plain.0[16], [2, 3, 0, 1, 6, 7, 4, 5].map(|i| values[0][i]));
        assert_eq!(plain.0[17], [5, 4, 7, 6, 1, 0, 3, 2].map(|i| values[0][i]));
        assert_eq!(plain.2[1], [values[0][5] - values[0][4], values[1][5] - values[0][5]]);
    }
}
