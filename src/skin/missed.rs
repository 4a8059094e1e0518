//! Contact that a step has missed: facets that lie in each other and that no interface has as a pair. Without this a body passes
//! through another one without a word (docs/formulation 19.5).

use super::near::{Near, PARALLEL};

/// Facets that are deeper in each other than this, over the smaller one's longest edge, are in contact: the error of flat facets on curved
/// bodies that hardly touch is less.
const DEEP: f64 = 0.005;
/// Their centres are no farther beside each other than this, over half of both sizes.
const BESIDE: f64 = 0.5;

/// Whether two facets lie in each other; `size`: the smaller one's longest edge `[L]`.
pub fn are_in_each_other(pair: &Near, size: f64) -> bool {
    pair.distance < -DEEP * size && pair.opposition < PARALLEL && pair.beside <= BESIDE
}
