//! Four doubles at a time, whatever the machine: kernels are written once over [`Lanes`] and compiled for each back
//! end; [`dispatch`] takes the best one that the processor has.
//!
//! Everything in a kernel must be inlined into [`dispatch`]'s function, or it is compiled without the processor's
//! features: `#[inline(always)]` functions and plain loops, no closures, no `array::map`. Back ends differ in the last
//! bit, for only some fuse a multiplication with an addition; one machine always takes the same.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod plain;
mod stack;

pub use plain::Plain;
pub use stack::Stack;

use std::ops::{Add, Div, Mul, Neg, Sub};

/// What formulas need of a number: one `f64` or four of them.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// This number, everywhere.
    fn splat(v: f64) -> Self;
    /// `self` times `b` plus `c`, rounded once where the processor can.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// `self` times `b` minus `c`, likewise.
    fn mul_sub(self, b: Self, c: Self) -> Self;
    /// `c` minus `self` times `b`, likewise.
    fn neg_mul_add(self, b: Self, c: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// The larger.
    fn max(self, other: Self) -> Self;
    /// The smaller.
    fn min(self, other: Self) -> Self;
    /// `yes` where `self` is above 0, else `no`.
    fn where_positive(self, yes: Self, no: Self) -> Self;
}

/// Four doubles.
pub trait Lanes: Real {
    /// Whether kernels share the functions that they are made of instead of each having its own copy inlined: slower,
    /// and a smaller library. Not for back ends of a processor's features, which a function of its own would lose.
    const SHARED: bool;
    /// From memory.
    fn load(v: &[f64; 4]) -> Self;
    /// To memory.
    fn store(self) -> [f64; 4];
    /// The sums over the lanes of each.
    fn sums(v: [Self; 4]) -> Self;
    /// Rows become columns.
    fn transpose(v: [Self; 4]) -> [Self; 4];
    /// Whether any of them is above 0.
    fn any_positive(self) -> bool;
    /// Lanes 0, 3, 2, 1.
    fn swap_1_3(self) -> Self;
    /// Lanes 0, 2, 1, 3.
    fn swap_1_2(self) -> Self;
    /// Lanes 2, 3, 0, 1.
    fn swap_halves(self) -> Self;
    /// Lanes 1, 0, 3, 2.
    fn swap_neighbours(self) -> Self;
}

/// `n` as the bound of a loop that is to stay one: unrolled, its body would make the library several times as large.
#[inline(always)]
pub fn rolled(n: usize) -> usize {
    std::hint::black_box(n)
}

/// Something to be computed with four lanes.
pub trait Kernel {
    /// What comes out.
    type Output;
    /// Computes it; to be marked `#[inline(always)]`.
    fn run<L: Lanes>(self) -> Self::Output;
}

/// Runs a kernel on the best back end of this processor.
#[inline]
pub fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(test)]
    if tests::PLAIN.get() {
        return kernel.run::<Plain>();
    }
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
        return avx2::run(kernel);
    }
    kernel.run::<Plain>()
}

impl Real for f64 {
    #[inline(always)]
    fn splat(v: f64) -> f64 {
        v
    }
    #[inline(always)]
    fn mul_add(self, b: f64, c: f64) -> f64 {
        self * b + c // the fused one is a call where the target does not have it
    }
    #[inline(always)]
    fn mul_sub(self, b: f64, c: f64) -> f64 {
        self * b - c
    }
    #[inline(always)]
    fn neg_mul_add(self, b: f64, c: f64) -> f64 {
        c - self * b
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        f64::max(self, other)
    }
    #[inline(always)]
    fn min(self, other: f64) -> f64 {
        f64::min(self, other)
    }
    #[inline(always)]
    fn where_positive(self, yes: f64, no: f64) -> f64 {
        if self > 0.0 { yes } else { no }
    }
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
            results.into_iter().map(L::store).collect()
        }
    }

    #[test]
    fn back_ends_agree_and_are_right() {
        let plain = Operations.run::<Plain>();
        assert_eq!(dispatch(Operations), plain);
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
