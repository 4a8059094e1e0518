//! What lies between the surfaces: a layer that yields, wear, a bond.

use super::guard::guard;
use super::handle::{either, handle, stickslip_interface};
use super::raw;
use super::sized::{self, Sized64};
use crate::error::{Error, Kind, Result};
use crate::features;
use crate::law::{Bond, Layer, Overclosure, Squeeze};
use crate::memory::Stored;

/// What lies between the surfaces, or becomes of them, beside the law of friction: any of three things. What is 0 or NULL is not there.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct stickslip_layer {
    /// sizeof(stickslip_layer).
    pub struct_size: u64,
    /// Points of a table of pressure against overclosure: 0 (surfaces are hard), or at least 2.
    pub n_overclosure: i64,
    /// n_overclosure: by how much the meshed surfaces overlap, growing [L]; the first may be below 0, where the pressure begins before
    /// they touch.
    pub overclosure: *const f64,
    /// n_overclosure: the pressure there, growing from 0 [F/L^2]. Straight lines in between, and beyond the last point.
    pub pressure: *const f64,
    /// Depth that is worn off a unit of pressure and of slip, of both surfaces together, as Archard has it: k = K / hardness [L^2/F].
    pub wear: f64,
    /// Of a bond: traction an opening, before damage [F/L^3]; 0: there is none, and what follows is 0, too.
    pub bond_stiffness: f64,
    /// The largest traction in tension [F/L^2].
    pub bond_strength: f64,
    /// Work that parts a unit of area, in tension, in shear and in any mixture of them [F/L].
    pub bond_toughness: f64,
    /// The largest shear traction over the one in tension [-].
    pub bond_shear: f64,
}

// SAFETY: repr(C), struct_size first, integers, numbers and raw pointers only.
unsafe impl Sized64 for stickslip_layer {
    const NAME: &'static str = "stickslip_layer";
    const FIRST: usize = 72;
}

/// The layer that a host's struct means; `None`: nothing.
fn read_layer(layer: *const stickslip_layer) -> Result<Option<Layer>> {
    if layer.is_null() {
        return Ok(None);
    }
    let of = sized::read(layer)?;
    let numbers = [
        ("wear", of.wear),
        ("bond_stiffness", of.bond_stiffness),
        ("bond_strength", of.bond_strength),
        ("bond_toughness", of.bond_toughness),
        ("bond_shear", of.bond_shear),
    ];
    for (name, v) in numbers {
        if !v.is_finite() {
            return Err(Error::new(Kind::NotFinite, text!("layer.{name} is {v}; it must be finite")));
        }
    }
    let n = raw::count(of.n_overclosure, 0, "layer.n_overclosure")?;
    let overclosure = if n == 0 {
        None
    } else {
        let overclosure = raw::numbers(of.overclosure, n, "layer.overclosure")?;
        let pressure = raw::numbers(of.pressure, n, "layer.pressure")?;
        let points = overclosure.iter().zip(pressure);
        let points: Vec<_> = points.map(|(&overclosure, &pressure)| Squeeze { overclosure, pressure }).stored()?;
        Some(Overclosure::new(&points)?)
    };
    let bond = Bond {
        stiffness: of.bond_stiffness,
        strength: of.bond_strength,
        toughness: of.bond_toughness,
        shear: of.bond_shear,
    };
    let has_bond = numbers[1..].iter().any(|(_, v)| *v != 0.0);
    let layer = Layer { overclosure, wear: (of.wear != 0.0).then_some(of.wear), bond: has_bond.then_some(bond) };
    layer.validate()?;
    Ok((layer != Layer::default()).then_some(layer))
}

/// Takes what lies between the surfaces, from the next evaluation on: a layer that yields under pressure, wear, a bond that bears
/// tension and shear until it is parted, or any of these together. The law of friction stays what it is, and stands beside a bond.
///
/// layer: see `stickslip_layer`; NULL, or one with nothing in it: nothing. It is copied. Wear is implicit: the depth of a step follows
/// from the pressure and the slip at its end. Worn depth and damage of the nodes are states, as those of a law are
/// (`stickslip_interface_law_states`, where they follow them, node by node), and belong to the history; the layer does not: set it again after a restart, before the
/// import. Its numbers may change from step to step; where wear or a bond comes or goes its states begin at 0, and no commit before it can be
/// undone. Offsets, which are the host's, are there beside it.
///
/// Not with (UNSUPPORTED): tied surfaces (STICKSLIP_FRICTION_TIED); conserving weights (STICKSLIP_WEIGHTS_CONSERVING);
/// derivatives by positions of t_n and by parameters.
///
/// Errors: NULL_POINTER, STRUCT_SIZE, INVALID_SIZE, NOT_FINITE, INVALID_VALUE (a number; wear or a bond without friction, which have no
/// slip), UNSUPPORTED (see above), and those of a search, where pairs must be sought farther or deeper.
/// Cost: the states, and of evaluations a part for each node; allocates them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn stickslip_interface_set_layer(
    interface: *mut stickslip_interface,
    layer: *const stickslip_layer,
) -> i32 {
    guard(|| {
        let h = handle(interface)?;
        let layer = read_layer(layer)?;
        if layer.is_some() {
            features::needs!(LAWS);
            features::needs!(OFFSETS); // covered areas change as a gap by an offset does
        }
        either!(&mut h.inner, c => c.set_layer(layer))
    })
}
