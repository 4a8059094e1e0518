//! Where the rows of each node stand among the entries of compressed sparse rows.
//!
//! The three rows of a node have the same columns. Where the node and all of its columns are plain (`numbering.rs`), they
//! stand one after the other among the entries, equally long, and a block's three entries of a row stand side by side: such
//! rows are direct. All others (an equation is prescribed, or shared by two nodes, or the numbering goes component by
//! component) are laid out in the same way beside the entries, as if all equations existed, and go from there to the entries.

use super::numbering::{NO_RANK, Nodes, Numbering, SCALARS, Sides};
use super::pattern::Key;
use crate::error::Result;
use crate::interface::data::lists::Lists;
use crate::interface::data::options::Form;
use crate::interface::data::surface::NO_EQUATION;
use crate::memory::{self, Store, store_entry};

/// The place of an entry beside that has no equation.
pub const NOWHERE: usize = usize::MAX;

/// The rows of a node.
#[derive(Clone, Copy, Debug, Default)]
pub struct NodeRows {
    /// Where the first begins, among the entries or beside them; the others follow.
    pub start: usize,
    /// The length of each; 0: the node has none.
    pub len: u32,
    /// How many there are.
    pub scalars: u8,
    /// Whether they stand among the entries.
    pub is_direct: bool,
    /// Whether the block of the node with itself is a diagonal.
    pub is_diagonal: bool,
}

impl NodeRows {
    /// Numbers of all of them.
    pub fn size(&self) -> usize {
        usize::from(self.scalars) * self.len as usize
    }

    /// Where these are.
    pub fn range(&self) -> std::ops::Range<usize> {
        self.start..self.start + self.size()
    }
}

/// How wide blocks are in one row.
#[derive(Clone, Copy, Debug)]
pub struct Widths {
    /// Components of a multiplier.
    multiplier: u32,
    /// Of a multiplier in the rows of displacements.
    force: u32,
}

impl Widths {
    /// In plans of this interface.
    pub fn of(setup: Sides) -> Widths {
        // n I: component i in row i alone. Tractions of points are no multiples of multipliers.
        let is_narrow =
            setup.options.form == Form::Multiplier && !setup.options.decides_at_points() && !setup.options.conserves();
        let force = if is_narrow { 1 } else { setup.components as u32 };
        Widths { multiplier: setup.components as u32, force }
    }

    /// Of a column in the rows of a node; `own`: its block with itself.
    fn of_key(self, key: Key, row_is_multiplier: bool, own: Option<(Key, bool)>) -> u32 {
        match (key & 1 == 1, row_is_multiplier) {
            (false, _) => SCALARS as u32,
            (true, false) => self.force,
            (true, true) if own == Some((key, true)) => 1,
            (true, true) => self.multiplier,
        }
    }
}

/// All places of a plan.
#[derive(Debug, Default)]
pub struct Places {
    /// Of every node.
    pub rows: Vec<NodeRows>,
    /// The equations that have entries, ascending.
    pub equations: Vec<i64>,
    /// Where the entries of each begin; one more at the end.
    pub offsets: Vec<usize>,
    /// Where those beside the entries go, or [`NOWHERE`].
    pub beside: Vec<usize>,
    /// The ranges of entries that those come from.
    pub indirect: Vec<(usize, usize)>,
}

/// What the layout of a row follows from.
#[derive(Clone, Copy)]
pub struct Layout<'a> {
    pub nodes: Nodes<'a>,
    pub numbering: &'a Numbering,
    pub columns: &'a Lists,
    pub widths: Widths,
}

impl Layout<'_> {
    /// Whether a node has rows.
    #[inline(always)]
    pub fn has_rows(&self, node: usize) -> bool {
        self.numbering.has_equations(node) && self.nodes.has_rows(node)
    }

    fn own(&self, node: usize, is_diagonal: bool) -> Option<(Key, bool)> {
        let rank = Some(self.numbering.rank[node]).filter(|rank| *rank != NO_RANK)?;
        Some((2 * rank + u32::from(self.nodes.is_multiplier(node)), is_diagonal))
    }

    /// Gives the node of each column of a node's rows, with its offset and its width. `is_diagonal`: whether the block of the
    /// node with itself is a diagonal.
    pub fn each_offset(&self, node: usize, is_diagonal: bool, keys: &[Key], mut give: impl FnMut(usize, u32, u32)) {
        let (own, is_multiplier) = (self.own(node, is_diagonal), self.nodes.is_multiplier(node));
        let mut at = 0;
        for &key in keys {
            let width = self.widths.of_key(key, is_multiplier, own);
            give(self.numbering.node[key as usize / 2] as usize, at, width);
            at += width;
        }
    }

    /// The offset of a column in a node's rows; `None`: they have no such block.
    pub fn offset(&self, node: usize, column: usize, rows: &NodeRows) -> Option<u32> {
        let key = 2 * self.numbering.rank[column] + u32::from(self.nodes.is_multiplier(column));
        let columns = self.columns.get(node);
        let k = columns.binary_search(&key).ok()?;
        let multipliers = columns[..k].iter().fold(0, |sum, key| sum + (key & 1));
        let displacements = (k as u32 - multipliers) * SCALARS as u32;
        let (is_multiplier, own) = (self.nodes.is_multiplier(node), self.own(node, rows.is_diagonal));
        let width = if is_multiplier { self.widths.multiplier } else { self.widths.force };
        // One that is narrower than the others of its kind.
        let narrow = own.is_some_and(|(key, diagonal)| diagonal && columns[..k].binary_search(&key).is_ok());
        Some(displacements + multipliers * width - if narrow { self.widths.multiplier - 1 } else { 0 })
    }

    /// Where a node's columns come among all: columns in [`Layout::offsets`] ascend by it. The largest of all where it has no equations.
    #[inline]
    pub fn key(&self, column: usize) -> Key {
        self.numbering.rank[column].saturating_mul(2).saturating_add(u32::from(self.nodes.is_multiplier(column)))
    }

    /// [`Layout::offset`] of several columns, which ascend by their keys, in one walk through the row; columns without equations
    /// are left out.
    #[inline]
    pub fn offsets<T>(
        &self,
        node: usize,
        rows: &NodeRows,
        columns: impl Iterator<Item = (T, Key)>,
        mut give: impl FnMut(T, Option<u32>),
    ) {
        let (own, is_multiplier) = (self.own(node, rows.is_diagonal), self.nodes.is_multiplier(node));
        let (mut keys, mut at) = (self.columns.get(node), 0);
        for (of, key) in columns.take_while(|(_, key)| *key < NO_RANK) {
            while let Some((_, rest)) = keys.split_first().filter(|(first, _)| **first < key) {
                at += self.widths.of_key(keys[0], is_multiplier, own);
                keys = rest;
            }
            give(of, (keys.first() == Some(&key)).then_some(at));
        }
    }

    /// Whether a column is one scalar in each row, that of the row's component.
    pub fn is_diagonal(&self, node: usize, column: usize, rows: &NodeRows) -> bool {
        match (self.nodes.is_multiplier(node), self.nodes.is_multiplier(column)) {
            (_, false) => false,
            (true, true) => node == column && rows.is_diagonal,
            (false, true) => self.widths.force < self.widths.multiplier,
        }
    }

    /// The columns of one row in equations, with their places in a layout that has all.
    fn row(&self, node: usize, i: usize, rows: &NodeRows, give: &mut dyn FnMut(i64, u32) -> Result<()>) -> Result<()> {
        let mut outcome = Ok(());
        self.each_offset(node, rows.is_diagonal, self.columns.get(node), |column, offset, _| {
            let equations = self.nodes.equations(column);
            if outcome.is_err() {
            } else if self.is_diagonal(node, column, rows) {
                outcome = give(equations[i], offset);
            } else {
                outcome = (0..).zip(equations).try_for_each(|(j, &equation)| give(equation, offset + j));
            }
        });
        outcome
    }

    /// The columns of an equation whose rows are those of some scalars, ascending, each once.
    fn equation_columns(&self, scalars: &[u32], rows: &[NodeRows], columns: &mut Vec<i64>) -> Result<()> {
        columns.clear();
        for &scalar in scalars {
            let (node, i) = (scalar as usize / SCALARS, scalar as usize % SCALARS);
            self.row(node, i, &rows[node], &mut |equation, _| {
                if equation != NO_EQUATION { store_entry(columns, equation) } else { Ok(()) }
            })?;
        }
        memory::sort(columns)?;
        columns.dedup();
        Ok(())
    }

    fn equation(&self, scalar: u32) -> i64 {
        self.nodes.equations(scalar as usize / SCALARS)[scalar as usize % SCALARS]
    }

    /// Groups of scalars with the same equation.
    fn groups(&self) -> impl Iterator<Item = &[u32]> {
        self.numbering.scalars.chunk_by(|&p, &q| self.equation(p) == self.equation(q))
    }

    /// The places of all rows; `is_diagonal`: of which non-mortar nodes the multiplier's block with itself is a diagonal.
    pub fn places(&self, is_diagonal: &dyn Fn(usize) -> bool) -> Result<Places> {
        let nodes = self.nodes;
        let mut p = Places { rows: memory::filled(NodeRows::default(), nodes.len())?, ..Places::default() };
        let mut beside = 0;
        for node in 0..nodes.len() {
            let columns = self.columns.get(node);
            if columns.is_empty() {
                continue;
            }
            let plain = |key: &Key| self.numbering.plain[self.numbering.node[*key as usize / 2] as usize];
            let scalars = nodes.equations(node).len();
            let mut rows = NodeRows {
                scalars: scalars as u8,
                is_direct: self.numbering.plain[node] && columns.iter().all(plain),
                is_diagonal: nodes.is_multiplier(node) && is_diagonal(node - nodes.multiplier(0)),
                ..NodeRows::default()
            };
            self.each_offset(node, rows.is_diagonal, columns, |_, offset, width| rows.len = offset + width);
            if !rows.is_direct {
                rows.start = beside;
                beside += rows.size();
            }
            p.rows[node] = rows;
        }
        p.beside = memory::filled(NOWHERE, beside)?;
        let (mut at, mut columns) = (0, Vec::new());
        for scalars in self.groups() {
            let (node, i) = (scalars[0] as usize / SCALARS, scalars[0] as usize % SCALARS);
            let before = at;
            if p.rows[node].is_direct {
                if i == 0 {
                    p.rows[node].start = at;
                }
                at += p.rows[node].len as usize;
            } else {
                self.equation_columns(scalars, &p.rows, &mut columns)?;
                at += columns.len();
                for &scalar in scalars {
                    let (node, i) = (scalar as usize / SCALARS, scalar as usize % SCALARS);
                    let rows = &p.rows[node];
                    let (start, to) = (rows.start + i * rows.len as usize, &mut p.beside);
                    self.row(node, i, rows, &mut |equation, offset| {
                        if let Ok(k) = columns.binary_search(&equation) {
                            to[start + offset as usize] = before + k;
                        }
                        Ok(())
                    })?;
                }
                match p.indirect.last_mut() {
                    Some(last) if last.1 == before => last.1 = at,
                    _ => p.indirect.store((before, at))?,
                }
            }
            if at > before {
                p.equations.store(self.equation(scalars[0]))?;
                p.offsets.store(before)?;
            }
        }
        p.offsets.store(at)?;
        Ok(p)
    }

    /// Gives the columns of every row that has entries, row by row.
    pub fn each_row(&self, p: &Places, give: &mut dyn FnMut(&[i64]) -> Result<()>) -> Result<()> {
        let mut columns = Vec::new();
        for scalars in self.groups() {
            let (node, i) = (scalars[0] as usize / SCALARS, scalars[0] as usize % SCALARS);
            if p.rows[node].is_direct {
                columns.clear();
                self.row(node, i, &p.rows[node], &mut |equation, _| store_entry(&mut columns, equation))?;
            } else {
                self.equation_columns(scalars, &p.rows, &mut columns)?;
            }
            if !columns.is_empty() {
                give(&columns)?;
            }
        }
        Ok(())
    }
}

impl Places {
    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        let rows = self.rows.capacity() * size_of::<NodeRows>() + self.equations.capacity() * size_of::<i64>();
        let places = (self.offsets.capacity() + self.beside.capacity()) * size_of::<usize>();
        rows + places + self.indirect.capacity() * size_of::<(usize, usize)>()
    }
}
