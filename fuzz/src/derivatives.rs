//! Derivatives of a scene's residual by what is no unknown: what is written, and where they do not go with what the scene is.

use super::interface::{Scene, shake};
use super::meshes::{N1, N2};
use super::{Bytes, Watched, all_finite, succeeded};
use stickslip::capi::*;

/// More than the entries of any matrix of this size.
const MOST: usize = 100_000;

/// The matrix and both products, of the members that the input chooses. They change nothing of the contact.
pub(super) fn derivatives(scene: &Scene, bytes: &mut Bytes) {
    let bits = |residual: Vec<f64>| residual.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    let before = scene.residual().map(bits);
    let (h, x1, x2, lambda) = (scene.handle, scene.x1.as_ptr(), scene.x2.as_ptr(), scene.lambda.as_ptr());
    let (mut rows, mut columns, mut values) = (Watched::new(MOST), Watched::new(MOST), Watched::<f64>::new(MOST));
    let (r, c, v, mut count) = (rows.pointer(), columns.pointer(), values.pointer(), 0);
    // SAFETY: the arrays are as long as the handle's surfaces ask for; so below.
    if succeeded(unsafe {
        stickslip_interface_previous_tangent_coo(h, x1, x2, lambda, MOST as i64, r, c, v, &mut count)
    }) {
        all_finite(&values.values()[..count as usize]);
    } else {
        values.assert_untouched();
        rows.assert_untouched();
        columns.assert_untouched();
    }

    let residual = [scene.x1.len(), scene.x2.len(), scene.lambda.len()];
    let lengths = [residual[0], residual[1], residual[0], residual[1], N1, 1, N1, N2];
    let wanted = lengths.map(|_| !bytes.once_in(4));
    let mut a = residual.map(|n| vec![0.5; n]);
    let mut along = lengths.map(|n| vec![0.25; n]);
    a.iter_mut().chain(&mut along).for_each(|v| shake(bytes, v));

    let mut slopes = lengths.map(Watched::<f64>::new);
    let [previous1, previous2, now1, now2, friction, shear_limit, offsets1, offsets2]: [*mut f64; 8] =
        std::array::from_fn(|k| if wanted[k] { slopes[k].pointer() } else { std::ptr::null_mut() });
    let struct_size = size_of::<stickslip_gradient>() as u64;
    let to =
        stickslip_gradient { struct_size, previous1, previous2, now1, now2, friction, shear_limit, offsets1, offsets2 };
    let [a1, a2, a_rows] = a.each_ref().map(|a| a.as_ptr());
    let works = succeeded(unsafe { stickslip_interface_adjoint(h, x1, x2, lambda, a1, a2, a_rows, &to) });
    for (slopes, wanted) in slopes.iter().zip(wanted) {
        if works && wanted {
            all_finite(slopes.values());
        } else {
            slopes.assert_untouched();
        }
    }

    let [previous1, previous2, now1, now2, friction, shear_limit, offsets1, offsets2]: [*const f64; 8] =
        std::array::from_fn(|k| if wanted[k] { along[k].as_ptr() } else { std::ptr::null() });
    let of = stickslip_direction {
        struct_size,
        previous1,
        previous2,
        now1,
        now2,
        friction,
        shear_limit,
        offsets1,
        offsets2,
    };
    let mut change = residual.map(Watched::<f64>::new);
    let [f1, f2, r] = change.each_mut().map(Watched::pointer);
    if succeeded(unsafe { stickslip_interface_sensitivity(h, x1, x2, lambda, &of, f1, f2, r) }) {
        change.iter().for_each(|c| all_finite(c.values()));
    } else {
        change.iter().for_each(Watched::assert_untouched);
    }
    assert!(before == scene.residual().map(bits), "derivatives have changed the contact");
}
