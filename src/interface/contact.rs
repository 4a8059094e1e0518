//! The handle: it owns an interface's data and calls the stages on it.

use super::cache::Cache;
use super::compose::Feature;
use super::data::counters::Counters;
use super::data::effects::Effects;
use super::data::extent::Extent;
use super::data::history::History;
use super::data::node_data::{Owner, check_length, free_directions};
use super::data::options::{Friction, Options, Weights};
use super::data::point_friction::REALS_PER_POINT;
use super::data::points::Points;
use super::data::restart::Host;
use super::data::setup::Setup;
use super::data::surface::{NO_EQUATION, Surface};
use super::inspect::bytes;
use super::inspect::describe;
use super::linear::Linear;
use super::pairing::given::{Given, NormalsAt, Step, check_finite};
use super::pairing::hidden::Hidden;
use super::pairing::settle::Pairing;
use super::pairing::walls::backs;
use super::stages::commit::{self, Known, Settled};
use super::stages::lost::{refuse_lost_contact, refuse_passed};
use super::stages::residual::Residual;
use super::stages::spin::refuse_spin;
use super::stages::sums::NodeSums;
use super::stages::turn::refuse_turn;
use crate::error::{Error, Kind, Result, Text};
use crate::geometry::{Mat3, Vec3};
use crate::law::{Coefficient, Layer, NodeResponse};
use crate::memory::{self, Store};
use nalgebra::SVector;

/// An interface with three multipliers per non-mortar node.
pub type Interface = Contact<3>;

/// A contact interface with N multipliers per non-mortar node: three, or one along the normal without friction. One
/// thread at a time; distinct interfaces are independent.
#[derive(Debug)]
pub struct Contact<const N: usize> {
    pub(super) setup: Setup<N>,
    pub(super) step: Step,
    pub(super) rollback: Option<Before>,
    /// Memory for the history that a commit makes; `None`: it takes new one.
    spare: Option<History>,
    pub(super) cache: Cache<N>,
    pub(super) linear: Linear<N>,
    /// The last residual.
    pub(super) residual: Residual<N>,
}

impl Contact<3> {
    /// An interface whose t_n is the surfaces' reference configuration.
    ///
    /// `multiplier_equations`: per non-mortar node and component, 0-based or [`NO_EQUATION`].
    pub fn new(
        nonmortar: Surface,
        mortar: Surface,
        multiplier_equations: Vec<[i64; 3]>,
        options: Options,
    ) -> Result<Interface> {
        let mu = match options.friction.law().mu {
            Coefficient::Given => options.mu,
            Coefficient::Always(mu) => mu,
        };
        let mu = memory::filled(mu, nonmortar.len())?;
        let effects = Effects::of_three(&options, &mortar, &mu, None, false);
        Self::build(Setup::new((nonmortar, mortar), multiplier_equations, options, mu, effects)?)
    }

    /// Friction coefficient per node.
    pub fn set_friction(&mut self, mu: Vec<f64>) -> Result<()> {
        if self.setup.options.friction.law().mu != Coefficient::Given {
            let text = "mu belongs to Coulomb friction; this interface has another law";
            return Err(Error::new(Kind::InvalidValue, text));
        }
        self.setup.nodes.set_mu(mu)?;
        self.renew_effects();
        self.cache.forget();
        Ok(())
    }
}

impl Contact<3> {
    /// What follows from law, coefficients and what lies between the surfaces.
    pub(super) fn renew_effects(&mut self) {
        let Setup { options, mortar, nodes, own, layer, .. } = &self.setup;
        let slips = layer.as_ref().is_some_and(Layer::slips);
        self.setup.effects = Effects::of_three(options, mortar, &nodes.mu, own.as_ref(), slips);
    }
}

impl Contact<1> {
    /// A frictionless interface whose t_n is the surfaces' reference configuration.
    ///
    /// `multiplier_equations`: per non-mortar node, 0-based or [`NO_EQUATION`].
    pub fn frictionless(
        nonmortar: Surface,
        mortar: Surface,
        multiplier_equations: Vec<[i64; 1]>,
        options: Options,
    ) -> Result<Contact<1>> {
        let options = Options { friction: Friction::None, ..options };
        let effects = Effects::of_one(&options, &mortar);
        let mu = memory::filled(0.0, nonmortar.len())?;
        Self::build(Setup::new((nonmortar, mortar), multiplier_equations, options, mu, effects)?)
    }
}

/// What the last commit has replaced.
#[derive(Debug)]
pub(super) struct Before {
    history: History,
    hidden: Hidden,
}

/// What a commit would put in place.
#[derive(Debug)]
pub(crate) struct Next {
    step: Step,
    /// Whether the pairs are those where it begins.
    active: bool,
    /// The points that are to remember what those of the last step have answered.
    points: Option<Points>,
}

/// A step that begins.
fn begun<const N: usize>(setup: &Setup<N>, pairing: Pairing, history: History) -> Step {
    Step { history, pairing, normals: setup.options.normals, now: None, room: NormalsAt::default() }
}

/// The points of a step before which nothing has slipped, which its history is to remember with friction; without it none.
fn unslipped<const N: usize>(setup: &Setup<N>, step: &mut Step) -> Result<Points> {
    let mut points = Points::default();
    if setup.has_point_friction() {
        let count = points.count(Given { setup, step })?;
        memory::refill(&mut step.history.states, 0.0, REALS_PER_POINT * count)?;
    }
    Ok(points)
}

/// Data, and what a host sets.
impl<const N: usize> Contact<N> {
    fn build(mut setup: Setup<N>) -> Result<Contact<N>> {
        setup.nonmortar.backs = backs(&setup.nonmortar, &|_, _| true)?;
        setup.mortar.backs = backs(&setup.mortar, &|_, _| true)?;
        let mut cache = Cache::default();
        let at = (&setup.nonmortar.reference[..], &setup.mortar.reference[..]);
        let (_, active, work, _) = cache.leave();
        let known = Known { active, filter: None };
        let (surfaces, history) = (setup.surfaces(), History::empty());
        let settled = commit::settled_at(surfaces, &setup.options, Extent::Whole, work, at, known, history)?;
        let pairing = Pairing::new(&setup, settled.filter, &settled.history)?;
        let mut step = begun(&setup, pairing, settled.history);
        Given { setup: &setup, step: &step }.normals()?;
        let points = unslipped(&setup, &mut step)?;
        cache.begin(&step.history, settled.active);
        cache.settle_points(points);
        let (linear, residual) = (Linear::default(), Residual::default());
        Ok(Contact { setup, step, rollback: None, spare: None, cache, linear, residual })
    }

    /// What the stages are given.
    pub(super) fn given(&self) -> Given<'_, N> {
        Given { setup: &self.setup, step: &self.step }
    }

    /// Augmentation r_A [F/L^5] per node; `None` returns to the options'.
    pub fn set_augmentation(&mut self, r: Option<Vec<f64>>) -> Result<()> {
        self.setup.nodes.set_augmentations(r)?;
        self.cache.forget();
        Ok(())
    }

    /// Unit normals into the non-mortar body; `None` returns to the library's. Not where the host asked for normals that follow
    /// the motion.
    pub fn set_normals(&mut self, normals: Option<Vec<Vec3>>) -> Result<()> {
        let given = normals.is_some();
        let options = self.setup.options.beside_normals(given);
        let before = std::mem::replace(&mut self.setup.options, options);
        let refused = if given { self.setup.refuse(&[(Feature::HostNormals, true)]) } else { Ok(()) };
        if let Err(error) = refused.and_then(|()| self.setup.nodes.set_normals(normals)) {
            self.setup.options = before;
            return Err(error);
        }
        if options.normals != before.normals {
            self.step.normals = options.normals;
            self.step.forget_normals();
            self.linear.forget();
        }
        self.cache.forget();
        Ok(())
    }

    /// Directions in which nodes are prescribed on both sides (or against a rigid mortar side): the
    /// multiplier has no component there and the normal none either. Replaces all earlier ones.
    ///
    /// At a Dirichlet edge over a deformable mortar side do not declare it: the patch test needs that
    /// component.
    pub fn set_constraints(&mut self, directions: &[(usize, Vec3)]) -> Result<()> {
        let free = self.constrained(directions)?;
        self.constrain(free);
        Ok(())
    }

    /// What constraints leave free of each node, where every node keeps a normal; nothing is changed.
    pub(crate) fn constrained(&mut self, directions: &[(usize, Vec3)]) -> Result<Vec<Mat3>> {
        let free = free_directions(&self.setup.multiplier_equations, directions)?;
        let old = std::mem::replace(&mut self.setup.nodes.free, free);
        self.step.forget_normals();
        let normals = self.given().normals().map(|_| ());
        let free = std::mem::replace(&mut self.setup.nodes.free, old);
        self.step.forget_normals();
        normals.map(|()| free)
    }

    /// Puts in place what [`Contact::constrained`] has found.
    pub(crate) fn constrain(&mut self, free: Vec<Mat3>) {
        self.setup.nodes.free = free;
        self.step.forget_normals();
        self.cache.forget();
    }

    /// Where the multipliers of the nodes act, of a part of an interface. Facets of which no node acts here are left out, unless
    /// nodes carry others, or points decide: who carries them, and what points know, follows from what is covered farther away. Before
    /// the first step: t_n becomes the reference configuration.
    pub fn set_owners(&mut self, owners: Vec<Owner>) -> Result<()> {
        self.setup.refuse(&[
            (Feature::Elsewhere, owners.contains(&Owner::Elsewhere)),
            (Feature::Shared, owners.contains(&Owner::Shared)),
        ])?;
        self.setup.nodes.set_owners(owners)?;
        let Setup { nonmortar, nodes, options, .. } = &mut self.setup;
        let needs_others = options.effective_weak_coverage() > 0.0 || options.decides_at_points();
        nonmortar.set_idle(|a| needs_others || nodes.acts(a))?;
        self.cache.forget();
        self.linear.forget();
        if self.setup.nonmortar.idle.is_empty() {
            return Ok(());
        }
        let x1 = memory::copied(&self.setup.nonmortar.reference)?;
        let x2 = memory::copied(&self.setup.mortar.reference)?;
        self.set_previous(&x1, &x2)
    }

    /// Multipliers per non-mortar node, N.
    pub fn components(&self) -> usize {
        N
    }

    /// Multiplier equations.
    pub fn multipliers(&self) -> usize {
        self.setup.multiplier_equations.as_flattened().iter().filter(|&&e| e != NO_EQUATION).count()
    }

    /// The options.
    pub fn options(&self) -> &Options {
        &self.setup.options
    }

    /// The non-mortar and the mortar surface.
    pub fn surfaces(&self) -> (&Surface, &Surface) {
        self.setup.surfaces()
    }

    /// The committed history.
    pub fn history(&self) -> &History {
        &self.step.history
    }

    /// What has been done so far.
    pub fn counters(&self) -> Counters {
        self.cache.work.counters
    }

    /// Pairs active at the last evaluation, commit or creation.
    pub fn active_pairs(&self) -> usize {
        self.cache.work.counters.pairs_active
    }

    /// nu_A: that of the last evaluation where it follows the motion, else the host's or the committed one; normalised
    /// within the free directions.
    pub fn normal(&self, a: usize) -> Result<Vec3> {
        self.given().normal(a)
    }

    /// r_A [F/L^5]: the host's, or rhat_A / M_A.
    pub fn augmentation(&self, a: usize) -> f64 {
        self.given().augmentation(a)
    }

    /// Factor of node A's multiplier rows.
    pub fn row_scale(&self, a: usize) -> f64 {
        self.given().row_scale(a)
    }

    /// Which nodes carry others in this step: (carried node, carrier, weight), sorted.
    pub fn carriers(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        let all = self.step.pairing.carriers.iter().enumerate();
        all.flat_map(|(a, carriers)| carriers.iter().map(move |&(b, w)| (a, b, w)))
    }

    /// Slip of node A since the first configuration `[L]`, this step's included.
    pub fn slip_after(&self, a: usize, response: &NodeResponse<N>, coverage_previous: f64) -> Vec3 {
        self.given().slip_after(a, response, coverage_previous)
    }

    /// One sentence per effect: what is computed, and whether the options ask for it or the scene lets the library
    /// choose it.
    ///
    /// # Errors
    /// [`Kind::OutOfMemory`].
    pub fn effects(&self) -> Result<Text> {
        describe::effects(&self.setup)
    }

    /// Heap memory in use `[bytes]`: surfaces, histories, the filter, the search tree, the last evaluation, what is
    /// set per node.
    pub fn bytes(&self) -> usize {
        bytes::of_setup(&self.setup)
            + bytes::of_history(&self.step.history)
            + bytes::of_pairing(&self.step.pairing)
            + self.step.now.as_ref().map_or(0, bytes::of_normals)
            + bytes::of_normals(&self.step.room)
            + self.rollback.as_ref().map_or(0, |b| bytes::of_history(&b.history) + bytes::of_hidden(&b.hidden))
            + self.spare.as_ref().map_or(0, bytes::of_history)
            + bytes::of_residual(&self.residual)
            + self.cache.bytes()
            + self.linear.bytes()
    }
}

/// Steps.
impl<const N: usize> Contact<N> {
    fn put_in_place(&mut self, pairing: Pairing, history: History, active: bool) -> Before {
        self.step.forget_normals();
        let hidden = self.step.pairing.take_hidden();
        (self.step.pairing, self.step.normals) = (pairing, self.setup.options.normals);
        let history = std::mem::replace(&mut self.step.history, history);
        self.setup.nonmortar.layer = self.layer_reach(&self.step.history.states);
        self.cache.begin(&self.step.history, active);
        self.linear.forget();
        Before { history, hidden }
    }

    /// Takes (x1, x2) as the configuration of t_n, with nothing slipped yet, instead of the reference.
    pub fn set_previous(&mut self, x1: &[Vec3], x2: &[Vec3]) -> Result<()> {
        self.given().check_positions(x1, x2)?;
        let (surfaces, options) = (self.setup.surfaces(), &self.setup.options);
        let (_, active, work, _) = self.cache.leave();
        let known = Known { active, filter: None };
        let new = commit::settled_at(surfaces, options, Extent::Whole, work, (x1, x2), known, History::empty())?;
        self.take_unslipped(new)
    }

    /// Takes (x1, x2) as t_n, after so many commits, with this slip since the first configuration `[L]` at every node: what
    /// handles with other parts of the interface had committed; what a law of one's own remembers is 0. Weights of the reference and first gaps stay those that this
    /// one was created with. No commit can then be undone.
    pub fn set_committed(&mut self, x1: &[Vec3], x2: &[Vec3], slip: &[Vec3], commits: i64) -> Result<()> {
        self.given().check_positions(x1, x2)?;
        self.setup.refuse(&[(Feature::NodeHistory, true), (Feature::Friction, N == 3)])?;
        check_length("slip", slip.len(), self.setup.nonmortar.len())?;
        check_finite("slip", slip)?;
        if commits < 0 {
            return Err(Error::new(Kind::InvalidValue, text!("commits is {commits}; it must not be negative")));
        }
        let (surfaces, options) = (self.setup.surfaces(), &self.setup.options);
        let (_, active, work, _) = self.cache.leave();
        let mut new = if options.effective_weights() == Weights::Reference {
            commit::with_the_same_weights(
                surfaces,
                &self.step.history,
                (x1, x2),
                &mut work.room.sums,
                History::empty(),
            )?
        } else {
            let known = Known { active, filter: None };
            commit::settled_at(surfaces, options, Extent::Whole, work, (x1, x2), known, History::empty())?
        };
        new.history.commits = commits;
        let kept = new.history.slip.len();
        new.history.slip.copy_from_slice(&slip[..kept]);
        self.take_unslipped(new)
    }

    /// Begins a step at this new t_n, of which a law and points remember nothing yet. No commit can then be undone.
    fn take_unslipped(&mut self, mut new: Settled) -> Result<()> {
        memory::refill(&mut new.history.states, 0.0, self.step.history.states.len())?;
        new.history.check_finite()?;
        let mut next = self.begin(Pairing::new(&self.setup, new.filter, &new.history)?, new.history);
        let points = unslipped(&self.setup, &mut next)?;
        self.put_in_place(next.pairing, next.history, new.active);
        self.cache.settle_points(points);
        self.rollback = None;
        Ok(())
    }

    /// Accepts a converged step: (x1, x2) becomes t_n.
    pub fn commit(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
    ) -> Result<()> {
        let next = self.next(x1, x2, lambda, sums)?;
        self.accept(next);
        Ok(())
    }

    /// Puts in place what [`Contact::next`] has found; nothing is refused.
    pub(crate) fn accept(&mut self, next: Next) {
        let old = self.put_in_place(next.step.pairing, next.step.history, next.active);
        if let Some(points) = next.points {
            self.cache.settle_points(points);
        }
        self.spare = self.rollback.replace(old).map(|before| before.history);
    }

    /// Whether [`Contact::commit`] would accept the step: its refusals, and nothing changes.
    pub fn check_commit(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
    ) -> Result<()> {
        self.spare = Some(self.next(x1, x2, lambda, sums)?.step.history);
        Ok(())
    }

    /// The step that follows a converged one, to be accepted where all interfaces of a skin have found theirs.
    pub(crate) fn next(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
    ) -> Result<Next> {
        if self.setup.layer.is_none() {
            return self.next_at(x1, x2, lambda, sums);
        }
        self.cache.respond(&self.setup, &mut self.step, (x1, x2), lambda, sums)?;
        let reach = self.layer_reach(&self.cache.answers().responses.own.states);
        let before = std::mem::replace(&mut self.setup.nonmortar.layer, reach);
        let next = self.next_at(x1, x2, lambda, sums);
        self.setup.nonmortar.layer = before;
        next
    }

    #[inline(never)] // for a commit and its check
    fn next_at(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        sums: Option<&[NodeSums]>,
    ) -> Result<Next> {
        let (extent, shared) = (Extent::of(sums), sums.is_some());
        if self.step.normals != self.setup.options.normals {
            let text = "commit of a step that was solved with the normals of its start alone: with STICKSLIP_NORMALS_CURRENT these are for the first phase; call stickslip_interface_use_normals(..., STICKSLIP_NORMALS_CURRENT) and solve on";
            return Err(Error::new(Kind::InvalidValue, text));
        }
        self.cache.respond(&self.setup, &mut self.step, (x1, x2), lambda, sums)?;
        let given = Given { setup: &self.setup, step: &self.step };
        refuse_turn(given, (x1, x2), shared, &mut self.cache.work.room.vectors)?;
        let answers = self.cache.answers();
        refuse_spin(given, x1, (&answers.sums, &answers.responses.nodes))?;
        refuse_passed(given, (x1, x2))?;
        let (surfaces, options, history) = (self.setup.surfaces(), &self.setup.options, &self.step.history);
        let moved = self.spare.take().unwrap_or_else(History::empty);
        let (is_known, active, work, answers) = self.cache.leave();
        let responses = &answers.responses.nodes;
        let mut new = if options.effective_weights() == Weights::Reference {
            commit::with_the_same_weights(surfaces, history, (x1, x2), &mut work.room.sums, moved)?
        } else {
            let filter = self.step.pairing.filter.as_ref().filter(|_| is_known);
            let new = commit::settled_at(surfaces, options, extent, work, (x1, x2), Known { active, filter }, moved)?;
            let dropped = (&work.room.dropped[..], &history.areas[..]);
            refuse_lost_contact(&self.setup, dropped, &new, (x1, x2), responses)?;
            new
        };
        new.history.commits = history.commits.saturating_add(1); // an imported history may hold any number
        new.history.slip.clear();
        if self.setup.effects.law.slips {
            let slip = |a: usize| given.slip_after(a, &responses[a], answers.sums[a].coverage_previous);
            new.history.slip.store_all((0..responses.len()).map(slip))?;
        } else {
            memory::recopy(&mut new.history.slip, &history.slip)?;
        }
        memory::recopy(&mut new.history.states, &answers.responses.own.states)?;
        new.history.check_finite()?;
        let remembers = self.setup.has_point_friction() && options.effective_weights() != Weights::Reference;
        if remembers {
            new.history.states.clear();
        }
        let mut next = self.begin(Pairing::new(&self.setup, new.filter, &new.history)?, new.history);
        if !remembers {
            return Ok(Next { step: next, active: new.active, points: None });
        }
        let (points, x1) = (&self.cache.answers().responses.points, &self.step.history.x1);
        let mut anew = Points::default();
        next.history.states = anew.remember(Given { setup: &self.setup, step: &next }, lambda, (points, x1))?;
        Ok(Next { step: next, active: new.active, points: Some(anew) })
    }

    /// A step that begins, to be looked at before it is put in place.
    fn begin(&self, pairing: Pairing, history: History) -> Step {
        begun(&self.setup, pairing, history)
    }

    /// Undoes the last commit exactly.
    ///
    /// # Errors
    /// [`Kind::NothingToRollBack`] when there is none; only one commit can be undone.
    pub fn roll_back(&mut self) -> Result<()> {
        let pairing = self.last()?;
        self.go_back(pairing);
        Ok(())
    }

    /// The pairs of the step before the last commit, to go back to where all interfaces of a skin have found theirs.
    pub(crate) fn last(&mut self) -> Result<Pairing> {
        let Some(Before { history, .. }) = &self.rollback else {
            let text = "no commit can be undone: none was made since creation, import or the last rollback";
            return Err(Error::new(Kind::NothingToRollBack, text));
        };
        let reach = self.layer_reach(&history.states);
        let before = std::mem::replace(&mut self.setup.nonmortar.layer, reach);
        let filter = commit::filter_of(self.setup.surfaces(), &self.setup.options, history);
        let pairing = filter.and_then(|filter| Pairing::new(&self.setup, filter, history));
        self.setup.nonmortar.layer = before;
        pairing
    }

    /// Goes back to what [`Contact::last`] has found; nothing is refused.
    pub(crate) fn go_back(&mut self, mut pairing: Pairing) {
        if let Some(Before { history, hidden }) = self.rollback.take() {
            pairing.put_hidden(hidden);
            self.put_in_place(pairing, history, false);
        }
    }

    fn host(&self) -> Host<'_> {
        Host::of(&self.setup, self.step.history.states.len())
    }

    /// The history as flat arrays, for a restart.
    pub fn export_history(&mut self) -> Result<(Vec<i64>, Vec<f64>)> {
        self.cache.complete(&self.setup, &mut self.step)?;
        self.step.history.export(&self.host())
    }

    /// Lengths of what [`Contact::export_history`] gives.
    pub fn history_size(&mut self) -> Result<(usize, usize)> {
        self.cache.complete(&self.setup, &mut self.step)?;
        Ok(self.step.history.flat_size(&self.host()))
    }

    /// Replaces the history by an imported one, after which no commit can be undone.
    pub fn import_history(&mut self, integers: &[i64], reals: &[f64]) -> Result<()> {
        let history = History::import((integers, reals), &self.host())?;
        let reach = self.layer_reach(&history.states);
        let before = std::mem::replace(&mut self.setup.nonmortar.layer, reach);
        let filter = commit::filter_again(self.setup.surfaces(), &self.setup.options, &history, &mut self.cache.work);
        self.setup.nonmortar.layer = before;
        let filter = filter?;
        let next = self.begin(Pairing::new(&self.setup, filter, &history)?, history);
        if self.setup.has_point_friction() {
            Points::default().check_memory(Given { setup: &self.setup, step: &next })?;
        }
        self.put_in_place(next.pairing, next.history, false);
        self.rollback = None;
        Ok(())
    }
}
