//! The lag of normals of t_n (`src/interface/inspect/equilibrium.rs`): a step that turns bodies with their pressure is off by the turn, and
//! this is what is found; where normals follow, or tractions need not turn, nothing is.

use crate::support::mesh::*;
use nalgebra::{Rotation3, SVector};
use stickslip::geometry::Vec3;
use stickslip::interface::{Contact, Equilibrium, Friction, MultiplierBasis, Normals, Options, Scales, Stiffness};

/// Of a traction of 1: sums of some products.
const ROUNDING: f64 = 1e-10;
const DEGREES: [f64; 5] = [0.0, 0.5, 3.0, 10.0, 30.0];

fn options(friction: Friction, mu: f64, normals: Normals) -> Options {
    Options { friction, mu, normals, ..Options::paper(Stiffness::Modulus(100.0)) }
}

/// Both bodies, that touch, turned about y; the tractions as they were, `along` of them along the surface.
fn turned<const N: usize>(options: Options, degrees: f64, along: f64) -> Equilibrium
where
    Contact<N>: Create<N>,
{
    let one = grid(3, 3, [0.0, 0.0], [1.0, 1.0], 0.0, false, Cells::Quads);
    let two = grid(4, 4, [-0.5, -0.5], [1.5, 1.5], 0.0, true, Cells::Quads);
    let mut contact: Contact<N> = contact(&one, &two, false, options);
    let turn = Rotation3::from_axis_angle(&Vec3::y_axis(), degrees.to_radians());
    let [x1, x2] = [&one, &two].map(|mesh| mesh.x.iter().map(|x| turn * x).collect::<Vec<_>>());
    let vector = Vec3::new(along, 0.0, -1.0);
    let lambda = SVector::from_fn(|k, _| if N == 1 { -1.0 } else { vector[k] });
    let lambda = vec![lambda; one.x.len()];
    contact.equilibrium(&x1, &x2, &lambda, None, &Scales { modulus: 100.0, traction: 0.0 }).unwrap()
}

fn share(e: &Equilibrium) -> [f64; 2] {
    [e.lag.value / e.lag.scale, if e.lag_force[1] > 0.0 { e.lag_force[0] / e.lag_force[1] } else { 0.0 }]
}

#[test]
fn without_friction_it_is_the_turn() {
    for degrees in DEGREES {
        let angle = degrees.to_radians();
        let one = share(&turned::<1>(options(Friction::None, 0.0, Normals::Committed), degrees, 0.0));
        let three = share(&turned::<3>(options(Friction::Coulomb, 0.0, Normals::Committed), degrees, 0.0));
        for k in 0..2 {
            assert!((one[k] - 2.0 * (0.5 * angle).sin()).abs() < ROUNDING, "{degrees}: {one:?}");
            assert!((three[k] - angle.sin()).abs() < ROUNDING, "{degrees}: {three:?}");
        }
        let dual = Options { basis: MultiplierBasis::Dual, ..options(Friction::None, 0.0, Normals::Committed) };
        assert!((share(&turned::<1>(dual, degrees, 0.0))[0] - one[0]).abs() < ROUNDING);
    }
}

#[test]
fn what_sticks_within_the_cone_lags_by_nothing_and_beyond_it_by_what_is_beyond() {
    for degrees in DEGREES {
        // Rough enough for all turns; the tractions may well lean.
        let stuck = share(&turned::<3>(options(Friction::Coulomb, 2.0, Normals::Committed), degrees, 0.1));
        assert!(stuck[0] < ROUNDING, "{degrees}: {stuck:?}");
        let angle = degrees.to_radians();
        let leaning = share(&turned::<3>(options(Friction::Coulomb, 0.1, Normals::Committed), degrees, 0.0));
        // The tangential part beyond mu times the normal one.
        let beyond = (angle.sin() - 0.1 * angle.cos()).max(0.0);
        assert!((leaning[0] - beyond).abs() < ROUNDING, "{degrees}: {leaning:?}, expected {beyond}");
    }
}

#[test]
fn normals_of_now_lag_by_nothing() {
    for degrees in DEGREES {
        let found = share(&turned::<1>(options(Friction::None, 0.0, Normals::Current), degrees, 0.0));
        assert_eq!(found, [0.0; 2], "{degrees}");
        let tied = share(&turned::<3>(options(Friction::Tied, 0.0, Normals::Committed), degrees, 0.0));
        assert_eq!(tied[0], 0.0, "{degrees}");
    }
}
