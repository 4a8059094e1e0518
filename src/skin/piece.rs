//! A piece as an interface of its own, and the ways between its nodes and the skin's.

use super::near::Near;
use super::pieces::Piece;
use super::roles::Role;
use super::table::{Between, Table};
use super::whole::Whole;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::{Interface, NO_EQUATION, Options, Surface};
use crate::law::Coefficient;
use crate::memory::{self, Store, Stored};

/// Facets whose normals have a scalar product below this oppose each other.
const OPPOSED: f64 = -0.5;
/// The sine of 20 degrees, half of a crease: a facet that rises more over another one beside it lies in front of it.
const IN_FRONT: f64 = 0.34;

/// The sine of a normal's angle with the directions in which its node is prescribed, below which it is one of them.
const PRESCRIBED: f64 = 1e-6;

/// What holds for all pieces of a skin.
#[derive(Debug)]
pub struct Rules {
    /// The interfaces' options.
    pub options: Options,
    /// What differs between bodies.
    pub table: Table,
    /// Directions in which nodes of the host are prescribed.
    pub constraints: Vec<(usize, Vec3)>,
    /// How often these have been declared: a piece that was made before has others.
    pub declared: u64,
}

/// A piece and its interface.
#[derive(Debug)]
pub struct Held {
    /// Its facets.
    pub piece: Piece,
    /// Per side the copies that its nodes are.
    pub copies: [Vec<usize>; 2],
    /// Which of its non-mortar nodes have multipliers.
    pub has_multiplier: Vec<bool>,
    /// Components of these that push on nothing that can move.
    pub idle: Vec<[bool; 3]>,
    /// Of which declaration its constraints are.
    pub declared: u64,
    /// Friction of its non-mortar nodes; empty: that of the options.
    mu: Vec<f64>,
    /// Its interface.
    pub contact: Interface,
    /// Where it is looked at.
    pub room: Room,
}

/// Where a piece is looked at: positions of either side and multipliers.
#[derive(Debug, Default)]
pub struct Room {
    pub x: [Vec<Vec3>; 2],
    pub lambda: Vec<Vec3>,
}

impl Held {
    /// The interface of a piece, at the first configuration.
    pub fn new(whole: &Whole, piece: Piece, rules: &Rules, options: Options) -> Result<Held> {
        let mut facets = memory::copied(&piece.own)?;
        memory::extend(&mut facets, &piece.ring)?;
        let sides = [&facets[..], &piece.mortar];
        let copies = [copies_of(whole, sides[0])?, copies_of(whole, sides[1])?];
        let mut has_multiplier = memory::filled(false, copies[0].len())?;
        for &f in &piece.own {
            for a in whole.surface.host_nodes(f) {
                if let Ok(local) = copies[0].binary_search(a) {
                    has_multiplier[local] = whole.multipliers[*a] != [NO_EQUATION; 3];
                }
            }
        }
        let roots = roots_of_folds(whole, &piece, [&copies[0], &copies[1]])?;
        has_multiplier.iter_mut().zip(&roots).for_each(|(has, is_root)| *has &= !is_root);
        let idle = idle_components(whole, [&copies[0], &copies[1]])?;
        for (local, &a) in copies[0].iter().enumerate() {
            has_multiplier[local] &= !is_prescribed(whole, &piece, (a, idle[local]), &rules.constraints);
        }
        let nonmortar = surface_of(whole, "nonmortar", sides[0], &copies[0])?;
        let mortar = surface_of(whole, "mortar", sides[1], &copies[1])?;
        let equations = copies[0].iter().zip(&has_multiplier).zip(&idle).map(|((&a, &has), idle)| {
            let has = |i: usize| has && !idle[i];
            std::array::from_fn(|i| if has(i) { whole.multipliers[a][i] } else { NO_EQUATION })
        });
        let mut contact = Interface::new(nonmortar, mortar, equations.stored()?, options)?;
        let declared = constraints_of(whole, (&copies[0], &has_multiplier), &rules.constraints)?;
        if !declared.is_empty() {
            contact.set_constraints(&declared)?;
        }
        Ok(Held {
            piece,
            copies,
            has_multiplier,
            idle,
            declared: rules.declared,
            mu: Vec::new(),
            contact,
            room: Room::default(),
        })
    }

    /// Friction by the bodies that its nodes are between, twice for [`Held::take_friction`]; `None`: it is as before. `near`: the
    /// pairs of now; `claims`: in how many pieces a node of the host has a multiplier, and a partner that is close.
    pub fn friction(
        &self,
        whole: &Whole,
        rules: &Rules,
        (roles, near, claims): (&[Role], &[Near], &[u32]),
    ) -> Result<Option<[Vec<f64>; 2]>> {
        if rules.options.friction.law().mu != Coefficient::Given {
            return Ok(None);
        }
        let mut mu = memory::filled(rules.options.mu, self.copies[0].len())?;
        let mut nearest = memory::filled(f64::INFINITY, mu.len())?;
        for pair in near {
            let [f, g] = pair.facets;
            let own = if roles[f] == Role::Nonmortar { f } else { g };
            if self.piece.own.binary_search(&own).is_err() {
                continue;
            }
            let Some(Between::Friction(own_mu)) = rules.table.between(pair.facets.map(|f| whole.bodies[f])) else {
                continue;
            };
            for a in whole.surface.host_nodes(own) {
                if let Ok(local) = self.copies[0].binary_search(a)
                    && pair.distance < nearest[local]
                {
                    (mu[local], nearest[local]) = (own_mu, pair.distance);
                }
            }
        }
        // Where copies of a node stick in two pieces, six conditions meet three displacements.
        for (mu, &a) in mu.iter_mut().zip(&self.copies[0]) {
            if claims[whole.originals[a]] > 1 {
                *mu = 0.0;
            }
        }
        let is_as_before = match self.mu.is_empty() {
            true => mu.iter().all(|&mu| mu == rules.options.mu),
            false => mu == self.mu,
        };
        if is_as_before { Ok(None) } else { Ok(Some([memory::copied(&mu)?, mu])) }
    }

    /// Takes what [`Held::friction`] has found; nothing is refused.
    pub fn take_friction(&mut self, mu: Option<[Vec<f64>; 2]>) -> Result<()> {
        let Some([own, of_contact]) = mu else { return Ok(()) };
        self.mu = own;
        self.contact.set_friction(of_contact)
    }

    /// Goes to its part of positions of the host's nodes and of multipliers of the copies, or of none.
    pub fn go_to(&mut self, whole: &Whole, x: &[Vec3], lambda: &[Vec3]) -> Result<()> {
        for (room, copies) in self.room.x.iter_mut().zip(&self.copies) {
            room.clear();
            room.store_all(copies.iter().map(|&a| x[whole.originals[a]]))?;
        }
        self.room.lambda.clear();
        if !lambda.is_empty() {
            let own = self.copies[0].iter().zip(&self.has_multiplier).zip(&self.idle);
            self.room.lambda.store_all(
                own.map(|((&a, &has), idle)| Vec3::from_fn(|i, _| if has && !idle[i] { lambda[a][i] } else { 0.0 })),
            )?;
        }
        Ok(())
    }

    /// Its interface and where it goes.
    pub fn at(&mut self, whole: &Whole, x: &[Vec3], lambda: &[Vec3]) -> Result<(&mut Interface, &Room)> {
        self.go_to(whole, x, lambda)?;
        Ok((&mut self.contact, &self.room))
    }

    /// A node of the host for each of the piece's.
    pub fn originals<'a>(&'a self, whole: &'a Whole, side: usize) -> impl Iterator<Item = usize> + 'a {
        self.copies[side].iter().map(|&a| whole.originals[a])
    }
}

/// The copies of some facets, in ascending order.
fn copies_of(whole: &Whole, facets: &[usize]) -> Result<Vec<usize>> {
    let mut copies = Vec::new();
    for &f in facets {
        memory::extend(&mut copies, whole.surface.host_nodes(f))?;
    }
    memory::sort(&mut copies)?;
    copies.dedup();
    Ok(copies)
}

/// A surface of some facets of the skin, with these copies as nodes.
fn surface_of(whole: &Whole, side: &'static str, facets: &[usize], copies: &[usize]) -> Result<Surface> {
    let local = |a: &usize| copies.binary_search(a).map_or(-1, |local| local as i64);
    let mut nodes = memory::with_room(facets.len())?;
    for &f in facets {
        nodes.store(whole.surface.host_nodes(f).iter().map(local).stored()?)?;
    }
    let x = copies.iter().map(|&a| whole.surface.reference[a]).stored()?;
    let equations = copies.iter().map(|&a| whole.surface.equations[a]).stored()?;
    match whole.measure {
        None => Surface::new(side, x, &nodes, equations),
        Some(measure) => Surface::of_lines(side, x, &nodes, equations, measure),
    }
}

/// Per non-mortar node the components of its multiplier that push on nothing that can move: it is prescribed itself, and so is all
/// that may lie opposite. In such a component a matrix would be singular. Of lines the third one.
fn idle_components(whole: &Whole, [one, two]: [&[usize]; 2]) -> Result<Vec<[bool; 3]>> {
    let moves = |a: &usize, i: usize| whole.surface.equations[*a][i] != NO_EQUATION;
    let opposite: [bool; 3] = std::array::from_fn(|i| two.iter().any(|b| moves(b, i)));
    let is_idle = |a: &usize, i: usize| i >= whole.components() || !(opposite[i] || moves(a, i));
    one.iter().map(|a| std::array::from_fn(|i| is_idle(a, i))).stored()
}

/// Whether the normal of a non-mortar node lies in directions in which it is prescribed, or nothing can move: it has none then, and no
/// multiplier.
fn is_prescribed(whole: &Whole, piece: &Piece, (a, idle): (usize, [bool; 3]), directions: &[(usize, Vec3)]) -> bool {
    let own = whole.around.of(a).iter().filter(|f| piece.own.binary_search(f).is_ok());
    let area = |f: usize| whole.surface.facet(f, &whole.surface.reference).area_vector();
    let normal: Vec3 = own.flat_map(|&f| parts(whole, f)).map(area).sum();
    let mut rest = Vec3::from_fn(|i, _| if idle[i] { 0.0 } else { normal[i] });
    for (_, direction) in directions.iter().filter(|(node, _)| *node == whole.originals[a]) {
        rest -= direction * (direction.dot(&rest) / direction.norm_squared());
    }
    rest != normal && rest.norm() <= PRESCRIBED * normal.norm()
}

/// The directions that are declared of some copies, by their places: of those that have multipliers.
fn constraints_of(
    whole: &Whole,
    (copies, has): (&[usize], &[bool]),
    directions: &[(usize, Vec3)],
) -> Result<Vec<(usize, Vec3)>> {
    let mut declared = Vec::new();
    for (local, &a) in copies.iter().enumerate().filter(|(local, _)| has[*local]) {
        let of_node = directions.iter().filter(|(node, _)| *node == whole.originals[a]);
        declared.store_all(of_node.map(|&(_, direction)| (local, direction)))?;
    }
    Ok(declared)
}

/// Per non-mortar node whether it is at the root of a fold: it is a node of both sides whose facets there oppose each other or lie in
/// front of each other, as the flanks of a notch. Nothing can touch there, and a multiplier would be without a gap.
fn roots_of_folds(whole: &Whole, piece: &Piece, [one, two]: [&[usize]; 2]) -> Result<Vec<bool>> {
    let mut roots = memory::filled(false, one.len())?;
    let mut of_mortar: Vec<_> = two.iter().map(|&a| (whole.originals[a], a)).stored()?;
    memory::sort(&mut of_mortar)?;
    let x = &whole.surface.reference;
    let shape = |f: usize| {
        let nodes = whole.surface.host_nodes(f);
        let centre = nodes.iter().map(|&a| x[a]).sum::<Vec3>() / nodes.len() as f64;
        let mut normal = Vec3::zeros();
        for part in parts(whole, f) {
            normal += whole.surface.facet(part, x).area_vector();
        }
        (centre, normal.try_normalize(0.0).unwrap_or_default())
    };
    for (root, &a) in roots.iter_mut().zip(one) {
        let original = whole.originals[a];
        let first = of_mortar.partition_point(|other| other.0 < original);
        for &(_, b) in of_mortar[first..].iter().take_while(|other| other.0 == original) {
            let own = whole.around.of(a).iter().filter(|f| piece.own.binary_search(f).is_ok());
            for (centre, normal) in own.map(|&f| shape(f)) {
                let others = whole.around.of(b).iter().filter(|f| piece.mortar.binary_search(f).is_ok());
                *root |= others.map(|&g| shape(g)).any(|(other, normal_of_other)| {
                    let between = other - centre;
                    normal.dot(&normal_of_other) < OPPOSED || between.dot(&normal) > IN_FRONT * between.norm()
                });
            }
        }
    }
    Ok(roots)
}

/// The linear facets that a facet of the host is, or is cut into.
fn parts(whole: &Whole, f: usize) -> std::ops::Range<usize> {
    whole.surface.parents.as_ref().map_or(f..f + 1, |parents| parents.parts(f))
}
