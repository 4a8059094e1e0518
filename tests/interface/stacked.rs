//! A mortar surface that lies over itself: in layers, smaller or larger than the facets over them, of which the nearest are
//! pairs, and what only looks like it.

use crate::support::mesh::*;
use nalgebra::Rotation3;
use stickslip::error::{Kind, Result};
use stickslip::geometry::Vec3;
use stickslip::interface::{Cover, Friction, Interface, Options, Scheme, Surface, Weights};
use stickslip::quadrature;

const CELLS: [Cells; 2] = [Cells::Quads, Cells::Triangles];
const GAP: f64 = 0.2;

/// One facet, or two triangles, on [0, 1]^2, looking down.
fn coarse(cells: Cells) -> Mesh {
    grid(1, 1, [0.0, 0.0], [1.0, 1.0], 0.0, false, cells)
}

/// An n x n plate with this corner, size and height, looking up.
fn plate(n: usize, corner: [f64; 2], size: f64, z: f64, cells: Cells) -> Mesh {
    grid(n, n, corner, [corner[0] + size, corner[1] + size], z, true, cells)
}

fn create(one: &Mesh, two: &Mesh, options: Options) -> Result<Interface> {
    let (n1, n2) = (one.x.len(), two.x.len());
    let nonmortar = Surface::new("nonmortar", one.x.clone(), &one.facets, numbered(0, n1))?;
    let mortar = Surface::new("mortar", two.x.clone(), &two.facets, numbered(3 * n1, n2))?;
    Interface::new(nonmortar, mortar, numbered(3 * (n1 + n2), n1), options)
}

/// The pairs are these, of `parts` together: of the first one in every bit what it has alone, of the others those in `kept`
/// (part and facet).
#[track_caller]
fn assert_pairs(one: &Mesh, parts: &[Mesh], options: Options, kept: &[[usize; 2]]) {
    let (all, first) = (create(one, &together(parts), options).unwrap(), create(one, &parts[0], options).unwrap());
    let (all, first) = (&all.history().pairs, &first.history().pairs);
    let ends: Vec<usize> = (0..=parts.len()).map(|k| parts[..k].iter().map(|part| part.facets.len()).sum()).collect();
    let part = |f: usize| ends.partition_point(|&end| end <= f) - 1;
    let near: Vec<_> = all.iter().copied().filter(|pair| part(pair.two) == 0).collect();
    assert_eq!(&near, first);
    let mut far: Vec<_> =
        all.iter().filter(|p| part(p.two) > 0).map(|p| [part(p.two), p.two - ends[part(p.two)]]).collect();
    far.sort_unstable();
    assert_eq!(far, kept);
}

/// How much of a polygon lies in a rectangle between two corners, over its area.
fn share_within(polygon: &[Vec3], low: [f64; 2], high: [f64; 2]) -> f64 {
    let area = |p: &[Vec3]| (2..p.len()).map(|k| (p[k - 1] - p[0]).cross(&(p[k] - p[0])).z).sum::<f64>().abs();
    let mut part = polygon.to_vec();
    for (i, at, sign) in [(0, low[0], 1.0), (1, low[1], 1.0), (0, high[0], -1.0), (1, high[1], -1.0)] {
        let inside = |x: &Vec3| sign * (x[i] - at);
        let ends = part.iter().zip(part.iter().cycle().skip(1));
        part = ends
            .flat_map(|(x, y)| {
                let (a, b) = (inside(x), inside(y));
                let cut = (a * b < 0.0).then(|| x + (y - x) * (a / (a - b)));
                (a >= 0.0).then_some(*x).into_iter().chain(cut)
            })
            .collect();
    }
    area(&part) / area(polygon)
}

fn turned(mesh: &Mesh, angles: [f64; 3]) -> Mesh {
    let q = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
    Mesh { x: mesh.x.iter().map(|x| q * x).collect(), facets: mesh.facets.clone() }
}

/// Plates much smaller than the facet over them. At creation, in any orientation, for quads and triangles: the nearer plate has
/// the pairs that it has alone, and of the farther one the facets that stick out beside it by at least half.
#[test]
fn the_nearest_of_plates_that_lie_over_each_other_are_pairs() {
    let (mut hidden, mut seen) = (0, 0);
    // Sizes over the facet's, offsets over the plate's.
    for (size, offset) in
        [(0.9, 0.0), (0.5, 0.0), (0.5, 0.5), (0.3, 0.8), (0.1, 0.0), (0.1, 0.3), (1e-2, 0.5), (1e-4, 0.0)]
    {
        for (n, angles) in [(1, [0.0; 3]), (1, [0.4, -0.9, 1.3]), (3, [2.0, 0.3, -0.7])] {
            for cells in CELLS {
                let corner = [0.05, 0.03];
                let upper = plate(n, corner, size, 0.0, cells);
                let lower = plate(n + 1, [corner[0] + offset * size, corner[1]], size, -GAP, cells);
                let sticks_out = |f: &usize| {
                    let polygon: Vec<_> = lower.facets[*f].iter().map(|&k| lower.x[k as usize]).collect();
                    share_within(&polygon, corner, corner.map(|c| c + size)) <= 0.5
                };
                let kept: Vec<_> = (0..lower.facets.len()).filter(sticks_out).map(|f| [1, f]).collect();
                (hidden, seen) = (hidden + lower.facets.len() - kept.len(), seen + kept.len());
                let one = turned(&coarse(Cells::Quads), angles);
                let parts = [&upper, &lower].map(|part| turned(part, angles));
                assert_pairs(&one, &parts, options(), &kept);
                let nearer = Options { search_distance: Some(0.9 * GAP), ..options() };
                assert_pairs(&one, &parts, nearer, &[]);
            }
        }
    }
    assert!(hidden > 100 && seen > 50, "{hidden} hidden, {seen} seen");
}

/// The sheet that is touched is the nearer one, be it a little in front of the facet or behind it; three of them; with frozen weights,
/// too.
#[test]
fn the_sheet_in_contact_is_the_nearest_one() {
    let at = |z: f64| plate(2, [-0.5, -0.5], 2.0, z, Cells::Quads);
    let all = [Weights::Current, Weights::Committed, Weights::Reference];
    for (options, n) in all
        .into_iter()
        .flat_map(|weights| [(Options { weights, ..options() }, 1), (Options { weights, ..options() }, 3)])
    {
        let one = grid(n, n, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Triangles);
        for heights in [
            &[0.0, -0.3][..],
            &[-0.01, -0.011],
            &[0.02, -0.03],
            &[-0.02, 0.03],
            &[0.01, -0.2, -0.4, 0.3],
            &[-1e-7, -2e-7],
        ] {
            assert_pairs(&one, &heights.iter().map(|z| at(*z)).collect::<Vec<_>>(), options, &[]);
        }
    }
}

/// Points in place of cells: what they hold of a hidden plate is left out.
#[test]
fn points_in_place_of_cells_see_the_nearer_plate() {
    let line = quadrature::cell::line_of(7).unwrap();
    for scheme in [Scheme::Elements(line), Scheme::Hybrid(line)] {
        for size in [0.9, 0.5] {
            let parts =
                [plate(1, [0.05, 0.03], size, 0.0, Cells::Quads), plate(2, [0.05, 0.03], size, -GAP, Cells::Quads)];
            assert_pairs(&coarse(Cells::Quads), &parts, Options { scheme, ..options() }, &[]);
        }
    }
}

/// A plate that comes in between within a step: the report tells it, and the commit of the step settles which is the nearer one.
/// What follows is what follows without the other one. A step back, and a restart, settle the same.
#[test]
fn a_plate_that_slides_in_between_is_settled_at_commit() {
    for (cells, friction) in CELLS.into_iter().flat_map(|c| [(c, Friction::Coulomb), (c, Friction::None)]) {
        let options = Options { friction, ..options() };
        let one = coarse(Cells::Quads);
        let parts = [plate(2, [0.2, 0.2], 0.4, 0.0, cells), plate(2, [2.2, 0.2], 0.4, -GAP, cells)];
        let two = together(&parts);
        let mut i = create(&one, &two, options).unwrap();
        let mut alone = create(&one, &parts[0], options).unwrap();
        let first = two.x.len() / 2;
        let beside = |by: f64| -> Vec<_> {
            two.x.iter().enumerate().map(|(k, x)| if k < first { *x } else { x - Vec3::x() * by }).collect()
        };
        let lambda = [Vec3::new(0.1, 0.0, -1.0); 4];
        let report = i.report(&one.x, &beside(2.0)).unwrap();
        assert!(report.nodes.iter().all(|n| n.cover == Cover::Several && n.layers == 2), "{report:?}");
        i.commit(&one.x, &beside(2.0), &lambda, None).unwrap();
        alone.commit(&one.x, &parts[0].x, &lambda, None).unwrap();
        let same = |i: &mut Interface, alone: &mut Interface| {
            for by in [2.0, 1.97, 2.04] {
                let found = i.residual(&one.x, &beside(by), &lambda, None).unwrap();
                let expected = alone.residual(&one.x, &parts[0].x, &lambda, None).unwrap();
                assert_eq!((&found.nonmortar, &found.rows), (&expected.nonmortar, &expected.rows));
                assert_eq!(found.mortar[..first], expected.mortar);
                assert!(found.mortar[first..].iter().all(|f| *f == Vec3::zeros()));
            }
        };
        same(&mut i, &mut alone);
        let (integers, reals) = i.export_history().unwrap();
        let mut again = create(&one, &two, options).unwrap();
        again.import_history(&integers, &reals).unwrap();
        same(&mut again, &mut alone);
        // The next step takes it away again; and back.
        i.commit(&one.x, &two.x, &lambda, None).unwrap();
        let both = i.residual(&one.x, &beside(2.0), &lambda, None).unwrap();
        assert!(both.mortar[first..].iter().any(|f| *f != Vec3::zeros()));
        i.roll_back().unwrap();
        same(&mut i, &mut alone);
    }
}

/// Two plates at one height with the same place: none of them is farther. Behind a third one they are no matter.
#[test]
fn a_plate_given_twice_is_refused() {
    for size in [2.0, 0.1] {
        let parts =
            [plate(1, [0.05, 0.03], size, 0.0, Cells::Quads), plate(1, [0.05, 0.03], size, 0.0, Cells::Triangles)];
        let e = create(&coarse(Cells::Quads), &together(&parts), options()).unwrap_err();
        assert_eq!(e.kind, Kind::InvalidValue, "{}", e.message);
        for said in
            ["in layers over non-mortar facet 0", "mortar facets 0 and ", "lie on each other", "leave one of them out"]
        {
            assert!(e.message.contains(said), "{}", e.message);
        }
        let near = plate(3, [0.05, 0.03], size, 1e-3 * size, Cells::Quads);
        let [a, b] = parts.map(|part| Mesh { x: part.x.iter().map(|x| x - Vec3::z() * GAP).collect(), ..part });
        assert_pairs(&coarse(Cells::Quads), &[near, a, b], options(), &[]);
    }
}

/// Bodies under one coarse facet, touching or with overlaps of rounding, at one height or several.
#[test]
fn plates_side_by_side_are_no_layers() {
    for angles in [[0.0; 3], [0.4, -0.9, 1.3], [2.0, 0.3, -0.7]] {
        for cells in CELLS {
            for (overlap, step) in [(0.0, 0.0), (0.0, 0.3), (1e-12, 0.3), (1e-9, 0.0), (1e-9, 0.3), (-0.05, 0.3)] {
                let (mut parts, size) = (Vec::new(), 0.25);
                for k in 0..16 {
                    let corner = [k % 4, k / 4].map(|c| f64::from(c) * size - 0.5 * overlap * size);
                    let z = -step * f64::from(k % 3);
                    parts.push(plate(1 + k as usize % 3, corner, size * (1.0 + overlap), z, cells));
                }
                let (one, two) = (turned(&coarse(Cells::Quads), angles), turned(&together(&parts), angles));
                assert!(create(&one, &two, options()).is_ok(), "overlap {overlap}, step {step}");
            }
        }
    }
}

/// A disc in a hole whose meshes do not match along the circle, flush or not: chords of the one cut into the other.
#[test]
fn meshes_that_do_not_match_along_a_circle_are_no_layers() {
    let ring = |n: usize, radii: &[f64], z: f64| {
        let mut mesh = Mesh { x: Vec::new(), facets: Vec::new() };
        for r in radii {
            mesh.x.extend((0..n).map(|k| {
                let angle = 2.0 * std::f64::consts::PI * k as f64 / n as f64;
                Vec3::new(0.5 + r * angle.cos(), 0.5 + r * angle.sin(), z)
            }));
        }
        let at = |i: usize, k: usize| (i * n + k % n) as i64;
        for i in 1..radii.len() {
            mesh.facets.extend((0..n).map(|k| vec![at(i - 1, k), at(i, k), at(i, k + 1), at(i - 1, k + 1)]));
        }
        mesh
    };
    for step in [0.0, 1e-3] {
        let two = together(&[ring(12, &[0.3, 0.6, 0.9], 0.0), ring(40, &[0.05, 0.1, 0.15, 0.2, 0.25, 0.3], -step)]);
        create(&coarse(Cells::Quads), &two, options()).unwrap();
    }
}

/// The mortar facets that the only non-mortar facet of a new interface has as pairs.
fn facets_over(one: &Mesh, two: &Mesh) -> Vec<usize> {
    let i = create(one, two, options()).unwrap();
    i.history().pairs.iter().filter(|p| p.weights.coverage(0) > 0.0).map(|p| p.two).collect()
}

/// A sheet that is folded back twice: its upper and its lower run both look up, joined by a middle that looks down.
#[test]
fn of_an_s_shaped_sheet_the_upper_run_is_met() {
    for (width, n) in [(3.0, 1), (0.6, 1), (0.6, 4), (0.05, 2)] {
        let profile = [[0.0, 0.0], [width, 0.0], [0.1 * width, -0.5 * GAP], [width, -GAP]];
        let mut two = Mesh { x: Vec::new(), facets: Vec::new() };
        for j in 0..=n {
            let y = 0.5 + width * (j as f64 / n as f64 - 0.5);
            two.x.extend(profile.iter().map(|[x, z]| Vec3::new(0.5 + x - 0.5 * width, y, *z)));
        }
        for j in 0..n as i64 {
            two.facets.extend((0..3).map(|k| vec![4 * j + k, 4 * j + k + 1, 4 * j + k + 5, 4 * j + k + 4]));
        }
        let met = facets_over(&coarse(Cells::Quads), &two);
        assert!(!met.is_empty() && met.iter().all(|f| f % 3 == 0), "{met:?}");
    }
}

/// One connected sheet that winds down under itself, like a thread, larger than the facet: its first turn is met.
#[test]
fn of_a_winding_sheet_the_first_turn_is_met() {
    let (n, turns) = (12, 2);
    let mut two = Mesh { x: Vec::new(), facets: Vec::new() };
    for k in 0..=n * turns {
        let angle = 2.0 * std::f64::consts::PI * k as f64 / n as f64;
        let at = |r: f64| Vec3::new(0.5 + r * angle.cos(), 0.5 + r * angle.sin(), -0.5 * k as f64 / n as f64);
        two.x.extend([at(0.05), at(1.5)]);
    }
    two.facets.extend((0..(n * turns) as i64).map(|k| vec![2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2]));
    let met = facets_over(&coarse(Cells::Quads), &two);
    assert!(met.len() >= n / 2 && met.iter().all(|f| *f < n), "{met:?}");
}

/// A pad on a tube: of the skin near it and of the inner skin on the far side, which look the same way.
#[test]
fn of_a_tube_the_skin_under_the_pad_is_met() {
    let n = 16;
    let skin = |r: f64, outwards: bool| {
        let mut mesh = Mesh { x: Vec::new(), facets: Vec::new() };
        for k in 0..n {
            let angle = 2.0 * std::f64::consts::PI * (k as f64 + 0.5) / n as f64;
            mesh.x.extend([-1.0, 2.0].map(|y| Vec3::new(0.5 + r * angle.sin(), y, -1.05 + r * angle.cos())));
        }
        for k in 0..n as i64 {
            let next = (k + 1) % n as i64;
            let facet = vec![2 * k, 2 * k + 1, 2 * next + 1, 2 * next];
            mesh.facets.push(if outwards { facet } else { facet.into_iter().rev().collect() });
        }
        mesh
    };
    let outer = skin(1.0, true);
    let up = (outer.x[1] - outer.x[0]).cross(&(outer.x[2] - outer.x[0]));
    let flip = up.z < 0.0;
    let [outer, inner] = [skin(1.0, !flip), skin(0.8, flip)];
    let small = grid(1, 1, [0.45, 0.0], [0.55, 0.4], 0.0, false, Cells::Quads);
    for pad in [coarse(Cells::Quads), small] {
        assert_pairs(&pad, &[outer.clone(), inner.clone()], options(), &[]);
    }
}

/// Quads that are nearly triangles: a rule of degree 2 errs by more than a hundredth of a node's area. That was refused as
/// "covered 1.01 times", even at the commit of a converged step.
#[test]
fn distorted_quads_are_no_layers() {
    let quads = [
        ([[0.8941, 0.4043], [0.0352, 0.0736], [0.8558, 0.2522], [0.8172, 0.2279]], 3, [-0.3935, -0.1883], 1.7045),
        ([[0.2197, 0.2072], [0.9243, 0.2841], [0.9279, 0.5590], [0.9956, 0.5847]], 2, [-0.2194, -0.0031], 2.0847),
        ([[0.3144, 0.3916], [0.7430, 0.1444], [0.7513, 0.4181], [0.7557, 0.3928]], 2, [-0.5817, -0.0233], 1.4780),
    ];
    let mut worst = 0.0_f64;
    for (corners, n, from, size) in quads {
        let one = coarse(Cells::Quads);
        let x1: Vec<_> = corners.iter().map(|c| Vec3::new(c[0], c[1], 0.0)).collect();
        for parts in [n, 2 * n, 3 * n + 1] {
            let two = plate(parts, from, size, 0.0, Cells::Quads);
            for rule in [&quadrature::DEGREE_1, &quadrature::DEGREE_2, &quadrature::DEGREE_5] {
                let options = Options { rule, ..options() };
                create(&one, &two, options).unwrap().commit(&x1, &two.x, &[Vec3::zeros(); 4], None).unwrap();
                let mut i = create(&Mesh { x: x1.clone(), facets: one.facets.clone() }, &two, options).unwrap();
                if rule.degree > 1 {
                    let h = i.history();
                    worst = h.coverage.iter().zip(&h.areas).map(|(c, area)| c / area).fold(worst, f64::max);
                }
                let report = i.report(&x1, &two.x).unwrap();
                // Of a rule of lower degree the share that counts as covered is itself off by a tenth.
                let full = |cover| cover == Cover::Full || rule.degree < 5 && cover == Cover::Part;
                assert!(report.nodes.iter().all(|n| full(n.cover) && n.layers == 1), "{}: {report:?}", rule.degree);
            }
        }
    }
    assert!(worst > 1.01, "no facet here is as distorted as it should be: covered {worst} times at most");
}
