//! Vectors of the hot loops, for the instruction set that the machine has.
//!
//! Compilers split the loops of the elements into scalars and short vectors, which takes twice the time. A [`Task`] is
//! therefore written with [`Lanes`], and [`dispatch`] runs it with those of the machine. No operation is fused and each
//! works lane by lane, so that all instruction sets give the same bits.

#[cfg(target_arch = "x86_64")]
mod x86;

/// Two components of a node.
pub(crate) type Half = [f64; 2];
/// Eight numbers: two components of four vectors.
pub(crate) type Wide = [f64; 8];

/// Operations on eight numbers, and on the two of a node.
pub(crate) trait Lanes: Copy {
    /// Eight numbers in registers.
    type Wide: Copy;
    /// Two numbers in a register.
    type Half: Copy;

    /// From four vectors.
    fn quad(self, parts: [Half; 4]) -> Self::Wide;
    /// Each of two vectors twice.
    fn twice(self, parts: [Half; 2]) -> Self::Wide;
    /// A number eight times.
    fn splat(self, number: f64) -> Self::Wide;
    /// Each of four numbers twice.
    fn repeat(self, numbers: &[f64; 4]) -> Self::Wide;
    /// From memory.
    fn load(self, from: &Wide) -> Self::Wide;
    /// To memory.
    fn store(self, from: Self::Wide) -> Wide;
    /// The first component of each vector, twice.
    fn first(self, v: Self::Wide) -> Self::Wide;
    /// The second component of each vector, twice.
    fn second(self, v: Self::Wide) -> Self::Wide;
    /// Components exchanged.
    fn swap(self, v: Self::Wide) -> Self::Wide;
    /// Vectors 0 and 1 exchanged, and 2 and 3.
    fn cross(self, v: Self::Wide) -> Self::Wide;
    /// Sum.
    fn add(self, a: Self::Wide, b: Self::Wide) -> Self::Wide;
    /// Difference.
    fn sub(self, a: Self::Wide, b: Self::Wide) -> Self::Wide;
    /// Product.
    fn mul(self, a: Self::Wide, b: Self::Wide) -> Self::Wide;
    /// Vectors 0 and 2.
    fn ends(self, v: Self::Wide) -> [Self::Half; 2];
    /// `to` + `v`.
    fn add_to(self, to: &mut Half, v: Self::Half);
    /// `to` − `v`.
    fn take_from(self, from: &mut Half, v: Self::Half);
}

/// Work that is done with vectors.
pub(crate) trait Task {
    /// Its result.
    type Output;

    /// Does the work. All that it calls must be `#[inline(always)]`, to be compiled for the instruction set.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

/// Does the work with the widest vectors of the machine.
#[inline]
pub(crate) fn dispatch<T: Task>(task: T) -> T::Output {
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

/// Plain arrays, for every machine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Portable;

#[inline(always)]
fn map(a: Wide, b: Wide, f: impl Fn(f64, f64) -> f64) -> Wide {
    let mut result = [0.0; 8];
    for i in 0..8 {
        result[i] = f(a[i], b[i]);
    }
    result
}

#[inline(always)]
fn pick(v: Wide, of: [usize; 8]) -> Wide {
    let mut result = [0.0; 8];
    for i in 0..8 {
        result[i] = v[of[i]];
    }
    result
}

impl Lanes for Portable {
    type Wide = Wide;
    type Half = Half;

    #[inline(always)]
    fn quad(self, [a, b, c, d]: [Half; 4]) -> Wide {
        [a[0], a[1], b[0], b[1], c[0], c[1], d[0], d[1]]
    }

    #[inline(always)]
    fn twice(self, [a, b]: [Half; 2]) -> Wide {
        self.quad([a, a, b, b])
    }

    #[inline(always)]
    fn splat(self, number: f64) -> Wide {
        [number; 8]
    }

    #[inline(always)]
    fn repeat(self, [a, b, c, d]: &[f64; 4]) -> Wide {
        [*a, *a, *b, *b, *c, *c, *d, *d]
    }

    #[inline(always)]
    fn load(self, from: &Wide) -> Wide {
        *from
    }

    #[inline(always)]
    fn store(self, from: Wide) -> Wide {
        from
    }

    #[inline(always)]
    fn first(self, v: Wide) -> Wide {
        pick(v, [0, 0, 2, 2, 4, 4, 6, 6])
    }

    #[inline(always)]
    fn second(self, v: Wide) -> Wide {
        pick(v, [1, 1, 3, 3, 5, 5, 7, 7])
    }

    #[inline(always)]
    fn swap(self, v: Wide) -> Wide {
        pick(v, [1, 0, 3, 2, 5, 4, 7, 6])
    }

    #[inline(always)]
    fn cross(self, v: Wide) -> Wide {
        pick(v, [2, 3, 0, 1, 6, 7, 4, 5])
    }

    #[inline(always)]
    fn add(self, a: Wide, b: Wide) -> Wide {
        map(
            a,
            b,
            #[inline(always)]
            |a, b| a + b,
        )
    }

    #[inline(always)]
    fn sub(self, a: Wide, b: Wide) -> Wide {
        map(
            a,
            b,
            #[inline(always)]
            |a, b| a - b,
        )
    }

    #[inline(always)]
    fn mul(self, a: Wide, b: Wide) -> Wide {
        map(
            a,
            b,
            #[inline(always)]
            |a, b| a * b,
        )
    }

    #[inline(always)]
    fn ends(self, v: Wide) -> [Half; 2] {
        [[v[0], v[1]], [v[4], v[5]]]
    }

    #[inline(always)]
    fn add_to(self, to: &mut Half, v: Half) {
        *to = [to[0] + v[0], to[1] + v[1]];
    }

    #[inline(always)]
    fn take_from(self, from: &mut Half, v: Half) {
        *from = [from[0] - v[0], from[1] - v[1]];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation on numbers without a pattern.
    #[derive(Clone, Copy)]
    struct All([Wide; 2]);

    impl Task for All {
        type Output = (Vec<Wide>, Vec<Half>);

        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> Self::Output {
            let halves = |v: &Wide| [0, 2, 4, 6].map(|i| [v[i], v[i + 1]]);
            let ([p, q, r, s], numbers) = (halves(&self.0[0]), &[0.1, 0.2, 0.3, 0.7]);
            let (a, b) = (l.load(&self.0[0]), l.load(&self.0[1]));
            let wide = [
                l.quad([s, p, r, q]),
                l.twice([q, p]),
                l.splat(self.0[0][3]),
                l.repeat(numbers),
                l.first(a),
                l.second(a),
                l.swap(a),
                l.cross(a),
                l.add(a, b),
                l.sub(a, b),
                l.mul(a, b),
            ];
            let [first, last] = l.ends(a);
            let (mut more, mut less) = (r, s);
            l.add_to(&mut more, first);
            l.take_from(&mut less, last);
            (wide.map(|v| l.store(v)).to_vec(), vec![more, less])
        }
    }

    /// Every instruction set of this processor does what plain arrays do.
    #[test]
    fn the_operations_are_those_of_plain_arrays() {
        let all = All([0, 8].map(|start| std::array::from_fn(|i| ((start + i + 1) as f64).sqrt())));
        let plain = all.run(Portable);
        assert_eq!(plain, dispatch(all));
        #[cfg(target_arch = "x86_64")]
        if let Some(set) = pulp::x86::V3::try_new() {
            assert_eq!(plain, set.vectorize(|| all.run(set)));
        }
        let a = all.0[0];
        assert_eq!(plain.0[7], [2, 3, 0, 1, 6, 7, 4, 5].map(|i| a[i]));
        assert_eq!(plain.1[1], [a[6] - a[4], a[7] - a[5]]);
    }
}
