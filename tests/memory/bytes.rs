//! `bytes` of an interface against what the allocator hands out.
use crate::allocator::LIVE;
use crate::support::mesh::*;
use nalgebra::SVector;
use stickslip::geometry::{AnalyticShape, Vec3};
use stickslip::interface::{Contact, Friction, Options, Surface, Weights};

/// What `bytes` may be off by, over all: words here and there. A vector of one number a facet left out is more.
const SHARE: f64 = 1e-3;

fn check<const N: usize>(c: &Contact<N>, before: i64, what: &str, when: &str) {
    let (counted, held) = (c.bytes() as f64, (LIVE.get() - before) as f64);
    assert!((counted - held).abs() <= SHARE * held, "{what}, {when}: {counted} bytes counted, {held} held");
}

/// Creation, an evaluation elsewhere, a commit, an evaluation.
fn run<const N: usize>(analytic: bool, options: Options, height: f64)
where
    Contact<N>: Create<N>,
{
    let upper = grid(8, 7, [0.0, 0.0], [1.0, 1.0], height, false, Cells::Quads);
    let lower = grid(9, 9, [-0.5, -0.5], [1.5, 1.5], 0.0, true, Cells::Triangles);
    let (n1, n2, what) = (upper.x.len(), lower.x.len(), format!("analytic {analytic}, {options:?}"));
    let x1: Vec<_> = upper.x.iter().map(|x| x + Vec3::new(0.01, 0.02, -0.001)).collect();
    let lambda = vec![SVector::from_element(-0.1); n1];
    let frame = vec![Vec3::zeros(), Vec3::z(), Vec3::x(), Vec3::y()];
    let x2 = if analytic { frame.clone() } else { lower.x.clone() };

    let before = LIVE.get();
    let one = Surface::new("nonmortar", upper.x.clone(), &upper.facets, numbered(0, n1)).unwrap();
    let two = if analytic {
        Surface::analytic("mortar", AnalyticShape::Plane, frame.clone()).unwrap()
    } else {
        Surface::new("mortar", lower.x.clone(), &lower.facets, numbered(3 * n1, n2)).unwrap()
    };
    let mut c = Contact::create(one, two, numbered(3 * (n1 + n2), n1), options).unwrap();
    check(&c, before, &what, "created");
    drop(c.residual(&x1, &x2, &lambda, None).unwrap());
    check(&c, before, &what, "evaluated");
    c.commit(&x1, &x2, &lambda, None).unwrap();
    check(&c, before, &what, "committed");
    drop(c.residual(&upper.x, &x2, &lambda, None).unwrap());
    check(&c, before, &what, "evaluated after the commit");
    c.roll_back().unwrap();
    check(&c, before, &what, "rolled back");
}

#[test]
fn bytes_are_those_that_the_allocator_hands_out() {
    for analytic in [false, true] {
        for height in [0.0, 9.0] {
            for weights in [Weights::Current, Weights::Committed, Weights::Reference] {
                run::<3>(analytic, Options { weights, ..options() }, height);
                run::<1>(analytic, Options { weights, friction: Friction::None, mu: 0.0, ..options() }, height);
            }
            run::<3>(analytic, Options { friction: Friction::Tied, mu: 0.0, ..options() }, height);
        }
    }
}
