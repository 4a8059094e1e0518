//! A tiny host of any kind of cell: boxes of tet4, tet10, hex8, hex20 or hex27, linear elasticity with small strains, dense matrices.
#![allow(dead_code)]

use super::mesh::Mesh;
use nalgebra::{DMatrix, DVector, Matrix3, Matrix6, Vector6};
use std::collections::{BTreeMap, HashMap};
use stickslip::geometry::Vec3;

/// A kind of cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cell {
    Tet4,
    Tet10,
    Hex8,
    Hex20,
    Hex27,
}

pub const CELLS: [Cell; 5] = [Cell::Tet4, Cell::Tet10, Cell::Hex8, Cell::Hex20, Cell::Hex27];

/// A point of the grid, four steps a cell.
type Place = [i64; 3];

fn middle(p: Place, q: Place) -> Place {
    [0, 1, 2].map(|i| (p[i] + q[i]) / 2)
}

impl Cell {
    pub fn is_quadratic(self) -> bool {
        matches!(self, Cell::Tet10 | Cell::Hex20 | Cell::Hex27)
    }

    fn is_tet(self) -> bool {
        matches!(self, Cell::Tet4 | Cell::Tet10)
    }

    /// The cells of the cube at `o`, each by the places of its nodes.
    fn of_cube(self, o: Place) -> Vec<Vec<Place>> {
        let at = |d: [i64; 3]| [0, 1, 2].map(|i| o[i] + d[i]);
        if self.is_tet() {
            let paths = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
            return paths
                .map(|path| {
                    let mut d = [0; 3];
                    let mut nodes = vec![at(d)];
                    for axis in path {
                        d[axis] = 4;
                        nodes.push(at(d));
                    }
                    if self == Cell::Tet10 {
                        for (i, j) in [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)] {
                            nodes.push(middle(nodes[i], nodes[j]));
                        }
                    }
                    nodes
                })
                .to_vec();
        }
        // Hexahedra: of the 27 places those with so many coordinates in the middle.
        let most = match self {
            Cell::Hex8 => 0,
            Cell::Hex20 => 1,
            _ => 3,
        };
        let all = (0..27).map(|k| [2 * (k % 3), 2 * (k / 3 % 3), 2 * (k / 9)]);
        vec![all.filter(|d| d.iter().filter(|v| **v == 2).count() <= most).map(at).collect()]
    }

    /// Exponents of the monomials that the functions are made of.
    fn monomials(self) -> Vec<[i32; 3]> {
        let all = (0..27).map(|k| [k % 3, k / 3 % 3, k / 9]);
        let fits = |e: &[i32; 3]| match self {
            Cell::Tet4 => e.iter().sum::<i32>() <= 1,
            Cell::Tet10 => e.iter().sum::<i32>() <= 2,
            Cell::Hex8 => e.iter().all(|v| *v <= 1),
            // Of degree 2 at most, counted over the variables that are not linear.
            Cell::Hex20 => e.iter().filter(|v| **v > 1).sum::<i32>() <= 2,
            Cell::Hex27 => true,
        };
        all.filter(fits).collect()
    }

    /// A facet with these corners: mid nodes and centre as the cell has them.
    fn facet(self, corners: Vec<Place>) -> Vec<Place> {
        let mut nodes = corners.clone();
        if self.is_quadratic() {
            nodes.extend((0..corners.len()).map(|k| middle(corners[k], corners[(k + 1) % corners.len()])));
        }
        if self == Cell::Hex27 {
            nodes.push(middle(corners[0], corners[2]));
        }
        nodes
    }
}

/// A box of cells.
pub struct Solid {
    pub x: Vec<Vec3>,
    /// The facets of the side that it touches the other body with, by nodes of the box.
    pub facets: Vec<Vec<i64>>,
    pub stiffness: DMatrix<f64>,
}

impl Solid {
    /// n x n x 1 cells on [0, 1]^2 x [z0, z0 + 1]; the contact side is the upper one or the lower one.
    pub fn new(cell: Cell, n: i64, z0: f64, is_upper: bool, (young, poisson): (f64, f64)) -> Solid {
        let (mut x, mut numbers) = (Vec::new(), HashMap::new());
        let mut number = |p: Place| {
            *numbers.entry(p).or_insert_with(|| {
                let at = |k: usize| p[k] as f64 / (4 * n) as f64;
                x.push(Vec3::new(at(0), at(1), z0 + p[2] as f64 / 4.0));
                x.len() - 1
            })
        };
        let (mut cells, mut facets) = (Vec::new(), Vec::new());
        for (i, j) in (0..n).flat_map(|j| (0..n).map(move |i| (i, j))) {
            let o = [4 * i, 4 * j, 0];
            for nodes in cell.of_cube(o) {
                cells.push(nodes.into_iter().map(&mut number).collect::<Vec<_>>());
            }
            let z = if is_upper { 4 } else { 0 };
            let at = |a: i64, b: i64| [o[0] + 4 * a, o[1] + 4 * b, z];
            let sides = if cell.is_tet() {
                vec![vec![at(0, 0), at(1, 0), at(1, 1)], vec![at(0, 0), at(1, 1), at(0, 1)]]
            } else {
                vec![vec![at(0, 0), at(1, 0), at(1, 1), at(0, 1)]]
            };
            for mut corners in sides {
                if !is_upper {
                    corners.reverse();
                }
                facets.push(cell.facet(corners).into_iter().map(|p| number(p) as i64).collect());
            }
        }
        let mut stiffness = DMatrix::zeros(3 * x.len(), 3 * x.len());
        let mut kept: BTreeMap<Vec<[i64; 3]>, DMatrix<f64>> = BTreeMap::new();
        for nodes in &cells {
            let at: Vec<Vec3> = nodes.iter().map(|&k| x[k]).collect();
            // Cells of one shape have one stiffness.
            let shape = at.iter().map(|p| (p - at[0]).map(|v| (v * 4e6).round() as i64).into()).collect();
            let k = kept.entry(shape).or_insert_with(|| element(cell, &at, young, poisson));
            for (i, j) in (0..k.nrows()).flat_map(|i| (0..k.nrows()).map(move |j| (i, j))) {
                stiffness[(3 * nodes[i / 3] + i % 3, 3 * nodes[j / 3] + j % 3)] += k[(i, j)];
            }
        }
        Solid { x, facets, stiffness }
    }

    /// The contact side as a mesh of its own, with the nodes of the box that it has.
    pub fn side(&self) -> (Mesh, Vec<usize>) {
        let mut nodes: Vec<usize> = self.facets.iter().flatten().map(|&k| k as usize).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let own = |k: &i64| nodes.binary_search(&(*k as usize)).unwrap() as i64;
        let facets = self.facets.iter().map(|f| f.iter().map(own).collect()).collect();
        (Mesh { x: nodes.iter().map(|&k| self.x[k]).collect(), facets }, nodes)
    }
}

/// The stiffness of a cell with straight edges and mid nodes in the middle, whose map is affine.
fn element(cell: Cell, x: &[Vec3], young: f64, poisson: f64) -> DMatrix<f64> {
    let (lame, shear) = (young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young / (2.0 + 2.0 * poisson));
    let mut elasticity = Matrix6::from_diagonal(&Vector6::new(2.0, 2.0, 2.0, 1.0, 1.0, 1.0)) * shear;
    elasticity.fixed_view_mut::<3, 3>(0, 0).add_scalar_mut(lame);
    // Coordinates s of the cell: x = x_0 + F s.
    let edges = if cell.is_tet() {
        [x[1] - x[0], x[2] - x[0], x[3] - x[0]]
    } else {
        let far = x.iter().fold(Vec3::zeros(), |far, p| far.sup(&(p - x[0])));
        [Vec3::x() * far.x, Vec3::y() * far.y, Vec3::z() * far.z]
    };
    let f = Matrix3::from_columns(&edges);
    let inverse = f.try_inverse().unwrap();
    let (monomials, n) = (cell.monomials(), x.len());
    let power = |v: f64, e: i32| v.powi(e);
    let value = |e: &[i32; 3], s: &Vec3| (0..3).map(|i| power(s[i], e[i])).product::<f64>();
    let slope = |e: &[i32; 3], s: &Vec3| {
        Vec3::from_fn(|i, _| {
            if e[i] == 0 {
                return 0.0;
            }
            let mut lower = *e;
            lower[i] -= 1;
            f64::from(e[i]) * value(&lower, s)
        })
    };
    let places: Vec<Vec3> = x.iter().map(|p| inverse * (p - x[0])).collect();
    let at_nodes = DMatrix::from_fn(n, n, |k, t| value(&monomials[t], &places[k]));
    let coefficients = at_nodes.try_inverse().unwrap(); // [monomial][function]
    // Gauss points of [0, 1]^3, mapped to a tetrahedron where that is one.
    let line: [(f64, f64); 3] =
        [(0.5 - 0.15_f64.sqrt(), 5.0 / 18.0), (0.5, 4.0 / 9.0), (0.5 + 0.15_f64.sqrt(), 5.0 / 18.0)];
    let mut k = DMatrix::zeros(3 * n, 3 * n);
    for point in 0..27 {
        let [(a, u), (b, v), (c, w)] = [line[point % 3], line[point / 3 % 3], line[point / 9]];
        let (s, weight) = if cell.is_tet() {
            (Vec3::new(a, b * (1.0 - a), c * (1.0 - a) * (1.0 - b)), u * v * w * (1.0 - a).powi(2) * (1.0 - b))
        } else {
            (Vec3::new(a, b, c), u * v * w)
        };
        let slopes: Vec<Vec3> = monomials.iter().map(|e| inverse.transpose() * slope(e, &s)).collect();
        let mut strain = DMatrix::zeros(6, 3 * n);
        for node in 0..n {
            let d: Vec3 = (0..n).map(|t| slopes[t] * coefficients[(t, node)]).sum();
            for (row, i, v) in [(0, 0, d.x), (1, 1, d.y), (2, 2, d.z), (3, 0, d.y), (3, 1, d.x), (4, 1, d.z)] {
                strain[(row, 3 * node + i)] = v;
            }
            (strain[(4, 3 * node + 2)], strain[(5, 3 * node)], strain[(5, 3 * node + 2)]) = (d.y, d.z, d.x);
        }
        k += strain.transpose() * elasticity * &strain * (weight * f.determinant().abs());
    }
    k
}

/// The forces at a body's nodes that hold the linear field u.
pub fn forces_of(body: &Solid, u: impl Fn(&Vec3) -> Vec3) -> DVector<f64> {
    let field = DVector::from_iterator(
        3 * body.x.len(),
        body.x.iter().flat_map(|x| {
            let v = u(x);
            [v.x, v.y, v.z]
        }),
    );
    &body.stiffness * field
}
