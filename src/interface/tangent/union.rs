//! Which pairs a tangent has: those active now and, where slip counts, those of t_n.

use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::checksum::of_words;
use crate::interface::data::options::Weights;
use crate::interface::data::pairs::{PairRecord, ParentRecord};
use crate::interface::data::surface::frames;
use crate::interface::pairing::analytic;
use crate::interface::pairing::candidates::{KeptTree, SKIN, candidates};
use crate::interface::pairing::filter::Filter;
use crate::interface::pairing::given::Given;
use crate::memory::{self, Store, Stored};
use crate::mortar::{PairWeights, ParentWeights};
use crate::shape::{MAX_CORNERS, MAX_NODES};
use crate::simd;
use std::ops::Range;

/// So many pairs ahead weights are fetched: about two facets'.
const AHEAD: usize = 8;

/// A pair of the union of those active now and those of t_n.
#[derive(Clone, Copy, Debug)]
pub struct UnionPair {
    /// Non-mortar facet.
    pub one: usize,
    /// Mortar facet.
    pub two: usize,
    /// Whether it is active now.
    pub is_active: bool,
    /// Its place among the current pairs, or that of the next one.
    pub place: usize,
    /// Its place among those of t_n.
    pub previous: Option<usize>,
}

impl UnionPair {
    /// The places of those that are active now among the current pairs, of pairs that follow each other.
    pub fn places(pairs: &[UnionPair]) -> Range<usize> {
        let first = pairs[0].place;
        first..first + pairs.iter().filter(|pair| pair.is_active).count()
    }
}

/// The pairs that a tangent has, sorted by their facets.
#[derive(Clone, Copy, Debug)]
pub enum Pairs<'a> {
    /// Those active now and, where slip counts, those of t_n.
    Union([&'a [PairRecord]; 2]),
    /// The same of pairs of parents.
    Parents([&'a [ParentRecord]; 2]),
    /// All that there may be.
    Possible(&'a [(usize, usize)]),
}

impl<'a> Pairs<'a> {
    /// A number that tells these pairs, and this fact of them, from others.
    pub fn checksum(self, fact: bool) -> u64 {
        if let Pairs::Possible(list) = self {
            let pairs = list.iter().flat_map(|&(one, two)| [one as u64, two as u64]);
            return of_words([2 + u64::from(fact)].into_iter().chain(pairs));
        }
        let list = |list: usize| {
            let pairs = (0..self.len(list)).filter_map(move |k| self.get(list, k));
            std::iter::once(self.len(list) as u64).chain(pairs.flat_map(|pair| [pair.0 as u64, pair.1 as u64]))
        };
        of_words(std::iter::once(u64::from(fact)).chain((0..2).flat_map(list)))
    }

    /// Pairs of a list: those of now, those of t_n.
    fn len(self, list: usize) -> usize {
        match self {
            Pairs::Union(lists) => lists[list].len(),
            Pairs::Parents(lists) => lists[list].len(),
            Pairs::Possible(possible) => {
                if list == 0 {
                    possible.len()
                } else {
                    0
                }
            }
        }
    }

    /// The facets of the k-th of them.
    fn get(self, list: usize, k: usize) -> Option<(usize, usize)> {
        match self {
            Pairs::Union(lists) => lists[list].get(k).map(|p| (p.one, p.two)),
            Pairs::Parents(lists) => lists[list].get(k).map(|p| (p.one, p.two)),
            Pairs::Possible(possible) => possible.get(k).copied(), // active and of t_n
        }
    }

    /// The weights of now of a pair of parents.
    pub fn parent_now(self, pair: &UnionPair) -> Option<&'a ParentWeights> {
        let Pairs::Parents([now, _]) = self else { return None };
        pair.is_active.then(|| &now[pair.place].weights)
    }

    /// Its weights of t_n.
    pub fn parent_previous(self, pair: &UnionPair) -> Option<&'a ParentWeights> {
        let Pairs::Parents([_, previous]) = self else { return None };
        pair.previous.map(|place| &previous[place].weights)
    }

    /// The weights of now of a pair; 0 where it is possible alone.
    pub fn now(self, pair: &UnionPair) -> Option<&'a PairWeights> {
        self.weights(0, pair.is_active.then_some(pair.place))
    }

    /// Its weights of t_n.
    pub fn previous(self, pair: &UnionPair) -> Option<&'a PairWeights> {
        self.weights(1, pair.previous)
    }

    /// Has the processor fetch the weights that are next after those of the pairs of a facet: it would wait for them.
    pub fn fetch(self, pairs: &[UnionPair]) {
        let Pairs::Union([now, before]) = self else { return };
        for pair in pairs {
            now.get(pair.place + AHEAD).into_iter().for_each(simd::prefetch);
            let previous = pair.previous.and_then(|place| before.get(place + AHEAD));
            previous.into_iter().for_each(simd::prefetch);
        }
    }

    fn weights(self, list: usize, place: Option<usize>) -> Option<&'a PairWeights> {
        static NONE: PairWeights =
            PairWeights { ab: [[0.0; MAX_NODES]; MAX_CORNERS], ac: [[0.0; MAX_NODES]; MAX_CORNERS] };
        place.map(|place| match self {
            Pairs::Union(lists) => &lists[list][place].weights,
            Pairs::Parents(_) | Pairs::Possible(_) => &NONE,
        })
    }
}

/// Walks through pairs facet by facet.
#[derive(Clone, Copy, Debug)]
pub struct Walk<'a> {
    pairs: Pairs<'a>,
    next: [usize; 2],
    /// The first facet that is none of these.
    end: usize,
}

impl<'a> Walk<'a> {
    /// Through those of these facets.
    pub fn through(pairs: Pairs<'a>, facets: Range<usize>) -> Walk<'a> {
        let next = match pairs {
            Pairs::Union(lists) => lists.map(|list| list.partition_point(|pair| pair.one < facets.start)),
            Pairs::Parents(lists) => lists.map(|list| list.partition_point(|pair| pair.one < facets.start)),
            Pairs::Possible(list) => [list.partition_point(|pair| pair.0 < facets.start), 0],
        };
        Walk { pairs, next, end: facets.end }
    }

    /// Puts the pairs of the next facet into `of_facet`; gives the facet.
    pub fn next(&mut self, of_facet: &mut Vec<UnionPair>) -> Result<Option<usize>> {
        of_facet.clear();
        loop {
            let heads = match self.pairs {
                Pairs::Possible(_) => [self.pairs.get(0, self.next[0]); 2],
                pairs => [0, 1].map(|list| pairs.get(list, self.next[list])),
            };
            let facet = of_facet.first().map(|pair| pair.one);
            let head = heads.into_iter().flatten().min();
            let Some((one, two)) = head.filter(|h| h.0 < self.end && facet.is_none_or(|f| f == h.0)) else {
                return Ok(facet);
            };
            let [is_active, was_active] = heads.map(|head| head == Some((one, two)));
            let previous = was_active.then_some(self.next[1]);
            of_facet.store(UnionPair { one, two, is_active, place: self.next[0], previous })?;
            self.next[0] += usize::from(is_active);
            self.next[1] += usize::from(was_active);
        }
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
                let once = !h.keeps.pairs() || (x1, x2) == (&h.x1[..], &h.x2[..]);
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
                let faces = |&i: &usize| !one.is_idle(i) && (facing[i] || now.get(i).is_some_and(|now| *now));
                pairs.store_all((0..facing.len()).filter(faces).map(|i| (i, 0)))?;
            }
        }
    }
    if let (Some(p), Some(q)) = (&one.parents, &two.parents) {
        pairs.iter_mut().for_each(|pair| *pair = (p.parent(pair.0), q.parent(pair.1)));
        pairs.store_all(h.parents.iter().map(|p| (p.one, p.two)))?;
    }
    memory::sort(&mut pairs)?;
    pairs.dedup();
    Ok(pairs)
}
