//! The vectors of AVX2 and AVX-512.

use super::{Half, Lanes, Wide};
use pulp::cast;
use pulp::x86::{V3, V4};
use std::arch::x86_64::{__m128d, __m256d, __m512d};

#[inline(always)]
fn each(v: [__m256d; 2], f: impl Fn(__m256d) -> __m256d) -> [__m256d; 2] {
    [f(v[0]), f(v[1])]
}

/// AVX2: two registers.
impl Lanes for V3 {
    type Wide = [__m256d; 2];
    type Half = __m128d;

    #[inline(always)]
    fn quad(self, [a, b, c, d]: [Half; 4]) -> Self::Wide {
        let low = self.avx._mm256_castpd128_pd256(cast(a));
        let high = self.avx._mm256_castpd128_pd256(cast(c));
        [self.avx._mm256_insertf128_pd::<1>(low, cast(b)), self.avx._mm256_insertf128_pd::<1>(high, cast(d))]
    }

    #[inline(always)]
    fn twice(self, [a, b]: [Half; 2]) -> Self::Wide {
        [self.avx._mm256_broadcast_pd(&cast(a)), self.avx._mm256_broadcast_pd(&cast(b))]
    }

    #[inline(always)]
    fn splat(self, number: f64) -> Self::Wide {
        [self.avx._mm256_set1_pd(number); 2]
    }

    #[inline(always)]
    fn repeat(self, numbers: &[f64; 4]) -> Self::Wide {
        let v = cast(*numbers);
        [self.avx2._mm256_permute4x64_pd::<0b01_01_00_00>(v), self.avx2._mm256_permute4x64_pd::<0b11_11_10_10>(v)]
    }

    #[inline(always)]
    fn load(self, from: &Wide) -> Self::Wide {
        cast(*from)
    }

    #[inline(always)]
    fn store(self, from: Self::Wide) -> Wide {
        cast(from)
    }

    #[inline(always)]
    fn first(self, v: Self::Wide) -> Self::Wide {
        each(
            v,
            #[inline(always)]
            |v| self.avx._mm256_movedup_pd(v),
        )
    }

    #[inline(always)]
    fn second(self, v: Self::Wide) -> Self::Wide {
        each(
            v,
            #[inline(always)]
            |v| self.avx._mm256_permute_pd::<0b1111>(v),
        )
    }

    #[inline(always)]
    fn swap(self, v: Self::Wide) -> Self::Wide {
        each(
            v,
            #[inline(always)]
            |v| self.avx._mm256_permute_pd::<0b0101>(v),
        )
    }

    #[inline(always)]
    fn cross(self, v: Self::Wide) -> Self::Wide {
        each(
            v,
            #[inline(always)]
            |v| self.avx._mm256_permute2f128_pd::<1>(v, v),
        )
    }

    #[inline(always)]
    fn add(self, a: Self::Wide, b: Self::Wide) -> Self::Wide {
        [self.avx._mm256_add_pd(a[0], b[0]), self.avx._mm256_add_pd(a[1], b[1])]
    }

    #[inline(always)]
    fn sub(self, a: Self::Wide, b: Self::Wide) -> Self::Wide {
        [self.avx._mm256_sub_pd(a[0], b[0]), self.avx._mm256_sub_pd(a[1], b[1])]
    }

    #[inline(always)]
    fn mul(self, a: Self::Wide, b: Self::Wide) -> Self::Wide {
        [self.avx._mm256_mul_pd(a[0], b[0]), self.avx._mm256_mul_pd(a[1], b[1])]
    }

    #[inline(always)]
    fn ends(self, v: Self::Wide) -> [__m128d; 2] {
        [self.avx._mm256_castpd256_pd128(v[0]), self.avx._mm256_castpd256_pd128(v[1])]
    }

    #[inline(always)]
    fn add_to(self, to: &mut Half, v: __m128d) {
        *to = cast(self.sse2._mm_add_pd(cast(*to), v));
    }

    #[inline(always)]
    fn take_from(self, from: &mut Half, v: __m128d) {
        *from = cast(self.sse2._mm_sub_pd(cast(*from), v));
    }
}

/// AVX-512: one register.
impl Lanes for V4 {
    type Wide = __m512d;
    type Half = __m128d;

    #[inline(always)]
    fn quad(self, [a, b, c, d]: [Half; 4]) -> Self::Wide {
        let v = self.avx512f._mm512_castpd128_pd512(cast(a));
        let v = self.avx512dq._mm512_mask_broadcast_f64x2(v, 0b1100, cast(b));
        let v = self.avx512dq._mm512_mask_broadcast_f64x2(v, 0b11_0000, cast(c));
        self.avx512dq._mm512_mask_broadcast_f64x2(v, 0b1100_0000, cast(d))
    }

    #[inline(always)]
    fn twice(self, [a, b]: [Half; 2]) -> Self::Wide {
        let v = self.avx512dq._mm512_broadcast_f64x2(cast(a));
        self.avx512dq._mm512_mask_broadcast_f64x2(v, 0b1111_0000, cast(b))
    }

    #[inline(always)]
    fn splat(self, number: f64) -> Self::Wide {
        self.avx512f._mm512_set1_pd(number)
    }

    #[inline(always)]
    fn repeat(self, numbers: &[f64; 4]) -> Self::Wide {
        let order = cast([0_u64, 0, 1, 1, 2, 2, 3, 3]);
        self.avx512f._mm512_permutexvar_pd(order, self.avx512f._mm512_castpd256_pd512(cast(*numbers)))
    }

    #[inline(always)]
    fn load(self, from: &Wide) -> Self::Wide {
        cast(*from)
    }

    #[inline(always)]
    fn store(self, from: Self::Wide) -> Wide {
        cast(from)
    }

    #[inline(always)]
    fn first(self, v: Self::Wide) -> Self::Wide {
        self.avx512f._mm512_movedup_pd(v)
    }

    #[inline(always)]
    fn second(self, v: Self::Wide) -> Self::Wide {
        self.avx512f._mm512_permute_pd::<0b1111_1111>(v)
    }

    #[inline(always)]
    fn swap(self, v: Self::Wide) -> Self::Wide {
        self.avx512f._mm512_permute_pd::<0b0101_0101>(v)
    }

    #[inline(always)]
    fn cross(self, v: Self::Wide) -> Self::Wide {
        self.avx512f._mm512_shuffle_f64x2::<0b1011_0001>(v, v)
    }

    #[inline(always)]
    fn add(self, a: Self::Wide, b: Self::Wide) -> Self::Wide {
        self.avx512f._mm512_add_pd(a, b)
    }

    #[inline(always)]
    fn sub(self, a: Self::Wide, b: Self::Wide) -> Self::Wide {
        self.avx512f._mm512_sub_pd(a, b)
    }

    #[inline(always)]
    fn mul(self, a: Self::Wide, b: Self::Wide) -> Self::Wide {
        self.avx512f._mm512_mul_pd(a, b)
    }

    #[inline(always)]
    fn ends(self, v: Self::Wide) -> [__m128d; 2] {
        [self.avx512f._mm512_castpd512_pd128(v), self.avx512dq._mm512_extractf64x2_pd::<2>(v)]
    }

    #[inline(always)]
    fn add_to(self, to: &mut Half, v: __m128d) {
        *to = cast(self.sse2._mm_add_pd(cast(*to), v));
    }

    #[inline(always)]
    fn take_from(self, from: &mut Half, v: __m128d) {
        *from = cast(self.sse2._mm_sub_pd(cast(*from), v));
    }
}
