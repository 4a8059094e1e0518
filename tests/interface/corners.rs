//! Copies of a node that have one face opposite: the corner of a cube on a floor, a foot whose sides lean over it.

use crate::crease::{apply, corner, surface};
use crate::support::mesh::*;
use nalgebra::{DMatrix, DVector, Rotation3, SVector};
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Normals, Options, Stiffness, Surface};
use stickslip::law::{Friction, State};

const CREASE: f64 = 40.0 * std::f64::consts::PI / 180.0;
/// Of a tangent against central differences at 1e-6 of sizes of 1.
const TANGENT: f64 = 1e-7;
const ROUNDING: f64 = 1e-12;

/// A body's skin over a floor that moves; copies share displacements.
struct Over<const N: usize> {
    contact: Contact<N>,
    originals: Vec<usize>,
    skin: Vec<Vec3>,
    floor: Vec<Vec3>,
}

impl<const N: usize> Over<N>
where
    Contact<N>: Create<N>,
{
    fn new(skin: &Mesh, options: Options) -> Over<N> {
        let split = surface("nonmortar", skin).split_creases(CREASE).unwrap();
        let mesh = apply(skin, &split);
        let floor = grid(5, 4, [-2.1, -2.3], [2.4, 2.2], 0.0, true, Cells::Quads);
        let (n1, n2) = (skin.x.len(), floor.x.len());
        let of = |&k: &usize| [0, 1, 2].map(|i| (3 * k + i) as i64);
        let one = Surface::new("nonmortar", mesh.x.clone(), &mesh.facets, split.originals.iter().map(of).collect());
        let two = Surface::new("mortar", floor.x.clone(), &floor.facets, numbered(3 * n1, n2)).unwrap();
        let multipliers = (0..mesh.x.len()).map(|a| std::array::from_fn(|i| (3 * (n1 + n2) + N * a + i) as i64));
        let contact = Contact::create(one.unwrap(), two, multipliers.collect(), options).unwrap();
        Over { contact, originals: split.originals, skin: skin.x.clone(), floor: floor.x }
    }

    fn copied(&self, x: &[Vec3]) -> Vec<Vec3> {
        self.originals.iter().map(|&k| x[k]).collect()
    }

    fn copies_of(&self, node: usize) -> Vec<usize> {
        (0..self.originals.len()).filter(|&a| self.originals[a] == node).collect()
    }

    /// Forces on the skin and the floor, rows.
    fn residual(&mut self, z: &DVector<f64>) -> DVector<f64> {
        let (n1, n2) = (self.skin.len(), self.floor.len());
        let (x, x2, lambda) = self.parts(z);
        let r = self.contact.residual(&self.copied(&x), &x2, &lambda, None).unwrap();
        let mut f = DVector::zeros(z.len());
        for (force, &k) in r.nonmortar.iter().zip(&self.originals) {
            let mut rows = f.fixed_rows_mut::<3>(3 * k);
            rows += force;
        }
        r.mortar.iter().enumerate().for_each(|(k, force)| f.fixed_rows_mut::<3>(3 * (n1 + k)).copy_from(force));
        r.rows.iter().enumerate().for_each(|(a, row)| f.fixed_rows_mut::<N>(3 * (n1 + n2) + N * a).copy_from(row));
        f
    }

    fn parts(&self, z: &DVector<f64>) -> (Vec<Vec3>, Vec<Vec3>, Vec<SVector<f64, N>>) {
        let (n1, n2, m) = (self.skin.len(), self.floor.len(), self.originals.len());
        let vectors = |from: usize, n: usize| (from..from + n).map(|k| z.fixed_rows::<3>(3 * k).into()).collect();
        let lambda = (0..m).map(|a| z.fixed_rows::<N>(3 * (n1 + n2) + N * a).into()).collect();
        (vectors(0, n1), vectors(n1, n2), lambda)
    }

    fn unknowns(&self, x: &[Vec3], lambda: &[SVector<f64, N>]) -> DVector<f64> {
        let places = x.iter().chain(&self.floor).flat_map(|v| v.iter().copied());
        DVector::from_iterator(
            3 * (self.skin.len() + self.floor.len()) + N * lambda.len(),
            places.chain(lambda.iter().flat_map(|l| l.iter().copied())),
        )
    }

    /// The largest difference of the tangent to differences of the residual, over its largest entry.
    fn tangent_error(&mut self, z: &DVector<f64>) -> f64 {
        let step = 1e-6;
        let (x, x2, lambda) = self.parts(z);
        let mut k = DMatrix::<f64>::zeros(z.len(), z.len());
        let mut sink = |i: i64, j: i64, v: f64| k[(i as usize, j as usize)] += v;
        self.contact.tangent(&self.copied(&x), &x2, &lambda, None, &mut sink).unwrap();
        let mut worst = 0.0_f64;
        for j in 0..z.len() {
            let mut at = |h: f64| {
                let mut z = z.clone();
                z[j] += h;
                self.residual(&z)
            };
            let differences = (at(step) - at(-step)) / (2.0 * step);
            worst = worst.max((differences - k.column(j)).amax());
        }
        worst / k.amax()
    }
}

fn options(mu: f64, normals: Normals) -> Options {
    let friction = if mu > 0.0 { Friction::Coulomb } else { Friction::None };
    Options { mu, friction, normals, ..Options::new(Stiffness::Modulus(1.0)) }
}

/// The three faces of a cube that stands on its corner.
fn cube() -> Mesh {
    let [x, y, z] = [Vec3::x(), Vec3::y(), Vec3::z()];
    let mut mesh = corner(2, &[[y, x], [z, y], [x, z]]);
    let upright = Rotation3::rotation_between(&Vec3::repeat(1.0), &Vec3::z()).unwrap();
    mesh.x.iter_mut().for_each(|p| *p = upright * *p);
    mesh
}

/// A strip of a foot, with a side that leans over the floor by `degrees`.
fn foot(degrees: f64) -> Mesh {
    let angle = degrees.to_radians();
    corner(2, &[[Vec3::y(), -Vec3::x()], [Vec3::new(angle.cos(), 0.0, angle.sin()), Vec3::y()]].map(|[a, b]| [b, a]))
}

fn tip(mesh: &Mesh) -> usize {
    mesh.x.iter().position(|p| p.norm() < ROUNDING).unwrap()
}

/// One traction along the mean of the sides' normals, whatever the others' multipliers are.
#[test]
fn a_corner_presses_straight_down() {
    for normals in [Normals::Current, Normals::Committed] {
        let mesh = cube();
        let mut over = Over::<3>::new(&mesh, options(0.0, normals));
        let copies = over.copies_of(tip(&mesh));
        assert_eq!(copies.len(), 3);
        let mut lambda = vec![Vec3::zeros(); over.originals.len()];
        copies.iter().enumerate().for_each(|(k, &a)| lambda[a] = -Vec3::z() * (1.0 + k as f64));
        let x1 = over.copied(&over.skin);
        let (floor, first) = (over.floor.clone(), lambda[copies[0]]);
        let responses = over.contact.responses(&x1, &floor, &lambda, None).unwrap();
        for &a in &copies {
            let (state, t) = (responses[a].state, responses[a].traction);
            assert!(state != State::Gap && (t - first).norm() <= ROUNDING, "{normals:?}: {state:?} {t:?}");
        }
    }
}

#[test]
fn the_tangent_of_a_corner_that_presses_equals_differences() {
    fn check<const N: usize>(mu: f64, down: impl Fn(f64) -> SVector<f64, N>)
    where
        Contact<N>: Create<N>,
    {
        let mesh = cube();
        let mut over = Over::<N>::new(&mesh, options(mu, Normals::Current));
        let mut random = Random(3);
        let lambda: Vec<_> = (0..over.originals.len()).map(|_| down(0.4 + 0.1 * random.next())).collect();
        // A rigid motion, which keeps the facets flat.
        let tilt = Rotation3::from_euler_angles(0.01, -0.015, 0.02);
        let x: Vec<_> = over.skin.iter().map(|p| tilt * p + Vec3::new(0.003, 0.002, -0.01)).collect();
        let z = over.unknowns(&x, &lambda);
        let error = over.tangent_error(&z);
        assert!(error <= TANGENT, "{N} multipliers, mu {mu}: {error}");
    }
    check::<1>(0.0, |p| SVector::from([-p]));
    for mu in [0.1, 0.8] {
        check::<3>(mu, |p| Vec3::new(0.1 * p, 0.2 * p, -p));
    }
}

/// A side that stands off stays open, however its multipliers pull, where the foot lies flat; a step later, with the foot
/// off the floor, the edge touches as one node.
#[test]
fn a_leaning_side_stays_open_beside_a_flat_foot() {
    for degrees in [41.0, 60.0, 75.0] {
        let mesh = foot(degrees);
        let mut over = Over::<3>::new(&mesh, options(0.3, Normals::Current));
        let lambda: Vec<_> = (0..over.originals.len()).map(|a| -over.contact.normal(a).unwrap()).collect();
        let (x1, floor) = (over.copied(&over.skin), over.floor.clone());
        let is_foot: Vec<_> = lambda.iter().map(|l| l.z < -0.99).collect();
        let responses = over.contact.responses(&x1, &floor, &lambda, None).unwrap();
        for (a, response) in responses.iter().enumerate() {
            let open = response.state == State::Gap;
            let on_edge = over.copies_of(over.originals[a]).len() > 1;
            assert!(!is_foot[a] || !open, "{degrees}: node {a} of the foot");
            assert!(is_foot[a] || !on_edge || open, "{degrees}: node {a} of the side");
        }
        let tilt = Rotation3::from_axis_angle(&Vec3::y_axis(), 0.5 * degrees.to_radians());
        let x: Vec<_> = over.skin.iter().map(|p| tilt * p).collect();
        let copied = over.copied(&x);
        over.contact.commit(&copied, &floor, &lambda, None).unwrap();
        let responses = over.contact.responses(&copied, &floor, &lambda, None).unwrap();
        let edge = over.copies_of(tip(&mesh));
        let [one, two] = edge[..] else { panic!("{edge:?}") };
        assert_eq!(responses[one].traction, responses[two].traction, "{degrees}");
    }
}
