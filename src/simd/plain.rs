//! Four lanes for any processor; compilers make of it what the target's baseline has (two registers of two doubles).

use super::lanes::{Lanes, Real};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Four doubles.
#[derive(Clone, Copy, Debug)]
#[repr(align(16))]
pub struct Plain([f64; 4]);

macro_rules! lanewise {
    ($($trait:ident $method:ident $op:tt),*) => {$(
        impl $trait for Plain {
            type Output = Plain;
            #[inline(always)]
            fn $method(self, o: Plain) -> Plain {
                let (a, b) = (self.0, o.0);
                Plain([a[0] $op b[0], a[1] $op b[1], a[2] $op b[2], a[3] $op b[3]])
            }
        }
    )*};
}

lanewise!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Neg for Plain {
    type Output = Plain;
    #[inline(always)]
    fn neg(self) -> Plain {
        let a = self.0;
        Plain([-a[0], -a[1], -a[2], -a[3]])
    }
}

impl Real for Plain {
    #[inline(always)]
    fn splat(v: f64) -> Plain {
        Plain([v; 4])
    }
    #[inline(always)]
    fn mul_add(self, b: Plain, c: Plain) -> Plain {
        self * b + c
    }
    #[inline(always)]
    fn mul_sub(self, b: Plain, c: Plain) -> Plain {
        self * b - c
    }
    #[inline(always)]
    fn neg_mul_add(self, b: Plain, c: Plain) -> Plain {
        c - self * b
    }
    #[inline(always)]
    fn sqrt(self) -> Plain {
        let a = self.0;
        Plain([a[0].sqrt(), a[1].sqrt(), a[2].sqrt(), a[3].sqrt()])
    }
    #[inline(always)]
    fn max(self, other: Plain) -> Plain {
        (self - other).where_positive(self, other)
    }
    #[inline(always)]
    fn min(self, other: Plain) -> Plain {
        (self - other).where_positive(other, self)
    }
    #[inline(always)]
    fn where_positive(self, yes: Plain, no: Plain) -> Plain {
        let (a, y, n) = (self.0, yes.0, no.0);
        let one = [
            if a[0] > 0.0 { y[0] } else { n[0] },
            if a[1] > 0.0 { y[1] } else { n[1] },
            if a[2] > 0.0 { y[2] } else { n[2] },
            if a[3] > 0.0 { y[3] } else { n[3] },
        ];
        Plain(one)
    }
}

impl Lanes for Plain {
    const SHARED: bool = true;
    #[inline(always)]
    fn load(v: &[f64; 4]) -> Plain {
        Plain(*v)
    }
    #[inline(always)]
    fn store(self) -> [f64; 4] {
        self.0
    }
    #[inline(always)]
    fn sums(v: [Plain; 4]) -> Plain {
        let [a, b, c, d] = Plain::transpose(v);
        (a + b) + (c + d)
    }
    #[inline(always)]
    fn pairs(self, other: Plain) -> [Plain; 2] {
        let (a, b) = (self.0, other.0);
        [Plain([a[0], b[0], a[2], b[2]]), Plain([a[1], b[1], a[3], b[3]])]
    }
    #[inline(always)]
    fn any_positive(self) -> bool {
        let a = self.0;
        (a[0] > 0.0) | (a[1] > 0.0) | (a[2] > 0.0) | (a[3] > 0.0)
    }
    #[inline(always)]
    fn swap_1_3(self) -> Plain {
        let a = self.0;
        Plain([a[0], a[3], a[2], a[1]])
    }
    #[inline(always)]
    fn swap_1_2(self) -> Plain {
        let a = self.0;
        Plain([a[0], a[2], a[1], a[3]])
    }
    #[inline(always)]
    fn swap_halves(self) -> Plain {
        let a = self.0;
        Plain([a[2], a[3], a[0], a[1]])
    }
    #[inline(always)]
    fn swap_neighbours(self) -> Plain {
        let a = self.0;
        Plain([a[1], a[0], a[3], a[2]])
    }
    #[inline(always)]
    fn transpose(v: [Plain; 4]) -> [Plain; 4] {
        let [a, b, c, d] = [v[0].0, v[1].0, v[2].0, v[3].0];
        [
            Plain([a[0], b[0], c[0], d[0]]),
            Plain([a[1], b[1], c[1], d[1]]),
            Plain([a[2], b[2], c[2], d[2]]),
            Plain([a[3], b[3], c[3], d[3]]),
        ]
    }
}
