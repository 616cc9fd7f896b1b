//! The registers of AVX2 and AVX-512.

use super::{Eight, Four, Portable, Registers, Two};
use pulp::cast;
use pulp::x86::{V3, V4};
use std::arch::x86_64::{__m128d, __m256d, __m512d};

/// Operations on four numbers, which both instruction sets have.
macro_rules! four {
    () => {
        #[inline(always)]
        fn load4(self, from: &Four) -> __m256d {
            cast(*from)
        }

        #[inline(always)]
        fn store4(self, from: __m256d) -> Four {
            cast(from)
        }

        #[inline(always)]
        fn splat4(self, x: f64) -> __m256d {
            self.avx._mm256_set1_pd(x)
        }

        #[inline(always)]
        fn add4(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_add_pd(a, b)
        }

        #[inline(always)]
        fn sub4(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_sub_pd(a, b)
        }

        #[inline(always)]
        fn mul4(self, a: __m256d, b: __m256d) -> __m256d {
            self.avx._mm256_mul_pd(a, b)
        }
    };
}

/// Two vectors, from memory.
#[inline(always)]
fn both(set: V3, a: &[f64; 2], b: &[f64; 2]) -> __m256d {
    set.avx._mm256_insertf128_pd::<1>(set.avx._mm256_castpd128_pd256(cast(*a)), cast(*b))
}

#[inline(always)]
fn each(v: [__m256d; 2], f: impl Fn(__m256d) -> __m256d) -> [__m256d; 2] {
    [f(v[0]), f(v[1])]
}

/// AVX2: two registers.
impl Registers for V3 {
    type Eight = [__m256d; 2];
    type Four = __m256d;
    type Two = __m128d;

    four!();

    #[inline(always)]
    fn load(self, from: &Eight) -> Self::Eight {
        cast(*from)
    }

    #[inline(always)]
    fn store(self, from: Self::Eight) -> Eight {
        cast(from)
    }

    #[inline(always)]
    fn splat(self, x: f64) -> Self::Eight {
        [self.splat4(x); 2]
    }

    #[inline(always)]
    fn add(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        [self.add4(a[0], b[0]), self.add4(a[1], b[1])]
    }

    #[inline(always)]
    fn sub(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        [self.sub4(a[0], b[0]), self.sub4(a[1], b[1])]
    }

    #[inline(always)]
    fn mul(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        [self.mul4(a[0], b[0]), self.mul4(a[1], b[1])]
    }

    #[inline(always)]
    fn div(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        [self.avx._mm256_div_pd(a[0], b[0]), self.avx._mm256_div_pd(a[1], b[1])]
    }

    #[inline(always)]
    fn sqrt(self, v: Self::Eight) -> Self::Eight {
        [self.avx._mm256_sqrt_pd(v[0]), self.avx._mm256_sqrt_pd(v[1])]
    }

    #[inline(always)]
    fn max(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        // Where one is NaN, the instruction gives its second operand.
        [self.avx._mm256_max_pd(b[0], a[0]), self.avx._mm256_max_pd(b[1], a[1])]
    }

    #[inline(always)]
    fn max_bits(self, a: Self::Eight, b: Self::Eight) -> Self::Eight {
        // There is no such instruction.
        self.load(&Portable.max_bits(self.store(a), self.store(b)))
    }

    #[inline(always)]
    fn abs(self, v: Self::Eight) -> Self::Eight {
        let sign = self.splat4(-0.0);
        [self.avx._mm256_andnot_pd(sign, v[0]), self.avx._mm256_andnot_pd(sign, v[1])]
    }

    #[inline(always)]
    fn later(self, first: f64, v: Self::Eight) -> Self::Eight {
        self.load(&Portable.later(first, self.store(v)))
    }

    #[inline(always)]
    fn interleave(self, [a, b]: Self::Eight, [c, d]: Self::Eight) -> [Self::Eight; 2] {
        let first = [self.avx._mm256_unpacklo_pd(a, c), self.avx._mm256_unpacklo_pd(b, d)];
        [first, [self.avx._mm256_unpackhi_pd(a, c), self.avx._mm256_unpackhi_pd(b, d)]]
    }

    #[inline(always)]
    fn transpose(self, [a, b, c, d, e, f, g, h]: [&[f64; 2]; 8]) -> [Self::Eight; 2] {
        let [p, q] = [both(self, a, c), both(self, e, g)];
        let [r, s] = [both(self, b, d), both(self, f, h)];
        let low = [self.avx._mm256_unpacklo_pd(p, r), self.avx._mm256_unpacklo_pd(q, s)];
        [low, [self.avx._mm256_unpackhi_pd(p, r), self.avx._mm256_unpackhi_pd(q, s)]]
    }

    #[inline(always)]
    fn swap_pairs(self, [a, b]: Self::Eight) -> Self::Eight {
        [self.avx._mm256_permute2f128_pd::<1>(a, a), self.avx._mm256_permute2f128_pd::<1>(b, b)]
    }

    #[inline(always)]
    fn turn(self, [a, b]: Self::Eight) -> Self::Eight {
        [self.avx._mm256_permute_pd::<0b0101>(b), self.avx._mm256_permute_pd::<0b0101>(a)]
    }

    #[inline(always)]
    fn first(self, [a, _]: Self::Eight) -> __m256d {
        a
    }

    #[inline(always)]
    fn last(self, [_, b]: Self::Eight) -> __m256d {
        b
    }

    #[inline(always)]
    fn with_first(self, [_, b]: Self::Eight, first: __m256d) -> Self::Eight {
        [first, b]
    }

    #[inline(always)]
    fn join(self, first: __m256d, last: __m256d) -> Self::Eight {
        [first, last]
    }

    #[inline(always)]
    fn quad(self, [a, b, c, d]: [Two; 4]) -> Self::Eight {
        let low = self.avx._mm256_castpd128_pd256(cast(a));
        let high = self.avx._mm256_castpd128_pd256(cast(c));
        [self.avx._mm256_insertf128_pd::<1>(low, cast(b)), self.avx._mm256_insertf128_pd::<1>(high, cast(d))]
    }

    #[inline(always)]
    fn twice(self, [a, b]: [Two; 2]) -> Self::Eight {
        [self.avx._mm256_broadcast_pd(&cast(a)), self.avx._mm256_broadcast_pd(&cast(b))]
    }

    #[inline(always)]
    fn repeat(self, numbers: &[f64; 4]) -> Self::Eight {
        let v = cast(*numbers);
        [self.avx2._mm256_permute4x64_pd::<0b01_01_00_00>(v), self.avx2._mm256_permute4x64_pd::<0b11_11_10_10>(v)]
    }

    #[inline(always)]
    fn evens(self, v: Self::Eight) -> Self::Eight {
        each(
            v,
            #[inline(always)]
            |v| self.avx._mm256_movedup_pd(v),
        )
    }

    #[inline(always)]
    fn odds(self, v: Self::Eight) -> Self::Eight {
        each(
            v,
            #[inline(always)]
            |v| self.avx._mm256_permute_pd::<0b1111>(v),
        )
    }

    #[inline(always)]
    fn swap_lanes(self, v: Self::Eight) -> Self::Eight {
        each(
            v,
            #[inline(always)]
            |v| self.avx._mm256_permute_pd::<0b0101>(v),
        )
    }

    #[inline(always)]
    fn ends(self, v: Self::Eight) -> [__m128d; 2] {
        [self.avx._mm256_castpd256_pd128(v[0]), self.avx._mm256_castpd256_pd128(v[1])]
    }

    #[inline(always)]
    fn add_to(self, to: &mut Two, v: __m128d) {
        *to = cast(self.sse2._mm_add_pd(cast(*to), v));
    }

    #[inline(always)]
    fn take_from(self, from: &mut Two, v: __m128d) {
        *from = cast(self.sse2._mm_sub_pd(cast(*from), v));
    }
}

/// AVX-512: one register.
impl Registers for V4 {
    type Eight = __m512d;
    type Four = __m256d;
    type Two = __m128d;

    four!();

    #[inline(always)]
    fn load(self, from: &Eight) -> __m512d {
        cast(*from)
    }

    #[inline(always)]
    fn store(self, from: __m512d) -> Eight {
        cast(from)
    }

    #[inline(always)]
    fn splat(self, x: f64) -> __m512d {
        self.avx512f._mm512_set1_pd(x)
    }

    #[inline(always)]
    fn add(self, a: __m512d, b: __m512d) -> __m512d {
        self.avx512f._mm512_add_pd(a, b)
    }

    #[inline(always)]
    fn sub(self, a: __m512d, b: __m512d) -> __m512d {
        self.avx512f._mm512_sub_pd(a, b)
    }

    #[inline(always)]
    fn mul(self, a: __m512d, b: __m512d) -> __m512d {
        self.avx512f._mm512_mul_pd(a, b)
    }

    #[inline(always)]
    fn div(self, a: __m512d, b: __m512d) -> __m512d {
        self.avx512f._mm512_div_pd(a, b)
    }

    #[inline(always)]
    fn sqrt(self, v: __m512d) -> __m512d {
        self.avx512f._mm512_sqrt_pd(v)
    }

    #[inline(always)]
    fn max(self, a: __m512d, b: __m512d) -> __m512d {
        // Where one is NaN, the instruction gives its second operand.
        self.avx512f._mm512_max_pd(b, a)
    }

    #[inline(always)]
    fn max_bits(self, a: __m512d, b: __m512d) -> __m512d {
        cast(self.avx512f._mm512_max_epu64(cast(a), cast(b)))
    }

    #[inline(always)]
    fn abs(self, v: __m512d) -> __m512d {
        self.avx512f._mm512_abs_pd(v)
    }

    #[inline(always)]
    fn later(self, first: f64, v: __m512d) -> __m512d {
        cast(self.avx512f._mm512_alignr_epi64::<7>(cast(v), cast(self.splat(first))))
    }

    #[inline(always)]
    fn interleave(self, a: __m512d, b: __m512d) -> [__m512d; 2] {
        [self.avx512f._mm512_unpacklo_pd(a, b), self.avx512f._mm512_unpackhi_pd(a, b)]
    }

    #[inline(always)]
    fn transpose(self, [a, b, c, d, e, f, g, h]: [&[f64; 2]; 8]) -> [__m512d; 2] {
        let p = self.avx512f._mm512_castpd256_pd512(both(*self, a, c));
        let p = self.avx512f._mm512_insertf64x4::<1>(p, both(*self, e, g));
        let q = self.avx512f._mm512_castpd256_pd512(both(*self, b, d));
        let q = self.avx512f._mm512_insertf64x4::<1>(q, both(*self, f, h));
        [self.avx512f._mm512_unpacklo_pd(p, q), self.avx512f._mm512_unpackhi_pd(p, q)]
    }

    #[inline(always)]
    fn swap_pairs(self, v: __m512d) -> __m512d {
        self.avx512f._mm512_shuffle_f64x2::<0b1011_0001>(v, v)
    }

    #[inline(always)]
    fn turn(self, v: __m512d) -> __m512d {
        let swapped = self.avx512f._mm512_shuffle_f64x2::<0b0100_1110>(v, v);
        self.avx512f._mm512_permute_pd::<0b0101_0101>(swapped)
    }

    #[inline(always)]
    fn first(self, v: __m512d) -> __m256d {
        self.avx512f._mm512_castpd512_pd256(v)
    }

    #[inline(always)]
    fn last(self, v: __m512d) -> __m256d {
        self.avx512f._mm512_extractf64x4_pd::<1>(v)
    }

    #[inline(always)]
    fn with_first(self, v: __m512d, first: __m256d) -> __m512d {
        self.avx512f._mm512_insertf64x4::<0>(v, first)
    }

    #[inline(always)]
    fn join(self, first: __m256d, last: __m256d) -> __m512d {
        self.avx512f._mm512_insertf64x4::<1>(self.avx512f._mm512_castpd256_pd512(first), last)
    }

    #[inline(always)]
    fn quad(self, [a, b, c, d]: [Two; 4]) -> Self::Eight {
        let v = self.avx512f._mm512_castpd128_pd512(cast(a));
        let v = self.avx512dq._mm512_mask_broadcast_f64x2(v, 0b1100, cast(b));
        let v = self.avx512dq._mm512_mask_broadcast_f64x2(v, 0b11_0000, cast(c));
        self.avx512dq._mm512_mask_broadcast_f64x2(v, 0b1100_0000, cast(d))
    }

    #[inline(always)]
    fn twice(self, [a, b]: [Two; 2]) -> Self::Eight {
        let v = self.avx512dq._mm512_broadcast_f64x2(cast(a));
        self.avx512dq._mm512_mask_broadcast_f64x2(v, 0b1111_0000, cast(b))
    }

    #[inline(always)]
    fn repeat(self, numbers: &[f64; 4]) -> Self::Eight {
        let order = cast([0_u64, 0, 1, 1, 2, 2, 3, 3]);
        self.avx512f._mm512_permutexvar_pd(order, self.avx512f._mm512_castpd256_pd512(cast(*numbers)))
    }

    #[inline(always)]
    fn evens(self, v: Self::Eight) -> Self::Eight {
        self.avx512f._mm512_movedup_pd(v)
    }

    #[inline(always)]
    fn odds(self, v: Self::Eight) -> Self::Eight {
        self.avx512f._mm512_permute_pd::<0b1111_1111>(v)
    }

    #[inline(always)]
    fn swap_lanes(self, v: Self::Eight) -> Self::Eight {
        self.avx512f._mm512_permute_pd::<0b0101_0101>(v)
    }

    #[inline(always)]
    fn ends(self, v: Self::Eight) -> [__m128d; 2] {
        [self.avx512f._mm512_castpd512_pd128(v), self.avx512dq._mm512_extractf64x2_pd::<2>(v)]
    }

    #[inline(always)]
    fn add_to(self, to: &mut Two, v: __m128d) {
        *to = cast(self.sse2._mm_add_pd(cast(*to), v));
    }

    #[inline(always)]
    fn take_from(self, from: &mut Two, v: __m128d) {
        *from = cast(self.sse2._mm_sub_pd(cast(*from), v));
    }
}
