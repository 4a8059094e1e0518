//! A tiny host: an elastic layer whose far side is a rigid plate, pressed on a mortar surface that is prescribed. The
//! plate turns and moves as one wishes; the layer is linear in the plate's frame. Its inner unknowns are eliminated.
#![allow(dead_code)]

use super::host::Body;
use super::mesh::{Create, Mesh, numbered};
use nalgebra::{DMatrix, DVector, Isometry3, SVector};
use stickslip::error::Error;
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Options, Surface};
use stickslip::law::State;

/// Newton steps at most.
const MOST_STEPS: usize = 40;
/// A step below this, relative to the unknowns, is rounding.
const CONVERGED: f64 = 1e-12;
/// Of positions of size 1, times what a solution of the system loses.
const ROUNDING: f64 = 1e-13;
/// Halvings of a step at most.
const MOST_HALVINGS: usize = 12;

/// Where the plate is and where the mortar nodes are.
#[derive(Clone)]
pub struct Place {
    pub plate: Isometry3<f64>,
    pub mortar: Vec<Vec3>,
}

/// Why a step was not taken.
#[derive(Debug)]
pub enum Failure {
    NotConverged,
    Refused(Error),
}

pub struct Press<const N: usize> {
    pub contact: Contact<N>,
    surface: Mesh,
    stiffness: DMatrix<f64>,
    /// Displacements of the surface in the plate's frame [L].
    pub u: DVector<f64>,
    pub lambda: Vec<SVector<f64, N>>,
}

impl<const N: usize> Press<N>
where
    Contact<N>: Create<N>,
{
    /// `body` as it is made, its far side on the plate.
    pub fn new(body: Body, mortar: Surface, options: Options) -> Press<N> {
        let m = body.surface.x.len();
        let k = |rows, columns| body.stiffness.view((rows, columns), (3 * m, 3 * m)).into_owned();
        let stiffness = k(0, 0); // the far side does not move against the plate
        let one = Surface::new("nonmortar", body.surface.x.clone(), &body.surface.facets, numbered(0, m)).unwrap();
        let mut contact = Contact::create(one, mortar, numbered(3 * m, m), options).unwrap();
        let lambda = contact.initial_multipliers().unwrap();
        Press { contact, surface: body.surface, stiffness, u: DVector::zeros(3 * m), lambda }
    }

    /// Positions of the layer's surface.
    pub fn positions(&self, place: &Place) -> Vec<Vec3> {
        let x = self.surface.x.iter().enumerate();
        x.map(|(a, x)| place.plate.rotation * (x + self.u.fixed_rows::<3>(3 * a)) + place.plate.translation.vector)
            .collect()
    }

    /// Equilibrium at a place, by Newton's method.
    pub fn solve(&mut self, place: &Place) -> Result<(), Failure> {
        let (n, m) = (self.u.len(), self.lambda.len());
        let turn = place.plate.rotation.to_rotation_matrix();
        for _ in 0..MOST_STEPS {
            let x1 = self.positions(place);
            let mut k = DMatrix::zeros(n + N * m, n + N * m);
            let mut r = DVector::zeros(n + N * m);
            let c = self.contact.residual(&x1, &place.mortar, &self.lambda, None).map_err(Failure::Refused)?;
            let mut sink = |i: i64, j: i64, v: f64| k[(i as usize, j as usize)] += v;
            self.contact.tangent(&x1, &place.mortar, &self.lambda, None, &mut sink).map_err(Failure::Refused)?;
            // Rows and columns of displacements into the plate's frame.
            for a in 0..m {
                let columns = k.fixed_columns::<3>(3 * a) * turn.matrix();
                k.fixed_columns_mut::<3>(3 * a).copy_from(&columns);
                let rows = turn.matrix().transpose() * k.fixed_rows::<3>(3 * a);
                k.fixed_rows_mut::<3>(3 * a).copy_from(&rows);
                r.fixed_rows_mut::<3>(3 * a).copy_from(&(turn.inverse() * c.nonmortar[a]));
                r.fixed_rows_mut::<N>(n + N * a).copy_from(&c.rows[a]);
            }
            let mut body = k.view_mut((0, 0), (n, n));
            body += &self.stiffness;
            let force = &self.stiffness * &self.u;
            let mut forces = r.rows_mut(0, n);
            forces += force;
            let Some(change) = k.lu().solve(&r) else { return Err(Failure::NotConverged) };
            self.u -= change.rows(0, n);
            for (a, lambda) in self.lambda.iter_mut().enumerate() {
                *lambda -= change.fixed_rows::<N>(n + N * a);
            }
            let largest = self.lambda.iter().map(|l| l.amax()).fold(f64::MIN_POSITIVE, f64::max);
            // Positions of size 1 have their rounding, and forces that of the stiffness times it.
            let small = change.rows(0, n).amax() <= CONVERGED * self.u.amax() + ROUNDING
                && change.rows(n, N * m).amax() <= CONVERGED * largest + ROUNDING * self.stiffness.amax();
            if small {
                return Ok(());
            }
        }
        Err(Failure::NotConverged)
    }

    /// Equilibrium at a place, accepted; nothing has changed where it fails.
    pub fn step(&mut self, place: &Place) -> Result<(), Failure> {
        let (u, lambda) = (self.u.clone(), self.lambda.clone());
        // Where the normals follow the motion; elsewhere they stay.
        let turned = self.contact.turn_multipliers(&self.positions(place), &self.lambda);
        let result = turned.map(|turned| self.lambda = turned).map_err(Failure::Refused);
        let result = result.and_then(|()| self.solve(place)).and_then(|()| {
            let x1 = self.positions(place);
            self.contact.commit(&x1, &place.mortar, &self.lambda, None).map_err(Failure::Refused)
        });
        if result.is_err() {
            (self.u, self.lambda) = (u, lambda);
        }
        result
    }

    /// From s = `from` to `to` in so many steps, halved where Newton's method or the library asks for it; how often.
    pub fn go(&mut self, (from, to): (f64, f64), steps: usize, place: &impl Fn(f64) -> Place) -> usize {
        let (mut at, mut cuts) = (from, 0);
        for k in 1..=steps {
            let target = from + (to - from) * k as f64 / steps as f64;
            let mut halvings = 0;
            while at != target {
                let next = if halvings == 0 { target } else { at + (target - at) / f64::from(1 << halvings) };
                match self.step(&place(next)) {
                    Ok(()) => (at, halvings) = (next, 0),
                    Err(failure) => {
                        (halvings, cuts) = (halvings + 1, cuts + 1);
                        assert!(halvings <= MOST_HALVINGS, "no way on from {at}: {failure:?}");
                    }
                }
            }
        }
        cuts
    }

    /// Force of the contact on the mortar side, and states, at a place with what is committed there.
    pub fn force(&mut self, place: &Place) -> (Vec3, Vec<State>) {
        let x1 = self.positions(place);
        let r = self.contact.residual(&x1, &place.mortar, &self.lambda, None).unwrap();
        let states = self.contact.responses(&x1, &place.mortar, &self.lambda, None).unwrap();
        (r.nonmortar.iter().sum(), states.iter().map(|r| r.state).collect())
    }
}
