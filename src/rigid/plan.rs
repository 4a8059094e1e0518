//! The entries of a matrix in which rigid bodies have equations of their reference points in place of those of their nodes:
//! T^T K T + G (docs/formulation 14.4, equations R5 and R6). Where each value goes is found once; values then come as often as there are
//! motions.
//!
//! The rows of a body have one list of columns, and so have its columns of rows: what a plan keeps grows with the entries that
//! it is made of, never with the square of a body's nodes.

use super::body::{Body, Motion, in_space, turn_of_moment};
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::memory::{self, Store};

/// Equations of a body: displacement of the reference point, rotation.
pub const SIX: usize = 6;
/// No equation.
const NONE: i64 = -1;
/// The place of what has no equation.
const NOWHERE: usize = usize::MAX;
/// Of an entry whose row, or column, is none of a rigid node.
const PLAIN: u32 = u32::MAX;
/// Of a node's arms, those of forces and those of displacements.
const ROWS: usize = 0;
const COLUMNS: usize = 1;
/// Numbers of a node's equations, in the plane, too.
const SCALARS: usize = 3;

/// One entry of the nodal matrix.
#[derive(Clone, Copy, Debug)]
struct Entry {
    /// [`SCALARS`] times the rigid node plus the component, or [`PLAIN`].
    row: u32,
    column: u32,
    /// The first of its slots; [`NOWHERE`]: it has none.
    slots: usize,
}

/// What a plan keeps of a body.
#[derive(Debug)]
struct Part {
    /// One beyond the last of its nodes.
    end: usize,
    dimension: usize,
    /// The first slot of its block with itself.
    own: usize,
}

/// Where the entries of a nodal matrix go.
#[derive(Debug)]
pub struct RigidPlan {
    entries: Vec<Entry>,
    /// Places of entries of the outcome, block by block: 1 or [`SIX`] rows of 1 or [`SIX`] columns.
    slots: Vec<usize>,
    /// Row and column of each entry of the outcome.
    places: Vec<(i64, i64)>,
    parts: Vec<Part>,
    /// X - P of all nodes.
    arms: Vec<Vec3>,
    /// The same in the motion of now: what forces have as arms, what displacements have.
    room: Vec<[Vec3; 2]>,
}

/// A body, the equations that its nodes have in the nodal matrix, and those of its reference point.
pub type Kept<'a> = (Body<'a>, &'a [i64], [i64; SIX]);

/// Rows or columns of a key: an equation, or -2 - b of body b.
type Group = i64;

fn body_of(group: Group) -> Option<usize> {
    usize::try_from(-2 - group).ok()
}

/// The equations of the bodies' nodes, sorted, with the number of each scalar.
fn scalars(bodies: &[Kept]) -> Result<Vec<(i64, u32)>> {
    let (mut all, mut node) = (Vec::new(), 0);
    for (body, equations, _) in bodies {
        for of_node in equations.chunks_exact(body.dimension) {
            for (i, &equation) in of_node.iter().enumerate().filter(|e| *e.1 != NONE) {
                all.store((equation, (SCALARS * node + i) as u32))?;
            }
            node += 1;
        }
    }
    memory::sort(&mut all)?;
    Ok(all)
}

/// Refuses equations that two unknowns have.
fn check_equations(nodes: &[(i64, u32)], bodies: &[Kept]) -> Result<()> {
    if let Some(pair) = nodes.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        let text = text!(
            "node_equations: the equation {} is that of two components of nodes; each has a number that nothing else has",
            pair[0].0
        );
        return Err(Error::new(Kind::InvalidValue, text));
    }
    let mut own = Vec::new();
    own.store_all(bodies.iter().flat_map(|body| body.2).filter(|&e| e != NONE))?;
    memory::sort(&mut own)?;
    if let Some(pair) = own.windows(2).find(|pair| pair[0] == pair[1]) {
        let text = text!("equations: {} is that of two unknowns of rigid bodies", pair[0]);
        return Err(Error::new(Kind::InvalidValue, text));
    }
    let is_of_a_node = |e: &&i64| nodes.binary_search_by_key(*e, |node| node.0).is_ok();
    if let Some(equation) = own.iter().find(is_of_a_node) {
        let text = text!("equations: {equation} of a reference point is in node_equations, too");
        return Err(Error::new(Kind::InvalidValue, text));
    }
    Ok(())
}

/// Equations of a group; `none` is what a single equation is put into.
fn equations<'a>(group: &'a Group, bodies: &'a [Kept]) -> &'a [i64] {
    body_of(*group).map_or(std::slice::from_ref(group), |b| &bodies[b].2)
}

impl RigidPlan {
    /// Of the nodal matrix with these entries, in any order; -1: none.
    pub fn new(
        bodies: &[Kept],
        rows: impl Iterator<Item = i64>,
        columns: impl Iterator<Item = i64>,
    ) -> Result<RigidPlan> {
        let nodes = scalars(bodies)?;
        check_equations(&nodes, bodies)?;
        let (mut parts, mut arms) = (Vec::new(), Vec::new());
        for (body, ..) in bodies {
            arms.store_all(body.arms())?;
            parts.store(Part { end: arms.len(), dimension: body.dimension, own: NOWHERE })?;
        }
        if arms.len() >= PLAIN as usize / SCALARS {
            return Err(Error::new(Kind::Unsupported, text!("{} rigid nodes are more than a plan holds", arms.len())));
        }
        let place = |equation: i64| match nodes.binary_search_by_key(&equation, |node| node.0) {
            Ok(k) => {
                let node = nodes[k].1 as usize / SCALARS;
                (nodes[k].1, -2 - parts.partition_point(|part| part.end <= node) as i64)
            }
            Err(_) => (PLAIN, equation),
        };
        // Which blocks there are.
        let (mut entries, mut groups) = (Vec::new(), Vec::new());
        for (row, column) in rows.zip(columns) {
            let ((row, r), (column, c)) = (place(row), place(column));
            let slots = if r == NONE || c == NONE { NOWHERE } else { 0 };
            entries.store(Entry { row, column, slots })?;
            groups.store((r, c))?;
        }
        let mut keys = memory::copied(&groups)?;
        keys.store_all((0..bodies.len() as i64).map(|b| (-2 - b, -2 - b)))?;
        memory::sort(&mut keys)?;
        keys.dedup();
        keys.retain(|key| key.0 != NONE && key.1 != NONE);
        // Their entries, each once.
        let mut places = Vec::new();
        for (r, c) in &keys {
            for &row in equations(r, bodies).iter().filter(|e| **e != NONE) {
                places.store_all(equations(c, bodies).iter().filter(|e| **e != NONE).map(|&column| (row, column)))?;
            }
        }
        memory::sort(&mut places)?;
        places.dedup();
        memory::fit(&mut places)?;
        let (mut slots, mut first) = (Vec::new(), memory::with_room(keys.len())?);
        for (r, c) in &keys {
            first.store(slots.len())?;
            for row in equations(r, bodies) {
                let slot = |column: &i64| places.binary_search(&(*row, *column)).unwrap_or(NOWHERE);
                slots.store_all(equations(c, bodies).iter().map(slot))?;
            }
        }
        let slots_of = |key: &(Group, Group)| keys.binary_search(key).map_or(NOWHERE, |k| first[k]);
        for (entry, key) in entries.iter_mut().zip(&groups).filter(|(entry, _)| entry.slots != NOWHERE) {
            entry.slots = slots_of(key);
        }
        for (b, part) in parts.iter_mut().enumerate() {
            part.own = slots_of(&(-2 - b as i64, -2 - b as i64));
        }
        let room = memory::filled([Vec3::zeros(); 2], arms.len())?;
        Ok(RigidPlan { entries, slots, places, parts, arms, room })
    }

    /// Row and column of each entry, by rows and within a row by columns.
    pub fn places(&self) -> &[(i64, i64)] {
        &self.places
    }

    /// Entries that it was made of.
    pub fn entries(&self) -> usize {
        self.entries.len()
    }

    /// Dimension and nodes of each body.
    pub fn bodies(&self) -> impl Iterator<Item = (usize, usize)> {
        let mut first = 0;
        self.parts.iter().map(move |part| (part.dimension, part.end - std::mem::replace(&mut first, part.end)))
    }

    /// Values of its entries from those of the nodal matrix, in the order in which it was made; `forces`: of the bodies' nodes,
    /// body by body.
    pub fn values(&mut self, motions: &[Motion], forces: &[f64], nodal: &[f64], values: &mut [f64]) {
        let (mut first, mut spins, mut forces) = (0, motions.iter().map(Motion::spin), forces);
        values.fill(0.0);
        for (part, motion) in self.parts.iter().zip(motions) {
            let (own, rest) = forces.split_at(part.dimension * (part.end - first));
            let mut turn = nalgebra::Matrix3::zeros();
            for (k, force) in own.chunks_exact(part.dimension).enumerate() {
                let arm = &self.arms[first + k];
                self.room[first + k] = [motion.lever(arm), motion.arm(arm)];
                turn += turn_of_moment(&motion.turning(arm), &in_space(force));
            }
            let turn = spins.next().map_or(turn, |spin| turn * spin);
            for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
                let place = self.slots[part.own + SIX * (3 + i) + 3 + j];
                if place != NOWHERE {
                    values[place] += turn[(i, j)];
                }
            }
            (first, forces) = (part.end, rest);
        }
        for (entry, &value) in self.entries.iter().zip(nodal).filter(|(entry, _)| entry.slots != NOWHERE) {
            let (mut left, mut right) = ([1.0; SIX], [1.0; SIX]);
            let (mut m, mut n) = (1, 1);
            if entry.row != PLAIN {
                (left, m) = (self.factors(entry.row, ROWS).0, SIX);
            }
            if entry.column != PLAIN {
                let (factors, node) = self.factors(entry.column, COLUMNS);
                let b = self.parts.partition_point(|part| part.end <= node);
                // d x = d u + w x rho with the spin w = H d theta.
                let turn = motions[b].spin().tr_mul(&Vec3::new(factors[3], factors[4], factors[5]));
                right = [factors[0], factors[1], factors[2], turn.x, turn.y, turn.z];
                n = SIX;
            }
            for (a, l) in left[..m].iter().enumerate().filter(|(_, l)| **l != 0.0) {
                for (b, r) in right[..n].iter().enumerate().filter(|(_, r)| **r != 0.0) {
                    let place = self.slots[entry.slots + n * a + b];
                    if place != NOWHERE {
                        values[place] += l * value * r;
                    }
                }
            }
        }
    }

    /// What a force of 1 at a scalar is at the reference point, e_i and rho x e_i; and the scalar's node.
    #[inline]
    fn factors(&self, scalar: u32, which: usize) -> ([f64; SIX], usize) {
        let (node, i) = (scalar as usize / SCALARS, scalar as usize % SCALARS);
        let rho = &self.room[node][which];
        let moment = [[0.0, rho.z, -rho.y], [-rho.z, 0.0, rho.x], [rho.y, -rho.x, 0.0]][i];
        let mut factors = [0.0, 0.0, 0.0, moment[0], moment[1], moment[2]];
        factors[i] = 1.0;
        (factors, node)
    }
}
