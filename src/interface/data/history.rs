//! What an interface remembers of t_n: configuration, weights, normals, areas, coverage, slip (docs/formulation 6.1).
//! It changes only on commit, rolls back exactly, and travels as flat arrays (`restart.rs`). Without friction there is no
//! slip to measure: no gaps (but where overlaps of t_n count as closed, or copies of nodes are told apart by them), no slip, and weights only where they are frozen. Tied surfaces keep the gap, that of their
//! facets too (`facet_gaps.rs`), and no slip.

use super::active::Active;
use super::facet_gaps::{FacetGaps, REALS_PER_FACET};
use super::options::{Options, Weights};
use super::pairs::{PairRecord, ParentRecord, Weighted};
use super::surface::Surface;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::law::Remembers;
use crate::memory;

/// What a history holds besides configuration, normals, areas and coverage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keeps {
    /// Gaps, slip and weights of t_n, from which slip is measured.
    Slip,
    /// The frozen weights and their first gaps: tied.
    Gap,
    /// The frozen weights alone: without friction.
    Weights,
    /// The frozen weights and the gaps of t_n, without friction: copies of a node are told apart.
    GapAndWeights,
    /// The gaps of t_n, without friction, weights of now: overlaps count as closed, or copies of a node are told apart.
    GapAlone,
    /// Nothing: without friction, weights of now.
    Nothing,
}

impl Keeps {
    /// What an interface with these options needs.
    pub fn of(options: &Options) -> Keeps {
        let tells_copies = options.tells_copies_apart();
        match (options.friction.law().remembers, options.effective_weights()) {
            (Remembers::Nothing, Weights::Current) if tells_copies || options.conserves() => Keeps::GapAlone,
            (Remembers::Nothing, Weights::Current) => Keeps::Nothing,
            (Remembers::Nothing, _) if tells_copies => Keeps::GapAndWeights,
            (Remembers::Nothing, _) => Keeps::Weights,
            (Remembers::FirstGap, _) => Keeps::Gap,
            (Remembers::Slip, _) => Keeps::Slip,
        }
    }

    /// Vectors a node of gaps, and of slip: 1 where they are kept.
    pub fn gaps_and_slips(self) -> [usize; 2] {
        match self {
            Keeps::Slip => [1, 1],
            Keeps::Gap | Keeps::GapAndWeights | Keeps::GapAlone => [1, 0],
            Keeps::Weights | Keeps::Nothing => [0, 0],
        }
    }

    /// Whether the pairs of t_n are kept, with their weights.
    pub fn pairs(self) -> bool {
        !matches!(self, Keeps::Nothing | Keeps::GapAlone)
    }

    /// Whether gaps of facets are kept.
    pub fn facet_gaps(self) -> bool {
        self == Keeps::Gap
    }

    /// Vectors per non-mortar node: position, normal and what else is kept.
    fn vectors(self) -> usize {
        2 + self.gaps_and_slips().iter().sum::<usize>()
    }

    /// Reals of a history of n1 + n2 nodes and so many non-mortar facets, but for its pairs.
    pub fn reals(self, [n1, n2]: [usize; 2], facets: usize) -> usize {
        let facets = if self.facet_gaps() { REALS_PER_FACET * facets } else { 0 };
        (3 * self.vectors() + 2) * n1 + 3 * n2 + facets
    }
}

/// The committed state of an interface.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// Which of the members below are in use.
    pub(crate) keeps: Keeps,
    /// Steps committed since creation.
    pub commits: i64,
    /// Non-mortar positions x(t_n).
    pub x1: Vec<Vec3>,
    /// Mortar positions x(t_n).
    pub x2: Vec<Vec3>,
    /// Positions of both sides that weights frozen for good are of, where these are not the first configuration; else empty.
    pub frozen_at: [Vec<Vec3>; 2],
    /// nu_A(t_n), into the non-mortar body.
    pub normals: Vec<Vec3>,
    /// M_A: full nodal area, covered or not [L^2].
    pub areas: Vec<f64>,
    /// m_A(t_n): covered area [L^2].
    pub coverage: Vec<f64>,
    /// g[n_n, x_n] [L^3]; empty without friction, unless its overlaps count as closed or copies of nodes are told apart by it. Tied: the part of the first gap that turns with no facet.
    pub gap: Vec<Vec3>,
    /// Tied: the part of the first gap that turns with its facet; else empty.
    pub facet_gaps: FacetGaps,
    /// Slip accumulated since the first configuration `[L]`; empty without friction, and of tied surfaces.
    pub slip: Vec<Vec3>,
    /// What a law of one's own remembers, node by node; else empty.
    pub states: Vec<f64>,
    /// n(t_n), sorted by facets; none without friction, unless they are frozen.
    pub pairs: Vec<PairRecord>,
    /// In place of them, where either side has quadratic facets: those of pairs of parents.
    pub parents: Vec<ParentRecord>,
    /// Whether coverage, gap and pairs are known; if not they are 0, and made up for when the surfaces come near.
    pub integrated: bool,
}

impl History {
    /// Takes each node's coverage and, of gaps and weights of t_n, what it keeps; leaves the rest. All of it or nothing.
    pub(crate) fn fill(&mut self, active: &mut Active, has_parents: bool, sums: &[(f64, Vec3)]) -> Result<()> {
        // There is room for as many: zeros are there.
        self.coverage.iter_mut().zip(sums).for_each(|(to, (coverage, _))| *to = *coverage);
        self.gap.iter_mut().zip(sums).for_each(|(to, (_, gap))| *to = *gap);
        if self.keeps.pairs() {
            match has_parents {
                false => std::mem::swap(&mut self.pairs, &mut active.pairs),
                true => std::mem::swap(&mut self.parents, &mut active.parents),
            }
        }
        self.integrated = true;
        Ok(())
    }

    /// The pairs of t_n between these surfaces.
    pub(crate) fn weighted(&self, surfaces: (&Surface, &Surface)) -> Weighted<'_> {
        match surfaces.0.parents {
            None => Weighted::Facets(&self.pairs),
            Some(_) => Weighted::Parents(&self.parents),
        }
    }

    /// None yet: memory for one.
    pub(crate) fn empty() -> History {
        History {
            keeps: Keeps::Nothing,
            commits: 0,
            x1: Vec::new(),
            x2: Vec::new(),
            frozen_at: [Vec::new(), Vec::new()],
            normals: Vec::new(),
            areas: Vec::new(),
            coverage: Vec::new(),
            gap: Vec::new(),
            facet_gaps: FacetGaps::default(),
            slip: Vec::new(),
            states: Vec::new(),
            pairs: Vec::new(),
            parents: Vec::new(),
            integrated: false,
        }
    }

    /// Begins anew with these positions, all zeros and no normals and pairs.
    pub(crate) fn begin(&mut self, keeps: Keeps, (x1, x2): (&[Vec3], &[Vec3])) -> Result<()> {
        let (n1, [gap, slip]) = (x1.len(), keeps.gaps_and_slips());
        (self.keeps, self.commits, self.integrated) = (keeps, 0, false);
        memory::recopy(&mut self.x1, x1)?;
        memory::recopy(&mut self.x2, x2)?;
        self.frozen_at.iter_mut().for_each(Vec::clear);
        self.normals.clear();
        memory::refill(&mut self.areas, 0.0, n1)?;
        memory::refill(&mut self.coverage, 0.0, n1)?;
        memory::refill(&mut self.gap, Vec3::zeros(), gap * n1)?;
        self.facet_gaps.clear();
        memory::refill(&mut self.slip, Vec3::zeros(), slip * n1)?;
        self.states.clear();
        self.pairs.clear();
        self.parents.clear();
        Ok(())
    }

    /// Notes that weights are frozen for good at (x1, x2).
    pub(crate) fn freeze_at(&mut self, (one, two): (&Surface, &Surface), (x1, x2): (&[Vec3], &[Vec3])) -> Result<()> {
        if one.reference != x1 || two.reference != x2 {
            memory::recopy(&mut self.frozen_at[0], x1)?;
            memory::recopy(&mut self.frozen_at[1], x2)?;
        }
        Ok(())
    }

    /// The positions that frozen weights are of.
    pub(crate) fn weighted_at<'a>(
        &'a self,
        weights: Weights,
        (one, two): (&'a Surface, &'a Surface),
    ) -> (&'a [Vec3], &'a [Vec3]) {
        match (weights, &self.frozen_at) {
            (Weights::Reference, [x1, _]) if x1.is_empty() => (&one.reference, &two.reference),
            (Weights::Reference, [x1, x2]) => (x1, x2),
            _ => (&self.x1, &self.x2),
        }
    }

    /// Becomes a copy of another one, with other positions.
    pub(crate) fn move_to(&mut self, other: &History, x1: &[Vec3], x2: &[Vec3]) -> Result<()> {
        (self.keeps, self.commits, self.integrated) = (other.keeps, other.commits, other.integrated);
        memory::recopy(&mut self.x1, x1)?;
        memory::recopy(&mut self.x2, x2)?;
        self.frozen_at.iter_mut().zip(&other.frozen_at).try_for_each(|(to, of)| memory::recopy(to, of))?;
        memory::recopy(&mut self.normals, &other.normals)?;
        memory::recopy(&mut self.areas, &other.areas)?;
        memory::recopy(&mut self.coverage, &other.coverage)?;
        memory::recopy(&mut self.gap, &other.gap)?;
        self.facet_gaps.recopy(&other.facet_gaps)?;
        memory::recopy(&mut self.slip, &other.slip)?;
        memory::recopy(&mut self.states, &other.states)?;
        memory::recopy(&mut self.pairs, &other.pairs)?;
        memory::recopy(&mut self.parents, &other.parents)
    }

    /// Refuses a history that has left the range of doubles: nothing could be measured from it, and no import takes it.
    pub(crate) fn check_finite(&self) -> Result<()> {
        // A facet's gap that is not finite has left a node's gap that is not.
        let vectors = [("gap", &self.gap), ("slip", &self.slip)];
        let vectors = vectors.map(|(name, v)| (name, v.iter().position(|v| !v.iter().all(|c| c.is_finite()))));
        let numbers = [("area", &self.areas), ("coverage", &self.coverage)];
        let numbers = numbers.map(|(name, v)| (name, v.iter().position(|v| !v.is_finite())));
        match vectors.into_iter().chain(numbers).find_map(|(name, at)| Some((name, at?))) {
            None => Ok(()),
            Some((name, node)) => {
                let text = text!("the {name} of non-mortar node {node} overflows; the positions are out of range");
                Err(Error::new(Kind::NotFinite, text))
            }
        }
    }
}
