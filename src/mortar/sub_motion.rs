//! What a pair of sub-facets adds to a tangent (docs/formulation 12.3): derivatives of the forces of a field of tractions
//! p = sum_A N_A p_A, and of the gaps of its multipliers, with respect to the sub-facets' nodes. The weights alone are
//! differentiated: nodes that forces and gaps depend on through their own motion are the caller's.
//!
//! With nu_s the monomials of N_A, mu_t those of N_B or N_C, the derivatives with respect to the projected corners are made of
//!
//! int N_k d_c (nu_s mu1_t), int N_k (d_c nu_s) mu2_t, int N_l nu_s (d_c mu2_t),
//!
//! which follow from moments (`sub_moments.rs`); contracted with tractions they give the forces' derivatives, with positions
//! those of the gaps, lanes over the components of both. Edges are added point by point. Only then monomials become functions,
//! and corners nodes.

use super::chain::{Chain, Columns};
use super::field::MultiplierSpace;
use super::segment::{NonmortarFrame, Segment};
use super::slots::{PAIR_CORNERS, PAIR_NODES};
use super::sub_fields::{Fields, Rows};
use super::sub_integrals::{Integrals, Plane, Sums};
use super::sub_moments::{BATCH, FEW_SLOTS, SLOTS, SubMoments};
use super::sub_pair::{Points, Side};
use super::sub_polynomials::Polynomials;
use super::transport::PlaneDerivatives;
use crate::features;
use crate::geometry::Vec3;
use crate::quadrature::Rule;
use crate::shape::{GROUPS, MAX_CORNERS, MAX_PARENT_NODES, Parent, Quadrilateral, TERMS, Triangle};
use crate::simd::{self, Kernel, Lanes, rolled};

/// `[k][j][B]`, lanes over the three components i and one more number: derivatives with respect to component j of the k-th
/// node of the two sub-facets.
type Blocks<const N: usize> = [[[[f64; 4]; N]; 3]; PAIR_NODES];

/// Derivatives of forces and gaps of a pair of sub-facets.
#[derive(Clone, Debug)]
pub struct SubMotion {
    /// Of f_B = sum_A n_AB p_A at the non-mortar parent's nodes [F/L]; the fourth number is 0.
    pub one: Blocks<MAX_PARENT_NODES>,
    /// Of f_C = -sum_A n_AC p_A at the mortar parent's, likewise.
    pub two: Blocks<MAX_PARENT_NODES>,
    /// Of g_A = sum_B n_AB x_B - sum_C n_AC x_C at fixed nodes, rows A [L^2]; the fourth number: of the covered area
    /// int N_A da `[L]`.
    pub gap: Blocks<MAX_CORNERS>,
}

impl Default for SubMotion {
    fn default() -> Self {
        let zero = [[[[0.0; 4]; MAX_PARENT_NODES]; 3]; PAIR_NODES];
        SubMotion { one: zero, two: zero, gap: [[[[0.0; 4]; MAX_CORNERS]; 3]; PAIR_NODES] }
    }
}

/// Nodes of both parents, from any point that both have in common `[L]`.
pub type ParentPositions<'a> = (&'a [Vec3; MAX_PARENT_NODES], &'a [Vec3; MAX_PARENT_NODES]);

/// Those of a pair with these tractions, `[i][A]` of the rows A, by a rule of `rule_for`, in place of what was in `to`. Nodes
/// that a sub-facet, and columns that a parent, does not have are left as they are.
pub fn sub_motion(
    pair: (&NonmortarFrame, &Segment, &Rule),
    sides: (Side, Side),
    space: MultiplierSpace,
    tractions: &[[f64; MAX_CORNERS]; 3],
    positions: ParentPositions,
    to: &mut SubMotion,
) {
    features::QUADRATIC.is_here();
    simd::dispatch(Motion { pair, sides, space, tractions, positions, to });
}

struct Motion<'a> {
    pair: (&'a NonmortarFrame, &'a Segment, &'a Rule),
    sides: (Side, Side),
    space: MultiplierSpace,
    tractions: &'a [[f64; MAX_CORNERS]; 3],
    positions: ParentPositions<'a>,
    to: &'a mut SubMotion,
}

impl Kernel for Motion<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Motion { pair, sides: (side1, side2), space, tractions, positions, to } = self;
        let (frame, segment, _) = pair;
        let one = Polynomials::new::<L>(side1.0, side1.1, &frame.projection, &frame.map);
        let two = Polynomials::new::<L>(side2.0, side2.1, &segment.mortar, &segment.mortar_map);
        let rows = Rows::new(space, side1.0, &one);
        let fields = Fields::new(&rows, [side1.0, side2.0], tractions, [positions.0, positions.1]);
        let mut sums = Sums {
            one: [[[L::splat(0.0); 2]; PAIR_CORNERS]; TERMS],
            two: [[[L::splat(0.0); 2]; PAIR_CORNERS]; TERMS],
            gap: [[[L::splat(0.0); 2]; PAIR_CORNERS]; TERMS],
        };
        let integrals = Integrals { one: &one, two: &two, nu: rows.n, mu: [side1.0.terms, side2.0.terms] };
        // What is not needed is not begun with zeros: of two triangles with six nodes or three it would be three quarters.
        let (mut few, mut many);
        let batch: &mut [[L; BATCH]] = if side1.0.n.max(side2.0.n) <= 6 && one.n == 3 && two.n == 3 {
            few = [[L::splat(0.0); BATCH]; FEW_SLOTS];
            &mut few
        } else {
            many = [[L::splat(0.0); BATCH]; SLOTS];
            &mut many
        };
        let mut moments = SubMoments::zero();
        let mut summation = integrals.moments(batch, &mut moments);
        let mut points = Points::<L>::new(pair, true);
        while let Some(four) = points.next() {
            match &four.edge {
                None => summation.add(&four, &one, &two),
                Some(edge) => integrals.add_edge(&four, edge, &fields, &mut sums),
            }
        }
        summation.finish();
        integrals.contract(&moments, &fields, &mut sums);
        let chain = Chain::new(frame, segment);
        // One loop for all three: what it does is inlined into it, and three of them would make the library larger.
        for which in 0..rolled(3) {
            let (n, terms, plane) = match which {
                0 => (side1.0.n, side1.0.terms, &sums.one),
                1 => (side2.0.n, side2.0.terms, &sums.two),
                _ => (space.nodes(side1.0, side1.1).len(), rows.n, &sums.gap),
            };
            for column in 0..rolled(n) {
                let (function, mut to) = match which {
                    0 => (function(side1.0, column), Block::of(&mut to.one, column)),
                    1 => (function(side2.0, column), Block::of(&mut to.two, column)),
                    _ => (row(&rows, column), Block::of(&mut to.gap, column)),
                };
                to_nodes(&chain, plane, &function, terms, &mut to);
            }
        }
    }
}

/// From monomials to a function with these coefficients, and from corners to nodes.
#[inline(always)]
fn to_nodes<L: Lanes>(chain: &Chain<L>, plane: &Plane<L>, function: &[f64; TERMS], terms: usize, to: &mut Block) {
    let mut g: PlaneDerivatives<L> = [[L::splat(0.0); 2]; PAIR_CORNERS];
    for side in 0..2 {
        let mut sums = [[L::splat(0.0); 2]; MAX_CORNERS];
        for t in 0..terms.min(TERMS) {
            if function[t] != 0.0 {
                let (n, of) = (L::splat(function[t]), &plane[t]);
                for k in 0..MAX_CORNERS {
                    for c in 0..2 {
                        sums[k][c] = of[MAX_CORNERS * side + k][c].mul_add(n, sums[k][c]);
                    }
                }
            }
        }
        for k in 0..MAX_CORNERS {
            g[MAX_CORNERS * side + k] = sums[k];
        }
    }
    match (chain.frame.projection.shape.n, chain.segment.mortar.shape.n) {
        (3, 3) => chain.nodes::<Triangle, Triangle>(&g, to),
        (3, _) => chain.nodes::<Triangle, Quadrilateral>(&g, to),
        (_, 3) => chain.nodes::<Quadrilateral, Triangle>(&g, to),
        _ => chain.nodes::<Quadrilateral, Quadrilateral>(&g, to),
    }
}

/// Coefficients of a parent's function.
#[inline(always)]
fn function(parent: &Parent, b: usize) -> [f64; TERMS] {
    let mut of = [0.0; TERMS];
    for t in 0..TERMS {
        of[t] = parent.functions[t][b / 4 % GROUPS][b % 4];
    }
    of
}

/// Those of the function of a row.
#[inline(always)]
fn row(rows: &Rows, a: usize) -> [f64; TERMS] {
    let mut of = [0.0; TERMS];
    for s in 0..6 {
        of[s] = rows.of[s][a & 3];
    }
    of
}

/// Where the derivatives of a column go.
struct Block<'a> {
    /// `[k][j]`, then so many columns.
    to: &'a mut [[f64; 4]],
    columns: usize,
    column: usize,
}

impl<'a> Block<'a> {
    #[inline(always)]
    fn of<const N: usize>(blocks: &'a mut Blocks<N>, column: usize) -> Self {
        Block { to: blocks.as_flattened_mut().as_flattened_mut(), columns: N, column }
    }
}

impl<L: Lanes> Columns<L> for Block<'_> {
    #[inline(always)]
    fn set(&mut self, k: usize, columns: [L; 3]) {
        for j in 0..3 {
            self.to[(3 * k + j) * self.columns + self.column] = columns[j].store();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Facet;
    use crate::mortar::rule_for;
    use crate::quadrature::DEGREE_5;

    /// Relative to the largest.
    const SAME: f64 = 1e-12;

    /// A parent over its reference cell, seen from below or, larger, from above.
    fn nodes(parent: &Parent, up: bool) -> [Vec3; MAX_PARENT_NODES] {
        let (scale, from) = if up { (1.3, -0.1) } else { (1.0, 0.0) };
        parent.at.map(|at| {
            let [u, v] = if up { at } else { [at[1], at[0]] };
            Vec3::new(scale * u + 0.1 * u * v + from, scale * v + 0.07 * u * u, 0.1 * (u * u + v * v))
        })
    }

    /// `sub_motion` of all pairs of sub-facets, one after the other.
    fn motions(one: &'static Parent, two: &'static Parent, space: MultiplierSpace) -> Vec<f64> {
        let (x1, x2, mut all) = (nodes(one, false), nodes(two, true), Vec::new());
        let facet =
            |x: &[Vec3], sub: &crate::shape::SubFacet| Facet { nodes: sub.nodes.map(|k| x[k]), shape: sub.shape };
        let p = [[0.3, -0.2, 0.4, 0.1], [0.7, 0.9, 0.2, -0.5], [-1.0, -1.1, -0.8, -0.9]];
        for sigma in one.subs {
            let frame = NonmortarFrame::new(&facet(&x1, sigma)).unwrap();
            for tau in two.subs {
                let Some(segment) = Segment::new(&frame, &facet(&x2, tau)).unwrap() else { continue };
                let (pair, mut to) = ((&frame, &segment, rule_for(&DEGREE_5, [one, two])), SubMotion::default());
                sub_motion(pair, ((one, sigma), (two, tau)), space, &p, (&x1, &x2), &mut to);
                for blocks in [&to.one, &to.two] {
                    all.extend(blocks.as_flattened().as_flattened().as_flattened());
                }
                all.extend(to.gap.as_flattened().as_flattened().as_flattened());
            }
        }
        all
    }

    #[test]
    fn all_lanes_give_the_same() {
        let kinds = [3, 4, 6, 8, 9].map(|n| Parent::of(n).unwrap());
        for (one, two) in kinds.iter().flat_map(|one| kinds.map(|two| (one, two))) {
            for space in [MultiplierSpace::Corner, MultiplierSpace::Sub] {
                let (fast, plain) = (motions(one, two, space), simd::on_plain_lanes(|| motions(one, two, space)));
                let largest = plain.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
                let error = fast.iter().zip(&plain).fold(0.0_f64, |m, (v, w)| m.max((v - w).abs()));
                assert!(
                    fast.len() == plain.len() && largest > 0.1 && error < SAME * largest,
                    "{} {}",
                    one.name,
                    two.name
                );
            }
        }
    }
}
