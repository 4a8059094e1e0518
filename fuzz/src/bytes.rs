//! Numbers from bytes: small changes of the bytes are small changes of the input, and special values are near.

/// Bytes that are used up from the front; zeros after their end.
pub struct Bytes<'a>(pub &'a [u8]);

/// Doubles at which arithmetic changes its ways.
const SPECIAL: [f64; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN_POSITIVE,
    5e-324,
    1e-160,
    1e155,
    1e300,
    1e-16,
    1e-8,
    1e8,
];

impl Bytes<'_> {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub fn byte(&mut self) -> u8 {
        let (first, rest) = self.0.split_first().map_or((0, self.0), |(b, rest)| (*b, rest));
        self.0 = rest;
        first
    }

    /// A number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        usize::from(self.byte()) % n
    }

    /// One of two in 256 / `rarely` cases.
    pub fn once_in(&mut self, rarely: u8) -> bool {
        self.byte() % rarely == rarely - 1
    }

    fn word(&mut self) -> u64 {
        (0..8).fold(0, |w, _| w << 8 | u64::from(self.byte()))
    }

    /// Any double: special, of any bits, or the usual one, near it or a multiple.
    pub fn number(&mut self, usual: f64) -> f64 {
        match self.byte() {
            b @ 0..16 => SPECIAL[usize::from(b)],
            16 => f64::from_bits(self.word()),
            17 => usual * f64::from(i16::from(self.byte()) - 128),
            18 => usual * 10f64.powi(i32::from(self.byte()) - 128),
            19 => usual * (1.0 + 1e-15 * f64::from(self.byte())),
            _ => usual,
        }
    }

    /// A finite coordinate: of a coarse grid, so that things coincide; near it by an arbitrary amount; or of any size.
    pub fn coordinate(&mut self) -> f64 {
        let base = f64::from(self.byte() as i8) / 16.0;
        match self.byte() {
            0 => base + 10f64.powi(-i32::from(self.byte() % 20)),
            1 => base + f64::from(self.byte()) / 4096.0 + f64::from(self.byte()) / 1048576.0,
            2 => base * 10f64.powi(i32::from(self.byte() as i8)),
            _ => base,
        }
    }

    /// Any integer: special, of any bits, or mostly the usual one.
    pub fn integer(&mut self, usual: i64) -> i64 {
        match self.byte() {
            b @ 0..6 => [i64::MIN, i64::MAX, -1, 1 << 40, 1 << 41, i64::MAX / 3][usize::from(b)],
            6 => self.word() as i64,
            b @ 7..16 => i64::from(b) - 7,
            16 => usual.wrapping_sub(1),
            _ => usual,
        }
    }

    /// A count of `room` entries that exist: any below it, or one that no array can have.
    pub fn count(&mut self, room: i64) -> i64 {
        match self.integer(room) {
            n if n > room && n <= 1 << 40 => room, // a promise that the caller would not keep
            n => n,
        }
    }

    /// A choice among `n`, now and then none of them.
    pub fn choice(&mut self, n: i32) -> i32 {
        let usual = self.below(n as usize) as i32;
        self.integer(i64::from(usual)) as i32
    }

    /// The pointer, or NULL, or one that is not aligned.
    pub fn pointer<T>(&mut self, usual: *const T) -> *const T {
        match self.byte() {
            0 => std::ptr::null(),
            1 => usual.wrapping_byte_add(1),
            _ => usual,
        }
    }

    /// The same of an output.
    pub fn output<T>(&mut self, usual: *mut T) -> *mut T {
        self.pointer(usual).cast_mut()
    }

    /// The same of characters, whose pointers are never crooked.
    pub fn text(&mut self, usual: *mut i8) -> *mut i8 {
        if self.once_in(16) { std::ptr::null_mut() } else { usual }
    }
}
