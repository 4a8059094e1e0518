//! The history as flat arrays, for a restart.
//!
//! Integers: the layout, the checksum (`checksum.rs`), the meaning (`meaning.rs`), commits, nodes of both sides; then lists,
//! each after its length: the pairs' facets. Reals: x1, x2, normals, gaps, slip, gaps of facets, areas, coverage, what a law of
//! one's own or points remember, the positions that weights are of where they are frozen for good, the pairs' weights. What is not kept (`Keeps`) takes no room.

use super::checksum::{self, PLACE};
use super::facet_gaps::{FacetGaps, REALS_PER_FACET};
use super::history::{History, Keeps};
use super::meaning;
use super::options::Weights;
use super::pairs::{PairRecord, ParentRecord};
use super::setup::Setup;
use super::surface::Surface;
use crate::error::{Error, Kind, Result, Text};
use crate::geometry::{Plane, Vec3};
use crate::memory::{self, Store, Stored};
use crate::mortar::{NonmortarFrame, PairWeights, ParentWeights};
use crate::shape::{MAX_CORNERS, MAX_NODES, MAX_PARENT_NODES};

/// First integer: "stickslip history", layout 6.
const LAYOUT: i64 = 0x57_1C_06;
/// First integers of the layouts before.
const OLD_LAYOUTS: std::ops::RangeInclusive<i64> = 0x57_1C_01..=0x57_1C_05;
/// Integers before the lists.
const HEADER: usize = 2 + meaning::LENGTH + 3;
/// A pair's weights n_AB and n_AC.
const REALS_PER_PAIR: usize = 2 * MAX_CORNERS * MAX_NODES;
/// Those of a pair of parents.
const REALS_PER_PARENT_PAIR: usize = 2 * MAX_PARENT_NODES * MAX_PARENT_NODES;
/// A normal farther from unit length than rounding takes it was not written by the library.
const UNIT: f64 = 1e-10;

/// What an import must fit to.
pub struct Host<'a> {
    surfaces: (&'a Surface, &'a Surface),
    keeps: Keeps,
    /// Reals that the law remembers of all nodes; `None`: points remember, and how many there are follows from the pairs.
    states: Option<usize>,
    meaning: [i64; meaning::LENGTH],
    /// Whether the weights are frozen for good: then the positions that they are of are kept.
    frozen: bool,
}

impl<'a> Host<'a> {
    /// What an interface is, whose law remembers so many reals.
    pub fn of<const N: usize>(setup: &'a Setup<N>, states: usize) -> Host<'a> {
        let (options, own, surfaces) = (&setup.options, setup.own.as_ref(), setup.surfaces());
        Host {
            surfaces,
            keeps: Keeps::of(options),
            states: (!setup.has_point_friction()).then_some(states),
            meaning: meaning::of(options, own, surfaces),
            frozen: options.effective_weights() == Weights::Reference,
        }
    }

    /// Reals of the positions that weights are of.
    fn places(&self) -> usize {
        let (one, two) = self.surfaces;
        if self.frozen { 3 * (one.len() + two.len()) } else { 0 }
    }
}

fn mismatch<T>(text: impl Into<Text>) -> Result<T> {
    Err(Error::new(Kind::HistoryMismatch, text.into()))
}

/// The next list: its length, then so many items of `width` integers.
fn list<'a>(rest: &mut &'a [i64], name: &str, width: usize) -> Result<&'a [i64]> {
    let text = || text!("the list of {name} is longer than the integers");
    let Some((&n, items)) = rest.split_first() else { return mismatch(text()) };
    let length = usize::try_from(n).ok().and_then(|n| n.checked_mul(width)).filter(|n| *n <= items.len());
    let Some(length) = length else { return mismatch(text()) };
    let (list, others) = items.split_at(length);
    *rest = others;
    Ok(list)
}

/// The next `n` numbers; there are as many.
fn take<'a>(rest: &mut &'a [f64], n: usize) -> &'a [f64] {
    let (head, tail) = rest.split_at(n);
    *rest = tail;
    head
}

fn vectors(rest: &mut &[f64], n: usize) -> Result<Vec<Vec3>> {
    take(rest, 3 * n).chunks_exact(3).map(Vec3::from_column_slice).stored()
}

impl History {
    /// Lengths of the flat arrays: (integers, reals).
    pub fn flat_size(&self, host: &Host) -> (usize, usize) {
        let (n, per_pair) = match self.parents.len() {
            0 => (self.pairs.len(), REALS_PER_PAIR),
            n => (n, REALS_PER_PARENT_PAIR),
        };
        let nodes = [self.x1.len(), self.x2.len()];
        let of_nodes = self.keeps.reals(nodes, self.facet_gaps.len()) + self.states.len() + host.places();
        (HEADER + 1 + 2 * n, of_nodes + n * per_pair)
    }

    /// The history as flat arrays.
    pub fn export(&self, host: &Host) -> Result<(Vec<i64>, Vec<f64>)> {
        let (n_integers, n_reals) = self.flat_size(host);
        let (mut integers, mut reals) = (memory::with_room(n_integers)?, memory::with_room(n_reals)?);
        let pairs = self.pairs.len() + self.parents.len(); // one of the lists is empty
        let counts = [self.commits, self.x1.len() as i64, self.x2.len() as i64, pairs as i64];
        integers.store_all([LAYOUT, 0].into_iter().chain(host.meaning).chain(counts))?;
        for x in [&self.x1, &self.x2, &self.normals, &self.gap, &self.slip] {
            reals.store_all(x.iter().flat_map(|v| v.iter().copied()))?;
        }
        reals.store_all(self.facet_gaps.reals().copied())?;
        reals.store_all(self.areas.iter().copied())?;
        reals.store_all(self.coverage.iter().copied())?;
        reals.store_all(self.states.iter().copied())?;
        if host.frozen {
            let (x1, x2) = self.weighted_at(Weights::Reference, host.surfaces);
            reals.store_all(x1.iter().chain(x2).flat_map(|v| v.iter().copied()))?;
        }
        for pair in &self.pairs {
            integers.store_all([pair.one as i64, pair.two as i64].into_iter())?;
            reals.store_all(pair.weights.ab.iter().chain(&pair.weights.ac).flatten().copied())?;
        }
        for pair in &self.parents {
            integers.store_all([pair.one as i64, pair.two as i64].into_iter())?;
            reals.store_all(pair.weights.ab.iter().chain(&pair.weights.ac).flatten().copied())?;
        }
        checksum::seal_history(&mut integers, &reals);
        Ok((integers, reals))
    }

    /// Reads what [`History::export`] wrote for the same surfaces and choices.
    ///
    /// # Errors
    /// [`Kind::HistoryMismatch`] or [`Kind::NotFinite`], naming the array.
    pub fn import((integers, reals): (&[i64], &[f64]), host: &Host) -> Result<History> {
        let &Host { surfaces: (nonmortar, mortar), keeps, states, frozen, .. } = host;
        let (n1, n2) = (nonmortar.len(), mortar.len());
        let (commits, facets) = check_header((integers, reals), host)?;
        let has_parents = nonmortar.parents.is_some();
        let per_pair = if has_parents { REALS_PER_PARENT_PAIR } else { REALS_PER_PAIR };
        let others = keeps.reals([n1, n2], nonmortar.facets.len()) + host.places() + facets.len() / 2 * per_pair;
        let states = states.unwrap_or(reals.len().saturating_sub(others));
        let n_reals = others + states;
        if reals.len() != n_reals {
            return mismatch(text!("reals has {} entries; {n_reals} are needed", reals.len()));
        }
        let mut rest = reals;
        let (x1, x2, normals) = (vectors(&mut rest, n1)?, vectors(&mut rest, n2)?, vectors(&mut rest, n1)?);
        let [gaps, slips] = keeps.gaps_and_slips();
        let (gap, slip) = (vectors(&mut rest, gaps * n1)?, vectors(&mut rest, slips * n1)?);
        let kept = if keeps.facet_gaps() { nonmortar.facets.len() } else { 0 };
        let facet_gaps = FacetGaps::from_reals(take(&mut rest, REALS_PER_FACET * kept))?;
        let (areas, coverage) = (memory::copied(take(&mut rest, n1))?, memory::copied(take(&mut rest, n1))?);
        let states = memory::copied(take(&mut rest, states))?;
        let at = if frozen { [vectors(&mut rest, n1)?, vectors(&mut rest, n2)?] } else { Default::default() };
        let (mut pairs, mut parents) = (Vec::new(), Vec::new());
        for f in facets.chunks_exact(2) {
            let index = |v: i64, n: usize| usize::try_from(v).ok().filter(|&i| i < n);
            let (Some(one), Some(two)) = (index(f[0], nonmortar.host_facets()), index(f[1], mortar.host_facets()))
            else {
                return mismatch(text!("a pair names the facets {} and {}, which do not exist", f[0], f[1]));
            };
            let values = take(&mut rest, per_pair);
            if has_parents {
                let mut weights = ParentWeights::default();
                weights.ab.as_flattened_mut().copy_from_slice(&values[..REALS_PER_PARENT_PAIR / 2]);
                weights.ac.as_flattened_mut().copy_from_slice(&values[REALS_PER_PARENT_PAIR / 2..]);
                parents.store(ParentRecord { one, two, weights })?;
                continue;
            }
            let mut weights = PairWeights::default();
            weights.ab.as_flattened_mut().copy_from_slice(&values[..REALS_PER_PAIR / 2]);
            weights.ac.as_flattened_mut().copy_from_slice(&values[REALS_PER_PAIR / 2..]);
            pairs.store(PairRecord { one, two, weights })?;
        }
        let integrated = true;
        let mut history = History {
            keeps,
            commits,
            x1,
            x2,
            frozen_at: Default::default(),
            normals,
            areas,
            coverage,
            gap,
            facet_gaps,
            slip,
            states,
            pairs,
            parents,
            integrated,
        };
        if frozen {
            history.freeze_at(host.surfaces, (&at[0], &at[1]))?;
        }
        check_contents(&history, (nonmortar, mortar), frozen)?;
        match mortar.check_rigid(&history.x2) {
            Ok(()) => Ok(history),
            Err(e) => mismatch(e.message),
        }
    }
}

/// Refuses what is damaged or not of this interface. Steps committed, and the pairs' facets.
fn check_header<'a>((integers, reals): (&'a [i64], &[f64]), host: &Host) -> Result<(i64, &'a [i64])> {
    if integers.len() < HEADER {
        return mismatch(text!("integers has {} entries; at least {HEADER} are needed", integers.len()));
    }
    let (layout, (nonmortar, mortar)) = (integers[0], host.surfaces);
    if OLD_LAYOUTS.contains(&layout) {
        let text = "the history has the layout of an older library version; this one reads layout 6: \
                    go on with the version that wrote it, or start anew";
        return mismatch(text);
    }
    if layout != LAYOUT {
        return mismatch(text!("integers[0] is {layout}: not a history of this library version"));
    }
    if let Some(k) = reals.iter().position(|v| !v.is_finite()) {
        return Err(Error::new(Kind::NotFinite, text!("reals[{k}] is not finite")));
    }
    if integers[PLACE] != checksum::of_history(integers, reals) {
        return mismatch(text!(
            "the checksum does not fit the {} integers and {} reals given: they are not those that were exported",
            integers.len(),
            reals.len()
        ));
    }
    let (meaning, rest) = integers[PLACE + 1..].split_first_chunk().expect("the header is longer");
    let (&[commits, nodes1, nodes2], mut rest) = rest.split_first_chunk().expect("the header is longer");
    let (n1, n2) = (nonmortar.len(), mortar.len());
    if (nodes1, nodes2) != (n1 as i64, n2 as i64) {
        return mismatch(text!("the history has {nodes1} + {nodes2} nodes, the interface {n1} + {n2}"));
    }
    meaning::check(meaning, &host.meaning)?;
    if commits < 0 {
        return mismatch(text!("integers names {commits} commits"));
    }
    let facets = list(&mut rest, "pairs", 2)?;
    if !rest.is_empty() {
        return mismatch(text!("integers holds {} entries after its last list", rest.len()));
    }
    if !host.keeps.pairs() && !facets.is_empty() {
        return mismatch("integers names pairs; a history without friction, with weights of now, has none");
    }
    Ok((commits, facets))
}

/// Refuses numbers that no evaluation could use.
fn check_contents(history: &History, (nonmortar, mortar): (&Surface, &Surface), frozen: bool) -> Result<()> {
    let is_sorted = history.pairs.is_sorted_by(|p, q| (p.one, p.two) < (q.one, q.two))
        && history.parents.is_sorted_by(|p, q| (p.one, p.two) < (q.one, q.two));
    if !is_sorted {
        return mismatch("the pairs are not sorted by their facets, or one comes twice");
    }
    if let Some(k) = history.areas.iter().position(|&a| a <= 0.0) {
        return mismatch(text!("the area of node {k} is not positive"));
    }
    if let Some(k) = history.normals.iter().position(|n| !((n.norm() - 1.0).abs() <= UNIT)) {
        return mismatch(text!("the normal of node {k} is no unit vector"));
    }
    // Weights that are frozen for good are none of these positions, and a commit takes any.
    if frozen {
        return Ok(());
    }
    let frame = |f| NonmortarFrame::new(&nonmortar.facet(f, &history.x1)).map(|_| ());
    let plane = |f| Plane::of(&mortar.facet(f, &history.x2)).map(|_| ());
    let facets = (0..nonmortar.facets.len()).map(frame).chain((0..mortar.facets.len()).map(plane));
    match facets.into_iter().find_map(Result::err) {
        Some(error) => mismatch(text!("a facet is degenerate at the history's positions: {error}")),
        None => Ok(()),
    }
}
