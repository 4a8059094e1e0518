//! Nodes split along creases; a punch with a sharp edge in the corner of a channel, which needs it.

use crate::support::differences::Point;
use crate::support::mesh::*;
use nalgebra::{DMatrix, DVector, Rotation3};
use proptest::prelude::*;
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Form, NO_EQUATION, Normals, Options, Split, Stiffness, Surface};
use stickslip::law::{Friction, State};
use stickslip::line::Measure;
use stickslip::normal::corner_normal;

const DEGREE: f64 = std::f64::consts::PI / 180.0;

pub fn surface(side: &'static str, mesh: &Mesh) -> Surface {
    Surface::new(side, mesh.x.clone(), &mesh.facets, numbered(0, mesh.x.len())).unwrap()
}

/// The mesh with the split's numbering.
pub fn apply(mesh: &Mesh, split: &Split) -> Mesh {
    let mut nodes = split.facet_nodes.iter().map(|&k| k as i64);
    let facets = mesh.facets.iter().map(|f| nodes.by_ref().take(f.len()).collect()).collect();
    Mesh { x: split.originals.iter().map(|&k| mesh.x[k]).collect(), facets }
}

/// Grids on the planes through the origin that `axes` span pairwise, welded; normals along `axes[0] x axes[1]` and so on.
pub fn corner(n: usize, planes: &[[Vec3; 2]]) -> Mesh {
    let mut mesh = Mesh { x: Vec::new(), facets: Vec::new() };
    for [a, b] in planes {
        let sheet = grid(n, n, [0.0, 0.0], [1.0, 1.0], 0.0, true, Cells::Quads);
        let mut number = |x: &Vec3| {
            let at = a * x.x + b * x.y;
            let known = mesh.x.iter().position(|y| (y - at).norm() < 1e-12);
            known.unwrap_or_else(|| {
                mesh.x.push(at);
                mesh.x.len() - 1
            }) as i64
        };
        let numbers: Vec<_> = sheet.x.iter().map(&mut number).collect();
        mesh.facets.extend(sheet.facets.iter().map(|f| f.iter().map(|&k| numbers[k as usize]).collect::<Vec<_>>()));
    }
    mesh
}

fn copies(split: &Split, node: usize) -> usize {
    split.originals.iter().filter(|&&o| o == node).count()
}

#[test]
fn a_box_corner_is_split_into_three_its_edges_into_two() {
    let [x, y, z] = [Vec3::x(), Vec3::y(), Vec3::z()];
    for n in [1, 3] {
        let mesh = corner(n, &[[x, y], [y, z], [z, x]]);
        let split = surface("nonmortar", &mesh).split_creases(40.0 * DEGREE).unwrap();
        for (k, p) in mesh.x.iter().enumerate() {
            let planes = p.iter().filter(|c| c.abs() < 1e-12).count();
            assert_eq!(copies(&split, k), planes, "{p:?}");
        }
        let m = mesh.x.len();
        assert_eq!(split.originals[..m], (0..m).collect::<Vec<_>>(), "the nodes keep their numbers");
        assert!(split.originals[m..].is_sorted());
        // One over 90 degrees: nothing to split, as where there is no crease.
        let whole = surface("nonmortar", &mesh).split_creases(90.1 * DEGREE).unwrap();
        assert_eq!(whole.originals.len(), m);
        assert_eq!(whole.facet_nodes, mesh.facets.iter().flatten().map(|&k| k as usize).collect::<Vec<_>>());
    }
}

/// Where the crease ends within the surface: a roof whose ridge becomes flat.
#[test]
fn a_crease_may_end_within_the_surface() {
    let mut mesh = grid(2, 6, [-1.0, 0.0], [1.0, 6.0], 0.0, true, Cells::Triangles);
    for x in &mut mesh.x {
        x.z = -x.x.abs() * (3.0 - x.y).max(0.0) / 3.0;
    }
    let split = surface("nonmortar", &mesh).split_creases(30.0 * DEGREE).unwrap();
    let ridge = |y: f64| mesh.x.iter().position(|x| x.x == 0.0 && x.y == y).unwrap();
    assert_eq!([0.0, 1.0, 4.0, 6.0].map(|y| copies(&split, ridge(y))), [2, 2, 1, 1]);
}

/// A smooth cone's tip looks in all directions though no edge is sharp: it is cut into sectors.
#[test]
fn a_smooth_cone_is_cut_into_sectors() {
    let n = 24_i64;
    let rim = |k: i64| {
        let phi = std::f64::consts::TAU * k as f64 / n as f64;
        Vec3::new(phi.cos(), phi.sin(), -1.0)
    };
    let mesh = Mesh {
        x: std::iter::once(Vec3::zeros()).chain((0..n).map(rim)).collect(),
        facets: (0..n).map(|k| vec![0, 1 + k, 1 + (k + 1) % n]).collect(),
    };
    let split = surface("nonmortar", &mesh).split_creases(50.0 * DEGREE).unwrap();
    assert!(copies(&split, 0) >= 4, "{} sectors", copies(&split, 0));
    assert!((1..=n as usize).all(|k| copies(&split, k) == 1));
    assert_no_wide_fan(&apply(&mesh, &split), 50.0 * DEGREE);
}

/// Rounding of a scalar product of unit vectors.
const ROUNDING: f64 = 1e-14;

fn assert_no_wide_fan(mesh: &Mesh, angle: f64) {
    let s = surface("nonmortar", mesh);
    let mut normals = vec![Vec::new(); mesh.x.len()];
    for (f, facet) in s.facets.iter().enumerate() {
        for (k, &node) in facet.as_slice().iter().enumerate() {
            normals[node].push(corner_normal(&s.facet(f, &mesh.x), k));
        }
    }
    for fan in &normals {
        assert!(!fan.is_empty());
        let wide = |(m, n): (&Vec3, &Vec3)| m.dot(n) < angle.cos() - ROUNDING;
        assert!(!fan.iter().flat_map(|m| fan.iter().map(move |n| (m, n))).any(wide));
    }
}

proptest! {
    #![proptest_config(crate::support::random::cases(200))]

    /// On crumpled surfaces: no fan spans more than the angle, facets keep their corners, nothing is split in vain.
    #[test]
    fn no_fan_spans_more_than_the_angle(seed in 0_u64..1_000_000, degrees in 5.0..170.0_f64, crumpled in 0.0..0.8_f64) {
        let mut random = Random(seed);
        let cells = if seed % 2 == 0 { Cells::Quads } else { Cells::Triangles };
        let mut mesh = grid(4, 3, [0.0, 0.0], [4.0, 3.0], 0.0, true, cells);
        mesh.x.iter_mut().for_each(|x| *x += Vec3::new(0.1 * random.next(), 0.1 * random.next(), crumpled * random.next()));
        let angle = degrees * DEGREE;
        let split = surface("nonmortar", &mesh).split_creases(angle).unwrap();
        let after = apply(&mesh, &split);
        for (old, new) in mesh.facets.iter().zip(&after.facets) {
            let back: Vec<_> = new.iter().map(|&k| split.originals[k as usize] as i64).collect();
            prop_assert_eq!(old, &back);
        }
        assert_no_wide_fan(&after, angle);
        let again = surface("nonmortar", &after).split_creases(angle).unwrap();
        prop_assert_eq!(again.originals.len(), after.x.len(), "what is split stays");
    }
}

#[test]
fn angles_out_of_range_are_refused() {
    let s = surface("nonmortar", &grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, true, Cells::Quads));
    for angle in [0.0, -1.0, std::f64::consts::PI, 45.0, f64::NAN, f64::INFINITY] {
        let error = s.split_creases(angle).unwrap_err();
        assert!(error.kind == Kind::InvalidValue && error.message.starts_with("angle is"), "{error}");
    }
}

/// A punch's edge, with faces down and to the left, in the corner of a channel, turned in space.
struct Punch<const N: usize> {
    contact: Contact<N>,
    /// Copies of nodes and what they copy.
    split: Split,
    punch: Mesh,
    channel: Mesh,
    frame: Rotation3<f64>,
}

impl<const N: usize> Punch<N>
where
    Contact<N>: Create<N>,
{
    /// Equations: those of the punch's nodes, of the channel's where it moves, multipliers of each copy.
    fn new(options: Options, channel_moves: bool) -> Punch<N> {
        let [x, y, z] = [Vec3::x(), Vec3::y(), Vec3::z()];
        let frame = Rotation3::from_euler_angles(0.4, -0.9, 1.3);
        let turned = |mut mesh: Mesh| {
            mesh.x.iter_mut().for_each(|p| *p = frame * *p);
            mesh
        };
        let punch = turned(corner(3, &[[y, x], [z, y]]));
        // A little wider, and with other facets.
        let mut channel = corner(4, &[[x, y], [y, z]]);
        channel.x.iter_mut().for_each(|p| *p = Vec3::new(1.3 * p.x, 1.2 * p.y - 0.1, 1.3 * p.z));
        let channel = turned(channel);
        let whole = surface("nonmortar", &punch);
        let split = whole.split_creases(40.0 * DEGREE).unwrap();
        let (n1, n2) = (punch.x.len(), channel.x.len());
        let mesh = apply(&punch, &split);
        let of = |node: &usize| [0, 1, 2].map(|i| (3 * node + i) as i64);
        let equations = split.originals.iter().map(of).collect();
        let one = Surface::new("nonmortar", mesh.x.clone(), &mesh.facets, equations).unwrap();
        let fixed = vec![[NO_EQUATION; 3]; n2];
        let moving = if channel_moves { numbered(3 * n1, n2) } else { fixed };
        let two = Surface::new("mortar", channel.x.clone(), &channel.facets, moving).unwrap();
        let multipliers = numbered(3 * (n1 + n2), mesh.x.len());
        Punch { contact: Contact::create(one, two, multipliers, options).unwrap(), split, punch, channel, frame }
    }

    fn copied(&self, x: &[Vec3]) -> Vec<Vec3> {
        self.split.originals.iter().map(|&k| x[k]).collect()
    }
}

/// Each copy looks out of its own face, and each face is covered in full.
#[test]
fn copies_have_the_normals_of_their_faces() {
    let punch = Punch::<3>::new(options(), false);
    let faces = [Vec3::z(), Vec3::x()].map(|n| punch.frame * n);
    let n1 = punch.punch.x.len();
    assert_eq!(punch.split.originals.len(), n1 + 4, "four nodes on the edge");
    for a in 0..punch.split.originals.len() {
        let nu = punch.contact.normal(a).unwrap();
        assert!(faces.iter().any(|n| (nu - n).norm() < 1e-14), "{nu:?}");
    }
    let h = punch.contact.history();
    assert!(h.coverage.iter().zip(&h.areas).all(|(c, a)| (c / a - 1.0).abs() < 1e-12));
}

/// Both copies of a node move with it: the tangent that the shared equations sum up is the derivative of the summed
/// residual, and all forces add up to nothing.
#[test]
fn shared_equations_momentum_and_tangent() {
    /// The bound of tests/interface/tangent.rs on affine facets.
    const TANGENT: f64 = 1e-7;
    let mut p = Punch::<3>::new(options(), true);
    let mut random = Random(5);
    let (n1, n2, m) = (p.punch.x.len(), p.channel.x.len(), p.split.originals.len());
    // Rigid motions keep facets flat; the multipliers make all states occur.
    let tilt = Rotation3::from_euler_angles(0.01, -0.015, 0.02);
    let push = p.frame * Vec3::new(-0.013, 0.02, -0.01);
    let x: Vec<_> = p.punch.x.iter().map(|x| tilt * x + push).collect();
    let lambda: Vec<_> = (0..m).map(|a| p.contact.normal(a).unwrap() * -0.15 + random.vector(0.4)).collect();
    let x1 = p.copied(&x);
    let x2 = p.channel.x.clone();
    let states: Vec<_> = p.contact.responses(&x1, &x2, &lambda, None).unwrap().iter().map(|r| r.state).collect();
    assert!([State::Gap, State::Stick, State::Slip].iter().all(|s| states.contains(s)), "{states:?}");
    let r = p.contact.residual(&x1, &x2, &lambda, None).unwrap();
    let total: Vec3 = r.nonmortar.iter().chain(&r.mortar).sum();
    let scale = r.nonmortar.iter().map(Vec3::amax).fold(0.0, f64::max);
    assert!(total.norm() <= 1e-14 * scale, "{total:?}");

    let n = 3 * (n1 + n2 + m);
    let mut k = DMatrix::<f64>::zeros(n, n);
    let mut sink = |i: i64, j: i64, v: f64| k[(i as usize, j as usize)] += v;
    p.contact.tangent(&x1, &x2, &lambda, None, &mut sink).unwrap();
    let z: Vec<f64> = x.iter().chain(&x2).chain(&lambda).flat_map(|v| v.iter().copied()).collect();
    let mut residual = |z: &[f64]| {
        let v: Vec<_> = z.chunks_exact(3).map(Vec3::from_column_slice).collect();
        let x1: Vec<_> = p.split.originals.iter().map(|&k| v[k]).collect();
        let r = p.contact.residual(&x1, &v[n1..n1 + n2], &v[n1 + n2..], None).unwrap();
        let mut f = vec![Vec3::zeros(); n1];
        r.nonmortar.iter().zip(&p.split.originals).for_each(|(force, &k)| f[k] += force);
        let all: Vec<f64> = f.iter().chain(&r.mortar).chain(&r.rows).flat_map(|v| v.iter().copied()).collect();
        DVector::from_vec(all)
    };
    let step = 1e-6;
    let mut worst = 0.0_f64;
    for j in 0..n {
        let at = |h: f64| {
            let mut z = z.clone();
            z[j] += h;
            z
        };
        let fd = (residual(&at(step)) - residual(&at(-step))) / (2.0 * step);
        worst = worst.max((fd - k.column(j)).amax());
    }
    assert!(worst <= TANGENT * k.amax(), "{worst} of {}", k.amax());
}

/// Stiffness of the springs under the punch's faces, over the area [F/L^3].
const SPRINGS: f64 = 100.0;
const DEPTH: f64 = 0.01;

/// The punch hangs on springs, along each face's normal by the face's area, and is pushed into the corner by DEPTH on
/// both faces: pressures SPRINGS DEPTH on both, exactly.
fn pushed<const N: usize>(mut p: Punch<N>) -> (Punch<N>, Vec<nalgebra::SVector<f64, N>>, usize)
where
    Contact<N>: Create<N>,
{
    let (n1, n2, m) = (p.punch.x.len(), p.channel.x.len(), p.split.originals.len());
    let mut springs = vec![[0.0; 3]; n1];
    for a in 0..m {
        let local = p.frame.inverse() * p.contact.normal(a).unwrap();
        let area = p.contact.history().areas[a];
        for i in 0..3 {
            springs[p.split.originals[a]][i] += SPRINGS * area * local[i].abs();
        }
    }
    // Along the faces weak ones that hold the nodes where they are: no facet changes its area.
    let mut push = vec![Vec3::zeros(); n1];
    for (springs, push) in springs.iter_mut().zip(&mut push) {
        for i in 0..3 {
            if springs[i] > 1e-9 {
                push[i] = -DEPTH;
            } else {
                springs[i] = 0.01 * SPRINGS;
            }
        }
        *push = p.frame * *push;
    }
    let mut u = vec![Vec3::zeros(); n1];
    let mut lambda = p.contact.initial_multipliers().unwrap();
    let n = 3 * n1 + N * m;
    let first = 3 * (n1 + n2);
    let at = |e: i64| if (e as usize) < first { e as usize } else { e as usize - first + 3 * n1 };
    let x2 = p.channel.x.clone();
    for iteration in 0..20 {
        let x: Vec<_> = (0..n1).map(|a| p.punch.x[a] + push[a] + u[a]).collect();
        let x1 = p.copied(&x);
        let r = p.contact.residual(&x1, &x2, &lambda, None).unwrap();
        let mut k = DMatrix::<f64>::zeros(n, n);
        let mut sink = |i: i64, j: i64, v: f64| k[(at(i), at(j))] += v;
        p.contact.tangent(&x1, &x2, &lambda, None, &mut sink).unwrap();
        let mut f = DVector::zeros(n);
        for a in 0..n1 {
            let turn = p.frame.matrix();
            let spring = turn * nalgebra::Matrix3::from_diagonal(&Vec3::from(springs[a])) * turn.transpose();
            f.fixed_rows_mut::<3>(3 * a).copy_from(&(spring * u[a]));
            let mut block = k.fixed_view_mut::<3, 3>(3 * a, 3 * a);
            block += spring;
        }
        for (a, force) in r.nonmortar.iter().enumerate() {
            let mut rows = f.fixed_rows_mut::<3>(3 * p.split.originals[a]);
            rows += force;
        }
        for (a, row) in r.rows.iter().enumerate() {
            f.fixed_rows_mut::<N>(3 * n1 + N * a).copy_from(row);
        }
        if f.amax() <= 1e-13 * SPRINGS * DEPTH {
            p.contact.commit(&x1, &x2, &lambda, None).unwrap();
            return (p, lambda, iteration);
        }
        let change = k.lu().solve(&f).expect("of full rank");
        (0..n1).for_each(|a| u[a] -= change.fixed_rows::<3>(3 * a));
        lambda.iter_mut().enumerate().for_each(|(a, l)| *l -= change.fixed_rows::<N>(3 * n1 + N * a));
    }
    panic!("no equilibrium in 20 iterations");
}

#[test]
fn a_punch_pushed_into_a_channel_corner_presses_on_both_faces() {
    /// Of the pressure; the condition of the system is 1e4.
    const PRESSURE: f64 = 1e-10;
    let options = Options::paper(Stiffness::Modulus(SPRINGS));
    let (punch, lambda, iterations) = pushed(Punch::<3>::new(options, false));
    assert!(iterations <= 6, "{iterations}");
    for (a, l) in lambda.iter().enumerate() {
        let pressure = punch.contact.normal(a).unwrap() * -SPRINGS * DEPTH;
        assert!((l - pressure).norm() <= PRESSURE * SPRINGS * DEPTH, "node {a}: {l:?}, expected {pressure:?}");
    }
    let (_, one, _) = pushed(Punch::<1>::new(options, false));
    for l in &one {
        assert!((l[0] + SPRINGS * DEPTH).abs() <= PRESSURE * SPRINGS * DEPTH, "{}", l[0]);
    }
}

impl Punch<3> {
    /// Coefficients that let no copy of a split node stick.
    fn friction(&self, mu: f64) -> Vec<f64> {
        self.split.originals.iter().map(|&o| if copies(&self.split, o) > 1 { 0.0 } else { mu }).collect()
    }

    /// Least over largest singular value of a tangent with all nodes closed and none sliding, on springs of 1.
    fn rank(&mut self) -> f64 {
        let (n1, n2, m) = (self.punch.x.len(), self.channel.x.len(), self.split.originals.len());
        let lambda: Vec<_> = (0..m).map(|a| -self.contact.normal(a).unwrap()).collect();
        let x1 = self.copied(&self.punch.x);
        let mut k = DMatrix::<f64>::zeros(3 * (n1 + m), 3 * (n1 + m));
        let at = |e: i64| if (e as usize) < 3 * n1 { e as usize } else { e as usize - 3 * n2 };
        let mut sink = |i: i64, j: i64, v: f64| k[(at(i), at(j))] += v;
        self.contact.tangent(&x1, &self.channel.x, &lambda, None, &mut sink).unwrap();
        (0..3 * n1).for_each(|i| k[(i, i)] += 1.0);
        let values = k.singular_values();
        values.min() / values.max()
    }
}

/// Where both copies of a node stuck there were six rows for three displacements. Copies that touch together act without friction,
/// without being told; in law and tangent nothing changes when they are.
#[test]
fn copies_of_a_node_do_not_both_stick() {
    for friction in [Friction::Coulomb, Friction::Rough] {
        let mu = if friction == Friction::Coulomb { 0.5 } else { 0.0 };
        let mut p = Punch::<3>::new(Options { mu, friction, ..Options::paper(Stiffness::Modulus(1.0)) }, false);
        let rank = p.rank();
        // Measured 1.3e-5: rows without friction are areas, the springs 1.
        assert!(rank > 1e-6, "{friction:?}: {rank}");
        if friction == Friction::Coulomb {
            p.contact.set_friction(p.friction(mu)).unwrap();
            assert_eq!(p.rank(), rank);
        }
    }
}

/// A copy that is alone in contact has friction: the channel has lost one of its faces.
#[test]
fn a_copy_that_touches_alone_sticks() {
    let [x, y, z] = [Vec3::x(), Vec3::y(), Vec3::z()];
    let mesh = corner(2, &[[y, x], [z, y]]);
    let mut floor = corner(3, &[[x, y]]);
    floor.x.iter_mut().for_each(|p| *p = *p * 1.3 - Vec3::new(0.1, 0.1, 0.0));
    let split = surface("nonmortar", &mesh).split_creases(40.0 * DEGREE).unwrap();
    let copied = apply(&mesh, &split);
    let equations = split.originals.iter().map(|&k| [0, 1, 2].map(|i| (3 * k + i) as i64)).collect();
    let one = Surface::new("nonmortar", copied.x.clone(), &copied.facets, equations).unwrap();
    let two = Surface::new("mortar", floor.x.clone(), &floor.facets, vec![[NO_EQUATION; 3]; floor.x.len()]).unwrap();
    let multipliers = numbered(3 * mesh.x.len(), copied.x.len());
    let options = Options { mu: 0.5, ..Options::paper(Stiffness::Modulus(1.0)) };
    let mut contact = Contact::<3>::create(one, two, multipliers, options).unwrap();
    let lambda: Vec<_> = (0..copied.x.len()).map(|a| -contact.normal(a).unwrap()).collect();
    let found = contact.responses(&copied.x, &floor.x, &lambda, None).unwrap();
    for (a, response) in found.iter().enumerate() {
        let is_foot = contact.normal(a).unwrap().z.abs() > 0.5;
        assert_eq!(response.state, if is_foot { State::Stick } else { State::Gap }, "node {a}");
    }
    assert!(split.originals.len() > mesh.x.len());
}

/// Lines are split where two of them meet at an angle, and not at the node in the middle of one.
#[test]
fn lines_are_split_at_their_corners() {
    let at = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    let x = vec![at(0.0, 1.0), at(0.0, 0.0), at(0.5, 0.01), at(1.0, 0.0), at(2.0, 0.1)];
    for (facets, nodes) in [
        (vec![vec![0, 1], vec![1, 2], vec![2, 3], vec![3, 4]], [0, 1, 5, 2, 2, 3, 3, 4].as_slice()),
        (vec![vec![0, 1], vec![1, 3, 2], vec![3, 4]], &[0, 1, 5, 3, 2, 3, 4]),
    ] {
        let surface =
            Surface::of_lines("surface", x.clone(), &facets, vec![[NO_EQUATION; 3]; 5], Measure::Axisymmetric).unwrap();
        let split = surface.split_creases(0.7).unwrap();
        assert_eq!(split.facet_nodes, nodes);
        assert_eq!(split.originals, [0, 1, 2, 3, 4, 1]);
        assert_eq!(surface.split_creases(1.7).unwrap().originals.len(), 5);
    }
}

#[test]
fn a_punch_with_friction_pushed_into_a_channel_corner() {
    /// Rounding of the cone, over the pressure.
    const CONE: f64 = 1e-10;
    for mu in [0.2, 2.0] {
        let p = Punch::<3>::new(Options { mu, ..Options::paper(Stiffness::Modulus(SPRINGS)) }, false);
        let friction = p.friction(mu);
        let (p, lambda, iterations) = pushed(p);
        assert!(iterations <= 10, "{iterations}");
        let mut slid = 0;
        for (a, l) in lambda.iter().enumerate() {
            let nu = p.contact.normal(a).unwrap();
            let (normal, tangential) = (l.dot(&nu), (l - nu * l.dot(&nu)).norm());
            assert!(normal < 0.0 && tangential <= -friction[a] * normal + CONE * SPRINGS * DEPTH, "node {a}: {l:?}");
            slid += usize::from(tangential > 0.0);
        }
        assert!(slid > 0, "friction acts");
    }
}

/// Unsplit, the edge of a blade has a normal along the blade, which is neither face's.
#[test]
fn the_edge_of_a_blade_has_both_normals_once_it_is_split() {
    let [x, y] = [Vec3::x(), Vec3::y()];
    // The other face, folded back by all but 2 degrees.
    let back = Vec3::new((2.0 * DEGREE).cos(), 0.0, (2.0 * DEGREE).sin());
    let blade = corner(2, &[[y, x], [back, y]]);
    let table = grid(2, 2, [-1.0, -1.0], [2.0, 2.0], -0.1, true, Cells::Quads);
    let whole = interface(&blade, &table, options());
    assert!(whole.normal(0).unwrap().dot(&Vec3::x()) > 0.99);
    let split = surface("nonmortar", &blade).split_creases(60.0 * DEGREE).unwrap();
    let added = blade.x.len();
    assert_eq!(
        split.originals[added..],
        [0, 1, 2].map(|k| blade.x.iter().position(|p| *p == y * 0.5 * f64::from(k)).unwrap())
    );
    let i = interface(&apply(&blade, &split), &table, options());
    assert!((i.normal(0).unwrap() - Vec3::z()).norm() < 1e-14, "the lower face's");
    assert!((i.normal(added).unwrap() - back.cross(&y) * -1.0).norm() < 1e-14, "the upper face's");
}

/// A punch with a sharp edge in a corner, normals of now: the tangent equals differences whether its edge is split or not.
/// Copies have equations of their own here, so that each is moved alone.
#[test]
fn the_tangent_at_a_crease_equals_differences_with_normals_of_now() {
    /// Relative to the largest entry of a block, on affine facets.
    const DIFFERENCES: f64 = 1e-7;
    let [x, y, z] = [Vec3::x(), Vec3::y(), Vec3::z()];
    let mesh = corner(2, &[[y, x], [z, y]]);
    let other = corner(3, &[[x, y], [y, z]]);
    // The corner that the punch stands in is larger, and a little off.
    let two = Mesh { x: other.x.iter().map(|p| p * 1.3 - Vec3::new(0.004, 0.15, 0.003)).collect(), ..other };
    let split = surface("nonmortar", &mesh).split_creases(40.0 * DEGREE).unwrap();
    let copied = apply(&mesh, &split);
    assert!(copied.x.len() > mesh.x.len());
    for (what, one) in [("split", copied), ("one node", mesh)] {
        for form in [Form::Multiplier, Form::Augmented] {
            let options = Options { form, normals: Normals::Current, search_distance: Some(0.2), ..options() };
            let mut contact: Contact<3> = contact(&one, &two, false, options);
            let mut random = Random(9);
            // A homogeneous strain keeps the facets affine, copies apart.
            let strain = nalgebra::Matrix3::from_fn(|i, j| 0.03 * random.next() + if i == j { 1.0 } else { 0.0 });
            let x1: Vec<_> = one.x.iter().map(|p| strain * p).collect();
            let lambda: Vec<_> = (0..x1.len())
                .map(|a| contact.normal(a).unwrap() * (-0.6 + 0.5 * random.next()) + random.vector(0.2))
                .collect();
            let states = contact.responses(&x1, &two.x, &lambda, None).unwrap();
            assert!(states.iter().filter(|r| r.state != State::Gap).count() > 3, "{what}");
            let mut at = Point { contact: &mut contact, x1: &x1, x2: &two.x, lambda: &lambda };
            let error = at.difference_error(0.0);
            assert!(error <= DIFFERENCES, "{what} {form:?}: {error:e}");
        }
    }
}

/// Two facets with eight nodes, a right angle between them: the three nodes of their edge are listed once a side, mid node
/// included, and parts of one facet are not split from each other.
#[test]
fn a_crease_between_quadratic_facets_is_split_at_its_mid_nodes_too() {
    let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
    let x = vec![
        at(0.0, 0.0, 0.0),
        at(1.0, 0.0, 0.0),
        at(1.0, 1.0, 0.0),
        at(0.0, 1.0, 0.0),
        at(0.5, 0.0, 0.0),
        at(1.0, 0.5, 0.0),
        at(0.5, 1.0, 0.0),
        at(0.0, 0.5, 0.0),
        at(1.0, 0.0, -1.0),
        at(1.0, 1.0, -1.0),
        at(1.0, 0.0, -0.5),
        at(1.0, 0.5, -1.0),
        at(1.0, 1.0, -0.5),
    ];
    let facets = vec![vec![0, 1, 2, 3, 4, 5, 6, 7], vec![1, 8, 9, 2, 10, 11, 12, 5]];
    let equations = vec![[NO_EQUATION; 3]; x.len()];
    let surface = Surface::new("surface", x, &facets, equations).unwrap();
    let split = surface.split_creases(0.5).unwrap();
    assert_eq!(split.facet_nodes.len(), 16);
    assert_eq!(split.originals[13..], [1, 2, 5]);
    assert_eq!(split.facet_nodes[..8], [0, 1, 2, 3, 4, 5, 6, 7]);
    assert_eq!(split.facet_nodes[8..], [13, 8, 9, 14, 10, 11, 12, 15]);
    assert_eq!(surface.split_creases(2.0).unwrap().originals.len(), 13);
}
