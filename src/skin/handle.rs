//! The skin's handle: what it is, and what a host sets and asks.

use super::near::{Near, Reach, near};
use super::piece::{Held, Rules};
use super::pieces::{Wanted, pieces};
use super::roles::{Role, Sides, sides};
use super::table::{Between, Table};
use super::whole::{Given, Whole};
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::{CLOSE, Decision, Friction, MortarSide, NO_EQUATION, Options, free_directions};
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
    /// How far the host says that it looks; after a step that was refused since facets met out of reach the pieces look farther.
    pub(super) given: Option<f64>,
    pub(super) before: Option<Before>,
}

/// What the last commit has replaced.
#[derive(Debug)]
pub(super) struct Before {
    pub start: Start,
    pub dropped: Vec<Held>,
    pub order: Vec<Slot>,
}

/// Where a piece of the last step is now.
#[derive(Clone, Copy, Debug)]
pub(super) enum Slot {
    /// At this place of the present ones.
    Kept(usize),
    /// At this place of those that were dropped.
    Dropped(usize),
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
        if options.decision != Decision::Nodes {
            let text = "options.method.decision must be STICKSLIP_DECISION_NODES: what points remember does not go over to interfaces that a commit makes anew";
            return Err(Error::new(Kind::Unsupported, text));
        }
        options.validate()?;
        let whole = Whole::new(given)?;
        let x = reference(&whole)?;
        let rules = Rules { options, table: Table::default(), constraints: Vec::new(), declared: 0 };
        let (start, counts) = (Start { x, ..Start::default() }, Counts::default());
        let given = options.search_distance;
        let mut skin = Skin { whole, rules, held: Vec::new(), start, is_planned: false, counts, given, before: None };
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
        let before = std::mem::replace(&mut self.rules.constraints, directions);
        self.rules.declared += 1;
        let done = self.begin_anew(0.0);
        if done.is_err() {
            self.rules.constraints = before;
            self.rules.declared -= 1;
        }
        done
    }

    /// Takes the pieces that t_n asks for, with room for a motion; none of them has been there before.
    pub(super) fn begin(&mut self, motion: f64) -> Result<()> {
        let near = self.look(&self.start.x, motion)?;
        let sides = sides(&self.whole, &near, &self.start.sides.roles)?;
        let wanted = pieces(&self.whole, &sides.roles, &near)?;
        let mut held = memory::with_room(wanted.len())?;
        for Wanted { piece, .. } in wanted {
            held.store(Held::new(&self.whole, piece, &self.rules, self.rules.options)?)?;
        }
        set_friction(&self.whole, &self.rules, (&sides, &near), &mut held)?;
        self.counts.made += held.len() as i64;
        (self.held, self.start.sides, self.start.near) = (held, sides, near);
        (self.is_planned, self.before) = (false, None);
        Ok(())
    }

    /// The pairs of facets that may touch where the host's nodes are at `x`, after a step with this motion.
    pub(super) fn look(&self, x: &[Vec3], motion: f64) -> Result<Vec<Near>> {
        let reach = Reach { given: self.rules.options.search_distance, motion };
        near(&self.whole, &self.whole.places(x)?, reach, &self.rules.table)
    }

    /// Which copies have their multiplier in a piece.
    pub(super) fn claim(&self, claimed: &mut [bool]) {
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
pub(super) fn set_friction(whole: &Whole, rules: &Rules, near: (&Sides, &[Near]), held: &mut [Held]) -> Result<()> {
    let friction = friction_of(whole, rules, near, &held.iter().stored()?)?;
    held.iter_mut().zip(friction).try_for_each(|(held, mu)| held.take_friction(mu))
}

/// Friction of all pieces, by what is near now, of each for [`Held::take_friction`].
pub(super) fn friction_of(
    whole: &Whole,
    rules: &Rules,
    (sides, near): (&Sides, &[Near]),
    all: &[&Held],
) -> Result<Vec<Option<[Vec<f64>; 2]>>> {
    // A copy far from anything is not taken to close within the step, as within a piece.
    let mut is_close = memory::filled(false, whole.copies())?;
    for Near { facets: [f, g], distance, .. } in near {
        let close = *distance <= CLOSE * whole.areas[*f].min(whole.areas[*g]).sqrt();
        [f, g].into_iter().for_each(|&f| whole.surface.host_nodes(f).iter().for_each(|&a| is_close[a] |= close));
    }
    let (mut claims, mut last) = (memory::filled(0_u32, whole.nodes)?, memory::filled(usize::MAX, whole.nodes)?);
    for (p, held) in all.iter().enumerate() {
        for (&a, _) in held.copies[0].iter().zip(&held.has_multiplier).filter(|(a, has)| **has && is_close[**a]) {
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
