//! Numbers of twice a double's precision: unevaluated sums of two doubles, for the few differences that cancel almost
//! wholly. Sums and products of doubles without error: Knuth (TAOCP 2, 4.2.2), Dekker (Numer. Math. 18, 1971); of pairs
//! of them, with relative errors of a few 2^-106: Joldes, Muller, Popescu (ACM TOMS 44, 2017), algorithms 6 and 10.
//!
//! Plain additions and multiplications in a fixed order: every machine and back end gives the same bits.

use std::ops::{Add, Mul, Sub};

/// high + low, `low` at most half a unit in the last place of `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// 2^27 + 1: splits 53 bits into 26 and 26.
const SPLIT: f64 = 134_217_729.0;

/// a + b, exactly.
#[inline]
fn two_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let part = high - a;
    DoubleDouble { high, low: (a - (high - part)) + (b - part) }
}

/// a + b, exactly, where |a| >= |b|.
#[inline]
fn fast_two_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

/// a b, exactly, unless it over- or underflows; without a fused multiplication, which most processors of a generic
/// build would emulate.
#[inline]
fn two_product(a: f64, b: f64) -> DoubleDouble {
    let halves = |v: f64| {
        let scaled = SPLIT * v;
        let high = scaled - (scaled - v);
        (high, v - high)
    };
    let (high, (a1, a2), (b1, b2)) = (a * b, halves(a), halves(b));
    DoubleDouble { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
}

impl DoubleDouble {
    /// a - b, exactly.
    #[inline]
    pub fn difference(a: f64, b: f64) -> DoubleDouble {
        two_sum(a, -b)
    }

    /// The nearest double.
    #[inline]
    pub fn value(self) -> f64 {
        self.high
    }
}

impl Add for DoubleDouble {
    type Output = DoubleDouble;
    /// Relative error 3 2^-106, whatever the signs.
    #[inline]
    fn add(self, o: DoubleDouble) -> DoubleDouble {
        let (high, low) = (two_sum(self.high, o.high), two_sum(self.low, o.low));
        let sum = fast_two_sum(high.high, high.low + low.high);
        fast_two_sum(sum.high, low.low + sum.low)
    }
}

impl Sub for DoubleDouble {
    type Output = DoubleDouble;
    #[inline]
    fn sub(self, o: DoubleDouble) -> DoubleDouble {
        self + DoubleDouble { high: -o.high, low: -o.low }
    }
}

impl Mul for DoubleDouble {
    type Output = DoubleDouble;
    /// Relative error 7 2^-106.
    #[inline]
    fn mul(self, o: DoubleDouble) -> DoubleDouble {
        let high = two_product(self.high, o.high);
        fast_two_sum(high.high, high.low + (self.high * o.low + self.low * o.high))
    }
}

impl Mul<f64> for DoubleDouble {
    type Output = DoubleDouble;
    #[inline]
    fn mul(self, o: f64) -> DoubleDouble {
        let high = two_product(self.high, o);
        fast_two_sum(high.high, high.low + self.low * o)
    }
}
