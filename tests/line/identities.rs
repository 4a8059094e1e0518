//! What holds for lines of any shape: both sides have the same sums, rigid motions do nothing, derivatives are those of
//! differences, and what has no meaning is refused.

use proptest::prelude::*;
use stickslip::error::Kind;
use stickslip::geometry::Vec2;
use stickslip::line::{LineDerivatives, LineFacet, LineWeights, MAX_LINE_NODES, Measure};
use stickslip::mortar::MultiplierSpace;

/// Sums of some products.
const ROUNDING: f64 = 1e-14;
/// Central differences with a step of 1e-6 of a line: rounding 1e-16 / 1e-6, and the step's square.
const STEP: f64 = 1e-6;
const DIFFERENCES: f64 = 1e-8;

type Scene = (LineFacet, LineFacet, MultiplierSpace, Measure);

fn facet(x: &[Vec2]) -> LineFacet {
    LineFacet::new(x).unwrap()
}

/// A line along x and one above it, of either kind, bent and with middle nodes off the middle, away from the axis.
fn scene() -> impl Strategy<Value = Scene> {
    let jitter = prop::array::uniform12(-0.1..0.1_f64);
    (2..4_usize, 2..4_usize, jitter, any::<bool>(), any::<bool>(), -0.6..0.6_f64).prop_map(
        |(n1, n2, j, sub, axis, shift)| {
            let at = |x: f64, y: f64, k: usize| Vec2::new(3.0 + x + j[2 * k], y + j[2 * k + 1]);
            let one = [at(0.0, 0.0, 0), at(1.0, 0.0, 1), at(0.5, 0.0, 2)];
            let two = [at(1.0 + shift, 0.2, 3), at(shift, 0.2, 4), at(0.5 + shift, 0.2, 5)];
            let space = if sub { MultiplierSpace::Sub } else { MultiplierSpace::Corner };
            let measure = if axis { Measure::Axisymmetric } else { Measure::Thickness(0.7) };
            (facet(&one[..n1]), facet(&two[..n2]), space, measure)
        },
    )
}

/// Nodes of both lines, moved.
fn moved((one, two, space, measure): &Scene, motion: impl Fn(usize, Vec2) -> Vec2) -> LineWeights {
    let to = |f: &LineFacet, first: usize| -> LineFacet {
        let x: Vec<_> = (0..f.n).map(|k| motion(first + k, f.x[k])).collect();
        facet(&x)
    };
    LineWeights::new(&to(one, 0), &to(two, MAX_LINE_NODES), *space, *measure)
}

fn all(w: &LineWeights) -> impl Iterator<Item = f64> {
    w.ab.into_iter().flatten().chain(w.ac.into_iter().flatten())
}

proptest! {
    #[test]
    fn both_sides_have_the_same_sums(s in scene()) {
        let w = LineWeights::new(&s.0, &s.1, s.2, s.3);
        for a in 0..MAX_LINE_NODES {
            let sums = [w.ab[a].iter().sum::<f64>(), w.ac[a].iter().sum::<f64>()];
            prop_assert!((sums[0] - sums[1]).abs() <= 20.0 * ROUNDING, "{a}: {sums:?}");
            prop_assert!(sums[0] >= 0.0);
        }
    }

    #[test]
    fn rigid_motions_change_nothing(s in scene(), angle in -3.0..3.0_f64, x in -2.0..2.0_f64, y in -5.0..5.0_f64) {
        let w = LineWeights::new(&s.0, &s.1, s.2, s.3);
        let axis = s.3 == Measure::Axisymmetric; // which may move along itself only
        let (sin, cos) = if axis { (0.0, 1.0) } else { angle.sin_cos() };
        let shift = Vec2::new(if axis { 0.0 } else { x }, y);
        let turned = moved(&s, |_, p| Vec2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y) + shift);
        for (a, b) in all(&w).zip(all(&turned)) {
            prop_assert!((a - b).abs() <= 400.0 * ROUNDING, "{a} {b}");
        }
    }

    #[test]
    fn derivatives_are_those_of_differences(s in scene()) {
        let d = LineDerivatives::new(&s.0, &s.1, s.2, s.3);
        for (k, i) in (0..2 * MAX_LINE_NODES).flat_map(|k| [(k, 0), (k, 1)]) {
            let at = |h: f64| moved(&s, |node, p| if node == k { p + Vec2::new([h, 0.0][i], [0.0, h][i]) } else { p });
            let (plus, less) = (at(STEP), at(-STEP));
            let exact = d.ab.iter().flatten().chain(d.ac.iter().flatten()).map(|of| of[2 * k + i]);
            for ((p, m), e) in all(&plus).zip(all(&less)).zip(exact) {
                let difference = (p - m) / (2.0 * STEP);
                prop_assert!((difference - e).abs() <= 20.0 * DIFFERENCES, "{k} {i}: {difference} {e}");
            }
        }
    }
}

/// The multipliers at all nodes of a line are those of the two lines that it is cut into.
#[test]
fn areas_at_all_nodes_are_those_of_the_parts() {
    let x = [Vec2::new(1.0, 0.0), Vec2::new(2.0, 0.1), Vec2::new(1.6, 0.2)];
    let two = facet(&[Vec2::new(2.5, 0.3), Vec2::new(0.5, 0.1)]);
    for measure in [Measure::Thickness(2.0), Measure::Axisymmetric] {
        let areas = |f: &LineFacet| {
            LineWeights::new(f, &two, MultiplierSpace::Sub, measure).ab.map(|row| row.iter().sum::<f64>())
        };
        let whole = areas(&facet(&x));
        let (first, second) = (areas(&facet(&[x[0], x[2]])), areas(&facet(&[x[2], x[1]])));
        for (found, expected) in whole.iter().zip([first[0], second[1], first[1] + second[0]]) {
            assert!((found - expected).abs() <= 20.0 * ROUNDING, "{found} {expected}");
        }
    }
}

#[test]
fn lines_without_meaning_are_refused() {
    let (a, b) = (Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0));
    let kind = |x: &[Vec2]| LineFacet::new(x).unwrap_err().kind;
    assert_eq!(kind(&[a]), Kind::InvalidSize);
    assert_eq!(kind(&[a, b, a, b]), Kind::InvalidSize);
    assert_eq!(kind(&[a, a]), Kind::DegenerateFacet);
    assert_eq!(kind(&[a, Vec2::new(f64::NAN, 0.0)]), Kind::NotFinite);
    for middle in [-0.1, 0.0, 0.2, 0.25, 0.75, 0.9, 1.2] {
        assert_eq!(kind(&[a, b, Vec2::new(middle, 0.0)]), Kind::DegenerateFacet, "{middle}");
    }
    for middle in [0.26, 0.5, 0.74] {
        assert!(LineFacet::new(&[a, b, Vec2::new(middle, 0.1)]).is_ok(), "{middle}");
    }
}
