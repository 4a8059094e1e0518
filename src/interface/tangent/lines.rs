//! What a line of the host adds to the tangent with all of its pairs (docs/formulation 13.3). Everything else is as of other
//! facets of the host (`parents.rs`).

use super::fields::Fields;
use super::parent_table::ParentTable;
use crate::features;
use crate::geometry::Vec3;
use crate::interface::data::active::Active;
use crate::interface::data::lines::line;
use crate::interface::data::parents::Parents;
use crate::interface::data::surface::Surface;
use crate::line::{LineDerivatives, LineFacet, LineWeights, MAX_LINE_NODES, Measure, line_motion};
use crate::mortar::{MORTAR, SubMotion};
use crate::shape::{MAX_CORNERS, MAX_PARENT_NODES};
use std::ops::Range;

/// Multipliers of a line, at its first nodes.
const NODES: [usize; MAX_LINE_NODES] = [0, 1, 2];

/// Adds the derivatives of line f with the active pairs in these places, at these tractions of its multipliers and
/// fields; gives the number of pairs of parts. `two`: the mortar side, where it moves.
pub fn add_lines(
    (one, other, two): (&Parents, &Parents, Option<&Surface>),
    (f, measure): (usize, Measure),
    (active, places): (&Active, Range<usize>),
    (tractions, fields): (&[Vec3], Fields),
    table: &mut ParentTable,
    motion: &mut SubMotion,
) -> i64 {
    features::LINES.is_here();
    let own = LineFacet { n: one.facets[f].parent.n, x: [0, 1, 2].map(|k| fields.one()[k].xy()) };
    // Weights are of the nodes where they are, for r counts from the axis; gaps of what a basis makes of them.
    let here = line(&one.at(f, &active.x1));
    let rows = &NODES[..one.multipliers(f)];
    let mut p = [[0.0; MAX_CORNERS]; 3];
    for (a, i) in rows.iter().flat_map(|&a| (0..3).map(move |i| (a, i))) {
        p[i][a] = tractions[a][i];
    }
    for pair in &active.pairs[places.start..places.end] {
        let g = other.parent(pair.two);
        let parts = (pair.one - one.parts(f).start, pair.two - other.parts(g).start);
        let (mut d, at) = (LineDerivatives::default(), line(&other.at(g, &active.x2)));
        d.add_parts([&here, &at], parts, one.space, measure, &mut LineWeights::default());
        let values = fields.two(g, &other.at(g, &active.x2).x);
        let at = LineFacet { x: [0, 1, 2].map(|k| values[k].xy()), ..at };
        line_motion(&d, (&own, &at), &p, motion);
        let (mut slots, mut columns) = ([None; 2 * MORTAR], [None; MAX_PARENT_NODES]);
        (0..own.n).for_each(|k| slots[k] = Some(k));
        if let Some(two) = two {
            two.host_nodes(g).iter().zip(&mut columns).for_each(|(&c, to)| *to = table.column(c));
            (0..at.n).for_each(|l| slots[MORTAR + l] = columns[l]);
        }
        fields.add(table, motion, (&slots, &columns), rows);
    }
    places.len() as i64
}
