//! Four lanes in one register, with fused multiplication and addition.
//!
//! With `stack.rs` the only `unsafe` below the ABI: instructions that [`super::dispatch`] has found the processor to have.
#![allow(unsafe_code)]

use super::lanes::{Kernel, Lanes, Real};
use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Four doubles. Made only in kernels that [`run`] runs, so where there is a value, there is AVX2 with FMA.
#[derive(Clone, Copy, Debug)]
pub(super) struct Avx2(__m256d);

/// Runs a kernel; the caller has found AVX2 and FMA.
#[inline]
pub(super) fn run<K: Kernel>(kernel: K) -> K::Output {
    #[target_feature(enable = "avx2,fma")]
    fn with_features<K: Kernel>(kernel: K) -> K::Output {
        kernel.run::<Avx2>()
    }
    // SAFETY: called by `dispatch` alone, after it asked the processor for both features.
    unsafe { with_features(kernel) }
}

/// The same with the registers and broadcasts of AVX-512: equal in every bit; the caller has found AVX-512F and VL as well.
#[inline]
pub(super) fn run_wide<K: Kernel>(kernel: K) -> K::Output {
    #[target_feature(enable = "avx2,fma,avx512f,avx512vl")]
    fn with_more_registers<K: Kernel>(kernel: K) -> K::Output {
        kernel.run::<Avx2>()
    }
    // SAFETY: called by `dispatch_wide` alone, after it asked the processor for these features.
    unsafe { with_more_registers(kernel) }
}

/// An instruction on lanes.
macro_rules! instruction {
    ($e:expr) => {
        // SAFETY: within a kernel that `run` runs, so the processor has the instruction; it touches no memory.
        unsafe { $e }
    };
}

macro_rules! lanewise {
    ($($trait:ident $method:ident $instruction:ident),*) => {$(
        impl $trait for Avx2 {
            type Output = Avx2;
            #[inline(always)]
            fn $method(self, o: Avx2) -> Avx2 {
                Avx2(instruction!($instruction(self.0, o.0)))
            }
        }
    )*};
}

lanewise!(Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd, Div div _mm256_div_pd);

impl Neg for Avx2 {
    type Output = Avx2;
    #[inline(always)]
    fn neg(self) -> Avx2 {
        Avx2(instruction!(_mm256_xor_pd(self.0, _mm256_set1_pd(-0.0))))
    }
}

impl Real for Avx2 {
    #[inline(always)]
    fn splat(v: f64) -> Avx2 {
        Avx2(instruction!(_mm256_set1_pd(v)))
    }
    #[inline(always)]
    fn mul_add(self, b: Avx2, c: Avx2) -> Avx2 {
        Avx2(instruction!(_mm256_fmadd_pd(self.0, b.0, c.0)))
    }
    #[inline(always)]
    fn mul_sub(self, b: Avx2, c: Avx2) -> Avx2 {
        Avx2(instruction!(_mm256_fmsub_pd(self.0, b.0, c.0)))
    }
    #[inline(always)]
    fn neg_mul_add(self, b: Avx2, c: Avx2) -> Avx2 {
        Avx2(instruction!(_mm256_fnmadd_pd(self.0, b.0, c.0)))
    }
    #[inline(always)]
    fn sqrt(self) -> Avx2 {
        Avx2(instruction!(_mm256_sqrt_pd(self.0)))
    }
    #[inline(always)]
    fn max(self, other: Avx2) -> Avx2 {
        Avx2(instruction!(_mm256_max_pd(self.0, other.0)))
    }
    #[inline(always)]
    fn min(self, other: Avx2) -> Avx2 {
        Avx2(instruction!(_mm256_min_pd(self.0, other.0)))
    }
    #[inline(always)]
    fn where_positive(self, yes: Avx2, no: Avx2) -> Avx2 {
        Avx2(instruction!({
            let above = _mm256_cmp_pd::<_CMP_GT_OQ>(self.0, _mm256_setzero_pd());
            _mm256_blendv_pd(no.0, yes.0, above)
        }))
    }
}

impl Lanes for Avx2 {
    const SHARED: bool = false;
    #[inline(always)]
    fn load(v: &[f64; 4]) -> Avx2 {
        // SAFETY: as for `instruction`; reads the four doubles of `v`.
        Avx2(unsafe { _mm256_loadu_pd(v.as_ptr()) })
    }
    #[inline(always)]
    fn store(self) -> [f64; 4] {
        let mut v = [0.0; 4];
        // SAFETY: as for `instruction`; writes the four doubles of `v`.
        unsafe { _mm256_storeu_pd(v.as_mut_ptr(), self.0) }
        v
    }
    #[inline(always)]
    fn sums(v: [Avx2; 4]) -> Avx2 {
        Avx2(instruction!({
            // Neighbours added: (a0 + a1, b0 + b1, a2 + a3, b2 + b3); then the halves.
            let (ab, cd) = (_mm256_hadd_pd(v[0].0, v[1].0), _mm256_hadd_pd(v[2].0, v[3].0));
            _mm256_add_pd(_mm256_blend_pd::<0b1100>(ab, cd), _mm256_permute2f128_pd::<0x21>(ab, cd))
        }))
    }
    #[inline(always)]
    fn pairs(self, other: Avx2) -> [Avx2; 2] {
        instruction!([Avx2(_mm256_unpacklo_pd(self.0, other.0)), Avx2(_mm256_unpackhi_pd(self.0, other.0))])
    }
    #[inline(always)]
    fn any_positive(self) -> bool {
        instruction!(_mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GT_OQ>(self.0, _mm256_setzero_pd()))) != 0
    }
    #[inline(always)]
    fn swap_1_3(self) -> Avx2 {
        Avx2(instruction!(_mm256_permute4x64_pd::<0b01_10_11_00>(self.0)))
    }
    #[inline(always)]
    fn swap_1_2(self) -> Avx2 {
        Avx2(instruction!(_mm256_permute4x64_pd::<0b11_01_10_00>(self.0)))
    }
    #[inline(always)]
    fn swap_halves(self) -> Avx2 {
        Avx2(instruction!(_mm256_permute4x64_pd::<0b01_00_11_10>(self.0)))
    }
    #[inline(always)]
    fn swap_neighbours(self) -> Avx2 {
        Avx2(instruction!(_mm256_permute_pd::<0b0101>(self.0)))
    }
    #[inline(always)]
    fn transpose(v: [Avx2; 4]) -> [Avx2; 4] {
        instruction!({
            let (low01, high01) = (_mm256_unpacklo_pd(v[0].0, v[1].0), _mm256_unpackhi_pd(v[0].0, v[1].0));
            let (low23, high23) = (_mm256_unpacklo_pd(v[2].0, v[3].0), _mm256_unpackhi_pd(v[2].0, v[3].0));
            [
                Avx2(_mm256_permute2f128_pd::<0x20>(low01, low23)),
                Avx2(_mm256_permute2f128_pd::<0x20>(high01, high23)),
                Avx2(_mm256_permute2f128_pd::<0x31>(low01, low23)),
                Avx2(_mm256_permute2f128_pd::<0x31>(high01, high23)),
            ]
        })
    }
}
