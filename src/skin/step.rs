//! A skin from step to step: what a commit keeps and makes anew, and what takes it back.

use super::handle::{Before, Skin, Slot, Start, friction_of, set_friction};
use super::missed::are_in_each_other;
use super::near::{MOTIONS, Near};
use super::piece::Held;
use super::pieces::{Piece, Wanted, has_all, pieces};
use super::roles::{Role, Sides, sides};
use crate::error::{Error, Kind, Result, Text};
use crate::geometry::Vec3;
use crate::memory::{self, Store, Stored};

/// What the step that follows has in place of a piece.
#[expect(clippy::large_enum_variant, reason = "a skin has a few")]
enum Next {
    /// This one of the present ones.
    Kept(usize),
    Made(Held),
}

/// The step that follows.
struct Following {
    start: Start,
    next: Vec<Next>,
    /// Multipliers that copies take over from the other side; no copy is in two pieces.
    taken: Vec<(usize, Vec3)>,
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
    /// The same where steps have been committed: the nodes keep what they remember.
    pub(super) fn begin_anew(&mut self, motion: f64) -> Result<()> {
        if self.start.commits == 0 {
            return self.begin(motion);
        }
        let (x, commits) = (memory::copied(&self.start.x)?, self.start.commits);
        let (near, brought) = (self.look(&x, motion)?, self.brought_from_start()?);
        let start = Start { x, commits, motion, sides: Sides::default(), near };
        let Following { start, next, .. } = self.follow(start, &self.start.sides.roles, &brought)?;
        let change = self.change(start, next)?;
        self.replace(change)?;
        self.before = None;
        Ok(())
    }

    /// The largest motion of any node since t_n, beside the mean of all: what moves as a whole comes no nearer `[L]`.
    fn motion_to(&self, x: &[Vec3]) -> f64 {
        let motions = || self.start.x.iter().zip(x).map(|(from, to)| to - from);
        let mean = motions().sum::<Vec3>() / x.len() as f64;
        motions().map(|motion| (motion - mean).norm()).fold(0.0, f64::max)
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
        let near = self.look(x, motion)?;
        self.refuse_missed(x, (&near, motion))?;
        self.rules.options.search_distance = self.given;
        let brought = self.brought_by(x, lambda)?;
        let mut steps = memory::with_room(self.held.len())?;
        for held in &mut self.held {
            let (contact, room) = held.at(&self.whole, x, lambda)?;
            steps.store(Some(contact.next(&room.x[0], &room.x[1], &room.lambda, None)?))?;
        }
        let commits = self.start.commits.saturating_add(1);
        let start = Start { x: memory::copied(x)?, commits, motion, sides: Sides::default(), near };
        let Following { start, next, taken } = self.follow(start, &self.start.sides.roles, &brought)?;
        let change = self.change(start, next)?;
        let mut claimed = memory::filled(false, self.whole.copies())?;
        // From here on nothing is refused.
        for k in change.next.iter().filter_map(|next| if let Next::Kept(k) = next { Some(*k) } else { None }) {
            if let Some(step) = steps[k].take() {
                self.held[k].contact.accept(step);
            }
        }
        self.replace(change)?;
        self.take_over((lambda, &mut claimed), &taken);
        Ok(())
    }

    /// Writes what copies have taken over from the other side, and 0 to those that are in no piece; `claimed`: room.
    fn take_over(&self, (lambda, claimed): (&mut [Vec3], &mut [bool]), taken: &[(usize, Vec3)]) {
        taken.iter().for_each(|&(a, of_other)| lambda[a] = of_other);
        self.claim(claimed);
        lambda.iter_mut().zip(claimed).filter(|(_, claimed)| !**claimed).for_each(|(l, _)| *l = Vec3::zeros());
    }

    /// Exchanges the sides of all facets at t_n, for a step that does not converge however small it is: that may depend on the side
    /// that has the multipliers. Writes the multipliers of t_n of the copies that take over.
    pub fn exchange(&mut self, lambda: &mut [Vec3]) -> Result<()> {
        self.check(&self.start.x, lambda)?;
        let other = |role: &Role| match role {
            Role::None => Role::None,
            Role::Nonmortar => Role::Mortar,
            Role::Mortar => Role::Nonmortar,
        };
        let before: Vec<_> = self.start.sides.roles.iter().map(other).stored()?;
        let mut brought = self.brought_from_start()?;
        brought.lambda.copy_from_slice(lambda);
        let Start { commits, motion, .. } = self.start;
        let (x, near) = (memory::copied(&self.start.x)?, memory::copied(&self.start.near)?);
        let start = Start { x, commits, motion, sides: Sides::default(), near };
        let Following { mut start, next, taken } = self.follow(start, &before, &brought)?;
        let exchanged = |(now, before): &(&Role, &Role)| **now != Role::None && now == before;
        start.sides.exchanged = start.sides.roles.iter().zip(&before).filter(exchanged).count();
        let (change, mut claimed) = (self.change(start, next)?, memory::filled(false, self.whole.copies())?);
        // From here on nothing is refused.
        self.replace(change)?;
        self.before = None;
        self.take_over((lambda, &mut claimed), &taken);
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
            last.store(match *slot {
                Slot::Kept(k) => Some(self.held[k].contact.last()?),
                Slot::Dropped(_) => None,
            })?;
        }
        for slot in &before.order {
            old.store(match *slot {
                Slot::Kept(k) => &self.held[k],
                Slot::Dropped(k) => &before.dropped[k],
            })?;
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
    fn refuse_missed(&mut self, x: &[Vec3], (now, motion): (&[Near], f64)) -> Result<()> {
        let places = self.whole.places(x)?;
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
        self.rules.options.search_distance = self.given.map(|reach| reach.max(MOTIONS * motion));
        let found = self.begin_anew(motion);
        if found.is_err() {
            self.rules.options.search_distance = self.given;
        }
        found?;
        self.counts.missed += 1;
        Err(Error::new(Kind::ContactLost, text))
    }

    /// The step that follows, with its sides. `before`: the sides that facets have so far.
    fn follow(&self, start: Start, before: &[Role], brought: &Brought) -> Result<Following> {
        let places = self.whole.places(&start.x)?;
        let sides = sides(&self.whole, &start.near, before)?;
        let wanted = pieces(&self.whole, &sides.roles, &start.near)?;
        let (mut next, mut taken) = (memory::with_room(wanted.len())?, Vec::new());
        for Wanted { piece, partners } in wanted {
            let is_same = |held: &Held| {
                held.declared == self.rules.declared
                    && held.piece.own == piece.own
                    && has_all(&held.piece.mortar, &partners)
                    && !self.holds_apart(&held.piece)
            };
            if let Some(k) = self.held.iter().position(is_same) {
                next.store(Next::Kept(k))?;
                continue;
            }
            let mut made = Held::new(&self.whole, piece, &self.rules, self.rules.options)?;
            let mut slip = memory::filled(Vec3::zeros(), made.copies[0].len())?;
            for (local, &a) in made.copies[0].iter().enumerate().filter(|(local, _)| made.has_multiplier[*local]) {
                if brought.had[a] {
                    slip[local] = brought.slip[a];
                } else if let Some(other) = self.nearest_of_other_side(a, &places) {
                    slip[local] = -brought.slip[other];
                    taken.store((a, -brought.lambda[other]))?;
                }
            }
            let (contact, room) = made.at(&self.whole, &start.x, &[])?;
            contact.set_committed(&room.x[0], &room.x[1], &slip, start.commits)?;
            next.store(Next::Made(made))?;
        }
        Ok(Following { start: Start { sides, ..start }, next, taken })
    }

    /// Whether a piece has facets of bodies that do not see each other any more.
    fn holds_apart(&self, piece: &Piece) -> bool {
        let has = |facets: &[usize], body: usize| facets.iter().any(|&f| self.whole.bodies[f] == body);
        let mut apart = self.rules.table.apart();
        apart.any(|[a, b]| has(&piece.own, a) && has(&piece.mortar, b) || has(&piece.own, b) && has(&piece.mortar, a))
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
}
