//! What an interface remembers of t_n: configuration, weights, normals, areas, coverage, slip (docs/formulation.md 6.1).
//! It changes only on commit, rolls back exactly, and travels as flat arrays (`restart.rs`). Without friction there is no
//! slip to measure: no gaps, no slip, and weights only where they are frozen. Tied surfaces keep the gap, that of their
//! facets too (`facet_gaps.rs`), and no slip.

use super::facet_gaps::{FacetGaps, REALS_PER_FACET};
use super::options::{Options, Weights};
use super::pairs::PairRecord;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::law::Remembers;
use crate::memory::{self, Stored};
use crate::shape::{MAX_CORNERS, MAX_NODES};

/// What a history holds besides configuration, normals, areas and coverage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keeps {
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
        match (options.friction.law().remembers, options.effective_weights()) {
            (Remembers::Nothing, Weights::Current) => Keeps::Nothing,
            (Remembers::Nothing, _) => Keeps::Weights,
            (Remembers::FirstGap, _) => Keeps::Gap,
            (Remembers::Slip, _) => Keeps::Slip,
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

    /// Whether gaps of facets are kept.
    pub fn facet_gaps(self) -> bool {
        self == Keeps::Gap
    }

    /// Vectors per non-mortar node: position, normal and what else is kept.
    fn vectors(self) -> usize {
        2 + self.gaps_and_slips().iter().sum::<usize>()
    }

    /// Reals of a history of n1 + n2 nodes, so many non-mortar facets and pairs.
    pub fn reals(self, [n1, n2]: [usize; 2], facets: usize, pairs: usize) -> usize {
        let facets = if self.facet_gaps() { REALS_PER_FACET * facets } else { 0 };
        (3 * self.vectors() + 2) * n1 + 3 * n2 + facets + REALS_PER_PAIR * pairs
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
    /// nu_A(t_n), into the non-mortar body.
    pub normals: Vec<Vec3>,
    /// M_A: full nodal area, covered or not [L^2].
    pub areas: Vec<f64>,
    /// m_A(t_n): covered area [L^2].
    pub coverage: Vec<f64>,
    /// g[n_n, x_n] [L^3]; empty without friction. Tied: the part of the first gap that turns with no facet.
    pub gap: Vec<Vec3>,
    /// Tied: the part of the first gap that turns with its facet; else empty.
    pub facet_gaps: FacetGaps,
    /// Slip accumulated since the first configuration `[L]`; empty without friction, and of tied surfaces.
    pub slip: Vec<Vec3>,
    /// n(t_n), sorted by facets; none without friction, unless they are frozen.
    pub pairs: Vec<PairRecord>,
    /// Whether coverage, gap and pairs are known; if not they are 0, and made up for when the surfaces come near.
    pub integrated: bool,
}

/// A pair's weights n_AB and n_AC.
pub const REALS_PER_PAIR: usize = 2 * MAX_CORNERS * MAX_NODES;

impl History {
    /// Takes each node's coverage and, of gaps and weights of t_n, what it keeps; leaves the rest. All of it or nothing.
    pub(crate) fn fill(&mut self, pairs: &mut Vec<PairRecord>, sums: &[(f64, Vec3)]) -> Result<()> {
        let coverage = sums.iter().map(|(coverage, _)| *coverage).stored()?;
        if self.keeps.gaps_and_slips()[0] == 1 {
            self.gap = sums.iter().map(|(_, gap)| *gap).stored()?;
        }
        self.coverage = coverage;
        if self.keeps != Keeps::Nothing {
            self.pairs = std::mem::take(pairs);
        }
        self.integrated = true;
        Ok(())
    }

    /// A copy with other positions.
    pub(crate) fn moved_to(&self, x1: &[Vec3], x2: &[Vec3]) -> Result<History> {
        let History { keeps, commits, integrated, .. } = *self;
        let (normals, areas, coverage) =
            (memory::copied(&self.normals)?, memory::copied(&self.areas)?, memory::copied(&self.coverage)?);
        let (gap, slip) = (memory::copied(&self.gap)?, memory::copied(&self.slip)?);
        let facet_gaps = self.facet_gaps.copied()?;
        let (x1, x2, pairs) = (memory::copied(x1)?, memory::copied(x2)?, memory::copied(&self.pairs)?);
        Ok(History { keeps, commits, x1, x2, normals, areas, coverage, gap, facet_gaps, slip, pairs, integrated })
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
