//! Normals that follow the motion (docs/formulation 11): the derivative of the averaged normal of a node amid its facets,
//! and of the answers of the laws with respect to it.

use super::{angles, config};
use crate::support::mesh::Random;
use nalgebra::{Rotation3, SMatrix};
use proptest::prelude::*;
use stickslip::geometry::{Facet, Mat3, Vec3};
use stickslip::law::{Friction, Frictionless, LAWS, Law, Node, SlipMeasure, Special};
use stickslip::normal::{corner_normal, corner_normal_derivatives, nodal_normal, nodal_normal_derivative};

/// 11.1: rounding of a sum over all corners, relative to the sum of its terms' sizes.
const IDENTITIES: f64 = 1e-13;
/// Step of the differences, over the size of the facets.
const STEP: f64 = 1e-6;
/// Rounding 1e-16 / 1e-6, and truncation 1e-12 times a third derivative of 1e4 where a corner is sharp.
const DIFFERENCES: f64 = 1e-8;
/// Sharper corners, and sums shorter than this times their number, are no matter of these laws: there Dnu is large.
const SHARP: f64 = 0.1;

/// A node amid a ring of facets, each a triangle or a quadrilateral.
#[derive(Clone, Debug)]
struct Fan {
    quads: Vec<bool>,
    noise: Vec<f64>,
    angles: [f64; 3],
    size: f64,
    offset: f64,
    /// A prescribed direction, or none.
    prescribed: Option<[f64; 3]>,
}

/// Positions and facets; the node is number 0, the first corner of each facet.
struct Mesh {
    x: Vec<Vec3>,
    facets: Vec<Vec<usize>>,
}

fn fans() -> impl Strategy<Value = Fan> {
    let shape = (proptest::collection::vec(any::<bool>(), 3..=6), proptest::collection::vec(-1.0..1.0f64, 39));
    let place = (angles(), (-9..=9i32).prop_map(|k| 10f64.powi(k)), prop_oneof![Just(0.0), 0.0..10.0f64]);
    let prescribed = prop_oneof![Just(None), [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_map(Some)];
    (shape, place, prescribed).prop_map(|((quads, noise), (angles, size, offset), prescribed)| Fan {
        quads,
        noise,
        angles,
        size,
        offset,
        prescribed,
    })
}

impl Fan {
    fn mesh(&self) -> Mesh {
        let (n, q) = (self.quads.len(), Rotation3::from_euler_angles(self.angles[0], self.angles[1], self.angles[2]));
        let noise = |k: usize| Vec3::new(self.noise[3 * k], self.noise[3 * k + 1], 2.0 * self.noise[3 * k + 2]) * 0.25;
        let around = |k: f64, far: f64| {
            let angle = std::f64::consts::TAU * k / n as f64;
            Vec3::new(angle.cos(), angle.sin(), 0.0) * far
        };
        let ring = (0..n).map(|k| around(k as f64, 1.0) + noise(1 + k));
        let mut x: Vec<_> = std::iter::once(noise(0)).chain(ring).collect();
        let mut facets = Vec::new();
        for (k, quad) in self.quads.iter().enumerate() {
            let mut facet = vec![0, 1 + k];
            if *quad {
                facet.push(x.len());
                x.push(around(k as f64 + 0.5, 1.6) + noise(7 + k));
            }
            facet.push(1 + (k + 1) % n);
            facets.push(facet);
        }
        let offset = Vec3::new(1.0, -0.7, 0.4) * self.offset;
        x.iter_mut().for_each(|x| *x = (q * *x + offset) * self.size);
        Mesh { x, facets }
    }

    /// The projector on the free directions.
    fn free(&self) -> Mat3 {
        let direction = self.prescribed.and_then(|d| Vec3::from(d).try_normalize(0.1));
        direction.map_or(Mat3::identity(), |d| Mat3::identity() - d * d.transpose())
    }
}

impl Mesh {
    fn facet(&self, f: usize) -> Facet {
        Facet::new(&self.facets[f].iter().map(|&k| self.x[k]).collect::<Vec<_>>()).unwrap()
    }

    fn sum(&self) -> Vec3 {
        (0..self.facets.len()).map(|f| corner_normal(&self.facet(f), 0)).sum()
    }

    fn nu(&self, free: &Mat3) -> Vec3 {
        nodal_normal(free * self.sum(), 0).unwrap()
    }

    /// Neither sharp corners nor a knife's edge.
    fn is_plain(&self, free: &Mat3) -> bool {
        let sine = |f: usize| {
            let facet = self.facet(f);
            let [a, b] = [1, facet.len() - 1].map(|k| (facet.nodes[k] - facet.nodes[0]).normalize());
            a.cross(&b).norm()
        };
        let n = self.facets.len();
        (0..n).all(|f| sine(f) > SHARP) && (free * self.sum()).norm() > SHARP * n as f64
    }

    /// Dnu for a motion of all nodes, and the sum of its terms' sizes.
    fn dnu(&self, free: &Mat3, motion: impl Fn(&Vec3) -> Vec3) -> (Vec3, f64) {
        let (dnu_dsum, mut total, mut size) = (nodal_normal_derivative(self.sum(), free), Vec3::zeros(), 0.0);
        for (f, nodes) in self.facets.iter().enumerate() {
            for (corner, dm) in corner_normal_derivatives(&self.facet(f), 0, &nalgebra::Matrix3::identity()) {
                let moved = motion(&self.x[nodes[corner]]);
                total += dnu_dsum * (dm * moved);
                size += (dnu_dsum * dm).norm() * moved.norm();
            }
        }
        (total, size)
    }
}

proptest! {
    #![proptest_config(config(file!(), 1))]

    /// 11.1: nothing for a translation and a stretching, w x nu for a small rotation w; and no part along nu.
    #[test]
    fn derivatives_of_a_normal_keep_its_identities(fan in fans(), w in [-1.0..1.0f64, -1.0..1.0, -1.0..1.0]) {
        let (mesh, free, w) = (fan.mesh(), fan.free(), Vec3::from(w));
        prop_assume!(mesh.is_plain(&free));
        let (shifted, size) = mesh.dnu(&free, |_| w);
        prop_assert!(shifted.norm() <= IDENTITIES * size, "translation {:e} of {size:e}", shifted.norm());
        let (stretched, size) = mesh.dnu(&free, |x| *x);
        prop_assert!(stretched.norm() <= IDENTITIES * size, "stretching {:e} of {size:e}", stretched.norm());
        let whole = Mat3::identity();
        let (turned, size) = mesh.dnu(&whole, |x| w.cross(x));
        let error = (turned - w.cross(&mesh.nu(&whole))).norm();
        prop_assert!(error <= IDENTITIES * (size + w.norm()), "rotation {error:e} of {size:e}");
        let (any, size) = mesh.dnu(&free, |x| Vec3::new(x.y, -2.0 * x.z, x.x));
        prop_assert!(mesh.nu(&free).dot(&any).abs() <= IDENTITIES * size);
    }

    #[test]
    fn derivatives_of_a_normal_equal_differences(fan in fans(), seed in any::<u64>()) {
        let (mesh, free) = (fan.mesh(), fan.free());
        prop_assume!(mesh.is_plain(&free) && fan.offset < 1.0);
        let mut random = Random(seed);
        let motion: Vec<_> = mesh.x.iter().map(|_| random.vector(fan.size)).collect();
        let at = |h: f64| {
            let x = mesh.x.iter().zip(&motion).map(|(x, d)| x + d * h).collect();
            Mesh { x, facets: mesh.facets.clone() }.nu(&free)
        };
        let place = |x: &Vec3| motion[mesh.x.iter().position(|y| y == x).unwrap()];
        let (found, size) = mesh.dnu(&free, place);
        let error = (found - (at(STEP) - at(-STEP)) / (2.0 * STEP)).norm();
        // A sharp corner turns fast: the truncation grows with the third power of its speed.
        prop_assert!(error <= DIFFERENCES * (1.0 + size).powi(3), "{error:e} of {size:e}");
    }
}

/// Nodes that every law is tried on.
const NODES: usize = 6000;

/// A closed node, an open one, one that slips, at random.
fn node<const N: usize>(random: &mut Random, friction: Friction) -> Node<N> {
    let mut flag = |one_in: f64| random.next() < 2.0 / one_in - 1.0;
    let (covered, covered_before, prescribed) = (!flag(8.0), !flag(3.0), flag(2.0));
    let slip = [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Paper]
        [((random.next() + 1.0) * 1.5).min(2.9) as usize];
    let d = random.vector(1.0).normalize();
    let free = if prescribed { Mat3::identity() - d * d.transpose() } else { Mat3::identity() };
    let normal = (free * random.vector(1.0)).normalize();
    let law = friction.law();
    let mu = match law.mu {
        stickslip::law::Coefficient::Given => 0.6 * (random.next() + 1.0),
        stickslip::law::Coefficient::Always(mu) => mu,
    };
    let pressed = normal * (random.next() - 0.5);
    let vector = random.vector(0.7) + pressed;
    Node {
        lambda: SMatrix::from_fn(|i, _| if N == 1 { normal.dot(&vector) } else { vector[i] }),
        normal,
        augmentation: 10f64.powf(random.next()),
        mu,
        shear_limit: if law.limits_shear { 0.4 } else { f64::INFINITY },
        gap_now: random.vector(0.3),
        gap_previous: random.vector(0.3),
        gap_committed: random.vector(0.3),
        covered,
        covered_before,
        slip,
        free,
        special: Special::Nothing,
    }
}

/// The state, and how far the derivatives are from differences; `None` near a border of states, and near the axis, where
/// slip has no direction.
fn error<const N: usize, L: Law<N>>(node: &Node<N>, random: &mut Random) -> Option<(usize, f64)> {
    let tangent = node.free - node.normal * node.normal.transpose();
    let d = tangent * random.vector(1.0);
    let at = |h: f64| L::respond(&Node { normal: (node.normal + d * h).normalize(), ..*node });
    let (here, plus, minus) = (L::respond(node), at(STEP), at(-STEP));
    let sigma_t = here.sigma - node.normal * node.normal.dot(&here.sigma);
    let scale = node.lambda.norm() + node.augmentation * (node.gap_now.norm() + node.gap_previous.norm() + 0.3);
    let slides = N == 3 && node.mu > 0.0 && here.state as i32 == 2;
    if plus.state != here.state || minus.state != here.state || (slides && sigma_t.norm() < SHARP * scale) {
        return None;
    }
    let turn = L::turn(node);
    let traction = turn.dp_dnormal * d - (plus.traction - minus.traction) / (2.0 * STEP);
    let row = turn.drow_dnormal * d - (plus.row - minus.row) / (2.0 * STEP);
    Some((here.state as usize, traction.norm().max(row.norm() * node.augmentation) / scale))
}

/// 11.2: every law in every state, also of nodes that are new or not free to go anywhere, with every measure of slip.
#[test]
fn answers_turn_with_the_normal_as_differences_say() {
    fn try_law<const N: usize, L: Law<N>>(friction: Friction, states: &[usize]) {
        let (mut random, mut seen) = (Random(17 + friction as u64), [0; 3]);
        for _ in 0..NODES {
            let node = node(&mut random, friction);
            let Some((state, error)) = error::<N, L>(&node, &mut random) else { continue };
            seen[state] += 1;
            assert!(error <= DIFFERENCES, "{friction:?}, {N} multipliers: {error:e} of {node:?}");
        }
        // A law that is hardly ever tested holds easily.
        for state in 0..3 {
            assert_eq!(seen[state] > NODES / 50, states.contains(&state), "{friction:?} {seen:?}");
        }
    }
    try_law::<3, stickslip::law::Coulomb>(Friction::Coulomb, &[0, 1, 2]);
    try_law::<3, stickslip::law::Coulomb>(Friction::Rough, &[0, 1]);
    try_law::<3, stickslip::law::Tresca>(Friction::Tresca, &[0, 1, 2]);
    try_law::<3, stickslip::law::Tied>(Friction::Tied, &[0, 1]);
    try_law::<3, Frictionless>(Friction::None, &[0, 2]);
    try_law::<1, Frictionless>(Friction::None, &[0, 2]);
    assert_eq!(LAWS.len(), 5, "a new law is to be tried, too");
}
