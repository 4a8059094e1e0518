//! What an interface remembers of t_n: configuration, weights, normals, areas, coverage, slip
//! (formulation b.10). Changes only on commit, rolls back exactly, travels as flat arrays. Without friction there is no
//! slip to measure: no gaps, no slip, and weights only where they are frozen; tied surfaces keep the gap, and no slip.

use super::options::{Friction, Options, Weights};
use super::surface::Surface;
use crate::error::{Error, Kind, Result};
use crate::geometry::{AnalyticShape, Plane, Vec3};
use crate::mortar::{NonmortarFrame, PairWeights};
use crate::shape::MAX_NODES;

/// The weights of one pair of facets.
#[derive(Clone, Debug, PartialEq)]
pub struct PairRecord {
    /// Non-mortar facet.
    pub one: usize,
    /// Mortar facet.
    pub two: usize,
    /// Their weights.
    pub weights: PairWeights,
}

/// What a history holds besides configuration, normals, areas and coverage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keeps {
    /// Gaps, slip and weights of t_n, from which slip is measured.
    Slip,
    /// The frozen weights and their first gaps: tied.
    Gap,
    /// The frozen weights alone: without friction.
    Weights,
    /// Nothing: without friction, weights of now.
    Nothing,
}

impl Keeps {
    /// What an interface with these options needs.
    pub fn of(options: &Options) -> Keeps {
        match (options.friction, options.effective_weights()) {
            (Friction::None, Weights::Current) => Keeps::Nothing,
            (Friction::None, _) => Keeps::Weights,
            (Friction::Tied, _) => Keeps::Gap,
            _ => Keeps::Slip,
        }
    }

    /// First integer of an exported history: "stickslip history, layout 1 to 4".
    fn layout(self) -> i64 {
        match self {
            Keeps::Slip => 0x57_1C_01,
            Keeps::Weights => 0x57_1C_02,
            Keeps::Nothing => 0x57_1C_03,
            Keeps::Gap => 0x57_1C_04,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Keeps::Slip => "with slip",
            Keeps::Gap => "of tied surfaces",
            Keeps::Weights => "without friction, with frozen weights",
            Keeps::Nothing => "without friction, with weights of now",
        }
    }

    /// Vectors a node of gaps, and of slip: 1 where they are kept.
    pub fn gaps_and_slips(self) -> [usize; 2] {
        match self {
            Keeps::Slip => [1, 1],
            Keeps::Gap => [1, 0],
            Keeps::Weights | Keeps::Nothing => [0, 0],
        }
    }

    /// Vectors per non-mortar node: position, normal and what else is kept.
    fn vectors(self) -> usize {
        2 + self.gaps_and_slips().iter().sum::<usize>()
    }

    fn reals(self, n1: usize, n2: usize, pairs: usize) -> usize {
        (3 * self.vectors() + 2) * n1 + 3 * n2 + REALS_PER_PAIR * pairs
    }
}

/// The committed state of an interface.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// Which of the members below are in use.
    pub(super) keeps: Keeps,
    /// Steps committed since creation.
    pub commits: i64,
    /// Non-mortar positions x(t_n).
    pub x1: Vec<Vec3>,
    /// Mortar positions x(t_n).
    pub x2: Vec<Vec3>,
    /// nu_A(t_n), into the non-mortar body.
    pub normals: Vec<Vec3>,
    /// M_A: full nodal area, covered or not [L^2].
    pub areas: Vec<f64>,
    /// m_A(t_n): covered area [L^2].
    pub coverage: Vec<f64>,
    /// g[n_n, x_n] [L^3]; empty without friction.
    pub gap: Vec<Vec3>,
    /// Slip accumulated since the first configuration `[L]`; empty without friction, and of tied surfaces.
    pub slip: Vec<Vec3>,
    /// n(t_n), sorted by facets; none without friction, unless they are frozen.
    pub pairs: Vec<PairRecord>,
    /// Whether coverage, gap and pairs are known; if not they are 0, and made up for when the surfaces come near.
    pub integrated: bool,
}

const HEADER: usize = 6;
/// A normal farther from unit length than rounding takes it was not written by the library.
const UNIT: f64 = 1e-10;
const REALS_PER_PAIR: usize = 2 * MAX_NODES * MAX_NODES;

impl History {
    /// Takes each node's coverage and, of gaps and weights of t_n, what it keeps; leaves the rest.
    pub(super) fn fill(&mut self, pairs: &mut Vec<PairRecord>, sums: &[(f64, Vec3)]) {
        self.coverage = sums.iter().map(|(coverage, _)| *coverage).collect();
        if self.keeps.gaps_and_slips()[0] == 1 {
            self.gap = sums.iter().map(|(_, gap)| *gap).collect();
        }
        if self.keeps != Keeps::Nothing {
            self.pairs = std::mem::take(pairs);
        }
        self.integrated = true;
    }

    /// Refuses a history that has left the range of doubles: nothing could be measured from it, and no import takes it.
    pub(super) fn check_finite(&self) -> Result<()> {
        let vectors = [("gap", &self.gap), ("slip", &self.slip)];
        let vectors = vectors.map(|(name, v)| (name, v.iter().position(|v| !v.iter().all(|c| c.is_finite()))));
        let numbers = [("area", &self.areas), ("coverage", &self.coverage)];
        let numbers = numbers.map(|(name, v)| (name, v.iter().position(|v| !v.is_finite())));
        match vectors.into_iter().chain(numbers).find_map(|(name, at)| Some((name, at?))) {
            None => Ok(()),
            Some((name, node)) => {
                let text = format!("the {name} of non-mortar node {node} overflows; the positions are out of range");
                Err(Error::new(Kind::NotFinite, text))
            }
        }
    }

    /// Lengths of the flat arrays: (integers, reals).
    pub fn flat_size(&self) -> (usize, usize) {
        let n = self.pairs.len();
        (HEADER + 2 * n, self.keeps.reals(self.x1.len(), self.x2.len(), n))
    }

    /// The history as flat arrays.
    pub fn export(&self, nonmortar: &Surface, mortar: &Surface) -> (Vec<i64>, Vec<f64>) {
        let counts = [self.x1.len() as i64, self.x2.len() as i64, self.pairs.len() as i64];
        let mut integers = vec![self.keeps.layout(), self.commits];
        integers.extend(counts);
        integers.push(fingerprint(nonmortar, mortar));
        let mut reals = Vec::with_capacity(self.flat_size().1);
        for x in [&self.x1, &self.x2, &self.normals, &self.gap, &self.slip] {
            reals.extend(x.iter().flat_map(|v| v.iter()));
        }
        reals.extend(&self.areas);
        reals.extend(&self.coverage);
        for pair in &self.pairs {
            integers.extend([pair.one as i64, pair.two as i64]);
            reals.extend(pair.weights.ab.iter().chain(&pair.weights.ac).flatten());
        }
        (integers, reals)
    }

    /// Reads what [`History::export`] wrote for the same surfaces and the same `keeps`; `frozen`: weights are, for good.
    ///
    /// # Errors
    /// [`Kind::HistoryMismatch`] or [`Kind::NotFinite`], naming the array.
    pub(super) fn import(
        (keeps, frozen): (Keeps, bool),
        (integers, reals): (&[i64], &[f64]),
        (nonmortar, mortar): (&Surface, &Surface),
    ) -> Result<History> {
        let mismatch = |text: String| Err(Error::new(Kind::HistoryMismatch, text));
        let (n1, n2) = (nonmortar.len(), mortar.len());
        let &[layout, commits, nodes1, nodes2, pairs, print, ref facets @ ..] = integers else {
            return mismatch(format!("integers has {} entries; at least {HEADER} are needed", integers.len()));
        };
        let Some(found) =
            [Keeps::Slip, Keeps::Gap, Keeps::Weights, Keeps::Nothing].into_iter().find(|k| k.layout() == layout)
        else {
            return mismatch(format!("integers[0] is {layout}: not a history of this library version"));
        };
        if found != keeps {
            return mismatch(format!("the history is one {}, the interface one {}", found.name(), keeps.name()));
        }
        if (nodes1, nodes2) != (n1 as i64, n2 as i64) {
            return mismatch(format!("the history has {nodes1} + {nodes2} nodes, the interface {n1} + {n2}"));
        }
        if print != fingerprint(nonmortar, mortar) {
            return mismatch("the history was made with other facets, or with the same in another order".into());
        }
        if keeps == Keeps::Nothing && pairs != 0 {
            return mismatch(format!("integers names {pairs} pairs; a history {} has none", keeps.name()));
        }
        if commits < 0 || usize::try_from(pairs).map(|p| p.checked_mul(2)) != Ok(Some(facets.len())) {
            return mismatch(format!("integers names {pairs} pairs and holds {} facets", facets.len()));
        }
        let n_reals = keeps.reals(n1, n2, facets.len() / 2);
        if reals.len() != n_reals {
            return mismatch(format!("reals has {} entries; {n_reals} are needed", reals.len()));
        }
        if let Some(k) = reals.iter().position(|v| !v.is_finite()) {
            return Err(Error::new(Kind::NotFinite, format!("reals[{k}] is not finite")));
        }
        let mut rest = reals;
        let mut take = |n: usize| {
            let (head, tail) = rest.split_at(n);
            rest = tail;
            head
        };
        let mut vectors = |n: usize| take(3 * n).chunks_exact(3).map(Vec3::from_column_slice).collect::<Vec<_>>();
        let (x1, x2, normals) = (vectors(n1), vectors(n2), vectors(n1));
        let [gap, slip] = keeps.gaps_and_slips().map(|kept| vectors(kept * n1));
        let (areas, coverage) = (take(n1).to_vec(), take(n1).to_vec());
        let mut history = History {
            keeps,
            commits,
            x1,
            x2,
            normals,
            areas,
            coverage,
            gap,
            slip,
            pairs: Vec::new(),
            integrated: true,
        };
        for f in facets.chunks_exact(2) {
            let index = |v: i64, n: usize| usize::try_from(v).ok().filter(|&i| i < n);
            let (Some(one), Some(two)) = (index(f[0], nonmortar.facets.len()), index(f[1], mortar.facets.len())) else {
                return mismatch(format!("a pair names the facets {} and {}, which do not exist", f[0], f[1]));
            };
            let mut weights = PairWeights::default();
            let values = take(REALS_PER_PAIR);
            weights.ab.as_flattened_mut().copy_from_slice(&values[..REALS_PER_PAIR / 2]);
            weights.ac.as_flattened_mut().copy_from_slice(&values[REALS_PER_PAIR / 2..]);
            history.pairs.push(PairRecord { one, two, weights });
        }
        if !history.pairs.is_sorted_by(|p, q| (p.one, p.two) < (q.one, q.two)) {
            return mismatch("the pairs are not sorted by their facets, or one comes twice".into());
        }
        if let Some(k) = history.areas.iter().position(|&a| a <= 0.0) {
            return mismatch(format!("the area of node {k} is not positive"));
        }
        if let Some(k) = history.normals.iter().position(|n| !((n.norm() - 1.0).abs() <= UNIT)) {
            return mismatch(format!("the normal of node {k} is no unit vector"));
        }
        // Weights that are frozen for good are none of these positions, and a commit takes any.
        if !frozen {
            let frame = |f| NonmortarFrame::new(&nonmortar.facet(f, &history.x1)).map(|_| ());
            let plane = |f| Plane::of(&mortar.facet(f, &history.x2)).map(|_| ());
            let facets = (0..nonmortar.facets.len()).map(frame).chain((0..mortar.facets.len()).map(plane));
            if let Some(error) = facets.into_iter().find_map(Result::err) {
                return mismatch(format!("a facet is degenerate at the history's positions: {error}"));
            }
        }
        Ok(history)
    }
}

/// A number that two pairs of surfaces share only when their facets name the same nodes in the same
/// order, and an analytic surface has the same shape (FNV-1a).
fn fingerprint(nonmortar: &Surface, mortar: &Surface) -> i64 {
    let facets = nonmortar.facets.iter().chain(&mortar.facets);
    let words = facets.flat_map(|f| std::iter::once(f.len).chain(f.nodes)).map(|word| word as u64);
    let words = words.chain(mortar.analytic.into_iter().flat_map(AnalyticShape::words));
    words.fold(0xcbf2_9ce4_8422_2325_u64, |hash, word| (hash ^ word).wrapping_mul(0x0100_0000_01b3)) as i64
}
