//! The residual of a combination as a function along a direction, with multipliers among the unknowns or without, and its derivative.

use super::choice::Asked;
use super::handles::{Handles, Refused, TakesLaw, when};
use super::scene::{At, Scene};
use crate::support::max_abs;
use crate::support::mesh::{Create, Random};
use nalgebra::SVector;
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Csr, Piece};

/// Stiffness of a host without multipliers, of the order of its contact's.
const HOST: f64 = 300.0;

/// A direction that unknowns move in.
pub struct Direction {
    x1: Vec<Vec3>,
    x2: Vec<Vec3>,
    /// Of a frame, in place of `x2`.
    moved: Vec3,
    turned: Vec3,
    lambda: Vec<Vec3>,
}

impl Direction {
    pub fn still(scene: &Scene) -> Direction {
        let none = |n| vec![Vec3::zeros(); n];
        let (x1, x2) = (none(scene.one.x.len()), none(scene.two.x.len()));
        Direction { lambda: x1.clone(), x1, x2, moved: Vec3::zeros(), turned: Vec3::zeros() }
    }

    /// Of all positions, or of all multipliers.
    pub fn random(scene: &Scene, random: &mut Random, of_multipliers: bool) -> Direction {
        let mut direction = Direction::still(scene);
        let axes = scene.axes();
        let mut vector = |n: usize| {
            let v = random.vector(1.0);
            Vec3::from_fn(|i, _| if i < n { v[i] } else { 0.0 })
        };
        if of_multipliers {
            let has = direction.lambda.iter_mut().zip(&scene.has_row);
            has.filter(|(_, has)| **has).for_each(|(l, _)| *l = vector(axes));
            return direction;
        }
        direction.x1.iter_mut().for_each(|x| *x = vector(axes));
        if scene.choice.frame_moves() {
            (direction.moved, direction.turned) = (vector(axes), vector(3));
        } else if scene.mortar_moves() {
            direction.x2.iter_mut().for_each(|x| *x = vector(axes));
        }
        direction
    }

    /// So far along it.
    pub fn moved<const N: usize>(&self, scene: &Scene, at: &At<N>, h: f64) -> At<N> {
        let by = |x: &[Vec3], v: &[Vec3]| x.iter().zip(v).map(|(x, v)| x + h * v).collect::<Vec<_>>();
        let mut x2 = by(&at.x2, &self.x2);
        if scene.choice.frame_moves() && h != 0.0 {
            let turn = scene.rotation(h * self.turned);
            x2 = at.x2.iter().map(|x| turn * (x - at.x2[0]) + at.x2[0] + h * self.moved).collect();
        }
        let lambda = at.lambda.iter().zip(&self.lambda);
        let lambda = lambda.map(|(l, v)| l + h * SVector::<f64, N>::from_fn(|i, _| v[i])).collect();
        At { x1: by(&at.x1, &self.x1), x2, lambda }
    }

    /// Per unknown, in the order of the equations.
    pub fn numbers<const N: usize>(&self, scene: &Scene, at: &At<N>) -> Vec<f64> {
        let axis = if scene.choice.has_lines() { Vec3::new(0.0, 0.0, self.turned.x) } else { self.turned };
        let of_frame = |x: &Vec3| self.moved + axis.cross(&(x - at.x2[0]));
        let x2: Vec<Vec3> = match scene.choice.frame_moves() {
            true => at.x2.iter().map(of_frame).collect(),
            false => self.x2.clone(),
        };
        let x = self.x1.iter().chain(&x2).flat_map(|v| v.iter().copied());
        x.chain(self.lambda.iter().flat_map(|v| v.iter().copied().take(N))).collect()
    }
}

/// A combination where it is looked at.
pub struct System<'a, const N: usize> {
    pub scene: &'a Scene,
    handles: &'a mut Handles<N>,
    at: At<N>,
    /// What the host's own forces are there, of a system without multipliers.
    host: Vec<f64>,
}

pub type Grouped = Vec<Vec<f64>>;

impl<'a, const N: usize> System<'a, N>
where
    Contact<N>: Create<N> + TakesLaw,
{
    pub fn new(scene: &'a Scene, handles: &'a mut Handles<N>, at: &At<N>) -> Result<System<'a, N>, Refused> {
        let (mut at, mut host) = (at.clone(), Vec::new());
        if scene.choice.is_condensed() {
            // Host's forces that are balanced by these multipliers.
            let r = when(Asked::Residual, handles.residual(&at))?;
            let (n1, n) = (3 * at.x1.len(), 3 * (at.x1.len() + at.x2.len()));
            host = r[..n].iter().enumerate().map(|(i, f)| if i < n1 { -f } else { 0.0 }).collect();
            at.lambda = when(Asked::Condensed, handles.condensed_multipliers(&at, &nodes(&host, 0..at.x1.len())))?;
        }
        Ok(System { scene, handles, at, host })
    }

    /// Whether an unknown of a position has an equation.
    fn is_unknown(&self, i: usize) -> bool {
        i % 3 < self.scene.axes() && (i < 3 * self.at.x1.len() || self.scene.mortar_moves())
    }

    /// The host's stiffness: all unknowns couple, no two alike.
    fn stiffness(&self, i: usize, j: usize) -> f64 {
        if !self.is_unknown(i) || !self.is_unknown(j) {
            return 0.0;
        }
        HOST * (0.02 * (0.7 * (i * j) as f64 + 0.3 * (i + j) as f64).sin() + if i == j { 1.5 } else { 0.0 })
    }

    fn host_times(&self, v: &[f64]) -> Vec<f64> {
        (0..v.len())
            .map(|i| v.iter().enumerate().map(|(j, v)| if *v == 0.0 { 0.0 } else { self.stiffness(i, j) * v }).sum())
            .collect()
    }

    /// Forces of the first side, of the second one, rows. Forces at the points of a frame are told by what they are together.
    fn grouped(&self, r: Vec<f64>) -> Grouped {
        let (n1, n) = (3 * self.at.x1.len(), 3 * (self.at.x1.len() + self.at.x2.len()));
        let mut two = r[n1..n].to_vec();
        if self.scene.choice.is_analytic() {
            let places = || two.chunks_exact(3).map(Vec3::from_column_slice).zip(&self.at.x2);
            let force: Vec3 = places().map(|(f, _)| f).sum();
            let moment: Vec3 = places().map(|(f, x)| (x - self.at.x2[0]).cross(&f)).sum();
            two = force.iter().chain(moment.iter()).copied().collect();
        }
        if !self.scene.mortar_moves() {
            two.clear();
        }
        vec![r[..n1].to_vec(), two, r[n..].to_vec()]
    }

    /// The residual so far along a direction, and the nodes' states there.
    pub fn value(&mut self, direction: &Direction, h: f64) -> Result<(Grouped, Vec<u8>), Refused> {
        let mut at = direction.moved(self.scene, &self.at, h);
        let r = if self.scene.choice.is_condensed() {
            self.condensed_residual(&mut at, direction, h)?
        } else {
            let r = when(Asked::Residual, self.handles.residual(&at))?;
            r.into_iter().enumerate().map(|(i, r)| if self.has_equation(i) { r } else { 0.0 }).collect()
        };
        let states = when(Asked::Residual, self.handles.answers(&at))?.iter().map(|r| r.state as u8).collect();
        Ok((self.grouped(r), states))
    }

    fn has_equation(&self, i: usize) -> bool {
        i >= 3 * (self.at.x1.len() + self.at.x2.len()) || self.is_unknown(i)
    }

    fn condensed_residual(&mut self, at: &mut At<N>, direction: &Direction, h: f64) -> Result<Vec<f64>, Refused> {
        let (n1, n) = (at.x1.len(), at.x1.len() + at.x2.len());
        let v: Vec<f64> = direction.numbers(self.scene, &self.at)[..3 * n].iter().map(|v| h * v).collect();
        let mut r: Vec<f64> = self.host_times(&v).iter().zip(&self.host).map(|(k, host)| k + host).collect();
        let host = nodes(&r, 0..n1);
        at.lambda = when(Asked::Condensed, self.handles.condensed_multipliers(at, &host))?;
        r[..3 * n1].fill(0.0);
        let lambda = at.lambda.clone();
        let parts = self.handles.each(at, |handle, x2, kept, _| {
            Ok((handle.condensed_residual(&at.x1, x2, &lambda, &host)?, kept.to_vec()))
        });
        for ((rows, gains), kept) in when(Asked::Condensed, parts)? {
            let nodes = (0..n1).chain(kept.iter().map(|k| n1 + k));
            for (node, force) in nodes.zip(rows.iter().chain(&gains)) {
                (0..3).for_each(|i| r[3 * node + i] += force[i]);
            }
        }
        Ok(r.into_iter().enumerate().map(|(i, r)| if self.is_unknown(i) { r } else { 0.0 }).collect())
    }

    /// A piece of the condensed matrix times a vector.
    fn piece(&mut self, piece: Piece, v: &[f64]) -> Result<Vec<f64>, Refused> {
        let (mut product, at) = (vec![0.0; v.len()], self.at.clone());
        let parts = self.handles.each(&at, |handle, x2, _, _| {
            let mut add = |i: i64, j: i64, value: f64| product[i as usize] += value * v[j as usize];
            handle.condensed_tangent((&at.x1, x2), &at.lambda, piece, &mut add)
        });
        when(Asked::Condensed, parts)?;
        Ok(product)
    }

    /// (L (K + T) + G) v; with what it lacks where multipliers follow from the displacements.
    fn condensed_derivative(&mut self, v: &[f64], with_scales: bool) -> Result<Vec<f64>, Refused> {
        let mut all = self.host_times(v);
        let add = |to: &mut Vec<f64>, of: &[f64]| to.iter_mut().zip(of).for_each(|(to, of)| *to += of);
        add(&mut all, &self.piece(Piece::Forces, v)?);
        let eliminated = self.piece(Piece::Elimination, &all)?;
        add(&mut all, &eliminated);
        add(&mut all, &self.piece(Piece::Constraints, v)?);
        if with_scales {
            add(&mut all, &self.piece(Piece::Scales, v)?);
        }
        Ok(all)
    }

    /// The derivative along a direction.
    pub fn derivative(&mut self, direction: &Direction) -> Result<Grouped, Refused> {
        let v = direction.numbers(self.scene, &self.at);
        let n = 3 * (self.at.x1.len() + self.at.x2.len());
        if self.scene.choice.is_condensed() {
            let all = self.condensed_derivative(&v[..n], true)?;
            return Ok(self.grouped(all));
        }
        let (mut product, at) = (vec![0.0; v.len()], self.at.clone());
        let mut add = |i: usize, j: usize, value: f64| product[i] += value * v[j];
        when(Asked::Tangent, self.handles.tangent(&at, &mut add))?;
        Ok(self.grouped(product))
    }

    /// The host's matrix condensed in place against the pieces: the largest difference of the product with a vector, and its size.
    pub fn in_place(&mut self) -> Result<(f64, f64), Refused> {
        let n = 3 * (self.at.x1.len() + self.at.x2.len());
        let (offsets, columns): (Vec<i64>, Vec<i64>) =
            ((0..=n).map(|k| (k * n) as i64).collect(), (0..n * n).map(|k| (k % n) as i64).collect());
        let mut matrix: Vec<f64> = (0..n * n).map(|k| self.stiffness(k / n, k % n)).collect();
        let (host, at) = (matrix.clone(), self.at.clone());
        let csr = Csr::new(0, &offsets, &columns);
        let parts = self.handles.each(&at, |handle, x2, _, _| {
            let rows = handle.condense((&at.x1, x2), &at.lambda, csr, &|k| host[k])?;
            rows.places().for_each(|(place, value)| matrix[place] = value);
            Ok(())
        });
        when(Asked::InPlace, parts)?;
        let v: Vec<f64> = (0..n).map(|i| if self.is_unknown(i) { (1.3 * i as f64).cos() } else { 0.0 }).collect();
        let expected = self.condensed_derivative(&v, false)?;
        let found = matrix.chunks_exact(n).map(|row| row.iter().zip(&v).map(|(k, v)| k * v).sum::<f64>());
        Ok((max_abs(found.zip(&expected).map(|(a, b)| a - b)), max_abs(expected.iter().copied())))
    }
}

fn nodes(values: &[f64], range: std::ops::Range<usize>) -> Vec<Vec3> {
    values[3 * range.start..3 * range.end].chunks_exact(3).map(Vec3::from_column_slice).collect()
}
