//! Which pairs a tangent has: those active now and, where slip counts, those of t_n.

use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::history::Keeps;
use crate::interface::data::options::Weights;
use crate::interface::data::pairs::PairRecord;
use crate::interface::data::setup::Setup;
use crate::interface::data::surface::frames;
use crate::interface::pairing::analytic;
use crate::interface::pairing::candidates::{KeptTree, SKIN, candidates};
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::given::Given;
use crate::memory::{self, Store, Stored};
use crate::mortar::{MORTAR, PAIR_NODES, PairWeights};
use std::ops::Range;

/// A pair of the union of those active now and those of t_n.
#[derive(Clone, Copy, Debug)]
pub struct UnionPair<'a> {
    /// Non-mortar facet.
    pub one: usize,
    /// Mortar facet.
    pub two: usize,
    /// Its weights of now.
    pub now: Option<&'a PairWeights>,
    /// Its place among the current pairs, or that of the next one.
    pub place: usize,
    /// Its weights of t_n.
    pub previous: Option<&'a PairWeights>,
}

impl<'a> UnionPair<'a> {
    fn now((place, pair): (usize, &'a PairRecord)) -> UnionPair<'a> {
        UnionPair { one: pair.one, two: pair.two, now: Some(&pair.weights), place, previous: None }
    }

    /// The places of those that are active now among the current pairs, of pairs that follow each other.
    pub fn places(pairs: &[UnionPair]) -> Range<usize> {
        let first = pairs[0].place;
        first..first + pairs.iter().filter(|pair| pair.now.is_some()).count()
    }

    /// The nodes in the pair's slots, as indices over both surfaces (mortar after non-mortar).
    pub fn slots<const N: usize>(&self, setup: &Setup<N>) -> [Option<usize>; PAIR_NODES] {
        let (one, two) = (&setup.nonmortar.facets[self.one], &setup.mortar.facets[self.two]);
        std::array::from_fn(|k| {
            if k < MORTAR {
                (k < one.len).then(|| one.nodes[k])
            } else {
                (k - MORTAR < two.len).then(|| setup.nonmortar.len() + two.nodes[k - MORTAR])
            }
        })
    }
}

/// The union of the pairs active now and, where `slips`, of those of t_n; both are sorted by their facets, and so is it.
pub fn union<'a>(now: &'a [PairRecord], previous: &'a [PairRecord], slips: bool) -> Result<Vec<UnionPair<'a>>> {
    if !slips {
        return now.iter().enumerate().map(UnionPair::now).stored();
    }
    let (mut now, mut previous) = (now.iter().peekable(), previous.iter().peekable());
    let mut place = 0;
    let mut union = memory::with_room(now.len().max(previous.len()))?;
    loop {
        let heads = [now.peek(), previous.peek()];
        let Some((one, two)) = heads.into_iter().flatten().map(|p| (p.one, p.two)).min() else { return Ok(union) };
        let n = now.next_if(|p| (p.one, p.two) == (one, two));
        let p = previous.next_if(|p| (p.one, p.two) == (one, two));
        union.store(UnionPair { one, two, now: n.map(|p| &p.weights), place, previous: p.map(|p| &p.weights) })?;
        place += usize::from(n.is_some());
    }
}

/// The pairs of t_n and all that may be active while the surfaces move by less than the skin, sorted.
pub fn possible_pairs<const N: usize>(
    given: Given<N>,
    tree: &mut KeptTree,
    (x1, x2): (&[Vec3], &[Vec3]),
) -> Result<Vec<(usize, usize)>> {
    let ((one, two), h) = (given.setup.surfaces(), given.history());
    let mut pairs: Vec<_> = h.pairs.iter().map(|p| (p.one, p.two)).stored()?;
    if given.setup.options.effective_weights() == Weights::Current {
        match given.step.pairing.filter.as_ref().expect("current weights have one") {
            Filter::Facets(filter) => {
                // Those of t_n are sought as those of now: whether their weights were left out, because the surfaces
                // were apart, does not matter then, and nothing is integrated for a pattern.
                let once = h.keeps == Keeps::Nothing || (x1, x2) == (&h.x1[..], &h.x2[..]);
                for (x1, x2) in [(x1, x2), (&h.x1[..], &h.x2[..])].into_iter().take(if once { 1 } else { 2 }) {
                    let (frames, tree) = (frames(one, x1)?, tree.at(two, x2)?);
                    let options = &given.setup.options;
                    let found = candidates((one, two), options, &frames, (x1, x2), (tree, filter), SKIN, &mut 0)?;
                    pairs.store_all(found.into_iter())?;
                }
            }
            Filter::Analytic(facing) => {
                let options = &given.setup.options;
                let now = if options.follows_normals() {
                    analytic::facing(one, &two.analytic_at(x2)?, options, x1, SKIN)?
                } else {
                    Vec::new()
                };
                let faces = |&i: &usize| facing[i] || now.get(i).is_some_and(|now| *now);
                pairs.store_all((0..facing.len()).filter(faces).map(|i| (i, 0)))?;
            }
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    Ok(pairs)
}
