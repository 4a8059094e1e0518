//! Small blocks into rows of numbers that stand equally far from each other, and numbers fetched before they are read.
#![allow(unsafe_code)]

/// Adds R rows of W numbers to as many: the first stand in `numbers` from `at` on, those of each further row `len` after those of
/// the one before. One test of the bounds serves all of them.
///
/// # Panics
/// Where they do not stand in `numbers`.
#[inline(always)]
pub fn add_rows<const R: usize, const W: usize>(numbers: &mut [f64], at: usize, len: u32, values: [[f64; W]; R]) {
    let needs = (R as u64 - 1) * u64::from(len) + W as u64; // `len` has 32 bits: nothing overflows
    assert!(at <= numbers.len() && needs <= (numbers.len() - at) as u64, "a block stands in its rows");
    for i in 0..R {
        // SAFETY: at + i len + W <= numbers.len() for each i < R, as has just been seen.
        let row = unsafe { &mut *numbers.as_mut_ptr().add(at + i * len as usize).cast::<[f64; W]>() };
        for j in 0..W {
            row[j] += values[i][j];
        }
    }
}

/// What the processor fetches at a time `[bytes]`.
#[cfg(target_arch = "x86_64")]
const LINE: usize = 64;

/// Has the processor fetch a value that will be read soon. Nothing else follows from it.
#[inline(always)]
pub fn prefetch<T>(value: &T) {
    #[cfg(target_arch = "x86_64")]
    for line in (0..size_of::<T>()).step_by(LINE) {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: every processor of this architecture has the instruction, and it reads nothing that the program sees.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(value).cast::<i8>().wrapping_add(line)) }
    }
    let _ = value;
}

/// The same of numbers that follow each other.
#[inline(always)]
pub fn prefetch_all(numbers: &[f64]) {
    #[cfg(target_arch = "x86_64")]
    numbers.iter().step_by(LINE / size_of::<f64>()).for_each(prefetch);
    let _ = numbers;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_added_where_they_stand() {
        let mut numbers = [1.0; 12];
        add_rows(&mut numbers, 1, 4, [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]);
        assert_eq!(numbers, [1.0, 2.0, 3.0, 1.0, 1.0, 4.0, 5.0, 1.0, 1.0, 6.0, 7.0, 1.0]);
        add_rows(&mut numbers, 11, u32::MAX, [[1.0]]);
        assert_eq!(numbers[11], 2.0);
        prefetch(&numbers);
        prefetch_all(&numbers);
    }

    #[test]
    fn no_block_reaches_beyond_its_rows() {
        for (at, len) in [(4, 4), (2, 5), (12, 0), (13, 0), (usize::MAX, 1), (0, u32::MAX)] {
            let refused = std::panic::catch_unwind(|| add_rows(&mut [0.0; 12], at, len, [[1.0; 2]; 3]));
            assert!(refused.is_err(), "{at} {len}");
        }
        add_rows(&mut [0.0; 12], 2, 4, [[1.0; 2]; 3]);
    }
}
