//! A tiny host: two elastic bodies, each one layer of hexahedra under its contact surface, a dense Newton method. Small
//! strains in the bodies, current positions in the contact. Displacement equations: body 1, body 2; multipliers after
//! them. A body's nodes: its contact surface, then the same grid on the far side.
#![allow(dead_code)]

use super::mesh::{Create, Mesh, numbered};
use nalgebra::{DMatrix, DVector, Matrix6, SMatrix, SVector, Vector6};
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, NO_EQUATION, Options, Surface};

/// Newton steps at most; the problems here take up to ten.
const MOST_STEPS: usize = 50;
/// A step below this, relative to the unknowns, is rounding of a matrix with a condition of 1e4.
const CONVERGED: f64 = 1e-13;

/// One layer of hexahedra between a contact surface of quads and its copy, shifted by `far`.
pub struct Body {
    /// The contact surface, normal out of the body.
    pub surface: Mesh,
    /// Reference positions of all nodes.
    pub x: Vec<Vec3>,
    /// Stiffness of the displacements.
    pub stiffness: DMatrix<f64>,
}

impl Body {
    /// An elastic body with Young's modulus and Poisson's ratio.
    pub fn new(surface: Mesh, far: Vec3, young: f64, poisson: f64) -> Body {
        let m = surface.x.len();
        let x: Vec<_> = surface.x.iter().copied().chain(surface.x.iter().map(|x| x + far)).collect();
        let mut stiffness = DMatrix::zeros(6 * m, 6 * m);
        for quad in &surface.facets {
            let nodes: Vec<usize> =
                quad.iter().map(|&k| k as usize).chain(quad.iter().map(|&k| k as usize + m)).collect();
            let k = brick(&std::array::from_fn(|i| x[nodes[i]]), young, poisson);
            for (i, j) in (0..24).flat_map(|i| (0..24).map(move |j| (i, j))) {
                stiffness[(3 * nodes[i / 3] + i % 3, 3 * nodes[j / 3] + j % 3)] += k[(i, j)];
            }
        }
        Body { surface, x, stiffness }
    }

    /// The tributary area of each node of the contact surface [L^2]; the grids are of rectangles.
    pub fn areas(&self) -> Vec<f64> {
        let mut areas = vec![0.0; self.surface.x.len()];
        for quad in &self.surface.facets {
            let p: Vec<_> = quad.iter().map(|&k| self.surface.x[k as usize]).collect();
            let area = (p[2] - p[0]).cross(&(p[3] - p[1])).norm() / 2.0;
            quad.iter().for_each(|&k| areas[k as usize] += area / 4.0);
        }
        areas
    }
}

/// Stiffness of a trilinear hexahedron, 2 x 2 x 2 Gauss points.
fn brick(x: &[Vec3; 8], young: f64, poisson: f64) -> SMatrix<f64, 24, 24> {
    let (lame, shear) = (young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young / (2.0 + 2.0 * poisson));
    let mut elasticity = Matrix6::from_diagonal(&Vector6::new(2.0, 2.0, 2.0, 1.0, 1.0, 1.0)) * shear;
    elasticity.fixed_view_mut::<3, 3>(0, 0).add_scalar_mut(lame);
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let gauss = 1.0 / 3.0_f64.sqrt();
    let mut k = SMatrix::<f64, 24, 24>::zeros();
    for point in 0..8 {
        let s = [0, 1, 2].map(|i| if point >> i & 1 == 0 { -gauss } else { gauss });
        let slopes: [Vec3; 8] = std::array::from_fn(|a| {
            let c = [corners[a % 4][0], corners[a % 4][1], if a < 4 { -1.0 } else { 1.0 }];
            let f = [0, 1, 2].map(|i| 1.0 + c[i] * s[i]);
            Vec3::new(c[0] * f[1] * f[2], f[0] * c[1] * f[2], f[0] * f[1] * c[2]) / 8.0
        });
        let jacobian = (0..8).map(|a| x[a] * slopes[a].transpose()).sum::<SMatrix<f64, 3, 3>>();
        let to_physical = jacobian.try_inverse().unwrap().transpose();
        let mut b = SMatrix::<f64, 6, 24>::zeros();
        for a in 0..8 {
            let d = to_physical * slopes[a];
            for (row, i, v) in [(0, 0, d.x), (1, 1, d.y), (2, 2, d.z), (3, 0, d.y), (3, 1, d.x), (4, 1, d.z)] {
                b[(row, 3 * a + i)] = v;
            }
            (b[(4, 3 * a + 2)], b[(5, 3 * a)], b[(5, 3 * a + 2)]) = (d.y, d.z, d.x);
        }
        k += b.transpose() * elasticity * b * jacobian.determinant().abs();
    }
    k
}

/// Two bodies in contact, or one over a mortar surface that is prescribed.
pub struct Host<const N: usize> {
    pub contact: Contact<N>,
    pub bodies: Vec<Body>,
    /// Displacements, body after body [L].
    pub u: DVector<f64>,
    /// Prescribed displacements.
    pub prescribed: Vec<Option<f64>>,
    /// Forces on the nodes [F].
    pub load: DVector<f64>,
    pub lambda: Vec<SVector<f64, N>>,
    mortar: Mesh,
}

impl<const N: usize> Host<N>
where
    Contact<N>: Create<N>,
{
    /// `mortar`: the second body, or a surface that stays where it is.
    pub fn new(body: Body, mortar: Result<Body, Mesh>, options: Options) -> Host<N> {
        let first = body.stiffness.nrows();
        let (mut bodies, m1) = (vec![body], first / 6);
        let (mesh, equations) = match mortar {
            Ok(body) => {
                let mesh = body.surface.clone();
                bodies.push(body);
                (mesh.clone(), numbered(first, mesh.x.len()))
            }
            Err(mesh) => (mesh.clone(), vec![[NO_EQUATION; 3]; mesh.x.len()]),
        };
        let n: usize = bodies.iter().map(|b| b.stiffness.nrows()).sum();
        let surface = &bodies[0].surface;
        let one = Surface::new("nonmortar", surface.x.clone(), &surface.facets, numbered(0, m1)).unwrap();
        let two = Surface::new("mortar", mesh.x.clone(), &mesh.facets, equations).unwrap();
        let mut contact = Contact::create(one, two, numbered(n, m1), options).unwrap();
        let lambda = contact.initial_multipliers().unwrap();
        let (u, load) = (DVector::zeros(n), DVector::zeros(n));
        Host { contact, bodies, u, prescribed: vec![None; n], load, lambda, mortar: mesh }
    }

    /// First displacement equation of a body's far side, and of what follows it.
    pub fn far(&self, body: usize) -> std::ops::Range<usize> {
        let first: usize = self.bodies[..body].iter().map(|b| b.stiffness.nrows()).sum();
        let n = self.bodies[body].stiffness.nrows();
        first + n / 2..first + n
    }

    /// Holds a body's far side at a displacement.
    pub fn hold(&mut self, body: usize, u: impl Fn(&Vec3) -> Vec3) {
        let range = self.far(body);
        let nodes = &self.bodies[body].x[range.len() / 3..];
        for (k, at) in range.enumerate() {
            self.prescribed[at] = Some(u(&nodes[k / 3])[k % 3]);
        }
    }

    /// Positions of both contact surfaces.
    pub fn positions(&self) -> (Vec<Vec3>, Vec<Vec3>) {
        let moved = |x: &[Vec3], first: usize| -> Vec<Vec3> {
            x.iter().enumerate().map(|(k, x)| x + self.u.fixed_rows::<3>(first + 3 * k)).collect()
        };
        let x1 = moved(&self.bodies[0].surface.x, 0);
        let x2 = match self.bodies.get(1) {
            Some(body) => moved(&body.surface.x, self.bodies[0].stiffness.nrows()),
            None => self.mortar.x.clone(),
        };
        (x1, x2)
    }

    /// Newton's method; the number of steps it took.
    pub fn solve(&mut self) -> usize {
        self.solve_to(CONVERGED)
    }

    /// The same until a step is below `tolerance`, relative to the unknowns.
    pub fn solve_to(&mut self, tolerance: f64) -> usize {
        let (n, m) = (self.u.len(), self.lambda.len());
        for step in 0..MOST_STEPS {
            let (x1, x2) = self.positions();
            let mut k = DMatrix::zeros(n + N * m, n + N * m);
            let mut r = DVector::zeros(n + N * m);
            let mut first = 0;
            for body in &self.bodies {
                let size = body.stiffness.nrows();
                k.view_mut((first, first), (size, size)).copy_from(&body.stiffness);
                first += size;
            }
            let force = k.view((0, 0), (n, n)) * &self.u - &self.load;
            r.rows_mut(0, n).copy_from(&force);
            let c = self.contact.residual(&x1, &x2, &self.lambda, None).unwrap();
            let mut add = |at: usize, values: &mut dyn Iterator<Item = f64>| {
                values.enumerate().for_each(|(i, v)| r[at + i] += v);
            };
            add(0, &mut c.nonmortar.iter().flat_map(|v| v.iter().copied()));
            if self.bodies.len() > 1 {
                add(6 * m, &mut c.mortar.iter().flat_map(|v| v.iter().copied()));
            }
            add(n, &mut c.rows.iter().flat_map(|v| v.iter().copied()));
            let mut sink = |i: i64, j: i64, v: f64| k[(i as usize, j as usize)] += v;
            self.contact.tangent(&x1, &x2, &self.lambda, None, &mut sink).unwrap();
            for (i, value) in self.prescribed.iter().enumerate() {
                if let Some(value) = value {
                    k.row_mut(i).fill(0.0);
                    k[(i, i)] = 1.0;
                    r[i] = self.u[i] - value;
                }
            }
            let change = k.lu().solve(&r).expect("the problem is held and the multipliers are independent");
            self.u -= change.rows(0, n);
            for (a, lambda) in self.lambda.iter_mut().enumerate() {
                *lambda -= change.fixed_rows::<N>(n + N * a);
            }
            let largest = |v: f64, w: f64| v <= tolerance * w;
            let lambda = self.lambda.iter().map(|l| l.amax()).fold(0.0, f64::max);
            if largest(change.rows(0, n).amax(), self.u.amax())
                && largest(change.rows(n, N * m).amax(), lambda.max(f64::MIN_POSITIVE))
            {
                return step;
            }
        }
        panic!("no convergence in {MOST_STEPS} steps");
    }

    /// Accepts the step.
    pub fn commit(&mut self) {
        let (x1, x2) = self.positions();
        self.contact.commit(&x1, &x2, &self.lambda, None).unwrap();
    }
}
