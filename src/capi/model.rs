//! Of how many dimensions a caller's model is, and what a length of its lines stands for.

use super::choice::choose;
use crate::error::{Error, Kind, Result};
use crate::features;
use crate::line::Measure;

/// Facets of a solid: positions have three components.
pub const STICKSLIP_MODEL_SOLID: i32 = 0;
/// Lines of a plane model, strain or stress: positions are (x, y).
pub const STICKSLIP_MODEL_PLANE: i32 = 1;
/// Lines of an axisymmetric model: positions are (r, z). Forces are those of the whole ring.
pub const STICKSLIP_MODEL_AXISYMMETRIC: i32 = 2;

/// A STICKSLIP_MODEL_... value.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Model {
    Solid,
    Plane,
    Axisymmetric,
}

/// The model of a STICKSLIP_MODEL_... value.
#[inline]
pub(super) fn model(value: i32, name: &str) -> Result<Model> {
    choose(value, name, &[Model::Solid, Model::Plane, Model::Axisymmetric], 3)
}

/// What a length of a line stands for in a model of this thickness, `None` in a solid. 0 of a plane model is 1.
#[inline]
pub(super) fn measure(model: Model, thickness: f64, name: &str) -> Result<Option<Measure>> {
    if !thickness.is_finite() {
        return Err(Error::new(Kind::NotFinite, text!("{name} is {thickness}; it must be finite")));
    }
    if thickness < 0.0 {
        return Err(Error::new(Kind::InvalidValue, text!("{name} is {thickness}; it must not be negative")));
    }
    if model != Model::Plane && thickness != 0.0 {
        let text = text!("{name} is {thickness}; it is of plane models (STICKSLIP_MODEL_PLANE), leave it 0 in others");
        return Err(Error::new(Kind::InvalidValue, text));
    }
    if model != Model::Solid {
        features::needs!(LINES);
    }
    Ok(match model {
        Model::Solid => None,
        Model::Plane => Some(Measure::Thickness(if thickness == 0.0 { 1.0 } else { thickness })),
        Model::Axisymmetric => Some(Measure::Axisymmetric),
    })
}
