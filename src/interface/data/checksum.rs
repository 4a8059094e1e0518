//! A checksum of words, and a history's place for its own.
//!
//! Each word passes through a bijection of the sum so far, so that a change of one word alone, be it one bit, always
//! shows; changes of several words, two that change places among them, go unseen with a chance of 2^-64. The bijection
//! is the finaliser of SplitMix64 (Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators"), in
//! which every bit of the input reaches every bit of the output. (FNV-1a would not do: its highest bit reaches none
//! other, so that the signs of two numbers could change unseen.)

/// The odd integer next to 2^64 over the golden ratio, with which SplitMix64 begins.
const BEGIN: u64 = 0x9e37_79b9_7f4a_7c15;

/// One step: a bijection of `sum` for each word, and of the word for each sum.
fn mix(sum: u64, word: u64) -> u64 {
    let z = (sum ^ word).wrapping_add(BEGIN);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The checksum of some words in their order.
pub fn of_words(words: impl IntoIterator<Item = u64>) -> u64 {
    words.into_iter().fold(BEGIN, mix)
}

/// Where a history's checksum stands among its integers.
pub const PLACE: usize = 1;

/// The checksum of a history's flat arrays, all numbers but itself, and their lengths.
pub fn of_history(integers: &[i64], reals: &[f64]) -> i64 {
    let lengths = [integers.len() as u64, reals.len() as u64];
    let others = integers.iter().enumerate().filter(|(k, _)| *k != PLACE).map(|(_, &i)| i as u64);
    of_words(lengths.into_iter().chain(others).chain(reals.iter().map(|v| v.to_bits()))) as i64
}

/// Gives flat arrays that somebody has changed the checksum that fits them; those too short for one stay as they are.
/// For tests that look at what lies behind it.
pub fn seal_history(integers: &mut [i64], reals: &[f64]) {
    if integers.len() > PLACE {
        integers[PLACE] = of_history(integers, reals);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_of_a_word_reaches_half_of_the_sum() {
        for bit in 0..64 {
            let changed = |word: u64| (of_words([1, word, 2]) ^ of_words([1, word ^ (1 << bit), 2])).count_ones();
            let mean = (0..1000).map(|k| f64::from(changed(u64::wrapping_mul(k, BEGIN.rotate_left(bit))))).sum::<f64>()
                / 1000.0;
            assert!((mean - 32.0).abs() < 1.0, "bit {bit}: {mean}");
        }
    }

    #[test]
    fn order_and_signs_of_two_numbers_count() {
        let sum = |v: [f64; 3]| of_words(v.map(f64::to_bits));
        let here = sum([1.0, 2.0, 3.0]);
        for other in [[2.0, 1.0, 3.0], [-1.0, -2.0, 3.0], [1.0, 3.0, 2.0], [-1.0, 2.0, -3.0], [0.0, 1.0, 2.0]] {
            assert_ne!(sum(other), here);
        }
        assert_ne!(of_words([0]), of_words([0, 0]));
    }
}
