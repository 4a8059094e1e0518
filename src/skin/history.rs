//! A skin's history as flat arrays, for a restart: which facets each piece has, and the pieces' own histories.
//!
//! Integers: the layout, the checksum, nodes, facets, commits, pieces; the sides of the facets; piece by piece how many facets of
//! three kinds, integers and reals it has, and these. Reals: positions of t_n, the motion before it, then those of the pieces.

use super::handle::{Skin, Start};
use super::piece::Held;
use super::pieces::Piece;
use super::roles::{Role, Sides};
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::interface::{Options, history_checksum, seal_history};
use crate::memory::{self, Store, Stored};

/// What the first integer of a layout says.
const LAYOUT: i64 = 0x736b_696e_0001;
/// Integers before the sides of the facets.
const HEAD: usize = 6;

impl Skin {
    /// The history as flat arrays.
    pub fn export_history(&mut self) -> Result<(Vec<i64>, Vec<f64>)> {
        let sizes = [self.whole.nodes, self.whole.facets()].map(|n| n as i64);
        let head = [LAYOUT, 0, sizes[0], sizes[1], self.start.commits, self.held.len() as i64];
        let (mut integers, mut reals) = (memory::copied(&head)?, Vec::new());
        integers.store_all(self.start.sides.roles.iter().map(|&role| role as i64))?;
        reals.store_all(self.start.x.iter().flat_map(|x| [x.x, x.y, x.z]))?;
        reals.store(self.start.motion)?;
        for held in &mut self.held {
            let (i, r) = held.contact.export_history()?;
            let lists = [&held.piece.own, &held.piece.ring, &held.piece.mortar];
            let lengths = [lists[0].len(), lists[1].len(), lists[2].len(), i.len(), r.len()];
            integers.store_all(lengths.into_iter().map(|n| n as i64))?;
            for list in lists {
                integers.store_all(list.iter().map(|&f| f as i64))?;
            }
            memory::extend(&mut integers, &i)?;
            // A piece that was made after a refusal looks farther than the options say; 0: no distance is given.
            reals.store(held.contact.options().search_distance.unwrap_or(0.0))?;
            memory::extend(&mut reals, &r)?;
        }
        seal_history(&mut integers, &reals);
        Ok((integers, reals))
    }

    /// Replaces the history by an exported one of the same skin, after which no commit can be undone.
    pub fn import_history(&mut self, integers: &[i64], reals: &[f64]) -> Result<()> {
        let head = integers.get(..HEAD).unwrap_or_default();
        if head.first() != Some(&LAYOUT) || head[1] != history_checksum(integers, reals) {
            return Err(mismatch("it is not a skin's, or was changed since its export"));
        }
        let (n, facets) = (self.whole.nodes, self.whole.facets());
        if head[2..4] != [n as i64, facets as i64] {
            return Err(mismatch("it is of a skin with other nodes or facets"));
        }
        let mut rest = Flat { integers: &integers[HEAD..], reals };
        let roles = rest.integers(facets)?.iter().map(role_of).stored_if_ok()?;
        let x: Vec<_> = rest.reals(3 * n)?.chunks_exact(3).map(Vec3::from_column_slice).stored()?;
        let (motion, mut held) = (rest.reals(1)?[0], Vec::new());
        for _ in 0..head[5] {
            let lengths: Vec<_> =
                rest.integers(5)?.iter().map(|&n| usize::try_from(n).unwrap_or(usize::MAX)).stored()?;
            let mut list = |k: usize| rest.integers(lengths[k])?.iter().map(|&f| facet_of(f, facets)).stored_if_ok();
            let piece = Piece { own: list(0)?, ring: list(1)?, mortar: list(2)? };
            let reach = rest.reals(1)?[0];
            let options = Options { search_distance: (reach > 0.0).then_some(reach), ..self.rules.options };
            let mut one = Held::new(&self.whole, piece, &self.rules, options)?;
            one.contact.import_history(rest.integers(lengths[3])?, rest.reals(lengths[4])?)?;
            held.store(one)?;
        }
        let near = self.look(&x, motion)?;
        let sides = Sides { roles, ..Sides::default() };
        self.put_in_place(Start { x, commits: head[4], motion, sides, near }, held)
    }
}

/// What is left of flat arrays.
struct Flat<'a> {
    integers: &'a [i64],
    reals: &'a [f64],
}

impl<'a> Flat<'a> {
    fn integers(&mut self, n: usize) -> Result<&'a [i64]> {
        take(&mut self.integers, n)
    }

    fn reals(&mut self, n: usize) -> Result<&'a [f64]> {
        take(&mut self.reals, n)
    }
}

fn take<'a, T>(rest: &mut &'a [T], n: usize) -> Result<&'a [T]> {
    let Some((first, others)) = rest.split_at_checked(n) else { return Err(mismatch("it ends too soon")) };
    *rest = others;
    Ok(first)
}

fn role_of(number: &i64) -> Result<Role> {
    match number {
        0 => Ok(Role::None),
        1 => Ok(Role::Nonmortar),
        2 => Ok(Role::Mortar),
        _ => Err(mismatch("a facet has no side")),
    }
}

fn facet_of(number: i64, facets: usize) -> Result<usize> {
    usize::try_from(number).ok().filter(|&f| f < facets).ok_or_else(|| mismatch("it names a facet that is not there"))
}

fn mismatch(why: &str) -> Error {
    Error::new(Kind::HistoryMismatch, text!("the history does not belong to this skin: {why}"))
}
