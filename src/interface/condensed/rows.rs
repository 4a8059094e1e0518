//! The rows of a host's matrix that condensation changes, taken out of it and put back: J becomes L J + G in place
//! (docs/formulation 10.7).

use super::elimination::{Elimination, Row};
use crate::error::{Error, Result};
use crate::geometry::Mat3;
use crate::interface::data::csr::Csr;
use crate::interface::data::surface::{NO_EQUATION, Surface, node_equations};
use crate::interface::tangent::by_equations::Sink;
use crate::memory::{self, Store};

/// CondensedRows of a matrix, to be changed.
#[derive(Debug)]
pub struct CondensedRows<'a> {
    csr: Csr<'a>,
    /// Which, ascending.
    equations: Vec<i64>,
    /// Where each begins in `values`.
    starts: Vec<usize>,
    values: Vec<f64>,
    /// Why an entry found no place.
    refused: Option<Error>,
}

impl<'a> CondensedRows<'a> {
    /// The rows of these equations, those that there are, with what `value` says of each place.
    pub fn new(csr: Csr<'a>, mut equations: Vec<i64>, value: &dyn Fn(usize) -> f64) -> Result<CondensedRows<'a>> {
        equations.retain(|e| *e != NO_EQUATION);
        memory::sort(&mut equations)?;
        equations.dedup();
        let (mut starts, mut values) = (memory::with_room(equations.len())?, Vec::new());
        for &equation in &equations {
            starts.store(values.len())?;
            values.store_all(csr.row(equation)?.map(value))?;
        }
        Ok(CondensedRows { csr, equations, starts, values, refused: None })
    }

    /// The first entry that found no place is refused.
    pub fn check(&mut self) -> Result<()> {
        self.refused.take().map_or(Ok(()), Err)
    }

    /// Where a row begins here, and its places in the matrix.
    fn row(&self, equation: i64) -> Option<(usize, std::ops::Range<usize>)> {
        let k = self.equations.binary_search(&equation).ok()?;
        Some((self.starts[k], self.csr.row(equation).ok()?))
    }

    /// Adds `factor` times the entries of one row, as (column, value), to another.
    fn add_row(&mut self, equation: i64, entries: &[(i64, f64)], factor: f64) {
        for &(column, value) in entries.iter().filter(|_| factor != 0.0) {
            if value != 0.0 {
                self.add(equation, column, factor * value);
            }
        }
    }

    /// The entries of the rows of a node's equations.
    fn entries(&self, equations: &[i64; 3]) -> Result<[Vec<(i64, f64)>; 3]> {
        let mut entries = [const { Vec::new() }; 3];
        for (entries, &equation) in entries.iter_mut().zip(equations) {
            if let Some((start, places)) = self.row(equation) {
                let first = places.start;
                let entry = |place: usize| (self.csr.column(place), self.values[start + place - first]);
                entries.store_all(places.map(entry))?;
            }
        }
        Ok(entries)
    }

    /// Adds `block` times the rows of one node to those of another.
    fn transfer(&mut self, to: &[i64; 3], from: &[i64; 3], block: &Mat3) -> Result<()> {
        let entries = self.entries(from)?;
        for (i, &equation) in to.iter().enumerate().filter(|(_, e)| **e != NO_EQUATION) {
            for (j, entries) in entries.iter().enumerate() {
                self.add_row(equation, entries, block[(i, j)]);
            }
        }
        Ok(())
    }

    /// Replaces the rows of a node by `block` times them.
    fn multiply(&mut self, equations: &[i64; 3], block: &Mat3) -> Result<()> {
        let entries = self.entries(equations)?;
        for (i, &equation) in equations.iter().enumerate() {
            let Some((start, places)) = self.row(equation) else { continue };
            self.values[start..start + places.len()].fill(0.0);
            for (j, entries) in entries.iter().enumerate() {
                self.add_row(equation, entries, block[(i, j)]);
            }
        }
        Ok(())
    }

    /// J becomes L J.
    pub fn eliminate(&mut self, e: &Elimination, answers: &[Row], surfaces: (&Surface, &Surface)) -> Result<()> {
        // (C R)_B first: rows of nodes without multipliers are still the host's.
        for b in e.own() {
            for &(m, c) in e.hat(b) {
                let share = Mat3::from_diagonal_element(c);
                self.transfer(node_equations(surfaces, b), node_equations(surfaces, m), &share)?;
            }
        }
        for t in &e.transfers {
            self.transfer(node_equations(surfaces, t.row), node_equations(surfaces, t.own), &t.block)?;
        }
        for b in e.own() {
            self.multiply(node_equations(surfaces, b), &e.diagonal(b, &answers[b]))?;
        }
        Ok(())
    }

    /// Adds other rows of the same equations.
    pub fn add_rows(&mut self, other: &CondensedRows) {
        self.values.iter_mut().zip(&other.values).for_each(|(v, w)| *v += w);
    }

    /// The values in their places of the matrix.
    pub fn places(&self) -> impl Iterator<Item = (usize, f64)> {
        let rows = self.equations.iter().flat_map(|&e| self.csr.row(e).unwrap_or_default());
        rows.zip(self.values.iter().copied())
    }

    /// The values.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

impl Sink for CondensedRows<'_> {
    fn add(&mut self, row: i64, column: i64, value: f64) {
        match self.csr.place(row, column) {
            Ok(place) => {
                if let Some((start, places)) = self.row(row) {
                    self.values[start + place - places.start] += value;
                }
            }
            Err(error) => {
                self.refused.get_or_insert(error);
            }
        }
    }
}
