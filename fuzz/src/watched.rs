//! Output arrays that show what was written.

/// Entries behind the end that must stay as they are.
const MARGIN: usize = 16;

/// Values that no result has.
pub trait Pattern: Copy + PartialEq {
    const PATTERN: Self;
    fn untouched(self) -> bool;
}

impl Pattern for f64 {
    const PATTERN: f64 = f64::from_bits(0x7ff4_dead_beef_5eed);
    fn untouched(self) -> bool {
        self.to_bits() == Self::PATTERN.to_bits()
    }
}

macro_rules! integers {
    ($($t:ty: $v:expr),*) => {
        $(impl Pattern for $t {
            const PATTERN: $t = $v;
            fn untouched(self) -> bool {
                self == Self::PATTERN
            }
        })*
    };
}
integers!(i64: 0x5eed_dead_beef_5eed, i32: 0x5eed_beef, i8: 0x5e);

/// An array of `n` entries.
pub struct Watched<T>(Vec<T>, usize);

impl<T: Pattern> Watched<T> {
    pub fn new(n: usize) -> Watched<T> {
        Watched(vec![T::PATTERN; n + MARGIN], n)
    }

    /// One that goes in and comes out.
    pub fn holding(values: &[T]) -> Watched<T> {
        let mut watched = Watched::new(values.len());
        watched.0[..values.len()].copy_from_slice(values);
        watched
    }

    pub fn pointer(&mut self) -> *mut T {
        self.0.as_mut_ptr()
    }

    /// The entries. Nothing lies behind them.
    pub fn values(&self) -> &[T] {
        assert!(self.0[self.1..].iter().all(|v| v.untouched()), "written beyond the end");
        &self.0[..self.1]
    }

    /// A refused call has written nothing.
    pub fn assert_untouched(&self) {
        assert!(self.0.iter().all(|v| v.untouched()), "a refused call has written");
    }
}
