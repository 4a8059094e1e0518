//! A system without multipliers through the handle: what a host multiplies and adds, in pieces or in place, and the
//! multipliers back (docs/formulation 10.7).

use super::compose::Feature;
use super::condensed::elimination::{Elimination, Row, widened};
use super::condensed::pattern::Columns;
use super::condensed::refusal::refuse;
use super::condensed::rows::CondensedRows;
use super::contact::Contact;
use super::data::csr::Csr;
use super::data::extent::Extent;
use super::data::node_data::check_length;
use super::data::surface::NO_EQUATION;
use super::linear::PlanPairs;
use super::pairing::given::{Given, check_finite};
use super::plan::pattern::System;
use super::stages::carried::carried;
use super::stages::residual;
use super::tangent::by_equations::Sink;
use super::tangent::union::possible_pairs;
use crate::error::{Error, Result};
use crate::geometry::Vec3;
use crate::memory::{self, Store, Stored};
use nalgebra::SVector;

/// A piece of the condensed matrix L J_uu + G.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Piece {
    /// What the contact forces add to J_uu: their derivative at fixed multipliers.
    Forces,
    /// L - I.
    Elimination,
    /// G.
    Constraints,
    /// What G lacks where multipliers follow from the displacements: c_A Ds_A.
    Scales,
    /// E_L - I: rows of the reduced form.
    ReductionRows,
    /// E_R - I: its columns.
    ReductionColumns,
    /// Q: the directions of its constraints.
    Constrained,
    /// s D Q: what these have in its matrix.
    ConstraintDiagonal,
}

impl<const N: usize> Contact<N> {
    /// The elimination at x.
    fn elimination(&mut self, x: (&[Vec3], &[Vec3])) -> Result<Elimination> {
        let sums = memory::copied(self.cache.sums(&self.setup, &mut self.step, x, Extent::Whole)?)?;
        let (given, pairs) = (self.given(), self.cache.weighted(self.setup.surfaces(), &self.step.history));
        let normals = given.normals()?;
        refuse(given, &normals)?;
        Elimination::of(given, &normals, pairs, &sums, &carried(given, &sums)?)
    }

    /// The same, with the multipliers in force and the law's answers to them.
    fn eliminated(
        &mut self,
        x: (&[Vec3], &[Vec3]),
        lambda: &[SVector<f64, N>],
    ) -> Result<(Elimination, Vec<SVector<f64, N>>)> {
        check_length("lambda", lambda.len(), self.setup.nonmortar.len())?;
        check_finite("lambda", lambda)?;
        let elimination = self.elimination(x)?;
        let lambda = elimination.completed(&self.step.pairing.carriers, lambda.iter().map(widened).stored()?);
        let lambda = narrowed(&lambda)?;
        self.cache.respond(&self.setup, &mut self.step, x, &lambda, None)?;
        Ok((elimination, lambda))
    }

    /// The multipliers that balance `host`, the residual of the host's own forces at the non-mortar nodes `[F]`.
    pub fn condensed_multipliers(&mut self, x1: &[Vec3], x2: &[Vec3], host: &[Vec3]) -> Result<Vec<SVector<f64, N>>> {
        check_length("host", host.len(), self.setup.nonmortar.len())?;
        let elimination = self.elimination((x1, x2))?;
        narrowed(&elimination.multipliers(&self.step.pairing.carriers, host)?)
    }

    /// The multiplier rows at the last point.
    fn rows(&self) -> Result<Vec<Row>> {
        let gives_way = self.setup.layer.is_some();
        let row = |response| if gives_way { Row::of(response).unreduced() } else { Row::of(response) };
        self.cache.answers().responses.nodes.iter().map(row).stored()
    }

    /// The rows of the non-mortar nodes, and what is added to those of the mortar nodes; `host` as above. Of a node whose multiplier
    /// acts elsewhere: what is added to its rows.
    pub fn condensed_residual(
        &mut self,
        x1: &[Vec3],
        x2: &[Vec3],
        lambda: &[SVector<f64, N>],
        host: &[Vec3],
    ) -> Result<(Vec<Vec3>, Vec<Vec3>)> {
        check_length("host", host.len(), self.setup.nonmortar.len())?;
        let (elimination, lambda) = self.eliminated((x1, x2), lambda)?;
        let (given, responses) = (self.given(), &self.cache.answers().responses.nodes);
        let mut forces =
            residual::residual(given, self.cache.weighted(self.setup.surfaces(), given.history()), &lambda, responses)?;
        let acting = (0..host.len()).filter(|&a| given.setup.nodes.acts(a));
        acting.for_each(|a| forces.nonmortar[a] += host[a]);
        let (rows, gains) = elimination.residual(&forces.nonmortar, forces.mortar.len(), &self.rows()?)?;
        forces.mortar.iter_mut().zip(gains).for_each(|(force, gain)| *force += gain);
        Ok((rows, forces.mortar))
    }

    /// A piece of the condensed matrix.
    pub fn condensed_tangent(
        &mut self,
        (x1, x2): (&[Vec3], &[Vec3]),
        lambda: &[SVector<f64, N>],
        piece: Piece,
        sink: &mut dyn Sink,
    ) -> Result<()> {
        let (elimination, lambda) = self.eliminated((x1, x2), lambda)?;
        let mut nowhere = |_: i64, _: i64, _: f64| {};
        let scales = elimination.scales()?;
        let sinks: (&mut dyn Sink, &mut dyn Sink) = match piece {
            Piece::Forces => (sink, &mut nowhere),
            Piece::Constraints => (&mut nowhere, sink),
            Piece::Scales => return self.scale_derivatives((x1, x2), &elimination, sink),
            Piece::Elimination => {
                elimination.entries(&self.rows()?, self.setup.surfaces(), sink);
                return Ok(());
            }
            Piece::ReductionRows => {
                elimination.reduction_rows(&self.rows()?, self.setup.surfaces(), sink);
                return Ok(());
            }
            Piece::ReductionColumns => {
                elimination.reduction_columns(&self.rows()?, self.setup.surfaces(), sink);
                return Ok(());
            }
            Piece::Constrained | Piece::ConstraintDiagonal => {
                let scaled = piece == Piece::ConstraintDiagonal;
                elimination.constrained(&self.rows()?, scaled, self.setup.surfaces(), sink);
                return Ok(());
            }
        };
        self.linearise_by_equations((x1, x2), &lambda, Extent::Whole, (Some(&scales), None), (sinks.0, Some(sinks.1)))
    }

    /// Makes the plans of forces and constraints of these pairs at x.
    pub fn make_condensed_plan(&mut self, x: (&[Vec3], &[Vec3]), of: PlanPairs) -> Result<()> {
        let given = self.given();
        given.check_positions(x.0, x.1)?;
        refuse(given, &given.normals()?)?;
        self.linear.condensed = Some(self.plans(x, of, [System::Forces, System::Constraints])?);
        Ok(())
    }

    /// Forces and constraints in the order of their plans. After an error the values mean nothing.
    pub fn condensed_values(
        &mut self,
        x: (&[Vec3], &[Vec3]),
        lambda: &[SVector<f64, N>],
        values: [&mut [f64]; 2],
    ) -> Result<()> {
        self.plan(System::Forces)?;
        let (elimination, lambda) = self.eliminated(x, lambda)?;
        let scales = elimination.scales()?;
        self.fill_condensed((x, &lambda, (Extent::Whole, Some(&scales))), values)
    }

    /// T_A r_A c_A times DD_A in the rows of A: the forces at A of multipliers r_A c_A, differentiated at fixed multipliers.
    fn scale_derivatives(
        &mut self,
        x: (&[Vec3], &[Vec3]),
        elimination: &Elimination,
        sink: &mut dyn Sink,
    ) -> Result<()> {
        let lambda = narrowed(&elimination.traction_changes(&self.rows()?)?)?;
        let nonmortar = &self.setup.nonmortar.equations;
        // Which rows the rows of each equation are gathered in, and their shares.
        let mut rows = Vec::new();
        for (a, own) in nonmortar.iter().enumerate() {
            // What dual multipliers of linear facets do to other nodes' rows is 0.
            if self.setup.has_parents() && elimination.scale(a) == 0.0 {
                continue;
            }
            rows.store_all(own.iter().map(|&e| (e, e, 1.0)))?;
            for &(m, c) in elimination.hat(a) {
                rows.store_all(nonmortar[m].iter().zip(own).map(|(&from, &to)| (from, to, c)))?;
            }
        }
        let rows = memory::sorted(&rows, |p, q| (p.0, p.1).cmp(&(q.0, q.1)))?;
        let mut forces = |row: i64, column: i64, value: f64| {
            let first = rows.partition_point(|r| r.0 < row);
            let mut last = None;
            for &(_, to, c) in rows[first..].iter().take_while(|r| r.0 == row && r.1 != NO_EQUATION) {
                // Nodes may share an equation.
                if last.replace(to) != Some(to) {
                    sink.add(to, column, c * value);
                }
            }
        };
        let (mut nowhere, scales) = (|_: i64, _: i64, _: f64| {}, memory::filled(0.0, nonmortar.len())?);
        self.linearise_by_equations(x, &lambda, Extent::Whole, (Some(&scales), None), (&mut forces, Some(&mut nowhere)))
    }

    /// Turns the host's own matrix into the condensed one: the rows that change, with their new values.
    pub fn condense<'a>(
        &mut self,
        (x1, x2): (&[Vec3], &[Vec3]),
        lambda: &[SVector<f64, N>],
        csr: Csr<'a>,
        value: &dyn Fn(usize) -> f64,
    ) -> Result<CondensedRows<'a>> {
        self.setup.refuse(&[(Feature::InPlace, true)])?;
        let (elimination, lambda) = self.eliminated((x1, x2), lambda)?;
        let scales = elimination.scales()?;
        let (one, two) = self.setup.surfaces();
        let mut changed = Vec::new();
        for equations in [&one.equations, &two.equations] {
            changed.store_all(equations.as_flattened().iter().copied())?;
        }
        let mut rows = CondensedRows::new(csr, memory::copied(&changed)?, value)?;
        let mut constraints = CondensedRows::new(csr, changed, &|_| 0.0)?;
        self.linearise_by_equations(
            (x1, x2),
            &lambda,
            Extent::Whole,
            (Some(&scales), None),
            (&mut rows, Some(&mut constraints)),
        )?;
        rows.eliminate(&elimination, &self.rows()?, self.setup.surfaces())?;
        rows.check()?;
        constraints.check()?;
        rows.add_rows(&constraints);
        Ok(rows)
    }

    /// The entries of the condensed matrix that the interface may need while the surfaces slide by less than a quarter of
    /// a facet; `csr` is the host's own pattern.
    pub fn condensed_pattern(&mut self, x1: &[Vec3], x2: &[Vec3], csr: &Csr, sink: &mut dyn Sink) -> Result<()> {
        let given = self.given();
        given.check_positions(x1, x2)?;
        given.setup.refuse(&[(Feature::InPlace, true)])?;
        refuse(given, &given.normals()?)?;
        let mut columns = Columns::of(&self.setup.nonmortar.equations, csr)?;
        let (mut forces, mut constraints) = (Noted::default(), Noted::default());
        self.superset((x1, x2), (&mut forces, Some(&mut constraints)))?;
        for (row, column) in forces.entries()? {
            columns.add(row, column)?;
            sink.add(row, column, 0.0);
        }
        constraints.entries()?.into_iter().for_each(|(row, column)| sink.add(row, column, 0.0));
        columns.settle()?;
        let given = Given { setup: &self.setup, step: &self.step };
        let pairs = possible_pairs(given, &mut self.cache.work.tree, (x1, x2))?;
        let (carriers, moves) = (&self.step.pairing.carriers, self.setup.mortar_moves());
        columns.entries(self.setup.surfaces(), carriers, (&pairs, moves), sink)
    }
}

/// The components of multipliers that there are.
fn narrowed<const N: usize>(lambda: &[Vec3]) -> Result<Vec<SVector<f64, N>>> {
    lambda.iter().map(|l| SVector::from_fn(|i, _| l[i])).stored()
}

/// Entries without values.
#[derive(Default)]
struct Noted {
    entries: Vec<(i64, i64)>,
    refused: Option<Error>,
}

impl Noted {
    /// Each once.
    fn entries(mut self) -> Result<Vec<(i64, i64)>> {
        self.refused.take().map_or(Ok(()), Err)?;
        memory::sort(&mut self.entries)?;
        self.entries.dedup();
        Ok(self.entries)
    }
}

impl Sink for Noted {
    fn add(&mut self, row: i64, column: i64, _value: f64) {
        if let Err(error) = self.entries.store((row, column)) {
            self.refused.get_or_insert(error);
        }
    }
}
