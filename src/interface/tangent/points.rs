//! The tangent where points decide (docs/formulation 16.4). Tractions at points depend on sigma_A of
//! a facet's nodes, and sigma_A = lambda_A + rhat_A nu_A . g_A / D_A on the nodes that `slopes.rs` has. So the rows of a node are sums over
//! the nodes A of its facets, of d R / d sigma_A times what sigma_A depends on (`row_sums.rs`). Where sigma = 0 the tractions vanish: the
//! border's motion adds nothing. What nodes whose facets are all open act on is left out.

use super::around::Around;
use super::emission::{Emitter, Place, RowBlock};
use super::point_motion::of_facets;
pub use super::point_numbers::PointNumbers;
use super::point_rows::{self, Rows};
use super::slopes::{Along, Slopes};
use super::union::Pairs;
use crate::error::Result;
use crate::interface::data::points::{Closed, OfNodes, Points};
use crate::interface::pairing::given::Given;
use crate::shape::MAX_CORNERS;

/// What a node has of one A.
#[derive(Clone, Copy, Debug, Default)]
struct Found {
    /// d R / d sigma_A: three components of a force, and the row of a multiplier beside them.
    acts: [f64; 4],
    /// What the multiplier's row has of lambda_A at fixed sigma.
    left: f64,
}

impl Found {
    /// By sigma_A and by lambda_A, with this factor of the multiplier's row.
    fn by(&self, scale: f64, points: Option<&Points>, a: usize) -> (RowBlock, RowBlock) {
        let mut acts = self.acts;
        acts[3] *= scale;
        let by = points.map_or(1.0, |points| points.yields(a)[1]);
        let mut by_lambda = acts.map(|acts| acts * by);
        by_lambda[3] -= scale * self.left;
        (acts.map(|by| [by; 4]), by_lambda.map(|by| [by, 0.0, 0.0, 0.0]))
    }
}

impl<const N: usize> point_rows::Found<N> for Found {
    fn add_own(rows: &mut Rows<Self, N>, i: usize, k: usize, PointNumbers { points, .. }: &PointNumbers) -> Result<()> {
        for at in rows.around.at(k) {
            let (facet, mut room, mut all) = (&points.facets[at], OfNodes::default(), [0.0; MAX_CORNERS]);
            let row = facet.nodes().iter().position(|&b| b == i);
            let row_if_covered = row.filter(|_| points.is_covered[i]);
            let is_open = points.states[at] == Closed::Nothing;
            let is_here = facet.is_here(&rows.given.setup.nodes);
            let mass = points.states[at].mass(facet, &points.closed, &mut room);
            let one = &rows.given.setup.nonmortar;
            match (points.has_parts, row) {
                (false, Some(row)) => (0..MAX_CORNERS).for_each(|l| all[l] = mass[l][row]),
                (false, None) => continue,
                (true, _) => {
                    let place = one.host_nodes(rows.around.facets[k]).iter().position(|&b| b == i).unwrap_or_default();
                    let acts = facet.places().filter_map(|pair| points.acts(at, pair));
                    acts.for_each(|acts| {
                        all.iter_mut().zip(&acts.ab).for_each(|(sum, n)| *sum += facet.fade * n[place])
                    });
                }
            }
            for (l, &a) in facet.nodes().iter().enumerate().filter(|(_, a)| one.has_row(**a)) {
                let found = rows.at(a)?;
                if let Some(row) = row_if_covered {
                    found.left += facet.mass[row][l] + points.factors[i] * facet.stabilisation[row][l];
                }
                if points.is_covered[a] && !is_open {
                    let force = facet.normal * if is_here { all[l] } else { 0.0 };
                    (0..3).for_each(|n| found.acts[n] += force[n]);
                    found.acts[3] += row_if_covered.map_or(0.0, |row| mass[row][l]);
                }
            }
        }
        Ok(())
    }

    fn add_mortar(
        rows: &mut Rows<Self, N>,
        c: usize,
        k: usize,
        PointNumbers { points, .. }: &PointNumbers,
    ) -> Result<()> {
        let (one, two) = rows.given.setup.surfaces();
        for at in rows.around.at(k) {
            let facet = &points.facets[at];
            if !facet.is_here(&rows.given.setup.nodes) {
                continue;
            }
            let (mut weights, mut is_there) = ([0.0; MAX_CORNERS], false);
            for pair in facet.places() {
                let Some(closed) = points.closed(at, pair) else { break };
                if let Some(column) = two.host_nodes(points.pairs[pair].two).iter().position(|&d| d == c) {
                    match points.acts(at, pair) {
                        Some(acts) => (0..MAX_CORNERS).for_each(|l| weights[l] += facet.fade * acts.ac[l][column]),
                        None => (0..MAX_CORNERS).for_each(|l| weights[l] += closed.ac[l][column]),
                    }
                    is_there = true;
                }
            }
            for (&a, n) in facet.nodes().iter().zip(weights).filter(|_| is_there) {
                if points.is_covered[a] && one.has_row(a) {
                    let (found, force) = (rows.at(a)?, facet.normal * n);
                    (0..3).for_each(|i| found.acts[i] -= force[i]);
                }
            }
        }
        Ok(())
    }

    fn force(&self, points: Option<&Points>, a: usize) -> (RowBlock, RowBlock) {
        self.by(0.0, points, a)
    }

    fn emit_own(rows: &mut Rows<Self, N>, i: usize, emitter: &mut Emitter<N>) -> Result<()> {
        let (per_gap, has_row) = (rows.per_gap(i), rows.given.setup.nonmortar.has_row(i));
        let scale = rows.given.row_scale(i) / (rows.given.augmentation(i) * rows.given.history().areas[i]);
        let acts = rows.sum_up::<4>(|found, points, a| found.by(scale, points, a))?;
        if has_row && rows.numbers.is_some_and(|numbers| !numbers.points.is_covered[i]) {
            rows.sums.of_multiplier(i)?[3][0] = -per_gap;
        }
        if acts {
            emitter.taker.sums(Place::Displacement(i), &rows.sums.blocks(0));
        }
        if has_row {
            emitter.taker.sums(Place::Multiplier(i), &rows.sums.blocks(3));
        }
        Ok(())
    }
}

/// All blocks.
pub fn blocks<const N: usize>(
    (given, pairs): (Given<N>, Pairs),
    numbers: Option<&PointNumbers>,
    emitter: &mut Emitter<N>,
) -> Result<()> {
    let (surfaces, moves) = (given.setup.surfaces(), given.setup.mortar_moves());
    let around = Around::of(given.setup, pairs, numbers.map(|numbers| numbers.points))?;
    let motions = match numbers.and_then(|numbers| Some((numbers, numbers.active?))) {
        Some(numbers) => Some(of_facets(given, numbers, &around, emitter)?),
        None => None,
    };
    let own = given.setup.options.differentiates_weights() || given.setup.nonmortar.has_mid_nodes();
    let slopes = Slopes::of((surfaces, &around, moves, own), numbers.map(|n| (n, Along::Normals(motions.as_ref()))))?;
    point_rows::emit::<Found, N>(given, (&around, &slopes), numbers, emitter)
}
