//! Normals that follow the motion, through the handle: which of them evaluations use, and multipliers to start a step with
//! (docs/formulation 11.3, 11.4).

use super::contact::Contact;
use super::data::node_data::check_length;
use super::data::options::Normals;
use super::pairing::given::check_finite;
use super::stages::normals;
use crate::error::{Error, Kind, Result};
use crate::geometry::Vec3;
use crate::memory::{self, Stored};
use crate::normal::turned;
use nalgebra::SVector;

impl<const N: usize> Contact<N> {
    /// Which normals evaluations use until the next commit, rollback or import. Those of t_n are a robust first phase of a
    /// step; a commit needs those of the options.
    pub fn use_normals(&mut self, normals: Normals) -> Result<()> {
        if normals == Normals::Current && self.setup.options.normals == Normals::Committed {
            let text = "normals: STICKSLIP_NORMALS_CURRENT is for interfaces that were created with it";
            return Err(Error::new(Kind::InvalidValue, text));
        }
        self.step.normals = normals;
        self.step.forget_normals();
        self.cache.forget();
        Ok(())
    }

    /// Turns multipliers as the normals turn from t_n to `x1`: a start for Newton's method. One along the normal, and
    /// those of interfaces whose normals do not follow the motion, stay as they are.
    pub fn turn_multipliers(&self, x1: &[Vec3], lambda: &[SVector<f64, N>]) -> Result<Vec<SVector<f64, N>>> {
        check_length("x1", x1.len(), self.setup.nonmortar.len())?;
        check_length("lambda", lambda.len(), self.setup.nonmortar.len())?;
        check_finite("x1", x1)?;
        check_finite("lambda", lambda)?;
        if N != 3 || !self.setup.options.follows_normals() {
            return memory::copied(lambda);
        }
        let (given, now) = (self.given(), normals::at(&self.setup, &self.step, x1)?);
        let turn = |(a, lambda): (usize, &SVector<f64, N>)| {
            let vector = Vec3::from_fn(|i, _| lambda[i]);
            let vector = turned(vector, given.normal_of_step(a)?, given.free_normal(a, now.nu[a])?);
            Ok(SVector::from_fn(|i, _| vector[i]))
        };
        lambda.iter().enumerate().map(turn).stored_if_ok()
    }
}
