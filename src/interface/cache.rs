//! What evaluations leave for the next one at the same positions: the pairs of now, the nodes' sums, the law's answers, the
//! search tree. A host asks for residual and tangent of one point, and both need the same.

use super::data::active::Active;
use super::data::counters::Counters;
use super::data::extent::{Extent, Scope};
use super::data::history::History;
use super::data::node_data::check_length;
use super::data::options::Weights;
use super::data::pairs::PairRecord;
use super::data::setup::Setup;
use super::data::surface::are_same;
use super::inspect::bytes;
use super::pairing::candidates::KeptTree;
use super::pairing::filter::Filter;
use super::pairing::given::{Given, Step, check_finite};
use super::stages::acting::acting;
use super::stages::apart::stays_apart;
use super::stages::carried::refuse_sums;
use super::stages::commit;
use super::stages::integrate::segments;
use super::stages::normals::follow;
use super::stages::respond::{Responses, respond};
use super::stages::sums::{self, NodeSums};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::memory;
use nalgebra::SVector;

/// The pairs at the last positions, of weights of now.
#[derive(Debug)]
struct Kept {
    active: Active,
    /// What the evaluation was about, and whether it found the surfaces apart; then there are no pairs.
    scope: Scope,
    /// What the nodes assemble over the pairs here, once it was asked for, and for what.
    sums: Option<(Extent, Vec<NodeSums>)>,
}

/// The law's answers at a point.
#[derive(Debug)]
pub struct Answers<const N: usize> {
    x: [Vec<Vec3>; 2],
    lambda: Vec<SVector<f64, N>>,
    /// Whether the sums are the host's, who may give others.
    shared: bool,
    /// Of every node.
    pub sums: Vec<NodeSums>,
    /// To these sums.
    pub responses: Responses<N>,
}

impl<const N: usize> Answers<N> {
    fn is_at(&self, x: (&[Vec3], &[Vec3]), lambda: &[SVector<f64, N>]) -> bool {
        are_same(&self.x[0], x.0) && are_same(&self.x[1], x.1) && are_same(&self.lambda, lambda)
    }
}

/// Whether sums are to have what slip is measured from. The nodes that a handle shares may slip by what another one knows
/// of their friction.
fn asks_for_slip<const N: usize>(setup: &Setup<N>, extent: Extent) -> bool {
    setup.effects.law.slips || extent == Extent::Part
}

/// What evaluations leave.
#[derive(Debug)]
pub struct Cache<const N: usize> {
    kept: Option<Kept>,
    answers: Option<Answers<N>>,
    tree: KeptTree,
    /// What has been done so far.
    pub counters: Counters,
}

impl<const N: usize> Default for Cache<N> {
    fn default() -> Self {
        Cache { kept: None, answers: None, tree: KeptTree::default(), counters: Counters::default() }
    }
}

impl<const N: usize> Cache<N> {
    /// What searches and integrations work with.
    pub fn work(&mut self) -> (&mut Counters, &mut KeptTree) {
        (&mut self.counters, &mut self.tree)
    }

    /// Drops what must not outlive what it was found with.
    pub fn forget(&mut self) {
        (self.kept, self.answers) = (None, None);
    }

    /// A step begins. `active`: the pairs where the last one ended, for the next evaluation may well be there.
    pub fn begin(&mut self, history: &History, active: Option<Active>) {
        self.forget();
        let scope = Scope { extent: Extent::Part, apart: false };
        self.kept = active.map(|active| Kept { active, scope, sums: None });
        self.count_pairs(history);
    }

    /// The pairs that were found at the last positions; `None`: the weights are frozen, or there are none yet.
    pub fn active(&self) -> Option<&Active> {
        self.kept.as_ref().map(|k| &k.active)
    }

    /// The same with what searches work with; `None` also where the surfaces are apart and nothing was looked at.
    pub fn looked_at(&mut self) -> (Option<&Active>, &mut Counters, &mut KeptTree) {
        let active = self.kept.as_ref().filter(|k| !k.scope.apart).map(|k| &k.active);
        (active, &mut self.counters, &mut self.tree)
    }

    /// The pairs whose weights act now.
    pub fn pairs<'a>(&'a self, history: &'a History) -> &'a [PairRecord] {
        self.active().map_or(&history.pairs, |k| &k.pairs)
    }

    /// What an evaluation of this extent leaves out at the last positions.
    pub fn scope(&self, extent: Extent) -> Scope {
        Scope { extent, apart: self.is_apart() }
    }

    /// Whether the surfaces were found apart at the last positions.
    pub fn is_apart(&self) -> bool {
        self.kept.as_ref().is_some_and(|k| k.scope.apart)
    }

    /// The law's answers at the last point.
    pub fn answers(&self) -> &Answers<N> {
        self.answers.as_ref().expect("asked for after respond()")
    }

    fn count_pairs(&mut self, history: &History) {
        self.counters.pairs_active = self.pairs(history).len();
    }

    /// Makes up for weights of t_n that a commit has left out because the surfaces were apart. Frozen weights never are.
    pub fn complete(&mut self, setup: &Setup<N>, step: &mut Step) -> Result<()> {
        if setup.options.effective_weights() != Weights::Current || step.history.integrated {
            return Ok(());
        }
        let Step { history, pairing, .. } = step;
        match &pairing.filter {
            Some(filter) => commit::complete(setup.surfaces(), &setup.options, (history, filter), self.work()),
            None => Ok(()),
        }
    }

    /// Stage 1: finds the pairs at (x1, x2), as an evaluation of this extent needs them. With frozen weights there is
    /// nothing to do, nor, but for a comparison, where the surfaces are apart.
    pub fn integrate(
        &mut self,
        setup: &Setup<N>,
        step: &mut Step,
        (x1, x2): (&[Vec3], &[Vec3]),
        extent: Extent,
    ) -> Result<()> {
        if setup.options.effective_weights() != Weights::Current {
            self.counters.pairs_reused += step.history.pairs.len() as i64;
            self.count_pairs(&step.history);
            return Ok(());
        }
        follow(setup, step, x1)?;
        let kept = self.kept.as_ref().filter(|k| k.active.is_at(x1, x2)).map(|k| k.scope);
        let serves = kept.is_some_and(|k| k.extent == extent || (k.extent == Extent::Whole && !k.apart));
        if !serves {
            let apart = extent == Extent::Whole && stays_apart(Given { setup, step }, x1, x2)?;
            self.counters.evaluations_apart += i64::from(apart);
            if apart {
                self.kept = Some(Kept { active: Active::none(x1, x2)?, scope: Scope { extent, apart }, sums: None });
            } else if kept.is_none_or(|k| k.apart) {
                self.complete(setup, step)?;
                let filter = step.pairing.filter.as_ref().expect("current weights have one");
                let active = acting(setup.surfaces(), &setup.options, filter, self.work(), (x1, x2))?;
                self.kept = Some(Kept { active, scope: Scope { extent, apart }, sums: None });
            }
            if let Some(k) = &mut self.kept {
                k.scope.extent = extent;
            }
        }
        self.count_pairs(&step.history);
        Ok(())
    }

    /// Makes up for overlaps that a commit did not keep.
    pub fn find_segments(&mut self, setup: &Setup<N>, step: &Step) -> Result<()> {
        let Some(k) = self.kept.as_mut().filter(|k| k.active.segments.len() < k.active.pairs.len()) else {
            return Ok(());
        };
        if let Some(filter @ Filter::Facets(_)) = &step.pairing.filter {
            k.active.segments = segments(&setup.mortar, &setup.options, filter, &k.active)?;
        }
        Ok(())
    }

    /// Stage 1, assembled: every node's gaps and coverage at (x1, x2).
    pub fn sums(
        &mut self,
        setup: &Setup<N>,
        step: &mut Step,
        x: (&[Vec3], &[Vec3]),
        extent: Extent,
    ) -> Result<Vec<NodeSums>> {
        self.arrive(setup, step, x, extent)?;
        self.sums_here(Given { setup, step }, x, extent)
    }

    /// What an evaluation with this handle's own sums begins with: finds the pairs, and counts.
    fn arrive(&mut self, setup: &Setup<N>, step: &mut Step, x: (&[Vec3], &[Vec3]), extent: Extent) -> Result<()> {
        Given { setup, step }.check_positions(x.0, x.1)?;
        self.integrate(setup, step, x, extent)?;
        if !self.is_apart() && asks_for_slip(setup, extent) {
            self.counters.nodes_slipping += setup.nonmortar.len() as i64;
        }
        Ok(())
    }

    /// The sums over the pairs that were found.
    fn sums_here(&mut self, given: Given<N>, x: (&[Vec3], &[Vec3]), extent: Extent) -> Result<Vec<NodeSums>> {
        if self.is_apart() {
            return memory::filled(NodeSums::default(), given.nodes());
        }
        if let Some((of, sums)) = self.kept.as_ref().and_then(|k| k.sums.as_ref())
            && *of == extent
        {
            return memory::copied(sums);
        }
        let sums = sums::sums(given, self.active(), asks_for_slip(given.setup, extent), x)?;
        if let Some(k) = &mut self.kept {
            k.sums = Some((extent, memory::copied(&sums)?));
        }
        Ok(sums)
    }

    /// Stages 1 and 2 at (x1, x2, lambda): leaves [`Cache::answers`]. `shared`: the sums of all handles, in place of this
    /// one's own.
    pub fn respond(
        &mut self,
        setup: &Setup<N>,
        step: &mut Step,
        x: (&[Vec3], &[Vec3]),
        lambda: &[SVector<f64, N>],
        shared: Option<&[NodeSums]>,
    ) -> Result<()> {
        let nodes = setup.nonmortar.len();
        check_length("lambda", lambda.len(), nodes)?;
        check_finite("lambda", lambda)?;
        let extent = Extent::of(shared);
        let sums = match shared {
            Some(sums) => {
                Given { setup, step }.check_positions(x.0, x.1)?;
                check_length("sums", sums.len(), nodes)?;
                refuse_sums(&setup.options)?;
                self.integrate(setup, step, x, extent)?;
                memory::copied(sums)?
            }
            None => {
                self.arrive(setup, step, x, extent)?;
                if self.answers.as_ref().is_some_and(|a| !a.shared && a.is_at(x, lambda)) {
                    return Ok(());
                }
                self.sums_here(Given { setup, step }, x, extent)?
            }
        };
        self.answers = None;
        let responses = respond(Given { setup, step }, lambda, &sums, self.scope(extent))?;
        self.counters.nodes_evaluated += responses.counts.total() - responses.counts.left_out;
        self.counters.nodes = responses.counts;
        let (x, lambda) = ([memory::copied(x.0)?, memory::copied(x.1)?], memory::copied(lambda)?);
        self.answers = Some(Answers { x, lambda, shared: shared.is_some(), sums, responses });
        Ok(())
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        let sums = |k: &Kept| k.sums.as_ref().map_or(0, |(_, sums)| bytes::heap(sums));
        let kept = self.kept.as_ref().map_or(0, |k| bytes::of_active(&k.active) + sums(k));
        let answers = self.answers.as_ref().map_or(0, |a| {
            let given = a.x.iter().map(bytes::heap).sum::<usize>() + bytes::heap(&a.lambda) + bytes::heap(&a.sums);
            given + bytes::heap(&a.responses.nodes) + bytes::heap(&a.responses.carried)
        });
        kept + answers + bytes::of_tree(&self.tree)
    }
}
