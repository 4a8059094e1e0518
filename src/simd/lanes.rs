//! What kernels are written over: numbers, and four of them at a time.

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
    /// Lanes 0 of both, then lanes 2; and lanes 1, then lanes 3.
    fn pairs(self, other: Self) -> [Self; 2];
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
