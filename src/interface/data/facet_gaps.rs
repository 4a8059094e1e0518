//! The gap g_0 that tied surfaces start with, open or not.
//!
//! It turns with the non-mortar surface: each facet keeps what its pairs add to its nodes' gaps in the axes (t1, t2, e) of
//! its plane, and a node's gap is the sum over its facets,
//!
//!   g_0,A(x1) = rest_A + sum_f F_f(x1) c_f,A,   F_f = (t1, t2, e).
//!
//! So a rigid motion of both surfaces together leaves g - g_0 = 0, whatever the angle. Between facets c_f,A lies along e;
//! against an analytic surface it does not. A closed facet has c_f = 0: its share is rounding, stays in the rest, and
//! surfaces that are closed all over remain linear.

use super::active::Active;
use super::pairs::PairRecord;
use super::surface::Surface;
use crate::error::Result;
use crate::geometry::{Mat3, Plane, Vec3};
use crate::memory::{self, Stored};
use crate::mortar::{GapBlocks, Segment, gap};
use crate::quadrature::Rule;
use crate::shape::{MAX_CORNERS, MAX_NODES};

/// Reals of a facet.
pub const REALS_PER_FACET: usize = 3 * MAX_CORNERS;
/// A facet's gap below this, over its longest edge, is rounding: that of coordinates up to 1e4 facets from the origin.
const CLOSED: f64 = 1e-12;

/// Per non-mortar facet and node, c_f,A [L^3]; nothing where surfaces are not tied.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FacetGaps(Vec<[Vec3; MAX_CORNERS]>);

fn axes(plane: &Plane) -> Mat3 {
    Mat3::from_columns(&[plane.t1, plane.t2, plane.e])
}

impl FacetGaps {
    /// Takes the shares of open facets out of the nodes' gaps.
    pub(crate) fn take(
        &mut self,
        (one, two): (&Surface, &Surface),
        at: &Active,
        rule: &'static Rule,
        sums: &mut [(f64, Vec3)],
    ) -> Result<()> {
        let all = &mut self.0;
        memory::refill(all, [Vec3::zeros(); MAX_CORNERS], one.facets.len())?;
        for pairs in at.pairs.chunk_by(|p, q| p.one == q.one) {
            let f = pairs[0].one;
            let (facet, axes) = (one.facet(f, &at.x1), axes(&plane(one, f, &at.x1)?));
            let (mut shares, mut coverage) = ([Vec3::zeros(); MAX_CORNERS], 0.0);
            for pair in pairs {
                let gaps = match &one.parents {
                    None => gap(&pair.weights, &facet, &two.facet(pair.two, &at.x2)),
                    Some(_) => gap_of_parts((one, two), at, pair, rule)?,
                };
                for k in 0..MAX_CORNERS {
                    shares[k] += gaps[k];
                    coverage += pair.weights.coverage(k);
                }
            }
            if !at.integrated_parents.is_empty() {
                shares = dual_shares(one, at, one.host_facet(f), &shares)?;
            }
            let largest = shares.iter().map(|share| share.norm()).fold(0.0, f64::max);
            if largest <= CLOSED * facet.longest_edge() * coverage {
                continue;
            }
            for (k, &node) in one.rows(f).as_slice().iter().enumerate() {
                all[f][k] = axes.transpose() * shares[k];
                // What overflowed is no number from here on, and refused with the history.
                sums[node].1 -= shares[k];
            }
        }
        Ok(())
    }

    /// Takes all away.
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    /// Becomes a copy.
    pub(crate) fn recopy(&mut self, other: &FacetGaps) -> Result<()> {
        memory::recopy(&mut self.0, &other.0)
    }

    /// What each facet adds to g_0 of each of its nodes at x1.
    pub(crate) fn each_turned(&self, one: &Surface, x1: &[Vec3], mut add: impl FnMut(usize, Vec3)) -> Result<()> {
        for (f, shares) in self.0.iter().enumerate().filter(|(_, shares)| is_open(shares)) {
            let axes = axes(&plane(one, f, x1)?);
            for (k, &node) in one.rows(f).as_slice().iter().enumerate() {
                add(node, axes * shares[k]);
            }
        }
        Ok(())
    }

    /// What the derivative of g - g_0 has of g_0 on facet `f` at x1.
    pub(crate) fn motion(&self, one: &Surface, f: usize, x1: &[Vec3]) -> Result<Option<GapBlocks>> {
        let Some(shares) = self.0.get(f).filter(|shares| is_open(shares)) else { return Ok(None) };
        let (plane, mut blocks) = (plane(one, f, x1)?, [[[[0.0; MAX_CORNERS]; 3]; 3]; MAX_NODES]);
        for (a, share) in shares.iter().enumerate() {
            let turned = plane.derivative_of_fixed(&(axes(&plane) * share));
            for (k, i, j) in (0..MAX_CORNERS).flat_map(|k| (0..9).map(move |ij| (k, ij / 3, ij % 3))) {
                blocks[k][i][j][a] = -turned[k][(i, j)];
            }
        }
        Ok(Some(blocks))
    }

    /// Facets, or 0.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// Facet by facet, node by node.
    pub(crate) fn reals(&self) -> impl Iterator<Item = &f64> {
        self.0.iter().flatten().flat_map(|share| share.iter())
    }

    /// From [`FacetGaps::reals`].
    pub(crate) fn from_reals(reals: &[f64]) -> Result<FacetGaps> {
        let share = |facet: &[f64], k: usize| Vec3::from_column_slice(&facet[3 * k..3 * k + 3]);
        let facet = |facet: &[f64]| std::array::from_fn(|k| share(facet, k));
        reals.chunks_exact(REALS_PER_FACET).map(facet).stored().map(FacetGaps)
    }

    /// On the heap `[bytes]`.
    pub(crate) fn bytes(&self) -> usize {
        self.0.capacity() * size_of::<[Vec3; MAX_CORNERS]>()
    }
}

fn is_open(shares: &[Vec3; MAX_CORNERS]) -> bool {
    shares.iter().any(|share| *share != Vec3::zeros())
}

/// What dual multipliers make of a part's gaps, with all pairs of its facet f of the host.
fn dual_shares(one: &Surface, at: &Active, f: usize, shares: &[Vec3; MAX_CORNERS]) -> Result<[Vec3; MAX_CORNERS]> {
    let [first, end] = [f, f + 1].map(|f| at.parents.partition_point(|pair| pair.one < f));
    let Some(basis) = one.parent_basis(f, &at.x1, &mut at.integrated_parents[first..end].iter())? else {
        return Ok([Vec3::zeros(); MAX_CORNERS]);
    };
    let a = basis.faded_coefficients();
    Ok(std::array::from_fn(|k| (0..MAX_CORNERS).map(|b| shares[b] * a[k][b]).sum()))
}

/// What a pair of parts adds to the gaps of the nodes that have the multipliers over the non-mortar one [L^3].
fn gap_of_parts(
    (one, two): (&Surface, &Surface),
    at: &Active,
    pair: &PairRecord,
    rule: &'static Rule,
) -> Result<[Vec3; MAX_CORNERS]> {
    let mut gaps = [Vec3::zeros(); MAX_CORNERS];
    let frame = one.frame(pair.one, &at.x1, &at.normals)?;
    let (Some(p), Some(q)) = (&one.parents, &two.parents) else { return Ok(gaps) };
    let share = if two.analytic.is_some() {
        let surface = two.analytic_at(&at.x2)?;
        p.over_surface(pair.one, (&frame, &at.x1), (&surface, rule), |part, x| part.weights(x))?
    } else {
        let Some(segment) = Segment::new(&frame, &two.facet(pair.two, &at.x2))? else { return Ok(gaps) };
        p.share(q, (pair.one, pair.two), (&frame, &segment, rule), (&at.x1, &at.x2))
    };
    let (of_one, of_two) = (p.at(p.parent(pair.one), &at.x1), q.at(q.parent(pair.two), &at.x2));
    for (a, gap) in gaps.iter_mut().enumerate() {
        // Sums of weights vanish, and so does a common offset.
        let from = |x: &[Vec3], n: &[f64]| -> Vec3 { x.iter().zip(n).map(|(x, n)| (x - of_one.x[0]) * *n).sum() };
        *gap = from(&of_one.x, &share.ab[a]) - from(&of_two.x, &share.ac[a]);
    }
    Ok(gaps)
}

fn plane(one: &Surface, f: usize, x1: &[Vec3]) -> Result<Plane> {
    Plane::of(&one.facet(f, x1)).map_err(one.at(f))
}
