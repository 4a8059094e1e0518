//! A tiny host: elastic bodies with known stiffness on one rigid body with six unknowns, or three, a dense Newton method.
#![allow(dead_code)]

use super::mesh::{Create, Mesh};
use nalgebra::{DMatrix, DVector, Matrix3, SVector};
use stickslip::geometry::{AnalyticShape, Vec3};
use stickslip::interface::{Contact, NO_EQUATION, Options, Surface};
use stickslip::line::Measure;
use stickslip::rigid::{Body, Levers, Motion, RigidPlan, SIX, turned};

/// Newton steps at most.
const MOST_STEPS: usize = 40;
/// A step below this, relative to the unknowns, is rounding of a matrix with a condition of 1e4.
const CONVERGED: f64 = 1e-11;
/// Of positions of size 1, times what a solution of the system loses; of the stiffness what the multipliers lose so.
const ROUNDING: f64 = 1e-14;

/// The surface of an elastic body, its stiffness there, and forces on it where the rigid body is absent.
pub struct Elastic {
    pub surface: Mesh,
    /// Of the surface's displacements, `dimension` a node.
    pub stiffness: DMatrix<f64>,
    /// Of what else loads the body.
    pub load: DVector<f64>,
}

/// One interface for each elastic body.
pub struct Contacts<const N: usize> {
    pub contacts: Vec<Contact<N>>,
    pub elastic: Vec<Elastic>,
    /// Whether the elastic body has the multipliers.
    elastic_first: bool,
    pub dimension: usize,
    /// The rigid body's surface towards each of them.
    pub rigid: Vec<Mesh>,
    pub point: Vec3,
    /// Which of the six are unknown.
    free: [bool; SIX],
    /// Displacements of the elastic surfaces, multipliers, the body's displacement and rotation of the step.
    pub u: Vec<DVector<f64>>,
    pub lambda: Vec<Vec<SVector<f64, N>>>,
    pub q: SVector<f64, SIX>,
    pub turned: Matrix3<f64>,
    /// Force and moment on the body at its reference point.
    pub load: SVector<f64, SIX>,
}

fn flat(v: &[Vec3], dimension: usize) -> Vec<f64> {
    v.iter().flat_map(|v| v.iter().copied().take(dimension)).collect()
}

impl<const N: usize> Contacts<N>
where
    Contact<N>: Create<N>,
{
    /// `measure`: of lines. A rigid surface without facets is a ball of radius 1, its nodes the frame.
    pub fn new(
        elastic: Vec<Elastic>,
        (rigid, point, free): (Vec<Mesh>, Vec3, [bool; SIX]),
        elastic_first: bool,
        measure: Option<Measure>,
        options: &Options,
    ) -> Contacts<N> {
        let dimension = if measure.is_some() { 2 } else { 3 };
        let per = if measure.is_some() && N == 3 { 2 } else { N };
        let (mut contacts, mut lambda) = (Vec::new(), Vec::new());
        let displacements: usize = elastic.iter().map(|body| body.stiffness.nrows()).sum();
        let multipliers = |k: usize| if elastic_first { elastic[k].surface.x.len() } else { rigid[k].x.len() };
        let all: usize = displacements + (0..elastic.len()).map(|k| per * multipliers(k)).sum::<usize>() + SIX;
        let (mut first, mut at, mut shadow) = (0, displacements, all);
        for (k, body) in elastic.iter().enumerate() {
            let equations = |first: usize, n: usize| -> Vec<[i64; 3]> {
                let of = |a, i| if i < dimension { (first + dimension * a + i) as i64 } else { NO_EQUATION };
                (0..n).map(|a| [0, 1, 2].map(|i| of(a, i))).collect()
            };
            let surface = |side, mesh: &Mesh, equations| match measure {
                None if mesh.facets.is_empty() => {
                    let mut ball = Surface::analytic(side, AnalyticShape::Sphere(1.0), mesh.x.clone()).unwrap();
                    ball.equations = equations;
                    ball
                }
                None => Surface::new(side, mesh.x.clone(), &mesh.facets, equations).unwrap(),
                Some(measure) => Surface::of_lines(side, mesh.x.clone(), &mesh.facets, equations, measure).unwrap(),
            };
            let (n, m) = (body.surface.x.len(), rigid[k].x.len());
            let (of_body, of_rigid) = (equations(first, n), equations(shadow, m));
            let [one, two] = if elastic_first {
                [surface("nonmortar", &body.surface, of_body), surface("mortar", &rigid[k], of_rigid)]
            } else {
                [surface("nonmortar", &rigid[k], of_rigid), surface("mortar", &body.surface, of_body)]
            };
            let rows = (0..multipliers(k))
                .map(|a| std::array::from_fn(|i| if i < per { (at + per * a + i) as i64 } else { NO_EQUATION }));
            let mut contact = Contact::create(one, two, rows.collect(), *options).unwrap();
            lambda.push(contact.initial_multipliers().unwrap());
            contacts.push(contact);
            (first, at, shadow) = (first + dimension * n, at + per * multipliers(k), shadow + dimension * m);
        }
        let u = elastic.iter().map(|body| DVector::zeros(body.stiffness.nrows())).collect();
        let (q, turned, load) = (SVector::zeros(), Matrix3::identity(), SVector::zeros());
        Contacts { contacts, elastic, elastic_first, dimension, rigid, point, free, u, lambda, q, turned, load }
    }

    pub fn motion(&self) -> Motion {
        Motion::new(self.q.fixed_rows::<3>(0).into(), self.q.fixed_rows::<3>(3).into(), self.turned, Levers::End)
            .unwrap()
    }

    fn positions(&self, k: usize) -> (Vec<Vec3>, Vec<Vec3>) {
        let d = self.dimension;
        let moved = |(a, x): (usize, &Vec3)| x + Vec3::from_fn(|i, _| if i < d { self.u[k][d * a + i] } else { 0.0 });
        let elastic = self.elastic[k].surface.x.iter().enumerate().map(moved).collect();
        let coordinates = flat(&self.rigid[k].x, d);
        let body = Body { point: self.point, coordinates: &coordinates, dimension: d };
        let rigid = body.positions(&self.motion()).collect();
        if self.elastic_first { (elastic, rigid) } else { (rigid, elastic) }
    }

    /// Newton's method; the number of steps it took, and entries of the matrix that are the rigid body's.
    pub fn solve(&mut self) -> (usize, usize) {
        let (d, per) = (self.dimension, if self.dimension == 2 && N == 3 { 2 } else { N });
        let displacements: usize = self.u.iter().map(DVector::len).sum();
        let all = displacements + self.lambda.iter().map(|l| per * l.len()).sum::<usize>() + SIX;
        let last = all - SIX;
        for step in 0..MOST_STEPS {
            let (mut k, mut r) = (DMatrix::zeros(all, all), DVector::zeros(all));
            let (mut first, mut at, mut shadow) = (0, displacements, all);
            let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
            let (mut equations, mut coordinates, mut forces) = (Vec::new(), Vec::new(), Vec::new());
            for c in 0..self.contacts.len() {
                let (x1, x2) = self.positions(c);
                let n = self.u[c].len();
                k.view_mut((first, first), (n, n)).copy_from(&self.elastic[c].stiffness);
                let own = &self.elastic[c].stiffness * &self.u[c] - &self.elastic[c].load;
                r.rows_mut(first, n).copy_from(&own);
                let residual = self.contacts[c].residual(&x1, &x2, &self.lambda[c], None).unwrap();
                let (of_elastic, of_rigid) = if self.elastic_first {
                    (&residual.nonmortar, &residual.mortar)
                } else {
                    (&residual.mortar, &residual.nonmortar)
                };
                flat(of_elastic, d).iter().enumerate().for_each(|(i, f)| r[first + i] += f);
                forces.extend(flat(of_rigid, d));
                let of_rows = residual.rows.iter().flat_map(|row| row.iter().copied().take(per));
                of_rows.enumerate().for_each(|(i, v)| r[at + i] += v);
                let mut sink = |i: i64, j: i64, v: f64| {
                    rows.push(i);
                    columns.push(j);
                    values.push(v);
                };
                self.contacts[c].tangent(&x1, &x2, &self.lambda[c], None, &mut sink).unwrap();
                let m = self.rigid[c].x.len();
                equations.extend((shadow..shadow + d * m).map(|e| e as i64));
                coordinates.extend(flat(&self.rigid[c].x, d));
                (first, at, shadow) = (first + n, at + per * self.lambda[c].len(), shadow + d * m);
            }
            let body = Body { point: self.point, coordinates: &coordinates, dimension: d };
            let motion = self.motion();
            let resultant = body.resultant(&motion, &forces);
            (0..SIX).for_each(|i| r[last + i] = resultant[i / 3][i % 3] - self.load[i]);
            let six = std::array::from_fn(|i| if self.free[i] { (last + i) as i64 } else { NO_EQUATION });
            let bodies = [(body, &equations[..], six)];
            let mut plan = RigidPlan::new(&bodies, rows.into_iter(), columns.into_iter()).unwrap();
            let mut entries = vec![0.0; plan.places().len()];
            plan.values(&[motion], &forces, &values, &mut entries);
            let mut rigid = 0;
            for (&(i, j), v) in plan.places().iter().zip(&entries) {
                k[(i as usize, j as usize)] += v;
                rigid += usize::from(i as usize >= last || j as usize >= last);
            }
            for i in (0..SIX).filter(|i| !self.free[*i]).map(|i| last + i) {
                (k[(i, i)], r[i]) = (1.0, 0.0);
            }
            let change = k.lu().solve(&r).expect("the body is held and the multipliers are independent");
            let (mut first, mut at, mut largest) = (0, displacements, [0.0_f64; 4]);
            for c in 0..self.contacts.len() {
                let n = self.u[c].len();
                self.u[c] -= change.rows(first, n);
                largest[0] = largest[0].max(change.rows(first, n).amax());
                largest[1] = largest[1].max(self.u[c].amax());
                for (a, lambda) in self.lambda[c].iter_mut().enumerate() {
                    for i in 0..per {
                        lambda[i] -= change[at + per * a + i];
                        largest[2] = largest[2].max(change[at + per * a + i].abs());
                        largest[3] = largest[3].max(lambda[i].abs());
                    }
                }
                (first, at) = (first + n, at + per * self.lambda[c].len());
            }
            self.q -= change.fixed_rows::<SIX>(last);
            let stiffest = self.elastic.iter().map(|body| body.stiffness.amax()).fold(0.0, f64::max);
            if largest[0] <= CONVERGED * largest[1] + ROUNDING
                && largest[2] <= CONVERGED * largest[3] + ROUNDING * stiffest
            {
                return (step, rigid);
            }
        }
        panic!("no convergence in {MOST_STEPS} steps");
    }

    /// Accepts the step.
    pub fn commit(&mut self) {
        for c in 0..self.contacts.len() {
            let (x1, x2) = self.positions(c);
            self.contacts[c].commit(&x1, &x2, &self.lambda[c], None).unwrap();
        }
        let theta: Vec3 = self.q.fixed_rows::<3>(3).into();
        self.turned = turned(&theta, &self.turned);
        self.q.fixed_rows_mut::<3>(3).fill(0.0);
    }

    /// Force of contact `c` on the elastic body's nodes, with the sign of internal forces.
    pub fn forces_on_elastic(&mut self, c: usize) -> Vec<Vec3> {
        let (x1, x2) = self.positions(c);
        let r = self.contacts[c].residual(&x1, &x2, &self.lambda[c], None).unwrap();
        if self.elastic_first { r.nonmortar.clone() } else { r.mortar.clone() }
    }
}
