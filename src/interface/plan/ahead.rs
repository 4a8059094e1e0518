//! Rows that the blocks of the next facet will be added to, fetched while those of this one come. The rows of a plan are larger
//! than any cache: without this a facet waits for each of them, a tenth of all time.

use super::numbering::Sides;
use super::places::Layout;
use super::scatter::Scatter;
use super::table::Hand;
use crate::simd;

/// Rows of nodes at most: of eight own ones, of their multipliers, of so many mortar nodes. More are not fetched.
const MOST: usize = 32;
/// Numbers of a fetch, eight a line of 64 bytes. A fetch of all at once would fill the processor's queue, and wait.
const AT_ONCE: usize = 160;

/// What is still to be fetched.
#[derive(Debug)]
pub struct Ahead {
    /// The piece, where the rows begin there, where they end.
    rows: [(u32, usize, usize); MOST],
    len: usize,
}

impl Default for Ahead {
    fn default() -> Self {
        Ahead { rows: [(0, 0, 0); MOST], len: 0 }
    }
}

impl Ahead {
    /// Notes the rows of the facet after `f`, but those that it shares with `f`.
    pub fn after(&mut self, f: usize, (setup, layout): (Sides, &Layout), scatter: Option<&Scatter>, hand: &Hand) {
        self.len = 0;
        let (Some(facet), Some(scatter)) = (setup.nonmortar.facets.get(f + 1), scatter) else { return };
        let (here, nodes) = (&setup.nonmortar.facets[f], layout.nodes);
        for &a in facet.as_slice().iter().filter(|&a| !here.as_slice().contains(a)) {
            self.note(a, layout, hand);
            self.note(nodes.multiplier(a), layout, hand);
        }
        let here = scatter.mortar_nodes(f);
        for c in scatter.mortar_nodes(f + 1).iter().filter(|&c| !here.contains(c)) {
            self.note(nodes.mortar(*c as usize), layout, hand);
        }
    }

    fn note(&mut self, node: usize, layout: &Layout, hand: &Hand) {
        if self.len == MOST || !layout.has_rows(node) {
            return;
        }
        if let Some(at) = hand.find(node) {
            self.rows[self.len] = (at.piece as u32, at.start, at.start + at.rows.size());
            self.len += 1;
        }
    }

    /// Fetches some. Like other steps between two blocks it is always inlined: the compiler is told to spare size (cmake/library.cmake).
    #[inline(always)]
    pub fn fetch(&mut self, pieces: &[&mut [f64]]) {
        let Some((piece, start, end)) = self.rows[..self.len].last_mut() else { return };
        let to = (*end).min(*start + AT_ONCE);
        let numbers = pieces.get(*piece as usize).and_then(|piece| piece.get(*start..to));
        numbers.into_iter().for_each(simd::prefetch_all);
        *start = to;
        if to == *end {
            self.len -= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_rows_are_fetched_and_nothing_else_is_read() {
        let (mut first, mut second) = (vec![1.0; 3 * AT_ONCE], vec![2.0; 5]);
        let pieces: [&mut [f64]; 2] = [&mut first, &mut second];
        let mut ahead = Ahead::default();
        // The last one is no longer there: such rows are left out.
        for (k, rows) in [(0, 7, 2 * AT_ONCE + 8), (1, 0, 5), (2, 0, 9), (1, 3, 9)].into_iter().enumerate() {
            (ahead.rows[k], ahead.len) = (rows, k + 1);
        }
        let mut left = Vec::new();
        while ahead.len > 0 {
            ahead.fetch(&pieces);
            left.push((ahead.len, ahead.rows[0].1));
        }
        assert_eq!(left, [(3, 7), (2, 7), (1, 7), (1, 7 + AT_ONCE), (1, 7 + 2 * AT_ONCE), (0, 2 * AT_ONCE + 8)]);
        ahead.fetch(&pieces);
        assert_eq!(ahead.len, 0);
    }
}
