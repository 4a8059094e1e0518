//! The tangent where points decide (docs/formulation.md 16.4). Tractions at points depend on sigma_A of
//! a facet's nodes, and sigma_A = lambda_A + rhat_A nu_A . g_A / D_A on the nodes that `slopes.rs` has. So the rows of a node are sums over
//! the nodes A of its facets, of d R / d sigma_A times what sigma_A depends on (`row_sums.rs`). Where sigma = 0 the tractions vanish: the
//! border's motion adds nothing. What nodes whose facets are all open act on is left out.

use super::around::Around;
use super::emission::{Emitter, Place, RowBlock};
use super::point_motion::of_facets;
pub use super::point_numbers::PointNumbers;
use super::row_sums::{Acting, Gathered};
use super::slopes::{Along, Slopes};
use super::union::Pairs;
use crate::error::Result;
use crate::interface::data::points::{Closed, OfNodes};
use crate::interface::pairing::given::Given;
use crate::memory::Store;
use crate::shape::MAX_CORNERS;

/// What a node has of one A.
#[derive(Clone, Copy, Debug, Default)]
struct Found {
    /// d R / d sigma_A: three components of a force, and the row of a multiplier beside them.
    acts: [f64; 4],
    /// What the multiplier's row has of lambda_A at fixed sigma.
    left: f64,
}

/// Rows in the making. What they are made of has no numbers where the pattern is asked for alone.
struct Rows<'a, const N: usize> {
    given: Given<'a, N>,
    around: &'a Around,
    numbers: Option<&'a PointNumbers<'a>>,
    slopes: &'a Slopes,
    row: Gathered<Found>,
    acting: Vec<Acting>,
}

impl<const N: usize> Rows<'_, N> {
    /// Adds what a non-mortar node has of the k-th facet.
    fn own(&mut self, i: usize, k: usize, PointNumbers { points, .. }: &PointNumbers) -> Result<()> {
        let Some(at) = self.around.at(k) else { return Ok(()) };
        let (facet, is_covered) = (&points.facets[at], points.is_covered[i]);
        let Some(row) = facet.nodes().iter().position(|&b| b == i) else { return Ok(()) };
        let (is_open, mut room) = (points.states[at] == Closed::Nothing, OfNodes::default());
        let mass = points.states[at].mass(facet, &points.closed, &mut room);
        for (l, &a) in facet.nodes().iter().enumerate() {
            if !self.given.setup.nonmortar.has_row(a) {
                continue;
            }
            let found = self.row.at(a)?;
            if is_covered {
                found.left += facet.mass[row][l] + points.factors[i] * facet.stabilisation[row][l];
            }
            if points.is_covered[a] && !is_open {
                let force = facet.normal * mass[l][row];
                (0..3).for_each(|n| found.acts[n] += force[n]);
                found.acts[3] += if is_covered { mass[row][l] } else { 0.0 };
            }
        }
        Ok(())
    }

    /// Adds what mortar node c has of the k-th facet.
    fn mortar(&mut self, c: usize, k: usize, PointNumbers { points, .. }: &PointNumbers) -> Result<()> {
        let (one, two) = self.given.setup.surfaces();
        let Some(at) = self.around.at(k) else { return Ok(()) };
        let facet = &points.facets[at];
        let (mut weights, mut is_there) = ([0.0; MAX_CORNERS], false);
        for pair in facet.places() {
            let Some(closed) = points.closed(at, pair) else { return Ok(()) };
            if let Some(column) = two.host_nodes(points.pairs[pair].two).iter().position(|&d| d == c) {
                (0..MAX_CORNERS).for_each(|l| weights[l] += closed.ac[l][column]);
                is_there = true;
            }
        }
        for (&a, n) in facet.nodes().iter().zip(weights).filter(|_| is_there) {
            if points.is_covered[a] && one.has_row(a) {
                let (found, force) = (self.row.at(a)?, facet.normal * n);
                (0..3).for_each(|i| found.acts[i] -= force[i]);
            }
        }
        Ok(())
    }

    /// Sums the row up, whose multiplier's row has these factors of what acts and of what is left; gives whether any force acts.
    fn sum_up<const R: usize>(&mut self, scale: f64) -> Result<bool> {
        let Gathered { sums, of, acts } = &mut self.row;
        self.acting.clear();
        for (&a, found) in of.iter().zip(acts) {
            let (mut act, block) = (found.acts, sums.of_multiplier(a)?);
            act[3] *= scale;
            (0..3).for_each(|i| block[i][0] = act[i]);
            block[3][0] = act[3] - scale * found.left;
            if act != [0.0; 4] {
                self.acting.store((a, act.map(|by| [by; 4])))?;
            }
        }
        if self.numbers.is_none() {
            sums.reach(of.iter().copied(), self.slopes)?;
            return Ok(true);
        }
        sums.add::<R>(&self.acting, self.slopes)?;
        Ok(!self.acting.is_empty())
    }

    /// The rows of a non-mortar node.
    fn emit_own(&mut self, i: usize, emitter: &mut Emitter<N>) -> Result<()> {
        let (given, facets, has_row) = (self.given, self.around.around(i), self.given.setup.nonmortar.has_row(i));
        if facets.is_empty() {
            let value = if self.numbers.is_some() { -given.row_scale(i) / given.augmentation(i) } else { 0.0 };
            if has_row {
                emitter.taker.node(Place::Multiplier(i), Place::Multiplier(i), &[value]);
            }
            return Ok(());
        }
        self.row.begin();
        for k in facets.iter().map(|&k| k as usize) {
            match self.numbers {
                Some(numbers) => self.own(i, k, numbers)?,
                None => self.row.reach(&self.given.setup.nonmortar, self.around, k)?,
            }
        }
        let scale = given.row_scale(i) / (given.augmentation(i) * given.history().areas[i]);
        let acts = self.sum_up::<4>(scale)?;
        if has_row && self.numbers.is_some_and(|numbers| !numbers.points.is_covered[i]) {
            let own: &mut RowBlock = self.row.sums.of_multiplier(i)?;
            own[3][0] = -given.row_scale(i) / given.augmentation(i);
        }
        if acts {
            emitter.taker.sums(Place::Displacement(i), &self.row.sums.blocks(0));
        }
        if has_row {
            emitter.taker.sums(Place::Multiplier(i), &self.row.sums.blocks(3));
        }
        Ok(())
    }

    /// The rows of mortar node c.
    fn emit_mortar(&mut self, c: usize, emitter: &mut Emitter<N>) -> Result<()> {
        self.row.begin();
        for k in self.around.below(c).iter().map(|&k| k as usize) {
            match self.numbers {
                Some(numbers) => self.mortar(c, k, numbers)?,
                None => self.row.reach(&self.given.setup.nonmortar, self.around, k)?,
            }
        }
        if self.sum_up::<3>(0.0)? {
            let place = Place::Displacement(self.given.nodes() + c);
            emitter.taker.sums(place, &self.row.sums.blocks(0));
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
    let (surfaces, moves) = (given.setup.surfaces(), given.setup.effects.moves());
    let around = Around::of(surfaces, moves, pairs, numbers.map(|numbers| numbers.points))?;
    let motions = match numbers.and_then(|numbers| Some((numbers, numbers.active?))) {
        Some(numbers) => Some(of_facets(given, numbers, &around, emitter)?),
        None => None,
    };
    let own = given.setup.options.differentiates_weights();
    let slopes = Slopes::of((surfaces, &around, moves, own), numbers.map(|n| (n, Along::Normals(motions.as_ref()))))?;
    let (row, acting, slopes, around) = (Gathered::of(surfaces)?, Vec::new(), &slopes, &around);
    let mut rows = Rows { given, around, numbers, slopes, row, acting };
    (0..given.nodes()).try_for_each(|i| rows.emit_own(i, emitter))?;
    let mortar = if moves { given.setup.mortar.len() } else { 0 };
    (0..mortar).try_for_each(|c| rows.emit_mortar(c, emitter))
}
