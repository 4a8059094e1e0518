//! What evaluations leave for the next one at the same positions: the pairs of now, the nodes' sums, the law's answers, the
//! search tree. A host asks for residual and tangent of one point, and both need the same. Its memory serves all evaluations:
//! what does not hold any more is room.

use super::compose::Feature;
use super::data::active::Active;
use super::data::conserving::Conserving;
use super::data::extent::{Extent, Scope};
use super::data::history::History;
use super::data::node_data::check_length;
use super::data::options::{Scheme, Weights};
use super::data::pairs::{PairRecord, ParentRecord, Weighted};
use super::data::points::Points;
use super::data::setup::Setup;
use super::data::surface::{Surface, are_same};
use super::inspect::bytes;
use super::pairing::given::{Given, Step, check_finite};
use super::pairing::work::Work;
use super::stages::acting::acting;
use super::stages::apart::stays_apart;
use super::stages::commit;
use super::stages::conserving;
use super::stages::normals::follow;
use super::stages::respond::{Responses, respond};
use super::stages::shares::refuse_hybrid;
use super::stages::sums::{self, NodeSums};
use super::tangent::gaps::{GapRoom, gaps};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::memory::{self, Store};
use nalgebra::SVector;

/// The pairs at the last positions, of weights of now.
#[derive(Debug, Default)]
struct Kept {
    active: Active,
    /// What the evaluation was about, and whether it found the surfaces apart; then there are no pairs. `None`: nothing is
    /// kept.
    scope: Option<Scope>,
    /// What the nodes assemble over the pairs.
    sums: Vec<NodeSums>,
    /// What for; `None`: it is not what they assemble here.
    sums_of: Option<Extent>,
}

/// The law's answers at a point.
#[derive(Debug)]
pub struct Answers<const N: usize> {
    x: [Vec<Vec3>; 2],
    lambda: Vec<SVector<f64, N>>,
    /// Whether the sums are the host's, who may give others.
    shared: bool,
    /// Whether there are any.
    are_known: bool,
    /// Of every node.
    pub sums: Vec<NodeSums>,
    /// To these sums.
    pub responses: Responses<N>,
}

impl<const N: usize> Default for Answers<N> {
    fn default() -> Self {
        let (x, lambda, sums) = (Default::default(), Vec::new(), Vec::new());
        Answers { x, lambda, shared: false, are_known: false, sums, responses: Responses::default() }
    }
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
    kept: Kept,
    answers: Answers<N>,
    /// With conserving weights: what is known of the step, and where it is found. That is large: there is none before it is needed.
    conserving: Conserving,
    gaps: Vec<GapRoom<N>>,
    /// Whether its pairs half way are of this step.
    is_half_way: bool,
    /// What searches and integrations work with.
    pub work: Work,
}

impl<const N: usize> Default for Cache<N> {
    fn default() -> Self {
        let (kept, answers, conserving) = (Kept::default(), Answers::default(), Conserving::default());
        let (gaps, work) = (Vec::new(), Work::default());
        Cache { kept, answers, conserving, gaps, is_half_way: false, work }
    }
}

impl<const N: usize> Cache<N> {
    /// Drops what must not outlive what it was found with.
    pub fn forget(&mut self) {
        (self.kept.scope, self.kept.sums_of, self.answers.are_known) = (None, None, false);
        self.is_half_way = false;
        self.answers.responses.points.is_settled = false;
    }

    /// Takes the points that the step which begins has been found to have.
    pub fn settle_points(&mut self, points: Points) {
        self.answers.responses.points = points;
    }

    /// A step begins. `active`: whether the pairs are those where the last one ended, for the next evaluation may well be
    /// there.
    pub fn begin(&mut self, history: &History, active: bool) {
        self.forget();
        self.kept.scope = active.then_some(Scope { extent: Extent::Part, apart: false });
        self.count_pairs(history);
    }

    /// The pairs that were found at the last positions; `None`: the weights are frozen, or there are none yet.
    pub fn active(&self) -> Option<&Active> {
        self.kept.scope.map(|_| &self.kept.active)
    }

    /// The same with what searches work with; `None` also where the surfaces are apart and nothing was looked at.
    pub fn looked_at(&mut self) -> (Option<&Active>, &mut Work) {
        (self.kept.scope.filter(|scope| !scope.apart).map(|_| &self.kept.active), &mut self.work)
    }

    /// What a commit works with: whether the pairs are those at the last positions, their memory, which is the commit's own
    /// from here on, and the law's answers.
    pub fn leave(&mut self) -> (bool, &mut Active, &mut Work, &Answers<N>) {
        (self.kept.scope.take().is_some(), &mut self.kept.active, &mut self.work, &self.answers)
    }

    /// The pairs whose weights act now.
    pub fn pairs<'a>(&'a self, history: &'a History) -> &'a [PairRecord] {
        self.active().map_or(&history.pairs, |k| &k.pairs)
    }

    /// The pairs whose weights act between these surfaces.
    pub fn weighted<'a>(&'a self, surfaces: (&Surface, &Surface), history: &'a History) -> Weighted<'a> {
        self.active().map_or(history.weighted(surfaces), |k| k.weighted(surfaces))
    }

    /// Those of parents.
    pub fn parents<'a>(&'a self, history: &'a History) -> &'a [ParentRecord] {
        self.active().map_or(&history.parents, |k| &k.parents)
    }

    /// The same, with the law's answers and what stages work with.
    pub fn acting<'a>(
        &'a mut self,
        surfaces: (&Surface, &Surface),
        history: &'a History,
    ) -> (Weighted<'a>, &'a Answers<N>, &'a mut Work) {
        let active = self.kept.scope.map(|_| &self.kept.active);
        let pairs = active.map_or(history.weighted(surfaces), |k| k.weighted(surfaces));
        (pairs, &self.answers, &mut self.work)
    }

    /// What an evaluation of this extent leaves out at the last positions.
    pub fn scope(&self, extent: Extent) -> Scope {
        Scope { extent, apart: self.is_apart() }
    }

    /// Whether the surfaces were found apart at the last positions.
    pub fn is_apart(&self) -> bool {
        self.kept.scope.is_some_and(|scope| scope.apart)
    }

    /// The law's answers at the last point.
    pub fn answers(&self) -> &Answers<N> {
        assert!(self.answers.are_known, "asked for after respond()");
        &self.answers
    }

    fn count_pairs(&mut self, history: &History) {
        self.work.counters.pairs_active = match self.parents(history).len() {
            0 => self.pairs(history).len(),
            parents => parents,
        };
    }

    /// Makes up for weights of t_n that a commit has left out because the surfaces were apart. Frozen weights never are.
    pub fn complete(&mut self, setup: &Setup<N>, step: &mut Step) -> Result<()> {
        if setup.options.effective_weights() != Weights::Current || step.history.integrated {
            return Ok(());
        }
        let Step { history, pairing, .. } = step;
        match &mut pairing.filter {
            Some(filter) => commit::complete(setup.surfaces(), &setup.options, (history, filter), &mut self.work),
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
            self.work.counters.pairs_reused += step.history.weighted(setup.surfaces()).len() as i64;
            self.count_pairs(&step.history);
            return Ok(());
        }
        follow(setup, step, x1)?;
        let kept = self.kept.scope.filter(|_| self.kept.active.is_at(x1, x2));
        let serves = kept.is_some_and(|k| k.extent == extent || (k.extent == Extent::Whole && !k.apart));
        if !serves {
            let apart = extent == Extent::Whole && stays_apart(Given { setup, step }, x1, x2)?;
            self.work.counters.evaluations_apart += i64::from(apart);
            if apart {
                (self.kept.scope, self.kept.sums_of) = (None, None);
                self.kept.active.begin(x1, x2)?;
            } else if kept.is_none_or(|k| k.apart) {
                self.complete(setup, step)?;
                (self.kept.scope, self.kept.sums_of) = (None, None);
                let filter = step.pairing.filter.as_ref().expect("current weights have one");
                let (work, active) = (&mut self.work, &mut self.kept.active);
                acting(setup.surfaces(), &setup.options, filter, work, (x1, x2), active)?;
            }
            self.kept.scope = Some(Scope { extent, apart });
        }
        if setup.options.conserves() {
            self.integrate_half_way(setup, step, (x1, x2))?;
        }
        self.count_pairs(&step.history);
        Ok(())
    }

    /// The same with conserving weights half way between t_n and (x1, x2).
    fn integrate_half_way(&mut self, setup: &Setup<N>, step: &Step, (x1, x2): (&[Vec3], &[Vec3])) -> Result<()> {
        let known = &mut self.conserving;
        if self.kept.scope.is_some_and(|scope| scope.apart) {
            self.is_half_way = false;
            return known.clear(x1.len());
        }
        let (mut m1, mut m2) = (Vec::new(), Vec::new());
        conserving::mean_places(&step.history.x1, x1, &mut m1)?;
        conserving::mean_places(&step.history.x2, x2, &mut m2)?;
        if self.is_half_way && known.mean.is_at(&m1, &m2) {
            return Ok(());
        }
        self.is_half_way = false;
        let filter = step.pairing.filter.as_ref().expect("current weights have one");
        acting(setup.surfaces(), &setup.options, filter, &mut self.work, (&m1, &m2), &mut known.mean)?;
        self.is_half_way = true;
        Ok(())
    }

    /// With conserving weights: the normals half way, along which the answers are.
    pub fn turn_half_way(&self, setup: &Setup<N>, step: &mut Step) -> Result<()> {
        if self.is_half_way { follow(setup, step, &self.conserving.mean.x1) } else { Ok(()) }
    }

    /// With conserving weights: the gaps at x and half way, what the nodes do, and in `sums` what the law is asked with. The normals are
    /// those half way from here on.
    fn conserve(&mut self, setup: &Setup<N>, step: &mut Step, x: (&[Vec3], &[Vec3])) -> Result<()> {
        if self.is_apart() {
            return Ok(());
        }
        if self.gaps.is_empty() {
            self.gaps.store(GapRoom::default())?;
        }
        let (known, room) = (&mut self.conserving, &mut self.gaps[0]);
        let mut at = [std::mem::take(&mut known.gaps[0]), std::mem::take(&mut known.gaps[1])];
        gaps(Given { setup, step }, (&self.kept.active, &self.kept.sums), room, &mut at[0])?;
        follow(setup, step, &known.mean.x1)?;
        let (given, mean) = (Given { setup, step }, (&known.mean.x1[..], &known.mean.x2[..]));
        sums::sums(given, Some(&known.mean), false, mean, &mut self.answers.sums)?;
        gaps(given, (&known.mean, &self.answers.sums), room, &mut at[1])?;
        known.gaps = at;
        conserving::settle(given, x, known)?;
        conserving::sums(known, &mut self.answers.sums)
    }

    /// What is known of the step where [`Cache::respond`] was called last, with conserving weights.
    pub fn conserving(&self) -> &Conserving {
        &self.conserving
    }

    /// Stage 1, assembled: every node's gaps and coverage at (x1, x2).
    pub fn sums(
        &mut self,
        setup: &Setup<N>,
        step: &mut Step,
        x: (&[Vec3], &[Vec3]),
        extent: Extent,
    ) -> Result<&[NodeSums]> {
        self.arrive(setup, step, x, extent)?;
        self.find_sums(Given { setup, step }, x, extent)?;
        Ok(&self.kept.sums)
    }

    /// What an evaluation with this handle's own sums begins with: finds the pairs, and counts.
    fn arrive(&mut self, setup: &Setup<N>, step: &mut Step, x: (&[Vec3], &[Vec3]), extent: Extent) -> Result<()> {
        Given { setup, step }.check_positions(x.0, x.1)?;
        self.integrate(setup, step, x, extent)?;
        if !self.is_apart() && asks_for_slip(setup, extent) {
            self.work.counters.nodes_slipping += setup.nonmortar.len() as i64;
        }
        Ok(())
    }

    /// Puts the sums over the pairs that were found in place.
    fn find_sums(&mut self, given: Given<N>, x: (&[Vec3], &[Vec3]), extent: Extent) -> Result<()> {
        let Kept { active, scope, sums, sums_of } = &mut self.kept;
        let active = scope.map(|_| &*active);
        if scope.is_some_and(|scope| scope.apart) {
            *sums_of = None;
            return memory::refill(sums, NodeSums::default(), given.nodes());
        }
        if active.is_some() && *sums_of == Some(extent) {
            return Ok(());
        }
        *sums_of = None;
        sums::sums(given, active, asks_for_slip(given.setup, extent), x, sums)?;
        *sums_of = Some(extent);
        Ok(())
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
        match shared {
            Some(sums) => {
                Given { setup, step }.check_positions(x.0, x.1)?;
                check_length("sums", sums.len(), nodes)?;
                setup.refuse(&[(Feature::Sums, true)])?;
                self.integrate(setup, step, x, extent)?;
                if matches!(setup.options.scheme, Scheme::Hybrid(_)) {
                    let given = Given { setup, step };
                    self.find_sums(given, x, extent)?;
                    let history = given.history().weighted(setup.surfaces());
                    let pairs = [self.weighted(setup.surfaces(), given.history()), history];
                    refuse_hybrid(given, pairs, &self.kept.sums, sums)?;
                }
                self.answers.are_known = false;
                memory::recopy(&mut self.answers.sums, sums)?;
            }
            None => {
                self.arrive(setup, step, x, extent)?;
                if self.answers.are_known && !self.answers.shared && self.answers.is_at(x, lambda) {
                    return self.turn_half_way(setup, step);
                }
                self.find_sums(Given { setup, step }, x, extent)?;
                self.answers.are_known = false;
                memory::recopy(&mut self.answers.sums, &self.kept.sums)?;
                if setup.options.conserves() {
                    self.conserve(setup, step, x)?;
                }
            }
        }
        let scope = self.scope(extent);
        let active = self.kept.scope.map(|_| &self.kept.active);
        let answers = &mut self.answers;
        respond((Given { setup, step }, active), lambda, &answers.sums, scope, &mut answers.responses)?;
        if self.is_half_way {
            conserving::tell(&self.conserving, &mut answers.responses.nodes);
        }
        let counts = answers.responses.counts;
        self.work.counters.nodes_evaluated += counts.total() - counts.left_out;
        self.work.counters.nodes = counts;
        memory::recopy(&mut answers.x[0], x.0)?;
        memory::recopy(&mut answers.x[1], x.1)?;
        memory::recopy(&mut answers.lambda, lambda)?;
        (answers.shared, answers.are_known) = (shared.is_some(), true);
        Ok(())
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        let kept = bytes::of_active(&self.kept.active) + bytes::heap(&self.kept.sums);
        let a = &self.answers;
        let given = a.x.iter().map(bytes::heap).sum::<usize>() + bytes::heap(&a.lambda) + bytes::heap(&a.sums);
        let of_law = bytes::heap(&a.responses.nodes)
            + bytes::heap(&a.responses.carried)
            + a.responses.own.bytes()
            + a.responses.points.bytes();
        let answers = given + of_law;
        let conserving = bytes::of_active(&self.conserving.mean) + self.conserving.bytes();
        kept + answers + conserving + bytes::of_work(&self.work)
    }
}
