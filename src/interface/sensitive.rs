//! Derivatives of a residual by what it depends on besides the unknowns, through the handle (docs/formulation 18): as a matrix, from
//! the left (an adjoint), from the right (a direction).

use super::compose::Feature;
use super::contact::Contact;
use super::data::active::Active;
use super::data::extent::Extent;
use super::data::options::Weights;
use super::data::setup::Setup;
use super::pairing::given::Given;
use super::sensitivity::derivatives::{Known, derivatives};
use super::sensitivity::layout::{Layout, Natural};
use super::sensitivity::{Column, Wanted};
use super::stages::acting::acting;
use super::tangent::by_equations::{Numbers, Sink};
use super::tangent::emission::Place;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::memory;
use nalgebra::SVector;

/// Takes derivatives, with what the interface is.
type TakeWith<'a, const N: usize> = dyn FnMut(&Setup<N>, Place, Column, &[f64]) + 'a;

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

    /// Gives the derivatives at (x, lambda), at which it evaluates.
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
        let setup = &self.setup;
        let given = Given { setup, step: &self.step };
        let (answers, pairs) = (self.cache.answers(), self.cache.weighted(surfaces, history));
        let known = Known { given, x, lambda, pairs, sums: &answers.sums, responses: &answers.responses };
        let mut give = |row: Place, column: Column, values: &[f64]| take(setup, row, column, values);
        derivatives(known, wanted, follows.then_some(&active), &mut give)
    }
}
