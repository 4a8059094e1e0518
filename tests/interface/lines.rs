//! Lines of plane and axisymmetric models through the interface (docs/formulation 13).

use crate::support::lines::*;
use crate::support::max_abs;
use crate::support::mesh::*;
use stickslip::geometry::Vec3;
use stickslip::interface::{Friction, Interface, MultiplierBasis, Options, Stiffness, Surface, Tangent, Weights};
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
        for (options, seed) in choices(options()).into_iter().flat_map(|o| [1, 2, 3, 4].map(|seed| (o, seed))) {
            // Half of the scenes with so much friction that nodes stick.
            let options = Options { mu: if seed % 2 == 0 { 3.0 } else { options.mu }, ..options };
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
        for (options, measure) in
            choices(under(friction, mu, options())).into_iter().flat_map(|o| MEASURES.map(|m| (o, m)))
        {
            let error = match friction {
                Friction::None => moved_lines::<1>(&options, [3, 2], measure, 5).difference_error(),
                _ => moved_lines::<3>(&options, [3, 2], measure, 5).difference_error(),
            };
            assert!(
                error <= DIFFERENCES,
                "{friction:?} {measure:?} {:?} {:?}: {error:e}",
                options.space,
                options.basis
            );
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
    let all =
        laws.into_iter().flat_map(|law| [MultiplierBasis::Standard, MultiplierBasis::Dual].map(|basis| (law, basis)));
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
            s.contact
                .tangent(&x1, &x2, &s.lambda, None, &mut |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v)
                .unwrap();
            let equation = |i: i64| {
                let (i, [a, b]) = (i as usize, [6 * n1, 6 * (n1 + n2)]);
                let (first, from, nodes) = if i < a {
                    (0, 0, n1)
                } else if i < b {
                    (2 * n1, a, n2)
                } else {
                    (2 * (n1 + n2), b, n1)
                };
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
            if basis == MultiplierBasis::Dual {
                let mut random = Random(3);
                let host: Vec<_> = (0..n1).map(|_| Vec3::new(random.next(), random.next(), 0.0)).collect();
                let halves: Vec<_> = host.iter().chain(&host).map(|f| f * 0.5).collect();
                let own = s.contact.condensed_multipliers(&x1, &x2, &host).unwrap();
                let of_space = space.condensed_multipliers(&y1, &y2, &halves).unwrap();
                let largest = max_abs(own.iter().flat_map(|v| v.iter().copied()));
                assert!(
                    (0..n1).all(|a| ((own[a] - of_space[a]).xy()).amax() <= SAME * largest),
                    "{friction:?} {weights:?}"
                );
                let (own, gain) = s.contact.condensed_residual(&x1, &x2, &own, &host).unwrap();
                let (rows, gains) = space.condensed_residual(&y1, &y2, &of_space, &halves).unwrap();
                let largest = max_abs(own.iter().chain(&gain).flat_map(|v| v.iter().copied()));
                for (own, all) in [(&own, &rows), (&gain, &gains)] {
                    let n = own.len();
                    let error = max_abs((0..n).flat_map(|k| [0, 1].map(|i| own[k][i] - all[k][i] - all[k + n][i])));
                    assert!(error <= SAME * largest, "{friction:?} {weights:?}: condensed {error:e} of {largest:e}");
                }
            }
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

/// int N_k rho dr of the nodes of a line from r = a to b, by a rule of its own: Gauss with three points.
fn loads(nodes: usize, [a, b]: [f64; 2], rho: impl Fn(f64) -> f64) -> Vec<f64> {
    let root = 0.6_f64.sqrt();
    let mut loads = vec![0.0; nodes];
    for (xi, w) in [(-root, 5.0 / 9.0), (0.0, 8.0 / 9.0), (root, 5.0 / 9.0)] {
        let n = match nodes {
            2 => vec![0.5 * (1.0 - xi), 0.5 * (1.0 + xi)],
            _ => vec![0.5 * xi * (xi - 1.0), 0.5 * xi * (xi + 1.0), 1.0 - xi * xi],
        };
        let r = 0.5 * (a + b) + 0.5 * (b - a) * xi;
        (0..nodes).for_each(|k| loads[k] += n[k] * w * 0.5 * (b - a) * rho(r));
    }
    loads
}

/// Under one pressure the forces on both sides are its consistent loads, on meshes that do not match: plane, and ring on ring. With a
/// node on the axis.
#[test]
fn one_pressure_gives_consistent_loads() {
    const PRESSURE: f64 = 2.5;
    let thickness = 0.7;
    for (nodes, measure, from) in [[2, 2], [2, 3], [3, 2], [3, 3]].into_iter().flat_map(|nodes| {
        [(Measure::Thickness(thickness), -1.0), (Measure::Axisymmetric, 1.0), (Measure::Axisymmetric, 0.0)]
            .map(|(m, from)| (nodes, m, from))
    }) {
        let rho = |r: f64| if measure == Measure::Axisymmetric { std::f64::consts::TAU * r } else { thickness };
        for options in choices(Options { mu: 0.0, ..options() }) {
            let one = lines(5, nodes[0], [from, from + 2.0], false);
            let two = lines(3, nodes[1], [from, from + 2.0], true);
            let mut c = contact_of_lines::<3>(&one, &two, measure, options);
            let lambda: Vec<_> = has_row(&one, options.space)
                .iter()
                .map(|has| Vec3::new(0.0, if *has { -PRESSURE } else { 0.0 }, 0.0))
                .collect();
            let r = c.residual(&one.x, &two.x, &lambda, None).unwrap();
            for (mesh, forces, sign) in [(&one, &r.nonmortar, -1.0), (&two, &r.mortar, 1.0)] {
                let mut expected = vec![0.0; mesh.x.len()];
                for facet in &mesh.facets {
                    let ends = [facet[0], facet[1]].map(|k| mesh.x[k as usize].x);
                    let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                    let mut own = loads(facet.len(), [low, high], rho);
                    if ends[0] > ends[1] {
                        own.swap(0, 1);
                    }
                    facet.iter().zip(own).for_each(|(&k, load)| expected[k as usize] += sign * PRESSURE * load);
                }
                let error = max_abs(forces.iter().zip(&expected).flat_map(|(f, e)| [f.x, f.y - e]));
                let what = format!("{nodes:?} {measure:?} from {from} {:?} {:?}", options.space, options.basis);
                assert!(error <= SAME * max_abs(expected.iter().copied()), "{what}: {error:e}");
            }
            assert!(max_abs(r.rows.iter().flat_map(|row| row.iter().copied())) <= SAME, "closed, in equilibrium");
            // Areas are all that there is.
            let whole: f64 = loads(2, [from, from + 2.0], rho).iter().sum();
            let areas: f64 =
                (0..one.x.len()).filter(|&a| c.surfaces().0.has_row(a)).map(|a| c.history().areas[a]).sum();
            assert!((areas - whole).abs() <= SAME * whole);
        }
    }
}

#[test]
fn histories_of_lines_are_kept_undone_and_imported() {
    for (options, measure) in choices(options()).into_iter().flat_map(|o| MEASURES.map(|m| (o, m))) {
        let mut s = moved_lines::<3>(&options, [3, 2], measure, 6);
        let z = s.unknowns();
        s.contact.commit(&s.x1, &s.x2, &s.lambda, None).unwrap();
        let after = s.residual(&z);
        let (integers, reals) = s.contact.export_history().unwrap();
        let mut other = moved_lines::<3>(&options, [3, 2], measure, 6);
        other.contact.import_history(&integers, &reals).unwrap();
        assert_eq!(other.residual(&z), after);
        s.contact.roll_back().unwrap();
        assert_ne!(s.residual(&z), after);
        // Of another thickness it is another interface.
        let foreign = if measure == Measure::Axisymmetric { Measure::Thickness(0.7) } else { Measure::Thickness(0.8) };
        let mut foreign = moved_lines::<3>(&options, [3, 2], foreign, 6);
        assert!(foreign.contact.import_history(&integers, &reals).is_err());
    }
}

/// Forces and rows are proportional to the thickness, in every bit of a power of two, and nothing else depends on it: the size of a node
/// is a length.
#[test]
fn the_thickness_is_a_factor() {
    const FACTOR: f64 = 1024.0;
    for options in choices(options()) {
        let mut thin = moved_lines::<3>(&options, [3, 2], Measure::Thickness(1.0), 8);
        let mut thick = moved_lines::<3>(&options, [3, 2], Measure::Thickness(FACTOR), 8);
        let z = thin.unknowns();
        let (own, other) = (thin.residual(&z), thick.residual(&z));
        assert!(own.iter().zip(&other).all(|(f, g)| f * FACTOR == *g), "{:?} {:?}", options.space, options.basis);
        let starts = [&mut thin, &mut thick].map(|s| s.contact.initial_multipliers().unwrap());
        assert_eq!(starts[0], starts[1]);
    }
}

/// A node's size is about the length of its lines, at the axis and far from it.
#[test]
fn the_augmentation_follows_the_length_of_lines() {
    for (from, n) in [(0.0, 8), (1.0, 8), (1000.0, 8), (0.0, 80)] {
        let (one, two) = (lines(n, 2, [from, from + 2.0], false), lines(3, 2, [from, from + 2.0], true));
        let options = Options { stiffness: Stiffness::Modulus(1.0), ..options() };
        let mut rings = contact_of_lines::<3>(&one, &two, Measure::Axisymmetric, options);
        let mut plane = contact_of_lines::<3>(&one, &two, Measure::Thickness(3.0), options);
        for a in 0..one.x.len() {
            let hat = |c: &mut Interface| c.augmentation(a) * c.history().areas[a];
            let ratio = hat(&mut rings) / hat(&mut plane);
            assert!((0.5..2.0).contains(&ratio), "node {a} from {from}: {ratio}");
        }
    }
}

fn refusal(options: Options, sides: [stickslip::error::Result<Surface>; 2]) -> String {
    let [one, two] = sides;
    let made = one.and_then(|one| {
        let n = one.len();
        Interface::new(one, two?, plane_equations(100, n), options)
    });
    made.map(|_| ()).unwrap_err().to_string()
}

#[test]
fn what_lines_do_not_take_is_refused() {
    let (one, two) = (lines(2, 2, [0.0, 1.0], false), lines(3, 2, [0.0, 1.0], true));
    let of = |mesh: &Mesh, side, measure| {
        let n = mesh.x.len();
        Surface::of_lines(
            side,
            mesh.x.clone(),
            &mesh.facets,
            plane_equations(if side == "mortar" { 20 } else { 0 }, n),
            measure,
        )
    };
    let plane = Measure::Thickness(1.0);
    let sides = || [of(&one, "nonmortar", plane), of(&two, "mortar", plane)];
    for (options, name) in [
        (Options { tangent: Tangent::FrozenNormals, ..options() }, "FROZEN_NORMALS) with lines"),
        (
            Options { basis: MultiplierBasis::Dual, space: MultiplierSpace::Sub, ..options() },
            "multipliers at all nodes",
        ),
    ] {
        let text = refusal(options, sides());
        assert!(text.contains(name), "{text}");
    }
    let layer = layer(&two, 1.0);
    let solid = Surface::new("mortar", layer.x.clone(), &layer.facets, numbered(20, layer.x.len()));
    let text = refusal(options(), [of(&one, "nonmortar", plane), solid]);
    assert!(text.contains("another model"), "{text}");
    let text = refusal(options(), [of(&one, "nonmortar", plane), of(&two, "mortar", Measure::Thickness(2.0))]);
    assert!(text.contains("another thickness"), "{text}");
    let text = refusal(options(), [of(&layer, "nonmortar", plane), of(&two, "mortar", plane)]);
    assert!(text.contains("facet 0 has 4 nodes; a line has 2 or 3"), "{text}");
    let behind = Mesh { x: one.x.iter().map(|x| x - Vec3::new(0.25, 0.0, 0.0)).collect(), facets: one.facets.clone() };
    let text = refusal(
        options(),
        [of(&behind, "nonmortar", Measure::Axisymmetric), of(&two, "mortar", Measure::Axisymmetric)],
    );
    assert!(text.contains("node 0 has r = -2.5e-1, beyond the axis"), "{text}");
    let reversed = Mesh { x: one.x.clone(), facets: vec![vec![0, 1], vec![2, 1]] };
    let text = refusal(options(), [of(&reversed, "nonmortar", plane), of(&two, "mortar", plane)]);
    assert!(text.contains("facets 0 and 1 both end at node 1"), "{text}");
    let back = Mesh { x: vec![Vec3::zeros(), Vec3::x(), Vec3::new(0.2, 0.0, 0.0)], facets: vec![vec![0, 1, 2]] };
    let text = refusal(options(), [of(&back, "nonmortar", plane), of(&two, "mortar", plane)]);
    assert!(text.contains("a line turns back"), "{text}");
    // Later positions are looked at, too, and nothing is lost.
    let mut c = Interface::new(
        of(&one, "nonmortar", Measure::Axisymmetric).unwrap(),
        of(&two, "mortar", Measure::Axisymmetric).unwrap(),
        plane_equations(100, one.x.len()),
        options(),
    )
    .unwrap();
    let lambda = vec![Vec3::new(0.0, -1.0, 0.0); one.x.len()];
    let before = c.residual(&one.x, &two.x, &lambda, None).unwrap();
    let text = c.residual(&behind.x, &two.x, &lambda, None).unwrap_err().to_string();
    assert!(text.contains("nonmortar: node 0 has r = -2.5e-1, beyond the axis"), "{text}");
    let lifted: Vec<_> = two.x.iter().map(|x| x + Vec3::z()).collect();
    let text = c.residual(&one.x, &lifted, &lambda, None).unwrap_err().to_string();
    assert!(text.contains("mortar: node 0 has z = 1e0"), "{text}");
    assert_eq!(c.residual(&one.x, &two.x, &lambda, None).unwrap(), before);
}
