//! Four doubles at a time, whatever the machine: kernels are written once over [`Lanes`] and compiled for each back
//! end; [`dispatch`] takes the best one that the processor has.
//!
//! Everything in a kernel must be inlined into [`dispatch`]'s function, or it is compiled without the processor's
//! features: `#[inline(always)]` functions and plain loops, no closures, no `array::map`. Back ends differ in the last
//! bit, for only some fuse a multiplication with an addition; one machine always takes the same.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod finite;
mod lanes;
mod plain;
mod rows;
mod stack;

use finite::{AreFinite, FEW, few};
pub use lanes::{Kernel, Lanes, Real, rolled};
pub use plain::Plain;
pub use rows::{add_rows, prefetch, prefetch_all};
pub use stack::Stack;

/// What kernels are compiled for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum BackEnd {
    /// Any processor.
    Plain,
    /// x86-64 with AVX2 and FMA.
    Avx2,
}

/// The best one that this processor has.
#[inline]
pub fn back_end() -> BackEnd {
    #[cfg(test)]
    if tests::PLAIN.get() {
        return BackEnd::Plain;
    }
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
        return BackEnd::Avx2;
    }
    BackEnd::Plain
}

/// Runs a kernel on the best back end of this processor.
#[inline]
pub fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    if back_end() == BackEnd::Avx2 {
        return avx2::run(kernel);
    }
    kernel.run::<Plain>()
}

/// The same of a kernel that needs more numbers at a time than AVX2 has registers, for the few where time counts most: where the
/// processor has the 32 registers of AVX-512 it is compiled for them once more. The lanes are the same, and so is every bit.
#[inline]
pub fn dispatch_wide<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    if back_end() == BackEnd::Avx2 && is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl") {
        return avx2::run_wide(kernel);
    }
    dispatch(kernel)
}

/// Whether all of them are finite.
#[inline]
pub fn are_finite(values: &[f64]) -> bool {
    if values.len() < FEW { few(values) } else { dispatch(AreFinite { values }) }
}

#[cfg(test)]
pub(crate) use tests::on_plain_lanes;

#[cfg(test)]
mod tests {
    use super::*;

    thread_local! {
        pub(super) static PLAIN: std::cell::Cell<bool> = const { std::cell::Cell::new(false) };
    }

    /// Does `work` as on a processor without any features.
    pub(crate) fn on_plain_lanes<T>(work: impl FnOnce() -> T) -> T {
        PLAIN.set(true);
        let result = work();
        PLAIN.set(false);
        result
    }

    /// Every operation, in exact numbers: all back ends give the same.
    struct Operations;

    impl Kernel for Operations {
        type Output = Vec<[f64; 4]>;
        #[inline(always)]
        fn run<L: Lanes>(self) -> Vec<[f64; 4]> {
            let (a, b) = (L::load(&[1.0, -2.0, 4.0, 9.0]), L::load(&[2.0, 0.5, -1.0, 3.0]));
            let c = L::splat(0.25);
            let mut results = vec![a + b, a - b, a * b, b / c, -a, a.mul_add(b, c), (a * a).sqrt()];
            results.extend([a.max(b), a.min(b), a.where_positive(b, c), L::sums([a, b, c, a * b])]);
            results.extend(L::transpose([a, b, c, a + b]));
            results.extend([a.swap_1_3(), a.swap_1_2(), a.swap_halves(), a.swap_neighbours()]);
            results.extend([a.mul_sub(b, c), a.neg_mul_add(b, c)]);
            results.extend(a.pairs(b));
            results.into_iter().map(L::store).collect()
        }
    }

    #[test]
    fn back_ends_agree_and_are_right() {
        let plain = Operations.run::<Plain>();
        assert_eq!(dispatch(Operations), plain);
        assert_eq!(dispatch_wide(Operations), plain);
        assert_eq!(plain[0], [3.0, -1.5, 3.0, 12.0]);
        assert_eq!(plain[3], [8.0, 2.0, -4.0, 12.0]);
        assert_eq!(plain[5], [2.25, -0.75, -3.75, 27.25]);
        assert_eq!(plain[9], [2.0, 0.25, -1.0, 3.0]);
        assert_eq!(plain[10], [12.0, 4.5, 1.0, 24.0]);
        assert_eq!(plain[12], [-2.0, 0.5, 0.25, -1.5]);
        assert_eq!(plain[15], [1.0, 9.0, 4.0, -2.0]);
        assert_eq!(plain[16], [1.0, 4.0, -2.0, 9.0]);
        assert_eq!(plain[17], [4.0, 9.0, 1.0, -2.0]);
        assert_eq!(plain[18], [-2.0, 1.0, 9.0, 4.0]);
        assert_eq!(plain[19], [1.75, -1.25, -4.25, 26.75]);
        assert_eq!(plain[20], [-1.75, 1.25, 4.25, -26.75]);
        assert_eq!(plain[21..23], [[1.0, 2.0, 4.0, -1.0], [-2.0, 0.5, 9.0, 3.0]]);
    }

    struct AnyPositive([f64; 4]);

    impl Kernel for AnyPositive {
        type Output = bool;
        #[inline(always)]
        fn run<L: Lanes>(self) -> bool {
            L::load(&self.0).any_positive()
        }
    }

    #[test]
    fn any_positive_lane_is_seen() {
        let mut cases = vec![([0.0, -0.0, -1.0, f64::NAN], false)];
        for k in 0..4 {
            let mut v = [-1.0; 4];
            v[k] = f64::MIN_POSITIVE;
            cases.push((v, true));
        }
        for (v, any) in cases {
            assert_eq!([AnyPositive(v).run::<Plain>(), dispatch(AnyPositive(v))], [any; 2], "{v:?}");
        }
    }
}
