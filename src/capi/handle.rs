//! The interface handle, and what is behind it.

use super::guard::refuse_within_a_law;
use super::raw;
use crate::error::Result;
use crate::interface::Contact;
use nalgebra::SVector;

/// A contact interface. Created and destroyed by the library; one thread at a time.
pub struct stickslip_interface {
    pub(super) inner: Inner,
    pub(super) base: i64,
}

/// The interface by its number of multipliers per node.
pub(super) enum Inner {
    One(Contact<1>),
    Three(Contact<3>),
}

/// Calls the same code for either kind.
macro_rules! either {
    ($inner:expr, $contact:ident => $body:expr) => {
        match $inner {
            $crate::capi::handle::Inner::One($contact) => $body,
            $crate::capi::handle::Inner::Three($contact) => $body,
        }
    };
}
pub(super) use either;

/// The handle behind a pointer.
#[inline(never)]
pub(super) fn handle<'a>(p: *mut stickslip_interface) -> Result<&'a mut stickslip_interface> {
    raw::check(p, "interface")?;
    refuse_within_a_law()?;
    // SAFETY: non-null and aligned; by the caller's contract it came from create, is not destroyed, and
    // is used by this thread alone.
    Ok(unsafe { &mut *p })
}

/// Nodes of the two sides.
pub(super) fn sizes(interface: &Inner) -> (usize, usize) {
    let (one, two) = either!(interface, c => c.surfaces());
    (one.len(), two.len())
}

/// Components of a vector in the caller's arrays: 3, or 2 of plane and axisymmetric models.
pub(super) fn dimension(interface: &Inner) -> usize {
    either!(interface, c => components_of(c))
}

/// The same of what is behind a handle.
pub(super) fn components_of<const N: usize>(c: &Contact<N>) -> usize {
    if c.surfaces().0.lines().is_some() { 2 } else { 3 }
}

/// Components node by node: of vectors the first `dimension` ones.
pub(super) fn flat<const N: usize>(v: &[SVector<f64, N>], dimension: usize) -> impl Iterator<Item = f64> {
    v.iter().flat_map(move |v| v.iter().copied().take(dimension))
}
