//! Systems without multipliers: golden cases, against systems with multipliers, their derivatives, what is refused.

use super::golden::{Golden, set_up_with};
use super::weak::{self, WEAK};
use crate::support::mesh::*;
use crate::support::parents::*;
use crate::support::*;
use nalgebra::{DMatrix, DVector, Rotation3, SVector};
use serde_json::Value;
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::interface::{
    Contact, Csr, Form, Friction, Interface, MultiplierBasis, NO_EQUATION, NO_WEAK_COVERAGE, Normals, Options, Owner,
    Piece, Stiffness, Surface, Weights,
};

/// Golden L, J_cond and R_cond, relative to the largest entry.
const SYSTEM: f64 = 1e-12;
/// The same of facets that are not affine: the golden derivatives are those of the rule, ours those of the integrals.
const RULE: f64 = 1e-4;
/// Golden steps and multipliers: the condition of the system times rounding.
const SOLUTION: f64 = 1e-9;
/// The step and the multipliers against those of the system with multipliers, likewise.
const SAME: f64 = 1e-10;
/// Derivatives against central differences, relative to a row's largest.
const DIFFERENCES: f64 = 1e-7;

/// A host: the derivative and the value of the residual of its own forces, all rows dense.
pub struct Dense {
    pub j: DMatrix<f64>,
    pub r: DVector<f64>,
    /// Of a dense matrix.
    offsets: Vec<i64>,
    columns: Vec<i64>,
}

impl Dense {
    pub fn new(j: DMatrix<f64>, r: DVector<f64>) -> Dense {
        let n = r.len() as i64;
        let offsets = (0..=n).map(|k| k * n).collect();
        Dense { j, r, offsets, columns: (0..n * n).map(|k| k % n).collect() }
    }

    fn of_nodes(&self, range: std::ops::Range<usize>) -> Vec<Vec3> {
        self.r.as_slice()[3 * range.start..3 * range.end].chunks_exact(3).map(Vec3::from_column_slice).collect()
    }
}

/// Where a system is made.
pub struct At<'a, const N: usize> {
    contact: &'a mut Contact<N>,
    x1: &'a [Vec3],
    x2: &'a [Vec3],
    lambda: &'a [SVector<f64, N>],
}

impl<const N: usize> At<'_, N> {
    /// The condensed matrix in place, and the residual.
    pub fn condensed(&mut self, host: &Dense) -> (DMatrix<f64>, DVector<f64>) {
        let (n, n1) = (host.r.len(), self.x1.len());
        let csr = Csr::new(0, &host.offsets, &host.columns);
        let rows = self.contact.condense((self.x1, self.x2), self.lambda, csr, &|k| host.j[(k / n, k % n)]).unwrap();
        let mut j = host.j.clone();
        rows.places().for_each(|(place, value)| j[(place / n, place % n)] = value);
        let of_one = host.of_nodes(0..n1);
        let (rows, gains) = self.contact.condensed_residual(self.x1, self.x2, self.lambda, &of_one).unwrap();
        let mut r = host.r.clone();
        for (k, v) in rows.iter().flat_map(|v| v.iter()).enumerate() {
            r[k] = *v;
        }
        for (k, v) in gains.iter().flat_map(|v| v.iter()).enumerate() {
            r[3 * n1 + k] += v;
        }
        (j, r)
    }

    pub fn piece(&mut self, n: usize, piece: Piece) -> DMatrix<f64> {
        let mut m = DMatrix::zeros(n, n);
        let mut add = |i: i64, j: i64, v: f64| m[(i as usize, j as usize)] += v;
        self.contact.condensed_tangent((self.x1, self.x2), self.lambda, piece, &mut add).unwrap();
        m
    }

    /// The multipliers after a step.
    fn recovered(&mut self, host: &Dense, du: &DVector<f64>) -> Vec<SVector<f64, N>> {
        let moved = Dense::new(host.j.clone(), &host.r + self.linear(host) * du);
        self.contact.condensed_multipliers(self.x1, self.x2, &moved.of_nodes(0..self.x1.len())).unwrap()
    }

    /// The host's matrix with what the contact forces add.
    fn linear(&mut self, host: &Dense) -> DMatrix<f64> {
        &host.j + self.piece(host.r.len(), Piece::Forces)
    }

    /// The step and the new multipliers of the system with multipliers.
    fn with_multipliers(&mut self, host: &Dense) -> (DVector<f64>, DVector<f64>) {
        let (n, m) = (host.r.len(), N * self.x1.len());
        let mut k = DMatrix::zeros(n + m, n + m);
        k.view_mut((0, 0), (n, n)).copy_from(&host.j);
        let mut add = |i: i64, j: i64, v: f64| k[(i as usize, j as usize)] += v;
        self.contact.tangent(self.x1, self.x2, self.lambda, None, &mut add).unwrap();
        let residual = self.contact.residual(self.x1, self.x2, self.lambda, None).unwrap();
        let forces = residual.nonmortar.iter().chain(&residual.mortar).flat_map(|v| v.iter());
        let own = forces.zip(&host.r).map(|(f, h)| f + h);
        let all = own.chain(residual.rows.iter().flat_map(|v| v.iter().copied()));
        let r = DVector::from_iterator(n + m, all);
        // A multiplier that is not there has no equation.
        for i in (n..n + m).filter(|&i| k.row(i).amax() == 0.0).collect::<Vec<_>>() {
            k[(i, i)] = 1.0;
        }
        let step = -k.lu().solve(&r).unwrap();
        let lambda = DVector::from_iterator(m, self.lambda.iter().flat_map(|l| l.iter().copied()));
        (step.rows(0, n).into_owned(), step.rows(n, m) + lambda)
    }
}

fn golden_dual(case: &Value) -> Golden {
    let of = Options::paper(Stiffness::Augmentation(1.0));
    set_up_with(case, Options { basis: MultiplierBasis::Dual, weak_coverage: NO_WEAK_COVERAGE, ..of })
}

/// The largest difference over the largest value.
fn error<'a>(found: impl IntoIterator<Item = &'a f64>, expected: &[f64]) -> f64 {
    let found: Vec<f64> = found.into_iter().copied().collect();
    assert_eq!(found.len(), expected.len());
    max_abs(found.iter().zip(expected).map(|(a, b)| a - b)) / max_abs(expected.iter().copied())
}

fn flat(v: &Value) -> Vec<f64> {
    if v.is_array() { v.as_array().unwrap().iter().flat_map(flat).collect() } else { vec![v.as_f64().unwrap()] }
}

#[test]
fn golden_condensed_systems() {
    let mut compared = 0;
    for case in golden_part("golden_dual.json", "interfaces").iter().filter(|c| c["condensed"].is_object()) {
        let (mut g, expected) = (golden_dual(case), &case["condensed"]);
        let (n1, n) = (g.x1.len(), 3 * (g.x1.len() + g.x2.len()));
        let (j, r) = golden_host(n);
        let host = Dense::new(j, r);
        let Golden { interface, x1, x2, lambda } = &mut g;
        let mut at = At { contact: interface, x1, x2, lambda };
        let (j, r) = at.condensed(&host);
        let derivatives = if case["affine"].as_bool().unwrap() { SYSTEM } else { RULE };
        let l = at.piece(n, Piece::Elimination) + DMatrix::identity(n, n);
        let (w, p) = (flat(&expected["W"]), table(&expected["P"]));
        for a in 0..n1 {
            let found = l.view((3 * a, 3 * a), (3, 3)).transpose();
            assert!(max_abs(found.iter().zip(&w[9 * a..]).map(|(a, b)| a - b)) <= SYSTEM, "{}: W_{a}", name(case));
            for (c, p) in p[a].iter().enumerate() {
                let found = l.view((3 * (n1 + c), 3 * a), (3, 3)).into_owned();
                assert!((found - DMatrix::identity(3, 3) * *p).amax() <= SYSTEM, "{}: P_{a}{c}", name(case));
            }
        }
        let errors =
            [error(j.transpose().iter(), &flat(&expected["J_cond"])), error(r.iter(), &flat(&expected["R_cond"]))];
        println!("{:32} J {:.1e} R {:.1e}", name(case), errors[0], errors[1]);
        assert!(errors[0] <= derivatives && errors[1] <= SYSTEM, "{}: {errors:?}", name(case));
        let pieces = &l * at.linear(&host) + at.piece(n, Piece::Constraints);
        assert!((pieces - &j).amax() <= SYSTEM * j.amax(), "{}: in place and in pieces", name(case));
        let du = -j.lu().solve(&r).unwrap();
        let new = at.recovered(&host, &du);
        let bound = if derivatives == SYSTEM { SOLUTION } else { RULE };
        assert!(error(du.iter(), &flat(&expected["du"])) <= bound, "{}: du", name(case));
        let new: Vec<f64> = new.iter().flat_map(|l| l.iter().copied()).collect();
        assert!(error(&new, &flat(&expected["lambda_new"])) <= bound, "{}: lambda", name(case));
        compared += 1;
    }
    assert!(compared > 0);
}

/// Scenes with carried nodes and without, on tilted surfaces that slide off an edge.
pub fn scene<const N: usize>(options: Options) -> weak::Scene<N>
where
    Contact<N>: Create<N>,
{
    weak::scene::<N>(&Options { basis: MultiplierBasis::Dual, ..options }, Cells::Quads)
}

pub fn at<const N: usize>(s: &mut weak::Scene<N>) -> At<'_, N> {
    At { contact: &mut s.contact, x1: &s.x1, x2: &s.x2, lambda: &s.lambda }
}

pub fn random_host(n: usize, seed: u64) -> Dense {
    let mut random = Random(seed);
    let mut j = DMatrix::from_fn(n, n, |_, _| random.next());
    j += DMatrix::identity(n, n) * 20.0;
    Dense::new(j, DVector::from_fn(n, |_, _| random.next()))
}

fn is_the_system_with_multipliers<const N: usize>(s: &mut weak::Scene<N>, what: &str) {
    let (n, n1) = (3 * (s.x1.len() + s.x2.len()), s.x1.len());
    let host = random_host(n, 11);
    // Multipliers of nodes that have none of their own are ignored: take those in force.
    let sums = s.contact.sums(&s.x1, &s.x2).unwrap();
    let open: Vec<_> = (0..n1).filter(|&a| sums[a].coverage == 0.0).collect();
    let mut point = at(s);
    let (expected, lambda) = point.with_multipliers(&host);
    let (j, r) = point.condensed(&host);
    let step = -j.lu().solve(&r).unwrap();
    let new = point.recovered(&host, &step);
    assert!((&step - &expected).amax() <= SAME * expected.amax(), "{what}: {:e}", (step - &expected).amax());
    for (a, new) in new.iter().enumerate() {
        let expected = lambda.rows(N * a, N);
        let off = max_abs(new.iter().zip(expected.iter()).map(|(a, b)| a - b));
        assert!(off <= SAME * lambda.amax(), "{what}: lambda of node {a} off by {off:e}");
    }
    assert!(open.iter().all(|&a| new[a].amax() == 0.0), "{what}");
}

/// The step and the multipliers are those of the system with multipliers, whatever the state, the law, the weights, carried
/// nodes, and directions in which nodes have no multiplier.
#[test]
fn is_the_same_step_as_with_multipliers() {
    let kinds = [
        (Weights::Current, Normals::Committed),
        (Weights::Current, Normals::Current),
        (Weights::Committed, Normals::Committed),
    ];
    for (weak_coverage, (weights, normals)) in [NO_WEAK_COVERAGE, WEAK].into_iter().flat_map(|w| kinds.map(|v| (w, v)))
    {
        for friction in [Friction::Coulomb, Friction::Rough, Friction::Tied, Friction::Tresca] {
            let options = under(friction, 0.4, Options { weights, normals, weak_coverage, ..options() });
            let mut s = scene::<3>(options);
            complete(&mut s);
            let what = format!("{friction:?} {weak_coverage} {weights:?} {normals:?}");
            is_the_system_with_multipliers(&mut s, &what);
            let in_plane = Rotation3::from_euler_angles(0.4, -0.9, 1.3) * Vec3::y();
            let directions: Vec<_> = (0..s.x1.len()).step_by(2).map(|a| (a, in_plane)).collect();
            s.contact.set_constraints(&directions).unwrap();
            complete(&mut s);
            is_the_system_with_multipliers(&mut s, &format!("{what}, directions taken away"));
        }
        let options = Options { friction: Friction::None, mu: 0.0, weights, normals, weak_coverage, ..options() };
        let mut s = scene::<1>(options);
        complete(&mut s);
        is_the_system_with_multipliers(&mut s, &format!("one multiplier {weak_coverage} {weights:?} {normals:?}"));
    }
}

/// Puts the multipliers in force into a scene: what a Newton step in displacements starts from.
pub fn complete<const N: usize>(s: &mut weak::Scene<N>) {
    let host: Vec<Vec3> = (0..s.x1.len()).map(|a| Vec3::new(0.02 * a as f64, 0.01, 0.03)).collect();
    s.lambda = s.contact.condensed_multipliers(&s.x1, &s.x2, &host).unwrap();
}

/// F(u) with the multipliers that balance a host's linear forces.
fn eliminated<const N: usize>(s: &mut weak::Scene<N>, host: &Dense, u: &DVector<f64>) -> DVector<f64> {
    let (n1, x) = (s.x1.len(), |k: usize| Vec3::new(u[3 * k], u[3 * k + 1], u[3 * k + 2]));
    let x1: Vec<_> = (0..n1).map(|k| s.x1[k] + x(k)).collect();
    let x2: Vec<_> = (0..s.x2.len()).map(|k| s.x2[k] + x(n1 + k)).collect();
    let moved = Dense::new(host.j.clone(), &host.r + &host.j * u);
    let lambda = s.contact.condensed_multipliers(&x1, &x2, &moved.of_nodes(0..n1)).unwrap();
    At { contact: &mut s.contact, x1: &x1, x2: &x2, lambda: &lambda }.condensed(&moved).1
}

fn is_its_derivative<const N: usize>(s: &mut weak::Scene<N>, what: &str) {
    const STEP: f64 = 1e-6;
    let (n1, n) = (s.x1.len(), 3 * (s.x1.len() + s.x2.len()));
    let mut host = random_host(n, 5);
    host.j *= 0.05;
    host.r *= 0.05;
    s.lambda = s.contact.condensed_multipliers(&s.x1, &s.x2, &host.of_nodes(0..n1)).unwrap();
    let (mut j, r) = at(s).condensed(&host);
    assert_eq!(eliminated(s, &host, &DVector::zeros(n)), r, "{what}: evaluated at the same point");
    let scales = at(s).piece(n, Piece::Scales);
    let matters = scales.amax() > 1e-3 * j.amax();
    j += scales;
    for column in 0..n {
        let mut at = |h: f64| {
            let mut u = DVector::zeros(n);
            u[column] = h;
            eliminated(s, &host, &u)
        };
        let slope = (at(STEP) - at(-STEP)) / (2.0 * STEP);
        for row in 0..n {
            let (off, largest) = ((j[(row, column)] - slope[row]).abs(), j.row(row).amax());
            assert!(off <= DIFFERENCES * largest, "{what}: row {row}, column {column}: {off:e} of {largest:e}");
        }
    }
    assert!(matters || what.contains("frozen"), "{what}: the change of the scales could be left out");
}

/// With the piece of the scales the matrix is the exact derivative of the residual whose multipliers follow from the
/// displacements. (Without it Newton's method cycled for ever where a surface on springs slips.)
#[test]
fn the_matrix_is_the_derivative_of_the_eliminated_residual() {
    for (friction, mu) in [(Friction::Coulomb, 0.4), (Friction::Tied, 0.0), (Friction::Rough, 0.0)] {
        for weak_coverage in [NO_WEAK_COVERAGE, WEAK] {
            for (weights, normals) in [
                (Weights::Current, Normals::Committed),
                (Weights::Current, Normals::Current),
                (Weights::Committed, Normals::Committed),
            ] {
                let options = Options { friction, mu, weak_coverage, weights, normals, ..options() };
                let frozen = weights != Weights::Current || friction == Friction::Tied;
                let what = format!("{friction:?} {weak_coverage} {}", if frozen { "frozen" } else { "" });
                is_its_derivative(&mut scene::<3>(options), &what);
            }
        }
    }
    is_its_derivative(&mut scene::<1>(Options { friction: Friction::None, mu: 0.0, ..options() }), "one multiplier");
}

#[test]
fn an_evaluation_knows_nothing_of_the_calls_before_it() {
    let mut s = scene::<3>(Options { weak_coverage: WEAK, ..options() });
    let host = random_host(3 * (s.x1.len() + s.x2.len()), 2);
    let zero = DVector::zeros(host.r.len());
    let other = DVector::from_element(host.r.len(), 1e-3);
    let first = eliminated(&mut s, &host, &zero);
    assert_ne!(eliminated(&mut s, &host, &other), first);
    assert_eq!(eliminated(&mut s, &host, &zero), first);
}

/// The pattern for a sparse host has all entries, with the condensed system in place in it; without it nothing is changed.
#[test]
fn the_pattern_has_what_condensing_needs() {
    for weak_coverage in [NO_WEAK_COVERAGE, WEAK] {
        let mut s = scene::<3>(Options { weak_coverage, ..options() });
        complete(&mut s);
        let n = 3 * (s.x1.len() + s.x2.len());
        // Each node is tied to itself and to the one after the next.
        let coupled = |i: usize, j: usize| i / 3 == j / 3 || i.abs_diff(j) == 6;
        let mut entries: Vec<(i64, i64)> =
            (0..n * n).filter(|k| coupled(k / n, k % n)).map(|k| ((k / n) as i64, (k % n) as i64)).collect();
        let csr_of = |entries: &[(i64, i64)]| {
            let offsets: Vec<i64> = (0..=n as i64).map(|r| entries.partition_point(|e| e.0 < r) as i64).collect();
            (offsets, entries.iter().map(|e| e.1).collect::<Vec<i64>>())
        };
        let (offsets, columns) = csr_of(&entries);
        let csr = Csr::new(0, &offsets, &columns);
        let refused = s.contact.condense((&s.x1, &s.x2), &s.lambda, csr, &|_| 1.0).unwrap_err();
        assert_eq!(refused.kind, Kind::MissingEntry);
        let mut more = Vec::new();
        s.contact.condensed_pattern(&s.x1, &s.x2, &csr, &mut |i: i64, j: i64, _: f64| more.push((i, j))).unwrap();
        entries.extend(more);
        entries.sort_unstable();
        entries.dedup();
        assert!(entries.len() < n * n, "the pattern is full");
        let (offsets, columns) = csr_of(&entries);
        let value = |i: usize, j: usize| if coupled(i, j) { 1.0 + ((3 * i + 5 * j) % 7) as f64 } else { 0.0 };
        let at_place = |k: usize| value(entries[k].0 as usize, entries[k].1 as usize);
        let rows = s.contact.condense((&s.x1, &s.x2), &s.lambda, Csr::new(0, &offsets, &columns), &at_place).unwrap();
        let host = Dense::new(DMatrix::from_fn(n, n, value), DVector::zeros(n));
        let mut sparse = host.j.clone();
        rows.places().for_each(|(k, v)| sparse[(entries[k].0 as usize, entries[k].1 as usize)] = v);
        assert_eq!(sparse, at(&mut s).condensed(&host).0);
    }
}

/// Changes the equations of the non-mortar side, of the mortar side, of the multipliers.
type Change<'a> = &'a dyn Fn(&mut [[i64; 3]], &mut [[i64; 3]], &mut [[i64; 3]]);

#[test]
fn what_cannot_be_condensed_is_refused_by_name() {
    let one = grid(2, 1, [0.0, 0.0], [1.0, 1.0], -0.01, false, Cells::Quads);
    let two = floor();
    let (n1, n) = (one.x.len(), one.x.len() + two.x.len());
    let dual = Options { basis: MultiplierBasis::Dual, ..options() };
    let surface = |side, mesh: &Mesh, equations: Vec<[i64; 3]>| {
        Surface::new(side, mesh.x.clone(), &mesh.facets, equations).unwrap()
    };
    let refusal = |change: Change, options: Options| {
        let (mut e1, mut e2, mut m) = (numbered(0, n1), numbered(3 * n1, n - n1), numbered(3 * n, n1));
        change(&mut e1, &mut e2, &mut m);
        let mut c = Interface::new(surface("nonmortar", &one, e1), surface("mortar", &two, e2), m, options).unwrap();
        c.condensed_multipliers(&one.x, &two.x, &vec![Vec3::z(); n1]).map_err(|e| (e.kind, e.to_string()))
    };
    let refused = |change: Change, options: Options, words: &str| {
        let (kind, text) = refusal(change, options).unwrap_err();
        assert!(kind == Kind::Unsupported && text.contains(words), "{text}");
    };
    refused(&|_, _, _| {}, options(), "standard multipliers");
    refused(&|_, _, _| {}, Options { form: Form::Augmented, ..dual }, "augmented form");
    refused(&|e1, _, _| e1[2][1] = NO_EQUATION, dual, "component 1 of non-mortar node 2 is prescribed");
    refused(&|e1, _, _| e1[2] = e1[3], dual, "non-mortar nodes 2 and 3 have an equation in common");
    refused(&|e1, e2, _| e2[1][0] = e1[4][0], dual, "non-mortar node 4 and mortar node 1");
    refused(&|e1, _, _| e1[2][1] = e1[2][0], dual, "two components of non-mortar node 2");
    refusal(&|_, _, _| {}, dual).unwrap();
    // Without a multiplier there, it can be.
    refusal(&|e1, _, m| (e1[2][1], m[2][1]) = (NO_EQUATION, NO_EQUATION), dual).unwrap();
    refusal(&|e1, _, m| (e1[2], m[2], m[3]) = (e1[3], [NO_EQUATION; 3], [NO_EQUATION; 3]), dual).unwrap();
    let mut c: Interface = interface(&one, &two, dual);
    let mut owners = vec![Owner::Here; n1];
    owners[3] = Owner::Shared;
    c.set_owners(owners).unwrap();
    let error = c.condensed_multipliers(&one.x, &two.x, &vec![Vec3::z(); n1]).unwrap_err();
    assert!(error.kind == Kind::Unsupported && error.to_string().contains("nodes that handles share"), "{error}");
}

/// A copy of a node on a crease that has no multiplier gave the host's row of both as its own, beside the condensed one: a
/// host that wrote it last lost the constraint.
#[test]
fn a_copy_without_a_multiplier_took_the_row_of_the_node_that_has_one() {
    let (one, two) = (grid(2, 1, [0.0, 0.0], [1.0, 1.0], -0.01, false, Cells::Quads), floor());
    let n1 = one.x.len();
    for (copy, node) in [(2, 3), (3, 2)] {
        let (mut e1, mut m) = (numbered(0, n1), numbered(100, n1));
        (e1[copy], m[copy]) = (e1[node], [NO_EQUATION; 3]);
        let surface = |side, mesh: &Mesh, e| Surface::new(side, mesh.x.clone(), &mesh.facets, e).unwrap();
        let sides = (surface("nonmortar", &one, e1), surface("mortar", &two, numbered(50, two.x.len())));
        let options = Options { basis: MultiplierBasis::Dual, ..options() };
        let mut c = Interface::new(sides.0, sides.1, m, options).unwrap();
        let error = c.condensed_multipliers(&one.x, &two.x, &vec![Vec3::z(); n1]).unwrap_err();
        let words = format!("non-mortar nodes {node} and {copy} have an equation in common, and node {copy} has no");
        assert!(error.kind == Kind::Unsupported && error.to_string().contains(&words), "{error}");
    }
}

/// Two quadrilaterals at the middle of an edge of one with eight nodes: the multiplier of the node between them came back off by
/// as much as it was, with status 0.
#[test]
fn a_mid_node_that_is_a_corner_elsewhere_is_not_condensed() {
    let at = [[0, 0], [0, 2], [2, 2], [2, 0], [0, 1], [1, 2], [2, 1], [1, 0], [3, 0], [3, 1], [3, 2]];
    let x: Vec<_> = at.iter().map(|p| Vec3::new(0.25 * f64::from(p[0]), 0.25 * f64::from(p[1]), -0.01)).collect();
    let facets = [(0..8).collect(), vec![3, 6, 9, 8], vec![6, 2, 10, 9]];
    let (two, n1) = (floor(), x.len());
    let mut multipliers = numbered(100, n1);
    [4, 5, 7].iter().for_each(|&a| multipliers[a] = [NO_EQUATION; 3]);
    let one = Surface::new("nonmortar", x.clone(), &facets, numbered(0, n1)).unwrap();
    let mortar = Surface::new("mortar", two.x.clone(), &two.facets, numbered(50, two.x.len())).unwrap();
    let options = Options { basis: MultiplierBasis::Dual, ..options() };
    let mut c = Interface::new(one, mortar, multipliers, options).unwrap();
    let error = c.condensed_multipliers(&x, &two.x, &vec![Vec3::z(); n1]).unwrap_err();
    let words = "non-mortar node 6 is a mid node of facet 0 and a corner of another one";
    assert!(error.kind == Kind::Unsupported && error.to_string().contains(words), "{error}");
}

fn floor() -> Mesh {
    grid(1, 1, [-0.5, -0.5], [1.5, 1.5], 0.0, true, Cells::Quads)
}

/// Quadratic facets, mixed, covered in part, with carried nodes and without: the rows of nodes without multipliers are changed too.
pub fn of_parents<const N: usize>(options: Options, prescribed: bool, kinds: [&[usize]; 2]) -> weak::Scene<N>
where
    Contact<N>: Create<N>,
{
    let options = Options { basis: MultiplierBasis::Dual, ..options };
    let m = moved_parents::<N>(&options, kinds, Roughness { slide: 2.6, ..FLAT }, 0.0, prescribed, 5);
    weak::Scene { contact: m.contact, x1: m.x1, x2: m.x2, lambda: m.lambda }
}

#[test]
fn quadratic_facets_take_the_same_step_as_with_multipliers() {
    for kinds in [[&[8][..], &[6][..]], [&[9, 8, 6, 6], &[8, 6, 9, 9, 8]], [&[6], &[4]], [&[4], &[9]]] {
        for (weak_coverage, weights) in
            [NO_WEAK_COVERAGE, WEAK].into_iter().flat_map(|w| [Weights::Current, Weights::Committed].map(|v| (w, v)))
        {
            for friction in [Friction::Coulomb, Friction::Rough, Friction::Tied] {
                let options = under(friction, 0.4, Options { weights, weak_coverage, ..options() });
                let mut s = of_parents::<3>(options, false, kinds);
                complete(&mut s);
                is_the_system_with_multipliers(&mut s, &format!("{kinds:?} {friction:?} {weak_coverage} {weights:?}"));
            }
            let options = Options { friction: Friction::None, mu: 0.0, weights, weak_coverage, ..options() };
            let mut s = of_parents::<1>(options, false, kinds);
            complete(&mut s);
            is_the_system_with_multipliers(&mut s, &format!("{kinds:?} one multiplier {weak_coverage} {weights:?}"));
        }
    }
}

/// Seconds and more: `make test-long`.
mod long {
    use super::*;

    #[test]
    fn the_matrix_of_quadratic_facets_is_the_derivative() {
        for weak_coverage in [NO_WEAK_COVERAGE, WEAK] {
            let options = Options { mu: 0.4, weak_coverage, ..options() };
            is_its_derivative(
                &mut of_parents::<3>(options, false, [&[8], &[6]]),
                &format!("quadratic {weak_coverage}"),
            );
        }
    }
}
