//! Values into the entries of a plan, as the blocks of a tangent come.
//!
//! A row is set to 0 when the first block of it comes: the array of entries is larger than any cache, and would otherwise pass
//! through it once more. Rows that no block came for are set to 0 at the end.

use super::numbering::{NO_RANK, SCALARS};
use super::places::{Layout, NOWHERE, NodeRows, Places};
use super::scatter::{LACKS, Offsets, SKIP, Scatter};
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::setup::Setup;
use crate::interface::tangent::emission::{Blocks, MortarBlock, Place, Span};
use crate::memory;
use crate::shape::{MAX_CORNERS, MAX_NODES};
use crate::simd::{self, Kernel, Lanes};

/// What a fill works with, kept from one to the next.
#[derive(Debug, Default)]
pub struct FillRoom {
    /// The last fill that touched the rows of each node.
    touched: Vec<u32>,
    fill: u32,
    /// The rows beside the entries.
    beside: Vec<f64>,
}

impl FillRoom {
    /// Begins with a fill of these places.
    pub fn begin(&mut self, places: &Places) -> Result<()> {
        if self.touched.len() != places.rows.len() || self.fill == u32::MAX {
            memory::refill(&mut self.touched, 0, places.rows.len())?;
            self.fill = 0;
        }
        self.fill += 1;
        if self.beside.len() != places.beside.len() {
            memory::refill(&mut self.beside, 0.0, places.beside.len())?;
        }
        Ok(())
    }

    /// On the heap `[bytes]`.
    pub fn bytes(&self) -> usize {
        self.touched.capacity() * size_of::<u32>() + self.beside.capacity() * size_of::<f64>()
    }
}

/// The rows of four nodes at most, and where their columns begin: by row, then by column.
struct Target {
    rows: [NodeRows; MAX_NODES],
    n_rows: usize,
    offsets: [[u32; MAX_NODES]; MAX_NODES],
    n_columns: usize,
}

/// Wider forms of the marks of `scatter.rs`.
const WIDE_LACKS: u32 = u32::MAX;
const WIDE_SKIP: u32 = u32::MAX - 1;

fn widened(offset: u16) -> u32 {
    match offset {
        LACKS => WIDE_LACKS,
        SKIP => WIDE_SKIP,
        offset => u32::from(offset),
    }
}

/// Takes blocks and adds them to the entries of a plan.
pub struct Fill<'a, const N: usize> {
    pub setup: &'a Setup<N>,
    pub layout: Layout<'a, N>,
    pub places: &'a Places,
    pub scatter: Option<&'a Scatter>,
    /// The values of the entries.
    pub values: &'a mut [f64],
    pub room: &'a mut FillRoom,
    state: State,
}

/// The facet at hand, and what has come up so far.
#[derive(Debug, Default)]
struct State {
    facet: usize,
    /// Places of the mortar nodes of the mortar facet that was looked up last.
    last: Option<(usize, [Option<usize>; MAX_NODES])>,
    /// An entry that the plan lacks: row and column.
    lacks: Option<(Place, Place)>,
    /// 0 times all values: 0, or not a number where one is not finite.
    nothing: [f64; 4],
}

impl<'a, const N: usize> Fill<'a, N> {
    /// Into these values.
    pub fn new(
        setup: &'a Setup<N>,
        layout: Layout<'a, N>,
        (places, scatter): (&'a Places, Option<&'a Scatter>),
        values: &'a mut [f64],
        room: &'a mut FillRoom,
    ) -> Self {
        Fill { setup, layout, places, scatter, values, room, state: State::default() }
    }

    /// Ends: what no block came for is 0, and what stands beside the entries is added to them. Whether all values are finite,
    /// or an entry that the plan lacks.
    pub fn end(self) -> std::result::Result<bool, (Place, Place)> {
        for &(first, end) in &self.places.indirect {
            self.values[first..end].fill(0.0);
        }
        for (rows, &touched) in self.places.rows.iter().zip(&self.room.touched) {
            let range = rows.start..rows.start + usize::from(rows.scalars) * rows.len as usize;
            match (rows.is_direct, touched == self.room.fill) {
                (true, false) => self.values[range].fill(0.0),
                (false, true) => {
                    for (&to, &value) in self.places.beside[range.clone()].iter().zip(&self.room.beside[range]) {
                        if to != NOWHERE {
                            self.values[to] += value;
                        }
                    }
                }
                _ => {}
            }
        }
        self.state.lacks.map_or(Ok(self.state.nothing.iter().sum::<f64>() == 0.0), Err)
    }

    fn touch(&mut self, node: usize) -> NodeRows {
        let rows = self.places.rows[node];
        if std::mem::replace(&mut self.room.touched[node], self.room.fill) != self.room.fill {
            let range = rows.start..rows.start + usize::from(rows.scalars) * rows.len as usize;
            if rows.is_direct { &mut self.values[range] } else { &mut self.room.beside[range] }.fill(0.0);
        }
        rows
    }

    /// The number of the k-th node of a span of the facet at hand.
    fn node_of(&self, span: Span, k: usize) -> usize {
        match span {
            Span::Own => self.setup.nonmortar.facets[self.state.facet].nodes[k],
            Span::Mortar(j) => self.layout.nodes.mortar(self.setup.mortar.facets[j].nodes[k]),
        }
    }

    fn len_of(&self, span: Span) -> usize {
        match span {
            Span::Own => self.setup.nonmortar.facets[self.state.facet].len,
            Span::Mortar(j) => self.setup.mortar.facets[j].len,
        }
    }

    /// The places of a mortar facet's nodes among those of the facet at hand.
    fn places_of(&mut self, scatter: &Scatter, j: usize) -> [Option<usize>; MAX_NODES] {
        match self.state.last {
            Some((of, places)) if of == j => places,
            _ => {
                let facet = &self.setup.mortar.facets[j];
                let places = std::array::from_fn(|k| {
                    if k < facet.len { scatter.place(self.state.facet, facet.nodes[k]) } else { None }
                });
                self.state.last = Some((j, places));
                places
            }
        }
    }

    /// Where a block begins in the rows of a node, by a search.
    fn found(&self, row: usize, column: usize) -> u32 {
        let rank = &self.layout.numbering.rank;
        if rank[row] == NO_RANK || rank[column] == NO_RANK {
            return WIDE_SKIP;
        }
        self.layout.offset(row, column, &self.places.rows[row]).unwrap_or(WIDE_LACKS)
    }

    /// Rows and columns of two spans, multipliers in place of displacements of the facet's own nodes where asked for.
    fn target(&mut self, (rows, of_multipliers): (Span, bool), (columns, by_multipliers): (Span, bool)) -> Target {
        let (n_rows, n_columns) = (self.len_of(rows), self.len_of(columns));
        let n1 = self.layout.nodes.multiplier(0);
        let row_node = |fill: &Self, b: usize| fill.node_of(rows, b) + if of_multipliers { n1 } else { 0 };
        let mut target =
            Target { rows: Default::default(), n_rows, offsets: [[WIDE_SKIP; MAX_NODES]; MAX_NODES], n_columns };
        for b in 0..n_rows {
            let node = row_node(self, b);
            target.rows[b] = self.touch(node);
        }
        let f = self.state.facet;
        // Facets without pairs in the plan have no offsets.
        let scatter = self.scatter.filter(|s| s.first_node[f] < s.first_node[f + 1] || !self.setup.effects.moves());
        let Some(scatter) = scatter else {
            for (b, k) in (0..n_rows).flat_map(|b| (0..n_columns).map(move |k| (b, k))) {
                let column = self.node_of(columns, k) + if by_multipliers { n1 } else { 0 };
                target.offsets[b][k] = self.found(row_node(self, b), column);
            }
            return target;
        };
        let own = &scatter.own[f];
        let mut take = |from: &Offsets| target.offsets = from.map(|row| row.map(widened));
        match (rows, columns) {
            (Span::Own, Span::Own) => take(match (of_multipliers, by_multipliers) {
                (false, false) => &own.forces,
                (false, true) => &own.multipliers,
                (true, _) => &own.rows,
            }),
            (Span::Own, Span::Mortar(j)) => {
                for (k, place) in self.places_of(scatter, j).into_iter().enumerate().take(n_columns) {
                    let from = place.map(|p| &scatter.mortar[p]);
                    for b in 0..n_rows {
                        let offset = from.map(|m| if of_multipliers { m.row[b] } else { m.column[b] });
                        target.offsets[b][k] = offset.map_or(WIDE_LACKS, widened);
                    }
                }
            }
            (Span::Mortar(j), Span::Own) => {
                for (b, place) in self.places_of(scatter, j).into_iter().enumerate().take(n_rows) {
                    let from = place.map(|p| &scatter.mortar[p]);
                    let from = from.map(|m| if by_multipliers { m.multipliers } else { m.forces });
                    target.offsets[b] = from.map_or([WIDE_LACKS; MAX_NODES], |m| m.map(widened));
                }
            }
            (Span::Mortar(j), Span::Mortar(_)) => take(&scatter.among[j]),
        }
        target
    }

    /// Notes that the plan lacks one of these blocks, if it does.
    fn note(&mut self, lacks: bool, row: Place, column: Place) {
        if lacks && self.state.lacks.is_none() {
            self.state.lacks = Some((row, column));
        }
    }

    fn add<const R: usize>(&mut self, target: &Target, values: &[[[[f64; 4]; R]; 3]]) -> bool {
        let beside = &mut self.room.beside;
        let nothing = &mut self.state.nothing;
        simd::dispatch(Add { entries: self.values, beside, target, values, nothing })
    }

    fn place_of(&self, span: Span) -> Place {
        Place::Displacement(self.node_of(span, 0))
    }
}

impl<const N: usize> Blocks<N> for Fill<'_, N> {
    fn begin(&mut self, f: usize) {
        (self.state.facet, self.state.last) = (f, None);
    }

    fn forces(&mut self, rows: Span, columns: Span, values: &[[[[f64; MAX_NODES]; 3]; 3]]) {
        let target = self.target((rows, false), (columns, false));
        let lacks = self.add::<3>(&target, values);
        self.note(lacks, self.place_of(rows), self.place_of(columns));
    }

    fn multipliers(&mut self, rows: Span, n: &[[f64; MAX_NODES]; MAX_CORNERS], nu: &[Vec3; MAX_CORNERS]) {
        let target = self.target((rows, false), (Span::Own, true));
        let mut lacks = false;
        for (a, b) in (0..target.n_columns).flat_map(|a| (0..target.n_rows).map(move |b| (a, b))) {
            let (rows, offset, value) = (&target.rows[b], target.offsets[b][a], n[a][b]);
            if offset >= WIDE_SKIP {
                lacks |= offset == WIDE_LACKS;
                continue;
            }
            let to = if rows.is_direct { &mut *self.values } else { &mut self.room.beside[..] };
            let (at, len) = (rows.start + offset as usize, rows.len as usize);
            for i in 0..SCALARS {
                to[at + i * len] += if N == 1 { value * nu[a][i] } else { value };
            }
            self.state.nothing[0] += 0.0 * value;
        }
        self.note(lacks, self.place_of(rows), Place::Multiplier(self.node_of(Span::Own, 0)));
    }

    fn rows(&mut self, columns: Span, values: &[[[[f64; MAX_CORNERS]; N]; 3]]) {
        let target = self.target((Span::Own, true), (columns, false));
        let lacks = self.add::<N>(&target, values);
        self.note(lacks, Place::Multiplier(self.node_of(Span::Own, 0)), self.place_of(columns));
    }

    fn mortar(&mut self, block: &MortarBlock) {
        let f = self.state.facet;
        let nodes = self.layout.nodes;
        let places = |fill: &Self, node: usize| fill.scatter.and_then(|s| s.place(f, node));
        let mut target = Target {
            rows: Default::default(),
            n_rows: block.rows.len(),
            offsets: [[WIDE_SKIP; MAX_NODES]; MAX_NODES],
            n_columns: block.own,
        };
        let mut of_rows = [None; MAX_NODES];
        for (c, &node) in block.rows.iter().enumerate() {
            target.rows[c] = self.touch(nodes.mortar(node));
            of_rows[c] = places(self, node);
            for k in 0..block.own {
                target.offsets[c][k] = match (self.scatter, of_rows[c]) {
                    (Some(scatter), Some(place)) => widened(scatter.mortar[place].forces[k]),
                    _ => self.found(nodes.mortar(node), self.node_of(Span::Own, k)),
                };
            }
        }
        let mut lacks = self.add::<3>(&target, &block.values[..block.own]);
        for (columns, values) in block.columns.chunks(MAX_NODES).zip(block.values[MAX_NODES..].chunks(MAX_NODES)) {
            target.n_columns = columns.len();
            for (k, &column) in columns.iter().enumerate() {
                let place = places(self, column);
                for (c, &row) in block.rows.iter().enumerate() {
                    target.offsets[c][k] = match (self.scatter, place, of_rows[c]) {
                        (Some(s), Some(column), Some(row)) => {
                            let (first, m) = (s.first_node[f], s.first_node[f + 1] - s.first_node[f]);
                            widened(s.couplings[s.first_coupling[f] + (row - first) * m + column - first])
                        }
                        _ => self.found(nodes.mortar(row), nodes.mortar(column)),
                    };
                }
            }
            lacks |= self.add::<3>(&target, values);
        }
        let place = Place::Displacement(nodes.mortar(block.rows[0]));
        self.note(lacks, place, place);
    }

    fn node(&mut self, row: Place, column: Place, values: &[f64]) {
        let (r, c) = (self.layout.nodes.number(row), self.layout.nodes.number(column));
        let offset = self.found(r, c);
        if offset >= WIDE_SKIP {
            return self.note(offset == WIDE_LACKS, row, column);
        }
        let rows = self.touch(r);
        if self.layout.is_diagonal(r, c, &rows) {
            return self.note(true, row, column);
        }
        let to = if rows.is_direct { &mut *self.values } else { &mut self.room.beside[..] };
        let (at, n) = (rows.start + offset as usize, usize::from(rows.scalars));
        for (j, values) in values.chunks_exact(n).enumerate() {
            for (i, value) in values.iter().enumerate() {
                to[at + i * rows.len as usize + j] += value;
                self.state.nothing[0] += 0.0 * value;
            }
        }
    }

    fn diagonal(&mut self, a: usize, values: &[f64]) {
        let node = self.layout.nodes.multiplier(a);
        let offset = self.found(node, node);
        if offset >= WIDE_SKIP {
            return self.note(offset == WIDE_LACKS, Place::Multiplier(a), Place::Multiplier(a));
        }
        let rows = self.touch(node);
        let to = if rows.is_direct { &mut *self.values } else { &mut self.room.beside[..] };
        for (i, value) in values.iter().enumerate() {
            let j = if rows.is_diagonal { 0 } else { i };
            to[rows.start + offset as usize + i * rows.len as usize + j] += value;
            self.state.nothing[0] += 0.0 * value;
        }
    }
}

/// Adds the blocks of up to four by four nodes, `[k][j][i][B]`. Gives whether one of them has no place.
struct Add<'a, const R: usize> {
    entries: &'a mut [f64],
    beside: &'a mut [f64],
    target: &'a Target,
    values: &'a [[[[f64; 4]; R]; 3]],
    nothing: &'a mut [f64; 4],
}

impl<const R: usize> Kernel for Add<'_, R> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(self) -> bool {
        let Add { entries, beside, target, values, nothing } = self;
        let (mut lacks, mut sum) = (false, L::load(nothing));
        for k in 0..target.n_columns {
            for i in 0..R {
                let [x, y, z] = [0, 1, 2].map(|j| L::load(&values[k][j][i]));
                let zero = L::splat(0.0);
                sum = zero.mul_add(x, zero.mul_add(y, zero.mul_add(z, sum)));
                let by_node = L::transpose([x, y, z, zero]);
                for b in 0..target.n_rows {
                    let (rows, offset) = (&target.rows[b], target.offsets[b][k]);
                    if offset >= WIDE_SKIP {
                        lacks |= offset == WIDE_LACKS;
                        continue;
                    }
                    let at = rows.start + offset as usize + i * rows.len as usize;
                    let to = if rows.is_direct { &mut entries[at..at + 3] } else { &mut beside[at..at + 3] };
                    let [x, y, z, _] = by_node[b].store();
                    to[0] += x;
                    to[1] += y;
                    to[2] += z;
                }
            }
        }
        *nothing = sum.store();
        lacks
    }
}
