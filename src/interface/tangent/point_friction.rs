//! The tangent with friction where points decide (docs/formulation 16.7), as without it (`points.rs`): rows of a node are sums over the
//! nodes A of its facets, of d R / d sigma_A times what sigma_A depends on. At a point dt = H (nu_e N_A dsigma_NA + P_e N_A dsigma_TA), H the
//! derivative of the projection; dsigma_A = dlambda_A + (rhat_A / D_A) dg_A, taken apart by nu_A and T_A.

use super::around::Around;
use super::emission::{Emitter, Place, RowBlock};
use super::point_numbers::PointNumbers;
use super::point_rows::{self, FORCES, Rows};
use super::slopes::{Along, Slopes};
use super::union::Pairs;
use crate::error::Result;
use crate::geometry::Mat3;
use crate::interface::data::point_friction::{FrictionNode, PointFriction};
use crate::interface::data::points::{Closed, PointFacet, Points};
use crate::interface::pairing::given::Given;
use crate::shape::MAX_CORNERS;
use std::ops::Range;

/// What a node has of one A.
#[derive(Clone, Copy, Debug, Default)]
struct Found {
    /// d force / d sigma_A, before sigma_A is taken apart.
    force: Mat3,
    /// d (int N_B t, taken apart by nu_B and T_B) / d sigma_A, in the multiplier's row of node B.
    row: Mat3,
    /// What that row has of lambda_A at fixed sigma.
    left: Mat3,
}

/// By the nodes of a facet: int N_A N H.
type OfFacet = [Mat3; MAX_CORNERS];

/// Adds those of these points; N: which of which functions of a point it is.
#[inline(never)]
fn add(sums: &mut OfFacet, friction: &PointFriction, points: Range<usize>, (which, node): (usize, usize)) {
    for q in points {
        let (point, answer) = (&friction.points[q], &friction.answers[q]);
        let h = answer.derivative * (point.weight * friction.functions(q)[which][node]);
        sums.iter_mut().zip(&point.own).for_each(|(sum, n)| *sum += h * *n);
    }
}

/// d t / d sigma_A of the points of a facet whose H are summed up.
fn of_sigma(sum: &Mat3, facet: &PointFacet, node: &FrictionNode) -> Mat3 {
    let normal = sum * facet.normal;
    normal * node.normal.transpose() + (sum - normal * facet.normal.transpose()) * node.along
}

impl<const N: usize> point_rows::Found<N> for Found {
    fn add_own(rows: &mut Rows<Self, N>, i: usize, k: usize, PointNumbers { points, .. }: &PointNumbers) -> Result<()> {
        let (friction, one) = (&points.friction, &rows.given.setup.nonmortar);
        let place = one.host_nodes(rows.around.facets[k]).iter().position(|&b| b == i);
        let Some(place) = place else { return Ok(()) };
        for at in rows.around.at(k) {
            let (facet, is_open) = (&points.facets[at], points.states[at] == Closed::Nothing);
            let (mut sums, of_points) = (OfFacet::default(), friction.of_pairs(facet.places()));
            let is_here = facet.is_here(&rows.given.setup.nodes);
            let row = facet.nodes().iter().position(|&b| b == i).filter(|_| points.is_covered[i]);
            if !is_open {
                add(&mut sums, friction, of_points.clone(), (0, place));
            }
            // The function of a multiplier is that of its node but where facets have parts.
            let mut of_row = sums;
            if let (Some(row), true, false) = (row, points.has_parts, is_open) {
                of_row = OfFacet::default();
                add(&mut of_row, friction, of_points, (2, row));
            }
            let own = &friction.nodes[i];
            for (l, &a) in facet.nodes().iter().enumerate().filter(|(_, a)| one.has_row(**a)) {
                let (found, node) = (rows.at(a)?, &friction.nodes[a]);
                let normal = own.normal * node.normal.transpose();
                if let Some(row) = row {
                    let left = facet.mass[row][l] + points.factors[i] * facet.stabilisation[row][l];
                    found.left += (normal + own.along * node.along) * left;
                }
                if points.is_covered[a] && !is_open {
                    found.force += if is_here { of_sigma(&sums[l], facet, node) } else { Mat3::zeros() };
                    if row.is_some() {
                        let (e, force) = (facet.normal, of_sigma(&of_row[l], facet, node));
                        let pressure = e.dot(&(of_row[l] * e));
                        found.row += normal * pressure + own.along * (force - e * node.normal.transpose() * pressure);
                    }
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
        for at in rows.around.at(k).filter(|at| points.states[*at] != Closed::Nothing) {
            let (facet, friction, mut sums) = (&points.facets[at], &points.friction, OfFacet::default());
            let (mut is_there, is_here) = (false, facet.is_here(&rows.given.setup.nodes));
            for place in facet.places() {
                let nodes = two.host_nodes(points.pairs[place].two);
                let Some(column) = nodes.iter().position(|&d| d == c) else { continue };
                is_there = true;
                add(&mut sums, friction, friction.of_pair(place), (1, column));
            }
            for (&a, sum) in facet.nodes().iter().zip(&sums).filter(|_| is_there && is_here) {
                if points.is_covered[a] && one.has_row(a) {
                    rows.at(a)?.force -= of_sigma(sum, facet, &friction.nodes[a]);
                }
            }
        }
        Ok(())
    }

    fn force(&self, points: Option<&Points>, a: usize) -> (RowBlock, RowBlock) {
        (three_rows(&self.force), three_rows(&by_lambda(&self.force, points, a)))
    }

    fn emit_own(rows: &mut Rows<Self, N>, i: usize, emitter: &mut Emitter<N>) -> Result<()> {
        if rows.sum_up::<FORCES>(point_rows::Found::<N>::force)? {
            emitter.taker.sums(Place::Displacement(i), &rows.sums.blocks(0));
        }
        if !rows.given.setup.nonmortar.has_row(i) {
            return Ok(());
        }
        let per_gap = rows.per_gap(i);
        let scale = per_gap / rows.given.history().areas[i];
        rows.sum_up::<FORCES>(|Found { row, left, .. }, points, a| {
            (three_rows(&(row * scale)), three_rows(&((by_lambda(row, points, a) - left) * scale)))
        })?;
        if let Some(numbers) = rows.numbers {
            let free = if numbers.points.is_covered[i] { rows.given.setup.nodes.free[i] } else { Mat3::zeros() };
            let (own, held) = (rows.sums.of_multiplier(i)?, three_rows(&(Mat3::identity() - free)));
            own.as_flattened_mut().iter_mut().zip(held.as_flattened()).for_each(|(to, n)| *to -= per_gap * n);
        }
        emitter.taker.sums(Place::Multiplier(i), &rows.sums.blocks(0));
        Ok(())
    }
}

/// By lambda_A what is this by sigma_A.
fn by_lambda(of: &Mat3, points: Option<&Points>, a: usize) -> Mat3 {
    points.filter(|points| !points.yields.is_empty()).map_or(*of, |points| of + of * points.friction.nodes[a].yields)
}

/// Its rows.
fn three_rows(of: &Mat3) -> RowBlock {
    std::array::from_fn(|i| if i < 3 { [of[(i, 0)], of[(i, 1)], of[(i, 2)], 0.0] } else { [0.0; 4] })
}

/// All blocks.
pub fn blocks<const N: usize>(
    (given, pairs): (Given<N>, Pairs),
    numbers: Option<&PointNumbers>,
    emitter: &mut Emitter<N>,
) -> Result<()> {
    let (surfaces, moves) = (given.setup.surfaces(), given.setup.mortar_moves());
    let around = Around::of(given.setup, pairs, numbers.map(|numbers| numbers.points))?;
    let own = surfaces.0.has_mid_nodes();
    let slopes = Slopes::of((surfaces, &around, moves, own), numbers.map(|n| (n, Along::All)))?;
    point_rows::emit::<Found, N>(given, (&around, &slopes), numbers, emitter)
}
