//! The kind of model that facets belong to, as a caller says it.

use super::choice::choose;
use crate::error::{Error, Kind, Result};
use crate::line::Measure;

/// A model in space: facets are tri3, quad4, tri6, quad8, quad9; three components a node.
pub const STICKSLIP_MODEL_SOLID: i32 = 0;
/// Plane strain or plane stress: facets are line2 or line3; two components a node, x and y.
pub const STICKSLIP_MODEL_PLANE: i32 = 1;
/// Axisymmetric: facets are line2 or line3; two components a node, r and z. Areas and forces are those of the whole ring, with
/// 2 pi r.
pub const STICKSLIP_MODEL_AXISYMMETRIC: i32 = 2;

/// What the lengths of a model's lines stand for; `None`: its facets are no lines.
pub(super) fn measure(model: i32, thickness: f64, of: &str) -> Result<Option<Measure>> {
    let measure = choose(model, &text!("{of}.model"), &[None, Some(false), Some(true)], 3)?;
    if !thickness.is_finite() {
        return Err(Error::new(Kind::NotFinite, text!("{of}.thickness is {thickness}; it must be finite")));
    }
    let plane = measure == Some(false);
    if if plane { thickness < 0.0 } else { thickness != 0.0 } {
        let allowed = if plane { "positive, or 0 for 1" } else { "0 where the model is not STICKSLIP_MODEL_PLANE" };
        return Err(Error::new(Kind::InvalidValue, text!("{of}.thickness is {thickness}; it must be {allowed}")));
    }
    let thickness = if thickness == 0.0 { 1.0 } else { thickness };
    Ok(measure.map(|axisymmetric| if axisymmetric { Measure::Axisymmetric } else { Measure::Thickness(thickness) }))
}
