//! Layers of the mortar surface while surfaces slide: what nearer facets hide stays hidden within the step, and a seam with a step
//! is crossed (`src/interface/pairing/hidden.rs`, `stacked.rs`).

use crate::support::host::{Body, Host};
use crate::support::lines::{contact_of_lines, lines};
use crate::support::mesh::*;
use crate::support::parents::{Kind, contact_of, grid_of};
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Friction, Interface, MultiplierBasis, Normals, Options, Weights};
use stickslip::line::Measure;

/// How far the force on a pad of eight rows of facets may be off where up to half of a row is covered twice or not at all: a
/// quarter of a row's share; measured 1.3e-2.
const HALF: f64 = 0.03;
/// Where whole rows are hidden: roundings of other meshes.
const ALL: f64 = 1e-5;
/// What a pad moves in a step.
const STEP: Vec3 = Vec3::new(0.45, 0.0, 0.0);

fn shifted(x: &[Vec3], by: Vec3) -> Vec<Vec3> {
    x.iter().map(|x| x + by).collect()
}

/// Along a wall with others behind it: at all places within the step, and after each of several commits, what is computed is
/// what the wall alone gives, in every bit.
fn slides_as_without_the_others<const N: usize>(one: &Mesh, walls: &[Mesh], create: impl Fn(&Mesh) -> Contact<N>) {
    let all = together(walls);
    let (mut i, mut alone, first) = (create(&all), create(&walls[0]), walls[0].x.len());
    let lambda = vec![nalgebra::SVector::<f64, N>::repeat(-0.3); one.x.len()];
    let mut pairs = 0;
    for step in 0..4 {
        let at = |part: f64| shifted(&one.x, STEP * (f64::from(step) + part));
        for part in [0.1, 0.5, 1.0] {
            let found = i.residual(&at(part), &all.x, &lambda, None).unwrap();
            let expected = alone.residual(&at(part), &walls[0].x, &lambda, None).unwrap();
            assert_eq!((&found.nonmortar, &found.rows), (&expected.nonmortar, &expected.rows), "step {step}, {part}");
            assert_eq!(found.mortar[..first], expected.mortar);
            assert!(found.mortar[first..].iter().all(|f| *f == Vec3::zeros()));
            pairs += i.active_pairs();
        }
        i.commit(&at(1.0), &all.x, &lambda, None).unwrap();
        alone.commit(&at(1.0), &walls[0].x, &lambda, None).unwrap();
        assert_eq!(i.history().coverage, alone.history().coverage);
        assert_eq!(i.history().slip, alone.history().slip);
    }
    assert!(pairs > 12, "{pairs}");
}

/// A pad of several facets slides by nearly two mortar facets a step along a wall. The edges of walls behind it pass under the pad, and one in
/// front of the wall is farther than the wall is deep.
#[test]
fn a_second_wall_behind_the_first_is_not_seen() {
    let one = grid(3, 2, [0.1, 0.3], [0.9, 0.8], 0.0, false, Cells::Quads);
    let plate = |n: [usize; 2], a: [f64; 2], b: [f64; 2], z: f64| grid(n[0], n[1], a, b, z, true, Cells::Triangles);
    let walls = [
        plate([20, 5], [0.0, 0.0], [5.0, 1.1], -0.01),
        plate([15, 7], [0.0, 0.02], [1.9, 1.08], -0.3),
        plate([9, 4], [2.2, 0.2], [4.9, 0.7], -0.2),
        plate([6, 3], [0.4, 0.05], [4.9, 1.05], 0.12),
    ];
    for (weights, normals, friction) in [
        (Weights::Current, Normals::Committed, Friction::Coulomb),
        (Weights::Current, Normals::Committed, Friction::None),
        (Weights::Current, Normals::Current, Friction::None),
        (Weights::Committed, Normals::Committed, Friction::Coulomb),
    ] {
        let options = Options { weights, normals, friction, ..options() };
        let create = |two: &Mesh| -> Interface { contact(&one, two, true, options) };
        slides_as_without_the_others(&one, &walls, create);
    }
}

/// Edges of facets lie above each other but for rounding: what a facet touches by a sliver is not under it.
#[test]
fn walls_of_the_same_mesh_are_told_apart() {
    let one = grid(3, 2, [0.3, 0.3], [1.2, 0.9], 0.0, false, Cells::Quads);
    let wall = |b: f64, n: usize, z: f64| grid(n, 4, [0.0, 0.0], [b, 1.2], z, true, Cells::Quads);
    let walls = [wall(5.1, 17, 0.0), wall(4.8, 16, -0.2), wall(2.1, 7, -0.4)];
    let create = |two: &Mesh| -> Interface { contact(&one, two, true, options()) };
    slides_as_without_the_others(&one, &walls, create);
}

/// Facets of any kind, quadratic ones among them, and lines.
#[test]
fn facets_of_all_kinds_hide_those_behind() {
    let options = Options { friction: Friction::None, ..options() };
    let low = |mesh: Mesh, z: f64| Mesh { x: shifted(&mesh.x, Vec3::z() * z), ..mesh };
    let kinds: [(&[Kind], &[Kind]); 3] = [(&[8], &[6, 4]), (&[9, 3], &[8, 4]), (&[4], &[9])];
    for (of_pad, of_walls) in kinds {
        let one = grid_of(2, 1, [0.1, 0.3], [0.9, 0.8], false, of_pad);
        let walls = [
            low(grid_of(11, 4, [0.0, 0.0], [5.0, 1.1], true, of_walls), -0.01),
            low(grid_of(7, 3, [0.0, -0.2], [1.9, 1.3], true, of_walls), -0.3),
            low(grid_of(5, 2, [2.2, 0.2], [4.9, 0.7], true, of_walls), -0.2),
        ];
        let create = |two: &Mesh| -> Contact<1> { contact_of(&one, two, true, options) };
        slides_as_without_the_others(&one, &walls, create);
    }
    for nodes in [2, 3] {
        let at = |mesh: Mesh, y: f64| Mesh { x: shifted(&mesh.x, Vec3::new(1.0, y, 0.0)), ..mesh };
        let one = at(lines(3, nodes, [0.1, 0.9], false), 0.0);
        let walls = [
            at(lines(23, 2, [0.0, 5.0], true), -0.01),
            at(lines(7, nodes, [0.0, 1.9], true), -0.3),
            at(lines(9, 2, [2.2, 4.9], true), -0.2),
        ];
        for measure in [Measure::Thickness(0.7), Measure::Axisymmetric] {
            let create = |two: &Mesh| -> Contact<1> { contact_of_lines(&one, two, measure, options) };
            slides_as_without_the_others(&one, &walls, create);
        }
    }
}

/// An elastic pad is pressed on two plates side by side and slides over their seam: the second one lies lower and reaches
/// under the first one by `under`. Forces along and across after each step.
fn over_a_seam(under: f64) -> Vec<Vec3> {
    let pad = grid(8, 2, [0.0, 0.0], [0.8, 0.2], 0.0, false, Cells::Quads);
    let plate = |n: usize, from: f64, to: f64, z: f64| grid(n, 2, [from, -0.1], [to, 0.3], z, true, Cells::Quads);
    let plates = together(&[plate(10, -0.13, 0.87, 0.0), plate(11, 0.87 - under, 1.97 - under, -0.01)]);
    let body = Body::new(pad, Vec3::z() * 0.2, 1000.0, 0.3);
    let mut host = Host::<3>::new(body, Err(plates), Options { mu: 0.2, basis: MultiplierBasis::Dual, ..options() });
    (1..=12)
        .map(|step| {
            host.hold(0, |_| Vec3::new(0.06 * f64::from(step - 1), 0.0, -0.03));
            host.solve();
            let (x1, x2) = host.positions();
            let force: Vec3 = host.contact.residual(&x1, &x2, &host.lambda, None).unwrap().nonmortar.iter().sum();
            host.commit();
            force
        })
        .collect()
}

/// A step of 0.01 between two blocks under facets of 0.1, of which one reaches under the other: it was refused.
#[test]
fn a_seam_with_a_step_runs_through() {
    let expected = over_a_seam(0.0);
    for (under, most) in
        [(0.004, HALF), (0.01, HALF), (0.02, HALF), (0.03, HALF), (0.045, HALF), (0.07, HALF), (0.1, ALL), (0.3, ALL)]
    {
        let found = over_a_seam(under);
        let worst = found.iter().zip(&expected).map(|(f, e)| (f - e).amax() / e.amax()).fold(0.0, f64::max);
        println!("reaches under by {under}: off by {worst:.2e}");
        assert!(worst < most, "{under}: {found:?}, {expected:?}");
    }
}
