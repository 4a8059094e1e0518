//! Derivatives of a residual by what it depends on besides the unknowns, through the handle (docs/formulation.md 18): as a matrix, from
//! the left (an adjoint), from the right (a direction).

use super::compose::Feature;
use super::contact::Contact;
use super::data::active::Active;
use super::data::extent::Extent;
use super::data::options::Weights;
use super::data::setup::Setup;
use super::pairing::given::Given;
use super::sensitivity::carriers::through_shares;
use super::sensitivity::normals::through_normals;
use super::sensitivity::parameters::{Slipping, by_threshold, through_offsets, through_threshold};
use super::sensitivity::weights::{through_gaps, through_weights};
use super::sensitivity::{Answer, At, Column, Take, Wanted, weights_of};
use super::stages::acting::acting;
use super::stages::carried::carriers_sums;
use super::stages::sums::in_previous_gaps;
use super::tangent::by_equations::{Numbers, Sink};
use super::tangent::emission::Place;
use super::tangent::read::square;
use super::tangent::turning::{Turning, Turns};
use super::weights::facet::{FacetWeights, each_facet};
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::memory::{self, Stored};
use nalgebra::SVector;
use std::ops::Range;

/// Where everything stands in the vectors of residuals and of what they depend on.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// Nodes of both sides.
    nodes: [usize; 2],
    /// Components of a multiplier.
    components: usize,
}

impl Layout {
    /// What the residual's forces on one side have, three numbers a node; of what it depends on: the positions of now.
    pub fn now(&self, side: usize) -> Range<usize> {
        let first = 3 * self.nodes[0] * side;
        first..first + 3 * self.nodes[side]
    }

    /// The residual's rows of multipliers.
    pub fn rows(&self) -> Range<usize> {
        let first = 3 * (self.nodes[0] + self.nodes[1]);
        first..first + self.components * self.nodes[0]
    }

    /// The positions at t_n.
    pub fn previous(&self, side: usize) -> Range<usize> {
        let (all, now) = (3 * (self.nodes[0] + self.nodes[1]), self.now(side));
        all + now.start..all + now.end
    }

    /// mu of the non-mortar nodes.
    pub fn friction(&self) -> Range<usize> {
        let first = self.previous(1).end;
        first..first + self.nodes[0]
    }

    /// The largest shear traction.
    pub fn shear_limit(&self) -> usize {
        self.friction().end
    }

    /// The offsets.
    pub fn offsets(&self, side: usize) -> Range<usize> {
        let first = self.shear_limit() + 1 + self.nodes[0] * side;
        first..first + self.nodes[side]
    }

    /// The first place of a column.
    fn place(&self, column: Column) -> usize {
        match column {
            Column::Previous(node) => self.previous(0).start + 3 * node,
            Column::Friction(a) => self.friction().start + a,
            Column::ShearLimit => self.shear_limit(),
            Column::Offset(node) => self.offsets(0).start + node,
        }
    }

    /// Numbers of a residual.
    pub fn residual(&self) -> usize {
        self.rows().end
    }

    /// Numbers of what it depends on.
    pub fn arguments(&self) -> usize {
        self.offsets(1).end
    }
}

/// Takes derivatives, with what the interface is.
type TakeWith<'a, const N: usize> = dyn FnMut(&Setup<N>, Place, Column, &[f64]) + 'a;

/// The residual's places as equations.
struct Natural<const N: usize> {
    sides: [Vec<[i64; 3]>; 2],
    multipliers: Vec<[i64; N]>,
}

impl<const N: usize> Natural<N> {
    fn of(layout: &Layout) -> Result<Self> {
        let side = |side: usize| {
            let first = layout.now(side).start;
            (0..layout.nodes[side]).map(move |k| std::array::from_fn(|i| (first + 3 * k + i) as i64)).stored()
        };
        let first = layout.rows().start;
        let multipliers = (0..layout.nodes[0]).map(|a| std::array::from_fn(|i| (first + N * a + i) as i64)).stored()?;
        Ok(Natural { sides: [side(0)?, side(1)?], multipliers })
    }

    fn numbers(&self) -> Numbers<'_, N> {
        Numbers { sides: [&self.sides[0], &self.sides[1]], multipliers: &self.multipliers }
    }
}

impl<const N: usize> Contact<N> {
    /// Where everything stands.
    pub fn layout(&self) -> Layout {
        Layout { nodes: [self.setup.nonmortar.len(), self.setup.mortar.len()], components: N }
    }

    /// d residual / d (positions of t_n) at (x, lambda), in the host's equations.
    ///
    /// # Errors
    /// Those of a residual; [`Kind::Unsupported`].
    pub fn previous_tangent(&mut self, x: [&[Vec3]; 2], lambda: &[SVector<f64, N>], sink: &mut dyn Sink) -> Result<()> {
        let wanted = Wanted { previous: true, parameters: false };
        self.differentiate(x, lambda, wanted, &mut |setup, row, column, values| {
            let numbers = Numbers::of(setup);
            let acts = !matches!(row, Place::Multiplier(a) if !setup.nodes.acts(a));
            if let (true, Column::Previous(node)) = (acts, column) {
                sink.add_block(numbers.place(row), numbers.place(Place::Displacement(node)), values);
            }
        })
    }

    /// a^T d residual / d (what it depends on): `a` and the answer as [`Layout`] says. `now`: with the positions of now.
    ///
    /// # Errors
    /// As [`Contact::previous_tangent`]; also where a mortar side that does not move is asked for its positions of now.
    pub fn adjoint(
        &mut self,
        x: [&[Vec3]; 2],
        lambda: &[SVector<f64, N>],
        a: &[f64],
        (wanted, now): (Wanted, [bool; 2]),
    ) -> Result<Vec<f64>> {
        let layout = self.layout();
        let (natural, mut products) = (Natural::<N>::of(&layout)?, memory::filled(0.0, layout.arguments())?);
        self.differentiate(x, lambda, wanted, &mut |_, place, column, values| {
            let rows = natural.numbers().place(place);
            for (to, values) in products[layout.place(column)..].iter_mut().zip(values.chunks_exact(rows.len())) {
                *to += rows.iter().zip(values).map(|(&row, v)| a[row as usize] * v).sum::<f64>();
            }
        })?;
        self.by_positions_of_now(x, lambda, (&natural, now), &mut |row: i64, column: i64, value: f64| {
            if let Some(to) = products[..layout.rows().start].get_mut(column as usize) {
                *to += a[row as usize] * value;
            }
        })?;
        Ok(products)
    }

    /// d residual / d (what it depends on) along a direction: both as [`Layout`] says.
    ///
    /// # Errors
    /// As [`Contact::adjoint`].
    pub fn sensitivity(
        &mut self,
        x: [&[Vec3]; 2],
        lambda: &[SVector<f64, N>],
        along: &[f64],
        (wanted, now): (Wanted, [bool; 2]),
    ) -> Result<Vec<f64>> {
        let layout = self.layout();
        let (natural, mut change) = (Natural::<N>::of(&layout)?, memory::filled(0.0, layout.residual())?);
        self.differentiate(x, lambda, wanted, &mut |_, place, column, values| {
            let rows = natural.numbers().place(place);
            for (by, values) in along[layout.place(column)..].iter().zip(values.chunks_exact(rows.len())) {
                rows.iter().zip(values).for_each(|(&row, v)| change[row as usize] += by * v);
            }
        })?;
        self.by_positions_of_now(x, lambda, (&natural, now), &mut |row: i64, column: i64, value: f64| {
            if let Some(by) = along[..layout.rows().start].get(column as usize) {
                change[row as usize] += by * value;
            }
        })?;
        Ok(change)
    }

    /// The tangent's columns of positions, where they are asked for.
    fn by_positions_of_now(
        &mut self,
        x: [&[Vec3]; 2],
        lambda: &[SVector<f64, N>],
        (natural, now): (&Natural<N>, [bool; 2]),
        sink: &mut dyn Sink,
    ) -> Result<()> {
        if now[1] && !self.setup.effects.moves() {
            let text = "positions of now of a mortar side without equations: its forces are not differentiated; give its nodes equations";
            return Err(Error::new(Kind::Unsupported, text));
        }
        if now == [false; 2] {
            return Ok(());
        }
        self.linearise_by_equations((x[0], x[1]), lambda, Extent::Whole, (None, Some(natural.numbers())), (sink, None))
    }

    /// Gives the derivatives, with the host's equations and whether a row is one of this handle.
    fn differentiate(
        &mut self,
        x: [&[Vec3]; 2],
        lambda: &[SVector<f64, N>],
        wanted: Wanted,
        take: &mut TakeWith<N>,
    ) -> Result<()> {
        self.setup.refuse(&[(Feature::Derivatives, true)])?;
        if let Some(edge) = self.step.pairing.corners.edges.first() {
            let text = text!(
                "derivatives where copies of a node touch as one (non-mortar nodes {:?}): their normal is that of the mortar face at t_n, which is not differentiated; move the edge off the face",
                edge.sides
            );
            return Err(Error::new(Kind::Unsupported, text));
        }
        let at = (x[0], x[1]);
        self.cache.respond(&self.setup, &mut self.step, at, lambda, None)?;
        self.cache.complete(&self.setup, &mut self.step)?;
        let (surfaces, history) = (self.setup.surfaces(), &self.step.history);
        let follows = self.setup.options.effective_weights() == Weights::Current;
        let mut active = Active::default();
        if let (true, true, Some(filter)) = (wanted.previous, follows, &self.step.pairing.filter) {
            let before = (&history.x1[..], &history.x2[..]);
            acting(surfaces, &self.setup.options, filter, &mut self.cache.work, before, &mut active)?;
        }
        let (setup, step) = (&self.setup, &self.step);
        let given = Given { setup, step };
        let pairs = self.cache.weighted(surfaces, history);
        let weights = weights_of(surfaces, [pairs, history.weighted(surfaces)])?;
        let (normals, known) = (given.normals()?, self.cache.answers());
        let (sums, responses) = (&known.sums[..], &known.responses);
        let answer = |a: usize| {
            let (of, scale) = (&responses.nodes[a], if setup.nodes.is_own(a) { given.row_scale(a) } else { 0.0 });
            let by_gap = [of.drow_dnow, of.drow_dprevious].map(|by| square(&by) * scale);
            let lambda = Vec3::from_fn(|i, _| lambda[a].get(i).copied().unwrap_or(0.0));
            Answer { by_gap, lambda, scale, augmentation: given.augmentation(a) }
        };
        let answers = (0..given.nodes()).map(answer).stored()?;
        let slip = setup.effects.law.slips.then(|| setup.options.effective_slip().coefficients().1);
        let at = At {
            surfaces,
            step,
            nodes: &setup.nodes,
            components: N,
            slip,
            start: f64::from(!setup.options.friction.law().opens),
            x,
            sums,
            answers: &answers,
            carried: &responses.carried,
            normals: &normals,
            weights: &weights,
        };
        let mut give = |row: Place, column: Column, values: &[f64]| take(setup, row, column, values);
        let take: &mut Take = &mut give;
        if wanted.previous {
            through_gaps(&at, take);
            through_shares(&at, take)?;
            if follows && slip.is_some() {
                let through = &mut |facet: &FacetWeights| through_weights(&at, (&active, facet), take);
                each_facet((given, &normals), (&active, responses), through)?;
            }
            let keeps = |a: usize| step.now.is_none() || step.pairing.keeps_normal[a];
            if follows && setup.nodes.normals.is_none() && (0..given.nodes()).any(keeps) {
                let (mut corner_sums, mut room) = (Vec::new(), Vec::new());
                surfaces.0.add_normals(&history.x1, &mut corner_sums)?;
                let turning = Turning { x1: &history.x1, corner_sums: &corner_sums, turns: &keeps };
                let (of, scale) = ((pairs, sums, responses), &|a| given.row_scale(a));
                let turns = Turns::of(given, turning, lambda, of, &normals, scale, &mut room)?;
                through_normals(&at, given, &turns, take);
            }
        }
        if wanted.parameters {
            let shared = carriers_sums(given, sums, &responses.carried, &normals)?;
            for (a, response) in responses.nodes.iter().enumerate().filter(|_| N == 3) {
                let sums = shared.binary_search_by_key(&a, |(b, _)| *b).map_or(&sums[a], |k| &shared[k].1);
                let slipping = Slipping { lambda: &lambda[a], sums, response };
                let is_carried = responses.carried.get(a).is_some_and(|is| *is);
                if let Some(by) = if is_carried { None } else { by_threshold(given, a, slipping)? } {
                    through_threshold(&at, a, by, take);
                }
            }
            // The offsets of now are in both gaps where slip is a difference of the two, and where weights are frozen.
            let both = slip.is_some() && (in_previous_gaps(given) || !setup.options.differentiates_weights());
            through_offsets(&at, both, take);
        }
        Ok(())
    }
}
