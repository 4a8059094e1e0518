//! Facets as hosts have them, and the linear sub-facets that their geometry is cut into (docs/formulation 12).
//!
//! A quadratic facet, the parent, keeps its functions; its sub-facets, triangles and quadrilaterals between its nodes, are
//! what planes, overlaps, inverse maps and edges are made of. In the parent's coordinates each of them is a triangle or a
//! parallelogram, so that those coordinates are affine in the sub-facet's own.
//!
//! Node order: corners, then the mid nodes, k between corners k and k + 1, then the centre. A linear facet is its own
//! sub-facet.

use super::basis::MAX_NODES;
use super::cell::MAX_CORNERS;
use super::quad4::QUAD4;
use super::table::{Fields, Shape};
use super::tri3::TRI3;
use crate::simd::Real;

/// Most nodes of a parent.
pub const MAX_PARENT_NODES: usize = 9;
/// Monomials that the functions of a parent are made of: 1, x, y, x^2, xy, y^2, x^2 y, x y^2, x^2 y^2.
pub const TERMS: usize = 9;
/// Groups of four functions, one a lane.
pub const GROUPS: usize = MAX_PARENT_NODES.div_ceil(4);

/// A linear facet between nodes of a parent, with its orientation.
#[derive(Debug)]
pub struct SubFacet {
    /// Nodes of the parent; of a triangle the fourth repeats the first.
    pub nodes: [usize; MAX_CORNERS],
    /// Its kind.
    pub shape: &'static Shape,
    /// Per edge, from node k on, the sub-facet of the same parent beyond it, if there is one.
    pub beyond: [Option<usize>; MAX_CORNERS],
}

/// A kind of facet.
#[derive(Debug)]
pub struct Parent {
    /// Its name with mesh generators.
    pub name: &'static str,
    /// Nodes.
    pub n: usize,
    /// The parent's coordinates of its nodes.
    pub at: [[f64; 2]; MAX_PARENT_NODES],
    /// Coefficients of the functions N_B: `[term][group]`, lanes over the functions.
    pub functions: [[[f64; 4]; GROUPS]; TERMS],
    /// Terms that occur.
    pub terms: usize,
    /// The linear cell on its corners, whose functions the corner multipliers have.
    pub cell: &'static Shape,
    /// What it is cut into.
    pub subs: &'static [SubFacet],
}

impl Parent {
    /// The kind with `n` nodes, if there is one.
    pub fn of(n: usize) -> Option<&'static Parent> {
        match n {
            3 => Some(&PARENT_TRI3),
            4 => Some(&PARENT_QUAD4),
            6 => Some(&TRI6),
            8 => Some(&QUAD8),
            9 => Some(&QUAD9),
            _ => None,
        }
    }

    /// The kind of line with `n` nodes, of a plane or axisymmetric model, if there is one.
    pub fn of_line(n: usize) -> Option<&'static Parent> {
        match n {
            2 => Some(&LINE2),
            3 => Some(&LINE3),
            _ => None,
        }
    }

    /// How many of the nodes are corners; they come first.
    pub fn corners(&self) -> usize {
        self.cell.n
    }

    /// The functions N_B at these coordinates of the parent.
    pub fn values(&self, [x, y]: [f64; 2]) -> [f64; MAX_PARENT_NODES] {
        let terms = monomials(x, y);
        std::array::from_fn(|b| (0..self.terms).map(|t| self.functions[t][b / 4][b % 4] * terms[t]).sum())
    }

    /// Groups of four functions.
    pub fn groups(&self) -> usize {
        self.n.div_ceil(4)
    }

    /// The polynomial degree that a quadrature rule needs where both sides are affine: of the derivatives of pairs with
    /// such a parent (docs/formulation 12).
    pub fn degree(&self) -> u32 {
        if self.n >= 8 { 7 } else { 5 }
    }
}

/// The reference coordinates of a cell's corners.
pub fn cell_corners(cell: &Shape) -> [[f64; 2]; MAX_CORNERS] {
    let at = if cell.n == 3 { &TRIANGLE } else { &SQUARE };
    [at[0], at[1], at[2], at[3]]
}

/// The monomials at (x, y).
#[inline(always)]
pub fn monomials<R: Real>(x: R, y: R) -> [R; TERMS] {
    let (xx, xy, yy) = (x * x, x * y, y * y);
    [R::splat(1.0), x, y, xx, xy, yy, xx * y, x * yy, xx * yy]
}

/// The monomials at (x, y), and their derivatives with respect to x and y.
#[inline(always)]
pub fn monomial_slopes(x: f64, y: f64) -> [[f64; TERMS]; 3] {
    let (xx, xy, yy) = (x * x, x * y, y * y);
    [
        monomials(x, y),
        [0.0, 1.0, 0.0, 2.0 * x, y, 0.0, 2.0 * xy, yy, 2.0 * x * yy],
        [0.0, 0.0, 1.0, 0.0, x, 2.0 * y, xx, 2.0 * xy, 2.0 * xx * y],
    ]
}

/// Coefficients of functions, term by term, in groups of lanes.
const fn grouped(rows: &[[f64; TERMS]; MAX_PARENT_NODES]) -> [[[f64; 4]; GROUPS]; TERMS] {
    let mut to = [[[0.0; 4]; GROUPS]; TERMS];
    let mut k = 0;
    while k < MAX_PARENT_NODES * TERMS {
        to[k % TERMS][k / TERMS / 4][k / TERMS % 4] = rows[k / TERMS][k % TERMS];
        k += 1;
    }
    to
}

const NONE: [f64; TERMS] = [0.0; TERMS];
/// The triangle (0,0), (1,0), (0,1).
const TRIANGLE: [[f64; 2]; MAX_PARENT_NODES] =
    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]];
/// The square [-1, 1]^2.
const SQUARE: [[f64; 2]; MAX_PARENT_NODES] =
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, 0.0]];

/// Functions of a linear cell.
const fn linear(shape: &Shape) -> [[[f64; 4]; GROUPS]; TERMS] {
    let mut rows = [NONE; MAX_PARENT_NODES];
    let mut k = 0;
    while k < shape.n {
        let c = shape.coefficients[k];
        rows[k] = [c[0], c[1], c[2], 0.0, c[3], 0.0, 0.0, 0.0, 0.0];
        k += 1;
    }
    grouped(&rows)
}

/// L (2 L - 1) of the corners, 4 L L' of the mid nodes.
const TRI6_FUNCTIONS: [[f64; TERMS]; MAX_PARENT_NODES] = [
    [1.0, -3.0, -3.0, 2.0, 4.0, 2.0, 0.0, 0.0, 0.0],
    [0.0, -1.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, -1.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0],
    [0.0, 4.0, 0.0, -4.0, -4.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 4.0, 0.0, -4.0, -4.0, 0.0, 0.0, 0.0],
    NONE,
    NONE,
    NONE,
];

/// (1 + s x)(1 + t y)(s x + t y - 1) / 4 of the corners at (s, t); (1 - x^2)(1 + t y) / 2 and (1 + s x)(1 - y^2) / 2 of the
/// mid nodes.
const fn quad8_functions() -> [[f64; TERMS]; MAX_PARENT_NODES] {
    let mut rows = [NONE; MAX_PARENT_NODES];
    let mut k = 0;
    while k < 8 {
        let [s, t] = SQUARE[k];
        rows[k] = if k < 4 {
            [-0.25, 0.0, 0.0, 0.25, 0.25 * s * t, 0.25, 0.25 * t, 0.25 * s, 0.0]
        } else if s == 0.0 {
            [0.5, 0.0, 0.5 * t, -0.5, 0.0, 0.0, -0.5 * t, 0.0, 0.0]
        } else {
            [0.5, 0.5 * s, 0.0, 0.0, 0.0, -0.5, 0.0, -0.5 * s, 0.0]
        };
        k += 1;
    }
    rows
}

/// Products of l(x) and l(y), l = (x^2 + s x) / 2 at s = -1, 1 and 1 - x^2 at 0.
const fn quad9_functions() -> [[f64; TERMS]; MAX_PARENT_NODES] {
    let mut rows = [NONE; MAX_PARENT_NODES];
    let mut k = 0;
    while k < 9 {
        let [a, b] = [line(SQUARE[k][0]), line(SQUARE[k][1])];
        rows[k] = [
            a[0] * b[0],
            a[1] * b[0],
            a[0] * b[1],
            a[2] * b[0],
            a[1] * b[1],
            a[0] * b[2],
            a[2] * b[1],
            a[1] * b[2],
            a[2] * b[2],
        ];
        k += 1;
    }
    rows
}

/// Coefficients of 1, x, x^2.
const fn line(s: f64) -> [f64; 3] {
    if s == 0.0 { [1.0, 0.0, -1.0] } else { [0.0, 0.5 * s, 0.5] }
}

const fn triangle(nodes: [usize; 3], beyond: [Option<usize>; 3]) -> SubFacet {
    SubFacet {
        nodes: [nodes[0], nodes[1], nodes[2], nodes[0]],
        shape: &TRI3,
        beyond: [beyond[0], beyond[1], beyond[2], None],
    }
}

const fn quadrilateral(nodes: [usize; 4], beyond: [Option<usize>; 4]) -> SubFacet {
    SubFacet { nodes, shape: &QUAD4, beyond }
}

/// A linear triangle.
pub static PARENT_TRI3: Parent = Parent {
    name: "tri3",
    n: 3,
    at: TRIANGLE,
    functions: linear(&TRI3),
    terms: 3,
    cell: &TRI3,
    subs: &[triangle([0, 1, 2], [None; 3])],
};

/// A bilinear quadrilateral.
pub static PARENT_QUAD4: Parent = Parent {
    name: "quad4",
    n: 4,
    at: SQUARE,
    functions: linear(&QUAD4),
    terms: 5,
    cell: &QUAD4,
    subs: &[quadrilateral([0, 1, 2, 3], [None; 4])],
};

/// A quadratic triangle, in four.
pub static TRI6: Parent = Parent {
    name: "tri6",
    n: 6,
    at: TRIANGLE,
    functions: grouped(&TRI6_FUNCTIONS),
    terms: 6,
    cell: &TRI3,
    subs: &[
        triangle([0, 3, 5], [None, Some(3), None]),
        triangle([3, 1, 4], [None, None, Some(3)]),
        triangle([5, 4, 2], [Some(3), None, None]),
        triangle([3, 4, 5], [Some(1), Some(2), Some(0)]),
    ],
};

/// The quadrilateral of serendipity, in four triangles at its corners and one quadrilateral.
pub static QUAD8: Parent = Parent {
    name: "quad8",
    n: 8,
    at: SQUARE,
    functions: grouped(&quad8_functions()),
    terms: 8,
    cell: &QUAD4,
    subs: &[
        triangle([0, 4, 7], [None, Some(4), None]),
        triangle([4, 1, 5], [None, None, Some(4)]),
        triangle([5, 2, 6], [None, None, Some(4)]),
        triangle([6, 3, 7], [None, None, Some(4)]),
        quadrilateral([4, 5, 6, 7], [Some(1), Some(2), Some(3), Some(0)]),
    ],
};

/// The biquadratic quadrilateral, in four.
pub static QUAD9: Parent = Parent {
    name: "quad9",
    n: 9,
    at: SQUARE,
    functions: grouped(&quad9_functions()),
    terms: 9,
    cell: &QUAD4,
    subs: &[
        quadrilateral([0, 4, 8, 7], [None, Some(1), Some(3), None]),
        quadrilateral([4, 1, 5, 8], [None, None, Some(2), Some(0)]),
        quadrilateral([8, 5, 2, 6], [Some(1), None, None, Some(3)]),
        quadrilateral([7, 8, 6, 3], [Some(0), Some(2), None, None]),
    ],
};

/// The cell of a line, whose second coordinate is not used. No facet of the geometry has this shape.
static LINE: Shape = Shape {
    n: 2,
    coefficients: [[0.5, -0.5, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0], [0.0; 4], [0.0; 4]],
    next: [1, 0, 0, 0],
    reversed: [1, 0, 0, 0],
    fields: Fields { moments: [[0.0; 3]; MAX_CORNERS], products: [[[0.0; MAX_NODES]; MAX_CORNERS]; 3] },
};

/// Ends, then the middle.
const ON_LINE: [[f64; 2]; MAX_PARENT_NODES] = {
    let mut at = [[0.0; 2]; MAX_PARENT_NODES];
    (at[0], at[1]) = ([-1.0, 0.0], [1.0, 0.0]);
    at
};

/// Functions of lines, of 1, x, x^2.
const fn on_line(functions: [[f64; 3]; 3]) -> [[[f64; 4]; GROUPS]; TERMS] {
    let mut rows = [NONE; MAX_PARENT_NODES];
    let mut k = 0;
    while k < 3 {
        let c = functions[k];
        rows[k] = [c[0], c[1], 0.0, c[2], 0.0, 0.0, 0.0, 0.0, 0.0];
        k += 1;
    }
    grouped(&rows)
}

/// The ends of a part, up one side and down the other: a line of some width is a quadrilateral.
const fn straight(from: usize, to: usize, beyond: [Option<usize>; 2]) -> SubFacet {
    SubFacet { nodes: [from, to, to, from], shape: &LINE, beyond: [None, beyond[0], None, beyond[1]] }
}

/// A straight line.
static LINE2: Parent = Parent {
    name: "line2",
    n: 2,
    at: ON_LINE,
    functions: on_line([[0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [0.0; 3]]),
    terms: 2,
    cell: &LINE,
    subs: &[straight(0, 1, [None; 2])],
};

/// A quadratic line, in two.
static LINE3: Parent = Parent {
    name: "line3",
    n: 3,
    at: ON_LINE,
    functions: on_line([line(-1.0), line(1.0), line(0.0)]),
    terms: 4,
    cell: &LINE,
    subs: &[straight(0, 2, [Some(1), None]), straight(2, 1, [None, Some(0)])],
};

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [&Parent; 5] = [&PARENT_TRI3, &PARENT_QUAD4, &TRI6, &QUAD8, &QUAD9];

    /// Values and derivatives of all functions.
    fn functions(parent: &Parent, x: f64, y: f64) -> [[f64; MAX_PARENT_NODES]; 3] {
        monomial_slopes(x, y)
            .map(|m| std::array::from_fn(|b| (0..TERMS).map(|t| parent.functions[t][b / 4][b % 4] * m[t]).sum()))
    }

    #[test]
    fn functions_are_one_at_their_node_and_sum_to_one() {
        for parent in ALL {
            for k in 0..parent.n {
                let [n, ..] = functions(parent, parent.at[k][0], parent.at[k][1]);
                assert!((0..parent.n).all(|b| n[b] == if b == k { 1.0 } else { 0.0 }), "{}", parent.name);
            }
            let at = functions(parent, 0.3125, 0.125); // exact in every sum
            assert_eq!(at.map(|v| v.iter().sum::<f64>()), [1.0, 0.0, 0.0], "{}", parent.name);
            assert!(parent.functions[parent.terms..].as_flattened().as_flattened().iter().all(|c| *c == 0.0));
        }
    }

    #[test]
    fn functions_of_lines_are_one_at_their_node_and_give_linear_fields() {
        for parent in [2, 3].map(|n| Parent::of_line(n).unwrap()) {
            for k in 0..parent.n {
                let [n, ..] = functions(parent, parent.at[k][0], 0.0);
                assert!((0..parent.n).all(|b| n[b] == if b == k { 1.0 } else { 0.0 }), "{}", parent.name);
            }
            let [n, nx, ny] = functions(parent, 0.3125, 0.125);
            let field = |b: usize| 2.0 + 3.0 * parent.at[b][0];
            let of = |n: &[f64; MAX_PARENT_NODES]| (0..parent.n).map(|b| n[b] * field(b)).sum::<f64>();
            assert_eq!([of(&n), of(&nx), of(&ny)], [2.0 + 3.0 * 0.3125, 3.0, 0.0], "{}", parent.name);
            assert!(parent.functions[parent.terms..].as_flattened().as_flattened().iter().all(|c| *c == 0.0));
            assert_eq!(parent.cell.values(-1.0, 0.0)[..2], [1.0, 0.0]);
            assert_eq!(parent.cell.values(0.5, 0.0)[..2], [0.25, 0.75]);
        }
    }

    /// A linear field is its own interpolation, with its gradient.
    #[test]
    fn functions_give_linear_fields() {
        for parent in ALL {
            let (x, y) = (0.3125, 0.125);
            let field = |p: [f64; 2]| 2.0 + 3.0 * p[0] - 5.0 * p[1];
            let of = |n: &[f64; MAX_PARENT_NODES]| (0..parent.n).map(|b| n[b] * field(parent.at[b])).sum::<f64>();
            let [n, nx, ny] = functions(parent, x, y);
            assert_eq!([of(&n), of(&nx), of(&ny)], [field([x, y]), 3.0, -5.0], "{}", parent.name);
        }
    }

    #[test]
    fn derivatives_of_monomials_are_those_of_differences() {
        let (x, y, h) = (0.3, -0.7, 1e-6);
        let [_, dx, dy] = monomial_slopes(x, y);
        for t in 0..TERMS {
            let difference = |a: f64, b: f64| (monomials(x + a, y + b)[t] - monomials(x - a, y - b)[t]) / (2.0 * h);
            assert!((difference(h, 0.0) - dx[t]).abs() < 1e-9 && (difference(0.0, h) - dy[t]).abs() < 1e-9);
        }
    }

    /// They tile the parent: areas add up, neighbours share an edge in opposite directions, none is folded.
    #[test]
    fn sub_facets_tile_the_parent() {
        for parent in ALL {
            let mut area = 0.0;
            for (s, sub) in parent.subs.iter().enumerate() {
                let at = |k: usize| parent.at[sub.nodes[k % sub.shape.n]];
                let cross = |k: usize| at(k)[0] * at(k + 1)[1] - at(k)[1] * at(k + 1)[0];
                let own = 0.5 * (0..sub.shape.n).map(cross).sum::<f64>();
                assert!(own > 0.0);
                area += own;
                for k in 0..sub.shape.n {
                    let edge = (sub.nodes[k], sub.nodes[(k + 1) % sub.shape.n]);
                    let sharing = parent.subs.iter().position(|other| {
                        (0..other.shape.n).any(|l| (other.nodes[(l + 1) % other.shape.n], other.nodes[l]) == edge)
                    });
                    assert_eq!(sub.beyond[k], sharing, "{} {s}", parent.name);
                }
                // Parallelograms: coordinates are affine in the sub-facet's.
                if sub.shape.n == 4 {
                    assert!((0..2).all(|i| at(0)[i] + at(2)[i] == at(1)[i] + at(3)[i]));
                }
            }
            assert_eq!(area, if parent.corners() == 3 { 0.5 } else { 4.0 }, "{}", parent.name);
        }
    }
}
