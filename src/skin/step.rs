//! The skin's handle: its pieces are asked one after the other, and made anew at a commit where what may touch has changed.

use super::missed::are_in_each_other;
use super::near::{Near, Reach, near};
use super::piece::{Held, Rules};
use super::pieces::{Wanted, has_all, pieces};
use super::roles::{Role, Sides, sides};
use super::table::{Between, Table};
use super::whole::{Given, Whole};
use crate::error::{Error, Kind, Result, Text};
use crate::geometry::Vec3;
use crate::interface::{Friction, MortarSide, NO_EQUATION, Options, free_directions};
use crate::memory::{self, Store, Stored};

/// What has happened to a skin since it was created.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counts {
    /// Interfaces that were made, the first ones among them.
    pub made: i64,
    /// Facets in contact that exchanged their side.
    pub exchanged: i64,
    /// Steps that were refused since facets met that no interface had as a pair.
    pub missed: i64,
}

/// Where a step begins.
#[derive(Debug, Default)]
pub(super) struct Start {
    /// Positions of the host's nodes.
    pub x: Vec<Vec3>,
    pub commits: i64,
    /// The largest motion of the step before, by which the skin looks for partners `[L]`.
    pub motion: f64,
    pub sides: Sides,
    pub near: Vec<Near>,
}

/// General contact.
#[derive(Debug)]
pub struct Skin {
    pub(super) whole: Whole,
    pub(super) rules: Rules,
    /// The pieces, and where their step begins.
    pub(super) held: Vec<Held>,
    pub(super) start: Start,
    /// Whether the plans are of these pieces.
    pub(super) is_planned: bool,
    pub(super) counts: Counts,
    before: Option<Before>,
}

/// What the last commit has replaced.
#[derive(Debug)]
struct Before {
    start: Start,
    dropped: Vec<Held>,
    order: Vec<Slot>,
}

/// Where a piece of the last step is now.
#[derive(Clone, Copy, Debug)]
enum Slot {
    /// At this place of the present ones.
    Kept(usize),
    /// At this place of those that were dropped.
    Dropped(usize),
}

/// What the step that follows has in place of a piece.
enum Next {
    /// This one of the present ones.
    Kept(usize),
    Made(Held),
}

/// A step that follows, and all that it takes to put it in place, so that nothing is refused then.
struct Change {
    start: Start,
    next: Vec<Next>,
    /// Of each piece what it does not have yet.
    friction: Vec<Option<[Vec<f64>; 2]>>,
    /// Room for the pieces of now, of then, those that are dropped, and where those of now have gone.
    present: Vec<Option<Held>>,
    held: Vec<Held>,
    dropped: Vec<Held>,
    order: Vec<Slot>,
}

/// What the nodes bring along: of each copy its slip so far and its multiplier, where it had one.
struct Brought {
    had: Vec<bool>,
    slip: Vec<Vec3>,
    lambda: Vec<Vec3>,
}

impl Skin {
    /// A skin whose t_n is the first configuration.
    pub fn new(given: Given, options: Options) -> Result<Skin> {
        // Three multipliers a copy, whether there is friction or not: a pair of bodies may have some.
        let options = match options.friction {
            Friction::None => Options { friction: Friction::Coulomb, mu: 0.0, ..options },
            Friction::Tied => {
                let text = "a skin opens and closes; tie surfaces by an interface of their own";
                return Err(Error::new(Kind::InvalidValue, text));
            }
            _ => options,
        };
        if options.mortar_side != MortarSide::Deformable {
            let text = "options.mortar_side must be STICKSLIP_MORTAR_DEFORMABLE: which side of a skin is rigid follows from its equations";
            return Err(Error::new(Kind::InvalidValue, text));
        }
        options.validate()?;
        let whole = Whole::new(given)?;
        let x = reference(&whole)?;
        let rules = Rules { options, table: Table::default(), constraints: Vec::new() };
        let (start, counts) = (Start { x, ..Start::default() }, Counts::default());
        let mut skin = Skin { whole, rules, held: Vec::new(), start, is_planned: false, counts, before: None };
        skin.begin(0.0)?;
        Ok(skin)
    }

    /// What the host has handed over.
    pub fn whole(&self) -> &Whole {
        &self.whole
    }

    /// The pieces' options.
    pub fn options(&self) -> &Options {
        &self.rules.options
    }

    /// What has happened.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// How many pairs could not be put on different sides in this step.
    pub fn contradictions(&self) -> usize {
        self.start.sides.contradictions
    }

    /// How many pieces there are.
    pub fn pieces(&self) -> usize {
        self.held.len()
    }

    /// Per facet of the host its side.
    pub fn roles(&self) -> &[Role] {
        &self.start.sides.roles
    }

    /// The pairs of facets that may touch in this step.
    pub fn near(&self) -> &[Near] {
        &self.start.near
    }

    /// Per facet of the host the piece that it is in as non-mortar facet.
    pub fn piece_of_facets(&self) -> Result<Vec<Option<usize>>> {
        let mut pieces = memory::filled(None, self.whole.facets())?;
        for (p, held) in self.held.iter().enumerate() {
            held.piece.own.iter().for_each(|&f| pieces[f] = Some(p));
        }
        Ok(pieces)
    }

    /// Says what there is between two bodies, or within one, from now on.
    pub fn set_between(&mut self, bodies: [usize; 2], between: Between) -> Result<()> {
        let known = self.whole.bodies.iter().max().map_or(0, |last| last + 1);
        if let Some(body) = bodies.into_iter().find(|&body| body >= known) {
            return Err(Error::new(Kind::IndexOutOfRange, text!("body {body} of {known}")));
        }
        let before = self.rules.table.between(bodies);
        self.rules.table.set(bodies, between)?;
        let done = self.begin_anew(0.0);
        if done.is_err() {
            self.rules.table.put_back(bodies, before);
        }
        done
    }

    /// Directions in which nodes of the host are prescribed on both sides of a contact; replaces all earlier ones.
    pub fn set_constraints(&mut self, directions: Vec<(usize, Vec3)>) -> Result<()> {
        // What is wrong with the directions themselves is told by the host's numbers, and before a piece has the nodes.
        free_directions(&memory::filled([0; 3], self.whole.nodes)?, &directions)?;
        let mut free = memory::with_room(self.held.len())?;
        for held in &mut self.held {
            free.store(held.constrained(&self.whole, &directions)?)?;
        }
        self.held.iter_mut().zip(free).for_each(|(held, free)| held.contact.constrain(free));
        self.rules.constraints = directions;
        Ok(())
    }

    /// Takes the pieces that t_n asks for, with room for a motion; none of them has been there before.
    fn begin(&mut self, motion: f64) -> Result<()> {
        let places = self.whole.places(&self.start.x)?;
        let near = near(&self.whole, &places, self.reach(motion), &self.rules.table)?;
        let sides = sides(&self.whole, &near, &self.start.sides.roles)?;
        let wanted = pieces(&self.whole, &sides.roles, &near)?;
        let mut held = memory::with_room(wanted.len())?;
        for Wanted { piece, .. } in wanted {
            held.store(Held::new(&self.whole, piece, &self.rules)?)?;
        }
        set_friction(&self.whole, &self.rules, (&sides, &near), &mut held)?;
        self.counts.made += held.len() as i64;
        (self.held, self.start.sides, self.start.near) = (held, sides, near);
        (self.is_planned, self.before) = (false, None);
        Ok(())
    }

    /// The same where steps have been committed: the nodes keep what they remember.
    fn begin_anew(&mut self, motion: f64) -> Result<()> {
        if self.start.commits == 0 {
            return self.begin(motion);
        }
        let (x, commits) = (memory::copied(&self.start.x)?, self.start.commits);
        let brought = self.brought_from_start()?;
        let (start, next, _) = self.follow(x, (motion, commits), &brought)?;
        let change = self.change(start, next)?;
        self.replace(change)?;
        self.before = None;
        Ok(())
    }

    pub(super) fn reach(&self, motion: f64) -> Reach {
        self.rules.options.search_distance.map_or(Reach::Motion(motion), Reach::Given)
    }

    /// The largest motion of any node since t_n `[L]`.
    fn motion_to(&self, x: &[Vec3]) -> f64 {
        self.start.x.iter().zip(x).map(|(from, to)| (to - from).norm()).fold(0.0, f64::max)
    }

    /// Takes the pieces and the start of another time, after which no commit can be undone.
    pub(super) fn put_in_place(&mut self, start: Start, mut held: Vec<Held>) -> Result<()> {
        set_friction(&self.whole, &self.rules, (&start.sides, &start.near), &mut held)?;
        (self.held, self.start, self.is_planned, self.before) = (held, start, false, None);
        Ok(())
    }

    /// Accepts a converged step: `x` becomes t_n. Writes the multipliers of copies that have none any more, or that take over from
    /// the other side.
    pub fn commit(&mut self, x: &[Vec3], lambda: &mut [Vec3]) -> Result<()> {
        self.check(x, lambda)?;
        let motion = self.motion_to(x);
        if !motion.is_finite() {
            return Err(Error::new(Kind::NotFinite, text!("x lies so far from t_n that the way overflows")));
        }
        self.refuse_missed(x, motion)?;
        let mut brought = self.brought_by(x, lambda)?;
        let mut steps = memory::with_room(self.held.len())?;
        for held in &mut self.held {
            let (contact, room) = held.at(&self.whole, x, lambda)?;
            steps.store(Some(contact.next(&room.x[0], &room.x[1], &room.lambda, None)?))?;
        }
        let commits = self.start.commits.saturating_add(1);
        let (start, next, taken) = self.follow(memory::copied(x)?, (motion, commits), &brought)?;
        taken.iter().for_each(|&(a, of_other)| brought.lambda[a] = of_other);
        let change = self.change(start, next)?;
        let mut claimed = memory::filled(false, self.whole.copies())?;
        // From here on nothing is refused.
        for k in change.next.iter().filter_map(|next| if let Next::Kept(k) = next { Some(*k) } else { None }) {
            if let Some(step) = steps[k].take() {
                self.held[k].contact.accept(step);
            }
        }
        self.replace(change)?;
        for (a, lambda) in lambda.iter_mut().enumerate() {
            *lambda = if brought.had[a] || taken.binary_search_by_key(&a, |t| t.0).is_ok() {
                brought.lambda[a]
            } else {
                Vec3::zeros()
            };
        }
        self.claim(&mut claimed);
        lambda.iter_mut().zip(claimed).filter(|(_, claimed)| !claimed).for_each(|(l, _)| *l = Vec3::zeros());
        Ok(())
    }

    /// Undoes the last commit exactly; the host takes its multipliers of then.
    pub fn roll_back(&mut self) -> Result<()> {
        let Some(before) = &self.before else {
            let text = "no commit can be undone: none was made since creation, import, the last rollback or the last refusal of missed contact";
            return Err(Error::new(Kind::NothingToRollBack, text));
        };
        let n = before.order.len();
        let (mut last, mut old, mut held) = (memory::with_room(n)?, memory::with_room(n)?, memory::with_room(n)?);
        for slot in &before.order {
            let (one, pairing) = match *slot {
                Slot::Kept(k) => (&self.held[k], Some(self.held[k].contact.last()?)),
                Slot::Dropped(k) => (&before.dropped[k], None),
            };
            last.store(pairing)?;
            old.store(one)?;
        }
        let friction = friction_of(&self.whole, &self.rules, (&before.start.sides, &before.start.near), &old)?;
        let (mut present, mut others) = (memory::with_room(self.held.len())?, memory::with_room(before.dropped.len())?);
        // From here on nothing is refused.
        let Some(Before { start, dropped, order }) = self.before.take() else { return Ok(()) };
        present.store_all(std::mem::take(&mut self.held).into_iter().map(Some))?;
        others.store_all(dropped.into_iter().map(Some))?;
        for ((slot, pairing), mu) in order.into_iter().zip(last).zip(friction) {
            let one = match slot {
                Slot::Kept(k) => present[k].take(),
                Slot::Dropped(k) => others[k].take(),
            };
            if let Some(mut one) = one {
                pairing.into_iter().for_each(|pairing| one.contact.go_back(pairing));
                one.take_friction(mu)?;
                held.store(one)?;
            }
        }
        (self.held, self.start, self.is_planned) = (held, start, false);
        Ok(())
    }

    /// Refuses a step after which facets lie in each other that no piece has as a pair. The pieces are then made with these pairs at
    /// t_n, so that the same step may be solved again.
    fn refuse_missed(&mut self, x: &[Vec3], motion: f64) -> Result<()> {
        let places = self.whole.places(x)?;
        let now = near(&self.whole, &places, self.reach(motion), &self.rules.table)?;
        let size = |f: usize| {
            let nodes = self.whole.surface.host_nodes(f);
            let edge = |k: usize| (places[nodes[k]] - places[nodes[(k + 1) % nodes.len()]]).norm();
            (0..nodes.len()).map(edge).fold(0.0, f64::max)
        };
        let is_known = |pair: &Near| {
            let [f, g] = pair.facets;
            let has = |own: usize, mortar: usize| {
                let mut pieces = self.held.iter().map(|held| &held.piece);
                pieces.any(|p| p.own.binary_search(&own).is_ok() && p.mortar.binary_search(&mortar).is_ok())
            };
            has(f, g) || has(g, f)
        };
        let deep = now.iter().filter(|p| are_in_each_other(p, size(p.facets[0]).min(size(p.facets[1]))));
        let missed: Vec<_> = deep.filter(|p| !is_known(p)).copied().stored()?;
        let Some(first) = missed.first() else { return Ok(()) };
        let [f, g] = first.facets;
        let text: Text = text!(
            "facets {f} and {g} of the skin have met within the step, and {} pairs in all, but were out of reach at its start; they are looked for now: solve the step again from t_n, or a smaller one",
            missed.len()
        );
        self.begin_anew(motion)?;
        self.counts.missed += 1;
        Err(Error::new(Kind::ContactLost, text))
    }

    /// What the step that follows t_n = `x` has: where it begins, its pieces, and the multipliers that copies take over from the other
    /// side, in the order of the copies.
    fn follow(
        &self,
        x: Vec<Vec3>,
        (motion, commits): (f64, i64),
        brought: &Brought,
    ) -> Result<(Start, Vec<Next>, Vec<(usize, Vec3)>)> {
        let places = self.whole.places(&x)?;
        let near = near(&self.whole, &places, self.reach(motion), &self.rules.table)?;
        let sides = sides(&self.whole, &near, &self.start.sides.roles)?;
        let wanted = pieces(&self.whole, &sides.roles, &near)?;
        let (mut next, mut taken) = (memory::with_room(wanted.len())?, Vec::new());
        for Wanted { piece, partners } in wanted {
            let is_same = |held: &Held| held.piece.own == piece.own && has_all(&held.piece.mortar, &partners);
            if let Some(k) = self.held.iter().position(is_same) {
                next.store(Next::Kept(k))?;
                continue;
            }
            let mut made = Held::new(&self.whole, piece, &self.rules)?;
            let mut slip = memory::filled(Vec3::zeros(), made.copies[0].len())?;
            for (local, &a) in made.copies[0].iter().enumerate().filter(|(local, _)| made.has_multiplier[*local]) {
                if brought.had[a] {
                    slip[local] = brought.slip[a];
                } else if let Some(other) = self.nearest_of_other_side(a, &places) {
                    slip[local] = -brought.slip[other];
                    taken.store((a, -brought.lambda[other]))?;
                }
            }
            let (contact, room) = made.at(&self.whole, &x, &[])?;
            contact.set_committed(&room.x[0], &room.x[1], &slip, commits)?;
            next.store(Next::Made(made))?;
        }
        let taken = memory::sorted(&taken, |p, q| p.0.cmp(&q.0))?;
        Ok((Start { x, commits, motion, sides, near }, next, taken))
    }

    /// The step that follows, with friction and room for all that is put in place.
    fn change(&self, start: Start, next: Vec<Next>) -> Result<Change> {
        let mut pieces = memory::with_room(next.len())?;
        pieces.store_all(next.iter().map(|next| match next {
            Next::Kept(k) => &self.held[*k],
            Next::Made(one) => one,
        }))?;
        let friction = friction_of(&self.whole, &self.rules, (&start.sides, &start.near), &pieces)?;
        let n = self.held.len();
        let (present, dropped) = (memory::with_room(n)?, memory::with_room(n)?);
        let (held, order) = (memory::with_room(next.len())?, memory::filled(Slot::Dropped(0), n)?);
        Ok(Change { start, next, friction, present, held, dropped, order })
    }

    /// Puts the next step in place; what is dropped is kept for a rollback. Nothing is refused: there is room.
    fn replace(&mut self, change: Change) -> Result<()> {
        let Change { start, next, friction, mut present, mut held, mut dropped, mut order } = change;
        present.store_all(std::mem::take(&mut self.held).into_iter().map(Some))?;
        let all_kept = next.len() == present.len() && next.iter().all(|n| matches!(n, Next::Kept(_)));
        for (next, mu) in next.into_iter().zip(friction) {
            let one = match next {
                Next::Kept(k) => {
                    order[k] = Slot::Kept(held.len());
                    present[k].take()
                }
                Next::Made(one) => {
                    self.counts.made += 1;
                    Some(one)
                }
            };
            if let Some(mut one) = one {
                one.take_friction(mu)?;
                held.store(one)?;
            }
        }
        for (k, one) in present.into_iter().enumerate() {
            if let Some(one) = one {
                order[k] = Slot::Dropped(dropped.len());
                dropped.store(one)?;
            }
        }
        self.counts.exchanged += start.sides.exchanged as i64;
        let start = std::mem::replace(&mut self.start, start);
        (self.held, self.before) = (held, Some(Before { start, dropped, order }));
        self.is_planned &= all_kept;
        Ok(())
    }

    /// What the nodes bring along from t_n: their slips.
    fn brought_from_start(&self) -> Result<Brought> {
        let mut brought = self.nothing_brought()?;
        for held in &self.held {
            let slip = &held.contact.history().slip;
            for (local, &a) in held.copies[0].iter().enumerate().filter(|(local, _)| held.has_multiplier[*local]) {
                brought.had[a] = true;
                brought.slip[a] = slip.get(local).copied().unwrap_or_default();
            }
        }
        Ok(brought)
    }

    /// What they bring along from a converged step.
    fn brought_by(&mut self, x: &[Vec3], lambda: &[Vec3]) -> Result<Brought> {
        let mut brought = self.nothing_brought()?;
        brought.lambda.copy_from_slice(lambda);
        for held in &mut self.held {
            let (contact, room) = held.at(&self.whole, x, lambda)?;
            contact.respond(&room.x[0], &room.x[1], &room.lambda, None)?;
            let (sums, responses) = held.contact.answers();
            for (local, &a) in held.copies[0].iter().enumerate().filter(|(local, _)| held.has_multiplier[*local]) {
                brought.had[a] = true;
                brought.slip[a] = held.contact.slip_after(local, &responses[local], sums[local].coverage_previous);
            }
        }
        Ok(brought)
    }

    fn nothing_brought(&self) -> Result<Brought> {
        let (n, zero) = (self.whole.copies(), Vec3::zeros());
        Ok(Brought { had: memory::filled(false, n)?, slip: memory::filled(zero, n)?, lambda: memory::filled(zero, n)? })
    }

    /// Of a copy that was a mortar node, the nearest non-mortar one of the piece that it was in.
    fn nearest_of_other_side(&self, a: usize, places: &[Vec3]) -> Option<usize> {
        let pieces = self.held.iter().filter(|held| held.copies[1].binary_search(&a).is_ok());
        let nodes = pieces.flat_map(|held| held.copies[0].iter().zip(&held.has_multiplier));
        let distance = |b: usize| (places[b] - places[a]).norm_squared();
        let with = nodes.filter(|(_, has)| **has).map(|(&b, _)| (distance(b), b));
        with.min_by(|p, q| p.0.total_cmp(&q.0)).map(|nearest| nearest.1)
    }

    /// Which copies have their multiplier in a piece.
    pub(super) fn claimed(&self) -> Result<Vec<bool>> {
        let mut claimed = memory::filled(false, self.whole.copies())?;
        self.claim(&mut claimed);
        Ok(claimed)
    }

    fn claim(&self, claimed: &mut [bool]) {
        for held in &self.held {
            held.copies[0].iter().zip(&held.has_multiplier).for_each(|(&a, &has)| claimed[a] |= has);
        }
    }

    /// Refuses positions and multipliers that are no such.
    pub(super) fn check(&self, x: &[Vec3], lambda: &[Vec3]) -> Result<()> {
        self.whole.check(x)?;
        if lambda.len() != self.whole.copies() {
            let text = text!("lambda has {} nodes; the skin has {} copies", lambda.len(), self.whole.copies());
            return Err(Error::new(Kind::InvalidSize, text));
        }
        match lambda.iter().position(|l| !l.iter().all(|v| v.is_finite())) {
            None => Ok(()),
            Some(a) => Err(Error::new(Kind::NotFinite, text!("lambda of copy {a} is not finite"))),
        }
    }
}

/// Where the nodes of the host are in the first configuration.
fn reference(whole: &Whole) -> Result<Vec<Vec3>> {
    let mut x = memory::filled(Vec3::zeros(), whole.nodes)?;
    whole.originals.iter().zip(&whole.surface.reference).for_each(|(&a, place)| x[a] = *place);
    Ok(x)
}

/// Friction of new pieces, by what is near now.
fn set_friction(whole: &Whole, rules: &Rules, near: (&Sides, &[Near]), held: &mut [Held]) -> Result<()> {
    let friction = friction_of(whole, rules, near, &held.iter().stored()?)?;
    held.iter_mut().zip(friction).try_for_each(|(held, mu)| held.take_friction(mu))
}

/// Friction of all pieces, by what is near now, of each for [`Held::take_friction`].
fn friction_of(
    whole: &Whole,
    rules: &Rules,
    (sides, near): (&Sides, &[Near]),
    all: &[&Held],
) -> Result<Vec<Option<[Vec<f64>; 2]>>> {
    let (mut claims, mut last) = (memory::filled(0_u32, whole.nodes)?, memory::filled(usize::MAX, whole.nodes)?);
    for (p, held) in all.iter().enumerate() {
        for (&a, _) in held.copies[0].iter().zip(&held.has_multiplier).filter(|(_, has)| **has) {
            let node = whole.originals[a];
            claims[node] += u32::from(last[node] != p);
            last[node] = p;
        }
    }
    all.iter().map(|held| held.friction(whole, rules, (&sides.roles, near, &claims))).stored_if_ok()
}

/// Whether a multiplier has an equation.
pub(super) fn is_there(equations: &[i64; 3]) -> bool {
    *equations != [NO_EQUATION; 3]
}
