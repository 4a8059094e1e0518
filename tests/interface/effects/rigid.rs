//! A rigid mortar side against a deformable one without equations: the same residual to the last bit, the same tangent.

use super::*;
use proptest::prelude::*;
use stickslip::error::Kind;
use stickslip::interface::{Friction, MortarSide, NO_EQUATION, Surface};
use stickslip::law::SlipMeasure;
use stickslip::quadrature::{DEGREE_5, DEGREE_10};

/// Entries of the tangent on affine facets, over the largest.
const AFFINE: f64 = 1e-12;
/// On warped and distorted quads the two differentiate the same integral in different ways, each with the error of its
/// quadrature: 2e-5 at most in 400 scenes, and 2e-10 with degree 10; 2e-9 in 3000, since scenes are ever more distorted.
/// A wrong derivative is off by parts of itself with either.
const WARPED_DEGREE_5: f64 = 1e-3;
const WARPED_DEGREE_10: f64 = 2e-8;

/// Residual bits and the full matrix of a scene's tangent, rows and columns x1 and lambda.
fn evaluate<const N: usize>(c: &mut Contact<N>, scene: &Moved) -> (Vec<u64>, Vec<f64>)
where
    Contact<N>: Create<N>,
{
    let lambda: Vec<SVector<f64, N>> =
        scene.lambda.iter().map(|l| SVector::from_fn(|i, _| if N == 1 { -l.norm() } else { l[i] })).collect();
    let r = c.residual(&scene.x1, &scene.x2, &lambda, None).unwrap();
    let n = 3 * (scene.x1.len() + scene.x2.len()) + N * lambda.len();
    let mut k = vec![0.0; n * n];
    let mut add = |i: i64, j: i64, v: f64| k[i as usize * n + j as usize] += v;
    c.tangent(&scene.x1, &scene.x2, &lambda, None, &mut add).unwrap();
    (bits(&r), k)
}

/// Asserts equal bits of the residual; the difference of the tangents over the largest entry.
fn difference_of<const N: usize>(scene: &Moved, options: Options) -> f64
where
    Contact<N>: Create<N>,
{
    let mut full: Contact<N> = again(scene, true, Options { shortcuts: NO_SHORTCUTS, ..options });
    let (r, k) = evaluate(&mut full, scene);
    let asked = Options { mortar_side: MortarSide::Rigid, shortcuts: NO_SHORTCUTS, ..options };
    let mut worst = 0.0_f64;
    for rigid in [asked, options] {
        let (r_rigid, k_rigid) = evaluate(&mut again::<N>(scene, true, rigid), scene);
        assert_eq!(r, r_rigid, "{options:?}");
        let scale = crate::support::max_abs(k.iter().copied());
        worst = worst.max(crate::support::max_abs(k.iter().zip(&k_rigid).map(|(a, b)| a - b)) / scale);
    }
    worst
}

/// All laws and forms with all weights.
fn laws() -> impl Iterator<Item = Options> {
    let law = |friction, mu| Options { friction, mu, ..options() };
    let laws =
        [law(Friction::Coulomb, 0.7), law(Friction::Rough, 0.0), law(Friction::Tied, 0.0), law(Friction::None, 0.0)];
    laws.into_iter().flat_map(variants)
}

fn worst_of_laws(scene: &Moved, rule: &'static stickslip::quadrature::Rule) -> f64 {
    laws().fold(0.0, |worst, options| {
        let options = Options { rule, ..options };
        worst.max(if options.friction == Friction::None {
            difference_of::<1>(scene, options)
        } else {
            difference_of::<3>(scene, options)
        })
    })
}

proptest! {
    #![proptest_config(crate::support::random::cases(24))]

    #[test]
    fn affine_facets(seed in 1_u64..1 << 40, slide in 0.0..0.5_f64, warp in 0.0..0.08_f64, jitter in 0.0..0.1_f64) {
        for (cells, rough) in [
            (CELLS[0], Roughness { slide, ..FLAT }),
            (CELLS[1], Roughness { slide, ..FLAT }),
            (CELLS[2], Roughness { warp, jitter, slide }),
        ] {
            let error = worst_of_laws(&moved(&options(), cells, rough, seed), &DEGREE_5);
            prop_assert!(error <= AFFINE, "{error:e}");
        }
    }

    #[test]
    fn warped_facets(seed in 1_u64..1 << 40, slide in 0.0..0.5_f64) {
        let scene = moved(&options(), CELLS[0], Roughness { slide, ..ROUGH }, seed);
        for (rule, bound) in [(&DEGREE_5, WARPED_DEGREE_5), (&DEGREE_10, WARPED_DEGREE_10)] {
            let error = worst_of_laws(&scene, rule);
            prop_assert!(error <= bound, "degree {}: {error:e}", rule.degree);
        }
    }
}

/// The mortar side may move all the same: it is prescribed.
#[test]
fn a_prescribed_mortar_side_may_move() {
    for slip in [SlipMeasure::Objective, SlipMeasure::Increment, SlipMeasure::Paper] {
        let mut scene = moved(&options(), CELLS[0], FLAT, 3);
        let options = Options { slip, ..options() };
        let mut rigid: Contact<3> = again(&scene, true, options);
        let mut full: Contact<3> = again(&scene, true, Options { shortcuts: NO_SHORTCUTS, ..options });
        for _ in 0..3 {
            scene.x2 = shifted(&scene.x2, along() * -0.07);
            let ((r, k), (r_full, k_full)) = (evaluate(&mut rigid, &scene), evaluate(&mut full, &scene));
            assert_eq!(r, r_full);
            let scale = crate::support::max_abs(k.iter().copied());
            assert!(crate::support::max_abs(k.iter().zip(&k_full).map(|(a, b)| a - b)) <= AFFINE * scale);
            rigid.commit(&scene.x1, &scene.x2, &scene.lambda, None).unwrap();
            full.commit(&scene.x1, &scene.x2, &scene.lambda, None).unwrap();
            assert_eq!(rigid.history(), full.history());
        }
    }
}

#[test]
fn a_rigid_side_with_an_equation_is_refused() {
    let scene = moved(&options(), CELLS[0], FLAT, 3);
    let (one, two) = scene.interface.surfaces();
    let mut equations = vec![[NO_EQUATION; 3]; two.len()];
    equations[5][1] = 7;
    let mesh = mesh_of(two);
    let two = Surface::new("mortar", mesh.x, &mesh.facets, equations).unwrap();
    let rigid = Options { mortar_side: MortarSide::Rigid, ..options() };
    let refused = Contact::<3>::new(one.clone(), two, numbered(3 * one.len(), one.len()), rigid).unwrap_err();
    assert!(refused.kind == Kind::InvalidValue && refused.message.contains("node 5"), "{}", refused.message);
}
