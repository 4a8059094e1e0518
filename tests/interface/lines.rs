//! Lines of plane and axisymmetric models through the interface (docs/formulation.md 13).

use crate::support::lines::*;
use crate::support::mesh::*;
use crate::support::max_abs;
use stickslip::geometry::Vec3;
use stickslip::interface::{Friction, Interface, MultiplierBasis, Options, Weights};
use stickslip::law::State;
use stickslip::line::Measure;
use stickslip::mortar::MultiplierSpace;

/// Differences: truncation 1e-12 and rounding 1e-10 of a step of 1e-6.
const DIFFERENCES: f64 = 1e-7;
/// Two ways through other sums, over the largest entry.
const SAME: f64 = 1e-12;

const MEASURES: [Measure; 2] = [Measure::Thickness(0.7), Measure::Axisymmetric];

/// All choices of space and basis that there are.
fn choices(of: Options) -> [Options; 3] {
    let standard = [MultiplierSpace::Corner, MultiplierSpace::Sub].map(|space| Options { space, ..of });
    [standard[0], standard[1], Options { basis: MultiplierBasis::Dual, ..of }]
}

#[test]
fn tangents_are_those_of_differences_for_every_kind_on_every_kind() {
    let mut seen = [0; 3];
    let kinds = [[2, 2], [2, 3], [3, 2], [3, 3]];
    for (nodes, measure) in kinds.into_iter().flat_map(|nodes| MEASURES.map(|measure| (nodes, measure))) {
        for (options, seed) in choices(options()).into_iter().flat_map(|o| [1, 2, 3].map(|seed| (o, seed))) {
            let mut s = moved_lines::<3>(&options, nodes, measure, seed);
            for r in s.contact.responses(&s.x1, &s.x2, &s.lambda, None).unwrap() {
                seen[r.state as usize] += 1;
            }
            let error = s.difference_error();
            assert!(error <= DIFFERENCES, "{nodes:?} {measure:?} {:?} {:?}: {error:e}", options.space, options.basis);
        }
    }
    for state in [State::Gap, State::Stick, State::Slip] {
        assert!(seen[state as usize] > 20, "{state:?} hardly occurs: {seen:?}");
    }
}

#[test]
fn tangents_of_all_laws() {
    for (friction, mu) in [(Friction::Tied, 0.0), (Friction::None, 0.0), (Friction::Tresca, 0.2)] {
        for (options, measure) in choices(under(friction, mu, options())).into_iter().flat_map(|o| MEASURES.map(|m| (o, m))) {
            let error = match friction {
                Friction::None => moved_lines::<1>(&options, [3, 2], measure, 5).difference_error(),
                _ => moved_lines::<3>(&options, [3, 2], measure, 5).difference_error(),
            };
            assert!(error <= DIFFERENCES, "{friction:?} {measure:?} {:?} {:?}: {error:e}", options.space, options.basis);
        }
    }
}

/// A model in space of one layer of quadrilaterals: node k at z = 0 and node k + n at z = the thickness.
fn layer(mesh: &Mesh, thickness: f64) -> Mesh {
    let n = mesh.x.len();
    let up = |k: i64| k + n as i64;
    let x = mesh.x.iter().copied().chain(mesh.x.iter().map(|x| x + Vec3::new(0.0, 0.0, thickness))).collect();
    Mesh { x, facets: mesh.facets.iter().map(|f| vec![f[0], f[1], up(f[1]), up(f[0])]).collect() }
}

/// Residual and tangent of lines are those of one layer of quadrilaterals whose nodes above each other have the same unknowns: of
/// every law, basis and weights, over steps that open, stick and slip.
#[test]
fn lines_are_one_layer_of_quadrilaterals() {
    const THICKNESS: f64 = 0.45;
    let laws = [(Friction::Coulomb, 0.3), (Friction::Tied, 0.0), (Friction::Tresca, 0.2)];
    let all = laws.into_iter().flat_map(|law| [MultiplierBasis::Standard, MultiplierBasis::Dual].map(|basis| (law, basis)));
    for (((friction, mu), basis), weights) in
        all.flat_map(|of| [Weights::Current, Weights::Committed].map(|weights| (of, weights)))
    {
        let options = Options { basis, weights, ..under(friction, mu, options()) };
        let mut s = moved_lines::<3>(&options, [2, 2], Measure::Thickness(THICKNESS), 11);
        let [one, two] = [0, 1].map(|side| layer(&s.meshes[side], THICKNESS));
        let mut space = interface(&one, &two, options);
        let (n1, n2) = (s.x1.len(), s.x2.len());
        let twice = |v: &[Vec3], thickness: f64| {
            let above = v.iter().map(|x| x + Vec3::new(0.0, 0.0, thickness));
            v.iter().copied().chain(above).collect::<Vec<_>>()
        };
        let from = [s.meshes[0].x.clone(), s.meshes[1].x.clone()];
        for part in [0.4, 0.8, 1.0] {
            let between = |side: usize, to: &[Vec3]| -> Vec<Vec3> {
                from[side].iter().zip(to).map(|(x, y)| x + (y - x) * part).collect()
            };
            let (x1, x2) = (between(0, &s.x1), between(1, &s.x2));
            let (y1, y2) = (twice(&x1, THICKNESS), twice(&x2, THICKNESS));
            let lambda = twice(&s.lambda, 0.0);
            let own = s.contact.residual(&x1, &x2, &s.lambda, None).unwrap();
            let of_space = space.residual(&y1, &y2, &lambda, None).unwrap();
            for (own, all) in
                [(&own.nonmortar, &of_space.nonmortar), (&own.mortar, &of_space.mortar), (&own.rows, &of_space.rows)]
            {
                let (n, largest) = (own.len(), max_abs(own.iter().flat_map(|v| v.iter().copied())));
                for k in 0..n {
                    let mut sum = all[k] + all[k + n];
                    sum.z = 0.0; // each of the two is pressed to the other
                    let error = (sum - own[k]).amax();
                    assert!(error <= SAME * largest, "{friction:?} {basis:?} {weights:?}: {error:e} of {largest:e}");
                }
            }
            let states = |c: &mut Interface, x: (&[Vec3], &[Vec3]), lambda: &[Vec3]| -> Vec<_> {
                c.responses(x.0, x.1, lambda, None).unwrap().iter().map(|r| r.state).collect()
            };
            assert_eq!(states(&mut s.contact, (&x1, &x2), &s.lambda), states(&mut space, (&y1, &y2), &lambda)[..n1]);
            // The tangent, with the equations of a layer made those of the lines.
            let n = 2 * (2 * n1 + n2);
            let (mut k, mut of_layer) = (vec![0.0; n * n], vec![0.0; n * n]);
            s.contact.tangent(&x1, &x2, &s.lambda, None, &mut |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v).unwrap();
            let equation = |i: i64| {
                let (i, [a, b]) = (i as usize, [6 * n1, 6 * (n1 + n2)]);
                let (first, from, nodes) = if i < a { (0, 0, n1) } else if i < b { (2 * n1, a, n2) } else { (2 * (n1 + n2), b, n1) };
                let (node, component) = ((i - from) / 3 % nodes, (i - from) % 3);
                (component < 2).then_some(first + 2 * node + component)
            };
            let mut add = |i: i64, j: i64, v: f64| {
                if let (Some(i), Some(j)) = (equation(i), equation(j)) {
                    of_layer[i * n + j] += v;
                }
            };
            space.tangent(&y1, &y2, &lambda, None, &mut add).unwrap();
            let (largest, error) = (max_abs(k.iter().copied()), max_abs(k.iter().zip(&of_layer).map(|(a, b)| a - b)));
            assert!(error <= SAME * largest, "{friction:?} {basis:?} {weights:?}: tangent {error:e} of {largest:e}");
            s.contact.commit(&x1, &x2, &s.lambda, None).unwrap();
            space.commit(&y1, &y2, &lambda, None).unwrap();
        }
    }
}

#[test]
fn plans_have_the_entries_of_the_tangent() {
    for (options, nodes) in choices(options()).into_iter().flat_map(|o| [[2, 2], [3, 2], [3, 3]].map(|n| (o, n))) {
        let mut s = moved_lines::<3>(&options, nodes, Measure::Axisymmetric, 4);
        let what = format!("{nodes:?} {:?} {:?}", options.space, options.basis);
        super::plan::agrees(&mut s.contact, &s.x1, &s.x2, &s.lambda, &what);
    }
}
