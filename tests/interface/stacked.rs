//! A mortar surface that lies over itself: in layers, smaller or larger than the facets over them, which is refused, and
//! what only looks like it.

use crate::support::mesh::*;
use nalgebra::Rotation3;
use stickslip::error::{Error, Kind, Result};
use stickslip::geometry::Vec3;
use stickslip::interface::{Cover, Interface, Options, Scheme, Surface};
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

/// Several meshes as one surface, without common nodes.
fn together(parts: &[Mesh]) -> Mesh {
    let mut all = Mesh { x: Vec::new(), facets: Vec::new() };
    for part in parts {
        let first = all.x.len() as i64;
        all.facets.extend(part.facets.iter().map(|f| f.iter().map(|k| k + first).collect()));
        all.x.extend(&part.x);
    }
    all
}

fn create(one: &Mesh, two: &Mesh, options: Options) -> Result<Interface> {
    let (n1, n2) = (one.x.len(), two.x.len());
    let nonmortar = Surface::new("nonmortar", one.x.clone(), &one.facets, numbered(0, n1))?;
    let mortar = Surface::new("mortar", two.x.clone(), &two.facets, numbered(3 * n1, n2))?;
    Interface::new(nonmortar, mortar, numbered(3 * (n1 + n2), n1), options)
}

#[track_caller]
fn assert_layers(e: &Error, apart: Option<f64>) {
    assert_eq!(e.kind, Kind::InvalidValue, "{}", e.message);
    for said in ["in layers over non-mortar facet 0", "mortar facets ", "leave"] {
        assert!(e.message.contains(said), "{}", e.message);
    }
    if let Some(apart) = apart {
        assert!(e.message.contains(&format!("{apart:.3e} apart; set search_distance below")), "{}", e.message);
    }
}

fn turned(mesh: &Mesh, angles: [f64; 3]) -> Mesh {
    let q = Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
    Mesh { x: mesh.x.iter().map(|x| q * x).collect(), facets: mesh.facets.clone() }
}

/// Plates much smaller than the facet over them: no node is covered more than once in all, and both plates were given
/// its force. At creation, in either order of the plates, in any orientation, by every way of integration.
#[test]
fn plates_smaller_than_the_facet_over_them_are_refused() {
    // Sizes over the facet's, offsets over the plate's.
    for (size, offset) in
        [(0.9, 0.0), (0.5, 0.0), (0.5, 0.5), (0.3, 0.8), (0.1, 0.0), (0.1, 0.3), (1e-2, 0.5), (1e-4, 0.0)]
    {
        for (n, swapped, angles) in [(1, false, [0.0; 3]), (1, true, [0.4, -0.9, 1.3]), (3, false, [2.0, 0.3, -0.7])] {
            for cells in CELLS {
                let upper = plate(n, [0.05, 0.03], size, 0.0, cells);
                let lower = plate(n + 1, [0.05 + offset * size, 0.03], size, -GAP, cells);
                let parts = if swapped { [lower, upper] } else { [upper, lower] };
                let (one, two) = (turned(&coarse(Cells::Quads), angles), turned(&together(&parts), angles));
                assert_layers(&create(&one, &two, options()).unwrap_err(), Some(GAP));
                let nearer = Options { search_distance: Some(0.9 * GAP), ..options() };
                assert!(create(&one, &two, nearer).is_ok());
            }
        }
    }
}

/// Points in place of cells find plates that hold some of them.
#[test]
fn points_in_place_of_cells_find_layers_too() {
    for scheme in
        [Scheme::Elements(quadrature::cell::line_of(7).unwrap()), Scheme::Hybrid(quadrature::cell::line_of(7).unwrap())]
    {
        for size in [0.9, 0.5] {
            let parts =
                [plate(1, [0.05, 0.03], size, 0.0, Cells::Quads), plate(2, [0.05, 0.1], size, -GAP, Cells::Quads)];
            let e = create(&coarse(Cells::Quads), &together(&parts), Options { scheme, ..options() }).unwrap_err();
            assert_layers(&e, Some(GAP));
        }
    }
}

/// A plate that comes in between within a step is refused where the step is committed, and nothing has changed then; the
/// report tells it before.
#[test]
fn a_plate_that_slides_in_between_is_refused_at_commit() {
    for cells in CELLS {
        let one = coarse(Cells::Quads);
        let two = together(&[plate(2, [0.2, 0.2], 0.4, 0.0, cells), plate(2, [2.2, 0.2], 0.4, -GAP, cells)]);
        let mut i = create(&one, &two, options()).unwrap();
        let first = two.x.len() / 2;
        let x2: Vec<_> =
            two.x.iter().enumerate().map(|(k, x)| if k < first { *x } else { x - Vec3::x() * 1.9 }).collect();
        let lambda = [Vec3::zeros(); 4];
        let report = i.report(&one.x, &x2).unwrap();
        assert!(report.nodes.iter().all(|n| n.cover == Cover::Several && n.layers == 2), "{report:?}");
        let before = i.history().clone();
        assert_layers(&i.commit(&one.x, &x2, &lambda, None).unwrap_err(), Some(GAP));
        assert_eq!(*i.history(), before);
        i.commit(&one.x, &two.x, &lambda, None).unwrap();
    }
}

/// Two plates at one height with the same place: none of them is farther.
#[test]
fn a_plate_given_twice_is_refused() {
    for size in [2.0, 0.1] {
        let parts =
            [plate(1, [0.05, 0.03], size, 0.0, Cells::Quads), plate(1, [0.05, 0.03], size, 0.0, Cells::Triangles)];
        let e = create(&coarse(Cells::Quads), &together(&parts), options()).unwrap_err();
        assert!(e.kind == Kind::InvalidValue && e.message.contains("lie on each other"), "{}", e.message);
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

/// A sheet that is folded back twice: its upper and its lower run both look up, joined by a middle that looks down.
#[test]
fn an_s_shaped_sheet_is_refused() {
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
        assert_layers(&create(&coarse(Cells::Quads), &two, options()).unwrap_err(), None);
        let nearer = Options { search_distance: Some(0.4 * GAP), ..options() };
        assert!(create(&coarse(Cells::Quads), &two, nearer).is_ok());
    }
}

/// One connected sheet that winds up over itself, like a thread, larger than the facet.
#[test]
fn a_winding_sheet_is_refused() {
    let (n, turns) = (12, 2);
    let mut two = Mesh { x: Vec::new(), facets: Vec::new() };
    for k in 0..=n * turns {
        let angle = 2.0 * std::f64::consts::PI * k as f64 / n as f64;
        let at = |r: f64| Vec3::new(0.5 + r * angle.cos(), 0.5 + r * angle.sin(), -0.5 * k as f64 / n as f64);
        two.x.extend([at(0.05), at(1.5)]);
    }
    two.facets.extend((0..(n * turns) as i64).map(|k| vec![2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2]));
    assert_layers(&create(&coarse(Cells::Quads), &two, options()).unwrap_err(), None);
}

/// A pad on a tube: of the skin near it and of the inner skin on the far side, which look the same way.
#[test]
fn a_tube_needs_a_search_distance() {
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
            mesh.facets.push(if outwards { facet.into_iter().rev().collect() } else { facet });
        }
        mesh
    };
    let mut tube = together(&[skin(1.0, true), skin(0.8, false)]);
    if create(&coarse(Cells::Quads), &tube, options()).is_ok() {
        tube.facets.iter_mut().for_each(|f| f.reverse());
    }
    let small = grid(1, 1, [0.45, 0.0], [0.55, 0.4], 0.0, false, Cells::Quads);
    for pad in [coarse(Cells::Quads), small] {
        assert_layers(&create(&pad, &tube, options()).unwrap_err(), None);
        let i = create(&pad, &tube, Options { search_distance: Some(0.5), ..options() }).unwrap();
        assert!(i.history().coverage.iter().sum::<f64>() > 0.0);
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
