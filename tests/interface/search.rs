//! What the search guarantees: no pair missed at any size ratio, none twice, opposing normals only, the same whatever
//! the order of nodes and facets, O(n log n).

use crate::support::mesh::*;
use nalgebra::Rotation3;
use proptest::prelude::*;
use stickslip::geometry::{Plane, Vec3};
use stickslip::interface::{Interface, Options};
use stickslip::mortar::{NonmortarFrame, Segment};

/// The least scalar product of opposing normals, as ARCHITECTURE.md has it (80 degrees), with a margin that keeps
/// rounding out of the comparison; scenes in which a pair lies within the margin are not compared.
const OPPOSING: f64 = 0.17;
const MARGIN: f64 = 1e-9;
/// Sums of the same numbers in another order.
const ROUNDING: f64 = 1e-12;
/// Coverage of a node on curved facets, over its area: what the facets of one side, seen from the facets of the other,
/// lack at joints under an angle is of second order. Measured 2e-3 at 0.15 rad between coarse facets; a missing fine
/// facet would take a quarter of a node's area.
const COVERED: f64 = 0.05;

/// Two unit normals with more than this along an axis have a scalar product of at least -0.68: the sides of a wall have less than -0.7.
const LEAST_UP: f64 = 0.4;

/// What the surfaces lie on: flat (0), or a cylinder along y with this curvature [1/L].
#[derive(Clone, Copy, Debug)]
struct Sheet {
    curvature: f64,
    twist: f64,
    frame: Rotation3<f64>,
}

impl Sheet {
    /// A grid's points (s, t) brought on the sheet.
    fn bend(&self, mesh: &mut Mesh) {
        for x in &mut mesh.x {
            let (s, k) = (x.x, self.curvature);
            let (across, up) = if k == 0.0 { (s, 0.0) } else { ((k * s).sin() / k, (1.0 - (k * s).cos()) / k) };
            *x = self.frame * Vec3::new(across, x.y, x.z + up + self.twist * x.x * x.y);
        }
    }
}

/// Pairs by definition, all against all: normals oppose each other and the projections overlap or touch. `None` where a
/// pair is too close to a border of the definition to compare.
fn all_against_all(one: &Mesh, two: &Mesh) -> Option<Vec<(usize, usize)>> {
    let (one, two) = surfaces(one, two);
    let planes: Vec<_> = (0..two.facets.len()).map(|j| Plane::of(&two.facet(j, &two.reference)).unwrap()).collect();
    let mut pairs = Vec::new();
    for i in 0..one.facets.len() {
        let frame = NonmortarFrame::new(&one.facet(i, &one.reference)).unwrap();
        for (j, plane) in planes.iter().enumerate() {
            let opposition = -frame.plane.e.dot(&plane.e);
            if (opposition - OPPOSING).abs() < MARGIN {
                return None;
            }
            let overlap = || Segment::new(&frame, &two.facet(j, &two.reference)).unwrap().is_some();
            if opposition > OPPOSING && overlap() {
                pairs.push((i, j));
            }
        }
    }
    Some(pairs)
}

fn surfaces(one: &Mesh, two: &Mesh) -> (stickslip::interface::Surface, stickslip::interface::Surface) {
    let surface = |side, m: &Mesh| {
        stickslip::interface::Surface::new(side, m.x.clone(), &m.facets, numbered(0, m.x.len())).unwrap()
    };
    (surface("nonmortar", one), surface("mortar", two))
}

fn found(interface: &Interface) -> Vec<(usize, usize)> {
    interface.history().pairs.iter().map(|p| (p.one, p.two)).collect()
}

fn cells(triangles: bool) -> Cells {
    if triangles { Cells::Triangles } else { Cells::Quads }
}

/// A coarse grid of facets of size 1 and a fine patch, `ratio` times finer, somewhere on it; one faces up.
fn coarse_and_fine(
    (n, m): (usize, usize),
    ratio: f64,
    at: [f64; 2],
    sheet: &Sheet,
    kinds: [Cells; 2],
    fine_up: bool,
) -> [Mesh; 2] {
    let h = 1.0 / ratio;
    let mut coarse = grid(3, 3, [-1.5, -1.5], [1.5, 1.5], 0.0, !fine_up, kinds[0]);
    let (a, b) = (at, [at[0] + n as f64 * h, at[1] + m as f64 * h]);
    let mut fine = grid(n, m, a, b, 0.0, fine_up, kinds[1]);
    sheet.bend(&mut coarse);
    sheet.bend(&mut fine);
    [coarse, fine]
}

proptest! {
    #![proptest_config(crate::support::random::cases(100))]

    /// Size ratios from 1:1 to 1:1e4, both ways round, flat and curved, quads warped by the twist.
    #[test]
    fn finds_what_all_against_all_finds_at_any_size_ratio(
        log_ratio in 0.0..4.0_f64,
        n in 1_usize..14,
        at in [-1.4..0.4_f64, -1.4..0.4_f64],
        curvature in prop_oneof![Just(0.0), 0.01..0.3_f64, -0.3..-0.01_f64],
        twist in prop_oneof![Just(0.0), -0.05..0.05_f64],
        angles in [-3.0..3.0_f64, -1.5..1.5_f64, -3.0..3.0_f64],
        triangles in [any::<bool>(), any::<bool>()],
        fine_is_nonmortar in any::<bool>(),
        fine_up in any::<bool>(),
    ) {
        let frame = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
        let sheet = Sheet { curvature, twist, frame };
        let ratio = 10_f64.powf(log_ratio);
        let [coarse, fine] = coarse_and_fine((n, n + 1), ratio, at, &sheet, triangles.map(cells), fine_up);
        let (one, two) = if fine_is_nonmortar { (&fine, &coarse) } else { (&coarse, &fine) };
        let Some(expected) = all_against_all(one, two) else { return Ok(()) };
        let i = interface(one, two, options());
        prop_assert_eq!(found(&i), expected);
        if fine_is_nonmortar && ratio > 4.0 && at.iter().all(|a| a + (n + 1) as f64 / ratio < 1.4) {
            let h = i.history();
            for (covered, area) in h.coverage.iter().zip(&h.areas) {
                prop_assert!((covered / area - 1.0).abs() < COVERED, "covered {covered} of {area}");
            }
        }
    }

    /// Random triangles in all directions, at all distances: nothing but the definition decides. No two of a heap look so far apart that
    /// they could be the sides of a wall.
    #[test]
    fn finds_what_all_against_all_finds_in_a_heap_of_triangles(seed in 0_u64..1_000_000, log_ratio in 0.0..4.0_f64) {
        let mut random = Random(seed);
        let mut heap = |n: usize, size: f64, up: f64| {
            let mut mesh = Mesh { x: Vec::new(), facets: Vec::new() };
            while mesh.x.len() < 3 * n {
                let centre = random.vector(1.0);
                let x: [_; 3] = std::array::from_fn(|_| centre + random.vector(size));
                if up * (x[1] - x[0]).cross(&(x[2] - x[0])).normalize().z > LEAST_UP {
                    let f = mesh.x.len() as i64;
                    mesh.facets.push(vec![f, f + 1, f + 2]);
                    mesh.x.extend(x);
                }
            }
            mesh
        };
        let (one, two) = (heap(6, 0.5, -1.0), heap(40, 0.5 * 10_f64.powf(-log_ratio), 1.0));
        // Any depth: the heap is no surface of a body.
        let options = Options { search_distance: Some(100.0), ..options() };
        for (one, two) in [(&one, &two), (&two, &one)] {
            // Of what lies in layers the nearest is found, or it is refused as lying on each other: then either half of it by
            // itself.
            let mut heaps = vec![two.clone()];
            while let Some(two) = heaps.pop() {
                let Some(expected) = all_against_all(one, &two) else { continue };
                let (s1, s2) = surfaces(one, &two);
                match Interface::new(s1, s2, numbered(3 * (one.x.len() + two.x.len()), one.x.len()), options) {
                    Ok(i) if found(&i) == expected => {}
                    Ok(i) => {
                        let found = found(&i);
                        prop_assert!(found.iter().all(|pair| expected.contains(pair)) && two.facets.len() > 1);
                        let met = |f: usize| found.iter().any(|pair| pair.0 == f);
                        prop_assert!(expected.iter().all(|pair| met(pair.0)));
                        heaps.extend(halves(&two));
                    }
                    Err(e) => {
                        prop_assert!(e.message.contains("layers") && two.facets.len() > 1, "{}", e);
                        heaps.extend(halves(&two));
                    }
                }
            }
        }
    }
}

/// Two meshes of triangles without common nodes.
fn halves(mesh: &Mesh) -> [Mesh; 2] {
    let half = mesh.facets.len() / 2;
    let part = |x: &[Vec3]| Mesh {
        x: x.to_vec(),
        facets: (0..x.len() as i64 / 3).map(|f| vec![3 * f, 3 * f + 1, 3 * f + 2]).collect(),
    };
    let (first, second) = mesh.x.split_at(3 * half);
    [part(first), part(second)]
}

/// Fine facets on the middle of a coarse one that is the chord of a curved or the plane of a warped surface: they lie
/// behind it by many times their size.
#[test]
fn fine_facets_deep_behind_a_coarse_chord_are_found() {
    for (curvature, twist) in [(0.3, 0.0), (-0.3, 0.0), (0.0, 0.05), (0.0, -0.05)] {
        for fine_is_nonmortar in [true, false] {
            for fine_up in [true, false] {
                let sheet = Sheet { curvature, twist, frame: Rotation3::identity() };
                for at in [[0.0, 0.0], [-0.45, -0.45], [0.3, 0.35], [-1.4, -1.4]] {
                    let [coarse, fine] =
                        coarse_and_fine((8, 8), 1e3, at, &sheet, [Cells::Quads, Cells::Quads], fine_up);
                    let (one, two) = if fine_is_nonmortar { (&fine, &coarse) } else { (&coarse, &fine) };
                    let i = interface(one, two, options());
                    let covered: f64 = i.history().coverage.iter().sum();
                    let expected = 64.0 * 1e-6;
                    assert!(
                        (covered / expected - 1.0).abs() < COVERED,
                        "curvature {curvature}, twist {twist}, at {at:?}, up {fine_up}: covered {covered}"
                    );
                }
            }
        }
    }
}

/// One facet under a thousand: each of them covered in full, and the other way round.
#[test]
fn one_facet_under_a_thousand() {
    let thousand = grid(32, 32, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let one_facet = grid(1, 1, [-5e3, -4e3], [5e3, 6e3], 0.0, true, Cells::Quads);
    let i = interface(&thousand, &one_facet, options());
    assert_eq!(found(&i), (0..1024).map(|f| (f, 0)).collect::<Vec<_>>());
    let h = i.history();
    assert!(h.coverage.iter().zip(&h.areas).all(|(c, a)| (c / a - 1.0).abs() < ROUNDING));
    let turned = |m: &Mesh| Mesh {
        x: m.x.clone(),
        facets: m.facets.iter().map(|f| f.iter().rev().copied().collect()).collect(),
    };
    let i = interface(&turned(&one_facet), &turned(&thousand), options());
    assert_eq!(found(&i), (0..1024).map(|f| (0, f)).collect::<Vec<_>>());
    let covered: f64 = i.history().coverage.iter().sum();
    assert!((covered - 1.0).abs() < ROUNDING, "{covered}");
}

/// The inverse of a permutation.
fn inverse(order: &[usize]) -> Vec<usize> {
    let mut inverse = vec![0; order.len()];
    order.iter().enumerate().for_each(|(new, &old)| inverse[old] = new);
    inverse
}

fn shuffled(n: usize, random: &mut Random) -> Vec<usize> {
    let mut order: Vec<_> = (0..n).collect();
    for k in (1..n).rev() {
        order.swap(k, ((random.next() + 1.0) / 2.0 * (k + 1) as f64) as usize % (k + 1));
    }
    order
}

/// A mesh with its nodes, facets and the facets' first nodes in another order; and the orders, new to old.
fn permuted(mesh: &Mesh, random: &mut Random) -> (Mesh, Vec<usize>, Vec<usize>) {
    let (nodes, facets) = (shuffled(mesh.x.len(), random), shuffled(mesh.facets.len(), random));
    let new = inverse(&nodes);
    let facet = |f: &usize| {
        let mut facet: Vec<i64> = mesh.facets[*f].iter().map(|&k| new[k as usize] as i64).collect();
        let turn = ((random.next() + 1.0) * 2.0) as usize % facet.len();
        facet.rotate_left(turn);
        facet
    };
    let permuted = Mesh { x: nodes.iter().map(|&k| mesh.x[k]).collect(), facets: facets.iter().map(facet).collect() };
    (permuted, nodes, facets)
}

/// The same pairs and, within rounding, the same forces and rows whatever the numbering. Affine facets: there the rule
/// is exact, wherever a facet's nodes begin.
#[test]
fn permuted_nodes_and_facets_give_the_same_pairs_and_residual() {
    let mut random = Random(11);
    for kinds in [[Cells::Quads; 2], [Cells::Triangles, Cells::Quads], [Cells::Triangles; 2]] {
        let mut one = grid(7, 6, [0.0, 0.0], [1.0, 1.0], 0.0, false, kinds[0]);
        let mut two = grid(9, 8, [-0.3, -0.2], [1.1, 1.3], 0.0, true, kinds[1]);
        let frame = Rotation3::from_euler_angles(0.4, -0.9, 1.3);
        let turn = Rotation3::from_euler_angles(0.0, 0.0, 0.3);
        two.x.iter_mut().for_each(|x| *x = turn * *x);
        [&mut one, &mut two].into_iter().for_each(|m| m.x.iter_mut().for_each(|x| *x = frame * *x));
        let tilt = Rotation3::from_euler_angles(0.01, -0.02, 0.03);
        let moved = |x: &Vec3| tilt * x + frame * Vec3::new(0.06, 0.03, -0.004);
        let x1: Vec<_> = one.x.iter().map(moved).collect();
        let lambda: Vec<_> =
            one.x.iter().map(|_| frame * (random.vector(0.3) - Vec3::z() * (0.4 + 0.3 * random.next()))).collect();
        let mut i = interface(&one, &two, options());
        let r = i.residual(&x1, &two.x, &lambda, None).unwrap();
        let scale = r.nonmortar.iter().chain(&r.rows).map(Vec3::amax).fold(0.0, f64::max);
        for _ in 0..10 {
            let (p1, nodes1, facets1) = permuted(&one, &mut random);
            let (p2, nodes2, facets2) = permuted(&two, &mut random);
            let mut p = interface(&p1, &p2, options());
            let mut pairs: Vec<_> = found(&p).iter().map(|&(a, b)| (facets1[a], facets2[b])).collect();
            pairs.sort_unstable();
            assert_eq!(pairs, found(&i));
            let pick = |v: &[Vec3], order: &[usize]| -> Vec<Vec3> { order.iter().map(|&k| v[k]).collect() };
            let s = p.residual(&pick(&x1, &nodes1), &p2.x, &pick(&lambda, &nodes1), None).unwrap();
            let compared = [
                (pick(&r.nonmortar, &nodes1), s.nonmortar),
                (pick(&r.mortar, &nodes2), s.mortar),
                (pick(&r.rows, &nodes1), s.rows),
            ];
            for (expected, found) in compared.iter().flat_map(|(e, f)| e.iter().zip(f)) {
                assert!((expected - found).amax() <= ROUNDING * scale, "{expected:?} {found:?}");
            }
        }
    }
}

fn bits(values: &[Vec3]) -> Vec<u64> {
    values.iter().flat_map(|v| v.iter().map(|c| c.to_bits())).collect()
}

/// A, B, A, with pairs that come and go in between, and more than once: the same bits, no pair twice.
#[test]
fn repeated_searches_give_the_same_bits_and_no_pair_twice() {
    let one = grid(6, 5, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(8, 8, [-0.6, -0.5], [1.6, 1.5], 0.0, true, Cells::Triangles);
    let mut i = interface(&one, &two, options());
    let lambda = vec![Vec3::new(0.2, 0.1, -0.7); one.x.len()];
    let slid = |by: f64| -> Vec<Vec3> { one.x.iter().map(|x| x + Vec3::new(by, 0.3 * by, -0.001)).collect() };
    let mut seen: Vec<(f64, Vec<u64>, usize)> = Vec::new();
    for by in [0.0, 0.7, 0.31, 0.0, 1.9, 0.7, 0.31, 0.0, 1.9] {
        let x1 = slid(by);
        let r = i.residual(&x1, &two.x, &lambda, None).unwrap();
        let bits = [bits(&r.nonmortar), bits(&r.mortar), bits(&r.rows)].concat();
        let active = i.active_pairs();
        match seen.iter().find(|(b, _, _)| *b == by) {
            Some((_, earlier, pairs)) => assert!(*earlier == bits && *pairs == active, "slid by {by}"),
            None => seen.push((by, bits, active)),
        }
        let mut fresh = interface(&Mesh { x: x1.clone(), ..one.clone() }, &two, options());
        assert!(found(&fresh).is_sorted_by(|p, q| p < q), "sorted, none twice");
        fresh.commit(&x1, &two.x, &lambda, None).unwrap();
        assert_eq!(found(&fresh).len(), active, "what is active depends on the positions alone");
    }
    assert!(seen.iter().any(|(by, _, active)| *by == 1.9 && *active == 0), "and at one place there is none");
}

/// Boxes compared, over n log2 n, n the facets of both sides: bounded, whichever side is the finer one.
#[test]
fn a_search_compares_o_of_n_log_n_boxes() {
    /// Measured 3.1 at most, the same from 128 facets to 32768.
    const MOST: f64 = 4.0;
    for (fine, coarse) in [(1, 1), (8, 1), (1, 8)] {
        for n in [8, 16, 32, 64, 128] {
            let frame = Rotation3::from_euler_angles(0.4, -0.9, 1.3);
            let cells = |k: usize| (n / k).max(1);
            let mut one = grid(cells(fine), cells(fine), [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
            let mut two = grid(cells(coarse), cells(coarse), [-0.01, -0.02], [1.01, 1.03], 0.0, true, Cells::Quads);
            [&mut one, &mut two].into_iter().for_each(|m| m.x.iter_mut().for_each(|x| *x = frame * *x));
            let i = interface(&one, &two, options());
            let total = (one.facets.len() + two.facets.len()) as f64;
            let visited = i.counters().boxes_visited as f64;
            assert!(visited > 0.0);
            let ratio = visited / (total * total.log2());
            println!("1:{fine} on 1:{coarse}, {total} facets: {visited} boxes, {ratio:.2} n log2 n");
            assert!(ratio <= MOST, "{total} facets: {ratio} n log2 n");
        }
    }
}
