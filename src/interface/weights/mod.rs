//! All weights of an interface one by one, and how they change: for what is not contracted with tractions.

pub mod facet;

use crate::error::Result;
use crate::interface::data::pairs::Weighted;
use crate::interface::data::surface::Surface;

/// Gives every weight of these pairs: node A, the other node over both surfaces, n_AB or - n_AC.
pub fn each_weight(
    (one, two): (&Surface, &Surface),
    pairs: Weighted,
    give: &mut dyn FnMut(usize, usize, f64) -> Result<()>,
) -> Result<()> {
    let mut add = |(f, g): (usize, usize), ab: &dyn Fn(usize, usize) -> f64, ac: &dyn Fn(usize, usize) -> f64| {
        let (own, other) = (one.host_nodes(f), two.host_nodes(g));
        for (a, &node) in own.iter().enumerate().take(one.multipliers(f)) {
            own.iter().enumerate().try_for_each(|(b, &to)| give(node, to, ab(a, b)))?;
            other.iter().enumerate().try_for_each(|(c, &to)| give(node, one.len() + to, -ac(a, c)))?;
        }
        Ok(())
    };
    match pairs {
        Weighted::Facets(pairs) => pairs.iter().try_for_each(|pair| {
            let n = &pair.weights;
            add((pair.one, pair.two), &|a, b| n.ab[a][b], &|a, c| n.ac[a][c])
        }),
        Weighted::Parents(pairs) => pairs.iter().try_for_each(|pair| {
            let n = &pair.weights;
            add((pair.one, pair.two), &|a, b| n.ab[a][b], &|a, c| n.ac[a][c])
        }),
    }
}
