//! Values into the entries of a plan, as the blocks of a tangent come.

use super::add::{Add, Starts};
use super::ahead::Ahead;
use super::numbering::{SCALARS, Sides};
use super::pattern::Key;
use super::places::{Layout, Places};
use super::scatter::{self, MortarOffsets, Scatter};
use super::table::{Hand, Target};
use crate::dual::Columns;
use crate::geometry::Vec3;
use crate::interface::tangent::emission::{
    Blocks, Directions, MortarBlock, NodeBlock, Place, RowBlocks, Span, Weights,
};
use crate::shape::{MAX_CORNERS, MAX_NODES};
use crate::simd::{self, add_rows};

/// Columns with their keys.
fn keys<'a>(
    layout: Layout<'a>,
    columns: &'a [(usize, Place)],
) -> impl Iterator<Item = ((usize, Place), Key)> + use<'a> {
    columns.iter().map(move |&(k, place)| ((k, place), layout.key(layout.nodes.number(place))))
}

/// What the blocks of a chunk have shown.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shown {
    /// An entry that the plan lacks: row and column.
    pub lacks: Option<(Place, Place)>,
    /// 0 times all values: 0, or not a number where one is not finite.
    pub nothing: f64,
}

/// What an offset that was searched for is where there is none (see [`Starts`]).
const SKIP: u32 = u32::MAX - 1;
const LACKS: u32 = SKIP + 1;

/// An offset of `scatter.rs` with its marks as those of a search.
#[inline(always)]
fn widened(offset: u16) -> u32 {
    if offset >= scatter::SKIP { SKIP + u32::from(offset - scatter::SKIP) } else { u32::from(offset) }
}

/// Of a mortar node that the facet does not have, and of one without equations.
static MISSING: MortarOffsets = all(scatter::LACKS);
static SKIPPED: MortarOffsets = all(scatter::SKIP);

/// The offsets of a mortar node that has this place.
#[inline]
fn of_mortar(scatter: &Scatter, place: Option<usize>, has_equations: bool) -> &MortarOffsets {
    match place {
        Some(place) => &scatter.mortar[place],
        None if has_equations => &MISSING,
        None => &SKIPPED,
    }
}

const fn all(offset: u16) -> MortarOffsets {
    let all = [offset; MAX_NODES];
    MortarOffsets { column: all, row: all, forces: all, multipliers: all }
}

impl Shown {
    /// Adds what others have shown.
    pub fn add(&mut self, other: Shown) {
        self.lacks = self.lacks.or(other.lacks);
        self.nothing += other.nothing;
    }
}

/// Takes blocks of one chunk and adds them to the entries of a plan.
pub struct Fill<'a, 'p, const N: usize> {
    setup: Sides<'a>,
    layout: Layout<'a>,
    places: &'a Places,
    scatter: Option<&'a Scatter>,
    hand: Hand<'a, 'p>,
    ahead: Ahead,
    state: State,
}

/// The facet at hand, and what has come up so far.
#[derive(Debug, Default)]
struct State {
    facet: usize,
    /// Nodes of the facet.
    len: usize,
    /// The rows of their displacements, and of their multipliers.
    own: [Target; MAX_NODES],
    multipliers: [Target; MAX_NODES],
    /// The mortar nodes at hand, how many they are, and their rows.
    mortar: Option<Span>,
    mortar_len: usize,
    mortar_rows: [Target; MAX_NODES],
    /// Whether one of them is another chunk's.
    is_foreign: bool,
    /// The places of these nodes among the mortar nodes of the facets.
    places: [Option<usize>; MAX_NODES],
    /// Which of these nodes have equations.
    has_equations: [bool; MAX_NODES],
    /// Of the blocks at hand.
    starts: Starts,
    /// An entry that the plan lacks: row and column.
    lacks: Option<(Place, Place)>,
    /// 0 times all values: 0, or not a number where one is not finite.
    nothing: [f64; 4],
}

impl<'a, 'p, const N: usize> Fill<'a, 'p, N> {
    /// With this hand.
    pub fn new(
        setup: Sides<'a>,
        layout: Layout<'a>,
        (places, scatter): (&'a Places, Option<&'a Scatter>),
        hand: Hand<'a, 'p>,
    ) -> Self {
        Fill { setup, layout, places, scatter, hand, ahead: Ahead::default(), state: State::default() }
    }

    /// What has come up.
    pub fn shown(&self) -> Shown {
        Shown { lacks: self.state.lacks, nothing: self.state.nothing.iter().sum() }
    }

    /// The rows of a node. Where no pair of the plan leads there they may be another chunk's, and nothing can be added.
    #[inline]
    fn touch(&mut self, place: Place) -> Option<Target> {
        let node = self.layout.nodes.number(place);
        if !self.layout.has_rows(node) {
            return Some(Target::default()); // nothing is ever added
        }
        let target = self.hand.claim(node);
        if target.is_none() {
            self.note(true, place, Place::Displacement(self.node_of(Span::Own, 0)));
        }
        target
    }

    /// The number of the k-th node of a span of the facet at hand.
    fn node_of(&self, span: Span, k: usize) -> usize {
        match span {
            Span::Own => self.setup.nonmortar.facets[self.state.facet].nodes[k],
            Span::Mortar(j) => self.layout.nodes.mortar(self.setup.mortar.facets[j].nodes[k]),
            Span::Group(nodes) => self.layout.nodes.mortar(nodes.nodes[k]),
        }
    }

    fn len_of(&self, span: Span) -> usize {
        match span {
            Span::Own => self.state.len,
            Span::Mortar(_) | Span::Group(_) => self.state.mortar_len,
        }
    }

    /// Looks at a span, if it is of mortar nodes and not that at hand.
    #[inline]
    fn look(&mut self, span: Span) {
        let facet = match span {
            Span::Own => return,
            Span::Mortar(j) => &self.setup.mortar.facets[j],
            Span::Group(ref nodes) => nodes,
        };
        if self.state.mortar == Some(span) {
            return;
        }
        (self.state.mortar, self.state.mortar_len, self.state.is_foreign) = (Some(span), facet.len, false);
        for (k, &node) in facet.as_slice().iter().enumerate() {
            let target = self.touch(Place::Displacement(self.layout.nodes.mortar(node)));
            self.state.is_foreign |= target.is_none();
            self.state.mortar_rows[k] = target.unwrap_or_default();
            self.state.places[k] = self.scatter.and_then(|s| s.place(self.state.facet, node));
            self.state.has_equations[k] = self.layout.numbering.has_equations(self.layout.nodes.mortar(node));
        }
    }

    /// Where a block begins in the rows of a node, by a search.
    fn found(&self, row: usize, column: usize) -> u32 {
        if !self.layout.has_rows(row) || !self.layout.numbering.has_equations(column) {
            return SKIP;
        }
        self.layout.offset(row, column, &self.places.rows[row]).unwrap_or(LACKS)
    }

    /// Finds where the columns of one span begin in the rows of another; multipliers in place of displacements of the facet's
    /// own nodes where asked for.
    #[inline]
    fn find(&mut self, (rows, of_multipliers): (Span, bool), (columns, by_multipliers): (Span, bool)) {
        self.look(rows);
        self.look(columns);
        if self.state.is_foreign && (rows, columns) != (Span::Own, Span::Own) {
            self.state.starts = Starts { at: [[LACKS; MAX_NODES]; MAX_NODES], skip: SKIP };
            return;
        }
        let f = self.state.facet;
        let Some(scatter) = self.scatter else { return self.search((rows, of_multipliers), (columns, by_multipliers)) };
        let (own, starts) = (&scatter.own[f], &mut self.state.starts);
        starts.skip = scatter::SKIP.into();
        let table = match (rows, columns) {
            // Facets without pairs in the plan have no offsets.
            (Span::Own, Span::Own) if !scatter.has(f) => {
                return self.search((rows, of_multipliers), (columns, by_multipliers));
            }
            (Span::Own, Span::Own) if of_multipliers => &own.rows,
            (Span::Own, Span::Own) if by_multipliers => &own.multipliers,
            (Span::Own, Span::Own) => &own.forces,
            (Span::Mortar(j), Span::Mortar(_)) if scatter.among[j][0][0] == scatter::LACKS => {
                return self.search((rows, of_multipliers), (columns, by_multipliers));
            }
            (Span::Mortar(j), Span::Mortar(_)) => &scatter.among[j],
            (Span::Own, Span::Mortar(_) | Span::Group(_)) => {
                for k in 0..MAX_NODES {
                    let from = of_mortar(scatter, self.state.places[k], self.state.has_equations[k]);
                    let from = if of_multipliers { &from.row } else { &from.column };
                    for b in 0..MAX_NODES {
                        starts.at[b][k] = from[b].into();
                    }
                }
                return;
            }
            (Span::Mortar(_) | Span::Group(_), Span::Own) => {
                for b in 0..MAX_NODES {
                    let from = of_mortar(scatter, self.state.places[b], self.state.has_equations[b]);
                    let from = if by_multipliers { &from.multipliers } else { &from.forces };
                    for k in 0..MAX_NODES {
                        starts.at[b][k] = from[k].into();
                    }
                }
                return;
            }
            // Mortar nodes of several facets have nothing among each other but what comes by `mortar`.
            _ => return self.search((rows, of_multipliers), (columns, by_multipliers)),
        };
        for b in 0..MAX_NODES {
            for k in 0..MAX_NODES {
                starts.at[b][k] = table[b][k].into();
            }
        }
    }

    /// The same by a search for each.
    #[cold]
    fn search(&mut self, (rows, of_multipliers): (Span, bool), (columns, by_multipliers): (Span, bool)) {
        let multiplier = self.layout.nodes.multiplier(0);
        self.state.starts.skip = SKIP;
        let (n_rows, n_columns) = (self.len_of(rows), self.len_of(columns));
        for (b, k) in (0..n_rows).flat_map(|b| (0..n_columns).map(move |k| (b, k))) {
            let row = self.node_of(rows, b) + if of_multipliers { multiplier } else { 0 };
            let column = self.node_of(columns, k) + if by_multipliers { multiplier } else { 0 };
            let acts = !by_multipliers || self.layout.nodes.has_rows(column);
            self.state.starts.at[b][k] = if acts { self.found(row, column) } else { SKIP };
        }
    }

    /// Adds blocks to the rows of a span, or of the facet's multipliers.
    #[inline]
    fn add<const R: usize>(
        &mut self,
        (rows, of_multipliers): (Span, bool),
        columns: Span,
        values: &[[[[f64; 4]; R]; 3]],
    ) {
        self.find((rows, of_multipliers), (columns, false));
        self.ahead.fetch(self.hand.pieces);
        let shape = (self.len_of(rows), self.len_of(columns));
        let State { own, multipliers, mortar_rows, starts, nothing, .. } = &mut self.state;
        let node_rows = match (rows, of_multipliers) {
            (Span::Own, true) => multipliers,
            (Span::Own, false) => own,
            (Span::Mortar(_) | Span::Group(_), _) => mortar_rows,
        };
        let pieces = &mut *self.hand.pieces;
        let lacks = simd::dispatch(Add { pieces, rows: node_rows, starts, shape, values, nothing });
        if lacks {
            let place = |span: Span| Place::Displacement(self.node_of(span, 0));
            let row = if of_multipliers { Place::Multiplier(self.node_of(rows, 0)) } else { place(rows) };
            self.note(true, row, place(columns));
        }
    }

    fn add_mortar(&mut self, shape: (usize, usize), values: &[Columns]) -> bool {
        self.ahead.fetch(self.hand.pieces);
        let State { mortar_rows, starts, nothing, .. } = &mut self.state;
        let pieces = &mut *self.hand.pieces;
        simd::dispatch(Add { pieces, rows: mortar_rows, starts, shape, values, nothing })
    }

    /// Adds to the rows of one node, column by column in their order: `add` is given the row from there, the length of each of the
    /// node's rows, the column's index, and whether it is a multiplier's.
    #[inline]
    fn add_row(
        &mut self,
        row: Place,
        mut columns: impl Iterator<Item = ((usize, Place), Key)>,
        mut add: impl FnMut(&mut [f64], u32, (usize, bool), &mut [f64; 4]),
    ) {
        let node = self.layout.nodes.number(row);
        if !self.layout.has_rows(node) {
            return;
        }
        let Some(Target { rows, piece, start }) = self.hand.claim(node) else {
            let first = columns.next();
            return self.note(first.is_some(), row, first.map_or(row, |((_, place), _)| place));
        };
        let (to, nothing) = (&mut self.hand.pieces[piece][start..start + rows.size()], &mut self.state.nothing);
        let mut lacks = None;
        let columns = columns.map(|(of, key)| ((of, key & 1 == 1), key));
        self.layout.offsets(node, &rows, columns, |((k, place), is_multiplier), offset| match offset {
            Some(offset) => add(&mut to[offset as usize..], rows.len, (k, is_multiplier), nothing),
            None => lacks = lacks.or(Some(place)),
        });
        if let Some(column) = lacks {
            self.note(true, row, column);
        }
    }

    /// Notes the first of these blocks that the plan lacks, if it lacks any; others have no equations.
    #[cold]
    fn miss(&mut self, row: Place, of: &RowBlocks) {
        let node = self.layout.nodes.number(row);
        if let Some(&column) = of.columns.iter().find(|column| self.found(node, **column) == LACKS) {
            let place = column.checked_sub(of.nodes).map_or(Place::Displacement(column), Place::Multiplier);
            self.note(true, row, place);
        }
    }

    /// Notes that the plan lacks one of these blocks, if it does.
    fn note(&mut self, lacks: bool, row: Place, column: Place) {
        if lacks && self.state.lacks.is_none() {
            self.state.lacks = Some((row, column));
        }
    }
}

impl<const N: usize> Blocks<N> for Fill<'_, '_, N> {
    fn begin(&mut self, f: usize) {
        let facet = &self.setup.nonmortar.facets[f];
        (self.state.facet, self.state.len, self.state.mortar) = (f, facet.len, None);
        for (k, &a) in facet.as_slice().iter().enumerate() {
            self.state.own[k] = self.touch(Place::Displacement(a)).unwrap_or_default();
            self.state.multipliers[k] = self.touch(Place::Multiplier(a)).unwrap_or_default();
        }
        self.ahead.after(f, (self.setup, &self.layout), self.scatter, &self.hand);
    }

    fn forces(&mut self, rows: Span, columns: Span, values: &[[[[f64; MAX_NODES]; 3]; 3]]) {
        self.add::<3>((rows, false), columns, values);
    }

    fn multipliers(&mut self, rows: Span, n: &[[f64; MAX_NODES]; MAX_CORNERS], nu: &[Vec3; MAX_CORNERS]) {
        self.find((rows, false), (Span::Own, true));
        let (n_rows, n_columns, mut lacks) = (self.len_of(rows), self.state.len, false);
        let State { own, mortar_rows, starts, nothing, .. } = &mut self.state;
        let node_rows = if rows == Span::Own { own } else { mortar_rows };
        for (b, target) in node_rows.iter().enumerate().take(n_rows) {
            for a in 0..n_columns {
                let (offset, value) = (starts.at[b][a], n[a][b]);
                if offset >= starts.skip {
                    lacks |= offset > starts.skip;
                    continue;
                }
                let at = target.start + offset as usize;
                let column = if N == 1 { [0, 1, 2].map(|i| [value * nu[a][i]]) } else { [[value]; SCALARS] };
                add_rows(self.hand.pieces[target.piece], at, target.rows.len, column);
                nothing[a] += 0.0 * value;
            }
        }
        let row = Place::Displacement(self.node_of(rows, 0));
        self.note(lacks, row, Place::Multiplier(self.node_of(Span::Own, 0)));
    }

    fn rows(&mut self, columns: Span, values: &[[[[f64; MAX_CORNERS]; N]; 3]]) {
        self.add::<N>((Span::Own, true), columns, values);
    }

    fn mortar(&mut self, block: &MortarBlock) {
        let (f, nodes) = (self.state.facet, self.layout.nodes);
        let mut of_rows = [None; MAX_NODES];
        (self.state.mortar, self.state.starts.skip) = (None, SKIP);
        for (c, &node) in block.rows.iter().enumerate() {
            let Some(target) = self.touch(Place::Displacement(nodes.mortar(node))) else { return };
            self.state.mortar_rows[c] = target;
            of_rows[c] = self.scatter.and_then(|s| s.place(f, node));
            let has_equations = self.layout.numbering.has_equations(nodes.mortar(node));
            if self.scatter.is_some() && of_rows[c].is_none() && has_equations {
                let row = Place::Displacement(nodes.mortar(node));
                return self.note(true, row, Place::Displacement(self.node_of(Span::Own, 0)));
            }
            for k in 0..block.own {
                self.state.starts.at[c][k] = match (self.scatter, of_rows[c]) {
                    (Some(scatter), Some(place)) => widened(scatter.mortar[place].forces[k]),
                    _ => self.found(nodes.mortar(node), self.node_of(Span::Own, k)),
                };
            }
        }
        let mut lacks = self.add_mortar((block.rows.len(), block.own), block.values);
        for (columns, values) in block.columns.chunks(MAX_NODES).zip(block.values[MAX_NODES..].chunks(MAX_NODES)) {
            for (k, &column) in columns.iter().enumerate() {
                let place = self.scatter.and_then(|s| s.place(f, column));
                for (c, &row) in block.rows.iter().enumerate() {
                    self.state.starts.at[c][k] = match (self.scatter, place, of_rows[c]) {
                        (Some(s), Some(column), Some(row)) => widened(s.coupling(f, row, column)),
                        _ => self.found(nodes.mortar(row), nodes.mortar(column)),
                    };
                }
            }
            lacks |= self.add_mortar((block.rows.len(), columns.len()), values);
        }
        let place = Place::Displacement(nodes.mortar(block.rows[0]));
        self.note(lacks, place, place);
    }

    fn node(&mut self, row: Place, column: Place, values: &[f64]) {
        let (r, c) = (self.layout.nodes.number(row), self.layout.nodes.number(column));
        let offset = self.found(r, c);
        if offset >= SKIP {
            return self.note(offset == LACKS, row, column);
        }
        let Some(Target { rows, piece, start }) = self.touch(row) else { return };
        if self.layout.is_diagonal(r, c, &rows) {
            return self.note(true, row, column);
        }
        let (to, at, n) = (&mut *self.hand.pieces[piece], start + offset as usize, usize::from(rows.scalars));
        for (j, values) in values.chunks_exact(n).enumerate() {
            for (i, value) in values.iter().enumerate() {
                to[at + i * rows.len as usize + j] += value;
                self.state.nothing[0] += 0.0 * value;
            }
        }
    }

    fn order(&self, column: Place) -> u32 {
        self.layout.key(self.layout.nodes.number(column))
    }

    fn row(&mut self, row: Place, columns: &[(usize, Place)], blocks: &[NodeBlock]) {
        let scalars = if matches!(row, Place::Displacement(_)) { SCALARS } else { N };
        let keys = keys(self.layout, columns);
        self.add_row(row, keys, |to, len, (k, _), nothing| {
            for (j, of) in blocks[k].iter().enumerate() {
                (0..scalars).for_each(|i| to[i * len as usize + j] += of[i]);
                nothing.iter_mut().zip(of).for_each(|(nothing, value)| *nothing += 0.0 * value);
            }
        });
    }

    fn sums(&mut self, row: Place, of: &RowBlocks) {
        let node = self.layout.nodes.number(row);
        if !self.layout.has_rows(node) {
            return;
        }
        let Some(Target { rows, piece, start }) = self.hand.claim(node) else { return self.note(true, row, row) };
        let (to, nothing, mut found) = (&mut *self.hand.pieces[piece], &mut self.state.nothing, 0);
        self.layout.each_offset(node, rows.is_diagonal, self.layout.columns.get(node), |column, offset, width| {
            let Some(block) = of.blocks.get(of.places[column] as usize) else { return };
            let (at, len, of_row) = (start + offset as usize, rows.len, &block[of.first]);
            found += 1;
            match (rows.scalars, width) {
                (1, 1) => add_rows(to, at, len, [[of_row[0]]]),
                (1, _) => add_rows(to, at, len, [[of_row[0], of_row[1], of_row[2]]]),
                (_, 1) => add_rows(to, at, len, [[block[0][0]], [block[1][0]], [block[2][0]]]),
                _ => add_rows(to, at, len, [0, 1, 2].map(|i| [block[i][0], block[i][1], block[i][2]])),
            }
            for row in &block[of.first..of.first + usize::from(rows.scalars)] {
                nothing.iter_mut().zip(row).for_each(|(nothing, value)| *nothing += 0.0 * value);
            }
        });
        if found < of.columns.len() {
            self.miss(row, of);
        }
    }

    fn multiplier_row(&mut self, row: Place, columns: &[(usize, Place)], n: &Weights, nu: &Directions) {
        let keys = keys(self.layout, columns);
        self.add_row(row, keys, |to, len, (k, _), nothing| {
            (0..SCALARS).for_each(|i| to[i * len as usize] += if N == 1 { n[k] * nu[k][i] } else { n[k] });
            nothing[0] += 0.0 * n[k];
        });
    }

    fn diagonal(&mut self, a: usize, values: &[f64]) {
        let node = self.layout.nodes.multiplier(a);
        let offset = self.found(node, node);
        if offset >= SKIP {
            return self.note(offset == LACKS, Place::Multiplier(a), Place::Multiplier(a));
        }
        let Some(Target { rows, piece, start }) = self.touch(Place::Multiplier(a)) else { return };
        let (to, at) = (&mut *self.hand.pieces[piece], start + offset as usize);
        for (i, value) in values.iter().enumerate() {
            let j = if rows.is_diagonal { 0 } else { i };
            to[at + i * rows.len as usize + j] += value;
            self.state.nothing[0] += 0.0 * value;
        }
    }
}
