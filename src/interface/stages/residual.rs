//! Stage 3: the forces of both sides, and the multiplier rows.

use crate::element::pair_force;
use crate::error::Result;
use crate::geometry::Vec3;
use crate::interface::data::multiplier::force_traction;
use crate::interface::data::pairs::PairRecord;
use crate::interface::pairing::given::Given;
use crate::law::NodeResponse;
use crate::memory::{self, Stored};
use crate::mortar::MORTAR;
use nalgebra::SVector;

/// Residual of an interface.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual<const N: usize = 3> {
    /// Internal forces at the non-mortar nodes `[F]`; the force ON the body is the negative.
    pub nonmortar: Vec<Vec3>,
    /// Internal forces at the mortar nodes `[F]`.
    pub mortar: Vec<Vec3>,
    /// Multiplier rows (`[F]` or [L^3], see the row scale).
    pub rows: Vec<SVector<f64, N>>,
}

/// Of the pairs whose weights act, at the law's answers.
pub fn residual<const N: usize>(
    given: Given<N>,
    pairs: &[PairRecord],
    lambda: &[SVector<f64, N>],
    responses: &[NodeResponse<N>],
) -> Result<Residual<N>> {
    let ((nonmortar, mortar), nodes) = (given.setup.surfaces(), &given.setup.nodes);
    let mut r = Residual {
        nonmortar: memory::filled(Vec3::zeros(), nonmortar.len())?,
        mortar: memory::filled(Vec3::zeros(), mortar.len())?,
        rows: memory::filled(SVector::zeros(), nonmortar.len())?,
    };
    let (normals, form) = (given.normals()?, given.setup.options.form);
    let traction = |a: usize| force_traction(form, &lambda[a], &responses[a], normals[a]);
    let tractions: Vec<_> = (0..responses.len()).map(traction).stored()?;
    for pair in pairs {
        let (one, two) = (&nonmortar.facets[pair.one], &mortar.facets[pair.two]);
        let f = pair_force(&pair.weights, &one.nodes.map(|a| tractions[a]));
        for k in 0..one.len {
            r.nonmortar[one.nodes[k]] += f[k];
        }
        for k in 0..two.len {
            r.mortar[two.nodes[k]] += f[MORTAR + k];
        }
    }
    for (a, response) in responses.iter().enumerate() {
        if nodes.owned[a] {
            r.rows[a] = response.row * given.row_scale(a);
        }
    }
    Ok(r)
}
