//! What the pairs of a non-mortar facet add to the same entries of the tangent.

use crate::element::{PairNow, PairTangent};
use crate::mortar::{MORTAR, PairWeights};
use crate::shape::{MAX_CORNERS, MAX_NODES};
use crate::simd::{self, Kernel, Lanes};

/// The sum of those weights that there are, in `sum` where they are several; n_AC of one pair alone.
pub fn total<'a>(
    sum: &'a mut PairWeights,
    weights: impl Iterator<Item = Option<&'a PairWeights>>,
) -> Option<&'a PairWeights> {
    let mut weights = weights.flatten();
    let first = weights.next()?;
    let Some(second) = weights.next() else { return Some(first) };
    *sum = *first;
    for next in std::iter::once(second).chain(weights) {
        add(false, sum.ab.as_flattened_mut(), next.ab.as_flattened());
    }
    Some(sum)
}

/// A facet's d force / d x, `[k][j][i][B]`, and its weights n_AB.
pub type FacetNow<'a> = (&'a [[[[f64; MAX_NODES]; 3]; 3]], &'a [[f64; MAX_NODES]; MAX_CORNERS]);

/// What the pairs of a non-mortar facet add to the same entries of the tangent.
#[derive(Debug)]
pub struct FacetTangent<const N: usize> {
    /// `[k][j][i][B]`.
    pub forces: [[[[f64; MAX_NODES]; 3]; 3]; MAX_NODES],
    /// `[k][j][n][A]`.
    pub rows: [[[[f64; MAX_CORNERS]; N]; 3]; MAX_NODES],
    /// n_AB.
    pub weights: [[f64; MAX_NODES]; MAX_CORNERS],
    /// Whether a pair is active now.
    pub acts: bool,
}

impl<const N: usize> Default for FacetTangent<N> {
    fn default() -> Self {
        FacetTangent {
            forces: [[[[0.0; MAX_NODES]; 3]; 3]; MAX_NODES],
            rows: [[[[0.0; MAX_CORNERS]; N]; 3]; MAX_NODES],
            weights: [[0.0; MAX_NODES]; MAX_CORNERS],
            acts: false,
        }
    }
}

impl<const N: usize> FacetTangent<N> {
    /// What is there of pairs active now: d force / d x, and weights.
    pub fn now(&self) -> Option<FacetNow<'_>> {
        self.acts.then_some((&self.forces, &self.weights))
    }

    /// Adds a pair's share, or begins with the `first` one.
    pub fn add(&mut self, first: bool, now: Option<&PairNow>, t: &PairTangent<N>) {
        add(first, self.rows.flat_mut(), t.rows[..MORTAR].flat());
        if let Some(PairNow { weights, .. }) = now {
            let (first, n) = (!self.acts, &weights.ab);
            self.acts = true;
            add(first, self.forces.flat_mut(), t.forces.one[..MORTAR].flat());
            add(first, self.weights.as_flattened_mut(), n.as_flattened());
        }
    }
}

/// The values of nested arrays, one after the other.
pub trait Flat {
    /// To read.
    fn flat(&self) -> &[f64];
    /// To write.
    fn flat_mut(&mut self) -> &mut [f64];
}

impl<const I: usize, const J: usize, const K: usize> Flat for [[[[f64; I]; J]; K]] {
    fn flat(&self) -> &[f64] {
        self.as_flattened().as_flattened().as_flattened()
    }
    fn flat_mut(&mut self) -> &mut [f64] {
        self.as_flattened_mut().as_flattened_mut().as_flattened_mut()
    }
}

/// Adds numbers, a multiple of four, to as many; the `first` ones replace what is there.
#[inline(never)]
fn add(first: bool, sum: &mut [f64], values: &[f64]) {
    if first {
        sum.copy_from_slice(values);
    } else {
        simd::dispatch(Add { sum, values });
    }
}

struct Add<'a> {
    sum: &'a mut [f64],
    values: &'a [f64],
}

impl Kernel for Add<'_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        for (sum, v) in self.sum.as_chunks_mut().0.iter_mut().zip(self.values.as_chunks().0) {
            *sum = (L::load(sum) + L::load(v)).store();
        }
    }
}
