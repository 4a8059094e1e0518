//! Steps of a skin: what is kept and what is made anew at a commit, missed contact, rollback, restart.

use crate::bodies::*;
use stickslip::error::Kind;
use stickslip::geometry::Vec3;
use stickslip::skin::{Role, Skin};

/// Positions in which the nodes from `first` on are moved.
fn moved(mesh: &Mesh, first: usize, by: Vec3) -> Vec<Vec3> {
    mesh.x.iter().enumerate().map(|(a, x)| if a < first { *x } else { x + by }).collect()
}

/// A small block over a large one, and the small one's first node.
fn scene(gap: f64) -> (Mesh, usize) {
    (stack(-gap, false), brick([4, 4, 2], [0.0; 3], [1.0; 3], false).x.len())
}

/// A pressure on all copies of the non-mortar side.
fn pressed(skin: &Skin, pressure: f64) -> Vec<Vec3> {
    let whole = skin.whole();
    let own = |a: usize| whole.around.of(a).iter().any(|&f| skin.roles()[f] == Role::Nonmortar);
    (0..whole.copies()).map(|a| Vec3::new(0.0, 0.0, if own(a) { -pressure } else { 0.0 })).collect()
}

/// A block that slides within the room that its piece has keeps the piece; its forces are those of a skin that came there anew.
#[test]
fn a_piece_is_kept_while_its_partners_are_there() {
    let (mesh, first) = scene(-1e-3);
    let mut skin = skin(&mesh, options(0.3));
    assert_eq!((skin.pieces(), skin.counts().made), (1, 1));
    for step in 1..6 {
        let x = moved(&mesh, first, Vec3::new(0.02 * f64::from(step), 0.0, 0.0));
        let mut lambda = pressed(&skin, 1.0);
        skin.commit(&x, &mut lambda).unwrap();
        assert_eq!(lambda, pressed(&skin, 1.0), "who keeps its side keeps its multiplier");
    }
    assert_eq!((skin.pieces(), skin.counts().exchanged), (1, 0));
}

/// A block that comes from above is not seen until it is within reach; a step that goes through the surface is refused, and the
/// same step is in contact when it is solved again.
#[test]
fn a_body_does_not_pass_through_another_one() {
    let (mesh, first) = scene(0.6);
    let mut skin = skin(&mesh, options(0.0));
    assert_eq!((skin.pieces(), skin.near().len()), (0, 0));
    let x = moved(&mesh, first, Vec3::new(0.0, 0.0, -0.62));
    let mut lambda = vec![Vec3::zeros(); skin.whole().copies()];
    let refused = skin.commit(&x, &mut lambda).unwrap_err();
    assert_eq!(refused.kind, Kind::ContactLost);
    assert!(refused.message.contains("have met within the step"), "{}", refused.message);
    assert_eq!((skin.pieces(), skin.counts().missed), (1, 1));
    let open = skin.states(&x, &lambda).unwrap();
    assert!(open.iter().any(|copy| copy.gap < 0.0), "the same place is in contact now");
}

/// A commit is undone to the bit, whether it made pieces anew or not.
#[test]
fn a_rollback_gives_everything_back() {
    let (mesh, first) = scene(-1e-3);
    let mut skin = skin(&mesh, options(0.3));
    let at = |k: f64| moved(&mesh, first, Vec3::new(0.17 * k, 0.0, if k == 3.0 { 2.0 } else { 0.0 }));
    let mut made = Vec::new();
    for step in 1..5 {
        let x = at(f64::from(step));
        let before = skin.export_history().unwrap();
        let lambda = pressed(&skin, 1.0);
        let look = |skin: &mut Skin| {
            let found = skin.residual(&x, &lambda).unwrap();
            (found.forces, found.rows)
        };
        let residual = look(&mut skin);
        skin.commit(&x, &mut lambda.clone()).unwrap();
        made.push(skin.counts().made);
        skin.roll_back().unwrap();
        assert_eq!(skin.export_history().unwrap(), before, "step {step}");
        assert_eq!(look(&mut skin), residual, "step {step}");
        assert_eq!(skin.roll_back().unwrap_err().kind, Kind::NothingToRollBack);
        skin.commit(&x, &mut lambda.clone()).unwrap();
    }
    assert!(made.last() > made.first(), "pieces were made anew: {made:?}");
}

/// A restart goes on to the bit, from every step; another skin's history is refused, and so is one that has changed.
#[test]
fn a_restart_goes_on_to_the_bit() {
    let (mesh, first) = scene(-1e-3);
    let mut whole_run = skin(&mesh, options(0.3));
    let at = |k: i32| moved(&mesh, first, Vec3::new(0.11 * f64::from(k), 0.05 * f64::from(k), 0.0));
    for step in 1..5 {
        let history = whole_run.export_history().unwrap();
        let mut restarted = skin(&mesh, options(0.3));
        restarted.import_history(&history.0, &history.1).unwrap();
        for skin in [&mut whole_run, &mut restarted] {
            let mut lambda = pressed(skin, 2.0);
            skin.commit(&at(step), &mut lambda).unwrap();
        }
        assert_eq!(whole_run.export_history().unwrap(), restarted.export_history().unwrap(), "step {step}");
    }
    let (mut integers, reals) = whole_run.export_history().unwrap();
    let mut other = skin(&stack(1e-3, true), options(0.3));
    assert_eq!(other.import_history(&integers, &reals).unwrap_err().kind, Kind::HistoryMismatch);
    integers[7] ^= 1;
    assert_eq!(whole_run.import_history(&integers, &reals).unwrap_err().kind, Kind::HistoryMismatch);
}

/// Positions and multipliers that are not there, or are no numbers.
#[test]
fn what_is_not_of_the_skin_is_refused_by_name() {
    let (mesh, _) = scene(0.0);
    let mut skin = skin(&mesh, options(0.3));
    let mut lambda = vec![Vec3::zeros(); skin.whole().copies()];
    let short = skin.commit(&mesh.x[1..], &mut lambda).unwrap_err();
    assert!(short.message.starts_with("x has "), "{}", short.message);
    lambda[3].x = f64::NAN;
    let wrong = skin.residual(&mesh.x, &lambda).unwrap_err();
    assert_eq!((wrong.kind, &*wrong.message), (Kind::NotFinite, "lambda of copy 3 is not finite"));
}

/// Exchanged sides: what was mortar has the multipliers, those of the nearest nodes with the other sign, so that forces balance
/// about as before; and once more gives the first sides.
#[test]
fn sides_can_be_exchanged() {
    let (mesh, _) = scene(-1e-3);
    let mut skin = skin(&mesh, options(0.3));
    let mut lambda = pressed(&skin, 1.0);
    skin.commit(&mesh.x, &mut lambda).unwrap();
    let roles = skin.roles().to_vec();
    let total = |skin: &mut Skin, lambda: &[Vec3]| {
        let forces = skin.residual(&mesh.x, lambda).unwrap().forces;
        let first = brick([4, 4, 2], [0.0; 3], [1.0; 3], false).x.len();
        forces[first..].iter().sum::<Vec3>().z
    };
    let before = total(&mut skin, &lambda);
    skin.exchange(&mut lambda).unwrap();
    let other = |role: &Role| match role {
        Role::None => Role::None,
        Role::Nonmortar => Role::Mortar,
        Role::Mortar => Role::Nonmortar,
    };
    assert_eq!(skin.roles(), roles.iter().map(other).collect::<Vec<_>>());
    let after = total(&mut skin, &lambda);
    assert!(before < -0.3 && (after / before - 1.0).abs() < 0.05, "{before} {after}");
    skin.exchange(&mut lambda).unwrap();
    assert_eq!(skin.roles(), roles);
}
