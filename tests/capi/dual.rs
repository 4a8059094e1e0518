//! Golden facets and interfaces with dual multipliers, by the stateless calls of the C ABI.

use super::golden::*;
use crate::support::*;
use serde_json::{Value, json};
use std::ffi::CStr;
use std::mem::{size_of, zeroed};
use std::ptr::{null, null_mut};
use stickslip::capi::*;
use stickslip::dual::{DualBasis, FacetSums};
use stickslip::geometry::{Facet, Vec3};
use stickslip::mortar::{NonmortarFrame, PairWeights};

/// Rounding of the sums over pairs, relative to the largest number; of slivers, to the facet's area.
const SUMS: f64 = 1e-13;
/// Of dual weights: sums times coefficients. The rule of degree 10 on warped facets is as exact (measured 1.1e-14).
const WEIGHTS: f64 = 1e-12;
/// Under an inner strip, where the condition is 2e4.
const WEIGHTS_UNDER_A_STRIP: f64 = 1e-10;
/// Residual blocks, relative to the largest entry of the block.
const RESIDUAL: f64 = 1e-12;
/// Tangent blocks of affine interfaces, and of warped ones with the rule of degree 10.
const TANGENT: f64 = 1e-10;
const RULE_TANGENT: f64 = 1e-4;
/// A block smaller than this part of the matrix is what is left of pairs that cancel: its rounding is 1e-16 of the matrix.
const VANISHING: f64 = 1e-5;

/// A non-mortar facet with all mortar facets, at some positions.
struct Patch {
    nodes1: Vec<i64>,
    nodes2: Vec<Vec<i64>>,
    n2: Vec<i32>,
    x1: Vec<f64>,
    /// One mortar facet after the other.
    x2: Vec<f64>,
    quadrature: i32,
    /// Points along a side in place of overlaps, or 0.
    points: i64,
    mass: Vec<f64>,
    /// n_ab and n_ac of one pair after the other, and their dual ones.
    ab: Vec<Vec<f64>>,
    ac: Vec<Vec<f64>>,
    dual_ab: Vec<Vec<f64>>,
    dual_ac: Vec<Vec<f64>>,
}

impl Patch {
    /// Stages 1 and 1b.
    fn new(one: (&Value, Vec<i64>), two: (&Value, Vec<Vec<i64>>), quadrature: i32) -> Patch {
        let mut patch = Patch::at(one, two, quadrature);
        patch.integrate();
        patch
    }

    fn at((x1, nodes1): (&Value, Vec<i64>), (x2, nodes2): (&Value, Vec<Vec<i64>>), quadrature: i32) -> Patch {
        let gather = |x: &Value, nodes: &[i64]| nodes.iter().flat_map(|&k| flat(&x[k as usize])).collect::<Vec<_>>();
        let n = nodes1.len();
        Patch {
            n2: nodes2.iter().map(|f| f.len() as i32).collect(),
            x1: gather(x1, &nodes1),
            x2: gather(x2, &nodes2.concat()),
            quadrature,
            points: 0,
            mass: vec![0.0; n * n],
            ab: nodes2.iter().map(|_| vec![f64::NAN; n * n]).collect(),
            ac: nodes2.iter().map(|f| vec![f64::NAN; n * f.len()]).collect(),
            dual_ab: Vec::new(),
            dual_ac: Vec::new(),
            nodes1,
            nodes2,
        }
    }

    fn integrate(&mut self) {
        self.mass.fill(0.0);
        for p in 0..self.n2.len() {
            let (pair, ab, ac) = (self.pair(p), self.ab[p].as_mut_ptr(), self.ac[p].as_mut_ptr());
            let mut raw = pair.raw();
            raw.element_points = self.points;
            ok!(stickslip_pair_weights(&raw, ab, ac, null_mut(), null_mut()));
            self.mass.iter_mut().zip(&self.ab[p]).for_each(|(m, n)| *m += n);
        }
        // In place, as a host may that needs the integrated ones no more.
        (self.dual_ab, self.dual_ac) = (self.ab.clone(), self.ac.clone());
        for p in 0..self.n2.len() {
            let (pair, mass) = (self.pair(p), self.mass.as_ptr());
            let (ab, ac) = (self.dual_ab[p].as_mut_ptr(), self.dual_ac[p].as_mut_ptr());
            ok!(stickslip_pair_dual(&pair.raw(), mass, ab, ac, ab, ac));
        }
    }

    fn pair(&self, p: usize) -> Pair {
        let first = 3 * self.n2[..p].iter().sum::<i32>() as usize;
        let x2 = self.x2[first..][..3 * self.n2[p] as usize].to_vec();
        Pair { x1: self.x1.clone(), x2, quadrature: self.quadrature, space: STICKSLIP_SPACE_CORNER }
    }

    fn raw(&self) -> stickslip_facet {
        let mut facet = sized!(stickslip_facet);
        (facet.n1, facet.n_pairs, facet.quadrature) = (self.nodes1.len() as i32, self.n2.len() as i64, self.quadrature);
        facet.element_points = self.points;
        (facet.x1, facet.n2, facet.x2) = (self.x1.as_ptr(), self.n2.as_ptr(), self.x2.as_ptr());
        facet
    }

    /// Its basis by the library's own functions.
    fn basis(&self) -> Option<DualBasis> {
        let points: Vec<_> = self.x1.chunks_exact(3).map(Vec3::from_column_slice).collect();
        let mut sums = FacetSums::new(&NonmortarFrame::new(&Facet::new(&points).unwrap()).unwrap());
        for (k, m) in self.mass.iter().enumerate() {
            sums.mass[k / points.len()][k % points.len()] = *m;
        }
        DualBasis::of(&sums).unwrap()
    }

    /// n^d_AC over all mortar nodes, row A.
    fn row_sums(&self, mortar: usize) -> Vec<f64> {
        let n = self.nodes1.len();
        let mut sums = vec![0.0; n * mortar];
        for (nodes, dual) in self.nodes2.iter().zip(&self.dual_ac) {
            for (k, v) in dual.iter().enumerate() {
                sums[k / nodes.len() * mortar + nodes[k % nodes.len()] as usize] += v;
            }
        }
        sums
    }
}

#[test]
fn golden_facets() {
    for case in golden_part("golden_dual.json", "facets") {
        let nodes1: Vec<i64> = (0..case["x1"].as_array().unwrap().len() as i64).collect();
        let n = nodes1.len();
        let quadrature =
            if case["affine"] == true { STICKSLIP_QUADRATURE_DEGREE_5 } else { STICKSLIP_QUADRATURE_DEGREE_10 };
        let expected = if case["affine"] == true { &case } else { &case["exact"] };
        let patch = Patch::new((&case["x1"], nodes1), (&case["x2"], facets(&case["facets2"])), quadrature);
        let (mut fade, mut areas, mut turn) = (f64::NAN, vec![f64::NAN; n], vec![f64::NAN; n * n]);
        let (mass, a, t) = (patch.mass.as_ptr(), areas.as_mut_ptr(), turn.as_mut_ptr());
        ok!(stickslip_facet_dual(n as i32, patch.x1.as_ptr(), mass, &mut fade, a, t));
        let basis = patch.basis();
        let area = basis.map_or(1.0, |b| b.area);
        let is_sliver = name(&case).contains("sliver");
        let scaled = |v: &[f64]| if is_sliver { area } else { max_abs(v.iter().copied()) };
        let check = |what: &str, found: &[f64], expected: &[f64], bound: f64| {
            let error = relative(difference(found, expected), scaled(expected));
            println!("{:40} {what:6} {error:.1e}", name(&case));
            assert!(error <= bound, "{}: {what} off by {error:e}", name(&case));
        };
        assert!((fade - case["fade"].as_f64().unwrap()).abs() <= SUMS, "{}: phi is {fade}", name(&case));
        check("D", &areas, &numbers(&expected["D"]), SUMS);
        let bound = if name(&case).contains("strip") { WEIGHTS_UNDER_A_STRIP } else { WEIGHTS };
        let mortar = case["x2"].as_array().unwrap().len();
        check("nd", &patch.row_sums(mortar), &flat(&expected["nd"]), bound);
        if case["affine"] == true && fade == 1.0 && !is_sliver {
            check("A", &turn, &flat(&case["A"]), bound);
        }
        same_bits_as_the_library(&patch, basis.as_ref());
    }
}

/// What the handle calls for each pair gives these bits.
fn same_bits_as_the_library(patch: &Patch, basis: Option<&DualBasis>) {
    let n = patch.nodes1.len();
    for p in 0..patch.n2.len() {
        let mut weights = PairWeights::default();
        let n2 = patch.n2[p] as usize;
        for a in 0..n {
            weights.ab[a][..n].copy_from_slice(&patch.ab[p][a * n..][..n]);
            weights.ac[a][..n2].copy_from_slice(&patch.ac[p][a * n2..][..n2]);
        }
        let dual = basis.map_or_else(PairWeights::default, |basis| basis.weights(&weights));
        for a in 0..n {
            assert_eq!(dual.ab[a][..n], patch.dual_ab[p][a * n..][..n]);
            assert_eq!(dual.ac[a][..n2], patch.dual_ac[p][a * n2..][..n2]);
        }
    }
}

/// The unknowns of an interface's x1, x2 and multipliers, and where they end.
struct Ends([usize; 4]);

impl Ends {
    fn of(case: &Value) -> Ends {
        let [n1, n2] = ["x1", "x2"].map(|x| 3 * case[x].as_array().unwrap().len());
        Ends([0, n1, n1 + n2, n1 + n2 + n1])
    }

    fn unknowns(&self, patch: &Patch, nodes2: &[i64], multipliers: bool) -> Vec<usize> {
        let [_, two, lambda, _] = self.0;
        let last = if multipliers { &patch.nodes1[..] } else { &[] };
        (patch.nodes1.iter().map(|&a| 3 * a as usize))
            .chain(nodes2.iter().map(|&c| two + 3 * c as usize))
            .chain(last.iter().map(|&a| lambda + 3 * a as usize))
            .flat_map(|first| first..first + 3)
            .collect()
    }
}

fn triple(v: &[f64], a: i64) -> [f64; 3] {
    std::array::from_fn(|i| v[3 * a as usize + i])
}

/// Adds a facet's share of coverage and gaps with weights of its own or of t_n, at its positions.
fn add_sums(patch: &Patch, weights: &Patch, coverage: &mut [f64], gaps: &mut [f64]) {
    let n = patch.nodes1.len();
    for p in 0..patch.n2.len() {
        let (ab, ac) = (&weights.dual_ab[p], &weights.dual_ac[p]);
        let mut gap = vec![f64::NAN; 3 * n];
        ok!(stickslip_pair_gap(&patch.pair(p).raw(), ab.as_ptr(), ac.as_ptr(), gap.as_mut_ptr()));
        for (a, &node) in patch.nodes1.iter().enumerate() {
            coverage[node as usize] += ab[a * n..][..n].iter().sum::<f64>();
            (0..3).for_each(|i| gaps[3 * node as usize + i] += gap[3 * a + i]);
        }
    }
}

/// Stage 2 at every node.
fn respond(case: &Value, now: &[Patch], before: &[Patch]) -> Vec<stickslip_node_response> {
    let lambda = flat(&case["lambda"]);
    let n1 = lambda.len() / 3;
    let mut coverage = [vec![0.0; n1], vec![0.0; n1], vec![0.0; n1]];
    let mut gaps = [vec![0.0; 3 * n1], vec![0.0; 3 * n1], vec![0.0; 3 * n1]];
    for (now, before) in now.iter().zip(before) {
        for (k, (patch, weights)) in [(now, now), (now, before), (before, before)].into_iter().enumerate() {
            add_sums(patch, weights, &mut coverage[k], &mut gaps[k]);
        }
    }
    let (mu, r, nu) = (per_node(&case["mu"], n1), per_node(&case["r"], n1), flat(&case["nu"]));
    let largest = max_abs(coverage.iter().flatten().copied());
    let respond = |a: usize| {
        let mut node = sized!(stickslip_node);
        node.slip = slip_option(case);
        (node.lambda, node.normal) = (triple(&lambda, a as i64), triple(&nu, a as i64));
        (node.augmentation, node.mu) = (r[a], mu[a]);
        (node.coverage, node.coverage_previous, node.coverage_min) = (coverage[0][a], coverage[1][a], 1e-8 * largest);
        [node.gap_now, node.gap_previous, node.gap_committed] = gaps.each_ref().map(|g| triple(g, a as i64));
        let mut response = sized!(stickslip_node_response);
        ok!(stickslip_node_respond(&node, &mut response));
        response
    };
    (0..n1).map(respond).collect()
}

/// Residual of the multiplier form, of the augmented form, and tangent of the multiplier form.
fn assemble(case: &Value, quadrature: i32) -> ([Vec<f64>; 2], Vec<f64>) {
    let Ends([_, _, first, n]) = Ends::of(case);
    let patches = |x1: &str, x2: &str| -> Vec<Patch> {
        let nodes1 = facets(&case["facets1"]).into_iter();
        nodes1.map(|f| Patch::new((&case[x1], f), (&case[x2], facets(&case["facets2"])), quadrature)).collect()
    };
    let (now, before) = (patches("x1", "x2"), patches("x1_prev", "x2_prev"));
    let responses = respond(case, &now, &before);
    for (a, (response, expected)) in responses.iter().zip(numbers(&case["state"])).enumerate() {
        assert!(state_matches(case, response.state, expected), "{}: state of node {a}", name(case));
    }
    let lambda = flat(&case["lambda"]);
    let projected: Vec<f64> = responses.iter().flat_map(|r| r.traction).collect();
    let (mut residual, mut tangent) = ([vec![0.0; n], vec![0.0; n]], vec![0.0; n * n]);
    for (patch, before) in now.iter().zip(&before) {
        let local = |v: &[f64]| patch.nodes1.iter().flat_map(|&a| triple(v, a)).collect::<Vec<_>>();
        for (form, traction) in [&lambda, &projected].into_iter().enumerate() {
            for (p, nodes2) in patch.nodes2.iter().enumerate() {
                let (pair, t) = (patch.pair(p), local(traction));
                let mut force = vec![f64::NAN; 3 * (pair.n().0 + pair.n().1)];
                let (ab, ac) = (patch.dual_ab[p].as_ptr(), patch.dual_ac[p].as_ptr());
                ok!(stickslip_pair_residual(&pair.raw(), ab, ac, t.as_ptr(), force.as_mut_ptr()));
                let unknowns = Ends::of(case).unknowns(patch, nodes2, false);
                force.iter().zip(unknowns).for_each(|(f, i)| residual[form][i] += f);
            }
        }
        let unknowns = Ends::of(case).unknowns(patch, &patch.nodes2.concat(), true);
        let size = unknowns.len();
        let mut k = vec![f64::NAN; size * size];
        let of_facet: Vec<_> = patch.nodes1.iter().map(|&a| responses[a as usize]).collect();
        ok!(stickslip_facet_tangent(
            &patch.raw(),
            patch.ab.concat().as_ptr(),
            patch.ac.concat().as_ptr(),
            before.dual_ab.concat().as_ptr(),
            before.dual_ac.concat().as_ptr(),
            local(&lambda).as_ptr(),
            of_facet.as_ptr(),
            null(),
            k.as_mut_ptr(),
            size as i64
        ));
        for (row, &i) in k.chunks_exact(size).zip(&unknowns) {
            row.iter().zip(&unknowns).for_each(|(v, &j)| tangent[i * n + j] += v);
        }
    }
    add_node_blocks(&responses, (first, n), &mut residual, &mut tangent);
    (residual, tangent)
}

#[test]
fn golden_interfaces() {
    let mut compared = 0;
    for case in golden_part("golden_dual.json", "interfaces") {
        let (ends, affine) = (Ends::of(&case).0, case["affine"] == true);
        let (residual, _) = assemble(&case, STICKSLIP_QUADRATURE_DEGREE_5);
        for (residual, key) in residual.iter().zip(["residual_mult", "residual"]) {
            let error = residual_error(ends, residual, &numbers(&case[key]));
            println!("{:32} {key} {error:.1e}", name(&case));
            assert!(error <= RESIDUAL, "{}: {key} off by {error:e}", name(&case));
        }
        let expected = if affine { &case["tangent_mult"] } else { &case["exactquad"]["tangent_mult"] };
        if !expected.is_object() {
            continue;
        }
        let rule = if affine { STICKSLIP_QUADRATURE_DEGREE_5 } else { STICKSLIP_QUADRATURE_DEGREE_10 };
        let (_, tangent) = assemble(&case, rule);
        let error = tangent_error(ends, &tangent, &dense(expected, ends[3]), VANISHING);
        println!("{:32} tangent_mult {error:.1e}", name(&case));
        assert!(error <= if affine { TANGENT } else { RULE_TANGENT }, "{}: tangent off by {error:e}", name(&case));
        compared += 1;
    }
    assert!(compared >= 4, "{compared}");
}

/// Central differences at steps of 1e-6, relative to the largest entry.
const STEP: f64 = 1e-6;
const DIFFERENCES: f64 = 1e-8;

/// Forces at these tractions and gaps, in the order of the facet's matrix: x1, x2 of one pair after the other, multipliers.
fn forces_and_gaps(patch: &Patch, traction: &[f64]) -> Vec<f64> {
    let (own, mortar) = (patch.x1.len(), patch.x2.len());
    let mut values = vec![0.0; own + mortar + own];
    let mut first = own;
    for p in 0..patch.n2.len() {
        let (pair, ab, ac) = (patch.pair(p), patch.dual_ab[p].as_ptr(), patch.dual_ac[p].as_ptr());
        let (mut force, mut gap) = (vec![f64::NAN; own + pair.x2.len()], vec![f64::NAN; own]);
        ok!(stickslip_pair_residual(&pair.raw(), ab, ac, traction.as_ptr(), force.as_mut_ptr()));
        ok!(stickslip_pair_gap(&pair.raw(), ab, ac, gap.as_mut_ptr()));
        for i in 0..own {
            values[i] += force[i];
            values[own + mortar + i] += gap[i];
        }
        values[first..first + pair.x2.len()].copy_from_slice(&force[own..]);
        first += pair.x2.len();
    }
    values
}

/// With a law whose row is the gap, the matrix of a facet has the derivatives of forces and gaps.
fn compare_with_differences(patch: &mut Patch, what: &str) {
    let (own, mortar) = (patch.x1.len(), patch.x2.len());
    let traction: Vec<f64> = (0..own).map(|i| 0.3 - 0.2 * (i % 5) as f64).collect();
    let mut response = sized!(stickslip_node_response);
    response.drow_dnow = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let size = 2 * own + mortar;
    let mut k = vec![f64::NAN; size * size];
    ok!(stickslip_facet_tangent(
        &patch.raw(),
        patch.ab.concat().as_ptr(),
        patch.ac.concat().as_ptr(),
        null(),
        null(),
        traction.as_ptr(),
        [response; 4].as_ptr(),
        null(),
        k.as_mut_ptr(),
        size as i64
    ));
    let largest = max_abs(k.iter().copied());
    for column in 0..own + mortar {
        let mut at = |h: f64| {
            let x = if column < own { &mut patch.x1[column] } else { &mut patch.x2[column - own] };
            *x += h;
            patch.integrate();
            forces_and_gaps(patch, &traction)
        };
        let (plus, minus) = (at(STEP), at(-2.0 * STEP));
        at(STEP);
        for row in 0..size {
            let difference = (plus[row] - minus[row]) / (2.0 * STEP);
            let error = (k[row * size + column] - difference).abs() / largest;
            assert!(error <= DIFFERENCES, "{what}: ({row}, {column}) off by {error:e}");
        }
    }
}

/// More pairs than keep their derivatives.
#[test]
fn facet_tangents_equal_differences_with_many_pairs() {
    let x1 = json!([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0]]);
    let place = |k: i64| [0.4 * (k % 4) as f64 - 0.1, 0.35 * (k / 4) as f64 - 0.07];
    let x2: Vec<_> = (0..16).map(place).map(|[s, t]| [s, t, -0.1 + 0.03 * s - 0.02 * t]).collect();
    let facets = (0..9).map(|f| f / 3 * 4 + f % 3).map(|a| vec![a, a + 1, a + 5, a + 4]).collect();
    let mut patch = Patch::at((&x1, vec![0, 1, 2, 3]), (&json!(x2), facets), 0);
    patch.integrate();
    compare_with_differences(&mut patch, "many pairs");
}

/// Points in place of overlaps, and overlaps. Facets that several pairs cover in part. Even numbers of points: with odd ones a mortar corner of D15 lies under the
/// middle one.
#[test]
fn facet_tangents_equal_differences_with_points_too() {
    let mut compared = 0;
    for (case, points) in golden_part("golden_dual.json", "facets").iter().flat_map(|c| [(c, 0), (c, 4), (c, 6)]) {
        if !["D02", "D04", "D05", "D07", "D15"].iter().any(|start| name(case).starts_with(start)) {
            continue;
        }
        let nodes1: Vec<i64> = (0..case["x1"].as_array().unwrap().len() as i64).collect();
        let mut patch = Patch::at((&case["x1"], nodes1), (&case["x2"], facets(&case["facets2"])), 0);
        patch.points = points;
        patch.integrate();
        compare_with_differences(&mut patch, &format!("{} {points}", name(case)));
        compared += 1;
    }
    assert!(compared >= 6, "{compared}");
}
