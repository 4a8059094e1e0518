//! Whether numbers are finite, many at a time: 0 times a finite number is 0, of others NaN, which a sum keeps.

use super::lanes::{Kernel, Lanes};

/// Fewer numbers than this are added up at once where they are asked for: to look for the processor's back end and to call
/// it costs as much.
pub(super) const FEW: usize = 40;
/// Lanes whose sums do not wait for each other.
const CHAINS: usize = 4;

/// The same of few numbers, for any processor.
#[inline(always)]
pub(super) fn few(values: &[f64]) -> bool {
    let (fours, rest) = values.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for four in fours {
        for k in 0..4 {
            sums[k] += 0.0 * four[k];
        }
    }
    for (sum, v) in sums.iter_mut().zip(rest) {
        *sum += 0.0 * v;
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) == 0.0
}

/// Whether all of many numbers are finite.
pub(super) struct AreFinite<'a> {
    pub values: &'a [f64],
}

impl Kernel for AreFinite<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(self) -> bool {
        let zero = L::splat(0.0);
        let mut sums = [zero; CHAINS];
        let (fours, rest) = self.values.as_chunks::<4>();
        let (many, others) = fours.as_chunks::<CHAINS>();
        for fours in many {
            for k in 0..CHAINS {
                sums[k] = zero.mul_add(L::load(&fours[k]), sums[k]);
            }
        }
        for four in others {
            sums[0] = zero.mul_add(L::load(four), sums[0]);
        }
        let [a, b, c, d] = ((sums[0] + sums[1]) + (sums[2] + sums[3])).store();
        let mut sum = (a + b) + (c + d);
        for v in rest {
            sum += 0.0 * v;
        }
        sum == 0.0
    }
}

#[cfg(test)]
mod tests {
    use crate::simd::{are_finite, on_plain_lanes};

    #[test]
    fn a_single_one_that_is_not_finite_is_found_wherever_it_stands() {
        let mut values = [f64::MAX; 70];
        values[3] = -f64::MAX;
        for n in 0..values.len() {
            assert!(are_finite(&values[..n]) && on_plain_lanes(|| are_finite(&values[..n])));
            for k in 0..n {
                for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    let good = std::mem::replace(&mut values[k], bad);
                    assert!(!are_finite(&values[..n]) && !on_plain_lanes(|| are_finite(&values[..n])), "{k} of {n}");
                    values[k] = good;
                }
            }
        }
    }
}
